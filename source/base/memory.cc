// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/memory.h>

#include <malloc.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>
#include <vector>

namespace PeriDeal
{
  namespace
  {
    constexpr double unlimited = std::numeric_limits<double>::infinity();


    /**
     * The number behind a key in a file of lines "key number", or the first one where the key is
     * empty.
     */
    double number_in(const std::string &file_name, const std::string &key, const double otherwise)
    {
      std::ifstream file(file_name);
      for (std::string line; std::getline(file, line);)
        {
          std::istringstream words(line);
          std::string        first;
          double             value = 0.;
          if (!key.empty() && (!(words >> first) || first != key))
            continue;
          return words >> value ? value : otherwise;
        }
      return otherwise;
    }


    /**
     * What a group may take beyond what it has; the system gives files' pages that it keeps back
     * when they are needed.
     */
    double room_of_group(const std::string &folder)
    {
      const double limit = number_in(folder + "/memory.max", "", unlimited); // "max" is no number
      const double taken = number_in(folder + "/memory.current", "", 0.) -
                           number_in(folder + "/memory.stat", "inactive_file", 0.);
      return std::max(0., limit - taken);
    }


    /** The folders of the groups of this process, from the inmost one on. */
    std::vector<std::string> groups(const std::string &root)
    {
      std::vector<std::string> folders;
      std::ifstream            file(root + "/proc/self/cgroup");
      for (std::string line; std::getline(file, line);)
        if (line.compare(0, 3, "0::") == 0)
          for (std::string path = line.substr(3); path.size() > 1;
               path             = path.substr(0, path.rfind('/')))
            folders.push_back(root + "/sys/fs/cgroup" + path);
      folders.push_back(root + "/sys/fs/cgroup");
      return folders;
    }


    /** In bytes; the system tells kB. */
    double of_this_process(const std::string &key)
    {
      return 1024. * number_in("/proc/self/status", key, 0.);
    }
  } // namespace


  double available_memory(const std::string &root)
  {
    double room = 1024. * number_in(root + "/proc/meminfo", "MemAvailable:", unlimited);
    for (const std::string &group : groups(root))
      room = std::min(room, room_of_group(group));
    // version 1 of the groups, whose limit is a huge number where there is none
    const std::string old = root + "/sys/fs/cgroup/memory";
    return std::min(room,
                    std::max(0.,
                             number_in(old + "/memory.limit_in_bytes", "", unlimited) -
                               number_in(old + "/memory.usage_in_bytes", "", 0.) +
                               number_in(old + "/memory.stat", "total_inactive_file", 0.)));
  }


  double available_memory(const MPI_Comm communicator)
  {
    MPI_Comm machine;
    MPI_Comm_split_type(communicator, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    double share = available_memory() / dealii::Utilities::MPI::n_mpi_processes(machine);
    MPI_Comm_free(&machine);
    rlimit own{};
    if (getrlimit(RLIMIT_AS, &own) == 0 && own.rlim_cur != RLIM_INFINITY)
      share =
        std::min(share,
                 std::max(0., static_cast<double>(own.rlim_cur) - of_this_process("VmSize:")));
    return dealii::Utilities::MPI::min(share, communicator) *
           dealii::Utilities::MPI::n_mpi_processes(communicator);
  }


  double resident_memory()
  {
    return of_this_process("VmRSS:");
  }


  double peak_memory()
  {
    return of_this_process("VmHWM:");
  }


  bool forget_peak_memory()
  {
    malloc_trim(0);
    std::ofstream file("/proc/self/clear_refs");
    file << "5" << std::flush; // 5: the peak alone
    return static_cast<bool>(file);
  }
} // namespace PeriDeal
