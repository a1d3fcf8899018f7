// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/lac/full_matrix.h>

#include <perideal/mesh/mesh_builder.h>
#include <perideal/operators/diffusion/cell_term.h>
#include <perideal/operators/diffusion/extended_bond_term.h>
#include <perideal/operators/diffusion/node_loads.h>
#include <perideal/operators/diffusion/side_term.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * What the tests of meshes, bonds, operators and solvers share; compiled once, for it takes
   * longer than most tests.
   */
  namespace OperatorTests
  {
    /** Entries of a scene: "Section/Entry" and its text. Later ones replace earlier ones. */
    using Settings = std::vector<std::pair<std::string, std::string>>;


    inline Settings operator+(Settings a, const Settings &b)
    {
      a.insert(a.end(), b.begin(), b.end());
      return a;
    }


    /** Parse and check the scene with these entries. */
    template <int dim>
    void set(Scene<dim> &scene, const Settings &settings);


    /** A scene with its mesh and the operator of one model. */
    template <int dim>
    struct Problem
    {
      explicit Problem(const Settings &settings,
                       const ModelKind model        = ModelKind::peridynamics,
                       const MPI_Comm  communicator = MPI_COMM_WORLD);

      ~Problem();

      FieldOperator<dim> &op() const
      {
        return *field;
      }

      Vector vector() const;

      /** K x of the free unknowns. */
      Vector product(const Vector &x) const;

      /** f - K u. */
      Vector residual(const Vector &u, const double t = 0.) const;

      /** The steady solution, from a field on, zero unless given. */
      Vector steady(const double tolerance = 1e-12, Vector u = Vector()) const;

      /** A vector with the values of a function at the owned unknowns. */
      template <typename Function>
      Vector values(const Function &f) const
      {
        Vector v = vector();
        for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
          v.local_element(i) = f(positions[i]);
        return v;
      }

      Scene<dim>                                  scene;
      std::vector<std::string>                    notes;
      std::unique_ptr<dealii::Triangulation<dim>> mesh;
      dealii::DoFHandler<dim>                     handler;
      std::unique_ptr<Nodes<dim>>                 nodes;
      std::unique_ptr<FieldOperator<dim>>         field;
      std::vector<dealii::Point<dim>>             positions; // of owned unknowns
      std::vector<dealii::Point<dim>> sides; // the same, a little towards the unknown's own cells

    private:
      void find_positions();
    };


    /** Place of an unknown, rounded, as a key. */
    template <int dim>
    std::array<long, dim> place(const dealii::Point<dim> &p)
    {
      std::array<long, dim> key;
      for (unsigned int d = 0; d < dim; ++d)
        key[d] = std::lround(p[d] * 1e7);
      return key;
    }


    /** All values of a vector by place, on every process of its communicator. */
    template <int dim>
    std::map<std::array<long, dim>, double> gathered(const Problem<dim> &problem, const Vector &v);


    /**
     * Largest difference of two vectors of the same unknowns on different processes; infinite if
     * the unknowns differ.
     */
    template <int dim>
    double difference(const Problem<dim> &a,
                      const Vector       &x,
                      const Problem<dim> &b,
                      const Vector       &y);


    double largest_difference(const Vector &a, const Vector &b);


    /** The same, over the largest of the second. */
    double relative_difference(const Vector &a, const Vector &b);


    /** A field without any symmetry. */
    template <int dim>
    double bumpy(const dealii::Point<dim> &p)
    {
      double s = 0.3;
      for (unsigned int d = 0; d < dim; ++d)
        s += std::sin((3.1 + d) * p[d] + 0.7 * d) + (1 + d) * 0.4 * p[d] * p[(d + 1) % dim];
      return s;
    }


    /** The matrix that apply() multiplies with, on every process; for small problems. */
    dealii::FullMatrix<double> dense(const Operator &op);


    /**
     * Eigenvalues' largest, of C^{-1} K for symmetric K, and how unsymmetric K is: largest entry of
     * K - K^T relative to the largest of K.
     */
    struct DenseProperties
    {
      explicit DenseProperties(const Operator &op);

      double asymmetry = 0., smallest = 0., largest = 0., entry = 0.;
    };


    /** Areas of the sides that nodes have, by id, and their volume, at last. Collective. */
    template <int dim>
    std::vector<double> measures_of(const Nodes<dim> &nodes)
    {
      std::vector<double> sums(257, 0.), all(257);
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        sums[256] += nodes.volume(i);
      for (const BoundaryShare &share : nodes.boundary_shares())
        sums[share.id] += share.area;
      dealii::Utilities::MPI::sum(sums, MPI_COMM_WORLD, all);
      return all;
    }


    /** Of a body without prescribed values: what K conserves, that it is symmetric, positive. */
    template <int dim>
    void expect_conservation(const Problem<dim> &problem,
                             const std::string  &what,
                             const double        of_one = 1e-13)
    {
      const Vector y = problem.product(problem.values(bumpy<dim>));
      EXPECT_NEAR(y.mean_value() * y.size(), 0., 1e-12 * y.l1_norm()) << what;
      const DenseProperties matrix(problem.op());
      EXPECT_LT(matrix.asymmetry, 1e-14) << what;
      EXPECT_GT(matrix.smallest, -1e-12 * matrix.largest) << what;
      const Vector one = problem.values([](const auto &) { return 1.; });
      EXPECT_LT(problem.product(one).linfty_norm(), of_one * matrix.entry) << what;
    }


    inline unsigned int n_processes()
    {
      return dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    }


    inline unsigned int this_process()
    {
      return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    }


    template <typename Number>
    Number sum_of_all(const Number &own)
    {
      return dealii::Utilities::MPI::sum(own, MPI_COMM_WORLD);
    }


    template <typename Number>
    Number max_of_all(const Number &own)
    {
      return dealii::Utilities::MPI::max(own, MPI_COMM_WORLD);
    }
  } // namespace OperatorTests
} // namespace PeriDeal
