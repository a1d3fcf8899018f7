// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/distributed/grid_refinement.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_generator.h>

#include <perideal/analysis/field_error.h>
#include <perideal/solvers/linear_solver.h>

#include <set>

#include "goal_error_cases.h"

namespace PeriDeal
{
  using namespace dealii;
  using namespace OperatorTests;
  using namespace GoalCases;

  namespace
  {
    /**
     * -Laplace u = 1 on a square with a square hole, 0 on all sides: exercise 2.3 of Bangerth and
     * Rannacher 2003, and of deal.II's step-14, on meshes refined by the estimate of a goal.
     */
    class SquareRing
    {
    public:
      SquareRing()
        : mesh(MPI_COMM_WORLD)
      {
        Triangulation<2> square, ring;
        GridGenerator::subdivided_hyper_cube(square, 4, -1., 1.);
        std::set<Triangulation<2>::active_cell_iterator> removed;
        for (const auto &cell : square.active_cell_iterators())
          if (std::abs(cell->center()[0]) < 0.5 && std::abs(cell->center()[1]) < 0.5)
            removed.insert(cell);
        GridGenerator::create_triangulation_with_removed_cells(square, removed, ring);
        for (const auto &face : ring.active_face_iterators())
          if (face->at_boundary())
            face->set_boundary_id(0);
        mesh.copy_triangulation(ring);
        mesh.refine_global(1);
        body.run.steady                = true;
        body.initial_and_source.source = Expression(1.);
        body.set_own_mesh(0.1);
        body.boundary_conditions.prescribe(0, Expression(0.));
      }

      /** Solve, estimate the value at (0.75, 0.75), and refine by 80 per cent of the shares. */
      Row solve(const bool adapt)
      {
        const Goal<2> goal = Goal<2>::value_at({0.75, 0.75});
        DoFHandler<2> dofs(mesh);
        dofs.distribute_dofs(FE_Q<2>(1));
        n_dofs                 = dofs.n_dofs();
        const auto        made = field_of_elements<2>(dofs, body);
        FieldOperator<2> &op   = *made;
        Vector            u;
        op.initialize_vector(u);
        solve_steady(op, u, 0., 1e-12, 1000);
        LinearSolver      solver(op, 1e-12, 1000);
        const SolveSystem solution = [&](Vector &x, const Vector &b) {
          solver.solve(0., 1., x, b);
        };
        const QuadraticElements<2> elements(op, body);
        const GoalError            error = GoalErrors<2>(elements, solution, u).of(goal);
        const FieldError<2>        field(elements, solution, u);
        const auto                 fine  = field_of_elements<2>(elements.dof_handler(), body);
        Vector                     finer = elements.quadratic_vector();
        solve_steady(*fine, finer, 0., 1e-12, 1000);
        const Cracks<2> &cracks = body.cracks;
        Row              row;
        row.error     = 0.0334473 - error.value; // the value that step-14 has extrapolated
        row.weighted  = error.estimate;
        row.corrected = value_at<2>(elements.dof_handler(), cracks, goal.point, field.field());
        row.quadratic =
          value_at<2>(elements.dof_handler(), cracks, goal.point, finer) - error.value;
        dealii::Vector<float> marks(mesh.n_active_cells());
        for (unsigned int c = 0; c < marks.size(); ++c)
          marks[c] = std::abs(error.cells[c]);
        if (adapt)
          parallel::distributed::GridRefinement::refine_and_coarsen_fixed_fraction(mesh,
                                                                                   marks,
                                                                                   0.8,
                                                                                   0.02);
        else
          mesh.set_all_refine_flags();
        mesh.execute_coarsening_and_refinement();
        return row;
      }

      unsigned long long n_dofs = 0;

    private:
      parallel::distributed::Triangulation<2> mesh;
      HeatParameters<2>                       body;
    };
  } // namespace


  TEST(GoalErrors, beside_step_14)
  {
    for (const bool adapt : {false, true})
      {
        SquareRing         ring;
        const unsigned int n_cycles = with_tables() ? (adapt ? 9 : 5) : 3;
        for (unsigned int cycle = 0; cycle < n_cycles; ++cycle)
          {
            const Row row = ring.solve(adapt);
            print_row("ring, " + std::string(adapt ? "adapted" : "uniform") + " | " +
                        std::to_string(ring.n_dofs),
                      row);
            // 0.69 on the first mesh, as there; later there 0.92 to 0.95.
            const double ratio = row.quadratic / row.error;
            EXPECT_GT(ratio, cycle == 0 ? 0.68 : adapt ? 0.8 : 0.75) << cycle;
            EXPECT_LT(ratio, cycle == 0 ? 0.7 : adapt ? 0.95 : 0.8) << cycle;
            EXPECT_LT(row.corrected / row.error, 0.6) << cycle; // recovery sees little of corners
            EXPECT_NEAR(row.weighted, row.corrected, 1e-9) << cycle;
          }
      }
  }
} // namespace PeriDeal
