// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "study_tables.h"

#include <perideal/output/tables.h>
#include <perideal/scene/lists.h>

#include <algorithm>

namespace PeriDeal
{
  namespace
  {
    using Json = RowResult::Json;

    /** The columns of this study: entries of scenes stand behind the group and x. */
    std::vector<std::string> all_columns(const Study &study)
    {
      std::vector<std::string> columns = study_columns();
      const auto               model   = std::find(columns.begin(), columns.end(), "model");
      columns.insert(model, study.columns.begin(), study.columns.end());
      return columns;
    }


    /** The text of an entry in a row: of the scene with all defaults, or what was to be set. */
    Json entry_of(const CheckedRow &checked, const std::string &entry)
    {
      const auto found = checked.entries.find(entry);
      if (found != checked.entries.end())
        return found->second;
      for (const Setting &setting : checked.row.settings)
        if (setting.first == entry)
          return setting.second;
      return Json();
    }


    Json x_of(const CheckedRow &checked)
    {
      if (checked.row.x.has_value())
        return checked.row.x.value();
      return checked.row.x_entry.empty() ? Json() : entry_of(checked, checked.row.x_entry);
    }


    /** What a row has in common in all its lines. */
    Json first_cells(const Study &study, const CheckedRow &checked, const RowResult &result)
    {
      Json line = {{"name", checked.row.name},
                   {"scene", checked.row.scene},
                   {"group", checked.row.group},
                   {"x", x_of(checked)},
                   {"status", result.status_of(checked.row)},
                   {"processes", result.record.value("processes", Json())},
                   {"repeats", result.record.value("repeats", Json())},
                   {"message", result.message}};
      for (const std::string &entry : study.columns)
        line[entry] = entry_of(checked, entry);
      return line;
    }


    void add_model_cells(Json &line, const Json &model, const Json &times)
    {
      for (const char *const key : {"unknowns",
                                    "bonds",
                                    "nonzeros",
                                    "steps",
                                    "operator applications",
                                    "iterations",
                                    "peak memory",
                                    "memory"})
        if (model.contains(key))
          line[key] = model[key];
      for (const char *const balance : {"heat balance", "force balance"})
        if (model.contains(balance))
          line.update(model[balance]);
      line["set-up time"]   = times["set-up"];
      line["stepping time"] = times["stepping"];
      line["wall time"]     = times["total"];
    }


    /** The value of a list of [time, value], or null. */
    Json at_time(const Json &errors, const std::string &kind, const Json &time)
    {
      if (errors.contains(kind))
        for (const Json &pair : errors[kind])
          if (pair[0] == time)
            return pair[1];
      return Json();
    }


    /**
     * `ux at (80, 0)`: what a column of probes.csv is called here. @param field the name of the
     * diffusing quantity
     */
    std::string name_at_probe(const std::string &column,
                              const Json        &coordinates,
                              const std::string &field)
    {
      std::string place;
      for (const Json &x : coordinates)
        place += (place.empty() ? "" : ", ") + number_text(x.get<double>());
      return (column == "value" ? field : column) + " at (" + place + ")";
    }


    /**
     * What a model has found in the end, by the names of columns: values at probes, stress
     * intensities, energies, the largest force.
     */
    Json quantities_of(const Json &results, const std::string &name)
    {
      const Json &model = results["models"][name];
      Json        found = Json::object();
      double      end   = 0.;
      for (const Json &row : results["probes"])
        end = std::max(end, row.value("time", 0.));
      const std::string field =
        results.contains("names") ? results["names"].value("field", "value") : "value";
      for (const Json &row : results["probes"])
        if (row.value("model", "") == name && row.value("time", 0.) == end)
          for (const char *const column : {"value", "ux", "uy", "uz", "von_mises"})
            if (row.contains(column))
              found[name_at_probe(column, row["coordinates"], field)] = row[column];
      if (model.contains("stress intensity"))
        for (const auto &[crack_end, values] : model["stress intensity"].items())
          for (const char *const mode : {"I", "II", "III"})
            if (values.contains(mode))
              found[std::string("K_") + mode + " at " + crack_end] = values[mode];
      for (const char *const key : {"effective conductivity", "strain energy"})
        if (model.contains(key))
          found[key] = model[key];
      if (model.contains("largest force"))
        found["largest force"] = model["largest force"]["value"];
      if (model.contains("energy balance"))
        for (const auto &[key, title] :
             {std::pair<const char *, const char *>{"dissipated", "energy dissipated"},
              {"broken bonds", "broken bonds"}})
          if (model["energy balance"].contains(key))
            found[title] = model["energy balance"][key];
      return found;
    }


    /** The lines of study.csv as objects. */
    void add_lines(Json                     &lines,
                   std::vector<std::string> &quantities,
                   const Study              &study,
                   const CheckedRow         &checked,
                   const RowResult          &result)
    {
      if (result.status == RowResult::Status::missing)
        return;
      const Json first = first_cells(study, checked, result);
      if (result.status == RowResult::Status::failed)
        {
          lines.push_back(first);
          return;
        }
      for (const auto &item : result.results["models"].items())
        {
          Json line     = first;
          line["model"] = item.key();
          add_model_cells(line, item.value(), result.record["models"][item.key()]["times"]);
          const Json errors = item.value().value("errors", Json::object());
          Json       times  = Json::array();
          for (const Json &pair : errors.value("relative l2", Json::array()))
            times.push_back(pair[0]);
          if (times.empty())
            times.push_back(result.results.value("end time", 0.));
          for (const Json &time : times)
            {
              line["time"] = time;
              if (!errors.empty())
                {
                  line["relative l2 error"] = at_time(errors, "relative l2", time);
                  line["maximum error"]     = at_time(errors, "maximum", time);
                }
              lines.push_back(line);
            }
          const Json found = quantities_of(result.results, item.key());
          lines.back().update(found);
          for (const auto &quantity : found.items())
            if (std::find(quantities.begin(), quantities.end(), quantity.key()) == quantities.end())
              quantities.push_back(quantity.key());
        }
    }


