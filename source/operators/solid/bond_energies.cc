// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/laws/volume_fraction.h>
#include <perideal/operators/solid/bond_energies.h>

#include <array>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  BondEnergies<dim>::BondEnergies(const BreakableBonds<dim> &bonds, const VolumeFraction fraction)
    : families(bonds.families)
    , fraction(fraction)
    , limits(bonds, factors_of(bonds), false)
    , least(bonds.families.nodes().n_local(), 0.)
  {
    for (const FamilyMember<dim> &member : families.weights().members())
      {
        Tensor<1, dim> xi;
        for (unsigned int d = 0; d < dim; ++d)
          xi[d] = member.offset[d] * families.nodes().lattice()->spacing[d];
        squares.push_back(member.weight * member.r * member.r / part(xi));
      }
  }


  template <int dim>
  double BondEnergies<dim>::part(const Tensor<1, dim> &xi) const
  {
    const double delta = families.weights().horizon();
    if (fraction == VolumeFraction::none)
      return 1.;
    if (fraction == VolumeFraction::linear)
      return linear_fraction(xi.norm(), delta, families.nodes().smallest_spacing());
    if (!families.nodes().lattice())
      return 1.;
    std::array<double, dim> center, edges;
    for (unsigned int d = 0; d < dim; ++d)
      {
        center[d] = xi[d];
        edges[d]  = families.nodes().lattice()->spacing[d];
      }
    return exact_fraction<dim>(center, edges, delta);
  }


  template <int dim>
  double BondEnergies<dim>::square_over_volumes(const unsigned int i, const unsigned int j) const
  {
    const KernelWeights<dim> &weights = families.weights();
    const Tensor<1, dim>      xi      = families.neighbors().bond_vector(i, j);
    if (!families.nodes().lattice())
      return part(xi) > 0. ? weights.of_length(xi.norm()) * xi.norm_square() / part(xi) : 0.;
    const FamilyMember<dim> *const member = weights.find(xi);
    return member != nullptr ? squares[member - weights.members().data()] : 0.;
  }


  /** w_c over the fracture energy. */
  template <int dim>
  std::vector<double> BondEnergies<dim>::factors_of(const BreakableBonds<dim> &bonds) const
  {
    const Nodes<dim>                           &nodes = families.nodes();
    std::vector<typename Families<dim>::Member> family;
    Vector                                      factors(nodes.partitioner());
    // What a bond adds to the sum over half a family, mean over the axes.
    const auto crossing_of = [&](const Tensor<1, dim> &xi, const double volume) {
      double sum = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        sum += 0.5 * std::abs(xi[d]) * part(xi) * volume / dim;
      return sum;
    };
    double of_lattice = 0.;
    for (const FamilyMember<dim> &member : families.weights().members())
      {
        Tensor<1, dim> xi;
        for (unsigned int d = 0; d < dim; ++d)
          xi[d] = member.offset[d] * nodes.lattice()->spacing[d];
        of_lattice += crossing_of(xi, nodes.lattice()->cell_volume());
      }
    // Of meshes the largest family is whole; of smaller ones, at surfaces, planes cut as much.
    std::vector<double> of_families(nodes.n_owned(), 1.);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        double crossing = of_lattice;
        if (!nodes.lattice())
          {
            families.members_of(i, family);
            of_families[i] = 0.;
          }
        for (const auto &bond : family)
          {
            const Tensor<1, dim> xi     = families.neighbors().bond_vector(i, bond.neighbor);
            const double         volume = nodes.volume(bond.neighbor);
            crossing += crossing_of(xi, volume);
            of_families[i] += families.weights().of_length(xi.norm()) * volume;
          }
        factors.local_element(i) = 1. / crossing;
      }
    double most = 0.;
    for (const double one : of_families)
      most = std::max(most, one);
    most = Utilities::MPI::max(most, nodes.communicator());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      factors.local_element(i) *= of_families[i] / most;
    factors.update_ghost_values();
    std::vector<double> list = scatter_factors(bonds); // of stretches
    for (unsigned int i = 0; i < list.size(); ++i)
      list[i] *= list[i] * factors.local_element(i);
    return list;
  }


  PERIDEAL_INSTANTIATE_CLASS(class BondEnergies);
} // namespace PeriDeal
