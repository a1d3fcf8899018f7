// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/study/growing_cracks.h>

#include <functional>
#include <memory>
#include <optional>
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
    bool                             rests      = false; // before a side, at the end of the run
    double                           turned     = 0.;    // the largest angle at any place, radians
    double                           step = 0., grown = 0., seconds = 0.;

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
    std::optional<TracedState>        first = {};    // if known from a trace before
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
    using Ends = std::vector<GrowingCracks::End>;

    double fineness_for(const GrowingCracks &cracks, const Attempts<dim> &attempts) const;

    /** Around an end, for a ring by which its stress intensities are found. */
    double room(const GrowingCracks &cracks, const GrowingCracks::End &end) const;

    TracedState first_state(const GrowingCracks &cracks, const TraceControl &control) const;

    /** state_of(), with what would help where it cannot be computed. */
    TracedState next_state(const GrowingCracks &cracks, const TraceControl &control) const;

    /**
     * Lets those of the ends go straight on that have no room for a ring: to a side or another
     * crack that is near, else by a step, past a place that is held. Whether any did.
     */
    bool pass_unseen(const TracedState &now,
                     const Ends        &growing,
                     const double       step,
                     GrowingCracks     &cracks,
                     unsigned int      &n_passed) const;

    /** The state between the last one, whose cracks grow, and one that wants larger loads. */
    void rest_before(TracedState       &&now,
                     const TraceControl &control,
                     const double        reached,
                     const double        best,
                     GrowthTrace        &trace) const;

    const Scene<dim>         &scene;
    const SceneText          &text;
    const MPI_Comm            communicator;
    const MeasuredError<dim> &measure;
  };
} // namespace PeriDeal
