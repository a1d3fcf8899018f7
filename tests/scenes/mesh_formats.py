# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Meshes as people bring them: a bar of tetrahedra in all formats, bars of all kinds of cells, damaged files.

    mesh_formats.py formats | bars | damaged | sets | dialects | exodus | others | unfit

The bar has edges 2, 1, 1 and is divided into cubes, and each cube into cells. Writers of the formats stand here, apart from the readers.
"""

import itertools
import os
import random
import re
import struct

from scene_test import FE, PD, Comparison, check, check_message, check_one_message, run_parts, run_perideal, run_scene, scene_text, temporary_folder
from perideal.meshes import Fault, convert
from scene_texts import mesh_text

FOLDER = temporary_folder()
# Corners of a cube by their bits x, y, z; six tetrahedra around its diagonal, two wedges along z, the cube.
CELLS = {"tetrahedra": [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)],
         "wedges": [(0, 1, 3, 4, 5, 7), (0, 3, 2, 4, 7, 6)], "hexahedra": [(0, 1, 3, 2, 4, 5, 7, 6)]}
GMSH = {4: 4, 6: 6, 8: 5}
SHAPE, LENGTH = (4, 2, 2), 2.0

BAR = scene_text("""
Dimension = 3
Physics = elasticity
Models = finite elements
Domain/Shape = mesh file
Material/Young modulus = 200
Material/Poisson ratio = 0.3
Boundary conditions/Displacement = left: 0, 0, 0
Boundary conditions/Traction = right: 1, 0, 0
Output/Fields = none
""")


def bar(kind, shape=SHAPE):
    """Nodes, cells and the nodes of its ends."""
    number = {index: k for k, index in enumerate(itertools.product(*(range(n + 1) for n in shape)))}
    nodes = [tuple(LENGTH * i / shape[0] if d == 0 else i / shape[d] for d, i in enumerate(index)) for index in number]
    cells = [[number[x + (c & 1), y + (c >> 1 & 1), z + (c >> 2)] for c in corners]
             for x, y, z in itertools.product(*map(range, shape)) for corners in CELLS[kind]]
    ends = {name: [number[index] for index in number if index[0] == at] for name, at in (("left", 0), ("right", shape[0]))}
    return nodes, cells, ends


def faces_in(cells, nodes):
    """Faces of tetrahedra that lie among these nodes."""
    return sorted({tuple(sorted(face)) for cell in cells for face in itertools.combinations(cell, 3) if set(face) <= set(nodes)})


def gmsh_text(nodes, cells, sides):
    """Version 2.2."""
    elements = [f"{GMSH[len(cell)]} 2 9 9 " + " ".join(str(k + 1) for k in cell) for cell in cells]
    elements += [f"{ {3: 2, 4: 3}[len(face)]} 2 {group} {group} " + " ".join(str(k + 1) for k in face) for group, faces in enumerate(sides.values(), 1) for face in faces]
    return mesh_text(nodes, elements, [(2, group, name) for group, name in enumerate(sides, 1)] + [(3, 9, "steel")])


def gmsh_binary(version, nodes, cells, sides):
    """Version 4.0 or 4.1, all nodes of the volume 1, faces of the surfaces 1 and 2."""
    latest = version == "4.1"
    count, tag = ("<Q", "<Q") if latest else ("<Q", "<i")
    integers = lambda *numbers: struct.pack(f"<{len(numbers)}i", *numbers)
    names = "".join(f'{d} {k} "{name}"\n' for d, k, name in [(2, k, name) for k, name in enumerate(sides, 1)] + [(3, 9, "steel")])
    data = f"$MeshFormat\n{version} 1 8\n".encode() + integers(1) + f"\n$EndMeshFormat\n$PhysicalNames\n3\n{names}$EndPhysicalNames\n$Entities\n".encode()
    data += struct.pack("<4Q", 0, 0, len(sides), 1)
    for number, group in [(k, k) for k in range(1, len(sides) + 1)] + [(1, 9)]:
        data += integers(number) + struct.pack("<6d", *[0.0] * 6) + struct.pack("<Q", 1) + integers(group) + struct.pack("<Q", 0)
    data += b"\n$EndEntities\n$Nodes\n"
    head = lambda entity, dimension, *rest: integers(dimension, entity, *rest) if latest else integers(entity, dimension, *rest)
    data += struct.pack("<4Q", 1, len(nodes), 1, len(nodes)) if latest else struct.pack("<2Q", 1, len(nodes))
    data += head(1, 3, 0) + struct.pack("<Q", len(nodes))
    if latest:
        data += b"".join(struct.pack("<Q", k + 1) for k in range(len(nodes))) + b"".join(struct.pack("<3d", *node) for node in nodes)
    else:
        data += b"".join(struct.pack("<i3d", k + 1, *node) for k, node in enumerate(nodes))
    blocks = [(group, 2, 2, faces) for group, faces in enumerate(sides.values(), 1)] + [(1, 3, GMSH[len(cells[0])], cells)]
    n = sum(len(block[3]) for block in blocks)
    data += b"\n$EndNodes\n$Elements\n" + (struct.pack("<4Q", len(blocks), n, 1, n) if latest else struct.pack("<2Q", len(blocks), n))
    number = itertools.count(1)
    for entity, dimension, kind, rows in blocks:
        data += head(entity, dimension, kind) + struct.pack(count, len(rows))
        for row in rows:
            data += struct.pack(tag, next(number)) + b"".join(struct.pack(tag, k + 1) for k in row)
    return data + b"\n$EndElements\n"


def abaqus_text(nodes, cells, ends, surfaces=False):
    """Sets of nodes at the ends, or surfaces of faces; two sets of elements."""
    half = len(cells) // 2
    text = "*Heading\n** a bar\n*Part, name=bar\n*Node\n" + "".join(f"{k}, {x!r}, {y!r}, {z!r}\n" for k, (x, y, z) in enumerate(nodes, 1))
    text += "*Element, type=C3D4, elset=all\n" + "".join(f"{k}, {', '.join(str(i + 1) for i in cell)}\n" for k, cell in enumerate(cells, 1))
    text += f"*Elset, elset=steel, generate\n{1}, {half}, 1\n*Elset, elset=iron, generate\n{half + 1}, {len(cells)}\n"
    for name, rows in ends.items():
        if surfaces:
            text += f"*Surface, type=ELEMENT, name={name}\n"
            for k, cell in enumerate(cells, 1):
                for side, corners in enumerate(((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)), 1):
                    text += f"{k}, S{side}\n" if {cell[c] for c in corners} <= set(rows) else ""
        else:
            text += f"*Nset, nset={name}\n" + ",\n".join(str(row + 1) for row in rows) + "\n"
    return text + "*End Part\n*Assembly, name=all of it\n*Instance, name=bar-1, part=bar\n*End Instance\n*End Assembly\n*Step\n*Static\n*End Step\n"


def unv_text(nodes, cells, ends):
    text = "    -1\n  2411\n" + "".join(f"{k:10d}{1:10d}{1:10d}{11:10d}\n" + "".join(f"{x:25.16E}" for x in node).replace("E", "D") + "\n" for k, node in enumerate(nodes, 1))
    text += "    -1\n    -1\n  2412\n" + "".join(f"{k:10d}{111:10d}{1:10d}{1:10d}{7:10d}{4:10d}\n" + "".join(f"{i + 1:10d}" for i in cell) + "\n" for k, cell in enumerate(cells, 1))
    text += "    -1\n    -1\n  2467\n"
    for k, (name, rows, kind) in enumerate([(name, rows, 7) for name, rows in ends.items()] + [("steel", range(len(cells)), 8)], 1):
        entries = [f"{kind:10d}{row + 1:10d}{0:10d}{0:10d}" for row in rows]
        text += "".join(f"{number:10d}" for number in (k, 0, 0, 0, 0, 0, 0, len(entries))) + f"\n{name}\n"
        text += "".join("".join(entries[i:i + 2]) + "\n" for i in range(0, len(entries), 2))
    return text + "    -1\n"


def exodus_bytes(nodes, cells, ends):
    """A classic NetCDF file with one block and two side sets."""
    sides = {end: [(k, side) for k, cell in enumerate(cells, 1) for side, corners in enumerate(((0, 1, 3), (1, 2, 3), (0, 3, 2), (0, 2, 1)), 1)
                   if {cell[c] for c in corners} <= set(rows)] for end, rows in ends.items()}
    text = lambda words: b"".join(word.encode().ljust(33, b"\0") for word in words)
    ints = lambda numbers: struct.pack(f">{len(numbers)}i", *numbers)
    sizes = {"num_nodes": len(nodes), "num_el": len(cells), "four": 4, "one": 1, "two": 2, "len": 33, "n1": len(sides["left"]), "n2": len(sides["right"])}
    variables = [(f"coord{axis}", ["num_nodes"], 6, struct.pack(f">{len(nodes)}d", *(node[d] for node in nodes)), None) for d, axis in enumerate("xyz")]
    variables += [("eb_names", ["one", "len"], 2, text(["steel"]), None), ("connect1", ["num_el", "four"], 4, ints([i + 1 for cell in cells for i in cell]), "TETRA"),
                  ("ss_names", ["two", "len"], 2, text(ends), None), ("ss_prop1", ["two"], 4, ints([1, 2]), None)]
    for k, rows in enumerate(sides.values(), 1):
        variables += [(f"elem_ss{k}", [f"n{k}"], 4, ints([row[0] for row in rows]), None), (f"side_ss{k}", [f"n{k}"], 4, ints([row[1] for row in rows]), None)]
    return netcdf_bytes(sizes, variables)


def netcdf_bytes(sizes, variables):
    """The classic format: sizes by name of a dimension; variables as name, dimensions, type, data, and `elem_type` or nothing."""
    pad = lambda data: data + bytes(-len(data) % 4)
    name = lambda text: struct.pack(">I", len(text)) + pad(text.encode())
    places = list(sizes)

    def head(begins):
        data = b"CDF\x01" + struct.pack(">3I", 0, 10, len(sizes)) + b"".join(name(one) + struct.pack(">I", size) for one, size in sizes.items())
        data += struct.pack(">4I", 0, 0, 11, len(variables))
        for (one, of, kind, values, attribute), begin in zip(variables, begins):
            data += name(one) + struct.pack(">I", len(of)) + b"".join(struct.pack(">I", places.index(d)) for d in of)
            data += struct.pack(">2I", 12, 1) + name("elem_type") + struct.pack(">2I", 2, len(attribute)) + pad(attribute.encode()) if attribute else struct.pack(">2I", 0, 0)
            data += struct.pack(">3I", kind, len(pad(values)), begin)
        return data

    begins, at = [], len(head([0] * len(variables)))
    for variable in variables:
        begins.append(at)
        at += len(pad(variable[3]))
    return head(begins) + b"".join(pad(variable[3]) for variable in variables)


THREE = 'NumberOfComponents="3"'


def vtu_text(nodes, cells):
    array = lambda kind, name, numbers, more="": f'<DataArray type="{kind}" Name="{name}" {more} format="ascii">{" ".join(map(str, numbers))}</DataArray>'
    return ('<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>'
            f'<Piece NumberOfPoints="{len(nodes)}" NumberOfCells="{len(cells)}"><Points>{array("Float64", "Points", [x for node in nodes for x in node], THREE)}</Points>'
            f'<Cells>{array("Int64", "connectivity", [i for cell in cells for i in cell])}{array("Int64", "offsets", [4 * (k + 1) for k in range(len(cells))])}'
            f'{array("UInt8", "types", [10] * len(cells))}</Cells><CellData>{array("Int64", "material", [5] * len(cells))}</CellData></Piece></UnstructuredGrid></VTKFile>')


def write(name, data):
    path = os.path.join(FOLDER, name)
    with open(path, "wb") as file:
        file.write(data if isinstance(data, bytes) else data.encode())
    return path


def all_formats():
    """Paths of the bar of tetrahedra, by format."""
    nodes, cells, ends = bar("tetrahedra")
    sides = {name: faces_in(cells, rows) for name, rows in ends.items()}
    return {"msh 2.2": write("old.msh", gmsh_text(nodes, cells, sides)), "msh 4.0, binary": write("four.msh", gmsh_binary("4.0", nodes, cells, sides)),
            "msh 4.1, binary": write("latest.msh", gmsh_binary("4.1", nodes, cells, sides)), "inp, sets of nodes": write("sets.inp", abaqus_text(nodes, cells, ends)),
            "inp, surfaces": write("surfaces.inp", abaqus_text(nodes, cells, ends, surfaces=True)), "unv": write("bar.unv", unv_text(nodes, cells, ends)),
            "Exodus": write("bar.exo", exodus_bytes(nodes, cells, ends)), "vtu": write("bar.vtu", vtu_text(nodes, cells))}


def formats():
    """The same mesh whatever the format; sides and regions by their names; what is converted can be computed, also on two processes."""
    n = 4 * 6 * 16  # cells
    table = Comparison("A bar of tetrahedra in all formats: what `perideal mesh` tells, and its elongation")
    for what, path in all_formats().items():
        status, out, err = run_perideal(["mesh", path])
        if what == "vtu" and status == 1:  # meshio is not needed by anything else
            check_one_message(out, err, ["bar.vtu", "meshio", "python3-meshio"], what)
            continue
        check(status == 0, f"{what}: {err}")
        check(f"{n} hexahedra, divided from {n // 4} cells" in out and "volume 2\n" in out and "from (0, 0, 0) to (2, 1, 1)" in out, f"{what}: {out}")
        if what == "vtu":
            check("regions: 5: 384 cells" in out, f"{what}: {out}")
            continue
        for side in ("left", "right"):
            check(re.search(rf"'{side}' \(\d+\): 24 faces, area 1\b", out), f"{what}, {side}: {out}")
        check("area 8\n" in out, f"{what}, the rest of the surface: {out}")
        check("'steel'" in out and ("inp" not in what or re.search(r"'steel' \(\d+\): 192 cells", out) and "'iron'" in out and "'all' is left out" in out), f"{what}: {out}")
        run = run_scene(BAR, {"Domain/Mesh file": path}, ranks=2 if what == "Exodus" else 1)
        table.add(f"{what}: force on the left side", run.total("force on left in x", FE), -1.0, relative=1e-9)
    out_path = os.path.join(FOLDER, "out.msh")
    status, out, _ = run_perideal(["mesh", os.path.join(FOLDER, "sets.inp"), out_path])
    again = run_perideal(["mesh", out_path])[1]
    check(status == 0 and "'left'" in again and "'iron'" in again and f": {n} hexahedra, 553 nodes" in again, f"what was written: {again}")
    # Triangles on the left side and away from the body, which sets name beside a set of nodes.
    nodes, cells, ends = bar("tetrahedra")
    skin = [[k + 1 for k in face] for face in faces_in(cells, ends["left"])] + [[1, 2, len(nodes)]]
    shells = "*Element, type=S3, elset=skin\n" + "".join(f"{k}, {', '.join(map(str, face))}\n" for k, face in enumerate(skin, 1001)) + "*Elset"
    both = write("both.inp", abaqus_text(nodes, cells, ends).replace("*Elset", shells, 1))
    notes = convert(both, out_path)
    again = run_perideal(["mesh", out_path])[1]
    check(any("1 elements of dimension 2" in note for note in notes) and any("'left'" in note and "left out" in note for note in notes) != ("'left' (" in again), f"{notes}")
    check(again.count("24 faces, area 1") == 2, f"a side that two sets name: {again}")
    parted = {"Domain/Mesh file": os.path.join(FOLDER, "sets.inp"), "Material/Phases/Regions": "soft: mesh(iron)", "Material/Phases/Young modulus": "soft: 100",
              "Material/Poisson ratio": "0", "Output/Probes": "2, 0.5, 0.5", "Solver/Tolerance": "1e-13"}
    run = run_scene(BAR, parted)
    table.add("half of another stiffness: elongation", run.probe(FE, (2, 0.5, 0.5), column="ux"), 1 / 200 + 1 / 100, relative=1e-9)
    check("wedge" in run_perideal(["mesh", write("wedges.msh", gmsh_text(*bar("wedges")[:2], {}))])[1], "wedges are not named")
    check_message(run_scene(BAR, {"Domain/Mesh file": os.path.join(FOLDER, "sets.inp"), "Boundary conditions/Traction": "rihgt: 1, 0, 0"}, expect_error=True), "rihgt", "left", "right")
    table.show()


def bars():
    """Young's modulus of bars of all kinds of cells whose edges are alike once they are divided."""
    table = Comparison("Young's modulus of a bar, 200")
    for kind, shape in (("hexahedra", (16, 8, 8)), ("tetrahedra", (6, 3, 3)), ("wedges", (8, 4, 8))):
        nodes, cells, ends = bar(kind, shape)
        path = write(f"{kind}.msh", gmsh_text(nodes, cells, {}))
        left = {name: [k for k, node in enumerate(nodes) if node[d] == at] for name, d, at in (("x0", 0, 0), ("y0", 1, 0), ("z0", 2, 0), ("x1", 0, LENGTH))}
        sides = {name: [face for face in _surface(cells) if set(face) <= set(rows)] for name, rows in left.items()}
        path = write(f"{kind}.msh", gmsh_text(nodes, cells, sides))
        run = run_scene(BAR, {"Domain/Mesh file": path, "Models": f"{FE}, {PD}", "Boundary conditions/Displacement": "", "Boundary conditions/Symmetry": "x0, y0, z0",
                              "Boundary conditions/Traction": "x1: 1, 0, 0", "Peridynamics/Horizon": "0.4", "Peridynamics/Kernel exponent": "0",
                              "Output/Probes": "0.5, 0.5, 0.5 ; 1.5, 0.5, 0.5", "Solver/Tolerance": "1e-10"})
        for model, bound in ((FE, 0.01), (PD, 0.03)):
            stretch = run.probe(model, (1.5, 0.5, 0.5), column="ux") - run.probe(model, (0.5, 0.5, 0.5), column="ux")
            table.add(f"{kind}, {model}", 1 / stretch, 200, relative=1e-7 if model == FE else bound)
    table.show()


