// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/solid_sums.h>

#include <type_traits>

#include "../lattice/state_lattice.h"
#include "change_along.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  SolidSums<dim>::SolidSums(const Families<dim>  &families,
                            const BondEnds<dim>  &ends,
                            const BondTable<dim> &bonds,
                            const NodeLaws<dim>  &laws)
    : families(families)
    , ends(ends)
    , bonds(bonds)
    , laws(laws)
  {}


  template <int dim>
  SolidSums<dim>::~SolidSums() = default;


  template <int dim>
  void SolidSums<dim>::take_lattice(const bool of_unit)
  {
    c_is_1 = of_unit;
    if (bonds.body.units.empty())
      return;
    const StateLaw      law = laws.reference();
    const double        q   = bonds.complete_weighted;
    LatticeCoefficients coefficients;
    coefficients.stiffness  = law.extension / q;
    const auto c            = [&](const StateLaw &of) { return c_is_1 ? 1. : of.volumetric; };
    coefficients.dilatation = laws.volumetric ? c(law) * law.dilatation / (q * q) : 0.;
    for (unsigned int i = 0; i < families.nodes().n_local(); ++i)
      {
        const double own = laws.weighted.local_element(i);
        coefficients.excesses.push_back(0.5 * (laws.stiffness(i) / coefficients.stiffness - 1.));
        if (laws.volumetric && i < families.nodes().n_owned())
          coefficients.dilatations.push_back(c(laws[i]) * laws[i].dilatation / (own * own));
      }
    std::vector<bool> computed;
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      computed.push_back(bonds.is_on_lattice(i));
    lattice = std::make_unique<StateLattice<dim>>(families, coefficients, computed);
  }


  template <int dim>
  bool SolidSums<dim>::is_regular(const unsigned int i) const
  {
    return lattice && bonds.is_on_lattice(i) && lattice->is_regular(i);
  }


  // Inline, with what all bonds of a row have looked up once: rates of whole applications at
  // surfaces go with it.
  template <int dim>
  template <bool is_beyond, typename Visit>
  inline void SolidSums<dim>::visit_parts(const BondRows<dim> &rows,
                                          const std::size_t    row,
                                          const Visit         &visit) const
  {
    const std::size_t begin = rows.starts[row], end = rows.starts[row + 1];
    if (!rows.is_packed())
      {
        if (!rows.nonlinear.slopes.empty())
          for (std::size_t k = begin; k < end; ++k)
            visit(rows.neighbors[k],
                  rows.moments[k],
                  rows.nonlinear.slopes[k] * rows.springs[k],
                  1.);
        else
          for (std::size_t k = begin; k < end; ++k)
            visit(rows.neighbors[k], rows.moments[k], laws.slope * rows.springs[k], 1.);
        return;
      }
    const unsigned int i      = rows.nodes[row];
    const double       own    = laws.stiffness(i);
    const double       volume = families.nodes().volume(i);
    for (std::size_t k = begin; k < end; ++k)
      if (rows.codes[k] != BondCode::gone)
        {
          const UnitBond<dim> &unit = rows.units[BondCode::number(rows.codes[k])];
          const unsigned int   j    = rows.neighbors[k];
          // Of spring and W x e volumes drop out.
          if constexpr (is_beyond)
            visit(j, unit.moment, own / unit.weight, volume * (*ends.images)[ends.image(j)].volume);
          else
            visit(j,
                  unit.moment,
                  (own + laws.stiffness(j)) / unit.weight,
                  bonds.volumes_of(rows, i, k));
        }
  }


  template <int dim>
  void SolidSums<dim>::find_tensions(double *tau, const double *u) const
  {
    if (lattice)
      lattice->dilatation_forces(tau, u);
    ends.find(u);
    const auto sum_of = [&](const auto           is_beyond,
                            const BondRows<dim> &rows,
                            const std::size_t    row,
                            const auto          &value) {
      double              sum = 0.;
      const double *const own = u + dim * rows.nodes[row];
      visit_parts<decltype(is_beyond)::value>(
        rows,
        row,
        [&](const unsigned int j, const Tensor<1, dim> &p, const double, const double w) {
          sum += w * change_along(p, own, value(j));
        });
      return c_is_1 ? laws.unit_tension(rows.nodes[row], sum) :
                      laws.tangent_tension(rows.nodes[row], sum);
    };
    for (std::size_t row = 0; row < bonds.body.nodes.size(); ++row)
      tau[bonds.body.nodes[row]] =
        sum_of(std::false_type(), bonds.body, row, [u](const unsigned int j) {
          return u + dim * j;
        });
    for (std::size_t row = 0; row < bonds.beyond.nodes.size(); ++row)
      tau[bonds.beyond.nodes[row]] +=
        sum_of(std::true_type(), bonds.beyond, row, [&](const unsigned int j) {
          return ends.images->value(ends.image(j));
        });
  }


  template <int dim>
  void SolidSums<dim>::find_forces(Vector &y, const double *u, const double *tau) const
  {
    if (lattice)
      lattice->forces(y.begin(), u, tau);
    const auto tension = [tau](const unsigned int i) { return tau != nullptr ? tau[i] : 0.; };
    // Of a row; value(j), far_tension(j) of the far ends; take(j, force) is told each bond's.
    const auto force_of = [&](const auto           is_beyond,
                              const BondRows<dim> &rows,
                              const std::size_t    row,
                              const auto          &value,
                              const auto          &far_tension,
                              const auto          &take) {
      const unsigned int i   = rows.nodes[row];
      const double       own = tension(i);
      Tensor<1, dim>     sum;
      visit_parts<decltype(is_beyond)::value>(
        rows,
        row,
        [&](const unsigned int j, const Tensor<1, dim> &p, const double s, const double w) {
          const double         size  = LinearPeridynamicSolid::force(s,
                                                            change_along(p, u + dim * i, value(j)),
                                                            own + far_tension(j));
          const Tensor<1, dim> force = (size * w) * p;
          sum += force;
          take(j, force);
        });
      return sum;
    };
    for (std::size_t row = 0; row < bonds.body.nodes.size(); ++row)
      {
        const Tensor<1, dim> force = force_of(
          std::false_type(),
          bonds.body,
          row,
          [u](const unsigned int j) { return u + dim * j; },
          tension,
          [](const unsigned int, const Tensor<1, dim> &) {});
        for (unsigned int d = 0; d < dim; ++d)
          y.local_element(dim * bonds.body.nodes[row] + d) = -force[d];
      }
    if (!ends.images)
      return;
    const FictitiousImages<dim> &images = *ends.images;
    if (tau == nullptr) // else they have been found
      images.find(u);
    images.begin_forces();
    for (std::size_t row = 0; row < bonds.beyond.nodes.size(); ++row)
      {
        const Tensor<1, dim> force = force_of(
          std::true_type(),
          bonds.beyond,
          row,
          [&](const unsigned int j) { return images.value(ends.image(j)); },
          [](const unsigned int) { return 0.; },
          [&](const unsigned int j, const Tensor<1, dim> &of_bond) {
            images.pull(ends.image(j), of_bond);
          });
        for (unsigned int d = 0; d < dim; ++d)
          y.local_element(dim * bonds.beyond.nodes[row] + d) -= force[d];
      }
    images.pass_on(y);
  }


  template <int dim>
  void SolidSums<dim>::find_forces_of_tensions(Vector &y, const double *tau) const
  {
    if (lattice)
      lattice->forces(y.begin(), nullptr, tau);
    for (std::size_t row = 0; row < bonds.body.nodes.size(); ++row)
      {
        const unsigned int i = bonds.body.nodes[row];
        Tensor<1, dim>     force;
        visit_parts<false>(
          bonds.body,
          row,
          [&](const unsigned int j, const Tensor<1, dim> &p, const double, const double w) {
            force += ((tau[i] + tau[j]) * w) * p;
          });
        for (unsigned int d = 0; d < dim; ++d)
          y.local_element(dim * i + d) = -force[d];
      }
    if (!ends.images)
      return;
    ends.images->begin_forces();
    for (std::size_t row = 0; row < bonds.beyond.nodes.size(); ++row)
      {
        const unsigned int i = bonds.beyond.nodes[row];
        visit_parts<true>(
          bonds.beyond,
          row,
          [&](const unsigned int j, const Tensor<1, dim> &p, const double, const double w) {
            const Tensor<1, dim> of_bond = (tau[i] * w) * p;
            for (unsigned int d = 0; d < dim; ++d)
              y.local_element(dim * i + d) -= of_bond[d];
            ends.images->pull(ends.image(j), of_bond);
          });
      }
    ends.images->pass_on(y);
  }


  template <int dim>
  std::size_t SolidSums<dim>::memory_consumption() const
  {
    return lattice ? lattice->memory_consumption() : 0;
  }


  PERIDEAL_INSTANTIATE_CLASS(class SolidSums);
} // namespace PeriDeal
