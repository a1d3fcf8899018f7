# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Diyaroglu, Oterkus, Oterkus and Madenci (2017)."""

import numpy as np

import closed_forms as exact
import figures
from results import FEM, extrapolated, fitted_order, largest
from lines import Line, Paper, Picture, Table

TIMES, CELLS, RATIOS = (100, 500, 2000, 5000), (20, 50, 100, 200, 400), (1, 3, 6, 12, 24, 60)
CONTRASTS = {"1": "k1 = k2 = k", "2": "k1 = k/2", "10": "k1 = k/10"}


def bar(points, t):
    return exact.hot_ends(points[:, 0], t)


def measure(row, t):
    """The paper's global error: root mean square over the largest exact value."""
    points, values = row.line(t)
    wanted = bar(points, t)
    return float(np.sqrt(np.mean((values - wanted)**2)) / np.max(np.abs(wanted)))


def bar_line(what, name, model=None):
    def compute(study):
        errors = []
        for t in TIMES:
            points, values = study[name].line(t, model)
            errors.append(largest(values, bar(points, t)))
        return errors
    return Line(what, name, compute)


def shock_line(what, name, model=None):
    def compute(study):
        errors = []
        for t in (3, 6):
            points, values = study[name].line(t, model)
            wanted = exact.thermal_shock(points[:, 0], t)
            errors.append(largest(values, wanted) / np.max(wanted))
        return errors
    return Line(what, name, compute)


def reference(study, contrast):
    return extrapolated(*(study[f"example_c_elements_{contrast}_{c}"].line(500, FEM)[1] for c in (200, 400)))


def two_materials(what, name, contrast):
    return Line(what, [name] + [f"example_c_elements_{contrast}_{c}" for c in (200, 400)],
                lambda study: [largest(study[name].line(500)[1], reference(study, contrast))])


def weight_line(what, name):
    def compute(study):
        times, weights = study[name].totals("weight")
        weights = dict(zip(times, 8 * weights))
        return [weights[120.0]] + [weights[t] / exact.slab_weight(t) - 1 for t in (5.0, 20.0, 60.0)]
    return compute


def order_line(what, prefix):
    return Line(what, [f"{prefix}{c}" for c in reversed(CELLS)],
                lambda study: [fitted_order([1 / c for c in CELLS[1:]], [measure(study[f"{prefix}{c}"], t) for c in CELLS[1:]]) for t in TIMES])


def draw_bar(study, path):
    temperatures, wanted = [], []
    for t in TIMES:
        points, values = study["example_a_100"].line(t)
        temperatures.append((f"t = {t}", points[:, 0], values))
        wanted.append(np.where(points[:, 0] > 0.99, np.nan, bar(points, t)))
    temperatures.append(("exact", np.tile(points[:, 0], len(TIMES)), np.concatenate(wanted)))
    figures.curves(path, [("Fig. 6: temperature", temperatures, None)], "x (m)", "Temperature (°C)", markers=False, size=(3.6, 2.6))


def draw_errors(study, path):
    panels = []
    for title, prefix in (("Fig. 7: as published", "example_a_"), ("Fig. 7: ours", "example_a_ours_")):
        panels.append((title, [(f"t = {t}", [1 / c for c in CELLS], [measure(study[f"{prefix}{c}"], t) for c in CELLS]) for t in TIMES], None))
    figures.curves(path, panels, "spacing (m)", "global error", log_x=10, log_y=True)
    panels = []
    for title, prefix in (("Fig. 8: as published", "example_a_m"), ("Fig. 8: ours", "example_a_mirror_m")):
        panels.append((title, [(f"t = {t}", RATIOS, [measure(study[f"{prefix}{m}"], t) for m in RATIOS]) for t in TIMES], None))
    figures.curves(path.with_name("diyaroglu_2017_nonlocality.png"), panels, "m", "global error", log_x=10, log_y=True)


def draw_shock(study, path):
    lines = []
    for t in (3, 6):
        for label, name in (("as published", "example_b"), ("ours", "example_b_ours")):
            points, values = study[name].line(t)
            lines.append((f"{label}, t = {t}", points[:, 0], values))
        lines.append(("exact" if t == 3 else "_exact", points[:, 0], exact.thermal_shock(points[:, 0], t)))
    two = []
    for contrast, label in CONTRASTS.items():
        points, values = study[f"example_c_{contrast}"].line(500)
        two.append((label, points[:, 1], values))
    wanted = [np.append(reference(study, contrast), np.nan) for contrast in CONTRASTS]
    two.append(("finite elements", np.tile(np.append(points[:, 1], np.nan), 3), np.concatenate(wanted)))
    figures.curves(path, [("Fig. 10: T(x, 0)", lines, None)], "x (m)", "Temperature (°C)", markers=False, size=(3.6, 2.6))
    figures.curves(path.with_name("diyaroglu_2017_example_c.png"), [("Fig. 13: T(0, y), t = 500 s, as published", two, None)], "y (m)", "Temperature (°C)", markers=False, size=(3.8, 2.7))


def draw_materials(study, path):
    figures.field_grid(path, [(label.replace("k1", "k₁").replace("k2", "k₂"), study[f"example_c_{c}"].folder, (100, 500)) for c, label in CONTRASTS.items()])


