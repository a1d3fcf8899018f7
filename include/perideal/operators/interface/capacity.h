// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>

namespace PeriDeal
{
  /**
   * C of C du/dt = f - K u: what the unknowns of a body store. Vectors must come from the operator.
   * Not collective unless stated.
   */
  class Capacity
  {
  public:
    virtual ~Capacity() = default;

    /** Diagonal of C, or its lumped form. Positive everywhere. */
    const Vector &lumped() const
    {
      return diagonal;
    }

    /** C is its diagonal. */
    virtual bool is_diagonal() const
    {
      return true;
    }

    /** y = C x. Collective. */
    virtual void apply(Vector &y, const Vector &x) const
    {
      y = x;
      y.scale(diagonal);
    }

    /** C depends on the solution. */
    virtual bool depends_on_solution() const
    {
      return false;
    }

    /**
     * Be that of the temperatures u; nothing where it is found with the matrices of cells.
     * Collective.
     */
    virtual void take_at(const Vector & /*u*/) {}

    /** As DiffusionOperator::heat_between(). Collective. */
    virtual void heat_between(Vector &y, const Vector &u, const Vector &v) const = 0;

    /** Heat in this process's part of the body. Collective. */
    virtual double content(const Vector &u) const = 0;

    virtual std::size_t memory_consumption() const
    {
      return diagonal.memory_consumption();
    }

  protected:
    Vector diagonal;
  };
} // namespace PeriDeal
