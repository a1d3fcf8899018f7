// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/operators/solid/crack_contact.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

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


    /** l, for lost bonds and a normal. */
    template <int dim>
    Tensor<1, dim> lean_of(const std::vector<FacingBond<dim>> &family, const Tensor<1, dim> &normal)
    {
      Tensor<2, dim> tangents;
      Tensor<1, dim> lean;
      double         sum = 0.;
      for (const FacingBond<dim> &bond : family)
        if (const double height = normal * bond.xi; bond.is_lost && height > 0.)
          {
            const double         x = bond.xi.norm(), a = bond.stiffness * height * height / (x * x);
            const Tensor<1, dim> t = (bond.xi - height * normal) / x;
            sum += a;
            tangents += a * outer_product(t, t);
            lean += a * t;
          }
      return solved(tangents + sum * outer_product(normal, normal), lean); // that is regular
    }


    /** Ghosts of a vector are up to date while this lives. */
    class WithGhosts
    {
    public:
      explicit WithGhosts(const Vector &vector)
        : vector(vector)
        , before(vector.has_ghost_elements())
      {
        vector.update_ghost_values();
      }

      ~WithGhosts()
      {
        vector.set_ghost_state(before);
      }

      WithGhosts(const WithGhosts &) = delete;

    private:
      const Vector &vector;
      const bool    before;
    };
  } // namespace


  template <int dim>
  CrackContact<dim>::CrackContact(const FamilyOf &family_of,
                                  const Layout   &nodes,
                                  const Layout   &unknowns)
    : family_of(family_of)
    , nodes(nodes)
    , unknowns(unknowns)
    , normals(
        [this](const unsigned int node, std::vector<Bond> &bonds) { this->family_of(node, bonds); },
        nodes,
        unknowns)
  {}


  template <int dim>
  double CrackContact<dim>::share_across(const Tensor<1, dim> &direction,
                                         const Tensor<1, dim> &normal,
                                         const Tensor<1, dim> &lean) const
  {
    const double own = normal * direction;
    return own > 0. ? own * own * (1. - lean * direction) : 0.;
  }


  /** Of the family that is looked at. */
  template <int dim>
  bool CrackContact<dim>::has_whole_bonds_across(const Tensor<1, dim> &normal) const
  {
    constexpr double about_normal = 0.7, some = 0.2; // cosine; of what is lost
    double           face = std::numeric_limits<double>::max(), lost = 0., whole = 0.;
    const auto       is_about = [&](const Bond &bond) {
      return normal * bond.xi > about_normal * bond.xi.norm();
    };
    for (const Bond &bond : family)
      if (bond.is_lost && is_about(bond))
        {
          face = std::min(face, normal * bond.xi);
          lost += bond.stiffness;
        }
    for (const Bond &bond : family)
      if (!bond.is_lost && is_about(bond) && normal * bond.xi > (1. - 1e-6) * face)
        whole += bond.stiffness;
    return whole > some * lost;
  }


  template <int dim>
  typename CrackContact<dim>::Row &CrackContact<dim>::row_of(const unsigned int node)
  {
    const auto [place, is_new] = row_numbers.try_emplace(node, rows.size());
    if (is_new)
      {
        rows.emplace_back();
        rows.back().node = node;
      }
    return rows[place->second];
  }


  template <int dim>
  void CrackContact<dim>::make_row(Row &row)
  {
    const unsigned int node  = row.node;
    const double       scale = family_of(node, family);
    row.ends.clear();
    row.weight                   = 0.;
    const Tensor<1, dim> normal  = normals.normal(node);
    const bool           presses = normal != Tensor<1, dim>() && !has_whole_bonds_across(normal);
    const Tensor<1, dim> lean    = presses ? lean_of(family, normal) : Tensor<1, dim>();
    constexpr double     some    = 0.01;
    double               squares = 0., all = 0.;
    for (const Bond &bond : family)
      if (bond.is_lost)
        {
          const double         x = bond.xi.norm();
          const Tensor<1, dim> d = bond.xi / x;
          const double         a = presses ? share_across(d, normal, lean) : 0.;
          squares += bond.stiffness * a * a;
          all += bond.stiffness * std::pow(std::max(0., normal * d), 4);
          row.ends.push_back({bond.neighbor, d, bond.stiffness, bond.stiffness * a, x});
        }
    if (squares > some * all) // else they lean to one side only
      row.weight = scale / squares;
    else
      row.touches = false;
    for (unsigned int c = 0; c < dim; ++c)
      leans.local_element(dim * node + c) = lean[c];
    find_strained(row);
  }


  template <int dim>
  void CrackContact<dim>::find_strained(Row &row) const
  {
    row.strained = 0.;
    for (const End &end : row.ends)
      if (strain_at)
        row.strained +=
          0.5 * end.factor * end.length * (strain_at(row.node) + strain_at(end.neighbor));
  }


  template <int dim>
  void CrackContact<dim>::find_any()
  {
    const bool touch =
      std::any_of(rows.begin(), rows.end(), [](const Row &row) { return row.touches; });
    double any[2] = {rows.empty() ? 0. : 1., touch ? 1. : 0.};
    Utilities::MPI::max(any, unknowns->get_mpi_communicator(), any);
    any_rows   = any[0] > 0.;
    any_closed = any[1] > 0.;
  }


  template <int dim>
  double CrackContact<dim>::set_rows(const std::vector<unsigned int> &of_nodes, const Vector *u)
  {
    const std::vector<unsigned int> changed = normals.renew(of_nodes);
    double                          flag    = changed.empty() ? 0. : 1.;
    flag = Utilities::MPI::max(flag, unknowns->get_mpi_communicator());
    if (!any_rows && flag == 0.)
      return 0.;
    if (leans.size() == 0)
      {
        leans.reinit(unknowns);
        pressures.reinit(nodes);
      }
    double     released = 0.;
    const auto renew    = [&](Row &row) {
      released += u ? energy_of(row, u->begin()) : 0.;
      make_row(row);
      if (u)
        row.touches = row.weight > 0. && is_closed(row, u->begin());
      released -= u ? energy_of(row, u->begin()) : 0.;
    };
    for (const unsigned int i : of_nodes) // those that are whole again
      if (const auto found = row_numbers.find(i);
          found != row_numbers.end() && !std::binary_search(changed.begin(), changed.end(), i))
        {
          renew(rows[found->second]);
          pressures.local_element(i) = 0.;
        }
    for (const unsigned int i : changed)
      renew(row_of(i));
    leans.update_ghost_values();
    find_any();
    return released;
  }


  template <int dim>
  void CrackContact<dim>::renew()
  {
    std::vector<unsigned int> owned(nodes->locally_owned_size());
    std::iota(owned.begin(), owned.end(), 0);
    set_rows(owned);
  }


  template <int dim>
  double CrackContact<dim>::change(const std::vector<unsigned int> &of_nodes, const Vector &u)
  {
    const WithGhosts ghosts(u);
    const double     released = set_rows(of_nodes, &u);
    return any_rows ? Utilities::MPI::sum(released, unknowns->get_mpi_communicator()) : 0.;
  }


  template <int dim>
  void CrackContact<dim>::set_strains(const std::function<double(const unsigned int)> &at)
  {
    strain_at = at;
    for (Row &row : rows)
      find_strained(row);
  }


  template <int dim>
  double CrackContact<dim>::gap(const Row &row, const double *u) const
  {
    double sum = -row.strained;
    for (const End &end : row.ends)
      sum += end.factor * change_along(end.direction, u, row.node, end.neighbor);
    return sum;
  }


  template <int dim>
  double CrackContact<dim>::size_of_terms(const Row &row, const double *u) const
  {
    double size = std::abs(row.strained);
    for (const End &end : row.ends)
      for (unsigned int d = 0; d < dim; ++d)
        size += std::abs(end.factor * end.direction[d]) *
                (std::abs(u[dim * row.node + d]) + std::abs(u[dim * end.neighbor + d]));
    return size;
  }


  template <int dim>
  bool CrackContact<dim>::is_closed(const Row &row, const double *u) const
  {
    // Of displacements that a solver has found to its tolerance: else nodes would flutter.
    constexpr double noise = 1e-9;
    const double     now   = gap(row, u);
    if ((now < 0.) == row.touches || std::abs(now) > noise * size_of_terms(row, u))
      return now < 0.;
    return row.touches;
  }


  template <int dim>
  bool CrackContact<dim>::update(const Vector &u, double &gained)
  {
    gained = 0.; // it begins and ends at gaps of 0
    if (!any_rows)
      return false;
    const WithGhosts ghosts(u);
    double           flags[] = {0., 0.};
    for (Row &row : rows)
      {
        const bool touches = row.weight > 0. && is_closed(row, u.begin());
        if (touches != row.touches)
          flags[0] = 1.;
        if (touches)
          flags[1] = 1.;
        row.touches = touches;
      }
    Utilities::MPI::max(flags, unknowns->get_mpi_communicator(), flags);
    any_closed = flags[1] > 0.;
    return flags[0] > 0.;
  }


  template <int dim>
  void CrackContact<dim>::find_pressures(const Vector &u, const bool strained) const
  {
    const WithGhosts ghosts(u);
    for (const Row &row : rows)
      pressures.local_element(row.node) =
        row.touches ? row.weight * (gap(row, u.begin()) + (strained ? 0. : row.strained)) : 0.;
    pressures.update_ghost_values();
  }


  /** Of K u, from what presses at both ends of the node's lost bonds. */
  template <int dim>
  Tensor<1, dim> CrackContact<dim>::force_of(const Row &row) const
  {
    Tensor<1, dim> force;
    const double   own = pressures.local_element(row.node);
    for (const End &end : row.ends)
      {
        double size = own * end.factor;
        if (const double other = pressures.local_element(end.neighbor); other != 0.)
          {
            Tensor<1, dim> lean;
            for (unsigned int d = 0; d < dim; ++d)
              lean[d] = leans.local_element(dim * end.neighbor + d);
            size += other * end.stiffness *
                    share_across(-1. * end.direction, normals.normal(end.neighbor), lean);
          }
        force -= size * end.direction;
      }
    return force;
  }


  template <int dim>
  void CrackContact<dim>::add_forces(Vector &y, const Vector &u, const double multiple) const
  {
    if (any_closed)
      find_pressures(u, true);
    for (const Row &row : rows)
      row.force = any_closed ? force_of(row) : Tensor<1, dim>();
    add_last_forces(y, multiple);
  }


  template <int dim>
  void CrackContact<dim>::add_tangent(Vector &y, const Vector &x) const
  {
    if (!any_closed)
      return;
    find_pressures(x, false);
    for (const Row &row : rows)
      {
        const Tensor<1, dim> force = force_of(row);
        for (unsigned int d = 0; d < dim; ++d)
          y.local_element(dim * row.node + d) += force[d];
      }
  }


  template <int dim>
  void CrackContact<dim>::add_last_forces(Vector &y, const double multiple) const
  {
    for (const Row &row : rows)
      for (unsigned int d = 0; d < dim; ++d)
        y.local_element(dim * row.node + d) += multiple * row.force[d];
  }


  template <int dim>
  double CrackContact<dim>::energy_of(const Row &row, const double *u) const
  {
    const double now = row.weight > 0. ? std::min(0., gap(row, u)) : 0.;
    return 0.5 * row.weight * now * now;
  }


  template <int dim>
  double CrackContact<dim>::energy(const Vector &u) const
  {
    if (!any_rows)
      return 0.;
    const WithGhosts ghosts(u);
    // In the order of nodes: the same digits in a run that is resumed.
    std::vector<std::pair<unsigned int, double>> energies;
    for (const Row &row : rows)
      if (const double energy = energy_of(row, u.begin()); energy > 0.)
        energies.emplace_back(row.node, energy);
    std::sort(energies.begin(), energies.end());
    double sum = 0.;
    for (const auto &[node, energy] : energies)
      sum += energy;
    return Utilities::MPI::sum(sum, unknowns->get_mpi_communicator());
  }


  template <int dim>
  void CrackContact<dim>::exchange(Archive &archive, const NodeKeys &keys)
  {
    Vector nodal(nodes);
    for (const Row &row : rows)
      nodal.local_element(row.node) = row.touches ? 1. : 0.;
    archive.exchange("touching", nodal, keys);
    for (Row &row : rows)
      row.touches = row.weight > 0. && nodal.local_element(row.node) > 0.;
    find_any();
  }


  template <int dim>
  std::size_t CrackContact<dim>::memory_consumption() const
  {
    std::size_t sum = 0;
    for (const Row &row : rows)
      sum += sizeof(row) + row.ends.capacity() * sizeof(End);
    return sum + leans.memory_consumption() + pressures.memory_consumption() +
           normals.memory_consumption();
  }


  template class CrackContact<1>;
  template class CrackContact<2>;
  template class CrackContact<3>;
} // namespace PeriDeal
