#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Frames of a 2D run: its field at every written time, with the cracks as they are then.

    python3 applications/report/animate.py RUN_DIRECTORY [--model peridynamics] [--output DIRECTORY]

Writes frame_0000.png, frame_0001.png, ... and contact_sheet.png into RUN_DIRECTORY/animation. All
frames have one colour scale and one size, so that a film can be made of them, for example by
ffmpeg -framerate 8 -i frame_%04d.png film.mp4. How many frames there are is said by Write every
or Write at of the scene.
"""

import argparse
import sys
from pathlib import Path

try:
    import numpy as np

    import style
    from contours import Maps, color_bar, draw_cells, draw_picture, segments_of, sparse_ticks
    from read_run import MODEL_ORDER, ReportError, Run
except ImportError as fault:
    sys.exit(f"animate: a Python package is missing ({fault}); frames need numpy, matplotlib and h5py")

DOTS_PER_INCH = 120


class Film:
    """The pictures of one model of a run at all written times, and their common scale."""

    def __init__(self, run, model, n_pixels=480):
        self.run, self.model = run, model
        self.times = run.written_times()
        self.indices = [i for i in range(len(self.times)) if run.field_file(i, model) is not None]
        self.segments = {i: segments_of(run.cracks(i)) for i in self.indices}
        self.view = Maps(run, n_pixels).view()
        self.pictures, self.isolines = {}, {}
        for i in self.indices:
            maps = Maps(run, n_pixels)  # its weights depend on the cracks of this time
            values = run.solution(i, model)
            self.pictures[i] = maps.picture(i, model, values, self.segments[i])
            self.isolines[i] = maps.isoline_picture(i, model, values, self.segments[i])
        self.scale = style.value_scale(list(self.pictures.values()))

    def time_text(self, index):
        """The time of a frame with its unit."""
        unit = self.run.get("units", "time", default="")
        return f"t = {style.plain(self.times[index])} {unit}".rstrip()

    def draw(self, axes, index, scale=None):
        """One frame in its axes, with its time in the corner."""
        draw_picture(axes, self.view, self.pictures[index], scale or self.scale,
                     self.segments[index], self.isolines[index])
        draw_cells(axes, self.run, index, self.model)
        axes.text(0.02, 0.98, self.time_text(index), transform=axes.transAxes, va="top", ha="left",
                  fontsize=8.5, zorder=9, color=style.INK,
                  bbox={"facecolor": "white", "alpha": 0.85, "edgecolor": "none", "pad": 2})


def chosen_model(run, model):
    """The model whose frames are drawn: the one asked for, else peridynamics or what there is."""
    with_fields = [m for m in run.models
                   if any(m in entry["files"] for entry in run.summary["fields"])]
    if not with_fields:
        raise ReportError(f"'{run.directory}' has no fields: set 'Fields' in section 'Output' of the "
                          "scene to hdf5, and run it again")
    if model is None:
        return "peridynamics" if "peridynamics" in with_fields else with_fields[0]
    if model not in with_fields:
        raise ReportError(f"'{run.directory}' has no fields of '{model}', but of "
                          f"{', '.join(with_fields)}")
    return model


def shape_of(film):
    """Width and height of one panel in inches, 3.6 at most."""
    left, right, bottom, top = film.view.extent
    aspect = (top - bottom) / (right - left)
    return (3.6, 3.6 * aspect) if aspect <= 1 else (3.6 / aspect, 3.6)


def frame_figure(film, index):
    """One frame: the field, the axes, the bar of the scale."""
    width, height = shape_of(film)
    total = (width + 1.75, height + 0.75)
    figure = style.figure(*total)
    axes = figure.add_axes([0.6 / total[0], 0.45 / total[1], width / total[0], height / total[1]])
    film.draw(axes, index)
    sparse_ticks(axes, width, height)
    words = film.run.words
    axes.set_xlabel(words.axis("x"), labelpad=1)
    axes.set_ylabel(words.axis("y"), labelpad=2)
    color_bar(figure, [(width + 0.78) / total[0], 0.45 / total[1], 0.13 / total[0],
                       height / total[1]], film.scale, words.solution.label(), vertical=True)
    return figure


def contact_sheet(film, at_most=12):
    """Up to so many frames on one page."""
    n = len(film.indices)
    chosen = [film.indices[k] for k in sorted({int(round(x)) for x in np.linspace(0, n - 1, min(n, at_most))})]
    columns = min(len(chosen), 4)
    rows = -(-len(chosen) // columns)
    width, height = (0.72 * size for size in shape_of(film))
    total = (columns * (width + 0.12) + 0.3, rows * (height + 0.12) + 0.75)
    figure = style.figure(*total)
    for k, index in enumerate(chosen):
        left = 0.15 + (k % columns) * (width + 0.12)
        bottom = total[1] - 0.1 - (k // columns + 1) * (height + 0.12) + 0.12
        axes = figure.add_axes([left / total[0], bottom / total[1], width / total[0], height / total[1]])
        film.draw(axes, index)
        axes.set_xticks([])
        axes.set_yticks([])
    length = min(total[0] - 0.6, 5.0)
    color_bar(figure, [(total[0] - length) / 2 / total[0], 0.45 / total[1], length / total[0], 0.12 / total[1]],
              film.scale, film.run.words.solution.label())
    return figure


def make(directory, model=None, output=None):
    """Writes all frames and the contact sheet; returns the folder."""
    run = Run(directory)
    if run.dimension != 2:
        raise ReportError(f"'{directory}' is a {run.dimension}D run; frames are drawn of 2D runs")
    film = Film(run, chosen_model(run, model))
    folder = Path(output) if output else Path(directory) / "animation"
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("frame_*.png"):
        old.unlink()
    for number, index in enumerate(film.indices):
        frame_figure(film, index).savefig(folder / f"frame_{number:04d}.png", dpi=DOTS_PER_INCH)
    contact_sheet(film).savefig(folder / "contact_sheet.png", dpi=DOTS_PER_INCH)
    return folder


def main(arguments=None):
    """Command line."""
    parser = argparse.ArgumentParser(description="Draws the field of a 2D run at every written time.")
    parser.add_argument("directory", metavar="RUN_DIRECTORY")
    parser.add_argument("--model", choices=MODEL_ORDER)
    parser.add_argument("--output", metavar="DIRECTORY")
    options = parser.parse_args(arguments)
    try:
        print(make(options.directory, options.model, options.output))
    except (ReportError, OSError) as fault:
        print(f"animate: {fault}".replace("\n", " "), file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
