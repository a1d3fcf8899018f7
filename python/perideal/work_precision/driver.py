# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Plan the rows of the study, let the program compute them, compare what they have found, and write it down."""

import dataclasses
import json
import os
import shlex
import signal
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from typing import Dict, List, Sequence

from .. import program
from ..drivers import mistake_in, require_scene, write_text
from ..program import Error, settings
from ..server import Server
from . import growth, tables
from .evaluation import ComputedRow, evaluate
from .families import FAMILIES
from .lattice import Cells, n_vertices, to_text
from .plan import Plan, Row, comparison_of, make_plan, require_comparable
from ..words import full_precision

# Unknowns of multigrid's coarsest level: so few that iterations compare on coarse lattices, too. On
# those that have no more it has another level.
MOST_DIRECT, MOST_DIRECT_OF_FEW = 100, 10

# What is the same in all rows, stronger than the scene.
OUTPUT = {"Domain/Node spacing": "", "Coupling/Certificate": "false", "Output/Fields": "none", "Output/Write at": "", "Output/Write every": "",
          "Output/Probes": "", "Output/Line": ""}
SUFFIXES = {"field": "", "opening": "_opening", "stress intensity": "_intensity", "strength": "_strength", "path": "_path"}


@dataclasses.dataclass
class Options:
    """What accuracy is charted against cost for."""

    overrides: Sequence[str] = ()  # "Section/Entry=value", of all rows
    cells: str = ""  # "21, 21 | 41, 41"; empty: from the scene's `Cells`
    reference: str = ""  # three lattices for the reference; empty: chosen here
    budget: float = 2e6  # bonds of peridynamics in the whole body
    picks: bool = True  # mark what `Models = auto` chooses
    measure: str = "field"  # opening, stress intensity
    output: str = ""  # empty: output/studies/<scene>_work_precision
    study: Sequence[str] = ()  # options of `perideal study`: --only, --quick, --redo, --repeat
    quiet: bool = False
    processes: int = 1


class Ended(Exception):
    """The program has ended with a status, and has said why."""

    def __init__(self, status: int):
        super().__init__(status)
        self.status = status


def _common_settings(comparison: str) -> Dict[str, str]:
    """What is the same in all rows but those in which the program chooses."""
    if comparison == "mesh":
        return {**OUTPUT, "Output/Grid": "", "Solver/Direct solver up to": str(MOST_DIRECT)}
    common = {**OUTPUT, "Domain/Nodes": "vertices", "Peridynamics/Flux treatment": "natural", "Solver/Direct solver up to": str(MOST_DIRECT)}
    if "cracks" in comparison:
        common.update({"Cracks/Nodes on cracks": "left", "Finite elements/Degree": "1"})  # these very cells
    return common


def _decided_entries(comparison: str) -> List[str]:
    """The entries that no override may touch."""
    decided = {"Domain/Cells", "Output/Grid", *_common_settings(comparison)}
    if comparison == "mesh":
        decided |= {"Domain/Refinements", "Domain/Coarsening", "Peridynamics/Horizon"}
    return sorted(decided.union(*(family.settings for family in FAMILIES[comparison])))


def _own_settings(facts: dict, plan: Plan, row: Row) -> Dict[str, str]:
    """Of this row alone, stronger than what all have."""
    own = dict(row.settings)
    if plan.measure == "path" and row.role == "method":
        own["Output/Fields"] = "vtu"  # with the cracks
    if plan.comparison in ("growth", "mesh"):
        own["Output/Grid"] = ""
    elif row.role != "reference":
        own["Output/Grid"] = "" if row.role == "pick" else to_text(row.cells)
    if not row.is_chosen and plan.comparison != "mesh":
        own["Domain/Cells"] = to_text(row.cells)
        if n_vertices(row.cells) <= MOST_DIRECT:
            own["Solver/Direct solver up to"] = str(MOST_DIRECT_OF_FEW)
    if row.role == "reference" and not row.is_chosen:
        own["Output/Grid"] = " ; ".join(map(to_text, plan.lattices()))
        own["Time/Tolerance"] = "1e-7"  # the error in time out of sight
    if plan.probes and row.role != "pick":
        own["Output/Probes"] = plan.probes
    if row.family is not None and row.family.courant > 0:
        own["Time/Time step"] = _step(facts, row.cells, row.family.courant)
    return own


