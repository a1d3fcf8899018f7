# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""The words and units of a run: what its physics calls the solution, the flux and the rest.

Only this module tells one physics from another; all others take their words from here.
"""

import re
from dataclasses import dataclass, replace

import style
from units import Units


@dataclass(frozen=True)
class Field:
    """A scalar field: its name in the files, its unit's label, lines on which it has one value."""

    name: str
    unit: str = ""
    isolines: str = "isolines"
    about: str = ""  # a remark on what it is
    called: str = ""  # the name in running text, where it is not that in the files
    outliers: float = 0.0  # share of the values that colours may leave out at either end
    span: tuple = ()  # the ends of its scale, where these do not follow from its values

    @property
    def text(self):
        """The name in running text."""
        return self.called or self.name.replace("_", " ")

    @property
    def title(self):
        """The name at the start of a line."""
        return style.name(self.text)

    def label(self, text=None):
        """The name, or another text, with the unit: for axes and colour bars."""
        return with_unit(text or self.title, self.unit)

    def amount(self, value):
        """A value with few digits and its unit."""
        return f"{style.plain(value, 3)} {self.unit}".strip()


@dataclass(frozen=True)
class Physics:
    """The words of one physics; the first five may be given by the run."""

    field: str
    flux: str
    content: str
    flow: str
    quantity: str
    values: str  # several values of the field
    isolines: str  # lines on which the field has one value
    closed: str = "insulated"  # a side that nothing passes
    held: str = ""  # a Dirichlet side, where it has a name of its own
    also: tuple = ()  # further fields, drawn where they are no multiple of the solution
    content_apart: bool = False  # whether the content over time has a plot of its own


NAMES = ("field", "flux", "content", "flow", "quantity")
PHYSICS = {
    "heat": Physics("temperature", "heat_flux", "heat content", "heat flow", "heat",
                    "temperatures", "isotherms"),
    "moisture": Physics(
        "wetness", "moisture_flux", "weight", "moisture flow", "moisture",
        "values of the wetness", "contours of equal wetness", closed="sealed",
        also=(Field("concentration", isolines="contours of equal concentration",
                    about="The wetness times the saturated concentration: where materials of "
                    "different saturated concentration meet, the wetness is continuous and the "
                    "concentration jumps."),),
        content_apart=True),
    "electricity": Physics("potential", "current_density", "charge", "current", "charge",
                           "potentials", "equipotentials", held="electrode"),
    "elasticity": Physics("displacement", "stress", "strain energy", "force", "force",
                          "displacements", "contours of equal displacement", closed="free")}
DEGREES = {"C": "°C", "F": "°F", "degC": "°C"}


def words_of(physics, names):
    """Those of a physics; of one that a program has brought those that the run gives."""
    if physics not in PHYSICS:
        field = str(names["field"])
        return Physics(*(str(names.get(key, key)) for key in NAMES), f"values of the {field}", f"contours of equal {field}")
    return replace(PHYSICS[physics], **{key: str(names[key]) for key in NAMES if names.get(key)})


def with_unit(name, unit):
    """'name (unit)', or the name alone without a unit."""
    return f"{name} ({unit})" if unit else name


