#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Draw sections of a wire of filaments in a matrix, as in chapter 3 of Le (2014), for `Shape = image`.

    make_wire.py wire.png                                          rough filaments along x
    make_wire.py wire.png --section cross --bridges 6              a cross section with bridges between filaments
    make_wire.py wire.png --defect rectangle --length 14 --breadth 5
    make_wire.py --all FOLDER                                      the images of prm/papers/le_2014

The matrix is white, filaments are black, defects red (or --color); all lengths are in pixels. The same seed gives the same
picture on every machine.
"""

import argparse
import math
import os
import random
import struct
import sys
import zlib

MATRIX, FILAMENT, DEFECT = 0, 1, 2
PALETTE = [(255, 255, 255), (0, 0, 0), (255, 0, 0)]


def write_png(path, rows, palette):
    """A palette picture of 8 bits; rows of palette numbers from the top."""
    def chunk(kind, content):
        body = kind + content
        return struct.pack(">I", len(content)) + body + struct.pack(">I", zlib.crc32(body))

    head = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 3, 0, 0, 0)
    pixels = b"".join(b"\0" + bytes(row) for row in rows)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"PLTE", bytes(c for p in palette for c in p)) +
                   chunk(b"IDAT", zlib.compress(pixels, 9)) + chunk(b"IEND", b""))


def rough_line(rng, length, amplitude, n_waves=9):
    """A periodic random curve of cosines over 0..1, of that root mean square."""
    waves = [(k, rng.uniform(0, 2 * math.pi), k ** -0.7 * rng.uniform(0.5, 1)) for k in range(1, n_waves + 1)]
    size = math.sqrt(sum(a * a for _, _, a in waves) / 2)
    return [amplitude / size * sum(a * math.cos(2 * math.pi * k * (i + 0.5) / length + phase) for k, phase, a in waves)
            for i in range(length)]


class Wire:
    """A section in pixels; x to the right, y upwards, both from the lower left corner."""

    def __init__(self, options):
        self.options = options
        self.width, self.height = options.width, options.height
        self.phase = [[MATRIX] * self.width for _ in range(self.height)]
        self.rng = random.Random(options.seed)
        if options.section == "longitudinal":
            self.draw_filaments()
        else:
            self.draw_cross_section()
        if options.defect != "none":
            self.draw_defect()

    def fill(self, inside, value, only=None):
        """Give the pixels whose centre is inside a phase."""
        for j in range(self.height):
            for i in range(self.width):
                if inside(i + 0.5, j + 0.5) and (only is None or self.phase[j][i] == only):
                    self.phase[j][i] = value

    def draw_filaments(self):
        """Filaments along x with rough sides, evenly spaced."""
        o = self.options
        self.middles = [self.height * (k + 0.5) / o.filaments for k in range(o.filaments)]
        for y in self.middles:
            upper, lower = (rough_line(self.rng, self.width, o.roughness) for _ in range(2))
            for i in range(self.width):
                for j in range(self.height):
                    if y - 0.5 * o.thickness + lower[i] <= j + 0.5 <= y + 0.5 * o.thickness + upper[i]:
                        self.phase[j][i] = FILAMENT
        for k in range(min(o.bridges, len(self.middles) - 1) if o.bridges else 0):
            x = self.rng.uniform(0.2, 0.8) * self.width
            self.fill(lambda p, q: abs(p - x) < 3 and self.middles[k] < q < self.middles[k + 1], FILAMENT)

    def draw_cross_section(self):
        """Rough round filaments in staggered rows, and bridges between neighbours."""
        o = self.options
        radius, step = 0.5 * o.thickness, 1.6 * o.thickness
        n_rows = max(1, round(self.height / (0.87 * step)))
        centers = []
        for row in range(n_rows):
            y = self.height * (row + 0.5) / n_rows
            n = max(1, int(self.width / step) - row % 2)
            centers += [(self.width * (k + 0.5) / n, y) for k in range(n)]
        self.middles = sorted({y for _, y in centers})
        for x, y in centers:
            line = rough_line(self.rng, 90, o.roughness, 5)

            def inside(p, q, x=x, y=y, line=line):
                angle = math.atan2(q - y, p - x) / (2 * math.pi) % 1
                return math.hypot(p - x, q - y) < radius + line[int(90 * angle) % 90]

            self.fill(inside, FILAMENT)
        pairs = [(a, b) for k, a in enumerate(centers) for b in centers[:k] if math.dist(a, b) < 1.35 * step]
        self.rng.shuffle(pairs)
        for a, b in pairs[:o.bridges]:
            wide = self.rng.uniform(1.5, 3)
            along = ((b[0] - a[0]) / math.dist(a, b), (b[1] - a[1]) / math.dist(a, b))

            def near(p, q, a=a, b=b, wide=wide, along=along):
                s = (p - a[0]) * along[0] + (q - a[1]) * along[1]
                return 0 < s < math.dist(a, b) and abs((p - a[0]) * along[1] - (q - a[1]) * along[0]) < wide

            self.fill(near, FILAMENT)

    def draw_defect(self):
        """In the middle of the picture, or around --at."""
        o = self.options
        middle = self.middles[len(self.middles) // 2]
        x, y = o.at if o.at else (0.5 * self.width, middle)
        if o.defect == "rectangle" and not o.at and o.edge:
            y = middle - 0.5 * o.thickness - o.edge + 0.5 * o.length  # from the lower side of the filament upwards
        if o.defect == "rectangle":
            self.fill(lambda p, q: abs(p - x) < 0.5 * o.breadth and abs(q - y) < 0.5 * o.length, DEFECT)
        elif o.defect == "slanted":  # at 45 degrees; the breadth is measured along x
            self.fill(lambda p, q: abs(p - x - (q - y)) < 0.5 * o.breadth and abs(q - y) < 0.5 * o.length, DEFECT)
        elif o.defect == "circle":
            self.fill(lambda p, q: math.hypot(p - x, q - y) < 0.5 * o.diameter, DEFECT)
        elif o.defect == "irregular":
            self.draw_irregular_defect(x, y)
            others = [m for m in self.middles if m != middle]
            for k in range(o.defects - 1):
                self.draw_irregular_defect(self.rng.uniform(0.2, 0.8) * self.width, others[k % len(others)] if others else y)
        else:  # delamination: what is matrix just above and below the filament
            half = 0.5 * o.thickness + 3 * o.roughness
            for i in range(max(0, int(x - 0.5 * o.length)), min(self.width, int(x + 0.5 * o.length))):
                column = [j for j in range(self.height) if self.phase[j][i] == FILAMENT and abs(j + 0.5 - y) < half]
                if column:
                    for j in range(max(column) + 1, min(self.height, max(column) + 1 + o.breadth)):
                        self.phase[j][i] = DEFECT

    def draw_irregular_defect(self, x, y):
        """A blob taller than wide."""
        diameter = self.options.diameter
        line = rough_line(self.rng, 90, 0.08 * diameter, 5)
        self.fill(lambda p, q: math.hypot((p - x) / 0.7, q - y) <
                  0.5 * diameter + line[int(90 * math.atan2(q - y, p - x) / (2 * math.pi)) % 90], DEFECT)

    def write(self, path):
        """As PNG, every pixel scale x scale times."""
        scale = self.options.scale
        rows = [[p for p in row for _ in range(scale)] for row in reversed(self.phase) for _ in range(scale)]
        write_png(path, rows, PALETTE[:2] + [self.options.color])


# The images of prm/papers/le_2014, 0.56 micrometres a pixel: filaments of 27 pixels, 15.1
# micrometres.
ALL = {
    "longitudinal": [], "single_filament": ["--filaments", "1"],
    "cross_section": ["--section", "cross", "--bridges", "9", "--thickness", "22", "--roughness", "1"],
    "irregular": ["--defect", "irregular", "--diameter", "20"],
    "several": ["--defect", "irregular", "--diameter", "20", "--defects", "4"],
    **{f"length_{n:02}": ["--defect", "rectangle", "--breadth", "5", "--length", str(n + 2), "--edge", "2"]
       for n in (7, 13, 20, 31)},
    **{f"width_{n:02}": ["--defect", "rectangle", "--breadth", str(n), "--length", "33", "--edge", "2"]
       for n in (3, 10, 20)},
    **{f"slanted_{n:02}": ["--defect", "slanted", "--breadth", str(n), "--length", "33"] for n in (5, 10, 20)},
    **{f"circle_{n:02}": ["--defect", "circle", "--diameter", str(n)] for n in (6, 12, 18, 40)},
    **{f"aspect_{h}_{w}": ["--defect", "rectangle", "--length", str(h), "--breadth", str(w)]
       for h, w in ((20, 5), (10, 10), (5, 20))},
    "delamination": ["--defect", "delamination", "--length", "60", "--breadth", "3"],
}


def pair(text):
    """Two numbers with a comma between."""
    return tuple(float(part) for part in text.split(","))


def color(text):
    """Three numbers from 0 to 255."""
    parts = tuple(int(part) for part in text.split(","))
    if len(parts) != 3 or not all(0 <= part <= 255 for part in parts):
        raise argparse.ArgumentTypeError("three numbers from 0 to 255")
    return parts


def make_parser():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("output", help="PNG file, or with --all a folder")
    add("--all", action="store_true", help="draw the images of prm/papers/le_2014")
    add("--section", choices=("longitudinal", "cross"), default="longitudinal")
    add("--width", type=int, default=160, help="pixels (160)")
    add("--height", type=int, default=126, help="pixels (126)")
    add("--filaments", type=int, default=3, help="number of filaments of a longitudinal section (3)")
    add("--thickness", type=float, default=27, help="of a filament (27)")
    add("--roughness", type=float, default=1.4, help="root mean square deviation of the sides of filaments (1.4)")
    add("--bridges", type=int, default=0, help="number of bridges between filaments (0)")
    add("--defect", choices=("none", "rectangle", "slanted", "circle", "irregular", "delamination"), default="none")
    add("--length", type=float, default=14, help="of a rectangle or a slanted defect along y, of a delamination along x (14)")
    add("--breadth", type=int, default=5, help="of a rectangle or a slanted defect along x, opening of a delamination (5)")
    add("--diameter", type=float, default=14, help="of a circle or an irregular defect (14)")
    add("--defects", type=int, default=1, help="number of irregular defects: one in the middle, the others anywhere in the other filaments (1)")
    add("--edge", type=float, default=0,
        help="a rectangle begins so far below the nominal lower side of the filament (0: it lies in the middle)")
    add("--at", type=pair, help="x,y: middle of the defect (middle of a filament)")
    add("--color", type=color, default=PALETTE[DEFECT], help="of the defect (255,0,0)")
    add("--scale", type=int, default=1, help="edge of a pixel of the drawing in pixels of the file (1)")
    add("--seed", type=int, default=1, help="of all that is random (1)")
    return parser


def main():
    """One image or all of them."""
    parser = make_parser()
    options = parser.parse_args()
    if min(options.width, options.height, options.filaments, options.scale, options.defects) < 1:
        parser.error("sizes and numbers have to be 1 or more")
    if not options.all:
        Wire(options).write(options.output)
        return 0
    for name, arguments in ALL.items():
        path = os.path.join(options.output, name + ".png")
        Wire(parser.parse_args([path] + arguments)).write(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
