# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The program perideal: where it is, how it is started, and a run of a scene."""

import json
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Iterable, Mapping, NamedTuple, Optional, Union

from .results import Results, read

PACKAGE = Path(__file__).resolve().parent
Overrides = Union[Mapping[str, object], Iterable[str]]


class Error(Exception):
    """What the program has to say of a scene that it does not compute, word for word.

    status: 1 for a mistake of the scene or a run that diverged, 2 for a fault of the program, 3 for a run that was stopped.
    """

    def __init__(self, message: str, status: int = 1):
        super().__init__(message)
        self.status = status


class Answer(NamedTuple):
    """How a command has ended, and what it has said on standard output and error."""

    status: int
    output: str
    errors: str


def find_program() -> str:
    """The executable: PERIDEAL_EXECUTABLE, that of this checkout's build folder or of this installation, or the first in PATH."""
    named = os.environ.get("PERIDEAL_EXECUTABLE")
    if named:
        return named
    for place in (PACKAGE.parents[1] / "build/release/applications/perideal", *(above / "bin/perideal" for above in PACKAGE.parents[3:4])):
        if place.is_file():
            return str(place)
    found = shutil.which("perideal")
    if not found:
        raise Error("The program perideal was not found: PERIDEAL_EXECUTABLE may name it; ./run builds it.")
    return found


def command(arguments: Iterable[str], processes: int = 1) -> list:
    """How the program is started with these arguments, on so many processes."""
    return on_processes([find_program(), *arguments], processes)


def on_processes(words: list, processes: int) -> list:
    """How a program of MPI is started."""
    if processes == 1:
        return words
    # Without the network, of which Open MPI 5 complains where it leads nowhere; a batch system may give several machines.
    several = any(os.environ.get(name) for name in ("SLURM_JOB_ID", "PBS_JOBID", "LSB_JOBID", "PE_HOSTFILE"))
    network = [] if several else ["env", "OMPI_MCA_btl=" + os.environ.get("OMPI_MCA_btl", "^tcp")]
    return [*network, find_launcher(), "-np", str(processes), *words]


def find_launcher() -> str:
    """PERIDEAL_MPIRUN, that with which this checkout was configured, or mpirun: of another MPI it would start single processes."""
    named = os.environ.get("PERIDEAL_MPIRUN")
    cache = PACKAGE.parents[1] / "build/release/CMakeCache.txt"
    if not named and cache.is_file():
        found = re.search(r"^PERIDEAL_MPIRUN:FILEPATH=(.*)$", cache.read_text(errors="replace"), re.MULTILINE)
        named = found.group(1) if found and not found.group(1).endswith("NOTFOUND") else None
    return named or "mpirun"


def environment() -> dict:
    """Of parallel programs, as in .ci/build.sh: several processes on few cores, also as root and in containers."""
    return dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                OMPI_MCA_rmaps_base_oversubscribe="1", PRTE_MCA_rmaps_default_mapping_policy=":oversubscribe",
                OMPI_MCA_hwloc_base_binding_policy="none", PRTE_MCA_hwloc_default_binding_policy="none",
                OMPI_MCA_orte_execute_quiet="1", OMPI_MCA_btl_vader_single_copy_mechanism="none", PMIX_MCA_gds="hash")


def call(arguments: Iterable[str], processes: int = 1, timeout: Optional[float] = None, cwd=None) -> Answer:
    """Start the program with these arguments and wait for its end."""
    done = subprocess.run(command(arguments, processes), stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace",
                          timeout=timeout, cwd=cwd, env=environment())
    return Answer(done.returncode, done.stdout, done.stderr)


def settings(overrides: Overrides) -> list:
    """Overrides as the command line takes them: "Section/Entry=value"."""
    if isinstance(overrides, Mapping):
        return [f"{entry}={_text(value)}" for entry, value in overrides.items()]
    return list(overrides)


def _text(value) -> str:
    """A value as scenes have it: true and false, lists with commas."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return ", ".join(map(_text, value))
    return str(value)


def arguments_of(overrides: Overrides) -> list:
    """Overrides as words of the command line."""
    return [word for setting in settings(overrides) for word in ("-s", setting)]


def message_of(answer: Answer) -> str:
    """The program's own message; where it has none, all that it has said."""
    # Behind it Open MPI 5 has words of its own: lines that name a machine and a process, and blocks between lines of dashes.
    found = re.search(r"^perideal: (?:error: )?(.*?)(?=^\[[^\]\s]+:\d+\] |^-{60,}$|\Z)", answer.errors, re.MULTILINE | re.DOTALL)
    return (found.group(1) if found else answer.errors or answer.output).strip()


def require_success(answer: Answer) -> Answer:
    """Raises Error with the program's own message unless it has ended as it should."""
    if answer.status != 0:
        raise Error(message_of(answer) or f"perideal ended with status {answer.status}.", answer.status)
    return answer


def run_with(caller, scene, overrides: Overrides, folder) -> Results:
    """A run by caller(arguments), which gives an Answer; else as run()."""
    temporary = None
    if folder is None or "\n" in str(scene):
        temporary = tempfile.TemporaryDirectory(prefix="perideal_")
    if "\n" in str(scene):
        text, scene = scene, os.path.join(temporary.name, "scene.prm")
        Path(scene).write_text(text, encoding="utf-8")
    place = os.path.join(temporary.name, "results") if folder is None else os.fspath(folder)
    answer = require_success(caller(["run", os.fspath(scene), *arguments_of(overrides), "-s", f"Output directory={place}"]))
    results = read(place)
    results.output = answer.output
    results.temporary = temporary if folder is None else None
    return results


def run(scene, overrides: Overrides = (), processes: int = 1, folder=None, timeout: Optional[float] = None) -> Results:
    """Compute a scene.

    scene: the path of a scene file, or the text of a scene (if it has several lines).
    overrides: {"Section/Entry": value}, or texts "Section/Entry=value" as of the command line.
    folder: where the results are kept; without it in a temporary folder, which goes with the object that is returned.
    Raises Error with the program's own message where it does not compute the scene.
    """
    return run_with(lambda arguments: call(arguments, processes, timeout), scene, overrides, folder)


def describe_with(caller, scene, overrides: Overrides) -> dict:
    """The facts of a scene by caller(arguments), which gives an Answer."""
    return json.loads(require_success(caller(["check", os.fspath(scene), "--json", *arguments_of(overrides)])).output)


def describe(scene, overrides: Overrides = ()) -> dict:
    """What a scene is, without computing it (doc/python.md). Raises Error where it has mistakes."""
    return describe_with(call, scene, overrides)
