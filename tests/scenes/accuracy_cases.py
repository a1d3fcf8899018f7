# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Scenes for `Models = auto` with exact solutions: a text, and a function of points (n x dim) and a formula that say the same.

The formulas of cracks are those of an insulated crack, or one without traction, in an infinite plate, prescribed on all sides of the box.
"""

import math

import numpy as np


class Case:
    """A scene and its exact solution. `exact` gives n values of a point's columns, or n x dim of a displacement."""

    def __init__(self, name, kind, exact, dimension=2, inside=None, **sections):
        self.name, self.kind, self.exact, self.dimension = name, kind, exact, dimension
        self.inside = inside or (lambda p: np.full(len(p), True))  # the points of the box that lie in the body
        self.sections = sections

    def text(self):
        """Without `Accuracy` and `Output`, which overrides give."""
        lines = [f"set Title = {self.name}", f"set Dimension = {self.dimension}", "set Models = auto"]
        if self.kind == "elastic":
            lines.append("set Physics = elasticity")
        names = {"domain": "Domain", "material": "Material", "source": "Initial and source", "boundary": "Boundary conditions", "cracks": "Cracks",
                 "elasticity": "Elasticity", "peridynamics": "Peridynamics", "time": "Time"}
        for key, entries in self.sections.items():
            lines.append(f"subsection {names[key]}")
            lines += [f"  set {entry} = {value}" for entry, value in entries.items()]
            lines.append("end")
        if self.kind != "elastic" and "time" not in self.sections:
            lines += ["subsection Time", "  set Steady = true", "end"]
        return "\n".join(lines) + "\n"

    def box(self):
        domain = self.sections.get("domain", {})
        corner = lambda entry, default: np.array([float(x) for x in domain.get(entry, ", ".join([default] * self.dimension)).split(",")])
        return corner("Lower corner", "0"), corner("Upper corner", "1")


def all_sides(formula, dimension):
    return "; ".join(f"{side}: {formula}" for side in ("left", "right", "bottom", "top", "back", "front")[:2 * dimension])


SQUARE = {"Lower corner": "-1, -1", "Upper corner": "1, 1"}


def on_box(name, formula, exact, source="0", dimension=2, **more):
    return Case(name, "smooth", exact, dimension, source={"Source": source}, boundary={"Dirichlet": all_sides(formula, dimension)}, **more)


def insulated_crack(name, angle, half_length=0.5, centre=(0., 0.)):
    """Im sqrt(z^2 - a^2), z along and across the crack: the gradient 1 across it far away."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    c, s = (0. if abs(v) < 1e-15 else v for v in (c, s))
    xi, eta = (f"({a:.17g}*(x-({centre[0]}))+({b:.17g})*(y-({centre[1]})))" for a, b in ((c, s), (-s, c)))
    real, imaginary = f"({xi}^2-{eta}^2-{half_length ** 2:.17g})", f"(2*{xi}*{eta})"
    formula = f"({eta} > -1e-9 ? 1 : -1)*sqrt(max(0,(sqrt({real}^2+{imaginary}^2)-{real})/2))"

    def exact(p):
        z = ((p[:, 0] - centre[0]) + 1j * (p[:, 1] - centre[1])) * (c - 1j * s)
        w = np.sqrt(z * z - half_length ** 2 + 0j)
        return np.where(z.imag >= 0, 1, -1) * np.abs(w.imag)

    ends = [(centre[0] + k * half_length * c, centre[1] + k * half_length * s) for k in (-1, 1)]
    return Case(name, "crack", exact, domain=SQUARE, boundary={"Dirichlet": all_sides(formula, 2)},
                cracks={"Segments": " ; ".join(f"{x:.17g},{y:.17g}" for x, y in ends)})


def crack_from_side(name, angle, tip=(0.1, 0.05)):
    """sqrt(r) sin(phi/2) about the tip, the crack leaving the box to the left at an angle."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    xi, eta = (f"({a:.17g}*(x-({tip[0]}))+({b:.17g})*(y-({tip[1]})))" for a, b in ((c, s), (-s, c)))
    formula = f"({eta} > -1e-9 ? 1 : -1)*sqrt(max(0,(sqrt({xi}^2+{eta}^2)-{xi})/2))"

    def exact(p):
        z = ((p[:, 0] - tip[0]) + 1j * (p[:, 1] - tip[1])) * (c - 1j * s)
        return np.where(z.imag >= 0, 1, -1) * np.sqrt(np.maximum(0, (np.abs(z) - z.real) / 2))

    length = (1 + tip[0]) / c
    return Case(name, "crack", exact, domain=SQUARE, boundary={"Dirichlet": all_sides(formula, 2)},
                cracks={"Segments": f"-1,{tip[1] - length * s:.17g} ; {tip[0]:.17g},{tip[1]:.17g}"})


