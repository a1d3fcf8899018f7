// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "work_evaluation.h"

#include <perideal/base/user_error.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>

#include "work_numbers.h"

namespace PeriDeal
{
  namespace
  {
    using Json   = RowResult::Json;
    using Status = RowResult::Status;
    using Role   = WorkPlan::Role;

    std::vector<std::string> cells_of(const std::string &line)
    {
      std::vector<std::string> cells;
      std::istringstream       in(line);
      for (std::string cell; std::getline(in, cell, ',');)
        cells.push_back(cell);
      return cells;
    }


    /** Of grid.csv, those that are the unknown: `value`, or the components of a displacement. */
    std::vector<std::size_t> columns_of_unknown(const std::vector<std::string> &header)
    {
      std::vector<std::size_t> columns;
      for (std::size_t k = 0; k < header.size(); ++k)
        for (const char *const name : {"value", "ux", "uy", "uz"})
          if (header[k] == name)
            columns.push_back(k);
      return columns;
    }


    /** The values of one model in grid.csv at the last time, all components of a point together. */
    std::vector<double> read_grid(const CheckedRow &row, const std::string &model)
    {
      std::ifstream       in(row.folder + "/grid.csv");
      std::vector<double> values;
      std::string         time, head;
      std::getline(in, head);
      const std::vector<std::size_t> columns = columns_of_unknown(cells_of(head));
      for (std::string line; std::getline(in, line);)
        {
          const std::size_t first = line.find(','), second = line.find(',', first + 1);
          if (second == std::string::npos ||
              line.compare(first + 1, second - first - 1, model) != 0)
            continue;
          if (line.compare(0, first, time) != 0)
            {
              values.clear();
              time = line.substr(0, first);
            }
          const std::vector<std::string> cells = cells_of(line);
          for (const std::size_t k : columns)
            values.push_back(std::strtod(k < cells.size() ? cells[k].c_str() : "", nullptr));
        }
      AssertThrow(!values.empty(),
                  UserError("work_precision: '" + row.folder + "/grid.csv' of the row '" +
                            row.row.name + "' cannot be read. Compute it again with --redo."));
      return values;
    }


    std::size_t n_vertices(const CellCounts &cells)
    {
      std::size_t n = 1;
      for (const unsigned int count : cells)
        n *= count + 1;
      return n;
    }


    /** Values of the limit at the vertices of all lattices. */
    using LatticeValues = std::map<CellCounts, std::vector<double>>;

    LatticeValues split(const std::vector<double> &values, const std::vector<CellCounts> &lattices)
    {
      LatticeValues parts;
      std::size_t   n_points = 0;
      for (const CellCounts &cells : lattices)
        n_points += n_vertices(cells);
      auto begin = values.begin();
      for (const CellCounts &cells : lattices)
        {
          const auto end =
            begin + static_cast<std::ptrdiff_t>(n_vertices(cells) * (values.size() / n_points));
          parts[cells].assign(begin, end);
          begin = end;
        }
      return parts;
    }


    /**
     * Near a crack's end finite elements are of first order at the nodes, without one of second:
     * such an order is taken for what it is.
     */
    double likely_order(const double observed)
    {
      return std::abs(observed - 1.) < 0.15 ? 1. : std::abs(observed - 2.) < 0.15 ? 2. : observed;
    }


    void require_reference(const WorkPlan::Row &planned, const RowResult &result)
    {
      AssertThrow(
        result.status == Status::finished,
        UserError("work_precision: the row '" + planned.name +
                  "' is not there, and without the reference nothing is known of errors" +
                  (result.message.empty() ? ". Compute it, too: --only has to name 'reference'." :
                                            ": " + result.message)));
    }


