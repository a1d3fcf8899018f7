// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "work_families.h"

#include <perideal/base/progress.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  namespace
  {
    const char *const elements = "finite elements", *const bonds = "peridynamics",
                      *const coupled = "coupled";

    WorkFamily family(const std::string &name,
                      const std::string &model,
                      const std::string &mesh,
                      const std::string &correction)
    {
      WorkFamily result;
      result.name     = name;
      result.model    = model;
      result.settings = {{"Models", model},
                         {"Cracks/Mesh", mesh},
                         {"Peridynamics/Surface correction", correction},
                         {"Peridynamics/Boundary treatment", "auto"},
                         {"Peridynamics/Horizon", ""},
                         {"Coupling/Zone", "cracks: 1"},
                         {"Coupling/Adaptive tolerance", "0.02"},
                         {"Domain/Coarsening", "0"},
                         {"Domain/Fine where", "auto"}};
      result.on_faces = mesh == "faces";
      return result;
    }


    void set_entry(WorkFamily &family, const std::string &entry, const std::string &value)
    {
      for (Setting &setting : family.settings)
        if (setting.first == entry)
          {
            setting.second = value;
            return;
          }
      family.settings.emplace_back(entry, value);
    }


    WorkFamily whole_body(const std::string &kind,
                          const std::string &ratio,
                          const std::string &treatment,
                          const std::string &correction)
    {
      WorkFamily result = family("PD " + kind + ", m = " + ratio, bonds, "pairs", correction);
      set_entry(result, "Peridynamics/Boundary treatment", treatment);
      set_entry(result, "Peridynamics/Horizon ratio", ratio);
      result.ratio = std::stod(ratio);
      return result;
    }


    WorkFamily zone(const std::string &ratio, const std::string &width, const bool scaled)
    {
      WorkFamily result =
        family("coupled, m = " + ratio + ", c = " + width + (scaled ? ", scaled" : ""),
               coupled,
               "pairs",
               scaled ? "crack scaling" : "none");
      set_entry(result, "Peridynamics/Horizon ratio", ratio);
      set_entry(result, "Coupling/Zone", "cracks: " + width);
      return result;
    }


    /** The crack is part of the surface: no bond is broken, and there is nothing to be scaled. */
    WorkFamily zone_on_faces(const std::string &width)
    {
      WorkFamily result = family("coupled on faces, m = 3, c = " + width, coupled, "faces", "none");
      set_entry(result, "Peridynamics/Horizon ratio", "3");
      set_entry(result, "Coupling/Zone", "cracks: " + width);
      return result;
    }


    /**
     * The same on meshes whose cells are merged up to k times away from cracks; those of finite
     * elements alone are as for m = 3, c = 1.
     */
    WorkFamily graded(WorkFamily family, const unsigned int k)
    {
      family.name += ", graded " + std::to_string(k);
      family.multiple = 1u << k;
      set_entry(family, "Domain/Coarsening", std::to_string(k));
      if (family.model == elements)
        set_entry(family, "Peridynamics/Horizon ratio", "3");
      return family;
    }


    std::vector<WorkFamily> make_families()
    {
      std::vector<WorkFamily> all = {
        family("FEM, crack on faces", elements, "faces", "none"),
        family("FEM, pairs", elements, "pairs", "none"),
        family("FEM, pairs, scaled", elements, "pairs", "crack scaling"),
        family("FEM, cells removed", elements, "removed", "none")};
      for (const char *const m : {"2", "3", "4", "6.5"})
        {
          all.push_back(whole_body("raw", m, "none", "none"));
          all.push_back(whole_body("energy-corrected", m, "none", "energy"));
          all.push_back(whole_body("exchange", m, "exchange", "none"));
          all.push_back(whole_body("exchange, scaled", m, "exchange", "crack scaling"));
        }
      for (const char *const m : {"2", "3"})
        for (const char *const c : {"0.5", "1", "2"})
          for (const bool scaled : {false, true})
            all.push_back(zone(m, c, scaled));
      all.push_back(zone_on_faces("1"));
      for (const unsigned int k : {2u, 3u})
        for (const WorkFamily &uniform :
             {family("FEM, crack on faces", elements, "faces", "none"),
              family("FEM, pairs, scaled", elements, "pairs", "crack scaling"),
              zone("2", "1", true),
              zone("3", "0.5", true),
              zone("3", "1", true),
              zone_on_faces("0.5"),
              zone_on_faces("1")})
          all.push_back(graded(uniform, k));
      return all;
    }


    /** Cells that a crack cuts carry nothing, or the crack is part of the surface. */
    std::vector<WorkFamily> families_of_bodies()
    {
      std::vector<WorkFamily> all = {family("FEM, crack on faces", elements, "faces", "none"),
                                     family("FEM, cells removed", elements, "removed", "none")};
      for (const char *const m : {"2", "3", "4", "6.5"})
        {
          all.push_back(whole_body("cut at sides", m, "none", "none"));
          all.push_back(whole_body("energy-corrected", m, "none", "energy"));
          all.push_back(whole_body("completed", m, "auto", "auto"));
        }
      for (const char *const m : {"2", "3"})
        for (const char *const c : {"0.5", "1", "2"})
          for (const bool scaled : {false, true})
            all.push_back(zone(m, c, scaled));
      for (const unsigned int k : {2u, 3u})
        for (const WorkFamily &uniform : {family("FEM, crack on faces", elements, "faces", "none"),
                                          zone("2", "1", true),
                                          zone("3", "1", true)})
          all.push_back(graded(uniform, k));
      for (WorkFamily &one : all)
        {
          one.deforms = true;
          if (!one.on_faces)
            set_entry(one, "Cracks/Mesh", "removed");
        }
      return all;
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
      // The finest is six times as fine as the finest of the study, in 3D twice.
      const double factor = box.dim() == 2 ? 1.5 : 0.5;
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
          plan.rows.push_back({family.name + ", " + lattice_name(*cells), &family, *cells});
          last = &plan.rows.back().cells;
        }
    }
  } // namespace


  const std::vector<WorkFamily> &work_families()
  {
    static const std::vector<WorkFamily> families = [] {
      std::vector<WorkFamily> all = make_families(), of_bodies = families_of_bodies();
      all.insert(all.end(), of_bodies.begin(), of_bodies.end());
      return all;
    }();
    return families;
  }


  WorkPlan plan_work(const CrackedBox  &box,
                     const bool         deforms,
                     const bool         exact,
                     const bool         moving_cracks,
                     const std::string &cells,
                     const std::string &reference,
                     const double       budget)
  {
    constexpr unsigned int n_rungs = 4;
    WorkPlan               plan;
    plan.ladder = cells.empty() ? default_ladder(box.cells, n_rungs) :
                                  parse_ladder(cells, "--cells", box.dim(), 2);
    AssertThrow(
      plan.ladder.size() >= 2,
      UserError("work_precision needs at least two lattices, but 'Cells' in section 'Domain', " +
                to_text(box.cells) +
                ", is too coarse to be halved. Give more cells, or name lattices with --cells."));
    AssertThrow(
      !exact || reference.empty(),
      UserError("command line: --reference: the scene has a 'Solution' in section 'Reference', "
                "with which it is compared."));
    if (!exact)
      {
        if (!moving_cracks)
          plan.reference = reference_lattices(box, plan.ladder, reference);
        AssertThrow(
          !plan.reference.empty(),
          UserError(
            std::string(
              "work_precision has nothing to compare with: 'Solution' in section 'Reference' is empty, and "
              "no reference can be computed by finite elements with the cracks on cell faces, because ") +
            (moving_cracks ?
               "the cracks grow" :
             !along_axes(box) ?
               "not all cracks run along the axes" :
               "no lattice of similar cells has the ends of all cracks on its vertices") +
            ". Give the exact solution."));
        for (const CellCounts &lattice : plan.reference)
          plan.rows.push_back({"reference, " + lattice_name(lattice), nullptr, lattice});
      }
    for (const WorkFamily &one : work_families())
      if (one.deforms == deforms)
        add_rows(plan, box, one, moving_cracks, budget);
    return plan;
  }
} // namespace PeriDeal
