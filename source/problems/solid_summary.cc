// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "solid_summary.h"

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>

#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  using json = nlohmann::ordered_json;

  namespace
  {
    std::string text_of(const VectorCondition &condition)
    {
      std::string text;
      for (const std::string &component : condition.texts)
        text += (text.empty() ? "" : ", ") + component;
      return text;
    }


    /** Points spread evenly over a side of a box: 1 in one, 7 in two, 3 x 3 in three dimensions. */
    template <int dim>
    std::vector<Point<dim>> points_on_side(const unsigned int side,
                                           const Point<dim>  &lower,
                                           const Point<dim>  &upper)
    {
      const unsigned int      n = dim == 3 ? 3 : 7, normal = side / 2;
      std::vector<Point<dim>> points;
      for (unsigned int k = 0; k < (dim == 1 ? 1 : dim == 2 ? n : n * n); ++k)
        {
          Point<dim>   p;
          unsigned int rest = k;
          for (unsigned int d = 0; d < dim; ++d)
            if (d == normal)
              p[d] = side % 2 == 0 ? lower[d] : upper[d];
            else
              {
                p[d] = lower[d] + (rest % n + 0.5) / n * (upper[d] - lower[d]);
                rest /= n;
              }
          points.push_back(p);
        }
      return points;
    }


    template <int dim>
    json values_at(const VectorCondition &condition, const Point<dim> &p, const double t)
    {
      json values = json::array();
      for (const auto &value : condition.values)
        try
          {
            values.push_back(!value         ? json() :
                             condition.rate ? json(integral_over_time(*value, p, 0., t)) :
                                              json(value->value(p, t)));
          }
        catch (const UserError &) // no number at this point, which the run need not use
          {
            values.push_back(json());
          }
      return values;
    }

    /**
   * Side -> what holds there in words: `displacement 0, free`, `traction 1, 0`, `symmetry`, several
   * separated by `; `, else `free`.
   */
    template <int dim>
    json describe_solid_sides(const Scene<dim> &scene)
    {
      const auto &conditions = scene.boundary_conditions;
      const bool  box_sides  = scene.domain.has_lattice();
      json        sides      = json::object();
      if (box_sides)
        for (unsigned int k = 0; k < 2 * dim; ++k)
          sides[box_side_names()[k]] = "free";
      const auto add = [&](const std::string &name, const std::string &text) {
        if (sides.contains(name) && sides[name] != "free")
          sides[name] = sides[name].template get<std::string>() + "; " + text;
        else
          sides[name] = text;
      };
      for (const auto side : conditions.symmetry)
        add(conditions.name_of(side), "symmetry");
      for (const VectorCondition &c : conditions.displacement)
        add(c.name, (c.rate ? "velocity " : "displacement ") + text_of(c));
      for (const VectorCondition &c : conditions.traction)
        add(c.name, "traction " + text_of(c));
      for (const SideCondition &c : conditions.dirichlet)
        add(c.name, "temperature " + c.value.text());
      for (const SurfaceTransfer &c : conditions.transfers)
        add(c.name, (c.fixes_level() ? "" : "heat ") + c.text());
      return sides;
    }


    /**
   * Side or part -> `displacement`, `traction` -> `at` (points spread over it) and `values` (at
   * time @p t, a list of components for each point; null: free), what arrows in a sketch are drawn
   * from. The points of what is no side of a box are those of @p places (places_of_conditions()).
   */
    template <int dim>
    json values_on_sides(const Scene<dim> &scene,
                         const Point<dim> &lower,
                         const Point<dim> &upper,
                         const double      t,
                         const json       &places)
    {
      json       sides = json::object();
      const bool box   = scene.domain.has_lattice();
      const auto add   = [&](const std::vector<VectorCondition> &list, const std::string &kind) {
        for (const VectorCondition &condition : list)
          {
            std::vector<Point<dim>> points;
            if (box && condition.id < 2 * dim)
              points = points_on_side<dim>(condition.id, lower, upper);
            else if (places.contains(condition.name))
              for (const json &at : places[condition.name]["at"])
                {
                  points.emplace_back();
                  for (unsigned int d = 0; d < dim; ++d)
                    points.back()[d] = at[d];
                }
            if (points.empty())
              continue;
            json at = json::array(), values = json::array();
            for (const Point<dim> &p : points)
              {
                json coordinates = json::array();
                for (unsigned int d = 0; d < dim; ++d)
                  coordinates.push_back(p[d]);
                at.push_back(coordinates);
                values.push_back(values_at(condition, p, t));
              }
            sides[condition.name][kind] = {{"at", at}, {"values", values}};
          }
      };
      add(scene.boundary_conditions.displacement, "displacement");
      add(scene.boundary_conditions.traction, "traction");
      return sides;
    }


    /**
   * Why some model of a body at rest with whole bonds has no stress intensity factors at the ends
   * of its cracks, or nothing: there are no cracks,
   * or all models have them. @param models their entries in the summary
   */
    template <int dim>
    std::string no_stress_intensity(const Scene<dim> &scene, const json &models)
    {
      const Material &material = scene.material;
      if (scene.cracks.cracks.empty() || !scene.elasticity.is_static() ||
          material.fracture_energy || material.critical_stretch)
        return "";
      bool found = false, all = true;
      for (const auto &[name, model] : models.items())
        {
          const bool has = model.contains("stress intensity");
          found          = found || has;
          all            = all && has;
        }
      if (found)
        return all ?
                 "" :
                 "peridynamics has none: its rings begin beyond one horizon from the end or front of a crack, and there is no room for some cells around that";
      return "they need a box or a plate whose moduli are the same everywhere, and room around the end or front of a crack for some cells, with peridynamics beyond one horizon";
    }
  } // namespace


  template <int dim>
  double find_force_scale(const SolidProblem<dim> &model,
                          const Scene<dim>        &scene,
                          const double             throughput)
  {
    const MPI_Comm communicator = model.dofs().get_communicator();
    const Vector  &u            = model.displacement;
    double         volume = 0., stiffness = 0., spread = 0.;
    Point<dim>     lowest, highest; // of places: minus the lowest and the highest
    for (unsigned int d = 0; d < dim; ++d)
      lowest[d] = highest[d] = std::numeric_limits<double>::lowest();
    Point<dim> least = lowest, most = highest; // likewise of displacements
    for (unsigned int i = 0; i < u.locally_owned_size() / dim; ++i)
      {
        const Point<dim> p = model.position(i);
        try
          {
            stiffness += model.volume(i) * scene.material.moduli(p).young();
            volume += model.volume(i);
          }
        catch (const UserError &) // no number at this point, which finite elements need not use
          {}
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double v = u.local_element(dim * i + d);
            lowest[d]      = std::max(lowest[d], -p[d]);
            highest[d]     = std::max(highest[d], p[d]);
            least[d]       = std::max(least[d], -v);
            most[d]        = std::max(most[d], v);
          }
      }
    // Of a body that moves as a whole only round-off is left.
    constexpr double least_strain = 1e-6;
    double           edge         = std::numeric_limits<double>::max();
    for (unsigned int d = 0; d < dim; ++d)
      {
        const auto width = [&](const double low, const double high) {
          return Utilities::MPI::max(low, communicator) + Utilities::MPI::max(high, communicator);
        };
        edge                  = std::min(edge, width(lowest[d], highest[d]));
        const double farthest = Utilities::MPI::max(std::max(least[d], most[d]), communicator);
        spread = std::max({spread, width(least[d], most[d]), least_strain * farthest});
      }
    volume    = Utilities::MPI::sum(volume, communicator);
    stiffness = Utilities::MPI::sum(stiffness, communicator) / (volume > 0. ? volume : 1.);
    return std::max(throughput, stiffness * std::pow(edge, dim - 2.) * spread);
  }


  template <int dim>
  void describe_solid_scene(const Scene<dim> &scene, const bool at_the_end, json &summary)
  {
    summary["solver"] = scene.elasticity.solver_name();
    summary["sides"]  = describe_solid_sides(scene);
    Point<dim> lower = scene.domain.lower, upper = scene.domain.upper;
    for (unsigned int d = 0; d < dim && !scene.domain.has_extra_layers(); ++d)
      {
        lower[d] = summary["domain"]["lower"][d];
        upper[d] = summary["domain"]["upper"][d];
      }
    summary["values on sides"] = values_on_sides(scene,
                                                 lower,
                                                 upper,
                                                 scene.time.steady ? 0. : scene.time.end_time,
                                                 summary.value("places", json::object()));
    if (const std::string reason = no_stress_intensity(scene, summary["models"]);
        at_the_end && !reason.empty())
      summary["no stress intensity"] = reason;
  }


  template <int dim>
  json describe_solving_of(const SolidProblem<dim> &problem)
  {
    const Scene<dim> &scene = problem.scene;
    json              entry{{"iterations", problem.n_iterations}};
    if (problem.stepper)
      {
        entry["stepper"]     = problem.stepper->name();
        entry["steps"]       = problem.stepper->cost().steps;
        entry["iterations"]  = problem.stepper->cost().iterations;
        entry["time step"]   = problem.stepper->current_step();
        entry["stable step"] = {{"sharp", problem.stable_step}, {"method", "verlet"}};
      }
    if (problem.loading && !scene.time.steady)
      {
        entry["steps"] = problem.loading->n_steps();
        if (!scene.warms_slowly()) // then equilibria are at times of output
          entry["time step"] = problem.load_step();
      }
    return entry;
  }


#define PERIDEAL_INSTANTIATE(dim)                                               \
  template json   describe_solving_of(const SolidProblem<dim> &);               \
  template void   describe_solid_scene(const Scene<dim> &, const bool, json &); \
  template double find_force_scale(const SolidProblem<dim> &, const Scene<dim> &, const double);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
