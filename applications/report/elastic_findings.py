# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Sentences that say what a run of an elastic body found."""

import findings
from elastic_tables import extreme, last_totals, place
from style import name, plain


def what_ran(run, words):
    """The problem and the models."""
    models = [findings.counts(m, run.summary["models"][m]) for m in run.models]
    joined = models[0] if len(models) == 1 else ", ".join(models[:-1]) + " and by " + models[-1]
    plane = run.scene_entry("Elasticity", "Plane") if run.dimension == 2 else ""
    kind = {1: "a bar", 2: "a body" if plane == "strain" else "a plate", 3: "a body"}[
        run.dimension]
    state = f" in plane {plane}" if plane else ""
    n = len(run.cracks())
    cracks = "" if not n else " with a crack" if n == 1 else f" with {n} cracks"
    end = run.get("end time")
    when = " at rest" if run.get("steady", default=False) else \
        "" if end is None else f" up to {words.at_time(end)}"
    return f"The displacement of {kind}{cracks}{state}{when} was computed by {joined}."


def largest_values(run, index, field):
    """The largest value of a field by each model, or None."""
    found = {m: extreme(run, index, m, field, "largest") for m in run.models}
    found = {m: f for m, f in found.items() if f is not None}
    if not found:
        return None
    listed = " and ".join(f"{field.amount(value)} at {place(point)} ({m})"
                          for m, (value, point) in found.items())
    return f"The largest {field.text} is {listed}."


def what_is_stored(run):
    """The strain energies."""
    energies = last_totals(run, "strain energy")
    listed = " and ".join(f"{plain(v, 4)} ({m})" for m, v in energies.items() if m in run.models)
    return f"The strain energy is {listed}." if listed else None


def are_balanced(run):
    """The balance of forces."""
    shares = {}
    for model in run.models:
        found = run.summary["models"][model].get("force balance") or {}
        imbalance, throughput = found.get("imbalance"), found.get("throughput")
        if imbalance is not None and throughput:
            shares[model] = abs(imbalance / throughput)
    if not shares:
        return None
    worst = max(shares, key=shares.get)
    if shares[worst] < 1e-6:
        return ("The forces on the body are in balance: their sum is at most "
                f"{plain(shares[worst], 2)} of the force that passes through it.")
    return (f"The forces on the body add up to {findings.percent(shares[worst])} of the force that "
            f"passes through it (worst: {worst}): {name(worst)} "
            f"{findings.is_or_are(worst)} not in equilibrium, or the body accelerates.")


def sentences(run, words, difference, index):
    """What the run says; difference: the largest of the displacement, index: of the last fields."""
    found = [what_ran(run, words), findings.what_broke(run, words)]
    if index is not None:
        found += [largest_values(run, index, words.solution),
                  largest_values(run, index, words.fields["von_mises"])]
    found += [findings.how_far_apart(run, words, difference), findings.how_far_coupled(run),
              findings.how_wrong(run), what_is_stored(run), findings.what_it_cost(run),
              are_balanced(run)]
    return [s for s in found if s]
