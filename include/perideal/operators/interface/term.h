// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/exceptions.h>

#include <perideal/operators/interface/operator.h>
#include <perideal/scene/change_set.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** What a change of cracks has made of terms. */
  struct Mended
  {
    std::vector<unsigned int> rows; // of K that differ now, ascending

    /**
     * Rates can have grown; the same on all processes. Where bonds and cells are only cut, the old
     * bounds still hold.
     */
    bool stiffer = false;

    /**
     * The sharp bound of iterations that start with noise in these rows alone, and end once they
     * come down to @p enough; negative if they are not possible. Empty: all of K is asked again,
     * when somebody wants to know. Collective.
     */
    std::function<
      double(const std::vector<unsigned int> &rows, const Vector &noise, const double enough)>
      local_bound;

    /** Add what has become of another term. */
    void add(Mended other)
    {
      if (rows.empty())
        rows = std::move(other.rows);
      else if (!other.rows.empty())
        {
          std::vector<unsigned int> both;
          std::set_union(rows.begin(),
                         rows.end(),
                         other.rows.begin(),
                         other.rows.end(),
                         std::back_inserter(both));
          rows = std::move(both);
        }
      if (stiffer && other.stiffer) // nobody knows of both together
        local_bound = nullptr;
      else if (other.stiffer || !local_bound)
        local_bound = std::move(other.local_bound);
      stiffer = stiffer || other.stiffer;
    }
  };


  /** Some rows of K, as all terms have them. */
  struct RowsOfK
  {
    /** Why they are looked at. */
    enum class After
    {
      start,
      change,
      new_temperatures
    };

    const After                      after;
    const std::vector<unsigned int> &rows;
    const std::vector<double>       &sums; // of the absolute values of entries
    const Vector                    &diagonal;
    const double                     largest_rate; // Gershgorin's bound before a change
  };


  /**
   * One of the terms that K u of a field is the sum of: what bonds conduct, what cells do, what
   * enters through sides. The unknowns may have one component or several, interleaved; rows are
   * owned unknowns.
   *
   * A term that is not linear in u has a value and a tangent, the one for residuals and the other
   * for directions (At). Vectors must come from the operator. Not collective unless stated.
   */
  template <int dim>
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

    /**
     * Add the diagonal of these rows, and the absolute values of all entries of rows[k] to sums[k].
     */
    virtual void add_rows(Vector &diagonal, std::vector<double> &sums, const Rows &rows) const = 0;

    virtual bool symmetric() const
    {
      return true;
    }

    /** Mend what a change names. Returns what has changed. Collective. Throws UserError. */
    virtual Mended apply_change(const ChangeSet<dim> & /*change*/)
    {
      return {};
    }

    /** Be the term of temperatures, which have been through distribute(). Collective. */
    virtual void take_material_at(const Vector & /*u*/) {}

    /**
     * Throw UserError where nothing holds an unknown of these rows, or nothing positive.
     * Collective.
     */
    virtual void require_held(const RowsOfK & /*of_all*/) const {}

    /**
     * Make the matrix of Operator::surrogate() before rows and columns that are not free are
     * cleared. Of the first term alone. @param others the diagonal of all others, which belongs to
     * it. Collective.
     */
    virtual void make_surrogate(dealii::TrilinosWrappers::SparseMatrix & /*matrix*/,
                                const Vector & /*others*/) const
    {
      Assert(false, dealii::ExcMessage("This is never the first of terms."));
    }

    /** As that of Operator; of the first term alone. */
    virtual bool surrogate_is_exact() const
    {
      return false;
    }

    /** Add what flows into the body through sides, by name, and through cracks. Collective. */
    virtual void add_flows(Balance & /*balance*/, const At & /*at*/) const {}

    /** Collective. */
    virtual void add_to(OperatorSize &size) const = 0;
  };
} // namespace PeriDeal
