// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/operators/coupling/lattice_exchange.h>

#include <algorithm>
#include <array>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim, typename Law>
  LatticeExchange<dim, Law>::LatticeExchange(Nodes<dim>                &nodes,
                                             const BodyParameters<dim> &body,
                                             const Zone<dim>           &zone)
    : LatticeBonds<dim>(nodes, body, zone, Law::stiffness(body))
    , law(own_families, body)
  {
    law.check_form(*this);
    surplus = Law::calibrate(*this);
  }


  template <int dim, typename Law>
  void LatticeExchange<dim, Law>::bonds_of(const unsigned int node, std::vector<Bond> &list) const
  {
    list.clear();
    const bool near_crack = own_families.near_crack(node);
    this->for_each_bond(
      node,
      [&](const unsigned int neighbor, const auto &, const double strength, const bool broken) {
        Bond bond{neighbor, broken ? 0. : strength, strength, broken};
        if (near_crack && !broken)
          bond.weight *= law.kept_fraction(node, neighbor, bond.cut);
        list.push_back(bond);
      });
  }


  template <int dim, typename Law>
  bool LatticeExchange<dim, Law>::change_cell(const Cell &cell, FullMatrix<double> &stiffness) const
  {
    if (!this->is_of_lattice(cell))
      return false;
    if (leaves_nothing(cell))
      {
        stiffness = 0.;
        return true;
      }
    constexpr unsigned int    n    = Law::n_components * GeometryInfo<dim>::vertices_per_cell;
    const Site                site = own_families.nodes().lattice()->index(cell->vertex(0));
    std::array<double, n * n> taken{};
    bool                      any = false;
    this->for_each_passage(site, [&](const auto &passage, const double share) {
      any               = true;
      const auto values = corner_values<Law::n_components>(
        passage.change,
        Law::direction(this->vector_of(this->offsets[passage.offset])));
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j <= i; ++j)
          taken[i * n + j] += share * values[i] * values[j];
    });
    if (!any)
      return false;
    stiffness.add(this->stiffness_of(site), surplus.matrix);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        stiffness(i, j) -= taken[std::max(i, j) * n + std::min(i, j)];
    return true;
  }


  template <int dim, typename Law>
  bool LatticeExchange<dim, Law>::finish_cell(const Cell &cell, FullMatrix<double> &stiffness) const
  {
    if (!this->parts_cell(cell))
      return false;
    stiffness = 0.;
    return true;
  }


  template <int dim, typename Law>
  bool LatticeExchange<dim, Law>::leaves_nothing(const Cell &cell) const
  {
    if (!this->plain || !this->zone.is_everywhere() || !surplus.takes_all)
      return false;
    // All bonds that pass a cell far from the body's sides are there, with whole volumes.
    const Lattice<dim> &lattice = *own_families.nodes().lattice();
    const Site          site    = lattice.index(cell->vertex(0));
    for (unsigned int d = 0; d < dim; ++d)
      if (site[d] < this->reach[d] || site[d] + 1 + this->reach[d] >= lattice.n_sites[d])
        return false;
    return true;
  }


  template <int dim, typename Law>
  DiffusionBonds<dim> *LatticeExchange<dim, Law>::bonds_of_form()
  {
    return this->plain && this->zone.is_everywhere() ? law.conducting() : nullptr;
  }


  template <int dim, typename Law>
  void LatticeExchange<dim, Law>::take_conductivities_at(const Vector &u)
  {
    law.take_conductivities_at(u);
    LatticeBonds<dim>::take_conductivities_at(u);
  }


  template <int dim, typename Law>
  std::size_t LatticeExchange<dim, Law>::memory_consumption() const
  {
    return LatticeBonds<dim>::memory_consumption() + law.memory_consumption();
  }


#define PERIDEAL_TEMPLATES(dim)                              \
  template class LatticeExchange<dim, ConductingBonds<dim>>; \
  template class LatticeExchange<dim, ElasticBonds<dim>>;
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
