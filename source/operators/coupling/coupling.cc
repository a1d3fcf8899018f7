// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/bonds/fictitious_nodes.h>
#include <perideal/operators/coupling/lattice_exchange.h>
#include <perideal/operators/coupling/mesh_exchange.h>
#include <perideal/operators/coupling/state_coupling.h>
#include <perideal/operators/coupling/weighted_bonds.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <utility>

namespace PeriDeal
{
  void throw_if_zone_empty(const double n_nodes, const MPI_Comm communicator)
  {
    AssertThrow(
      dealii::Utilities::MPI::sum(n_nodes, communicator) > 0.,
      UserError(
        "'Zone' in section 'Coupling': no node of the mesh lies in the zone. Choose a wider zone or a finer "
        "mesh, or 'Models = finite elements'."));
  }


  template <int dim>
  double Coupling<dim>::zone_share() const
  {
    return families().nodes().volume_share([&](const unsigned int i) { return in_zone(i); });
  }


  template <int dim>
  std::vector<bool> hanging_nodes(const Nodes<dim> &nodes)
  {
    Vector marks(nodes.partitioner());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      marks.local_element(i) = nodes.is_hanging(i) ? 1. : 0.;
    marks.update_ghost_values();
    std::vector<bool> hanging(nodes.n_local());
    for (unsigned int i = 0; i < hanging.size(); ++i)
      hanging[i] = marks.local_element(i) > 0.;
    return hanging;
  }


  namespace
  {
    template <typename Law, int dim>
    std::unique_ptr<Coupling<dim>> make_exchange(Nodes<dim>                &nodes,
                                                 const BodyParameters<dim> &body,
                                                 const Zone<dim>           &zone)
    {
      if (nodes.lattice() && !nodes.has_doubled_nodes())
        return std::make_unique<LatticeExchange<dim, Law>>(nodes, body, zone);
      return std::make_unique<MeshExchange<dim, Law>>(nodes, body, zone);
    }
  } // namespace


  template <int dim>
  std::unique_ptr<Coupling<dim>> make_coupling(Nodes<dim>                &nodes,
                                               const BodyParameters<dim> &body,
                                               const Zone<dim>           &zone,
                                               const CouplingScheme       scheme)
  {
    if (scheme != CouplingScheme::exchange)
      return std::make_unique<WeightedBonds<dim>>(nodes, body, zone, scheme);
    return make_exchange<ConductingBonds<dim>>(nodes, body, zone);
  }


  template <int dim>
  std::unique_ptr<Coupling<dim>> make_solid_coupling(Nodes<dim>                &nodes,
                                                     const BodyParameters<dim> &body)
  {
    Zone<dim> zone(body.coupling, body.horizon());
    zone.stay_in({{body.domain.lower, body.domain.upper}});
    if (body.coupling.scheme != CouplingScheme::exchange)
      return std::make_unique<StateCoupling<dim>>(nodes, body, zone, body.coupling.scheme);
    return make_exchange<ElasticBonds<dim>>(nodes, body, zone);
  }


  PERIDEAL_INSTANTIATE_FUNCTION(hanging_nodes);
  PERIDEAL_INSTANTIATE_FUNCTION(make_coupling);
  PERIDEAL_INSTANTIATE_FUNCTION(make_solid_coupling);

#define PERIDEAL_TEMPLATES(dim) template double Coupling<dim>::zone_share() const;
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
