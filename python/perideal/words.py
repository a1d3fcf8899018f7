# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Numbers and names as the program writes them."""

import math
from typing import Iterable, List


def split_list(text: str, separator: str) -> List[str]:
    """The pieces between separators; none of a text that is empty."""
    return [piece.strip() for piece in text.split(separator)] if text.strip() else []


def number_text(value: float) -> str:
    """With as many digits, from 6 to 12, as the number needs."""
    return next((text for text in (f"{value:.{digits}g}" for digits in range(6, 12)) if float(text) == value), f"{value:.12g}")


def readable_count(n: int) -> str:
    """With commas between thousands."""
    return f"{n:,}"


def full_precision(value: float) -> str:
    """As in tables."""
    return "nan" if math.isnan(value) else f"{value:.15g}"


def readable_duration(seconds: float) -> str:
    """"5.4 s", "12 s", "3 min 20 s", "2 h 5 min"."""
    if seconds < 60:
        return f"{seconds:.2g} s" if seconds < 9.95 else f"{seconds:.0f} s"
    if seconds < 3600:
        return f"{int(seconds / 60)} min {int(seconds) % 60} s"
    return f"{int(seconds / 3600)} h {int(seconds / 60) % 60} min"


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """" Did you mean 'x'?", the name nearest in edit distance, or nothing where none is near enough to be what was meant."""
    distances = ((_edit_distance(name.lower(), one.lower()), one) for one in known)
    distance, best = min(distances, key=lambda pair: pair[0], default=(len(name), ""))
    return f" Did you mean '{best}'?" if distance < len(name) // 2 + 1 else ""


def _edit_distance(a: str, b: str) -> int:
    """Insertions, deletions, replacements and swaps of neighbours that turn one into the other."""
    rows = [list(range(len(b) + 1))]
    for i, letter in enumerate(a, 1):
        rows.append([i])
        for j, other in enumerate(b, 1):
            best = min(rows[i - 1][j] + 1, rows[i][j - 1] + 1, rows[i - 1][j - 1] + (letter != other))
            if i > 1 and j > 1 and letter == b[j - 2] and a[i - 2] == other:
                best = min(best, rows[i - 2][j - 2] + 1)
            rows[i].append(best)
    return rows[-1][-1]
