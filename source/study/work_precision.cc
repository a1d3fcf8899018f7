// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/output/result_folder.h>
#include <perideal/problems/problem_factory.h>
#include <perideal/study/work_precision.h>

#include <algorithm>
#include <map>
#include <set>

#include "work_tables.h"

namespace PeriDeal
{
  namespace
  {
    /** What the study has to know of a scene. */
    struct SceneFacts
    {
      CrackedBox  box;
      bool        deforms = false, exact = false, moving_cracks = false;
      std::string title;
    };


    template <int dim>
    SceneFacts facts_of(const Scene<dim> &scene)
    {
      const std::string who = "work_precision: ";
      AssertThrow(dim > 1,
                  UserError(who + "'Dimension' is 1, where a crack has no ends; it needs 2 or 3."));
      AssertThrow(
        !scene.cracks.cracks.empty(),
        UserError(
          who +
          "the scene has no crack ('Segments' or 'Polygons' in section 'Cracks'), with which the "
          "methods that it compares have to deal."));
      AssertThrow(
        scene.domain.shape == Shape::box,
        UserError(
          who +
          "'Shape' in section 'Domain' has to be box: other bodies change with the lattice, or have none."));
      AssertThrow(
        !scene.cracks.conduct() || scene.cracks.contact_conductance >= 0.,
        UserError(
          who +
          "'Transmission' in section 'Cracks' is a share of bonds of one horizon, another crack on each "
          "lattice. Give 'Contact conductance' in its place."));
      AssertThrow(
        !scene.cracks.conduct() || !scene.reference.solution.empty(),
        UserError(
          who +
          "the cracks conduct ('Contact conductance' in section 'Cracks'), and cannot be cut into the mesh of the reference then. Give "
          "'Solution' in section 'Reference'."));
      SceneFacts facts;
      facts.title         = scene.general.title;
      facts.deforms       = problem_factory(scene).n_components() > 1;
      facts.exact         = !scene.reference.solution.empty();
      facts.moving_cracks = scene.cracks.change();
      facts.box           = cracked_box(scene);
      return facts;
    }


    /**
     * Unknowns of multigrid's coarsest level: so few that iterations compare on coarse lattices,
     * too. On those that have no more it has another level.
     */
    constexpr unsigned int most_direct = 100, most_direct_of_few = 10;


    /** What is the same in all rows, stronger than the scene. */
    std::vector<Setting> common_settings()
    {
      return {{"Domain/Node spacing", ""},
              {"Domain/Nodes", "vertices"},
              {"Cracks/Nodes on cracks", "left"}, // these very cells
              {"Peridynamics/Flux treatment", "natural"},
              {"Finite elements/Degree", "1"},
              {"Coupling/Certificate", "false"},
              {"Solver/Direct solver up to", std::to_string(most_direct)},
              {"Output/Fields", "none"},
              {"Output/Write at", ""},
              {"Output/Write every", ""},
              {"Output/Probes", ""},
              {"Output/Line", ""}};
    }


    /** The entries that no override may touch. */
    std::set<std::string> decided_entries()
    {
      std::set<std::string> entries = {"Domain/Cells", "Output/Grid"};
      for (const Setting &setting : common_settings())
        entries.insert(setting.first);
      for (const WorkFamily &family : work_families())
        for (const Setting &setting : family.settings)
          entries.insert(setting.first);
      return entries;
    }


    /**
     * Of the reference: as the finite elements it is compared with, but with the error in time out
     * of sight.
     */
    std::vector<Setting> reference_settings(const WorkPlan &plan)
    {
      std::string grid;
      for (const CellCounts &cells : lattices_of(plan))
        grid += (grid.empty() ? "" : " ; ") + to_text(cells);
      std::vector<Setting> settings = work_families().front().settings;
      settings.emplace_back("Time/Tolerance", "1e-7");
      settings.emplace_back("Output/Grid", grid);
      return settings;
    }


