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
  void Coupling<dim>::require(const BodyParameters<dim> &body)
  {
    const CouplingControl &control  = body.coupling;
    const auto             obstacle = body.obstacle_to_bonds_on_elements();
    if (!obstacle.first.empty())
      entry_error(obstacle.first, obstacle.second + ", for 'Models = coupled'.");
    control.refuse(
      dim == 1 && control.is_near_cracks(),
      "Zone",
      "'" + control.zone_text() +
        "' needs a crack, and bodies of 'Dimension' 1 have none. Give a formula of x, or 'everywhere'.");
    control.refuse(
      (control.is_near_cracks() || control.is_adaptive()) && body.cracks.cracks.empty(),
      "Zone",
      "'" + control.zone_text() +
        "' lies around cracks, but section 'Cracks' has none: the zone is empty. Give a formula, or 'everywhere'" +
        (body.material.fracture_energy || body.material.critical_stretch ?
           ", or 'follow', with which bonds appear where the body is about to break." :
           "."));
    double widest = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      widest = std::max(widest, body.domain.upper[d] - body.domain.lower[d]);
    const double overlap =
      body.domain.has_lattice() && control.overlap > 0. ? control.overlap * body.horizon() : 0.;
    control.refuse(overlap > widest,
                   "Overlap",
                   "is " + number_text(control.overlap) + " horizons, " + number_text(overlap) +
                     ", wider than the body, " + number_text(widest) + ".");
    body.finite_elements.refuse(
      body.finite_elements.degree > 1,
      "Degree",
      "found " + std::to_string(body.finite_elements.degree) +
        "; bonds and elements share the nodes of elements of degree 1 ('Models = coupled').");
    KernelWeights<dim>::require(body);
    if (!body.deforms)
      require_fictitious_nodes(body);
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

#define PERIDEAL_TEMPLATES(dim)                                        \
  template void   Coupling<dim>::require(const BodyParameters<dim> &); \
  template double Coupling<dim>::zone_share() const;
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
