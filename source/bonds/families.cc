// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/bonds/boundary_images.h>
#include <perideal/bonds/families.h>
#include <perideal/laws/crack_conductance.h>
#include <perideal/laws/interface.h>
#include <perideal/laws/kernel.h>

#include <algorithm>
#include <cmath>

#include "families_search.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * Exchanged elastic bonds do better with open tips unless they are scaled; all other elastic
     * ones are cut there.
     */
    template <int dim>
    bool cuts_at_tips(const Scene<dim> &scene, const HaloAround halo)
    {
      if (scene.general.physics == Physics::elasticity &&
          scene.cracks.through_tips == ThroughTips::automatic)
        return halo == HaloAround::nodes || scene.coupling.scheme != CouplingScheme::exchange ||
               scene.peridynamics.surface_correction == SurfaceCorrection::crack_scaling;
      return scene.cracks.cuts_bonds_at_tips(scene.peridynamics.surface_correction);
    }
  } // namespace


  template <int dim>
  Families<dim>::Families(Nodes<dim>       &nodes,
                          const Scene<dim> &scene,
                          const HaloAround  halo,
                          const HasBonds   &has_bonds)
    : own_nodes(&nodes)
    , material(scene.material)
    , parameters(scene.peridynamics)
    , history(scene.crack_history())
    , cracks_of(history.representative(0.))
    , cut_at_tips(cuts_at_tips(scene, halo))
    , cracks(make_crack_geometries(history.pieces(cracks_of, cut_at_tips)))
    , transmission(history.transmission(cracks_of))
    , contact_conductance(scene.cracks.contact_conductance)
    , delta(scene.horizon())
    , conductivity_scale(
        micro_conductivity(dim, parameters.kernel, parameters.kernel_exponent, delta))
    , on_lattice(nodes.lattice().has_value() && !nodes.has_doubled_nodes())
  {
    if (parameters.across_voids == BondsAcrossVoids::cut && scene.domain.has_voids())
      voids = &scene.domain;
    find_weights();
    // A slave of the layer extrapolation hangs on a node that may be half a spacing farther away
    // than any bond.
    const double layer  = parameters.flux_treatment == FluxTreatment::layer_extrapolation ?
                            delta + 0.5 * nodes.smallest_spacing() :
                            0.;
    const double images = completes_mesh(scene) ? halo_of_images(farthest) : 0.;
    add_halo(nodes, std::max({farthest, layer, images}), halo);
    typename Lattice<dim>::Index reach_in_sites{};
    for (const FamilyMember<dim> &member : members)
      for (unsigned int d = 0; d < dim; ++d)
        reach_in_sites[d] = std::max(reach_in_sites[d], member.offset[d]);
    // A symmetry plane of an elastic body holds its nodes, and families end at it.
    const bool mirrors = scene.general.physics != Physics::elasticity;
    AssertThrow(
      on_lattice || scene.boundary_conditions.symmetry.empty() || !mirrors,
      UserError(
        "'Symmetry' in section 'Boundary conditions' needs the lattice of a box without doubled nodes."));
    // Beside finite elements a symmetry side is an insulated one, and that exactly.
    if (halo == HaloAround::nodes && mirrors)
      outside = make_fictitious_nodes(nodes,
                                      scene.boundary_conditions,
                                      parameters.treatment,
                                      parameters.nodal_volume,
                                      reach_in_sites);
    AssertThrow(
      on_lattice || outside.empty(),
      UserError(
        "'Boundary treatment' in section 'Peridynamics': fictitious layers need a lattice without doubled "
        "nodes; use 'Mesh = pairs' in section 'Cracks', or 'none'."));
    extent = reach_in_sites;
    if (on_lattice)
      index_lattice();
    else
      {
        search = std::make_unique<Search>(nodes);
        calibrate_off_lattice(has_bonds);
      }
    find_conductivities(scene);
  }


  template <int dim>
  Families<dim>::~Families() = default;


  template <int dim>
  void Families<dim>::find_weights()
  {
    if (own_nodes->lattice())
      {
        const Tensor<1, dim> &h = own_nodes->lattice()->spacing;
        members                 = lattice_family<dim>(h,
                                      delta,
                                      parameters.kernel,
                                      parameters.kernel_exponent,
                                      parameters.volume_fraction,
                                      parameters.calibration);
        if (parameters.self_term == SelfTerm::paper)
          self_additions = self_term_family<dim>(h,
                                                 delta,
                                                 parameters.kernel,
                                                 parameters.kernel_exponent,
                                                 parameters.volume_fraction,
                                                 parameters.calibration);
        for (const FamilyMember<dim> &member : members)
          farthest = std::max(farthest, member.r);
        for (const FamilyMember<dim> &member : self_additions)
          farthest = std::max(farthest, member.r);
      }
    else
      farthest = parameters.volume_fraction == VolumeFraction::linear ?
                   delta + 0.5 * own_nodes->smallest_spacing() :
                   delta * (1. + 1e-9);
  }


  template <int dim>
  bool Families<dim>::in_table(const typename Lattice<dim>::Index &site) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (site[d] < corner[d] || site[d] >= corner[d] + extent[d])
        return false;
    return true;
  }


  template <int dim>
  std::size_t Families<dim>::site_key(const typename Lattice<dim>::Index &site) const
  {
    std::size_t key = 0;
    for (unsigned int d = dim; d-- > 0;)
      {
        Assert(site[d] >= corner[d] && site[d] < corner[d] + extent[d], ExcInternalError());
        key = key * extent[d] + (site[d] - corner[d]);
      }
    return key;
  }


  template <int dim>
  void Families<dim>::index_lattice()
  {
    const typename Lattice<dim>::Index reach_in_sites = extent;
    typename Lattice<dim>::Index       low{}, high{};
    for (unsigned int i = 0; i < own_nodes->n_local(); ++i)
      {
        const auto site = own_nodes->lattice()->index(own_nodes->position(i));
        for (unsigned int d = 0; d < dim; ++d)
          {
            low[d]  = i == 0 ? site[d] : std::min(low[d], site[d]);
            high[d] = i == 0 ? site[d] : std::max(high[d], site[d]);
          }
      }
    for (const FamilyMember<dim> &member : members)
      {
        int n_steps = 0;
        for (unsigned int d = 0; d < dim; ++d)
          n_steps += std::abs(member.offset[d]);
        if (n_steps == 1)
          nearest.push_back(member);
      }
    std::size_t n_sites = 1;
    for (unsigned int d = 0; d < dim; ++d)
      {
        corner[d] = low[d] - std::max(1, reach_in_sites[d]);
        extent[d] = high[d] + std::max(1, reach_in_sites[d]) + 1 - corner[d];
        n_sites *= extent[d];
      }
    node_of_site.assign(n_sites, numbers::invalid_unsigned_int);
    for (unsigned int i = 0; i < own_nodes->n_local(); ++i)
      node_of_site[site_key(own_nodes->lattice()->index(own_nodes->position(i)))] = i;
    // Images of ghosts may lie beyond the table, where no owned node has a bond to.
    for (unsigned int f = 0; f < outside.size(); ++f)
      if (in_table(outside[f].site))
        outside_of_site[site_key(outside[f].site)].push_back(own_nodes->n_local() + f);
  }


  template <int dim>
  Point<dim> Families<dim>::position(const unsigned int node) const
  {
    return node < own_nodes->n_local() ?
             own_nodes->position(node) :
             own_nodes->lattice()->position(outside[node - own_nodes->n_local()].site);
  }


  template <int dim>
  Tensor<1, dim> Families<dim>::bond_vector(const unsigned int node,
                                            const unsigned int neighbor) const
  {
    return position(neighbor) - position(node);
  }


  template <int dim>
  void Families<dim>::add_bond(const unsigned int node,
                               const unsigned int neighbor,
                               const double       w,
                               std::vector<Bond> &bonds) const
  {
    const bool   real   = neighbor < own_nodes->n_local();
    const double volume = real ? own_nodes->volume(neighbor) :
                                 outside[neighbor - own_nodes->n_local()].volume;
    Bond         bond;
    bond.neighbor = neighbor;
    bond.intact   = own_nodes->volume(node) * volume * w * bond_conductivity(node, neighbor);
    bond.weight   = bond.intact * kept_fraction(node, neighbor, bond.cut);
    if (!factors.empty())
      bond.weight *= bond_factor(node, neighbor);
    bonds.push_back(bond);
  }


  template <int dim>
  double Families<dim>::node_factor(const unsigned int node, const unsigned int direction) const
  {
    const unsigned int n_real = own_nodes->n_local();
    if (node >= n_real && !factors_mirrored)
      return 1.;
    return factors[(node < n_real ? node : outside[node - n_real].mirror) * n_factor_directions +
                   direction];
  }


  template <int dim>
  double Families<dim>::bond_factor(const unsigned int node, const unsigned int neighbor) const
  {
    if (n_factor_directions == 1)
      return 0.5 * (node_factor(node, 0) + node_factor(neighbor, 0));
    const Tensor<1, dim> xi  = bond_vector(node, neighbor);
    double               sum = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      sum += 0.5 * (node_factor(node, d) + node_factor(neighbor, d)) * xi[d] * xi[d];
    return sum / xi.norm_square();
  }


  template <int dim>
  void Families<dim>::bonds_on_lattice(const unsigned int                    node,
                                       const std::vector<FamilyMember<dim>> &offsets,
                                       std::vector<Bond>                    &bonds) const
  {
    const auto site = own_nodes->lattice()->index(own_nodes->position(node));
    for (const FamilyMember<dim> &member : offsets)
      {
        typename Lattice<dim>::Index other = site;
        for (unsigned int d = 0; d < dim; ++d)
          other[d] += member.offset[d];
        const std::size_t key = site_key(other);
        if (node_of_site[key] != numbers::invalid_unsigned_int)
          add_bond(node, node_of_site[key], member.weight, bonds);
        if (!outside.empty())
          if (const auto found = outside_of_site.find(key); found != outside_of_site.end())
            for (const unsigned int neighbor : found->second)
              add_bond(node, neighbor, member.weight, bonds);
      }
  }


  template <int dim>
  void Families<dim>::add_self_term(const unsigned int node, std::vector<Bond> &bonds) const
  {
    const double volume    = own_nodes->volume(node);
    unsigned int n_present = 0;
    // The missing half of a vertex on a side is a node at the same place: one term for both.
    const auto is_second_half = [&](const Bond &bond) {
      return bond.neighbor >= own_nodes->n_local() &&
             node_at(outside[bond.neighbor - own_nodes->n_local()].site) !=
               numbers::invalid_unsigned_int;
    };
    for (const Bond &bond : bonds)
      for (const FamilyMember<dim> &self : self_additions)
        if (bond.weight > 0. && !is_second_half(bond) &&
            is_offset(bond_vector(node, bond.neighbor), self))
          ++n_present;
    // In a bar the term is the mean over the neighbours that are there (Bobaru 2010, section 3).
    const double share = dim == 1 && n_present == 1 ? 2. : 1.;
    for (Bond &bond : bonds)
      for (const FamilyMember<dim> &self : self_additions)
        if (bond.intact > 0. && !is_second_half(bond) &&
            is_offset(bond_vector(node, bond.neighbor), self))
          {
            const double intact =
              share * volume * volume * self.weight * bond_conductivity(node, bond.neighbor);
            bond.weight += intact * (bond.weight / bond.intact);
            bond.intact += intact;
          }
  }


  template <int dim>
  bool Families<dim>::is_offset(const Tensor<1, dim> &xi, const FamilyMember<dim> &member) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (std::lround(xi[d] / own_nodes->lattice()->spacing[d]) != member.offset[d])
        return false;
    return true;
  }


  template <int dim>
  void Families<dim>::bonds_of(const unsigned int node,
                               std::vector<Bond> &bonds,
                               const bool         with_self_term) const
  {
    AssertIndexRange(node, own_nodes->n_owned());
    known_bonds_of(node, bonds);
    if (with_self_term && !self_additions.empty())
      add_self_term(node, bonds);
  }


  template <int dim>
  void Families<dim>::known_bonds_of(const unsigned int node, std::vector<Bond> &bonds) const
  {
    bonds.clear();
    if (on_lattice)
      bonds_on_lattice(node, members, bonds);
    else
      bonds_off_lattice(node, bonds);
  }


  template <int dim>
  bool Families<dim>::is_parted(const unsigned int node, const unsigned int neighbor) const
  {
    bool cut = false;
    if (own_nodes->has_doubled_nodes())
      kept_fraction(node, neighbor, cut);
    return cut;
  }


  template <int dim>
  void Families<dim>::nearest_bonds_of(const unsigned int node, std::vector<Bond> &bonds) const
  {
    bonds.clear();
    if (on_lattice)
      bonds_on_lattice(node, nearest, bonds);
    else
      bonds_off_lattice(node, bonds);
  }


  template <int dim>
  const Nodes<dim> &Families<dim>::nodes() const
  {
    return *own_nodes;
  }

  template <int dim>
  const std::vector<FictitiousNode<dim>> &Families<dim>::fictitious() const
  {
    return outside;
  }

  template <int dim>
  const std::vector<FamilyMember<dim>> &Families<dim>::lattice_members() const
  {
    return members;
  }

  template <int dim>
  const std::vector<FamilyMember<dim>> &Families<dim>::self_members() const
  {
    return self_additions;
  }

  template <int dim>
  double Families<dim>::horizon() const
  {
    return delta;
  }

  template <int dim>
  double Families<dim>::reach() const
  {
    return farthest;
  }

  template <int dim>
  bool Families<dim>::uniform_conductivity() const
  {
    return uniform;
  }

  template <int dim>
  bool Families<dim>::conductivity_depends_on_temperature() const
  {
    return material.conductivity.depends_on_temperature();
  }

  template <int dim>
  bool Families<dim>::corrects_every_bond() const
  {
    return parameters.surface_correction == SurfaceCorrection::energy;
  }

  template <int dim>
  bool Families<dim>::has_unique_sites() const
  {
    return on_lattice;
  }

  template <int dim>
  unsigned int Families<dim>::node_at(const typename Lattice<dim>::Index &site) const
  {
    return in_table(site) ? node_of_site[site_key(site)] : numbers::invalid_unsigned_int;
  }

  template <int dim>
  bool Families<dim>::near_crack(const unsigned int node) const
  {
    // Crack-side scaling changes the bonds of the nodes that have a bond cut: those reach once
    // farther.
    const double radius = factors.empty() ? farthest : 2. * farthest;
    return voids != nullptr ||
           std::any_of(cracks.begin(), cracks.end(), [&](const CrackGeometry<dim> &crack) {
             return crack.is_near(own_nodes->position(node), radius);
           });
  }

  template <int dim>
  void Families<dim>::set_node_factors(std::vector<double> node_factors,
                                       const unsigned int  n_directions,
                                       const bool          mirrored)
  {
    Assert(node_factors.empty() || node_factors.size() == own_nodes->n_local() * n_directions,
           ExcDimensionMismatch(node_factors.size(), own_nodes->n_local() * n_directions));
    factors             = std::move(node_factors);
    n_factor_directions = n_directions;
    factors_mirrored    = mirrored;
  }

  template <int dim>
  bool Families<dim>::symmetric() const
  {
    return self_additions.empty();
  }

  template <int dim>
  std::size_t Families<dim>::memory_consumption() const
  {
    return conductivities.capacity() * sizeof(double) + factors.capacity() * sizeof(double) +
           node_of_site.capacity() * sizeof(unsigned int) +
           outside.capacity() * sizeof(FictitiousNode<dim>);
  }

  template <int dim>
  double Families<dim>::effective_conductivity() const
  {
    if (members.empty())
      return 1.;
    const Lattice<dim> &lattice = *own_nodes->lattice();
    double              sum     = 0.;
    for (const auto *list : {&members, &self_additions})
      for (const FamilyMember<dim> &member : *list)
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double xi = member.offset[d] * lattice.spacing[d];
            sum += member.weight * lattice.cell_volume() * xi * xi / (2. * dim);
          }
    return sum;
  }

  template <int dim>
  bool Families<dim>::has_complete_families() const
  {
    return complete_families;
  }

  template class Families<1>;
  template class Families<2>;
  template class Families<3>;
} // namespace PeriDeal
