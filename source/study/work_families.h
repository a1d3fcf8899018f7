// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/study/study_file.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /** Among which methods a scene lets one choose. */
  enum class Comparison
  {
    cracks,       // diffusion around cracks
    solid_cracks, // elastic bodies with cracks
    field,        // diffusion without cracks
    solid,        // elastic bodies without cracks
    motion        // elastic bodies in motion, without cracks
  };

  /** A method with its settings, to be computed on several lattices. */
  struct WorkFamily
  {
    std::string          name;
    std::string          model; // as in output files
    std::vector<Setting> settings;
    double               ratio      = 0.;    // m of peridynamics in the whole body, else 0
    bool                 on_faces   = false; // needs lattices with the cracks on cell faces
    unsigned int         multiple   = 1;     // of the numbers of cells
    Comparison           comparison = Comparison::cracks;
    bool                 given_zone = false; // the zone is the scene's, by a formula
    double courant = 0.; // steps over the time in which a wave crosses a cell; motion only
  };

  /** All methods that are compared, in the order of tables and legends. */
  const std::vector<WorkFamily> &work_families();
} // namespace PeriDeal
