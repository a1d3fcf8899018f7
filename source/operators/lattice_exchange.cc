// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/operators/lattice_exchange.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The matrix of a brick cell with a conductivity tensor that is diagonal. */
    template <int dim>
    FullMatrix<double> brick_matrix(const Tensor<1, dim>          &spacing,
                                    const std::array<double, dim> &conductivities)
    {
      constexpr unsigned int n = GeometryInfo<dim>::vertices_per_cell;
      FullMatrix<double>     matrix(n, n);
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
          for (unsigned int d = 0; d < dim; ++d)
            {
              double term = conductivities[d];
              for (unsigned int e = 0; e < dim; ++e)
                {
                  const bool same = ((a >> e) & 1) == ((b >> e) & 1);
                  term *= e == d ? (same ? 1. : -1.) / spacing[e] :
                                   (same ? 1. / 3. : 1. / 6.) * spacing[e];
                }
              matrix(a, b) += term;
            }
      return matrix;
    }
  } // namespace


  template <int dim>
  LatticeExchange<dim>::LatticeExchange(Nodes<dim>       &nodes,
                                        const Scene<dim> &scene,
                                        const Zone<dim>  &zone)
    : bonds(nodes, scene, zone)
    , of_families(bonds.families, scene)
    , form(scene.peridynamics.form)
  {
    AssertThrow(
      bonds.plain || form != OperatorForm::lattice || !zone.is_everywhere(),
      UserError(
        "'Operator form = lattice' in section 'Peridynamics' is not possible here: the conductivity varies or "
        "the body has voids. Use 'auto'."));
    find_full_matrix();
  }


  template <int dim>
  void LatticeExchange<dim>::find_full_matrix()
  {
    const Lattice<dim>     &lattice = *bonds.families.nodes().lattice();
    const double            volume  = lattice.cell_volume();
    std::array<double, dim> A{};
    constexpr unsigned int  n = GeometryInfo<dim>::vertices_per_cell;
    surplus.reinit(n, n);
    for (const auto &offset : bonds.offsets)
      for (unsigned int d = 0; d < dim; ++d)
        A[d] += offset.weight * volume * std::pow(offset.site[d] * lattice.spacing[d], 2);
    bonds.for_each_full_passage([&](const auto &passage, const double share) {
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
          surplus(a, b) += share * passage.change[a] * passage.change[b];
    });
    surplus.add(-1., brick_matrix<dim>(lattice.spacing, A));
    calibrated =
      std::all_of(A.begin(), A.end(), [](const double a) { return std::abs(a - 1.) < 1e-12; });
  }


  template <int dim>
  void LatticeExchange<dim>::bonds_of(const unsigned int node, std::vector<Bond> &list) const
  {
    list.clear();
    bonds.for_each_bond(node,
                        [&](const unsigned int neighbor, const auto &, const double strength) {
                          Bond bond;
                          bond.neighbor = neighbor;
                          bond.intact   = strength;
                          bond.weight =
                            strength * of_families.kept_fraction(node, neighbor, bond.cut);
                          list.push_back(bond);
                        });
  }


  template <int dim>
  void LatticeExchange<dim>::possible_neighbors_of(const unsigned int         node,
                                                   std::vector<unsigned int> &neighbors) const
  {
    bonds.possible_neighbors_of(node, neighbors);
  }


  template <int dim>
  bool LatticeExchange<dim>::change_cell(const Cell &cell, FullMatrix<double> &stiffness) const
  {
    if (!bonds.is_of_lattice(cell))
      return false;
    if (leaves_nothing(cell))
      {
        stiffness = 0.;
        return true;
      }
    constexpr unsigned int    n    = GeometryInfo<dim>::vertices_per_cell;
    const Site                site = bonds.families.nodes().lattice()->index(cell->vertex(0));
    std::array<double, n * n> taken{};
    bool                      any = false;
    bonds.for_each_passage(site, [&](const auto &passage, const double share) {
      any = true;
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j <= i; ++j)
          taken[i * n + j] += share * passage.change[i] * passage.change[j];
    });
    if (!any)
      return false;
    stiffness.add(bonds.stiffness_of(site), surplus);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        stiffness(i, j) -= taken[std::max(i, j) * n + std::min(i, j)];
    return true;
  }


  template <int dim>
  bool LatticeExchange<dim>::leaves_nothing(const Cell &cell) const
  {
    if (!bonds.plain || !bonds.zone.is_everywhere() || !calibrated)
      return false;
    // All bonds that pass a cell far from the body's sides are there, with whole volumes.
    const Lattice<dim> &lattice = *bonds.families.nodes().lattice();
    const Site          site    = lattice.index(cell->vertex(0));
    for (unsigned int d = 0; d < dim; ++d)
      if (site[d] < bonds.reach[d] || site[d] + 1 + bonds.reach[d] >= lattice.n_sites[d])
        return false;
    return true;
  }


  template <int dim>
  bool LatticeExchange<dim>::has_form() const
  {
    return bonds.plain && bonds.zone.is_everywhere();
  }

  template <int dim>
  std::unique_ptr<BondForm> LatticeExchange<dim>::make_form()
  {
    return form == OperatorForm::stored ? make_stored_form(of_families) :
                                          make_lattice_form(of_families);
  }

  template <int dim>
  void LatticeExchange<dim>::set_form_factors(std::vector<double> factors)
  {
    of_families.factors().set(std::move(factors), 1, true);
  }

  template <int dim>
  bool LatticeExchange<dim>::symmetric() const
  {
    return true;
  }

  template <int dim>
  std::vector<BoundingBox<dim>> LatticeExchange<dim>::joining_by(const double time) const
  {
    return bonds.joining_by(time);
  }

  template <int dim>
  void LatticeExchange<dim>::set_cracks_of(const double time)
  {
    bonds.set_cracks_of(time);
  }

  template <int dim>
  bool LatticeExchange<dim>::in_zone(const unsigned int node) const
  {
    return bonds.in_zone(node);
  }

  template <int dim>
  const Families<dim> &LatticeExchange<dim>::families() const
  {
    return bonds.families;
  }

  template <int dim>
  std::size_t LatticeExchange<dim>::memory_consumption() const
  {
    return bonds.memory_consumption() + of_families.memory_consumption();
  }


  template class LatticeExchange<1>;
  template class LatticeExchange<2>;
  template class LatticeExchange<3>;
} // namespace PeriDeal
