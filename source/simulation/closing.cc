// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "closing.h"

#include <perideal/scene/lists.h>

#include <unistd.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <sstream>

namespace PeriDeal
{
  using json = nlohmann::ordered_json;

  namespace
  {
    std::string at_time(const double t, const json &summary)
    {
      const std::string unit = summary["units"].value("time", "");
      return "t = " + rounded_text(t, 4) + (unit.empty() ? "" : " " + unit);
    }


    /** The last value of a series [[t, value], ...]; NaN if there is none. */
    double last_of(const json &entries, const std::string &norm)
    {
      if (!entries.contains(norm) || entries[norm].empty())
        return std::nan("");
      const json &value = entries[norm].back()[1];
      return value.is_number() ? value.get<double>() : std::nan("");
    }


    /** `peridynamics minus finite elements: 0.12 % (relative L2), at most 0.034 K`. */
    void add_difference(std::vector<std::string> &lines,
                        const std::string        &pair,
                        const json               &entries,
                        const std::string        &unit)
    {
      const double relative = last_of(entries, "relative l2"),
                   largest  = last_of(entries, "maximum");
      if (std::isfinite(relative))
        lines.push_back(pair + ": " + rounded_text(100. * relative, 3) +
                        " % (relative L2), at most " + rounded_text(largest, 3) +
                        (unit.empty() ? "" : " " + unit));
    }


    void add_errors(std::vector<std::string> &lines, const json &summary)
    {
      for (const auto &[name, model] : summary["models"].items())
        if (model.contains("errors"))
          if (const double error = last_of(model["errors"], "relative l2"); std::isfinite(error))
            lines.push_back("error of " + name + " against the exact solution: " +
                            rounded_text(100. * error, 3) + " % (relative L2)");
    }


    /**
     * One number of some or all models in one line: `what: 1.23 (finite elements), 1.24 (coupled)`.
     */
    void add_of_models(std::vector<std::string>                               &lines,
                       const std::string                                      &what,
                       const json                                             &summary,
                       const std::function<std::string(const json &of_model)> &value)
    {
      std::string line;
      for (const auto &[name, model] : summary["models"].items())
        if (const std::string text = value(model); !text.empty())
          line += (line.empty() ? "" : ", ") + text + " (" + name + ")";
      if (!line.empty())
        lines.push_back(what + ": " + line);
    }


    void add_intensities(std::vector<std::string> &lines, const json &summary)
    {
      std::vector<std::string> ends;
      for (const auto &[name, model] : summary["models"].items())
        if (model.contains("stress intensity"))
          for (const auto &[end, values] : model["stress intensity"].items())
            if (std::find(ends.begin(), ends.end(), end) == ends.end())
              ends.push_back(end);
      constexpr std::size_t most = 8;
      for (std::size_t k = 0; k < std::min(most, ends.size()); ++k)
        for (const std::string mode : {"I", "II", "III"})
          add_of_models(lines, "K_" + mode + " at " + ends[k], summary, [&](const json &model) {
            if (!model.contains("stress intensity") || !model["stress intensity"].contains(ends[k]))
              return std::string();
            const json &found       = model["stress intensity"][ends[k]];
            double      most_of_all = 0.;
            for (const char *const other : {"I", "II", "III"})
              most_of_all = std::max(most_of_all, std::abs(found.value(other, 0.)));
            // Other modes are worth a line where they are more than an error of the method.
            constexpr double small = 0.01;
            if (!found.contains(mode) ||
                (mode != "I" && std::abs(found.value(mode, 0.)) < small * most_of_all))
              return std::string();
            return rounded_text(found.value(mode, 0.), 4);
          });
      if (ends.size() > most)
        lines.push_back("stress intensities at " + std::to_string(ends.size() - most) +
                        " more ends or places of cracks are in totals.csv");
      if (summary.contains("no stress intensity"))
        lines.push_back(
          (ends.empty() ? "no stress intensity factors: " : "stress intensity factors: ") +
          summary["no stress intensity"].get<std::string>());
    }


    /** ` at (0.1, 0.2)`, where the first bond broke; nothing if that is not known. */
    std::string at_place(const json &model)
    {
      std::string text;
      if (model.contains("first broken bond"))
        for (const json &x : model["first broken bond"])
          text += (text.empty() ? "" : ", ") + rounded_text(x, 4);
      return text.empty() ? text : " at (" + text + ")";
    }