class Words:
    """What the report of a run calls things; a summary without 'physics' is one of heat."""

    def __init__(self, summary=None):
        summary = summary or {}
        units, names = (part if isinstance(part, dict) else {}
                        for part in (summary.get("units"), summary.get("names")))
        physics = words_of(summary.get("physics") or "heat", names)
        self.length = units.get("length") or ""
        self.time = units.get("time") or ""
        unit = units.get("field", units.get(physics.field)) or ""
        self.solution = Field(physics.field, DEGREES.get(unit, unit), physics.isolines)
        self.units = Units(units, summary.get("dimension", 3), summary.get("physics") or "heat",
                           summary.get("moisture counts", ""))
        self.flux = Field(physics.flux, self.units.flux)
        self.content, self.flow, self.quantity = physics.content, physics.flow, physics.quantity
        self.values, self.also = physics.values, physics.also
        self.plotted_apart = [physics.content] if physics.content_apart else []
        self.closed, self.held = physics.closed, physics.held
        self.parts = {}  # name of a scalar field: (data set, component or None for its length)
        self.elastic = summary.get("physics") == "elasticity"
        if self.elastic:
            self._name_elastic_fields()

    MAGNITUDE = "displacement_magnitude"

    def _name_elastic_fields(self):
        """The scalar fields of an elastic body."""
        vector, unit, stress = self.solution.name, self.solution.unit, self.units.stress
        self.quantity = "force"
        self.parts[self.MAGNITUDE] = (vector, None)
        self.solution = Field(self.MAGNITUDE, unit, "contours of equal displacement",
                              called="magnitude of the displacement")
        self.fields = {self.MAGNITUDE: self.solution}
        for component, axis in enumerate("xyz"):
            part = f"{vector}_{axis}"
            self.parts[part] = (vector, component)
            self.fields[part] = Field(part, unit, called=f"displacement in {axis}")
            for other in "xyz"[component:]:
                part = f"stress_{axis}{other}"
                self.fields[part] = Field(part, stress, called=f"stress {axis}{other}", outliers=0.002)
        for part, title in (("von_mises", "von Mises stress"), ("pressure", "pressure")):
            self.fields[part] = Field(part, stress, called=title, outliers=0.002)
        self.fields["damage"] = Field("damage", isolines="", span=(0.0, 1.0),
                                      about="The share of a node's bonds, by volume, that are "
                                      "broken: 0 where all are whole, 1 where none is left. Bonds "
                                      "that a crack of the scene cuts are broken from the start.")
        self.fields["plastic_strain"] = Field("plastic_strain", isolines="", called="equivalent plastic strain",
                                              about="The strain that stays, as a length of its path: where it is 0 the "
                                              "body has not yielded.")
        self.fields["temperature"] = Field("temperature")

    def column(self, name):
        """What a column of probes.csv and line.csv holds, as a field."""
        if name in ("ux", "uy", "uz"):
            return self.fields[f"displacement_{name[1]}"]
        if name == "value":
            return self.solution
        return self.fields.get(f"stress_{name[1:]}" if re.fullmatch("s[xyz]{2}", name) else name) \
            or Field(name)

    @property
    def effective(self):
        """What the body conducts as a whole is called."""
        return "effective conductivity" if self.quantity != "moisture" or self.units.counts == "mass" else "effective diffusivity"

    @property
    def passing(self):
        """What passes a side: 'heat', 'moisture', 'current'."""
        return self.flow.removesuffix(" flow")

    def total(self, quantity):
        """The title of a quantity of totals.csv, with its unit."""
        unit = self.units.of_total(quantity)
        return with_unit(style.name(self.effective if quantity == "effective conductivity" else quantity), unit)

    def total_amount(self, quantity, value, digits=4):
        """A value of it with few digits and its unit."""
        return f"{style.plain(value, digits)} {self.units.of_total(quantity)}".strip()

    def solution_parts(self):
        """Names in the files of what the solution is computed from."""
        return {data for data, _ in self.parts.values()}

    def flux_datasets(self):
        """Names of the flux in the files, the best first."""
        return self.flux.name, f"{self.flux.name}_one_sided"

    def condition(self, text, brief=False):
        """The condition of a side; brief: as the sketch has it, without the name of a Dirichlet side."""
        if self.elastic and brief:
            return str(text).replace("displacement ", "u = ").replace("traction ", "t = ")
        text = re.sub(r"\binsulated\b", self.closed, str(text))
        named = self.held and not brief and "dirichlet" in text.lower()
        return f"{self.held}, {text}" if named else text

    def axis(self, name):
        """Label of a coordinate axis."""
        return with_unit(f"${name}$", self.length)

    def time_axis(self):
        """Label of the time."""
        return with_unit("Time", self.time)

    def at_time(self, time, steady=False):
        """'t = 0.5 s', or 'steady state'."""
        if steady:
            return "at rest" if self.elastic else "steady state"
        return f"t = {style.plain(time)} {self.time}".strip()
