// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/diffusion/node_constraints.h>
#include <perideal/operators/parts/condition_faces.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  NodeConstraints<dim>::NodeConstraints(const DiffusionBonds<dim> &bonds,
                                        const BodyParameters<dim> &body)
    : nodes(bonds.nodes())
    , kinds(nodes.n_local(), free)
  {
    find_prescribed(bonds, body);
    find_slaves(bonds, body);
    slaves_exist = Utilities::MPI::max(slaves.empty() ? 0 : 1, nodes.communicator()) > 0;
    if (slaves_exist)
      couple_slaves(nodes);
    std::vector<unsigned int> not_free, with_value;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      if (kinds[i] != free)
        {
          not_free.push_back(i);
          if (kinds[i] == prescribed)
            with_value.push_back(i);
        }
    this->set_held(std::move(not_free), std::move(with_value));
  }


  template <int dim>
  void NodeConstraints<dim>::update(const DiffusionBonds<dim> &bonds,
                                    const BodyParameters<dim> &body)
  {
    if (!slaves_exist)
      return;
    std::replace(kinds.begin(), kinds.end(), slave, free);
    slaves.clear();
    find_slaves(bonds, body);
    n_coupled = 0;
    couple_slaves(nodes);
  }


  namespace
  {
    /**
     * Of the listed sides and parts, the first in the list on which each owned node lies, or
     * (partial) some of its area.
     */
    template <int dim, typename Condition>
    std::map<unsigned int, const Condition *> first_sides(const Nodes<dim>             &nodes,
                                                          const std::vector<Condition> &list,
                                                          const bool with_partial = false)
    {
      std::map<unsigned int, const Condition *> first;
      for (const Condition &condition : list)
        for (const BoundaryShare &share : nodes.condition_shares())
          if (share.id == condition.id && (share.inside || with_partial))
            first.try_emplace(share.node, &condition);
      return first;
    }
  } // namespace


  template <int dim>
  void NodeConstraints<dim>::find_prescribed(const DiffusionBonds<dim> &bonds,
                                             const BodyParameters<dim> &body)
  {
    const auto                                        &conditions = body.boundary_conditions;
    const auto                                        &dirichlet  = conditions.dirichlet;
    std::vector<typename PrescribedValues<dim>::Entry> list;
    if (body.peridynamics.has_layers())
      {
        AssertThrow(
          nodes.lattice(),
          UserError(
            "'Boundary treatment = layer' in section 'Peridynamics' needs the lattice of a box."));
        const Lattice<dim> &lattice = *nodes.lattice();
        // Of a hole, which has no lattice rows, the nodes on it
        // and of parts that are no sides of the box
        std::set<std::pair<unsigned int, types::boundary_id>> own;
        for (const BoundaryShare &share : nodes.condition_shares())
          if (share.inside && conditions.side_of(share.id) >= 2 * dim)
            own.insert({share.node, share.id});
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          {
            const auto site = lattice.index(nodes.position(i));
            for (const SideCondition &condition : dirichlet)
              {
                const types::boundary_id side    = conditions.side_of(condition.id);
                const bool               on_side = side < 2 * dim;
                const unsigned int       d       = on_side ? side / 2 : 0;
                const int  depth = side % 2 == 0 ? site[d] : lattice.n_sites[d] - 1 - site[d];
                Point<dim> foot  = nodes.position(i);
                if (on_side)
                  foot[d] = side % 2 == 0 ? lattice.lower[d] : lattice.upper[d];
                if (on_side ? depth < static_cast<int>(body.peridynamics.layer_rows) &&
                                conditions.holds_at(condition.id, foot) :
                              own.count({i, condition.id}) > 0)
                  {
                    list.push_back({i, nodes.position(i), &condition});
                    break;
                  }
              }
          }
      }
    else
      // Beyond the sides of a lattice of cell centres it is the fictitious nodes that have the
      // values.
      for (const auto &[node, condition] : first_sides(nodes, dirichlet))
        if (!body.peridynamics.has_fictitious_nodes() || !nodes.lattice() ||
            !nodes.lattice()->at_centers || conditions.side_of(condition->id) >= 2 * dim)
          list.push_back({node, nodes.position(node), condition});
    for (const auto &entry : list)
      kinds[entry.unknown] = prescribed;
    std::vector<unsigned long long> n_nodes(dirichlet.size(), 0), n_outside(dirichlet.size(), 0);
    for (const BoundaryShare &share : nodes.condition_shares())
      for (std::size_t k = 0; k < dirichlet.size(); ++k)
        n_nodes[k] += share.inside && share.id == dirichlet[k].id ? 1 : 0;
    for (const FictitiousNode<dim> &node : bonds.neighbors().outside())
      for (const auto &term : node.terms)
        ++n_outside[term.condition - dirichlet.data()];
    this->set_entries(std::move(list), conditions, n_nodes, n_outside, nodes.communicator());
  }


  template <int dim>
  void NodeConstraints<dim>::find_slaves(const DiffusionBonds<dim> &bonds,
                                         const BodyParameters<dim> &body)
  {
    if (body.peridynamics.natural_fluxes())
      return;
    AssertThrow(
      body.domain.is_box() && bonds.neighbors().has_unique_sites(),
      UserError(
        "'Flux treatment' in section 'Peridynamics' must be 'natural' unless the body is a box "
        "without doubled nodes."));
    std::vector<SurfaceTransfer> fluxes;
    for (const SurfaceTransfer &transfer : body.boundary_conditions.transfers)
      if (!transfer.fixes_level())
        fluxes.push_back(transfer);
    std::string message;
    if (body.peridynamics.extrapolates_layers())
      {
        std::set<types::boundary_id> sides;
        for (const SurfaceTransfer &flux : fluxes)
          sides.insert(flux.id);
        for (const SurfaceTransfer &flux : fluxes)
          if (find_condition(fluxes, flux.id) == &flux) // once for each side
            message = extrapolate_layer(bonds, flux.id, sides.size(), body);
      }
    else
      for (const auto &[node, transfer] : first_sides(nodes, fluxes, true))
        if (kinds[node] == free)
          {
            const unsigned int side = body.boundary_conditions.side_of(transfer->id);
            Slave              slave;
            slave.node              = node;
            const std::string fault = extrapolate(bonds, side, *transfer, slave);
            message                 = message.empty() ? fault : message;
            add_fluxes(body.boundary_conditions, side, slave);
            slaves.push_back(slave);
          }
    throw_on_all_if_any(nodes.communicator(), message);
    for (const Slave &entry : slaves)
      kinds[entry.node] = slave;
  }


  template <int dim>
  void NodeConstraints<dim>::add_fluxes(const BoundaryConditions<dim> &conditions,
                                        const unsigned int             side,
                                        Slave                         &slave) const
  {
    double whole = 0.;
    for (const BoundaryShare &share : nodes.boundary_shares())
      if (share.node == slave.node && share.id == side)
        whole = share.area;
    for (const BoundaryShare &share : nodes.condition_shares())
      if (share.node == slave.node && conditions.side_of(share.id) == side)
        for (const SurfaceTransfer &transfer : conditions.transfers)
          if (transfer.id == share.id && !transfer.fixes_level())
            slave.fluxes.push_back({&transfer,
                                    share.id == side ? slave.flux_coefficient :
                                                       slave.flux_coefficient * share.area / whole,
                                    nodes.place_of(share)});
  }


  template <int dim>
  std::string NodeConstraints<dim>::extrapolate(const DiffusionBonds<dim> &bonds,
                                                const unsigned int         side,
                                                const SurfaceTransfer     &transfer,
                                                Slave                     &slave) const
  {
    std::vector<typename DiffusionBonds<dim>::Bond> family;
    bonds.bonds_of(slave.node, family, false);
    double sum = 0.;
    for (const auto &bond : family)
      {
        const double inward = (side % 2 == 0 ? 1. : -1.) *
                              bonds.neighbors().bond_vector(slave.node, bond.neighbor)[side / 2];
        if (bond.neighbor >= nodes.n_local() || inward <= 1e-9 * nodes.smallest_spacing() ||
            bond.weight == 0.)
          continue;
        const double weight = bond.weight / nodes.volume(slave.node) * inward;
        slave.masters.emplace_back(bond.neighbor, weight);
        sum += weight;
      }
    if (!(sum > 0.))
      {
        std::ostringstream message;
        message
          << "'Flux treatment = extrapolation' in section 'Peridynamics' needs bonds from every node of a side named in '"
          << transfer.kind->entry << "' into the body, but the node at ("
          << nodes.position(slave.node)
          << ") has none left. Move the cracks in section 'Cracks' away from the side '"
          << transfer.name << "', or choose 'natural'.";
        return message.str();
      }
    for (auto &[neighbor, weight] : slave.masters)
      weight /= sum;
    slave.flux_coefficient = 1. / sum;
    return "";
  }


  template <int dim>
  std::string NodeConstraints<dim>::extrapolate_layer(const DiffusionBonds<dim> &bonds,
                                                      const unsigned int         side,
                                                      const int                  n_layers,
                                                      const BodyParameters<dim> &body)
  {
    const Lattice<dim> &lattice = *nodes.lattice();
    const int           rows = static_cast<int>(std::lround(body.horizon() / lattice.spacing[0]));
    if (lattice.n_sites[0] <= n_layers * rows)
      return "'Flux treatment = layer extrapolation' in section 'Peridynamics' takes a layer of one horizon at each end with a "
             "flux, and the bar has no node beyond. Choose a shorter 'Horizon', more 'Cells' or 'natural'.";
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        auto      site  = lattice.index(nodes.position(i));
        const int depth = side == 0 ? site[0] : lattice.n_sites[0] - 1 - site[0];
        if (depth >= rows || kinds[i] != free)
          continue;
        site[0]                   = side == 0 ? rows : lattice.n_sites[0] - 1 - rows;
        const unsigned int master = bonds.neighbors().node_at(site);
        Assert(master != numbers::invalid_unsigned_int, ExcInternalError());
        Slave slave;
        slave.node    = i;
        slave.masters = {{master, 1.}};
        slave.flux_coefficient =
          (rows - depth) * lattice.spacing[0] / bonds.conductivities().of_node(i);
        for (const SurfaceTransfer &transfer : body.boundary_conditions.transfers)
          if (transfer.id == side && !transfer.fixes_level())
            slave.fluxes.push_back({&transfer, slave.flux_coefficient, nodes.position(i)});
        slaves.push_back(slave);
      }
    return "";
  }


  template <int dim>
  void NodeConstraints<dim>::couple_slaves(const Nodes<dim> &nodes)
  {
    const MPI_Comm communicator = nodes.communicator();
    Vector         flags(nodes.partitioner());
    for (const Slave &entry : slaves)
      flags.local_element(entry.node) = 1.;
    flags.update_ghost_values();
    for (unsigned int i = nodes.n_owned(); i < nodes.n_local(); ++i)
      if (flags.local_element(i) > 0.5)
        kinds[i] = slave;

    // Rows (slave, master, coefficient) of all slaves that depend on other slaves, known to
    // everybody.
    std::vector<std::array<double, 3>> rows;
    for (const Slave &entry : slaves)
      for (const auto &[master, coefficient] : entry.masters)
        if (kinds[master] == slave)
          rows.push_back({static_cast<double>(nodes.partitioner()->local_to_global(entry.node)),
                          static_cast<double>(nodes.partitioner()->local_to_global(master)),
                          coefficient});
    std::map<types::global_dof_index, int> number;
    const auto all_rows = Utilities::MPI::all_gather(communicator, rows);
    for (const auto &part : all_rows)
      for (const auto &row : part)
        for (const unsigned int k : {0, 1})
          number.try_emplace(static_cast<types::global_dof_index>(row[k]), 0);
    for (auto &[index, k] : number)
      k = static_cast<int>(n_coupled++);
    if (n_coupled == 0)
      return;
    coupled_loads.resize(n_coupled);
    coupled_values.resize(n_coupled);

    std::vector<Eigen::Triplet<double>> entries;
    for (unsigned int k = 0; k < n_coupled; ++k)
      entries.emplace_back(k, k, 1.);
    for (const auto &part : all_rows)
      for (const auto &row : part)
        entries.emplace_back(number.at(static_cast<types::global_dof_index>(row[0])),
                             number.at(static_cast<types::global_dof_index>(row[1])),
                             -row[2]);
    Eigen::SparseMatrix<double> matrix(n_coupled, n_coupled);
    matrix.setFromTriplets(entries.begin(), entries.end());
    coupling.compute(matrix);
    AssertThrow(
      coupling.info() == Eigen::Success,
      UserError(
        "'Flux treatment' in section 'Peridynamics': the values at the sides named in 'Flux' are not determined, because they only "
        "refer to each other. Choose more 'Cells' (section 'Domain') or 'natural'."));

    for (Slave &entry : slaves)
      {
        const auto found = number.find(nodes.partitioner()->local_to_global(entry.node));
        if (found != number.end())
          entry.coupled = found->second;
        auto &masters = entry.masters;
        masters.erase(std::remove_if(masters.begin(),
                                     masters.end(),
                                     [&](const auto &m) { return kinds[m.first] == slave; }),
                      masters.end());
      }
  }


  template <int dim>
  void NodeConstraints<dim>::set_slaves(Vector &u, const double t, const bool homogeneous) const
  {
    if (!slaves_exist)
      return;
    u.update_ghost_values();
    coupled_loads.setZero();
    for (const Slave &entry : slaves)
      {
        double value = 0.;
        for (const SlaveFlux &flux : entry.fluxes)
          value += homogeneous ? 0. : flux.coefficient * flux.transfer->flux.value(flux.place, t);
        for (const auto &[master, coefficient] : entry.masters)
          value += coefficient * u.local_element(master);
        if (entry.coupled >= 0)
          coupled_loads[entry.coupled] = value;
        else
          u.local_element(entry.node) = value;
      }
    if (n_coupled > 0)
      {
        // Each entry has one owner, the others add zero: exact in any order.
        Utilities::MPI::sum(ArrayView<const double>(coupled_loads.data(), n_coupled),
                            nodes.communicator(),
                            ArrayView<double>(coupled_loads.data(), n_coupled));
        coupled_values = coupling.solve(coupled_loads);
        for (const Slave &entry : slaves)
          if (entry.coupled >= 0)
            u.local_element(entry.node) = coupled_values[entry.coupled];
      }
    u.set_ghost_state(false);
  }


  template <int dim>
  void NodeConstraints<dim>::distribute(Vector &u, const double t) const
  {
    PrescribedValues<dim>::distribute(u, t);
    set_slaves(u, t, false);
  }


  template <int dim>
  void NodeConstraints<dim>::distribute_homogeneous(Vector &x) const
  {
    for (const auto &entry : this->entries())
      x.local_element(entry.unknown) = 0.;
    set_slaves(x, 0., true);
  }


  PERIDEAL_INSTANTIATE_CLASS(class NodeConstraints);
} // namespace PeriDeal
