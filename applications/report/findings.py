# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Sentences that say what a run found, made from summary.json."""

import re

from style import name, plain

FEM, PD = "finite elements", "peridynamics"
SHORT_TIME = 0.1  # s; below it a ratio of wall times is chance
ROUND_OFF = 1e-11
ORDINAL = {1: "one", 2: "two", 3: "three"}


def last(pairs):
    """Last value of a list of [time, value], or None."""
    if not pairs:
        return None
    return pairs[-1][1] if isinstance(pairs[-1], (list, tuple)) else pairs[-1]


def percent(value):
    """A relative number as a percentage."""
    return f"{plain(100 * value, 3)} %"


def wall_time(model):
    """Total wall time of a model: its entry 'total', or the sum of the phases; None if absent."""
    phases = model.get("wall time")
    if isinstance(phases, (int, float)):
        return float(phases)
    if not phases:
        return None
    if "total" in phases:
        return phases["total"]
    return sum(v for v in phases.values() if isinstance(v, (int, float)))


def kernel_name(setting, noun=" kernel"):
    """'conical kernel, n = 2' for the setting 'conical, exponent 2'."""
    found = re.fullmatch(r"(.*?), exponent (\S+)", str(setting))
    return f"{found[1]}{noun}, n = {found[2]}" if found else f"{setting}{noun}"


def ratio_text(setting):
    """A horizon ratio with few digits."""
    try:
        return plain(float(setting), 3)
    except ValueError:
        return str(setting)


def counts(title, model):
    """'peridynamics (14 641 unknowns, 432 000 bonds, m = 3, conical kernel)'."""
    parts = []
    if model.get("unknowns") is not None:
        parts.append(f"{plain(model['unknowns'])} unknowns")
    if model.get("bonds") is not None:
        parts.append(f"{plain(model['bonds'])} bonds")
    settings = model.get("settings") or {}
    if "m" in settings:
        parts.append(f"horizon ratio m = {ratio_text(settings['m'])}")
    if "kernel" in settings:
        parts.append(kernel_name(settings["kernel"]))
    return title + (f" ({', '.join(parts)})" if parts else "")


def what_ran(run, words):
    """The problem and the models."""
    models = [counts(m, run.summary["models"][m]) for m in run.models]
    joined = models[0] if len(models) == 1 else ", ".join(models[:-1]) + " and by " + models[-1]
    dimension = ORDINAL[run.dimension]
    dimension = f"{dimension} dimension" + ("s" if run.dimension > 1 else "")
    if run.get("steady", default=False):
        how = f"The steady {words.solution.text}"
    else:
        end = run.end_time
        how = f"The {words.solution.text}" + (
            "" if end is None else f" up to {words.at_time(end)}")
    n = run.n_cracks()
    body = "" if not n else ", in a body with a crack," if n == 1 else f", in a body with {n} cracks,"
    return f"{how} in {dimension}{body} was computed by {joined}."


def how_far_apart(run, words, difference):
    """Peridynamics against finite elements; difference: the largest one, or None."""
    relative = last(run.get("comparison", "relative l2"))
    largest = last(run.get("comparison", "maximum"))
    if relative is None and largest is None:
        return None
    parts = []
    if relative is not None:
        parts.append(f"by {percent(relative)} in the relative L2 norm")
    if largest is not None:
        place = f", reached {difference.place()}" if difference and not difference.zero else ""
        parts.append(f"by at most {words.solution.amount(abs(largest))}" + place)
    when = "" if run.get("steady", default=False) else "At the end "
    text = f"{when}peridynamics differs from finite elements {' and '.join(parts)}."
    return text[0].upper() + text[1:]


def how_far_coupled(run):
    """The coupled model against the others."""
    parts = [f"by {percent(last(entries['relative l2']))} from {pair.split(' minus ')[1]}"
             for pair, entries in (run.get("comparisons") or {}).items()]
    if not parts:
        return None
    when = "The" if run.get("steady", default=False) else "At the end the"
    return f"{when} coupled model differs {' and '.join(parts)} in the relative L2 norm."


def how_accurate(run):
    """What `Models = auto` chose for the accuracy that was asked for."""
    accuracy = run.summary.get("accuracy")
    if not accuracy:
        return None
    tries = len(accuracy["steps"])
    cells = accuracy["settings"]["Domain/Cells"].replace(", ", " x ")
    graded = accuracy["settings"].get("Domain/Coarsening", "0") != "0"
    mesh = f"a mesh that is {cells} cells fine at the crack" if graded else f"{cells} cells"
    met = "" if accuracy["met"] else ": the budget did not allow more"
    effect = accuracy.get("horizon effect")
    horizon = "" if effect is None else f" The horizon changes the solution by about {percent(effect)}."
    return (f"Chosen were {accuracy['model']} on {mesh}, in {tries} tries: "
            f"the error ({accuracy['measure']}) is estimated as {percent(accuracy['estimate'])}, "
            f"{percent(accuracy['tolerance'])} was asked for{met}.{horizon}")


