# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Where peridynamics differs most from finite elements, judged at the nodes."""

import numpy as np

import fragments
from raster import is_constant_per_cell
from read_run import DIFFERENCE
from style import is_nothing, plain

FEM, PD, COUPLED = "finite elements", "peridynamics", "coupled"


class Largest:
    """The largest difference and one node that has it; zero: the models agree to round-off."""

    def __init__(self, value, at, alone, zero):
        self.value, self.at, self.alone, self.zero = value, at, alone, zero

    def place(self):
        """'at (0, 0.5)', or '... among others' where several nodes have it."""
        numbers = [plain(float(v)) for v in self.at]
        point = f"x = {numbers[0]}" if len(numbers) == 1 else f"({', '.join(numbers)})"
        return f"at {point}" + ("" if self.alone else " among others")


def difference_field(run, index, name, model=PD):
    """A model minus finite elements of a field at the vertices of the cells, or None."""
    if any(m not in run.models or run.field_file(index, m) is None for m in (FEM, model)):
        return None
    values = None
    if name == run.words.solution.name and model == PD:
        values = run.field(index, PD, DIFFERENCE, required=False)
    if values is None and run.mesh(index, model) is run.mesh(index, FEM):
        pair = [run.field(index, m, name, required=False) for m in (model, FEM)]
        if all(v is not None for v in pair):
            values = pair[0] - at_nodes_of(run.mesh(index, model), *pair)
    return without_fragments(run, index, model, values)


def without_fragments(run, index, model, values):
    """NaN at the fragments of an elastic body: how far they have flown is no difference of models."""
    flying = fragments.find(run, index, model) if run.words.elastic and values is not None else None
    return values if flying is None else np.where(flying.mask, np.nan, values)


def compared(run, index, name, of_pd=None, with_equal=False):
    """[(model, its largest difference or None)] of the models to be drawn minus finite elements.

    of_pd: that of peridynamics, where it is known. What agrees to round-off is not drawn.
    """
    if FEM not in run.models:
        return []
    found = [(m, of_pd if m == PD and of_pd is not None else largest(run, index, name, m))
             for m in (PD, COUPLED) if m in run.models]
    return [(m, size) for m, size in found if with_equal or size is None or not size.zero]


def at_nodes_of(mesh, nodal, values):
    """Values at the vertices where the nodes of another model are: its own, or cell centres."""
    if not is_constant_per_cell(mesh, nodal) or is_constant_per_cell(mesh, values):
        return values
    result = np.empty_like(values)
    result[mesh.cells] = values[mesh.cells].mean(axis=1, keepdims=True)
    return result


def displacement_gap(run, index):
    """Length of the difference of the displacement vectors at the vertices, or None."""
    if any(m not in run.models or run.field_file(index, m) is None for m in (FEM, PD)) \
            or run.mesh(index, PD) is not run.mesh(index, FEM):
        return None
    mesh, pair = run.mesh(index, PD), [run.displacement(index, m) for m in (PD, FEM)]
    if any(v is None for v in pair):
        return None
    at_centers = any(is_constant_per_cell(mesh, v) for v in pair[0].T)
    gap = np.zeros(len(mesh.nodes))
    for of_pd, of_fem in zip(pair[0].T, pair[1].T):
        if at_centers:
            smooth = np.empty_like(of_fem)
            smooth[mesh.cells] = of_fem[mesh.cells].mean(axis=1, keepdims=True)
            of_fem = smooth
        gap += (of_pd - of_fem) ** 2
    return without_fragments(run, index, PD, np.sqrt(gap))


def is_multiple(run, indices, name):
    """Whether a field is the same multiple of the solution in all models and at all these times.

    It is so where the field is absent, too.
    """
    factor = None
    for index in indices:
        for model in run.models:
            if run.field_file(index, model) is None:
                continue
            values = run.field(index, model, name, required=False)
            if values is None or not np.isfinite(values).any():
                continue
            solution = run.solution(index, model)
            if factor is None and np.nanmax(np.abs(solution)) > 0:
                at = int(np.nanargmax(np.abs(solution)))
                factor = values[at] / solution[at]
            rest = values - (0.0 if factor is None else factor) * solution
            if np.nanmax(np.abs(rest), initial=0) > 1e-6 * np.nanmax(np.abs(values)):
                return False
    return True


def largest(run, index, name, model=PD):
    """The largest difference of a field at a written time, or None where there is none to tell."""
    return largest_of(run, index, difference_field(run, index, name, model), name, model)


def largest_of(run, index, values, name, model=PD):
    """The largest of the values at the vertices, which are differences of a field of that name."""
    if values is None or not np.isfinite(values).any():
        return None
    mesh = run.mesh(index, model)
    points = mesh.nodes
    if is_constant_per_cell(mesh, values):  # nodes at cell centres
        points, values = mesh.nodes[mesh.cells].mean(axis=1), values[mesh.cells[:, 0]]
    size = np.abs(values)
    chosen = int(np.nanargmax(size))
    equal = points[size >= (1 - 1e-6) * size[chosen]]
    extent = max(np.ptp(points, axis=0).max(), 1e-300)
    alone = bool(np.abs(equal - points[chosen]).max() < 1e-9 * extent)
    at = np.where(np.abs(points[chosen]) < 1e-12 * extent, 0.0, points[chosen])
    return Largest(float(values[chosen]), at, alone,
                   is_nothing(values, run.field(index, FEM, name)))
