// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "work_plan.h"

#include <perideal/base/progress.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  namespace
  {
    bool has_cracks(const Comparison comparison)
    {
      return comparison == Comparison::cracks || comparison == Comparison::solid_cracks;
    }


    /**
     * The lattices of the reference: three, each twice as fine as the one before, with the cracks
     * on faces.
     */
    std::vector<CellCounts> reference_lattices(const CrackedBox              &box,
                                               const std::vector<CellCounts> &ladder,
                                               const std::string             &given)
    {
      if (!given.empty())
        {
          const auto lattices = parse_ladder(given, "--reference", box.dim(), 3);
          bool       fits     = lattices.size() == 3;
          for (std::size_t k = 0; k < lattices.size(); ++k)
            {
              const auto on_faces = nearest_fitting(box, lattices[k], true, 1);
              fits                = fits && on_faces && *on_faces == lattices[k];
              for (unsigned int d = 0; d < box.dim() && k > 0; ++d)
                fits = fits && lattices[k][d] == 2 * lattices[k - 1][d];
            }
          AssertThrow(
            fits,
            UserError(
              "command line: --reference '" + given +
              "': needs three lattices, each with twice the cells of the one before, on whose cell "
              "faces all cracks lie."));
          return lattices;
        }
      // The finest is six times as fine as the finest of the study, in 3D twice; of degree 2, where
      // there are no cracks, twice, in 3D as fine.
      const double factor = box.cracks.empty() ? (box.dim() == 3 ? 0.25 : 0.5) :
                            box.dim() == 2     ? 1.5 :
                                                 0.5;
      const auto   finest = nearest_fitting(box, ladder.back(), true, 1);
      CellCounts   coarsest;
      for (const unsigned int n : finest.value_or(ladder.back()))
        coarsest.push_back(std::max(2u, static_cast<unsigned int>(std::lround(factor * n))));
      const auto fitting = nearest_fitting(box, coarsest, true, 1);
      if (!fitting)
        return {};
      std::vector<CellCounts> lattices(3, *fitting);
      for (std::size_t k = 1; k < 3; ++k)
        for (unsigned int d = 0; d < box.dim(); ++d)
          lattices[k][d] = 2 * lattices[k - 1][d];
      return lattices;
    }


    void add_rows(WorkPlan         &plan,
                  const CrackedBox &box,
                  const WorkFamily &family,
                  const bool        moving_cracks,
                  const double      budget)
    {
      const std::string why =
        ": no similar lattice" +
        (family.multiple > 1 ? " divisible by " + std::to_string(family.multiple) : std::string()) +
        (!family.on_faces     ? "." :
         family.multiple == 1 ? " has all cracks on cell faces." :
                                " has all cracks on faces of the largest cells.");
      const CellCounts *last = nullptr;
      for (const CellCounts &rung : plan.ladder)
        {
          const auto cells = nearest_fitting(box, rung, family.on_faces, family.multiple);
          if (!cells || (family.on_faces && moving_cracks))
            {
              plan.left_out.push_back(
                family.name + ", near " + lattice_name(rung) +
                (moving_cracks && family.on_faces ? ": the cracks grow." : why));
              continue;
            }
          if (last != nullptr && *cells == *last)
            continue;
          const double n_bonds = family.ratio > 0. ? estimated_bonds(box, *cells, family.ratio) :
                                                     0.;
          if (n_bonds > budget)
            {
              plan.left_out.push_back(family.name + ", " + lattice_name(*cells) + ": about " +
                                      readable_count(static_cast<unsigned long long>(n_bonds)) +
                                      " bonds, more than --budget " + number_text(budget) + ".");
              continue;
            }
          plan.rows.push_back({family.name + ", " + lattice_name(*cells),
                               WorkPlan::Role::method,
                               &family,
                               *cells,
                               family.settings,
                               "",
                               0.});
          last = &plan.rows.back().cells;
        }
    }


    /** Vertices on a crack have two values: where it runs along them, one more cell has none. */
    CellCounts beside_cracks(const CrackedBox &box, CellCounts cells)
    {
      for (const auto &crack : box.cracks)
        for (unsigned int d = 0; d < box.dim(); ++d)
          {
            const double length = box.upper[d] - box.lower[d];
            const double s      = (crack[0][d] - box.lower[d]) / length * cells[d];
            const bool   along  = std::all_of(crack.begin(), crack.end(), [&](const auto &corner) {
              return std::abs(corner[d] - crack[0][d]) <= 1e-9 * length;
            });
            if (along && std::abs(s - std::round(s)) < 1e-7)
              ++cells[d];
          }
      return cells;
    }


    /** Nine points along each crack, a spacing of the coarsest lattice to the right and left. */
    std::string beside_sides(const CrackedBox &box, const CellCounts &coarsest)
    {
      double off = 0.;
      for (unsigned int d = 0; d < 2; ++d)
        off = std::max(off, (box.upper[d] - box.lower[d]) / coarsest[d]);
      std::string text;
      for (const auto &crack : box.cracks)
        for (unsigned int k = 1; k < 10; ++k)
          for (const double side : {off, -off})
            {
              const double s = 0.1 * k, along_x = crack[1][0] - crack[0][0],
                           along_y = crack[1][1] - crack[0][1];
              const double length  = std::hypot(along_x, along_y);
              text += (text.empty() ? "" : " ; ") +
                      number_text(crack[0][0] + s * along_x + side * along_y / length) + ", " +
                      number_text(crack[0][1] + s * along_y - side * along_x / length);
            }
      return text;
    }


    void require_measure(const WorkScene &scene, const WorkMeasure measure)
    {
      AssertThrow(measure == WorkMeasure::field ||
                    (scene.comparison == Comparison::solid_cracks && scene.box.dim() == 2),
                  UserError("command line: --measure: 'opening' and 'stress "
                            "intensity' are of cracks in "
                            "elastic bodies, in two dimensions. Use 'field'."));
    }


    void add_picks(WorkPlan &plan, const WorkScene &scene)
    {
      plan.no_picks = scene.no_choice;
      if (!scene.no_choice.empty())
        return;
      const bool        at_ends  = plan.measure == WorkMeasure::stress_intensity;
      const std::string measure  = at_ends ? "stress intensity" : "field";
      const CellCounts  compared = beside_cracks(scene.box, plan.ladder.back());
      for (const char *const tolerance : {"3e-2", "1e-2", "1e-3"})
        for (const WorkPlan::Role role : {WorkPlan::Role::pick, WorkPlan::Role::pick_values})
          plan.rows.push_back({std::string("auto, ") + tolerance +
                                 (role == WorkPlan::Role::pick_values ? ", values" : ""),
                               role,
                               nullptr,
                               compared,
                               {{"Models", "auto"},
                                {"Peridynamics/Horizon", ""}, // the classical solution, as all
                                {"Accuracy/Measure", measure},
                                {"Accuracy/Tolerance", tolerance}},
                               "",
                               std::stod(tolerance)});
    }


    /**
     * One method on the finest lattice but one with all steppers; those with fixed steps take the
     * largest that are stable.
     */
    void add_steppers(WorkPlan &plan, const WorkScene &scene)
    {
      const std::string wanted = has_cracks(scene.comparison) ? "FEM, pairs, scaled" :
                                                                "FEM, degree 1";
      const auto        family =
        std::find_if(work_families().begin(), work_families().end(), [&](const WorkFamily &one) {
          return one.comparison == scene.comparison && one.name == wanted;
        });
      const CellCounts cells = plan.ladder[plan.ladder.size() - 2];
      const auto       add   = [&](const std::string   &name,
                           const WorkPlan::Role role,
                           const std::string   &stepper,
                           const std::string   &tolerance) {
        WorkPlan::Row row = {name, role, &*family, cells, family->settings, stepper, 0.};
        row.settings.emplace_back("Time/Stepper", stepper);
        row.settings.emplace_back("Time/Time step", "auto");
        if (!tolerance.empty())
          {
            row.settings.emplace_back("Time/Tolerance", tolerance);
            row.tolerance = std::stod(tolerance);
          }
        plan.rows.push_back(row);
      };
      add("in time: reference", WorkPlan::Role::exact_in_time, "auto", "1e-9");
      for (const char *const stepper : {"euler", "rk4"})
        add(std::string("in time: ") + stepper, WorkPlan::Role::in_time, stepper, "");
      for (const char *const stepper : {"rkc2", "chebyshev", "crank nicolson", "bdf2", "sdirk2"})
        for (const char *const tolerance : {"1e-2", "1e-3", "1e-4", "1e-5"})
          add(std::string("in time: ") + stepper + ", " + tolerance,
              WorkPlan::Role::in_time,
              stepper,
              tolerance);
    }


    void add_reference(WorkPlan &plan, const WorkScene &scene, const std::string &given)
    {
      AssertThrow(scene.comparison != Comparison::motion,
                  UserError("work_precision has nothing to compare a motion with: "
                            "'Solution' in section "
                            "'Reference' is empty. Give the exact solution."));
      if (!scene.moving_cracks)
        plan.reference = reference_lattices(scene.box, plan.ladder, given);
      AssertThrow(
        !plan.reference.empty(),
        UserError(
          std::string(
            "work_precision has nothing to compare with: 'Solution' in section 'Reference' is empty, and "
            "no reference can be computed by finite elements with the cracks on cell faces, because ") +
          (scene.moving_cracks ?
             "the cracks grow" :
           !along_axes(scene.box) ?
             "not all cracks run along the axes" :
             "no lattice of similar cells has the ends of all cracks on its vertices") +
          ". Give the exact solution."));
      // As the finite elements it is compared with, without cracks of degree 2.
      const auto family =
        std::find_if(work_families().begin(), work_families().end(), [&](const WorkFamily &one) {
          return one.comparison == scene.comparison &&
                 (has_cracks(scene.comparison) || one.name == "FEM, degree 2");
        });
      for (const CellCounts &lattice : plan.reference)
        plan.rows.push_back({"reference, " + lattice_name(lattice),
                             WorkPlan::Role::reference,
                             nullptr,
                             lattice,
                             family->settings,
                             "",
                             0.});
    }
  } // namespace


  WorkMeasure parse_measure(const std::string &text)
  {
    const std::vector<std::string> words = {"field", "opening", "stress intensity"};
    const auto                     found = std::find(words.begin(), words.end(), text);
    AssertThrow(found != words.end(),
                UserError("command line: --measure '" + text +
                          "': needs one of field, opening, stress "
                          "intensity." +
                          did_you_mean(text, words)));
    return static_cast<WorkMeasure>(found - words.begin());
  }


  WorkPlan plan_work(const WorkScene &scene, const WorkWishes &wishes)
  {
    constexpr unsigned int n_rungs = 4;
    const CrackedBox      &box     = scene.box;
    WorkPlan               plan;
    plan.ladder = wishes.cells.empty() ? default_ladder(box.cells, n_rungs) :
                                         parse_ladder(wishes.cells, "--cells", box.dim(), 2);
    AssertThrow(
      plan.ladder.size() >= 2,
      UserError("work_precision needs at least two lattices, but 'Cells' in section 'Domain', " +
                to_text(box.cells) +
                ", is too coarse to be halved. Give more cells, or name lattices with --cells."));
    AssertThrow(
      !scene.exact || wishes.reference.empty() || wishes.measure == WorkMeasure::stress_intensity,
      UserError("command line: --reference: the scene has a 'Solution' in section 'Reference', "
                "with which it is compared."));
    require_measure(scene, wishes.measure);
    plan.measure = wishes.measure;
    if (plan.measure == WorkMeasure::opening)
      plan.probes = beside_sides(box, plan.ladder.front());
    if (!scene.exact || plan.measure == WorkMeasure::stress_intensity)
      add_reference(plan, scene, wishes.reference);
    for (const WorkFamily &one : work_families())
      if (plan.measure == WorkMeasure::stress_intensity && one.comparison == scene.comparison &&
          one.model == "peridynamics")
        plan.left_out.push_back(one.name + ": no stress intensities.");
      else if (one.comparison == scene.comparison && (scene.given_zone || !one.given_zone))
        add_rows(plan, box, one, scene.moving_cracks, wishes.budget);
    if (wishes.picks)
      add_picks(plan, scene);
    if (!scene.steady &&
        (scene.comparison == Comparison::cracks || scene.comparison == Comparison::field))
      add_steppers(plan, scene);
    return plan;
  }
} // namespace PeriDeal
