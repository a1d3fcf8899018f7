# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Many runs for one start of the program: `perideal serve`, with its protocol in doc/python.md."""

import json
import os
import select
import subprocess
import tempfile
from pathlib import Path
from typing import Iterable, Optional

from . import program
from .program import Answer, Overrides
from .results import Results


class Server:
    """A running program that executes one command after the other, on a number of processes.

    It is started by the first command, and again by the next one where a command has ended it. Is a context: at the end it is stopped.
    """

    def __init__(self, processes: int = 1):
        self.processes = processes
        self.process = None
        self._said = None

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if kind is KeyboardInterrupt and self.process is not None:
            self.process.terminate()  # in the midst of a command
        self.close()

    def run(self, scene, overrides: Overrides = (), folder=None, timeout: Optional[float] = None) -> Results:
        """As perideal.run()."""
        return program.run_with(lambda arguments: self.call(arguments, timeout), scene, overrides, folder)

    def describe(self, scene, overrides: Overrides = ()) -> dict:
        """As perideal.describe()."""
        return program.describe_with(self.call, scene, overrides)

    def call(self, arguments: Iterable[str], timeout: Optional[float] = None, cwd=None) -> Answer:
        """Execute `perideal ARGUMENTS`. Raises subprocess.TimeoutExpired, after which the program is gone."""
        if self.process is not None and self.process.poll() is not None:  # something else has ended it meanwhile
            self._end()
        if self.process is None:
            self._start()
        with tempfile.TemporaryDirectory(prefix="perideal_said_") as folder:
            files = {name: os.path.join(folder, name) for name in ("output", "errors")}
            for name in files.values():
                Path(name).touch()
            status = self._ask({"arguments": list(arguments), "directory": os.path.abspath(cwd or os.curdir), **files}, timeout)
            texts = {name: Path(path).read_text(encoding="utf-8", errors="replace") for name, path in files.items()}
        if status is None:  # it has ended, as a program of its own would have
            status, texts["errors"] = self._end(), texts["errors"] + self._said_last()
        return Answer(status, **texts)

    def close(self):
        """End the program, if it runs."""
        if self.process is None:
            return
        try:
            self.process.stdin.close()
            self.process.wait(60)
        except (OSError, subprocess.TimeoutExpired):
            self.process.kill()
        self._end()

    def _start(self):
        self._said = tempfile.TemporaryFile()
        self.process = subprocess.Popen(program.command(["serve"], self.processes), stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=self._said, env=program.environment())

    def _end(self) -> int:
        """Of a program that ends by itself; its exit status."""
        process, self.process = self.process, None
        status = process.wait()
        for pipe in (process.stdin, process.stdout):
            try:
                pipe.close()
            except OSError:
                pass
        return status

    def _said_last(self) -> str:
        self._said.seek(0)
        return self._said.read().decode(errors="replace")

    def _ask(self, request: dict, timeout: Optional[float]) -> Optional[int]:
        """The exit status of a request; None if the program has ended over it."""
        try:
            self.process.stdin.write((json.dumps(request) + "\n").encode())
            self.process.stdin.flush()
        except BrokenPipeError:
            return None
        line = b""
        while not line.endswith(b"\n"):
            if not select.select([self.process.stdout], [], [], timeout)[0]:
                self.process.kill()
                self._end()
                raise subprocess.TimeoutExpired(["perideal", *request["arguments"]], timeout)
            more = os.read(self.process.stdout.fileno(), 4096)
            if not more:
                return None
            line += more
        return json.loads(line)["status"]
