// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Coupled operators: how long it takes to build them, against the matrix of finite elements on the
// same mesh, and what a moving zone adds to a transient run. Both sides of each ratio are measured
// in turn, as processor time.

#include <deal.II/grid/grid_tools.h>

#include <perideal/operators/coupling/coupling.h>
#include <perideal/operators/diffusion/cell_term.h>
#include <perideal/solvers/stepper.h>

#include <filesystem>

#include "benchmark_findings.h"
#include "benchmark_problem.h"

namespace PeriDeal
{
  namespace
  {
    /** A mesh with unknowns, on which operators can be built. */
    template <int dim>
    struct Body
    {
      explicit Body(const std::string &text)
      {
        SceneText scene_text{"benchmark", text};
        parse_scene(scene_text, scene);
        std::vector<std::string> notes;
        mesh    = build_mesh(scene, MPI_COMM_WORLD, notes);
        handler = std::make_unique<dealii::DoFHandler<dim>>(*mesh);
        handler->distribute_dofs(dealii::FE_Q<dim>(1));
        if (scene.domain.has_lattice())
          number_along_lattice(*handler, scene.domain);
      }

      std::unique_ptr<FieldOperator<dim>> elements() const
      {
        return field_of_elements<dim>(*handler, scene);
      }

      /** Nodes and bonds first, as in a run. */
      std::unique_ptr<FieldOperator<dim>> coupled()
      {
        nodes =
          std::make_unique<Nodes<dim>>(*handler, scene.domain, scene.cracks, NodalVolume::partial);
        auto coupling = make_coupling(*nodes,
                                      scene,
                                      Zone<dim>(scene.coupling, scene.horizon()),
                                      scene.coupling.scheme);
        return field_of_elements(*handler, scene, std::move(coupling));
      }

      Scene<dim>                                  scene;
      std::unique_ptr<dealii::Triangulation<dim>> mesh;
      std::unique_ptr<dealii::DoFHandler<dim>>    handler;
      std::unique_ptr<Nodes<dim>>                 nodes;
    };


    std::string section(const std::string &name, const std::string &entries)
    {
      return "subsection " + name + "\n" + entries + "end\n";
    }


    std::string list(const std::string &entry, const int dim)
    {
      return entry + (dim > 1 ? ", " + entry : "") + (dim > 2 ? ", " + entry : "");
    }


    /** A unit square or cube with a crack in its middle. */
    template <int dim>
    std::string cracked(const std::string &domain,
                        const std::string &horizon,
                        const std::string &zone)
    {
      return "set Dimension = " + std::to_string(dim) + "\nset Models = coupled\n" +
             section("Domain", domain) +
             section(
               "Cracks",
               dim == 2 ?
                 "set Segments = 0.23,0.41 ; 0.78,0.63\n" :
                 "set Polygons = 0.3,0.3,0.52 ; 0.7,0.3,0.52 ; 0.7,0.7,0.48 ; 0.3,0.7,0.48\n") +
             section("Peridynamics", horizon) + section("Coupling", "set Zone = " + zone + "\n");
    }


    template <int dim>
    void compare_building(const std::string &name, const std::string &scene)
    {
      constexpr unsigned int n_runs = 3;
      Body<dim>              body(scene);
      double                 coupled = 1e300, elements = 1e300, bonds = 0.;
      for (unsigned int k = 0; k < n_runs; ++k)
        {
          auto start = processor_seconds();
          body.elements();
          elements      = std::min(elements, processor_seconds() - start);
          start         = processor_seconds();
          const auto op = body.coupled();
          coupled       = std::min(coupled, processor_seconds() - start);
          bonds         = static_cast<double>(op->size().bonds);
        }
      const double each = 1e6 * (coupled - 3. * elements) / bonds;
      found(name,
            text("%.2f x FEM (%.0f ms), %.0f bonds", coupled / elements, 1e3 * elements, bonds));
      found(name + ": beyond 3 x FEM, per bond", text("%.2f us", each), "<= 2 us", each <= 2.);
    }


    /** A file of version 2.2; GridOut knows version 1 alone. */
    template <int dim>
    void write_gmsh(const dealii::Triangulation<dim> &mesh, const std::string &name)
    {
      // Gmsh goes around the quadrilaterals.
      constexpr unsigned int order[] = {0, 1, 3, 2, 4, 5, 7, 6};
      std::ofstream          file(name);
      file.precision(17);
      file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << mesh.n_vertices() << '\n';
      for (unsigned int i = 0; i < mesh.n_vertices(); ++i)
        file << i + 1 << ' ' << mesh.get_vertices()[i] << (dim == 2 ? " 0\n" : "\n");
      file << "$EndNodes\n$Elements\n" << mesh.n_active_cells() << '\n';
      for (const auto &cell : mesh.active_cell_iterators())
        {
          file << cell->active_cell_index() + 1 << (dim == 2 ? " 3" : " 5") << " 2 0 0";
          for (const unsigned int v : cell->vertex_indices())
            file << ' ' << cell->vertex_index(order[v]) + 1;
          file << '\n';
        }
      file << "$EndElements\n";
    }


