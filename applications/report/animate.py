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
    from PIL import Image  # which matplotlib needs

    import style
    from contours import color_bar, sparse_ticks
    from film import Film, contact_sheet, is_narrow, shape_of, spread
    from read_run import MODEL_ORDER, ReportError, Run
    from words import Field
except ImportError as fault:
    sys.exit(f"animate: a Python package is missing ({fault}); frames need numpy, matplotlib and h5py")

DOTS_PER_INCH = min(120, style.DOTS_PER_INCH)


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
    film.indices = spread(film.indices)
    contact_sheet([film]).savefig(folder / "contact_sheet.png", dpi=DOTS_PER_INCH)
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
