// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/operators/state_operator.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void StateOperator<dim>::initialize_nodal_vector(Vector &vector) const
  {
    vector.reinit(bonds.nodes().partitioner());
  }


  template <int dim>
  void StateOperator<dim>::set_temperature_change(const Vector &nodal)
  {
    this->keep_temperature_change(nodal);
    const Nodes<dim> &nodes   = bonds.nodes();
    double            hottest = 0.;
    for (unsigned int i = 0; i < laws.size(); ++i)
      {
        const Point<dim> &p = nodes.position(i);
        laws[i].thermal =
          thermal_strain_factor(scene.material.moduli(p), dim, scene.elasticity.plane) *
          scene.material.thermal_expansion.value(p) * this->temperature_change().local_element(i);
        hottest = std::max(hottest, std::abs(laws[i].thermal));
      }
    any_thermal   = Utilities::MPI::max(hottest, nodes.communicator()) > 0.;
    thermal_loads = 0.;
    find_thermal_loads();
  }


#define PERIDEAL_INSTANTIATE(dim)                                            \
  template void StateOperator<dim>::initialize_nodal_vector(Vector &) const; \
  template void StateOperator<dim>::set_temperature_change(const Vector &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
