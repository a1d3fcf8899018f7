// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/solid_bonds.h>
#include <perideal/scene/beyond_sides.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Families that go on beyond the sides of the body: adds to q. Collective. */
    template <int dim>
    std::unique_ptr<FictitiousBonds<dim>> complete_families(const Families<dim>  &families,
                                                            const SolidRows<dim> &rows,
                                                            const Scene<dim>     &scene,
                                                            Vector               &weighted)
    {
      if (completes_mesh(scene))
        {
          const auto goes_on = [&](const types::boundary_id side) {
            return goes_on_beyond(scene, side);
          };
          auto beyond = std::make_unique<FictitiousBonds<dim>>(
            families,
            boundary_images(families.nodes(),
                            scene.boundary_conditions.symmetry,
                            goes_on,
                            families.weights().reach()));
          beyond->add_weights(weighted);
          return beyond;
        }
      const auto sides = beyond_sides(scene);
      if (!families.neighbors().has_unique_sites() ||
          std::all_of(sides.begin(), sides.end(), [](const auto side) {
            return side == BeyondSide::nothing;
          }))
        return nullptr;
      auto beyond = std::make_unique<FictitiousBonds<dim>>(families, sides);
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
  SolidBonds<dim>::SolidBonds(Nodes<dim> &nodes, const Scene<dim> &scene)
    : families(nodes.find_parts(scene.boundary_conditions), scene)
    , laws(families.nodes(), scene)
    , rows(families, laws, scene)
    , kinematics(families, rows, thermal, scene.elasticity.kinematics == Kinematics::full)
    , beyond(complete_families(families, rows, scene, laws.weighted))
  {
    if (scene.elasticity.micromodulus == Micromodulus::constant)
      laws.weighted = rows.complete_weighted();
    laws.weighted.update_ghost_values();
    rows.find_springs(scene);
    kinematics.keep_lengths();
    if (beyond)
      beyond->find_springs(laws, kinematics.is_full());
  }


  template struct SolidBonds<1>;
  template struct SolidBonds<2>;
  template struct SolidBonds<3>;
} // namespace PeriDeal
