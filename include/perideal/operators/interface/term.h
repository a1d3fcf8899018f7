// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/interface/operator.h>

#include <vector>

namespace PeriDeal
{
  /**
   * One of the terms that K u of a field is the sum of: what bonds conduct, what cells do, what
   * enters through sides. The unknowns may have one component or several, interleaved; rows are
   * owned unknowns.
   *
   * A term that is not linear in u has a value and a tangent, the one for residuals and the other
   * for directions (At). Vectors must come from the operator. Not collective unless stated.
   */
  class Term
  {
  public:
    using Rows = std::vector<unsigned int>; // ascending

    /** What a term acts on. */
    struct At
    {
      const Vector &u;
      double        time;                 // of what is given from outside
      bool          is_direction = false; // what is given is left out, and the term is its tangent
    };

    virtual ~Term() = default;

    /**
     * Once before the sums over rows, for all that is not in their own unknowns. Adds to @p
     * entering what flows into the body through this term, per time. Collective.
     */
    virtual void begin(const At & /*at*/, double & /*entering*/) const {}

    /**
     * Add the term to y in the rows [begin, end). Asked of terms that are not the first: ghosts of
     * u are up to date if that one has use for them.
     */
    virtual void add(Vector            &y,
                     const At          &at,
                     const unsigned int begin,
                     const unsigned int end) const = 0;

    /**
     * Set all rows of y to the term, and finish as in Operator::apply_then(): the first of several
     * terms, the others are added in finish. Collective.
     */
    virtual void set_then(Vector &y, const At &at, const Operator::RowsAction &finish) const
    {
      y = 0.;
      add(y, at, 0, y.locally_owned_size());
      finish(0, y.locally_owned_size());
    }

    /** Add the diagonal of these rows. */
    virtual void add_diagonal(Vector &diagonal, const Rows &rows) const = 0;

    /** Add the absolute values of all entries of rows[k] to sums[k]. */
    virtual void add_row_sums(std::vector<double> &sums, const Rows &rows) const = 0;

    virtual bool symmetric() const
    {
      return true;
    }

    /** Add what flows into the body through sides, by name. Collective. */
    virtual void add_flows(Balance & /*balance*/, const At & /*at*/) const {}

    /** Collective. */
    virtual void add_to(OperatorSize &size) const = 0;
  };
} // namespace PeriDeal
