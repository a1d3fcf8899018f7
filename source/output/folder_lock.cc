// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/output/folder_lock.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <fstream>

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
} // namespace PeriDeal
