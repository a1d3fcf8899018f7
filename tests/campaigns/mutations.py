# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Scenes made small, and scenes made wrong.

A scene is kept as a list of lines, each ("set", entry, value), ("subsection", name), ("end",) or ("text", line).
"""

import os
import re

SET = re.compile(r"^\s*set\s+(.*?)\s*=\s*(.*?)\s*$")
SUBSECTION = re.compile(r"^\s*subsection\s+(.*?)\s*$")


def read_lines(path):
    """The lines of a scene without its comments; continued lines joined."""
    with open(path) as file:
        text = file.read().replace("\\\n", " ")
    lines = []
    for line in text.splitlines():
        line = line.split("#", 1)[0].rstrip()
        if not line.strip():
            continue
        if SET.match(line):
            lines.append(("set", *SET.match(line).groups()))
        elif SUBSECTION.match(line):
            lines.append(("subsection", SUBSECTION.match(line).group(1)))
        elif line.strip() == "end":
            lines.append(("end",))
        else:
            lines.append(("text", line))
    return lines


def write_lines(lines):
    words = {"set": lambda line: f"set {line[1]} = {line[2]}", "subsection": lambda line: f"subsection {line[1]}",
             "end": lambda line: "end", "text": lambda line: line[1]}
    return "\n".join(words[line[0]](line) for line in lines) + "\n"


def sections(lines, kind="set"):
    """(number of the line, section) of every entry, or of every line that opens a subsection."""
    path = []
    for number, line in enumerate(lines):
        if line[0] == "subsection":
            path.append(line[1])
        elif line[0] == "end" and path:
            path.pop()
        if line[0] == kind:
            yield number, "/".join(path)


def find(lines, section, entry):
    for number, where in sections(lines):
        if where == section and lines[number][1] == entry:
            return number
    return None


def value_of(lines, section, entry, default=None):
    number = find(lines, section, entry)
    return default if number is None else lines[number][2]


def set_value(lines, section, entry, value):
    """Change an entry, or add it to its section, which is added where it is missing."""
    number = find(lines, section, entry)
    line = ("set", entry, value)
    if number is not None:
        lines[number] = line
        return
    if not section:
        lines.insert(0, line)
        return
    for number, where in sections(lines, "subsection"):
        if where == section:
            lines.insert(number + 1, line)
            return
    names = section.split("/")
    lines += [("subsection", name) for name in names] + [line] + [("end",)] * len(names)


def make_small(lines, folder):
    """The scene with at most some 100 cells, few steps and no pictures; files named from where they lie. In place."""
    dimension = int(value_of(lines, "", "Dimension", "2"))
    most = {1: 40, 2: 12, 3: 5}[dimension]
    cells = [int(number) for number in value_of(lines, "Domain", "Cells", ", ".join(["20"] * dimension)).split(",")]
    shape = value_of(lines, "Domain", "Shape", "box")
    if shape in ("box", "plate with hole"):
        scale = min(1.0, most / max(cells))
        even = 4 if int(value_of(lines, "Domain", "Coarsening", "0")) else 1
        set_value(lines, "Domain", "Cells",
                  ", ".join(str(max(2, round(number * scale / even) * even)) for number in cells))
    elif shape == "image":
        set_value(lines, "Domain", "Pixels per cell", "8")
    for entry in ("Mesh file", "Image"):
        name = value_of(lines, "Domain", entry)
        if name:
            set_value(lines, "Domain", entry, os.path.normpath(os.path.join(folder, name)))
    if float(value_of(lines, "Peridynamics", "Horizon ratio", "3")) > 3:
        set_value(lines, "Peridynamics", "Horizon ratio", "3")
    if value_of(lines, "Elasticity", "Solver") == "dynamics" and value_of(lines, "Time", "End time"):
        set_value(lines, "Time", "End time", str(float(value_of(lines, "Time", "End time")) / 10))
    if value_of(lines, "Time", "Time step", "auto") not in ("auto", "") and value_of(lines, "Elasticity", "Solver") != "dynamics":
        set_value(lines, "Time", "End time", str(min(float(value_of(lines, "Time", "End time", "1")),
                                                     100 * float(value_of(lines, "Time", "Time step")))))
    for entry in ("Write at", "Write every"):
        if value_of(lines, "Output", entry):
            set_value(lines, "Output", entry, "")
    set_value(lines, "Output", "Fields", "none")
    return lines


# Values that something once did not expect.
NUMBERS = ["0", "-1", "nan", "inf", "-inf", "1e300", "1e-300", "-1e300", "1e400", "123456789012345678901234567890", "0x10", "1e", "--1", "0.5",
           "1e9", "-0", "1/0", "0/0", "sqrt(-1)", "log(0)", "1e10", "1e-10", "2147483648", "4294967296", "-2147483649", "3.5", "1", "2", "7",
           "1e5", "1e-5", "99999"]
TEXTS = ["", " ", "true", "none", "auto", "left", "free", "x", "t", "T", "foo", "x +", "sin(x", "x)", "((((((((x", "1,2,3,4", ",", ";", ";;", ":", ": 1", "left:",
         "left: ; right: 1", "left: 1; left: 2", "hole: 1", "99: 1", "a: x; b: y", "|", "1;2;3", "0,0;1,1", "0,0 ; 0,0", "1,2 ; 1,2 ; 3", "..", "40..",
         "\u00e9\u00df\u4e2d", "\U0001f525", "\u200b1", "\u00a01", "1\u00a02", "=", "= 1", "set x = 1", "end", "subsection Domain", "\\", "'", "\"", "<svg onload=alert(1)>",
         "%s%n%d", "../../etc/passwd", "/dev/null", "/dev/zero", "rnd(1)", "if(x>0, 1, 2)", "if(x", "x^x^x^x", "1e3*t", "-t", "x*1e300*1e300", "max(0, x-0.5)",
         "if(x>0.5, 0/0, 1)", "if(t>0, 1e300, 0)", "1/x", "1/T", "exp(1000*x)", "T-T", "-T", "E", "_pi", "pi", "everywhere", "cracks: 0", "cracks: -1",
         "cracks: 1e9", "adaptive", "follow", "computed", "circle(0.5, 0.5, -1)", "1: 0, 1,1", "9: 0, 1,1", "1: 0, 0,0", "1: 0, 1e9,0",
         "lattice harmonic(1, 1)", "bobaru 2012 example 1", "a" * 5000, "(" * 3000, "1+" * 3000 + "1", "1," * 3000 + "1", "0,0;" * 500 + "1,1"]
BINARY = [b"\x00", b"\xff\xfe", b"\x80", b"\x1b[31m", b"\r", b"\x0b", b"\xef\xbb\xbf", b"\xc3\x28", bytes(range(256))]
FACTORS = [0, -1, 0.1, 0.5, 2, 3, 10, 1e-3, 1e3, 1e-8, 1e8, 1e-30, 1e30, 1e-150, 1e150, 1e200, 1e-300, 1e300]
FORMULAS = [("Material", "Conductivity"), ("Material", "Density"), ("Material", "Heat capacity"), ("Material", "Young modulus"),
            ("Material", "Poisson ratio"), ("Material", "Fracture energy"), ("Material", "Critical stretch"), ("Material", "Thermal expansion"),
            ("Initial and source", "Initial value"), ("Initial and source", "Source"), ("Elasticity", "Temperature change"),
            ("Reference", "Solution"), ("Cracks", "Transmission"), ("Cracks", "Contact conductance"), ("Coupling", "Zone"),
            ("Boundary conditions", "Dirichlet"), ("Boundary conditions", "Flux"), ("Boundary conditions", "Convection"),
            ("Boundary conditions", "Displacement"), ("Boundary conditions", "Traction")]
WILD = ["x", "y", "-x", "t", "T", "1+T", "1+t", "1+x", "1+x^2", "max(0, x-0.5)", "if(x>0.5, 1, 1e-12)", "if(x>0.5, 1, 1e12)", "if(x>0.5, 0/0, 1)",
        "1/x", "1/(x-0.5)", "1/t", "1/T", "sqrt(x)", "sqrt(x-0.5)", "log(x)", "exp(100*x)", "exp(1000*x)", "exp(1000*t)", "exp(T)", "T^3", "T^2",
        "1e300", "1e308", "-1e308", "1e-308", "1e150", "1e-150", "0", "-1", "1e30*x", "sin(1e6*t)", "1/(1-t)", "if(t>0, 1e300, 0)", "1e5*t", "if(t > 0.01, 0/0, 1)"]
PHYSICS = ["heat", "moisture", "electricity", "elasticity", "thermoelasticity", "Heat", "magnetism"]
MODELS = ["finite elements", "peridynamics", "coupled", "finite elements, peridynamics", "finite elements, peridynamics, coupled",
          "coupled, coupled", "auto", "finite elements,", ""]


class Mutator:
    """Changes scenes at random. entries: all entries that there are, {(section, entry): (default, choices)}."""

    def __init__(self, entries):
        self.entries = entries
        form = [self.replace_value, self.replace_number, self.add_entry, self.delete, self.duplicate, self.swap, self.move, self.typo,
                self.dimension, self.brackets, self.count, self.structure]
        meaning = [self.scale_number, self.scale_number, self.scale_number, self.choose, self.choose, self.formula, self.formula, self.physics,
                   self.models, self.transplant, self.add_number, self.add_number]
        self.kinds = form + 2 * meaning

    def mutate(self, lines, random, others):
        """A changed copy, as bytes, and the names of the changes. others: scenes that lines are taken from."""
        lines = list(lines)
        self.others = others
        names = []
        for _ in range(random.choice([1, 1, 1, 2, 2, 3, 5])):
            kind = random.choice(self.kinds)
            if kind(lines, random) is not False:
                names.append(kind.__name__)
        text = write_lines(lines).encode()
        if random.random() < 0.05:
            text = self.bytes(text, random)
            names.append("bytes")
        return text, names

    @staticmethod
    def entry(lines, random):
        numbers = [number for number, line in enumerate(lines) if line[0] == "set"]
        return random.choice(numbers) if numbers else None

    def replace_value(self, lines, random):
        number = self.entry(lines, random)
        if number is None:
            return False
        lines[number] = ("set", lines[number][1], random.choice(NUMBERS + TEXTS))

    def replace_number(self, lines, random):
        """One number within a value."""
        number = self.entry(lines, random)
        found = list(re.finditer(r"\d+(\.\d*)?(e[-+]?\d+)?", lines[number][2])) if number is not None else []
        if not found:
            return False
        match = random.choice(found)
        value = lines[number][2]
        lines[number] = ("set", lines[number][1], value[:match.start()] + random.choice(NUMBERS) + value[match.end():])

    def scale_number(self, lines, random):
        """One number made larger or smaller, or turned round."""
        number = self.entry(lines, random)
        found = list(re.finditer(r"(?<![\w.])\d+(\.\d*)?(e[-+]?\d+)?", lines[number][2])) if number is not None else []
        if not found:
            return False
        match = random.choice(found)
        value = lines[number][2]
        new = float(match.group()) * random.choice(FACTORS)
        text = str(int(new)) if new.is_integer() and abs(new) < 1e6 else repr(new)
        lines[number] = ("set", lines[number][1], value[:match.start()] + text + value[match.end():])

    def formula(self, lines, random):
        """Another formula where one is."""
        section, entry = random.choice(FORMULAS)
        number = find(lines, section, entry)
        new = random.choice(WILD)
        if number is None and section == "Boundary conditions":
            return False
        if section == "Boundary conditions":
            side, _, rest = lines[number][2].partition(":")
            parts = rest.split(";")[0].split(",")
            parts[random.randrange(len(parts))] = " " + new
            new = side + ":" + ",".join(parts) + (";" + rest.split(";", 1)[1] if ";" in rest else "")
        set_value(lines, section, entry, new)

    def add_number(self, lines, random):
        """A number for an entry that takes one, given or not."""
        numeric = [key for key, (default, choices) in sorted(self.entries.items())
                   if not choices and re.fullmatch(r"[-+\d.e]+", default or "1")]
        section, entry = random.choice(numeric)
        default = self.entries[section, entry][0] or "1"
        set_value(lines, section, entry, f"{float(default) * random.choice(FACTORS):g}")

    def choose(self, lines, random):
        """Another choice of an entry that has choices."""
        (section, entry), (_, choices) = random.choice([item for item in self.entries.items() if item[1][1]])
        set_value(lines, section, entry, random.choice(choices))

    def add_entry(self, lines, random):
        """An entry that the scene does not have, with a value of its kind or of none."""
        (section, entry), (default, choices) = random.choice(sorted(self.entries.items()))
        if entry == "Output directory":
            return False
        set_value(lines, section, entry, random.choice((choices or [default]) + [random.choice(NUMBERS), random.choice(TEXTS)]))

    def delete(self, lines, random):
        if lines:
            del lines[random.randrange(len(lines))]

    def duplicate(self, lines, random):
        if lines:
            line = random.choice(lines)
            lines.insert(random.randrange(len(lines) + 1), line)

    def swap(self, lines, random):
        if lines:
            a, b = random.randrange(len(lines)), random.randrange(len(lines))
            lines[a], lines[b] = lines[b], lines[a]

    def move(self, lines, random):
        if lines:
            lines.insert(random.randrange(len(lines)), lines.pop(random.randrange(len(lines))))

    def typo(self, lines, random):
        number = self.entry(lines, random)
        if number is None:
            return False
        words = list(lines[number])
        part = random.choice([1, 2])
        if words[part]:
            k = random.randrange(len(words[part]))
            words[part] = words[part][:k] + random.choice(["", "x", " ", "=", words[part][k].upper(), ";", ","]) + words[part][k + 1:]
        lines[number] = tuple(words)

    def physics(self, lines, random):
        set_value(lines, "", "Physics", random.choice(PHYSICS))

    def models(self, lines, random):
        set_value(lines, "", "Models", random.choice(MODELS))

    def dimension(self, lines, random):
        set_value(lines, "", "Dimension", random.choice(["1", "2", "3", "0", "4", "-1", "two"]))

    def brackets(self, lines, random):
        number = self.entry(lines, random)
        if number is None:
            return False
        value = lines[number][2]
        k = random.randrange(len(value) + 1)
        lines[number] = ("set", lines[number][1], value[:k] + random.choice("()[]{},;:|") + value[k:])

    def count(self, lines, random):
        """One component more or less in a list."""
        number = self.entry(lines, random)
        if number is None:
            return False
        separator = random.choice(",;:")
        parts = lines[number][2].split(separator)
        k = random.randrange(len(parts))
        parts[k:k + 1] = random.choice([[], [parts[k], parts[k]], [parts[k], ""]])
        lines[number] = ("set", lines[number][1], separator.join(parts))

    def structure(self, lines, random):
        word = random.choice([("end",), ("subsection", "Domain"), ("subsection", "Nowhere"), ("subsection", ""), ("text", "set"), ("text", "foo bar"),
                              ("text", "include x"), ("set", "", "1"), ("set", "Unknown entry", "1")])
        lines.insert(random.randrange(len(lines) + 1), word)

    def transplant(self, lines, random):
        """A section of another scene in place of this scene's, or beside it."""
        other = random.choice(self.others)
        starts = [k for k, line in enumerate(other) if line[0] == "subsection"]
        if not starts:
            return False
        start = random.choice(starts)
        stop = next((k for k in range(start, len(other)) if other[k] == ("end",)), len(other) - 1)
        if random.random() < 0.6 and other[start] in lines:
            begin = lines.index(other[start])
            finish = next((k for k in range(begin, len(lines)) if lines[k] == ("end",)), len(lines) - 1)
            lines[begin:finish + 1] = other[start:stop + 1]
        else:
            lines += other[start:stop + 1]

    @staticmethod
    def bytes(text, random):
        kind = random.randrange(5)
        k = random.randrange(len(text) + 1)
        if kind == 0:
            return text[:k] + random.choice(BINARY) + text[k:]
        if kind == 1:
            return text[:k]
        if kind == 2:
            return text.replace(b"\n", random.choice([b"\r\n", b"\r"]))
        if kind == 3:
            return bytes(byte ^ (1 << random.randrange(8)) if random.random() < 0.005 else byte for byte in text)
        return b"\n".join(b"# " + line for line in text.split(b"\n"))
