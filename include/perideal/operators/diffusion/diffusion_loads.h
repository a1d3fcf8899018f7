// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/diffusion/load_tangents.h>
#include <perideal/operators/interface/operator.h>
#include <perideal/scene/boundary_conditions.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * What enters a body from outside: the source s, and through sides f + h (a - u)
   * (SurfaceTransfer), all positive into the body. The loads are what does not depend on u, with
   * the f in regions and at points; h acts in SideTerm or in the matrices of cells.
   *
   * A source or a side that is no line in u has its tangent in its place (LoadTangents), and
   * before the first take_at() nothing.
   *
   * The arguments of the constructor must outlive this.
   */
  template <int dim>
  class DiffusionLoads
  {
  public:
    /** An unknown, and h times its area. */
    using Coefficients = std::vector<std::pair<unsigned int, double>>;

    /** @param layout of the vectors */
    DiffusionLoads(const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &layout,
                   const BoundaryConditions<dim>                                    &conditions,
                   const Expression                                                 &source)
      : conditions(conditions)
      , source(source)
      , any_source(!source.is_constant() || source.value(dealii::Point<dim>()) != 0.)
      , varies(source.depends_on_time() || conditions.transfers_depend_on_time())
      , tangents(conditions, source)
      , loads(layout)
    {}

    virtual ~DiffusionLoads() = default;

    /** Loads, or prescribed values of the conditions, change with time. Not collective. */
    bool depends_on_time() const
    {
      return varies || conditions.depends_on_time();
    }

    /** Sources or sides are no lines in u. Not collective. */
    bool depends_on_solution() const
    {
      return tangents.any();
    }

    /** As LoadTangents::take(). Collective. */
    void take_at(const Vector &u, const double t, const bool steady)
    {
      tangents.take(u, t, steady);
      find_coefficients();
      find(t);
    }

    /** Owned unknowns whose rows of K take_at() changes, ascending. */
    const std::vector<unsigned int> &curved_rows() const
    {
      return curved;
    }

    /** f(t), which stays until the next call. Collective. */
    const Vector &at(const double t) const
    {
      if (varies)
        find(t);
      return loads;
    }

    /** Some load of this process is not 0, or may be at another time. */
    bool any() const
    {
      return varies || any_load;
    }

    /** Sum of this process's entries of the last at(). */
    double sum() const
    {
      return sum_of_loads;
    }

    /** What enters through the sides of unknowns that follow from others, and is no load. */
    virtual double through_slaves(const double) const
    {
      return 0.;
    }

    /** h times area of owned unknowns, ascending; one may come several times. */
    const Coefficients &with_coefficient() const
    {
      return coefficients;
    }

    /** What enters this process's unknowns where f and a are 0, per time. */
    double through_transfer(const Vector &u) const
    {
      double sum = 0.;
      for (const auto &[unknown, coefficient] : coefficients)
        sum -= coefficient * u.local_element(unknown);
      return sum;
    }

    /**
     * Add this process's share of what enters through sides and from sources, with the field u.
     * Collective.
     */
    virtual void add_to(Balance &balance, const Vector &u, const double t) const = 0;

    std::size_t memory_consumption() const
    {
      return loads.memory_consumption();
    }

  protected:
    /** Set `loads`, which are zero, to f(t). */
    virtual void assemble(const double t) const = 0;

    /** Set `coefficients`, of tangents those that have been taken. */
    virtual void find_coefficients() {}

    /** By constructors where loads do not vary. */
    void find(const double t) const
    {
      loads = 0.;
      assemble(t);
      sum_of_loads = std::accumulate(loads.begin(), loads.end(), 0.);
      any_load =
        std::any_of(loads.begin(), loads.end(), [](const double load) { return load != 0.; });
    }

    const BoundaryConditions<dim> &conditions;
    const Expression              &source;
    const bool                     any_source, varies;
    LoadTangents<dim>              tangents;
    std::vector<unsigned int>      curved;       // curved_rows()
    Coefficients                   coefficients; // ascending
    mutable Vector                 loads;

  private:
    mutable double sum_of_loads = 0.;
    mutable bool   any_load     = false;
  };
} // namespace PeriDeal
