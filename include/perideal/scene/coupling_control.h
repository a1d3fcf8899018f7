// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/expression.h>
#include <perideal/scene/section.h>

namespace PeriDeal
{
  /** How peridynamics and finite elements share a body. */
  enum class CouplingScheme
  {
    exchange,
    splice,
    blending
  };

  /** Which part of the body peridynamics gets. */
  enum class ZoneKind
  {
    near_cracks,
    everywhere,
    adaptive,
    follow,
    formula
  };


  /** Section `Coupling`: the model `coupled`. */
  class CouplingControl : public SceneSection
  {
  public:
    CouplingControl();

    CouplingScheme scheme;
    ZoneKind       zone  = ZoneKind::near_cracks;
    double         width = 1.; // of the zone on each side of a crack, in horizons
    Expression     formula;    // in the zone where greater than 0
    double         overlap;    // in horizons
    bool           certificate;
    double adaptive_tolerance; // of the zone `adaptive`: relative error of the flux, by recovery
    double zone_share;         // of the zone `follow`: of the critical stretch

    /**
     * Throws UserError for a zone that is none, a width or an overlap below 0, contradicting
     * entries.
     * @param bonds_break of a solid: the zone is then `follow` unless one is given, but for splice
     */
    void parse(const bool bonds_break = false);

    bool exchanges() const
    {
      return scheme == CouplingScheme::exchange;
    }

    bool splices() const
    {
      return scheme == CouplingScheme::splice;
    }

    /** The zone lies around the cracks. */
    bool is_near_cracks() const
    {
      return zone == ZoneKind::near_cracks;
    }

    /** The mesh follows the solution, and the zone with it. */
    bool is_adaptive() const
    {
      return zone == ZoneKind::adaptive;
    }

    /** The zone grows around what is stretched and what has broken. */
    bool follows_stretches() const
    {
      return zone == ZoneKind::follow;
    }

    /** The entries `Zone` and `Scheme` as given. */
    std::string zone_text() const
    {
      return text("Zone") != "auto" ? text("Zone") : follows_stretches() ? "follow" : "cracks: 1";
    }

    const std::string &scheme_text() const
    {
      return text("Scheme");
    }

  private:
    void parse_zone();
  };
} // namespace PeriDeal
