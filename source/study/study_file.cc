// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/text_file.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/scene.h>
#include <perideal/study/study_file.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "study_json.h"

namespace PeriDeal
{
  namespace
  {
    namespace fs = std::filesystem;

    constexpr unsigned int most_rows = 10000;


    /** All entries that a scene can have, as overrides name them. */
    std::vector<std::string> known_entries()
    {
      std::vector<std::string> names;
      Scene<2>                 scene;
      for (const SceneSection *const section : scene.sections())
        for (const Entry &entry : section->entries())
          names.push_back((section->name().empty() ? "" : section->name() + "/") + entry.name);
      return names;
    }


    /** Throws UserError unless a study may set the entry. */
    void check_entry(const std::string &entry, const std::string &where)
    {
      static const std::vector<std::string> known = known_entries();
      AssertThrow(entry != "Output directory",
                  UserError(where + ": 'Output directory' of each row is decided by the study; "
                                    "\"output\" (or --output) is the directory of all of them."));
      if (std::find(known.begin(), known.end(), entry) != known.end())
        return;
      std::string elsewhere; // the same entry in the right section says more than a similar name
      for (const std::string &name : known)
        if (elsewhere.empty() &&
            name.substr(name.rfind('/') + 1) == trimmed(entry.substr(entry.rfind('/') + 1)))
          elsewhere = " Did you mean '" + name + "'?";
      AssertThrow(false,
                  UserError(where + ": there is no entry '" + entry +
                            "'; entries are named 'Section/Entry'." +
                            (elsewhere.empty() ? did_you_mean(entry, known) : elsewhere)));
    }


    /** Add a setting, or give the one that is there another value. */
    void set(std::vector<Setting> &settings, const Setting &setting)
    {
      for (Setting &old : settings)
        if (old.first == setting.first)
          {
            old.second = setting.second;
            return;
          }
      settings.push_back(setting);
    }


    void add_column(Study &study, const std::string &entry)
    {
      if (std::find(study.columns.begin(), study.columns.end(), entry) == study.columns.end())
        study.columns.push_back(entry);
    }


    /** The file, on rank 0, and what is wrong with it. */
    std::string read_text(const std::string &file_name, std::string &message)
    {
      const std::string text = read_file(file_name, most_bytes_of_text, message);
      if (!message.empty())
        message = "The study file '" + file_name + "' " + message +
                  ". Check its path, which is relative to the working directory.";
      else if (trimmed(text).empty())
        message = "The study file '" + file_name + "' is empty.";
      return text;
    }


    /**
     * The folders that a scene's path may be relative to: the working one, that of the study file,
     * and its parents.
     */
    std::vector<fs::path> folders_of_scenes(const std::string &study_file)
    {
      std::error_code       none;
      std::vector<fs::path> folders(1);
      if (study_file.empty())
        return folders;
      fs::path folder = fs::absolute(study_file, none).lexically_normal().parent_path();
      for (; folder != folder.root_path(); folder = folder.parent_path())
        folders.push_back(folder);
      folders.push_back(folder);
      return folders;
    }


    /** Scenes that lie where this one was looked for. */
    std::vector<std::string> scenes_beside(const std::string           &scene,
                                           const std::vector<fs::path> &folders)
    {
      std::vector<std::string> names;
      const fs::path           beside = fs::path(scene).parent_path();
      std::error_code          none;
      for (const fs::path &folder : folders)
        {
          const fs::path place = folder / beside;
          for (const auto &file : fs::directory_iterator(place.empty() ? "." : place, none))
            if (file.path().extension() == ".prm")
              names.push_back((beside / file.path().filename()).string());
        }
      std::sort(names.begin(), names.end());
      return names;
    }


    /** Where a scene is, seen from the working directory. Collective. */
    std::string find_scene(const std::string &scene,
                           const std::string &study_file,
                           const std::string &where,
                           const MPI_Comm     communicator)
    {
      std::string found, message;
      if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
        {
          std::error_code             none;
          const std::vector<fs::path> folders = folders_of_scenes(study_file);
          for (std::size_t k = 0; k < folders.size() && found.empty(); ++k)
            if (fs::is_regular_file(folders[k] / scene, none))
              found = k == 0 ?
                        scene :
                        (folders[k] / scene).lexically_proximate(fs::current_path(none)).string();
          if (found.empty())
            message =
              where + ": there is no scene '" + scene + "' in the working directory" +
              (study_file.empty() ? "." : ", the folder of the study file, or its parents.") +
              did_you_mean(scene, scenes_beside(scene, folders));
        }
      throw_on_all_if_any(communicator, message);
      return dealii::Utilities::MPI::broadcast(communicator, found, 0);
    }


    /** A row of the file, or all combinations that it stands for. */
    class RowReader
    {
    public:
      RowReader(Study                      &study,
                const std::string          &study_file,
                const std::vector<Setting> &common,
                const MPI_Comm              communicator)
        : study(study)
        , study_file(study_file)
        , common(common)
        , communicator(communicator)
      {}