def _surface(cells):
    """Faces of one cell only, as their corners follow each other."""
    tables = {4: [(0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)], 6: [(0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)],
              8: [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]}
    found = {}
    for cell in cells:
        for corners in tables[len(cell)]:
            face = tuple(cell[c] for c in corners)
            found.setdefault(tuple(sorted(face)), []).append(face)
    return [faces[0] for faces in found.values() if len(faces) == 1]


def damaged():
    """Formats that are converted, cut short and with changed bytes: read, or one fault that says why; and what no mesh is."""
    generator = random.Random(7)
    out = os.path.join(FOLDER, "converted.msh")
    faults = set()
    for what, path in all_formats().items():
        if what.startswith("msh") or what == "vtu":  # damaged_meshes has the first, meshio the second
            continue
        with open(path, "rb") as file:
            data = file.read()
        for k in range(40):
            broken = bytearray(data[:generator.randrange(len(data))] if k % 2 else data)
            for _ in range(generator.choice((1, 12)) * (k % 2 == 0)):
                broken[generator.randrange(len(broken))] = generator.choice(b"0123456789 .,-*\n\xff")
            name = write("damaged" + os.path.splitext(path)[1], bytes(broken))
            try:
                convert(name, out)
            except Fault as fault:
                faults.add(str(fault)[:20])
            except Exception as error:
                check(False, f"{what}, damage {k}: {type(error).__name__}: {error}")
    check(len(faults) > 5, f"faults that were found: {faults}")
    nodes = bar("tetrahedra", (1, 1, 1))[0]
    for name, data, words in (("none.inp", "*Node\n1, 0, 0, 0\n", ["no elements"]), ("text.inp", "what is this\n", ["no input file of Abaqus"]),
                              ("missing.inp", "*Node\n1, 0, 0\n*Element, type=CPS3\n1, 1, 2, 3\n", ["no node 2"]), ("words.inp", "*Node\n1,0,zero\n", ["*NODE", "zero"]),
                              ("none.unv", "nothing\n", ["no universal file"]), ("none.exo", "nothing", ["no NetCDF file"])):
        try:
            convert(write(name, data), out)
            check(False, f"{name} is converted")
        except Fault as fault:
            check(all(word in str(fault) for word in words), f"{name}: {fault}")
    for name, data, words in (("flat.inp", "*Node\n1,0,0\n2,1,1\n3,2,2\n*Element, type=CPS3\n1, 1, 2, 3\n", ["triangle", "no angle"]),
                              ("text.unv", "nothing\n", ["no universal file"]), ("pyramid.msh", mesh_text([*nodes], ["7 2 0 0 1 2 4 3 5"]), ["pyramid"])):
        status, said, err = run_perideal(["mesh", write(name, data)])
        check_one_message(said, err, ["'Mesh file'", name, *words], name)
    status, said, err = run_perideal(["mesh", "nowhere.inp"])
    check_one_message(said, err, ["nowhere.inp", "cannot be read"], "a file that is not there")


