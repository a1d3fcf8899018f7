// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "diffusion_summary.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using json = nlohmann::ordered_json;

    /** One sentence per side on what holds there. */
    template <int dim>
    json describe_sides(const Scene<dim> &scene)
    {
      const auto &conditions = scene.boundary_conditions;
      json        sides      = json::object();
      if (scene.domain.has_lattice())
        for (unsigned int k = 0; k < 2 * dim; ++k)
          sides[box_side_names()[k]] = "insulated";
      const auto add = [&](const std::string &name, const std::string &text) {
        json &side = sides[name];
        if (side.is_null() || side == "insulated")
          side = text;
        else if (text != "insulated")
          side = side.get<std::string>() + ", " + text;
      };
      for (const SideCondition &c : conditions.dirichlet)
        add(c.name, "Dirichlet " + c.value.text());
      for (const SurfaceTransfer &c : conditions.transfers)
        add(c.name, c.insulates() ? "insulated" : c.text());
      for (const auto side : conditions.symmetry)
        add(conditions.name_of(side), "symmetry");
      return sides;
    }


    /**
     * Flows and amounts of moisture are wetness times volume: nothing is given that would make
     * them masses.
     */
    bool counts_wetness(const Material &material)
    {
      const auto is_one = [](const MaterialProperty &property) {
        return property.is_constant() && property.value(Point<1>()) == 1.;
      };
      return is_one(material.density) && is_one(material.heat_capacity);
    }
  } // namespace


  template <int dim>
  void describe_diffusion_scene(const Scene<dim> &scene, nlohmann::ordered_json &summary)
  {
    if (scene.general.physics == Physics::moisture)
      summary["moisture counts"] = counts_wetness(scene.material) ? "wetness" : "mass";
    summary["sides"]     = describe_sides(scene);
    summary["reference"] = scene.reference.solution;
  }


  nlohmann::ordered_json describe_stepping(const Stepper &stepper, const Spectrum &spectrum)
  {
    const StepperCost &cost  = stepper.cost();
    json               entry = {{"stepper", stepper.name()},
                                {"steps", cost.steps},
                                {"rejected steps", cost.rejected},
                                {"iterations", cost.iterations}};
    if (cost.divided > 0)
      entry["divided steps"] = {{"number", cost.divided}, {"most parts", cost.most_parts}};
    if (stepper.current_step() > 0.)
      entry["time step"] = stepper.current_step();
    const std::string method = stepper.name() == "rk4" ? "rk4" : "euler";
    entry["stable step"]     = {{"sharp", stable_step(method, spectrum.sharp)},
                                {"safe", stable_step(method, spectrum.safe)},
                                {"method", method}};
    return entry;
  }


  template void describe_diffusion_scene(const Scene<1> &, nlohmann::ordered_json &);
  template void describe_diffusion_scene(const Scene<2> &, nlohmann::ordered_json &);
  template void describe_diffusion_scene(const Scene<3> &, nlohmann::ordered_json &);
} // namespace PeriDeal
