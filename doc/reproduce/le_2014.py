# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Le, thesis, North Carolina State University (2014), chapter 2: plane elasticity; chapter 3 is in le_2014_wires."""

import numpy as np

import figures
import le_2014_wires
from results import FEM, PD, fitted_order
from lines import Line, Paper, Picture, Table

LENGTH = 100.0
RATIOS = (2, 3, 4, 5, 6, 7, 8)
HORIZONS = ("3", "2", "1_5", "1")
CORNERS = ("5", "4", "3", "2", "1_5", "1")
FITTED = ("3", "2", "1_5")


def length(name):
    return float(name.replace("_", "."))


def end_displacement(row, horizon):
    """u_x of the inside drawn on to the loaded side: a straight line through the nodes 2 to 4 horizons from it."""
    x, u = row.columns("line.csv", ("x", "ux"), PD)
    inside = (x < LENGTH - 2 * horizon + 1e-9) & (x > LENGTH - 4 * horizon)
    return float(np.polyval(np.polyfit(x[inside], u[inside], 1), LENGTH))


def at_hole(row, model=PD):
    """Von Mises' stress of the first probe."""
    return float(row.columns("probes.csv", ("von_mises",), model)[0][0])


def of_elements(study):
    """u_x(100, 25)."""
    return float(study["elements"].columns("probes.csv", ("ux",), FEM)[0][1])


def below_elements(study, name, horizon):
    return 100 * (end_displacement(study[name], horizon) / of_elements(study) - 1)


def plate_line(what, name, horizon):
    return Line(what, [name, "elements"], lambda study: [below_elements(study, name, horizon), at_hole(study[name])])


def corner_slope(study):
    return [fitted_order([length(h) for h in FITTED], [at_hole(study[f"corner_{h}"]) for h in FITTED])]


def draw(study, path):
    over_m = [("horizon 3 mm", RATIOS, [below_elements(study, f"hole_3_m{m}", 3) for m in RATIOS])]
    horizons = [length(h) for h in HORIZONS]
    over_h = [("m = 5", horizons, [below_elements(study, f"hole_{h}_m5", length(h)) for h in HORIZONS])]
    sizes = np.array([length(h) for h in CORNERS])
    stresses = np.array([at_hole(study[f"corner_{h}"]) for h in CORNERS])
    corner = [("m = 5", sizes, stresses), ("exact exponent", sizes, stresses[3] * (sizes / sizes[3]) ** -0.4555)]
    figures.curves(path, [("Fig. 2.5: u_x of the end", over_m, 0)], "m", "percent above finite elements", size=(3.2, 2.4))
    figures.curves(path.with_name("le_2014_delta.png"), [("Fig. 2.7: u_x of the end", over_h, 0)], "horizon (mm)", "percent above finite elements", size=(3.2, 2.4))
    figures.curves(path.with_name("le_2014_corner.png"), [("Fig. 2.12: von Mises at the corner", corner, None)], "horizon (mm)", "MPa", log_x=2, log_y=True, size=(3.4, 2.4))


