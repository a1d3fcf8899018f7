// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/operators/coupling/breakable_zone.h>
#include <perideal/operators/solid/family_bonds.h>

#include <algorithm>
#include <cmath>

#include "crossing_sums.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  FamilyBonds<dim>::FamilyBonds(Coupling<dim>             &coupling,
                                const BodyParameters<dim> &body,
                                const NodalLaw            *law)
    : ZoneBonds<dim>(coupling.families(), law)
    , zone(*coupling.breakable())
    , body(body)
  {
    coefficients.stiffness.reinit(this->families.nodes().partitioner());
    coefficients.dilatation.reinit(coefficients.stiffness);
    if (law != nullptr && law->relaxes())
      coefficients.shear.reinit(coefficients.stiffness);
  }


  template <int dim>
  StateLaw FamilyBonds<dim>::law_of(const unsigned int node) const
  {
    return state_law(body.moduli(this->families.nodes().position(node)),
                     dim,
                     body.elasticity.plane);
  }


  template <int dim>
  std::function<CrossingEnergy(unsigned int)> FamilyBonds<dim>::crossing_energies(
    const BodyParameters<dim> &) const
  {
    return PeriDeal::crossing_energies(
      this->families,
      [this](const unsigned int i) { return law_of(i); },
      dim > 1);
  }


  template <int dim>
  void FamilyBonds<dim>::set_row_of(const unsigned int node)
  {
    const double beta = zone.weight_of(node);
    double       q    = 0.;
    list.clear();
    this->families.members_of(node, family);
    for (const auto &member : family)
      {
        if (member.weight == 0.)
          continue;
        const unsigned int j = member.neighbor;
        const double       w = member.kept * member.weight;
        q += (body.material.law.softens() ? member.weight : w) *
             this->families.neighbors().bond_vector(node, j).norm_square() /
             this->families.nodes().volume(node);
        if (beta > 0. || zone.weight_of(j) > 0.)
          list.push_back({j, (1. - zone.softness(node, j).lost) * w, member.weight, w == 0.});
      }
    const StateLaw law    = law_of(node); // of the linear solid
    const double   volume = this->families.nodes().volume(node);
    coefficients.stiffness.local_element(node) =
      q > 0. ? beta * LinearPeridynamicSolid::stiffness(law, q) : 0.;
    coefficients.dilatation.local_element(node) =
      dim == 1 || q == 0. ? 0. : beta * LinearPeridynamicSolid::tension(law, q, volume, 1.);
    if (coefficients.shear.size() > 0)
      coefficients.shear.local_element(node) =
        q > 0. ? beta * LinearPeridynamicSolid::shear_tension(law, q, volume, 1.) : 0.;
    this->set_row(node, list);
  }


  template <int dim>
  void FamilyBonds<dim>::set_rows(const std::vector<unsigned int> &of_nodes,
                                  const CrackSideFactors &)
  {
    for (const unsigned int i : of_nodes)
      set_row_of(i);
    this->finish_rows();
    coefficients.stiffness.update_ghost_values();
    coefficients.dilatation.update_ghost_values();
  }


  template <int dim>
  std::vector<unsigned int> FamilyBonds<dim>::rows_at(const std::vector<unsigned int> &ends) const
  {
    std::vector<BoundingBox<dim>> boxes;
    for (const unsigned int i : ends)
      {
        const Point<dim> &p = this->families.nodes().position(i);
        boxes.push_back({{p, p}});
      }
    return this->families.neighbors().nodes_near(boxes, this->families.weights().reach());
  }


  PERIDEAL_INSTANTIATE_CLASS(class FamilyBonds);
} // namespace PeriDeal
