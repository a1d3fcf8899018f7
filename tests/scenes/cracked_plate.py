# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Infinite plates with a crack, whose exact fields are formulas of scenes."""

import math

HALF = 0.5  # of the crack's length
SIDES = ("left", "right", "bottom", "top")


class Plate:
    """An infinite plate with a crack at an angle to x, pulled in y by 1; Young's modulus 1."""

    def __init__(self, nu, angle=0.0, plane="stress"):
        self.nu, self.angle, self.plane = nu, math.radians(angle), plane
        self.c, self.s = math.cos(self.angle), math.sin(self.angle)
        self.normal, self.shear, self.along = self.c**2, self.s * self.c, self.s**2
        self.kappa = (3 - nu) / (1 + nu) if plane == "stress" else 3 - 4 * nu
        self.young = 1 if plane == "stress" else 1 / (1 - nu**2)
        self.intensities = [stress * math.sqrt(math.pi * HALF) for stress in (self.normal, self.shear)]

    def displacement(self, x, y):
        """At a place that is not on the crack."""
        X, Y = self.c * x + self.s * y, -self.s * x + self.c * y
        r = math.sqrt(math.hypot(X - HALF, Y) * math.hypot(X + HALF, Y))
        angle = 0.5 * (math.atan2(Y, X - HALF) + math.atan2(Y, X + HALF))
        root = complex(r * math.cos(angle), r * math.sin(angle))
        slope = complex(X, Y) / root
        k, mu = self.kappa, 1 / (2 * (1 + self.nu))
        u = self.normal * ((k - 1) / 2 * root.real - Y * slope.imag) + self.shear * ((k + 1) / 2 * root.imag + Y * slope.real)
        v = self.normal * ((k + 1) / 2 * root.imag - Y * slope.real) + self.shear * (-(k - 1) / 2 * root.real - Y * slope.imag)
        # and a uniform stress along the crack
        more = (self.along - self.normal) / self.young
        ratio = self.nu if self.plane == "stress" else self.nu / (1 - self.nu)
        u, v = u / (2 * mu) + more * X, v / (2 * mu) - ratio * more * Y
        return self.c * u - self.s * v, self.s * u + self.c * v

    def entries(self):
        """The same as formulas of the scene."""
        X, Y = f"({self.c!r}*x+{self.s!r}*y)", f"({self.c!r}*y-{self.s!r}*x)"
        square = f"sqrt((({X}-{HALF})^2+{Y}^2)*(({X}+{HALF})^2+{Y}^2))"
        angle = f"(0.5*(atan2({Y},{X}-{HALF})+atan2({Y},{X}+{HALF})))"
        root = (f"sqrt({square})*cos({angle})", f"sqrt({square})*sin({angle})")
        slope = (f"({X}*cos({angle})+{Y}*sin({angle}))/sqrt({square})", f"({Y}*cos({angle})-{X}*sin({angle}))/sqrt({square})")
        k, mu, n, t = self.kappa, 1 / (2 * (1 + self.nu)), self.normal, self.shear
        more = (self.along - self.normal) / self.young
        ratio = self.nu if self.plane == "stress" else self.nu / (1 - self.nu)
        u = f"({n*(k-1)/4/mu!r}*{root[0]}-{n/2/mu!r}*{Y}*{slope[1]}+{t*(k+1)/4/mu!r}*{root[1]}+{t/2/mu!r}*{Y}*{slope[0]}+{more!r}*{X})"
        v = f"({n*(k+1)/4/mu!r}*{root[1]}-{n/2/mu!r}*{Y}*{slope[0]}-{t*(k-1)/4/mu!r}*{root[0]}-{t/2/mu!r}*{Y}*{slope[1]}-{ratio*more!r}*{Y})"
        both = f"{self.c!r}*{u}-{self.s!r}*{v}, {self.s!r}*{u}+{self.c!r}*{v}"
        end = f"{HALF*self.c!r},{HALF*self.s!r}"
        return {"Boundary conditions/Displacement": " ; ".join(f"{side}: {both}" for side in SIDES), "Material/Poisson ratio": repr(self.nu),
                "Elasticity/Plane": self.plane, "Cracks/Segments": f"{-HALF*self.c!r},{-HALF*self.s!r} ; {end}"}


class HeatedPlate:
    """An infinite plate that heat flows through along y, its temperature y far away, with an insulated crack along x (Sih 1962; the field by Muskhelishvili's potentials). Young's modulus and expansion 1."""

    def __init__(self, nu, plane="stress"):
        self.nu, self.plane = nu, plane
        mu, kappa = 1 / (2 * (1 + nu)), (3 - nu) / (1 + nu) if plane == "stress" else 3 - 4 * nu
        expansion = 1 if plane == "stress" else 1 + nu
        self.young = 1 if plane == "stress" else 1 / (1 - nu**2)
        # With s = sqrt(z^2 - a^2), z = x + i y, and B = mu alpha a^2/(kappa + 1):
        # T = Im s, 2 mu (u + i v) = 2 i B ln|z + s| + 2 B y s/|s|^2 - i mu alpha z s
        square = f"sqrt(((x-{HALF})^2+y^2)*((x+{HALF})^2+y^2))"
        angle = f"(0.5*(atan2(y,x-{HALF})+atan2(y,x+{HALF})))"
        root = (f"(sqrt({square})*cos{angle})", f"(sqrt({square})*sin{angle})")
        b = mu * expansion * HALF**2 / (kappa + 1)
        u = f"{b/mu!r}*y*{root[0]}/{square}+{expansion/2!r}*(x*{root[1]}+y*{root[0]})"
        v = f"{b/2/mu!r}*ln((x+{root[0]})^2+(y+{root[1]})^2)+{b/mu!r}*y*{root[1]}/{square}-{expansion/2!r}*(x*{root[0]}-y*{root[1]})"
        self.displacement, self.temperature = (u, v), root[1]
        self.intensity = 2 * mu * expansion * HALF * math.sqrt(math.pi * HALF) / (kappa + 1)  # K_II

    def entries(self):
        """Of a body that knows the temperature."""
        return {"Boundary conditions/Displacement": " ; ".join(f"{side}: " + ", ".join(self.displacement) for side in SIDES),
                "Material/Poisson ratio": repr(self.nu), "Material/Thermal expansion": "1", "Elasticity/Plane": self.plane,
                "Elasticity/Temperature change": self.temperature, "Elasticity/Contact": "false",
                "Cracks/Segments": f"{-HALF!r},0 ; {HALF!r},0"}
