// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/bonds/diffusion_bonds.h>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  DiffusionBonds<dim>::DiffusionBonds(Families<dim> &families, const BodyParameters<dim> &body)
    : own_families(families)
    , topology(families.neighbors())
    , material(topology,
               body.material,
               body.initial_and_source.initial_value,
               body.material.uniform_conductivity() ?
                 typename BondConductivities<dim>::SidePoints() :
                 families.cracks().side_points())
    , node_factors(topology)
    , corrects_all(body.peridynamics.surface_correction == SurfaceCorrection::energy)
  {}


  template <int dim>
  void DiffusionBonds<dim>::add_bond(const unsigned int node,
                                     const unsigned int neighbor,
                                     const double       w,
                                     std::vector<Bond> &bonds) const
  {
    Bond bond;
    bond.neighbor = neighbor;
    bond.intact =
      topology.volume(node) * topology.volume(neighbor) * w * material.of_bond(node, neighbor);
    bond.weight = bond.intact * kept_fraction(node, neighbor, bond.cut);
    if (!node_factors.empty() && (corrects_all || !bond.cut)) // crack scaling leaves what crosses
      bond.weight *= node_factors.of_bond(node, neighbor);
    bonds.push_back(bond);
  }


  template <int dim>
  void DiffusionBonds<dim>::add_self_term(const unsigned int node, std::vector<Bond> &bonds) const
  {
    const double volume    = topology.volume(node);
    unsigned int n_present = 0;
    // The missing half of a vertex on a side is a node at the same place: one term for both.
    const auto is_second_half = [&](const Bond &bond) {
      const unsigned int n_real = topology.nodes().n_local();
      return !topology.is_real(bond.neighbor) &&
             topology.node_at(topology.outside()[bond.neighbor - n_real].site) !=
               numbers::invalid_unsigned_int;
    };
    for (const Bond &bond : bonds)
      for (const FamilyMember<dim> &self : topology.weights().self_members())
        if (bond.weight > 0. && !is_second_half(bond) &&
            topology.weights().is_offset(topology.bond_vector(node, bond.neighbor), self))
          ++n_present;
    // In a bar the term is the mean over the neighbours that are there (Bobaru 2010, section 3).
    const double share = dim == 1 && n_present == 1 ? 2. : 1.;
    for (Bond &bond : bonds)
      for (const FamilyMember<dim> &self : topology.weights().self_members())
        if (bond.intact > 0. && !is_second_half(bond) &&
            topology.weights().is_offset(topology.bond_vector(node, bond.neighbor), self))
          {
            const double intact =
              share * volume * volume * self.weight * material.of_bond(node, bond.neighbor);
            bond.weight += intact * (bond.weight / bond.intact);
            bond.intact += intact;
          }
  }


  template <int dim>
  void DiffusionBonds<dim>::bonds_of(const unsigned int node,
                                     std::vector<Bond> &bonds,
                                     const bool         with_self_term) const
  {
    AssertIndexRange(node, nodes().n_owned());
    known_bonds_of(node, bonds);
    if (with_self_term && !symmetric())
      add_self_term(node, bonds);
  }


  template <int dim>
  void DiffusionBonds<dim>::known_bonds_of(const unsigned int node, std::vector<Bond> &bonds) const
  {
    bonds.clear();
    topology.for_each(node, [&](const unsigned int neighbor, const double w) {
      add_bond(node, neighbor, w, bonds);
    });
  }


  template <int dim>
  void DiffusionBonds<dim>::nearest_bonds_of(const unsigned int node,
                                             std::vector<Bond> &bonds) const
  {
    bonds.clear();
    topology.for_each_nearest(node, [&](const unsigned int neighbor, const double w) {
      add_bond(node, neighbor, w, bonds);
    });
  }


  template <int dim>
  bool DiffusionBonds<dim>::near_crack(const unsigned int node) const
  {
    // Crack-side scaling changes the bonds of the nodes that have a bond cut: those reach once
    // farther.
    return cracks().is_near(node, (node_factors.empty() ? 1. : 2.) * weights().reach());
  }


  template <int dim>
  double DiffusionBonds<dim>::kept_fraction(const unsigned int node,
                                            const unsigned int neighbor,
                                            bool              &cut,
                                            const bool         of_way) const
  {
    return cracks().kept_fraction(node, neighbor, material, cut, of_way);
  }


  template <int dim>
  std::size_t DiffusionBonds<dim>::memory_consumption() const
  {
    return material.memory_consumption() + node_factors.memory_consumption();
  }


  template <int dim>
  const Nodes<dim> &DiffusionBonds<dim>::nodes() const
  {
    return topology.nodes();
  }

  template <int dim>
  const KernelWeights<dim> &DiffusionBonds<dim>::weights() const
  {
    return topology.weights();
  }

  template <int dim>
  BondConductivities<dim> &DiffusionBonds<dim>::conductivities()
  {
    return material;
  }

  template <int dim>
  const CrackSet<dim> &DiffusionBonds<dim>::cracks() const
  {
    return own_families.cracks();
  }

  template <int dim>
  CrackSet<dim> &DiffusionBonds<dim>::cracks()
  {
    return own_families.cracks();
  }

  template <int dim>
  NodeFactors<dim> &DiffusionBonds<dim>::factors()
  {
    return node_factors;
  }

  template <int dim>
  bool DiffusionBonds<dim>::symmetric() const
  {
    return weights().self_members().empty();
  }

  PERIDEAL_INSTANTIATE_CLASS(class DiffusionBonds);
} // namespace PeriDeal