def smooth_cases():
    pi, sin, cos, exp, tanh = np.pi, np.sin, np.cos, np.exp, np.tanh
    layer = lambda p: tanh((p[:, 0] + p[:, 1] - 1) / 0.03)
    # a narrow hill
    w = 0.02
    hill = lambda p: exp(-((p[:, 0] - 0.3137) ** 2 + (p[:, 1] - 0.6271) ** 2) / (2 * w * w))
    r2 = "((x-0.3137)^2+(y-0.6271)^2)"
    return [
        on_box("sine", "0", lambda p: sin(pi * p[:, 0]) * sin(pi * p[:, 1]), "2*pi^2*sin(pi*x)*sin(pi*y)"),
        on_box("harmonic", "exp(2*x)*sin(2*y)", lambda p: exp(2 * p[:, 0]) * sin(2 * p[:, 1])),
        on_box("layer", "tanh((x+y-1)/0.03)", layer, "4*tanh((x+y-1)/0.03)*(1-tanh((x+y-1)/0.03)^2)/0.03^2"),
        on_box("hill", "0", hill, f"(2/{w}^2-{r2}/{w}^4)*exp(-{r2}/(2*{w}^2))"),
        on_box("graded material", "log(1+x+2*y)", lambda p: np.log(1 + p[:, 0] + 2 * p[:, 1]), material={"Conductivity": "1+x+2*y"}),
        on_box("boundary layer 1D", "exp(-x/0.01)", lambda p: exp(-p[:, 0] / 0.01), "-exp(-x/0.01)/0.01^2", 1),
        on_box("cube", "0", lambda p: sin(pi * p[:, 0]) * sin(pi * p[:, 1]) * sin(2 * pi * p[:, 2]), "6*pi^2*sin(pi*x)*sin(pi*y)*sin(2*pi*z)", 3),
        Case("mixed", "smooth", lambda p: p[:, 0] ** 3 - 3 * p[:, 0] * p[:, 1] ** 2 + p[:, 1],
             domain={"Lower corner": "0, 0", "Upper corner": "2, 0.5"},
             boundary={"Dirichlet": "left: y ; top: x^3-0.75*x+0.5", "Flux": "right: 3*(4-y^2) ; bottom: -1"}),
    ]