def section(published):
    """The section of this paper."""
    bars = [bar_line("as published, 100 nodes", "example_a_100"), bar_line("ours, 100 nodes", "example_a_ours_100"), bar_line("finite elements, 100 cells", "example_a_elements_100", FEM)]
    spacings = [Line(f"as published, spacing {1 / c:g}", f"example_a_{c}", lambda study, c=c: [measure(study[f"example_a_{c}"], t) for t in TIMES]) for c in CELLS]
    spacings += [Line(f"ours, spacing {1 / c:g}", f"example_a_ours_{c}", lambda study, c=c: [measure(study[f"example_a_ours_{c}"], t) for t in TIMES]) for c in CELLS]
    orders = [order_line("as published", "example_a_"), order_line("ours", "example_a_ours_")]
    nonlocality = [Line(f"as published, m = {m}", f"example_a_m{m}", lambda study, m=m: [measure(study[f"example_a_m{m}"], t) for t in TIMES]) for m in RATIOS]
    nonlocality += [Line(f"ours, m = {m}", f"example_a_mirror_m{m}", lambda study, m=m: [measure(study[f"example_a_mirror_m{m}"], t) for t in TIMES]) for m in RATIOS]
    shock = [shock_line("as published", "example_b"), shock_line("ours", "example_b_ours"), shock_line("finite elements, 100 x 100 cells", "example_b_elements", FEM)]
    materials = []
    for contrast, label in CONTRASTS.items():
        materials += [two_materials(f"{label}, as published", f"example_c_{contrast}", contrast), two_materials(f"{label}, ours", f"example_c_ours_{contrast}", contrast)]
    weight = published["Section IV D"]["saturated weight in mg"]
    slab = [Line("as published", "example_d", weight_line("", "example_d"), [weight, None, None, None]),
            Line("ours", "example_d_ours", weight_line("", "example_d_ours"), [weight, None, None, None])]
    times = [f"t = {t}" for t in TIMES]
    tables = [
        Table("bar", "Fig. 6: example A, a bar with hot ends", "A picture, against finite elements of the paper. Largest difference from the series in degrees.", times, bars, kind="picture", digits=3,
              after="The paper finds both to agree very well. A constant layer as it describes it leaves 2 degrees at 500 s, 2 % of the scale of its picture."),
        Table("spacings", "Fig. 7: example A, smaller spacings at m = 3", "A picture. The paper's global error.", times, spacings, kind="picture", digits=3),
        Table("orders", "Fig. 7: observed orders", "Fitted over the spacings 0.02 to 0.0025.", times, orders, kind="picture", digits=3,
              after="The constant layer is of first order, mirrored nodes are of second."),
        Table("nonlocality", "Fig. 8: example A, larger m at spacing 0.0025", "A picture. The paper's global error.", times, nonlocality, kind="picture", digits=3),
        Table("shock", "Fig. 10: example B, a thermal shock", "A picture. Largest difference along y = 0 from the closed form, as a share of the largest temperature.", ["t = 3", "t = 6"], shock, kind="picture", digits=3,
              tolerance=2e-3),
        Table("materials", "Fig. 13: example C, two materials and a crack, t = 500 s", "A picture. Diffusivity 1.14e-4 m^2/s (centimetre units), material 1 on top. Largest difference along x = 0.005 "
              "from our finite elements with the crack cut into the mesh, 200 x 200 and 400 x 400 cells extrapolated, in degrees.", ["largest"], materials, kind="picture", digits=3, tolerance=2e-3),
        Table("slab", "Fig. 16: example D, moisture in a slab", "Weight at 120 h in mg; published is the saturated weight, and a picture of the way to it. Then the weight at earlier times over the closed form, minus 1.",
              ["mg at 120 h", "5 h", "20 h", "60 h"], slab, digits=5, after="The exact weight at 120 h is 23.747 mg.")]
    pictures = [Picture("diyaroglu_2017_example_a", "Fig. 6: example A, as published.", ["example_a_100"], draw_bar),
                Picture("diyaroglu_2017_orders", "Fig. 7.", [f"example_a_{c}" for c in CELLS] + [f"example_a_ours_{c}" for c in CELLS] + [f"example_a_m{m}" for m in RATIOS] + [f"example_a_mirror_m{m}" for m in RATIOS], draw_errors),
                Picture("diyaroglu_2017_nonlocality", "Fig. 8.", [], None),
                Picture("diyaroglu_2017_example_b", "Fig. 10: example B.", ["example_b", "example_b_ours"] + [f"example_c_{c}" for c in CONTRASTS] + [f"example_c_elements_{c}_{n}" for c in CONTRASTS for n in (200, 400)], draw_shock),
                Picture("diyaroglu_2017_example_c", "Fig. 13: example C.", [], None),
                Picture("diyaroglu_2017_fields", "Fig. 14: example C at 100 s and 500 s, as published.", [f"example_c_{c}" for c in CONTRASTS], draw_materials)]
    return Paper("diyaroglu_2017", "Diyaroglu et al. (2017): bar, thermal shock, two materials, moisture",
                 "C. Diyaroglu, S. Oterkus, E. Oterkus, E. Madenci, Peridynamic modeling of diffusion by using finite-element analysis, IEEE Transactions on Components, Packaging and Manufacturing Technology 7 (2017) 1823-1831.",
                 "As published: kernel exponent 1, cell centres, horizon 3.015 spacings (D: 1.733), linear volume correction, surface correction by energy, constant fictitious layers as long as the horizon. Its implicit "
                 "steps are replaced by steps small enough not to matter. Ours: conical kernel, exponent 2, m = 3, discrete calibration, mirrored nodes and symmetry planes.", tables, pictures)
