// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "stability_scene.h"

#include <perideal/output/tables.h>
#include <perideal/scene/scene_lines.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  namespace
  {
    /** So many cells that a map is computed in minutes. */
    double most_cells(const std::size_t dim)
    {
      return dim == 1 ? 60. : dim == 2 ? 450. : 512.;
    }


    /**
     * Cells of the same shape, as far as whole numbers allow; odd counts stay odd, and those that
     * are halved @p n_halvings times can be.
     */
    CellCounts coarse_cells(const CellCounts &cells, const unsigned int n_halvings)
    {
      const unsigned int unit    = 1u << n_halvings;
      double             product = 1.;
      for (const unsigned int n : cells)
        product *= n;
      const double share =
        std::min(1., std::pow(most_cells(cells.size()) / product, 1. / cells.size()));
      CellCounts coarse = cells;
      for (unsigned int &n : coarse)
        {
          const auto least = std::min(n, 4u + n % 2);
          auto       fewer = static_cast<unsigned int>(share * n);
          if (fewer % 2 != n % 2)
            ++fewer;
          fewer = std::max(1u, fewer / unit) * unit;
          n     = std::clamp(fewer, least, n);
        }
      return coarse;
    }


    std::string name_of(const KernelShape kernel)
    {
      return kernel == KernelShape::constant ? "constant" :
             kernel == KernelShape::conical  ? "conical" :
                                               "gaussian";
    }


    template <int dim>
    StabilityFacts facts_of_scene(const Scene<dim> &scene)
    {
      StabilityFacts facts;
      facts.title           = scene.general.title;
      facts.dim             = dim;
      facts.kernel          = name_of(scene.peridynamics.kernel);
      facts.fraction        = scene.peridynamics.volume_fraction == VolumeFraction::none ? "none" :
                              scene.peridynamics.volume_fraction == VolumeFraction::linear ? "linear" :
                                                                                             "exact";
      facts.calibration     = scene.peridynamics.calibration == Calibration::discrete ? "discrete" :
                                                                                        "analytic";
      facts.nodes           = scene.domain.has_nodes_at_centers() ? "cell centers" : "vertices";
      facts.kernel_exponent = scene.peridynamics.kernel_exponent;
      facts.ratio           = scene.peridynamics.horizon_ratio;
      facts.deforms         = scene.deforms;
      facts.moves           = scene.deforms && !scene.elasticity.is_static();
      facts.steady          = scene.time.steady;
      facts.is_box          = scene.domain.is_box() && !scene.domain.has_extra_layers();
      facts.breaks          = scene.material.fracture_energy || scene.material.critical_stretch;
      facts.depends_on_solution = scene.material.depends_on_temperature();
      facts.lumped              = !scene.finite_elements.consistent_capacity;
      facts.models              = scene.general.models;
      if (!facts.is_box)
        return facts;
      for (unsigned int d = 0; d < dim; ++d)
        {
          facts.cells.push_back(scene.domain.cells[d]);
          facts.lower.push_back(scene.domain.lower[d]);
          facts.upper.push_back(scene.domain.upper[d]);
        }
      facts.coarse = coarse_cells(facts.cells, scene.domain.coarsening.times);
      if (scene.peridynamics.horizon > 0.)
        {
          const auto h = scene.domain.spacing();
          facts.ratio  = scene.horizon() / *std::min_element(h.begin_raw(), h.end_raw());
        }
      return facts;
    }


    StabilityFacts facts_of_file(const std::string              &file,
                                 const std::vector<std::string> &overrides,
                                 const MPI_Comm                  communicator)
    {
      StabilityFacts facts;
      with_scene(read_scene(file, overrides, communicator),
                 [&](const auto &scene) { facts = facts_of_scene(scene); });
      return facts;
    }
  } // namespace


  bool StabilityFacts::runs(const ModelKind model) const
  {
    return std::find(models.begin(), models.end(), model) != models.end();
  }


  StabilityScene::StabilityScene(const std::string              &file,
                                 const std::vector<std::string> &overrides,
                                 const std::string              &folder,
                                 const MPI_Comm                  communicator)
    : facts(facts_of_file(file, overrides, communicator))
    , communicator(communicator)
    , folder(folder)
    , file(file)
    , overrides(overrides)
  {}


  std::string StabilityScene::no_diffusion_with(const ModelKind model) const
  {
    if (facts.deforms)
      return "it is of diffusion, and this scene is of elasticity";
    if (!facts.runs(model))
      return "'Models' has no " + to_string(model);
    return {};
  }


  SceneText StabilityScene::text_of_body(const ModelKind             model,
                                         const std::vector<Setting> &settings) const
  {
    // The horizon is given by one of two entries.
    const bool has_horizon =
      std::any_of(settings.begin(), settings.end(), [](const Setting &setting) {
        return setting.first == "Peridynamics/Horizon";
      });
    std::vector<std::string> all = {
      "Dimension=" + std::to_string(facts.dim),
      std::string("Physics=") + (facts.deforms ? "elasticity" : "heat"),
      "Models=" + to_string(model),
      "Domain/Nodes=" + (model == ModelKind::peridynamics ? facts.nodes : "vertices")};
    std::vector<Setting> of_bonds;
    if (model != ModelKind::finite_elements)
      of_bonds = {{"Kernel", facts.kernel},
                  {"Kernel exponent", std::to_string(facts.kernel_exponent)}};
    if (model != ModelKind::finite_elements && !has_horizon)
      of_bonds.emplace_back("Horizon ratio", full_precision(facts.ratio));
    for (const auto &[entry, value] : of_bonds)
      all.push_back("Peridynamics/" + entry + "=" + value);
    for (const auto &[entry, value] : settings)
      all.push_back(entry + "=" + value);
    return {"stability", apply_overrides("", "stability", all), communicator};
  }


  SceneText StabilityScene::text_with(const ModelKind             model,
                                      const std::vector<Setting> &settings) const
  {
    std::vector<std::string> all = overrides;
    const auto               add = [&](const Setting &setting) {
      all.push_back(setting.first + "=" + setting.second);
    };
    for (const char *const entry : {"Write at", "Write every", "Probes", "Line", "Grid"})
      add({std::string("Output/") + entry, ""});
    if (facts.is_box)
      {
        add({"Domain/Node spacing", ""});
        add({"Domain/Cells", to_text(facts.coarse)});
        add({"Cracks/Nodes on cracks", "left"}); // these very cells
        if (model != ModelKind::finite_elements)
          {
            add({"Peridynamics/Horizon", ""});
            add({"Peridynamics/Horizon ratio", full_precision(facts.ratio)});
          }
      }
    add({"Models", to_string(model)});
    for (const Setting &setting : settings)
      add(setting);
    return read_scene(file, all, communicator);
  }
} // namespace PeriDeal