def _step(facts: dict, cells: Cells, courant: float) -> str:
    """In which a wave passes so many cells."""
    spacing = min((upper - lower) / n for lower, upper, n in zip(facts["lower"], facts["upper"], cells))
    return full_precision(courant * spacing / facts["wave speed"])


def _sweep(row: Row) -> str:
    """What rows that belong together have in common."""
    return {"reference": "reference", "pick": "auto", "pick values": "auto"}.get(row.role) or (
        row.family.name if row.role == "method" else "in time")


def _setting(text: str):
    """Entry and value of an override."""
    entry, _, value = text.partition("=")
    return entry.strip(), value.strip()


def _study_file(facts: dict, plan: Plan, scene: str, options: Options, output: str) -> dict:
    """The rows as a study that the program computes (doc/study.md)."""
    overrides = dict(map(_setting, options.overrides))
    rows = []
    for row in plan.rows:
        own = _own_settings(facts, plan, row)
        common = OUTPUT if row.is_chosen else _common_settings(plan.comparison)
        of_row = {**common, **own, **overrides}
        if row.role != "method":  # a tolerance in time is that of the methods
            of_row.update(own)
        group = row.family.model if row.role == "method" else _sweep(row)
        rows.append({"name": row.name, "row": _sweep(row), "scene": scene, "group": group, "may fail": row.may_fail, "set": of_row})
    columns = ["Domain/Cells", "Peridynamics/Horizon ratio", "Peridynamics/Boundary treatment", "Peridynamics/Surface correction"]
    if facts["cracks"]:
        columns += ["Cracks/Mesh", "Coupling/Zone"]
    return {"source": "command line", "title": f"{facts['title']}: work and precision", "output": output, "columns": columns,
            "varied": _decided_entries(plan.comparison), "rows": rows}


def _no_choice(server: Server, scene: str, options: Options) -> str:
    """What keeps `Models = auto` from choosing for a scene, or nothing."""
    overrides = [*options.overrides, *([f"Accuracy/Measure={options.measure}"] if options.measure in growth.MEASURES else [])]
    try:
        return server.describe(scene, [*overrides, "Models=auto", "Peridynamics/Horizon=", *settings(OUTPUT)])["no choice"]
    except Error as error:
        return mistake_in(error)


def _leave_out_impossible(plan: Plan, server: Server, scene: str, overrides: Sequence[str]) -> None:
    """Take families out of the plan whose settings the scene cannot have, with what is wrong."""
    faults = {}
    for row in plan.rows:
        if row.role != "method" or row.family.name in faults:
            continue
        faults[row.family.name] = ""
        try:
            cells = [] if plan.comparison == "mesh" else [f"Domain/Cells={to_text(row.cells)}"]
            server.describe(scene, [*overrides, *cells, *settings(row.settings)])
        except Error as error:
            faults[row.family.name] = mistake_in(error)
            plan.left_out.append(f"{row.family.name}: {faults[row.family.name]}")
    plan.rows = [row for row in plan.rows if row.family is None or not faults.get(row.family.name)]


def _refuse_overrides(overrides: Sequence[str], decided: List[str]) -> None:
    for text in overrides:
        entry = _setting(text)[0]
        if entry == "Output directory":
            raise Error("command line: --set: 'Output directory' of each row is decided by the study; \"output\" (or --output) is the "
                        "directory of all of them.")
        if entry in decided:
            raise Error(f"command line: --set '{text}': the study varies that entry.")


MISTAKE = "\nperideal: error: "


class Relay:
    """What the program says, passed on as it comes, but for two things that are said in the end: where the results are, and what is wrong."""

    def __init__(self, process: subprocess.Popen, quiet: bool):
        self.quiet = quiet
        self.has_results = False
        self.mistake = ""
        self._held_back = ""  # of standard error: the beginning of a mistake, or of something else
        self._threads = [threading.Thread(target=self._follow, args=(pipe, action), daemon=True)
                         for pipe, action in ((process.stdout, self._output), (process.stderr, self._errors))]
        for thread in self._threads:
            thread.start()

    def wait(self) -> None:
        """Until the program has said all."""
        for thread in self._threads:
            thread.join()
        print(self._held_back, end="", file=sys.stderr, flush=True)

    @staticmethod
    def _follow(pipe, action):
        with pipe:
            while more := os.read(pipe.fileno(), 65536):
                action(more.decode(errors="replace"))

    def _output(self, text: str) -> None:
        at = text.find("Results: ") if text.startswith("Results: ") else text.find("\nResults: ") + 1
        if at > 0 or text.startswith("Results: "):
            self.has_results, text = True, text[:at]
        if not self.quiet:
            print(text, end="", flush=True)

    def _errors(self, text: str) -> None:
        if self.mistake:
            self.mistake += text
            return
        text, self._held_back = self._held_back + text, ""
        at = text.find(MISTAKE)
        if at >= 0:
            self.mistake = text[at:]
        else:  # it may come in several pieces
            at = next(k for k in range(max(0, len(text) - len(MISTAKE)), len(text) + 1) if MISTAKE.startswith(text[k:]))
            self._held_back = text[at:]
        print(text[:at], end="", file=sys.stderr, flush=True)


