# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Charts in the page whose points tell their names: Chart.js, the whole of which stands in the page, so that it needs no network."""

import json
import os
from html import escape
from pathlib import Path

# Debian's libjs-chart.js; another place may be given.
PLACES = (os.environ.get("PERIDEAL_CHART_JS"), "/usr/share/javascript/chart.js/chart.min.js", "/usr/share/nodejs/chart.js/dist/chart.min.js")
OWN = Path(__file__).parent / "interactive.js"
MARKERS = {"o": "circle", "s": "rect", "D": "rectRot", "^": "triangle", "v": "triangle", "P": "cross", "X": "crossRot", None: "circle"}


def library():
    """The text of Chart.js, or None where it is not installed."""
    for place in PLACES:
        if place and Path(place).is_file():
            return Path(place).read_text(encoding="utf-8")
    return None


def script(text):
    """In a page: nothing in it may end the element."""
    return f"<script>\n{text.replace('</script', '<' + chr(92) + '/script')}\n</script>"


def add_library(page):
    """Once in a page, before its charts. Whether there is one."""
    text = library()
    if text is None:
        return False
    page.add(script(text))
    page.add(script(OWN.read_text(encoding="utf-8")))
    return True


def add_chart(page, mark, chart, caption, height=720):
    """One chart. `chart`: lines (name, color, marker, dashes, hidden, stars, points with name and error), axes (key, name, title) of costs, and numbers
    (key, title, unit) that are told of a point; the first axis is shown first."""
    data = json.dumps(chart, ensure_ascii=True, allow_nan=False).replace("<", "\\u003c")
    page.add(f'<figure class="interactive"><div id="{mark}-buttons" class="buttons"></div><div style="height: {height}px"><canvas id="{mark}"></canvas></div>'
             f'<figcaption>{escape(caption)}</figcaption></figure><script type="application/json" id="{mark}-data">{data}</script>'
             + script(f'window.perideal_charts = window.perideal_charts || {{}};\nwindow.perideal_charts["{mark}"] = perideal_chart("{mark}");'))
