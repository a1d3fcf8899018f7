// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <perideal/base/user_error.h>
#include <perideal/simulation/simulation.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "result_record.h"
#include "summary_parts.h"

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
      if (scene.domain.shape != Shape::mesh_file)
        for (unsigned int k = 0; k < 2 * dim; ++k)
          sides[box_side_names()[k]] = "insulated";
      const auto add = [&](const std::string &name, const std::string &text) {
        if (sides.contains(name) && sides[name] != "insulated")
          sides[name] = sides[name].template get<std::string>() + ", " + text;
        else
          sides[name] = text;
      };
      for (const SideCondition &c : conditions.dirichlet)
        add(c.name, "Dirichlet " + c.value.text());
      for (const SideCondition &c : conditions.flux)
        add(c.name,
            c.value.is_constant() && c.value.value(Point<dim>()) == 0. ? "insulated" :
                                                                         "flux " + c.value.text());
      for (const SideCondition &c : conditions.convection)
        add(c.name, "convection " + c.coefficient.text() + ", " + c.value.text());
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


    template <int dim>
    json describe_model(const ModelRun<dim> &model,
                        const ResultRecord  &record,
                        const MPI_Comm       communicator)
    {
      const OperatorSize size = model.op().size();
      json               entry;
      entry["unknowns"] = size.unknowns;
      if (size.bonds > 0)
        entry["bonds"] = size.bonds;
      entry["nonzeros"] = size.nonzeros;
      if (size.busiest > 0.)
        entry["work of the busiest process"] = size.busiest;
      if (model.stepper)
        {
          entry["stepper"]        = model.stepper->name();
          entry["steps"]          = model.stepper->cost().steps;
          entry["rejected steps"] = model.stepper->cost().rejected;
          entry["iterations"]     = model.stepper->cost().iterations;
          if (model.stepper->current_step() > 0.)
            entry["time step"] = model.stepper->current_step();
          const Spectrum    spectrum = model.op().spectrum();
          const std::string method   = model.stepper->name() == "rk4" ? "rk4" : "euler";
          entry["stable step"]       = {{"sharp", stable_step(method, spectrum.sharp)},
                                        {"safe", stable_step(method, spectrum.safe)},
                                        {"method", method}};
        }
      else
        {
          entry["stepper"]    = "steady";
          entry["steps"]      = 0;
          entry["iterations"] = model.steady_iterations;
        }
      entry["operator applications"] = model.op().n_applications();
      entry["operator form"]         = size.form;
      json settings                  = json::object();
      for (const auto &[name, value] : model.settings())
        settings[name] = value;
      entry["settings"]  = settings;
      entry["wall time"] = model.timings.all();
      entry["memory"]    = Utilities::MPI::sum(static_cast<double>(size.memory), communicator);
      Utilities::System::MemoryStats stats;
      Utilities::System::get_memory_stats(stats);
      entry["peak memory"] =
        1024. * Utilities::MPI::sum(static_cast<double>(stats.VmHWM), communicator);
      if (const CouplingCertificate *certificate = model.examined())
        entry["certificate"] = describe_certificate(*certificate);
      if (record.errors.contains(model.name()))
        entry["errors"] = record.errors.at(model.name());
      if (record.balances.contains(model.name()))
        entry.update(record.balances.at(model.name()));
      return entry;
    }
  } // namespace


  template <int dim>
  json Simulation<dim>::summary_now() const
  {
    json summary = describe_scene(scene, text, *mesh, communicator);
    if (scene.domain.coarsening > 0)
      summary["mesh"] = {{"coarsening", scene.domain.coarsening}, {"adaptations", n_adaptations}};
    if (scene.general.physics == Physics::moisture)
      summary["moisture counts"] = counts_wetness(scene.material) ? "wetness" : "mass";
    summary["cracks"]      = corners_of(scene.cracks.pieces(scene.cracks.end_time));
    summary["sides"]       = describe_sides(scene);
    summary["steady"]      = scene.time.steady;
    summary["end time"]    = scene.time.steady ? 0. : scene.time.end_time;
    summary["write times"] = output_times();
    summary["reference"]   = scene.reference.solution;
    summary["notes"]       = record->notes;
    summary["fields"]      = record->fields;
    summary["wall time"]   = timings.all();
    summary["memory of mesh"] =
      Utilities::MPI::sum(static_cast<double>(mesh->memory_consumption()), communicator);
    for (const auto &model : models)
      summary["models"][model->name()] = describe_model(*model, *record, communicator);
    if (!record->comparison.empty())
      summary["comparison"] = record->comparison;
    if (!record->comparisons.empty())
      summary["comparisons"] = record->comparisons;
    return summary;
  }

  template json Simulation<1>::summary_now() const;
  template json Simulation<2>::summary_now() const;
  template json Simulation<3>::summary_now() const;
} // namespace PeriDeal
