# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Infinite bodies with a crack in three dimensions, whose exact fields are formulas of scenes. Young's modulus 1."""

import math

SIDES = ("left", "right", "bottom", "top", "front", "back")


class Disc:
    """A penny-shaped crack in the plane z = 0, under tension along z and shear along x (Sneddon 1946; Fabrikant 1989 writes the field so)."""

    def __init__(self, nu, radius, tension, shear):
        self.nu, self.radius, self.tension, self.shear = nu, radius, tension, shear
        self.mu = 1 / (2 * (1 + nu))

    def intensities(self, place):
        """K_I, K_II, K_III there; e_3 = e_1 x z goes clockwise."""
        root = math.sqrt(self.radius / math.pi)
        sheared = 4 * self.shear * root / (2 - self.nu)
        return [2 * self.tension * root, sheared * place[0] / self.radius, (1 - self.nu) * sheared * place[1] / self.radius]

    def entries(self):
        a, nu, mu = repr(self.radius), self.nu, self.mu
        r = "sqrt(x^2+y^2)"
        far, near = f"sqrt(({r}+{a})^2+z^2)", f"sqrt(({r}-{a})^2+z^2)"
        long, short, w = f"(0.5*({far}+{near}))", f"(0.5*({far}-{near}))", f"({far}*{near})"
        root, edge, turn = f"sqrt({long}^2-{a}^2)", f"sqrt(max(0,{a}^2-{short}^2))", f"asin({a}/{long})"
        gap, f = f"(if(z<0,-1,1)*{edge}-z*{turn})", f"({turn}-{a}*{root}/{long}^2)"
        p, b = self.tension / (math.pi * mu), 4 * (1 - nu) * self.shear / (math.pi * mu * (2 - nu))
        in_plane = f"({p/2!r}*(2*{a}^2*abs(z)*{edge}/({long}^2*{w})-{1-2*nu!r}*{f})-{nu*self.tension!r})"
        fall, back = f"(-2*{a}^3*{root}/({long}^4*{w}))", -1 / (2 * (1 - nu))
        u = f"x*{in_plane}+{b!r}*{gap}+{self.shear/mu!r}*z+{back*b/2!r}*z*({f}+x^2*{fall})"
        v = f"y*{in_plane}+{back*b/2!r}*z*x*y*{fall}"
        w_ = f"{p!r}*({2*(1-nu)!r}*{gap}+z*({turn}-{a}*{root}/{w}))+{self.tension!r}*z+{-(1-2*nu)*back*b/2!r}*x*{f}+{-back*b!r}*{a}^3*x*z^2/({root}*{long}^2*{w})"
        return {"Boundary conditions/Displacement": " ; ".join(f"{side}: {u}, {v}, {w_}" for side in SIDES), "Material/Poisson ratio": repr(nu),
                "Cracks/Polygons": f"disc: 0, 0, 0, 0, 0, 1, {a}"}


class Through:
    """A crack of half length HALF along x in the plane y = 0, of any extent along z: tension and shear in plane strain, and antiplane shear."""

    HALF = 0.5

    def __init__(self, nu, tension, shear, antiplane):
        self.nu, self.tension, self.shear, self.antiplane = nu, tension, shear, antiplane

    def intensities(self, place):
        """K_I, K_II, K_III; the polygon's normal is y, e_1 = sign(x) x, e_3 = e_1 x y."""
        root = math.sqrt(math.pi * self.HALF)
        side = math.copysign(root, place[0])
        return [self.tension * root, self.shear * side, self.antiplane * side]

    def entries(self, slides=False):
        """With slides, front and back hold the displacement along z alone (without antiplane shear)."""
        h, k, mu, s, t = self.HALF, 3 - 4 * self.nu, 1 / (2 * (1 + self.nu)), self.tension, self.shear
        square = f"sqrt(((x-{h})^2+y^2)*((x+{h})^2+y^2))"
        angle = f"(0.5*(atan2(y,x-{h})+atan2(y,x+{h})))"
        root = (f"sqrt({square})*cos({angle})", f"sqrt({square})*sin({angle})")
        slope = (f"(x*cos({angle})+y*sin({angle}))/sqrt({square})", f"(y*cos({angle})-x*sin({angle}))/sqrt({square})")
        u = f"{s*(k-1)/4/mu!r}*{root[0]}-{s/2/mu!r}*y*{slope[1]}+{t*(k+1)/4/mu!r}*{root[1]}+{t/2/mu!r}*y*{slope[0]}"
        v = f"{s*(k+1)/4/mu!r}*{root[1]}-{s/2/mu!r}*y*{slope[0]}-{t*(k-1)/4/mu!r}*{root[0]}-{t/2/mu!r}*y*{slope[1]}"
        both = f"{u}, {v}, {self.antiplane/mu!r}*{root[1]}"
        held = {side: "free, free, 0" if slides and side in ("front", "back") else both for side in SIDES}
        return {"Boundary conditions/Displacement": " ; ".join(f"{side}: {values}" for side, values in held.items()),
                "Material/Poisson ratio": repr(self.nu)}

    def polygon(self, low, high):
        h = self.HALF
        return f"{-h},0,{low} ; {-h},0,{high} ; {h},0,{high} ; {h},0,{low}"
