// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/matrix_rows.h>
#include <perideal/operators/bounds/local_bound.h>

#include <cmath>
#include <numeric>

#include "ritz_bound.h"

namespace PeriDeal
{
  using namespace dealii;

  LocalBound::LocalBound(const Vector &layout)
    : values(layout.get_partitioner())
    , rows(layout)
  {}


  void LocalBound::grow(const TrilinosWrappers::SparseMatrix &stiffness)
  {
    const auto       &layout = *values.get_partitioner();
    const std::size_t n      = rows.rows().size();
    for (; n_grown < n; ++n_grown)
      for_each_entry_of_row(stiffness,
                            rows.rows()[n_grown],
                            [&](const auto column, const double value) {
                              if (value == 0.)
                                return;
                              if (!layout.in_local_range(column) && !layout.is_ghost_entry(column))
                                {
                                  unknown = true;
                                  return;
                                }
                              rows.insert(layout.global_to_local(column));
                            });
    rows.compress();
  }


  double LocalBound::operator()(const TrilinosWrappers::SparseMatrix &stiffness,
                                const Vector                         &capacity,
                                const RowSet                         &held,
                                const std::vector<unsigned int>      &first,
                                const Vector                         &start,
                                const double                          enough)
  {
    const auto    &layout       = *values.get_partitioner();
    const MPI_Comm communicator = layout.get_mpi_communicator();
    const auto     sum          = [&](const std::vector<double> &a, const std::vector<double> &b) {
      return Utilities::MPI::sum(std::inner_product(a.begin(), a.end(), b.begin(), 0.),
                                 communicator);
    };
    n_grown = 0;
    unknown = false;
    for (std::vector<double> *v : {&root, &last, &now, &next})
      v->clear();
    for (const unsigned int i : first)
      rows.insert(i);
    for (const unsigned int i : rows.rows())
      {
        root.push_back(std::sqrt(capacity.local_element(i)));
        now.push_back(held.contains(i) ? 0. : start.local_element(i) * root.back());
      }
    double norm = std::sqrt(sum(now, now));
    if (norm == 0.)
      {
        rows.clear();
        return 0.;
      }
    for (double &x : now)
      x /= norm;
    norm = 0.;
    RitzBound bound(enough);
    for (unsigned int k = 0; k < RitzBound::n_max; ++k)
      {
        grow(stiffness);
        const std::vector<unsigned int> &list = rows.rows();
        for (std::size_t r = root.size(); r < list.size(); ++r)
          root.push_back(std::sqrt(capacity.local_element(list[r])));
        for (std::vector<double> *v : {&last, &now, &next})
          v->resize(list.size(), 0.);
        for (std::size_t r = 0; r < list.size(); ++r)
          values.local_element(list[r]) = now[r] / root[r];
        values.update_ghost_values();
        for (std::size_t r = 0; r < list.size(); ++r)
          {
            next[r] = 0.;
            if (held.contains(list[r]))
              continue;
            double image = 0.;
            for_each_entry_of_row(stiffness, list[r], [&](const auto column, const double value) {
              if (value != 0. && (layout.in_local_range(column) || layout.is_ghost_entry(column)))
                image += value * values.local_element(layout.global_to_local(column));
            });
            next[r] = image / root[r] - norm * last[r];
          }
        values.set_ghost_state(false);
        const double alpha = sum(now, next);
        for (std::size_t r = 0; r < list.size(); ++r)
          next[r] -= alpha * now[r];
        norm = std::sqrt(sum(next, next));
        if (bound.take(alpha, norm))
          break;
        for (double &x : next)
          x /= norm;
        last.swap(now);
        now.swap(next);
      }
    for (const unsigned int i : rows.rows())
      values.local_element(i) = 0.;
    values.zero_out_ghost_values();
    rows.clear();
    return Utilities::MPI::max(unknown ? 1 : 0, communicator) > 0 ? -1. : bound.value();
  }
} // namespace PeriDeal
