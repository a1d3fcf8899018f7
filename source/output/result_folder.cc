// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/process_end.h>
#include <perideal/base/user_error.h>
#include <perideal/output/result_folder.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace PeriDeal
{
  namespace
  {
    bool same_file(const int open_file, const std::string &name)
    {
      struct stat here = {}, there = {};
      return fstat(open_file, &here) == 0 && stat(name.c_str(), &there) == 0 &&
             here.st_ino == there.st_ino && here.st_dev == there.st_dev;
    }


    std::string this_process()
    {
      char host[256] = "", when[64] = "";
      gethostname(host, sizeof host - 1);
      const std::time_t now = std::time(nullptr);
      std::strftime(when, sizeof when, "%Y-%m-%d %H:%M:%S", std::localtime(&now));
      return "process " + std::to_string(getpid()) + " on " + host + " since " + when;
    }
  } // namespace


  FolderLock::~FolderLock()
  {
    release();
  }


  FolderLock::Outcome FolderLock::take(const std::string &lock_file)
  {
    release();
    name = lock_file;
    for (;;)
      {
        file = open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (file < 0)
          {
            text = std::strerror(errno);
            return Outcome::impossible;
          }
        // (Where the file system knows no locks, the run goes on without.)
        if (flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
          {
            std::ifstream in(name);
            std::getline(in, text);
            close(file);
            file = -1;
            return Outcome::taken;
          }
        if (same_file(file, name)) // else the holder has let go and removed it in between
          break;
        close(file);
      }
    const std::string holder = this_process() + "\n";
    if (ftruncate(file, 0) != 0 ||
        write(file, holder.data(), holder.size()) != static_cast<ssize_t>(holder.size()))
      {
        text = std::strerror(errno);
        release();
        return Outcome::impossible;
      }
    return Outcome::held;
  }


  void FolderLock::release()
  {
    if (file < 0)
      return;
    unlink(name.c_str());
    close(file);
    file = -1;
  }


  namespace
  {
    namespace fs = std::filesystem;

    const char *const list_name = "files";
    const char *const list_head =
      "# What runs of PeriDeal have written into the folder above; the next run replaces these files and no others.\n";


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


    bool there_is(const fs::path &file)
    {
      return fs::exists(fs::symlink_status(file));
    }


    /** Whether a folder has one of these files. */
    bool has_checkpoint(const std::set<std::string> &names, const fs::path &folder)
    {
      const std::string begin = "checkpoints/";
      return std::any_of(names.begin(), names.end(), [&](const std::string &name) {
        return name.compare(0, begin.size(), begin) == 0 && there_is(folder / name);
      });
    }


    /** Also from one file system to another, since `fields` may be a link. */
    void move_file(const fs::path &from, const fs::path &to)
    {
      std::error_code problem;
      fs::create_directories(to.parent_path());
      fs::rename(from, to, problem);
      if (!problem)
        return;
      if (problem != std::errc::cross_device_link)
        throw fs::filesystem_error("move", from, problem);
      fs::copy_file(from, to, fs::copy_options::overwrite_existing);
      fs::remove(from);
    }


    /**
     * Move what there is of these files from one folder into another; of unfinished ones nothing is
     * kept.
     */
    void move_files(const std::set<std::string> &names, const fs::path &from, const fs::path &to)
    {
      for (const std::string &name : names)
        if (lies_within(name))
          {
            fs::remove(from / (name + ".part"));
            if (there_is(from / name))
              move_file(from / name, to / name);
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
                             const MPI_Comm                  communicator,
                             const RunMode                   mode)
    : path(directory)
    , own(directory + "/.perideal")
    , communicator(communicator)
    , first_rank(dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
  {
    std::string message;
    if (first_rank)
      try
        {
          message = take(scene_file, names, mode);
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
                                 const std::vector<std::string> &names,
                                 const RunMode                   mode)
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
          break;
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
    if (mode == RunMode::resume)
      {
        go_on_with(earlier);
        return "";
      }
    if (mode == RunMode::begin && is_resumable(earlier))
      return "a run lies in '" + path +
             "' that was stopped and can go on. Add --resume to go on with it, --overwrite to begin anew and "
             "replace its results, or choose another directory";
    set_aside(earlier);
    if (const int problem = replace_file(own + "/" + list_name, list_head); problem != 0)
      return "cannot use '" + path + "': " + reason_of(problem) +
             ". Choose a directory that you may write to";
    return "";
  }


  std::string ResultFolder::file_of_another_origin(const std::vector<std::string> &names,
                                                   const std::set<std::string>    &earlier) const
  {
    const std::string unfinished = ".part";
    const auto        is_foreign = [&](const std::string &name) {
      const std::size_t end = name.size() - std::min(name.size(), unfinished.size());
      const std::string whole =
        name.compare(end, unfinished.size(), unfinished) == 0 ? name.substr(0, end) : name;
      return earlier.count(whole) == 0 && there_is(path + "/" + name);
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
    const std::string previous = own + "/previous", mark = previous + "/" + list_name;
    aside = true;
    if (!fs::exists(mark))
      {
        // The list, moved last, marks that all is there: a run that is killed before is gone on
        // with by the next one.
        if (!earlier.empty())
          {
            move_files(earlier, path, previous);
            fs::rename(own + "/" + list_name, mark);
          }
        return;
      }
    // The run before had no results. Those of the one before it are kept, also where it was killed
    // while it put them back.
    const std::set<std::string> kept = read_list(mark);
    std::set<std::string>       back, useless;
    for (const std::string &name : earlier)
      (kept.count(name) > 0 && !there_is(previous + "/" + name) ? back : useless).insert(name);
    remove_files(useless, path);
    move_files(back, path, previous);
  }


  void ResultFolder::go_on_with(const std::set<std::string> &earlier)
  {
    const std::string previous = own + "/previous";
    if (fs::exists(previous)) // a run began anew and ended without results: back to those before it
      {
        if (fs::exists(previous + "/" + list_name))
          set_aside(earlier);
        put_back();
        aside = false;
      }
    listed = read_list(own + "/" + list_name);
  }


  void ResultFolder::put_back()
  {
    const std::string     previous = own + "/previous", mark = previous + "/" + list_name;
    const bool            complete = fs::exists(mark);
    std::set<std::string> names    = read_list(complete ? mark : own + "/" + list_name);
    remove_files(listed, path);
    if (!fs::exists(previous))
      {
        if (std::find(made.begin(), made.end(), own) != made.end())
          fs::remove(own + "/" + list_name);
        return;
      }
    std::string all = list_head;
    for (const std::string &name : names)
      all += name + "\n";
    replace_file(own + "/" + list_name, all);
    move_files(names, previous, path);
    fs::remove_all(previous);
  }


  void ResultFolder::restore()
  {
    if (committed)
      return lock.release();
    try // a folder that has gone or is closed to writing, or memory that is out, is told elsewhere
      {
        if (aside)
          put_back();
        lock.release();
        for (const std::string &folder : made) // those that are empty again
          if (fs::is_directory(fs::symlink_status(folder)))
            {
              std::error_code ignored;
              fs::remove(folder, ignored);
            }
      }
    catch (...)
      {}
    lock.release();
  }


  bool ResultFolder::has_earlier_results() const
  {
    std::error_code ignored;
    return !committed && fs::exists(own + "/previous/" + list_name, ignored);
  }


  bool ResultFolder::is_resumable(const std::set<std::string> &earlier) const
  {
    const std::string previous = own + "/previous", mark = previous + "/" + list_name;
    return has_checkpoint(earlier, path) || has_checkpoint(earlier, previous) ||
           has_checkpoint(read_list(mark), previous);
  }


  std::string ResultFolder::claim(const std::string &name, int &problem)
  {
    Assert(first_rank, dealii::ExcMessage("the other processes write nothing"));
    problem = 0;
    if (listed.count(name) == 0)
      {
        errno = 0;
        std::ofstream list(own + "/" + list_name, std::ios::app);
        list << name << "\n" << std::flush;
        if (!list)
          {
            problem = errno != 0 ? errno : -1;
            return "";
          }
        listed.insert(name);
      }
    return path + "/" + name;
  }


  std::string ResultFolder::claim(const std::string &name)
  {
    int               problem = 0;
    const std::string file    = claim(name, problem);
    if (problem != 0)
      keep_failure(name, problem);
    return file;
  }


  void ResultFolder::write(const std::string &name, const std::string &text)
  {
    if (!first_rank)
      return;
    const std::string file = claim(name);
    if (file.empty())
      return;
    std::error_code ignored; // what cannot be made shows in the next line
    if (name.find('/') != std::string::npos)
      fs::create_directory(fs::path(file).parent_path(), ignored);
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


  void ResultFolder::keep_failure(const std::string &message)
  {
    if (failure.empty())
      failure = message;
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
    if (!first_rank)
      return;
    std::error_code ignored; // the mark first: without it the rest means nothing
    fs::remove(own + "/previous/" + list_name, ignored);
    fs::remove_all(own + "/previous", ignored);
  }


  void remove_results(const std::string &directory)
  {
    const fs::path  list = fs::path(directory) / ".perideal" / list_name;
    std::error_code ignored;
    remove_files(read_list(list), directory);
    fs::remove(list, ignored);
    fs::remove_all(fs::path(directory) / ".perideal" / "previous", ignored);
  }


  std::string reason_of(const int number)
  {
    return number <= 0 ? "the system gives no reason" : std::strerror(number);
  }


  int replace_file(const std::string &name, const std::string &text)
  {
    const std::string part = name + ".part";
    set_unfinished_file(part);
    const int file    = open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    int       problem = file < 0 ? errno : 0;
    for (std::size_t done = 0; done < text.size() && problem == 0;)
      {
        const ssize_t n = write(file, text.data() + done, text.size() - done);
        if (n > 0)
          done += static_cast<std::size_t>(n);
        else if (n == 0 || errno != EINTR)
          problem = n == 0 ? ENOSPC : errno;
      }
    if (file >= 0 && close(file) != 0 && problem == 0) // where a quota or a network speaks up
      problem = errno;
    if (problem == 0 && rename(part.c_str(), name.c_str()) != 0)
      problem = errno;
    if (problem != 0 && file >= 0)
      unlink(part.c_str());
    set_unfinished_file("");
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
