// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Where the first bonds break.

#include <deal.II/base/mpi.h>

#include <perideal/base/point_order.h>
#include <perideal/operators/state_operator.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int no_side = numbers::invalid_unsigned_int;


    bool is_no_load(const VectorCondition &traction)
    {
      return std::all_of(traction.values.begin(), traction.values.end(), [](const auto &value) {
        return !value || is_zero(*value);
      });
    }
  } // namespace


  template <int dim>
  void StateOperator<dim>::find_what_is_beside_loads()
  {
    const Nodes<dim>                           &nodes = bonds.nodes();
    const auto                                 &list  = scene.boundary_conditions.traction;
    std::vector<typename Families<dim>::Member> family;
    loaded_side.assign(nodes.n_local(), no_side);
    for (unsigned int number = 0; number < list.size(); ++number)
      {
        if (is_no_load(list[number]))
          continue;
        Vector beside(nodes.partitioner());
        for (const TractionShare<dim> &share : tractions)
          if (share.side == list[number].id && share.area != 0.)
            {
              bonds.members_of(share.node, family);
              beside.local_element(share.node) += 1.;
              for (const auto &bond : family)
                beside.local_element(bond.neighbor) += 1.;
            }
        beside.compress(VectorOperation::add);
        beside.update_ghost_values();
        for (unsigned int i = 0; i < nodes.n_local(); ++i)
          if (beside.local_element(i) > 0. && loaded_side[i] == no_side)
            loaded_side[i] = number;
      }
  }


  template <int dim>
  void StateOperator<dim>::keep_places()
  {
    if (places.elsewhere)
      return;
    const bool is_first = places.first.empty();
    if (is_first)
      find_what_is_beside_loads();
    const Nodes<dim> &nodes = bonds.nodes();
    const auto       &list  = scene.boundary_conditions.traction;
    // Ends of bonds beside each side, and of those elsewhere.
    std::vector<double>                        n_ends(list.size() + 1, 0.), all(n_ends);
    std::vector<std::pair<double, Point<dim>>> broken; // stretch over the critical one, middle
    const auto                                 add =
      [&](const unsigned int i, const unsigned int j, const double n, const double ratio) {
        const unsigned int side = std::min(loaded_side[i], loaded_side[j]);
        n_ends[side == no_side ? list.size() : side] += n;
        if (is_first)
          broken.emplace_back(ratio,
                              nodes.position(i) + 0.5 * (nodes.position(j) - nodes.position(i)));
      };
    unsigned int i = 0; // bonds are in the order of their nodes
    for (const auto &[k, ratio] : breaking)
      {
        while (k >= starts[i + 1])
          ++i;
        add(i, neighbors[k], 1., ratio);
      }
    std::size_t next = 0;
    if (beyond)
      beyond->for_each([&](const auto &bond) {
        if (next < breaking_images.size() && breaking_images[next].first == bond.number)
          add(bond.node, bond.node, beyond->n_ends(bond), breaking_images[next++].second);
      });
    const MPI_Comm communicator = nodes.communicator();
    Utilities::MPI::sum(n_ends, communicator, all);
    places.elsewhere = all.back() > 0.;
    for (unsigned int side = 0; side < list.size() && !places.elsewhere; ++side)
      if (all[side] > 0.)
        places.beside_loads[list[side].name] += static_cast<unsigned long long>(0.5 * all[side]);
    if (!is_first)
      return;
    // Of bonds that are stretched alike, but for round-off, the first in space.
    double most = 0.;
    for (const auto &[ratio, middle] : broken)
      most = std::max(most, ratio);
    most = (1. - 1e-6) * Utilities::MPI::max(most, communicator);
    std::vector<Point<dim>> first;
    for (const auto &[ratio, middle] : broken)
      if (ratio >= most && (first.empty() || comes_first(middle, first[0])))
        first.assign(1, middle);
    Point<dim> found;
    bool       any = false;
    for (const std::vector<Point<dim>> &of_one : Utilities::MPI::all_gather(communicator, first))
      if (!of_one.empty() && (!any || comes_first(of_one[0], found)))
        {
          found = of_one[0];
          any   = true;
        }
    places.first.assign(found.begin_raw(), found.end_raw());
  }


#define PERIDEAL_INSTANTIATE(dim)                                \
  template void StateOperator<dim>::find_what_is_beside_loads(); \
  template void StateOperator<dim>::keep_places();
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
