// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/diffusion/diffusion_loads.h>
#include <perideal/operators/diffusion/diffusion_operator_base.h>
#include <perideal/operators/diffusion/prescribed_values.h>
#include <perideal/operators/interface/term.h>

#include <initializer_list>
#include <vector>

namespace PeriDeal
{
  /**
   * A model of diffusion that is a list of terms, with loads and prescribed values:
   *
   *   r_i = f_i(t) - sum over terms (K u)_i  of free unknowns.
   *
   * Who derives from it makes the parts, says that they are complete (set_parts()), and mends them
   * when cracks move or conductivities change.
   */
  template <int dim>
  class FieldOperator : public DiffusionOperatorBase<dim>
  {
  public:
    using RowsAction = Operator::RowsAction;

    void apply_then(Vector &y, const Vector &x, const RowsAction &finish) const override;
    void residual_then(Vector           &r,
                       const Vector     &u,
                       const double      t,
                       const RowsAction &finish) const override;

    void distribute(Vector &u, const double t) const override
    {
      prescribed->distribute(u, t);
    }

    void distribute_homogeneous(Vector &x) const override
    {
      prescribed->distribute_homogeneous(x);
    }

    void clear_constrained(Vector &y) const override
    {
      prescribed->mask(y);
    }

    bool symmetric() const override;
    bool depends_on_time() const override
    {
      return loads->depends_on_time();
    }

    bool         has_steady_state() const override;
    void         surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const override;
    OperatorSize size() const override;

    /** y = K u of the terms with what is given from outside at time t. Collective. */
    void multiply(Vector &y, const Vector &u, const double t = 0.) const;

  protected:
    using Rows = Term::Rows; // owned unknowns, ascending

    using DiffusionOperatorBase<dim>::DiffusionOperatorBase;

    /** All must outlive this. The first of the terms sets what the others add to. */
    void set_parts(const PrescribedValues<dim>        &values,
                   const DiffusionLoads<dim>          &of_sides,
                   const std::initializer_list<Term *> list);

    /**
     * Take the diagonal of some rows from the terms, also where they are not free. Returns the sums
     * of the absolute values of their entries. Not collective.
     */
    std::vector<double> take_rows(const Rows &rows);

    /** All owned unknowns. */
    Rows all_rows() const;

    /** Gershgorin's bound of these rows on all processes, with take_rows()'s sums. Collective. */
    double largest_rate(const Rows &rows, const std::vector<double> &sums) const;

    /** Whether a row counts in Gershgorin's bound. */
    virtual bool counts(const unsigned int row) const = 0;

    /** The matrix of surrogate(), before rows and columns that are not free are cleared. */
    virtual void make_surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const = 0;

    /** Add what this process's bonds and cells conduct through cracks that conduct. Collective. */
    virtual void add_crack_heat(Balance &balance, const Vector &u) const = 0;

    /** Heat in this process's part of the body. Collective. */
    virtual double content(const Vector &u) const = 0;

  private:
    void find_flows(Balance &balance, Vector &heat, const Vector &u, const double t) const override;

    /** y = K u and finish; adds what flows in through terms and prescribed unknowns. */
    void add_up(Vector &y, const Term::At &at, double &entered, const RowsAction &finish) const;

    const PrescribedValues<dim> *prescribed = nullptr;
    const DiffusionLoads<dim>   *loads      = nullptr;
    std::vector<Term *>          terms;
    mutable Vector               scratch; // where slaves have to be set
  };
} // namespace PeriDeal
