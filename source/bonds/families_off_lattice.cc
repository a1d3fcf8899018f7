// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <perideal/base/user_error.h>
#include <perideal/laws/kernel.h>
#include <perideal/laws/volume_fraction.h>

#include <algorithm>
#include <limits>

#include "families_search.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  double Families<dim>::weight_off_lattice(const double r) const
  {
    const double h        = own_nodes->smallest_spacing();
    double       fraction = 1., at = r;
    if (r > delta - 0.5 * h) // else all of the neighbour is within the horizon
      {
        const bool linear = parameters.volume_fraction == VolumeFraction::linear;
        fraction = linear ? linear_fraction(r, delta, h) : (r <= delta * (1. + 1e-9) ? 1. : 0.);
        if (fraction == 0.)
          return 0.;
        if (linear && parameters.kernel == KernelShape::conical)
          at = shifted_distance(r, delta, h);
      }
    double power = 1.; // r^n
    for (unsigned int k = 0; k < parameters.kernel_exponent; ++k)
      power *= r;
    return factor * conductivity_scale * kernel_shape(parameters.kernel, at, delta) * fraction /
           power;
  }


  template <int dim>
  void Families<dim>::bonds_off_lattice(const unsigned int node, std::vector<Bond> &bonds) const
  {
    std::vector<std::pair<unsigned int, double>> found;
    search->within(own_nodes->position(node), farthest * (1. + 1e-9), found);
    std::vector<std::pair<Tensor<1, dim>, unsigned int>> around;
    around.reserve(found.size());
    for (const auto &[neighbor, square] : found)
      around.emplace_back(bond_vector(node, neighbor), neighbor);
    // In the order of the relative position; of two nodes at the same place the one on the same
    // side of a crack comes first by its crack point.
    std::sort(around.begin(), around.end(), [&](const auto &a, const auto &b) {
      for (unsigned int d = dim; d-- > 0;)
        if (a.first[d] != b.first[d])
          return a.first[d] < b.first[d];
      const Point<dim> pa = own_nodes->crack_point(a.second), pb = own_nodes->crack_point(b.second);
      for (unsigned int d = dim; d-- > 0;)
        if (pa[d] != pb[d])
          return pa[d] < pb[d];
      return a.second < b.second;
    });
    const double tiny = 1e-10 * own_nodes->smallest_spacing();
    for (const auto &[xi, neighbor] : around)
      {
        const double r = xi.norm();
        if (neighbor == node || r <= tiny)
          continue; // the node itself, or its twin across a crack
        double w = 0.;
        if (members.empty())
          w = weight_off_lattice(r);
        else if (const FamilyMember<dim> *member = find_member(xi))
          w = member->weight;
        if (w > 0.)
          add_bond(node, neighbor, w, bonds);
      }
  }


  template <int dim>
  const FamilyMember<dim> *Families<dim>::find_member(const Tensor<1, dim> &xi) const
  {
    std::array<int, dim> offset;
    for (unsigned int d = 0; d < dim; ++d)
      offset[d] = static_cast<int>(std::lround(xi[d] / own_nodes->lattice()->spacing[d]));
    // The members are sorted with the last coordinate slowest.
    const auto found =
      std::lower_bound(members.begin(),
                       members.end(),
                       offset,
                       [](const FamilyMember<dim> &member, const std::array<int, dim> &wanted) {
                         return std::lexicographical_compare(member.offset.rbegin(),
                                                             member.offset.rend(),
                                                             wanted.rbegin(),
                                                             wanted.rend());
                       });
    return found != members.end() && found->offset == offset ? &*found : nullptr;
  }


  template <int dim>
  void Families<dim>::calibrate_off_lattice(const HasBonds &has_bonds)
  {
    LinearAlgebra::distributed::Vector<double> at_boundary(own_nodes->partitioner());
    for (const BoundaryShare &share : own_nodes->boundary_shares())
      at_boundary.local_element(share.node) = 1.;
    at_boundary.update_ghost_values();
    const double tiny           = 1e-10 * own_nodes->smallest_spacing();
    double       smallest_count = std::numeric_limits<double>::max(), sum = 0., n_full = 0.;
    std::vector<std::pair<unsigned int, double>> found;
    for (unsigned int i = 0; i < own_nodes->n_owned(); ++i)
      {
        if (has_bonds && !has_bonds(own_nodes->position(i)))
          continue;
        search->within(own_nodes->position(i), farthest, found);
        smallest_count  = std::min(smallest_count, static_cast<double>(found.size()) - 1.);
        const bool full = std::none_of(found.begin(), found.end(), [&](const auto &f) {
          return at_boundary.local_element(f.first) > 0.;
        });
        if (!full || !members.empty())
          continue;
        double moment = 0.;
        for (const auto &[neighbor, square] : found)
          if (square > tiny * tiny) // not the node itself, nor its twin across a crack
            moment += weight_off_lattice(std::sqrt(square)) * own_nodes->volume(neighbor) * square;
        sum += moment / (2. * dim);
        n_full += 1.;
      }
    AssertThrow(
      Utilities::MPI::min(smallest_count, own_nodes->communicator()) > 0. ||
        own_nodes->is_graded(), // nodes of merged cells are in no zone
      UserError(
        "'Horizon' in section 'Peridynamics' is " + std::to_string(delta) +
        ": some node has no neighbour within it. Choose at least twice the largest cell of the " +
        (has_bonds ? "zone." : "mesh.")));
    sum    = Utilities::MPI::sum(sum, own_nodes->communicator());
    n_full = Utilities::MPI::sum(n_full, own_nodes->communicator());
    if (parameters.calibration != Calibration::discrete || !members.empty())
      return;
    complete_families = n_full > 0.;
    factor            = complete_families ? n_full / sum : 1.;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                  \
  template double Families<dim>::weight_off_lattice(const double) const;                           \
  template void   Families<dim>::bonds_off_lattice(const unsigned int, std::vector<Bond> &) const; \
  template void   Families<dim>::calibrate_off_lattice(const HasBonds &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