    LatticeValues extrapolate(const WorkPlan      &plan,
                              const ComputedStudy &computed,
                              WorkReference       &reference)
    {
      std::vector<std::vector<double>> solutions;
      for (std::size_t k = 0; k < plan.rows.size() && plan.rows[k].role == Role::reference; ++k)
        {
          require_reference(plan.rows[k], computed.results[k]);
          solutions.push_back(read_grid(computed.rows[k], "finite elements"));
        }
      const std::vector<CellCounts> lattices = lattices_of(plan);
      std::size_t                   n_values = 0;
      for (const CellCounts &cells : lattices)
        n_values += n_vertices(cells);
      for (const std::vector<double> &values : solutions)
        AssertThrow(
          values.size() % n_values == 0 && values.size() == solutions[0].size(),
          UserError(
            "work_precision: the reference belongs to other lattices. Compute it again with --redo."));
      const auto difference = [&](const std::vector<double> &a, const std::vector<double> &b) {
        double              worst = 0.;
        const LatticeValues u = split(a, lattices), v = split(b, lattices);
        for (const CellCounts &cells : lattices)
          worst = std::max(worst, nodal_error(u.at(cells), v.at(cells), cells));
        return worst;
      };
      constexpr double round_off = 1e-8; // of solvers: no order is seen in it
      const double     coarse    = difference(solutions[0], solutions[1]),
                   fine          = difference(solutions[1], solutions[2]);
      reference.exact            = false;
      reference.observed_order   = order_of_differences(coarse, fine);
      reference.order            = fine < round_off ? 2. : likely_order(reference.observed_order);
      AssertThrow(
        reference.order > 0.2,
        UserError(
          "work_precision: finite elements on the three lattices of the reference do not converge; observed order " +
          std::to_string(reference.observed_order) + ". Name finer ones with --reference."));
      const auto rough    = richardson(solutions[0], solutions[1], reference.order);
      const auto limit    = richardson(solutions[1], solutions[2], reference.order);
      reference.own_error = difference(rough, limit);
      return split(limit, lattices);
    }


    /**
     * Numbers that one application of the operator multiplies: the entries of a matrix; of bonds
     * that are kept apart what a matrix of them would have, two for each bond and one for each
     * unknown, and what is stored besides.
     */
    unsigned long long applied_nonzeros(const WorkRow &row)
    {
      if (row.form == "matrix")
        return row.nonzeros;
      return row.nonzeros + row.unknowns + (row.form == "lattice" ? 2 * row.bonds : 0);
    }


    WorkRow costs_of(const WorkPlan::Row &planned, const RowResult &result, const bool steady)
    {
      const Json &model  = result.results["models"][planned.family->model];
      const Json &record = result.record["models"][planned.family->model];
      WorkRow     row;
      row.name         = planned.name;
      row.family       = planned.family;
      row.cells        = planned.cells;
      row.form         = model["operator form"].get<std::string>();
      row.unknowns     = model["unknowns"].get<unsigned long long>();
      row.bonds        = model.value("bonds", 0ull);
      row.nonzeros     = model["nonzeros"].get<unsigned long long>();
      row.iterations   = model.value("iterations", 0ull);
      row.applications = model["operator applications"].get<unsigned long long>();
      row.applied      = applied_nonzeros(row);
      row.work         = static_cast<double>(row.applied) *
                 static_cast<double>(steady ? row.iterations : row.applications);
      row.memory      = model.value("memory", 0.);
      row.peak_memory = result.record.value("peak memory", 0.);
      row.set_up      = record["times"]["set-up"].get<double>();
      row.solve       = record["times"]["stepping"].get<double>();
      row.wall_time   = record["times"]["total"].get<double>();
      return row;
    }
  } // namespace


  std::vector<std::size_t> WorkResults::front(const bool in_time) const
  {
    return pareto_front(points(in_time));
  }


  std::vector<std::size_t> WorkResults::of_family(const WorkFamily &family) const
  {
    std::vector<std::size_t> some;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (rows[k].family == &family)
        some.push_back(k);
    return some;
  }


  std::vector<WorkPoint> WorkResults::points(const std::vector<std::size_t> &some,
                                             const bool                      in_time) const
  {
    std::vector<WorkPoint> list;
    for (const std::size_t k : some)
      list.push_back({in_time ? rows[k].wall_time : rows[k].work, rows[k].error});
    return list;
  }


  std::vector<WorkPoint> WorkResults::points(const bool in_time) const
  {
    std::vector<std::size_t> all(rows.size());
    std::iota(all.begin(), all.end(), std::size_t(0));
    return points(all, in_time);
  }


