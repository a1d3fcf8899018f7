// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/operators/lattice_exchange.h>
#include <perideal/operators/mesh_exchange.h>
#include <perideal/operators/weighted_coupling.h>

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


  template <int dim>
  std::unique_ptr<Coupling<dim>> make_coupling(Nodes<dim>          &nodes,
                                               const Scene<dim>    &scene,
                                               const Zone<dim>     &zone,
                                               const CouplingScheme scheme)
  {
    if (scheme == CouplingScheme::splice)
      return std::make_unique<Splice<dim>>(nodes, scene, zone);
    if (scheme == CouplingScheme::blending)
      return std::make_unique<Blending<dim>>(nodes, scene, zone);
    if (nodes.lattice() && !nodes.has_doubled_nodes())
      return std::make_unique<LatticeExchange<dim>>(nodes, scene, zone);
    return std::make_unique<MeshExchange<dim>>(nodes, scene, zone);
  }


  template std::vector<bool>            hanging_nodes(const Nodes<1> &);
  template std::vector<bool>            hanging_nodes(const Nodes<2> &);
  template std::vector<bool>            hanging_nodes(const Nodes<3> &);
  template double                       Coupling<1>::zone_share() const;
  template double                       Coupling<2>::zone_share() const;
  template double                       Coupling<3>::zone_share() const;
  template std::unique_ptr<Coupling<1>> make_coupling(Nodes<1> &,
                                                      const Scene<1> &,
                                                      const Zone<1> &,
                                                      const CouplingScheme);
  template std::unique_ptr<Coupling<2>> make_coupling(Nodes<2> &,
                                                      const Scene<2> &,
                                                      const Zone<2> &,
                                                      const CouplingScheme);
  template std::unique_ptr<Coupling<3>> make_coupling(Nodes<3> &,
                                                      const Scene<3> &,
                                                      const Zone<3> &,
                                                      const CouplingScheme);
} // namespace PeriDeal
