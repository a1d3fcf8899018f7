#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Check the order of the house: who includes whom, who knows no physics, how long files and comments are, and that each file names its licence.

Prints one line for each finding and ends with exit status 1 if there is any.
"""

import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

# From the bottom up. A room may include itself and the rooms of lower storeys; rooms of one storey
# do not know each other. A floor is a folder that holds rooms in place of files.
STOREYS = [["base"], ["scene"], ["mesh", "laws"], ["bonds"],
           ["operators/interface"], ["operators/bounds"], ["operators/parts"], ["operators/lattice"], ["operators/coupling"],
           ["operators/diffusion", "operators/solid"],
           ["solvers", "analysis"], ["output"], ["problems"], ["simulation"], ["study"]]
FLOORS = {room.split("/")[0] for rooms in STOREYS for room in rooms if "/" in room}
STOREY = {room: number for number, rooms in enumerate(STOREYS) for room in rooms}

MAX_HEADER, MAX_SOURCE = 300, 850
MAX_COMMENT = 100
LICENCE = "SPDX-License-Identifier: LGPL-2.1-or-later"
COPYRIGHT = "Copyright (C) 2026 the PeriDeal authors"

# Laws are functions of numbers: no mesh, no processes, no parameters.
LAWS_DEAL_II = {"deal.II/base/point.h", "deal.II/base/tensor.h", "deal.II/base/symmetric_tensor.h",
                "deal.II/base/exceptions.h", "deal.II/base/numbers.h"}

# Rooms that are to know neither which physics they serve nor its words: identifiers and strings, comments apart.
WITHOUT_PHYSICS = ("simulation", "output")
PHYSICS = re.compile(r"Physics::|heat|thermal|elastic|displacement|temperature|moisture|electric", re.I)

# The start of a comment, or a string, in which there is none.
COMMENT = re.compile(r"""//|/\*|"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])+'""")

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def files(folder, endings):
    for path, folders, names in os.walk(os.path.join(ROOT, folder)):
        folders[:] = sorted(f for f in folders if f not in ("build", "__pycache__"))
        for name in sorted(names):
            if name.endswith(endings):
                yield os.path.relpath(os.path.join(path, name), ROOT)


def room_of(path):
    for start in ("include/perideal/", "source/"):
        if path.startswith(start):
            folders = path[len(start):].split("/")[:-1]
            return "/".join(folders[:2] if folders[:1] and folders[0] in FLOORS else folders[:1])
    return None


def check_direction(where, room, path):
    other = room_of(path)
    if room and other in STOREY and other != room and STOREY[other] >= STOREY[room]:
        yield f"{where}: {room} must not include {other} ({path}): it stands above or beside it"


def check_includes(path, lines):
    room = room_of(path)
    for number, line in enumerate(lines, 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        bracket, name = match.groups()
        where = f"{path}:{number}"
        if bracket == '"' and path.startswith("include/"):
            yield f"{where}: include \"{name}\" as <perideal/room/file.h>"
        if name.startswith("perideal/"):
            if not os.path.isfile(os.path.join(ROOT, "include", name)):
                yield f"{where}: there is no include/{name}"
                continue
            yield from check_direction(where, room, os.path.join("include", name))
        elif bracket == '"' and room:
            yield from check_direction(where, room, os.path.normpath(os.path.join(os.path.dirname(path), name)))
        if room == "laws" and name.startswith("deal.II/") and name not in LAWS_DEAL_II:
            yield f"{where}: laws are functions of numbers and include no <{name}>"


def check_source(path, lines):
    header = path.endswith(".h")
    head = "\n".join(lines[:4])
    if LICENCE not in head or COPYRIGHT not in head:
        yield f"{path}: the licence header is missing:\n  {LICENCE}\n  {COPYRIGHT}"
    limit = MAX_HEADER if header else MAX_SOURCE
    if len(lines) > limit and path.endswith((".h", ".cc")):
        yield f"{path}: {len(lines)} lines; headers have at most {MAX_HEADER}, other sources {MAX_SOURCE}"
    if not header:
        return
    if "#pragma once" not in lines and path != "cmake/precompiled.h":
        yield f"{path}: #pragma once is missing"
    for number, line in enumerate(lines, 1):
        if re.match(r"\s*using\s+namespace\b", line):
            yield f"{path}:{number}: no 'using namespace' in a header"


def check_comments(path, lines):
    """No comment passes the last column, on a line of its own or behind code."""
    in_block = False
    for number, line in enumerate(lines, 1):
        place, has_comment = 0, in_block
        while True:
            if in_block:
                end = line.find("*/", place)
                if end < 0:
                    break
                place, in_block = end + 2, False
            match = COMMENT.search(line, place)
            if not match:
                break
            place = match.end()
            has_comment = has_comment or match[0] in ("//", "/*")
            in_block = match[0] == "/*"
            if match[0] == "//":
                break
        if has_comment and len(line) > MAX_COMMENT:
            yield f"{path}:{number}: the comment ends at column {len(line)}; at most {MAX_COMMENT}"


def check_words(path, lines):
    """Rooms without physics name none."""
    if room_of(path) not in WITHOUT_PHYSICS:
        return
    text = re.sub(r"/\*.*?\*/", lambda match: "\n" * match.group().count("\n"), "\n".join(lines), flags=re.S)
    for number, line in enumerate(text.split("\n"), 1):
        found = PHYSICS.search(re.sub(r"//.*", "", line))
        if found:
            yield f"{path}:{number}: '{found.group()}' is a word of a physics, which {room_of(path)} must not know"


def check_room(path):
    room = room_of(path)
    if room is not None and room not in STOREY:
        yield f"{path}: '{room or 'no folder'}' is not a room; there are {', '.join(STOREY)}"


def check_lists():
    """Every source is in the list that builds it."""
    for list_file, folder in (("source/CMakeLists.txt", "source"), ("tests/unit/CMakeLists.txt", "tests/unit")):
        path = os.path.join(ROOT, list_file)
        if not os.path.isfile(path):
            continue
        with open(path) as file:
            words = set(re.findall(r"[\w./]+\.cc", file.read()))
        found = {os.path.relpath(name, folder) for name in files(folder, (".cc",))}
        for name in sorted(found - words):
            yield f"{list_file}: {name} is not in the list"
        for name in sorted(words - found):
            yield f"{list_file}: {name} does not exist"


def say(findings, where, in_order):
    """Print what was found, or that all is in order; the exit status."""
    for finding in findings:
        print(finding)
    print(f"{len(findings)} findings in {where}." if findings else in_order)
    return 1 if findings else 0


def main():
    findings = []
    n_files = 0
    for folder in ("include", "source", "applications", "python", "tests", "cmake"):
        for path in files(folder, (".h", ".cc", ".py", ".cmake", "CMakeLists.txt")):
            n_files += 1
            with open(os.path.join(ROOT, path), encoding="utf-8") as file:
                lines = file.read().splitlines()
            findings += check_source(path, lines)
            if path.endswith((".h", ".cc")):
                room_findings = list(check_room(path))
                findings += room_findings or check_includes(path, lines)
                findings += check_comments(path, lines)
                findings += check_words(path, lines)
    findings += check_lists()
    return say(findings, f"{n_files} files (.ci/check_includes.py)", f"Include directions, words, lengths, comments and licence headers: {n_files} files in order.")


if __name__ == "__main__":
    sys.exit(main())
