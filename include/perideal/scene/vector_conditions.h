// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/types.h>

#include <perideal/scene/expression.h>

#include <optional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * A displacement, a velocity or a traction on one side or part, one formula of x, y, z, t per
   * component. A component without one is free: nothing holds the displacement in that direction.
   * With `if(condition, formula, free)` it is free where `held` is 0. Tractions have all
   * components.
   */
  struct VectorCondition
  {
    VectorCondition() = default;

    /** For programs. */
    VectorCondition(const std::string                            &name,
                    const dealii::types::boundary_id              id,
                    const std::vector<std::optional<Expression>> &values);

    std::string                            name;
    dealii::types::boundary_id             id = 0;
    std::vector<std::optional<Expression>> values;
    std::vector<std::optional<Expression>> held;  // of x, y, z; empty: wherever there is a value
    std::vector<std::string>               texts; // of the components, as the user wrote them
    bool rate = false; // values are velocities, which displacements are the integrals of

    bool depends_on_time() const;

    /** Whether a component is prescribed at a place. */
    template <int dim>
    bool holds(const unsigned int component, const dealii::Point<dim> &p) const;
  };

  /** The condition of the given list on a side or part, by its own id, or nullptr. */
  template <typename Condition>
  const Condition *find_condition(const std::vector<Condition>    &list,
                                  const dealii::types::boundary_id id)
  {
    for (const Condition &condition : list)
      if (condition.id == id)
        return &condition;
    return nullptr;
  }

  /**
   * `formula, free`: one formula of x, y, z, t for each of @p dim components, into values, held and
   * texts of @p condition.
   *
   * @param may_be_free whether `free` may stand for a formula; not for all of them
   * @param where       entry, section and side for messages. Throws UserError.
   * @param known       the variables that messages list
   */
  void parse_components(const std::string &text,
                        const unsigned int dim,
                        const bool         may_be_free,
                        const std::string &where,
                        VectorCondition   &condition,
                        const std::string &known = "x, y, z, t");

  /** One formula of x, y, z, t for each of @p dim components. Throws UserError. */
  std::vector<Expression> parse_vector(const std::string &text,
                                       const unsigned int dim,
                                       const std::string &where,
                                       const std::string &known = "x, y, z, t");

  /**
   * The integral of a rate over time, from @p from to @p to at a place: adaptive Simpson rule,
   * exact for constants.
   */
  template <int dim>
  double integral_over_time(const Expression         &rate,
                            const dealii::Point<dim> &p,
                            const double              from,
                            const double              to);

  /** A formula that is 0 everywhere and at all times. */
  bool is_zero(const Expression &formula);
} // namespace PeriDeal
