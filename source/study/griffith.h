// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/crack_kink.h>
#include <perideal/scene/scene.h>

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** What holds at the end of a crack under the loads of the end of the run. */
  struct GriffithEnd
  {
    std::string name;
    double      mode_1 = 0., mode_2 = 0.;
    double      toughness = 0.; // sqrt(E' G_c)

    CrackKink kink() const
    {
      return kink_of_most_release(mode_1, mode_2);
    }

    /** The share of the loads from which on it grows; infinite if they press it together. */
    double load() const;

    /** The same where the largest hoop stress decides. */
    double load_by_hoop_stress() const;
  };


  /**
   * A brittle body with cracks that do not grow, as its elastic solution under the loads of the end
   * of the run tells of it: displacements and loads are in proportion to t.
   */
  struct GriffithState
  {
    double                   force = 0.; // the largest on a side, by component
    std::vector<GriffithEnd> ends;

    /** The share of the loads from which on the first end grows; infinite if none does. */
    double load() const;
    double load_by_hoop_stress() const;

    /** What the body bears until then, or at the end of the run. */
    double strength() const;
    double strength_by_hoop_stress() const;
  };


  /**
   * That of a solution without bonds that break. Its ends are those with stress intensities.
   *
   * @param scene has the fracture energy
   * @param cracks of the solution
   * @param model  its entry of the summary
   */
  template <int dim>
  GriffithState griffith_state(const Scene<dim>             &scene,
                               const Cracks<dim>            &cracks,
                               const nlohmann::ordered_json &model);

  /** The number of the crack in `crack 3 end 2`, from 0, and of its end. */
  std::pair<unsigned int, unsigned int> crack_and_end(const std::string &name);
} // namespace PeriDeal
