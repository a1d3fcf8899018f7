// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/operators/coupling/exchange_laws.h>
#include <perideal/operators/solid/zone_breaking.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "stretch_fault.h"

namespace PeriDeal
{
  using namespace dealii;

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
    coupling.refuse(!coupling.exchanges(),
                    "Scheme",
                    "'" + coupling.scheme_text() +
                      "' has bonds that do not break, but section 'Material' has a '" + entry +
                      "'. Use 'exchange', or 'Models = peridynamics'.");
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
  void ZoneBreaking<dim>::find_critical_stretches(const BodyParameters<dim> &body)
  {
    const Material          &material  = body.material;
    const double             of_square = ElasticBonds<dim>::energy_per_square(of_lattice);
    const CellStiffness<dim> stiffness = ElasticBonds<dim>::stiffness(body);
    std::string              message;
    Vector                   stretches(nodes.partitioner());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const Point<dim> &p = nodes.position(i);
        double           &s = stretches.local_element(i);
        s                   = material.critical_stretch ?
                                material.critical_stretch->value(p) :
                                std::sqrt(material.fracture_energy->value(p) / (stiffness.at(p) * of_square));
        if (message.empty() && !(s > 0.))
          message = stretch_fault(material.critical_stretch.has_value(), p);
      }
    throw_on_all_if_any(nodes.communicator(), message);
    stretches.update_ghost_values();
    critical.assign(stretches.begin(), stretches.begin() + nodes.n_local());
  }


  template <int dim>
  void ZoneBreaking<dim>::find_cells(const DoFHandler<dim> &dofs)
  {
    std::vector<typename StretchedCells<dim>::Corners> list;
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && of_lattice.is_of_lattice(cell))
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
          limit = std::min(limit, critical[i]);
          warm += thermal.empty() ? 0. : thermal[i] / n_corners;
        }
      return share_of_zone * limit + warm;
    });
  }


#define PERIDEAL_INSTANTIATE(dim)                                                        \
  template void ZoneBreaking<dim>::require(const BodyParameters<dim> &);                 \
  template void ZoneBreaking<dim>::find_critical_stretches(const BodyParameters<dim> &); \
  template void ZoneBreaking<dim>::find_cells(const DoFHandler<dim> &);                  \
  template void ZoneBreaking<dim>::set_limits_of_cells();
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
