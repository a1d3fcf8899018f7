// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/fe/fe_dgq.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/interleaved.h>
#include <perideal/base/worst_trip.h>
#include <perideal/mesh/node_keys.h>
#include <perideal/operators/solid/stress_cells.h>
#include <perideal/operators/solid/thermal_strains.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  std::unique_ptr<StressCells<dim>> StressCells<dim>::of_scene(const DoFHandler<dim>     &dofs,
                                                               const BodyParameters<dim> &body,
                                                               const CutCells<dim>       &cracks,
                                                               const Share               &share)
  {
    PlacedStressLaw<dim> law = stress_law_of(body);
    if (!law.law)
      return nullptr;
    Kinematics kinematics;
    kinematics.is_full = body.elasticity.has_full_kinematics();
    // A linear body is what it is without the projection.
    kinematics.projects = body.material.law.kind != SolidLaw::linear &&
                          stress_state_of(dim, body.elasticity.plane) != StressState::plane_stress;
    return std::make_unique<StressCells>(dofs,
                                         std::move(law),
                                         kinematics,
                                         cracks,
                                         StressSteps::of_scene(body),
                                         share);
  }


  template <int dim>
  StressCells<dim>::StressCells(const DoFHandler<dim> &dofs,
                                PlacedStressLaw<dim>   law,
                                const Kinematics      &kinematics,
                                const CutCells<dim>   &cracks,
                                const StressSteps     &steps,
                                const Share           &share)
    : dofs(dofs)
    , of_points(std::move(law))
    , cracks(cracks)
    , first(dofs.get_triangulation().n_active_cells(), 0)
    , share(share)
    , steps(steps)
    , at{ProjectedStrains<dim>(dofs.get_fe(), kinematics.projects && !kinematics.is_full),
         nullptr,
         std::vector<types::global_dof_index>(dofs.get_fe().n_dofs_per_cell()),
         dealii::Vector<double>(dim * dofs.get_fe().n_dofs_per_cell()),
         {},
         false}
  {
    at.points.resize(at.strains.values().n_quadrature_points);
    if (kinematics.is_full)
      at.deformed = std::make_unique<DeformedStrains<dim>>(dofs.get_fe(),
                                                           at.points.size(),
                                                           kinematics.projects);
    for (LawPoint &point : at.points)
      point.state.resize(of_points.law->n_state());
    std::size_t n_points = 0;
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          first[cell->active_cell_index()] = n_points;
          n_points += at.points.size();
          at.strains.reinit(cell);
          for (const auto &place : at.strains.values().get_quadrature_points())
            {
              const std::vector<double> of_point = of_points.parameters_at_start(place);
              all_parameters.insert(all_parameters.end(), of_point.begin(), of_point.end());
            }
        }
    states.resize(n_points * of_points.law->n_state(), 0.);
  }


  template <int dim>
  bool StressCells<dim>::holds(const unsigned int q) const
  {
    const double ratio = at.deformed->volume_ratio(q);
    if (ratio > 0.)
      return true;
    keep_lower(inverted,
               turned_inside_out(at.strains.values().quadrature_point(q), ratio, steps.now));
    return false;
  }


  template <int dim>
  void StressCells<dim>::look_at(const Cell   &cell,
                                 const Vector *u,
                                 const double *accepted,
                                 const bool    with_tangents) const
  {
    at.strains.reinit(cell);
    cell->get_dof_indices(at.nodes);
    at.u = 0.;
    for (unsigned int i = 0; u != nullptr && i < at.u.size(); ++i)
      at.u(i) = (*u)(dim * at.nodes[i / dim] + i % dim);
    if (at.deformed)
      at.deformed->reinit(at.strains.values(), at.u, with_tangents);
    StressLaw::Trial trial;
    trial.length  = std::pow(cell->measure(), 1. / dim) / dofs.get_fe().degree;
    trial.element = cell->global_active_cell_index();
    double kept   = u == nullptr ? 1. : cracks.kept_of_removed(cell);
    if (u != nullptr && share)
      kept *= share(cell);
    const double *of_point = all_parameters.data() + first_of(cell) * of_points.law->n_parameters();
    for (unsigned int q = 0; q < at.points.size(); ++q)
      {
        LawPoint &point  = at.points[q];
        point.weight     = kept * at.strains.values().JxW(q);
        trial.parameters = of_point + q * of_points.law->n_parameters();
        trial.state      = accepted + q * of_points.law->n_state();
        trial.point      = q;
        if (at.deformed && (point.weight == 0. || !holds(q)))
          {
            point.response = StressLaw::Response();
            point.tangent  = 0.;
            std::copy_n(trial.state, point.state.size(), point.state.begin());
            continue;
          }
        trial.strain = at.deformed ? at.deformed->strain(q) : at.strains.strain(q, at.u);
        if (!warm.strains.empty())
          {
            const std::size_t n = first_of(cell) + q;
            if (u != nullptr)
              trial.strain -= warm.strains[n] * unit_symmetric_tensor<3>();
            trial.temperature = warm.temperatures[n];
            trial.warming     = warm.temperatures[n] - warm.accepted[n];
          }
        if (at.deformed)
          trial.displacement_gradient = at.deformed->displacement_gradient(q);
        point.response = steps.update(*of_points.law,
                                      trial,
                                      point.state.data(),
                                      with_tangents ? &point.tangent : nullptr,
                                      u == nullptr);
        at.unsymmetric = at.unsymmetric || !point.response.has_symmetric_tangent;
      }
  }


  template <int dim>
  bool StressCells<dim>::has_symmetric_tangents() const
  {
    return Utilities::MPI::max(at.unsymmetric ? 1 : 0, dofs.get_communicator()) == 0;
  }


  template <int dim>
  const std::vector<typename StressCells<dim>::LawPoint>
    &StressCells<dim>::points_of(const Cell &cell, const Vector &u) const
  {
    look_at(cell, &u, states.data() + first_of(cell) * of_points.law->n_state(), false);
    return at.points;
  }


  template <int dim>
  void StressCells<dim>::find_stiffness(const Cell         &cell,
                                        FullMatrix<double> &matrix,
                                        const Vector       *u) const
  {
    using Strain                   = StressLaw::Tensor;
    constexpr unsigned int n_parts = Strain::n_independent_components;
    const unsigned int     n       = at.u.size();
    if (u != nullptr)
      look_at(cell, u, states.data() + first_of(cell) * of_points.law->n_state(), true);
    else
      look_at(cell,
              nullptr,
              std::vector<double>(at.points.size() * of_points.law->n_state(), 0.).data(),
              true);
    matrix.reinit(n, n);
    FullMatrix<double> strains(n, n_parts), stresses(n, n_parts);
    for (unsigned int q = 0; q < at.points.size(); ++q)
      {
        const LawPoint &point = at.points[q];
        for (unsigned int i = 0; i < n; ++i)
          {
            const Strain strain = at.deformed ? at.deformed->of_unknown(i / dim, i % dim, q) :
                                                at.strains.of_unknown(i / dim, i % dim, q);
            const Strain stress = point.weight * (point.tangent * strain);
            for (unsigned int k = 0; k < n_parts; ++k)
              {
                // Entries beside the diagonal stand for two.
                strains(i, k)  = (k < 3 ? 1. : 2.) * strain.access_raw_entry(k);
                stresses(i, k) = stress.access_raw_entry(k);
              }
          }
        strains.mTmult(matrix, stresses, true);
      }
    if (!at.deformed || u == nullptr)
      return;
    std::vector<Strain> weighted;
    for (const LawPoint &point : at.points)
      weighted.push_back(point.weight * point.response.stress);
    at.deformed->add_geometric(matrix, weighted);
  }


  template <int dim>
  void StressCells<dim>::add_tangent(ElementMatrix<dim, dim> &matrix,
                                     const HangingNodes<dim> &hanging,
                                     const Vector            &u) const
  {
    std::vector<types::global_dof_index> unknowns(at.u.size());
    FullMatrix<double>                   of_cell;
    at.unsymmetric = false;
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          find_stiffness(cell, of_cell, &u);
          for (unsigned int i = 0; i < unknowns.size(); ++i)
            unknowns[i] = dim * at.nodes[i / dim] + i % dim;
          matrix.add(hanging, of_cell, unknowns);
        }
    throw_faults();
  }


  template <int dim>
  void StressCells<dim>::add_forces(std::vector<Tensor<1, dim>> &forces) const
  {
    std::vector<StressLaw::Tensor> stresses;
    std::vector<Tensor<2, dim>>    nominal;
    if (at.deformed)
      {
        for (const LawPoint &point : at.points)
          stresses.push_back(point.response.stress);
        at.deformed->find_nominal(nominal, stresses);
      }
    for (unsigned int q = 0; q < at.points.size(); ++q)
      for (unsigned int a = 0; a < forces.size(); ++a)
        forces[a] += at.points[q].weight * (at.deformed ?
                                              nominal[q] * at.strains.values().shape_grad(a, q) :
                                              at.strains.force(a, q, at.points[q].response.stress));
  }


  template <int dim>
  void StressCells<dim>::find_forces(Vector                  &y,
                                     const HangingNodes<dim> &hanging,
                                     const Vector            &u,
                                     const double             t) const
  {
    steps.now = t;
    inverted  = Trip();
    y         = 0.;
    std::vector<Tensor<1, dim>> forces(at.nodes.size());
    for_each(u, [&](const Cell &, const std::vector<LawPoint> &) {
      std::fill(forces.begin(), forces.end(), Tensor<1, dim>());
      add_forces(forces);
      for (unsigned int a = 0; a < forces.size(); ++a)
        for (unsigned int d = 0; d < dim; ++d)
          y(dim * at.nodes[a] + d) += forces[a][d];
    });
    throw_faults();
    if (at.deformed)
      throw_lowest_if_any(dofs.get_communicator(), inverted);
    y.compress(VectorOperation::add);
    hanging.condense(y);
    hanging.set(y, 0.);
  }


  template <int dim>
  double StressCells<dim>::energy(const Vector &u) const
  {
    double sum = 0.;
    for_each(u, [&](const Cell &, const std::vector<LawPoint> &points) {
      for (const LawPoint &point : points)
        sum += point.weight * point.response.stored;
    });
    throw_faults();
    return Utilities::MPI::sum(sum, dofs.get_communicator());
  }


  template <int dim>
  double StressCells<dim>::largest_stiffening(const Vector &u) const
  {
    double largest = 0.;
    if (at.deformed)
      for_each(u, [&](const Cell &, const std::vector<LawPoint> &points) {
        for (unsigned int q = 0; q < points.size(); ++q)
          if (points[q].weight > 0. && at.deformed->volume_ratio(q) > 0.)
            largest = std::max(largest, at.deformed->stiffening(q));
      });
    return Utilities::MPI::max(largest, dofs.get_communicator());
  }


  template <int dim>
  void StressCells<dim>::take_temperatures(const BodyParameters<dim> &body, const Vector &changes)
  {
    // Those of a computed temperature are at the reference until the first comes.
    const bool warms    = is_warm(body),
               is_known = changes.size() > 0 || !body.elasticity.computes_temperature;
    if (!warms && !body.material.law.yields())
      return;
    const unsigned int  n_points = at.points.size(), n_parameters = of_points.law->n_parameters();
    std::vector<double> strains(n_points);
    std::string         message;
    warm.strains.clear();
    warm.temperatures.clear();
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          at.strains.reinit(cell);
          cell->get_dof_indices(at.nodes);
          for (unsigned int q = 0; q < n_points; ++q)
            {
              const Point<dim> &p      = at.strains.values().quadrature_point(q);
              double            change = 0.;
              if (changes.size() == 0)
                change = body.elasticity.temperature_change.value(p);
              else
                for (unsigned int a = 0; a < at.nodes.size(); ++a)
                  change += changes(at.nodes[a]) * at.strains.values().shape_value(a, q);
              const double T = temperature_of(body, change);
              strains[q]     = body.free_expansion(p, change);
              if (message.empty() && is_known)
                message = yield_stress_fault(body.material, p, T);
              if (warms)
                warm.temperatures.push_back(T);
              if (!of_points.depends_on_temperature)
                continue;
              const std::vector<double> here = of_points.parameters(p, T);
              std::copy(here.begin(),
                        here.end(),
                        all_parameters.begin() + (first_of(cell) + q) * n_parameters);
            }
          if (!warms)
            continue;
          at.strains.project(strains);
          warm.strains.insert(warm.strains.end(), strains.begin(), strains.end());
        }
    if (warm.accepted.empty())
      warm.accepted.assign(warm.temperatures.size(), temperature_of(body, 0.));
    throw_on_all_if_any(dofs.get_communicator(), message);
  }


  template <int dim>
  double StressCells<dim>::accept(const Vector &u, const double t)
  {
    double dissipated = 0.;
    begun             = true;
    steps.now         = t;
    if (of_points.law->n_state() == 0 &&
        !of_points.law->may_fail()) // nothing to remember or dissipate
      {
        steps.accept(t, false);
        return 0.;
      }
    bool changes = false;
    for_each(u, [&](const Cell &cell, const std::vector<LawPoint> &points) {
      auto next = states.begin() + first_of(cell) * of_points.law->n_state();
      for (const LawPoint &point : points)
        {
          dissipated += point.weight * point.response.dissipated;
          changes = changes || !std::equal(point.state.begin(), point.state.end(), next);
          next    = std::copy(point.state.begin(), point.state.end(), next);
        }
    });
    throw_faults();
    warm.accepted = warm.temperatures;
    steps.accept(t, Utilities::MPI::max(changes ? 1U : 0U, dofs.get_communicator()) > 0);
    return Utilities::MPI::sum(dissipated, dofs.get_communicator());
  }


  template <int dim>
  void StressCells<dim>::exchange(Archive &archive)
  {
    // Cells have keys by the one node that such an element has in each.
    DoFHandler<dim>                      cells(dofs.get_triangulation());
    const FE_DGQ<dim>                    middle(0);
    std::vector<types::global_dof_index> node(1);
    cells.distribute_dofs(middle);
    const Utilities::MPI::Partitioner layout(cells.locally_owned_dofs(), cells.get_communicator());
    const auto exchange = [&](const std::string &name, const unsigned int n, auto &numbers) {
      const unsigned int                                 n_values = at.points.size() * n;
      dealii::LinearAlgebra::distributed::Vector<double> values(interleaved(layout, n_values));
      const auto                                         for_each_cell = [&](const auto &act) {
        for (const auto &cell : cells.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              cell->get_dof_indices(node);
              act(values.begin() + n_values * layout.global_to_local(node[0]),
                  numbers.begin() + first[cell->active_cell_index()] * n);
            }
      };
      for_each_cell([&](auto value, auto number) { std::copy_n(number, n_values, value); });
      archive.exchange(name, values, node_keys(cells));
      for_each_cell([&](auto value, auto number) { std::copy_n(value, n_values, number); });
    };
    archive.exchange("begun", begun);
    steps.exchange(archive);
    const unsigned int warms = warm.accepted.empty() ? 0 : 1;
    if (Utilities::MPI::max(warms, cells.get_communicator()) > 0)
      exchange("accepted temperatures", 1, warm.accepted);
    if (of_points.law->n_state() > 0)
      exchange("states of points", of_points.law->n_state(), states);
  }


  PERIDEAL_INSTANTIATE_CLASS(class StressCells);
} // namespace PeriDeal
