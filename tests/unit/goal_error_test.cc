// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>

#include <perideal/analysis/field_error.h>
#include <perideal/analysis/goal_error.h>
#include <perideal/solvers/linear_solver.h>

#include <cstdio>
#include <memory>

#include "goal_error_cases.h"

namespace PeriDeal
{
  using namespace dealii;
  using namespace OperatorTests;
  using namespace GoalCases;

  namespace
  {
    /** Its finite elements, and the parts that estimate their error. */
    template <int dim>
    struct Solved
    {
      explicit Solved(const Settings &settings,
                      const ModelKind model        = ModelKind::finite_elements,
                      const MPI_Comm  communicator = MPI_COMM_WORLD)
        : problem(settings, model, communicator)
        , u(problem.vector())
        , solver(problem.op(), 1e-12, 2000)
        , solve([this](Vector &x, const Vector &b) { solver.solve(0., 1., x, b); })
      {
        solve_steady(problem.op(), u, 0., 1e-12, 2000);
        elements = std::make_unique<QuadraticElements<dim>>(
          problem.op(),
          problem.scene,
          model == ModelKind::coupled ? &cells_of(problem.op()).bonds() : nullptr);
      }

      Problem<dim>                            problem;
      Vector                                  u;
      LinearSolver                            solver;
      SolveSystem                             solve;
      std::unique_ptr<QuadraticElements<dim>> elements;
    };


    /** Root of the mean square of exact - u. */
    template <int dim>
    double mean_error(const DoFHandler<dim> &dofs, const Vector &u, const Function<dim> &exact)
    {
      u.update_ghost_values();
      FEValues<dim>       values(dofs.get_fe(),
                           QGauss<dim>(4),
                           update_values | update_quadrature_points | update_JxW_values);
      std::vector<double> at_points(values.n_quadrature_points);
      double              square = 0., volume = 0.;
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            values.reinit(cell);
            values.get_function_values(u, at_points);
            for (const unsigned int q : values.quadrature_point_indices())
              {
                const double e = at_points[q] - exact(values.quadrature_point(q));
                square += e * e * values.JxW(q);
                volume += values.JxW(q);
              }
          }
      u.set_ghost_state(false);
      const MPI_Comm communicator = dofs.get_communicator();
      return std::sqrt(dealii::Utilities::MPI::sum(square, communicator) /
                       dealii::Utilities::MPI::sum(volume, communicator));
    }


    /** Those of all goals, and at last those of the root mean square. */
    template <int dim>
    std::vector<Row> rows_of(const Case<dim> &test,
                             const Settings  &more,
                             const bool       with_quadratic,
                             const ModelKind  model = ModelKind::finite_elements)
    {
      const Solved<dim>                   solved(test.settings + more, model);
      const auto                         &scene = solved.problem.scene;
      const GoalErrors<dim>               weighted(*solved.elements, solved.solve, solved.u);
      const FieldError<dim>               corrected(*solved.elements, solved.solve, solved.u);
      const DoFHandler<dim>              &fine_dofs = solved.elements->dof_handler();
      std::unique_ptr<FieldOperator<dim>> fine;
      Vector                              finer = solved.elements->quadratic_vector();
      if (with_quadratic)
        {
          fine = field_of_elements<dim>(fine_dofs, scene);
          solve_steady(*fine, finer, 0., 1e-12, 2000);
        }
      std::vector<Row> rows;
      for (std::size_t k = 0; k < test.goals.size(); ++k)
        {
          const Goal<dim> &goal  = test.goals[k];
          const GoalError  error = weighted.of(goal);
          const bool       point = goal.side.empty();
          Row              row;
          row.error     = test.values[k] - error.value;
          row.weighted  = error.estimate;
          row.corrected = point ?
                            value_at<dim>(fine_dofs, scene.cracks, goal.point, corrected.field()) :
                            corrected.of_flow_through(goal.side);
          if (with_quadratic)
            row.quadratic = (point ? value_at<dim>(fine_dofs, scene.cracks, goal.point, finer) :
                                     fine->balance(finer, 0., true).sides.at(goal.side)) -
                            error.value;
          rows.push_back(row);
        }
      Row mean;
      mean.error     = mean_error<dim>(solved.problem.handler, solved.u, test.exact);
      mean.weighted  = solved.elements->root_mean_square(weighted.solution_bubbles());
      mean.corrected = corrected.root_mean_square();
      if (with_quadratic)
        {
          finer -= solved.elements->prolonged(solved.u);
          mean.quadratic = solved.elements->root_mean_square(finer);
        }
      rows.push_back(mean);
      return rows;
    }


