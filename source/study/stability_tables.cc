// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "stability_tables.h"

#include <perideal/base/progress.h>
#include <perideal/output/tables.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace PeriDeal
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    /** `inf` is a number, too, for most readers of such tables. */
    std::string cell(const Json &value)
    {
      if (value.is_null())
        return "";
      if (value.is_number_float())
        return full_precision(value.get<double>());
      if (!value.is_string())
        return value.dump();
      const std::string text = value.get<std::string>();
      if (text.find_first_of(",\"\n") == std::string::npos)
        return text;
      std::string quoted = "\"";
      for (const char c : text)
        quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
      return quoted + "\"";
    }


    /** Those of all maps, each once, in the order in which they come up. */
    std::vector<std::string> parameter_names(const std::vector<StabilityResult> &results)
    {
      std::vector<std::string> names;
      const auto               add = [&](const StabilityPoint &point) {
        for (const auto &[name, value] : point.parameters)
          if (std::find(names.begin(), names.end(), name) == names.end())
            names.push_back(name);
      };
      for (const StabilityResult &result : results)
        {
          for (const StabilityPoint &point : result.points)
            add(point);
          for (const RandomPoint &random : result.random)
            add(random.point);
        }
      return names;
    }


    std::string line_of(const std::string              &map,
                        const std::string              &sample,
                        const std::vector<std::string> &names,
                        const StabilityPoint           &point)
    {
      const std::map<std::string, Json> values(point.parameters.begin(), point.parameters.end());
      std::string                       line = map + "," + sample;
      for (const std::string &name : names)
        line += "," + (values.count(name) > 0 ? cell(values.at(name)) : std::string());
      return line + "," + full_precision(point.predicted) + "," + full_precision(point.observed) +
             "," + point.verdict + "\n";
    }


    /** JSON has no infinity. */
    Json number(const double value)
    {
      return std::isfinite(value) ? Json(value) : std::isnan(value) ? Json() : Json("infinite");
    }


    Json entry_of(const StabilityPoint &point)
    {
      Json entry = Json::object();
      for (const auto &[name, value] : point.parameters)
        entry[name] = value;
      entry["predicted"] = number(point.predicted);
      entry["observed"]  = number(point.observed);
      entry["verdict"]   = point.verdict;
      return entry;
    }


    /** The least and the largest value of parameters that are numbers, else all texts. */
    Json ranges_of(const std::vector<StabilityPoint> &points)
    {
      Json ranges = Json::object();
      for (const StabilityPoint &point : points)
        for (const auto &[name, value] : point.parameters)
          {
            if (value.is_null())
              continue;
            if (value.is_number())
              {
                const double x = value.get<double>();
                if (!ranges.contains(name))
                  ranges[name] = {x, x};
                ranges[name][0] = std::min(x, ranges[name][0].get<double>());
                ranges[name][1] = std::max(x, ranges[name][1].get<double>());
              }
            else if (!ranges.contains(name))
              ranges[name] = {value};
            else if (std::find(ranges[name].begin(), ranges[name].end(), value) ==
                     ranges[name].end())
              ranges[name].push_back(value);
          }
      return ranges;
    }


    /** The least and the largest ratio of what is observed to what is predicted, where both are. */
    std::pair<double, double> ratios_of(const std::vector<StabilityPoint> &points)
    {
      double least = std::numeric_limits<double>::infinity(), most = 0.;
      for (const StabilityPoint &point : points)
        if (std::isfinite(point.predicted) && std::isfinite(point.observed) && point.predicted > 0.)
          {
            least = std::min(least, point.observed / point.predicted);
            most  = std::max(most, point.observed / point.predicted);
          }
      return {least, most};
    }
  } // namespace


  std::pair<unsigned int, unsigned int> StabilityResult::confirmed(const bool inside) const
  {
    std::pair<unsigned int, unsigned int> result{0, 0};
    for (const RandomPoint &one : random)
      if (one.inside == inside)
        {
          ++result.first;
          result.second += one.confirms() ? 1 : 0;
        }
    return result;
  }


  std::string stability_csv(const std::vector<StabilityResult> &results)
  {
    const std::vector<std::string> names  = parameter_names(results);
    std::string                    header = "map,sample", lines;
    for (const std::string &name : names)
      header += "," + name;
    for (const StabilityResult &result : results)
      {
        for (const StabilityPoint &point : result.points)
          lines += line_of(result.name, "grid", names, point);
        for (const RandomPoint &one : result.random)
          lines += line_of(result.name, one.inside ? "inside" : "outside", names, one.point);
      }
    return header + ",predicted,observed,verdict\n" + lines;
  }


  std::string stability_json(const std::string                  &scene,
                             const StabilityFacts               &facts,
                             const StabilityOptions             &options,
                             const std::vector<StabilityResult> &results)
  {
    Json all = {{"scene", scene},
                {"title", facts.title},
                {"set", options.overrides},
                {"cells", facts.coarse},
                {"cells of the scene", facts.cells},
                {"seed", options.seed},
                {"maps", Json::array()},
                {"left out", Json::object()}};
    for (const StabilityResult &result : results)
      {
        if (!result.obstacle.empty())
          {
            all["left out"][result.name] = result.obstacle;
            continue;
          }
        Json map = {{"name", result.name},
                    {"predicted", result.predicted},
                    {"observed", result.observed},
                    {"bound", result.bound},
                    {"ranges", ranges_of(result.points)},
                    {"wall time", result.wall_time},
                    {"left out", result.left_out},
                    {"points", Json::array()},
                    {"random", Json::array()}};
        for (const bool inside : {true, false})
          {
            const auto [n, n_confirmed]        = result.confirmed(inside);
            map[inside ? "inside" : "outside"] = {{"points", n}, {"confirmed", n_confirmed}};
          }
        for (const StabilityPoint &point : result.points)
          map["points"].push_back(entry_of(point));
        for (const RandomPoint &one : result.random)
          {
            Json entry         = entry_of(one.point);
            entry["inside"]    = one.inside;
            entry["confirmed"] = one.confirms();
            map["random"].push_back(entry);
          }
        all["maps"].push_back(map);
      }
    return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  }


  std::vector<std::string> describe(const StabilityResult &result)
  {
    if (!result.obstacle.empty())
      return {"  " + result.name + ": left out, " + result.obstacle};
    std::map<std::string, unsigned int> verdicts;
    for (const StabilityPoint &point : result.points)
      ++verdicts[point.verdict];
    std::string counts;
    for (const auto &[verdict, n] : verdicts)
      counts += ", " + std::to_string(n) + " " + verdict;
    std::vector<std::string> lines = {"  " + result.name + ": " +
                                      std::to_string(result.points.size()) + " points" + counts +
                                      " (" + readable_duration(result.wall_time) + ")"};
    const auto [least, most]       = ratios_of(result.points);
    if (result.name == "step limit" && most > 0.)
      lines.push_back("    observed over predicted: " + rounded_text(least, 4) + " to " +
                      rounded_text(most, 4));
    for (const bool inside : {true, false})
      if (const auto [n, n_confirmed] = result.confirmed(inside); n > 0)
        lines.push_back("    " + std::to_string(n_confirmed) + " of " + std::to_string(n) +
                        " random points " +
                        (inside ? "inside are healthy" : "outside are not healthy"));
    for (const std::string &what : result.left_out)
      lines.push_back("    left out: " + what);
    return lines;
  }
} // namespace PeriDeal
