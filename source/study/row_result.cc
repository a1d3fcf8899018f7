// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "row_result.h"

#include <deal.II/base/mpi.h>

#include <perideal/base/memory.h>
#include <perideal/base/process_end.h>
#include <perideal/base/user_error.h>
#include <perideal/output/result_folder.h>
#include <perideal/scene/lists.h>
#include <perideal/study/model_choice.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <sstream>

namespace PeriDeal
{
  namespace
  {
    namespace fs = std::filesystem;
    using Json   = RowResult::Json;
    using Status = RowResult::Status;

    bool is_first(const MPI_Comm communicator)
    {
      return dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
    }


    /** A table of a run as a list of objects; coordinates become one list. */
    Json read_table(const fs::path &path)
    {
      std::istringstream       in(content_of(path));
      std::vector<std::string> header;
      Json                     rows = Json::array();
      for (std::string line; std::getline(in, line);)
        {
          const std::vector<std::string> cells = split_list(line, ',');
          if (header.empty())
            {
              header = cells;
              continue;
            }
          Json row;
          for (std::size_t k = 0; k < std::min(header.size(), cells.size()); ++k)
            if (header[k] == "model" || header[k] == "quantity")
              row[header[k]] = cells[k];
            else if (header[k] == "x" || header[k] == "y" || header[k] == "z")
              row["coordinates"].push_back(std::strtod(cells[k].c_str(), nullptr));
            else
              row[header[k]] = std::strtod(cells[k].c_str(), nullptr);
          rows.push_back(row);
        }
      return rows;
    }


    Json read_results(const fs::path &folder)
    {
      Json results      = Json::parse(content_of(folder / "summary.json"));
      results["totals"] = read_table(folder / "totals.csv");
      results["probes"] = read_table(folder / "probes.csv");
      return results;
    }


    void keep_smaller(Json &target, const std::string &key, const double value)
    {
      target[key] = target.contains(key) ? std::min(target[key].get<double>(), value) : value;
    }


    /** Sizes and the smallest times so far of each model. */
    void add_models(Json &record, const Json &summary)
    {
      for (const auto &item : summary["models"].items())
        {
          const Json &model = item.value();
          Json       &entry = record["models"][item.key()];
          for (const char *const key :
               {"unknowns", "bonds", "steps", "operator applications", "iterations", "memory"})
            if (model.contains(key))
              entry[key] = model[key];
          double set_up = 0., stepping = 0.;
          for (const auto &phase : model["wall time"].items())
            {
              const double seconds     = phase.value().get<double>();
              const bool   of_stepping = phase.key() == "time stepping" || phase.key() == "solve" ||
                                       phase.key() == "solving" || phase.key() == "changing cracks";
              (of_stepping ? stepping : set_up) += seconds;
              keep_smaller(entry["phases"], phase.key(), seconds);
            }
          keep_smaller(entry["times"], "set-up", set_up);
          keep_smaller(entry["times"], "stepping", stepping);
          keep_smaller(entry["times"], "total", set_up + stepping);
          record["peak memory"] =
            std::max(record.value("peak memory", 0.), model.value("peak memory", 0.));
        }
    }


    Json new_record(const CheckedRow  &checked,
                    const unsigned int repeats,
                    const MPI_Comm     communicator)
    {
      return {{"name", checked.row.name},
              {"scene", checked.row.scene},
              {"hash", checked.hash},
              {"program", std::string("PeriDeal ") + PERIDEAL_VERSION},
              {"processes", dealii::Utilities::MPI::n_mpi_processes(communicator)},
              {"repeats", repeats},
              {"status", "finished"},
              {"message", ""}};
    }


    std::string text_of(const Json &json)
    {
      return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    }


    /** One run; its times go into the record. */
    void compute_once(const CheckedRow &checked, Json &record, const MPI_Comm communicator)
    {
      const double begin = MPI_Wtime();
      with_memory_errors([&] {
        with_scene(checked.text, [&](const auto &scene) {
          run_scene(scene, checked.text, communicator, RunMode::overwrite, true);
        });
      });
      if (!is_first(communicator))
        return;
      keep_smaller(record, "wall time", MPI_Wtime() - begin);
      const std::string summary = content_of(fs::path(checked.folder) / "summary.json");
      add_models(record, Json::parse(summary));
      record["hash of summary.json"] = text_hash(summary);
    }


