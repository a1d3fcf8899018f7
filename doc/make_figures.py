#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Make the pictures of the README and of doc/ from real runs, and the tables of scenes of doc/scenes.md and the README.

    python3 doc/make_figures.py [--program PERIDEAL] [--all] [SCENE.prm ...]
    python3 doc/make_figures.py --work-precision

Runs each scene (all below prm/ but those of prm/failures and those as published, if none is named), draws its report, and keeps of it
doc/figures/NAME.png: the last plastic strain or temperature (displacement, stress), scaled to a thumbnail. For prm/quick_start.prm the
figure is kept in full width too, as doc/figures/quick_start_wide.png. A picture that is newer
than its scene is left as it is, unless --all is given. The tables name every scene below prm/ (six of them in the README) with
its title and the first sentence of its comment, up to a colon or bracket; --table writes the tables only.
--work-precision makes the charts of accuracy against cost of doc/coupling.md instead, and prints what
`./run study work_precision` says. --charts makes those of doc/charts.md.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image, ImageChops

ROOT = Path(__file__).resolve().parent.parent
FIGURES = ROOT / "doc" / "figures"
THUMBNAIL_HEIGHT, WIDE_WIDTH = 200, 1300
CHART_WIDTH = 1400
PAGE_CHART_WIDTH = 1000
LADDER = "21, 21 | 41, 41 | 81, 81 | 161, 161 | 321, 321"
# Scene, options of `./run study work_precision`, and the charts that are kept.
CHARTS = (("prm/coupling/insulated_crack.prm",
           ["-s", "Time/Steady=true", "--cells", LADDER, "--reference", "240, 240 | 480, 480 | 960, 960"],
           {"error_over_work": "work_precision_insulated_crack", "error_over_wall_time": "work_precision_insulated_crack_time"}),
          ("prm/coupling/oblique_crack.prm", ["--cells", LADDER], {"error_over_work": "work_precision_oblique_crack"}))
# Of doc/charts.md: name, scene, options, charts.
TIMES, BOTH = ("error_over_wall_time",), ("error_over_wall_time", "error_in_time_over_work")
OF_CRACKS = ["--cells", "21, 21 | 41, 41 | 81, 81 | 161, 161", "--budget", "4e5"]
CHARTS_OF_PAGE = (
    ("smooth", "prm/heat/smooth_source.prm", ["--cells", "8, 8 | 16, 16 | 32, 32 | 64, 64", "--repeat", "5"], TIMES),
    ("layer", "prm/heat/narrow_layer.prm", ["--cells", "20, 20 | 40, 40 | 80, 80 | 160, 160", "--repeat", "3"], TIMES),
    ("insulated_crack", "prm/coupling/insulated_crack.prm", ["-s", "Time/Steady=true", *OF_CRACKS], TIMES),
    ("oblique_crack", "prm/coupling/oblique_crack.prm", OF_CRACKS, TIMES),
    ("graded_material_crack", "prm/coupling/graded_material_crack.prm", OF_CRACKS, TIMES),
    ("crack_3d", "prm/heat/block_with_crack.prm", ["-s", "Time/Steady=true", "--cells", "9, 9, 9 | 17, 17, 17 | 33, 33, 33", "--budget", "4e5", "--repeat", "1"], TIMES),
    ("transient_crack", "prm/coupling/insulated_crack.prm", ["--cells", "21, 21 | 41, 41 | 81, 81", "--budget", "2e5"], BOTH),
    ("elastic_crack", "prm/elasticity/coupled_crack.prm", ["--cells", "11, 11 | 21, 21 | 41, 41 | 81, 81", "--budget", "2e5"], TIMES),
    ("wave", "prm/elasticity/wave_in_bar.prm", ["--cells", "100 | 200 | 400 | 800", "--repeat", "5"], TIMES),
    ("angle", "prm/heat/angle.prm", ["--cells", "1 | 2 | 4 | 8 | 16", "--repeat", "5"], TIMES),
    ("strength", "prm/fracture/centre_crack.prm", ["--measure", "strength", "--cells", "15, 31 | 21, 41 | 31, 61", "--repeat", "1"], TIMES))
OF_README = ("quick_start.prm", "coupling/growing_cracks.prm", "elasticity/coupled_crack.prm", "elasticity/thermal_stress.prm",
             "fracture/branching_crack.prm", "papers/le_2014/longitudinal.prm")
BEGIN, END = "<!-- scenes: written by doc/make_figures.py -->\n", "<!-- end of scenes -->\n"


