// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/interleaved.h>
#include <perideal/operators/coupling/node_families.h>
#include <perideal/operators/solid/nodal_zone.h>
#include <perideal/scene/rules.h>

#include <algorithm>
#include <utility>

#include "with_ghosts.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Rows for Correspondence: q of ghosts is known, and there is memory of histories. */
    template <int dim>
    BondTable<dim> &completed(BondTable<dim>            &rows,
                              const NodeLaws<dim>       &laws,
                              const BodyParameters<dim> &body)
    {
      laws.weighted.update_ghost_values();
      rows.find_springs(false, body.material.law.yields() ? Correspondence<dim>::n_history : 0);
      return rows;
    }
  } // namespace


  template <int dim>
  std::vector<bool> NodalZone<dim>::reaching(const Coupling<dim> &coupling)
  {
    const Families<dim>                        &families = coupling.families();
    const NodeFamilies<dim>                    &shares   = *coupling.node_families();
    std::vector<bool>                           result(families.nodes().n_owned());
    std::vector<typename Families<dim>::Member> members;
    for (unsigned int i = 0; i < result.size(); ++i)
      {
        families.members_of(i, members);
        result[i] = shares.share_of(i) > 0. ||
                    std::any_of(members.begin(), members.end(), [&](const auto &member) {
                      return shares.share_of(member.neighbor) > 0.;
                    });
      }
    return result;
  }


  template <int dim>
  NodalZone<dim>::NodalZone(const Coupling<dim> &coupling, const BodyParameters<dim> &body)
    : laws(coupling.families().nodes(), body)
    , ends(coupling.families())
    , rows(coupling.families(), laws, ends, body, reaching(coupling))
    , found(interleaved(*coupling.families().nodes().partitioner(), dim))
  {
    auto families = std::make_unique<Correspondence<dim>>(coupling.families(),
                                                          ends,
                                                          completed(rows, laws, body),
                                                          laws,
                                                          body);
    nodal         = families.get();
    if (relaxes_at_nodes(body))
      by_family = std::make_unique<RelaxingFamilies<dim>>(shear_and_bulk(std::move(families), ends),
                                                          body.material.law,
                                                          found);
    else
      by_family = std::move(families);
    const NodeFamilies<dim> &shares = *coupling.node_families();
    for (unsigned int i = 0; i < nodal->shapes.size(); ++i)
      {
        nodal->shapes.set_share(i, shares.share_of(i));
        rows.for_each(i, [&](const auto &bond) {
          if (shares.share_of(i) > 0. || shares.share_of(bond.neighbor) > 0.)
            n_in_zone += 0.5;
        });
      }
  }


  template <int dim>
  void NodalZone<dim>::add_product(Vector &y, const Vector &x) const
  {
    const KeptGhosts ghosts(x);
    by_family->multiply(found, x);
    y += found;
  }


  template <int dim>
  void NodalZone<dim>::add_forces(Vector &y, const Vector &u, const double t) const
  {
    const KeptGhosts ghosts(u);
    by_family->find_forces(found, u, t);
    y += found;
  }


  template <int dim>
  double NodalZone<dim>::energy(const Vector &u) const
  {
    const KeptGhosts ghosts(u);
    return by_family->energy(u);
  }


  template <int dim>
  double NodalZone<dim>::accept(const Vector &u, const double t)
  {
    const KeptGhosts ghosts(u);
    return by_family->accept(u, t);
  }


  template <int dim>
  void NodalZone<dim>::linearize(const Vector &u)
  {
    const KeptGhosts ghosts(u);
    by_family->linearize(u);
  }


  template <int dim>
  void NodalZone<dim>::add_diagonal(Vector &diagonal) const
  {
    nodal->shapes.find_diagonal(found);
    diagonal += found;
  }


  template <int dim>
  void NodalZone<dim>::add_row_sums(std::vector<double> &sums) const
  {
    const Vector of_nodes = nodal->shapes.row_sums();
    for (unsigned int i = 0; i < sums.size(); ++i)
      sums[i] += of_nodes.local_element(i / dim);
  }


  PERIDEAL_INSTANTIATE_CLASS(class NodalZone);
} // namespace PeriDeal
