// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/lac/full_matrix.h>

#include <perideal/mesh/mesh_builder.h>
#include <perideal/operators/diffusion/bond_operator.h>
#include <perideal/operators/diffusion/fem_operator.h>

#include <gtest/gtest.h>

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

      DiffusionOperator &op() const;

      Vector vector() const;

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
      std::unique_ptr<BondOperator<dim>>          bonds;
      std::unique_ptr<FEMOperator<dim>>           fem;
      std::vector<dealii::Point<dim>>             positions; // of owned unknowns
      std::vector<dealii::Point<dim>> sides; // the same, a little towards the unknown's own cells

    private:
      void find_positions();
    };


    /** All values of a vector by place, rounded, on every process of its communicator. */
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


    inline unsigned int n_processes()
    {
      return dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    }
  } // namespace OperatorTests
} // namespace PeriDeal