  std::vector<CellCounts> lattices_of(const WorkPlan &plan)
  {
    std::vector<CellCounts> lattices;
    for (const WorkPlan::Row &row : plan.rows)
      if ((row.role == Role::method || row.role == Role::pick_values) &&
          std::find(lattices.begin(), lattices.end(), row.cells) == lattices.end())
        lattices.push_back(row.cells);
    std::sort(lattices.begin(), lattices.end());
    return lattices;
  }


  namespace
  {
    /** The error of one row's values at the vertices of its lattice. */
    double error_of(const WorkPlan::Row &planned,
                    const CheckedRow    &row,
                    const std::string   &model,
                    const LatticeValues &limit)
    {
      const bool                exact    = limit.empty();
      const std::vector<double> values   = read_grid(row, model);
      const std::vector<double> expected = exact ? read_grid(row, "exact") :
                                                   limit.at(planned.cells);
      AssertThrow(values.size() % n_vertices(planned.cells) == 0 &&
                    expected.size() == values.size(),
                  UserError("work_precision: '" + row.folder +
                            "/grid.csv' is not whole. Compute the row again with --redo."));
      return nodal_error(values, expected, planned.cells, exact);
    }


    /** The limit of such numbers. */
    std::vector<double> extrapolate_numbers(const WorkPlan      &plan,
                                            const ComputedStudy &computed,
                                            WorkReference       &reference)
    {
      std::vector<std::vector<double>> solutions;
      for (std::size_t k = 0; k < plan.rows.size() && plan.rows[k].role == Role::reference; ++k)
        {
          require_reference(plan.rows[k], computed.results[k]);
          solutions.push_back(numbers_of(computed.results[k], "finite elements", plan.measure));
          AssertThrow(!solutions.back().empty(),
                      UserError("work_precision: the reference has no stress "
                                "intensities: there is no "
                                "room around the ends of the cracks."));
        }
      reference.exact = false;
      reference.observed_order =
        order_of_differences(relative_difference(solutions[0], solutions[1]),
                             relative_difference(solutions[1], solutions[2]));
      // Where the error is small the numbers do not settle on one order.
      reference.order =
        std::isfinite(reference.observed_order) ? std::clamp(reference.observed_order, 1., 2.) : 1.;
      const auto rough    = richardson(solutions[0], solutions[1], reference.order);
      const auto limit    = richardson(solutions[1], solutions[2], reference.order);
      reference.own_error = relative_difference(rough, limit);
      return limit;
    }


    /** What the error of a row is found from. */
    struct Limit
    {
      LatticeValues       values;
      std::vector<double> numbers;
    };


    /** In the measure of the plan; not a number where a row does not have it. */
    double measured_error(const WorkPlan      &plan,
                          const ComputedStudy &computed,
                          const std::size_t    k,
                          const std::string   &model,
                          const Limit         &limit)
    {
      if (plan.measure == WorkMeasure::field)
        return error_of(plan.rows[k], computed.rows[k], model, limit.values);
      const auto found = numbers_of(computed.results[k], model, plan.measure);
      if (found.empty())
        return std::numeric_limits<double>::quiet_NaN();
      return relative_difference(found,
                                 limit.numbers.empty() ?
                                   numbers_of(computed.results[k], "exact", plan.measure) :
                                   limit.numbers);
    }


    /** "Cells = 16, 16; Degree = 2": what the model takes, but for what is switched off. */
    std::string text_of_settings(const Json &settings, const std::string &model)
    {
      std::vector<std::string> told = {"Domain/Cells",
                                       "Domain/Coarsening",
                                       "Domain/Fine where",
                                       "Cracks/Mesh",
                                       "Peridynamics/Surface correction",
                                       "Time/Tolerance"};
      if (model != "peridynamics")
        told.push_back("Finite elements/Degree");
      if (model != "finite elements")
        told.insert(told.end(), {"Peridynamics/Horizon ratio", "Peridynamics/Boundary treatment"});
      if (model == "coupled")
        told.push_back("Coupling/Zone");
      std::string text;
      for (const std::string &entry : told)
        {
          const std::string value = settings.value(entry, std::string());
          if (!value.empty() && value != "0" && value != "auto" && value != "none")
            text += (text.empty() ? "" : "; ") + entry.substr(entry.find('/') + 1) + " = " + value;
        }
      return text;
    }