      void read(const Json &object, const std::size_t number)
      {
        const std::string label = "row " + std::to_string(number);
        const bool        named = object.is_object() && object.contains("name") &&
                           object["name"].is_string();
        const std::string where =
          study.source + ": " + (named ? "row '" + object["name"].get<std::string>() + "'" : label);
        const StudyObject row(
          object,
          where,
          {"name", "row", "scene", "set", "vary", "quick", "group", "x", "fails", "may fail"});
        StudyRow          common_row;
        const std::string name = row.text("name", true);
        common_row.sweep       = row.text("row", false, name);
        common_row.scene =
          find_scene(row.text("scene", true), study_file, where + ", key 'scene'", communicator);
        common_row.group    = row.text("group");
        common_row.quick    = row.boolean("quick");
        common_row.fails    = row.boolean("fails");
        common_row.may_fail = row.boolean("may fail");
        common_row.settings = common;
        read_x(row, where, common_row);

        const auto own = row.settings("set");
        for (const Setting &setting : own)
          {
            check_entry(setting.first, where + ", key 'set'");
            add_column(study, setting.first);
            set(common_row.settings, setting);
          }
        const auto variations = row.variations("vary");
        for (const Variation &variation : variations)
          {
            check_entry(variation.first, where + ", key 'vary'");
            for (const Setting &setting : own)
              if (setting.first == variation.first)
                row.error("vary", "'" + variation.first + "' is in 'set', too.");
          }
        add(common_row, name, variations, where);
      }

      /** All combinations. */
      void add(const StudyRow               &common_row,
               const std::string            &name,
               const std::vector<Variation> &variations,
               const std::string            &where)
      {
        double n_rows = 1.;
        for (const Variation &variation : variations)
          {
            add_column(study, variation.first);
            study.varied.insert(variation.first);
            n_rows *= static_cast<double>(variation.second.size());
          }
        AssertThrow(static_cast<double>(study.rows.size()) + n_rows <= most_rows,
                    UserError(where + ": the study would have more than " +
                              std::to_string(most_rows) + " rows. Vary less."));
        for (const std::vector<Setting> &combination : combinations(variations))
          {
            StudyRow row = common_row;
            row.name     = combination_name(name, combination);
            for (const Setting &setting : combination)
              set(row.settings, setting);
            AssertThrow(names.insert(row.name).second,
                        UserError(where + ": there are two rows of the name '" + row.name +
                                  "'. Names tell rows apart; give one of them another."));
            study.rows.push_back(row);
          }
      }

    private:
      void read_x(const StudyObject &row, const std::string &where, StudyRow &target)
      {
        if (!row.has("x"))
          return;
        if (row.value("x").is_number())
          {
            target.x = row.value("x").get<double>();
            return;
          }
        target.x_entry = row.text("x", true);
        check_entry(target.x_entry, where + ", key 'x'");
        add_column(study, target.x_entry);
      }

      Study                      &study;
      const std::string          &study_file;
      const std::vector<Setting> &common;
      MPI_Comm                    communicator;
      std::set<std::string>       names;
    };


    /**
     * A number that runs find, of which only they know whether it is there: values at probes,
     * stress intensities, energies.
     */
    bool is_found_by_runs(const std::string &column)
    {
      static const std::vector<std::string> names = {"strain energy",
                                                     "largest force",
                                                     "energy dissipated",
                                                     "broken bonds",
                                                     "effective conductivity"};
      return std::find(names.begin(), names.end(), column) != names.end() ||
             column.find(" at (") != std::string::npos || column.rfind("K_I", 0) == 0;
    }


    /**
     * A column of a figure: one that every study has, x of the rows, a number that runs find, or
     * an entry of scenes.
     */
    void check_column(Study             &study,
                      const std::string &column,
                      const StudyObject &figure,
                      const std::string &key)
    {
      std::vector<std::string> known = study_columns();
      known.insert(known.end(), study.columns.begin(), study.columns.end());
      if (std::find(known.begin(), known.end(), column) != known.end() || is_found_by_runs(column))
        return;
      const std::vector<std::string> entries = known_entries();
      if (std::find(entries.begin(), entries.end(), column) != entries.end())
        return add_column(study, column);
      std::vector<std::string> all = known;
      all.insert(all.end(), entries.begin(), entries.end());
      figure.error(key,
                   "there is no column '" + column + "'; known: " + join_names(known) +
                     ", and all entries of scenes." + did_you_mean(column, all));
    }


    void read_figure(Study &study, const Json &object, const std::size_t number)
    {
      const bool named = object.is_object() && object.contains("name") &&
                         object["name"].is_string();
      const std::string where =
        study.source + ": figure " +
        (named ? "'" + object["name"].get<std::string>() + "'" : std::to_string(number));
      const StudyObject figure(object, where, {"name", "title", "x", "y", "log", "lines"});
      StudyFigure       result;
      result.name  = figure.text("name", true);
      result.title = figure.text("title", false, result.name);
      result.x     = figure.text("x", true);
      result.y     = figure.text("y", true);
      result.log   = figure.boolean("log");
      result.lines = figure.texts("lines");
      if (folder_names({result.name}).front() != result.name)
        figure.error("name",
                     "'" + result.name +
                       "' becomes the name of a file: letters, digits, '.', '-' and '_' only.");
      for (const StudyFigure &other : study.figures)
        if (other.name == result.name)
          figure.error("name", "there are two figures of the name '" + result.name + "'.");
      check_column(study, result.x, figure, "x");
      check_column(study, result.y, figure, "y");
      for (const std::string &line : result.lines)
        check_column(study, line, figure, "lines");
      study.figures.push_back(result);
    }
  } // namespace


