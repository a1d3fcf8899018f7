// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/solid/zone_breaking.h>

#include <algorithm>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** What bonds of a blending that break need. */
    template <int dim>
    void require_families(const BodyParameters<dim> &body, const std::string &entry)
    {
      const CouplingControl &coupling = body.coupling;
      body.peridynamics.refuse(
        body.peridynamics.completes_families(),
        "Surface correction",
        "'fictitious nodes' is not for 'Scheme = blending' with bonds that break ('" + entry +
          "' in section 'Material'); use 'none', or 'Models = peridynamics'.");
      coupling.refuse(
        coupling.is_near_cracks() && coupling.width < 2.,
        "Zone",
        "found '" + coupling.zone_text() + "'; with 'Scheme = blending' bonds break ('" + entry +
          "' in section 'Material') where their families are alone, and a zone of less than two horizons holds too few. Use 'follow', or 'cracks: 2' or more.");
      body.elasticity.refuse(
        body.elasticity.computes_temperature && body.elasticity.broken_bonds_conduct < 1.,
        "Broken bonds conduct",
        "broken bonds of 'Scheme = blending' in section 'Coupling' insulate nothing. Use 1, or 'Scheme = exchange'.");
    }
  } // namespace


  template <int dim>
  void ZoneBreaking<dim>::require(const BodyParameters<dim> &body)
  {
    const CouplingControl &coupling = body.coupling;
    const Material        &material = body.material;
    const std::string entry  = material.fracture_energy ? "Fracture energy" : "Critical stretch";
    const bool        breaks = material.fracture_energy || material.critical_stretch;
    coupling.refuse(
      coupling.follows_stretches() && !breaks,
      "Zone",
      "'follow' is for bonds that may break: give section 'Material' a 'Fracture energy' or a 'Critical stretch', or use 'cracks: 1'.");
    if (!breaks)
      return;
    coupling.refuse(
      coupling.splices(),
      "Scheme",
      "'splice' has forces without an energy that breaking bonds could release, but section 'Material' has a '" +
        entry + "'. Use 'exchange' or 'blending', or 'Models = peridynamics'.");
    if (!coupling.exchanges())
      require_families(body, entry);
    coupling.refuse(
      coupling.is_near_cracks() && coupling.width < 1.,
      "Zone",
      "found '" + coupling.zone_text() + "'; where bonds may break ('" + entry +
        "' in section 'Material') they would join through broken cells in a zone of less than one horizon. Use 'follow', or 'cracks: 1' or more.");
    material.refuse(
      !body.domain.has_lattice() || body.cracks.on_faces(),
      entry,
      !body.domain.has_lattice() ?
        "is for lattices of equal cells with 'Models = coupled'; on meshes of other cells bonds break in 'Models = peridynamics'." :
        "is not for 'Mesh = faces' in section 'Cracks' with 'Models = coupled'; use 'removed'.");
  }


  template <int dim>
  void ZoneBreaking<dim>::find_cells(const DoFHandler<dim> &dofs)
  {
    std::vector<typename StretchedCells<dim>::Corners> list;
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() &&
          cell->extent_in_direction(0) <= 1.5 * nodes.lattice()->spacing[0])
        {
          list.emplace_back();
          for (const unsigned int v : cell->vertex_indices())
            list.back()[v] = nodes.partitioner()->global_to_local(cell->vertex_dof_index(v, 0));
        }
    cells.set(std::move(list), nodes.lattice()->spacing);
    set_limits_of_cells();
  }


  template <int dim>
  void ZoneBreaking<dim>::set_limits_of_cells()
  {
    cells.set_limits([&](const std::array<unsigned int, n_corners> &corners) {
      double limit = std::numeric_limits<double>::max(), warm = 0.;
      for (const unsigned int i : corners)
        {
          limit = std::min(limit, critical.least_at_nodes()[i]);
          warm += thermal.empty() ? 0. : thermal[i] / n_corners;
        }
      return share_of_zone * limit + warm;
    });
  }


#define PERIDEAL_INSTANTIATE(dim)                                        \
  template void ZoneBreaking<dim>::require(const BodyParameters<dim> &); \
  template void ZoneBreaking<dim>::find_cells(const DoFHandler<dim> &);  \
  template void ZoneBreaking<dim>::set_limits_of_cells();
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
