// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "scene_sample.h"

#include <deal.II/base/mpi.h>

#include <perideal/base/memory.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/scene/lists.h>
#include <perideal/solvers/floating_part.h>
#include <perideal/solvers/linear_solver.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "problem_factory.h"
#include "run_context.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  double number_of(const std::array<unsigned int, dim> &cells, const unsigned int more)
  {
    double result = 1.;
    for (const unsigned int k : cells)
      result *= static_cast<double>(k) + more;
    return result;
  }


  template <int dim>
  std::array<unsigned int, dim> coarse_cells(const std::array<unsigned int, dim> &cells,
                                             const double                         nodes)
  {
    const auto divide = [&](const unsigned int q) {
      std::array<unsigned int, dim> n = cells;
      for (unsigned int &k : n)
        k = std::max(2u, (k + q / 2) / q);
      return n;
    };
    const auto ideal =
      static_cast<unsigned int>(std::ceil(std::pow(number_of<dim>(cells, 1) / nodes, 1. / dim)));
    // Not so far from the ideal that lattices of a quarter of the nodes have the same divisor.
    for (unsigned int q = std::max(2u, ideal); 2 * q < 3 * ideal; ++q)
      if (std::all_of(cells.begin(), cells.end(), [q](const unsigned int k) { return k % q == 0; }))
        return divide(q);
    return divide(std::max(2u, ideal));
  }


  template <int dim>
  std::shared_ptr<Scene<dim>> coarse_scene(const Scene<dim>                    &scene,
                                           const std::array<unsigned int, dim> &cells)
  {
    const auto                        coarse = std::make_shared<Scene<dim>>();
    const std::vector<SceneSection *> to     = coarse->sections(),
                                      from   = const_cast<Scene<dim> &>(scene).sections();
    for (unsigned int k = 0; k < from.size(); ++k)
      for (const Entry &entry : from[k]->entries())
        to[k]->set(entry.name, entry.text);
    std::string text;
    double      smallest = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        text += (d > 0 ? ", " : "") + std::to_string(cells[d]);
        const double h = (scene.domain.upper[d] - scene.domain.lower[d]) / cells[d];
        smallest       = d == 0 ? h : std::min(smallest, h);
      }
    coarse->domain.set("Node spacing", "");
    coarse->domain.set("Cells", text);
    coarse->cracks.set("Nodes on cracks", "left"); // these very cells
    if (scene.peridynamics.horizon > 0.)
      {
        const Tensor<1, dim> h   = scene.domain.spacing();
        double               own = h[0];
        for (unsigned int d = 1; d < dim; ++d)
          own = std::min(own, h[d]);
        coarse->peridynamics.set("Horizon", number_text(scene.horizon() / own * smallest));
      }
    for (const char *const entry : {"Probes", "Line", "Grid"})
      coarse->output.set(entry, "");
    coarse->domain.scene_folder = scene.domain.scene_folder;
    coarse->domain.communicator = scene.domain.communicator;
    coarse->parse_and_validate();
    return coarse;
  }


  double processor_seconds()
  {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  }


  double time_of_application(const Operator &op)
  {
    Vector x, y;
    op.initialize_vector(x);
    op.initialize_vector(y);
    op.apply(y, x);
    constexpr unsigned int n_trials = 20;
    const double           start    = processor_seconds();
    for (unsigned int k = 0; k < n_trials; ++k)
      op.apply(y, x);
    return (processor_seconds() - start) / n_trials;
  }


  double time_of_linear_equilibrium(const SolverControlParameters &control,
                                    ElasticOperator               &op,
                                    const double                   t,
                                    const bool                     must_be_held)
  {
    const double start = processor_seconds();
    Vector       u, r, change;
    for (Vector *const v : {&u, &r, &change})
      op.initialize_vector(*v);
    op.distribute(u, t);
    op.residual(r, u, t);
    LinearSolver solver(op, control.tolerance, control.max_iterations, control.direct_up_to);
    if (must_be_held && r.l2_norm() > 0.)
      check_no_loose_part(op, solver.surrogate(), r);
    try
      {
        solver.solve(0., 1., change, r);
      }
    catch (const UserError &) // on all processes
      {
        return -1.;
      }
    return processor_seconds() - start;
  }


  namespace
  {
    template <int dim>
    void take_problems(const Scene<dim>                          &scene,
                       const std::shared_ptr<Triangulation<dim>> &mesh,
                       Sample                                    &sample)
    {
      ResultRecord          record;
      RunOutput<dim>        output(scene, record);
      Progress              quiet(mesh->get_communicator(), true);
      const RunContext<dim> context{quiet, record, output};
      Problems<dim>         problems;
      for (unsigned int k = 0; k < sample.models.size(); ++k)
        {
          const double start = processor_seconds();
          problems.push_back(make_problem(scene.general.models[k], *mesh, scene));
          const Problem<dim> &problem = *problems.back();
          ModelEstimate      &model   = sample.models[k];
          const OperatorSize  size    = problem.op().size();
          model.unknowns              = static_cast<double>(size.unknowns);
          model.bonds                 = static_cast<double>(size.bonds);
          sample.time_to_build += processor_seconds() - start;
          model.time_of_application = time_of_application(problem.op());
        }
      for (unsigned int k = 0; k < problems.size(); ++k)
        {
          problems[k]->take_sample(context, sample.models[k]);
          for (const OutputField &field : problems[k]->fields(0.))
            sample.models[k].components += field.components.size();
          // The difference of the models.
          if (problems.size() > 1 && problems[k]->columns().size() == 1 &&
              scene.general.models[k] == ModelKind::peridynamics)
            sample.models[k].components += 1.;
        }
    }
  } // namespace


  template <int dim>
  Sample take_sample(const Scene<dim> &scene, const MPI_Comm communicator)
  {
    Sample sample;
    sample.nodes        = number_of<dim>(scene.domain.cells, 1);
    const bool   known  = forget_peak_memory();
    const double before = resident_memory();
    for (const ModelKind model : scene.general.models)
      sample.models.push_back({to_string(model)});
    std::vector<std::string>                  notes;
    const double                              start = processor_seconds();
    const std::shared_ptr<Triangulation<dim>> mesh  = build_mesh(scene, communicator, notes);
    sample.cells         = static_cast<double>(mesh->n_global_active_cells());
    sample.time_to_build = processor_seconds() - start;
    take_problems(scene, mesh, sample);
    const double own = known ? peak_memory() - before : 0.;
    sample.memory    = Utilities::MPI::sum(own, communicator);
    for (ModelEstimate &model : sample.models) // to be the same on all processes
      for (double *const time : {&model.time_of_application, &model.time_of_solution})
        *time = Utilities::MPI::max(*time, communicator);
    sample.time_to_build = Utilities::MPI::max(sample.time_to_build, communicator);
    return sample;
  }


  template <int dim>
  double time_of_equilibria(const Scene<dim>  &scene,
                            ElasticOperator   &op,
                            const unsigned int model,
                            const double       n_steps,
                            const MPI_Comm     communicator,
                            double            &memory)
  {
    // Larger ones take longer than one likes to wait for a check; where there is no coarse lattice
    // one waits some more.
    constexpr double few_unknowns = 5e4, many_unknowns = 3e5;
    // Iterations of other solvers over those of the linear one, where these are alike.
    constexpr double of_full_kinematics = 3.;
    if (scene.elasticity.solver == ElasticSolver::dynamic_relaxation ||
        scene.elasticity.solver == ElasticSolver::adaptive_dynamic_relaxation)
      return -1.;
    const double n_unknowns = static_cast<double>(op.size().unknowns);
    double       first      = 0.;
    if (n_unknowns > few_unknowns)
      {
        const RunEstimate estimate = estimate_run(scene, communicator);
        first                      = estimate.models[model].time_of_solution;
        memory                     = std::max(memory, estimate.memory);
      }
    if (first <= 0. && n_unknowns <= many_unknowns)
      first =
        Utilities::MPI::max(time_of_linear_equilibrium(scene.solver,
                                                       op,
                                                       scene.time.steady ? 0. : scene.time.end_time,
                                                       !op.nonlinear()),
                            communicator);
    if (first <= 0.)
      return -1.;
    if (op.nonlinear())
      first *= of_full_kinematics;
    // A step whose loads grow in proportion starts from its solution, and looks at every bond.
    constexpr double applications_of_step = 5.;
    if (scene.time.steady)
      return first;
    const bool alike = !op.nonlinear() && !scene.warms_slowly();
    return first + n_steps * (alike ? applications_of_step * time_of_application(op) : first);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                  \
  template double number_of<dim>(const std::array<unsigned int, dim> &, const unsigned int);       \
  template std::array<unsigned int, dim> coarse_cells<dim>(const std::array<unsigned int, dim> &,  \
                                                           const double);                          \
  template std::shared_ptr<Scene<dim>>   coarse_scene<dim>(const Scene<dim> &,                     \
                                                         const std::array<unsigned int, dim> &); \
  template Sample                        take_sample<dim>(const Scene<dim> &, const MPI_Comm);     \
  template double                        time_of_equilibria<dim>(const Scene<dim> &,               \
                                          ElasticOperator &,                \
                                          const unsigned int,               \
                                          const double,                     \
                                          const MPI_Comm,                   \
                                          double &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
