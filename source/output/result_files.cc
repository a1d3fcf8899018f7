// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/output/result_files.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace PeriDeal
{
  namespace
  {
    /** Files and folders of a run, by the first part of their names. */
    bool is_result(const std::filesystem::path &path)
    {
      static const std::vector<std::string> names = {"summary.json",
                                                     "report.html",
                                                     "probes.csv",
                                                     "line.csv",
                                                     "totals.csv",
                                                     "scene.prm",
                                                     "fields"};
      const std::string                     name  = path.filename().string();
      for (const std::string &known : names)
        if (name == known)
          return true;
      return path.extension() == ".pvd" || path.extension() == ".xdmf";
    }
  } // namespace


  void prepare_directory(const std::string &directory, const MPI_Comm communicator)
  {
    namespace fs = std::filesystem;
    std::string message;
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        try
          {
            fs::create_directories(directory);
            for (const auto &entry : fs::directory_iterator(directory))
              if (is_result(entry.path()))
                fs::remove_all(entry.path());
            fs::create_directories(fs::path(directory) / "fields");
            const fs::path trial = fs::path(directory) / ".perideal_trial";
            std::ofstream  file(trial);
            file << "x" << std::flush;
            if (!file)
              message = "it cannot be written to";
            file.close();
            fs::remove(trial);
          }
        catch (const fs::filesystem_error &error)
          {
            message = error.code().message();
          }
        if (!message.empty())
          message = "'Output directory' (outside all sections): cannot use '" + directory +
                    "': " + message + ". Choose a directory that you may write to.";
      }
    throw_on_all_if_any(communicator, message);
  }


  void write_file(const std::string &name, const std::string &text)
  {
    const std::string unfinished = name + ".part";
    {
      std::ofstream file(unfinished);
      file << text << std::flush;
      AssertThrow(file, UserError("Cannot write '" + name + "': is the disk full?"));
    }
    std::filesystem::rename(unfinished, name);
  }


  std::string full_precision(const double x)
  {
    char text[40];
    std::snprintf(text, sizeof text, "%.15g", x);
    return text;
  }


  PointTable::PointTable(const std::vector<std::vector<double>> &points, const unsigned int dim)
    : points(points)
    , header(std::string("time,model,x") + (dim > 1 ? ",y" : "") + (dim > 2 ? ",z" : "") +
             ",value\n")
  {}


  void PointTable::add(const double               time,
                       const std::string         &model,
                       const std::vector<double> &values)
  {
    for (std::size_t k = 0; k < points.size(); ++k)
      {
        rows += full_precision(time) + "," + model;
        for (const double x : points[k])
          rows += "," + full_precision(x);
        rows += "," + full_precision(values[k]) + "\n";
      }
  }


  std::string PointTable::text() const
  {
    return header + rows;
  }
} // namespace PeriDeal
