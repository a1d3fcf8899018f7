#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Frames of a 2D run: its field at every written time, with the cracks as they are then.

    python3 applications/report/animate.py RUN_DIRECTORY [--model peridynamics] [--field von_mises]
                                           [--output DIRECTORY] [--gif]

Elastic bodies are drawn in their deformed shape, magnified by one factor in all frames.

Writes frame_0000.png, frame_0001.png, ... and contact_sheet.png into RUN_DIRECTORY/animation, with
--gif film.gif, too, which browsers show. All frames have one colour scale and one size, so that a
film can be made of them, for example by ffmpeg -framerate 8 -i frame_%04d.png film.mp4. How many frames there are is said by Write every
or Write at of the scene.
"""

import argparse
import sys
from pathlib import Path

try:
    import numpy as np
    from PIL import Image  # which matplotlib needs

    import contours
    import deformed
    import fragments
    import style
    from contours import Maps, color_bar, draw_cells, draw_picture, segments_of, sparse_ticks
    from read_run import MODEL_ORDER, ReportError, Run
    from words import Field
except ImportError as fault:
    sys.exit(f"animate: a Python package is missing ({fault}); frames need numpy, matplotlib and h5py")

DOTS_PER_INCH = min(120, style.DOTS_PER_INCH)


class Film:
    """The pictures of one model of a run at all written times, and their common scale."""

    def __init__(self, run, model, field=None, n_pixels=480):
        self.run, self.model = run, model
        self.times = run.written_times()
        self.indices = [i for i in range(len(self.times)) if run.field_file(i, model) is not None]
        self.field = field or self.usual_field()
        self.segments = {i: segments_of(run.cracks(i)) for i in self.indices}
        self.shapes = self.deformed_shapes(n_pixels)
        if self.shapes is not None:
            self.view = self.shapes.view
            share = contours.outliers_of(run, self.indices, self.field)
            self.scale = self.scale_of([fragments.of_body(run, i, model, self.values(i))
                                        for i in self.indices], share)
            return
        self.view = Maps(run, n_pixels).view()
        self.pictures, self.isolines = {}, {}
        for i in self.indices:
            maps = Maps(run, n_pixels)  # its weights depend on the cracks of this time
            values = self.values(i)
            self.pictures[i] = maps.picture(i, model, values, self.segments[i])
            self.isolines[i] = maps.isoline_picture(i, model, values, self.segments[i])
        self.scale = self.scale_of(list(self.pictures.values()), 0.0)

    def usual_field(self):
        """The damage where bonds break, else the solution."""
        words = self.run.words
        if words.elastic and fragments.broke(self.run, self.indices[-1]) \
                and self.run.field(self.indices[-1], self.model, "damage", required=False) is not None:
            return words.fields["damage"]
        return words.solution

    def scale_of(self, values, outliers=None):
        """The scale of all frames: that of the field, where it has one, else what the values need."""
        field = self.field
        return style.fixed_scale(*field.span) if field.span else style.value_scale(
            values, outliers=field.outliers if outliers is None else outliers)

    def values(self, index):
        """The field of a frame at the vertices."""
        return self.run.field(index, self.model, self.field.name)

    def deformed_shapes(self, n_pixels):
        """Of an elastic body that moves, else None."""
        run = self.run
        factor = deformed.magnification(run, self.indices) if run.words.elastic else None
        if factor is None:
            return None
        shapes = deformed.Shapes(Maps(run, n_pixels), self.indices, [self.model], factor)
        return shapes if all((i, self.model) in shapes.shapes for i in self.indices) else None

    def time_text(self, index):
        """The time of a frame with its unit."""
        unit = self.run.get("units", "time", default="")
        return f"t = {style.plain(self.times[index])} {unit}".rstrip()

    def draw(self, axes, index, scale=None):
        """One frame in its axes, with its time in the corner."""
        if self.shapes is not None:
            self.shapes.draw(axes, index, self.model, self.values(index), scale or self.scale)
        else:
            draw_picture(axes, self.view, self.pictures[index], scale or self.scale,
                         self.segments[index], self.isolines[index])
            draw_cells(axes, self.run, index, self.model)
        if self.run.get("steady", default=False) and len(self.indices) < 2:
            return
        if is_narrow(self):  # beside the picture, which it would cover
            axes.set_title(self.time_text(index), loc="left", fontsize=8.5, fontweight="normal", pad=3)
            return
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


def is_narrow(film):
    """Whether the body is so flat or slender that a text would cover much of it."""
    return min(shape_of(film)) < 2.0


def shape_of(film):
    """Width and height of one panel in inches, 3.6 at most."""
    left, right, bottom, top = film.view.extent
    aspect = (top - bottom) / (right - left)
    return (3.6, 3.6 * aspect) if aspect <= 1 else (3.6 / aspect, 3.6)


def frame_figure(film, index):
    """One frame: the field, the axes, the bar of the scale."""
    width, height = shape_of(film)
    above = 0.2 if is_narrow(film) else 0.0  # room for the time
    low = max(0.45, 0.5 * (1.9 - height))  # and for the label of the bar beside a flat body
    total = (width + 1.95, height + 2 * low - 0.15 + above)
    figure = style.figure(*total)
    axes = figure.add_axes([0.6 / total[0], low / total[1], width / total[0], height / total[1]])
    film.draw(axes, index)
    sparse_ticks(axes, width, height)
    words = film.run.words
    axes.set_xlabel(words.axis("x"), labelpad=1)
    axes.set_ylabel(words.axis("y"), labelpad=2)
    color_bar(figure, [(width + 0.78) / total[0], low / total[1], 0.13 / total[0],
                       height / total[1]], film.scale, film.field.label(), vertical=True)
    return figure


def contact_sheet(film, at_most=12):
    """Up to so many frames on one page."""
    n = len(film.indices)
    chosen = [film.indices[k] for k in sorted({int(round(x)) for x in np.linspace(0, n - 1, min(n, at_most))})]
    columns = min(len(chosen), 4)
    rows = -(-len(chosen) // columns)
    width, height = (0.72 * size for size in shape_of(film))
    across, up = max(0.12, 1.0 - width), 0.32 if is_narrow(film) else 0.12
    total = (max(columns * (width + across) + 0.3, 3.0), rows * (height + up) + 0.85)
    figure = style.figure(*total)
    for k, index in enumerate(chosen):
        left = 0.15 + (k % columns) * (width + across)
        bottom = total[1] - 0.1 - (k // columns + 1) * (height + up) + 0.12
        axes = figure.add_axes([left / total[0], bottom / total[1], width / total[0], height / total[1]])
        film.draw(axes, index)
        axes.set_xticks([])
        axes.set_yticks([])
    length = min(total[0] - 0.6, 5.0)
    color_bar(figure, [(total[0] - length) / 2 / total[0], 0.55 / total[1], length / total[0], 0.12 / total[1]],
              film.scale, film.field.label())
    return figure


def chosen_field(run, model, name):
    """The field of that name, in words where it has some; None: the solution."""
    if name is None:
        return None
    last = len(run.summary["fields"]) - 1
    if run.field(last, model, name, required=False) is None:
        raise ReportError(f"'{run.field_file(last, model)}' has no dataset '{name}'")
    return getattr(run.words, "fields", {}).get(name) or Field(name)


def write_film(folder, per_second=8):
    """All frames as one GIF, which begins anew after a rest at the last one."""
    frames = []
    for path in sorted(folder.glob("frame_*.png")):
        with Image.open(path) as frame:
            frames.append(frame.convert("RGB").convert("P", palette=Image.Palette.ADAPTIVE))
    each = 1000 // per_second  # milliseconds
    frames[0].save(folder / "film.gif", save_all=True, append_images=frames[1:], loop=0,
                   duration=[each] * (len(frames) - 1) + [8 * each])


def make(directory, model=None, output=None, field=None, gif=False):
    """Writes all frames and the contact sheet; returns the folder."""
    run = Run(directory)
    if run.dimension != 2:
        raise ReportError(f"'{directory}' is a {run.dimension}D run; frames are drawn of 2D runs")
    model = chosen_model(run, model)
    film = Film(run, model, chosen_field(run, model, field))
    folder = Path(output) if output else Path(directory) / "animation"
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("frame_*.png"):
        old.unlink()
    for number, index in enumerate(film.indices):
        frame_figure(film, index).savefig(folder / f"frame_{number:04d}.png", dpi=DOTS_PER_INCH)
    contact_sheet(film).savefig(folder / "contact_sheet.png", dpi=DOTS_PER_INCH)
    if gif:
        write_film(folder)
    return folder


def main(arguments=None):
    """Command line."""
    parser = argparse.ArgumentParser(description="Draws the field of a 2D run at every written time.")
    parser.add_argument("directory", metavar="RUN_DIRECTORY")
    parser.add_argument("--model", choices=MODEL_ORDER)
    parser.add_argument("--field", metavar="NAME", help="a scalar field of the files, for example von_mises; "
                        "else the damage where bonds break, and the solution")
    parser.add_argument("--output", metavar="DIRECTORY")
    parser.add_argument("--gif", action="store_true", help="write film.gif, too")
    options = parser.parse_args(arguments)
    try:
        print(make(options.directory, options.model, options.output, options.field, options.gif))
    except (ReportError, OSError) as fault:
        print(f"animate: {fault}".replace("\n", " "), file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
