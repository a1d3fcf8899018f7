# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""A small sketch of the problem: the body, what holds on its sides, its cracks, line and probes."""

import numpy as np
from matplotlib import image
from matplotlib.collections import LineCollection
from matplotlib.patches import Rectangle

import contours
import solids
import style
import supports
from raster import boundary_lines

KIND_COLOR = (("dirichlet", "#c0392b"), ("flux", "#d98200"), ("convection", "#00897b"),
              ("u = ", supports.DISPLACEMENT), ("velocity", supports.DISPLACEMENT), ("t = ", supports.TRACTION),
              ("symmetry", supports.SYMMETRY), ("temperature", "#00897b"))
OTHER = "#8e44ad"  # kinds that have no colour of their own
CLOSED = "#7b8794"
CLOSED_WORDS = ("", "insulated", "sealed", "free")
BODY = "#eef2f6"
BOX_SIDES = {"bottom": ((0, 0), (1, 0)), "top": ((0, 1), (1, 1)), "left": ((0, 0), (0, 1)),
             "right": ((1, 0), (1, 1))}
# Where a side's text stands: x, y, alignments, rotation.
LABELS = {"bottom": (0.5, -0.055, "center", "top", 0), "top": (0.5, 1.04, "center", "bottom", 0),
          "left": (-0.045, 0.5, "right", "center", 90),
          "right": (1.045, 0.5, "left", "center", 90)}


def side_color(text):
    """Colour of a boundary condition by its kind."""
    lowered = text.lower()
    return next((color for kind, color in KIND_COLOR if kind in lowered), CLOSED if lowered in CLOSED_WORDS else OTHER)


def shorten(text, length=30):
    """Long expressions are cut; the table of sides has them in full."""
    return text if len(text) <= length else text[:length - 1] + "…"


def draw_material(axes, maps):
    """Where the body is: its cells, so that holes and outlines show. Whether it fills its box, and its outline if it does not."""
    run = maps.run
    if not run.summary["fields"]:
        return False, None
    for model in run.models:
        if run.field_file(0, model) is None:
            continue
        if draw_image(axes, run):
            return True, None
        view = maps.view()
        nodes = run.mesh(0, model).nodes
        picture = maps.picture(0, model, np.ones(len(nodes)), contours.segments_of(run.cracks(0)))
        inside = np.isfinite(picture)
        shades = np.zeros(picture.shape + (4,))
        shades[inside] = (0.933, 0.949, 0.965, 1)
        axes.imshow(shades, origin="lower", extent=view.extent, aspect="equal", zorder=1)
        if inside.all():
            return True, None
        outline = boundary_lines(run.mesh(0, model))
        draw_outline(axes, outline)
        return False, outline
    return True, None


def draw_image(axes, run):
    """The phases of a body from an image in paler colours; False where there is no image."""
    path = run.directory / "image_as_read.png"
    if not run.get("image", "phases") or not path.is_file():
        return False
    lower, upper = run.domain
    pixels = np.array(image.imread(str(path)), float)[:, :, :4]
    pixels[:, :, :3] = 1 - 0.55 * (1 - pixels[:, :, :3])
    axes.imshow(pixels, origin="upper", extent=(lower[0], upper[0], lower[1], upper[1]), aspect="equal",
                interpolation="nearest", zorder=1)
    return True


def legend_of_phases(figure, run, size):
    """The colours of the phases of an image in a row at the foot."""
    phases = run.get("image", "phases", default={}) or {}
    x = 0.95
    for phase, about in list(phases.items())[:4]:
        shade = [1 - 0.55 * (1 - c / 255) for c in about["color"]]
        figure.add_artist(Rectangle((x / size[0], 0.34 / size[1]), 0.14 / size[0], 0.1 / size[1], facecolor=shade,
                                    edgecolor="#52606d", linewidth=0.5))
        text = figure.text((x + 0.2) / size[0], 0.32 / size[1], shorten(phase, 14), fontsize=8, color="#52606d", va="bottom")
        x += 0.35 + 0.075 * len(text.get_text())