def taken(name, data, dimension=0):
    """Of a file that is converted: nodes of its cells, sides and points by group, as numbers of the file, and notes."""
    out = os.path.join(FOLDER, "taken.msh")
    notes = convert(write(name, data), out, dimension)
    with open(out, encoding="utf-8") as file:
        text = file.read()
    names = {(int(d), int(k)): one for d, k, one in re.findall(r'^(\d) (\d+) "(.*)"$', text, re.MULTILINE)}
    found = {}
    for line in text.split("$Elements\n")[1].splitlines()[1:-1]:
        _, kind, _, group, _, *nodes = map(int, line.split())
        d = {15: 0, 1: 1, 2: 2, 3: 2, 4: 3, 5: 3, 6: 3}[kind]
        found.setdefault((d, names.get((d, group), "")), set()).add(tuple(sorted(nodes)))
    places = dict((int(words[0]), tuple(map(float, words[1:]))) for words in (line.split() for line in text.split("$Nodes\n")[1].split("$End")[0].splitlines()[1:]))
    return found, notes, places


def fault_of(name, data, dimension=0):
    try:
        convert(write(name, data), os.path.join(FOLDER, "taken.msh"), dimension)
    except Fault as fault:
        return str(fault)
    return ""


def check_group(found, key, nodes, what):
    check(found.get(key, set()) == set(map(tuple, nodes)), f"{what}: {key} has {sorted(found.get(key, []))}, expected {sorted(nodes)}; there are {sorted(found)}")


