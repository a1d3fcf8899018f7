// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Nodes on the sides of larger cells, on a mesh of two sizes.

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/operators/parts/hanging_nodes.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The unit square or cube, its corner at the origin refined where asked. */
    template <int dim>
    struct GradedMesh
    {
      GradedMesh(const unsigned int degree, const bool graded)
        : mesh(MPI_COMM_WORLD)
        , fe(degree)
        , dofs(mesh)
      {
        GridGenerator::subdivided_hyper_cube(mesh, 4);
        for (const auto &cell : mesh.active_cell_iterators())
          if (graded && cell->is_locally_owned() && cell->center().norm() < 0.5)
            cell->set_refine_flag();
        mesh.execute_coarsening_and_refinement();
        dofs.distribute_dofs(fe);
        DoFTools::extract_locally_relevant_dofs(dofs, relevant);
        hanging = std::make_unique<HangingNodes<dim>>(dofs, *vector().get_partitioner());
      }

      Vector vector() const
      {
        return Vector(dofs.locally_owned_dofs(), relevant, MPI_COMM_WORLD);
      }

      template <typename Function>
      Vector values(const Function &f) const
      {
        Vector                                        v = vector();
        std::map<types::global_dof_index, Point<dim>> places;
        DoFTools::map_dofs_to_support_points(MappingQ1<dim>(), dofs, places);
        for (const auto &[dof, p] : places)
          if (v.in_local_range(dof))
            v(dof) = f(p);
        return v;
      }

      unsigned int n_hanging() const
      {
        return Utilities::MPI::sum(static_cast<unsigned int>(hanging->owned().size()),
                                   MPI_COMM_WORLD);
      }

      parallel::distributed::Triangulation<dim> mesh;
      FE_Q<dim>                                 fe;
      DoFHandler<dim>                           dofs;
      IndexSet                                  relevant;
      std::unique_ptr<HangingNodes<dim>>        hanging;
    };


    double linear(const Point<2> &p)
    {
      return 1. + 2. * p[0] - 3. * p[1];
    }


    double wavy(const Point<2> &p)
    {
      return std::sin(7. * p[0]) + std::cos(5. * p[1] + p[0]);
    }
  } // namespace


  TEST(HangingNodes, none_on_a_mesh_of_one_size)
  {
    const GradedMesh<2> body(1, false);
    EXPECT_FALSE(body.hanging->any());
    EXPECT_EQ(body.n_hanging(), 0u);
    Vector v = body.values(wavy), same(v);
    body.hanging->condense(v);
    body.hanging->interpolate(v);
    body.hanging->set(v, 3.);
    v -= same;
    EXPECT_EQ(v.linfty_norm(), 0.);
  }


  TEST(HangingNodes, follow_fields_of_their_degree)
  {
    for (const unsigned int degree : {1u, 2u})
      {
        const GradedMesh<2> body(degree, true);
        EXPECT_TRUE(body.hanging->any());
        // Three cells are refined, with four sides to large ones.
        EXPECT_EQ(body.n_hanging(), degree == 1 ? 4u : 12u);
        const auto   field = [&](const Point<2> &p) { return std::pow(linear(p), degree); };
        const Vector right = body.values(field);
        Vector       v(right);
        body.hanging->set(v, 100.);
        for (const unsigned int node : body.hanging->owned())
          {
            EXPECT_EQ(v.local_element(node), 100.);
            EXPECT_TRUE(body.hanging->is_hanging(v.get_partitioner()->local_to_global(node)));
          }
        body.hanging->interpolate(v);
        v -= right;
        EXPECT_LT(v.linfty_norm(), 1e-14) << degree;
      }
  }


  TEST(HangingNodes, loads_are_condensed_by_the_transpose)
  {
    const GradedMesh<2> body(2, true);
    Vector loads = body.values(wavy), one = body.values([](const auto &) { return 1.; });
    Vector field = body.values(linear);
    body.hanging->set(field, 0.);
    Vector whole(field);
    body.hanging->interpolate(whole);
    const double sum = loads * one, work = loads * whole;
    body.hanging->condense(loads);
    EXPECT_NEAR(loads * one, sum, 1e-13);
    EXPECT_NEAR(loads * field, work, 1e-13);
    for (const unsigned int node : body.hanging->owned())
      EXPECT_EQ(loads.local_element(node), 0.);
  }


  TEST(HangingNodes, matrix_of_a_linear_field)
  {
    // The flux of a linear field leaves nothing at any node inside.
    const GradedMesh<2>               body(1, true);
    const IndexSet                   &owned = body.dofs.locally_owned_dofs();
    TrilinosWrappers::SparsityPattern pattern(owned, owned, body.relevant, MPI_COMM_WORLD);
    DoFTools::make_sparsity_pattern(body.dofs, pattern, body.hanging->constraints(), false);
    pattern.compress();
    TrilinosWrappers::SparseMatrix matrix(pattern);
    FEValues<2>        values(body.fe, QGauss<2>(2), update_gradients | update_JxW_values);
    FullMatrix<double> of_cell(4, 4);
    std::vector<types::global_dof_index> indices(4);
    for (const auto &cell : body.dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          of_cell = 0.;
          for (const unsigned int q : values.quadrature_point_indices())
            for (unsigned int i = 0; i < 4; ++i)
              for (unsigned int j = 0; j < 4; ++j)
                of_cell(i, j) += values.shape_grad(i, q) * values.shape_grad(j, q) * values.JxW(q);
          cell->get_dof_indices(indices);
          body.hanging->add_to(matrix, of_cell, indices);
        }
    matrix.compress(VectorOperation::add);
    const Vector field = body.values(linear);
    Vector       y     = body.vector();
    matrix.vmult(y, field);
    body.hanging->set(y, 0.);
    Vector inside = body.values(
      [](const Point<2> &p) { return p[0] * (1. - p[0]) * p[1] * (1. - p[1]) > 1e-6 ? 1. : 0.; });
    EXPECT_GT(y.linfty_norm(), 0.1);
    y.scale(inside);
    EXPECT_LT(y.linfty_norm(), 1e-14);
  }
} // namespace PeriDeal