def _compute(study: dict, options: Options) -> str:
    """Let the program compute the rows. Returns what is wrong with some of them, to be said in the end. Raises Ended."""
    with tempfile.TemporaryDirectory(prefix="perideal_") as folder:
        file = os.path.join(folder, "study.json")
        Path(file).write_text(json.dumps(study), encoding="utf-8")
        environment = program.environment()
        environment.setdefault("PERIDEAL_COMMAND", shlex.join([Path(sys.executable).name, "-m", "perideal", *sys.argv[1:]]))
        process = subprocess.Popen(program.command(["study", file, *options.study], options.processes), stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment, start_new_session=True)
        before = {}

        def pass_on(number, _):  # the launcher of several processes kills them a second after an interrupt
            process.send_signal(number if options.processes == 1 else signal.SIGUSR1)

        if threading.current_thread() is threading.main_thread():
            before = {number: signal.signal(number, pass_on) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGUSR1)}
        try:
            relay = Relay(process, options.quiet)
            status = process.wait()
            relay.wait()
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
    if status != 0 and not (status == 1 and relay.has_results):
        print(relay.mistake, end="", file=sys.stderr)
        raise Ended(status if status > 0 else 128 - status)
    return relay.mistake or (MISTAKE + "Some rows did not end as they should.\n" if status else "")


def run(scene: str, options: Options = Options()) -> str:
    """Compute the study of a scene and write its results. Returns what is wrong with rows that did not end as they should, or nothing.

    Raises Error, among others: no box, no reference to be had; and Ended where the program has been stopped or has said what is wrong.
    """
    def say(text):
        if not options.quiet:
            print(text, flush=True)

    require_scene(scene)
    with Server() as server:
        # The models of the rows may be others.
        model = "peridynamics" if options.measure in growth.MEASURES else "finite elements"  # which do not break
        overrides = [*options.overrides, f"Models={model}", "Peridynamics/Surface correction=none", *settings(OUTPUT)]
        facts = server.describe(scene, overrides)
        require_comparable(facts)
        comparison = comparison_of(facts, options.measure)
        _refuse_overrides(options.overrides, _decided_entries(comparison))
        no_choice = _no_choice(server, scene, options) if options.picks or options.measure in growth.MEASURES else ""
        plan = make_plan(facts, options.measure, options.cells, options.reference, options.budget, options.picks, no_choice)
        _leave_out_impossible(plan, server, scene, [*overrides, *settings(_common_settings(comparison))])
    output = options.output or f"output/studies/{Path(scene).stem}_work_precision{SUFFIXES[plan.measure]}"
    study = _study_file(facts, plan, scene, options, output)
    say(f"{study['title']}: {len(plan.rows)} rows, {len(plan.left_out)} left out")
    mistake = _compute(study, options)

    folder = Path(output)
    written = json.loads((folder / "study.json").read_text(encoding="utf-8", errors="replace"))
    computed = [ComputedRow(entry, folder) for entry in written["rows"]]
    plan.left_out += [f"{planned.name}: {row.message}" for planned, row in zip(plan.rows, computed)
                      if planned.may_fail and row.status == "failed" and planned.role != "pick values"]
    results = evaluate(facts, plan, computed)
    write_text(f"{output}/work_precision.csv", tables.work_csv(results))
    write_text(f"{output}/work_precision.json", tables.work_json(written, scene, plan, results))
    if results.in_time:
        write_text(f"{output}/work_precision_in_time.csv", tables.in_time_csv(results))
    say(tables.work_report(plan, results))
    say(f"Results: {output}")
    return mistake
