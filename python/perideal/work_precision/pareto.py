# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The front of cost and error, orders, and what an error costs along a family of settings."""

import math
from typing import List, NamedTuple, Optional, Sequence


class Point(NamedTuple):
    """What a setting costs, and how wrong it is; both positive."""

    cost: float
    error: float


def dominates(a: Point, b: Point) -> bool:
    """Whether a is neither dearer nor more wrong than b, and better in one of the two."""
    return a.cost <= b.cost and a.error <= b.error and (a.cost < b.cost or a.error < b.error)


def front(points: Sequence[Point]) -> List[int]:
    """The points that none dominates, by rising cost; points equal in both are all in it, in the order given."""
    best = []
    for k in sorted(range(len(points)), key=lambda k: points[k]):
        if not best or not dominates(points[best[-1]], points[k]):
            best.append(k)
    return best


def dominating(points: Sequence[Point]) -> List[Optional[int]]:
    """For each point the cheapest of the front that dominates it, the first of several; None on the front."""
    best = front(points)
    return [next((k for k in best if dominates(points[k], point)), None) for point in points]


def observed_order(spacings: Sequence[float], errors: Sequence[float]) -> float:
    """The order p of error = C h^p by least squares in logarithms. NaN for fewer than two different spacings, or numbers that are not
    positive."""
    n = len(spacings)
    if not all(h > 0 and e > 0 for h, e in zip(spacings, errors)):
        return math.nan
    sum_x = sum_y = sum_xx = sum_xy = 0.0
    for x, y in ((math.log(h), math.log(e)) for h, e in zip(spacings, errors)):
        sum_x, sum_y, sum_xx, sum_xy = sum_x + x, sum_y + y, sum_xx + x * x, sum_xy + x * y
    spread = n * sum_xx - sum_x * sum_x
    return math.nan if n < 2 or spread <= 1e-12 * n * sum_xx else (n * sum_xy - sum_x * sum_y) / spread


class Cost(NamedTuple):
    """What an error costs along a family of settings.

    kind: "interpolated" between two points of the family; "extrapolated" beyond its finest point, with the slope of its last three;
    "at most" the cost of a point that is better: of the coarsest, or of one no dearer than the point before; "none": fewer than two points,
    too far beyond them, or the error does not become smaller.
    """

    kind: str
    cost: float = 0.0  # meaningless with none
    beyond: float = 1.0  # extrapolated: the finest point's error over the target


FARTHEST = 10.0  # costs are extrapolated down to this part of the finest point's error


def cost_at_error(family: Sequence[Point], error: float) -> Cost:
    """The cost at which a family, from coarse to fine, reaches an error for good, by lines in logarithms of cost and error."""
    if not family:
        return Cost("none")
    # The last point that is not good enough: what is coarser may be better by chance.
    last = max((k for k, point in enumerate(family) if point.error > error), default=None)
    if last is None:
        return Cost("at most", family[0].cost)
    is_beyond = last + 1 == len(family)
    a, b = family[last], family[last if is_beyond else last + 1]
    beyond = b.error / error if is_beyond else 1.0
    order = math.nan  # error = C cost^-order
    if is_beyond and beyond <= FARTHEST:
        order = -observed_order([point.cost for point in family[-3:]], [point.error for point in family[-3:]])
    elif not is_beyond and min(b.error, a.cost, b.cost) > 0 and a.cost != b.cost:
        order = math.log(a.error / b.error) / math.log(b.cost / a.cost)
    if not (b.error > 0 and order > 1e-2 and math.isfinite(order)):
        return Cost("none") if is_beyond else Cost("at most", b.cost)  # hardly dearer than the one before
    return Cost("extrapolated" if is_beyond else "interpolated", b.cost * math.pow(b.error / error, 1.0 / order), beyond)


def order_of_differences(coarse: float, fine: float) -> float:
    """The order p seen in three solutions on lattices refined by two, from the norms of their differences: log2(coarse/fine), where coarse is
    |u(2h) - u(4h)| and fine |u(h) - u(2h)|."""
    ratio = coarse / fine if fine > 0 else math.inf if coarse > 0 else math.nan
    return math.log2(ratio) if ratio > 0 else -math.inf if ratio == 0 else math.nan


def richardson(coarse, fine, order: float):
    """u(h) + (u(h) - u(2h))/(2^p - 1), value by value, of arrays."""
    exp2 = getattr(math, "exp2", lambda p: 2.0 ** p)  # before Python 3.11
    return fine + (fine - coarse) / (exp2(order) - 1.0)
