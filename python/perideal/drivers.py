# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""What studies that are written on this package share."""

import os
from pathlib import Path

from .program import Error
from .words import did_you_mean


class CannotWrite(Error):
    """A file of the study cannot be written: no fault of what is computed."""


def write_text(path: str, text: str) -> None:
    """Raises CannotWrite."""
    try:
        Path(path).write_text(text, encoding="utf-8", errors="replace")
    except OSError as error:
        raise CannotWrite(f"cannot write '{path}': {error.strerror}. Is the disk full, or was the directory removed during the run?") from None


def mistake_in(error: Error) -> str:
    """What is wrong with settings, without the words for overrides, which stand on no command line there. What is no mistake of a scene is raised
    on."""
    if error.status != 1 or isinstance(error, CannotWrite) or str(error).startswith("out of memory"):
        raise error
    return str(error).removeprefix("command line: ")


def require_scene(scene: str) -> None:
    """Raises Error where there is no such file, with the scene beside it that may be meant."""
    if os.path.isfile(scene):
        return
    beside = sorted(str(path) for path in Path(scene).parent.glob("*.prm"))
    raise Error(f"command line: there is no scene '{scene}' in the working directory." + did_you_mean(scene, beside))