# Four squares side by side: nodes 1 to 5 below and 6 to 10 above, squares 1 to 4.
SQUARES = {k: (k, k + 1, k + 5, k + 6) for k in (1, 2, 3, 4)}
STRIP = ("*Node\n" + "".join(f"{5 * y + x + 1}, {x}., {y}.\n" for y in (0, 1) for x in range(5)) +
         "*Element, type=CPS4R\n" + "".join(f"{k}, {k}, {k + 1}, {k + 6}, {k + 5}\n" for k in (1, 2, 3, 4)))


def cells(*numbers):
    return [SQUARES[k] for k in numbers]


def cae_text(part="", sections="", assembly=""):
    """What Abaqus/CAE writes."""
    return (f"*Heading\n** Job name: Job-1\n*Preprint, echo=NO\n*Part, name=Part-1\n{STRIP}{part}{sections}*End Part\n*Assembly, name=Assembly\n"
            f"*Instance, name=Part-1-1, part=Part-1\n*End Instance\n{assembly}*End Assembly\n*Material, name=Steel\n*Elastic\n200., 0.3\n*Step\n*Static\n*End Step\n")


def sets():
    """What sets of Abaqus and CalculiX become: regions, sides and points."""
    two = "*Elset, elset=Steel\n 1, 2, 3\n*Elset, elset=Iron\n 4,\n"
    sections = "*Solid Section, elset=Steel, material=Steel\n,\n*Solid Section, elset=Iron, material=Iron\n,\n"
    picked = ("*Nset, nset=_PickedSet7, internal, instance=Part-1-1\n 1, 6\n*Elset, elset=_PickedSet7, internal, instance=Part-1-1\n 1,\n"
              "*Elset, elset=_Load_S2, internal, instance=Part-1-1\n 4,\n*Surface, type=ELEMENT, name=Load\n_Load_S2, S2\n"
              "*Elset, elset=unnamed, instance=Part-1-1, internal\n 2, 3\n*Nset, nset=Left, instance=Part-1-1\n 1, 6\n*Elset, elset=Left, instance=Part-1-1\n 1,\n")
    found, notes, _ = taken("picked.inp", cae_text(two, sections, picked))
    for key, expected in {(2, "Steel"): cells(1, 2, 3), (2, "Iron"): cells(4), (1, "Load"): [(5, 10)], (1, "Left"): [(1, 6)]}.items():
        check_group(found, key, expected, "internal sets, and elements beside a side")
    check({name for _, name in found} == {"Steel", "Iron", "Load", "Left"}, f"groups: {sorted(found)}")
    check(any("'Left' is left out: all of its 1 elements" in note for note in notes), f"{notes}")
    # A set for output within a material; the same where one section is that of all: there the set is what tells regions apart.
    probe = "*Elset, elset=Probe\n 2,\n"
    found = taken("probe.inp", cae_text(two + probe, sections))[0]
    check_group(found, (2, "Steel"), cells(1, 2, 3), "a set within a section")
    found = taken("probe.inp", cae_text("*Elset, elset=All, generate\n 1, 4, 1\n" + probe, "*Solid Section, elset=All, material=Steel\n,\n"))[0]
    check_group(found, (2, "Probe"), cells(2), "a set within the one section")
    # Sections of sets that nobody named have the name of their material.
    found = taken("nameless.inp", cae_text("*Elset, elset=_PickedSet2, internal\n 1, 2\n*Elset, elset=_PickedSet3, internal\n 3, 4\n",
                                           "*Solid Section, elset=_PickedSet2, material=Steel\n,\n*Solid Section, elset=_PickedSet3, material=Iron\n,\n"))[0]
    check_group(found, (2, "Steel"), cells(1, 2), "a section of an internal set")
    check_group(found, (2, "Iron"), cells(3, 4), "a section of an internal set")
    own = cae_text(two, sections).replace("*End Instance\n", "").replace("*Part, name=Part-1", "*Instance, name=Part-1-1, part=Part-1")
    own = own.replace("*End Part\n*Assembly, name=Assembly\n*Instance, name=Part-1-1, part=Part-1\n", "*End Instance\n")
    check_group(taken("own.inp", own)[0], (2, "Iron"), cells(4), "an instance with nodes of its own")
    # PrePoMax's names of what was picked.
    found = taken("prepomax.inp", STRIP + "*Elset, Elset=Body\n1, 2, 3, 4\n*Elset, Elset=Internal_Selection-1_Load_S2\n4\n*Surface, Name=Load, Type=Element\n"
                  "Internal_Selection-1_Load_S2, S2\n*Solid section, Elset=Body, Material=Steel\n")[0]
    check({key: len(group) for key, group in found.items()} == {(2, "Body"): 4, (1, "Load"): 1}, f"PrePoMax: {found}")
    # A reference point, which is no place of the body, has the number of a node; one material in two instances tells no regions apart.
    point = ("*Node\n1, 9., 9.\n*Nset, nset=RP\n1,\n*Elset, elset=Soft, instance=Part-1-1\n3,\n*Instance, name=Part-1-2, part=Part-1\n9.\n*End Instance\n")
    status, out, err = run_perideal(["mesh", write("reference.inp", cae_text(assembly=point.split("*Instance")[0]))])
    check(status == 0 and "'RP' is left out" in out + err and "points" not in out, f"a reference point: {out} {err}")
    found = taken("instances.inp", cae_text("*Elset, elset=Steel, generate\n1, 4\n", "*Solid Section, elset=Steel, material=STEEL\n,\n", point))[0]
    check({key: len(group) for key, group in found.items()} == {(2, "Soft"): 1, (2, "Part-1-1.Steel"): 3, (2, "Part-1-2.Steel"): 4}, f"two instances: {found}")
    # One name within the part and in the assembly.
    found = taken("twice.inp", cae_text("*Elset, elset=Set-1\n 1, 2\n", "", "*Nset, nset=Set-1, instance=Part-1-1\n 5, 10\n*Elset, elset=Set-1, instance=Part-1-1\n 4,\n"))[0]
    check_group(found, (2, "Part-1-1.Set-1"), cells(1, 2), "a set of the part")
    check_group(found, (1, "Set-1"), [(5, 10)], "a set of the assembly")
    # Case does not tell names apart; sets of sets, of nodes of elements, of surfaces.
    more = ("*ELSET, ELSET=Ends\n1\n*elset, elset=ENDS\n4\n*ELSET, ELSET=Outer\nends, 3\n*Nset, nset=tip\n10\n*NSET, NSET=Near, ELSET=OUTER\n"
            "*Surface, name=Lower\nEnds, S1\n*SURFACE, NAME=Upper\nOUTER, s3\n*Surface, name=Both, combine=union\nLOWER, upper\n*Surface, name=around\nENDS, \n")
    found, notes, _ = taken("case.inp", STRIP + more)
    check_group(found, (2, "Ends"), cells(1, 4), "sets that differ in case")
    check_group(found, (2, "Outer"), cells(3), "a set of a set")
    check_group(found, (1, "Lower"), [(1, 2), (4, 5)], "a surface on a set in another case")
    check_group(found, (1, "Upper"), [(6, 7), (8, 9), (9, 10)], "a surface on a set in another case")
    check_group(found, (1, "around"), [(1, 6), (5, 10)], "the free faces of elements, but for those in smaller sets")
    check_group(found, (0, "tip"), [(10,)], "a point")
    check(any("'Both' is left out" in note for note in notes) and any("'Near' has whole cells" in note for note in notes), f"{notes}")
    # Members that are not there.
    spring = "*Element, type=SPRINGA, elset=Springs\n 9, 1, 6\n"
    _, notes, _ = taken("missing.inp", STRIP + spring + "*Nset, nset=Left\n1, 6, 77, 78\n*Elset, elset=Part\n1, 9\n")
    check(any("'Left' names 2 nodes that are not there, the first is 77" in note for note in notes), f"{notes}")
    check(any("'Part' names 1 elements that are left out" in note for note in notes) and any("1 elements of type SPRINGA" in note for note in notes), f"{notes}")
    for data, words in (("*Nset, nset=Left\n1, Lfet\n", ["no set of nodes 'Lfet'", "'Left'"]), ("*Surface, name=Load\nRihgt, S2\n", ["'Rihgt'", "'Load'"]),
                        ("*Solid Section, elset=Stel, material=Steel\n,\n", ["'Stel'", "section"]), ("*Elset, elset=A\nB\n*Elset, elset=B\nA\n", ["ring"]),
                        ("*Nset, nset=Left, instance=Part-9\n1\n", ["no instance 'Part-9'"]), ("*Surface, name=Load\n1, S7\n", ["face 7", "'Load'"])):
        fault = fault_of("unknown.inp", STRIP + data)
        check(all(word in fault for word in words), f"{data!r}: '{fault}'")