    void add_breaking(std::vector<std::string> &lines, const json &summary)
    {
      const bool steady = summary.value("steady", false);
      add_of_models(lines, "largest force", summary, [&](const json &model) {
        if (!model.contains("largest force") || model["largest force"]["value"] == 0.)
          return std::string();
        const json &found = model["largest force"];
        return rounded_text(found["value"], 4) + " on " + found["side"].get<std::string>() +
               " in " + found["direction"].get<std::string>() +
               (steady ? "" : " at " + at_time(found["time"], summary));
      });
      add_of_models(lines, "broken bonds", summary, [&](const json &model) {
        if (!model.contains("energy balance") || !model["energy balance"].contains("broken bonds"))
          return std::string();
        const double n = model["energy balance"]["broken bonds"];
        if (n == 0.)
          return std::string("none");
        return readable_count(static_cast<unsigned long long>(n)) + ", the first " +
               (summary["solver"] == "dynamics" ? "by " : "at ") +
               at_time(model.value("first broken bonds", 0.), summary) + at_place(model);
      });
      add_of_models(lines, "new cracks", summary, [&](const json &model) {
        const json found = model.value("new cracks", json::object());
        for (const std::string measure : {"length", "area"})
          if (found.value(measure, 0.) > 0.)
            return measure + " " + rounded_text(found[measure], 4) +
                   (found.value("number of tips", 0) > 1 ?
                      ", " + std::to_string(found["number of tips"].get<int>()) + " tips" :
                      "");
        return std::string();
      });
    }


    /** The largest peak of the memory of all processes that a model has seen. */
    double peak_memory(const json &summary)
    {
      double peak = 0.;
      for (const auto &[name, model] : summary["models"].items())
        peak = std::max(peak, model.value("peak memory", 0.));
      return peak;
    }


    bool is_file(const std::string &name)
    {
      return access(name.c_str(), R_OK) == 0;
    }


    /**
     * The script that draws reports: beside an installed program, or in the tree that it was built
     * in; empty if it is in neither.
     */
    std::string report_script()
    {
      char          path[PATH_MAX];
      const ssize_t n = readlink("/proc/self/exe", path, sizeof path);
      if (n <= 0 || n >= static_cast<ssize_t>(sizeof path))
        return "";
      const std::string file(path, n), folder = file.substr(0, file.rfind('/'));
      for (const std::string place :
           {"/../share/perideal/report/report.py", "/../../../applications/report/report.py"})
        if (char *real = realpath((folder + place).c_str(), nullptr))
          {
            std::string found = real;
            std::free(real);
            if (is_file(found))
              {
                if (char *here = getcwd(path, sizeof path))
                  if (found.rfind(std::string(here) + "/", 0) == 0)
                    found.erase(0, std::string(here).size() + 1);
                return found;
              }
          }
      return "";
    }


    std::string quoted(const std::string &name)
    {
      return name.find_first_of(" '\"$&()*;<>?\\|`") == std::string::npos ? name : "'" + name + "'";
    }
  } // namespace


  std::vector<std::string> what_was_found(const json &summary)
  {
    std::vector<std::string> lines;
    const std::string        unit = summary["units"].value("field", "");
    if (summary.contains("comparison"))
      add_difference(lines, "peridynamics minus finite elements", summary["comparison"], unit);
    if (summary.contains("comparisons"))
      for (const auto &[pair, entries] : summary["comparisons"].items())
        add_difference(lines, pair, entries, unit);
    add_errors(lines, summary);
    add_of_models(lines,
                  "effective " + summary["names"].value("property", ""),
                  summary,
                  [](const json &model) {
                    return model.contains("effective conductivity") ?
                             rounded_text(model["effective conductivity"], 6) :
                             std::string();
                  });
    add_intensities(lines, summary);
    add_breaking(lines, summary);
    return lines;
  }


  void say_what_was_found(const Progress    &progress,
                          const json        &summary,
                          const std::string &directory)
  {
    for (const std::string &line : what_was_found(summary))
      progress.line(line);
    progress.line("took " + readable_duration(progress.elapsed()) + " and " +
                  readable_bytes(peak_memory(summary)) + " of memory at its peak");
    progress.line("Results: " + directory);
    // ./run draws the report by itself.
    if (std::getenv("PERIDEAL_PROGRESS") == nullptr)
      if (const std::string script = report_script(); !script.empty())
        progress.line("To draw " + directory + (directory.back() == '/' ? "" : "/") +
                      "report.html: python3 " + quoted(script) + " " + quoted(directory));
  }
} // namespace PeriDeal
