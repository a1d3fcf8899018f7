// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/elastic_operator.h>
#include <perideal/solvers/findings.h>
#include <perideal/solvers/load_control.h>
#include <perideal/solvers/motion_energy.h>
#include <perideal/solvers/static_solver.h>
#include <perideal/solvers/step_span.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * The motion of a body of density one under loads and supports at rest, in which bonds break as
   * they do in any motion: at the step at which they are stretched too far. A crack between two
   * equilibria finds its way so, hardly drawn to the rows of the lattice. (Equilibria after each
   * break hold it back at each bond, most of all where it would leave a row.) The damping,
   * proportional to the mass, halves waves on their way through 70 horizons; what still moves when
   * the last bond has broken is left to the next equilibrium.
   *
   * Steps are those of velocity Verlet, of second order also where bonds break: each half of a step
   * takes the forces of the bonds there are in it. One more application where bonds have broken.
   */
  class BreakingMotion
  {
  public:
    /** @param op is referred to. @param share of the stable step; 0 to 1. */
    explicit BreakingMotion(ElasticOperator &op, const double share = 0.9);

    /**
     * From u at rest, distributed, until no bond has broken for a while. Returns the number of
     * steps. Collective.
     */
    unsigned int run(Vector &u, const double t);

    /**
     * What the last run took from the body but what bonds released: by damping, and what still
     * moved at its end. Strain energy and work of loads balance it to O(step^2). Collective.
     */
    double lost() const;

    /** The spectrum of K may have grown. Not collective. */
    void operator_changed()
    {
      step = 0.;
    }

    /** What the next run depends on. Collective. */
    void exchange(Archive &archive)
    {
      archive.exchange("step of breaking", step);
    }

  private:
    void   choose_step();
    double kinetic_energy() const; // on this process

    ElasticOperator          &op;
    const double              share;
    const std::vector<double> inverse_mass;
    double                    step   = 0.; // 0: to be chosen
    double                    damped = 0.; // energy, in the last run, on this process
    Vector                    velocity, residual;
  };


  /**
   * Energies of a body that goes from one equilibrium to the next (J; in 2D per unit thickness).
   */
  struct LoadingEnergy
  {
    double strain    = 0.;
    double start     = 0.; // strain energy of the first equilibrium, before any bond broke
    double work      = 0.; // of loads and supports since then
    double exchanged = 0.; // the most that start and work together have been so far
    // By broken bonds and growing cracks, and by the motion that a real body would make before it
    // is at rest again.
    double dissipated = 0.;

    /**
     * What has come from nowhere: the rounding of the solver where forces are linear and loads
     * change in proportion, else of second order in the load step. What is dissipated follows from
     * the balance of energy while bonds break, so that this tells of the steps between.
     */
    double imbalance() const
    {
      return strain + dissipated - start - work;
    }
  };


  /**
   * A body under loads that change so slowly that it is always at rest: equilibria at one load
   * after the other, at each of which cracks grow to where they are by then, and bonds break until
   * none is stretched too far. A step is divided where loads would stretch bonds by more than a few
   * percent of the critical stretch beyond it. Of the bonds that are stretched too far the most
   * stretched break first; what breaks then breaks in a damped motion (BreakingMotion), or, if that
   * is not wanted or would shatter the body, is asked for again in the new equilibrium. Or loads go
   * back where bonds break (LoadControl). Vectors are allocated once.
   */
  class SlowLoading
  {
  public:
    /** @param solver of equilibria, made with @p options */
    SlowLoading(ElasticOperator              &op,
                std::unique_ptr<StaticSolver> solver,
                const StaticOptions          &options);

    /**
     * The first equilibrium, at time t; u is overwritten. Collective. Throws UserError as step()
     * does.
     */
    void begin(Vector &u, const double t);

    /**
     * From the equilibrium u to that at time t. Bonds break in rounds; after each @p after_round is
     * called with the new equilibrium, when all that the next rounds depend on can be kept. Where
     * bonds are going to break @p before_breaks is called with the equilibrium of the time it is
     * given, within the step where that is divided: forces may be larger than at both of its ends.
     * Collective. Throws UserError if there is none to be found, among others since the body has
     * come apart under loads that nothing bears any more; u is the last equilibrium then. So it
     * does where full kinematics end with the body inside out.
     */
    void step(Vector          &u,
              const double     t,
              const AfterStep &after_round   = {},
              const AfterStep &before_breaks = {});

    /** The rest of a step whose beginning was kept by exchange(); as step(). Collective. */
    void go_on(Vector &u, const AfterStep &after_round = {}, const AfterStep &before_breaks = {});

    /**
     * The equilibrium again, at the time of the last one, after thermal loads have changed: no step
     * of its own. Throws UserError as step() does. Collective.
     */
    void renew(Vector &u);

    /** Moduli have changed. Not collective. */
    void stiffness_changed()
    {
      solver->stiffness_changed();
      if (breaks.motion)
        breaks.motion->operator_changed();
    }

    /** Within a step: there is a rest to go_on() with. */
    bool is_inside_step() const
    {
      return breaking.is_open;
    }

    /**
     * All that the next steps depend on besides u, which the caller keeps, and the operator.
     * Collective.
     */
    void exchange(Archive &archive, const NodeKeys &keys);

    /** Energies at u, the last equilibrium. Collective. */
    LoadingEnergy energy(const Vector &u) const;

    unsigned int n_steps() const
    {
      return counts.steps;
    }

    /** What has been found wrong with equilibria so far. Not collective. */
    Findings &findings()
    {
      return found;
    }

    /** How often a load step has been halved since no equilibrium was found at its end. */
    unsigned int n_divisions() const
    {
      return counts.divisions;
    }

    /** The smallest share of the loads of a time that were borne (LoadControl). */
    double least_load_factor() const
    {
      return breaks.control ? breaks.control->least_factor() : 1.;
    }

    /** Of the solver so far. */
    unsigned int n_iterations() const
    {
      return counts.iterations;
    }

  private:
    /** A step that is divided where no equilibrium is found at its end. */
    struct Division
    {
      static constexpr double most_parts = 16.;

      double whole = 0.; // length of the step
      double last  = 0.; // of the last part, where steps are divided
    };

    /** The rounds of breaking in an equilibrium. */
    struct Breaking
    {
      double   time = 0., energy = 0.; // of that of the last round
      bool     any = false, is_open = false;
      double   goal = 0.; // the time at which the step ends
      double   most = 0.; // stretch over critical stretch after the last rounds
      Division division;
    };

    /** What the last step brought before bonds broke, from which the next one is guessed. */
    struct LastStep
    {
      Vector state; // the equilibrium before the step
      Vector change;
      double start = 0.;
      bool   any   = false;
    };

    /** @param may_be_left the caller puts u back where StepLeft is thrown */
    void solve(Vector &u, const double t, const bool may_be_left = false);
    void reach(Vector &u, const AfterStep &before_breaks, const bool may_be_left = false);
    void find_equilibrium(Vector &u, const double t, const bool may_be_left);
    /** find_equilibrium() at the goal or, where there is none, before it. Returns when. */
    double find_next_equilibrium(Vector &u, const bool may_be_left);
    /**
     * From the equilibrium at time t. Returns the time, and the largest stretch over the critical
     * one then; 0: unknown.
     */
    std::pair<double, double> shorten(Vector &u, const double t);

    bool break_bonds(Vector &u, const double t);
    void change_bonds(Vector &u, const double t, const AfterStep &after_round);
    /** Of loads and supports, in a round in which bonds have changed. @p last is overwritten. */
    double work_since(Vector &last, const Vector &u, const double t);
    void   check_inversion(Vector &u, const double t);

    ElasticOperator              &op;
    std::unique_ptr<StaticSolver> solver;
    const StaticOptions           options;
    struct
    {
      std::optional<BreakingMotion> motion; // where bonds break in one
      std::optional<LoadControl>    control;
    } breaks;
    LastStep before;
    struct
    {
      Vector unbalanced, scratch;
    } memory;
    WorkOfForces work_of_forces;
    struct
    {
      double time = 0.;
      double size = 0.; // of the residual of the largest load so far, by which others are measured
    } reached;
    struct
    {
      unsigned int iterations = 0, steps = 0, divisions = 0;
    } counts;
    LoadingEnergy so_far;
    Breaking      breaking;
    Findings      found;
  };
} // namespace PeriDeal
