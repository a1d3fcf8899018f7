// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/coupling.h>
#include <perideal/operators/state_coupling.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  StateCoupling<dim>::StateCoupling(Nodes<dim>       &nodes,
                                    const Scene<dim> &scene,
                                    const Zone<dim>  &given_zone)
    : bonds(nodes, scene, HaloAround::cells)
    , volumetric(scene.elasticity.model == ElasticModel::state_based && dim > 1)
  {
    const double             overlap = scene.coupling.overlap * bonds.horizon();
    const CrackHistory<dim> &history = bonds.crack_history();
    Zone<dim>                zone    = given_zone;
    zone.set_cracks(history.pieces(history.representative(0.)));
    double n_in_zone = 0.;
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        weights.push_back(zone.weight(nodes.position(i), overlap));
        n_in_zone += i < nodes.n_owned() && weights[i] > 0.;
      }
    throw_if_zone_empty(n_in_zone, nodes.communicator());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const Moduli moduli = scene.material.moduli(nodes.position(i));
        laws.push_back(scene.elasticity.model == ElasticModel::bond_based ?
                         bond_law(moduli, dim, scene.elasticity.plane) :
                         state_law(moduli, dim, scene.elasticity.plane));
      }
  }


  template <int dim>
  void StateCoupling<dim>::bonds_of(const unsigned int, std::vector<Bond> &list) const
  {
    list.clear();
  }


  template <int dim>
  void StateCoupling<dim>::visit_family(const unsigned int                         node,
                                        const bool                                 intact,
                                        const ThermalStrain                       &strain,
                                        const std::function<void(const Family &)> &visit) const
  {
    if (family_weight(node) == 0.)
      return;
    std::vector<typename Families<dim>::Bond> members;
    bonds.bonds_of(node, members, false);
    std::vector<BondOfFamily> list;
    std::vector<unsigned int> nodes{node};
    double                    q = 0.;
    for (const auto &member : members)
      {
        const unsigned int j = member.neighbor;
        if (member.intact == 0. || (member.cut && !intact))
          continue;
        const Tensor<1, dim> xi = bonds.bond_vector(node, j);
        const double         w  = member.intact / bonds.bond_conductivity(node, j);
        nodes.push_back(j);
        list.push_back({w * xi, w * xi.norm_square(), 0.5 * (strain(node) + strain(j))});
        q += w * xi.norm_square() / bonds.nodes().volume(node);
      }
    if (list.empty() || std::all_of(nodes.begin(), nodes.end(), [&](const unsigned int j) {
          return row_weight(j) == 0.;
        }))
      return;
    const double extension = family_weight(node) * laws[node].extension / q;
    Family       family;
    const auto   pass_on = [&]() {
      scale_rows(family);
      visit(family);
    };
    if (!volumetric)
      {
        for (unsigned int k = 0; k < list.size(); ++k)
          {
            set_nodes({node, nodes[k + 1]}, family);
            add_bond(list[k], 1, extension, family);
            pass_on();
          }
        return;
      }
    set_nodes(nodes, family);
    add_dilatation(list,
                   family_weight(node) * laws[node].volumetric * laws[node].dilatation /
                     (bonds.nodes().volume(node) * q * q),
                   family);
    for (unsigned int k = 0; k < list.size(); ++k)
      add_bond(list[k], k + 1, extension, family);
    pass_on();
  }


  template <int dim>
  void StateCoupling<dim>::set_nodes(const std::vector<unsigned int> &nodes, Family &family)
  {
    family.nodes          = nodes;
    family.n_bonds        = nodes.size() - 1;
    family.thermal_energy = 0.;
    family.stiffness.reinit(dim * nodes.size(), dim * nodes.size());
    family.thermal.reinit(dim * nodes.size());
  }


  template <int dim>
  void StateCoupling<dim>::add_dilatation(const std::vector<BondOfFamily> &list,
                                          const double                     factor,
                                          Family                          &family)
  {
    Tensor<1, dim> own;
    double         thermal = 0.; // g . u of a free expansion
    for (const BondOfFamily &bond : list)
      {
        own -= bond.moment;
        thermal += bond.square * bond.strain;
      }
    const auto g = [&](const unsigned int row) {
      return row < dim ? own[row] : list[row / dim - 1].moment[row % dim];
    };
    for (unsigned int a = 0; a < family.thermal.size(); ++a)
      {
        family.thermal(a) += factor * thermal * g(a);
        for (unsigned int b = 0; b < family.thermal.size(); ++b)
          family.stiffness(a, b) += factor * g(a) * g(b);
      }
    family.thermal_energy += 0.5 * factor * thermal * thermal;
  }


  template <int dim>
  void StateCoupling<dim>::add_bond(const BondOfFamily &bond,
                                    const unsigned int  place,
                                    const double        factor,
                                    Family             &family)
  {
    const unsigned int far = dim * place;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double force = factor * bond.strain * bond.moment[d];
        family.thermal(d) -= force;
        family.thermal(far + d) += force;
        for (unsigned int e = 0; e < dim; ++e)
          {
            const double stiffness = factor * bond.moment[d] * bond.moment[e] / bond.square;
            family.stiffness(d, e) += stiffness;
            family.stiffness(far + d, far + e) += stiffness;
            family.stiffness(d, far + e) -= stiffness;
            family.stiffness(far + d, e) -= stiffness;
          }
      }
    family.thermal_energy += 0.5 * factor * bond.square * bond.strain * bond.strain;
  }


  template <int dim>
  void StateCoupling<dim>::scale_rows(Family &family) const
  {
    family.thermal_energy *= row_weight(family.nodes[0]);
    for (unsigned int a = 0; a < family.thermal.size(); ++a)
      {
        const double factor = row_weight(family.nodes[a / dim]);
        family.thermal(a) *= factor;
        for (unsigned int b = 0; b < family.thermal.size() && factor != 1.; ++b)
          family.stiffness(a, b) *= factor;
      }
  }


  template <int dim>
  double StateCoupling<dim>::weight(const unsigned int node) const
  {
    return weights[node];
  }

  template <int dim>
  double StateCoupling<dim>::weight_at(const Cell &cell, const unsigned int vertex) const
  {
    return weights[bonds.nodes().partitioner()->global_to_local(cell->vertex_dof_index(vertex, 0))];
  }

  template <int dim>
  bool StateCoupling<dim>::in_zone(const unsigned int node) const
  {
    return weights[node] > 0.;
  }

  template <int dim>
  const Families<dim> &StateCoupling<dim>::families() const
  {
    return bonds;
  }

  template <int dim>
  std::size_t StateCoupling<dim>::memory_consumption() const
  {
    return bonds.memory_consumption() + weights.capacity() * sizeof(double) +
           laws.capacity() * sizeof(StateLaw);
  }


  template <int dim>
  bool StateBlending<dim>::change_cell(const Cell &cell, FullMatrix<double> &stiffness) const
  {
    double mean = 0.;
    for (const unsigned int v : cell->vertex_indices())
      mean += this->weight_at(cell, v) / cell->n_vertices();
    if (mean == 0.)
      return false;
    stiffness *= std::max(0., 1. - mean);
    return true;
  }

  template <int dim>
  double StateBlending<dim>::family_weight(const unsigned int node) const
  {
    return this->weight(node);
  }

  template <int dim>
  double StateBlending<dim>::row_weight(const unsigned int) const
  {
    return 1.;
  }

  template <int dim>
  bool StateBlending<dim>::symmetric() const
  {
    return true;
  }


  template <int dim>
  bool StateSplice<dim>::change_cell(const Cell &cell, FullMatrix<double> &stiffness) const
  {
    bool changed = false;
    for (const unsigned int v : cell->vertex_indices())
      if (const double taken = this->weight_at(cell, v); taken > 0.)
        {
          changed = true;
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int b = 0; b < stiffness.n(); ++b)
              stiffness(dim * v + d, b) *= 1. - taken;
        }
    return changed;
  }

  template <int dim>
  double StateSplice<dim>::family_weight(const unsigned int) const
  {
    return 1.;
  }

  template <int dim>
  double StateSplice<dim>::row_weight(const unsigned int node) const
  {
    return this->weight(node);
  }

  template <int dim>
  bool StateSplice<dim>::symmetric() const
  {
    return false;
  }


#define PERIDEAL_INSTANTIATE(dim)    \
  template class StateCoupling<dim>; \
  template class StateBlending<dim>; \
  template class StateSplice<dim>;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
