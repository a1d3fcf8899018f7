// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/smallest_eigenvalue.h>
#include <perideal/operators/coupling/coupling.h>
#include <perideal/operators/coupling/nodal_family.h>
#include <perideal/operators/coupling/state_coupling.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  StateCoupling<dim>::StateCoupling(Nodes<dim>                &nodes,
                                    const BodyParameters<dim> &body,
                                    const Zone<dim>           &zone,
                                    const CouplingScheme       scheme)
    : WeightedCoupling<dim>(nodes, body, zone, scheme)
    , nodal(body.elasticity.is_correspondence() ? &body : nullptr)
  {
    if (body.peridynamics.completes_families())
      {
        symmetry_sides = body.boundary_conditions.symmetry;
        throw_if_narrow(own_families);
        extension.emplace(own_families, beyond_sides(body));
      }
    if (lists_bonds(body) && !has_nodal_law(body))
      {
        // What FamilyZone looks at around the bonds of the corners of a cell, from its centre.
        const double horizon = own_families.weights().horizon(),
                     around  = horizon + 1.5 * body.domain.spacing().norm();
        breaks.emplace(own_families,
                       weights_now,
                       std::max(body.coupling.width * horizon, around),
                       this->overlap);
      }
    find_nodes_that_act();
    laws.resize(nodes.n_owned());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      if (acts[i] && nodal == nullptr)
        laws[i] = state_law(body.moduli(nodes.position(i)), dim, body.elasticity.plane);
  }


  template <int dim>
  void StateCoupling<dim>::find_nodes_that_act()
  {
    // A family reaches the zone if its node is in one of the zone's families; once cracks have
    // grown.
    const Nodes<dim> &nodes = own_families.nodes();
    acts.assign(nodes.n_owned(), false);
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      if (weights_at_end[i] > 0.)
        {
          if (i < nodes.n_owned())
            acts[i] = true;
          const auto center = site_of(i);
          for (const FamilyMember<dim> &member : own_families.weights().members())
            {
              auto site = center;
              for (unsigned int d = 0; d < dim; ++d)
                site[d] += member.offset[d];
              if (const unsigned int j = own_families.neighbors().node_at(site);
                  j < nodes.n_owned())
                acts[j] = true;
            }
        }
  }


  template <int dim>
  void StateCoupling<dim>::bonds_of(const unsigned int, std::vector<Bond> &list) const
  {
    list.clear();
  }

  template <int dim>
  void StateCoupling<dim>::possible_neighbors_of(const unsigned int,
                                                 std::vector<unsigned int> &neighbors) const
  {
    neighbors.clear();
  }

  template <int dim>
  void StateCoupling<dim>::visit_family(const unsigned int                         node,
                                        const bool                                 intact,
                                        const ThermalStrain                       &strain,
                                        const std::function<void(const Family &)> &visit) const
  {
    std::vector<BondOfFamily> list;
    Family                    family;
    if (!find_family(weights_now, node, intact, strain, family.nodes, list))
      return;
    if (nodal != nullptr)
      {
        add_nodal(list, strain, family);
        scale_rows(family);
        visit(family);
        return;
      }
    double q = 0.;
    for (const BondOfFamily &bond : list)
      q += bond.square / own_families.nodes().volume(node);
    const double weight = this->weighting.of_family(weights_now[node]),
                 spring = weight * laws[node].extension / q;
    if (dim == 1) // no dilatation: rows of single bonds reach one horizon, not two
      {
        for (BondOfFamily &bond : list)
          {
            Family alone;
            for (Part &part : bond.parts)
              {
                alone.nodes.push_back(family.nodes[part.place]);
                part.place = alone.nodes.size() - 1;
              }
            set_size(alone);
            add_bond(bond, spring, alone);
            scale_rows(alone);
            visit(alone);
          }
        return;
      }
    set_size(family);
    for (const BondOfFamily &bond : list)
      add_bond(bond, spring, family);
    add_dilatation(list,
                   weight * laws[node].volumetric * laws[node].dilatation /
                     (own_families.nodes().volume(node) * q * q),
                   family);
    scale_rows(family);
    visit(family);
  }


  template <int dim>
  void StateCoupling<dim>::visit_nodes_of_family(
    const unsigned int                         node,
    const std::function<void(const Family &)> &visit) const
  {
    std::vector<BondOfFamily> list;
    Family                    family;
    if (!find_family(weights_at_end, node, true, {}, family.nodes, list))
      return;
    if (dim == 1)
      {
        for (const BondOfFamily &bond : list)
          {
            Family alone;
            for (const Part &part : bond.parts)
              alone.nodes.push_back(family.nodes[part.place]);
            find_rows(weights_at_end, alone);
            visit(alone);
          }
        return;
      }
    find_rows(weights_at_end, family);
    visit(family);
  }


  template <int dim>
  bool StateCoupling<dim>::find_family(const NodeWeights<dim>    &weights,
                                       const unsigned int         node,
                                       const bool                 intact,
                                       const ThermalStrain       &strain,
                                       std::vector<unsigned int> &nodes,
                                       std::vector<BondOfFamily> &list) const
  {
    if (!acts[node] || this->weighting.of_family(weights[node]) == 0.)
      return false;
    nodes.assign(1, node);
    add_neighbors(intact, strain, nodes, list);
    if (extension)
      add_fictitious(strain, nodes, list);
    return !list.empty() && std::any_of(nodes.begin(), nodes.end(), [&](const unsigned int j) {
      return this->weighting.of_row(weights[j]) > 0.;
    });
  }


  template <int dim>
  std::string StateCoupling<dim>::fault_of(const unsigned int node) const
  {
    // An energy of correspondence needs a gradient, whatever its weight.
    if (dim == 1 || weights_now[node] == 0. || (nodal == nullptr && weights_now[node] < 1.))
      return {};
    std::vector<BondOfFamily> list;
    std::vector<unsigned int> nodes{node};
    add_neighbors(false, {}, nodes, list);
    SymmetricTensor<2, dim> shape;
    for (const BondOfFamily &bond : list)
      shape += symmetrize(outer_product(bond.parts[1].moment, bond.parts[1].moment)) / bond.square;
    if (list.empty())
      return " is isolated: no bond of it is left.";
    if (smallest_eigenvalue(shape) < 1e-9 * trace(shape))
      return " has bonds in one line or plane only, across which nothing holds it.";
    return {};
  }


  template <int dim>
  void StateCoupling<dim>::add_neighbors(const bool                 intact,
                                         const ThermalStrain       &strain,
                                         std::vector<unsigned int> &nodes,
                                         std::vector<BondOfFamily> &list) const
  {
    const unsigned int                          own        = nodes[0];
    const double                                own_strain = strain ? strain(own) : 0.;
    std::vector<typename Families<dim>::Member> members;
    own_families.members_of(own, members);
    typename FictitiousExtension<dim>::Site site;
    for (const auto &member : members)
      {
        const unsigned int j = member.neighbor;
        if (member.weight == 0. || (member.kept == 0. && !intact))
          continue;
        const Tensor<1, dim> xi = own_families.neighbors().bond_vector(own, j);
        double               w  = intact ? member.weight : member.kept * member.weight;
        if (extension && !extension->is_inside(site_of(j)) && extension->find(site_of(j), site))
          w *= site.volume /
               own_families.nodes().volume(j); // with what is missing of a node on a side
        list.push_back({{{0, -w * xi}, {static_cast<unsigned int>(nodes.size()), w * xi}},
                        w * xi.norm_square(),
                        strain ? 0.5 * (own_strain + strain(j)) : 0.,
                        weights_now[own] == 0. ? 0. :
                        weights_now[j] == 0.   ? 1. :
                                                 0.5});
        nodes.push_back(j);
      }
  }


  template <int dim>
  void StateCoupling<dim>::add_fictitious(const ThermalStrain       &strain,
                                          std::vector<unsigned int> &nodes,
                                          std::vector<BondOfFamily> &list) const
  {
    const unsigned int                      own        = nodes[0];
    const double                            own_strain = strain ? strain(own) : 0.;
    const auto                              center     = site_of(own);
    const Lattice<dim>                     &lattice    = *own_families.nodes().lattice();
    typename FictitiousExtension<dim>::Site site;
    for (const FamilyMember<dim> &member : own_families.weights().members())
      {
        auto index   = center;
        bool outside = false;
        for (unsigned int d = 0; d < dim; ++d)
          {
            index[d] += member.offset[d];
            outside = outside || index[d] < 0 || index[d] >= lattice.n_sites[d];
          }
        if (!outside || !extension->find(index, site))
          continue;
        const double   w = own_families.nodes().volume(own) * site.volume * member.weight;
        Tensor<1, dim> xi;
        for (unsigned int d = 0; d < dim; ++d)
          xi[d] = member.offset[d] * lattice.spacing[d];
        BondOfFamily bond{{{0, -w * xi}}, w * xi.norm_square(), 0.5 * own_strain, 0.};
        bool reached = true; // no crack separates the node from those that the other one follows
        for (std::size_t k = 0; k < site.terms.size() && reached; ++k)
          {
            const auto &term  = site.terms[k];
            const auto  place = std::find(nodes.begin(), nodes.end(), term.node);
            Part        part{static_cast<unsigned int>(place - nodes.begin()), w * xi};
            for (unsigned int d = 0; d < dim; ++d)
              part.moment[d] *= term.of_component(d);
            bond.parts.push_back(part);
            if (strain)
              bond.strain += 0.5 * term.factor * strain(term.node);
            reached = place != nodes.end();
          }
        if (reached)
          list.push_back(bond);
      }
  }


  template <int dim>
  typename Lattice<dim>::Index StateCoupling<dim>::site_of(const unsigned int node) const
  {
    return own_families.nodes().lattice()->index(own_families.nodes().position(node));
  }


  template <int dim>
  void StateCoupling<dim>::set_size(Family &family)
  {
    const unsigned int n = dim * family.nodes.size();
    family.stiffness.reinit(n, n);
    family.thermal.reinit(n);
  }


  template <int dim>
  void StateCoupling<dim>::add_square(const std::vector<Part> &parts,
                                      const double             factor,
                                      const double             thermal,
                                      Family                  &family)
  {
    for (const Part &row : parts)
      for (unsigned int d = 0; d < dim; ++d)
        {
          family.thermal(dim * row.place + d) += factor * thermal * row.moment[d];
          for (const Part &column : parts)
            for (unsigned int e = 0; e < dim; ++e)
              family.stiffness(dim * row.place + d, dim * column.place + e) +=
                factor * row.moment[d] * column.moment[e];
        }
    family.thermal_energy += 0.5 * factor * thermal * thermal;
  }


  template <int dim>
  void StateCoupling<dim>::add_bond(const BondOfFamily &bond, const double factor, Family &family)
  {
    add_square(bond.parts, factor / bond.square, bond.square * bond.strain, family);
    family.n_bonds += bond.count;
  }


  template <int dim>
  void StateCoupling<dim>::add_dilatation(const std::vector<BondOfFamily> &list,
                                          const double                     factor,
                                          Family                          &family)
  {
    std::vector<Part> sum(family.nodes.size());
    for (unsigned int k = 0; k < sum.size(); ++k)
      sum[k].place = k;
    double thermal = 0.;
    for (const BondOfFamily &bond : list)
      {
        for (const Part &part : bond.parts)
          sum[part.place].moment += part.moment;
        thermal += bond.square * bond.strain;
      }
    add_square(sum, factor, thermal, family);
  }


  template <int dim>
  void StateCoupling<dim>::add_nodal(const std::vector<BondOfFamily> &list,
                                     const ThermalStrain             &strain,
                                     Family                          &family) const
  {
    const Nodes<dim>                            &nodes = own_families.nodes();
    const unsigned int                           node  = family.nodes[0];
    std::vector<typename NodalFamily<dim>::Bond> bonds;
    set_size(family);
    for (const BondOfFamily &bond : list)
      {
        const Tensor<1, dim> &moment = bond.parts[1].moment;
        bonds.push_back({moment, moment.norm_square() / bond.square});
        family.n_bonds += bond.count;
      }
    NodalFamily<dim>(*nodal, nodes.position(node))
      .add_to(family,
              bonds,
              nodes.volume(node),
              strain ? strain(node) : 0.,
              this->weighting.of_family(weights_now[node]));
  }


  template <int dim>
  void StateCoupling<dim>::find_rows(const NodeWeights<dim> &weights, Family &family) const
  {
    for (const unsigned int j : family.nodes)
      family.has_row.push_back(this->weighting.of_row(weights[j]) > 0.);
  }


  template <int dim>
  void StateCoupling<dim>::scale_rows(Family &family) const
  {
    family.thermal_energy *= this->weighting.of_row(weights_now[family.nodes[0]]);
    find_rows(weights_now, family);
    for (unsigned int a = 0; a < family.thermal.size(); ++a)
      {
        const double factor = this->weighting.of_row(weights_now[family.nodes[a / dim]]);
        family.thermal(a) *= factor;
        for (unsigned int b = 0; b < family.thermal.size() && factor != 1.; ++b)
          family.stiffness(a, b) *= factor;
      }
  }


  template <int dim>
  std::size_t StateCoupling<dim>::memory_of_bonds() const
  {
    return laws.capacity() * sizeof(StateLaw) + acts.capacity() / 8 +
           (breaks ? breaks->memory_consumption() : 0);
  }


  PERIDEAL_INSTANTIATE_CLASS(class StateCoupling);
} // namespace PeriDeal
