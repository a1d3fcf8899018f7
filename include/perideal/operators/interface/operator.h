// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/base/types.h>

#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace dealii::TrilinosWrappers
{
  class SparseMatrix;
}

namespace PeriDeal
{
  /** Bounds of the eigenvalues of C^{-1} K, the fastest rate of decay of the model. */
  struct Spectrum
  {
    double safe  = 0.; // Gershgorin
    double sharp = 0.; // Lanczos (symmetric) or power iterations, rounded up to three digits
  };


  /** Heat flows at one instant, all positive into the body. */
  struct Balance
  {
    std::map<std::string, double> sides; // by the side's name
    std::vector<double>
           cracks;       // from the right side of each crack to its left; not part of the balance
    double sources = 0.; // volume sources
    double stored  = 0.; // rate of change of the heat in the free unknowns
    double content = 0.; // sum C_i T_i; the integral of C over T where it depends on T

    /** Sum of everything that enters. */
    double throughput() const;

    /** Everything entering, minus what is stored. */
    double imbalance() const;
  };


  /** What a model costs, for summary.json. */
  struct OperatorSize
  {
    unsigned long long unknowns = 0, bonds = 0, nonzeros = 0;
    double      busiest = 0.; // most nonzeros of a process over the mean of all; 0: not known
    std::size_t memory =
      0; // bytes of this process's nodes, bonds and matrices, without mesh and DoFHandler
    std::string form; // lattice | stored | matrix
  };


  /**
   * A semi-discrete model C du/dt = f(t) - K u with some unknowns prescribed (Dirichlet values) and
   * some slaved to others. Every model has this one interface, so solvers know nothing of bonds or
   * elements. What heat needs besides is in DiffusionOperator, what solids do in ElasticOperator.
   *
   * Vectors come from initialize_vector(). K is positive semidefinite; f, K u are in power (W; per
   * unit thickness in 2D). "Free" are the unknowns that are neither prescribed nor slaves. All
   * functions are collective unless stated; ghosts are exchanged inside, arguments need no
   * up-to-date ghost values.
   */
  class Operator
  {
  public:
    /** Called with the first and past the last of some owned unknowns. */
    using RowsAction = std::function<void(const unsigned int begin, const unsigned int end)>;

    virtual ~Operator() = default;

    virtual void initialize_vector(Vector &vector) const = 0;

    /**
     * y = K x on free unknowns for homogeneous conditions: prescribed values of x must be zero, its
     * slaves are filled in here. Entries of y that are not free are set to zero.
     */
    virtual void apply(Vector &y, const Vector &x) const = 0;

    /**
     * r = f(t) - K u on free unknowns, zero elsewhere. u must have been through distribute(u, t).
     */
    virtual void residual(Vector &r, const Vector &u, const double t) const = 0;

    /**
     * As apply(), and finish(begin, end) once for each owned unknown when its y is final, many
     * unknowns at a time and, where the operator can, while y and x are still in cache. finish must
     * not change x.
     */
    virtual void apply_then(Vector &y, const Vector &x, const RowsAction &finish) const
    {
      apply(y, x);
      finish(0, y.locally_owned_size());
    }

    /** Set the prescribed and the slave values of u at time t. */
    virtual void distribute(Vector &u, const double t) const = 0;

    /** Set prescribed values to zero, slaves as for zero loads: what apply() assumes of x. */
    virtual void distribute_homogeneous(Vector &x) const = 0;

    /** Set entries that are not free to zero. Not collective. */
    virtual void clear_constrained(Vector &y) const = 0;

    /** Diagonal of C, or its lumped form. Positive everywhere. Not collective. */
    virtual const Vector &lumped_capacity() const = 0;

    /** y = C x. */
    virtual void apply_capacity(Vector &y, const Vector &x) const = 0;

    /** Diagonal of K, one on unknowns that are not free. Not collective. */
    virtual const Vector &diagonal() const = 0;

    /**
     * The diagonal of K to be used beside surrogate(): of K as it is; where an operator has been
     * loaded, until surrogate() is asked a second time, of the K for which it was made last in the
     * run before. Not collective.
     */
    virtual const Vector &surrogate_diagonal() const
    {
      return diagonal();
    }

    /** Bounds of the spectrum of C^{-1} K (with diagonal C). Kept until K may have grown. */
    virtual Spectrum spectrum() const = 0;

    /**
     * K is symmetric on the free unknowns: CG and Chebyshev expansions are allowed. Not collective.
     */
    virtual bool symmetric() const = 0;

    /** Loads or prescribed values change with time. Not collective. */
    virtual bool depends_on_time() const = 0;

    /**
     * A sparse matrix spectrally near K on the free unknowns, cheap enough for algebraic multigrid:
     * K itself for finite elements, the graph Laplacian of the nearest neighbours, cut where bonds
     * are cut, for peridynamics. Rows not free are those of the identity.
     */
    virtual void surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const = 0;

    /** Unknowns at each node, interleaved. Not collective. */
    virtual unsigned int n_components() const
    {
      return 1;
    }

    /**
     * For multigrid: what K maps to nearly nothing away from prescribed unknowns, in their absence
     * to zero. None: the constant. Collective.
     */
    virtual std::vector<Vector> near_null_space() const
    {
      return {};
    }

    /**
     * The surrogate is K itself, so that multigrid on it needs no further smoothing. Not
     * collective.
     */
    virtual bool surrogate_is_exact() const = 0;

    /**
     * First time after t at which K changes by itself, infinity if it never does: cracks that grow
     * or close. Not collective.
     */
    virtual double next_event(const double) const
    {
      return std::numeric_limits<double>::infinity();
    }

    /** Coordinates of an owned unknown for messages, as `(x, y)`. Not collective. */
    virtual std::string place_of(const unsigned int local_index) const = 0;

    virtual OperatorSize size() const = 0;

    /** Number of calls of apply() and residual() so far. Not collective. */
    unsigned long long n_applications() const
    {
      return applications;
    }

    /**
     * What does not follow from scene, time and solution. An operator that loads must be made for
     * the same scene. @param keys of the owned nodes. Collective.
     */
    virtual void exchange(Archive &archive, const NodeKeys & /*keys*/)
    {
      archive.exchange("applications", applications);
    }

    /** Go on counting from what an operator of the same model has had. */
    void carry_over_applications(const unsigned long long before)
    {
      applications += before;
    }

  protected:
    mutable unsigned long long applications = 0;
  };
} // namespace PeriDeal
