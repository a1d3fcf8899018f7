// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/study/growing_cracks.h>

#include <functional>
#include <memory>
#include <vector>

#include "griffith.h"
#include "search.h"

namespace PeriDeal
{
  /** Cracks on their way, and what holds then. */
  struct TracedState
  {
    GrowingCracks cracks;
    GriffithState state;
    Attempt       attempt;       // by which it was found
    double        fineness = 0.; // that Attempts was asked for
    double bears = 0.; // the largest force with these cracks; 0 where they run through at once
  };


  /** A brittle body whose cracks grow slowly, from the first state to the last. */
  struct GrowthTrace
  {
    std::vector<TracedState>         states;
    std::vector<GrowingCracks::Path> paths; // to a side, or as far as the loads bring them
    bool                             ends_early = false; // nothing later bears more
    bool                             is_stopped = false; // by TraceControl::may_go_on
    double                           step = 0., seconds = 0.;

    /** The one that bears most. */
    std::size_t strongest() const;

    /** By which share of its force a state between two of them may bear more. */
    double between_states() const;
  };


  /** How far a trace goes, and in which steps. */
  struct TraceControl
  {
    double                            step     = 0.;    // of the cracks
    bool                              to_end   = false; // even if nothing later bears more
    double                            fineness = 1.; // of meshes, against the coarsest that will do
    std::function<bool(const double)> may_go_on;     // after so many seconds of one state
  };


  /**
   * Follows cracks as Griffith has it, in a body at rest under loads in proportion to time: an end
   * grows, in the direction that releases most energy, when that is the fracture energy; it goes on
   * at once as long as it takes no larger loads. The body is computed by the model and mesh that
   * Attempts has for such a crack. All functions are collective and throw UserError.
   */
  template <int dim>
  class CrackTracer
  {
  public:
    CrackTracer(const Scene<dim>         &scene,
                const SceneText          &text,
                const MPI_Comm            communicator,
                const MeasuredError<dim> &measure);

    GrowthTrace follow(const GrowingCracks &cracks, const TraceControl &control) const;

    /** Entries of the body with these cracks and whole bonds, at the end of the run or before. */
    std::vector<Setting> settings(const GrowingCracks &cracks, const double end_time) const;

    /** The body that these are entries of. */
    std::shared_ptr<Scene<dim>> body_with(const GrowingCracks &cracks, const double end_time) const;

    /** What holds at a time, by the coarsest solution that will do, or one so many times finer. */
    TracedState state_of(const GrowingCracks &cracks,
                         const double         time,
                         const double         fineness) const;

    /** Throws UserError if loads are not in proportion to time, or press all cracks together. */
    void refuse_loads(const TracedState &state) const;

  private:
    double fineness_for(const GrowingCracks &cracks, const Attempts<dim> &attempts) const;

    const Scene<dim>         &scene;
    const SceneText          &text;
    const MPI_Comm            communicator;
    const MeasuredError<dim> &measure;
  };
} // namespace PeriDeal