    /** On rank 0, or on a process that failed alone. */
    void write_record(const CheckedRow &checked, const RowResult &result)
    {
      fs::create_directories(checked.folder);
      write_file(checked.folder + "/row.json", text_of(result.record));
    }


    /** On rank 0; what is wrong becomes everybody's. */
    void on_first(const MPI_Comm communicator, const std::function<void()> &action)
    {
      std::string message;
      if (is_first(communicator))
        try
          {
            action();
          }
        catch (const UserError &error)
          {
            message = error.message();
          }
        catch (const fs::filesystem_error &error)
          {
            message = std::string("Cannot write there: ") + error.what();
          }
      throw_on_all_if_any(communicator, message);
    }


    /** On rank 0. Throws Json::exception where files are not what they should be. */
    RowResult read_folder(const CheckedRow &checked)
    {
      RowResult      result;
      const fs::path folder = checked.folder;
      const Json     record = Json::parse(content_of(folder / "row.json"));
      if (record.at("hash") != checked.hash)
        return result;
      if (record.at("status") == "failed")
        {
          result.status  = Status::failed;
          result.message = record.at("message").get<std::string>();
        }
      else if (record.at("hash of summary.json") == text_hash(content_of(folder / "summary.json")))
        {
          result.results = read_results(folder);
          result.status  = Status::finished;
        }
      result.record = record;
      return result;
    }


    void fail(RowResult &result, const std::string &message)
    {
      result.status            = Status::failed;
      result.message           = message;
      result.record["status"]  = "failed";
      result.record["message"] = message;
      result.record.erase("models");
    }
  } // namespace


  std::string RowResult::status_of(const StudyRow &row) const
  {
    if (status == Status::missing)
      return "";
    if (status == Status::failed)
      return row.fails ? "failed as expected" : "failed";
    return row.fails ? "did not fail" : "finished";
  }


  bool RowResult::is_wrong(const StudyRow &row) const
  {
    return status != Status::missing && (status == Status::failed) != row.fails &&
           !has_failed_as_it_may(row);
  }


  bool RowResult::has_failed_as_it_may(const StudyRow &row) const
  {
    return status == Status::failed && row.may_fail;
  }


  unsigned int repeats_of(const RowResult &result)
  {
    return result.status == Status::finished ? result.record.value("repeats", 0u) : 0u;
  }


  RowResult read_row(const CheckedRow &checked, const MPI_Comm communicator)
  {
    RowResult result;
    if (is_first(communicator) && !checked.hash.empty())
      try
        {
          result = read_folder(checked);
        }
      catch (const Json::exception &)
        {} // no row.json of ours: nothing is there
    result.status = static_cast<Status>(
      dealii::Utilities::MPI::broadcast(communicator, static_cast<int>(result.status), 0));
    result.message = dealii::Utilities::MPI::broadcast(communicator, result.message, 0);
    return result;
  }


  RowResult compute_row(const CheckedRow  &checked,
                        const unsigned int repeats,
                        const MPI_Comm     communicator)
  {
    RowResult result;
    result.record = new_record(checked, repeats, communicator);
    on_first(communicator, [&] {
      fs::remove(fs::path(checked.folder) / "row.json"); // until the row is finished again
      remove_results(checked.folder);
    });
    try
      {
        AssertThrow(checked.mistake.empty(), UserError(checked.mistake));
        forget_peak_memory();
        for (unsigned int k = 0; k < repeats; ++k)
          compute_once(checked, result.record, communicator);
        result.status = Status::finished;
      }
    catch (const UserError &error)
      {
        fail(result, error.message());
        if (!all_processes_arrive(communicator))
          {
            write_record(checked, result);
            AssertThrow(false,
                        UserError("row '" + checked.row.name +
                                  "' failed on one process alone: " + error.message()));
          }
      }
    catch (const std::exception &)
      {
        std::cerr << "\nperideal: in row '" << checked.row.name << "':" << std::endl;
        throw;
      }
    on_first(communicator, [&] {
      write_record(checked, result);
      if (result.status == Status::finished)
        result.results = read_results(checked.folder);
    });
    return result;
  }
} // namespace PeriDeal
