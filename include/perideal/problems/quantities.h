// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/problem.h>
#include <perideal/problems/result_record.h>

#include <vector>

namespace PeriDeal
{
  /**
   * Rows of totals.csv for the quantities of section `Output`, and for the place of the least and
   * largest ones (of equal ones that with the smallest coordinates): `tip`, `tip at x`, ... In the
   * body and in regions these are nodes, whose volumes weigh, on sides values of faces at
   * vertices, or at the centres of their cells. A model has those of its fields. Throws UserError
   * for a place without a node or face, and where no model has such a field. Collective.
   */
  template <int dim>
  void add_quantities(const std::vector<const Problem<dim> *> &problems,
                      const double                             t,
                      ResultRecord                            &record);

  /** What add_quantities() throws, before steps are taken. Collective. */
  template <int dim>
  void check_quantities(const std::vector<const Problem<dim> *> &problems);
} // namespace PeriDeal
