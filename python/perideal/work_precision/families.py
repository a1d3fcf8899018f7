# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The methods that are compared, in the order of tables and legends."""

import dataclasses
from typing import Dict, List

ELEMENTS, BONDS, COUPLED = "finite elements", "peridynamics", "coupled"


@dataclasses.dataclass
class Family:
    """A method with its settings, to be computed on several lattices."""

    name: str
    model: str  # as in output files
    settings: Dict[str, str]
    ratio: float = 0.0  # m of peridynamics in the whole body, else 0
    on_faces: bool = False  # needs lattices with the cracks on cell faces
    multiple: int = 1  # of the numbers of cells
    given_zone: bool = False  # the zone is the scene's, by a formula
    courant: float = 0.0  # steps over the time in which a wave crosses a cell; motion only
    halvings: int = 1  # of cells at corners, while those elsewhere are halved once; mesh files only


def _cracked(name: str, model: str, mesh: str, correction: str) -> Family:
    return Family(name, model, {
        "Models": model, "Cracks/Mesh": mesh, "Peridynamics/Surface correction": correction, "Peridynamics/Boundary treatment": "auto",
        "Peridynamics/Horizon": "", "Coupling/Zone": "cracks: 1", "Coupling/Adaptive tolerance": "0.02", "Domain/Coarsening": "0",
        "Domain/Fine where": "auto"}, on_faces=mesh == "faces")


def _whole_body(kind: str, ratio: str, treatment: str, correction: str) -> Family:
    family = _cracked(f"PD {kind}, m = {ratio}", BONDS, "pairs", correction)
    family.settings.update({"Peridynamics/Boundary treatment": treatment, "Peridynamics/Horizon ratio": ratio})
    family.ratio = float(ratio)
    return family


def _zone(ratio: str, width: str, scaled: bool) -> Family:
    family = _cracked(f"coupled, m = {ratio}, c = {width}" + (", scaled" if scaled else ""), COUPLED, "pairs",
                      "crack scaling" if scaled else "none")
    family.settings.update({"Peridynamics/Horizon ratio": ratio, "Coupling/Zone": f"cracks: {width}"})
    return family


def _zone_on_faces(width: str) -> Family:
    """The crack is part of the surface: no bond is broken, and there is nothing to be scaled."""
    family = _cracked(f"coupled on faces, m = 3, c = {width}", COUPLED, "faces", "none")
    family.settings.update({"Peridynamics/Horizon ratio": "3", "Coupling/Zone": f"cracks: {width}"})
    return family


def _graded(family: Family, k: int) -> Family:
    """The same on meshes whose cells are merged up to k times away from cracks; those of finite elements alone are as for m = 3, c = 1."""
    settings = {**family.settings, "Domain/Coarsening": str(k)}
    if family.model == ELEMENTS:
        settings["Peridynamics/Horizon ratio"] = "3"
    return dataclasses.replace(family, name=f"{family.name}, graded {k}", multiple=2 ** k, settings=settings)


def _zones() -> List[Family]:
    return [_zone(m, c, scaled) for m in ("2", "3") for c in ("0.5", "1", "2") for scaled in (False, True)]


def _around_cracks() -> List[Family]:
    on_faces, scaled = (lambda: _cracked("FEM, crack on faces", ELEMENTS, "faces", "none"),
                        lambda: _cracked("FEM, pairs, scaled", ELEMENTS, "pairs", "crack scaling"))
    families = [on_faces(), _cracked("FEM, pairs", ELEMENTS, "pairs", "none"), scaled(),
                _cracked("FEM, cells removed", ELEMENTS, "removed", "none")]
    for m in ("2", "3", "4", "6.5"):
        families += [_whole_body("raw", m, "none", "none"), _whole_body("energy-corrected", m, "none", "energy"),
                     _whole_body("exchange", m, "exchange", "none"), _whole_body("exchange, scaled", m, "exchange", "crack scaling")]
    families += _zones() + [_zone_on_faces("1")]
    for k in (2, 3):
        families += [_graded(uniform, k) for uniform in (
            on_faces(), scaled(), _zone("2", "1", True), _zone("3", "0.5", True), _zone("3", "1", True), _zone_on_faces("0.5"),
            _zone_on_faces("1"))]
    return families


