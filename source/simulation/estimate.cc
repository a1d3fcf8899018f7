// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/memory.h>
#include <perideal/base/progress.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/problems/problem_factory.h>
#include <perideal/problems/run_context.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/scene.h>
#include <perideal/simulation/estimate.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "model_comparison.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** What a scene takes on a lattice that is coarse enough to be built in a second. */
    struct Sample
    {
      double                     cells = 0., nodes = 0.; // of the lattice, vertices
      double                     memory = 0., time_to_build = 0.;
      std::vector<ModelEstimate> models;
    };


    /** Cells of a lattice with @p more = 0, its vertices with 1. */
    template <int dim>
    double number_of(const std::array<unsigned int, dim> &cells, const unsigned int more)
    {
      double result = 1.;
      for (const unsigned int k : cells)
        result *= static_cast<double>(k) + more;
      return result;
    }


    /**
     * Numbers of cells that are those of the scene divided by a whole number, if possible without
     * remainder, with about so many nodes.
     */
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
        if (std::all_of(cells.begin(), cells.end(), [q](const unsigned int k) {
              return k % q == 0;
            }))
          return divide(q);
      return divide(std::max(2u, ideal));
    }


    /**
     * The scene on a coarser lattice with the same horizon in terms of its spacing, without points
     * of output. Throws UserError if it cannot be, for instance since cracks do not lie on its
     * faces.
     */
    template <int dim>
    std::shared_ptr<Scene<dim>> coarse_scene(const Scene<dim>                    &scene,
                                             const std::array<unsigned int, dim> &cells)
    {
      std::string text;
      double      smallest = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        {
          text += (d > 0 ? ", " : "") + std::to_string(cells[d]);
          const double h = (scene.domain.upper[d] - scene.domain.lower[d]) / cells[d];
          smallest       = d == 0 ? h : std::min(smallest, h);
        }
      std::vector<Setting> settings{{"Domain/Node spacing", ""},
                                    {"Domain/Cells", text},
                                    {"Cracks/Nodes on cracks", "left"}, // these very cells
                                    {"Output/Probes", ""},
                                    {"Output/Line", ""},
                                    {"Output/Grid", ""}};
      if (scene.peridynamics.horizon > 0.)
        {
          const Tensor<1, dim> h   = scene.domain.spacing();
          double               own = h[0];
          for (unsigned int d = 1; d < dim; ++d)
            own = std::min(own, h[d]);
          settings.emplace_back("Peridynamics/Horizon",
                                number_text(scene.horizon() / own * smallest));
        }
      const std::shared_ptr<Scene<dim>> coarse = scene_variant(scene, settings);
      problem_factory(*coarse).require_computable(*coarse);
      return coarse;
    }


    template <int dim>
    void take_problems(const Scene<dim>                          &scene,
                       const std::shared_ptr<Triangulation<dim>> &mesh,
                       Sample                                    &sample)
    {
      ResultRecord     record;
      Progress         quiet(mesh->get_communicator(), true);
      const RunContext context{quiet, record, {}};
      Models<dim>      models;
      for (unsigned int k = 0; k < sample.models.size(); ++k)
        {
          const double start = processor_seconds();
          models.push_back(std::make_unique<Model<dim>>(scene.general.models[k], *mesh));
          models.back()->problem      = problem_factory(scene).make_problem(*models.back(), scene);
          const Problem<dim> &problem = *models.back()->problem;
          ModelEstimate      &model   = sample.models[k];
          const OperatorSize  size    = problem.op().size();
          model.unknowns              = static_cast<double>(size.unknowns);
          model.bonds                 = static_cast<double>(size.bonds);
          sample.time_to_build += processor_seconds() - start;
          model.time_of_application = time_of_application(problem.op());
        }
      for (unsigned int k = 0; k < models.size(); ++k)
        {
          models[k]->problem->take_sample(context, sample.models[k]);
          sample.models[k].components = components_written(*models[k]->problem, models.size());
        }
    }


    /** Build the scene, and solve what is linear, to see what that takes. Throws UserError.
     * Collective. */
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
      const double own = known ? PeriDeal::peak_memory() - before : 0.;
      sample.memory    = Utilities::MPI::sum(own, communicator);
      for (ModelEstimate &model : sample.models) // to be the same on all processes
        for (double *const time : {&model.time_of_application, &model.time_of_solution})
          *time = Utilities::MPI::max(*time, communicator);
      sample.time_to_build = Utilities::MPI::max(sample.time_to_build, communicator);
      return sample;
    }


    // Measured on scenes of all kinds: bytes that a node takes at least in the mesh and in the
    // vectors of a model, and when fields are written.
    constexpr double bytes_of_node = 400.;

    // Likewise, for each number that is written, at a corner of a cell: bytes, and seconds.
    constexpr double bytes_of_hdf5 = 52., bytes_of_vtu = 29., time_of_hdf5 = 0.4e-6,
                     time_of_vtu = 0.16e-6;

    /** Nodes above which a scene is not built in order to be described. */
    constexpr double many_nodes = 500000.;


    /** Members of a full family: the volume of the horizon over that of a cell. */
    template <int dim>
    double family_size(const Scene<dim> &scene)
    {
      double size = dim == 1 ? 2. : dim == 2 ? 3.1416 : 4.1888;
      for (unsigned int d = 0; d < dim; ++d)
        size *= scene.horizon() / scene.domain.spacing()[d];
      return size;
    }


    template <int dim>
    bool has_bonds(const Scene<dim> &scene)
    {
      return std::any_of(scene.general.models.begin(),
                         scene.general.models.end(),
                         [](const ModelKind model) { return model != ModelKind::finite_elements; });
    }


    /** What holes leave of a plate at least; a round or square one may be turned. */
    template <int dim>
    double share_of_body(const Domain<dim> &domain)
    {
      double whole = 1.;
      for (int d = 0; d < std::min(dim, 2); ++d)
        whole *= domain.upper[d] - domain.lower[d];
      double holes = domain.holes.has_one ? 4. * domain.holes.radius * domain.holes.radius : 0.;
      for (const Hole &hole : domain.holes.listed)
        holes += hole.area();
      return std::max(0., 1. - holes / whole);
    }


    /** Cells of the body; where cells are merged, the fewest that there may be. */
    template <int dim>
    double number_of_cells(const Scene<dim> &scene)
    {
      const Domain<dim> &domain = scene.domain;
      if (domain.image)
        return static_cast<double>(domain.image->phases.size()) -
               static_cast<double>(domain.image->counts().back());
      double n = number_of<dim>(domain.cells, 0) / std::pow(2., 1. * dim * domain.coarsening.times);
      if (domain.has_voids())
        n *= share_of_body(domain);
      return n;
    }


    /** What no run of the scene can do without. */
    template <int dim>
    RunEstimate least(const Scene<dim> &scene)
    {
      RunEstimate result;
      result.cells          = number_of_cells(scene);
      const double per_node = problem_factory(scene).n_components();
      const double family   = has_bonds(scene) ? family_size(scene) : 0.;
      result.memory         = 32. * family;
      for (const ModelKind model : scene.general.models)
        {
          ModelEstimate estimate;
          estimate.name     = to_string(model);
          estimate.unknowns = per_node * result.cells;
          if (model == ModelKind::peridynamics)
            estimate.bonds = 0.5 * result.cells * std::min(family, result.cells);
          result.memory += bytes_of_node * result.cells * std::sqrt(per_node);
          result.models.push_back(estimate);
        }
      return result;
    }


    /** a n + b n^((d-1)/d) through two values, neither of which is taken to be negative. */
    class Growth
    {
    public:
      Growth(const unsigned int dim, const double n1, const double n2, const double n)
        : dim(dim)
        , n1(n1)
        , n2(n2)
        , n(n)
      {}

      double operator()(const double v1, const double v2) const
      {
        const double r1 = rim(n1), r2 = rim(n2), a = (v1 * r2 - v2 * r1) / (n1 * r2 - n2 * r1),
                     b = (v2 - a * n2) / r2;
        if (a < 0.)
          return v2 * rim(n) / r2;
        return b < 0. && a * n + b * rim(n) < v2 ? v2 * n / n2 : a * n + b * rim(n);
      }

      /** As a power of the number of nodes. */
      double power(const double v1, const double v2) const
      {
        return v1 > 0. && v2 > 0. ? v2 * std::pow(n / n2, std::log(v2 / v1) / std::log(n2 / n1)) :
                                    0.;
      }

    private:
      double rim(const double n) const
      {
        return std::pow(n, (dim - 1.) / dim);
      }

      const unsigned int dim;
      const double       n1, n2, n;
    };


    /** Why there is no coarse lattice to learn from; empty if there is. */
    template <int dim>
    std::string obstacle(const Scene<dim> &scene, const double sample_nodes)
    {
      if (!scene.domain.has_lattice() || scene.domain.image)
        return "the body is no box";
      if (scene.domain.coarsening.times > 0 || scene.domain.has_extra_layers())
        return "the lattice is graded or has extra layers";
      if (has_bonds(scene))
        {
          if (sample_nodes * family_size(scene) > 2e7 * dim)
            return "the horizon is too many cells long";
          const auto coarse = coarse_cells<dim>(scene.domain.cells, sample_nodes / 4.);
          double     m      = 1e300;
          for (unsigned int d = 0; d < dim; ++d)
            m = std::min(m, scene.horizon() / scene.domain.spacing()[d]);
          if (*std::max_element(coarse.begin(), coarse.end()) < 2. * m)
            return "the horizon is too many cells long";
        }
      return "";
    }
  } // namespace


  template <int dim>
  OutputEstimate estimate_output(const Scene<dim>          &scene,
                                 const double               cells,
                                 const std::vector<double> &components,
                                 const unsigned int         n_processes)
  {
    // The times of output and the end; `Write every` begins at the start.
    const OutputControl<dim> &output  = scene.output;
    double                    n_times = 1.;
    if (!scene.time.steady)
      n_times =
        output.write_times.size() + (output.starts_at_zero() ? 1. : 0.) +
        (output.write_times.empty() || output.write_times.back() < scene.time.end_time ? 1. : 0.);
    const double   corners = cells * (1u << dim);
    OutputEstimate result;
    for (const double n : components)
      {
        // Each process makes its own part; one writes, and keeps what it gets from one of the
        // others.
        result.time +=
          n_times * corners * n *
          ((output.hdf5 ? time_of_hdf5 : 0.) + (output.vtu ? time_of_vtu / n_processes : 0.));
        result.memory = std::max(result.memory,
                                 corners * n *
                                   (output.hdf5 ? bytes_of_hdf5 :
                                    output.vtu  ? bytes_of_vtu :
                                                  0.));
      }
    return result;
  }


  template <int dim>
  std::vector<std::string> describe_costs(const Scene<dim>          &scene,
                                          const double               computing,
                                          const double               memory,
                                          const double               cells,
                                          const std::vector<double> &components,
                                          const MPI_Comm             communicator)
  {
    const OutputEstimate output =
      estimate_output(scene, cells, components, Utilities::MPI::n_mpi_processes(communicator));
    std::vector<std::string> lines;
    const bool               more = problem_factory(scene).may_solve_again(scene);
    lines.push_back(
      "time: " +
      (computing >= 0. ?
         (more ? "at least " : "about ") + readable_duration(computing + output.time) +
           " after building, " + readable_duration(output.time) + " of it for output" +
           (more ? "; each step in which bonds break takes some more equilibria" : "") :
         "about " + readable_duration(output.time) + " for output, besides the solution"));
    const double resident = Utilities::MPI::sum(resident_memory(), communicator),
                 peak     = Utilities::MPI::sum(peak_memory(), communicator);
    lines.push_back("memory: about " +
                    readable_bytes(std::max({peak, resident + output.memory, memory})) +
                    " at its peak, the program's own included");
    return lines;
  }


  template <int dim>
  RunEstimate estimate_run(const Scene<dim> &scene, const MPI_Comm communicator)
  {
    RunEstimate      result       = least(scene);
    constexpr double sample_nodes = dim == 1 ? 10000. : dim == 2 ? 24000. : 12000.;
    const double     nodes        = number_of<dim>(scene.domain.cells, 1);
    result.reason                 = nodes < 2. * sample_nodes ? "the lattice is small" :
                                                                obstacle(scene, sample_nodes);
    if (!result.reason.empty())
      return result;
    std::vector<Sample> samples;
    try
      {
        for (const double n : {sample_nodes / 4., sample_nodes})
          {
            const auto coarse = coarse_scene<dim>(scene, coarse_cells<dim>(scene.domain.cells, n));
            if (samples.empty())
              take_sample(*coarse, communicator); // what is loaded and kept once counts for neither
            samples.push_back(take_sample(*coarse, communicator));
          }
      }
    catch (const UserError &fault)
      {
        result.reason = "a coarse lattice cannot be used: " + fault.message();
        return result;
      }
    const Sample &one = samples[0], &two = samples[1];
    if (!(two.nodes > one.nodes))
      {
        result.reason = "the lattice is small";
        return result;
      }
    const Growth growth(dim, one.nodes, two.nodes, nodes);
    result.sampled       = true;
    result.cells         = growth(one.cells, two.cells);
    result.time_to_build = growth(one.time_to_build, two.time_to_build);
    if (!scene.domain.has_voids())
      result.cells = number_of<dim>(scene.domain.cells, 0);
    std::vector<double> components;
    for (unsigned int k = 0; k < result.models.size(); ++k)
      {
        ModelEstimate       &model = result.models[k];
        const ModelEstimate &a = one.models[k], &b = two.models[k];
        model.unknowns            = growth(a.unknowns, b.unknowns);
        model.bonds               = growth(a.bonds, b.bonds);
        model.applications        = growth.power(a.applications, b.applications);
        model.time_of_application = growth(a.time_of_application, b.time_of_application);
        if (a.time_of_solution > 0. && b.time_of_solution > 0.) // else not known
          model.time_of_solution = growth(a.time_of_solution, b.time_of_solution);
        model.components = b.components;
        components.push_back(b.components);
      }
    const OutputEstimate output = estimate_output(scene,
                                                  result.cells,
                                                  components,
                                                  Utilities::MPI::n_mpi_processes(communicator));
    result.memory         = std::max(result.memory, growth(one.memory, two.memory) + output.memory);
    result.time_of_output = output.time;
    return result;
  }


  template <int dim>
  ModelEstimate estimate_model(const Scene<dim>  &scene,
                               const std::string &model,
                               const MPI_Comm     communicator,
                               double            &memory)
  {
    const RunEstimate estimate = estimate_run(scene, communicator);
    memory                     = std::max(memory, estimate.memory);
    const auto found           = std::find_if(estimate.models.begin(),
                                    estimate.models.end(),
                                    [&](const auto &one) { return one.name == model; });
    return found == estimate.models.end() ? ModelEstimate() : *found;
  }


  namespace
  {
    /** Two digits: more would be made up. */
    std::string about(const double value)
    {
      const double unit =
        std::pow(10., std::max(0., std::floor(std::log10(std::max(value, 1.))) - 1.));
      return "about " +
             readable_count(static_cast<unsigned long long>(unit * std::round(value / unit)));
    }
  } // namespace


  std::vector<std::string> describe_estimate(const RunEstimate &estimate,
                                             const MPI_Comm     communicator)
  {
    std::vector<std::string> lines;
    lines.push_back("estimated, nothing was built" +
                    std::string(estimate.sampled ?
                                  " but the same body on two coarse lattices:" :
                                  ", from numbers of nodes alone, so that more may be needed (" +
                                    estimate.reason + "):"));
    lines.push_back("mesh: " + about(estimate.cells) + " cells");
    double time = estimate.time_to_build;
    for (const ModelEstimate &model : estimate.models)
      {
        std::string line = model.name + ": " + about(model.unknowns) + " unknowns";
        if (model.bonds > 0.)
          line += ", " + about(model.bonds) + " bonds";
        lines.push_back(line);
        if (model.applications > 0.)
          lines.push_back("  estimated: " + about(model.applications) + " operator applications, " +
                          readable_duration(model.applications * model.time_of_application));
        else if (model.time_of_application > 0.)
          lines.push_back("  estimated: " + readable_duration(model.time_of_application) +
                          " for each operator application");
        time += model.applications * model.time_of_application + model.time_of_solution;
      }
    if (estimate.sampled)
      lines.push_back("time: about " + readable_duration(estimate.time_to_build) + " to build, " +
                      readable_duration(time) + " with all that is told above, " +
                      readable_duration(time + estimate.time_of_output) + " with output");
    const double available = available_memory(communicator),
                 taken     = Utilities::MPI::sum(resident_memory(), communicator);
    lines.push_back(
      std::string("memory: ") + (estimate.sampled ? "about " : "at least ") +
      readable_bytes(taken + estimate.memory) + " at its peak, " + readable_bytes(taken) +
      " of it taken already; " + readable_bytes(available) + " are available" +
      (estimate.memory <= available                          ? "." :
       estimate.memory <= 2. * available && estimate.sampled ? ": it may not suffice." :
                                                               ": a run is refused."));
    return lines;
  }


  namespace
  {
    /** What no scene needs as much as: that of the costliest kinds of nodes and bonds. */
    template <int dim>
    double most(const Scene<dim> &scene, const double nodes, const double n_bonds)
    {
      constexpr double most_of_node = 20000., most_of_bond = 100.;
      const double     factor = problem_factory(scene).n_components();
      return factor * (most_of_node * nodes + most_of_bond * factor * n_bonds);
    }


    template <int dim>
    double bonds_of_full_families(const Scene<dim> &scene)
    {
      const double nodes = number_of_cells(scene);
      return has_bonds(scene) ? nodes * std::min(nodes, family_size(scene)) : 0.;
    }
  } // namespace


  template <int dim>
  bool is_large(const Scene<dim> &scene, const MPI_Comm communicator)
  {
    if (!scene.domain.has_lattice())
      return false; // no larger than its file
    const double nodes = number_of_cells(scene), n_bonds = bonds_of_full_families(scene);
    const double factor = problem_factory(scene).n_components();
    return nodes * factor > many_nodes || n_bonds * factor > 100. * many_nodes ||
           most(scene, nodes, n_bonds) > 0.5 * available_memory(communicator);
  }


  template <int dim>
  void require_memory(const Scene<dim> &scene, const MPI_Comm communicator)
  {
    if (!scene.domain.has_lattice())
      return;
    const double available = available_memory(communicator);
    if (most(scene, number_of_cells(scene), bonds_of_full_families(scene)) < available)
      return;
    const double      least_of_all = least(scene).memory;
    const RunEstimate estimate     = least_of_all > available ? least(scene) :
                                                                estimate_run(scene, communicator);
    // Estimates are right to a factor of two.
    if (estimate.memory <= (estimate.sampled ? 2. : 1.) * available)
      return;
    const std::string entry = scene.domain.image ? "Cells per pixel" : "Cells";
    AssertThrow(
      false,
      UserError("The scene needs " + std::string(estimate.sampled ? "about " : "at least ") +
                readable_bytes(estimate.memory) + " of memory for " + about(estimate.cells) +
                " cells, but " + readable_bytes(available) + " are available. Choose fewer '" +
                entry + "' in section 'Domain'" +
                (has_bonds(scene) ? ", a smaller 'Horizon ratio' in section 'Peridynamics'" :
                                    std::string()) +
                " or fewer 'Models'; `perideal check` tells what a scene needs."));
  }


  PERIDEAL_INSTANTIATE_FUNCTION(estimate_output);
  PERIDEAL_INSTANTIATE_FUNCTION(describe_costs);
  PERIDEAL_INSTANTIATE_FUNCTION(estimate_run);
  PERIDEAL_INSTANTIATE_FUNCTION(estimate_model);
  PERIDEAL_INSTANTIATE_FUNCTION(is_large);
  PERIDEAL_INSTANTIATE_FUNCTION(require_memory);
} // namespace PeriDeal
