// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "operator_test_tools.h"

#include <Eigen/Eigenvalues>

namespace PeriDeal
{
  namespace OperatorTests
  {
    DenseProperties::DenseProperties(const Operator &op)
    {
      const dealii::FullMatrix<double> k = dense(op);
      const unsigned int               n = k.m();
      const Vector                    &c = op.lumped_capacity();
      std::vector<double>              own(n, 0.), capacity(n);
      for (unsigned int i = 0; i < c.locally_owned_size(); ++i)
        own[c.get_partitioner()->local_to_global(i)] = c.local_element(i);
      dealii::Utilities::MPI::sum(own, c.get_mpi_communicator(), capacity);
      Eigen::MatrixXd scaled(n, n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          {
            entry        = std::max(entry, std::abs(k(i, j)));
            asymmetry    = std::max(asymmetry, std::abs(k(i, j) - k(j, i)));
            scaled(i, j) = k(i, j) / std::sqrt(capacity[i] * capacity[j]);
          }
      asymmetry /= entry;
      if (asymmetry < 1e-10)
        {
          const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled,
                                                                      Eigen::EigenvaluesOnly);
          smallest = solver.eigenvalues()[0];
          largest  = solver.eigenvalues()[n - 1];
        }
      else
        largest = scaled.eigenvalues().cwiseAbs().maxCoeff();
    }
  } // namespace OperatorTests
} // namespace PeriDeal
