// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/diverged.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/process_end.h>
#include <perideal/base/text_file.h>
#include <perideal/simulation/run_files.h>

#include <sstream>

#include "run_guards.h"
#include "summary_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    std::string copy_of_table(const FormulaTable &table)
    {
      return "tables/" + table.name + ".csv";
    }


    /** What a run of the scene writes under names that are known beforehand, and its report. */
    template <int dim>
    std::vector<std::string> names_of_results(const Scene<dim> &scene)
    {
      std::vector<std::string> names{"scene.prm", "summary.json", "report.html", "totals.csv"};
      const auto               add = [&](const bool is_written, const std::string &name) {
        if (is_written)
          names.push_back(name);
      };
      add(!scene.output.probes.empty(), "probes.csv");
      add(!scene.output.line.empty(), "line.csv");
      add(!scene.output.grid.empty(), "grid.csv");
      add(static_cast<bool>(scene.domain.image), "image_as_read.png");
      for (const FormulaTable &table : scene.formulas.names->tables)
        add(true, copy_of_table(table));
      for (const ModelKind model : scene.general.models)
        {
          const std::string series = series_of(scene.general.name_of(model));
          add(scene.output.vtu, series + ".pvd");
          add(scene.output.hdf5, series + ".xdmf");
          add(scene.output.vtu || scene.output.hdf5, "fields/" + series + "_*");
        }
      return names;
    }
  } // namespace


  namespace
  {
    /** Of all that the scene reads besides itself. Collective. */
    template <int dim>
    std::map<std::string, std::string> checksums_of_files(const Scene<dim> &scene,
                                                          const MPI_Comm    communicator)
    {
      std::map<std::string, std::string> sums;
      for (const auto &[entry, file_name] : files_of(scene))
        sums[entry] = checksum_of_file(file_name, communicator);
      return sums;
    }


    /** The newest checkpoint of a run of this scene. Throws UserError. Collective. */
    std::unique_ptr<CheckpointReader> open_checkpoint(const ResultFolder       &folder,
                                                      const CheckpointHeader   &header,
                                                      std::vector<std::string> &notes)
    {
      const std::string name   = newest_checkpoint(folder.directory(), folder.processes(), notes);
      auto              reader = std::make_unique<CheckpointReader>(name, folder.processes());
      require_same_run(reader->header(), header, name);
      return reader;
    }
  } // namespace


  template <int dim>
  RunFiles::RunFiles(const Scene<dim> &scene,
                     const SceneText  &text,
                     const MPI_Comm    communicator,
                     const RunMode     mode)
    : folder(scene.general.output_directory,
             text.file_name,
             names_of_results(scene),
             communicator,
             mode)
    , communicator(communicator)
    , header{PERIDEAL_VERSION,
             scene_with_defaults(),
             dim,
             Utilities::MPI::n_mpi_processes(communicator),
             0.,
             0.,
             checksums_of_files(scene, communicator)}
    , checkpoints(folder, scene.checkpoint.n_kept, communicator)
    , reader(mode == RunMode::resume ? open_checkpoint(folder, header, notes) : nullptr)
    , summary_file(folder, describe_start(scene, text, communicator), reader != nullptr)
    , totals(folder, "totals.csv", "time,model,quantity,value", reader != nullptr)
    , last_update(Clock::now())
  {
    folder.write("scene.prm", scene_with_defaults());
    write_image_as_read(scene, folder);
    for (const FormulaTable &table : scene.formulas.names->tables)
      if (folder.writes())
        {
          std::string       fault; // the file has been there before
          const std::string text = read_file(table.file, most_bytes_of_data, fault);
          if (fault.empty())
            folder.write(copy_of_table(table), text);
        }
    if (folder.writes())
      folder.claim("report.html"); // the scripts that draw it keep no list
    folder.check();
  }


  namespace
  {
    /** Rows of `time,model,quantity,value`, with quotation marks where a quantity has a comma, as
     * the name of a side may have. */
    std::string with_quotes(const std::string &rows)
    {
      std::istringstream lines(rows);
      std::string        text;
      for (std::string line; std::getline(lines, line); text += line + "\n")
        {
          const std::size_t from = line.find(',', line.find(',') + 1), to = line.rfind(',');
          if (from < to && line.find(',', from + 1) < to)
            line = line.substr(0, from + 1) + '"' + line.substr(from + 1, to - from - 1) + '"' +
                   line.substr(to);
        }
      return text;
    }
  } // namespace


  void RunFiles::add_totals(const std::string &rows)
  {
    totals.add(with_quotes(rows));
    folder.check();
    folder.commit();
    has_results = true;
  }


  void RunFiles::after_output(const std::function<Json()> &summary, const std::string &reached)
  {
    constexpr int many = 50; // times what it costs
    const auto    now  = Clock::now();
    const bool    due =
      Utilities::MPI::broadcast(communicator, now - last_update >= many * cost_of_update, 0);
    folder.check();
    if (!due)
      return;
    summary_file.update(summary(), reached);
    last_update    = Clock::now();
    cost_of_update = last_update - now;
    folder.check();
  }


  void RunFiles::complete(const Json &summary)
  {
    folder.check();
    summary_file.complete(summary);
    folder.check();
    checkpoints.remove_all();
  }


  void RunFiles::has_resumed()
  {
    reader.reset();
    has_results = true;
  }


  std::string RunFiles::write_checkpoint(const double                          time,
                                         const double                          wall_time,
                                         const std::function<void(Archive &)> &save)
  {
    header.time               = time;
    header.wall_time          = wall_time;
    const std::string problem = checkpoints.write(header, save);
    has_results               = has_results || problem.empty();
    if (problem.empty())
      summary_file.note_checkpoint(last_checkpoint());
    return problem;
  }


  std::string RunFiles::last_checkpoint() const
  {
    return checkpoints.last().empty() ? "" : folder.directory() + "/" + checkpoints.last();
  }


  void RunFiles::exchange(Archive &archive)
  {
    {
      const Archive::Part part(archive, "summary");
      summary_file.exchange(archive);
    }
    const Archive::Part part(archive, "totals.csv");
    totals.exchange(archive);
    folder.check();
  }


  bool RunFiles::end_early(const std::string &message, const bool diverged, const Json &more)
  {
    // A run that has diverged has that to tell, if nothing else; not one whose scene has been found
    // wrong while it was built, when there is no time yet.
    const bool has_begun = more.contains("guard") && more["guard"]["time"] >= 0.;
    if (!has_results && diverged && has_begun)
      {
        folder.commit();
        has_results = true;
      }
    if (has_results)
      summary_file.end(diverged && !folder.failed() ? "diverged" : "stopped", message, more);
    return has_results;
  }


  void with_orderly_end(RunFiles                    &files,
                        const Progress              &progress,
                        const std::function<void()> &action)
  {
    const auto end = [&](const std::string    &message,
                         const bool            diverged,
                         const RunFiles::Json &more = RunFiles::Json::object()) {
      progress.end();
      if (!files.end_early(message, diverged, more))
        return;
      progress.line("Results until then: " + files.folder.directory());
      if (const std::string last = files.last_checkpoint(); diverged && !last.empty())
        progress.line("The last checkpoint before: " + last);
    };
    try
      {
        action();
      }
    catch (const Diverged &error)
      {
        end(error.message(), true, {{"guard", describe_trip(error.trip, files.last_checkpoint())}});
        throw;
      }
    catch (const UserError &error)
      {
        end(error.message(), true);
        throw;
      }
    catch (const Stopped &stopped)
      {
        end(stopped.what(), false);
        throw;
      }
    catch (...)
      {
        end("out of memory, or a fault of the program", false);
        throw;
      }
  }


#define PERIDEAL_TEMPLATES(dim) \
  template RunFiles::RunFiles(const Scene<dim> &, const SceneText &, const MPI_Comm, const RunMode);
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