def figure_name(scene):
    """Name of its picture: that of the file, of a paper's example with the paper's before it."""
    return f"{scene.parent.name}_{scene.stem}" if scene.parent.parent.name == "papers" else scene.stem


def published_twin(scene):
    """Whether a scene is one as published, beside the same one in our settings."""
    return scene.stem.endswith("_paper") and scene.with_name(scene.stem[:-6] + ".prm").exists()


def run(scene, program, folder):
    """Compute and draw one scene; returns the folder with its figures."""
    results, figures = folder / "results", folder / "figures"
    subprocess.run([program, "run", str(scene), "-q", "-s", f"Output directory={results}"],
                   check=True, cwd=ROOT)
    subprocess.run([sys.executable, str(ROOT / "applications" / "report" / "report.py"),
                    str(results), "--figures", str(figures)],
                   check=True, stdout=subprocess.DEVNULL)
    return figures


def cropped(image):
    """The image without the white margin around it."""
    image = image.convert("RGB")
    box = ImageChops.difference(image, Image.new("RGB", image.size, "white")).getbbox()
    if not box:
        return image
    margin = 12
    return image.crop((max(0, box[0] - margin), max(0, box[1] - margin),
                       min(image.width, box[2] + margin), min(image.height, box[3] + margin)))


def save(image, name, width=None, height=None):
    """Scaled to the width or height, with few colours."""
    scale = width / image.width if width else height / image.height
    size = (round(image.width * scale), round(image.height * scale))
    small = image.resize(size, Image.LANCZOS).quantize(256, kmeans=2, dither=Image.NONE)
    FIGURES.mkdir(exist_ok=True)
    small.save(FIGURES / f"{name}.png", optimize=True)
    print(f"doc/figures/{name}.png: {(FIGURES / f'{name}.png').stat().st_size / 1000:.0f} kB")


def picture(figures, scene):
    """The last figure of plastic strain or the temperature, of bodies that break the damage; of an elastic body the deformed shape, of those of papers the stress; of a bar its line."""
    elastic = {"le_2014": "von_mises", "fracture": "damage"}.get(scene.parent.name, "displacement_magnitude")
    found = (elastic != "damage" and (sorted(figures.glob("plastic_strain*.png")) or sorted(figures.glob("temperature*.png")))) or sorted(figures.glob(f"{elastic}*.png")) \
        or sorted(figures.glob("displacement_magnitude*.png")) or [figures / "line.png"]
    image = cropped(Image.open(found[-1]))
    solid = re.search(r"^\s*set\s+Dimension\s*=\s*3", scene.read_text(encoding="utf-8"), re.MULTILINE)
    if solid and image.height > image.width:  # its outer faces and the first slice
        image = image.crop((0, 0, image.width, round(0.47 * image.height)))
    return image


def description(scene):
    """Title and first sentence of the comment of a scene."""
    text = scene.read_text(encoding="utf-8")
    title = re.search(r"^\s*set\s+Title\s*=\s*(.*?)\s*$", text, re.MULTILINE)
    comment = []
    for line in text.splitlines():
        words = line.strip().lstrip("#").strip()
        if not line.strip().startswith("#") or (not words and comment):
            break
        if words and not re.match("SPDX|Copyright", words):
            comment.append(words)
    # A full stop that ends a sentence: not that of an abbreviation such as J. Comput. Phys.
    sentence = re.match(r".*?[a-z0-9)]{3}\.(?= [A-Z][a-z]* [a-z]|$)", " ".join(comment))
    text = sentence.group(0) if sentence else " ".join(comment)
    return (title.group(1) if title else scene.stem,
            re.split(r": | \(", text, maxsplit=1)[0].rstrip(".") + ".")


def row_of(scene, start):
    """A line of a table in a page of the folder start."""
    title, text = description(scene)
    published = scene.with_name(scene.stem + "_paper.prm")
    if published.exists():
        text += f" [As published]({os.path.relpath(published, start)})."
    shown = FIGURES / f"{figure_name(scene)}.png"
    image = f'<br><img src="{os.path.relpath(shown, start)}" height="100" alt="{title}">' if shown.exists() else ""
    return f"| [{figure_name(scene)}]({os.path.relpath(scene, start)}){image} | **{title}.** {text} |\n"


def write_between_marks(page, rows):
    """The table, between its marks."""
    text = page.read_text(encoding="utf-8")
    begin, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    page.write_text(text[:begin] + "\n| scene | |\n|---|---|\n" + "".join(rows) + "\n" + text[end:], encoding="utf-8")