def body_cases():
    """Bodies that are no boxes: round holes, a corner, meshes of deal.II's generators, layers."""
    def hole(x, y, a):
        return lambda p: np.hypot(p[:, 0] - x, p[:, 1] - y)

    r = hole(0.1, -0.05, 0.35)
    square = "((x-0.1)^2+(y+0.05)^2)"
    dipole = f"(x-0.1)*(1+{0.35 ** 2}/{square})"
    bore = "(1+z)*(x-0.45)*(1+0.04/((x-0.45)^2+(y-0.5)^2))"
    away = hole(0.45, 0.5, 0.2)
    corner = "(x^2+y^2)^(1/3)*sin(2/3*(atan2(y,x)+(y < -1e-12 ? 2*pi : 0)))".replace("pi", f"{math.pi:.17g}")

    def of_corner(p):
        phi = np.arctan2(p[:, 1], p[:, 0])
        return np.hypot(p[:, 0], p[:, 1]) ** (2 / 3) * np.sin(2 / 3 * np.where(phi < -1e-12, phi + 2 * np.pi, phi))

    ring = lambda p: np.hypot(p[:, 0], p[:, 1])
    # A + B/r^2 along the radius: an elastic ring in any plane state
    swelling = lambda p: p * (0.01 + 0.02 / ring(p) ** 2)[:, None]
    ball = lambda p: np.sqrt((p ** 2).sum(axis=1))
    return [
        Case("insulated round hole", "body", lambda p: (p[:, 0] - 0.1) * (1 + 0.35 ** 2 / r(p) ** 2), inside=lambda p: r(p) > 0.35,
             domain={**SQUARE, "Holes": "circle: 0.1, -0.05, 0.35"}, boundary={"Dirichlet": all_sides(dipole, 2)}),
        Case("cold rim", "body", lambda p: np.log(r(p)), inside=lambda p: r(p) > 0.35,
             domain={**SQUARE, "Holes": "circle: 0.1, -0.05, 0.35"}, boundary={"Dirichlet": all_sides(f"log(sqrt({square}))", 2) + f"; hole: {math.log(0.35):.17g}"}),
        Case("bore", "body", lambda p: (1 + p[:, 2]) * (p[:, 0] - 0.45) * (1 + 0.04 / away(p) ** 2), 3, inside=lambda p: away(p) > 0.2,
             domain={"Upper corner": "1, 1, 0.5", "Holes": "circle: 0.45, 0.5, 0.2"}, boundary={"Dirichlet": all_sides(bore, 3)}),
        Case("corner of an L", "body", of_corner, inside=lambda p: (p[:, 0] < 0) | (p[:, 1] > 0),
             domain={**SQUARE, "Holes": "rectangle: 0, -1, 1, 0"}, boundary={"Dirichlet": all_sides(corner, 2) + "; hole: 0"}),
        Case("ring of a generator", "body", lambda p: np.log(ring(p)), inside=lambda p: (ring(p) > 0.5) & (ring(p) < 0.95),
             domain={**SQUARE, "Shape": "generator", "Generator": "hyper_shell", "Generator arguments": "0, 0 : 0.5 : 1 : 10 : true"},
             boundary={"Dirichlet": f"0: {math.log(0.5):.17g} ; 1: 0"}),
        Case("elastic ring", "elastic", swelling, inside=lambda p: (ring(p) > 0.5) & (ring(p) < 0.95),
             domain={**SQUARE, "Shape": "generator", "Generator": "hyper_shell", "Generator arguments": "0, 0 : 0.5 : 1 : 12 : true"},
             material={"Young modulus": "1", "Poisson ratio": "0.3"},
             boundary={"Displacement": "; ".join(f"{k}: x*{f}, y*{f}" for k, f in ((0, 0.09), (1, 0.03)))}),
        Case("ball", "body", lambda p: p[:, 0] ** 2 - p[:, 2] ** 2 + p[:, 1], 3, inside=lambda p: ball(p) < 0.85,
             domain={"Lower corner": "-1, -1, -1", "Upper corner": "1, 1, 1", "Shape": "generator", "Generator": "hyper_ball", "Generator arguments": "0, 0, 0 : 1 : true"}, boundary={"Dirichlet": "0: x^2-z^2+y"}),
        Case("two layers", "body", lambda p: np.where(p[:, 0] < 0.4, p[:, 0] * 10 / 4.6, (p[:, 0] + 3.6) / 4.6),
             material={"Conductivity": "x < 0.4 ? 1 : 10"}, boundary={"Dirichlet": "left: 0 ; right: 1"}),
    ]


def crack_cases():
    return [
        insulated_crack("crack along a row", 0),
        insulated_crack("crack upright, off the middle", 90, 0.31, (0.137, 0.05)),
        insulated_crack("crack at 15 degrees", 15),
        insulated_crack("crack at 30 degrees", 30),
        insulated_crack("crack at 45 degrees", 45),
        insulated_crack("crack at 63 degrees", 63, 0.4, (0.2, -0.1)),
        insulated_crack("short crack", 20, 0.1),
        insulated_crack("long crack", 33, 0.85),
        crack_from_side("crack from a side", 0),
        crack_from_side("oblique crack from a side", 12),
    ]


