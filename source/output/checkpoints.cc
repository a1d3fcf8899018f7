// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/text_file.h>
#include <perideal/base/user_error.h>
#include <perideal/output/checkpoints.h>
#include <perideal/scene/scene_lines.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>

#include "checksum.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    namespace fs = std::filesystem;

    const std::string checkpoint_folder = "checkpoints/", checkpoint_ending = ".h5";


    std::string name_of_checkpoint(const unsigned int number)
    {
      return checkpoint_folder + std::to_string(number) + checkpoint_ending;
    }


    /** N of `N.h5`; 0 if it has another form. */
    unsigned int number_of_checkpoint(const fs::path &file)
    {
      constexpr std::size_t most_digits = 9;
      const std::string     digits      = file.stem().string();
      const bool            is_number   = !digits.empty() && digits.size() <= most_digits &&
                             std::all_of(digits.begin(), digits.end(), [](const unsigned char c) {
                               return std::isdigit(c);
                             });
      return is_number && file.extension() == checkpoint_ending ?
               static_cast<unsigned int>(std::stoul(digits)) :
               0;
    }


    /** Those in an output directory, whoever made them, sorted; perhaps unfinished ones too. */
    std::vector<unsigned int> numbers_in(const fs::path &directory, const bool with_unfinished)
    {
      std::vector<unsigned int> numbers;
      std::error_code           none;
      for (const auto &entry : fs::directory_iterator(directory / checkpoint_folder, none))
        {
          fs::path name = entry.path().filename();
          if (with_unfinished && name.extension() == ".part")
            name = name.stem();
          if (const unsigned int number = number_of_checkpoint(name); number > 0)
            numbers.push_back(number);
        }
      std::sort(numbers.begin(), numbers.end());
      return numbers;
    }


    bool may_differ(const std::string &entry)
    {
      for (const char *section : {"Output/", "Checkpoint/", "Guards/"})
        if (entry.compare(0, std::string(section).size(), section) == 0)
          return true;
      const std::vector<std::string> names = {"Title",
                                              "Output directory",
                                              "Time/End time",
                                              "Solver/Tolerance",
                                              "Solver/Maximum iterations"};
      return std::find(names.begin(), names.end(), entry) != names.end();
    }


    /** Blanks mean nothing in a value. */
    std::string without_blanks(const std::string &text)
    {
      std::string all;
      for (const char c : text)
        if (!std::isspace(static_cast<unsigned char>(c)))
          all += c;
      return all;
    }


    /** `'Cells' in section 'Domain'` of `Domain/Cells`. */
    std::string in_its_section(const std::string &entry)
    {
      const std::size_t slash = entry.rfind('/');
      return slash == std::string::npos ?
               "'" + entry + "' outside all sections" :
               "'" + entry.substr(slash + 1) + "' in section '" + entry.substr(0, slash) + "'";
    }


    std::string in_quotes(const SceneEntries::value_type *entry)
    {
      return entry == nullptr ? "missing" : "'" + entry->second + "'";
    }


    const SceneEntries::value_type *find_entry(const SceneEntries &entries, const std::string &name)
    {
      const auto found = std::find_if(entries.begin(), entries.end(), [&](const auto &entry) {
        return entry.first == name;
      });
      return found == entries.end() ? nullptr : &*found;
    }
  } // namespace


  Checkpoints::Checkpoints(ResultFolder      &folder,
                           const unsigned int n_kept,
                           const MPI_Comm     communicator)
    : folder(folder)
    , n_kept(n_kept)
    , communicator(communicator)
  {
    if (!folder.writes())
      return;
    std::error_code ignored;
    for (const unsigned int number : numbers_in(folder.directory(), true))
      if (folder.lists(name_of_checkpoint(number)))
        fs::remove(folder.directory() + "/" + name_of_checkpoint(number) + ".part", ignored);
  }


  std::vector<unsigned int> Checkpoints::numbers() const
  {
    std::vector<unsigned int> own;
    for (const unsigned int number : numbers_in(folder.directory(), false))
      if (folder.lists(name_of_checkpoint(number)))
        own.push_back(number);
    return own;
  }


  std::string Checkpoints::claim_next()
  {
    const std::vector<unsigned int> used = numbers_in(folder.directory(), true);
    const std::string               name = name_of_checkpoint(used.empty() ? 1 : used.back() + 1);
    std::error_code                 problem;
    fs::create_directories(folder.directory() + "/" + checkpoint_folder, problem);
    refusal    = problem ? problem.message() : "";
    int number = 0;
    if (!problem)
      folder.claim(name, number);
    if (number != 0)
      refusal = reason_of(number);
    return name;
  }


  std::string Checkpoints::write(const CheckpointHeader               &header,
                                 const std::function<void(Archive &)> &save)
  {
    const auto failure = [&](const std::string &name, const std::string &reason) {
      return "The checkpoint '" + folder.directory() + "/" + name +
             "' could not be written: " + reason +
             ". Is the disk full, or the directory closed to writing? Those before it are whole.";
    };
    std::string name;
    if (folder.writes())
      name = claim_next();
    share_text(name, communicator);
    share_text(refusal, communicator);
    if (!refusal.empty())
      return failure(name, refusal);
    CheckpointWriter writer(folder.directory() + "/" + name, header, communicator);
    save(writer);
    if (const int problem = writer.finish(); problem != 0)
      return failure(name, reason_of(problem));
    name_of_last = name;
    folder.commit();
    if (folder.writes())
      {
        std::vector<unsigned int> own = numbers();
        std::error_code           ignored;
        for (std::size_t k = 0; k + n_kept < own.size(); ++k)
          fs::remove(folder.directory() + "/" + name_of_checkpoint(own[k]), ignored);
      }
    return "";
  }


  void Checkpoints::remove_all()
  {
    if (!folder.writes())
      return;
    std::error_code ignored;
    for (const unsigned int number : numbers())
      fs::remove(folder.directory() + "/" + name_of_checkpoint(number), ignored);
    fs::remove(folder.directory() + "/" + checkpoint_folder, ignored); // unless others use it
  }


  std::string newest_checkpoint(const std::string        &directory,
                                const MPI_Comm            communicator,
                                std::vector<std::string> &notes)
  {
    std::string found, faults;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        std::vector<unsigned int> numbers = numbers_in(directory, false);
        while (!numbers.empty() && found.empty())
          {
            const std::string name  = directory + "/" + name_of_checkpoint(numbers.back());
            const std::string fault = fault_of_checkpoint(name);
            if (fault.empty())
              found = name;
            else
              faults += "'" + name + "' " + fault + "\n";
            numbers.pop_back();
          }
      }
    share_text(found, communicator);
    share_text(faults, communicator);
    std::string all;
    for (std::size_t begin = 0; begin < faults.size();)
      {
        const std::size_t end  = faults.find('\n', begin);
        const std::string line = faults.substr(begin, end - begin);
        if (!found.empty())
          notes.push_back("the checkpoint " + line + "; '" + found + "' is taken.");
        all += (all.empty() ? "" : ", and ") + line;
        begin = end + 1;
      }
    AssertThrow(
      !found.empty(),
      UserError(
        "There is nothing to resume in '" + directory + "': " +
        (all.empty() ?
           "it has no checkpoints (checkpoints/N.h5); a run that is complete has removed its own" :
           "the checkpoint " + all) +
        ". Leave out --resume to begin the run" +
        (all.empty() ? "" : ", with --overwrite to replace what lies there") +
        ", or check 'Output directory'."));
    return found;
  }


  std::string checksum_of_file(const std::string &file_name, const MPI_Comm communicator)
  {
    std::string sum;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        std::string       fault;
        const std::string bytes = read_file(file_name, most_bytes_of_data, fault);
        if (fault.empty())
          sum = std::to_string(checksum(bytes.data(), bytes.size()));
      }
    share_text(sum, communicator);
    return sum;
  }


  void require_same_run(const CheckpointHeader &saved,
                        const CheckpointHeader &now,
                        const std::string      &name)
  {
    const std::string remedy =
      " Take that of the checkpoint, or begin the run anew with --overwrite.";
    AssertThrow(saved.program == now.program,
                UserError("The checkpoint '" + name + "' is one of PeriDeal " + saved.program +
                          ", and this is PeriDeal " + now.program + "." + remedy));
    const SceneEntries then = entries_of(saved.scene), today = entries_of(now.scene);
    SceneEntries       all = today;
    all.insert(all.end(), then.begin(), then.end());
    for (const auto &[entry, value] : all)
      {
        const auto *const before = find_entry(then, entry), *const after = find_entry(today, entry);
        if (may_differ(entry) || (before != nullptr && after != nullptr &&
                                  without_blanks(before->second) == without_blanks(after->second)))
          continue;
        throw UserError(
          "Entry " + in_its_section(entry) + ": the checkpoint '" + name + "' has " +
          in_quotes(before) + ", and the scene has " + in_quotes(after) + "." + remedy +
          " Only 'Title', 'Output directory', 'End time' in section 'Time', 'Tolerance' and 'Maximum iterations' in section 'Solver', the sections "
          "'Output', 'Checkpoint' and 'Guards', and the number of processes may differ.");
      }
    for (const auto &[entry, sum] : now.files)
      {
        const auto before = saved.files.find(entry);
        AssertThrow(
          before != saved.files.end() && before->second == sum,
          UserError("Entry " + in_its_section(entry) +
                    ": the file that it names is not the one that the run of the checkpoint '" +
                    name + "' has read; it has changed since." + remedy));
      }
  }
} // namespace PeriDeal
