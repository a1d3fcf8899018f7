// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/output/result_folder.h>
#include <perideal/output/tables.h>
#include <perideal/study/work_precision.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "attempts.h"
#include "work_tables.h"

namespace PeriDeal
{
  namespace
  {
    using Role = WorkPlan::Role;

    template <int dim>
    void require_comparable(const Scene<dim> &scene)
    {
      const std::string who = "work_precision: ";
      AssertThrow(
        scene.domain.holes.listed.empty(),
        UserError(
          who +
          "'Holes' in section 'Domain' has to be empty: a body with holes changes with the lattice."));
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
    }


    template <int dim>
    Comparison comparison_of(const Scene<dim> &scene)
    {
      if (!scene.cracks.cracks.empty())
        return scene.deforms ? Comparison::solid_cracks : Comparison::cracks;
      return !scene.deforms                                     ? Comparison::field :
             scene.elasticity.solver == ElasticSolver::dynamics ? Comparison::motion :
                                                                  Comparison::solid;
    }


    template <int dim>
    WorkScene facts_of(const Scene<dim> &scene)
    {
      require_comparable(scene);
      WorkScene facts;
      facts.title         = scene.general.title;
      facts.box           = cracked_box(scene);
      facts.comparison    = comparison_of(scene);
      facts.exact         = !scene.reference.solution.empty();
      facts.moving_cracks = scene.cracks.change();
      facts.steady        = scene.time.steady;
      facts.given_zone    = scene.coupling.zone == ZoneKind::formula;
      if (facts.comparison == Comparison::motion)
        {
          const dealii::Point<dim> middle = 0.5 * (scene.domain.lower + scene.domain.upper);
          facts.wave_speed =
            std::sqrt(scene.material.moduli(middle).young() / scene.material.density.value(middle));
        }
      return facts;
    }


    /** What keeps `Models = auto` from choosing for a scene, or nothing. */
    std::string no_choice_for(const SceneText &text)
    {
      try
        {
          with_scene(text, [](const auto &scene) { require_choice(scene); });
        }
      catch (const UserError &error)
        {
          return mistake_in_overrides(error);
        }
      return "";
    }


    /**
     * Unknowns of multigrid's coarsest level: so few that iterations compare on coarse lattices,
     * too. On those that have no more it has another level.
     */
    constexpr unsigned int most_direct = 100, most_direct_of_few = 10;

    /** What is the same in all rows, stronger than the scene. */
    std::vector<Setting> settings_of_output()
    {
      return {{"Domain/Node spacing", ""},
              {"Coupling/Certificate", "false"},
              {"Output/Fields", "none"},
              {"Output/Write at", ""},
              {"Output/Write every", ""},
              {"Output/Probes", ""},
              {"Output/Line", ""}};
    }


    /** What is the same in all rows but those in which the program chooses. */
    std::vector<Setting> common_settings(const Comparison comparison)
    {
      std::vector<Setting> settings = settings_of_output();
      settings.insert(settings.end(),
                      {{"Domain/Nodes", "vertices"},
                       {"Peridynamics/Flux treatment", "natural"},
                       {"Solver/Direct solver up to", std::to_string(most_direct)}});
      if (comparison == Comparison::cracks || comparison == Comparison::solid_cracks)
        settings.insert(settings.end(),
                        {{"Cracks/Nodes on cracks", "left"}, // these very cells
                         {"Finite elements/Degree", "1"}});
      return settings;
    }


