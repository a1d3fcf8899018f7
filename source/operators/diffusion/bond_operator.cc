// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/base/worst_trip.h>
#include <perideal/bonds/fictitious_nodes.h>
#include <perideal/laws/interface.h>
#include <perideal/operators/diffusion/bond_operator.h>
#include <perideal/operators/diffusion/heat_content.h>
#include <perideal/operators/lattice/cut_bonds.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/not_positive.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  BondOperator<dim>::BondOperator(Nodes<dim> &nodes, const BodyParameters<dim> &body)
    : FieldOperator<dim>(body,
                         0.,
                         nullptr,
                         [this](Vector &vector) {
                           for (unsigned int i = 0; i < vector.locally_owned_size(); ++i)
                             vector.local_element(i) = position_noise(position(i));
                         })
    , families(nodes.find_parts(body.boundary_conditions), body)
    , bonds(families, body)
    , constraints(bonds, body)
    , loads(nodes, constraints, body)
    , bond_term(bonds, constraints, body.boundary_conditions)
    , side_term(loads)
    , factors(bonds, body.peridynamics)
  {
    this->set_layout(nodes.partitioner());
    this->set_parts(constraints, loads, {&bond_term, &side_term});
    find_capacity(nullptr);
    if (factors.any())
      factors.find(factors.nodes());
    choose_form(body.peridynamics.form);
    const Rows all  = this->all_rows();
    const auto sums = this->take_rows(all);
    throw_if_isolated(all);
    bounds.set(this->largest_rate(all, sums));
    constraints.mask(stiffness_diagonal, 1.);
  }


  template <int dim>
  void BondOperator<dim>::choose_form(const OperatorForm wanted)
  {
    std::string reason;
    const bool  suits   = lattice_form_suits(bonds, reason);
    const bool  lattice = takes_lattice_form(wanted, suits ? "" : reason, true);
    bond_term.take(lattice ? make_lattice_form(bonds) : make_stored_form(bonds), this->layout);
    note = lattice ? "lattice stencil, no stored bonds but corrections" :
           suits   ? "stored bonds, as asked" :
                     "stored bonds, because " + reason;
  }


  template <int dim>
  void BondOperator<dim>::find_capacity(const Vector *u)
  {
    const Nodes<dim> &nodes = bonds.nodes();
    Trip              worst;
    if (body.run.steady) // it only sets a scale then
      {
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          capacity.local_element(i) = nodes.volume(i);
        return;
      }
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const double T       = u != nullptr ?
                                 u->local_element(i) :
                                 body.initial_and_source.initial_value.value(nodes.position(i));
        const double storage = body.material.storage(nodes.position(i), T);
        if (!(storage > 0.))
          keep_lower(worst,
                     not_positive("'Density' times 'Heat capacity'",
                                  storage,
                                  u != nullptr ? T : std::numeric_limits<double>::quiet_NaN(),
                                  nodes.position(i)));
        capacity.local_element(i) = storage * nodes.volume(i);
      }
    throw_lowest_if_any(nodes.communicator(), worst);
  }


  template <int dim>
  void BondOperator<dim>::throw_if_isolated(const Rows &rows) const
  {
    std::string message;
    for (const unsigned int i : rows)
      if (message.empty() && !(bond_term.sum_of(i) > 0.) && counts(i))
        message =
          "The node at " + this->place_of(i) +
          " is isolated: no bond of it is left. Check 'Horizon' in section 'Peridynamics' and the cracks in section "
          "'Cracks', which may cut all bonds of a node (a crack in 'Horizon ratio' close to 1).";
    throw_on_all_if_any(bonds.nodes().communicator(), message);
  }


  template <int dim>
  bool BondOperator<dim>::apply_change(const ChangeSet<dim> &change)
  {
    bonds.cracks().apply_change(change);
    if (change.cuts.empty())
      return false;
    Rows rows = bonds.neighbors().nodes_near(change.cuts, bonds.weights().reach());
    if (factors.any())
      {
        factors.find(rows);
        rows = bonds.neighbors().nodes_near(change.cuts, 2. * bonds.weights().reach());
      }
    constraints.update(bonds, body);
    bond_term.update_rows(rows);
    const auto sums = this->take_rows(rows);
    if (bonds.cracks().broken().empty()) // damage may leave nodes alone, that keep their heat
      throw_if_isolated(rows);
    // Rates can have grown. Where bonds are only cut, the old bounds still hold.
    if (factors.any() || this->history.may_close() || !this->symmetric())
      bounds.set(std::max(bounds.safe(), this->largest_rate(rows, sums)));
    constraints.mask(stiffness_diagonal, 1.);
    return true;
  }


  template <int dim>
  void BondOperator<dim>::heat_between(Vector &y, const Vector &u, const Vector &v) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      y.local_element(i) = this->capacity_depends_on_solution() ?
                             nodes.volume(i) * heat_between_temperatures(body.material,
                                                                         nodes.position(i),
                                                                         u.local_element(i),
                                                                         v.local_element(i)) :
                             capacity.local_element(i) * (v.local_element(i) - u.local_element(i));
  }


  template <int dim>
  void BondOperator<dim>::update_crack_sides()
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
    bond_term.update_rows(rows);
  }


  template <int dim>
  void BondOperator<dim>::take_material_at(const Vector &u)
  {
    if (!this->depends_on_solution())
      return;
    if (this->capacity_depends_on_solution())
      find_capacity(&u);
    if (body.material.conductivity.depends_on_temperature())
      {
        u.update_ghost_values();
        bonds.conductivities().take_at(u);
        u.set_ghost_state(false);
        bond_term.update_conductivities();
        update_crack_sides();
        constraints.update(bonds, body);
      }
    const Rows all = this->all_rows();
    bounds.set(this->largest_rate(all, this->take_rows(all)));
    constraints.mask(stiffness_diagonal, 1.);
  }


  template <int dim>
  void BondOperator<dim>::add_crack_heat(Balance &balance, const Vector &u) const
  {
    u.update_ghost_values();
    add_heat_of_cut_bonds(
      families,
      u,
      [&](const unsigned int i, auto &family) { bonds.bonds_of(i, family); },
      [&](const unsigned int fictitious) { return bond_term.value_beyond(fictitious); },
      balance);
    u.set_ghost_state(false);
  }


  template <int dim>
  double BondOperator<dim>::content(const Vector &u) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    double            heat  = 0.;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      heat += nodes.volume(i) * heat_content(body.material, nodes.position(i), u.local_element(i));
    return heat;
  }


  template <int dim>
  OperatorSize BondOperator<dim>::size() const
  {
    OperatorSize size = FieldOperator<dim>::size();
    size.memory += families.memory_consumption() + bonds.memory_consumption() +
                   bonds.nodes().memory_consumption();
    return size;
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
  void BondOperator<dim>::make_surrogate(TrilinosWrappers::SparseMatrix &matrix) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    Vector            diagonal(nodes.partitioner()); // of sides and fictitious nodes
    side_term.add_diagonal(diagonal, this->all_rows());

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
        if (counts(i))
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
        values[0] = diag > 0. ? diag : bond_term.sum_of(i);
        matrix.set(columns[0], columns.size(), columns.data(), values.data());
      }
    matrix.compress(VectorOperation::insert);
  }


  PERIDEAL_INSTANTIATE_CLASS(class BondOperator);
} // namespace PeriDeal
