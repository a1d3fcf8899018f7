// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/crack_contact.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "change_along.h"
#include "with_ghosts.h"

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


    /** a. */
    template <int dim>
    double share_across(const Tensor<1, dim> &direction,
                        const Tensor<1, dim> &normal,
                        const Tensor<1, dim> &lean)
    {
      const double own = normal * direction;
      return own > 0. ? own * own * (1. - lean * direction) : 0.;
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


    template <int dim>
    bool has_whole_bonds_across(const std::vector<FacingBond<dim>> &family,
                                const Tensor<1, dim>               &normal)
    {
      constexpr double about_normal = 0.7, some = 0.2; // cosine; of what is lost
      double           face = std::numeric_limits<double>::max(), lost = 0., whole = 0.;
      const auto       is_about = [&](const FacingBond<dim> &bond) {
        return normal * bond.xi > about_normal * bond.xi.norm();
      };
      for (const FacingBond<dim> &bond : family)
        if (bond.is_lost && is_about(bond))
          {
            face = std::min(face, normal * bond.xi);
            lost += bond.stiffness;
          }
      for (const FacingBond<dim> &bond : family)
        if (!bond.is_lost && is_about(bond) && normal * bond.xi > (1. - 1e-6) * face)
          whole += bond.stiffness;
      return whole > some * lost;
    }
  } // namespace


  template <int dim>
  CrackContact<dim>::CrackContact(const FamilyOf   &family_of,
                                  const Nodes<dim> &nodes,
                                  const Layout     &layout)
    : family_of(family_of)
    , nodes(nodes)
    , layout(layout)
    , normals(
        [this](const unsigned int node, std::vector<Bond> &bonds) { this->family_of(node, bonds); },
        layout)
    , parted(normals.parted())
  {}


  template <int dim>
  typename CrackContact<dim>::Face CrackContact<dim>::face(const unsigned int place) const
  {
    Face result{normals.normal(place), {}};
    for (unsigned int d = 0; d < dim; ++d)
      result.lean[d] = leans.local_element(dim * place + d);
    return result;
  }


  /** Visit the lost bonds of a node: visit(end, direction, length). */
  template <int dim>
  template <typename Visit>
  void CrackContact<dim>::for_each_end(const unsigned int place, const Visit &visit) const
  {
    const Point<dim> &at = nodes.position(parted.node(place));
    for (const End &end : rows[place].ends)
      {
        const Tensor<1, dim> xi = nodes.position(end.neighbor) - at;
        const double         x  = xi.norm();
        visit(end, xi / x, x);
      }
  }


  template <int dim>
  void CrackContact<dim>::make_row(const unsigned int place)
  {
    Row         &row   = rows[place];
    const double scale = family_of(parted.node(place), family);
    row.ends.clear();
    row.weight                  = 0.;
    const Tensor<1, dim> normal = normals.normal(place);
    const bool presses = normal != Tensor<1, dim>() && !has_whole_bonds_across(family, normal);
    const Tensor<1, dim> lean    = presses ? lean_of(family, normal) : Tensor<1, dim>();
    constexpr double     some    = 0.01;
    double               squares = 0., all = 0.;
    row.ends.reserve(
      std::count_if(family.begin(), family.end(), [](const Bond &bond) { return bond.is_lost; }));
    for (const Bond &bond : family)
      if (bond.is_lost)
        {
          const Tensor<1, dim> d = bond.xi / bond.xi.norm();
          const double         a = presses ? share_across(d, normal, lean) : 0.;
          squares += bond.stiffness * a * a;
          all += bond.stiffness * std::pow(std::max(0., normal * d), 4);
          row.ends.push_back({bond.neighbor, bond.stiffness});
        }
    if (squares > some * all) // else they lean to one side only
      row.weight = scale / squares;
    else
      row.touches = false;
    for (unsigned int c = 0; c < dim; ++c)
      leans.local_element(dim * place + c) = lean[c];
    find_strained(place);
  }


  template <int dim>
  void CrackContact<dim>::find_strained(const unsigned int place)
  {
    double sum = 0.;
    if (strain_at)
      {
        const Face   own       = face(place);
        const double strain_of = strain_at(parted.node(place));
        for_each_end(place, [&](const End &end, const Tensor<1, dim> &d, const double x) {
          sum += 0.5 * end.stiffness * share_across(d, own.normal, own.lean) * x *
                 (strain_of + strain_at(end.neighbor));
        });
      }
    rows[place].strained = sum;
  }


  template <int dim>
  void CrackContact<dim>::find_any()
  {
    const bool touch =
      std::any_of(rows.begin(), rows.end(), [](const Row &row) { return row.touches; });
    any_closed = Utilities::MPI::max(touch ? 1 : 0, layout->get_mpi_communicator()) > 0;
  }


  template <int dim>
  double CrackContact<dim>::set_rows(const std::vector<unsigned int> &of_nodes, const Vector *u)
  {
    std::vector<double> before; // energies, of the normals until now
    for (unsigned int place = 0; u && place < rows.size(); ++place)
      before.push_back(energy_of(place, u->begin()));
    const std::vector<unsigned int> changed = normals.renew(of_nodes);
    if (parted.empty())
      return 0.;
    before.resize(parted.n_owned());
    rows.resize(parted.n_owned());
    parted.fit_vectors(leans);
    parted.fit_scalars(pressures);
    double     released = 0.;
    const auto renew    = [&](const unsigned int place) {
      make_row(place);
      if (u)
        rows[place].touches = rows[place].weight > 0. && is_closed(place, u->begin());
      released += u ? before[place] - energy_of(place, u->begin()) : 0.;
    };
    for (const unsigned int i : of_nodes) // those that are whole again
      if (const unsigned int place = parted.place(i);
          place != numbers::invalid_unsigned_int &&
          !std::binary_search(changed.begin(), changed.end(), i))
        {
          renew(place);
          pressures.local_element(place) = 0.;
        }
    for (const unsigned int i : changed)
      renew(parted.place(i));
    leans.update_ghost_values();
    find_any();
    return released;
  }


  template <int dim>
  void CrackContact<dim>::renew()
  {
    std::vector<unsigned int> owned(layout->locally_owned_size());
    std::iota(owned.begin(), owned.end(), 0);
    set_rows(owned);
  }


  template <int dim>
  double CrackContact<dim>::change(const std::vector<unsigned int> &of_nodes, const Vector &u)
  {
    const WithGhosts ghosts(u);
    const double     released = set_rows(of_nodes, &u);
    return parted.empty() ? 0. : Utilities::MPI::sum(released, layout->get_mpi_communicator());
  }


  template <int dim>
  void CrackContact<dim>::set_strains(const std::function<double(const unsigned int)> &at)
  {
    strain_at = at;
    for (unsigned int place = 0; place < rows.size(); ++place)
      find_strained(place);
  }


  template <int dim>
  double CrackContact<dim>::gap(const unsigned int place, const double *u, double *size) const
  {
    const unsigned int node = parted.node(place);
    const Face         own  = face(place);
    double             sum  = -rows[place].strained;
    if (size)
      *size += std::abs(rows[place].strained);
    for_each_end(place, [&](const End &end, const Tensor<1, dim> &d, const double) {
      const double factor = end.stiffness * share_across(d, own.normal, own.lean);
      sum += factor * change_along(d, u, node, end.neighbor);
      for (unsigned int c = 0; size && c < dim; ++c)
        *size += std::abs(factor * d[c]) *
                 (std::abs(u[dim * node + c]) + std::abs(u[dim * end.neighbor + c]));
    });
    return sum;
  }


  template <int dim>
  bool CrackContact<dim>::is_closed(const unsigned int place, const double *u) const
  {
    // Of displacements that a solver has found to its tolerance: else nodes would flutter.
    constexpr double noise   = 1e-9;
    const double     now     = gap(place, u);
    const bool       touches = rows[place].touches;
    if ((now < 0.) == touches)
      return touches;
    double size = 0.;
    gap(place, u, &size);
    return std::abs(now) > noise * size ? now < 0. : touches;
  }


  template <int dim>
  bool CrackContact<dim>::update(const Vector &u, double &gained)
  {
    gained = 0.; // it begins and ends at gaps of 0
    if (parted.empty())
      return false;
    const WithGhosts ghosts(u);
    double           flags[] = {0., 0.};
    for (unsigned int place = 0; place < rows.size(); ++place)
      {
        Row       &row     = rows[place];
        const bool touches = row.weight > 0. && is_closed(place, u.begin());
        if (touches != row.touches)
          flags[0] = 1.;
        if (touches)
          flags[1] = 1.;
        row.touches = touches;
      }
    Utilities::MPI::max(flags, layout->get_mpi_communicator(), flags);
    any_closed = flags[1] > 0.;
    return flags[0] > 0.;
  }


  template <int dim>
  template <typename Add>
  void CrackContact<dim>::visit_forces(const Vector &x, const bool strained, const Add &add) const
  {
    if (!any_closed)
      return;
    {
      const WithGhosts ghosts(x);
      for (unsigned int place = 0; place < rows.size(); ++place)
        {
          const Row &row = rows[place];
          pressures.local_element(place) =
            row.touches ? row.weight * (gap(place, x.begin()) + (strained ? 0. : row.strained)) :
                          0.;
        }
    }
    pressures.update_ghost_values();
    for (unsigned int place = 0; place < rows.size(); ++place)
      {
        // From what presses at both ends of the node's lost bonds.
        Tensor<1, dim> force;
        const Face     own      = face(place);
        const double   pressure = pressures.local_element(place);
        for_each_end(place, [&](const End &end, const Tensor<1, dim> &d, const double) {
          double             size  = 0.;
          const unsigned int other = parted.place(end.neighbor);
          if (pressure != 0.)
            size += pressure * end.stiffness * share_across(d, own.normal, own.lean);
          if (other != numbers::invalid_unsigned_int && pressures.local_element(other) != 0.)
            {
              const Face facing = face(other);
              size += pressures.local_element(other) * end.stiffness *
                      share_across(-1. * d, facing.normal, facing.lean);
            }
          force -= size * d;
        });
        for (unsigned int d = 0; d < dim; ++d)
          add(dim * parted.node(place) + d, force[d]);
      }
  }


  template <int dim>
  void CrackContact<dim>::find_forces(const Vector &u) const
  {
    this->forces.clear();
    visit_forces(u, true, [&](const unsigned int unknown, const double force) {
      this->forces.emplace_back(unknown, force);
    });
  }


  template <int dim>
  void CrackContact<dim>::add_tangent(Vector &y, const Vector &x) const
  {
    visit_forces(x, false, [&](const unsigned int unknown, const double force) {
      y.local_element(unknown) += force;
    });
  }


  template <int dim>
  void CrackContact<dim>::add_to_surrogate(const SolidContact::EntryAction &add, const bool anew)
  {
    for (Row &row : rows)
      row.in_surrogate = anew ? row.touches : row.in_surrogate;
    // Springs along n to the ends, together as stiff where a face moves as a whole. (All ends of a
    // node in one block would be K itself, and far more entries.)
    for (unsigned int place = 0; place < rows.size(); ++place)
      {
        if (!rows[place].in_surrogate)
          continue;
        const unsigned int i      = dim * parted.node(place);
        const Face         own    = face(place);
        const auto         height = [&](const End &end, const Tensor<1, dim> &d) {
          return end.stiffness * share_across(d, own.normal, own.lean) * (d * own.normal);
        };
        double sum = 0.;
        for_each_end(place, [&](const End &end, const Tensor<1, dim> &d, const double) {
          sum += height(end, d);
        });
        for_each_end(place, [&](const End &end, const Tensor<1, dim> &d, const double) {
          const double spring = rows[place].weight * sum * height(end, d);
          for (unsigned int k = 0; k < dim * dim && spring > 0.; ++k)
            {
              const unsigned int a = k / dim, b = k % dim, j = dim * end.neighbor;
              const double       value = spring * own.normal[a] * own.normal[b];
              add(i + a, i + b, value);
              add(i + a, j + b, -value);
              add(j + a, i + b, -value);
              add(j + a, j + b, value);
            }
        });
      }
  }


  template <int dim>
  double CrackContact<dim>::energy_of(const unsigned int place, const double *u) const
  {
    const double weight = rows[place].weight, now = weight > 0. ? std::min(0., gap(place, u)) : 0.;
    return 0.5 * weight * now * now;
  }


  template <int dim>
  double CrackContact<dim>::energy(const Vector &u) const
  {
    if (parted.empty())
      return 0.;
    const WithGhosts ghosts(u);
    // In the order of nodes: the same digits in a run that is resumed.
    std::vector<std::pair<unsigned int, double>> energies;
    for (unsigned int place = 0; place < rows.size(); ++place)
      if (const double energy = energy_of(place, u.begin()); energy > 0.)
        energies.emplace_back(parted.node(place), energy);
    std::sort(energies.begin(), energies.end());
    double sum = 0.;
    for (const auto &[node, energy] : energies)
      sum += energy;
    return Utilities::MPI::sum(sum, layout->get_mpi_communicator());
  }


  template <int dim>
  void CrackContact<dim>::exchange(Archive &archive, const NodeKeys &keys)
  {
    Vector     nodal(layout);
    const auto exchange_flags = [&](const std::string &name, bool Row::*const flag) {
      for (unsigned int place = 0; place < rows.size(); ++place)
        nodal.local_element(parted.node(place)) = rows[place].*flag ? 1. : 0.;
      archive.exchange(name, nodal, keys);
      for (unsigned int place = 0; place < rows.size(); ++place)
        rows[place].*flag = rows[place].weight > 0. && nodal.local_element(parted.node(place)) > 0.;
    };
    exchange_flags("touching", &Row::touches);
    exchange_flags("touching in the surrogate", &Row::in_surrogate);
    find_any();
  }


  template <int dim>
  std::size_t CrackContact<dim>::memory_consumption() const
  {
    std::size_t sum = rows.capacity() * sizeof(Row);
    for (const Row &row : rows)
      sum += row.ends.capacity() * sizeof(End);
    return sum + leans.memory_consumption() + pressures.memory_consumption() +
           normals.memory_consumption();
  }


  PERIDEAL_INSTANTIATE_CLASS(class CrackContact);
} // namespace PeriDeal