    /** The entries that no override may touch. */
    std::set<std::string> decided_entries(const Comparison comparison)
    {
      std::set<std::string> entries = {"Domain/Cells", "Output/Grid"};
      for (const Setting &setting : common_settings(comparison))
        entries.insert(setting.first);
      for (const WorkFamily &family : work_families())
        if (family.comparison == comparison)
          for (const Setting &setting : family.settings)
            entries.insert(setting.first);
      return entries;
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
          if (row.role != Role::method || faults.count(row.family) > 0)
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


    /** In which the program chooses the model and the mesh. */
    bool is_chosen(const WorkPlan::Row &row)
    {
      return row.role == Role::pick || row.role == Role::pick_values;
    }


    /** A step in which a wave passes so many cells. */
    std::string step_of(const WorkScene &scene, const WorkPlan::Row &row)
    {
      double spacing = std::numeric_limits<double>::infinity();
      for (unsigned int d = 0; d < scene.box.dim(); ++d)
        spacing = std::min(spacing, (scene.box.upper[d] - scene.box.lower[d]) / row.cells[d]);
      return full_precision(row.family->courant * spacing / scene.wave_speed);
    }


    /** Of this row alone, stronger than what all have. */
    std::vector<Setting> own_settings(const WorkScene     &scene,
                                      const WorkPlan      &plan,
                                      const WorkPlan::Row &row)
    {
      std::vector<Setting> settings = row.settings;
      if (row.role != Role::reference)
        settings.emplace_back("Output/Grid", row.role == Role::pick ? "" : to_text(row.cells));
      if (!is_chosen(row))
        {
          settings.emplace_back("Domain/Cells", to_text(row.cells));
          double n_nodes = 1.;
          for (const unsigned int n : row.cells)
            n_nodes *= n + 1.;
          if (n_nodes <= most_direct)
            settings.emplace_back("Solver/Direct solver up to", std::to_string(most_direct_of_few));
        }
      if (row.role == Role::reference)
        {
          std::string grid;
          for (const CellCounts &cells : lattices_of(plan))
            grid += (grid.empty() ? "" : " ; ") + to_text(cells);
          settings.emplace_back("Output/Grid", grid);
          settings.emplace_back("Time/Tolerance",
                                "1e-7"); // the error in time out of sight
        }
      if (!plan.probes.empty() && row.role != Role::pick)
        settings.emplace_back("Output/Probes", plan.probes);
      if (row.family != nullptr && row.family->courant > 0.)
        settings.emplace_back("Time/Time step", step_of(scene, row));
      return settings;
    }


    /** Each entry once: the new value in place of an older one. */
    std::vector<Setting> merged(std::vector<Setting> settings, const Setting &one)
    {
      const auto same = std::find_if(settings.begin(), settings.end(), [&](const Setting &other) {
        return other.first == one.first;
      });
      if (same == settings.end())
        settings.push_back(one);
      else
        same->second = one.second;
      return settings;
    }


    std::string sweep_of(const WorkPlan::Row &row)
    {
      switch (row.role)
        {
          case Role::reference:
            return "reference";
          case Role::pick:
          case Role::pick_values:
            return "auto";
          case Role::method:
            return row.family->name;
          default:
            return "in time";
        }
    }


    void add_to(Study &study, const WorkScene &scene, const WorkPlan &plan, const std::string &file)
    {
      for (const WorkPlan::Row &planned : plan.rows)
        {
          StudyRow row;
          row.name     = planned.name;
          row.scene    = file;
          row.sweep    = sweep_of(planned);
          row.group    = planned.role == Role::method ? planned.family->model : row.sweep;
          row.settings = is_chosen(planned) ? settings_of_output() :
                                              common_settings(scene.comparison);
          for (const Setting &own : own_settings(scene, plan, planned))
            row.settings = merged(std::move(row.settings), own);
          study.rows.push_back(row);
        }
      study.columns = {"Domain/Cells",
                       "Peridynamics/Horizon ratio",
                       "Peridynamics/Boundary treatment",
                       "Peridynamics/Surface correction"};
      if (!scene.box.cracks.empty())
        study.columns.insert(study.columns.end(), {"Cracks/Mesh", "Coupling/Zone"});
    }


    /**
     * What may turn out to be impossible only as it is computed, a choice of the program or a step
     * that is not stable, is left out then.
     */
    void leave_out_failures(WorkPlan &plan, ComputedStudy &computed)
    {
      for (std::size_t k = 0; k < plan.rows.size(); ++k)
        {
          const WorkPlan::Row &row       = plan.rows[k];
          const bool           uncertain = is_chosen(row) || row.role == Role::in_time ||
                                 (row.family != nullptr && row.family->courant > 0.);
          if (!uncertain || computed.results[k].status != RowResult::Status::failed)
            continue;
          computed.selected[k] = false;
          if (row.role != Role::pick_values)
            plan.left_out.push_back(row.name + ": " + computed.results[k].message);
        }
    }


    /** On rank 0; a user's error becomes everybody's. Returns the report. */
    std::string write_results(const Study         &study,
                              const WorkScene     &scene,
                              const WorkPlan      &plan,
                              const ComputedStudy &computed,
                              const MPI_Comm       communicator)
    {
      std::string message, report;
      if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
        try
          {
            const WorkResults results = evaluate_work(scene.box, plan, computed);
            write_file(study.output + "/work_precision.csv", work_csv(results));
            write_file(study.output + "/work_precision.json", work_json(study, plan, results));
            if (!results.in_time.empty())
              write_file(study.output + "/work_precision_in_time.csv", in_time_csv(results));
            report = work_report(plan, results);
          }
        catch (const UserError &error)
          {
            message = error.message();
          }
      throw_on_all_if_any(communicator, message);
      return report;
    }


    /** With settings that are stronger than those of the scene. */
    std::vector<std::string> with_settings(std::vector<std::string>    overrides,
                                           const std::vector<Setting> &settings)
    {
      for (const Setting &setting : settings)
        overrides.push_back(setting.first + "=" + setting.second);
      return overrides;
    }


    /** Of the scene, whichever models its rows have. Collective. */
    WorkScene read_work_scene(const std::string              &scene,
                              const std::vector<std::string> &overrides,
                              const MPI_Comm                  communicator)
    {
      WorkScene facts;
      with_scene(read_scene(scene, overrides, communicator),
                 [&](const auto &parsed) { facts = facts_of(parsed); });
      return facts;
    }


    std::string folder_of(const std::string &output, const WorkMeasure measure)
    {
      return output + "_work_precision" +
             (measure == WorkMeasure::opening          ? "_opening" :
              measure == WorkMeasure::stress_intensity ? "_intensity" :
                                                         "");
    }


    /** The rows of a plan in place of those that there were. */
    void set_rows(Study                          &study,
                  const WorkScene                &scene,
                  const WorkPlan                 &plan,
                  const std::string              &file,
                  const std::vector<std::string> &overrides)
    {
      study.rows.clear();
      add_to(study, scene, plan, file);
      override_rows(study, overrides);
      for (std::size_t k = 0; k < plan.rows.size(); ++k)
        if (plan.rows[k].role != Role::method) // a tolerance in time is that of the methods
          for (const Setting &own : own_settings(scene, plan, plan.rows[k]))
            study.rows[k].settings = merged(std::move(study.rows[k].settings), own);
    }
  } // namespace


