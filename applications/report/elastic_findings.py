# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Sentences that say what a run of an elastic body found."""

import findings
import fragments
import loading
from elastic_tables import extreme, last_totals, made_by_surfaces, place
from style import name, plain


AT_MOST = 4  # ends of cracks
MODES = ("I", "II", "III")


def what_ran(run, words):
    """The problem and the models."""
    models = [findings.counts(m, run.summary["models"][m]) for m in run.models]
    joined = models[0] if len(models) == 1 else ", ".join(models[:-1]) + " and by " + models[-1]
    plane = run.scene_entry("Elasticity", "Plane") if run.dimension == 2 else ""
    kind = {1: "a bar", 2: "a body" if plane == "strain" else "a plate", 3: "a body"}[
        run.dimension]
    state = f" in plane {plane}" if plane else ""
    n = run.n_cracks()
    cracks = "" if not n else " with a crack" if n == 1 else f" with {n} cracks"
    end = run.end_time
    slow = ", slowly loaded" if loading.is_slow(run) else ""
    when = " at rest" if run.get("steady", default=False) else \
        "" if end is None else f"{slow} up to {words.at_time(end)}" + ("," if slow else "")
    return f"The displacement of {kind}{cracks}{state}{when} was computed by {joined}."


def joined(parts):
    """'a', 'a and b', 'a, b and c'."""
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} and {parts[-1]}"


def largest_values(run, index, field, when=""):
    """The largest value of a field by each model, or None."""
    found = {m: extreme(run, index, m, field, "largest", with_surfaces=False, of_body=True) for m in run.models}
    found = {m: f for m, f in found.items() if f is not None}
    if not found:
        return None
    places = {place(run, point) for _, point in found.values()}
    listed = joined([f"{field.amount(value)}" + (f" at {place(run, point)}" if len(places) > 1 else "") + f" ({m})"
                     for m, (value, point) in found.items()])
    if len(places) == 1:
        listed += f" at {places.pop()}"
    inside = any(m in found and made_by_surfaces(run, m, field, run.mesh(index, m)).any()
                 for m in run.models)
    comma = "" if when else ","
    where = f"{comma} of peridynamics more than a horizon inside," if inside else ""
    return f"The largest {field.text}{when}{where} is {listed}."


def what_flies(run, index, words):
    """The fragments, which the largest values above leave out."""
    found = {m: fragments.find(run, index, m) for m in run.models}
    listed = " and ".join(f.text(words.solution.amount) + end_of(m if len(run.models) > 1 else "")
                          for m, f in found.items() if f is not None)
    return f"Left out of largest values and of the scales of pictures: {listed}." if listed else None


def intensities(run, words):
    """K_I, and K_II and K_III where they are more than an error of the method, at the ends or fronts of cracks; a few at most."""
    of_models = {m: run.summary["models"][m].get("stress intensity") or {} for m in run.models}
    ends = list(dict.fromkeys(e for found in of_models.values() for e in found))
    lines = []
    for end in ends[:AT_MOST]:
        for mode in MODES:
            values = {m: found[end] for m, found in of_models.items() if mode in found.get(end, {})}
            listed = [f"{plain(v[mode], 4)} ({m})" for m, v in values.items()
                      if mode == "I" or abs(v[mode]) > 0.01 * max(abs(v[other]) for other in MODES if other in v)]
            if listed:
                unit = f" in {words.units.intensity}" if words.units.intensity else ""
                lines.append(f"The stress intensity factor K_{mode} at {end}{unit} is "
                             f"{' and '.join(listed)}.")
    missing = run.get("no stress intensity", default="")
    if missing:
        lines.append(("About stress intensity factors: " if ends else "There are no stress intensity factors: ") + f"{missing}.")
    if len(ends) > AT_MOST:
        lines.append(f"Those at {len(ends) - AT_MOST} more ends or places are in totals.csv.")
    return lines


