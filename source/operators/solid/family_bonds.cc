// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/coupling/breakable_zone.h>
#include <perideal/operators/solid/family_bonds.h>

#include <algorithm>
#include <cmath>

#include "critical_stretches.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  FamilyBonds<dim>::FamilyBonds(Coupling<dim> &coupling, const BodyParameters<dim> &body)
    : ZoneBonds<dim>(coupling.families())
    , body(body)
    , zone(*coupling.breakable())
    , stiffness(coupling.families().nodes().partitioner())
    , dilatation(stiffness)
    , tensions(stiffness)
  {}


  template <int dim>
  StateLaw FamilyBonds<dim>::law_of(const unsigned int node) const
  {
    return state_law(body.material.moduli(this->families.nodes().position(node)),
                     dim,
                     body.elasticity.plane);
  }


  template <int dim>
  std::vector<double> FamilyBonds<dim>::critical_stretches(const BodyParameters<dim> &of_body) const
  {
    return critical_stretches_of_families(
      this->families,
      of_body,
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
        q += w * this->families.neighbors().bond_vector(node, j).norm_square() /
             this->families.nodes().volume(node);
        if (beta > 0. || zone.weight_of(j) > 0.)
          list.push_back({j, zone.is_broken(node, j) ? 0. : w, member.weight, w == 0.});
      }
    const StateLaw law            = law_of(node);
    const double   factor         = q > 0. ? beta / q : 0.;
    stiffness.local_element(node) = factor * law.extension;
    dilatation.local_element(node) =
      dim == 1 || q == 0. ?
        0. :
        factor * law.volumetric * law.dilatation / (q * this->families.nodes().volume(node));
    this->set_row(node, list);
  }


  template <int dim>
  void FamilyBonds<dim>::set_rows(const std::vector<unsigned int> &of_nodes,
                                  const CrackSideFactors &)
  {
    for (const unsigned int i : of_nodes)
      set_row_of(i);
    this->finish_rows();
    stiffness.update_ghost_values();
    dilatation.update_ghost_values();
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


  template <int dim>
  void FamilyBonds<dim>::find_tensions(const double *u, const double *thermal) const
  {
    if (dim == 1)
      return;
    for (const unsigned int i : this->nodes())
      {
        double       sum = 0.;
        const double a   = dilatation.local_element(i);
        if (a != 0.)
          this->for_each(i, [&](const Bond &bond, const Tensor<1, dim> &) {
            sum += bond.strength * change(i, bond, u, thermal);
          });
        tensions.local_element(i) = a * sum;
      }
    tensions.update_ghost_values();
  }


  template <int dim>
  void FamilyBonds<dim>::add_forces_of(const std::vector<unsigned int> &of_nodes,
                                       const double                     multiple,
                                       Vector                          &y,
                                       const double                    *u,
                                       const double                    *thermal) const
  {
    find_tensions(u, thermal);
    const double *const k = stiffness.begin(), *const t = tensions.begin();
    for (const unsigned int i : of_nodes)
      {
        Tensor<1, dim> sum;
        this->for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
          const unsigned int j = bond.neighbor;
          sum += bond.strength *
                 ((k[i] + k[j]) * change(i, bond, u, thermal) / xi.norm_square() + t[i] + t[j]) *
                 xi;
        });
        for (unsigned int d = 0; d < dim; ++d)
          y.local_element(dim * i + d) -= multiple * sum[d];
      }
  }


  template <int dim>
  void FamilyBonds<dim>::add_forces_of(const std::vector<unsigned int> &of_nodes,
                                       const double                     multiple,
                                       Vector                          &y,
                                       const Vector                    &u) const
  {
    add_forces_of(of_nodes, multiple, y, u.begin(), nullptr);
  }


  template <int dim>
  Tensor<1, dim> FamilyBonds<dim>::diagonal_of(const unsigned int node) const
  {
    Tensor<1, dim> sum, own;
    this->for_each(node, [&](const Bond &bond, const Tensor<1, dim> &xi) {
      const double of_both = spring(node, bond),
                   of_tension =
                     dilatation.local_element(bond.neighbor) * bond.strength * bond.strength;
      for (unsigned int d = 0; d < dim; ++d)
        sum[d] += (of_both + of_tension) * xi[d] * xi[d];
      own += bond.strength * xi;
    });
    for (unsigned int d = 0; d < dim; ++d)
      sum[d] += dilatation.local_element(node) * own[d] * own[d];
    return sum;
  }


  /*
   * With g_n what makes the sum over the family of n of u, K has a_n g_n g_n^T of it: in the row of
   * a neighbour W |xi| times the sum over |g_n|.
   */
  template <int dim>
  void FamilyBonds<dim>::add_row_sums(std::vector<double> &sums) const
  {
    const auto size = [](const Tensor<1, dim> &v) {
      double sum = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        sum += std::abs(v[d]);
      return sum;
    };
    Vector of_tensions(stiffness.get_partitioner()); // |a_n| times the sum over |g_n|
    for (const unsigned int i : this->nodes())
      {
        double         all = 0.;
        Tensor<1, dim> own;
        this->for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
          all += bond.strength * size(xi);
          own += bond.strength * xi;
        });
        of_tensions.local_element(i) = std::abs(dilatation.local_element(i)) * (all + size(own));
      }
    of_tensions.update_ghost_values();
    for (const unsigned int i : this->nodes())
      {
        Tensor<1, dim> own;
        this->for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
          const double of_both = 2. * spring(i, bond) * size(xi) +
                                 of_tensions.local_element(bond.neighbor) * bond.strength;
          for (unsigned int d = 0; d < dim; ++d)
            sums[dim * i + d] += of_both * std::abs(xi[d]);
          own += bond.strength * xi;
        });
        for (unsigned int d = 0; d < dim; ++d)
          sums[dim * i + d] += of_tensions.local_element(i) * std::abs(own[d]);
      }
  }


  template <int dim>
  double FamilyBonds<dim>::energy(const Vector                    &u,
                                  const std::vector<unsigned int> &of_nodes,
                                  const std::vector<double>       &thermal) const
  {
    return energy(u.begin(), of_nodes, thermal.empty() ? nullptr : thermal.data());
  }


  template <int dim>
  double FamilyBonds<dim>::energy(const double                    *u,
                                  const std::vector<unsigned int> &of_nodes,
                                  const double                    *thermal) const
  {
    double sum = 0.;
    for (const unsigned int i : of_nodes)
      {
        double all = 0., squares = 0.;
        this->for_each(i, [&](const Bond &bond, const Tensor<1, dim> &xi) {
          const double c = change(i, bond, u, thermal);
          all += bond.strength * c;
          squares += bond.strength * c * c / xi.norm_square();
        });
        sum +=
          0.5 * (stiffness.local_element(i) * squares + dilatation.local_element(i) * all * all);
      }
    return sum;
  }


  template <int dim>
  double FamilyBonds<dim>::add_thermal(Vector                          &loads,
                                       const std::vector<unsigned int> &of_nodes,
                                       const std::vector<double>       &thermal,
                                       const double                     multiple) const
  {
    add_forces_of(of_nodes, -multiple, loads, nullptr, thermal.data());
    return multiple * energy(nullptr, of_nodes, thermal.data());
  }


  template <int dim>
  std::size_t FamilyBonds<dim>::memory_consumption() const
  {
    return ZoneBonds<dim>::memory_consumption() + 3 * stiffness.memory_consumption();
  }


  template class FamilyBonds<1>;
  template class FamilyBonds<2>;
  template class FamilyBonds<3>;
} // namespace PeriDeal
