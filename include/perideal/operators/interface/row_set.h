// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>

#include <algorithm>
#include <vector>

namespace PeriDeal
{
  /**
   * Some unknowns. Nothing here takes time that grows with the number of all unknowns but the
   * constructor.
   */
  class RowSet
  {
  public:
    explicit RowSet(const Vector &layout)
      : marks(layout.get_partitioner())
      , owned(marks.locally_owned_size(), false)
    {}

    /** By local number, owned or ghost. */
    void insert(const unsigned int i)
    {
      if (i >= owned.size())
        marks.local_element(i) = 1.;
      else if (!owned[i])
        {
          owned[i] = true;
          list.push_back(i);
        }
    }

    /** Tell the owners of ghosts. Collective. */
    void compress()
    {
      const auto &partitioner = *marks.get_partitioner();
      if (partitioner.n_mpi_processes() == 1)
        return;
      marks.compress(dealii::VectorOperation::add);
      for (const auto &[begin, end] : partitioner.import_indices())
        for (unsigned int i = begin; i < end; ++i)
          if (marks.local_element(i) > 0.)
            {
              insert(i);
              marks.local_element(i) = 0.;
            }
    }

    bool contains(const unsigned int i) const
    {
      return owned[i];
    }

    /** The owned ones, in the order in which they came, or sorted. */
    const std::vector<unsigned int> &rows() const
    {
      return list;
    }

    void sort()
    {
      std::sort(list.begin(), list.end());
    }

    void clear()
    {
      for (const unsigned int i : list)
        owned[i] = false;
      list.clear();
    }

  private:
    Vector                    marks; // of ghosts
    std::vector<bool>         owned;
    std::vector<unsigned int> list;
  };
} // namespace PeriDeal