def dialects():
    """How else lines of Abaqus and CalculiX, and of other programs, look."""
    # Fields that hold nothing are 0.
    _, _, places = taken("blank.inp", STRIP.replace("1, 0., 0.\n", "1, , \n").replace("7, 1., 1.\n", "7, 1.D0, 1., ,\n").replace("6, 0., 1.\n", "6, , 1.\n"))
    check(places[1] == (0, 0, 0) and places[6] == (0, 1, 0) and places[7] == (1, 1, 0), f"{places}")
    _, _, places = taken("short.inp", STRIP.replace("1, 0., 0.\n", "1, 0.\n").replace("2, 1., 0.\n", "2, 1., 0., 0.\n"))
    check(places[1] == (0, 0, 0) and places[2] == (1, 0, 0) and places[3] == (2, 0, 0), f"{places}")
    _, _, places = taken("blanks.inp", "*Node\n1, , 1\n2, 1, 1\n3, 1, 2\n*Element, type=CPE3H\n1, 1, 2, 3\n")
    check(places == {1: (0, 1, 0), 2: (1, 1, 0), 3: (1, 2, 0)}, f"{places}")
    moved = lambda lines: taken("moved.inp", cae_text().replace("part=Part-1\n", f"part=Part-1\n{lines}"))[2]
    check(moved(",, 5.\n")[2] == (1, 0, 5) and moved(" 1., , 0.\n")[5] == (5, 0, 0), "an instance that is shifted")
    turned = moved(" 2., 0., 0.\n 2., 0., 0., 2., 0., 1., 90.\n")
    check(all(abs(x - y) < 1e-12 for x, y in zip(turned[10], (1, 4, 0))), f"an instance that is shifted, and turned about z: {turned[10]}")
    # Line ends, marks, tabs, names of other languages and in quotes, lines that go on, included files.
    other = "*ELSET,\n ELSET=\u00c5\u2026,\n GENERATE\n1, 3, 2\n*Nset, nset=\"left, lower\"\n1,\n6,\n*NSET,NSET=Right,\n5,10\n"
    write("right.inc", "*Include, input=in.inc\n")
    write("in.inc", "10\n")
    for what, data in (("UTF-8", other.encode()), ("with its mark and Windows' line ends", b"\xef\xbb\xbf" + other.replace("\n", "\r\n").encode()),
                       ("tabs", other.replace(", ", ",\t").encode()), ("included data", other.replace("5,10\n", "5\n*INCLUDE, INPUT=right.inc\n").encode())):
        start = b"\xef\xbb\xbf" if data.startswith(b"\xef") else b""
        found = taken("OTHER.INP", start + STRIP.encode() + data[len(start):])[0]
        check_group(found, (2, "\u00c5\u2026"), cells(1, 3), what)
        check_group(found, (1, "left, lower"), [(1, 6)], what)
        check_group(found, (1, "Right"), [(5, 10)], what)
    # Element types whose names are alike, over two lines, with second-order nodes; what is left out is told.
    cube = "*Node\n" + "".join(f"{k + 1}, {k & 1}, {k >> 1 & 1}, {k >> 2}\n" for k in range(8)) + "".join(f"{k}, 0, 0, 0\n" for k in range(9, 21))
    corners = (1, 2, 4, 3, 5, 6, 8, 7)
    twenty = f"*Element, type=C3D20R, elset=E\n1, {', '.join(map(str, corners))}, 9, 10, 11, 12, 13, 14, 15,\n16, 17, 18, 19, 20\n"
    found, notes, _ = taken("twenty.inp", cube + twenty + "*Element, type=S4R5, elset=skin\n2, 1, 2, 4, 3\n*Element, type=F3D4\n3, 1, 2, 4, 3\n*Element, type=R3D4\n4, 5, 6, 8, 7\n")
    check_group(found, (3, "E"), [tuple(range(1, 9))], "C3D20R")
    check_group(found, (2, "skin"), [(1, 2, 3, 4)], "S4R5")
    check(any("type F3D4" in note for note in notes) and any("2 quadrilaterals" in note for note in notes), f"{notes}")
    found, tied, _ = taken("shells.inp", cube + twenty + "*Element, type=S4\n2, 1, 2, 4, 3\n*Surface, name=base\n2, SPOS\n*Tie, name=glue\na, b\n")
    check_group(found, (2, "base"), [(1, 2, 3, 4)], "SPOS of a shell")
    _, notes, _ = taken("edges.inp", cube + twenty + "*Element, type=T3D2, elset=rim\n2, 1, 2\n")
    check(any("'rim' names 1 elements" in note for note in notes) and any("1 lines are no cells" in note for note in notes), f"{notes}")
    check(any("*TIE" in note and "apart" in note for note in tied), f"{tied}")
    # CalculiX numbers faces of shells 1, 2 and then edges.
    shells = STRIP.replace("CPS4R", "S4")
    found, notes, _ = taken("plane.inp", shells + "*Surface, name=bottom\n1, S3\n*Surface, name=right\n4, S4\n*Surface, name=left\n1, E4\n*Surface, name=face\n1, SPOS\n")
    check(any("'face' names 1 elements" in note for note in notes), f"{notes}")
    for side, edge in (("bottom", (1, 2)), ("right", (5, 10)), ("left", (1, 6))):
        check_group(found, (1, side), [edge], "edges of shells")
    lacking = STRIP.replace("2, 2, 3, 8, 7\n", "2, 2, 3, 8\n").replace("3, 3, 4, 9, 8\n", "3, 3, 4, 9, 8, 7\n")
    for data, words in ((lacking, ["CPS4R", "'3, 3, 4, 9, 8, 7'"]), (STRIP.replace("2, 2, 3, 8, 7", "2, 2, , 8, 7"), ["CPS4R", "'2, 2, , 8, 7'"]), (STRIP + "*Ngen\n1, 5, 1\n", ["*NGEN", "not read"]), (STRIP + "*Elgen\n1, 5\n", ["*ELGEN"]), ("*System\n1, 0, 0\n" + STRIP, ["*SYSTEM"]),
                        (cae_text().replace("part=Part-1\n", "part=Part-2\n"), ["'PART-2'"]), (STRIP + "*Include, input=none.inc\n", ["none.inc"])):
        fault = fault_of("maker.inp", data)
        check(all(word in fault for word in words), f"{data[-40:]!r}: '{fault}'")
    # UNV with coordinates of the dataset 15, groups of pairs, units, edges of second order, members that are not there.
    rows = lambda *lines: "".join("".join(f"{number:10d}" for number in line) + "\n" for line in lines)
    unv = ("    -1\n   164\n         5mm (milli)                  2\n  1.0D+03  1.0D+00  1.0D+00\n  0.0\n    -1\n    -1\n    15\n" +
           "".join(f"{k:10d}{0:10d}{0:10d}{11:10d}{x:13.5E}{y:13.5E}{0:13.5E}\n" for k, x, y in ((1, 0, 0), (2, 1, 0), (3, 1, 1), (4, 0, 1), (5, .5, 0))) +
           "    -1\n    -1\n  2412\n" + rows((1, 44, 1, 1, 7, 4), (1, 2, 3, 4), (2, 22, 1, 1, 7, 3), (0, 1, 1), (1, 5, 2)) +
           "    -1\n    -1\n  2430\n" + rows((1, 0, 0, 0, 0, 0, 0, 1)) + "below\n" + rows((8, 2), (2, 0, 0, 0, 0, 0, 0, 3)) + "left\n" + rows((7, 1, 7, 4, 7, 99)) + "    -1\n")
    found, notes, _ = taken("old.UNV", unv)
    check_group(found, (1, "below"), [(1, 2)], "UNV, pairs")
    check_group(found, (1, "left"), [(1, 4)], "UNV, pairs")
    check(any("'left' names 1 nodes" in note for note in notes) and any("164" in note for note in notes), f"{notes}")


