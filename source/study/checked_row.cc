// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "checked_row.h"

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/scene/scene_lines.h>

#include <fstream>
#include <sstream>

namespace PeriDeal
{
  std::string content_of(const std::string &file_name)
  {
    std::ifstream      in(file_name, std::ios::binary);
    std::ostringstream all;
    if (in)
      all << in.rdbuf();
    return all.str();
  }


  namespace
  {
    /**
     * Of the program, the processes (times and memory depend on them), the scene, its entries and
     * its files. Collective.
     */
    std::string hash_of(const CheckedRow                                       &checked,
                        const std::vector<std::pair<std::string, std::string>> &files,
                        const MPI_Comm                                          communicator)
    {
      std::string hash;
      if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
        {
          const std::string no_place = "Output directory=.";
          std::string       all      = std::string("PeriDeal ") + PERIDEAL_VERSION + ", " +
                            std::to_string(dealii::Utilities::MPI::n_mpi_processes(communicator)) +
                            " processes\n" +
                            apply_overrides(checked.text.text, checked.text.file_name, {no_place});
          for (const auto &[entry, value] : checked.entries)
            if (entry != "Output directory")
              all += entry + "=" + value + "\n";
          for (const auto &entry_and_file : files)
            all += content_of(entry_and_file.second);
          hash = text_hash(all);
        }
      return dealii::Utilities::MPI::broadcast(communicator, hash, 0);
    }


    /** The entries of the scene that was parsed last. */
    std::map<std::string, std::string> entries_of_parsed_scene()
    {
      std::map<std::string, std::string> entries;
      for (const SceneLine &line : scan_lines(scene_with_defaults(), "the parsed scene").entries)
        entries[(line.section.empty() ? "" : line.section + "/") + line.entry] = line.value;
      return entries;
    }
  } // namespace


  std::string mistake_in_overrides(const UserError &error)
  {
    std::string       message      = error.message();
    const std::string command_line = "command line: "; // what overrides are called elsewhere
    if (message.compare(0, command_line.size(), command_line) == 0)
      message.erase(0, command_line.size());
    return message;
  }


  CheckedRow check_row(const Study       &study,
                       const StudyRow    &row,
                       const std::string &folder,
                       const MPI_Comm     communicator)
  {
    CheckedRow checked;
    checked.row    = row;
    checked.folder = folder;
    std::vector<std::string> overrides;
    for (const auto &[entry, value] : row.settings)
      overrides.push_back(entry + "=" + value);
    overrides.push_back("Output directory=" + folder);
    try
      {
        checked.text = read_scene(row.scene, overrides, communicator);
        std::vector<std::pair<std::string, std::string>> files;
        with_scene(checked.text, [&](const auto &scene) {
          files           = files_of(scene);
          checked.entries = entries_of_parsed_scene();
        });
        checked.hash = hash_of(checked, files, communicator);
      }
    catch (const UserError &error)
      {
        const std::string message = mistake_in_overrides(error);
        AssertThrow(row.fails,
                    UserError(study.source + ": row '" + row.name + "' (scene '" + row.scene +
                              "'): " + message));
        checked.mistake = message;
      }
    return checked;
  }
} // namespace PeriDeal
