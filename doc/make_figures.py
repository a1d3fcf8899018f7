#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Make the pictures of the README and of doc/ from real runs.

    python3 doc/make_figures.py [--program PERIDEAL] [--all] [SCENE.prm ...]

Runs each scene (all below prm/ if none is named), draws its report, and keeps of it
doc/figures/NAME.png: the last temperature, scaled to a thumbnail. For prm/quick_start.prm the
figure is kept in full width too, as doc/figures/quick_start_wide.png. A picture that is newer
than its scene is left as it is, unless --all is given.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image, ImageChops

ROOT = Path(__file__).resolve().parent.parent
FIGURES = ROOT / "doc" / "figures"
THUMBNAIL_HEIGHT, WIDE_WIDTH, COLORS = 150, 1300, 128


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
    return image.crop(box) if box else image


def save(image, name, width=None, height=None):
    """Scaled to the width or height, with few colours."""
    scale = width / image.width if width else height / image.height
    size = (round(image.width * scale), round(image.height * scale))
    small = image.resize(size, Image.LANCZOS).quantize(COLORS, dither=Image.NONE)
    FIGURES.mkdir(exist_ok=True)
    small.save(FIGURES / f"{name}.png", optimize=True)
    print(f"doc/figures/{name}.png: {(FIGURES / f'{name}.png').stat().st_size / 1000:.0f} kB")


def picture(figures):
    """The last figure of the temperature; of a bar its line."""
    found = sorted(figures.glob("temperature*.png")) or [figures / "line.png"]
    return cropped(Image.open(found[-1]))


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description="Make doc/figures from runs of the scenes.")
    parser.add_argument("scenes", nargs="*", type=Path)
    parser.add_argument("--program", default=str(ROOT / "build/release/applications/perideal"))
    parser.add_argument("--all", action="store_true", help="also those that are up to date")
    options = parser.parse_args()
    scenes = [s.resolve() for s in options.scenes] or sorted((ROOT / "prm").rglob("*.prm"))
    failed = False
    for scene in scenes:
        old = FIGURES / f"{scene.stem}.png"
        if not options.all and old.exists() and old.stat().st_mtime > scene.stat().st_mtime:
            continue
        with tempfile.TemporaryDirectory() as folder:
            try:
                image = picture(run(scene, options.program, Path(folder)))
            except (subprocess.CalledProcessError, OSError) as fault:
                print(f"{scene.name}: {fault}", file=sys.stderr)
                failed = True
                continue
        save(image, scene.stem, height=THUMBNAIL_HEIGHT)
        if scene.stem == "quick_start":
            save(image, "quick_start_wide", width=WIDE_WIDTH)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