    /** A distorted mesh of the unit square or cube in a file. */
    template <int dim>
    std::string distorted_mesh(const Body<dim> &body, const double part)
    {
      const std::string name = (std::filesystem::temp_directory_path() /
                                ("perideal_benchmark_" + std::to_string(getpid()) + ".msh"))
                                 .string();
      dealii::GridTools::distort_random(part, *body.mesh, true, 7);
      write_gmsh(*body.mesh, name);
      return name;
    }


    template <int dim>
    void compare_building_on_all(const unsigned int n_cells,
                                 const unsigned int n_distorted,
                                 const double       part)
    {
      const auto describe = [](const unsigned int n) {
        return "building, " + std::to_string(dim) + "D " + std::to_string(n) + "^" +
               std::to_string(dim) + ", m = 3, ";
      };
      const auto cells_of = [](const unsigned int n) {
        return "set Lower corner = " + list("0", dim) + "\nset Upper corner = " + list("1", dim) +
               "\nset Cells = " + list(std::to_string(n), dim) + "\n";
      };
      for (const std::string zone : {"cracks: 1", "everywhere", "1"})
        compare_building<dim>(describe(n_cells) + (zone == "1" ? "zone by formula, all" : zone),
                              cracked<dim>(cells_of(n_cells), "set Horizon ratio = 3\n", zone));
      const std::string file =
        distorted_mesh<dim>(Body<dim>(cracked<dim>(cells_of(n_distorted), "", "everywhere")), part);
      for (const std::string zone : {"cracks: 1", "everywhere"})
        compare_building<dim>(
          describe(n_distorted) + "distorted, " + zone,
          cracked<dim>("set Shape = mesh file\nset Mesh file = " + file + "\n",
                       "set Horizon = " + std::to_string(3. / n_distorted) + "\n",
                       zone));
      std::filesystem::remove(file);
    }


    struct MovingResult
    {
      double       moving = 0., stepping = 0.;
      unsigned int n_events = 0;
    };


    /**
     * Example 5 of Bobaru and Duangpanya 2012: two cracks that grow and cross, with a zone of one
     * horizon.
     */
    MovingResult grow(const unsigned int n_cells,
                      const std::string &step,
                      const double       end,
                      const bool         scaled,
                      const bool         with_steps)
    {
      Body<2> body(
        "set Dimension = 2\nset Models = coupled\n" +
        section("Domain",
                "set Lower corner = -1, -1\nset Upper corner = 1, 1\nset Cells = " +
                  list(std::to_string(n_cells), 2) + "\n") +
        section("Material", "set Conductivity = 1.14\n") +
        section("Boundary conditions", "set Dirichlet = top: 100; bottom: -100\n") +
        section(
          "Cracks",
          "set Segments = -0.5,0.5 ; -0.5,0.5 ; 0.5,0.5 ; 0.5,0.5\n"
          "set Growth = 2: 0, 0.1414213562373095,-0.1414213562373095 ; 4: 0, -0.1414213562373095,-0.1414213562373095\n" +
            (step.empty() ? "" : "set Growth step = " + step + "\n")) +
        section("Peridynamics",
                std::string("set Horizon ratio = 3\nset Surface correction = ") +
                  (scaled ? "crack scaling\n" : "none\n")) +
        section("Coupling", "set Zone = cracks: 1\n") + section("Time", "set End time = 7\n"));
      const auto     op = body.coupled();
      StepperOptions options;
      options.tolerance  = body.scene.time.tolerance;
      const auto stepper = make_stepper("auto", *op, options);
      Vector     u;
      op->initialize_vector(u);
      op->distribute(u, 0.);
      MovingResult result;
      for (double t = 0.; t < end;)
        {
          auto       start   = processor_seconds();
          const bool changed = op->update(t);
          // The first event makes the table in which later ones search.
          if (changed && result.n_events++ > 0)
            result.moving += processor_seconds() - start;
          if (changed)
            stepper->restart();
          const double to = std::min(end, op->next_event(t));
          start           = processor_seconds();
          if (with_steps)
            stepper->advance(u, t, to);
          result.stepping += processor_seconds() - start;
          t = to;
        }
      return result;
    }


    void measure_moving_zones()
    {
      for (const bool scaled : {false, true})
        {
          const MovingResult run   = grow(240, "", 7., scaled, true);
          const double       share = run.moving / (run.moving + run.stepping);
          found(std::string("Example 5, 240 x 240, m = 3") + (scaled ? ", crack scaling" : "") +
                  ": moving the zone",
                text("%.1f %% of %.1f s, %u events",
                     100. * share,
                     run.moving + run.stepping,
                     run.n_events),
                "<= 15 %",
                share <= 0.15);
        }
      // The zone is as many cells wide on any mesh: what an event touches grows with the step over
      // the spacing.
      for (const std::string step : {"0.01", ""})
        for (const unsigned int n : {120, 240, 480})
          {
            const MovingResult run = grow(n, step, 3., false, false);
            found("one event, " + std::to_string(n) + "^2, growth step " +
                    (step.empty() ? "a quarter of the spacing" : step),
                  text("%.2f ms", 1e3 * run.moving / (run.n_events - 1)));
          }
    }
  } // namespace


  void measure_coupling()
  {
    compare_building_on_all<2>(240, 240, 0.2);
    compare_building_on_all<3>(48, 24, 0.1); // distorted, bonds take much memory
    measure_moving_zones();
  }
} // namespace PeriDeal
