// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/partitioner.h>

#include <perideal/operators/interface/operator.h>
#include <perideal/operators/solid/break_history.h>
#include <perideal/operators/solid/force_balance.h>
#include <perideal/scene/change_set.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * Where a body has been turned inside out: nodes have passed through neighbours to which bonds or
   * elements hold them.
   */
  struct Inversion
  {
    unsigned long long n_nodes = 0;
    std::string
      place; // of the worst of them in the undeformed body, as `(x, y)`; empty if there are none
  };


  /**
   * A body of linear elastic material: M u'' = f(t) - K u, u the displacement. Component c of node
   * i is the unknown dim i + c. K is symmetric and positive semidefinite, its null space the rigid
   * motions of the body and of parts that nothing holds together. C of the interface is the lumped
   * mass M.
   *
   * Where nonlinear(), residual() is that of the deformed body, and K of apply() its tangent at the
   * last linearize(), at first that of the undeformed body; multiply() leaves contact out.
   */
  class ElasticOperator : public Operator
  {
  public:
    /**
     * Reactions, tractions and body forces at a state of rest; u must have been through
     * distribute(u, t). Collective.
     */
    virtual ForceBalance forces(const Vector &u, const double t) const = 0;

    /** The strain energy (J; in 2D per unit thickness), thermal strain taken off. Collective. */
    virtual double energy(const Vector &u) const = 0;

    /** y = K x without conditions. Collective. */
    virtual void multiply(Vector &y, const Vector &x) const = 0;

    /**
     * As residual(), but of all unknowns: of those that are prescribed it is minus the force of the
     * support. Collective.
     */
    virtual void unbalanced(Vector &r, const Vector &u, const double t) const = 0;

    /** Gives a vector the layout of one number for each node. Not collective. */
    void initialize_nodal_vector(Vector &vector) const
    {
      vector.reinit(nodal.layout);
    }

    /**
     * Let the body be warmer at its nodes by so much than when it is unstressed. K stays as it is
     * unless moduli follow the temperature. A new equilibrium is to be found. Collective.
     */
    virtual void set_temperature_change(const Vector &nodal) = 0;

    /**
     * What set_temperature_change() was given, with up-to-date ghosts; empty: the formula of the
     * scene holds.
     */
    const Vector &temperature_change() const
    {
      return nodal.temperature_change;
    }

    /**
     * Tractions and body forces at time t, all unknowns; thermal strain loads nothing. Collective.
     */
    virtual void mechanical_loads(Vector &loads, const double t) const = 0;

    /**
     * y = D v, zero on unknowns that are not free: a viscosity of one second, that is, K's own
     * forces at the rate v of u. D is symmetric and damps no rigid motion. Collective.
     */
    virtual void damping_force(Vector &y, const Vector &v) const
    {
      apply(y, v);
    }

    /** At least the largest eigenvalue of M^{-1} D. Collective. */
    virtual double damping_bound() const
    {
      return spectrum().sharp;
    }

    /** At least (as sharp_bound() is) the largest eigenvalue of diag(K)^{-1} K. Collective. */
    double scaled_bound() const;

    /** The forces are not linear in the displacement. Not collective. */
    virtual bool nonlinear() const
    {
      return false;
    }

    /** Make K the tangent at u. Collective. */
    virtual void linearize(const Vector &) {}

    /**
     * Laws that know what the body went through go on from u at time t. Until then states of any
     * later time may be tried. Collective.
     */
    virtual void accept(const Vector & /*u*/, const double /*t*/) {}

    /**
     * How far K may be from that at rest: the largest |Y|/x - 1, either sign, of bonds Y that were
     * x long, or excess of a slope over 1; 0 where nonlinear() is not. Collective.
     */
    virtual double largest_stretch(const Vector & /*u*/) const
    {
      return 0.;
    }

    /**
     * The nodes at which a corner of a cell that u deforms has no positive volume (cell_corners());
     * those do not count that have lost a bond, since what has broken off may fold over.
     * Collective.
     */
    virtual Inversion inverted(const Vector & /*u*/) const
    {
      return {};
    }

    /** Null: no bonds of the body may break. Not collective. */
    virtual const BreakHistory *break_history() const
    {
      return nullptr;
    }

    bool brittle() const
    {
      return break_history() != nullptr;
    }

    /**
     * The bonds between nodes that have broken since there were @p n_known marks on this process,
     * which becomes what there are now; each by the process that has its first node. Not
     * collective.
     */
    virtual std::vector<NodePair> broken_since(std::size_t & /*n_known*/) const
    {
      return {};
    }

    /**
     * Break for good what is stretched too far at u, which must have been through distribute().
     * Returns how many bonds; K and its diagonal have changed if any, and its spectrum has hardly
     * grown (none of the springs; dilatations of more than a pressure may a little). Collective.
     *
     * @param t     the time of u, kept with each bond
     * @param share of the largest stretch over critical stretch: only bonds above it
     */
    virtual unsigned long long break_bonds(const Vector & /*u*/,
                                           const double /*t*/,
                                           const double /*share*/ = 0.)
    {
      return 0;
    }

    /** Largest stretch over critical stretch of bonds at u, distributed; 0: unknown. Collective. */
    virtual double stretch_over_critical(const Vector & /*u*/, const double /*t*/)
    {
      return 0.;
    }

    /**
     * Make the cracks of the scene those of the span of time between events that holds t: nodes
     * join the zone, then bonds and cells are cut, which gives up energy at u. Returns whether K
     * and its diagonal have changed. Collective. Throws UserError where a node loses its hold.
     */
    virtual bool grow_cracks(const Vector & /*u*/, const double /*t*/)
    {
      return false;
    }

    /**
     * Let nodes join the zone of a coupling where u has stretched the body, before bonds break
     * there. Returns whether K has changed. Collective.
     */
    virtual bool widen_zone(const Vector & /*u*/)
    {
      return false;
    }

    /** Find what touches at u, and return as SolidContact::update() does. Collective. */
    virtual bool update_contact(const Vector & /*u*/)
    {
      return false;
    }

    /** Something is there that update_contact() may find. Not collective. */
    bool may_touch() const
    {
      return has_contact;
    }

    /**
     * unbalanced() at the u and t of the last widen_zone() and break_bonds(), behind which nothing
     * else has changed. @p r is the latest that was found of the body before. Collective.
     */
    virtual void mend_unbalanced(Vector &r, const Vector &u, const double t) const
    {
      unbalanced(r, u, t);
    }

    /**
     * Cells outside of the zone of a coupling beyond the critical stretch, without bonds to break:
     * how many, and the place of the worst as `(x, y)`. Collective.
     */
    virtual std::pair<unsigned long long, std::string> stretched_outside(const Vector & /*u*/) const
    {
      return {};
    }

    struct
    {
      bool         follow        = false; // diagonal(), surrogate() need not know which bonds break
      unsigned int between_looks = 25;    // how many until one asks for largest_stretch() again
      double       load_factor = 1.; // of loads and prescribed displacements, of no thermal strains
      bool scales_loads = false, symmetric_law = true; // LoadControl; K, of forces that balance
    } stepping;                                        // what steppers and load steps ask for

    /** Some strain energy may be released: bonds break, or cracks grow. Not collective. */
    bool may_release_energy() const
    {
      return brittle() || has_growing_cracks();
    }

    /** Not collective. */
    bool has_growing_cracks() const
    {
      return next_event(0.) < std::numeric_limits<double>::infinity();
    }

    /** Nodes join the zone of a coupling as cracks grow. Not collective. */
    virtual bool zone_follows_cracks() const
    {
      return false;
    }

    /** But for that of bonds that broke. Not collective. */
    const ReleasedEnergy &released() const
    {
      return released_beside;
    }

    /** All of it, by broken bonds, too. Not collective. */
    double released_energy() const;

    unsigned long long n_broken_bonds() const;

    /** Where; empty while none have. Not collective. */
    const BreakPlaces &break_places() const;

    void exchange(Archive &archive, const NodeKeys &keys) override;

    bool symmetric() const override
    {
      return stepping.symmetric_law;
    }

    void apply_capacity(Vector &y, const Vector &x) const override
    {
      y = x;
      y.scale(lumped_capacity());
    }

  protected:
    /** Numbers that look random but depend on the unknowns' places alone. Not collective. */
    virtual void fill_noise(Vector &vector) const = 0;

    ReleasedEnergy released_beside;
    bool           has_contact = false;

    struct
    {
      std::shared_ptr<const dealii::Utilities::MPI::Partitioner> layout; // of one number for each
      Vector                                                     temperature_change; // or empty
    } nodal;

    /** Keeps what temperature_change() gives. Collective. */
    void keep_temperature_change(const Vector &nodal);
  };
} // namespace PeriDeal
