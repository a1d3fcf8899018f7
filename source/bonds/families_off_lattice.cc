// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

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
  double Families<dim>::off_lattice_weight(const double r) const
  {
    const double h        = own_nodes->smallest_spacing();
    const double fraction = parameters.volume_fraction == VolumeFraction::linear ?
                              linear_fraction(r, delta, h) :
                              (r <= delta * (1. + 1e-9) ? 1. : 0.);
    if (fraction == 0.)
      return 0.;
    const double at = parameters.kernel == KernelShape::conical &&
                          parameters.volume_fraction == VolumeFraction::linear ?
                        shifted_distance(r, delta, h) :
                        r;
    return factor * micro_conductivity(dim, parameters.kernel, parameters.kernel_exponent, delta) *
           kernel_shape(parameters.kernel, at, delta) * fraction /
           std::pow(r, static_cast<double>(parameters.kernel_exponent));
  }


  template <int dim>
  void Families<dim>::bonds_off_lattice(const unsigned int node, std::vector<Bond> &bonds) const
  {
    std::vector<std::pair<unsigned int, double>> found;
    search->within(own_nodes->position(node), farthest * (1. + 1e-9), found);
    // In the order of the relative position; of two nodes at the same place the one on the same side of a crack comes first by its crack point.
    std::sort(found.begin(), found.end(), [&](const auto &a, const auto &b) {
      const Tensor<1, dim> xa = bond_vector(node, a.first), xb = bond_vector(node, b.first);
      for (unsigned int d = dim; d-- > 0;)
        if (xa[d] != xb[d])
          return xa[d] < xb[d];
      const Point<dim> pa = own_nodes->crack_point(a.first), pb = own_nodes->crack_point(b.first);
      for (unsigned int d = dim; d-- > 0;)
        if (pa[d] != pb[d])
          return pa[d] < pb[d];
      return a.first < b.first;
    });
    const double tiny = 1e-10 * own_nodes->smallest_spacing();
    for (const auto &[neighbor, square] : found)
      {
        const Tensor<1, dim> xi = bond_vector(node, neighbor);
        const double         r  = xi.norm();
        if (neighbor == node || r <= tiny)
          continue; // the node itself, or its twin across a crack
        double w = 0.;
        if (!members.empty())
          {
            for (const FamilyMember<dim> &member : members)
              if (is_offset(xi, member))
                w = member.weight;
          }
        else
          w = off_lattice_weight(r);
        if (w > 0.)
          add_bond(node, neighbor, w, bonds);
      }
  }


  namespace
  {
    /** Positions of all nodes on the boundary, gathered on every process. */
    template <int dim>
    std::vector<Point<dim>> boundary_positions(const Nodes<dim> &nodes)
    {
      std::vector<Point<dim>> own;
      for (const BoundaryShare &share : nodes.boundary_shares())
        own.push_back(nodes.position(share.node));
      std::vector<Point<dim>> all;
      for (const auto &part : Utilities::MPI::all_gather(nodes.communicator(), own))
        all.insert(all.end(), part.begin(), part.end());
      return all;
    }
  } // namespace


  template <int dim>
  void Families<dim>::calibrate_off_lattice(const Scene<dim> &)
  {
    double     smallest_count = std::numeric_limits<double>::max();
    double     sum = 0., n_full = 0.;
    const auto boundary = boundary_positions(*own_nodes);
    std::vector<std::pair<unsigned int, double>> found;
    for (unsigned int i = 0; i < own_nodes->n_owned(); ++i)
      {
        const Point<dim> &p = own_nodes->position(i);
        search->within(p, farthest, found);
        smallest_count  = std::min(smallest_count, static_cast<double>(found.size()) - 1.);
        const bool full = std::none_of(boundary.begin(), boundary.end(), [&](const Point<dim> &b) {
          return b.distance_square(p) < farthest * farthest;
        });
        if (!full || !members.empty())
          continue;
        double moment = 0.;
        for (const auto &[neighbor, square] : found)
          if (neighbor != i)
            moment += off_lattice_weight(std::sqrt(square)) * own_nodes->volume(neighbor) * square;
        sum += moment / (2. * dim);
        n_full += 1.;
      }
    smallest_count = Utilities::MPI::min(smallest_count, own_nodes->communicator());
    sum            = Utilities::MPI::sum(sum, own_nodes->communicator());
    n_full         = Utilities::MPI::sum(n_full, own_nodes->communicator());
    AssertThrow(
      smallest_count > 0.,
      UserError(
        "'Horizon' in section 'Peridynamics' is " + std::to_string(delta) +
        ": some node has no neighbour within it. Choose at least twice the largest cell of the mesh."));
    if (parameters.calibration == Calibration::discrete && n_full > 0.)
      factor = n_full / sum;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                  \
  template double Families<dim>::off_lattice_weight(const double) const;                           \
  template void   Families<dim>::bonds_off_lattice(const unsigned int, std::vector<Bond> &) const; \
  template void   Families<dim>::calibrate_off_lattice(const Scene<dim> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
