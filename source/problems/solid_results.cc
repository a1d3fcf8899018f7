// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/analysis/exact_solution.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/laws/elasticity.h>
#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/run_context.h>
#include <perideal/problems/solid_problem.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <map>
#include <sstream>

#include "problem_parts.h"
#include "solid_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  using json = nlohmann::ordered_json;

  namespace
  {
    template <int dim>
    std::array<double, dim> coordinates_of(const Point<dim> &p)
    {
      std::array<double, dim> x;
      for (unsigned int d = 0; d < dim; ++d)
        x[d] = p[d];
      return x;
    }


    /** In three dimensions, without heating; no numbers where it is not known. */
    template <int dim>
    SymmetricTensor<2, 3> exact_stress(const Scene<dim>    &scene,
                                       const ExactSolution &exact,
                                       const Point<dim>    &point,
                                       const double         t)
    {
      SymmetricTensor<2, 3> full;
      Tensor<2, dim>        slopes;
      const Material::Law  &law = scene.material.law;
      for (unsigned int c = 0; c < dim; ++c)
        {
          double g[dim];
          if (law.kind == SolidLaw::user || law.kind == SolidLaw::hyperelastic ||
              !law.orthotropy.young.empty() || // has no two moduli
              !exact.gradient(coordinates_of(point).data(), t, c, g))
            {
              for (unsigned int a = 0; a < 3; ++a)
                for (unsigned int b = a; b < 3; ++b)
                  full[a][b] = std::numeric_limits<double>::quiet_NaN();
              return full;
            }
          for (unsigned int d = 0; d < dim; ++d)
            slopes[c][d] = g[d];
        }
      const Moduli                  moduli = scene.moduli(point);
      const PlaneState              plane  = scene.elasticity.plane;
      const SymmetricTensor<2, dim> found  = stress<dim>(moduli, plane, symmetrize(slopes));
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = a; b < dim; ++b)
          full[a][b] = found[a][b];
      if constexpr (dim == 2)
        full[2][2] = stress_zz(moduli, plane, found);
      return full;
    }


    /**
     * Area and the integral of the displacement of each side of a mesh, by its boundary id, of this
     * process.
     */
    template <int dim>
    std::map<types::boundary_id, std::pair<double, Tensor<1, dim>>> integrals_over_sides(
      const SolidProblem<dim> &model)
    {
      const DoFHandler<dim> &dofs        = model.dofs();
      const bool             at_vertices = dofs.get_fe().n_dofs_per_vertex() > 0;
      std::vector<Vector>    u;
      u.reserve(dim); // a vector that is copied forgets its ghosts
      for (unsigned int d = 0; d < dim; ++d)
        u.push_back(component_of(dofs, model.displacement, dim, d));
      std::map<types::boundary_id, std::pair<double, Tensor<1, dim>>> sides;
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned() && cell->at_boundary())
          for (const unsigned int f : cell->face_indices())
            {
              const auto face = cell->face(f);
              if (!face->at_boundary())
                continue;
              Tensor<1, dim>                       mean;
              const unsigned int                   n = GeometryInfo<dim>::vertices_per_face;
              std::vector<types::global_dof_index> of_cell(dofs.get_fe().n_dofs_per_cell());
              cell->get_dof_indices(of_cell);
              for (unsigned int v = 0; v < n; ++v)
                for (unsigned int d = 0; d < dim; ++d)
                  mean[d] +=
                    u[d](
                      of_cell[at_vertices ? GeometryInfo<dim>::face_to_cell_vertices(f, v) : 0]) /
                    n;
              double area = 1.; // of a point
              if constexpr (dim > 1)
                area = face->measure();
              auto &side = sides[face->boundary_id()];
              side.first += area;
              side.second += area * mean;
            }
      return sides;
    }


    /** (side, direction) of the largest component, a pull rather than a push that is its equal. */
    std::pair<std::string, unsigned int> largest_force(const ForceBalance &balance,
                                                       const double        scale)
    {
      constexpr double                     equal = 1e-6, round_off = 1e-9;
      std::pair<std::string, unsigned int> where;
      double                               most = round_off * scale;
      for (const auto &[side, force] : balance.sides)
        for (unsigned int d = 0; d < force.size(); ++d)
          if (const double size = std::abs(force[d]) * (force[d] > 0. ? 1. + equal : 1.);
              size > most)
            {
              most  = size;
              where = {side, d};
            }
      return where;
    }


    /**
     * The mean displacement, by area, of each side that has a condition on its displacement or
     * traction, with the name that the user gave it: of a body with nodes at cell centres that of
     * its outermost nodes. Collective.
     */
    template <int dim>
    std::vector<std::pair<std::string, Tensor<1, dim>>> displacements_of_sides(
      const SolidProblem<dim> &model)
    {
      const auto                                          own = integrals_over_sides(model);
      std::vector<std::pair<std::string, Tensor<1, dim>>> result;
      const auto add = [&](const std::string &name, const types::boundary_id id) {
        for (const auto &[known, value] : result)
          if (known == name)
            return;
        std::vector<double> sums(dim + 1, 0.), all(dim + 1);
        if (const auto found = own.find(id); found != own.end())
          {
            sums[dim] = found->second.first;
            for (unsigned int d = 0; d < dim; ++d)
              sums[d] = found->second.second[d];
          }
        Utilities::MPI::sum(sums, model.dofs().get_communicator(), all);
        Tensor<1, dim> mean;
        for (unsigned int d = 0; d < dim; ++d)
          mean[d] = all[dim] > 0. ? all[d] / all[dim] : 0.;
        if (all[dim] > 0.)
          result.emplace_back(name, mean);
      };
      for (const VectorCondition &condition : model.scene.boundary_conditions.displacement)
        add(condition.name, condition.id);
      for (const VectorCondition &condition : model.scene.boundary_conditions.traction)
        add(condition.name, condition.id);
      return result;
    }


    /**
     * Keep in @p extremes the largest component of a force on any side so far, as `largest force`
     * (`value`, `side`, `direction`, `time`). Of a pull and a support that are equal but for
     * round-off the pull counts; none, as where the arms of a cantilever are pushed apart, if all
     * are round-off beside the @p scale, find_force_scale().
     */
    void keep_largest_force(const ForceBalance     &balance,
                            const double            scale,
                            const double            t,
                            nlohmann::ordered_json &extremes)
    {
      const auto [side, direction] = largest_force(balance, scale);
      if (side.empty())
        return;
      const double value = balance.sides.at(side)[direction];
      if (!extremes.contains("largest force") ||
          std::abs(value) > std::abs(extremes["largest force"]["value"].get<double>()))
        extremes["largest force"] = {{"value", value},
                                     {"side", side},
                                     {"direction", std::string(1, "xyz"[direction])},
                                     {"time", t}};
    }


    /** `force 12.3 on top in y`, of the largest component now; empty without any. */
    std::string text_of_largest_force(const ForceBalance &balance, const double scale)
    {
      const auto [side, direction] = largest_force(balance, scale);
      if (side.empty())
        return "";
      std::ostringstream text;
      text << "force " << std::setprecision(4) << balance.sides.at(side)[direction] << " on "
           << side << " in "
           << "xyz"[direction];
      return text.str();
    }


    /**
     * The size of forces in the body now, against which a sum of forces that should be zero is
     * small or not: what passes through it (@p throughput), and its mean Young modulus times the
     * area of a cube on its shortest edge times the strain by which displacements differ over that
     * edge: a body that is free to expand bears nothing but round-off, which is small against the
     * latter. Collective.
     */
    template <int dim>
    double find_force_scale(const SolidProblem<dim> &model, const double throughput)
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
              stiffness += model.volume(i) * model.scene.moduli(p).young();
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
     * Side -> what holds there in words: `displacement 0, free`, `traction 1, 0`, `symmetry`,
     * several separated by `; `, else `free`.
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
     * time @p t, a list of components for each point; null: free), what arrows in a sketch are
     * drawn from. Points of what is no side of a box are those of @p places
     * (places_of_conditions()).
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
     * of its cracks, or nothing: there are no cracks, or all models have
     * them. @param models their entries in the summary
     */
    template <int dim>
    std::string no_stress_intensity(const Scene<dim> &scene, const json &models)
    {
      const Material &material = scene.material;
      if (scene.cracks.cracks.empty() || !scene.elasticity.is_static() || material.breaks())
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
  std::vector<std::vector<double>> velocities_at_points(const Scene<dim>          &scene,
                                                        const PointEvaluator<dim> &reader,
                                                        const Vector              &velocity)
  {
    std::vector<std::vector<double>> components;
    if (scene.elasticity.is_static())
      return components;
    Vector with_ghosts(velocity);
    with_ghosts.update_ghost_values();
    for (unsigned int d = 0; d < dim; ++d)
      components.push_back(reader.evaluate(with_ghosts, dim, d));
    return components;
  }


  void append_row(const double                *displacement,
                  const SymmetricTensor<2, 3> &stress,
                  const unsigned int           dim,
                  std::vector<double>         &rows)
  {
    rows.insert(rows.end(), displacement, displacement + dim);
    rows.push_back(stress[0][0]);
    if (dim > 1)
      rows.insert(rows.end(), {stress[1][1], stress[2][2], stress[0][1]});
    if (dim > 2)
      rows.insert(rows.end(), {stress[0][2], stress[1][2]});
    rows.push_back(von_mises(stress));
  }


  template <int dim>
  std::vector<std::string> solid_columns(const Scene<dim> &scene)
  {
    std::vector<std::string> columns;
    switch (dim)
      {
        case 1:
          columns = {"ux", "sxx", "von_mises"};
          break;
        case 2:
          columns = {"ux", "uy", "sxx", "syy", "szz", "sxy", "von_mises"};
          break;
        default:
          columns = {"ux", "uy", "uz", "sxx", "syy", "szz", "sxy", "sxz", "syz", "von_mises"};
      }
    if (scene.elasticity.computes_temperature)
      columns.push_back("temperature");
    if (!scene.elasticity.is_static())
      for (unsigned int d = 0; d < dim; ++d)
        columns.push_back(std::string("v") + "xyz"[d]);
    return columns;
  }


  template <int dim>
  std::vector<std::string> SolidProblem<dim>::columns() const
  {
    return solid_columns(scene);
  }


  template <int dim>
  std::vector<double> SolidProblem<dim>::at_points(
    const PointEvaluator<dim>              &reader,
    const std::vector<std::vector<double>> &points) const
  {
    return body.at_points(reader, points);
  }


  template <int dim>
  std::vector<OutputField> SolidProblem<dim>::fields(const double) const
  {
    return body.fields();
  }


  template <int dim>
  Difference SolidProblem<dim>::error(const ExactSolution &exact, const double t) const
  {
    const Vector &u = displacement;
    Vector        expected(u.get_partitioner());
    for (unsigned int i = 0; i < u.locally_owned_size() / dim; ++i)
      {
        const auto x     = coordinates_of(this->position(i));
        const bool shown = scene.domain.shows(this->position(i));
        for (unsigned int c = 0; c < dim; ++c)
          {
            const double value = exact.value(x.data(), t, c);
            expected.local_element(dim * i + c) =
              std::isnan(value) || !shown ? u.local_element(dim * i + c) : value;
          }
      }
    return nodal_difference(u, expected, [&](const unsigned int i) {
      return this->volume(i / dim);
    });
  }


  template <int dim>
  std::vector<double> SolidProblem<dim>::exact_row(const ExactSolution &exact,
                                                   const Point<dim>    &point,
                                                   const double         t) const
  {
    std::array<double, dim> u;
    for (unsigned int c = 0; c < dim; ++c)
      u[c] = exact.value(coordinates_of(point).data(), t, c);
    std::vector<double> row;
    append_row(u.data(), exact_stress(scene, exact, point, t), dim, row);
    row.resize(columns().size(), std::numeric_limits<double>::quiet_NaN());
    return row;
  }


  template <int dim>
  NewCracks SolidProblem<dim>::new_cracks() const
  {
    return cracks->surfaces(*this);
  }


  template <int dim>
  json SolidProblem<dim>::add_energies(const double t, const RunContext &context) const
  {
    json       balance;
    const auto add = [&](const std::string &key, const std::string &quantity, const double value) {
      balance[key] = value;
      context.record.add_row(this->name(), quantity, value, t);
    };
    const auto add_all = [&](const auto &energy, const double lost) {
      balance["strain"] = energy.strain;
      balance["start"]  = energy.start;
      add("work", "work of loads and supports", energy.work);
      if (scene.material.law.kind == SolidLaw::viscoelastic ||
          scene.material.law.kind == SolidLaw::user ||
          scene.material.law.kind == SolidLaw::user_bonds || scene.material.law.yields())
        add("dissipated by the law", "energy dissipated by the law", op().released().by_law);
      if (op().may_release_energy())
        {
          const double by_growth  = op().released().by_growth,
                       by_joining = op().released().by_joining;
          if (op().brittle())
            add("released", "energy released by broken bonds", op().break_history()->released);
          if (op().has_growing_cracks())
            add("released by cracks", "energy released by cracks", by_growth);
          if (op().zone_follows_cracks())
            add("released by joining", "energy released by nodes joining the zone", by_joining);
          add("dissipated", "energy dissipated", lost);
        }
      if (op().brittle())
        {
          const auto n_broken = op().n_broken_bonds();
          add("broken bonds", "broken bonds", static_cast<double>(n_broken));
          if (json &kept = context.record.extremes[this->name()];
              n_broken > 0 && !kept.contains("first broken bonds"))
            kept["first broken bonds"] = t;
        }
      if (!scene.warms_slowly()) // what warming does to the strain energy is not followed
        add("imbalance", "energy imbalance", energy.imbalance());
    };
    if (stepper)
      {
        const MotionEnergy energy = stepper->energy(displacement, velocity);
        add("kinetic", "kinetic energy", energy.kinetic);
        add_all(energy, energy.released);
        add("drift", "energy drift", energy.drift);
      }
    else
      {
        const LoadingEnergy energy = loading->energy(displacement);
        add_all(energy, energy.dissipated);
        if (scene.elasticity.controls_loads())
          add("load factor", "load factor", op().stepping.load_factor);
      }
    return balance;
  }


  namespace
  {
    /** What the rows of the ends of cracks are, told by row(quantity, value). Collective. */
    template <int dim, typename Row>
    nlohmann::ordered_json intensities(const SolidField<dim> &body, const double t, const Row &row)
    {
      nlohmann::ordered_json ends = nlohmann::ordered_json::object();
      // Where bonds have broken cracks end elsewhere, and J is that of the linear law.
      const bool grown = body.op().n_broken_bonds() > 0 ||
                         body.scene.material.law.kind != SolidLaw::linear;
      for (const StressIntensity &end :
           grown ? std::vector<StressIntensity>() : body.stress_intensities(t))
        {
          row("J-integral at " + end.name, end.j);
          row("stress intensity I at " + end.name, end.mode_1);
          row("stress intensity II at " + end.name, end.mode_2);
          ends[end.name] = {{"J-integral", end.j}, {"I", end.mode_1}, {"II", end.mode_2}};
          if (end.mode_3)
            {
              row("stress intensity III at " + end.name, *end.mode_3);
              ends[end.name]["III"] = *end.mode_3;
            }
          if (end.place)
            ends[end.name]["place"] = {(*end.place)[0], (*end.place)[1], (*end.place)[2]};
        }
      return ends;
    }
  } // namespace


  template <int dim>
  void SolidProblem<dim>::add_totals(const double t, const RunContext &context)
  {
    const auto row = [&](const std::string &quantity, const double value) {
      context.record.add_row(this->name(), quantity, value, t);
    };
    const ForceBalance          balance = op().forces(displacement, t);
    const double                energy  = op().energy(displacement);
    const SymmetricTensor<2, 3> mean    = body.mean_stress();
    require_finite(
      {{"largest displacement", displacement.linfty_norm()},
       {"strain energy", energy},
       {"sum of the forces", balance.throughput()},
       {"mean stress", von_mises(mean)}},
      this->name(),
      t,
      "Numbers beyond 1e308 came up. Check the sizes and units of loads and displacements (sections 'Boundary conditions' and 'Initial and source') and of the "
      "moduli (section 'Material').");
    row("strain energy", energy);
    for (const auto &[side, force] : balance.sides)
      for (unsigned int d = 0; d < dim; ++d)
        row("force on " + side + " in " + "xyz"[d], force[d]);
    if (!scene.time.steady)
      for (const auto &[side, moved] : displacements_of_sides(*this))
        for (unsigned int d = 0; d < dim; ++d)
          row("displacement of " + side + " in " + "xyz"[d], moved[d]);
    if (!stepper)
      force_scale = std::max(force_scale, find_force_scale(*this, balance.throughput()));
    keep_largest_force(balance, force_scale, t, context.record.extremes[this->name()]);
    context.progress.state(text_of_largest_force(balance, force_scale));
    for (unsigned int d = 0; d < dim; ++d)
      row(std::string("body force in ") + "xyz"[d], balance.body[d]);
    row("throughput", balance.throughput());
    if (!stepper) // of a motion it is the rate of its momentum
      row("imbalance", balance.imbalance());
    nlohmann::ordered_json stress = nlohmann::ordered_json::object();
    for (unsigned int a = 0; a < 3; ++a)
      for (unsigned int b = a; b < 3; ++b)
        if (b < dim || (dim == 2 && a == 2))
          {
            const std::string name = std::string(1, "xyz"[a]) + "xyz"[b];
            row("mean stress " + name, mean[a][b]);
            stress[name] = mean[a][b];
          }
    stress["von mises"]                   = von_mises(mean);
    const nlohmann::ordered_json ends     = intensities(body, t, row);
    context.record.balances[this->name()] = {{"boundary force", balance.sides},
                                             {"strain energy", energy},
                                             {"mean stress", stress}};
    if (stepper || op().may_release_energy() || (scene.is_loaded_slowly() && !scene.warms_slowly()))
      context.record.balances[this->name()]["energy balance"] = add_energies(t, context);
    if (!stepper)
      {
        context.record.balances[this->name()]["force balance"] = {
          {"throughput", balance.throughput()},
          {"imbalance", balance.imbalance()},
          {"scale", force_scale}};
        force_lost = balance.imbalance();
      }
    if (!ends.empty())
      context.record.balances[this->name()]["stress intensity"] = ends;
    if (heat != nullptr)
      heat->add_totals_of_solid(t, context);
    if (warming)
      {
        row("heat of deformation since start", warming->released());
        context.record.balances[this->name()]["heat balance"]["heat of deformation"] =
          warming->released();
      }
    cracks->add_totals(*this, t, context);
  }


  template <int dim>
  void SolidProblem<dim>::describe_end(nlohmann::ordered_json &entry, ResultRecord &record) const
  {
    const double time = scene.time.steady ? 0. : scene.time.end_time;
    const auto   row  = [&](const std::string &quantity, const double value) {
      record.add_row(this->name(), quantity, value, time);
    };
    for (const PhaseStatistics &phase : phase_statistics(body.stress_samples(),
                                                         scene.material.phases.all().names,
                                                         this->dofs().get_communicator()))
      {
        json &described              = entry["phases"][phase.name];
        described["volume fraction"] = phase.volume_fraction;
        row("volume fraction of " + phase.name, phase.volume_fraction);
        for (unsigned int a = 0; a < 3; ++a)
          for (unsigned int b = a; b < 3; ++b)
            if (b < dim || (dim == 2 && a == 2))
              {
                const std::string name         = std::string(1, "xyz"[a]) + "xyz"[b];
                described["mean stress"][name] = phase.mean_stress[a][b];
                row("mean stress " + name + " in " + phase.name, phase.mean_stress[a][b]);
              }
        described["von mises"] = {{"mean", phase.mean_von_mises},
                                  {"99th percentile", phase.highest_percentile},
                                  {"maximum", phase.largest_von_mises}};
        row("mean von Mises stress in " + phase.name, phase.mean_von_mises);
        row("99th percentile of the von Mises stress in " + phase.name, phase.highest_percentile);
        row("largest von Mises stress in " + phase.name, phase.largest_von_mises);
      }
  }


  template <int dim>
  void SolidProblem<dim>::describe_scene(json &summary, const bool at_the_end) const
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
  json SolidProblem<dim>::describe_solving() const
  {
    json entry{{"iterations", n_iterations}};
    if (stepper)
      {
        entry["stepper"]     = stepper->name();
        entry["steps"]       = stepper->cost().steps;
        entry["iterations"]  = stepper->cost().iterations;
        entry["time step"]   = stepper->current_step();
        entry["stable step"] = {{"sharp", stable_step}, {"method", "verlet"}};
      }
    if (loading && !scene.time.steady)
      {
        entry["steps"] = loading->n_steps();
        if (!scene.warms_slowly()) // then equilibria are at times of output
          entry["time step"] = load_step();
      }
    return entry;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(solid_columns);
  PERIDEAL_INSTANTIATE_FUNCTION(velocities_at_points);
#define PERIDEAL_RESULTS(dim)                                                                       \
  template std::vector<std::string> SolidProblem<dim>::columns() const;                             \
  template std::vector<double>      SolidProblem<dim>::at_points(                                   \
    const PointEvaluator<dim> &,                                                               \
    const std::vector<std::vector<double>> &) const;                                           \
  template std::vector<OutputField> SolidProblem<dim>::fields(const double) const;                  \
  template Difference          SolidProblem<dim>::error(const ExactSolution &, const double) const; \
  template std::vector<double> SolidProblem<dim>::exact_row(const ExactSolution &,                  \
                                                            const Point<dim> &,                     \
                                                            const double) const;                    \
  template NewCracks           SolidProblem<dim>::new_cracks() const;                               \
  template void                SolidProblem<dim>::add_totals(const double, const RunContext &);     \
  template void                SolidProblem<dim>::describe_end(json &, ResultRecord &) const;       \
  template void                SolidProblem<dim>::describe_scene(json &, const bool) const;         \
  template json                SolidProblem<dim>::describe_solving() const;
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_RESULTS)
#undef PERIDEAL_RESULTS
} // namespace PeriDeal
