# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Units of what follows from lengths, forces, times and amounts: labels made of those that a scene names."""

PRESSURES = {("N", "m"): "Pa", ("kN", "m"): "kPa", ("MN", "m"): "MPa", ("GN", "m"): "GPa",
             ("N", "mm"): "MPa", ("kN", "mm"): "GPa"}
ENERGIES = {("N", "m"): "J", ("kN", "m"): "kJ"}
RATES = {("J", "s"): "W", ("kJ", "s"): "kW"}
IN_BODIES = {1: "²", 2: "", 3: None}  # power of the length by which numbers of a 1D, 2D body are divided


def over(unit, by):
    """'N/m', or nothing where a part of it is unknown."""
    return f"{unit}/{by}" if unit and by else ""


class Units:
    """Labels of a run, each empty where the scene names too little for it.

    Numbers of a 2D body are per unit of its thickness, those of a 1D one per unit of its cross section.
    """

    def __init__(self, named, dimension, physics, counts=""):
        """counts: 'wetness' where flows of moisture are wetness times volume, else they are masses."""
        named = {key: str(value) for key, value in (named or {}).items() if value}
        self.length, self.time = named.get("length", ""), named.get("time", "")
        self.dimension, self.physics, self.named, self.counts = dimension, physics, named, counts
        force = named.get("force", "") if physics == "elasticity" else ""
        self.stress = PRESSURES.get((force, self.length), over(force, self.length and f"{self.length}²"))
        self.intensity = f"{self.stress} √{self.length}" if self.stress and self.length else ""
        self.toughness = over(force, self.length)
        self.force = self.per_body(force)
        amount, rate = self.amounts(named, force)
        self.weight = self.per_body(amount)
        if counts == "wetness":
            amount = f"{self.length}³" if self.length else ""
            rate = over(amount, self.time)
        self.amount, self.rate = self.per_body(amount), self.per_body(rate)
        if counts == "wetness" and dimension < 3 and self.length:  # mm³/mm is mm²
            power = {1: "", 2: "²"}[dimension]
            self.amount = self.length + power
            self.rate = over(self.amount, self.time)
        self.flux = over(self.length, self.time) if counts == "wetness" \
            else over(rate, self.length and f"{self.length}²")

    def amounts(self, named, force):
        """(unit of what a body holds, unit of what passes its sides in a time)."""
        if self.physics == "elasticity":
            energy = ENERGIES.get((force, self.length), f"{force} {self.length}" if force and self.length
                                  else "")
            return named.get("energy", energy), ""
        if self.physics == "electricity":
            current = named.get("current", "")
            return (f"{current} {self.time}" if current and self.time else ""), current
        amount = named.get("mass" if self.physics == "moisture" else "energy", "")
        return amount, RATES.get((amount, self.time), over(amount, self.time))

    def per_body(self, unit):
        """The unit of a number of the whole body."""
        power = IN_BODIES.get(self.dimension)
        if power is None or not unit:
            return unit
        return over(unit, self.length and self.length + power)

    def of_total(self, quantity):
        """The unit of a quantity of totals.csv; empty where it has none or it is not known."""
        return self.of_elastic_total(quantity) if self.physics == "elasticity" \
            else self.of_scalar_total(quantity)

    def of_elastic_total(self, quantity):
        """... of an elastic body."""
        if quantity.startswith(("displacement of ", "crack length", "tip x", "tip y", "tip z")):
            return self.length
        if quantity.startswith("tip speed"):
            return over(self.length, self.time)
        if quantity in ("crack area", "damaged volume"):
            return self.length and self.length + {2: "²", 3: "³"}[2 if quantity == "crack area" else self.dimension]
        if quantity.startswith("stress intensity "):
            return self.intensity
        if quantity.startswith("J-integral "):
            return self.toughness
        if quantity.startswith("mean stress"):
            return self.stress
        if quantity.startswith(("force on ", "body force in ")) or quantity in ("throughput", "imbalance"):
            return self.force
        return self.amount if "energy" in quantity.split() or quantity.startswith("work of ") else ""

    def of_scalar_total(self, quantity):
        """... of heat, moisture or charge."""
        if quantity == "weight":
            return self.weight
        if quantity.startswith("effective "):
            return self.of_material("Conductivity")
        if quantity.endswith(" since start") or quantity in ("heat content", "charge", "cumulative imbalance"):
            return self.amount
        flows = (" through ", " from sources")
        if any(part in quantity for part in flows) or quantity in ("rate of storage", "throughput",
                                                                   "imbalance"):
            return self.rate
        return ""

    def of_material(self, entry):
        """The unit of an entry of the section Material; empty where it has none or too little is named for it."""
        length, time = self.length, self.time
        volume = length and f"{length}³"
        if self.physics == "elasticity":
            densities = {("N", "m", "s"): "kg/m³", ("N", "mm", "s"): "t/mm³", ("N", "mm", "ms"): "g/mm³",
                         ("kN", "mm", "ms"): "kg/mm³"}
            temperature = self.named.get("temperature", "")
            degree = {"C": "K", "degC": "K", "F": "°F"}.get(temperature, temperature)
            stresses = ("Bulk modulus", "Shear modulus", "Young modulus", "Young moduli", "Shear moduli", "Tensile strength", "Yield stress",
                        "Hardening modulus")
            return {**dict.fromkeys(stresses, self.stress),
                    "Density": densities.get((self.named.get("force"), length, time), ""),
                    "Thermal expansion": degree and f"1/{degree}",
                    "Fracture energy": {"N/m": "J/m²", "kN/m": "kJ/m²"}.get(self.toughness, self.toughness)}.get(entry, "")
        if self.physics == "moisture":
            diffusivity = over(length and f"{length}²", time)
            mass = self.named.get("mass", "")
            of_mass = over(mass, f"({length} {time})" if length and time else "")
            return {"Conductivity": of_mass if self.counts == "mass" else diffusivity, "Diffusivity": diffusivity,
                    "Saturated concentration": over(mass, volume)}.get(entry, "")
        field = self.named.get("field", "")
        field = {"C": "K", "degC": "K", "F": "°F"}.get(field, field)
        amount, rate = self.amounts(self.named, "")
        per = f"({length} {field})" if length and field else ""
        if self.physics == "electricity":
            short = {("A", "V"): f"S/{length}"}
            return {"Conductivity": short.get((rate, field), over(rate, per)) if length else ""}.get(entry, "")
        mass = self.named.get("mass", "") if amount else ""
        return {"Conductivity": over(rate, per), "Density": over(mass, volume),
                "Heat capacity": over(amount, f"({mass} {field})" if mass and field else "")}.get(entry, "")