def others():
    """MED's families and numbers of cells in VTK, where meshio is there."""
    try:
        import meshio
        import numpy
    except ImportError:
        return
    points = [(x, y, 0.) for y in (0, 1) for x in range(5)]
    squares = numpy.array([(k, k + 1, k + 6, k + 5) for k in range(4)])
    mesh = meshio.Mesh(points, [("quad", squares), ("line", numpy.array([(0, 5)]))], cell_data={"cell_tags": [numpy.array([-6, -6, -7, -7]), numpy.array([-8])]})
    mesh.cell_tags = {-6: ["Steel", "All"], -7: ["All"], -8: ["Left"]}
    mesh.point_tags = {}
    path = os.path.join(FOLDER, "families.med")
    meshio.write(path, mesh)
    with open(path, "rb") as file:
        found = taken("families.med", file.read(), 2)[0]
    check_group(found, (2, "Steel"), cells(1, 2), "MED")
    check_group(found, (2, "All"), cells(3, 4), "MED")
    check_group(found, (1, "Left"), [(1, 6)], "MED")
    mesh = meshio.Mesh(points, [("quad", squares[:3]), ("triangle", numpy.array([(3, 4, 9), (3, 9, 8)])), ("vertex", numpy.array([(9,)]))],
                       cell_data={"partition_id": [numpy.array(numbers) for numbers in ([1, 1, 2], [2, 2], [1])],
                                  "MaterialIds": [numpy.array(numbers) for numbers in ([5, 0, 7], [7, 7], [3])]})
    path = os.path.join(FOLDER, "mixed.vtk")
    meshio.write(path, mesh)
    with open(path, "rb") as file:
        found, notes, _ = taken("mixed.vtk", file.read(), 2)
    check_group(found, (2, "5"), cells(1), "VTK")
    check_group(found, (2, "7"), [*cells(3), (4, 5, 10), (4, 9, 10)], "VTK")
    check_group(found, (0, "3"), [(10,)], "VTK")
    check(any("'MaterialIds'" in note for note in notes), f"{notes}")


