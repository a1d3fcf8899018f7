// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/progress.h>
#include <perideal/base/user_error.h>
#include <perideal/output/result_folder.h>
#include <perideal/scene/lists.h>
#include <perideal/study/study.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "row_result.h"
#include "study_tables.h"

namespace PeriDeal
{
  namespace
  {
    namespace fs = std::filesystem;

    bool names_row(const std::string &name, const StudyRow &row)
    {
      return name == row.name || name == row.sweep || (name == row.group && !name.empty());
    }


    /** Which rows the options ask for. */
    std::vector<bool> selected_rows(const Study &study, const StudyOptions &options)
    {
      std::vector<bool>        selected;
      std::vector<std::string> known;
      for (const StudyRow &row : study.rows)
        {
          const bool named =
            options.only.empty() ||
            std::any_of(options.only.begin(), options.only.end(), [&](const std::string &name) {
              return names_row(name, row);
            });
          selected.push_back(named && (!options.quick || row.quick));
          for (const std::string &name : {row.name, row.sweep, row.group})
            if (!name.empty() && std::find(known.begin(), known.end(), name) == known.end())
              known.push_back(name);
        }
      for (const std::string &name : options.only)
        AssertThrow(std::find(known.begin(), known.end(), name) != known.end(),
                    UserError(study.source + ": --only names '" + name +
                              "', but no row and no group has that name." +
                              did_you_mean(name, known)));
      AssertThrow(std::find(selected.begin(), selected.end(), true) != selected.end(),
                  UserError(study.source + ": no row " +
                            (options.only.empty() ? "" : "of those that --only names ") +
                            R"(has "quick": true, which --quick asks for.)"));
      return selected;
    }


    /** Lines on rank 0: what is computed at present stands there before it is done. */
    class Log
    {
    public:
      Log(const MPI_Comm communicator, const bool quiet)
        : active(dealii::Utilities::MPI::this_mpi_process(communicator) == 0 && !quiet)
      {}

      void print(const std::string &text) const
      {
        if (active)
          std::cout << text << std::flush;
      }

    private:
      bool active;
    };


    /** Make the directory, or say on all processes why that is not possible. Collective. */
    void make_directory(const Study &study, const MPI_Comm communicator)
    {
      std::string message;
      if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
        try
          {
            fs::create_directories(fs::path(study.output) / "rows");
            write_file(study.output + "/.perideal_trial", "x");
            fs::remove(fs::path(study.output) / ".perideal_trial");
          }
        catch (const fs::filesystem_error &error)
          {
            message = error.code().message();
          }
        catch (const UserError &)
          {
            message = "it cannot be written to";
          }
      if (!message.empty())
        message = study.source + ": \"output\" (or --output): cannot use '" + study.output +
                  "': " + message + ". Choose a directory that you may write to.";
      throw_on_all_if_any(communicator, message);
    }


    /** Collective. */
    void write_tables(const Study                   &study,
                      const std::vector<CheckedRow> &rows,
                      const std::vector<RowResult>  &results,
                      const MPI_Comm                 communicator)
    {
      std::string message;
      if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
        try
          {
            write_file(study.output + "/study.csv", study_csv(study, rows, results));
            write_file(study.output + "/study.json", study_json(study, rows, results));
          }
        catch (const UserError &error)
          {
            message = error.message();
          }
      throw_on_all_if_any(communicator, message);
    }


    std::string outcome(const RowResult &result, const StudyRow &row)
    {
      const std::string status = result.status_of(row);
      return result.message.empty() ? status : status + ": " + result.message;
    }


    /** All rows of a study, which of them were asked for, and what has become of each. */
    struct ComputedStudy
    {
      std::vector<CheckedRow> rows;
      std::vector<bool>       selected;
      std::vector<RowResult>  results;
    };


    /** Throws the UserError that lists the rows that did not end as they should. */
    void throw_if_wrong(const Study &study, const ComputedStudy &computed)
    {
      std::string  list;
      unsigned int n_wrong = 0, n_rows = 0;
      for (std::size_t k = 0; k < computed.results.size(); ++k)
        {
          if (!computed.selected[k] || computed.results[k].has_failed_as_it_may(study.rows[k]))
            continue;
          ++n_rows;
          if (!computed.results[k].is_wrong(study.rows[k]))
            continue;
          ++n_wrong;
          list += "\n  " + study.rows[k].name + ": " + outcome(computed.results[k], study.rows[k]);
        }
      AssertThrow(n_wrong == 0,
                  UserError(study.source + ": " + std::to_string(n_wrong) + " of " +
                            std::to_string(n_rows) + " rows did not end as they should:" + list));
    }


    /** Compute the rows that are asked for, and write the tables. Collective. */
    ComputedStudy compute_study(const Study        &study,
                                const StudyOptions &options,
                                const MPI_Comm      communicator)
    {
      ComputedStudy            computed;
      std::vector<std::string> names;
      for (const StudyRow &row : study.rows)
        names.push_back(row.name);
      const std::vector<std::string> folders = folder_names(names);
      AssertThrow(study.output.find_first_of("#\n\r\\") == std::string::npos,
                  UserError(study.source + ": \"output\" (or --output): '" + study.output +
                            "' must not contain #, \\ or line ends."));
      const std::vector<bool> &selected = computed.selected = selected_rows(study, options);
      std::vector<CheckedRow> &rows                         = computed.rows;
      std::vector<RowResult>  &results                      = computed.results;
      for (std::size_t k = 0; k < study.rows.size(); ++k)
        rows.push_back(
          check_row(study, study.rows[k], study.output + "/rows/" + folders[k], communicator));
      make_directory(study, communicator);
      for (const CheckedRow &row : rows)
        results.push_back(read_row(row, communicator));

      const Log   log(communicator, options.quiet);
      const auto  n_rows = std::count(selected.begin(), selected.end(), true);
      std::size_t number = 0;
      for (std::size_t k = 0; k < rows.size(); ++k)
        {
          if (!selected[k])
            continue;
          log.print("[" + std::to_string(++number) + "/" + std::to_string(n_rows) + "] " +
                    rows[k].row.name + ": ");
          const bool enough =
            dealii::Utilities::MPI::broadcast(communicator, repeats_of(results[k]), 0) >=
            options.repeats;
          if (results[k].status == RowResult::Status::finished && enough && !options.redo)
            {
              log.print("kept\n");
              continue;
            }
          results[k] = compute_row(rows[k], options.repeats, communicator);
          write_tables(study, rows, results, communicator);
          log.print(results[k].status == RowResult::Status::failed ?
                      outcome(results[k], rows[k].row) + "\n" :
                      readable_duration(results[k].record.value("wall time", 0.)) + "\n");
        }
      write_tables(study, rows, results, communicator);
      return computed;
    }
  } // namespace


  void run_study(const Study &study, const StudyOptions &options, const MPI_Comm communicator)
  {
    const ComputedStudy computed = compute_study(study, options, communicator);
    Log(communicator, options.quiet).print("Results: " + study.output + "\n");
    throw_if_wrong(study, computed);
  }
} // namespace PeriDeal
