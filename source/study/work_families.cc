// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "work_families.h"

#include <string>

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
          one.comparison = Comparison::solid_cracks;
          if (!one.on_faces)
            set_entry(one, "Cracks/Mesh", "removed");
        }
      return all;
    }


    /** Without cracks: what there is to be said of a whole body. */
    WorkFamily plain(const std::string &name,
                     const std::string &model,
                     const std::string &treatment  = "auto",
                     const std::string &correction = "none")
    {
      WorkFamily result;
      result.name     = name;
      result.model    = model;
      result.settings = {{"Models", model},
                         {"Finite elements/Degree", "1"},
                         {"Peridynamics/Surface correction", correction},
                         {"Peridynamics/Boundary treatment", treatment},
                         {"Peridynamics/Horizon", ""},
                         {"Domain/Coarsening", "0"},
                         {"Domain/Fine where", "auto"}};
      return result;
    }


    WorkFamily of_degree(const std::string &degree)
    {
      WorkFamily result = plain("FEM, degree " + degree, elements);
      set_entry(result, "Finite elements/Degree", degree);
      return result;
    }


    WorkFamily plain_bonds(const std::string &kind,
                           const std::string &ratio,
                           const std::string &treatment,
                           const std::string &correction)
    {
      WorkFamily result = plain("PD " + kind + ", m = " + ratio, bonds, treatment, correction);
      set_entry(result, "Peridynamics/Horizon ratio", ratio);
      result.ratio = std::stod(ratio);
      return result;
    }


    WorkFamily given_zone(const std::string &ratio)
    {
      WorkFamily result = plain("coupled, m = " + ratio + ", zone of the scene", coupled);
      set_entry(result, "Peridynamics/Horizon ratio", ratio);
      result.given_zone = true;
      return result;
    }


    std::vector<WorkFamily> families_without_cracks(const Comparison comparison)
    {
      std::vector<WorkFamily> all = {of_degree("1"), of_degree("2")};
      for (const char *const m : {"2", "3", "4"})
        if (comparison == Comparison::field)
          {
            all.push_back(plain_bonds("raw", m, "none", "none"));
            all.push_back(plain_bonds("energy-corrected", m, "none", "energy"));
            all.push_back(plain_bonds("exchange", m, "exchange", "none"));
            all.push_back(plain_bonds("mirror", m, "fictitious mirror", "none"));
          }
        else
          {
            all.push_back(plain_bonds("cut at sides", m, "none", "none"));
            all.push_back(plain_bonds("energy-corrected", m, "none", "energy"));
            all.push_back(plain_bonds("completed", m, "auto", "auto"));
          }
      for (const char *const m : {"2", "3"})
        all.push_back(given_zone(m));
      for (WorkFamily &one : all)
        one.comparison = comparison;
      return all;
    }


    /** Explicit steps of three lengths. */
    std::vector<WorkFamily> families_of_motion()
    {
      std::vector<WorkFamily> all;
      for (const char *const courant : {"0.8", "0.4", "0.2"})
        {
          all.push_back(plain("FEM", elements));
          for (const char *const m : {"2", "3", "4"})
            all.push_back(plain_bonds("completed", m, "auto", "auto"));
          for (std::size_t k = all.size() - 4; k < all.size(); ++k)
            {
              all[k].name += std::string(", steps of ") + courant + " cells";
              all[k].courant    = std::stod(courant);
              all[k].comparison = Comparison::motion;
              set_entry(all[k], "Time/Stepper", "verlet");
              set_entry(all[k], "Time/Time step", "auto");
            }
        }
      return all;
    }
  } // namespace


  const std::vector<WorkFamily> &work_families()
  {
    static const std::vector<WorkFamily> families = [] {
      std::vector<WorkFamily> all = make_families();
      for (const auto &more : {families_of_bodies(),
                               families_without_cracks(Comparison::field),
                               families_without_cracks(Comparison::solid),
                               families_of_motion()})
        all.insert(all.end(), more.begin(), more.end());
      return all;
    }();
    return families;
  }
} // namespace PeriDeal
