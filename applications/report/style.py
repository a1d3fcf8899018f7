# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Colours, fonts and number formats shared by all figures and tables."""

import math
import os
import re
import textwrap

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib.colors import BoundaryNorm, LinearSegmentedColormap, ListedColormap, to_rgb
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

DOTS_PER_INCH = int(os.environ.get("PERIDEAL_DOTS_PER_INCH", "200"))  # of pictures; tests draw them coarser

INK = "#1f2933"
GRID = "#e4e7eb"

# Okabe-Ito colours: told apart with any colour vision.
MODEL_COLOR = {"finite elements": "#0072b2", "peridynamics": "#d55e00", "coupled": "#009e73",
               "exact": "#000000"}
MODEL_DASHES = {"finite elements": "-", "peridynamics": (0, (5, 2)),
                "coupled": (0, (5, 1.5, 1, 1.5)), "exact": (0, (1, 1.6))}
MODEL_MARKER = {"finite elements": "o", "peridynamics": "s", "coupled": "D", "exact": ""}

THERMAL = LinearSegmentedColormap.from_list(
    "thermal", ["#0d2a5b", "#2a4f8f", "#5d5fa5", "#95619f", "#c9647f", "#ec7a55", "#f8a545",
                "#fbd36b", "#fff6c9"])
FLUX = LinearSegmentedColormap.from_list(
    "flux", ["#f7fbfb", "#cfe8e6", "#93cfd0", "#4faab8", "#2a7f9e", "#1d5680", "#142f57"])
DIFFERENCE = LinearSegmentedColormap.from_list(
    "difference", ["#123e7c", "#3f7fc0", "#9cc4e4", "#f7f7f7", "#f3b79b", "#d0603f", "#7f1d1d"])

DAMAGE = LinearSegmentedColormap.from_list(
    "damage", ["#f6f4ee", "#fadcae", "#f4a261", "#dd5b3c", "#a3202f", "#4a0d1f"])

matplotlib.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 9, "text.color": INK, "axes.labelcolor": INK,
    "axes.edgecolor": "#9aa5b1", "axes.linewidth": 0.8, "xtick.color": "#52606d",
    "ytick.color": "#52606d", "xtick.labelsize": 8, "ytick.labelsize": 8, "axes.titlesize": 10,
    "axes.titleweight": "bold", "axes.titlecolor": INK, "legend.frameon": False,
    "legend.fontsize": 8, "axes.formatter.limits": (-3, 4), "axes.formatter.use_mathtext": True,
    "mathtext.fontset": "dejavusans", "figure.facecolor": "white", "svg.fonttype": "path",
    "svg.hashsalt": "perideal", "image.interpolation": "nearest"})


