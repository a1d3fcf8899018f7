# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The scenes of doc/recipes.md run as they stand there and give what stands beside them."""

import os
import re

from scene_test import PD, SOURCE_DIR, Comparison, check, finish, run_scene


def recipes():
    """Heading -> scene, of each section."""
    with open(os.path.join(SOURCE_DIR, "doc", "recipes.md")) as file:
        sections = re.split(r"^## ", file.read(), flags=re.M)[1:]
    return {s.splitlines()[0]: "".join(line[4:] + "\n" for line in s.splitlines() if line.startswith("    ")) for s in sections}


def main():
    scenes = recipes()
    check(len(scenes) == 5, f"five recipes: {list(scenes)}")
    quiet = {"Output/Fields": "none"}
    table = Comparison("What the recipes say")
    for heading, handbook, above in (("Toughness: a beam with a notch, bent on three points", 1.065e4, 0.005),
                                     ("Toughness: a compact tension specimen", 9659, 0.011)):
        run = run_scene(scenes[heading], quiet)
        K = run.model("coupled")["stress intensity"]["crack 1 end 2"]["I"]
        table.add(f"{heading}: K_I over that of the handbook, less 1", K / handbook - 1, above, absolute=2e-3)
    holes = run_scene(scenes["A plate with holes"], quiet)
    for model in ("finite elements", PD):
        force = holes.model(model)["boundary force"]["left"][0]
        table.add(f"holes, {model}: force on the support", force, -1e5, relative=1e-6)
    struck = run_scene(scenes["A struck plate with two notches"], quiet)
    check(struck.model(PD)["energy balance"]["broken bonds"] > 1000, "the struck plate cracks")
    # A coarser lattice: half a minute otherwise.
    quench = run_scene(scenes["A hot plate in cold water"], {**quiet, "Domain/Cells": "50, 10"})
    check(quench.model(PD)["energy balance"]["broken bonds"] > 100, "the hot plate cracks")
    finish()


if __name__ == "__main__":
    main()
