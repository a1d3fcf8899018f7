// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/progress.h>
#include <perideal/base/text_file.h>

#include <filesystem>
#include <fstream>

namespace PeriDeal
{
  std::string places_looked_at(const std::string &file_name, const std::string &folder)
  {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path  here = fs::absolute(file_name, error).lexically_normal();
    std::string     text = ". Looked for it at '" + here.string() + "'";
    if (fs::path(file_name).is_absolute())
      return text + ".";
    const fs::path there = fs::absolute(fs::path(folder) / file_name, error).lexically_normal();
    if (there != here)
      text += " and, beside the scene file, at '" + there.string() + "'";
    return text +
           ". A path is relative to the working directory or to the folder of the scene file.";
  }


  std::string read_file(const std::string &file_name,
                        const std::size_t  most_bytes,
                        std::string       &fault)
  {
    namespace fs = std::filesystem;
    fault        = "cannot be read";
    std::error_code       error;
    const fs::file_status status = fs::status(file_name, error);
    if (fs::exists(status) && !fs::is_regular_file(status))
      {
        fault += fs::is_directory(status) ? ": it is a directory" :
                                            ": it is a device, a pipe or a socket, not a file";
        return "";
      }
    std::ifstream file(file_name, std::ios::binary);
    if (!file)
      return "";
    // Not the size that the system tells, which of files that are not on a disk (/proc) is 0.
    std::string bytes;
    char        buffer[1 << 16];
    do
      {
        file.read(buffer, sizeof buffer);
        bytes.append(buffer, static_cast<std::size_t>(file.gcount()));
      }
    while (file && bytes.size() <= most_bytes);
    if (bytes.size() > most_bytes)
      {
        fault += ": it has more than " + readable_bytes(static_cast<double>(most_bytes));
        return "";
      }
    if (!file.bad())
      fault.clear();
    return bytes;
  }


  void share_text(std::string &text, const MPI_Comm communicator)
  {
    unsigned long long size = text.size();
    MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, 0, communicator);
    text.resize(size);
    MPI_Bcast(&text[0], static_cast<int>(size), MPI_CHAR, 0, communicator);
  }
} // namespace PeriDeal