def draw_outline(axes, outline):
    """The edge of the body."""
    axes.add_collection(LineCollection(outline, colors="#52606d", linewidths=1.0, clip_on=False, zorder=2,
                                       capstyle="round"))


def draw_places(axes, run, inch, elastic):
    """Parts of sides, regions and points, and the sides of a mesh from a file, in the colours of what holds there."""
    sides, middle, below = run.sides(brief=True), np.array(run.domain).mean(axis=0), False
    for side, place in run.get("places", default={}).items():
        color = side_color(sides.get(side, ""))
        lines = np.array(place.get("lines", []), float).reshape(-1, 2, 2)
        points = np.array(place.get("at", []), float).reshape(-1, 2)
        if not len(points):
            continue
        if len(lines):
            axes.add_collection(LineCollection(lines, colors=color, linewidths=1.4 if color == CLOSED else 3.2,
                                               clip_on=False, zorder=3.5, capstyle="butt"))
        else:
            axes.plot(*points.T, linestyle="none", marker="x" if place["kind"] == "point" else ".", markersize=5, color=color,
                      clip_on=False, zorder=6)
        if elastic:
            supports.draw_place(axes, run, side, inch)
        normals = np.array(place.get("normals", []), float).reshape(-1, 2)
        k = len(points) // 2
        if len(normals) and run.get("domain", "shape") != "mesh file":  # outside are the names of whole sides
            name_place(axes, points[k] - normals[k] * inch * 0.1, -normals[k], side, color)
        elif len(normals):
            far = elastic and supports.longest_of(run, side) > 0
            name_place(axes, points[k] + normals[k] * inch * (0.45 if far else 0.22), normals[k], side, color)
        else:  # by turns above and below, so that those of neighbours do not meet
            below = not below
            away = np.array([0.0, -1.0 if below else 1.0])
            name_place(axes, points[k] + away * inch * 0.14, away, side, color, "right" if points[k][0] > middle[0] else "left")


def name_place(axes, at, away, side, color, horizontal=None):
    """The name of a part or side at a point, on that side of it."""
    axes.text(*at, shorten(side, 16), fontsize=8, color=color, clip_on=False, zorder=8,
              ha=horizontal or ("center" if abs(away[0]) < 0.5 else "left" if away[0] > 0 else "right"),
              va="center" if abs(away[1]) < 0.5 else "bottom" if away[1] > 0 else "top")


def draw_points(axes, run):
    """The line and the probes."""
    for model in run.line.data.values():
        points = next(iter(model.values()))[0]
        axes.plot(points[[0, -1], 0], points[[0, -1], 1], color="#0072b2", linewidth=1.1,
                  linestyle=(0, (4, 2.5)), zorder=4)
        break
    for model in run.probes.data.values():
        points = next(iter(model.values()))[0]
        axes.plot(points[:, 0], points[:, 1], linestyle="none", marker="o", markersize=4.5,
                  color="#0072b2", markeredgecolor="white", zorder=6)
        break


def parts_of_side(line, outline):
    """The lines of an outline that lie on a straight side; the whole side without an outline."""
    if not outline:
        return [line]
    across, size = int(line[0][0] != line[1][0]), max(np.abs(line).max(), 1e-300)
    pairs = [np.stack([part[:-1], part[1:]], axis=1) for part in outline]
    pairs = np.concatenate(pairs)
    return list(pairs[(np.abs(pairs[:, :, across] - line[0][across]) < 1e-6 * size).all(axis=1)])