def exodus():
    """Numbers of sides of shells, classic and in NetCDF 4 with 64-bit integers; numbers of sets; points beside the body."""
    ints = lambda numbers: struct.pack(f">{len(numbers)}i", *numbers)
    for kind, connect, sides in (("SHELL4", [1, 2, 4, 3, 2, 5, 6, 4], {3: [(1, 2)], 6: [(1, 3)]}), ("QUAD4", [1, 2, 4, 3, 2, 5, 6, 4], {1: [(1, 2)], 4: [(1, 3)]}),
                                 ("TRI3", [1, 2, 3, 2, 4, 3], {3: [(1, 2)], 5: [(1, 3)]}), ("TRISHELL3", [1, 2, 3, 2, 4, 3], {3: [(1, 2)], 5: [(1, 3)]})):
        places = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (2, 0, 0), (2, 1, 0)]
        n = len(connect) // 2
        numbers = list(sides)
        sizes = {"num_nodes": 6, "num_el": 2, "corners": n, "one": 1, "two": 2}
        data = [(f"coord{axis}", ["num_nodes"], 6, struct.pack(">6d", *(place[d] for place in places)), None) for d, axis in enumerate("xyz")]
        data += [("ss_prop1", ["two"], 4, ints([20, 10]), None), ("connect1", ["one", "corners"], 4, ints([1] * n), "SPHERE"), ("connect2", ["two", "corners"], 4, ints(connect), kind),
                 ("eb_prop1", ["two"], 4, ints([7, 8]), None)]
        for k, side in enumerate(numbers, 1):
            data += [(f"elem_ss{k}", ["one"], 4, ints([2]), None), (f"side_ss{k}", ["one"], 4, ints([side]), None)]
        expected = dict(zip(("sideset_20", "sideset_10"), sides.values()))
        files = {"classic": netcdf_bytes(sizes, data)}
        try:
            import h5py
            import numpy
            path = os.path.join(FOLDER, "four.exo")
            with h5py.File(path, "w") as file:
                for key, of, code, raw, attribute in data:
                    values = numpy.frombuffer(raw, dtype={6: ">f8", 4: ">i4"}[code]).reshape([sizes[one] for one in of])
                    file[key] = values.astype("<i8" if code == 4 else "<f8")
                    if attribute:
                        file[key].attrs["elem_type"] = numpy.bytes_(attribute)
            with open(path, "rb") as file:
                files["NetCDF 4"] = file.read()
        except ImportError:
            pass
        for what, raw in files.items():
            found, notes, _ = taken("plane.e", raw, dimension=2)
            for side, edges in expected.items():
                check_group(found, (1, side), edges, f"{kind}, {what}")
            check(any("SPHERE" in note for note in notes), f"{notes}")
            status, out, err = run_perideal(["mesh", os.path.join(FOLDER, "taken.msh")]) if kind == "SHELL4" else (0, "(20) (10)", "")
            check(status == 0 and "(20)" in out and "(10)" in out, f"numbers of side sets: {out} {err}")


