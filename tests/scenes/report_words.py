# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""What users may write into a scene stays text in the report: titles, units, comments, names of phases, sides and files that look like HTML or like formulas of TeX."""

import html.parser
import os
import subprocess
import sys

from scene_test import SOURCE_DIR, check, finish, run_perideal, temporary_folder, write_file

HOSTILE = "<svg onload=alert(1)>&amp;\"'<b>$\\frac</b>"
PHASE = "<svg onload=alert(1)>&'<b>$\\frac"
# Comments and values end at #; a backslash at the end continues a line.
TEXT = f"""# {HOSTILE}
#
#   {HOSTILE}
#   {HOSTILE}

set Title = {HOSTILE}
set Dimension = 2
set Physics = PHYSICS
subsection Domain
  set Upper corner = 1, 1
  set Cells = 8, 8
end
subsection Material
  set Young modulus = YOUNG
  set Poisson ratio = POISSON
  subsection Phases
    set Regions = {PHASE}: x > 0.5
    set ENTRY = {PHASE}: 100
  end
end
subsection Boundary conditions
  set CONDITIONS
end
subsection Time
  set End time = 0.1
end
subsection Output
  set Write every = 0.025
  set Probes = 0.5, 0.5
  set Line = 0, 0.5 ; 1, 0.5 ; 5
end
subsection Units
  set Length = {HOSTILE}
  set Time = {HOSTILE}
  set Temperature = {HOSTILE}
end
"""

KINDS = {"heat": ("", "", "Conductivity", "Dirichlet = left: 0*(x<1); right: 1"),
         "elasticity": ("200", "0.3", "Young modulus", "Displacement = left: 0, 0; right: 0.01*t*(y<2), 0")}

ALLOWED = {"html", "head", "meta", "title", "style", "body", "main", "header", "nav", "section", "div", "h1", "h2", "h3", "p", "span", "a", "ul", "li", "table",
           "thead", "tbody", "tr", "th", "td", "figure", "figcaption", "img", "strong", "em", "footer", "pre"}


class Tags(html.parser.HTMLParser):
    """Elements and attributes that no report has, and whether the user's words are read as they are."""

    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.foreign, self.text, self.alternatives = [], [], []

    def handle_starttag(self, tag, attrs):
        if tag not in ALLOWED or any(name.startswith("on") for name, _ in attrs):
            self.foreign.append((tag, attrs))
        self.alternatives += [value for name, value in attrs if name == "alt"]

    def handle_data(self, data):
        self.text.append(data)


def main():
    folder = temporary_folder()
    for physics, (young, poisson, entry, conditions) in KINDS.items():
        text = TEXT.replace("PHYSICS", physics).replace("YOUNG", young).replace("POISSON", poisson).replace("CONDITIONS", conditions)
        text = text.replace("ENTRY", entry)
        path = write_file(f"<i onclick=x>& '{physics}'.prm", text, folder)
        results = os.path.join(folder, physics)
        status, stdout, stderr = run_perideal(["run", path, "-s", f"Output directory={results}"])
        if not check(status == 0, f"{physics}: exit status {status}\n{stdout[-1500:]}{stderr[-1500:]}"):
            continue
        script = os.path.join(SOURCE_DIR, "applications", "report", "report.py")
        done = subprocess.run([sys.executable, script, results], capture_output=True, text=True, timeout=300)
        if not check(done.returncode == 0, f"{physics}: the report ends with {done.returncode}\n{done.stderr[-2000:]}"):
            continue
        with open(os.path.join(results, "report.html"), encoding="utf-8") as file:
            page = file.read()
        tags = Tags()
        tags.feed(page)
        check(not tags.foreign, f"{physics}: elements of the user in the page: {tags.foreign[:5]}")
        for raw in ("<svg", "onload=alert(1)>", "<b>", "<i onclick"):
            check(raw not in page, f"{physics}: '{raw}' is not escaped")
        words = "".join(tags.text)
        check(words.count(HOSTILE) >= 6, f"{physics}: the user's words are read as they are {words.count(HOSTILE)} times")
        check(f"'{physics}'.prm" in words, f"{physics}: the name of the scene")
        for text in tags.alternatives:
            check("&lt;" not in text and "&amp;lt;" not in text, f"{physics}: escaped twice: {text}")
    finish()


if __name__ == "__main__":
    main()
