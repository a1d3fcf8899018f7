// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The smallest eigenvalue of a family's shape, where closed forms fail: isotropic, nearly isotropic
// and singular tensors.

#include <perideal/base/smallest_eigenvalue.h>

#include <cmath>
#include <limits>
#include <random>

#include "dimensions.h"

using namespace PeriDeal;
using dealii::SymmetricTensor;
using dealii::Tensor;

namespace
{
  const double epsilon = std::numeric_limits<double>::epsilon();

  std::mt19937 numbers{1};

  double uniform()
  {
    return std::uniform_real_distribution<double>(-1., 1.)(numbers);
  }


  /** The shape of one bond. */
  template <int dim>
  SymmetricTensor<2, dim> random_bond()
  {
    Tensor<1, dim> bond;
    for (unsigned int d = 0; d < dim; ++d)
      bond[d] = uniform();
    return symmetrize(outer_product(bond, bond));
  }


  /**
   * Isotropic, and isotropic but for round-off, at any size: what whole families of a lattice give.
   */
  TEST_IN_DIMENSIONS(SmallestEigenvalue, of_isotropic_tensors, 2, 3)
  {
    for (const double size : {1e-60, 1., 1e60})
      {
        const auto isotropic = size * dealii::unit_symmetric_tensor<dim>();
        EXPECT_DOUBLE_EQ(smallest_eigenvalue(isotropic), size);
        for (unsigned int n = 0; n < 1000; ++n)
          {
            auto tensor = isotropic;
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = i; j < dim; ++j)
                tensor[i][j] += size * 4. * epsilon * uniform();
            ASSERT_NEAR(smallest_eigenvalue(tensor) / size, 1., 20. * epsilon) << tensor;
          }
      }
  }


  /** Bonds in one line, in any direction: singular to round-off; and with something weak across. */
  TEST_IN_DIMENSIONS(SmallestEigenvalue, of_bonds_in_a_line, 2, 3)
  {
    for (unsigned int n = 0; n < 1000; ++n)
      {
        const auto line = random_bond<dim>();
        ASSERT_LT(std::abs(smallest_eigenvalue(line)), 10. * epsilon * trace(line)) << line;
        const double weak = 1e-6 * trace(line);
        const auto   held = line + weak * dealii::unit_symmetric_tensor<dim>();
        ASSERT_NEAR(smallest_eigenvalue(held) / weak, 1., 1e-8) << held;
      }
  }


  TEST(SmallestEigenvalue, of_bonds_in_a_plane)
  {
    for (unsigned int n = 0; n < 1000; ++n)
      {
        const auto plane = random_bond<3>() + random_bond<3>();
        ASSERT_LT(std::abs(smallest_eigenvalue(plane)), 10. * epsilon * trace(plane)) << plane;
      }
  }


  TEST(SmallestEigenvalue, of_known_tensors)
  {
    SymmetricTensor<2, 2> plane;
    EXPECT_EQ(smallest_eigenvalue(plane), 0.);
    plane[0][0] = plane[1][1] = 2.;
    plane[0][1]               = -1.;
    EXPECT_DOUBLE_EQ(smallest_eigenvalue(plane), 1.);

    // (1 - x) (2 - x) (4 - x)
    SymmetricTensor<2, 3> space;
    space[0][0] = 3.;
    space[1][1] = 2.;
    space[2][2] = 2.;
    space[0][1] = 1.;
    space[0][2] = -1.;
    EXPECT_NEAR(smallest_eigenvalue(space), 1., 10. * epsilon);

    SymmetricTensor<2, 1> bar;
    bar[0][0] = 3.;
    EXPECT_EQ(smallest_eigenvalue(bar), 3.);
  }
} // namespace