  void run_work_precision(const WorkPrecisionOptions &options, const MPI_Comm communicator)
  {
    Study                    study = sweep_of_scenes({options.scene}, {}, communicator);
    const std::string        scene = study.rows.front().scene;
    std::vector<std::string> overrides =
      with_settings(options.overrides,
                    {{"Models", "finite elements"}, // those of the rows may be others
                     {"Peridynamics/Surface correction", "none"}});
    overrides       = with_settings(overrides, settings_of_output());
    WorkScene facts = read_work_scene(scene, overrides, communicator);
    study.varied    = decided_entries(facts.comparison);
    override_rows(study, options.overrides); // for its errors
    overrides = with_settings(overrides, common_settings(facts.comparison));
    if (options.picks)
      {
        const auto choosing =
          with_settings(options.overrides, {{"Models", "auto"}, {"Peridynamics/Horizon", ""}});
        facts.no_choice = no_choice_for(
          read_scene(scene, with_settings(choosing, settings_of_output()), communicator));
      }
    WorkPlan plan = plan_work(facts,
                              {options.cells,
                               options.reference,
                               options.budget,
                               options.picks,
                               parse_measure(options.measure)});
    leave_out_impossible(plan, scene, overrides, communicator);
    study.title  = facts.title + ": work and precision";
    study.output = options.output.empty() ? folder_of(study.output, plan.measure) : options.output;
    set_rows(study, facts, plan, scene, options.overrides);
    print_line(communicator,
               options.study.quiet,
               study.title + ": " + std::to_string(plan.rows.size()) + " rows, " +
                 std::to_string(plan.left_out.size()) + " left out");
    ComputedStudy computed = compute_study(study, options.study, communicator);
    leave_out_failures(plan, computed);
    const std::string report = write_results(study, facts, plan, computed, communicator);
    print_line(communicator, options.study.quiet, report);
    print_line(communicator, options.study.quiet, "Results: " + study.output);
    throw_if_wrong(study, computed);
  }
} // namespace PeriDeal