  const std::vector<std::string> &study_columns()
  {
    static const std::vector<std::string> columns = {"name",
                                                     "scene",
                                                     "group",
                                                     "x",
                                                     "model",
                                                     "time",
                                                     "status",
                                                     "unknowns",
                                                     "bonds",
                                                     "nonzeros",
                                                     "steps",
                                                     "operator applications",
                                                     "iterations",
                                                     "set-up time",
                                                     "stepping time",
                                                     "wall time",
                                                     "peak memory",
                                                     "memory",
                                                     "relative l2 error",
                                                     "maximum error",
                                                     "throughput",
                                                     "imbalance",
                                                     "processes",
                                                     "repeats",
                                                     "message"};
    return columns;
  }


  Study read_study(const std::string &file_name, const MPI_Comm communicator)
  {
    std::string text, message;
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      text = read_text(file_name, message);
    throw_on_all_if_any(communicator, message);
    text = dealii::Utilities::MPI::broadcast(communicator, text, 0);

    const Json        json = parse_study_text(text, file_name);
    const StudyObject file(
      json,
      file_name,
      {"title", "text", "output", "set", "rows", "figures", "source", "columns", "varied"});
    const std::string stem = fs::path(file_name).stem().string();
    Study             study;
    study.source = file.text("source", false, file_name);
    study.title  = file.text("title", false, stem);
    study.text   = file.text("text");
    study.output = file.text("output", false, "output/studies/" + stem);
    if (study.output.empty())
      file.error("output", "is empty, needs the name of a directory.");
    const auto common = file.settings("set");
    for (const Setting &setting : common)
      check_entry(setting.first, file_name + ", key 'set'");

    const std::vector<Json> rows = file.objects("rows");
    AssertThrow(!rows.empty(),
                UserError(file_name + ": the key 'rows' needs a list with at least one row, " +
                          R"([ { "name": "...", "scene": "..." } ].)"));
    RowReader reader(study, file_name, common, communicator);
    for (std::size_t k = 0; k < rows.size(); ++k)
      reader.read(rows[k], k + 1);
    if (file.has("columns"))
      study.columns = file.texts("columns");
    for (const std::string &entry : file.texts("varied"))
      study.varied.insert(entry);
    const std::vector<Json> figures = file.objects("figures");
    for (std::size_t k = 0; k < figures.size(); ++k)
      read_figure(study, figures[k], k + 1);
    return study;
  }


  Study sweep_of_scenes(const std::vector<std::string> &scenes,
                        const std::vector<Variation>   &variations,
                        const MPI_Comm                  communicator)
  {
    const auto stem = [](const std::string &scene) { return fs::path(scene).stem().string(); };
    std::set<std::string> stems, varied;
    for (const std::string &scene : scenes)
      stems.insert(stem(scene));
    Study study;
    study.source = "command line";
    study.output = "output/studies/" + stem(scenes.front());
    for (const Variation &variation : variations)
      {
        check_entry(variation.first, "command line: --vary");
        AssertThrow(varied.insert(variation.first).second,
                    UserError("command line: --vary names '" + variation.first + "' twice."));
        study.title += (study.title.empty() ? "" : " and ") + variation.first;
      }
    study.title = join_names(stems) + (study.title.empty() ? "" : ": " + study.title);
    const std::string          no_file;
    const std::vector<Setting> nothing;
    RowReader                  reader(study, no_file, nothing, communicator);
    for (const std::string &scene : scenes)
      {
        StudyRow row;
        row.sweep = stems.size() == scenes.size() ? stem(scene) : scene;
        row.scene = find_scene(scene, no_file, "command line", communicator);
        reader.add(row, row.sweep, variations, "command line");
      }
    return study;
  }


  void override_rows(Study &study, const std::vector<std::string> &overrides)
  {
    for (const std::string &text : overrides)
      {
        const std::size_t equals = text.find('=');
        const Setting     setting(trimmed(text.substr(0, equals)),
                              equals == std::string::npos ? "" : trimmed(text.substr(equals + 1)));
        AssertThrow(equals != std::string::npos && !setting.first.empty(),
                    UserError("command line: '" + text +
                              "' needs the form 'Section/Entry=value', or 'Entry=value' for "
                              "entries outside all sections."));
        check_entry(setting.first, "command line: --set");
        AssertThrow(study.varied.count(setting.first) == 0,
                    UserError("command line: --set '" + text + "': the study varies that entry."));
        for (StudyRow &row : study.rows)
          set(row.settings, setting);
      }
  }
} // namespace PeriDeal
