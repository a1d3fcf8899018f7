# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Campaigns: many random cases of one kind, and a count of how they end.

    campaign = Campaign(__doc__, cases=30)
    for case in campaign:                         # case.random is seeded, case.folder is fresh
        end = run(["run", scene], case, timeout=60)
        case.count("heat, killed", end.kind, end.detail)
    campaign.finish()

Every case is a function of the seed and its number alone: `--seed N --case K` repeats one, `--keep FOLDER` keeps the folders of
those that fail. A run has its own session, so that all its processes can be found and ended, and its own temporary folder.
"""

import argparse
import collections
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "scenes"))
from scene_test import TRACES, command_and_environment, print_table  # noqa: E402

COMPLETE, REFUSED, STOPPED, KILLED = "complete", "one message", "stopped", "killed"
CRASH, HANG, TRACE, TOO_LONG = "crash", "hang", "trace", "too long"
WRONG_STATUS, NO_MESSAGE, MESSAGES, WRONG = "wrong status", "no message", "several messages", "silently wrong"

# Ends that are no failure in themselves. Everything else is.
GOOD = {COMPLETE, REFUSED, STOPPED, KILLED, TOO_LONG}

FAULTS = TRACES + ("internal error", "Bus error", "bus error", "Floating point exception")


class End:
    """How a run ended. kind: one of the words above; detail: what to print of it."""

    def __init__(self, status, stdout, stderr, seconds):
        self.status, self.stdout, self.stderr, self.seconds = status, stdout, stderr, seconds
        self.kind, self.detail = self._judge()

    @property
    def text(self):
        return self.stdout + self.stderr

    @property
    def messages(self):
        return self.stderr.count("perideal: error:")

    def _judge(self):
        last = " ".join(self.stderr.split())[-300:]
        if self.status < 0 or self.status > 130 and self.status != 143:
            return CRASH, f"exit status {self.status}: {last}"
        found = [trace for trace in FAULTS if trace in self.text]
        if found:
            return TRACE, f"'{found[0]}' in the output: {' '.join(self.text.split())[:300]} ... {last[-200:]}"
        if self.status == 0:
            return COMPLETE, ""
        if self.status in (3, 130, 143):
            return STOPPED, last
        if self.status != 1:
            return WRONG_STATUS, f"exit status {self.status}: {last}"
        if self.messages == 0:
            return NO_MESSAGE, last
        if self.messages > 1:
            return MESSAGES, " ".join(self.stderr.split())[:600]
        return REFUSED, last


def limit_memory(size):
    """Of this process, to so many bytes of addresses, and without a core file."""
    resource.setrlimit(resource.RLIMIT_AS, (size, size))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def stat_of(process):
    """What the system says of a process, from its state on: R (runs), S (sleeps), D (waits for a disk), ...; nothing if it is gone."""
    try:
        with open(f"/proc/{process}/stat") as file:
            return file.read().rsplit(")", 1)[1].split()
    except OSError:
        return []


def session_members(session):
    """The processes of a session that are alive: mpirun and what it started stay in it, whatever their groups."""
    found = {int(name): stat_of(name) for name in os.listdir("/proc") if name.isdigit()}
    return [process for process, fields in found.items() if fields and int(fields[3]) == session and fields[0] != "Z"]


def processor_seconds(processes):
    """What these processes have computed so far."""
    return sum(int(field) for process in processes for field in stat_of(process)[11:13]) / os.sysconf("SC_CLK_TCK")


def shared_memory(processes):
    """The files in /dev/shm that these processes have mapped."""
    found = set()
    for process in processes:
        try:
            with open(f"/proc/{process}/maps") as file:
                found.update(line.split("/dev/shm/", 1)[1].strip() for line in file if "/dev/shm/" in line)
        except OSError:
            pass
    return {name for name in found if "(deleted)" not in name}


def signal_processes(processes, number):
    for process in processes:
        try:
            os.kill(process, number)
        except ProcessLookupError:
            pass


class Process:
    """A run that goes on. Its output is kept in files, so that it never waits for a reader."""

    def __init__(self, arguments, case, ranks=1, environment=None, prepare=None, cwd=None):
        command, variables = command_and_environment(arguments, ranks)
        variables.pop("OMPI_MCA_orte_tmpdir_base", None)
        variables.update({"TMPDIR": case.temporary, **(environment or {})})
        self.streams = [tempfile.TemporaryFile(), tempfile.TemporaryFile()]
        self.began = time.monotonic()
        self.popen = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=self.streams[0], stderr=self.streams[1],
                                      cwd=cwd or case.folder, env=variables, start_new_session=True, preexec_fn=prepare)

    @property
    def pid(self):
        return self.popen.pid

    @property
    def running(self):
        return self.popen.poll() is None

    def members(self):
        return session_members(self.popen.pid)

    def ranks(self):
        """The processes of the session that are the program itself."""
        found = []
        for process in self.members():
            try:
                if os.path.basename(os.readlink(f"/proc/{process}/exe")).startswith("perideal"):
                    found.append(process)
            except OSError:
                pass
        return sorted(found)

    def wait(self, timeout):
        """The end of the run. One that goes beyond the time limit is asked to stop, and ended if it does not. On a machine that has no
        time for the run the limit is four times as long."""
        late = None
        try:
            self.popen.wait(timeout)
        except subprocess.TimeoutExpired:
            late = self._late(timeout)
        finally:  # also where the campaign itself is interrupted
            self.end_all()
        return self._end(late, timeout)

    def _late(self, timeout):
        """What a run does that takes too long: 'ended when asked to', 'did not end when asked to', 'at rest'; or None if it ends after all."""
        while time.monotonic() - self.began < 4 * timeout and processor_seconds(self.members()) < timeout / 2 and self._runnable():
            try:
                self.popen.wait(1)
                return None
            except subprocess.TimeoutExpired:
                pass
        busy = self._runnable()
        if not self.running:
            return None
        signal_processes([self.pid], signal.SIGTERM)
        try:
            self.popen.wait(30)
        except subprocess.TimeoutExpired:
            return "did not end when asked to"
        return "ended when asked to" if busy else "at rest"

    def _runnable(self):
        """Whether any of the processes computes, waits for a processor or for a disk; looked at for five seconds."""
        for _ in range(100):
            if any(stat_of(process)[:1] in (["R"], ["D"]) for process in self.members()):
                return True
            time.sleep(0.05)
        return False

    def end_all(self):
        """End what is left of the session, and wait until it is gone."""
        for _ in range(100):
            members = self.members()
            if not members:
                break
            signal_processes(members, signal.SIGKILL)
            self.popen.poll()
            time.sleep(0.02)
        self.popen.wait()

    def _end(self, late, timeout):
        texts = []
        for stream in self.streams:
            stream.seek(0)
            texts.append(stream.read().decode(errors="replace"))
            stream.close()
        end = End(self.popen.returncode, texts[0], texts[1], time.monotonic() - self.began)
        if late is not None:
            end.kind = TOO_LONG if late == "ended when asked to" and end.kind != TRACE else HANG
            end.detail = f"after {timeout} s, {late}: " + " ".join(end.text.split())[-200:]
        return end


def run(arguments, case, ranks=1, timeout=60, environment=None, prepare=None, cwd=None):
    """Run the program to its end, or to the time limit."""
    return Process(arguments, case, ranks, environment, prepare, cwd).wait(timeout)


class Case:
    """One case: its number, its random numbers, a folder for its files and a temporary one for its runs."""

    def __init__(self, campaign, number):
        self.campaign, self.number = campaign, number
        self.random = random.Random(f"{campaign.name} {campaign.seed} {number}")
        self.base = tempfile.mkdtemp(prefix="perideal_")
        self.folder = os.path.join(self.base, "case")
        self.temporary = os.path.join(self.base, "tmp")
        os.mkdir(self.folder)
        os.mkdir(self.temporary)
        self.failed = False

    def count(self, what, kind, detail=""):
        """Count how the case ended. A kind that is not in GOOD is a failure, printed with how to repeat it."""
        self.campaign.table[what][kind] += 1
        if kind in GOOD:
            if self.campaign.only is not None:
                print(f"{what}: {kind} {detail}")
            return
        self.failed = True
        self.campaign.failed += 1
        print(f"FAILED: {what}: {kind}: {detail}\n"
              f"  repeat: {self.campaign.name}.py --seed {self.campaign.seed} --case {self.number}", flush=True)

    def left_behind(self):
        """What lies in the temporary folder of the runs."""
        return sorted(os.listdir(self.temporary))

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "wb") as file:
            file.write(text if isinstance(text, bytes) else text.encode())
        return path

    def close(self):
        if self.campaign.keep and (self.failed or self.campaign.only is not None):
            kept = os.path.join(self.campaign.keep, f"{self.campaign.name}_{self.campaign.seed}_{self.number}")
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(self.folder, kept, symlinks=True)
            print(f"  kept: {kept}")
        shutil.rmtree(self.base, ignore_errors=True)


class Campaign:
    """The cases that the command line asks for, and the table of their ends."""

    def __init__(self, text, cases):
        self.name = os.path.splitext(os.path.basename(sys.argv[0]))[0]
        parser = argparse.ArgumentParser(description=text, formatter_class=argparse.RawDescriptionHelpFormatter)
        parser.add_argument("--cases", type=int, default=cases, help=f"number of cases ({cases})")
        parser.add_argument("--seed", type=int, default=1, help="another seed tries other cases (1)")
        parser.add_argument("--case", type=int, help="this case only, counted from 0")
        parser.add_argument("--first", type=int, default=0, help="the first case (0)")
        parser.add_argument("--keep", help="folder to keep the files of failed cases in")
        arguments = parser.parse_args()
        self.seed, self.only, self.keep = arguments.seed, arguments.case, arguments.keep
        self.numbers = [self.only] if self.only is not None else range(arguments.first, arguments.first + arguments.cases)
        self.table = collections.defaultdict(collections.Counter)
        self.failed = 0
        self.began = time.monotonic()

    def __iter__(self):
        for number in self.numbers:
            case = Case(self, number)
            try:
                yield case
            finally:
                case.close()

    def finish(self):
        """Print the table; exit status 1 if any case failed, or none was counted."""
        kinds = sorted({kind for row in self.table.values() for kind in row}, key=lambda kind: (kind not in GOOD, kind))
        rows = [[what] + [str(row[kind] or "") for kind in kinds] + [str(sum(row.values()))]
                for what, row in sorted(self.table.items())]
        total = collections.Counter()
        for row in self.table.values():
            total.update(row)
        rows.append(["all"] + [str(total[kind] or "") for kind in kinds] + [str(sum(total.values()))])
        print_table(f"{self.name}, seed {self.seed}", ["", *kinds, "all"], rows)
        print(f"{len(self.numbers)} cases, {self.failed} failed, {time.monotonic() - self.began:.0f} s")
        sys.exit(1 if self.failed or not total else 0)
