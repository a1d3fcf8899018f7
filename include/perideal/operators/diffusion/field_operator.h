// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/bounds/spectrum.h>
#include <perideal/operators/diffusion/diffusion_loads.h>
#include <perideal/operators/diffusion/prescribed_values.h>
#include <perideal/operators/interface/diffusion_operator.h>
#include <perideal/operators/interface/term.h>
#include <perideal/scene/body_parameters.h>

#include <functional>
#include <memory>
#include <vector>

namespace PeriDeal
{
  /** What a FieldOperator is put together from. */
  template <int dim>
  struct FieldParts
  {
    using Visit = std::function<void(const unsigned int unknown, const dealii::Point<dim> &place)>;

    /** With the cracks of time @p start. Throws UserError, as BodyParameters::crack_history(). */
    explicit FieldParts(const BodyParameters<dim> &body, const double start = 0.)
      : start(start)
      , history(body.crack_history())
      , cracks_of(history.representative(start))
    {}

    double                                       start;
    CrackHistory<dim>                            history;
    double                                       cracks_of; // representative time of those in K
    DiffusionOperator::Layout                    layout;    // of vectors
    std::shared_ptr<Capacity>                    capacity;
    std::shared_ptr<const PrescribedValues<dim>> values;
    std::shared_ptr<DiffusionLoads<dim>>         loads;
    std::vector<std::shared_ptr<Term<dim>>>      terms; // the others add to what the first one sets

    /** Call for the owned unknowns, each once or several times. Not collective. */
    std::function<void(const Visit &)> for_each_place;
  };


  /**
   * Diffusion, in every model a list of terms with capacity, loads and prescribed values:
   *
   *   C_i du_i/dt = r_i = f_i(t) - sum over terms (K u)_i  of free unknowns.
   *
   * field_of_bonds() (peridynamics) and field_of_elements() (finite elements, with bonds or
   * without) put the parts together.
   */
  template <int dim>
  class FieldOperator : public DiffusionOperator
  {
  public:
    /** Collective. Throws UserError where nothing holds an unknown. The body must outlive this. */
    FieldOperator(const BodyParameters<dim> &body, const FieldParts<dim> &parts);

    void apply_then(Vector &y, const Vector &x, const RowsAction &finish) const override;
    void residual_then(Vector           &r,
                       const Vector     &u,
                       const double      t,
                       const RowsAction &finish) const override;

    void distribute(Vector &u, const double t) const override
    {
      parts.values->distribute(u, t);
    }

    void distribute_homogeneous(Vector &x) const override
    {
      parts.values->distribute_homogeneous(x);
    }

    void clear_constrained(Vector &y) const override
    {
      parts.values->mask(y);
    }

    Spectrum spectrum() const override;
    bool     symmetric() const override;
    bool     depends_on_time() const override
    {
      return parts.loads->depends_on_time();
    }

    bool has_steady_state() const override;
    void surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const override;
    bool surrogate_is_exact() const override
    {
      return first_term().surrogate_is_exact();
    }

    double next_event(const double t) const override
    {
      return parts.history.next_event(t);
    }

    bool update(const double t) override;

    /**
     * Follow damage of a solid on the same nodes (ChangeSet::broken). Returns whether K has
     * changed; then steppers have to be restarted. Collective.
     */
    bool follow(ChangeSet<dim> change);

    bool depends_on_solution() const override
    {
      return body.material.depends_on_temperature() || parts.loads->depends_on_solution();
    }

    void         take_material_at(const Vector &u, const double t) override;
    Balance      balance(const Vector &u, const double t, const bool steady) const override;
    std::string  place_of(const unsigned int local_index) const override;
    OperatorSize size() const override;

    /** y = K u of the terms with what is given from outside at time t. Collective. */
    void multiply(Vector &y, const Vector &u, const double t = 0.) const;

    /**
     * Numbers in [-1, 1] that look random but depend on the unknowns' positions alone. Collective.
     */
    const Vector &noise() const
    {
      return bounds.noise();
    }

    /** The one of the bonds or cells of the body: bonds_of() and cells_of() know more of it. */
    const Term<dim> &first_term() const
    {
      return *parts.terms[0];
    }

  private:
    bool apply_change(const ChangeSet<dim> &change);
    void take_all_rows(const RowsOfK::After after);

    const BodyParameters<dim> &body;
    FieldParts<dim>            parts;
    SpectralBounds             bounds;
    double                     rate_elsewhere = 0.; // than in DiffusionLoads::curved_rows()
    mutable Vector             scratch;             // where slaves have to be set
  };
} // namespace PeriDeal