    /** @param quantities the names of what rows have found, which are columns behind all others */
    Json all_lines(const Study                   &study,
                   const std::vector<CheckedRow> &rows,
                   const std::vector<RowResult>  &results,
                   std::vector<std::string>      &quantities)
    {
      Json lines = Json::array();
      for (std::size_t k = 0; k < rows.size(); ++k)
        add_lines(lines, quantities, study, rows[k], results[k]);
      return lines;
    }


    /** Texts in quotes where commas, quotes or line ends stand in them. */
    std::string csv_cell(const Json &value)
    {
      if (value.is_null())
        return "nan"; // JSON knows no number that is none
      if (value.is_number_float())
        return full_precision(value.get<double>());
      if (!value.is_string())
        return value.dump();
      std::string text;
      for (const char c : value.get<std::string>())
        text += c == '"' ? std::string("\"\"") : std::string(1, c);
      return text.find_first_of(",\"\n\r") == std::string::npos ? text : "\"" + text + "\"";
    }


    Json describe_figures(const Study &study)
    {
      Json figures = Json::array();
      for (const StudyFigure &figure : study.figures)
        figures.push_back({{"name", figure.name},
                           {"title", figure.title},
                           {"x", figure.x},
                           {"y", figure.y},
                           {"log", figure.log},
                           {"lines", figure.lines}});
      return figures;
    }


    /** All that is known of a row. */
    Json describe_row(const Study &study, const CheckedRow &checked, const RowResult &result)
    {
      Json row   = {{"name", checked.row.name},
                    {"row", checked.row.sweep},
                    {"scene", checked.row.scene},
                    {"group", checked.row.group},
                    {"x", x_of(checked)},
                    {"quick", checked.row.quick},
                    {"fails", checked.row.fails},
                    {"status", result.status_of(checked.row)},
                    {"message", result.message}};
      row["set"] = Json::object();
      for (const auto &[entry, value] : checked.row.settings)
        row["set"][entry] = value;
      row["entries"] = Json::object();
      for (const std::string &entry : study.columns)
        row["entries"][entry] = entry_of(checked, entry);
      row["folder"] = "rows/" + checked.folder.substr(checked.folder.rfind('/') + 1);
      for (const char *const key : {"hash", "program", "processes", "repeats", "wall time"})
        if (result.record.contains(key))
          row[key] = result.record[key];
      if (result.status != RowResult::Status::finished)
        return row;
      row["run"] =
        result.results; // its "wall time" is that of its last repeat, "times" the smallest
      for (auto &item : row["run"]["models"].items())
        item.value()["times"] = result.record["models"][item.key()]["times"];
      for (const char *const key : {"totals", "probes"})
        {
          row[key] = row["run"][key];
          row["run"].erase(key);
        }
      row["models"] = row["run"]["models"];
      row["run"].erase("models");
      return row;
    }
  } // namespace


  std::string study_csv(const Study                   &study,
                        const std::vector<CheckedRow> &rows,
                        const std::vector<RowResult>  &results)
  {
    std::vector<std::string> columns = all_columns(study), quantities;
    const Json               lines   = all_lines(study, rows, results, quantities);
    columns.insert(columns.end(), quantities.begin(), quantities.end());
    std::string text;
    for (std::size_t k = 0; k < columns.size(); ++k)
      text += (k > 0 ? "," : "") + csv_cell(columns[k]);
    text += "\n";
    for (const Json &line : lines)
      {
        for (std::size_t k = 0; k < columns.size(); ++k)
          {
            // x and entries that a row does not have are empty, not numbers that are none
            const bool given =
              line.contains(columns[k]) &&
              !(line[columns[k]].is_null() && columns[k].find("error") == std::string::npos);
            text += (k > 0 ? "," : "") + (given ? csv_cell(line[columns[k]]) : "");
          }
        text += "\n";
      }
    return text;
  }


  std::string study_json(const Study                   &study,
                         const std::vector<CheckedRow> &rows,
                         const std::vector<RowResult>  &results)
  {
    Json                     json;
    std::vector<std::string> columns = all_columns(study), quantities;
    const Json               lines   = all_lines(study, rows, results, quantities);
    columns.insert(columns.end(), quantities.begin(), quantities.end());
    json["title"]      = study.title;
    json["text"]       = study.text;
    json["source"]     = study.source;
    json["program"]    = std::string("PeriDeal ") + PERIDEAL_VERSION;
    json["columns"]    = columns;
    json["quantities"] = quantities;
    json["entries"]    = study.columns;
    json["varied"]     = study.varied;
    json["figures"]    = describe_figures(study);
    json["table"]      = lines;
    json["rows"]       = Json::array();
    for (std::size_t k = 0; k < rows.size(); ++k)
      json["rows"].push_back(describe_row(study, rows[k], results[k]));
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
  }
} // namespace PeriDeal
