#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Check how wide classes are: at most 25 functions, 12 members, 12 virtual functions, defined in at most two sources; and how long functions are: 60 lines.

    check_classes.py          one line for each finding; exit status 1 if there is any
    check_classes.py widest   the widest classes
    check_classes.py entries  what WIDER would have to say

A class that was wider when the limits came is in WIDER with what it has; it may only get narrower, and its entry with it. Likewise LONGER.
Defaulted and deleted functions, types and friends do not count.
"""

import os
import re
import sys

from check_includes import ROOT, files, say

LIMITS = {"functions": 25, "members": 12, "virtual functions": 12, "sources": 2}

# file: {name: (functions, members, virtual functions)}
WIDER = {
    "include/perideal/analysis/quadratic_elements.h": {"QuadraticElements": (22, 15, 0)},
    "include/perideal/analysis/stress_intensity.h": {"CrackEndIntegral": (11, 14, 0)},
    "include/perideal/bonds/stencil_tile.h": {"StencilTile": (0, 19, 0)},
    "include/perideal/mesh/nodes.h": {"Nodes": (32, 14, 0)},
    "include/perideal/operators/coupling/coupling.h": {"Coupling": (22, 2, 16)},
    "include/perideal/operators/coupling/lattice_bonds.h": {"LatticeBonds": (30, 11, 0)},
    "include/perideal/operators/coupling/mesh_exchange.h": {"MeshExchange": (22, 14, 0)},
    "include/perideal/operators/interface/operator.h": {"Operator": (24, 1, 22)},
    "include/perideal/operators/solid/elastic_elements.h": {"ElasticElements": (51, 13, 0)},
    "include/perideal/operators/solid/elastic_operator.h": {"ElasticOperator": (39, 4, 24)},
    "include/perideal/operators/solid/fictitious_images.h": {"FictitiousImages": (21, 13, 0)},
    "include/perideal/operators/solid/solid_operator.h": {"SolidOperator": (44, 14, 9)},
    "include/perideal/operators/solid/state_operator.h": {"StateOperator": (44, 6, 0)},
    "include/perideal/operators/solid/stretch_screen.h": {"StretchScreen": (18, 19, 0)},
    "include/perideal/problems/diffusion_problem.h": {"DiffusionProblem": (38, 10, 0)},
    "include/perideal/problems/solid_problem.h": {"SolidProblem": (44, 15, 0)},
    "include/perideal/scene/material.h": {"Material": (15, 13, 0)},
    "include/perideal/simulation/simulation.h": {"Simulation": (45, 16, 0)},
    "include/perideal/solvers/motion_stepper.h": {"MotionStepper": (29, 17, 4)},
    "source/operators/lattice/state_lattice.h": {"StateLattice": (13, 13, 0)},
    "source/solvers/implicit_stepper.h": {"ImplicitStepper": (19, 19, 2)},
    "source/solvers/rkc2.cc": {"RKC2": (19, 15, 0)},
    "source/study/model_choice.cc": {"Choice": (19, 17, 0)},
}


MAX_FUNCTION = 60

# file: lines of its functions that are longer, the longest first
LONGER = {
    "source/mesh/nodes.cc": [67],
    "source/operators/bounds/local_bound.cc": [67],
    "source/operators/diffusion/heat_surface_factors.cc": [66],
    "source/operators/solid/displacement_conditions.cc": [63],
    "source/operators/solid/elastic_elements.cc": [66],
    "source/operators/solid/least_additions.h": [62],
    "source/problems/bond_solid.cc": [67],
    "source/problems/element_diffusion.cc": [61],
    "source/problems/solid_results.cc": [67],
    "source/scene/domain.cc": [79],
    "source/scene/hole_rims.cc": [78],
    "source/solvers/implicit_stepper.cc": [64],
    "applications/perideal.cc": [62],
}


def long_functions(path):
    """How many lines the bodies of functions have that are too long, as clang-format sets them; the longest first."""
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        lines = file.read().split("\n")
    found = []
    for number, line in enumerate(lines):
        before = lines[number - 1].strip() if number else ""
        is_function = re.search(r"\)( const)?( override)?( noexcept)?$|^[:,] .*[)}]$", before) and not re.match(r"(if|for|while|switch|else)\b", before)
        if line.strip() == "{" and is_function:
            end = next((n for n in range(number + 1, len(lines)) if lines[n] == line.replace("{", "}")), number)
            if end - number - 1 > MAX_FUNCTION:
                found.append(end - number - 1)
    return sorted(found, reverse=True)


def too_long():
    for folder in ("include", "source", "applications"):
        for path in files(folder, (".h", ".cc")):
            found, allowed = long_functions(path), LONGER.get(path, [])
            if len(found) > len(allowed) or any(a > b for a, b in zip(found, allowed)):
                yield f"{path}: functions of {', '.join(map(str, found))} lines; at most {MAX_FUNCTION}" + (f", and those that are longer may only get shorter than {allowed}" if allowed else "")
            elif found != allowed:
                yield f"{path}: its long functions are shorter than LONGER (.ci/check_classes.py) says: " + (f"that is {found} now" if found else "take that out")


def without_comments(text):
    """The text without comments, preprocessor lines, and what stands in strings."""
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    text = re.sub(r"//[^\n]*", "", text)
    text = re.sub(r"^\s*#(?:[^\n]*\\\n)*[^\n]*", "", text, flags=re.M)
    return re.sub(r'"(?:\\.|[^"\\])*"', '""', text)


def end_of_block(text, start):
    """Behind the brace that closes the one before start."""
    depth = 1
    while depth > 0 and start < len(text):
        depth += {"{": 1, "}": -1}.get(text[start], 0)
        start += 1
    return start


def statements(body):
    """What stands in a class, a statement each; bodies of functions and initial values are empty braces."""
    found, current, place = [], "", 0
    while place < len(body):
        character = body[place]
        if character == "{":
            place = end_of_block(body, place + 1)
            current += "{}"
            if not body[place:].lstrip().startswith((";", ",", "{", ")")):  # no initial value, but the body of a function
                found.append(current)
                current = ""
            continue
        if character == ";":
            found.append(current)
            current = ""
        else:
            current += character
        place += 1
    return [" ".join(re.sub(r"\b(?:public|private|protected)\s*:", "", text).split()) for text in found]


def count(body):
    """Functions, members and virtual functions in a class."""
    functions = members = virtual = 0
    for text in statements(body):
        bare = re.sub(r"^template <[^;{]*?> (?=class|struct|[A-Za-z])", "", text)
        if not bare or re.match(r"(using|friend|typedef|enum|class|struct|static_assert|static constexpr)\b", bare):
            continue
        plain = bare
        while re.search(r"<[^<>]*>", plain):
            plain = re.sub(r"<[^<>]*>", "", plain)
        head = plain.split("{")[0].split(" = ")[0]
        if "(" in head or "operator" in head:
            if not re.search(r"= (?:delete|default)$", plain):
                functions += 1
                virtual += bare.startswith("virtual ")
        else:
            members += head.count(",") + 1
    return functions, members, virtual


def classes():
    """(name, path, (functions, members, virtual functions)) of each class, nested ones included."""
    for folder in ("include", "source", "applications"):
        for path in files(folder, (".h", ".cc")):
            with open(os.path.join(ROOT, path), encoding="utf-8") as file:
                text = without_comments(file.read())
            for match in re.finditer(r"(?<!enum )\b(?:class|struct)\s+((?:\w+(?:<[^<>]*>)?::)?\w+)\s*(?:final\s*)?(?::[^{};()]*)?\{", text):
                yield match[1], path, count(text[match.end():end_of_block(text, match.end()) - 1])


def sources_of_classes():
    """{class: sources with functions of it}"""
    found = {}
    for path in files("source", (".cc",)):
        with open(os.path.join(ROOT, path), encoding="utf-8") as file:
            text = without_comments(file.read())
        for match in re.finditer(r"^  (?:[\w:<>,&*]+ )*[&*]?(\w+)(?:<[\w, ]+>)?::~?\w+\(", text, re.M):
            if not match[0].lstrip().startswith(("return", "template", "using", "else")):
                found.setdefault(match[1], set()).add(path)
    return found


def main():
    found = list(classes())
    findings = []
    kinds = list(LIMITS)[:3]
    for name, path, numbers in found:
        allowed = WIDER.get(path, {}).get(name)
        over = any(number > LIMITS[kind] for kind, number in zip(kinds, numbers))
        what = ", ".join(f"{number} {kind}" for kind, number in zip(kinds, numbers))
        if allowed and numbers != allowed:
            narrower = all(a <= b for a, b in zip(numbers, allowed))
            findings.append(f"{path}: {name} has {what}; " + ("it is narrower than its entry in WIDER (.ci/check_classes.py) says: " +
                            (f"that is {numbers} now" if over else "take that out") if narrower else
                            "it is one of those that are too wide, and may only get narrower than " + ", ".join(f"{b} {kind}" for kind, b in zip(kinds, allowed))))
        elif over and not allowed:
            findings.append(f"{path}: {name} has {what}; at most " + ", ".join(f"{LIMITS[kind]} {kind}" for kind in kinds))
    names, there = {name for name, _, _ in found}, {(path, name) for name, path, _ in found}
    wider = {(path, name) for path, classes_there in WIDER.items() for name in classes_there}
    findings += [f".ci/check_classes.py: WIDER has '{name}', which is no class in {path}" for path, name in sorted(wider - there)]
    for name, sources in sorted(sources_of_classes().items()):
        if name in names and len(sources) > LIMITS["sources"]:
            findings.append(f"{name} is defined in {len(sources)} sources ({', '.join(sorted(sources))}); at most {LIMITS['sources']}")
    findings += too_long()
    if sys.argv[1:] == ["widest"]:
        for place, kind in enumerate(kinds):
            print(f"Most {kind}:")
            for name, path, numbers in sorted(found, key=lambda one: -one[2][place])[:10]:
                print(f"  {numbers[place]:4}  {name}  ({path})")
        print(f"{len(found)} classes, of which {len(wider)} are wider than the limits.")
        return 0
    if sys.argv[1:] == ["entries"]:
        by_file = {}
        for name, path, numbers in found:
            if any(number > LIMITS[kind] for kind, number in zip(kinds, numbers)):
                by_file.setdefault(path, {})[name] = numbers
        for path in sorted(by_file):
            print(f'    "{path}": {{' + ", ".join(f'"{name}": {numbers}' for name, numbers in sorted(by_file[path].items())) + "},")
        return 0
    return say(findings, f"{len(found)} classes (.ci/check_classes.py)", f"Widths of classes: {len(found)} in order, {len(wider)} of them wider than the limits, as they were.")


if __name__ == "__main__":
    sys.exit(main())
