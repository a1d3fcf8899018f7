// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/interleaved.h>
#include <perideal/base/place_text.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/solid/bond_softness.h>
#include <perideal/operators/solid/fictitious_cuts.h>
#include <perideal/operators/solid/solid_bonds.h>
#include <perideal/operators/solid/surface_factors.h>
#include <perideal/scene/beyond_sides.h>
#include <perideal/scene/rules.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "../lattice/state_lattice.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Where the body relaxes at nodes, bonds are linear. */
    template <int dim>
    Material::Law law_of_bonds(const BodyParameters<dim> &body)
    {
      Material::Law law = body.material.law;
      if (relaxes_at_nodes(body))
        law.kind = SolidLaw::linear;
      return law;
    }
  } // namespace


  /** Let families go on beyond the sides of the body. Collective. */
  template <int dim>
  void SolidBonds<dim>::complete_families(const BodyParameters<dim> &body)
  {
    const auto search = [&]() {
      ends.images = std::make_unique<FictitiousImages<dim>>(families.nodes());
      return FictitiousBondSearch<dim>(families, *ends.images);
    };
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
        corrections.thinnest = thin.thinnest;
        const bool all       = completes_at_surfaces(body) || thin.any;
        rows.go_on_beyond(
          search().on_mesh(images,
                           all ?
                             beyond_sides([](const types::boundary_id) { return true; }, nullptr) :
                             std::vector<BoundaryImage<dim>>()),
          false);
        return;
      }
    const auto sides     = beyond_sides(body);
    const bool completes = completes_at_surfaces(body);
    if (!families.neighbors().has_unique_sites() ||
        (!completes && std::all_of(sides.begin(), sides.end(), [](const auto side) {
          return side == BeyondSide::nothing;
        })))
      return;
    rows.go_on_beyond(search().on_lattice(sides, completes),
                      !body.elasticity.has_full_kinematics() && !law.any() &&
                        !body.material.law.softens() && !body.material.law.yields() &&
                        !body.elasticity.is_correspondence() &&
                        !families.cracks().history().changes_ever());
    // The lattice knows what is complete to the last bit.
    const double complete = rows.complete_weighted;
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      if (double &q = laws.weighted.local_element(i); std::abs(q - complete) < 1e-12 * complete)
        q = complete;
  }


  template <int dim>
  void SolidBonds<dim>::require(const BodyParameters<dim> &body)
  {
    const Peridynamics &pd = body.peridynamics;
    if (pd.completes_families())
      refuse_beyond_sides(body);
    if (pd.corrects_elastic_bonds())
      require_surface_factors(body);
    const std::string not_lattice = StateLattice<dim>::obstacle(body);
    pd.refuse(pd.wants_lattice_form() && !not_lattice.empty(),
              "Operator form",
              "'lattice' is not defined here: " + not_lattice + "; use 'auto'.");
    refuse_families(body);
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
  std::unique_ptr<FamilyForces<dim>> SolidBonds<dim>::make_families(const BodyParameters<dim> &body)
  {
    std::unique_ptr<Correspondence<dim>> nodal;
    if (body.elasticity.is_correspondence())
      nodal = std::make_unique<Correspondence<dim>>(families, ends, rows, laws, body);
    if (relaxes_at_nodes(body))
      return std::make_unique<RelaxingFamilies<dim>>(
        nodal ? shear_and_bulk(std::move(nodal), ends) :
                shear_and_bulk(ends, rows, laws, sums, forces),
        body.material.law,
        Vector(interleaved(*families.nodes().partitioner(), dim)));
    if (nodal)
      return nodal;
    if (body.material.law.yields())
      return std::make_unique<YieldingFamilies<dim>>(families, ends, rows, laws, body);
    return {};
  }


  template <int dim>
  SolidBonds<dim>::SolidBonds(Nodes<dim> &nodes, const BodyParameters<dim> &body)
    : families(nodes.find_parts(body.boundary_conditions), body)
    , laws(families.nodes(), body)
    , law(law_of_bonds(body), {body.domain.files.folder, body.domain.files.communicator})
    , ends(families)
    , rows(families, laws, ends, body)
    , sums(families, ends, rows, laws)
    , kinematics(families, ends, rows, thermal, body.elasticity.has_full_kinematics())
    , forces(families, ends, rows, laws, law, kinematics)
    , weights_follow(body.elasticity.micromodulus != Micromodulus::constant)
  {
    complete_families(body);
    if (!weights_follow)
      laws.weighted = rows.complete_weighted;
    laws.weighted.update_ghost_values();
    if (body.peridynamics.corrects_elastic_bonds())
      correct_surface(body);
    const Material::Law &of_scene  = body.material.law;
    const unsigned int   n_history = !of_scene.yields() ? law.n_history() :
                                     body.elasticity.is_correspondence() ?
                                                          Correspondence<dim>::n_history :
                                                          YieldingFamilies<dim>::n_history;
    rows.find_springs(body.elasticity.has_full_kinematics(),
                      of_scene.softens() ? BondSoftness::n : n_history);
    if (!body.elasticity.is_correspondence())
      sums.take_lattice(relaxes_at_nodes(body));
    by_family = make_families(body);
  }


  template <int dim>
  void SolidBonds<dim>::correct_surface(const BodyParameters<dim> &body)
  {
    BondRows<dim>       &stored = rows.body; // springs still are W x^2
    const SurfaceFactors factors =
      surface_factors(families,
                      body.peridynamics,
                      {stored.starts, stored.neighbors, stored.springs});
    std::string message;
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      if (message.empty() && laws.volumetric &&
          laws[i].extension + laws[i].volumetric * laws[i].dilatation * factors.ratio[i] <= 0.)
        message =
          "'Surface correction' in section 'Peridynamics': with this Poisson ratio the energy of the node at " +
          place_text(families.nodes().position(i)) +
          " would not be positive. Use 'moments' or 'none'.";
    throw_on_all_if_any(families.nodes().communicator(), message);
    for (std::size_t k = 0; k < stored.size(); ++k)
      {
        stored.moments[k] *= factors.dilatation[k];
        stored.springs[k] *= factors.dilatation[k] * factors.dilatation[k] / factors.extension[k];
      }
    laws.weighted      = factors.q;
    corrections.n_left = factors.n_left;
    corrections.gap    = factors.gap;
    laws.weighted.update_ghost_values();
  }


  template <int dim>
  void SolidBonds<dim>::part(const unsigned int i, const double t)
  {
    rows.for_each_stored(i, [&](const auto &bond) {
      if (rows.is_whole(bond.number) && families.cracks().cuts(i, bond.neighbor))
        rows.mark(bond.number, BondState::parted, t);
    });
    std::vector<typename BondEnds<dim>::Term> terms;
    rows.for_each_beyond(i, [&](const auto &bond) {
      if (!rows.is_whole(bond.number))
        return;
      const FictitiousImages<dim> &images = *ends.images;
      const unsigned int           image  = ends.image(bond.neighbor);
      terms.clear();
      images.for_each_term(image, [&](const auto &term) { terms.push_back(term); });
      const Point<dim> &mirror = families.nodes().lattice() ? images[image].place :
                                                              images.twice_planes(image);
      if (is_cut<dim>(families, i, terms, mirror))
        rows.mark(bond.number, BondState::parted, t);
    });
  }


  template <int dim>
  bool SolidBonds<dim>::has_parted(const unsigned int i) const
  {
    bool any = false;
    rows.for_each_stored(i, [&](const auto &bond) {
      any = any || rows.body.state.is_parted(bond.number) ||
            (!rows.is_whole(bond.number) && families.cracks().cuts(i, bond.neighbor));
    });
    rows.for_each_beyond(i, [&](const auto &bond) {
      const std::size_t k = rows.place(bond.number);
      // What was cut from the start has never had a weight.
      any = any || (rows.beyond.state.is_parted(k) && rows.beyond.squares[k] > 0.);
    });
    return any;
  }


  template <int dim>
  double SolidBonds<dim>::weight_left(const unsigned int i, std::string &message) const
  {
    std::vector<typename Families<dim>::Member> family;
    families.members_of(i, family);
    double outside = 0.;
    rows.for_each_beyond(i, [&](const auto &bond) {
      const std::size_t k = rows.place(bond.number);
      if (!rows.beyond.state.is_parted(k))
        outside += rows.beyond.squares[k] / families.nodes().volume(i);
    });
    return laws.weight_of(families, i, family, message) + outside;
  }


  template <int dim>
  void SolidBonds<dim>::renew_springs(const unsigned int i)
  {
    BondRows<dim> &stored = rows.body;
    if (!stored.is_packed() && !rows.is_on_lattice(i)) // packed ones follow from q
      {
        std::vector<typename Families<dim>::Member> family;
        families.members_of(i, family);
        std::size_t       k   = stored.starts[rows.row_in_body(i)];
        const std::size_t end = stored.starts[rows.row_in_body(i) + 1];
        for (const auto &bond : family)
          if (k < end && stored.neighbors[k] == bond.neighbor && bond.weight != 0.)
            {
              const double square =
                bond.weight * families.neighbors().bond_vector(i, bond.neighbor).norm_square();
              if (stored.state.is_whole(k))
                stored.springs[k] =
                  LinearPeridynamicSolid::spring(rows.stiffnesses(i, bond.neighbor), square);
              ++k;
            }
      }
    rows.for_each_beyond(i, [&](const auto &bond) {
      const std::size_t k = rows.place(bond.number);
      if (rows.is_whole(bond.number))
        rows.beyond.springs[k] =
          LinearPeridynamicSolid::spring(laws.stiffness(i), rows.beyond.squares[k]);
    });
  }


  template <int dim>
  void SolidBonds<dim>::renew_weights(const std::vector<unsigned int> &of_nodes)
  {
    std::string message;
    for (const unsigned int i : of_nodes)
      if (has_parted(i))
        {
          const double q = weight_left(i, message);
          if (weights_follow)
            laws.weighted.local_element(i) = q;
        }
    throw_on_all_if_any(families.nodes().communicator(), message);
    laws.weighted.update_ghost_values();
  }


  template <int dim>
  void SolidBonds<dim>::take_temperatures(const Vector &changes)
  {
    std::vector<double> before(families.nodes().n_local());
    for (unsigned int i = 0; i < before.size(); ++i)
      before[i] = laws.stiffness(i);
    laws.take_temperatures(changes);
    const auto scale = [&](BondRows<dim> &bonds) {
      for (std::size_t row = 0; !bonds.is_packed() && row < bonds.nodes.size(); ++row)
        for (std::size_t k = bonds.starts[row]; k < bonds.starts[row + 1]; ++k)
          {
            const unsigned int i = bonds.nodes[row], j = bonds.neighbors[k];
            bonds.springs[k] *=
              rows.stiffnesses(i, j) / (before[i] + (ends.is_fictitious(j) ? 0. : before[j]));
          }
    };
    scale(rows.body);
    scale(rows.beyond);
  }


  template <int dim>
  void SolidBonds<dim>::apply_change(const ChangeSet<dim> &change, const bool marked)
  {
    const Neighbors<dim> &neighbors = families.neighbors();
    const double          reach     = families.weights().reach();
    // On a mesh nodes follow from others that lie farther away.
    const double touched = ends.images && !families.nodes().lattice() ? halo_of_images(reach) :
                                                                        reach;
    families.cracks().apply_change(change);
    const std::vector<unsigned int> near = neighbors.nodes_near(change.cuts, touched);
    if (!marked)
      for (const unsigned int i : near)
        part(i, change.since);
    renew_weights(near);
    for (const unsigned int i : neighbors.nodes_near(change.cuts, touched + reach))
      renew_springs(i);
  }


  PERIDEAL_INSTANTIATE_CLASS(struct SolidBonds);
} // namespace PeriDeal