def plate_in_tension(name, angle, half_length=0.5, nu=0.3):
    """Westergaard: a crack without traction, an infinite plate in plane stress, E = 1, the stress 1 in all directions far away."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    c, s = (0. if abs(v) < 1e-15 else v for v in (c, s))
    x, y = f"({c:.17g}*x+({s:.17g})*y)", f"({-s:.17g}*x+({c:.17g})*y)"
    r1, r2 = (f"(({x}{sign}{half_length})^2+{y}^2)" for sign in "-+")
    root, phase = f"sqrt(sqrt({r1}*{r2}))", f"(0.5*(atan2({y},{x}-{half_length})+atan2({y},{x}+{half_length})))"
    along = f"({1 - nu}*{root}*cos{phase}-{1 + nu}*{y}*({y}*cos{phase}-{x}*sin{phase})/{root})"
    across = f"(2*{root}*sin{phase}-{1 + nu}*{y}*({x}*cos{phase}+{y}*sin{phase})/{root})"
    vector = f"{c:.17g}*{along}-({s:.17g})*{across}, {s:.17g}*{along}+({c:.17g})*{across}"

    def exact(p):
        z = (p[:, 0] + 1j * p[:, 1]) * (c - 1j * s)
        w = np.sqrt(z - half_length + 0j) * np.sqrt(z + half_length + 0j)
        u, v = (1 - nu) * w.real - (1 + nu) * z.imag * (z / w).imag, 2 * w.imag - (1 + nu) * z.imag * (z / w).real
        return np.stack([c * u - s * v, s * u + c * v], axis=1)

    ends = [(k * half_length * c, k * half_length * s) for k in (-1, 1)]
    return Case(name, "elastic", exact, domain=SQUARE, material={"Young modulus": 1, "Poisson ratio": nu}, elasticity={"Plane": "stress"},
                boundary={"Displacement": all_sides(vector, 2).replace("; ", " ; ")},
                cracks={"Segments": " ; ".join(f"{x:.17g},{y:.17g}" for x, y in ends)})


def elastic_cases():
    """Lame constants 1 and 1 in the first two."""
    pi, sin, cos = np.pi, np.sin, np.cos
    moduli = {"Young modulus": 2.5, "Poisson ratio": 0.25}
    zero = lambda n: np.zeros(n)
    return [
        Case("strained square", "elastic", lambda p: np.stack([sin(pi * p[:, 0]) * sin(pi * p[:, 1]), zero(len(p))], axis=1), material=moduli,
             elasticity={"Plane": "strain"}, source={"Body force": "4*pi^2*sin(pi*x)*sin(pi*y), -2*pi^2*cos(pi*x)*cos(pi*y)"},
             boundary={"Displacement": all_sides("0, 0", 2)}),
        Case("strained cube", "elastic", lambda p: np.stack([zero(len(p)), zero(len(p)), sin(pi * p[:, 0]) * sin(pi * p[:, 1]) * sin(pi * p[:, 2])], axis=1), 3,
             material=moduli, boundary={"Displacement": all_sides("0, 0, 0", 3)},
             source={"Body force": "-2*pi^2*cos(pi*x)*sin(pi*y)*cos(pi*z), -2*pi^2*sin(pi*x)*cos(pi*y)*cos(pi*z), 5*pi^2*sin(pi*x)*sin(pi*y)*sin(pi*z)"}),
        plate_in_tension("plate in tension", 0),
        plate_in_tension("plate in tension, turned", 25),
    ]


def nonlocal_share(dim, wave, horizon):
    """Of the classical rate of decay of a wave that peridynamics has: conical kernel over r^2, ever more nodes in the horizon."""
    r = (np.arange(20000) + 0.5) / 20000 * horizon
    kernel = (1 - r / horizon) / r ** 2
    if dim == 1:
        return np.sum(kernel * (1 - np.cos(wave * r))) / np.sum(kernel * (wave * r) ** 2 / 2)
    angle = (np.arange(400) + 0.5) / 400 * 2 * math.pi
    turned = np.array([np.mean(1 - np.cos(wave * x * np.cos(angle))) for x in r])
    return np.sum(kernel * r * turned) / np.sum(kernel * r * (wave * r) ** 2 / 4)


def nonlocal_cases():
    """Products of sines keep their shape with mirrored fictitious nodes."""
    pi, sin = np.pi, np.sin
    mirror = {"Boundary treatment": "fictitious mirror"}
    share = [nonlocal_share(2, math.sqrt(2) * pi, 0.25), nonlocal_share(1, 2 * pi, 0.1)]
    return [
        Case("sine of a horizon", "nonlocal", lambda p: sin(pi * p[:, 0]) * sin(pi * p[:, 1]) / share[0], source={"Source": "2*pi^2*sin(pi*x)*sin(pi*y)"},
             boundary={"Dirichlet": all_sides("0", 2)}, peridynamics={"Horizon": 0.25, **mirror}),
        Case("bar of a horizon", "nonlocal", lambda p: sin(2 * pi * p[:, 0]) / share[1], 1, source={"Source": "4*pi^2*sin(2*pi*x)"},
             boundary={"Dirichlet": all_sides("0", 1)}, peridynamics={"Horizon": 0.1, **mirror}),
    ]


def transient_cases():
    """At the end of a time."""
    pi, sin, cos, exp = np.pi, np.sin, np.cos, np.exp
    crack = insulated_crack("crack heated slowly", 20)
    on_sides = crack.sections["boundary"]["Dirichlet"]
    formula = on_sides[on_sides.index(":") + 1:on_sides.index("; right")]
    warming = Case(crack.name, "transient", lambda p: (1 - math.exp(-1)) * crack.exact(p), domain=SQUARE, cracks=crack.sections["cracks"],
                   source={"Source": f"exp(-t)*({formula})"}, time={"End time": 1}, boundary={"Dirichlet": all_sides(f"(1-exp(-t))*({formula})", 2)})
    erf = np.vectorize(math.erf)
    return [
        Case("sine that decays", "transient", lambda p: exp(-2 * pi ** 2 * 0.1) * sin(pi * p[:, 0]) * sin(pi * p[:, 1]), time={"End time": 0.1},
             source={"Initial value": "sin(pi*x)*sin(pi*y)"}, boundary={"Dirichlet": all_sides("0", 2)}),
        Case("heated end", "transient", lambda p: 1 - erf(p[:, 0] / (2 * 0.1)), 1, time={"End time": 0.01}, boundary={"Dirichlet": "left: 1; right: 0"}),
        Case("swinging source", "transient", lambda p: sin(pi * p[:, 0]) * cos(pi * p[:, 1] / 2) * math.cos(10 * 0.7), time={"End time": 0.7},
             source={"Initial value": "sin(pi*x)*cos(pi*y/2)", "Source": "sin(pi*x)*cos(pi*y/2)*(1.25*pi^2*cos(10*t)-10*sin(10*t))"},
             boundary={"Dirichlet": "left: 0; right: 0; top: 0"}),
        warming,
    ]


def moving_cases():
    """Waves, at the end of a time: one that runs, in a bar, and standing ones (P waves, Lame constants 1 and 1, sides that slide)."""
    pi, sin, exp = np.pi, np.sin, np.exp
    pulse = "exp(-((x-0.25)/0.06)^2)"

    def standing(name, dimension, end):
        return Case(name, "elastic", lambda p: np.stack([sin(pi * p[:, 0]) * math.cos(math.sqrt(3) * pi * end)] + [np.zeros(len(p))] * (dimension - 1), axis=1), dimension,
                    material={"Young modulus": 2.5, "Poisson ratio": 0.25, "Density": "1.0"}, elasticity={"Solver": "dynamics", **({"Plane": "strain"} if dimension == 2 else {})},
                    source={"Initial displacement": ", ".join(["sin(pi*x)", "0", "0"][:dimension])}, time={"End time": end},
                    boundary={"Symmetry": ", ".join(["left", "right", "bottom", "top", "back", "front"][:2 * dimension])})

    return [
        Case("pulse in a bar", "elastic", lambda p: exp(-((p - 0.75) / 0.06) ** 2), 1, material={"Young modulus": 1, "Density": "1.0"}, elasticity={"Solver": "dynamics"},
             source={"Initial displacement": pulse, "Initial velocity": f"2*(x-0.25)/0.06^2*{pulse}"}, time={"End time": 0.5}),
        standing("standing wave", 2, 1.3),
        standing("standing wave in a block", 3, 0.4),
    ]


def loaded_cases():
    """At rest, at the end of a load that changes with time; and warmed by a temperature that is computed. Lame constants 1 and 1."""
    pi, sin = np.pi, np.sin
    moduli, plane = {"Young modulus": 2.5, "Poisson ratio": 0.25}, {"Plane": "strain"}
    shape = lambda p: sin(pi * p[:, 0]) * sin(pi * p[:, 1])
    along_x = lambda p, factor=1.: np.stack([factor * shape(p), np.zeros(len(p))], axis=1)
    force = ("4*pi^2*sin(pi*x)*sin(pi*y)", "-2*pi^2*cos(pi*x)*cos(pi*y)")
    # The stress of the heat, 5 times the expansion times T, acts as its gradient.
    warm = f"{force[0]} + 0.5*pi*cos(pi*x)*sin(pi*y), {force[1]} + 0.5*pi*sin(pi*x)*cos(pi*y)"
    return [
        Case("loaded slowly", "elastic", lambda p: along_x(p, 0.7 ** 2), material=moduli, elasticity=plane, source={"Body force": f"t^2*{force[0]}, t^2*({force[1]})"},
             boundary={"Displacement": all_sides("0, 0", 2)}, time={"End time": 0.7}),
        Case("warmed", "elastic", along_x, material={**moduli, "Thermal expansion": 0.1}, elasticity={**plane, "Temperature change": "computed"},
             source={"Body force": warm, "Source": "2*pi^2*sin(pi*x)*sin(pi*y)"}, time={"Steady": "true"},
             boundary={"Displacement": all_sides("0, 0", 2), "Dirichlet": all_sides("0", 2)}),
    ]


def cases():
    return smooth_cases() + crack_cases() + elastic_cases() + nonlocal_cases()
