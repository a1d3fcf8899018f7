// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/output/tables.h>

#include <stdio_ext.h>
#include <unistd.h>

#include <cerrno>

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
    char text[40];
    std::snprintf(text, sizeof text, "%.15g", x);
    return text;
  }


  Table::Table(ResultFolder &folder, const std::string &name, const std::string &header)
    : folder(folder)
    , name(name)
  {
    if (!folder.writes())
      return;
    file = std::fopen(folder.claim(name).c_str(), "w");
    if (file == nullptr)
      {
        folder.keep_failure(name, errno);
        return;
      }
    std::setvbuf(file, nullptr, _IOLBF, BUFSIZ);
    add(header + "\n");
  }


  Table::~Table()
  {
    if (file != nullptr)
      std::fclose(file);
  }


  void Table::add(const std::string &rows)
  {
    if (file == nullptr || folder.failed())
      return;
    const long end = std::ftell(file);
    if (std::fputs(rows.c_str(), file) >= 0 && std::fflush(file) == 0)
      return;
    folder.keep_failure(name, errno);
    // What did not fit may be half a line, and must not follow when the file is closed.
    __fpurge(file);
    if (ftruncate(fileno(file), end) != 0)
      folder.keep_failure(name, errno);
    std::fclose(file);
    file = nullptr;
  }


  PointTable::PointTable(ResultFolder                           &folder,
                         const std::string                      &name,
                         const std::vector<std::vector<double>> &points,
                         const unsigned int                      dim,
                         const std::vector<std::string>         &columns)
    : points(points)
    , n_columns(columns.size())
    , table(folder, name, point_header(dim, columns))
  {}


  void PointTable::add(const double               time,
                       const std::string         &model,
                       const std::vector<double> &values)
  {
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
} // namespace PeriDeal