def what_is_stored(run):
    """The strain energies."""
    energies = last_totals(run, "strain energy")
    listed = " and ".join(f"{run.words.total_amount('strain energy', v)} ({m})"
                          for m, v in energies.items() if m in run.models)
    when = "At the end the" if loading.is_slow(run) else "The"
    return f"{when} strain energy is {listed}." if listed else None


def end_of(model):
    """The model in parentheses, where there are several."""
    return f" ({model})" if model else ""


def what_bonds_did(run, words):
    """When the first bonds broke, how many did, and what that cost."""
    if not loading.can_break(run):
        return []
    first, several, found = loading.first_break(run), len(run.totals[loading.BROKEN]) > 1, []
    for model, series in run.totals[loading.BROKEN].items():
        of = end_of(model if several else "")
        if model not in first:
            found.append(f"No bond broke{of}.")
            continue
        broken, whole = max(series)[1], run.summary["models"].get(model, {}).get("bonds")
        share = "" if not whole else \
            f" of {plain(int(whole + broken))} ({findings.percent(broken / (whole + broken))})"
        when = "at" if loading.is_slow(run) else "by"  # a motion is only seen at times of output
        lost = last_totals(run, loading.DISSIPATED).get(model)
        cost = "" if lost is None else f", and an energy of {words.total_amount(loading.DISSIPATED, lost)} was dissipated"
        found.append(f"The first bonds broke {when} {words.at_time(first[model])}{of}; in the end "
                     f"{plain(int(broken))} bonds{share} were broken{cost}.")
    return found


def largest_forces(run, words):
    """The largest force on each side that moves or is loaded; none that never changes."""
    if not loading.is_slow(run) and not loading.can_break(run):
        return []
    found = []
    for force in loading.forces(run)[0]:
        models = [m for m in force.of_models if not force.is_constant(m)]
        listed = " and ".join(
            f"{words.total_amount(force.quantity, value)} at {words.at_time(time)}{end_of(m if len(run.models) > 1 else '')}"
            for m, (time, value) in ((m, force.peak(m)) for m in models))
        if listed:
            found.append(f"The largest force on {force.side}, in {force.axis}, was {listed}.")
    return found


def are_balanced(run):
    """The balance of forces, against the size of forces in the body until then: it may end without any load or stress, or in pieces."""
    shares = {}
    largest = {m: max(v for _, v in s) for m, s in run.totals.get("throughput", {}).items()} \
        if loading.is_slow(run) else {}
    for model in run.models:
        found = run.summary["models"][model].get("force balance") or {}
        imbalance = found.get("imbalance")
        scale = found.get("scale") or largest.get(model, found.get("throughput"))
        if imbalance is not None and scale:
            shares[model] = abs(imbalance / scale)
    if not shares:
        return None
    worst = max(shares, key=shares.get)
    if shares[worst] < 1e-6:
        return ("The forces on the body are in balance: their sum is at most "
                f"{plain(shares[worst], 2)} of the largest force in it.")
    return (f"The forces on the body add up to {findings.percent(shares[worst])} of the largest "
            f"force in it (worst: {worst}): {name(worst)} "
            f"{findings.is_or_are(worst)} not in equilibrium, or the body accelerates.")


def sentences(run, words, difference, index, stressed):
    """What the run says; difference: the largest of the displacement, index: of the last fields,
    stressed: of those that the stress is told of."""
    found = [what_ran(run, words), findings.what_broke(run, words)]
    if index is not None:
        found += [what_flies(run, index, words), largest_values(run, index, words.solution),
                  largest_values(run, stressed, words.fields["von_mises"],
                                 f", at {words.at_time(run.written_times()[stressed])},"
                                 if loading.is_slow(run) else "")]
    found += intensities(run, words) + what_bonds_did(run, words) + largest_forces(run, words)
    found += [findings.how_far_apart(run, words, difference), findings.how_far_coupled(run),
              findings.how_accurate(run), findings.how_wrong(run), what_is_stored(run),
              findings.what_it_cost(run), are_balanced(run)]
    return [s for s in found if s]