def draw_sides(axes, sides, lower, extent, width, height, room=None, outline=None):
    """The sides of a rectangle of so many inches in the colours of what holds there.

    room: inches by which the text of a side is moved outwards; outline: of a body that does not fill the rectangle.
    """
    for side, ends in BOX_SIDES.items():
        if side not in sides:
            continue
        color = side_color(sides[side])
        line = lower + np.array(ends) * extent
        closed = color == CLOSED
        axes.add_collection(LineCollection(parts_of_side(line, outline), colors=color, linewidths=1.4 if closed else 3.2,
                                           capstyle="butt", clip_on=False, zorder=3))
        x, y, horizontal, vertical, turn = LABELS[side]
        away = (room or {}).get(side, 0.0)
        x += {"left": -away, "right": away}.get(side, 0.0) / width
        y += {"bottom": -away, "top": away}.get(side, 0.0) / height
        condition = style.minus(sides[side])
        text = shorten(f"{side}: {condition}", int(width / 0.068) + 14)
        if turn and len(f"{side}: {condition}") * 0.068 > height:
            turn, text = 0, f"{side}:\n" + shorten(condition, 11)
        axes.text(x, y, text,
                  transform=axes.transAxes, rotation=turn, color=color, fontsize=8,
                  ha=horizontal, va=vertical)


def sketch_2d(maps, words):
    """The rectangle with its four sides, or the outline of any other mesh."""
    run = maps.run
    lower, upper = run.domain
    extent = upper - lower
    width = 3.1 if extent[0] >= extent[1] else max(1.0, 3.1 * extent[0] / extent[1])
    height = min(width * extent[1] / extent[0], 3.4)
    height = max(height, 0.35)
    room = supports.room(run) if words.elastic else dict.fromkeys(BOX_SIDES, 0.0)
    if run.get("places") and run.get("domain", "shape") == "mesh file":
        room = {side: max(inches, 0.25) for side, inches in room.items()}  # for their names
    foot = 0.72 + 0.25 * bool(run.get("image", "phases"))  # with the legend of phases
    size = (width + 1.9 + room["left"] + room["right"],
            height + 0.53 + foot + room["bottom"] + room["top"])
    figure = style.figure(*size)
    axes = figure.add_axes([(0.95 + room["left"]) / size[0], (foot + room["bottom"]) / size[1],
                            width / size[0], height / size[1]])
    full, outline = draw_material(axes, maps)
    sides = {side: text for side, text in run.sides(brief=True).items() if supports.is_side_of_box(run, side)}
    draw_sides(axes, sides, lower, extent, width, height, room, outline)
    if words.elastic:
        supports.draw_2d(axes, run, lower, extent, extent[0] / width,
                         {s: BOX_SIDES[s] for s in BOX_SIDES if s in sides})
    if not any(side in sides for side in BOX_SIDES) and full:
        axes.plot(*(lower + np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)]) * extent).T,
                  color="#52606d", linewidth=1.2, clip_on=False)
    draw_places(axes, run, extent[0] / width, words.elastic)
    contours.draw_cracks(axes, contours.segments_of(run.cracks()), 1.8)
    draw_points(axes, run)
    legend_of_phases(figure, run, size)
    finish_2d(axes, lower, upper, words, size)
    return figure


def finish_2d(axes, lower, upper, words, size):
    """Extents instead of axes."""
    axes.set_xlim(lower[0], upper[0])
    axes.set_ylim(lower[1], upper[1])
    for spine in axes.spines.values():
        spine.set_visible(False)
    axes.set_xticks([])
    axes.set_yticks([])
    text = ",   ".join(f"${'xyz'[d]}$ = {style.plain(lower[d])} … {style.plain(upper[d])}"
                     for d in range(len(lower)))
    axes.figure.text(0.95 / size[0], 0.12 / size[1], f"{text} {words.length}", fontsize=8,
                     color="#52606d", ha="left", va="bottom")