def plain(value, digits=4):
    """A number for figures and running text: few digits, 1.2e-05 as 1.2×10⁻⁵."""
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int) or (float(value).is_integer() and 1000 <= abs(value) < 1e15):
        return f"{int(value):,}".replace(",", "\u202f").replace("-", "−")
    value = float(value)
    if not math.isfinite(value):
        return str(value)
    text = f"{value:.{digits}g}"
    if "e+" in text and abs(value) < 1e6:  # few digits of a number that is not large
        return plain(int(float(text)))
    if "e" in text:
        mantissa, exponent = text.split("e")
        superscript = str(int(exponent)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
        return f"{mantissa}×10{superscript}".replace("-", "−")
    return text.replace("-", "−")


def minus(text):
    """A formula with the sign of subtraction that numbers have."""
    return str(text).replace("-", "−")


def prose(text):
    """Running text whose numbers and formulas have that sign too; hyphens stay."""
    text = re.sub(r"(?<=\d[eE])-(?=\d)", "−", str(text))
    text = re.sub(r"(?<![\w-])-(?=[\d.(]|[a-z]+\()", "−", text)
    return re.sub(r"(?<=[\w)]) - (?=[\w(])", " − ", text)


def is_formula(text):
    """Whether a text is a formula and not a name."""
    return any(c in text for c in "()*/^=<>")


def is_nothing(values, among):
    """Whether values are zero but for the round-off of the values they belong to."""
    sizes = [np.abs(v[np.isfinite(v)]).max(initial=0) for v in map(np.asarray, (values, among))]
    return bool(sizes[0] <= 1e-12 * sizes[1])


def nice_levels(low, high, n):
    """Round levels that cover [low, high]."""
    if not high > low:
        middle, width = low, max(abs(low) * 1e-6, 1e-12)
        low, high = middle - width, middle + width
    levels = MaxNLocator(nbins=n, steps=[1, 2, 2.5, 4, 5, 10]).tick_values(low, high)
    step = levels[1] - levels[0]
    kept = [v for v in levels if v > low - step * (1 + 1e-9) and v < high + step * (1 + 1e-9)]
    while len(kept) > 2 and kept[1] <= low + 1e-9 * step:
        kept = kept[1:]
    while len(kept) > 2 and kept[-2] >= high - 1e-9 * step:
        kept = kept[:-1]
    return np.array(kept)


def refined(levels, parts):
    """Levels with each interval divided in so many parts."""
    position = np.arange((len(levels) - 1) * parts + 1) / parts
    return np.interp(position, np.arange(len(levels)), levels)


class Scale:
    """One colour scale: bands, the levels of its isolines, and whether values exceed it."""

    def __init__(self, levels, colormap, lines, extend="neither"):
        self.levels, self.lines, self.extend = np.asarray(levels), np.asarray(lines), extend
        n_bands = len(self.levels) - 1
        self.colormap = ListedColormap(colormap((np.arange(n_bands) + 0.5) / n_bands))
        self.colormap.set_under(colormap(0.0))
        self.colormap.set_over(colormap(1.0))
        self.colormap.set_bad("#ffffff00")
        self.norm = BoundaryNorm(self.levels, n_bands)

    def clean(self, picture, relative=1e-9):
        """A picture without round-off, whose isolines would be noise where values are equal."""
        grain = relative * max(self.levels[-1] - self.levels[0], 1e-300)
        return np.round(picture / grain) * grain + 0.0

    def line_colors(self):
        """Dark lines on light bands, light lines on dark ones."""
        colors = []
        for level in self.lines:
            red, green, blue = to_rgb(self.colormap(self.norm(level)))
            light = 0.299 * red + 0.587 * green + 0.114 * blue > 0.45
            colors.append("#1f293399" if light else "#ffffffb0")
        return colors


def without_outliers(values, share, worth=0.7):
    """(low, high, extend) of values but for a share at either end, where that spares much of the range."""
    low, high = float(values.min()), float(values.max())
    if not share or not high > low:
        return low, high, "neither"
    inner = np.quantile(values, [share, 1 - share])
    if inner[1] - inner[0] > worth * (high - low) or not inner[1] > inner[0]:
        return low, high, "neither"
    reach = 0.05 * (inner[1] - inner[0])  # no further than this beyond the rest
    ends = [inner[0] if low < inner[0] - reach else low,
            inner[1] if high > inner[1] + reach else high]
    return float(ends[0]), float(ends[1]), beyond(ends[0] > low, ends[1] < high)


def beyond(below, above):
    """At which ends of a scale there are values beyond it, as matplotlib says it."""
    return {(True, True): "both", (True, False): "min", (False, True): "max"}.get(
        (bool(below), bool(above)), "neither")


def value_scale(pictures, colormap=THERMAL, n=20, parts=2, clip=None, outliers=0.0, reach=None):
    """The common scale of several pictures; clip: the share of pixels that sets its upper end.

    outliers: the share of pixels at either end that may lie beyond it, such as those of a corner
    where the stress is infinite; reach: (lowest, highest) of all that is drawn, if the pictures are
    not all.
    """
    values = np.concatenate([p[np.isfinite(p)] for p in pictures] or [np.zeros(1)])
    if not len(values):
        values = np.zeros(1)
    low, high, extend = without_outliers(values, outliers)
    if clip is not None:
        low, high = float(values.min()), float(values.max())
        low, top = 0.0, float(np.quantile(values, clip))
        if 0 < top < 0.8 * high:
            high, extend = top, "max"
    levels = nice_levels(low, high, n)
    if reach is not None:
        slack = 1e-6 * (levels[-1] - levels[0])
        extend = beyond(reach[0] < levels[0] - slack, reach[1] > levels[-1] + slack)
    if extend == "neither" and high > levels[-1] + 1e-6 * (levels[-1] - levels[0]):
        extend = "max"
    return Scale(refined(levels, parts), colormap, levels[1:-1], extend)


def fixed_scale(low, high, n=20):
    """The scale of a share: its ends are given, and it has no isolines."""
    return Scale(np.linspace(low, high, n + 1), DAMAGE, [])


def difference_scale(pictures, n=8, clip=0.998):
    """A scale symmetric about zero; single extreme pixels (crack tips) may exceed it."""
    values = np.concatenate([np.abs(p[np.isfinite(p)]) for p in pictures] or [np.zeros(1)])
    top = float(values.max(initial=0))
    bound = float(np.quantile(values, clip)) if len(values) else 0.0
    extend = "neither"
    if top == 0:
        return Scale(np.linspace(-1, 1, 4 * n + 1), DIFFERENCE, [])
    if bound > 0.6 * top or bound == 0:
        bound = top
    levels = nice_levels(-bound, bound, n)
    bound = max(-levels[0], levels[-1])
    step = levels[1] - levels[0]
    levels = np.linspace(-bound, bound, int(round(2 * bound / step)) + 1)
    if top > bound * (1 + 1e-9):
        extend = "both"
    return Scale(refined(levels, 5), DIFFERENCE, [], extend)


INCHES_OF_LETTER = 0.0083  # for each point of its size


def set_title(axes, text, width, size=10, pad=5):
    """A title over axes with so many inches of room: smaller, then on two lines where it has to be."""
    def fits(words, points):
        return max(map(len, words.split("\n"))) * INCHES_OF_LETTER * 1.12 * points <= width
    lines = text.replace(" − ", "\n− ")
    for words, points in ((text, size), (text, 0.85 * size), (lines, size), (lines, 0.85 * size)):
        if fits(words, points):
            break
    axes.set_title(words, loc="left", pad=pad, fontsize=points)


def wrapped(text, inches, size=8.5):
    """A label on lines of so many inches at most, as far as its words allow that."""
    return textwrap.fill(text, max(8, int(inches / (INCHES_OF_LETTER * size))), break_long_words=False)


def figure(width, height):
    """A figure in inches; one inch is 100 pixels of the page."""
    return Figure(figsize=(width, height))


def tidy(axes):
    """The common look of line plots."""
    axes.grid(True, color=GRID, linewidth=0.8)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def name(model):
    """Name of a model or quantity with a capital, for titles."""
    return model[:1].upper() + model[1:]