def write_tables():
    """All scenes in doc/scenes.md, some of them in the README."""
    scenes = [scene for scene in sorted((ROOT / "prm").rglob("*.prm"), key=lambda s: (s.parent != ROOT / "prm", s.as_posix()))
              if "failures" not in scene.parts and not published_twin(scene)]  # the former are in doc/failures.md, the latter beside the others
    write_between_marks(ROOT / "doc" / "scenes.md", [row_of(scene, ROOT / "doc") for scene in scenes])
    write_between_marks(ROOT / "README.md", [row_of(ROOT / "prm" / name, ROOT) for name in OF_README])


def study(program, arguments, **options):
    """By the package in python/, on this program."""
    variables = dict(os.environ, PERIDEAL_EXECUTABLE=str(program), PYTHONPATH=str(ROOT / "python"))
    return subprocess.run([sys.executable, "-m", "perideal", *arguments], check=True, cwd=ROOT, env=variables, **options)


def make_charts(program):
    """Accuracy against cost."""
    for scene, options, charts in CHARTS:
        with tempfile.TemporaryDirectory() as folder:
            study(program, ["study", "work_precision", scene, "--output", folder, "--repeat", "3", *options])
            subprocess.run([sys.executable, str(ROOT / "applications" / "report" / "study.py"), folder], check=True, stdout=subprocess.DEVNULL)
            for figure, name in charts.items():
                save(cropped(Image.open(Path(folder) / f"{figure}.png")), name, width=CHART_WIDTH)


def make_charts_of_page(program, names, keep):
    """Those of doc/charts.md, with what `Models = auto` picks; all that the study says goes to output/charts."""
    for name, scene, options, charts in CHARTS_OF_PAGE:
        if names and name not in names:
            continue
        folder = ROOT / "output" / "charts" / name
        command = ["study", "work_precision", scene, "--output", str(folder), *options]
        print("perideal", " ".join(f'"{word}"' if " " in word else word for word in command), flush=True)
        if not keep:
            for more in ([], ["--only", "auto"] + ([] if "--repeat" in options else ["--repeat", "5"])):  # short runs are uncertain
                done = study(program, [*command, *more], capture_output=True, text=True)
            (folder / "said.txt").write_text(done.stdout, encoding="utf-8")
        subprocess.run([sys.executable, str(ROOT / "applications" / "report" / "study.py"), str(folder)], check=True, stdout=subprocess.DEVNULL)
        for chart in charts:
            save(cropped(Image.open(folder / f"{chart}.png")), f"chart_{name}" + ("_in_time" if "in_time" in chart else ""), width=PAGE_CHART_WIDTH)


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description="Make doc/figures from runs of the scenes.")
    parser.add_argument("scenes", nargs="*", type=Path)
    parser.add_argument("--program", default=str(ROOT / "build/release/applications/perideal"))
    parser.add_argument("--all", action="store_true", help="also those that are up to date")
    parser.add_argument("--table", action="store_true", help="only the tables of scenes")
    parser.add_argument("--work-precision", action="store_true", help="only the charts of accuracy against cost")
    parser.add_argument("--charts", nargs="*", metavar="NAME", help="only the charts of doc/charts.md, or those named")
    parser.add_argument("--drawn-again", action="store_true", help="with --charts: from what was computed before")
    options = parser.parse_args()
    if options.charts is not None:
        make_charts_of_page(options.program, options.charts, options.drawn_again)
        return 0
    if options.work_precision:
        make_charts(options.program)
        return 0
    if options.table:
        write_tables()
        return 0
    scenes = [s.resolve() for s in options.scenes] or sorted(
        s for s in (ROOT / "prm").rglob("*.prm") if "failures" not in s.parts and not published_twin(s))
    failed = False
    for scene in scenes:
        old = FIGURES / f"{figure_name(scene)}.png"
        if not options.all and old.exists() and old.stat().st_mtime > scene.stat().st_mtime:
            continue
        with tempfile.TemporaryDirectory() as folder:
            try:
                image = picture(run(scene, options.program, Path(folder)), scene)
            except (subprocess.CalledProcessError, OSError) as fault:
                print(f"{scene.name}: {fault}", file=sys.stderr)
                failed = True
                continue
        save(image, figure_name(scene), height=THUMBNAIL_HEIGHT)
        if scene.stem == "quick_start":
            save(image, "quick_start_wide", width=WIDE_WIDTH)
    write_tables()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
