# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Mesh files damaged at random: bytes changed, lines deleted, doubled and swapped, counts and numbers changed, nodes of cells
swapped, files cut short and put together.

Each has to be read, or refused with exit status 1 and one message that names the file, within 20 seconds and 3 GB of addresses.
"""

import os

from campaign import COMPLETE, HANG, NO_MESSAGE, REFUSED, STOPPED, TOO_LONG, WRONG, WRONG_STATUS
from campaign import Campaign, limit_memory, run
from scene_test import SOURCE_DIR

TIME = 20  # seconds
MEMORY = 3 << 30  # bytes of addresses

MESHES = [(2, "tests/data/two_materials.msh"), (2, "prm/heat/gmsh_plate.msh"),
          (2, "prm/papers/le_2014/plate_with_hole.msh"), (3, "tests/data/hexes.msh"), (2, "tests/data/triangles.msh"),
          (2, "prm/elasticity/ring_of_triangles.msh")]

NUMBERS = ["0", "-1", "1", "2", "3", "5", "15", "99", "255", "65536", "2147483647", "4294967296", "1e9", "1e-300", "1e300", "-1e-9",
           "nan", "inf", "0x10", "1,5", "$Nodes", "$EndElements", "\"a b\"", ""]

SCENE = """
set Dimension = {dimension}
set Models = {models}
subsection Domain
  set Shape = mesh file
  set Mesh file = damaged.msh
end
subsection Peridynamics
  set Horizon = {horizon}
end
"""


def change_bytes(text, random):
    data = bytearray(text)
    for _ in range(random.choice([1, 1, 2, 20])):
        place = random.randrange(len(data))
        data[place] = random.choice([data[place] ^ 1 << random.randrange(8), random.randrange(256), *b"0123456789.-e \n"])
    return bytes(data)


def change_lines(text, random):
    lines = text.split(b"\n")
    for _ in range(random.choice([1, 1, 1, 3, 30])):
        one, two = random.randrange(len(lines)), random.randrange(len(lines))
        kind = random.randrange(4)
        if kind == 0 and len(lines) > 1:
            del lines[one]
        elif kind == 1:
            lines.insert(two, lines[one])
        elif kind == 2:
            lines[one], lines[two] = lines[two], lines[one]
        else:
            del lines[min(one, two):min(one, two) + random.choice([2, 10, 100])]
            lines = lines or [b""]
    return b"\n".join(lines)


def change_words(text, random):
    """One word becomes another: a number that may be none, a word from elsewhere, its own value and a little."""
    lines = text.split(b"\n")
    for _ in range(random.choice([1, 1, 1, 4])):
        line = random.randrange(len(lines))
        words = lines[line].split() or [b""]
        k = random.randrange(len(words))
        kind = random.randrange(3)
        if kind == 0:
            words[k] = random.choice(NUMBERS).encode()
        elif kind == 1:
            words[k] = random.choice(random.choice(lines).split() or [b"x"])
        else:
            try:
                words[k] = str(int(words[k]) + random.choice([-100, -2, -1, 1, 2, 100])).encode()
            except ValueError:
                words[k] += random.choice([b"0", b"e1", b"e-30", b"-"])
        lines[line] = b" ".join(words)
    return b"\n".join(lines)


def change_counts(text, random):
    """A number in one of the lines that say how many follow: behind the beginning of a section, or short ones."""
    lines = text.split(b"\n")
    heads = [k + 1 for k, line in enumerate(lines[:-1]) if line.startswith(b"$") and not line.startswith(b"$End")]
    blocks = [k for k, line in enumerate(lines) if len(line.split()) == 4]
    line = random.choice(heads * 3 + random.sample(blocks, min(3, len(blocks))) if blocks else heads)
    words = lines[line].split() or [b"0"]
    k = random.randrange(len(words))
    try:
        words[k] = str(random.choice([0, 1, 2, 1000000, int(words[k]) - 1, int(words[k]) + 1, 2 * int(words[k])])).encode()
    except ValueError:
        words[k] = b"7"
    lines[line] = b" ".join(words)
    return b"\n".join(lines)


def change_cells(text, random):
    """Nodes of an element become others, or change places; two elements exchange their nodes."""
    lines = text.split(b"\n")
    begin = next(k for k, line in enumerate(lines) if line.startswith(b"$Elements"))
    cells = [k for k in range(begin, len(lines)) if len(lines[k].split()) >= 5]
    for _ in range(random.choice([1, 1, 2])):
        line, other = random.choice(cells), random.choice(cells)
        words, theirs = lines[line].split(), lines[other].split()
        one, two = random.randrange(-4, 0), random.randrange(-4, 0)
        kind = random.randrange(3)
        if kind == 0:
            words[one], words[two] = words[two], words[one]
        elif kind == 1:
            words[one] = theirs[two]
        else:
            words[-4:] = theirs[-4:]
        lines[line] = b" ".join(words)
    return b"\n".join(lines)


def move_nodes(text, random):
    lines = text.split(b"\n")
    end = next(k for k, line in enumerate(lines) if line.startswith(b"$EndNodes"))
    nodes = [k for k in range(end) if len(lines[k].split()) in (3, 4) and b"." in lines[k]]
    for _ in range(random.choice([1, 1, 5])):
        if not nodes:
            break
        line = random.choice(nodes)
        words = lines[line].split()
        words[random.choice([-3, -2])] = random.choice(
            [b"0", b"-5", b"1e-13", random.choice(lines[random.choice(nodes)].split()), str(random.uniform(0, 2)).encode()])
        lines[line] = b" ".join(words)
    return b"\n".join(lines)


def cut(text, random):
    place = random.randrange(len(text))
    return random.choice([text[:place], text[place:], text[:place] + text[random.randrange(len(text)):], text + text])


DAMAGES = [change_bytes, change_lines, change_words, change_counts, change_cells, move_nodes, cut]


def check_file(case, damage, scene, *words):
    """Count how the check of the scene ends: refused with a message that says one of the words, or read."""
    what = damage.__name__.replace("_", " ")
    end = run(["check", case.write("scene.prm", scene)], case, timeout=TIME, prepare=lambda: limit_memory(MEMORY))
    if end.kind == TOO_LONG:
        case.count(what, HANG, f"more than {TIME} s")
    elif end.kind == STOPPED:
        case.count(what, WRONG_STATUS, end.detail)
    elif end.kind == REFUSED and not any(word in end.stderr for word in words):
        case.count(what, NO_MESSAGE, f"about the file: {end.detail}")
    elif end.kind == COMPLETE and "Nothing was computed" not in end.stdout:
        case.count(what, WRONG, end.stdout[-300:])
    else:
        case.count(what, end.kind, end.detail)


def main():
    campaign = Campaign(__doc__, cases=500)
    for case in campaign:
        random = case.random
        dimension, mesh = MESHES[case.number % len(MESHES)]
        damage = DAMAGES[case.number // len(MESHES) % len(DAMAGES)]
        with open(os.path.join(SOURCE_DIR, mesh), "rb") as file:
            text = damage(file.read(), random)
        case.write("damaged.msh", text)
        scene = SCENE.format(dimension=dimension, horizon=random.choice([0.3, 0.7]),
                             models=random.choice(["finite elements"] * 3 + ["finite elements, peridynamics"]))
        check_file(case, damage, scene, "damaged.msh'", "some node has no neighbour within it")  # whole, but with nodes far apart
    campaign.finish()


if __name__ == "__main__":
    main()
