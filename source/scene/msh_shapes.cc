// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "msh_shapes.h"

#include <deal.II/base/exceptions.h>

#include <perideal/scene/msh_file.h>

namespace PeriDeal
{
  namespace
  {
    constexpr MshShape cell_shapes[] = {
      {"line", 1, 2, 2, {{1}, {0}}, {1, 1}, {{0}, {1}}},
      {"triangle", 2, 3, 3, {{1, 2}, {2, 0}, {0, 1}}, {2, 2, 2}, {{0, 1}, {1, 2}, {2, 0}}},
      {"quadrilateral",
       2,
       4,
       4,
       {{1, 3}, {2, 0}, {3, 1}, {0, 2}},
       {2, 2, 2, 2},
       {{0, 1}, {1, 2}, {2, 3}, {3, 0}}},
      {"tetrahedron",
       3,
       4,
       4,
       {{1, 2, 3}, {0, 3, 2}, {3, 0, 1}, {2, 1, 0}},
       {3, 3, 3, 3},
       {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}},
      {"wedge",
       3,
       6,
       5,
       {{1, 2, 3}, {2, 0, 4}, {0, 1, 5}, {5, 4, 0}, {3, 5, 1}, {4, 3, 2}},
       {3, 3, 4, 4, 4},
       {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},
      {"hexahedron",
       3,
       8,
       6,
       {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}},
       {4, 4, 4, 4, 4, 4},
       {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}}};
  } // namespace


  const MshShape &shape_of_cell(const unsigned int dimension, const unsigned int n_corners)
  {
    for (const MshShape &shape : cell_shapes)
      if (shape.dimension == dimension && shape.n_corners == n_corners)
        return shape;
    AssertThrow(false, dealii::ExcInternalError());
    return cell_shapes[0];
  }


  const char *msh_shape(const unsigned int dimension, const unsigned int n_corners)
  {
    return dimension == 0 ? "point" :
           n_corners == 5 ? "pyramid" :
                            shape_of_cell(dimension, n_corners).name;
  }
} // namespace PeriDeal