def how_wrong(run):
    """Errors against the exact solution."""
    errors = {m: last((run.summary["models"][m].get("errors") or {}).get("relative l2"))
              for m in run.models}
    errors = {m: e for m, e in errors.items() if e is not None}
    if not errors:
        return None
    listed = " and ".join(f"{percent(e)} ({m})" for m, e in errors.items())
    text = f"Against the exact solution the relative L2 error is {listed}"
    if len(errors) == 2 and min(errors.values()) > 0:
        (a, b), (ea, eb) = errors.keys(), errors.values()
        better, ratio = (a, eb / ea) if ea < eb else (b, ea / eb)
        if min(ea, eb) < ROUND_OFF:
            text += f"; {better} {is_or_are(better)} exact but for round-off"
        elif ratio < 1.05:
            text += "; the two are equally accurate"
        else:
            text += f"; {better} {is_or_are(better)} {plain(ratio, 2)} times more accurate"
    return text + "."


def is_or_are(model):
    """Finite elements are, the others are one thing."""
    return "are" if model == FEM else "is"


def what_it_cost(run):
    """Wall times and their ratio."""
    times = {m: wall_time(run.summary["models"][m]) for m in run.models}
    times = {m: t for m, t in times.items() if t}
    if not times:
        return None
    processes = run.get("processes", default=1)
    where = f"on {plain(processes)} process" + ("es" if processes != 1 else "")
    if max(times.values()) < SHORT_TIME:
        who = {1: "It", 2: "Both models"}.get(len(times), "Each model")
        return f"{who} took less than {plain(SHORT_TIME)} s of wall time {where}."
    listed = " and ".join(f"{plain(t, 3)} s ({m})" if t >= SHORT_TIME else
                          f"less than {plain(SHORT_TIME)} s ({m})" for m, t in times.items())
    text = f"The wall time was {listed} {where}"
    if FEM in times and PD in times and min(times[FEM], times[PD]) >= SHORT_TIME:
        ratio = times[PD] / times[FEM]
        more, times_as_much = ("peridynamics", ratio) if ratio >= 1 else ("finite elements", 1 / ratio)
        text += ": both cost as much" if plain(times_as_much, 2) == "1" else \
            f": {more} cost {plain(times_as_much, 2)} times as much"
    return text + "."


def balance(model, words):
    """The balance of heat, moisture or charge of a model's entry, empty where it is absent."""
    return model.get(f"{words.quantity} balance") or model.get("heat balance") or {}


def is_conserved(run, words):
    """The balance of heat, moisture or charge."""
    worst = None
    for model in run.models:
        found = balance(run.summary["models"][model], words)
        imbalance, throughput = found.get("imbalance"), found.get("throughput")
        if imbalance is None or not throughput:
            continue
        share = abs(imbalance / throughput)
        if worst is None or share > worst[1]:
            worst = (model, share)
    if worst is None:
        return None
    if worst[1] < 1e-6:
        return (f"{name(words.quantity)} is conserved: the imbalance is at most "
                f"{plain(worst[1], 2)} of the throughput.")
    return (f"The {words.quantity} balance closes to {percent(worst[1])} of the throughput "
            f"(worst: {worst[0]}).")


def is_kept(run, words):
    """The balance since the start, against the largest of what came in, passed through and was or is held."""
    worst = None
    for model in run.models:
        whole = balance(run.summary["models"][model], words)
        found = whole.get("cumulative") or {}
        passed = abs(whole.get("throughput") or 0) * (run.end_time or 0)  # where as much enters as leaves
        content = [abs(v) for _, v in run.totals.get(words.content, {}).get(model, [])]
        moved = max([abs(found.get(k) or 0) for k in ("entered", "stored")] + [passed] + content)
        if found.get("imbalance") is None or not moved:
            continue
        share = abs(found["imbalance"]) / moved
        if worst is None or share > worst[1]:
            worst = (model, share)
    if worst is None:
        return None
    amount = f"at most {plain(worst[1], 2)}" if worst[1] < 1e-6 else percent(worst[1])
    return (f"Since the start, what the body stores differs from the {words.quantity} that entered by {amount} of the largest of what "
            f"entered, passed through and is held (worst: {worst[0]}).")


def what_broke(run, words):
    """Models whose pictures have holes since values are not finite."""
    if not run.not_finite:
        return None
    listed = " and ".join(f"{m} (first shown at {words.at_time(t)})"
                          for m, t in run.not_finite.items())
    return f"Warning: {words.values} are not finite for {listed}; they are left white."


def sentences(run, words, difference):
    """Three to five sentences; difference: the largest one at the end, or None."""
    found = [what_ran(run, words), what_broke(run, words),
             how_far_apart(run, words, difference), how_far_coupled(run),
             how_accurate(run), how_wrong(run), what_it_cost(run),
             is_conserved(run, words), is_kept(run, words)]
    return [s for s in found if s]
