// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/place_text.h>
#include <perideal/base/user_error.h>
#include <perideal/bonds/fictitious_nodes.h>
#include <perideal/laws/interface.h>
#include <perideal/operators/diffusion/extended_bond_term.h>
#include <perideal/operators/diffusion/node_capacity.h>
#include <perideal/operators/diffusion/node_loads.h>
#include <perideal/operators/diffusion/side_term.h>
#include <perideal/operators/lattice/cut_bonds.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  ExtendedBondTerm<dim>::ExtendedBondTerm(Nodes<dim> &nodes, const BodyParameters<dim> &body)
    : body(body)
    , families(nodes.find_parts(body.boundary_conditions), body)
    , bonds(families, body)
    , prescribed(std::make_shared<NodeConstraints<dim>>(bonds, body))
    , factors(bonds, body.peridynamics)
    , outside(bonds.neighbors().outside().size())
  {}


  template <int dim>
  void ExtendedBondTerm<dim>::take_bonds()
  {
    if (factors.any())
      factors.find(factors.nodes());
    std::string reason;
    const bool  suits   = lattice_form_suits(bonds, reason);
    const bool  lattice = takes_lattice_form(body.peridynamics.form, suits ? "" : reason, true);
    this->take(lattice ? make_lattice_form(bonds) : make_stored_form(bonds),
               bonds.nodes().partitioner());
    note = lattice ? "lattice stencil, no stored bonds but corrections" :
           suits   ? "stored bonds, as asked" :
                     "stored bonds, because " + reason;
  }


  template <int dim>
  const std::vector<double> &ExtendedBondTerm<dim>::values(const At &at) const
  {
    const auto &fictitious = bonds.neighbors().outside();
    for (std::size_t f = 0; f < fictitious.size(); ++f)
      {
        outside[f] = fictitious[f].sign * at.u.local_element(fictitious[f].mirror);
        if (!at.is_direction)
          outside[f] += fictitious[f].constant(at.time);
      }
    return outside;
  }


  template <int dim>
  void ExtendedBondTerm<dim>::update_rows(const Rows &rows)
  {
    BondTerm<dim>::update_rows(rows);
    if (!outside.empty() && std::any_of(rows.begin(), rows.end(), [&](const unsigned int i) {
          return reaches_outside(i);
        }))
      outside_sums.known = false;
  }


  template <int dim>
  void ExtendedBondTerm<dim>::update_conductivities()
  {
    BondTerm<dim>::update_conductivities();
    outside_sums.known = false;
  }


  template <int dim>
  bool ExtendedBondTerm<dim>::reaches_outside(const unsigned int node) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    const auto        site  = nodes.lattice()->index(nodes.position(node));
    for (unsigned int d = 0; d < dim; ++d)
      {
        const int reach =
          static_cast<int>(bonds.weights().reach() / nodes.lattice()->spacing[d]) + 1;
        if (site[d] < reach || site[d] >= nodes.lattice()->n_sites[d] - reach)
          return true;
      }
    return false;
  }


  template <int dim>
  template <typename Visit>
  void ExtendedBondTerm<dim>::for_each_family(const Visit &visit) const
  {
    std::vector<typename DiffusionBonds<dim>::Bond> family;
    for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
      if (reaches_outside(i))
        {
          bonds.bonds_of(i, family);
          visit(i, family);
        }
  }


  template <int dim>
  void ExtendedBondTerm<dim>::find_sums() const
  {
    const unsigned int n_local = bonds.nodes().n_local();
    outside_sums               = {true, std::vector<double>(outside.size(), 0.), {}};
    for_each_family([&](const unsigned int node, const auto &family) {
      double sum = 0.;
      for (const auto &bond : family)
        if (bond.neighbor >= n_local)
          {
            outside_sums.of_outside[bond.neighbor - n_local] += bond.weight;
            sum += bond.weight;
          }
      outside_sums.of_nodes.emplace_back(node, sum);
    });
  }


  template <int dim>
  void ExtendedBondTerm<dim>::begin(const At &at, double &entering) const
  {
    BondTerm<dim>::begin(at, entering);
    values(at);
    if (outside.empty())
      return;
    if (!outside_sums.known)
      find_sums();
    double total = entering;
    for (std::size_t f = 0; f < outside.size(); ++f)
      total += outside_sums.of_outside[f] * outside[f];
    for (const auto &[node, weight] : outside_sums.of_nodes)
      total -= weight * at.u.local_element(node);
    entering = total;
  }


  template <int dim>
  void ExtendedBondTerm<dim>::add_flows_through_sides(Balance &balance, const At &at) const
  {
    const auto &conditions = body.boundary_conditions;
    for (const types::boundary_id side : conditions.symmetry)
      balance.sides[conditions.name_of(side)];
    const Nodes<dim> &nodes     = bonds.nodes();
    const auto       &dirichlet = conditions.dirichlet;
    // Which condition prescribes a node, of ghosts too: its number from 1 on.
    Vector condition_of(nodes.partitioner());
    for (const auto &entry : prescribed->entries())
      condition_of.local_element(entry.unknown) =
        1. + static_cast<double>(entry.condition - dirichlet.data());
    condition_of.update_ghost_values();
    if (outside.empty()) // of this process
      return;
    const auto condition = [&](const unsigned int node) -> const SideCondition * {
      const auto number = static_cast<std::size_t>(condition_of.local_element(node));
      return number == 0 ? nullptr : &dirichlet[number - 1];
    };
    // The side that heat comes through: the one whose value the fictitious node has, be it mirrored
    // at a symmetry side as well.
    const auto side_of = [&](const FictitiousNode<dim> &node) {
      const SideCondition *const given = node.terms.empty() ? condition(node.mirror) :
                                                              node.terms.back().condition;
      return given != nullptr ? given->name : conditions.name_of(node.side);
    };
    for_each_family([&](const unsigned int node, const auto &family) {
      for (const auto &bond : family)
        if (bond.neighbor >= nodes.n_local())
          {
            const unsigned int f    = bond.neighbor - nodes.n_local();
            const double       heat = bond.weight * (outside[f] - at.u.local_element(node));
            // In a prescribed node's own sum already, with the other sign.
            const SideCondition *const own = condition(node);
            balance.sides[own != nullptr ? own->name : side_of(bonds.neighbors().outside()[f])] +=
              heat;
          }
    });
  }


  template <int dim>
  void ExtendedBondTerm<dim>::add_flows(Balance &balance, const At &at) const
  {
    add_flows_through_sides(balance, at);
    if (!body.cracks.conduct())
      return;
    at.u.update_ghost_values();
    add_heat_of_cut_bonds(
      families,
      at.u,
      [&](const unsigned int i, auto &family) { bonds.bonds_of(i, family); },
      [&](const unsigned int fictitious) { return outside[fictitious]; },
      balance);
    at.u.set_ghost_state(false);
  }


  template <int dim>
  void ExtendedBondTerm<dim>::require_held(const RowsOfK &of_all) const
  {
    // Temperatures make no bond.
    if (of_all.after == RowsOfK::After::new_temperatures ||
        (of_all.after == RowsOfK::After::change && !families.cracks().broken().empty()))
      return;
    std::string message;
    for (const unsigned int i : of_all.rows)
      if (message.empty() && !(this->sum_of(i) > 0.) &&
          prescribed->kind(i) == NodeConstraints<dim>::free)
        message =
          "The node at " + place_text(bonds.nodes().position(i)) +
          " is isolated: no bond of it is left. Check 'Horizon' in section 'Peridynamics' and the cracks in section "
          "'Cracks', which may cut all bonds of a node (a crack in 'Horizon ratio' close to 1).";
    throw_on_all_if_any(bonds.nodes().communicator(), message);
    if (of_all.after == RowsOfK::After::start && !families.cracks().history().changes_ever())
      this->forget_sums();
  }


  template <int dim>
  Mended ExtendedBondTerm<dim>::apply_change(const ChangeSet<dim> &change)
  {
    bonds.cracks().apply_change(change);
    if (change.cuts.empty())
      return {};
    Mended mended;
    mended.rows = bonds.neighbors().nodes_near(change.cuts, bonds.weights().reach());
    if (factors.any())
      {
        factors.find(mended.rows);
        mended.rows = bonds.neighbors().nodes_near(change.cuts, 2. * bonds.weights().reach());
      }
    prescribed->update(bonds, body);
    update_rows(mended.rows);
    mended.stiffer = factors.any() || prescribed->any_slave() || !symmetric();
    return mended;
  }


  template <int dim>
  void ExtendedBondTerm<dim>::update_crack_sides()
  {
    // What a contact conductance lets through depends on the bond's conductivity, and so does
    // crack-side scaling.
    const bool scaled = factors.any() && !bonds.corrects_every_bond();
    if (body.cracks.cracks.empty() || !(scaled || body.cracks.contact_conductance > 0.))
      return;
    if (scaled)
      factors.find(factors.nodes());
    Rows rows;
    for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
      if (bonds.near_crack(i))
        rows.push_back(i);
    update_rows(rows);
  }


  template <int dim>
  void ExtendedBondTerm<dim>::take_material_at(const Vector &u)
  {
    if (!body.material.conductivity.depends_on_temperature())
      return;
    u.update_ghost_values();
    bonds.conductivities().take_at(u);
    u.set_ghost_state(false);
    update_conductivities();
    update_crack_sides();
    prescribed->update(bonds, body);
  }


  template <int dim>
  void ExtendedBondTerm<dim>::add_to(OperatorSize &size) const
  {
    BondTerm<dim>::add_to(size);
    size.memory += families.memory_consumption() + bonds.memory_consumption() +
                   bonds.nodes().memory_consumption();
  }


  namespace
  {
    /**
     * Conductance of a bond between nearest neighbours as a 5 or 7 point scheme has it; zero for
     * longer bonds and cut ones. The same from both ends, so that the matrix is symmetric.
     */
    template <int dim>
    double neighbor_conductance(const DiffusionBonds<dim>                &bonds,
                                const InterfaceRule                       rule,
                                const unsigned int                        node,
                                const typename DiffusionBonds<dim>::Bond &bond)
    {
      const Nodes<dim> &nodes = bonds.nodes();
      if (bond.intact == 0.)
        return 0.;
      const Tensor<1, dim> xi     = bonds.neighbors().bond_vector(node, bond.neighbor);
      const unsigned int   real   = bonds.neighbors().real(bond.neighbor);
      const double         volume = std::sqrt(nodes.volume(node) * nodes.volume(real));
      const double         kept   = bond.weight / bond.intact;
      const double         kappa  = interface_conductivity(rule,
                                                  bonds.conductivities().of_node(node),
                                                  bonds.conductivities().of_node(real));
      if (nodes.lattice())
        {
          unsigned int n_steps = 0;
          for (unsigned int d = 0; d < dim; ++d)
            n_steps += std::abs(std::lround(xi[d] / nodes.lattice()->spacing[d]));
          return n_steps == 1 ? kept * kappa * volume / xi.norm_square() : 0.;
        }
      const double size =
        std::pow(std::max(nodes.volume(node), nodes.volume(bond.neighbor)), 1. / dim);
      return xi.norm() <= 1.5 * size ? 0.5 * kept * kappa * volume / xi.norm_square() : 0.;
    }
  } // namespace


  template <int dim>
  void ExtendedBondTerm<dim>::make_surrogate(TrilinosWrappers::SparseMatrix &matrix,
                                             const Vector                   &others) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    Vector            diagonal(others); // and of fictitious nodes

    std::vector<typename DiffusionBonds<dim>::Bond> family;
    std::vector<unsigned int>                       starts{0};
    std::vector<std::pair<unsigned int, double>>    entries;
    std::vector<types::global_dof_index>            columns;
    std::vector<double>                             values;
    TrilinosWrappers::SparsityPattern pattern(nodes.dof_handler().locally_owned_dofs(),
                                              nodes.communicator(),
                                              nodes.lattice() ? 2 * dim + 1 : 12);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        columns.assign(1, nodes.partitioner()->local_to_global(i));
        double of_outside = 0.;
        family.clear();
        if (prescribed->kind(i) == NodeConstraints<dim>::free)
          bonds.nearest_bonds_of(i, family);
        for (const auto &bond : family)
          if (const double c = neighbor_conductance(bonds, body.material.interface_rule, i, bond);
              c > 0.)
            {
              if (bond.neighbor >= nodes.n_local())
                {
                  // A fictitious node holds its neighbours as far as it does not follow its mirror.
                  of_outside +=
                    (1. - bonds.neighbors().outside()[bond.neighbor - nodes.n_local()].sign) * c;
                  continue;
                }
              entries.emplace_back(bond.neighbor, c);
              columns.push_back(nodes.partitioner()->local_to_global(bond.neighbor));
            }
        diagonal.local_element(i) += of_outside;
        pattern.add_entries(columns[0], columns.begin(), columns.end());
        starts.push_back(static_cast<unsigned int>(entries.size()));
      }
    pattern.compress();
    matrix.reinit(pattern);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        double diag = diagonal.local_element(i);
        columns.assign(1, nodes.partitioner()->local_to_global(i));
        values.assign(1, 0.);
        for (unsigned int k = starts[i]; k < starts[i + 1]; ++k)
          {
            const auto [j, c] = entries[k];
            diag += c;
            columns.push_back(nodes.partitioner()->local_to_global(j));
            values.push_back(-c);
          }
        // A node without near neighbours keeps its own diagonal, so that the matrix stays regular.
        values[0] = diag > 0. ? diag : this->sum_of(i);
        matrix.set(columns[0], columns.size(), columns.data(), values.data());
      }
    matrix.compress(VectorOperation::insert);
  }


  template <int dim>
  std::unique_ptr<FieldOperator<dim>> field_of_bonds(Nodes<dim>                &nodes,
                                                     const BodyParameters<dim> &body)
  {
    FieldParts<dim> parts(body);
    const auto      bonds = std::make_shared<ExtendedBondTerm<dim>>(nodes, body);
    const auto      loads = std::make_shared<NodeLoads<dim>>(nodes, *bonds->constraints(), body);
    parts.layout          = nodes.partitioner();
    parts.capacity        = std::make_shared<NodeCapacity<dim>>(nodes, body);
    parts.values          = bonds->constraints();
    parts.loads           = loads;
    bonds->take_bonds();
    parts.terms          = {bonds, std::make_shared<SideTerm<dim>>(*loads)};
    parts.for_each_place = [&nodes](const typename FieldParts<dim>::Visit &visit) {
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        visit(i, nodes.position(i));
    };
    return std::make_unique<FieldOperator<dim>>(body, parts);
  }


  PERIDEAL_INSTANTIATE_CLASS(class ExtendedBondTerm);
  PERIDEAL_INSTANTIATE_FUNCTION(field_of_bonds);
} // namespace PeriDeal
