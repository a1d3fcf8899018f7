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
   * A displacement or a traction on one side, one formula of x, y, z, t per component. A component without one is free: nothing holds the
   * displacement in that direction. Tractions have them all.
   */
  struct VectorCondition
  {
    std::string                            name; // as the user wrote it
    dealii::types::boundary_id             id = 0;
    std::vector<std::optional<Expression>> values;

    bool depends_on_time() const;
  };

  /** The condition of the given list on a side, or nullptr. */
  const VectorCondition *find_condition(const std::vector<VectorCondition> &list,
                                        const dealii::types::boundary_id    id);

  /**
   * `formula, free`: one formula of x, y, z, t for each of @p dim components.
   *
   * @param may_be_free whether `free` may stand for a formula; not for all of them
   * @param where       entry, section and side for messages. Throws UserError.
   */
  std::vector<std::optional<Expression>> parse_components(const std::string &text,
                                                          const unsigned int dim,
                                                          const bool         may_be_free,
                                                          const std::string &where);

  /** A formula that is 0 everywhere and at all times. */
  bool is_zero(const Expression &formula);
} // namespace PeriDeal
