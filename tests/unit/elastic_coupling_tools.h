// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <cmath>

#include "elastic_test_tools.h"

namespace PeriDeal
{
  namespace OperatorTests
  {
    using Matrix = dealii::TrilinosWrappers::SparseMatrix;

    template <int dim>
    Settings zoned(const std::string &zone, const double nu, const std::string &plane = "stress")
    {
      const char *const corners[] = {"", "1.6", "1.4, 1.2", "0.8, 0.7, 0.6"};
      const char *const counts[]  = {"", "16", "14, 12", "8, 7, 6"};
      Settings          settings  = box<dim>() + Settings{{"Domain/Upper corner", corners[dim]},
                                                {"Domain/Cells", counts[dim]},
                                                {"Material/Poisson ratio", std::to_string(nu)},
                                                {"Coupling/Zone", zone}};
      if (dim == 2)
        settings.push_back({"Elasticity/Plane", plane});
      return settings;
    }


    /** Of a field, |(K - K of finite elements) u| over the largest of the latter. */
    template <int dim, typename Field>
    double defect(const Body<dim> &body, const Field &field)
    {
      Matrix with, without;
      body.elements->assemble_intact(with, true);
      body.elements->assemble_intact(without, false);
      Vector x = body.values(field), y(x), z(x);
      body.elements->hanging_nodes().set(x, 0.);
      with.vmult(y, x);
      without.vmult(z, x);
      return relative_difference(y, z);
    }


    template <int dim>
    double asymmetry(const Body<dim> &body)
    {
      Matrix matrix;
      body.elements->assemble_intact(matrix, true);
      Vector x = body.values(bumpy_vector<dim>), y(x), z(x);
      matrix.vmult(y, x);
      matrix.Tvmult(z, x);
      return relative_difference(z, y);
    }


    /** Largest |m . K x| over max |m| sum |K x| for the rigid motions m. */
    template <int dim>
    double unbalanced(const Body<dim> &body)
    {
      Matrix matrix;
      body.elements->assemble_intact(matrix, true);
      Vector x = body.values(bumpy_vector<dim>), y(x);
      body.elements->hanging_nodes().set(x, 0.);
      matrix.vmult(y, x);
      double largest = 0.;
      for (const Vector &motion : body.elements->near_null_space())
        largest = std::max(largest, std::abs(motion * y) / (motion.linfty_norm() * y.l1_norm()));
      return largest;
    }


    inline void expect_same_on_all_processes(const Settings &settings)
    {
      const Body<2> together(settings, ModelKind::coupled),
        alone(settings, ModelKind::coupled, MPI_COMM_SELF);
      EXPECT_LE(difference(together,
                           together.product(together.values(bumpy_vector<2>)),
                           alone,
                           alone.product(alone.values(bumpy_vector<2>))),
                1e-12);
      // What a preconditioner gets: the same, without rows and columns that are held.
      Matrix surrogate, surrogate_1;
      together.elements->surrogate(surrogate);
      alone.elements->surrogate(surrogate_1);
      EXPECT_NEAR(surrogate.frobenius_norm() / surrogate_1.frobenius_norm(), 1., 1e-12);
      EXPECT_EQ(together.elements->size().bonds, alone.elements->size().bonds);
    }


    /** Forces and energy of a free body that is as large as its temperature makes it. */
    template <int dim>
    void expect_free_expansion(const Body<dim> &body, const double strain, const double tolerance)
    {
      const Vector u = body.values(
        [&](const dealii::Point<dim> &p) { return dealii::Tensor<1, dim>(strain * p); });
      EXPECT_LT(body.residual(u).linfty_norm(), tolerance);
      EXPECT_NEAR(body.op().energy(u), 0., 0.1 * tolerance);
    }


    /** About a fifth, as if at random. */
    template <int dim>
    bool is_chosen(const dealii::Point<dim> &a, const dealii::Point<dim> &b)
    {
      double phase = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        phase += (91.7 + 37. * d) * (a[d] + b[d]) + (13.1 + 7. * d) * std::abs(a[d] - b[d]);
      return phase * 13.37 - std::floor(phase * 13.37) < 0.2;
    }


    /** Of K: asymmetry, force and moment on rigid motions, lowest energy of some fields. */
    template <int dim>
    void check_sound(const Body<dim> &body)
    {
      const Vector x = body.values(bumpy_vector<dim>);
      Vector       z = body.values([](const dealii::Point<dim> &p) {
        dealii::Tensor<1, dim> value;
        for (unsigned int d = 0; d < dim; ++d)
          value[d] = std::cos(17. * p[d] * (1. + p[0]) + d) + p.norm();
        return value;
      });
      const Vector y = body.product(x), w = body.product(z);
      const double size = std::sqrt((x * y) * (z * w));
      EXPECT_LT(std::abs(z * y - x * w), 1e-13 * size);
      EXPECT_GE(x * y, 0.);
      for (const Vector &motion : body.elements->near_null_space())
        {
          EXPECT_LT(std::abs(motion * y), 1e-13 * motion.linfty_norm() * y.l1_norm());
          EXPECT_LT(body.product(motion).linfty_norm(),
                    1e-12 * motion.linfty_norm() * y.linfty_norm());
        }
      EXPECT_GT(body.elements->lowest_remainder(), -1e-12);
    }
  } // namespace OperatorTests
} // namespace PeriDeal