def section(published):
    """The section of this paper."""
    top = published["Section 2.5.2"]["von Mises at the top of the hole"]
    hole = [Line("finite elements, quadratic", "elements", lambda study: [at_hole(study["elements"], FEM)], [top]),
            Line("finite elements, bilinear", "elements_bilinear", lambda study: [at_hole(study["elements_bilinear"], FEM)], [top])]
    hole += [Line(f"peridynamics, horizon {length(h):g} mm, m = 5", f"hole_{h}_m5", lambda study, h=h: [at_hole(study[f"hole_{h}_m5"])], [top]) for h in HORIZONS]
    over_h = [plate_line(f"horizon {length(h):g} mm, m = 5", f"hole_{h}_m5", length(h)) for h in HORIZONS]
    over_m = [plate_line(f"horizon 3 mm, m = {m}", f"hole_3_m{m}", 3) for m in RATIOS]
    influence = [plate_line(what, name, 3) for what, name in (
        ("1", "hole_3_m5"), ("conical, the default", "influence_conical_0"), ("1/r", "influence_constant_1"), ("conical/r", "influence_conical_1"), ("conical/r²", "influence_conical_2"))]
    corner = [Line(f"horizon {length(h):g} mm", f"corner_{h}", lambda study, h=h: [at_hole(study[f"corner_{h}"])]) for h in CORNERS]
    columns = ["u_x of the end, percent above finite elements", "von Mises above the hole"]
    tables = [
        Table("hole", "Section 2.5.2: stress at the top of the hole", "In MPa, under 1 MPa. The text says about 3.7 for both models, read off Fig. 2.8. Peridynamics: the node next to the hole near x = 50.", ["von Mises"], hole, digits=4,
              after="3.77 of finite elements, 3.774 on a mesh twice as fine, is what the finite width gives. The peridynamic peak does not converge to it: it is the stress in a skin of cut families, at a distance from the hole that the lattice decides."),
        Table("delta", "Figs. 2.7 and 2.8: delta-convergence", "Pictures. u_x along y = 25 is fitted by a straight line between 2 and 4 horizons from the loaded side and drawn on to x = 100, since the outermost nodes, which carry the load with few bonds, move further.",
              columns, over_h, kind="picture", digits=3, after="The plate is too stiff along its free sides and the hole, in proportion to the horizon: a node with half a family shares the force of its missing bonds among those that are left."),
        Table("m", "Figs. 2.5 and 2.6: m-convergence at a horizon of 3 mm", "Pictures. The same two numbers.", columns, over_m, kind="picture", digits=3,
              after="The paper finds m = 5 close enough. By our numbers the end still moves by 1.4 % from m = 5 to 8: at cell centres the held column stands half a spacing inside the plate, and skins follow the spacing as well as the horizon. "
              "The stress depends on where the first node above the hole lies."),
        Table("influence", "Figs. 2.5 and 2.6: other influence functions", "Horizon 3 mm, m = 5. The paper does not name its own.", columns, influence, kind="picture", digits=3),
        Table("corner", "Fig. 2.12: stress above the corner of a square hole", "A picture. Von Mises' stress in MPa of the node next to the upper corner, m = 5.", ["von Mises"], corner, kind="picture", digits=4),
        Table("slope", "Fig. 2.12: the power of the horizon", "Fitted over 3, 2 and 1.5 mm. The stress at a corner of 90 degrees grows with distance to the power -0.4555 (Williams).", ["exponent"],
              [Line("m = 5", [f"corner_{h}" for h in reversed(FITTED)], corner_slope)], kind="picture", digits=3)]
    tables += le_2014_wires.tables(published)
    drawn = sorted({f"hole_3_m{m}" for m in RATIOS} | {f"hole_{h}_m5" for h in HORIZONS} | {f"corner_{h}" for h in CORNERS} | {"elements"})
    pictures = [Picture("le_2014_m", "Fig. 2.5: m-convergence.", drawn, draw), Picture("le_2014_delta", "Fig. 2.7: delta-convergence.", [], None),
                Picture("le_2014_corner", "Fig. 2.12: stress above the corner.", [], None)] + le_2014_wires.pictures()
    return Paper("le_2014", "Le (2014): plates with a round and with a square hole, and wires",
                 "Q. V. Le, Relationship between microstructure and mechanical properties in Bi2Sr2CaCu2Ox round wires using peridynamic simulation, thesis, North Carolina State University (2014); the model: Q. V. Le, W. K. Chan, "
                 "J. Schwartz, A two-dimensional ordinary, state-based peridynamic model for linearly elastic solids, Int. J. Numer. Meth. Engng 98 (2014) 547-561.",
                 "Chapter 2 as published: nodes at the centres of square cells, those in the hole left out, volume fraction of equation 2.50, influence function 1, the outermost column of nodes held and loaded. 50 mm divided by horizon/m is rounded to a "
                 "whole number of cells. Chapter 3: a cell for each pixel of 0.56 micrometres, ten more layers of silver around the image, horizon of five cells, influence function 1, bonds cut at voids.",
                 tables, pictures)
