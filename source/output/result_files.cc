// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/output/result_files.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace PeriDeal
{
  namespace
  {
    namespace fs = std::filesystem;

    bool begins_with(const std::string &text, const std::string &begin)
    {
      return text.compare(0, begin.size(), begin) == 0;
    }


    /** Files that a run writes, in its directory or in the folder of fields. Nothing else is ever removed. */
    bool is_result(const fs::path &path, const bool field)
    {
      static const std::vector<std::string> names  = {"summary.json",
                                                      "report.html",
                                                      "probes.csv",
                                                      "line.csv",
                                                      "grid.csv",
                                                      "totals.csv",
                                                      "image_as_read.png",
                                                      "scene.prm"};
      const std::string                     name   = path.filename().string();
      const bool                            series = begins_with(name, "finite_elements") ||
                          begins_with(name, "peridynamics") || begins_with(name, "coupled");
      const std::string kind = path.extension().string();
      if (field)
        return series && (kind == ".vtu" || kind == ".pvtu" || kind == ".h5");
      return std::find(names.begin(), names.end(), name) != names.end() ||
             (series && (kind == ".pvd" || kind == ".xdmf"));
    }


    void remove_results(const fs::path &directory, const bool field)
    {
      if (fs::exists(directory))
        for (const auto &entry : fs::directory_iterator(directory))
          if (is_result(entry.path(), field))
            fs::remove(entry.path());
    }


    /** An empty text, or what is wrong with the directory. */
    std::string prepare(const fs::path &directory, const fs::path &scene_file)
    {
      try
        {
          fs::create_directories(directory / "fields");
          std::error_code no_such_file;
          if (fs::equivalent(directory / "scene.prm", scene_file, no_such_file))
            return "the scene file itself, which lies there, would be written over";
          if (fs::exists(
                directory /
                "scene.prm")) // only a run writes that: elsewhere the files are the user's own
            {
              remove_results(directory, false);
              remove_results(directory / "fields", true);
            }
          const fs::path trial = directory / ".perideal_trial";
          std::ofstream  file(trial);
          file << "x" << std::flush;
          if (!file)
            return "it cannot be written to";
          file.close();
          fs::remove(trial);
          return "";
        }
      catch (const fs::filesystem_error &error)
        {
          return error.code().message();
        }
    }
  } // namespace


  void prepare_directory(const std::string &directory,
                         const std::string &scene_file,
                         const MPI_Comm     communicator)
  {
    std::string message;
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      message = prepare(directory, scene_file);
    if (!message.empty())
      message = "'Output directory' (outside all sections): cannot use '" + directory +
                "': " + message + ". Choose a directory that you may write to.";
    throw_on_all_if_any(communicator, message);
  }


  void write_file(const std::string &name, const std::string &text)
  {
    const std::string unfinished = name + ".part";
    std::error_code   problem;
    {
      std::ofstream file(unfinished, std::ios::binary);
      file << text << std::flush;
      if (!file)
        problem = std::make_error_code(std::errc::io_error);
    }
    if (!problem)
      fs::rename(unfinished, name, problem);
    AssertThrow(!problem,
                UserError("'Output directory' (outside all sections): cannot write '" + name +
                          "'. Is the disk full, or was the directory removed during the run?"));
  }


  std::string full_precision(const double x)
  {
    char text[40];
    std::snprintf(text, sizeof text, "%.15g", x);
    return text;
  }


  PointTable::PointTable(const std::vector<std::vector<double>> &points,
                         const unsigned int                      dim,
                         const std::vector<std::string>         &columns)
    : points(points)
    , n_columns(columns.size())
    , header(std::string("time,model,x") + (dim > 1 ? ",y" : "") + (dim > 2 ? ",z" : ""))
  {
    for (const std::string &column : columns)
      header += "," + column;
    header += "\n";
  }


  void PointTable::add(const double               time,
                       const std::string         &model,
                       const std::vector<double> &values)
  {
    for (std::size_t k = 0; k < points.size(); ++k)
      {
        rows += full_precision(time) + "," + model;
        for (const double x : points[k])
          rows += "," + full_precision(x);
        for (std::size_t c = 0; c < n_columns; ++c)
          rows += "," + full_precision(values[k * n_columns + c]);
        rows += "\n";
      }
  }


  std::string PointTable::text() const
  {
    return header + rows;
  }
} // namespace PeriDeal