    WorkPick pick_of(const WorkPlan::Row &planned, const RowResult &result, const double error)
    {
      const Json &accuracy = result.results["accuracy"];
      WorkPick    pick;
      pick.name      = planned.name;
      pick.tolerance = planned.tolerance;
      pick.error     = error;
      pick.estimate  = accuracy.value("estimate", -1.);
      pick.met       = accuracy.value("met", false);
      pick.wall_time = result.record.value("wall time", 0.);
      pick.tries     = accuracy.contains("steps") ? accuracy["steps"].size() : 0;
      pick.model     = accuracy.value("model", std::string());
      pick.settings  = text_of_settings(accuracy.value("settings", Json::object()), pick.model);
      return pick;
    }


    bool is_finished(const ComputedStudy &computed, const std::size_t k)
    {
      return computed.results[k].status == Status::finished;
    }


    /** Rows in which only the stepper differs, against one that has hardly an error in time. */
    void compare_in_time(const WorkPlan &plan, const ComputedStudy &computed, WorkResults &results)
    {
      std::vector<double> exact;
      for (std::size_t k = 0; k < plan.rows.size(); ++k)
        {
          const WorkPlan::Row &planned = plan.rows[k];
          if (!is_finished(computed, k))
            continue;
          if (planned.role == Role::exact_in_time)
            {
              exact                  = read_grid(computed.rows[k], planned.family->model);
              results.method_in_time = planned.family->name + ", " + lattice_name(planned.cells);
              for (const WorkRow &row : results.rows)
                if (row.family == planned.family && row.cells == planned.cells)
                  results.error_in_space = row.error;
            }
          if (planned.role != Role::in_time || exact.empty())
            continue;
          const WorkRow cost = costs_of(planned, computed.results[k], false);
          TimeRow       row;
          row.name      = planned.name;
          row.stepper   = planned.stepper;
          row.tolerance = planned.tolerance;
          row.steps =
            computed.results[k].results["models"][planned.family->model].value("steps", 0ull);
          row.iterations   = cost.iterations;
          row.applications = cost.applications;
          row.work         = cost.work;
          row.wall_time    = cost.wall_time;
          row.error =
            nodal_error(read_grid(computed.rows[k], planned.family->model), exact, planned.cells);
          results.in_time.push_back(row);
        }
    }
  } // namespace


  WorkResults evaluate_work(const CrackedBox    &box,
                            const WorkPlan      &plan,
                            const ComputedStudy &computed)
  {
    WorkResults results;
    Limit       limit;
    results.reference.cracked = !box.cracks.empty();
    if (!plan.reference.empty() && plan.measure == WorkMeasure::field)
      limit.values = extrapolate(plan, computed, results.reference);
    else if (!plan.reference.empty())
      limit.numbers = extrapolate_numbers(plan, computed, results.reference);
    for (std::size_t k = 0; k < plan.rows.size(); ++k)
      {
        const WorkPlan::Row &planned = plan.rows[k];
        if (!is_finished(computed, k))
          continue;
        if (planned.role == Role::pick_values &&
            is_finished(computed, k - 1)) // before it: its cost
          results.picks.push_back(pick_of(plan.rows[k - 1],
                                          computed.results[k - 1],
                                          measured_error(plan, computed, k, "auto", limit)));
        if (planned.role != Role::method)
          continue;
        results.steady = computed.results[k].results["steady"].get<bool>();
        WorkRow row    = costs_of(planned, computed.results[k], results.steady);
        row.error      = measured_error(plan, computed, k, planned.family->model, limit);
        if (!std::isfinite(row.error))
          {
            results.without.push_back(planned.name);
            continue;
          }
        for (unsigned int d = 0; d < box.dim(); ++d)
          row.spacing = std::max(row.spacing, (box.upper[d] - box.lower[d]) / planned.cells[d]);
        results.rows.push_back(row);
      }
    compare_in_time(plan, computed, results);
    results.dominated_by      = dominating_points(results.points(false));
    results.dominated_in_time = dominating_points(results.points(true));
    return results;
  }
} // namespace PeriDeal