def unfit():
    """Cells that do not fit each other, or fold between their corners: refused with the place, or a note."""
    cube = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    box = "5 2 0 0 1 2 4 3 5 6 8 7"
    two = [*cube, (.5, .5, 2), (2, .5, .5)]
    flipped = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (.5, .5, 1), (.5, .5, -1)]
    folded = [(-.7, .1, .2), (.5, -.2, .3), (.5, 1.1, 0), (.2, 1.5, .1), (.7, -.1, 1.3), (.8, 0, .8), (.4, .9, 1.5), (.5, .3, .7)]
    for name, nodes, elements, words in (
            ("quads.msh", two, [box, "4 2 0 0 5 6 8 9", "4 2 0 0 5 8 7 9"], ["hexahedron 1", "tetrahedron", "(0.5, 0.5, 1)", "triangles against a quadrilateral"]),
            ("wedge.msh", two, ["6 2 0 0 1 2 4 5 6 8", "4 2 0 0 2 4 8 10", "4 2 0 0 2 8 6 10"], ["wedge 1", "triangles against a quadrilateral", "(1, 0.5, 0.5)"]),
            ("flipped.msh", flipped, ["4 2 0 0 1 2 3 5", "4 2 0 0 1 3 4 5", "4 2 0 0 1 2 4 6", "4 2 0 0 2 3 4 6"], ["diagonals", "(0.5, 0.5, 0)"]),
            ("folded.msh", folded, ["5 2 0 0 1 2 3 4 5 6 7 8"], ["cell 1", "folded", "inside"]),
            ("divided.msh", [*folded, (5, 0, 0), (6, 0, 0), (5, 1, 0), (5, 0, 1)], ["5 2 0 0 1 2 3 4 5 6 7 8", "4 2 0 0 9 10 11 12"], ["cell 1", "folded", "divided"]),
            ("curved.msh", [(0, 0, 0), (1, 0, 0), (1, 1, .1), (0, 1, 0)], ["3 2 0 0 1 2 3 4"], ["z from 0 to 0.1", "dimension 2"])):
        status, said, err = run_perideal(["mesh", write(name, mesh_text(nodes, elements))])
        check(status == 1, f"{name}: {said}")
        check_one_message(said, err, ["'Mesh file'", name, *words], name)
    fits = [box, "4 2 0 0 2 4 6 10", "4 2 0 0 4 6 8 10"]
    check(run_perideal(["mesh", write("fits.MSH", "\ufeff" + mesh_text(two, [fits[0]]))])[0] == 0, "a Gmsh file with a mark and capital letters")
    corner = [(0, 0), (1, 0), (0, 1), (1, 1), (2, 1), (1, 2), (2, 2)]
    status, said, err = run_perideal(["mesh", write("corner.msh", mesh_text(corner, ["3 2 0 0 1 2 4 3", "3 2 0 0 4 5 7 6"]))])
    check(status == 0 and "at 1 nodes" in said + err and "(1, 1)" in said + err, f"two squares at a corner: {said} {err}")
    # Instances whose nodes lie on each other are apart.
    parts = cae_text(assembly="*Instance, name=Part-1-2, part=Part-1\n 4.,,\n*End Instance\n")
    status, said, err = run_perideal(["mesh", write("apart.inp", parts)])
    check(status == 0 and "4 nodes lie on a node" in said + err and "2 pieces that have no nodes in common" in said + err, f"{said} {err}")


if __name__ == "__main__":
    run_parts(formats, bars, damaged, sets, dialects, exodus, others, unfit)