def _bodies_with_cracks() -> List[Family]:
    """Cells that a crack cuts carry nothing, or the crack is part of the surface."""
    families = [_cracked("FEM, crack on faces", ELEMENTS, "faces", "none"), _cracked("FEM, cells removed", ELEMENTS, "removed", "none")]
    for m in ("2", "3", "4", "6.5"):
        families += [_whole_body("cut at sides", m, "none", "none"), _whole_body("energy-corrected", m, "none", "energy"),
                     _whole_body("completed", m, "auto", "auto")]
    families += _zones()
    for k in (2, 3):
        families += [_graded(uniform, k) for uniform in (
            _cracked("FEM, crack on faces", ELEMENTS, "faces", "none"), _zone("2", "1", True), _zone("3", "1", True))]
    for family in families:
        if not family.on_faces:
            family.settings["Cracks/Mesh"] = "removed"
    return families


def _plain(name: str, model: str, treatment: str = "auto", correction: str = "none") -> Family:
    """Without cracks: what there is to be said of a whole body."""
    return Family(name, model, {
        "Models": model, "Finite elements/Degree": "1", "Peridynamics/Surface correction": correction,
        "Peridynamics/Boundary treatment": treatment, "Peridynamics/Horizon": "", "Domain/Coarsening": "0", "Domain/Fine where": "auto"})


def _plain_bonds(kind: str, ratio: str, treatment: str, correction: str) -> Family:
    family = _plain(f"PD {kind}, m = {ratio}", BONDS, treatment, correction)
    family.settings["Peridynamics/Horizon ratio"] = ratio
    family.ratio = float(ratio)
    return family


def _without_cracks(deforms: bool) -> List[Family]:
    families = []
    for degree in ("1", "2"):
        families.append(_plain(f"FEM, degree {degree}", ELEMENTS))
        families[-1].settings["Finite elements/Degree"] = degree
    for m in ("2", "3", "4"):
        if deforms:
            families += [_plain_bonds("cut at sides", m, "none", "none"), _plain_bonds("energy-corrected", m, "none", "energy"),
                         _plain_bonds("completed", m, "auto", "auto")]
        else:
            families += [_plain_bonds("raw", m, "none", "none"), _plain_bonds("energy-corrected", m, "none", "energy"),
                         _plain_bonds("exchange", m, "exchange", "none"), _plain_bonds("mirror", m, "fictitious mirror", "none")]
    for m in ("2", "3"):
        family = _plain(f"coupled, m = {m}, zone of the scene", COUPLED)
        family.settings["Peridynamics/Horizon ratio"] = m
        family.given_zone = True
        families.append(family)
    return families


def _in_motion() -> List[Family]:
    """Explicit steps of three lengths."""
    families = []
    for courant in ("0.8", "0.4", "0.2"):
        for family in (_plain("FEM", ELEMENTS), *(_plain_bonds("completed", m, "auto", "auto") for m in ("2", "3", "4"))):
            family.name += f", steps of {courant} cells"
            family.courant = float(courant)
            family.settings.update({"Time/Stepper": "verlet", "Time/Time step": "auto"})
            families.append(family)
    return families


def _breaking() -> List[Family]:
    """Bonds that break, everywhere or in a zone that follows them."""
    families = []
    for m in ("3", "4", "6"):
        families.append(_plain_bonds("breaking", m, "auto", "auto"))
        families[-1].name = f"PD, m = {m}"
    for scheme, overlap, ms in (("exchange", "0", ("3", "4", "6")), ("blending", "1", ("4",))):
        for m in ms:
            family = _plain(f"coupled, {scheme}, m = {m}", COUPLED, "auto", "auto")
            family.settings.update({"Peridynamics/Horizon ratio": m, "Coupling/Zone": "follow", "Coupling/Scheme": scheme, "Coupling/Overlap": overlap})
            families.append(family)
    return families


def _on_meshes() -> List[Family]:
    """Of a mesh from a file, whose cells are halved."""
    families = []
    for degree, halvings in (("1", 2), ("2", 3)):
        for at_corners in (1, halvings):
            family = _plain(f"FEM, degree {degree}" + (", fine at corners" if at_corners > 1 else ""), ELEMENTS)
            family.settings.update({"Finite elements/Degree": degree, "Domain/Fine where": "corners" if at_corners > 1 else "auto"})
            family.halvings = at_corners
            families.append(family)
    for kind, treatment, correction in (("raw", "none", "none"), ("energy-corrected", "none", "energy"), ("exchange", "exchange", "none")):
        families.append(_plain(f"PD {kind}", BONDS, treatment, correction))
    return families


# By what a scene lets one choose among.
FAMILIES = {"cracks": _around_cracks(), "solid cracks": _bodies_with_cracks(), "field": _without_cracks(deforms=False),
            "solid": _without_cracks(deforms=True), "motion": _in_motion(), "growth": _breaking(), "mesh": _on_meshes()}
