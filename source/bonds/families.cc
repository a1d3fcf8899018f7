// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/bonds/boundary_images.h>
#include <perideal/bonds/families.h>
#include <perideal/scene/rules.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * Exchanged elastic bonds do better with open tips unless they are scaled; all other elastic
     * ones are cut there.
     */
    template <int dim>
    bool cuts_at_tips(const BodyParameters<dim> &body, const HaloAround halo)
    {
      const ThroughTips choice = body.cracks.through_tips;
      if (body.deforms && (choice == ThroughTips::automatic || choice == ThroughTips::in_part))
        return halo == HaloAround::nodes || !body.coupling.exchanges() ||
               body.peridynamics.scales_beside_cracks();
      return body.cracks.cuts_bonds_at_tips(body.peridynamics.surface_correction);
    }


    template <int dim>
    KernelParameters kernel_parameters(const BodyParameters<dim> &body)
    {
      const Peridynamics &p = body.peridynamics;
      return {p.kernel,
              p.kernel_exponent,
              p.sampling.volume_fraction,
              calibration_of(body),
              p.sampling.self_term,
              body.horizon()};
    }


    template <int dim>
    std::optional<Tensor<1, dim>> lattice_spacing(const Nodes<dim> &nodes)
    {
      if (nodes.lattice())
        return nodes.lattice()->spacing;
      return {};
    }
  } // namespace


  template <int dim>
  KernelWeights<dim> kernel_weights(const Nodes<dim> &nodes, const BodyParameters<dim> &body)
  {
    return {kernel_parameters(body), lattice_spacing(nodes), nodes.smallest_spacing()};
  }


  template <int dim>
  double halo_reach(const Nodes<dim>          &nodes,
                    const BodyParameters<dim> &body,
                    const KernelWeights<dim>  &weights)
  {
    // A slave of the layer extrapolation depends on a node that may be half a spacing farther away
    // than any bond.
    const double layer  = body.peridynamics.extrapolates_layers() ?
                            body.horizon() + 0.5 * nodes.smallest_spacing() :
                            0.;
    const double images = completes_mesh(body) ? halo_of_images(weights.reach()) : 0.;
    return std::max({weights.reach(), layer, images});
  }


  namespace
  {
    /** Beside finite elements what passes through a crack in the mesh passes between its pairs of
     * nodes, and nothing through bonds. */
    template <int dim>
    double contact_of_bonds(const BodyParameters<dim> &body, const HaloAround halo)
    {
      const double contact = body.cracks.contact_conductance;
      return halo != HaloAround::nodes && body.cracks.double_nodes() && contact > 0. ? 0. : contact;
    }
  } // namespace


  template <int dim>
  Families<dim>::Families(Nodes<dim>                &nodes,
                          const BodyParameters<dim> &body,
                          const HaloAround           halo,
                          const HasBonds            &has_bonds)
    : of_bonds(kernel_weights(nodes, body))
    , topology(nodes, of_bonds, {halo_reach(nodes, body, of_bonds), halo})
    , voids(make_body_voids(nodes, body, of_bonds))
    , crack_set(topology,
                body.crack_history(),
                cuts_at_tips(body, halo),
                contact_of_bonds(body, halo),
                voids.get(),
                body.broken_bonds_conduct,
                body.cuts_in_part_at_tips())
  {
    const bool unique = topology.has_unique_sites();
    // A symmetry plane of an elastic body holds its nodes, and families end at it.
    const bool mirrors = !body.deforms;
    AssertThrow(
      unique || body.boundary_conditions.symmetry.empty() || !mirrors,
      UserError(
        "'Symmetry' in section 'Boundary conditions' needs the lattice of a box without doubled nodes."));
    std::vector<FictitiousNode<dim>> outside;
    // Beside finite elements a symmetry side is an insulated one, and that exactly.
    if (halo == HaloAround::nodes && mirrors)
      outside = make_fictitious_nodes(nodes,
                                      body.boundary_conditions,
                                      body.peridynamics.treatment,
                                      body.peridynamics.sampling.nodal_volume,
                                      of_bonds.reach_in_sites());
    // Some processes may have none.
    AssertThrow(
      unique || Utilities::MPI::max(outside.empty() ? 0 : 1, nodes.communicator()) == 0,
      UserError(
        "'Boundary treatment' in section 'Peridynamics': fictitious layers need a lattice without doubled "
        "nodes; use 'Mesh = pairs' in section 'Cracks', or 'none'."));
    topology.add_outside(std::move(outside));
    if (!unique)
      calibrate(has_bonds);
  }


  template <int dim>
  void Families<dim>::calibrate(const HasBonds &has_bonds)
  {
    const Nodes<dim>                          &nodes = topology.nodes();
    LinearAlgebra::distributed::Vector<double> at_boundary(nodes.partitioner());
    for (const BoundaryShare &share : nodes.boundary_shares())
      at_boundary.local_element(share.node) = 1.;
    at_boundary.update_ghost_values();
    const double tiny           = 1e-10 * nodes.smallest_spacing();
    double       smallest_count = std::numeric_limits<double>::max(), sum = 0., n_full = 0.;
    std::vector<std::pair<unsigned int, double>> found;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        if (has_bonds && !has_bonds(nodes.position(i)))
          continue;
        topology.within(nodes.position(i), of_bonds.reach(), found);
        smallest_count  = std::min(smallest_count, static_cast<double>(found.size()) - 1.);
        const bool full = std::none_of(found.begin(), found.end(), [&](const auto &f) {
          return at_boundary.local_element(f.first) > 0.;
        });
        if (!full || !of_bonds.wants_calibration())
          continue;
        double moment = 0.;
        for (const auto &[neighbor, square] : found)
          if (square > tiny * tiny) // not the node itself, nor its twin across a crack
            moment += of_bonds.of_length(std::sqrt(square)) * nodes.volume(neighbor) * square;
        sum += moment / (2. * dim);
        n_full += 1.;
      }
    AssertThrow(
      Utilities::MPI::min(smallest_count, nodes.communicator()) > 0. ||
        nodes.is_graded(), // nodes of merged cells are in no zone
      UserError(
        "'Horizon' in section 'Peridynamics' is " + std::to_string(of_bonds.horizon()) +
        ": some node has no neighbour within it. Choose at least twice the largest cell of the " +
        (has_bonds ? "zone." : "mesh.")));
    sum    = Utilities::MPI::sum(sum, nodes.communicator());
    n_full = Utilities::MPI::sum(n_full, nodes.communicator());
    if (of_bonds.wants_calibration())
      of_bonds.calibrate(sum, n_full);
  }


  template <int dim>
  void Families<dim>::members_of(const unsigned int node, std::vector<Member> &members) const
  {
    members.clear();
    topology.for_each(node, [&](const unsigned int neighbor, const double w) {
      members.push_back({neighbor,
                         topology.volume(node) * topology.volume(neighbor) * w,
                         crack_set.kept_part(node, neighbor)});
    });
  }


  template <int dim>
  bool Families<dim>::is_parted(const unsigned int node, const unsigned int neighbor) const
  {
    return nodes().has_doubled_nodes() && crack_set.cuts(node, neighbor);
  }


  template <int dim>
  bool Families<dim>::near_crack(const unsigned int node) const
  {
    return crack_set.is_near(node, of_bonds.reach());
  }


  template <int dim>
  const Nodes<dim> &Families<dim>::nodes() const
  {
    return topology.nodes();
  }

  template <int dim>
  CrackSet<dim> &Families<dim>::cracks()
  {
    return crack_set;
  }

  template <int dim>
  std::size_t Families<dim>::memory_consumption() const
  {
    return topology.memory_consumption();
  }

  PERIDEAL_INSTANTIATE_CLASS(class Families);
  PERIDEAL_INSTANTIATE_FUNCTION(kernel_weights);
  PERIDEAL_INSTANTIATE_FUNCTION(halo_reach);
} // namespace PeriDeal
