# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The pictures of the page, in the colours of the report."""

import sys
from pathlib import Path

import numpy as np
from matplotlib.ticker import NullFormatter
from PIL import Image

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "applications" / "report"))

import style  # noqa: E402
from animate import Film, shape_of  # noqa: E402
from contours import color_bar  # noqa: E402
from read_run import Run  # noqa: E402

# Okabe-Ito; the last one is for the exact solution.
COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f")
MARKS = ("o", "s", "D", "^", "v", "P", "X")
LIMIT = 200_000


def save(figure, path, dots=110):
    """A small PNG: few colours, and fewer dots if it is still too large."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    while True:
        figure.savefig(path, dpi=dots)
        image = Image.open(path).convert("RGB").quantize(256, kmeans=1, dither=Image.NONE)
        image.save(path, optimize=True)
        if path.stat().st_size < LIMIT or dots < 60:
            return
        dots *= 0.85


def reads_as_reference(name):
    return name.strip("_") in ("exact", "analytical") or name.startswith("finite elements")


def curves(path, panels, x_label, y_label, log_x=None, log_y=False, columns=3, markers=True, size=(2.9, 2.4)):
    """Panels side by side: (title, [(name, x, y), ...], level of a dashed line or None)."""
    columns = min(columns, len(panels))
    rows = -(-len(panels) // columns)
    width, height = size
    margin, gap = (0.95, 0.85) if log_y else (0.68, 0.62)
    total = (columns * (width + gap) + margin - gap + 0.2, rows * (height + 0.78) + 0.1)
    figure = style.figure(*total)
    for k, (title, lines, level) in enumerate(panels):
        left = margin + (k % columns) * (width + gap)
        bottom = total[1] - 0.28 - height - (k // columns) * (height + 0.78)
        axes = figure.add_axes([left / total[0], bottom / total[1], width / total[0], height / total[1]])
        style.tidy(axes)
        for i, (name, x, y) in enumerate(lines):
            reference = reads_as_reference(name)
            axes.plot(x, y, label=name, color="black" if reference else COLORS[i % len(COLORS)],
                      linestyle=(0, (1, 1.6)) if reference else "-", linewidth=1.4, zorder=4 if reference else 3,
                      marker=MARKS[i % len(MARKS)] if markers and not reference else "", markersize=3.5)
        if level is not None:
            axes.axhline(level, color="black", linewidth=1.0, linestyle=(0, (4, 3)), zorder=1)
        if log_x:
            axes.set_xscale("log", base=log_x)
            values = sorted({float(v) for _, x, _ in lines for v in x})
            if len(values) <= 6 and all(b > 1.4 * a for a, b in zip(values, values[1:])):
                axes.set_xticks(values)
                axes.set_xticklabels([style.plain(v, 3) for v in values], fontsize=7.5)
                axes.minorticks_off()
        if log_y:
            axes.set_yscale("log")
            axes.yaxis.set_minor_formatter(NullFormatter())
            levels = [v for _, _, y in lines for v in y if v > 0]
            if np.log10(max(levels) / min(levels)) < 1.3:  # hardly a power of ten: name the ends
                axes.set_yticks([min(levels), max(levels)])
                axes.set_yticklabels([style.plain(v, 2) for v in (min(levels), max(levels))])
        axes.set_title(title, loc="left", fontsize=9)
        axes.set_xlabel(x_label, labelpad=1)
        if k % columns == 0:
            axes.set_ylabel(y_label, labelpad=2)
        axes.legend(fontsize=7, handlelength=1.8, labelspacing=0.25, borderaxespad=0.2)
    save(figure, path)


def field_grid(path, rows, model="peridynamics", panel=1.55):
    """Fields with their cracks: rows of (label, folder of a run, times), one scale for all."""
    films = []
    for label, folder, times in rows:
        film = Film(Run(folder), model, 300)
        films.append((label, film, [min(film.indices, key=lambda i, t=t: abs(film.times[i] - t)) for t in times]))
    scale = style.value_scale([film.pictures[i] for _, film, chosen in films for i in chosen])
    columns = max(len(chosen) for _, _, chosen in films)
    width, height = (panel / 3.6 * size for size in shape_of(films[0][1]))
    total = (columns * (width + 0.08) + 0.42, len(films) * (height + 0.08) + 0.62)
    figure = style.figure(*total)
    for r, (label, film, chosen) in enumerate(films):
        for c, index in enumerate(chosen):
            left = 0.34 + c * (width + 0.08)
            bottom = total[1] - 0.04 - (r + 1) * (height + 0.08) + 0.08
            axes = figure.add_axes([left / total[0], bottom / total[1], width / total[0], height / total[1]])
            film.draw(axes, index, scale)
            axes.texts[-1].set_fontsize(7)
            for line in axes.lines:
                line.set_linewidth(0.55 * line.get_linewidth())
                line.set_snap(False)
            axes.set_xticks([])
            axes.set_yticks([])
            if c == 0:
                axes.set_ylabel(label, fontsize=8, labelpad=3)
    length = min(total[0] - 0.8, 4.0)
    color_bar(figure, [(total[0] - length) / 2 / total[0], 0.4 / total[1], length / total[0], 0.1 / total[1]], scale,
              films[0][1].run.words.solution.label())
    save(figure, path, 120)