def sketch_1d(run, words):
    """A bar with its two ends."""
    lower, upper = run.domain
    figure = style.figure(4.8, 1.5)
    left, width = (0.14, 0.72) if words.elastic else (0.06, 0.88)
    axes = figure.add_axes([left, 0.42, width, 0.2])
    axes.axvspan(lower[0], upper[0], color=BODY)
    sides = run.sides(brief=True)
    for side, x, align in (("left", lower[0], "left"), ("right", upper[0], "right")):
        text = style.minus(sides.get(side, ""))
        color = side_color(text)
        axes.plot([x, x], [0, 1], color=color, linewidth=4, clip_on=False, solid_capstyle="butt")
        fraction = 0.0 if align == "left" else 1.0
        axes.text(fraction, 1.25, shorten(text, 26), transform=axes.transAxes, color=color,
                  fontsize=8.5, ha=align, va="bottom")
        axes.text(fraction, -0.25, f"{'x = ' if align == 'left' else ''}{style.plain(x)} "
                  f"{words.length}", transform=axes.transAxes, color="#52606d", fontsize=8,
                  ha=align, va="top")
    for crack in run.cracks():
        axes.axvline(crack[:, 0].mean(), color="black", linewidth=2)
    if words.elastic:
        supports.draw_1d(axes, run, (upper[0] - lower[0]) / (4.8 * 0.72))
    axes.set_xlim(lower[0], upper[0])
    axes.set_ylim(0, 1)
    axes.axis("off")
    return figure


def sketch_3d(run, words):
    """An isometric box with its cracks; the sides are named beside it."""
    lower, upper = run.domain
    figure = style.figure(4.8, 3.5)
    axes = figure.add_axes([0.0, 0.0, 0.62, 1.0])
    corners = {(i, j, k): solids.project([(lower, upper)[i][0], (lower, upper)[j][1],
                                          (lower, upper)[k][2]])
               for i in (0, 1) for j in (0, 1) for k in (0, 1)}
    sides = run.sides(brief=True)
    faces = {"top": [(0, 1, 0), (1, 1, 0), (1, 1, 1), (0, 1, 1)],
             "front": [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
             "right": [(1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)]}
    for face in faces.values():
        points = np.array([corners[c] for c in face])
        axes.fill(points[:, 0], points[:, 1], facecolor=BODY, edgecolor="#52606d", linewidth=1.0)
    for c in ((1, 0, 0), (0, 1, 0), (0, 0, 1)):
        points = np.array([corners[0, 0, 0], corners[c]])
        axes.plot(points[:, 0], points[:, 1], color="#9aa5b1", linewidth=0.8,
                  linestyle=(0, (3, 3)))
    for polygon in run.cracks():
        if len(polygon) >= 3:
            points = solids.project(polygon)
            axes.fill(points[:, 0], points[:, 1], facecolor="#1f293355", edgecolor="black",
                      linewidth=1.3)
    solids.label_body(axes, lower, upper, words)
    solids.frame_body(axes, lower, upper)
    if words.elastic:
        axes.apply_aspect()
        supports.draw_3d(axes, run, np.ptp(axes.get_xlim()) / (4.8 * 0.62))
    for side, place in run.get("places", default={}).items():
        if place["kind"] == "point":
            color, at = side_color(sides.get(side, "")), solids.project(np.array(place["at"][0], float))
            axes.plot(*at, marker="x", markersize=5, color=color, clip_on=False, zorder=8)
            axes.annotate(shorten(side, 12), at, (3, 3), textcoords="offset points", fontsize=8, color=color, zorder=8)
    names = ("left", "right", "bottom", "top", "back", "front")
    listed = [(n, style.minus(sides[n])) for n in names if n in sides]
    listed += [(n, style.minus(text)) for n, text in sides.items() if n not in names]
    step = min(0.1, 0.75 / max(len(listed), 1))
    for i, (side, text) in enumerate(listed[:14]):
        figure.text(0.63, 0.80 - step * i, f"{side}: {shorten(text, 20)}", fontsize=8,
                    color=side_color(text))
    return figure


def problem_sketch(maps, words):
    """The sketch of a run of any dimension."""
    if maps.run.dimension == 1:
        return sketch_1d(maps.run, words)
    if maps.run.dimension == 2:
        return sketch_2d(maps, words)
    return sketch_3d(maps.run, words)
