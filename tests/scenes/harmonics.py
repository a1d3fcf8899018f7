# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Products of sines, which keep their shape and decay with a known rate: every error can be looked at by itself.

    harmonics.py exact       all kernels, exponents and dimensions: round-off against the rate of the lattice
    harmonics.py variants    cell centres, rectangular cells, stored bonds, other volume fractions
    harmonics.py time        orders of the time steppers
    harmonics.py elements    finite elements: orders in h
    harmonics.py space       peridynamics: orders in m and in the horizon
    harmonics.py fine_space  the same up to finer lattices
"""

import math

from scene_test import Comparison, check, observed_orders, print_table, run_parts, run_scene

SCENES = {1: "prm/heat/harmonic_1d.prm", 2: "prm/heat/harmonic_2d.prm", 3: "prm/heat/harmonic_3d.prm"}

# Rates of an independent program on 20 cells, horizon ratio m, all wave numbers 1: (dimension, m,
# kernel): exponents 0, 1, 2. Beyond the horizon the constant and the gaussian kernel go on as far
# as the linear volume fraction does.
RATES = {(1, 4, "constant"): (9.6632771539588, 9.69874355642944, 9.74311667614839),
         (1, 4, "conical"): (9.73411989596521, 9.76593062469284, 9.79711490608956),
         (1, 4, "gaussian"): (9.76385471710018, 9.79228572387711, 9.81600705338756),
         (2, 3, "constant"): (19.3504712840649, 19.3927794156245, 19.4464026787584),
         (2, 3, "conical"): (19.4541887752557, 19.5001227089786, 19.5482242423404),
         (2, 3, "gaussian"): (19.5136903469776, 19.5564502687756, 19.5958055800045),
         (2, 6.5, "constant"): (18.0770802749702, 18.2441738723427, 18.4847341736058),
         (2, 6.5, "conical"): (18.529110953687, 18.7222527201194, 18.961430905011),
         (2, 6.5, "gaussian"): (18.6967544282156, 18.909891200033, 19.1416433693962),
         (3, 3, "constant"): (28.8481766586912, 28.9072520710594, 28.9818934484461),
         (3, 3, "conical"): (29.0255490359774, 29.095421996098, 29.1739370556158),
         (3, 3, "gaussian"): (29.1251162553531, 29.1968187756035, 29.2703989196857)}


def run_harmonic(dim, cells, modes, reference="lattice", model="peridynamics", **more):
    """The scene of a dimension with this many cells a side and other wave numbers."""
    counts = cells if isinstance(cells, (list, tuple)) else [cells] * dim
    sines = "*".join(f"sin({n}*pi*{axis})" for n, axis in zip(modes, "xyz"))
    chosen = {"Models": model, "Domain/Cells": ", ".join(str(n) for n in counts), "Initial and source/Initial value": sines,
              "Reference/Solution": f"{reference} harmonic({','.join(str(n) for n in modes)})", "Output/Fields": "none",
              "Output/Line": "", "Output/Probes": ",".join(["0.5"] * dim)}
    chosen.update({key.replace("__", "/").replace("_", " "): value for key, value in more.items()})
    return run_scene(SCENES[dim], chosen)


def exact():
    errors = Comparison("Lattice harmonics: relative error of peridynamics at t = 0.05, 20 cells")
    rates = Comparison("Their rates of decay, from the temperature of the middle, against an independent program")
    for (dim, ratio, kernel), known in RATES.items():
        for exponent, rate in enumerate(known):
            run = run_harmonic(dim, 20, [1] * dim, Peridynamics__Horizon_ratio=str(ratio), Peridynamics__Kernel=kernel,
                               Peridynamics__Kernel_exponent=str(exponent), Time__Stepper="chebyshev")
            name = f"{dim}D, m = {ratio}, {kernel}, n = {exponent}"
            errors.add_limit(name, run.error("peridynamics"), 1e-9)
            rates.add(name, -math.log(run.probe("peridynamics", [0.5] * dim)) / 0.05, rate, relative=1e-11)
    errors.show()
    rates.show()


def variants():
    errors = Comparison("Lattice harmonics in other settings: relative error of peridynamics at t = 0.05")
    for name, dim, cells, modes, more in (
            ("cell centres, 1D, modes 3", 1, 25, [3], {"Domain__Nodes": "cell centers"}),
            ("cell centres, 2D, modes 1, 2", 2, 24, [1, 2], {"Domain__Nodes": "cell centers"}),
            ("cell centres, 3D, modes 1, 2, 1", 3, 12, [1, 2, 1], {"Domain__Nodes": "cell centers", "Peridynamics__Horizon_ratio": "2"}),
            ("rectangular cells, 2D, modes 2, 1", 2, [30, 20], [2, 1], {}),
            ("box of three unequal cells, 3D", 3, [16, 20, 12], [1, 1, 1], {"Peridynamics__Horizon": "0.15",
                                                                            "Peridynamics__Horizon_ratio": None}),
            ("stored bonds, 1D", 1, 20, [2], {"Peridynamics__Operator_form": "stored"}),
            ("stored bonds, 2D, m = 6.5", 2, 20, [1, 2], {"Peridynamics__Operator_form": "stored",
                                                          "Peridynamics__Horizon_ratio": "6.5"}),
            ("stored bonds, 3D", 3, 12, [1, 2, 1], {"Peridynamics__Operator_form": "stored"}),
            ("no volume fraction, analytic constant, m = 3.015", 2, 20, [1, 2], {
                "Peridynamics__Volume_fraction": "none", "Peridynamics__Calibration": "analytic",
                "Peridynamics__Horizon_ratio": "3.015"}),
            ("exact volume fraction, 1D", 1, 20, [2], {"Peridynamics__Volume_fraction": "exact"}),
            ("exact volume fraction, 2D", 2, 20, [1, 2], {"Peridynamics__Volume_fraction": "exact"}),
            ("exact volume fraction, 3D", 3, 12, [1, 2, 1], {"Peridynamics__Volume_fraction": "exact"}),
            ("conductivity 1.14, density 2, capacity 3", 2, 20, [1, 2], {
                "Material__Conductivity": "1.14", "Material__Density": "2", "Material__Heat_capacity": "3"})):
        if None in more.values():
            more = {key: value for key, value in more.items() if value is not None}
        run = run_harmonic(dim, cells, modes, **more)
        errors.add_limit(name, run.error("peridynamics"), 1e-9)
    errors.show()


def time():
    rows = []
    # The third mode on a coarse bar: its rate is not much below the largest eigenvalue, so that
    # explicit steps can be long enough for an error above round-off.
    for stepper, order, steps in (("euler", 1, (80, 160, 320, 640)), ("rkc2", 2, (20, 40, 80, 160)),
                                  ("crank nicolson", 2, (10, 20, 40, 80)), ("bdf2", 2, (20, 40, 80, 160)),
                                  ("sdirk2", 2, (10, 20, 40, 80)), ("rk4", 4, (20, 40, 80))):
        errors = []
        for n in steps:
            run = run_harmonic(1, 20, [3], Time__Stepper=stepper, Time__Time_step=repr(0.05 / n), Solver__Tolerance="1e-13",
                               Output__Write_at="")
            errors.append(run.error("peridynamics"))
        orders = observed_orders([1 / n for n in steps], errors)
        check(abs(orders[-1] - order) <= 0.15, f"{stepper}: order {orders[-1]} in the time step")
        rows.append((stepper, order, steps[-1], " ".join(f"{e:.2e}" for e in errors), " ".join(f"{o:.3f}" for o in orders)))
    print_table("Time steppers: relative error of a lattice harmonic (1D, 20 cells, m = 4, mode 3) as the step is halved",
                ("stepper", "order", "most steps", "errors", "observed orders"), rows)


def space_row(name, sizes, errors, order, within, rows):
    """Append a row; the last observed order has to be this one. A gaussian in 3D may do better: it hardly feels the cut."""
    orders = observed_orders(sizes, errors)
    better = name.startswith("3D, gaussian, horizon")
    check(order - within <= orders[-1] <= order + (1.5 if better else within), f"{name}: order {orders[-1]}")
    rows.append((name, " ".join(f"{e:.2e}" for e in errors), " ".join(f"{o:.3f}" for o in orders), f"{order - within:g} and more" if better else f"{order} +- {within:g}"))


COLUMNS = ("what", "relative errors", "observed orders", "bound on the last")


def elements():
    rows = []
    for dim, counts, modes in ((1, (20, 40, 80), [2]), (2, (10, 20, 40, 80), [1, 2]), (3, (8, 16, 32), [1, 2, 1])):
        for capacity in ("lumped", "consistent") if dim < 3 else ("lumped",):
            # The steppers for consistent capacity are implicit, and the error in time has to be far
            # below that in space.
            more = {"Time__End_time": "0.02", "Time__Tolerance": "1e-6"} if capacity == "consistent" else {}
            some = counts if capacity == "lumped" else counts[:2]
            errors = [run_harmonic(dim, n, modes, "classical", "finite elements", Finite_elements__Capacity=capacity,
                                   Output__Write_at="", **more).error("finite elements") for n in some]
            space_row(f"{dim}D, {capacity} capacity, {some[0]} to {some[-1]} cells", [1 / n for n in some], errors, 2, 0.1, rows)
    print_table("Q1 elements against the classical harmonic: order in h", COLUMNS, rows)

    rows = []
    for dim, counts in ((1, (10, 20, 40)), (2, (10, 20, 40)), (3, (4, 8, 16))):
        sines = "*".join(f"sin(pi*{axis})" for axis in "xyz"[:dim])
        for degree in (1, 2, 3):
            some = counts[:2] if dim == 3 and degree == 3 else counts
            errors = [run_harmonic(dim, n, [1] * dim, model="finite elements", Finite_elements__Degree=str(degree),
                                   Time__Steady="true", Output__Write_at="", Solver__Tolerance="1e-12", Initial_and_source__Source=f"{dim}*pi^2*{sines}",
                                   Reference__Solution=sines).error("finite elements") for n in some]
            space_row(f"{dim}D, Q{degree}, {some[0]} to {some[-1]} cells", [1 / n for n in some], errors, degree + 1, 0.15, rows)
    print_table("Elements of degree 1 to 3, steady with a source: order in h", COLUMNS, rows)


def space(fine=False):
    rows = []
    for dim, horizon, counts, modes in ((1, 0.2, (20, 40, 80, 160, 320), [2]), (2, 0.15, (20, 40, 80, 160) if fine else (20, 40, 80), [1, 2]),
                                        (3, 0.25, (8, 16, 32) if fine else (8, 16), [1, 1, 1])):
        # The sum leaves out the node's own volume, a share (h/horizon)^dim of the integral.
        # Calibration makes up for it where the temperature is a parabola, not beyond: order 1 in
        # 1D. From 2D on volumes cut by the horizon count as much.
        for kernel in ("constant", "conical", "gaussian"):
            errors = [run_harmonic(dim, n, modes, "nonlocal", Peridynamics__Horizon_ratio=repr(horizon * n), Peridynamics__Kernel=kernel,
                                   Output__Write_at="").error("peridynamics") for n in counts]
            space_row(f"{dim}D, {kernel}, horizon {horizon}, m = {horizon * counts[0]:g} to {horizon * counts[-1]:g}",
                      [1 / n for n in counts], errors, 1 if dim == 1 else 2, 0.1 if dim == 1 else 0.25, rows)
    print_table("m-convergence: fixed horizon, against the nonlocal harmonic at t = 0.05, order in 1/m", COLUMNS, rows)

    rows = []
    for dim, ratio, counts, modes in ((1, 4, (20, 40, 80, 160), [2]), (2, 3, (20, 40, 80, 160), [1, 2]), (3, 3, (10, 20, 40) if fine else (10, 20), [1, 1, 1])):
        for kernel in ("constant", "conical", "gaussian"):
            errors = [run_harmonic(dim, n, modes, "classical", Peridynamics__Horizon_ratio=str(ratio), Peridynamics__Kernel=kernel,
                                   Output__Write_at="").error("peridynamics") for n in counts]
            space_row(f"{dim}D, {kernel}, m = {ratio}, horizon {ratio / counts[0]:g} to {ratio / counts[-1]:g}",
                      [ratio / n for n in counts], errors, 2, 0.1, rows)
    print_table("delta-convergence: fixed m, against the classical harmonic at t = 0.05, order in the horizon", COLUMNS, rows)


def fine_space():
    space(fine=True)


if __name__ == "__main__":
    run_parts(exact, variants, time, elements, fine_space, space=space)
