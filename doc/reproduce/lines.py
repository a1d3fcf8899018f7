# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The tables of the page: what was published, what comes out, how to run it again."""

from results import Missing


class Line:
    """A line of a table.

    what: the settings in words. needs: rows of the study, the first of which is the one whose cost and scene are shown.
    compute: study -> list of numbers. published: list of the same length (None where the paper has no number), or None.
    """

    def __init__(self, what, needs, compute, published=None):
        self.what, self.compute, self.published = what, compute, published
        self.needs = [needs] if isinstance(needs, str) else list(needs)

    def evaluate(self, study):
        """{"values", "seconds", "bonds"}, or None where a row is missing."""
        if any(name not in study for name in self.needs):
            return None
        row = study[self.needs[0]]
        try:
            values = [float(v) for v in self.compute(study)]
        except Missing:
            return None
        return {"values": values, "seconds": float(f"{row.seconds():.2g}"), "bonds": int(row.model().get("bonds") or 0)}


class Table:
    """A published table or figure.

    kind: "numbers" has columns published, obtained and gap; "picture" only the obtained difference from a reference.
    columns: headings of the numbers. gap: "relative" or "absolute". digits: of the numbers. tolerance: of --check, relative to
    the largest number of a line.
    """

    def __init__(self, key, source, text, columns, lines, kind="numbers", gap="relative", digits=4, tolerance=1e-3,
                 after=""):
        self.key, self.source, self.text, self.columns, self.lines = key, source, text, columns, lines
        self.kind, self.gap, self.digits, self.tolerance, self.after = kind, gap, digits, tolerance, after
        names = [line.what for line in lines]
        assert len(set(names)) == len(names), f"{key}: two lines of one name"


class Picture:
    """A figure of the page; draw(study, path) needs the rows."""

    def __init__(self, name, text, needs, draw):
        self.name, self.text, self.needs, self.draw = name, text, list(needs), draw


class Paper:
    """A section of the page."""

    def __init__(self, key, title, reference, text, tables, pictures, after=""):
        self.key, self.title, self.reference, self.text = key, title, reference, text
        self.tables, self.pictures, self.after = tables, pictures, after
