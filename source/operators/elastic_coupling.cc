// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/operators/elastic_exchange.h>
#include <perideal/operators/state_coupling.h>

namespace PeriDeal
{
  template <int dim>
  double ElasticCoupling<dim>::zone_share() const
  {
    return families().nodes().volume_share([&](const unsigned int i) { return in_zone(i); });
  }


  template <int dim>
  std::unique_ptr<ElasticCoupling<dim>> make_elastic_coupling(Nodes<dim>       &nodes,
                                                              const Scene<dim> &scene)
  {
    Zone<dim> zone(scene.coupling, scene.horizon());
    zone.stay_in({{scene.domain.lower, scene.domain.upper}});
    if (scene.coupling.scheme == CouplingScheme::splice)
      return std::make_unique<StateSplice<dim>>(nodes, scene, zone);
    if (scene.coupling.scheme == CouplingScheme::blending)
      return std::make_unique<StateBlending<dim>>(nodes, scene, zone);
    return std::make_unique<ElasticExchange<dim>>(nodes, scene, zone);
  }


  template <int dim>
  std::unique_ptr<ElasticCoupling<dim>> make_families_everywhere(Nodes<dim>       &nodes,
                                                                 const Scene<dim> &scene)
  {
    return std::make_unique<StateBlending<dim>>(nodes, scene, Zone<dim>());
  }


#define PERIDEAL_INSTANTIATE(dim)                                                           \
  template class ElasticCoupling<dim>;                                                      \
  template std::unique_ptr<ElasticCoupling<dim>> make_elastic_coupling(Nodes<dim> &,        \
                                                                       const Scene<dim> &); \
  template std::unique_ptr<ElasticCoupling<dim>> make_families_everywhere(Nodes<dim> &,     \
                                                                          const Scene<dim> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
