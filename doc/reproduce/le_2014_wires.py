# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Le (2014), chapter 3: wires of Bi2212 in silver, read from images."""

import figures
from lines import Line, Picture, Table
from results import FEM, PD

KINDS = ("void", "soft", "hard")
PHASES = ("bi2212", "silver")
FAMILIES = {
    "length": ("Fig. 3.10: length of a slit from one side", "length (pixels)", {n: f"length_{n:02}" for n in (7, 13, 20, 31)}),
    "width": ("Fig. 3.12: width of a slit through the filament", "width (pixels)", {n: f"width_{n:02}" for n in (3, 10, 20)}),
    "slanted": ("Fig. 3.14: width of a slit at 45 degrees", "width (pixels)", {n: f"slanted_{n:02}" for n in (5, 10, 20)}),
    "diameter": ("Fig. 3.16: diameter of a round defect", "diameter (pixels)", {n: f"circle_{n:02}" for n in (6, 12, 18, 40)}),
    "aspect": ("Fig. 3.17: height over width, same area", "height over width", {0.25: "aspect_5_20", 1.0: "aspect_10_10", 4.0: "aspect_20_5"}),
}
NAMES = {"bi2212": "Bi2212", "silver": "silver"}


def strain_of(row, model=PD):
    return row.model(model)["mean stress"]["xx"]


def stress(row, phase, what="maximum", model=PD):
    return row.model(model)["phases"][phase]["von mises"][what]


def numbers(row, model=PD):
    """Macroscopic stress, and the largest von Mises stress of both phases."""
    return [strain_of(row, model)] + [stress(row, phase, model=model) for phase in PHASES]


def wire_line(what, name, published=None, model=PD):
    return Line(what, name, lambda study: numbers(study[name], model), published)


def family_lines(key):
    lines = []
    for size, image in FAMILIES[key][2].items():
        lines += [wire_line(f"{kind}, {size:g}", f"{kind}_{image}") for kind in KINDS]
    return lines


def draw_families(study, path):
    """One panel for each family: the largest stresses over the size, of voids in both phases, of soft and hard defects in Bi2212."""
    sound = {phase: stress(study["wire_longitudinal"], phase) for phase in PHASES}
    for key, (title, label, sizes) in FAMILIES.items():
        lines = []
        for kind, phase in (("void", "bi2212"), ("void", "silver"), ("soft", "bi2212"), ("hard", "bi2212")):
            start = [(0.0, sound[phase])] if key in ("length", "diameter") else []
            points = start + [(size, stress(study[f"{kind}_{image}"], phase)) for size, image in sizes.items()]
            lines.append((f"{kind}: {NAMES[phase]}", [p[0] for p in points], [p[1] for p in points]))
        figures.curves(path.with_name(f"le_2014_{key}.png"), [(title, lines, None)], label, "largest von Mises stress (MPa)",
                       log_x=2 if key == "aspect" else None, size=(3.6, 2.5))


def tables(published):
    """Those of chapter 3."""
    given = published["Chapter 3"]
    columns = ["macroscopic stress", "largest von Mises stress in Bi2212", "in silver"]
    sound = [wire_line("a single filament", "wire_single_filament", given["single filament"]), wire_line("several filaments", "wire_longitudinal", given["several filaments"]),
             wire_line("the same, finite elements", "wire_longitudinal", model=FEM), wire_line("cross section with bridges", "wire_cross_section", given["cross section"])]
    natural = [wire_line(f"one {kind} defect", f"{kind}_irregular", given["void"] if kind == "void" else None) for kind in KINDS]
    natural += [wire_line(f"several {kind} defects", f"{kind}_several") for kind in KINDS]
    natural += [wire_line("one void, finite elements", "void_irregular", model=FEM), wire_line("filament detached", "void_delamination")]
    grids = [wire_line(what, name) for what, name in (("two pixels", "grid_double"), ("a pixel", "wire_longitudinal"), ("half a pixel", "grid_half"))]
    text = ("In MPa, at 0.1 % strain. The images are ours, drawn with the thesis' sizes; its own are not published, so that trends are to be compared and not numbers. ")
    result = [
        Table("sound", "Figs. 3.5 and 3.6: wires without defects", text, columns, sound, digits=3),
        Table("natural", "Figs. 3.7, 3.8 and 3.18: irregular defects, and a filament that has come off", text, columns, natural, digits=3,
              after="As in the thesis a void is far worse than a soft or a hard defect of the same shape, and four defects are hardly worse than one: silver keeps filaments apart."),
        Table("grid", "Fig. 3.4: edge of a cell", text + "The horizon is five cells.", columns, grids, kind="picture", digits=3,
              after="Half a pixel keeps the corners of the pixels and sees them more sharply: maxima grow, means do not.")]
    for key, (title, _, _) in FAMILIES.items():
        result.append(Table(key, title, "Pictures; in MPa.", columns, family_lines(key), kind="picture", digits=3))
    return result


def pictures():
    needs = ["wire_longitudinal"] + [f"{kind}_{image}" for _, _, sizes in FAMILIES.values() for image in sizes.values() for kind in KINDS]
    keys = list(FAMILIES)
    return [Picture(f"le_2014_{keys[0]}", FAMILIES[keys[0]][0] + ".", needs, draw_families)] + [Picture(f"le_2014_{k}", FAMILIES[k][0] + ".", [], None) for k in keys[1:]]
