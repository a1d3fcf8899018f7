// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "work_tables.h"

#include <perideal/base/progress.h>
#include <perideal/output/tables.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace PeriDeal
{
  namespace
  {
    using Json = RowResult::Json;
    using Kind = CostAtError::Kind;

    const std::vector<double> target_errors = {1e-2, 1e-3};

    template <typename... Values>
    std::string formatted(const char *const format, const Values... values)
    {
      char text[400];
      std::snprintf(text, sizeof text, format, values...);
      return text;
    }


    /** Not a number becomes null, which JSON knows. */
    Json number(const double value)
    {
      return std::isfinite(value) ? Json(value) : Json();
    }


    const std::vector<std::string> &columns()
    {
      static const std::vector<std::string> names = {"name",
                                                     "family",
                                                     "model",
                                                     "cells",
                                                     "node spacing",
                                                     "unknowns",
                                                     "bonds",
                                                     "nonzeros",
                                                     "nonzeros applied",
                                                     "iterations",
                                                     "operator applications",
                                                     "work",
                                                     "error",
                                                     "set-up time",
                                                     "solution time",
                                                     "wall time",
                                                     "memory",
                                                     "peak memory",
                                                     "tolerance",
                                                     "front",
                                                     "dominated by",
                                                     "front in wall time",
                                                     "dominated in wall time by"};
      return names;
    }


    Json line_of(const WorkResults &results, const std::size_t k)
    {
      const WorkRow &row  = results.rows[k];
      const auto     name = [&](const std::size_t by) {
        return by == no_point ? Json("") : Json(results.rows[by].name);
      };
      const std::size_t by = results.dominated_by[k], by_in_time = results.dominated_in_time[k];
      return {{"name", row.name},
              {"family", row.family->name},
              {"model", row.family->model},
              {"cells", to_text(row.cells)},
              {"node spacing", row.spacing},
              {"unknowns", row.unknowns},
              {"bonds", row.bonds},
              {"nonzeros", row.nonzeros},
              {"nonzeros applied", row.applied},
              {"iterations", row.iterations},
              {"operator applications", row.applications},
              {"work", row.work},
              {"error", row.error},
              {"set-up time", row.set_up},
              {"solution time", row.solve},
              {"wall time", row.wall_time},
              {"memory", row.memory},
              {"peak memory", row.peak_memory},
              {"front", by == no_point},
              {"dominated by", name(by)},
              {"front in wall time", by_in_time == no_point},
              {"dominated in wall time by", name(by_in_time)}};
    }


    double order_of(const WorkResults &results, const std::vector<std::size_t> &some)
    {
      std::vector<double> spacings, errors;
      for (const std::size_t k : some)
        {
          spacings.push_back(results.rows[k].spacing);
          errors.push_back(results.rows[k].error);
        }
      return observed_order(spacings, errors);
    }


    Json cost_entry(const CostAtError &cost)
    {
      static const char *const kinds[] = {"interpolated", "extrapolated", "at most", "none"};
      Json                     entry   = {{"kind", kinds[static_cast<int>(cost.kind)]}};
      if (cost.kind != Kind::none)
        entry["cost"] = cost.cost;
      if (cost.kind == Kind::extrapolated)
        entry["finest error over target"] = cost.beyond;
      return entry;
    }


    Json describe_family(const WorkResults              &results,
                         const WorkFamily               &family,
                         const std::vector<std::size_t> &some)
    {
      Json entry = {{"name", family.name}, {"model", family.model}};
      for (const Setting &setting : family.settings)
        entry["set"][setting.first] = setting.second;
      entry["observed order"] = number(order_of(results, some));
      for (const std::size_t k : some)
        entry["rows"].push_back(results.rows[k].name);
      for (const double error : target_errors)
        entry["at error"].push_back(
          {{"error", error},
           {"work", cost_entry(cost_at_error(results.points(some, false), error))},
           {"wall time", cost_entry(cost_at_error(results.points(some, true), error))}});
      return entry;
    }


    Json describe_reference(const WorkPlan &plan, const WorkReference &reference)
    {
      if (reference.exact)
        return {{"kind", "exact solution"}};
      Json entry = {{"kind",
                     reference.cracked ?
                       "finite elements with the cracks on cell faces, extrapolated" :
                       "finite elements of degree 2, extrapolated"}};
      for (const CellCounts &cells : plan.reference)
        entry["cells"].push_back(to_text(cells));
      entry["observed order"] = number(reference.observed_order);
      entry["order"]          = reference.order;
      entry["own error"]      = reference.own_error;
      return entry;
    }


    Json names_of_rows(const WorkResults &results, const std::vector<std::size_t> &some)
    {
      Json names = Json::array();
      for (const std::size_t k : some)
        names.push_back(results.rows[k].name);
      return names;
    }


    std::string reference_line(const WorkPlan &plan, const WorkReference &reference)
    {
      if (reference.exact)
        return "Errors against the exact solution.";
      std::string lattices;
      for (const CellCounts &cells : plan.reference)
        lattices += (lattices.empty() ? "" : ", ") + lattice_name(cells);
      return (reference.cracked ? "Errors against finite elements with the cracks on cell faces, " :
                                  "Errors against finite elements of degree 2, ") +
             lattices + " cells, extrapolated" +
             formatted(" with order %.3g (observed: %s); own error %.1e.",
                       reference.order,
                       std::isfinite(reference.observed_order) ?
                         formatted("%.2f", reference.observed_order).c_str() :
                         "none",
                       reference.own_error);
    }


    std::string percent(const double error)
    {
      return formatted("%g %%", 100. * error);
    }


    /** What a given error costs each family, cheapest first. */
    std::string report_target(const WorkResults &results, const double error)
    {
      struct Line
      {
        const WorkFamily *family;
        CostAtError       work, time;
      };
      std::vector<Line> lines;
      std::string       none;
      for (const WorkFamily &family : work_families())
        {
          const auto some = results.of_family(family);
          if (some.empty())
            continue;
          const Line line = {&family,
                             cost_at_error(results.points(some, false), error),
                             cost_at_error(results.points(some, true), error)};
          if (line.work.kind != Kind::none)
            lines.push_back(line);
          else
            none += (none.empty() ? "" : "; ") + family.name;
        }
      std::stable_sort(lines.begin(), lines.end(), [](const Line &a, const Line &b) {
        return a.work.cost < b.work.cost;
      });
      std::string text =
        "\nAt an error of " + percent(error) +
        " (interpolated along each family; < the coarsest lattice is better already; * extrapolated, finest "
        "error as given)\n        work  relative   wall time  family\n";
      for (const Line &line : lines)
        {
          const auto mark = [](const CostAtError &cost) {
            return cost.kind == Kind::extrapolated ? '*' : cost.kind == Kind::at_most ? '<' : ' ';
          };
          text += formatted("  %c%9.3g %9.3g  ",
                            mark(line.work),
                            line.work.cost,
                            line.work.cost / lines.front().work.cost);
          text += (line.time.kind == Kind::none ?
                     std::string("        -  ") :
                     formatted("%c%7.3g s ", mark(line.time), line.time.cost)) +
                  " " + line.family->name;
          if (line.work.kind == Kind::extrapolated)
            text += " (" + percent(std::round(line.work.beyond * error * 1e5) / 1e5) + ")";
          text += "\n";
        }
      return text + (none.empty() ? "" : "  not seen, or too far to extrapolate: " + none + "\n");
    }
  } // namespace


  namespace
  {
    /** Lines as objects with these keys; what a line does not have stays empty. */
    std::string csv_of(const std::vector<std::string> &header, const std::vector<Json> &lines)
    {
      std::string text;
      for (std::size_t c = 0; c < header.size(); ++c)
        text += (c > 0 ? "," : "") + header[c];
      for (const Json &line : lines)
        {
          text += "\n";
          for (std::size_t c = 0; c < header.size(); ++c)
            {
              const Json value = line.value(header[c], Json());
              text += std::string(c > 0 ? "," : "") +
                      (value.is_null()         ? "" :
                       value.is_string()       ? "\"" + value.get<std::string>() + "\"" :
                       value.is_number_float() ? full_precision(value.get<double>()) :
                                                 value.dump());
            }
        }
      return text + "\n";
    }


    Json pick_entry(const WorkPick &pick)
    {
      return {{"name", pick.name},
              {"tolerance", pick.tolerance},
              {"error", number(pick.error)},
              {"estimate", pick.estimate},
              {"met", pick.met},
              {"wall time", pick.wall_time},
              {"tries", pick.tries},
              {"model", pick.model},
              {"settings", pick.settings}};
    }


    Json entry_in_time(const TimeRow &row)
    {
      return {{"name", row.name},
              {"stepper", row.stepper},
              {"tolerance", row.tolerance > 0. ? Json(row.tolerance) : Json()},
              {"steps", row.steps},
              {"iterations", row.iterations},
              {"operator applications", row.applications},
              {"work", row.work},
              {"error", number(row.error)},
              {"wall time", row.wall_time}};
    }


    std::string report_picks(const WorkPlan &plan, const WorkResults &results)
    {
      if (!plan.no_picks.empty())
        return "\nModels = auto: no choice. " + plan.no_picks + "\n";
      if (results.picks.empty())
        return "";
      std::string text = "\nModels = auto\n  asked for     error  estimate  wall "
                         "time  tries  choice\n";
      for (const WorkPick &pick : results.picks)
        text += formatted("  %9.0e %9.2e %9.2e %8.3g s %6zu  %s: %s\n",
                          pick.tolerance,
                          pick.error,
                          pick.estimate,
                          pick.wall_time,
                          pick.tries,
                          pick.model.c_str(),
                          pick.settings.substr(0, 200).c_str());
      return text;
    }


    std::string report_in_time(const WorkResults &results)
    {
      if (results.in_time.empty())
        return "";
      std::string text = "\nError in time alone, " + results.method_in_time +
                         formatted(" (error in space: %.2e)\n", results.error_in_space) +
                         "      work     error  wall time   steps  stepper\n";
      for (const TimeRow &row : results.in_time)
        text += formatted("  %8.3g %9.2e %7.3g s %8llu  %s\n",
                          row.work,
                          row.error,
                          row.wall_time,
                          row.steps,
                          row.name.c_str());
      return text;
    }
  } // namespace


  std::string work_csv(const WorkResults &results)
  {
    std::vector<Json> lines;
    for (std::size_t k = 0; k < results.rows.size(); ++k)
      lines.push_back(line_of(results, k));
    for (const WorkPick &pick : results.picks)
      lines.push_back({{"name", pick.name},
                       {"family", "auto"},
                       {"model", pick.model},
                       {"error", pick.error},
                       {"wall time", pick.wall_time},
                       {"tolerance", pick.tolerance}});
    return csv_of(columns(), lines);
  }


  std::string in_time_csv(const WorkResults &results)
  {
    std::vector<Json> lines;
    for (const TimeRow &row : results.in_time)
      lines.push_back(entry_in_time(row));
    return csv_of({"name",
                   "stepper",
                   "tolerance",
                   "steps",
                   "iterations",
                   "operator applications",
                   "work",
                   "error",
                   "wall time"},
                  lines);
  }


  std::string work_json(const Study &study, const WorkPlan &plan, const WorkResults &results)
  {
    Json json;
    json["title"]                       = study.title;
    json["text"]                        = study.text;
    json["scene"]                       = study.rows.front().scene;
    json["program"]                     = std::string("PeriDeal ") + PERIDEAL_VERSION;
    static const char *const measures[] = {"field", "opening", "stress intensity"};
    json["measure"]                     = measures[static_cast<int>(plan.measure)];
    json["steady"]                      = results.steady;
    json["work"]                        = results.steady ? "nonzeros applied x iterations" :
                                                           "nonzeros applied x operator applications";
    json["reference"]                   = describe_reference(plan, results.reference);
    json["left out"]                    = plan.left_out;
    for (const std::string &name : results.without)
      json["left out"].push_back(name + ": no such number can be found on it.");
    json["columns"] = columns();
    json["rows"]    = Json::array();
    for (std::size_t k = 0; k < results.rows.size(); ++k)
      json["rows"].push_back(line_of(results, k));
    json["front"]              = names_of_rows(results, results.front(false));
    json["front in wall time"] = names_of_rows(results, results.front(true));
    json["families"]           = Json::array();
    for (const WorkFamily &family : work_families())
      if (const auto some = results.of_family(family); !some.empty())
        json["families"].push_back(describe_family(results, family, some));
    json["picks"] = Json::array();
    for (const WorkPick &pick : results.picks)
      json["picks"].push_back(pick_entry(pick));
    json["no picks"] = plan.no_picks;
    if (!results.in_time.empty())
      {
        json["in time"] = {{"method", results.method_in_time},
                           {"error in space", number(results.error_in_space)},
                           {"rows", Json::array()}};
        for (const TimeRow &row : results.in_time)
          json["in time"]["rows"].push_back(entry_in_time(row));
      }
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
  }


  std::string work_report(const WorkPlan &plan, const WorkResults &results)
  {
    std::string text = "\n" + reference_line(plan, results.reference) + "\n";
    const auto  n_uncertain =
      std::count_if(results.rows.begin(), results.rows.end(), [&](const WorkRow &row) {
        return row.error < 3. * results.reference.own_error;
      });
    if (n_uncertain > 0)
      text += "Less than three times that are the errors of " + std::to_string(n_uncertain) +
              (n_uncertain == 1 ? " setting, which is" : " settings, which are") +
              " uncertain: --reference takes finer lattices.\n";
    for (const std::string &sentence : plan.left_out)
      text += "Left out: " + sentence + "\n";
    for (const std::string &name : results.without)
      text += "Left out: " + name + ": no such number can be found on it.\n";
    const std::string work = results.steady ? "nonzeros x iterations" :
                                              "nonzeros x operator applications";
    text += "\nPareto front (work: " + work + ")\n      work     error  wall time  setting\n";
    for (const std::size_t k : results.front(false))
      text += formatted("  %8.3g %9.2e %7.3g s  %s\n",
                        results.rows[k].work,
                        results.rows[k].error,
                        results.rows[k].wall_time,
                        results.rows[k].name.c_str());
    text += "\nDominated (x: work over that of the cheapest setting that is as good)\n"
            "      work     error       x  setting < by\n";
    for (std::size_t k = 0; k < results.rows.size(); ++k)
      if (const std::size_t by = results.dominated_by[k]; by != no_point)
        text += formatted("  %8.3g %9.2e %7.3g  %s < %s\n",
                          results.rows[k].work,
                          results.rows[k].error,
                          results.rows[k].work / results.rows[by].work,
                          results.rows[k].name.c_str(),
                          results.rows[by].name.c_str());
    text += report_picks(plan, results) + report_in_time(results);
    for (const double error : target_errors)
      text += report_target(results, error);
    return text;
  }
} // namespace PeriDeal
