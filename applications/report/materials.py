# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The table of materials, of all that the phases of a scene have of their own."""

from html import escape

from style import minus
from tables import cell, table
from words import with_unit

MODULI = ("Bulk modulus", "Shear modulus", "Young modulus", "Poisson ratio")
ORTHOTROPIC = ("Young moduli", "Shear moduli", "Poisson ratios", "Material angle")
OF_USERS = ("User law", "User properties")
ELASTIC = MODULI + ORTHOTROPIC + OF_USERS + ("Density", "Thermal expansion", "Fracture energy", "Critical stretch", "Tensile strength",
                    "Yield stress", "Hardening modulus")
DIFFUSING = {"heat": ("Conductivity", "Density", "Heat capacity"),
             "moisture": ("Conductivity", "Saturated concentration", "Density", "Heat capacity"),
             "electricity": ("Conductivity", "Density", "Heat capacity")}
CALLED = {("moisture", "Conductivity"): "Diffusivity"}
TRIVIAL = {"Density": "1", "Heat capacity": "1", "Thermal expansion": "0", "Saturated concentration": "1", "Hardening modulus": "0", "Material angle": "0"}


def number(text):
    """A number, or None for a formula."""
    try:
        return float(text)
    except (TypeError, ValueError):
        return None


def all_moduli(given):
    """The four moduli that two numbers make; {} unless exactly two are given, as numbers."""
    bulk, shear, young, poisson = (given.get(m) for m in MODULI)
    if sum(v is not None for v in (bulk, shear, young, poisson)) != 2:
        return {}
    try:
        if shear is None:
            if bulk is None:
                shear = young / (2 * (1 + poisson))
            elif young is not None:
                shear = 3 * bulk * young / (9 * bulk - young)
            else:
                shear = 3 * bulk * (1 - 2 * poisson) / (2 * (1 + poisson))
        if young is None:
            young = 2 * shear * (1 + poisson) if poisson is not None else \
                9 * bulk * shear / (3 * bulk + shear)
        if poisson is None:
            poisson = young / (2 * shear) - 1
        if bulk is None:
            bulk = young / (3 * (1 - 2 * poisson)) if poisson != 0.5 else float("inf")
    except ZeroDivisionError:
        return {}
    return {m: float(f"{v:.12g}") for m, v in zip(MODULI, (bulk, shear, young, poisson))}


def of_phases(text):
    """{phase: value} of an entry such as `core: 0.8 ; rim: 2`; separators in parentheses are not."""
    found, depth, part = {}, 0, ""
    for letter in text + ";":
        depth += {"(": 1, ")": -1}.get(letter, 0)
        if letter == ";" and depth == 0:
            if ":" in part:
                phase, value = part.split(":", 1)
                found[phase.strip()] = value.strip()
            part = ""
        else:
            part += letter
    return found


def phases_of_scene(run):
    """{phase: where it is}: of an image its colour; regions hold before them."""
    found = of_phases(run.scene_entry("Material/Phases", "Regions"))
    for phase, about in (run.get("image", "phases", default={}) or {}).items():
        if phase != "void" and phase not in found:
            found[phase] = "image, " + "rgb({}, {}, {})".format(*about["color"])
    return found


def entries_of(run):
    """The entries of the section Material that this run uses."""
    if run.words.elastic:
        return ELASTIC
    found = DIFFUSING.get(run.get("physics", default="heat"), DIFFUSING["heat"])
    if run.scene_entry("Material", "Diffusivity"):  # conductivity and storage follow from it
        return "Diffusivity", "Saturated concentration"
    return tuple(e for e in found if e not in ("Density", "Heat capacity")) if run.get("steady", default=False) else found


def materials(run, entries):
    """[(phase, where, {entry: text})]; the first is that of all that is in no phase, which images leave no place for."""
    base = {n: run.scene_entry("Material", n) for n in entries}
    special = {n: of_phases(run.scene_entry("Material/Phases", n)) for n in entries}
    rows = [] if run.get("image", "phases") else [("", "", base)]
    for phase, where in phases_of_scene(run).items():
        rows.append((phase, where, {n: special[n].get(phase, base[n]) for n in base}))
    return rows


def entries_as_cells(values, entries):
    """Numbers and formulas of one phase; those that follow from two moduli are italic."""
    given = {m: number(values[m]) for m in MODULI if values.get(m)}
    derived = all_moduli(given) if all(v is not None for v in given.values()) else {}
    cells = []
    for title in entries:
        text, value = values[title], number(values[title])
        if text:
            cells.append(cell(value, 6) if value is not None else escape(minus(text)))
        else:
            cells.append(f"<em>{cell(derived[title], 6)}</em>" if title in derived else "")
    return cells


def material_table(run):
    """What each phase is made of; empty where nothing is given."""
    entries = entries_of(run)
    rows = materials(run, entries)
    decisive = MODULI + ORTHOTROPIC[:1] + OF_USERS[:1] if run.words.elastic else entries[:1]
    if not any(values.get(m) for _, _, values in rows for m in decisive):
        return ""
    columns = [entries_as_cells(values, entries) for _, _, values in rows]
    shown = [escape(phase) if phase else "all else" if len(rows) > 1 else "Value" for phase, _, _ in rows]
    physics, lines = run.get("physics", default="heat"), []
    for i, title in enumerate(entries):
        trivial = title in TRIVIAL and all(c[i] == TRIVIAL[title] for c in columns)
        if any(c[i] for c in columns) and not trivial:
            called = CALLED.get((physics, title), title)
            lines.append([escape(with_unit(called, run.words.units.of_material(title)))] + [c[i] for c in columns])
    if any(w for _, w, _ in rows):
        lines.append(["Where"] + ["" if not w else escape(minus(w)) for _, w, _ in rows])
    return table(["Material"] + shown, lines, "numbers")
