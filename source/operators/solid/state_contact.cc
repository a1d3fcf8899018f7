// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "state_contact.h"

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/crack_contact.h>
#include <perideal/operators/solid/short_range_contact.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** CrackContact::FamilyOf. */
    template <int dim>
    double family_of(const SolidBonds<dim>        &solid,
                     const BodyParameters<dim>    &body,
                     const unsigned int            node,
                     std::vector<FacingBond<dim>> &list)
    {
      list.clear();
      if (solid.rows.is_on_lattice(node))
        return 0.;
      const BondRows<dim>                        &rows = solid.rows.body;
      const std::size_t                           row  = solid.rows.row_in_body(node);
      std::vector<typename Families<dim>::Member> family;
      std::vector<std::pair<unsigned int, int>>   crossed;
      solid.families.members_of(node, family);
      const double own = solid.laws.stiffness(node), tiny = 1e-9 * body.horizon();
      double       all = 0.; // of q, as if there were no crack
      std::size_t  k   = rows.starts[row];
      bool         any = false;
      for (const auto &member : family)
        {
          const unsigned int   j  = member.neighbor;
          const Tensor<1, dim> xi = solid.families.neighbors().bond_vector(node, j);
          bool                 is_lost;
          if (k < rows.starts[row + 1] && rows.neighbors[k] == j) // left out are those cut at first
            is_lost = !rows.state.is_whole(k++);
          else
            {
              solid.families.cracks().crossed_cracks(node, j, crossed);
              is_lost = !crossed.empty() || solid.families.is_parted(node, j);
              if (!is_lost)
                continue; // a void does that
            }
          if (xi.norm() < tiny) // twins across a crack between doubled nodes
            continue;
          any = any || is_lost;
          all += member.weight * xi.norm_square();
          list.push_back({j, xi, 0.5 * member.weight * (own + solid.laws.stiffness(j)), is_lost});
        }
      if (!any)
        {
          list.clear();
          return 0.;
        }
      // q may be that of what cracks have left.
      const double whole = std::min(1.,
                                    solid.laws.weighted.local_element(node) *
                                      solid.families.nodes().volume(node) / all);
      // Bonds that dilatations take from would be stiffer across a face than the body is.
      const Moduli moduli = solid.laws.moduli(node);
      const double stiff  = lambda_of(moduli, dim, body.elasticity.plane) + 2. * moduli.shear,
                   takes  = solid.laws.volumetric && dim > 1 ?
                              std::min(1., stiff / (3. * moduli.shear)) :
                              1.;
      return whole * takes;
    }


    /** Of owned nodes, for ShortRangeContact. */
    template <int dim>
    std::vector<double> stiffnesses(const BondTable<dim> &rows, const unsigned int n_owned)
    {
      // So many nodes of a plane of the lattice touch one of another body. At a surface a node
      // lacks half of its bonds: all of these together give it back half of what it lacks.
      constexpr double    n_facing = dim == 1 ? 1. : dim == 2 ? 3. : 5.;
      std::vector<double> result;
      for (unsigned int i = 0; i < n_owned; ++i)
        {
          double sum = 0.;
          rows.for_each_stored(i, [&](const auto &bond) {
            sum += bond.spring * bond.moment.norm_square();
          });
          result.push_back(sum / (4. * n_facing));
        }
      return result;
    }
  } // namespace


  template <int dim>
  std::unique_ptr<SolidContact> make_crack_contact(
    const SolidBonds<dim>                                    &solid,
    const BodyParameters<dim>                                &body,
    const std::shared_ptr<const Utilities::MPI::Partitioner> &layout)
  {
    return std::make_unique<CrackContact<dim>>(
      [&](const unsigned int node, std::vector<FacingBond<dim>> &bonds) {
        return family_of(solid, body, node, bonds);
      },
      solid.families.nodes(),
      layout);
  }


  template <int dim>
  std::unique_ptr<SolidContact> make_short_range_contact(const SolidBonds<dim>     &solid,
                                                         const BodyParameters<dim> &body)
  {
    const Nodes<dim> &nodes = solid.families.nodes();
    return std::make_unique<ShortRangeContact<dim>>(
      nodes,
      body.horizon(),
      [&](const unsigned int node, std::vector<unsigned int> &others) {
        std::vector<typename Families<dim>::Member> family;
        others.clear();
        solid.rows.for_each_stored(node, [&](const auto &bond) {
          if (bond.spring != 0.)
            others.push_back(bond.neighbor);
        });
        solid.families.members_of(node, family);
        return others.size() == family.size();
      },
      stiffnesses(solid.rows, nodes.n_owned()));
  }


  PERIDEAL_INSTANTIATE_FUNCTION(make_crack_contact);
  PERIDEAL_INSTANTIATE_FUNCTION(make_short_range_contact);
} // namespace PeriDeal
