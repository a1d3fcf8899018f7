// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/base/diverged.h>
#include <perideal/operators/solid/elastic_operator.h>

#include <limits>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * Work of the loads and of the supports of a body along its way, by the trapezoidal rule: wrong
   * by O(step^2). Vectors are allocated once.
   */
  class WorkOfForces
  {
  public:
    /** @param op is referred to. */
    explicit WorkOfForces(ElasticOperator &op);

    /**
     * The next step starts here, at time t. @param unbalanced ElasticOperator::unbalanced() there:
     * what is left of it at prescribed unknowns is what the supports bear.
     */
    void begin(const Vector &unbalanced, const double t);

    /**
     * Work (J; in 2D per unit thickness) of a step to time t, and begin() there. Collective.
     * @param from displacements before the step @param to after it
     */
    double step(const Vector &from, const Vector &to, const Vector &unbalanced, const double t);

    /**
     * What step() has counted too much (below 0: too little) where the supports' forces at its end
     * have become those of @p unbalanced little by little as it went on, and not at its end: half
     * of what they lost times their way. begin() is still to be called. Collective.
     */
    double counted_too_much(const Vector &from, const Vector &to, const Vector &unbalanced) const;

    /** What the next step depends on. Collective. */
    void exchange(Archive &archive, const NodeKeys &keys);

    /** Loads without the supports' forces at the end of the last step. */
    const Vector &loads() const
    {
      return load;
    }

  private:
    void find_active();
    void find_load(const double t);
    void find_forces(const Vector &unbalanced);

    ElasticOperator          &op;
    const std::vector<bool>   held;   // prescribed unknowns
    std::vector<unsigned int> active; // prescribed or loaded: elsewhere forces are zero
    bool                      begun = false;
    Vector                    load, forces, last_forces;
  };


  /**
   * Energies of a moving body (J; in 2D per unit thickness).
   *
   * With H the sum of kinetic and strain energy steps of `verlet` keep H - dt^2/8 a.Ma of linear
   * bodies exactly, a the accelerations, those of `newmark` H. So with `verlet` H goes up and down
   * with the accelerations, by an amount of order dt^2, and changes for good where these jump
   * because a load sets in or bonds break: the imbalance. The drift is what the steps have made
   * beside that.
   */
  struct MotionEnergy
  {
    double kinetic = 0., strain = 0.;
    double start    = 0.; // kinetic and strain energy at the start
    double work     = 0.; // of loads and supports since then
    double released = 0.; // by bonds that broke or joined a zone, and by cracks, since then
    double drift =
      0.; // change of what the steps keep, less the work: of linear bodies round-off at any step
    // The most that start and work together have been so far: what the others are to be compared
    // with.
    double exchanged = 0.;

    /**
     * What has come from nowhere: of order dt^2 with `verlet`, round-off of the linear solver with
     * `newmark` and linear kinematics.
     */
    double imbalance() const
    {
      return kinetic + strain + released - start - work;
    }
  };


  /**
   * The account that a stepper keeps of the energy of a motion, from its start on. Forces are those
   * that are unbalanced, at the displacement that is meant. Functions are collective.
   */
  class MotionAccount
  {
  public:
    /**
     * All have to outlive this object.
     * @param held the prescribed unknowns
     * @param c    steps of linear bodies conserve the energy H - c dt^2 a.Ma
     */
    MotionAccount(ElasticOperator           &op,
                  const std::vector<double> &inverse_mass,
                  const std::vector<double> &free_inverse_mass,
                  const std::vector<bool>   &held,
                  const double               c);

    /** What the steps of linear bodies keep back of the energy: c dt^2 a.Ma of the last step. */
    double kept_back(const Vector &forces) const;

    /** The steps begin, or go on behind an abrupt change of the motion. @param before kept back */
    void begin(const Vector &u,
               const Vector &v,
               const Vector &forces,
               const double  t,
               const double  before);

    /** Before each step; another one than the last keeps back something else. */
    void set_step(const double dt, const Vector &forces);

    /** A step has been made to t. @param from displacements before @param to after it */
    void add_step(const Vector &from, const Vector &to, const Vector &forces, const double t);

    /** Bonds have broken at t, between two steps. @param before kept back */
    void add_jump(const Vector &forces, const double t, const double before);

    double step() const
    {
      return step_now;
    }

    MotionEnergy energy(const Vector &u, const Vector &v, const Vector &forces) const;

    /**
     * What has gone wrong: values that are not finite, or for some steps now much more energy than
     * has come in, as it goes behind the name of a stepper.
     */
    Trip fault(const Vector &v, const unsigned long long n_steps);

    /**
     * What the steps have made or lost, as it goes behind the name of a stepper, where that is more
     * than a share of what has come in. Empty: it is not.
     */
    std::string drift_fault(const MotionEnergy &found, const double allowed) const;

    bool has_begun() const
    {
      return started;
    }

    /** All that it has kept. Collective. */
    void exchange(Archive &archive, const NodeKeys &keys);

  private:
    enum class Nodes
    {
      all,
      held,
      free
    };

    double kinetic_energy(const Vector &v, const Nodes which) const;
    double kept_back(const double dt, const Vector &forces) const;

    ElasticOperator           &op;
    const std::vector<double> &inverse_mass, &free_inverse_mass; // 0 where prescribed
    const std::vector<bool>   &held;
    WorkOfForces               work_of_forces;
    const double               c;
    bool                       started = false;
    double                     start = 0., work = 0., effort = 0., support_start = 0.;
    double                     step_now  = 0.; // the last one
    double                     jumps     = 0.; // of what steps keep back
    double                     exchanged = 0.; // the most that start and work have been so far
    static constexpr auto      never     = std::numeric_limits<unsigned long long>::max();
    unsigned long long suspected_at = never; // the step with more energy since than has come in
  };
} // namespace PeriDeal
