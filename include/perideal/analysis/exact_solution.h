// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/decay_rate.h>
#include <perideal/scene/choices.h>

#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * A known solution of a problem, to measure errors against: the diffusing quantity, or the
   * displacement of a body. Coordinates are those of the scene.
   */
  class ExactSolution
  {
  public:
    virtual ~ExactSolution() = default;

    /**
     * A component at the point x (dim numbers) and time t >= 0; not a number where the solution has
     * no single value.
     */
    virtual double value(const double *x, const double t, const unsigned int component) const = 0;

    /**
     * Write the spatial gradient of a component (dim numbers) if it is known; false, and nothing
     * written, if not.
     */
    virtual bool gradient(const double      *x,
                          const double       t,
                          const unsigned int component,
                          double            *g) const = 0;

    /** Of the first component. */
    double value(const double *x, const double t) const
    {
      return value(x, t, 0);
    }

    bool gradient(const double *x, const double t, double *g) const
    {
      return gradient(x, t, 0, g);
    }
  };


  /** What an exact solution may need to know of the scene. */
  struct ExactSolutionContext
  {
    unsigned int             dim = 2;
    std::vector<double>      lower{0., 0.}, upper{1., 1.}; // corners of the box
    double                   conductivity = 1., storage = 1.;
    std::vector<LatticeTerm> family;        // for lattice harmonics; may be empty
    double                   horizon  = 0.; // for nonlocal harmonics; zero: none
    KernelShape              kernel   = KernelShape::conical;
    unsigned int             exponent = 2;
    std::string no_named; // why the named solutions do not suit the scene; empty: they do
  };


  /**
   * The solution that the entry `Solution` in section `Reference` asks for: a name, or an
   * expression of x, y, z, t.
   *
   * - `bobaru 2010 example 1`, `2`, `3` and `bobaru 2012 example 1`, `2`: the classical series of
   *   the papers, misprints corrected (see HeatSeries), with their temperatures; the box and the
   *   diffusivity come from the scene, so that it may be scaled. All but 2012 example 1 (2D only)
   *   depend on x alone and hold in any dimension with insulated sides.
   * - `lattice harmonic(n1, ...)`: prod_a sin(n_a pi (x_a - lower_a)/L_a) exp(-lambda t), one
   *   positive integer per dimension, with the rate of the lattice: exact for the semi-discrete
   *   peridynamic equations with odd continuation at the sides.
   * - `nonlocal harmonic(n1, ...)`: with the rate of the continuous nonlocal operator; `classical
   *   harmonic(n1, ...)`: kappa |k|^2/(rho c).
   *
   * At t = 0 a series is its initial value inside and its prescribed value on the Dirichlet sides.
   * Below about 1e-11 L^2/alpha it is taken to be that still; the number of terms grows as t goes
   * to zero.
   *
   * Throws UserError for an unknown name (with the nearest known one), wrong arguments, or what the
   * scene cannot give; and what Expression throws for a mistake in an expression.
   */
  std::unique_ptr<ExactSolution> make_exact_solution(const std::string          &text,
                                                     const ExactSolutionContext &context);

  /** The names that make_exact_solution() knows, without arguments. */
  const std::vector<std::string> &exact_solution_names();


  /** Value and x-derivative of a solution in one variable. */
  struct ValueAndSlope
  {
    double value, slope;
  };

  /**
   * The classical one-dimensional solutions from which those of the papers are made: each solves
   * dT/dt = T'' on [0,1], in units of the length L and of the time L^2/alpha, and slopes are per
   * unit of x/L. Terms are added until the next ones are below 1e-16 of the first. At t = 0 (and
   * below 1e-11) the initial value, with the prescribed value at Dirichlet ends.
   */
  namespace HeatSeries
  {
    /**
     * Both ends 0, initially 1 (Bobaru 2010, eq 33 with its missing 1/n; a factor of Bobaru 2012,
     * example 1).
     */
    ValueAndSlope cooling_slab(const double x, const double t);

    /**
     * Left end insulated, right end held at @p right, initially @p first up to 1/2 and @p second
     * beyond (Bobaru 2010, eq 38 with its second minus a plus).
     */
    ValueAndSlope two_part_bar(const double x,
                               const double t,
                               const double first,
                               const double second,
                               const double right);

    /**
     * Left end held at @p left, given slope dT/dx = @p slope at the right end, initially 0 (Bobaru
     * 2010, eq 43 with sin(n x/2); Bobaru 2012, eq 18 with slope 0, whose flux, eq 19, is times
     * beta_n and not divided by it).
     */
    ValueAndSlope heated_bar(const double x, const double t, const double left, const double slope);
  } // namespace HeatSeries
} // namespace PeriDeal
