// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/diffusion/diffusion_loads.h>
#include <perideal/operators/interface/term.h>

#include <algorithm>

namespace PeriDeal
{
  /**
   * What sides with a coefficient h take of u: h A u_i of node i with the area A. What they give is
   * a load. The loads must outlive this.
   */
  template <int dim>
  class SideTerm : public Term<dim>
  {
  public:
    using typename Term<dim>::At;
    using typename Term<dim>::Rows;

    explicit SideTerm(const DiffusionLoads<dim> &loads)
      : loads(loads)
    {}

    void add(Vector            &y,
             const At          &at,
             const unsigned int begin,
             const unsigned int end) const override
    {
      for_each(begin, end, [&](const unsigned int i, const double coefficient) {
        y.local_element(i) += coefficient * at.u.local_element(i);
      });
    }

    /** Twice that to the sums, as bonds have twice their part of the diagonal. */
    void add_rows(Vector &diagonal, std::vector<double> &sums, const Rows &rows) const override
    {
      for (std::size_t k = 0; k < rows.size(); ++k)
        for_each(rows[k], rows[k] + 1, [&](const unsigned int i, const double coefficient) {
          diagonal.local_element(i) += coefficient;
          sums[k] += 2. * coefficient;
        });
    }

    void add_to(OperatorSize &) const override {}

  private:
    template <typename Visit>
    void for_each(const unsigned int begin, const unsigned int end, const Visit &visit) const
    {
      const auto &list = loads.with_coefficient();
      for (auto entry =
             std::lower_bound(list.begin(),
                              list.end(),
                              begin,
                              [](const auto &a, const unsigned int b) { return a.first < b; });
           entry != list.end() && entry->first < end;
           ++entry)
        visit(entry->first, entry->second);
    }

    const DiffusionLoads<dim> &loads;
  };
} // namespace PeriDeal
