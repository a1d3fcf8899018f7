// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/coupling_control.h>
#include <perideal/scene/lists.h>

namespace PeriDeal
{
  CouplingControl::CouplingControl()
    : SceneSection("Coupling")
  {
    declare(scheme, "Scheme", "exchange", {"exchange", "splice", "blending"}) =
      "How the model `coupled` joins peridynamics in the zone with finite elements elsewhere: each bond in exchange for what "
      "the elements conduct along it (symmetric, exact for linear fields); rows of either model side by side (not symmetric); or "
      "both energies, weighted over the overlap. With elasticity the bonds of `exchange` carry what pairs of nodes can, those of the others are state-based.";
    declare("Zone", EntryType::text, "auto") =
      "Where bonds are: `cracks: c`, up to c horizons from a crack; `everywhere`; or a formula of "
      "x, y, z, in the zone where it is greater than 0. `adaptive`: as `cracks: 1`, on a mesh that follows the cracks and the solution as the run goes "
      "on (`Coarsening` in section `Domain` says how large its cells may be). `follow`, with elasticity and bonds that break: one horizon (with `blending` two) around cracks, broken bonds, "
      "and wherever the body is stretched by more than `Zone share` of the critical stretch. `auto` is that where bonds may break, else `cracks: 1`.";
    declare(zone_share, "Zone share", "0.5", "1", Bounds::positive) =
      "With `Zone = follow`: bonds appear where the largest principal strain of a cell, thermal strain taken off, reaches this share of the critical stretch.";
    declare(adaptive_tolerance, "Adaptive tolerance", "0.02", "1", Bounds::positive) =
      "With `Zone = adaptive`: cells are refined and merged until the recovered flux shows this relative error in the energy norm, as far as "
      "cells of lattice size reach it.";
    declare(overlap, "Overlap", "0", "1", Bounds::not_negative.saying("0 or more horizons")) =
      "With `splice` and `blending`: width, in horizons, over which one model passes into the other, outwards from the zone's edge.";
    declare(certificate, "Certificate", "true") =
      "Examine the coupling before the run: linear, quadratic and cubic patch tests, symmetry, lowest eigenvalue, with elasticity the balance of forces and moments. Costs about as "
      "much as three steady solutions.";
    parse();
  }


  void CouplingControl::parse(const bool bonds_break)
  {
    SceneSection::parse();
    parse_zone();
    if (bonds_break && !splices() && text("Zone") == "auto")
      zone = ZoneKind::follow;
    if (follows_stretches() && !exchanges())
      width = 2.; // of a bond, and of the families at its ends
    if (is_given("Adaptive tolerance") && !is_adaptive())
      error("Adaptive tolerance", "is for 'Zone = adaptive'; 'Zone' is '" + zone_text() + "'.");
    refuse(zone_share > 0.9,
           "Zone share",
           "found " + text("Zone share") +
             ", needs more than 0 and at most 0.9: bonds have to be there before they break.");
    if (is_given("Zone share") && !follows_stretches())
      error("Zone share", "is for 'Zone = follow'; 'Zone' is '" + zone_text() + "'.");
    if (is_adaptive() && !exchanges())
      error("Zone",
            "'adaptive' changes the mesh while the run goes on, which 'Scheme = " + text("Scheme") +
              "' cannot follow. Use 'exchange', or 'cracks: 1'.");
    if (overlap > 0. && exchanges())
      error("Overlap", "is for 'Scheme' = splice and blending; 'exchange' has none.");
  }


  void CouplingControl::parse_zone()
  {
    const std::string &given = text("Zone");
    const auto         colon = given.find(':');
    const auto         head  = trimmed(given.substr(0, colon));
    if (given == "auto")
      {
        zone  = ZoneKind::near_cracks;
        width = 1.;
      }
    else if (given == "everywhere")
      zone = ZoneKind::everywhere;
    else if (given == "adaptive")
      zone = ZoneKind::adaptive;
    else if (given == "follow")
      zone = ZoneKind::follow;
    else if (colon != std::string::npos && head == "cracks")
      {
        zone  = ZoneKind::near_cracks;
        width = parse_number(given.substr(colon + 1), where("Zone"));
        refuse(width < 0., "Zone", "found '" + given + "', needs 0 or more horizons.");
      }
    else if (colon != std::string::npos || given == "cracks")
      error(
        "Zone",
        "found '" + given +
          "', needs 'cracks: c' with a number of horizons c, 'auto', 'everywhere', 'adaptive', 'follow', or a formula of x, y and z.");
    else if (const std::string near =
               nearest_name(given,
                            std::vector<std::string>{"auto", "everywhere", "adaptive", "follow"});
             !near.empty())
      error("Zone", "found '" + given + "'; did you mean '" + near + "'?");
    else
      {
        zone    = ZoneKind::formula;
        formula = Expression(given, where("Zone"), "x, y, z");
        if (formula.depends_on_time())
          error("Zone", "found '" + given + "'; a formula of the zone may not depend on t.");
      }
  }
} // namespace PeriDeal
