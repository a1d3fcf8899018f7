// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/operators/solid/solid_bonds.h>
#include <perideal/operators/solid/surface_factors.h>
#include <perideal/scene/beyond_sides.h>

#include <algorithm>
#include <cmath>

#include "../lattice/state_lattice.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * Families that go on beyond the sides of the body: adds to q. Collective.
     * @param thinnest part of a mesh
     */
    template <int dim>
    std::unique_ptr<FictitiousBonds<dim>> complete_families(const Families<dim>       &families,
                                                            const SolidRows<dim>      &rows,
                                                            const BodyParameters<dim> &body,
                                                            Vector                    &weighted,
                                                            double                    &thinnest)
    {
      if (completes_mesh(body))
        {
          const auto beyond_sides = [&](const auto &goes_on, ThinParts *thin) {
            return boundary_images<dim>(families.nodes(),
                                        body.boundary_conditions.symmetry,
                                        goes_on,
                                        families.weights().reach(),
                                        thin);
          };
          ThinParts  thin{[&](const types::boundary_id side) { return is_free(body, side); },
                         thin_on_mesh(body)};
          const auto images =
            beyond_sides([&](const types::boundary_id side) { return goes_on_beyond(body, side); },
                         &thin);
          thinnest          = thin.thinnest;
          const bool ends   = completes_at_surfaces(body) || thin.any;
          auto       beyond = std::make_unique<FictitiousBonds<dim>>(
            families,
            images,
            ends ? beyond_sides([](const types::boundary_id) { return true; }, nullptr) :
                         std::vector<BoundaryImage<dim>>());
          beyond->add_weights(weighted);
          return beyond;
        }
      const auto sides     = beyond_sides(body);
      const bool completes = completes_at_surfaces(body);
      if (!families.neighbors().has_unique_sites() ||
          (!completes && std::all_of(sides.begin(), sides.end(), [](const auto side) {
            return side == BeyondSide::nothing;
          })))
        return nullptr;
      auto beyond = std::make_unique<FictitiousBonds<dim>>(
        families,
        sides,
        completes,
        !body.elasticity.has_full_kinematics() && !families.cracks().history().changes_ever());
      beyond->add_weights(weighted);
      // The lattice knows what is complete to the last bit.
      const double complete = rows.complete_weighted();
      for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
        if (std::abs(weighted.local_element(i) - complete) < 1e-12 * complete)
          weighted.local_element(i) = complete;
      return beyond;
    }
  } // namespace


  template <int dim>
  void SolidBonds<dim>::require(const BodyParameters<dim> &body)
  {
    const Peridynamics &pd = body.peridynamics;
    if (pd.completes_families())
      FictitiousExtension<dim>::require(body);
    if (pd.corrects_elastic_bonds())
      require_surface_factors(body);
    const std::string not_lattice = StateLattice<dim>::obstacle(body);
    pd.refuse(pd.wants_lattice_form() && !not_lattice.empty(),
              "Operator form",
              "'lattice' is not defined here: " + not_lattice + "; use 'auto'.");
    KernelWeights<dim>::require(body);
    if (body.elasticity.micromodulus != Micromodulus::constant)
      return;
    body.elasticity.refuse(
      !body.domain.has_lattice(),
      "Micromodulus",
      "'constant' is that of the complete family of a lattice, which 'Shape = mesh file' has not. Leave the entry out.");
    body.elasticity.refuse(
      pd.corrects_elastic_bonds() || pd.completes_families(),
      "Micromodulus",
      "'constant' leaves surfaces soft, which 'Surface correction' and fictitious nodes (section 'Peridynamics') mend. Leave one of them out.");
  }


  template <int dim>
  SolidBonds<dim>::SolidBonds(Nodes<dim> &nodes, const BodyParameters<dim> &body)
    : families(nodes.find_parts(body.boundary_conditions), body)
    , laws(families.nodes(), body)
    , rows(families, laws, body)
    , kinematics(families, rows, thermal, body.elasticity.has_full_kinematics())
    , beyond(complete_families(families, rows, body, laws.weighted, thinnest))
    , weights_follow(body.elasticity.micromodulus != Micromodulus::constant)
  {
    if (!weights_follow)
      laws.weighted = rows.complete_weighted();
    laws.weighted.update_ghost_values();
    rows.find_springs(body);
    kinematics.keep_lengths();
    if (beyond)
      beyond->find_springs(laws, kinematics.is_full());
  }


  template <int dim>
  void SolidBonds<dim>::part(const unsigned int i, const double t, BondState &state)
  {
    rows.for_each_stored(i, [&](const auto &bond) {
      if (!state.is_whole(bond.number) || !families.cracks().cuts(i, bond.neighbor))
        return;
      state.mark(bond.number, BondState::parted, t);
      kinematics.release(bond.number);
    });
    if (beyond)
      beyond->part(i, t);
  }


  template <int dim>
  bool SolidBonds<dim>::has_parted(const unsigned int i, const BondState &state) const
  {
    bool any = beyond && beyond->is_parted(i);
    rows.for_each_stored(i, [&](const auto &bond) {
      any = any || state.is_parted(bond.number) ||
            (!state.is_whole(bond.number) && families.cracks().cuts(i, bond.neighbor));
    });
    return any;
  }


  template <int dim>
  void SolidBonds<dim>::renew_weights(const std::vector<unsigned int> &of_nodes,
                                      const BondState                 &state)
  {
    std::string message;
    for (const unsigned int i : of_nodes)
      if (has_parted(i, state))
        {
          const double q = rows.weight_left(i, message);
          if (weights_follow)
            laws.weighted.local_element(i) = q + (beyond ? beyond->weight_left(i) : 0.);
        }
    throw_on_all_if_any(families.nodes().communicator(), message);
    laws.weighted.update_ghost_values();
  }


  template <int dim>
  void SolidBonds<dim>::apply_change(const ChangeSet<dim> &change,
                                     BondState            &state,
                                     const bool            marked)
  {
    const Neighbors<dim> &neighbors = families.neighbors();
    const double          reach     = families.weights().reach();
    // On a mesh nodes follow from others that lie farther away.
    const double touched = beyond && !families.nodes().lattice() ? halo_of_images(reach) : reach;
    families.cracks().apply_change(change);
    const std::vector<unsigned int> near = neighbors.nodes_near(change.cuts, touched);
    if (!marked)
      for (const unsigned int i : near)
        part(i, change.since, state);
    renew_weights(near, state);
    for (const unsigned int i : neighbors.nodes_near(change.cuts, touched + reach))
      {
        rows.renew_springs(i, state);
        if (beyond)
          beyond->renew_springs(i, laws);
      }
  }


  template struct SolidBonds<1>;
  template struct SolidBonds<2>;
  template struct SolidBonds<3>;
} // namespace PeriDeal
