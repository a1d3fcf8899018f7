// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/process_end.h>
#include <perideal/base/user_error.h>
#include <perideal/output/result_folder.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace PeriDeal
{
  namespace
  {
    namespace fs = std::filesystem;

    const char *const list_name = "files";
    const char *const list_head =
      "# What runs of PeriDeal have written into the folder above; the next run replaces these files and no others.\n";


    std::string reason_of(const int number)
    {
      return number == 0 ? "the system gives no reason" : std::strerror(number);
    }


    std::set<std::string> read_list(const fs::path &file)
    {
      std::set<std::string> names;
      std::ifstream         in(file);
      for (std::string line; std::getline(in, line);)
        if (!line.empty() && line[0] != '#')
          names.insert(line);
      return names;
    }


    /** A list that somebody has edited must not lead out of the folder. */
    bool lies_within(const std::string &name)
    {
      const fs::path path = fs::path(name).lexically_normal();
      return !path.empty() && path.is_relative() && *path.begin() != "..";
    }


    /** Move what there is of these files from one folder into another. */
    void move_files(const std::set<std::string> &names, const fs::path &from, const fs::path &to)
    {
      for (const std::string &name : names)
        if (lies_within(name) && fs::exists(fs::symlink_status(from / name)))
          {
            fs::create_directories((to / name).parent_path());
            fs::rename(from / name, to / name);
          }
    }


    void remove_files(const std::set<std::string> &names, const fs::path &folder)
    {
      std::error_code ignored;
      for (const std::string &name : names)
        if (lies_within(name) && !fs::is_directory(fs::symlink_status(folder / name, ignored)))
          {
            fs::remove(folder / name, ignored);
            fs::remove(folder / (name + ".part"), ignored);
          }
    }
  } // namespace


  ResultFolder::ResultFolder(const std::string              &directory,
                             const std::string              &scene_file,
                             const std::vector<std::string> &names,
                             const MPI_Comm                  communicator)
    : path(directory)
    , own(directory + "/.perideal")
    , communicator(communicator)
    , first_rank(dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
  {
    std::string message;
    if (first_rank)
      try
        {
          message = take(scene_file, names);
        }
      catch (const fs::filesystem_error &error)
        {
          message = "cannot use '" + path + "': " + error.code().message() +
                    ". Choose a directory that you may write to";
        }
    if (!message.empty())
      message = "'Output directory' (outside all sections): " + message + ".";
    try
      {
        throw_on_all_if_any(communicator, message);
      }
    catch (const UserError &) // without an object there is no destructor
      {
        if (first_rank)
          restore();
        throw;
      }
  }


  ResultFolder::~ResultFolder()
  {
    set_unfinished_file("");
    if (first_rank)
      restore();
  }


  std::string ResultFolder::take(const std::string              &scene_file,
                                 const std::vector<std::string> &names)
  {
    for (fs::path folder = own; !folder.empty() && !fs::exists(folder);
         folder          = folder.parent_path())
      made.push_back(folder);
    if (!fs::exists(path + "/fields"))
      made.insert(made.begin(), path + "/fields");
    fs::create_directories(own);
    fs::create_directories(path + "/fields");
    switch (lock.take(own + "/lock"))
      {
        case FolderLock::Outcome::taken:
          made.clear(); // the other run uses them
          return "another run writes into '" + path + "' (" + lock.explanation() +
                 "). Wait until it ends, or choose another directory";
        case FolderLock::Outcome::impossible:
          return "cannot use '" + path + "': " + lock.explanation() +
                 ". Choose a directory that you may write to";
        default:
          holds = true;
      }
    std::error_code no_such_file;
    if (fs::equivalent(path + "/scene.prm", scene_file, no_such_file))
      return "cannot use '" + path +
             "': the scene file itself, which lies there, would be written over. Choose another "
             "directory, or copy the scene elsewhere";
    const std::set<std::string> earlier = read_list(own + "/" + list_name);
    if (const std::string other = file_of_another_origin(names, earlier); !other.empty())
      return "cannot use '" + path + "': '" + other +
             "' lies there, which no run has listed as its own and which would be written over. "
             "Choose another directory, or move it away";
    set_aside(earlier);
    if (const int problem = replace_file(own + "/" + list_name, list_head); problem != 0)
      return "cannot use '" + path + "': " + reason_of(problem) +
             ". Choose a directory that you may write to";
    return "";
  }


  std::string ResultFolder::file_of_another_origin(const std::vector<std::string> &names,
                                                   const std::set<std::string>    &earlier) const
  {
    const auto is_foreign = [&](const std::string &name) {
      return earlier.count(name) == 0 && fs::exists(fs::symlink_status(path + "/" + name));
    };
    for (const std::string &name : names)
      if (name.back() != '*')
        {
          if (is_foreign(name))
            return name;
        }
      else
        {
          const std::string begin  = name.substr(0, name.size() - 1);
          const fs::path    folder = fs::path(begin).parent_path();
          for (const auto &entry : fs::directory_iterator(fs::path(path) / folder))
            if (const std::string found = (folder / entry.path().filename()).string();
                found.compare(0, begin.size(), begin) == 0 && is_foreign(found))
              return found;
        }
    return "";
  }


  void ResultFolder::set_aside(const std::set<std::string> &earlier)
  {
    const std::string previous = own + "/previous";
    // A run that ended before it had results has left those of the run before it in place.
    if (fs::exists(previous + "/" + list_name))
      remove_files(earlier, path);
    else if (!earlier.empty())
      {
        fs::create_directories(previous);
        fs::copy_file(own + "/" + list_name,
                      previous + "/" + list_name,
                      fs::copy_options::overwrite_existing);
        move_files(earlier, path, previous);
      }
  }


  void ResultFolder::restore()
  {
    if (committed)
      return lock.release();
    std::error_code ignored;
    if (holds)
      try
        {
          const std::string previous = own + "/previous";
          remove_files(listed, path);
          if (fs::exists(previous + "/" + list_name))
            {
              move_files(read_list(previous + "/" + list_name), previous, path);
              fs::rename(previous + "/" + list_name, own + "/" + list_name);
              fs::remove_all(previous);
            }
          else if (!made.empty())
            fs::remove(own + "/" + list_name);
        }
      catch (const fs::filesystem_error &)
        {} // the folder has gone, or may not be written to any more: the run says so itself
    lock.release();
    for (const std::string &folder : made) // those that are empty again
      fs::remove(folder, ignored);
  }


  std::string ResultFolder::claim(const std::string &name)
  {
    Assert(first_rank, dealii::ExcMessage("the other processes write nothing"));
    if (listed.insert(name).second)
      {
        std::ofstream list(own + "/" + list_name, std::ios::app);
        list << name << "\n" << std::flush;
        if (!list)
          keep_failure(name, errno);
      }
    return path + "/" + name;
  }


  void ResultFolder::write(const std::string &name, const std::string &text)
  {
    if (!first_rank)
      return;
    const std::string file = claim(name);
    if (const int problem = replace_file(file, text); problem != 0)
      keep_failure(name, problem);
  }


  void ResultFolder::keep_failure(const std::string &name, const int reason)
  {
    if (failure.empty())
      failure =
        "'Output directory' (outside all sections): cannot write '" + path + "/" + name +
        "': " + reason_of(reason) +
        ". Is the disk full, or was the directory removed or closed to writing during the run? "
        "Files that were finished before are whole.";
  }


  void ResultFolder::check() const
  {
    throw_on_all_if_any(communicator, failure);
  }


  void ResultFolder::commit()
  {
    if (committed)
      return;
    committed = true;
    std::error_code ignored;
    if (first_rank)
      fs::remove_all(own + "/previous", ignored);
  }


  int replace_file(const std::string &name, const std::string &text)
  {
    const std::string part = name + ".part";
    const int         file = open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0)
      return errno;
    int problem = 0;
    for (std::size_t done = 0; done < text.size() && problem == 0;)
      {
        const ssize_t n = write(file, text.data() + done, text.size() - done);
        if (n > 0)
          done += static_cast<std::size_t>(n);
        else if (n == 0 || errno != EINTR)
          problem = n == 0 ? ENOSPC : errno;
      }
    if (close(file) != 0 && problem == 0) // where a quota or a network speaks up
      problem = errno;
    if (problem == 0 && rename(part.c_str(), name.c_str()) != 0)
      problem = errno;
    if (problem != 0)
      unlink(part.c_str());
    return problem;
  }


  void write_file(const std::string &name, const std::string &text)
  {
    const int problem = replace_file(name, text);
    AssertThrow(problem == 0,
                UserError("cannot write '" + name + "': " + reason_of(problem) +
                          ". Is the disk full, or was the directory removed during the run?"));
  }
} // namespace PeriDeal
