// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <mpi.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * A number given as a formula of x, y, z and t (muparser syntax), compiled when it is read so
   * that a mistake in it is reported with its position before anything runs. It knows the names of
   * names_of_formulas(), but for those of its own variables. Copies and others of the same text
   * share the compiled form. Not thread safe.
   */
  class Expression
  {
  public:
    /** The constant zero. */
    Expression();

    Expression(const double constant); // a number is a formula, too

    /**
     * What a program computes itself, of a point (coordinates beyond dim are zero) and t.
     * @param depends_on_time else it has the same value at all times
     */
    Expression(const std::function<double(const dealii::Point<3> &, const double)> &function,
               const bool depends_on_time);

    /**
     * @param text  the formula
     * @param where entry and section for messages, for example "'Source' in section 'Initial and
     *              source'" Throws UserError with the position and what is wrong.
     * @param known the variables that messages list. That a formula has no others (t where nothing
     *              may change) is for the one who reads it to ask. Other names than x, y, z, t are
     *              those of the coordinates of value(), in their order.
     * @param with_temperature T is a variable, too
     */
    Expression(const std::string &text,
               const std::string &where,
               const std::string &known            = "x, y, z, t",
               const bool         with_temperature = false);

    /**
     * Value at a point; coordinates beyond dim are zero. Throws UserError if it is not finite, or
     * gives NaN while DeferredFormulaErrors collects such errors.
     */
    template <int dim>
    double value(const dealii::Point<dim> &p,
                 const double              t           = 0.,
                 const double              temperature = 0.) const;

    /** No x, y, z, t or T in it. */
    bool is_constant() const;

    bool depends_on_time() const;

    bool depends_on_position() const;

    bool depends_on_temperature() const;

    /**
     * Where to look for jumps and peaks, ascending: its numbers and the places of its tables, with
     * both signs, sums and differences of two that follow each other in the text, and the middles
     * in between. Empty without T.
     */
    const std::vector<double> &marked_temperatures() const;

    const std::string &text() const;

    /** Names that mean something in every formula: of variables, functions and constants. */
    static bool is_reserved(const std::string &name);

  private:
    void compile(const std::string &known, const bool with_temperature);

    template <int dim>
    void not_finite(const dealii::Point<dim> &p, const double t, const double temperature) const;

    struct Compiled;
    std::shared_ptr<Compiled> compiled;
    std::string               formula, where;
    double                    constant;
  };


  /**
   * Throws the UserError, or keeps it while DeferredFormulaErrors collects such errors: found when
   * a formula's value is used.
   */
  void report_formula_error(const std::string &message);


  /**
   * While this is alive, a formula whose value is not finite gives NaN, and the first such error is
   * kept instead of thrown.
   *
   * The processes evaluate formulas at different points. An error thrown by one of them alone would
   * leave the others waiting for it; the run asks here from time to time instead, on all processes
   * together. One at a time.
   */
  class DeferredFormulaErrors
  {
  public:
    DeferredFormulaErrors();
    ~DeferredFormulaErrors();
    DeferredFormulaErrors(const DeferredFormulaErrors &)            = delete;
    DeferredFormulaErrors &operator=(const DeferredFormulaErrors &) = delete;

    /**
     * Throws Diverged on every process if a formula failed on any: monitor `formulas`. Collective.
     */
    void throw_if_any(const MPI_Comm communicator) const;

    /** The first of these messages; empty if there is none. The same everywhere. Collective. */
    std::string first(const MPI_Comm communicator) const;

  private:
    friend class Expression;
    friend void report_formula_error(const std::string &message);
    std::string message;
  };

  /**
   * Do what asks formulas for values: those that are none there become everybody's UserError when
   * it has been done, so that no process waits for another that has thrown. Not within itself.
   * Collective.
   */
  void with_formulas(const MPI_Comm communicator, const std::function<void()> &action);
} // namespace PeriDeal
