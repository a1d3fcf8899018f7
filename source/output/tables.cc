// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/output/tables.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>

namespace PeriDeal
{
  namespace
  {
    std::string point_header(const unsigned int dim, const std::vector<std::string> &columns)
    {
      std::string header =
        std::string("time,model,x") + (dim > 1 ? ",y" : "") + (dim > 2 ? ",z" : "");
      for (const std::string &column : columns)
        header += "," + column;
      return header;
    }
  } // namespace


  std::string full_precision(const double x)
  {
    if (std::isnan(x))
      return "nan"; // whatever its sign
    char text[40];
    std::snprintf(text, sizeof text, "%.15g", x);
    return text;
  }


  Table::Table(ResultFolder      &folder,
               const std::string &name,
               const std::string &header,
               const bool         goes_on)
    : folder(folder)
    , name(name)
  {
    if (!folder.writes())
      return;
    const std::string path = folder.claim(name);
    if (path.empty())
      return;
    file = open(path.c_str(), O_WRONLY | O_CLOEXEC | (goes_on ? 0 : O_CREAT | O_TRUNC), 0666);
    if (goes_on)
      return; // exchange() tells what is wrong
    if (file < 0)
      folder.keep_failure(name, errno);
    add(header + "\n");
  }


  Table::~Table()
  {
    if (file >= 0)
      close(file);
  }


  void Table::add(const std::string &rows)
  {
    if (file < 0 || folder.failed())
      return;
    const off_t end = lseek(file, 0, SEEK_END);
    for (std::size_t done = 0; done < rows.size();)
      {
        const ssize_t n = write(file, rows.data() + done, rows.size() - done);
        if (n > 0)
          {
            done += static_cast<std::size_t>(n);
            continue;
          }
        if (n < 0 && errno == EINTR)
          continue;
        folder.keep_failure(name, n == 0 ? ENOSPC : errno);
        // What did fit may end within a line.
        if (ftruncate(file, end) != 0)
          folder.keep_failure(name, errno);
        return;
      }
  }


  void Table::exchange(Archive &archive)
  {
    unsigned long long       length = 0;
    const unsigned long long found  = file < 0 ? 0 : lseek(file, 0, SEEK_END);
    if (!archive.loads())
      {
        if (file >= 0)
          fdatasync(file); // before the state that counts on it
        length = dealii::Utilities::MPI::broadcast(folder.processes(), found, 0);
      }
    archive.exchange("length", length);
    if (!archive.loads() || !folder.writes())
      return;
    const std::string path = "'" + folder.directory() + "/" + name + "'";
    if (file < 0)
      folder.keep_failure("The run cannot go on: its table " + path +
                          " is gone or cannot be written to. Bring it back, or begin the run "
                          "anew with --overwrite.");
    else if (found < length)
      folder.keep_failure("The run cannot go on: its table " + path + " has " +
                          std::to_string(found) + " bytes, and had " + std::to_string(length) +
                          " when the checkpoint was written: rows are missing. Bring them back, or "
                          "begin the run anew with --overwrite.");
    else if (ftruncate(file, static_cast<off_t>(length)) != 0)
      folder.keep_failure(name, errno);
  }


  PointTable::PointTable(ResultFolder                           &folder,
                         const std::string                      &name,
                         const std::vector<std::vector<double>> &points,
                         const unsigned int                      dim,
                         const std::vector<std::string>         &columns,
                         const bool                              goes_on)
    : points(points)
    , n_columns(columns.size())
    , table(folder, name, point_header(dim, columns), goes_on)
  {}


  void PointTable::add(const double               time,
                       const std::string         &model,
                       const std::vector<double> &values)
  {
    if (!table.writes())
      return;
    std::string rows;
    for (std::size_t k = 0; k < points.size(); ++k)
      {
        rows += full_precision(time) + "," + model;
        for (const double x : points[k])
          rows += "," + full_precision(x);
        for (std::size_t c = 0; c < n_columns; ++c)
          rows += "," + full_precision(values[k * n_columns + c]);
        rows += "\n";
      }
    table.add(rows);
  }


  void PointTable::exchange(Archive &archive)
  {
    table.exchange(archive);
  }
} // namespace PeriDeal
