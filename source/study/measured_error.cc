// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "measured_error.h"

#include <deal.II/base/mpi.h>

#include <perideal/analysis/point_evaluator.h>
#include <perideal/base/gathered_lists.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/rules.h>
#include <perideal/study/naming.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "griffith.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using Json = nlohmann::ordered_json;

    template <int dim>
    constexpr unsigned int n_points_of_field = dim == 1 ? 1000 :
                                               dim == 2 ? 2500 :
                                                          4096;


    /** Numbers between 0 and 1, as if by chance, that follow from a text. */
    struct Chance
    {
      explicit Chance(const std::string &text)
        : state(std::strtoull(text_hash(text).c_str(), nullptr, 16))
      {}

      double next()
      {
        state = state * 6364136223846793005ull + 1442695040888963407ull;
        return static_cast<double>(state >> 11) / 9007199254740992.;
      }

      unsigned long long state;
    };


    /** Points of a body and the part of it that each stands for. */
    struct Sample
    {
      std::vector<std::vector<double>> points;
      std::vector<double>              weights;
    };


    /**
     * Some n points: one somewhere in each cell of a mesh, several where there are few cells (the
     * error may be in a few of them), or in one of
     * so many cells that about n are left: adapted meshes have their cells where errors would be.
     * Chance follows from the places of cells, so that it does not matter how a mesh is dealt out.
     * Collective.
     */
    template <int dim>
    Sample sample_of(const Triangulation<dim> &mesh, const double n)
    {
      const double cells    = mesh.n_global_active_cells();
      double       at_sides = 0.;
      for (const auto &cell : mesh.active_cell_iterators())
        at_sides += cell->is_locally_owned() && cell->at_boundary() ? 1. : 0.;
      at_sides = Utilities::MPI::sum(at_sides, mesh.get_communicator());
      std::vector<double> own;
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            // Where there are too many, those at sides are looked at first: layers are there, and
            // solutions of a horizon jump.
            const bool         at_side  = cells > n && cell->at_boundary();
            const double       share    = std::min(1., n / (at_side ? at_sides : cells));
            const unsigned int n_points = at_side && dim == 1 ? 8 : std::ceil(n / cells);
            Chance             chance(cell->id().to_string());
            chance.next();
            if (chance.next() > share)
              continue;
            for (unsigned int k = 0; k < n_points; ++k)
              {
                Point<dim> place; // in coordinates of the cell
                for (unsigned int d = 0; d < dim; ++d)
                  place[d] = chance.next();
                Point<dim> p;
                for (const unsigned int v : cell->vertex_indices())
                  p += GeometryInfo<dim>::d_linear_shape_function(place, v) * cell->vertex(v);
                own.push_back(cell->measure() / share / n_points);
                for (unsigned int d = 0; d < dim; ++d)
                  own.push_back(p[d]);
              }
          }
      Sample                           sample;
      std::vector<std::vector<double>> all;
      for (const std::vector<double> &list : gathered_lists(mesh.get_communicator(), own))
        for (std::size_t k = 0; k < list.size(); k += dim + 1)
          all.emplace_back(list.begin() + k, list.begin() + k + dim + 1);
      std::sort(all.begin(), all.end());
      for (const std::vector<double> &one : all)
        {
          sample.weights.push_back(one[0]);
          sample.points.emplace_back(one.begin() + 1, one.end());
        }
      return sample;
    }


    /**
     * A point in each of n equal parts of a box, somewhere in each of them, the same for all
     * solutions. Not collective.
     */
    template <int dim>
    std::vector<std::vector<double>> points_in(const Point<dim>  &lower,
                                               const Point<dim>  &upper,
                                               const unsigned int n)
    {
      const unsigned int along = std::lround(std::pow(n, 1. / dim));
      Chance             chance("points");
      unsigned int       all = 1;
      for (unsigned int d = 0; d < dim; ++d)
        all *= along;
      std::vector<std::vector<double>> points;
      for (unsigned int k = 0; k < all; ++k)
        {
          points.emplace_back();
          unsigned int rest = k;
          for (unsigned int d = 0; d < dim; ++d, rest /= along)
            points.back().push_back(lower[d] +
                                    (upper[d] - lower[d]) * (rest % along + chance.next()) / along);
        }
      return points;
    }


    /**
     * Largest minus smallest value of a component at the nodes; 0 if that is round-off. Collective.
     */
    template <int dim>
    double range_of(const Problem<dim> &problem, const unsigned int component)
    {
      const Vector &u    = problem.state();
      double        high = -std::numeric_limits<double>::max(), low = -high;
      for (unsigned int i = component; i < u.locally_owned_size(); i += problem.n_components())
        {
          high = std::max(high, u.local_element(i));
          low  = std::min(low, u.local_element(i));
        }
      const MPI_Comm   communicator = problem.dofs().get_communicator();
      constexpr double round_off    = 1e-9; // solvers leave that
      const double     most         = Utilities::MPI::max(high, communicator),
                   least            = Utilities::MPI::min(low, communicator);
      return most - least > round_off * std::max(std::abs(most), std::abs(least)) ? most - least :
                                                                                    0.;
    }


    template <int dim>
    PointEvaluator<dim> reader_of(const Problem<dim>                     &problem,
                                  const Cracks<dim>                      &cracks,
                                  const std::vector<std::vector<double>> &points)
    {
      using Reader = PointEvaluator<dim>;
      return Reader(problem.dofs(),
                    problem.nodes(),
                    cracks,
                    points,
                    "Probes",
                    Reader::Outside::leave_gaps,
                    Reader::BesideCracks::own_side);
    }
  } // namespace


  template <int dim>
  MeasuredError<dim>::MeasuredError(const Scene<dim> &scene)
    : scene(scene)
  {
    refuse_measure(scene);
  }


  template <int dim>
  double MeasuredError<dim>::of_values(const MeasuredSolution<dim>            &finer,
                                       const MeasuredSolution<dim>            &coarser,
                                       const std::vector<std::vector<double>> &points,
                                       const std::vector<double>              &weights) const
  {
    const Problem<dim> &fine = finer.simulation.problem(), &coarse = coarser.simulation.problem();
    const PointEvaluator<dim> of_fine   = reader_of(fine, finer.cracks, points),
                              of_coarse = reader_of(coarse, coarser.cracks, points);
    double worst = 0., range = 0.;
    for (unsigned int c = 0; c < fine.n_components(); ++c)
      {
        const std::vector<double> u = of_fine.evaluate(fine.state(), fine.n_components(), c),
                                  v = of_coarse.evaluate(coarse.state(), fine.n_components(), c);
        double sum = 0., volume = 0., largest = 0.;
        for (std::size_t k = 0; k < u.size(); ++k)
          if (!of_fine.is_gap(k) && !of_coarse.is_gap(k))
            {
              largest = std::max(largest, std::abs(u[k] - v[k]));
              if (!weights.empty())
                {
                  sum += weights[k] * (u[k] - v[k]) * (u[k] - v[k]);
                  volume += weights[k];
                }
            }
        worst = std::max(worst, weights.empty() ? largest : std::sqrt(sum / volume));
        range = std::max(range, range_of(fine, c));
      }
    return range > 0. ? worst / range : 0.;
  }


  namespace
  {
    /** The size of a flow or of a force. */
    double size_of(const Json &value)
    {
      double square = 0.;
      for (const Json &component : value)
        square += std::pow(component.template get<double>(), 2);
      return std::sqrt(square);
    }


    /** The forces or the flow inside a body, which need not act on its sides. */
    double scale_of(const Json &found)
    {
      double scale = 0.;
      for (const auto &[balance, key] :
           {std::make_pair("force balance", "scale"), std::make_pair("heat balance", "throughput")})
        if (found.contains(balance))
          scale = std::max(scale, found[balance].value(key, 0.));
      return scale;
    }
  } // namespace


  namespace
  {
    /**
     * What stress intensities or flows of a body are about: E |u| / L sqrt(L), or k |u| / L times
     * volume over L. Collective.
     */
    template <int dim>
    double size_by_range(const Scene<dim> &scene, const Problem<dim> &problem)
    {
      double range = 0., longest = 0., volume = 1.;
      for (unsigned int c = 0; c < problem.n_components(); ++c)
        range = std::max(range, range_of(problem, c));
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double edge = scene.domain.upper[d] - scene.domain.lower[d];
          longest           = std::max(longest, edge);
          volume *= edge;
        }
      const Point<dim> middle =
        scene.domain.lower + 0.5 * (scene.domain.upper - scene.domain.lower);
      if (!scene.deforms)
        return scene.material.conductivity.value(middle) * range * volume / (longest * longest);
      return scene.moduli(middle).young() * range / std::sqrt(longest);
    }
  } // namespace


  template <int dim>
  void MeasuredError<dim>::refuse_forces_at_points(Simulation<dim> &simulation) const
  {
    // Fields are measured there, too, and what lies within a hundredth of the longest edge.
    constexpr double near    = 0.01;
    double           longest = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      longest = std::max(longest, scene.domain.upper[d] - scene.domain.lower[d]);
    const AccuracyMeasure    measure = scene.accuracy.measure;
    std::vector<std::string> points;
    const auto               any_probe_at = [&](const Point<dim> &p) {
      return std::any_of(scene.output.probes.begin(),
                         scene.output.probes.end(),
                         [&](const std::vector<double> &probe) {
                           double square = 0.;
                           for (unsigned int d = 0; d < dim; ++d)
                             square += std::pow(probe[d] - p[d], 2);
                           return std::sqrt(square) < near * longest;
                         });
    };
    for (const Part &part : scene.boundary_conditions.parts)
      if (part.kind == Part::point &&
          (measure == AccuracyMeasure::field ||
           (measure == AccuracyMeasure::probes && any_probe_at(part.position<dim>()))))
        points.push_back(part.name);
    if (dim == 1 || points.empty())
      return;
    constexpr double  small    = 1e-6; // points that only keep a body from floating
    const std::string reaction = scene.deforms ? "boundary force" : "boundary flux";
    const Json        found    = simulation.found()["models"]["auto"];
    if (!found.contains(reaction))
      return;
    double largest = scale_of(found);
    for (const Json &value : found[reaction])
      largest = std::max(largest, size_of(value));
    for (const std::string &name : points)
      if (found[reaction].contains(name) && size_of(found[reaction][name]) > small * largest)
        scene.accuracy.refuse(true,
                              "Measure",
                              "is '" + scene.accuracy.measure_text() + "', but at the point '" +
                                name + "' (entry 'Parts' in section 'Boundary conditions') a " +
                                (scene.deforms ? "force acts" : "flow enters") +
                                ", near which the classical solution is infinite: it would be "
                                "another one on each mesh. Give the part a size (for example 'top "
                                "if abs(x) < 0.1', which has to be some cells wide)" +
                                (scene.deforms && dim == 2 && !scene.cracks.cracks.empty() ?
                                   ", or measure 'stress intensity'." :
                                   "."));
  }


  template <int dim>
  MeasuredNumbers MeasuredError<dim>::numbers(Simulation<dim>   &simulation,
                                              const Cracks<dim> &cracks) const
  {
    constexpr double      small   = 0.01;
    const AccuracyMeasure measure = scene.accuracy.measure;
    MeasuredNumbers       numbers;
    if (measure == AccuracyMeasure::flow)
      {
        const std::string &side = scene.accuracy.side;
        const Json         all = simulation.found()["models"]["auto"], none = Json::object();
        const Json        &flows = all.contains("boundary flux") ? all["boundary flux"] : none;
        std::vector<std::string> names;
        for (const auto &item : flows.items())
          names.push_back(item.key());
        scene.accuracy.refuse(!flows.contains(side),
                              "Measure",
                              "found 'flow: " + side + "', needs a side with a condition: " +
                                join_names(names) + "." + did_you_mean(side, names));
        numbers.values[side] = flows[side].template get<double>();
        numbers.least = small * std::max(scale_of(all), size_by_range(scene, simulation.problem()));
      }
    else if (measure == AccuracyMeasure::strength)
      {
        const Json          all   = simulation.found()["models"]["auto"];
        const GriffithState state = griffith_state(scene, cracks, all);
        if (!state.ends.empty())
          numbers.values["strength"] = state.strength();
      }
    else if (measure == AccuracyMeasure::stress_intensity)
      {
        const Json all = simulation.found()["models"]["auto"];
        if (all.contains("stress intensity"))
          for (const auto &[end, k] : all["stress intensity"].items())
            numbers.values[end] =
              std::hypot(k["I"].template get<double>(), k["II"].template get<double>());
        for (const auto &[end, k] : numbers.values)
          numbers.least = std::max(numbers.least, small * k);
        numbers.least = std::max(numbers.least, small * size_by_range(scene, simulation.problem()));
      }
    return numbers;
  }


  namespace
  {
    /** The largest relative difference, or nothing, where there was no room around all ends. */
    std::optional<double> difference_of(const MeasuredNumbers &fine, const MeasuredNumbers &coarse)
    {
      if (fine.values.empty() || fine.values.size() != coarse.values.size())
        return {};
      double worst = 0.;
      for (const auto &[name, value] : fine.values)
        if (const double other = coarse.values.at(name); other != value)
          worst = std::max(worst, std::abs(value - other) / std::max(std::abs(value), fine.least));
      return worst;
    }


    /**
     * The largest difference at a time, as `field` and `probes` have it. Once a solution has come
     * to rest, its range is no measure any more: a hundredth of the largest is.
     */
    double difference_of(const std::vector<SeenValues> &fine,
                         const std::vector<SeenValues> &coarse,
                         const AccuracyMeasure          measure)
    {
      constexpr double at_rest = 0.01;
      double           widest = 0., worst = 0.;
      for (const SeenValues &seen : fine)
        widest = std::max(widest, seen.range);
      for (std::size_t k = 0; k < fine.size(); ++k)
        for (std::size_t c = 0; c < fine[k].values.size(); ++c)
          {
            double       sum = 0., largest = 0.;
            unsigned int n = 0;
            for (std::size_t i = 0; i < fine[k].values[c].size(); ++i)
              if (const double d = fine[k].values[c][i] - coarse[k].values[c][i]; std::isfinite(d))
                {
                  sum += d * d;
                  largest = std::max(largest, std::abs(d));
                  ++n;
                }
            const double found = measure == AccuracyMeasure::probes ? largest : std::sqrt(sum / n);
            if (found > 0. && widest > 0.)
              worst = std::max(worst, found / std::max(fine[k].range, at_rest * widest));
          }
      return worst;
    }
  } // namespace


  template <int dim>
  SeenValues MeasuredError<dim>::see(const Problem<dim> &problem, const Cracks<dim> &cracks) const
  {
    const bool at_probes = scene.accuracy.measure == AccuracyMeasure::probes;
    const std::vector<std::vector<double>> points =
      at_probes ? scene.output.probes :
                  points_in(scene.domain.lower, scene.domain.upper, n_points_of_field<dim>);
    const PointEvaluator<dim> reader = reader_of(problem, cracks, points);
    SeenValues                seen;
    for (unsigned int c = 0; c < problem.n_components(); ++c)
      {
        seen.values.push_back(reader.evaluate(problem.state(), problem.n_components(), c));
        for (std::size_t i = 0; i < points.size(); ++i)
          if (reader.is_gap(i))
            seen.values.back()[i] = std::numeric_limits<double>::quiet_NaN();
        seen.range = std::max(seen.range, range_of(problem, c));
      }
    return seen;
  }


  template <int dim>
  std::vector<unsigned int> MeasuredError<dim>::constant_directions(const Problem<dim> &problem,
                                                                    const Cracks<dim> &cracks) const
  {
    constexpr double       slack    = 1e-6;
    constexpr unsigned int n_points = 64;
    const double           range    = range_of(problem, 0);
    if (dim == 1 || problem.n_components() > 1 || range == 0.)
      return {};
    const auto values = [&](const std::vector<std::vector<double>> &points) {
      return reader_of(problem, cracks, points).evaluate(problem.state(), 1, 0);
    };
    const auto                points = points_in(scene.domain.lower, scene.domain.upper, n_points);
    const auto                before = values(points);
    std::vector<unsigned int> constant;
    for (unsigned int d = 0; d < dim; ++d)
      {
        auto moved = points;
        for (std::size_t k = 0; k < moved.size(); ++k) // to another point of the same line
          moved[k][d] = points[(k * 7 + 3) % points.size()][d];
        const auto after  = values(moved);
        double     change = 0.;
        for (std::size_t k = 0; k < after.size(); ++k)
          change = std::max(change, std::abs(after[k] - before[k]));
        if (change < slack * range)
          constant.push_back(d);
      }
    return constant;
  }


  template <int dim>
  std::optional<double> MeasuredError<dim>::difference(const MeasuredSolution<dim> &fine,
                                                       const MeasuredSolution<dim> &coarse) const
  {
    if (!scene.time.steady && scene.accuracy.measure != AccuracyMeasure::flow &&
        scene.accuracy.measure != AccuracyMeasure::stress_intensity &&
        !scene.accuracy.measures_growth())
      return difference_of(fine.seen, coarse.seen, scene.accuracy.measure);
    switch (scene.accuracy.measure)
      {
        case AccuracyMeasure::field:
          {
            const auto  &mesh   = fine.simulation.problem().dofs().get_triangulation();
            const Sample sample = sample_of(mesh, n_points_of_field<dim>);
            return of_values(fine, coarse, sample.points, sample.weights);
          }
        case AccuracyMeasure::probes:
          return of_values(fine, coarse, scene.output.probes, {});
        default:
          return difference_of(fine.numbers, coarse.numbers);
      }
  }


  PERIDEAL_INSTANTIATE_CLASS(class MeasuredError);
} // namespace PeriDeal
