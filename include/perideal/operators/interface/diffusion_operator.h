// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>

#include <perideal/operators/interface/capacity.h>
#include <perideal/operators/interface/operator.h>

#include <memory>

namespace PeriDeal
{
  /**
   * A model of diffusion: u is a temperature, a wetness or a potential, and heat, moisture or
   * charge is conserved. What steppers ask of it, with the unknowns, their capacity and the
   * diagonal of K.
   */
  class DiffusionOperator : public Operator
  {
  public:
    using Layout = std::shared_ptr<const dealii::Utilities::MPI::Partitioner>;

    void initialize_vector(Vector &vector) const override
    {
      vector.reinit(layout);
    }

    void apply(Vector &y, const Vector &x) const override
    {
      this->apply_then(y, x, [](const unsigned int, const unsigned int) {});
    }

    void residual(Vector &r, const Vector &u, const double t) const override
    {
      residual_then(r, u, t, [](const unsigned int, const unsigned int) {});
    }

    /** As residual(), with finish as in apply_then(). */
    virtual void residual_then(Vector           &r,
                               const Vector     &u,
                               const double      t,
                               const RowsAction &finish) const = 0;

    /**
     * What entered, per time, through the sides and from sources at the last residual(): this
     * process's share of Balance::throughput(), read off the rows of prescribed unknowns. After
     * apply() the part of it that is linear in x. Not collective.
     */
    double entering() const
    {
      return entering_now;
    }

    const Vector &lumped_capacity() const override
    {
      return capacity->lumped();
    }

    /** Whether C is its diagonal: explicit steppers need that. Not collective. */
    bool capacity_is_diagonal() const
    {
      return capacity->is_diagonal();
    }

    void apply_capacity(Vector &y, const Vector &x) const override
    {
      capacity->apply(y, x);
    }

    /** C depends on the solution. Not collective. */
    bool capacity_depends_on_solution() const
    {
      return capacity->depends_on_solution();
    }

    /**
     * y = what each unknown takes up from the temperatures u to v: the integral of C along the
     * straight line between both, whatever take_material_at() was given. The sum of y is the change
     * of the content of the body.
     */
    void heat_between(Vector &y, const Vector &u, const Vector &v) const
    {
      capacity->heat_between(y, u, v);
    }

    /** Heat in the body; u has been through distribute(). */
    double heat(const Vector &u) const
    {
      return dealii::Utilities::MPI::sum(capacity->content(u), layout->get_mpi_communicator());
    }

    const Vector &diagonal() const override
    {
      return stiffness_diagonal;
    }

    /**
     * Some unknown is prescribed or held by transfer, so that a steady state is determined. Not
     * collective.
     */
    virtual bool has_steady_state() const = 0;

    /**
     * Make K that of the span of time between events that holds t (an event belongs to the span
     * that begins with it). Returns whether K has changed; then steppers have to be restarted. Heat
     * stays where it is: only conductances change.
     */
    virtual bool update(const double t) = 0;

    /**
     * K, C or loads depend on the solution itself: a conductivity, a capacity, a source or what
     * enters through a side is a function of the temperature. Not collective.
     */
    virtual bool depends_on_solution() const = 0;

    /**
     * Make K and C those of the temperatures u, which must have been through distribute(u, t), and
     * sources and what enters through sides their tangents there. Bounds and diagonals change with
     * them, and so do values of slaves: distribute() again before residual().
     */
    virtual void take_material_at(const Vector &u, const double t) = 0;

    /**
     * Heat through each side and in the body; u must have been through distribute(u, t). @p steady
     * leaves out storage.
     */
    virtual Balance balance(const Vector &u, const double t, const bool steady) const = 0;

  protected:
    DiffusionOperator(const Layout &of_vectors, const std::shared_ptr<Capacity> &stored)
      : layout(of_vectors)
      , capacity(stored)
      , stiffness_diagonal(of_vectors)
    {}

    const Layout                    layout;
    const std::shared_ptr<Capacity> capacity;
    Vector                          stiffness_diagonal;
    mutable double                  entering_now = 0.; // of entering()
  };
} // namespace PeriDeal
