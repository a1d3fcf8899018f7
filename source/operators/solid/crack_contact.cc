// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/operators/solid/crack_contact.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "change_along.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** M^{-1} b; nothing where M is not regular. */
    template <int dim>
    Tensor<1, dim> solved(const Tensor<2, dim> &m, const Tensor<1, dim> &b)
    {
      constexpr double tiny = 1e-6;
      return std::abs(determinant(m)) > tiny * std::pow(m.norm(), dim) ? invert(m) * b :
                                                                         Tensor<1, dim>();
    }
  } // namespace


  template <int dim>
  CrackContact<dim>::CrackContact(const FamilyOf &family_of, const MPI_Comm communicator)
    : family_of(family_of)
    , communicator(communicator)
  {}


  template <int dim>
  bool CrackContact<dim>::make_row(const std::vector<Bond> &bonds, Row &row) const
  {
    constexpr double about_normal = 0.7, some = 0.6; // cosine; of the sum of lengths
    // Of the bonds that are lost, less the same share of all: families may end at a side.
    Tensor<1, dim> normal, all;
    double         lengths = 0., share = 0., sum_of_all = 0.;
    for (const Bond &bond : bonds)
      {
        all += bond.stiffness * bond.xi;
        sum_of_all += bond.stiffness;
        if (!bond.is_lost)
          continue;
        normal += bond.stiffness * bond.xi;
        lengths += bond.stiffness * bond.xi.norm();
        share += bond.stiffness;
      }
    normal -= share / sum_of_all * all;
    if (!(normal.norm() > some * lengths)) // nothing is lost, or in many directions
      return false;
    normal /= normal.norm();
    double face = std::numeric_limits<double>::max(), beyond = 0.;
    for (const Bond &bond : bonds)
      if (const double height = normal * bond.xi; height > about_normal * bond.xi.norm())
        {
          if (bond.is_lost)
            face = std::min(face, height);
          else
            beyond = std::max(beyond, height);
        }
    if (beyond > (1. - 1e-6) * face)
      return false;
    Tensor<2, dim> tangents;
    Tensor<1, dim> lean;
    double         sum = 0.;
    for (const Bond &bond : bonds)
      if (bond.is_lost)
        {
          const Tensor<1, dim> e   = bond.xi / bond.xi.norm();
          const double         own = std::max(0., normal * e);
          const Tensor<1, dim> t   = e - (normal * e) * normal;
          const double         a   = own * own * bond.stiffness;
          sum += a;
          tangents += a * outer_product(t, t);
          lean += a * t;
        }
    tangents += sum * outer_product(normal, normal); // so that it is regular
    const Tensor<1, dim> correction = solved(tangents, lean);
    double               squares    = 0.;
    row.ends.clear();
    for (const Bond &bond : bonds)
      if (const double own = normal * bond.xi; bond.is_lost && own > 0.)
        {
          const double         x = bond.xi.norm();
          const Tensor<1, dim> t = (bond.xi - own * normal) / x;
          const double         a = own * own / (x * x) * (1. - correction * t);
          squares += bond.stiffness * a * a;
          row.ends.push_back(
            {bond.neighbor, bond.stiffness * a / x * bond.xi, bond.stiffness * a * x});
        }
    row.weight = 1. / squares;
    return squares > 0.;
  }


  template <int dim>
  void CrackContact<dim>::find_strained(const unsigned int node, Row &row) const
  {
    row.strained = 0.;
    for (const End &end : row.ends)
      if (strain_at)
        row.strained += 0.5 * end.length * (strain_at(node) + strain_at(end.neighbor));
  }


  template <int dim>
  void CrackContact<dim>::find_any()
  {
    double any[2] = {rows.empty() ? 0. : 1., n_touching() > 0 ? 1. : 0.};
    Utilities::MPI::max(any, communicator, any);
    any_rows   = any[0] > 0.;
    any_closed = any[1] > 0.;
  }


  template <int dim>
  void CrackContact<dim>::set_rows(const std::vector<unsigned int> &of_nodes)
  {
    for (const unsigned int i : of_nodes)
      {
        family_of(i, family);
        Row row;
        if (family.empty() || !make_row(family, row))
          {
            rows.erase(i);
            continue;
          }
        find_strained(i, row);
        const auto old = rows.find(i);
        row.touches    = old != rows.end() && old->second.touches;
        rows[i]        = std::move(row);
      }
    find_any();
  }


  template <int dim>
  void CrackContact<dim>::set_strains(const std::function<double(const unsigned int)> &at)
  {
    strain_at = at;
    for (auto &[node, row] : rows)
      find_strained(node, row);
  }


  template <int dim>
  double CrackContact<dim>::gap(const unsigned int node, const Row &row, const double *u) const
  {
    double sum = -row.strained;
    for (const End &end : row.ends)
      sum += change_along(end.factor, u, node, end.neighbor);
    return sum;
  }


  template <int dim>
  double CrackContact<dim>::size_of_terms(const unsigned int node,
                                          const Row         &row,
                                          const double      *u) const
  {
    double size = std::abs(row.strained);
    for (const End &end : row.ends)
      for (unsigned int d = 0; d < dim; ++d)
        size += std::abs(end.factor[d]) *
                (std::abs(u[dim * node + d]) + std::abs(u[dim * end.neighbor + d]));
    return size;
  }


  template <int dim>
  bool CrackContact<dim>::is_closed(const unsigned int node, const Row &row, const double *u) const
  {
    // Of displacements that a solver has found to its tolerance: else nodes would flutter.
    constexpr double noise = 1e-9;
    const double     now   = gap(node, row, u);
    if ((now < 0.) == row.touches || std::abs(now) > noise * size_of_terms(node, row, u))
      return now < 0.;
    return row.touches;
  }


  template <int dim>
  bool CrackContact<dim>::update(const Vector &u)
  {
    if (!any_rows)
      return false;
    double flags[] = {0., 0.};
    for (auto &[node, row] : rows)
      {
        const bool touches = is_closed(node, row, u.begin());
        if (touches != row.touches)
          flags[0] = 1.;
        if (touches)
          flags[1] = 1.;
        row.touches = touches;
      }
    Utilities::MPI::max(flags, communicator, flags);
    any_closed = flags[1] > 0.;
    return flags[0] > 0.;
  }


  template <int dim>
  void CrackContact<dim>::add_force(const unsigned int node,
                                    const Row         &row,
                                    const double       size,
                                    double            *y) const
  {
    for (const End &end : row.ends)
      for (unsigned int d = 0; d < dim; ++d)
        {
          y[dim * end.neighbor + d] += size * end.factor[d];
          y[dim * node + d] -= size * end.factor[d];
        }
  }


  template <int dim>
  void CrackContact<dim>::add_forces(Vector       &y,
                                     const Vector &u,
                                     const bool    strained,
                                     const double  multiple) const
  {
    if (!any_closed)
      return;
    y.zero_out_ghost_values();
    for (const auto &[node, row] : rows)
      if (row.touches)
        add_force(node,
                  row,
                  multiple * row.weight *
                    (gap(node, row, u.begin()) + (strained ? 0. : row.strained)),
                  y.begin());
    y.compress(VectorOperation::add);
  }


  template <int dim>
  void CrackContact<dim>::add_forces_of(const std::vector<unsigned int> &of_nodes,
                                        const double                     multiple,
                                        double                          *y,
                                        const double                    *u) const
  {
    for (const unsigned int i : of_nodes)
      if (const auto found = rows.find(i); found != rows.end() && found->second.touches)
        add_force(i, found->second, multiple * found->second.weight * gap(i, found->second, u), y);
  }


  template <int dim>
  double CrackContact<dim>::energy_of(const std::vector<unsigned int> &of_nodes,
                                      const double                    *u) const
  {
    double sum = 0.;
    for (const unsigned int i : of_nodes)
      if (const auto found = rows.find(i); found != rows.end())
        {
          const double now = std::min(0., gap(i, found->second, u));
          sum += 0.5 * found->second.weight * now * now;
        }
    return sum;
  }


  template <int dim>
  double CrackContact<dim>::set_rows(const std::vector<unsigned int> &of_nodes,
                                     const Vector                    &u,
                                     Vector                          &change,
                                     bool                            &changes)
  {
    const bool touched = any_closed, any = any_rows;
    double     gained = -energy_of(of_nodes, u.begin());
    if (touched)
      add_forces_of(of_nodes, -1., change.begin(), u.begin());
    set_rows(of_nodes);
    for (const unsigned int i : of_nodes)
      if (const auto found = rows.find(i); found != rows.end())
        found->second.touches = is_closed(i, found->second, u.begin());
    find_any();
    gained += energy_of(of_nodes, u.begin());
    if (any_closed)
      add_forces_of(of_nodes, 1., change.begin(), u.begin());
    changes = changes || touched || any_closed;
    return any || any_rows ? -Utilities::MPI::sum(gained, communicator) : 0.;
  }


  template <int dim>
  double CrackContact<dim>::energy(const Vector &u) const
  {
    if (!any_rows)
      return 0.;
    double sum = 0.;
    for (const auto &[node, row] : rows)
      {
        const double now = std::min(0., gap(node, row, u.begin()));
        sum += 0.5 * row.weight * now * now;
      }
    return Utilities::MPI::sum(sum, communicator);
  }


  template <int dim>
  unsigned int CrackContact<dim>::n_touching() const
  {
    return std::count_if(rows.begin(), rows.end(), [](const auto &row) {
      return row.second.touches;
    });
  }


  template <int dim>
  void CrackContact<dim>::exchange(Archive &archive, Vector nodal, const NodeKeys &keys)
  {
    for (const auto &[node, row] : rows)
      nodal.local_element(node) = row.touches ? 1. : 0.;
    archive.exchange("touching", nodal, keys);
    for (auto &[node, row] : rows)
      row.touches = nodal.local_element(node) > 0.;
    find_any();
  }


  template <int dim>
  std::size_t CrackContact<dim>::memory_consumption() const
  {
    std::size_t sum = 0;
    for (const auto &row : rows)
      sum += sizeof(row) + row.second.ends.capacity() * sizeof(End);
    return sum;
  }


  template class CrackContact<1>;
  template class CrackContact<2>;
  template class CrackContact<3>;
} // namespace PeriDeal