    /**
     * Take families out of the plan whose settings the scene cannot have, with what is wrong.
     * Collective.
     */
    void leave_out_impossible(WorkPlan                       &plan,
                              const std::string              &scene,
                              const std::vector<std::string> &overrides,
                              const MPI_Comm                  communicator)
    {
      std::map<const WorkFamily *, std::string> faults;
      for (const WorkPlan::Row &row : plan.rows)
        {
          if (row.family == nullptr || faults.count(row.family) > 0)
            continue;
          std::vector<std::string> all = overrides;
          all.push_back("Domain/Cells=" + to_text(row.cells));
          for (const auto &[entry, value] : row.family->settings)
            all.push_back(entry + "=" + value);
          std::string &fault = faults[row.family];
          try
            {
              with_scene(read_scene(scene, all, communicator), [](const auto &) {});
            }
          catch (const UserError &error)
            {
              fault = mistake_in_overrides(error);
            }
          if (!fault.empty())
            plan.left_out.push_back(row.family->name + ": " + fault);
        }
      const auto impossible = [&](const WorkPlan::Row &row) {
        return row.family != nullptr && !faults[row.family].empty();
      };
      plan.rows.erase(std::remove_if(plan.rows.begin(), plan.rows.end(), impossible),
                      plan.rows.end());
    }


    void add_to(Study &study, const WorkPlan &plan, const std::string &scene)
    {
      for (const WorkPlan::Row &planned : plan.rows)
        {
          StudyRow row;
          row.name     = planned.name;
          row.scene    = scene;
          row.sweep    = planned.family == nullptr ? "reference" : planned.family->name;
          row.group    = planned.family == nullptr ? "reference" : planned.family->model;
          row.settings = common_settings();
          row.settings.emplace_back("Domain/Cells", to_text(planned.cells));
          double n_nodes = 1.;
          for (const unsigned int n : planned.cells)
            n_nodes *= n + 1.;
          if (n_nodes <= most_direct)
            for (Setting &setting : row.settings)
              if (setting.first == "Solver/Direct solver up to")
                setting.second = std::to_string(most_direct_of_few);
          auto own = planned.family == nullptr ? reference_settings(plan) :
                                                 planned.family->settings;
          if (planned.family != nullptr)
            own.emplace_back("Output/Grid", to_text(planned.cells));
          row.settings.insert(row.settings.end(), own.begin(), own.end());
          study.rows.push_back(row);
        }
      study.columns = {"Domain/Cells",
                       "Cracks/Mesh",
                       "Peridynamics/Horizon ratio",
                       "Peridynamics/Boundary treatment",
                       "Peridynamics/Surface correction",
                       "Coupling/Zone"};
    }


    /** On rank 0; a user's error becomes everybody's. Returns the report. */
    std::string write_results(const Study         &study,
                              const CrackedBox    &box,
                              const WorkPlan      &plan,
                              const ComputedStudy &computed,
                              const MPI_Comm       communicator)
    {
      std::string message, report;
      if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
        try
          {
            const WorkResults results = evaluate_work(box, plan, computed);
            write_file(study.output + "/work_precision.csv", work_csv(results));
            write_file(study.output + "/work_precision.json", work_json(study, plan, results));
            report = work_report(plan, results);
          }
        catch (const UserError &error)
          {
            message = error.message();
          }
      throw_on_all_if_any(communicator, message);
      return report;
    }
  } // namespace


  void run_work_precision(const WorkPrecisionOptions &options, const MPI_Comm communicator)
  {
    Study             study = sweep_of_scenes({options.scene}, {}, communicator);
    const std::string scene = study.rows.front().scene;
    study.varied            = decided_entries();
    override_rows(study, options.overrides); // for its errors
    std::vector<std::string> overrides = options.overrides;
    for (const auto &[entry, value] : common_settings())
      overrides.push_back(entry + "=" + value);
    overrides.push_back("Models=finite elements"); // those of the rows may be others
    overrides.push_back("Peridynamics/Surface correction=none");
    SceneFacts facts;
    with_scene(read_scene(scene, overrides, communicator),
               [&](const auto &parsed) { facts = facts_of(parsed); });
    WorkPlan plan = plan_work(facts.box,
                              facts.deforms,
                              facts.exact,
                              facts.moving_cracks,
                              options.cells,
                              options.reference,
                              options.budget);
    leave_out_impossible(plan, scene, overrides, communicator);
    study.rows.clear();
    study.title  = facts.title + ": work and precision";
    study.output = options.output.empty() ? study.output + "_work_precision" : options.output;
    add_to(study, plan, scene);
    override_rows(study, options.overrides);
    print_line(communicator,
               options.study.quiet,
               study.title + ": " + std::to_string(plan.rows.size()) + " rows, " +
                 std::to_string(plan.left_out.size()) + " left out");
    const ComputedStudy computed = compute_study(study, options.study, communicator);
    const std::string   report   = write_results(study, facts.box, plan, computed, communicator);
    print_line(communicator, options.study.quiet, report);
    print_line(communicator, options.study.quiet, "Results: " + study.output);
    throw_if_wrong(study, computed);
  }
} // namespace PeriDeal