    /** Rows of a problem on finer and finer meshes; returns those of the fields. */
    template <int dim>
    std::vector<Row> rows_of_fields(const Case<dim>                 &test,
                                    const std::vector<unsigned int> &counts,
                                    const bool                       with_quadratic,
                                    const Settings                  &more = {})
    {
      std::vector<Row> fields;
      for (const unsigned int n : counts)
        {
          const auto rows = rows_of<dim>(test, cells(n, dim) + more, with_quadratic);
          for (std::size_t k = 0; k < rows.size(); ++k)
            print_row(test.name + " | " + std::to_string(n) + " | " +
                        (k == test.goals.size()     ? "field" :
                         test.goals[k].side.empty() ? "value " + std::to_string(k) :
                                                      "flow " + test.goals[k].side),
                      rows[k]);
          fields.push_back(rows.back());
        }
      return fields;
    }
  } // namespace


  namespace
  {
    /** Bubbles of a quadratic polynomial, but on the left side and where @p leave_out says. */
    template <int dim>
    void expect_exact_bubbles(const Settings &settings, const Function<dim> &leave_out)
    {
      const Function<dim> f = [](const Point<dim> &p) {
        double value = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          value += (d + 0.5) * p[d] - (d + 1.) * p[d] * p[(d + 1) % dim] + 0.7 * p[d] * p[d];
        return value;
      };
      const Solved<dim> solved(
        settings + Settings{{"Time/Steady", "true"}, {"Boundary conditions/Dirichlet", "left: 0"}});
      Vector v = solved.problem.values(f);
      cells_of(solved.problem.op()).hanging_nodes().interpolate(v);
      Vector w = solved.elements->recovered_bubbles(v);
      w += solved.elements->prolonged(v);
      std::map<types::global_dof_index, Point<dim>> places;
      DoFTools::map_dofs_to_support_points(MappingQ1<dim>(),
                                           solved.elements->dof_handler(),
                                           places);
      double       largest = 0.;
      unsigned int n       = 0;
      for (const auto &[dof, p] : places)
        if (w.in_local_range(dof) && p[0] > 1e-9 && leave_out(p) == 0.)
          {
            largest = std::max(largest, std::abs(w(dof) - f(p)));
            ++n;
          }
      EXPECT_GT(sum_of_all(n), 20u);
      EXPECT_LT(largest, 1e-11);
    }
  } // namespace


  TEST(GoalErrors, quadratic_fields_are_recovered)
  {
    const auto nothing = [](const auto &) { return 0.; };
    expect_exact_bubbles<1>({{"Domain/Cells", "24"}}, nothing);
    expect_exact_bubbles<2>({{"Domain/Cells", "6, 5"}}, nothing);
    expect_exact_bubbles<3>({{"Domain/Cells", "4, 3, 4"}}, nothing);
    // Hanging nodes follow from straight edges.
    expect_exact_bubbles<2>(
      {{"Domain/Cells", "16, 16"}, {"Domain/Coarsening", "1"}, {"Domain/Fine where", "0.3 - x"}},
      [](const Point<2> &p) { return std::abs(p[0] - 0.5) < 0.2 ? 1. : 0.; });
  }


  namespace
  {
    /** Estimates of all goals and of the field lie between parts of the true errors. */
    template <int dim>
    void expect_effectivities(const std::string      &name,
                              const std::vector<Row> &rows,
                              double Row::*const estimate,
                              const double       least,
                              const double       most)
    {
      for (std::size_t k = 0; k < rows.size(); ++k)
        {
          EXPECT_GT(rows[k].*estimate / rows[k].error, least) << name << ", goal " << k;
          EXPECT_LT(rows[k].*estimate / rows[k].error, most) << name << ", goal " << k;
        }
    }


    std::vector<Row> all_but(std::vector<Row> rows, const std::size_t k)
    {
      rows.erase(rows.begin() + k);
      return rows;
    }
  } // namespace


  TEST(GoalErrors, corrected_fields_are_right_where_solutions_are_smooth)
  {
    // The flow of the first has its own test.
    for (const auto &test : {smooth(), mixed(), graded(), layer()})
      {
        auto rows = rows_of<2>(test, cells(64), false);
        if (test.name == "mixed")
          rows = all_but(rows, 3); // of the side with convection
        if (test.name == "smooth")
          rows = all_but(rows, 2);
        expect_effectivities<2>(test.name, rows, &Row::corrected, 0.9, 1.1);
      }
    expect_effectivities<3>("cube",
                            rows_of<3>(cube(), cells(8, 3), false),
                            &Row::corrected,
                            0.8,
                            1.2);
  }


  TEST(GoalErrors, dual_weights_are_right)
  {
    auto rows = rows_of<2>(mixed(), cells(32), false);
    rows.pop_back(); // the field
    expect_effectivities<2>("mixed", rows, &Row::weighted, 0.95, 1.05);
    // Flows, with a source and a conductivity that varies, and into a side of steep flow.
    for (const auto &test : {graded(), layer()})
      {
        const Row flow = rows_of<2>(test, cells(32), false)[2];
        expect_effectivities<2>(test.name, {flow}, &Row::weighted, 0.95, 1.05);
      }
  }


  TEST(GoalErrors, values_are_those_of_the_corrected_field)
  {
    for (const auto &test : {smooth(), mixed(), graded(), layer(), crack("faces"), crack("pairs")})
      {
        const auto rows = rows_of<2>(test, cells(test.name == "crack, pairs" ? 17 : 16), false);
        for (const unsigned int k : {0, 1})
          EXPECT_NEAR(rows[k].weighted, rows[k].corrected, 1e-9) << test.name;
      }
  }


  TEST(GoalErrors, quadratic_elements_are_right)
  {
    for (const auto &test : {smooth(), mixed(), graded()})
      expect_effectivities<2>(test.name,
                              rows_of<2>(test, cells(32), true),
                              &Row::quadratic,
                              0.95,
                              1.05);
    expect_effectivities<2>("distorted",
                            rows_of<2>(distorted(32), {}, true),
                            &Row::quadratic,
                            0.95,
                            1.05);
    // The tip of a crack: errors of both go with the size of cells.
    expect_effectivities<2>("crack",
                            rows_of<2>(crack("faces"), cells(32), true),
                            &Row::quadratic,
                            0.6,
                            0.8);
  }


  TEST(GoalErrors, recovery_does_not_see_tips_and_cut_cells)
  {
    for (const Row &row : rows_of<2>(crack("faces"), cells(32), false))
      EXPECT_LT(row.corrected / row.error, 0.3);
    for (const Row &row : rows_of<2>(crack("pairs"), cells(33), false))
      EXPECT_LT(row.corrected / row.error, 0.1);
  }


  TEST(GoalErrors, two_meshes)
  {
    for (const auto &test : {smooth(), graded(), crack("faces")})
      for (const unsigned int n : {16, 24})
        {
          const Solved<2> coarse(test.settings + cells(n)), fine(test.settings + cells(32));
          const double    difference =
            difference_on_meshes<2>(fine.problem.handler, fine.u, coarse.problem.handler, coarse.u);
          const double order = test.name == "crack, faces" ? 1. : 2.;
          const double error = mean_error<2>(fine.problem.handler, fine.u, test.exact);
          const double ratio = extrapolated_error(difference, 32., n, order) / error;
          if (with_tables())
            std::printf("| two meshes, %s | %u and 32 | %.3f |\n", test.name.c_str(), n, ratio);
          // What the fields lack inside of their cells does not cancel in the difference, which
          // counts the more the less the sizes differ.
          EXPECT_GT(ratio, 0.9) << test.name << ' ' << n;
          EXPECT_LT(ratio, n == 16 ? 1.25 : 1.5) << test.name << ' ' << n;
        }
  }


  TEST(GoalErrors, same_on_every_number_of_processes)
  {
    std::vector<Case<2>> tests{mixed(), layer(), crack("faces"), crack("pairs"), crack("pairs")};
    tests.back().name = "zone";
    for (const Case<2> &test : tests)
      {
        const bool     graded_mesh = test.name == "layer";
        const Settings more =
          cells(16) + (graded_mesh ?
                         Settings{{"Domain/Coarsening", "1"}, {"Domain/Fine where", "0.3 - x"}} :
                         Settings());
        const ModelKind model = test.name == "zone" ? ModelKind::coupled :
                                                      ModelKind::finite_elements;
        const Solved<2> one(test.settings + more, model, MPI_COMM_SELF),
          all(test.settings + more, model);
        EXPECT_EQ(one.elements->share_left_out(), all.elements->share_left_out());
        EXPECT_EQ(one.elements->share_left_out() > 0.,
                  test.name == "zone" || test.name == "crack, pairs");
        const GoalErrors<2> of_one(*one.elements, one.solve, one.u),
          of_all(*all.elements, all.solve, all.u);
        const FieldError<2> field_of_one(*one.elements, one.solve, one.u),
          field_of_all(*all.elements, all.solve, all.u);
        for (const Goal<2> &goal : test.goals)
          {
            const GoalError a = of_one.of(goal), b = of_all.of(goal);
            EXPECT_NEAR(a.value, b.value, 1e-10) << test.name;
            EXPECT_NEAR(a.estimate, b.estimate, 1e-10) << test.name;
            double sum_a = 0., sum_b = 0.;
            for (const double share : a.cells)
              sum_a += std::abs(share);
            for (const double share : b.cells)
              sum_b += std::abs(share);
            EXPECT_NEAR(sum_a, sum_of_all(sum_b), 1e-10) << test.name;
          }
        EXPECT_NEAR(field_of_one.root_mean_square(), field_of_all.root_mean_square(), 1e-10)
          << test.name;
      }
  }


  TEST(GoalErrors, quadratic_elements_see_the_error_of_fields_under_refinement)
  {
    using Counts      = std::vector<unsigned int>;
    const Counts flat = with_tables() ? Counts{8, 16, 32, 64} : Counts{8, 16},
                 odd  = with_tables() ? Counts{9, 19, 39} : Counts{9},
                 deep = with_tables() ? Counts{8, 16} : Counts{8};
    const Settings half_fine{{"Domain/Coarsening", "1"}, {"Domain/Fine where", "0.3 - x"}};
    const auto     check = [](const std::string &name, const std::vector<Row> &fields) {
      expect_effectivities<2>(name, fields, &Row::quadratic, 0.95, 1.05);
    };
    for (const auto &test : {smooth(), mixed(), layer(), graded()})
      check(test.name, rows_of_fields<2>(test, flat, true));
    check("odd", rows_of_fields<2>(smooth(), odd, true));
    check("hanging nodes", rows_of_fields<2>(smooth(), {16, 32}, true, half_fine));
    check("cube", rows_of_fields<3>(cube(), deep, true));
    for (const unsigned int n : flat)
      check("distorted", rows_of_fields<2>(distorted(n), {n}, true));
    expect_effectivities<2>("crack",
                            rows_of_fields<2>(crack("faces"), flat, true),
                            &Row::quadratic,
                            0.65,
                            0.75);
    if (with_tables())
      {
        rows_of_fields<2>(smooth(), {64}, true, half_fine);
        rows_of_fields<2>(crack("pairs"), {9, 17, 33, 65}, false);
      }
  }
} // namespace PeriDeal
