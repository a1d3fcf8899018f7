#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Say how the house stands: its largest classes, comparisons of enumerations, words of physics where none belong.

    .ci/house.py [N]      the N largest classes (10)

Members and methods are counted in the class's own braces, sources are the files that define a method of it. Prints, never fails.
"""

import glob
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

# Rooms that are to know neither which physics nor which model they serve.
WITHOUT_PHYSICS = ("source/simulation", "include/perideal/simulation", "source/output", "include/perideal/output")
PHYSICS = re.compile(r"Physics::|heat|thermal|elastic|displacement|temperature|moisture", re.I)
COMPARISON = re.compile(r"[=!]=\s*([A-Z]\w+)::[a-z]\w*|\bcase\s+([A-Z]\w+)::")


def code_of(path):
    """The text of a file without comments; strings stay."""
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        text = re.sub(r"/\*.*?\*/", lambda m: "\n" * m.group().count("\n"), file.read(), flags=re.S)
    return re.sub(r"//[^\n]*", "", text)


def files(*patterns):
    found = [path for pattern in patterns for path in glob.glob(os.path.join(ROOT, pattern), recursive=True)]
    return sorted(os.path.relpath(path, ROOT) for path in found)


def closing(text, at):
    """Where the brace at a place is closed."""
    depth = 0
    for k in range(at, len(text)):
        depth += (text[k] == "{") - (text[k] == "}")
        if depth == 0:
            return k
    return len(text)


def outer(body):
    """A class's declarations, what is in braces of its own left out (those of default arguments are not)."""
    kept, depth, brackets = [], 0, 0
    for char in body:
        brackets += 0 if depth else (char == "(") - (char == ")")
        if brackets:
            kept.append(char)
            continue
        depth += char == "{"
        if depth == 0:
            kept.append(char)
        elif char == "}":
            depth -= 1
            kept.append(";" if depth == 0 else "")
    return "".join(kept).split(";")


def without_template_arguments(text):
    while True:
        shorter = re.sub(r"<[^<>]*>", "", text)
        if shorter == text:
            return text
        text = shorter


def count(body):
    """(data members, methods) of a class."""
    n_members = n_methods = 0
    for statement in outer(body):
        statement = " ".join(re.sub(r"\b(public|private|protected)\s*:", "", statement).split())
        if not statement or re.match(r"(using|friend|typedef|enum|struct|class|static constexpr)\b", statement):
            continue
        bare = without_template_arguments(statement)
        if "(" in bare.replace("operator=", "").split("=")[0]:
            n_methods += 1
        else:
            n_members += 1 + re.sub(r"=[^,]*", "", bare).count(",")
    return n_members, n_methods


def largest_classes():
    sources = {path: code_of(path) for path in files("source/**/*.cc")}
    rows = []
    for path in files("include/**/*.h", "source/**/*.h"):
        text = code_of(path)
        for match in re.finditer(r"\b(?:class|struct)\s+(?:\w+::)?(\w+)(?:\s*:\s*[^{;]*)?\s*\{", text):
            name = match.group(1)
            n_members, n_methods = count(text[match.end():closing(text, match.end() - 1)])
            defined = re.compile(rf"^  (?! |template ).*\b{name}(?:<[\w, ]+>)?::~?\w+\s*\(", re.M)
            inside = [s for s, code in sources.items() if defined.search(code)]
            rows.append((n_members + n_methods, name, n_members, n_methods, len(inside), sum(sources[s].count("\n") for s in inside)))
    return sorted(rows, reverse=True)


def comparisons():
    """{room: {enumeration: number}} of the sources."""
    found = {}
    enumerations = {name for path in files("source/**/*.cc", "source/**/*.h", "include/**/*.h") for name in re.findall(r"\benum(?: class)? (\w+)", code_of(path))}
    for path in files("source/**/*.cc", "source/**/*.h"):
        room = found.setdefault(path.split("/")[1], {})
        for match in COMPARISON.finditer(code_of(path)):
            name = match.group(1) or match.group(2)
            if name in enumerations:
                room[name] = room.get(name, 0) + 1
    return found


def main():
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 10
    print(f"{'class':28} members methods sources lines of these")
    for _, name, n_members, n_methods, n_sources, n_lines in largest_classes()[:n]:
        print(f"{name:28} {n_members:7} {n_methods:7} {n_sources:7} {n_lines:14}")
    print("\ncomparisons of enumerations")
    for room, names in sorted(comparisons().items(), key=lambda item: -sum(item[1].values())):
        most = ", ".join(f"{name} {k}" for name, k in sorted(names.items(), key=lambda item: -item[1])[:6])
        if names:
            print(f"{room:12} {sum(names.values()):4}   {most}")
    print("\nlines with words of a physics")
    for room in WITHOUT_PHYSICS:
        lines = [line for path in files(f"{room}/**/*.cc", f"{room}/**/*.h") for line in code_of(path).split("\n") if PHYSICS.search(line)]
        print(f"{room:28} {len(lines):5}")
    total = sum(open(os.path.join(ROOT, path), encoding="utf-8").read().count("\n") for path in files("source/**/*.cc", "source/**/*.h", "include/**/*.h"))
    print(f"\nlines of source and include {total}")


if __name__ == "__main__":
    main()
