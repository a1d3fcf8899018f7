// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/partitioner.h>

#include <perideal/operators/bounds/spectrum.h>
#include <perideal/scene/body_parameters.h>

#include <memory>

namespace PeriDeal
{
  /**
   * What all models of diffusion have alike: unknowns, capacities, the diagonal and the bounds of
   * K, cracks that change with time, and flows that are summed up to a balance.
   */
  template <int dim>
  class DiffusionOperatorBase : public DiffusionOperator
  {
  public:
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
      this->residual_then(r, u, t, [](const unsigned int, const unsigned int) {});
    }

    const Vector &lumped_capacity() const override
    {
      return capacity;
    }

    bool capacity_is_diagonal() const override
    {
      return true;
    }

    void          apply_capacity(Vector &y, const Vector &x) const override;
    const Vector &diagonal() const override
    {
      return stiffness_diagonal;
    }

    Spectrum spectrum() const override
    {
      return bounds.get();
    }

    double next_event(const double t) const override
    {
      return history.next_event(t);
    }

    bool update(const double t) override;

    /**
     * Follow damage of a solid on the same nodes (ChangeSet::broken). Returns whether K has
     * changed; then steppers have to be restarted. Collective.
     */
    bool follow(ChangeSet<dim> change);

    bool depends_on_solution() const override
    {
      return body.material.depends_on_temperature();
    }

    bool capacity_depends_on_solution() const override
    {
      return body.material.storage_depends_on_temperature();
    }

    Balance      balance(const Vector &u, const double t, const bool steady) const override;
    std::string  place_of(const unsigned int local_index) const override;
    OperatorSize size() const override;

    /**
     * Numbers in [-1, 1] that look random but depend on the unknowns' positions alone. Collective.
     */
    const Vector &noise() const
    {
      return bounds.noise();
    }

  protected:
    using Layout = std::shared_ptr<const dealii::Utilities::MPI::Partitioner>;

    /**
     * @param start      time of the first cracks
     * @param layout     of the vectors; if null, set_layout() has to be called
     * @param fill_noise as of SpectralBounds
     */
    DiffusionOperatorBase(const BodyParameters<dim>           &body,
                          const double                         start,
                          const Layout                        &layout,
                          const std::function<void(Vector &)> &fill_noise);

    /** Sets capacity and diagonal to zero. Not collective. */
    void set_layout(const Layout &of_vectors);

    /** Mend what a change names. Returns whether K has changed. Collective. Throws UserError. */
    virtual bool apply_change(const ChangeSet<dim> &change) = 0;

    /**
     * Add to a balance what this process has, apart from what is stored, which is
     * @p heat = K u - f(t) of the unknowns that are free; where they are prescribed it comes from
     * outside. Collective.
     */
    virtual void find_flows(Balance      &balance,
                            Vector       &heat,
                            const Vector &u,
                            const double  t) const = 0;

    /** Of an owned unknown, for messages. Not collective. */
    virtual dealii::Point<dim> position(const unsigned int local_index) const = 0;

    const BodyParameters<dim> &body;
    Layout                     layout;
    const CrackHistory<dim>    history;
    double                     cracks_of; // representative time of the cracks in K
    Vector                     capacity, stiffness_diagonal;
    SpectralBounds             bounds;
  };
} // namespace PeriDeal
