// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/std_cxx20/iota_view.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/node_loops.h>
#include <perideal/base/user_error.h>
#include <perideal/base/worst_trip.h>
#include <perideal/bonds/fictitious_nodes.h>
#include <perideal/laws/interface.h>
#include <perideal/operators/diffusion/bond_operator.h>
#include <perideal/operators/diffusion/heat_content.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/not_positive.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void BondOperator<dim>::require(const BodyParameters<dim> &body)
  {
    DiffusionOperatorBase<dim>::require(body);
    if (const auto obstacle = body.obstacle_to_bonds_on_elements();
        body.peridynamics.treatment == BoundaryTreatment::exchange && !obstacle.first.empty())
      entry_error(
        obstacle.first,
        obstacle.second +
          ", for 'Boundary treatment = exchange'. Use 'Boundary treatment = none' (section 'Peridynamics') for bonds alone.");
    KernelWeights<dim>::require(body);
    require_fictitious_nodes(body);
    NodeConstraints<dim>::require(body);
  }


  template <int dim>
  BondOperator<dim>::BondOperator(Nodes<dim> &nodes, const BodyParameters<dim> &body)
    : DiffusionOperatorBase<dim>(body,
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
    , outside(bonds)
    , factors(bonds, body.peridynamics)
  {
    this->set_layout(nodes.partitioner());
    if (constraints.any_slave())
      this->initialize_vector(scratch);
    find_capacity(nullptr);
    if (factors.any())
      factors.find(factors.nodes());
    choose_form(body.peridynamics.form);
    find_diagonal();
  }


  template <int dim>
  void BondOperator<dim>::choose_form(const OperatorForm wanted)
  {
    std::string reason;
    const bool  suits   = lattice_form_suits(bonds, reason);
    const bool  lattice = takes_lattice_form(wanted, suits ? "" : reason, true);
    form                = lattice ? make_lattice_form(bonds) : make_stored_form(bonds);
    note                = lattice ? "lattice stencil, no stored bonds but corrections" :
                          suits   ? "stored bonds, as asked" :
                                    "stored bonds, because " + reason;
  }


  template <int dim>
  void BondOperator<dim>::find_capacity(const Vector *u)
  {
    const Nodes<dim> &nodes = bonds.nodes();
    Trip              worst;
    if (body.steady) // it only sets a scale then
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
  template <typename Rows>
  void BondOperator<dim>::throw_if_isolated(const Rows &rows) const
  {
    std::string message;
    for (const unsigned int i : rows)
      if (message.empty() && !(stiffness_diagonal.local_element(i) > 0.) &&
          constraints.kind(i) == NodeConstraints<dim>::free)
        message =
          "The node at " + this->place_of(i) +
          " is isolated: no bond of it is left. Check 'Horizon' in section 'Peridynamics' and the cracks in section "
          "'Cracks', which may cut all bonds of a node (a crack in 'Horizon ratio' close to 1).";
    throw_on_all_if_any(bonds.nodes().communicator(), message);
  }


  template <int dim>
  template <typename Rows>
  double BondOperator<dim>::largest_rate(const Rows &rows) const
  {
    double rate = 0.;
    for (const unsigned int i : rows)
      if (constraints.kind(i) == NodeConstraints<dim>::free)
        rate = std::max(rate, 2. * stiffness_diagonal.local_element(i) / capacity.local_element(i));
    return Utilities::MPI::max(rate, bonds.nodes().communicator());
  }


  template <int dim>
  void BondOperator<dim>::find_diagonal()
  {
    const std_cxx20::ranges::iota_view<unsigned int, unsigned int> all(0u, bonds.nodes().n_owned());
    n_own_bonds = form->row_sums(stiffness_diagonal.begin());
    throw_if_isolated(all);
    for (const auto &load : loads.with_coefficient())
      stiffness_diagonal.local_element(load.node) += load.coefficient;
    bounds.set(largest_rate(all));
    constraints.mask(stiffness_diagonal, 1.);
  }


  template <int dim>
  void BondOperator<dim>::apply_then(Vector &y, const Vector &x, const RowsAction &finish) const
  {
    ++this->applications;
    const Vector *input = &x;
    if (constraints.any_slave())
      {
        scratch = x;
        constraints.distribute_homogeneous(scratch);
        input = &scratch;
      }
    input->update_ghost_values();
    const double *const beyond  = outside.homogeneous_values(*input);
    double             &entered = this->entering_now;
    entered                     = loads.through_transfer(*input);
    outside.add_to(entered, *input);
    form->apply(y.begin(),
                input->begin(),
                beyond,
                [&](const unsigned int begin, const unsigned int end) {
                  loads.add_transfer(y, *input, begin, end);
                  entered += constraints.sum(y, begin, end);
                  constraints.mask(y, 0., begin, end);
                  finish(begin, end);
                });
    input->set_ghost_state(false);
  }


  template <int dim>
  void BondOperator<dim>::residual_then(Vector           &r,
                                        const Vector     &u,
                                        const double      t,
                                        const RowsAction &finish) const
  {
    ++this->applications;
    u.update_ghost_values();
    const double *const beyond   = outside.values(u, t);
    const double *const constant = loads.constant();
    const bool          vary     = loads.vary();
    double             *values   = r.begin();
    double             &entered  = this->entering_now;
    entered                      = loads.through_transfer(u);
    outside.add_to(entered, u);
    entered = entered + loads.through_slaves(t) + loads.constant_sum();
    form->apply(values, u.begin(), beyond, [&](const unsigned int begin, const unsigned int end) {
      loads.add_transfer(r, u, begin, end);
      entered += constraints.sum(r, begin, end);
      if (constant != nullptr)
        NodeLoops::subtract_from(values + begin, constant + begin, end - begin);
      else
        NodeLoops::negate(values + begin, end - begin);
      constraints.mask(r, 0., begin, end);
      if (!vary)
        finish(begin, end);
    });
    u.set_ghost_state(false);
    if (vary)
      {
        entered += loads.add_to(r, t);
        constraints.mask(r);
        finish(0, r.locally_owned_size());
      }
  }


  template <int dim>
  bool BondOperator<dim>::has_steady_state() const
  {
    return constraints.any_prescribed() || body.boundary_conditions.transfers_fix_level() ||
           !body.boundary_conditions.dirichlet.empty();
  }


  template <int dim>
  bool BondOperator<dim>::apply_change(const ChangeSet<dim> &change)
  {
    bonds.cracks().apply_change(change);
    if (change.cuts.empty())
      return false;
    std::vector<unsigned int> rows =
      bonds.neighbors().nodes_near(change.cuts, bonds.weights().reach());
    if (factors.any())
      {
        factors.find(rows);
        rows = bonds.neighbors().nodes_near(change.cuts, 2. * bonds.weights().reach());
      }
    constraints.update(bonds, body);
    form->update_rows(rows, stiffness_diagonal.begin());
    outside.update(rows);
    if (bonds.cracks().broken().empty()) // damage may leave nodes alone, that keep their heat
      throw_if_isolated(rows);
    for (const auto &load : loads.with_coefficient())
      if (std::binary_search(rows.begin(), rows.end(), load.node))
        stiffness_diagonal.local_element(load.node) += load.coefficient;
    // Rates can have grown. Where bonds are only cut, the old bounds still hold.
    if (factors.any() || this->history.may_close() || !symmetric())
      bounds.set(std::max(bounds.safe(), largest_rate(rows)));
    constraints.mask(stiffness_diagonal, 1.);
    n_own_bonds = -1.;
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
    std::vector<unsigned int> rows;
    for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
      if (bonds.near_crack(i))
        rows.push_back(i);
    form->update_rows(rows, stiffness_diagonal.begin());
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
        form->update_conductivities(stiffness_diagonal.begin());
        outside.update();
        update_crack_sides();
        constraints.update(bonds, body);
        for (const auto &load : loads.with_coefficient())
          stiffness_diagonal.local_element(load.node) += load.coefficient;
      }
    bounds.set(largest_rate(
      std_cxx20::ranges::iota_view<unsigned int, unsigned int>(0u, bonds.nodes().n_owned())));
    constraints.mask(stiffness_diagonal, 1.);
  }


  template <int dim>
  void BondOperator<dim>::add_crack_heat(const Vector &u, Balance &balance) const
  {
    const Nodes<dim>                               &nodes = bonds.nodes();
    std::vector<typename DiffusionBonds<dim>::Bond> family;
    std::vector<std::pair<unsigned int, int>>       crossed;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        if (!bonds.near_crack(i))
          continue;
        bonds.bonds_of(i, family);
        for (const auto &bond : family)
          if (bond.cut && bond.weight != 0.)
            {
              // A bond between two real nodes comes up at both of its ends; with a self term they
              // differ.
              const bool   real  = bond.neighbor < nodes.n_local();
              const double other = real ? u.local_element(bond.neighbor) :
                                          outside.last_values()[bond.neighbor - nodes.n_local()];
              const double heat  = (real ? 0.5 : 1.) * bond.weight * (other - u.local_element(i));
              bonds.cracks().crossed_cracks(i, bond.neighbor, crossed);
              for (const auto &[crack, side] : crossed)
                balance.cracks[crack] += side * heat;
            }
      }
  }


  template <int dim>
  void BondOperator<dim>::find_flows(Balance      &balance,
                                     Vector       &heat,
                                     const Vector &u,
                                     const double  t) const
  {
    const Nodes<dim> &nodes      = bonds.nodes();
    const auto       &conditions = body.boundary_conditions;
    Vector            entering;
    this->initialize_vector(entering);
    u.update_ghost_values();
    form->apply(heat.begin(), u.begin(), outside.values(u, t));
    loads.add_transfer(heat, u, 0, nodes.n_owned());
    loads.add_to(entering, t);
    heat -= entering;

    for (const types::boundary_id side : conditions.symmetry)
      balance.sides[conditions.name_of(side)];
    // In a prescribed node it has come in through the node's side.
    for (const auto &entry : constraints.prescribed_nodes())
      balance.sides[entry.condition->name] += heat.local_element(entry.node);
    outside.add_to(balance, u, constraints, conditions);
    loads.add_to(balance, u, t);
    if (body.cracks.conduct())
      add_crack_heat(u, balance);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      balance.content +=
        nodes.volume(i) * heat_content(body.material, nodes.position(i), u.local_element(i));
    u.set_ghost_state(false);
  }


  template <int dim>
  OperatorSize BondOperator<dim>::size() const
  {
    const MPI_Comm communicator = bonds.nodes().communicator();
    if (n_own_bonds < 0.)
      {
        std::vector<double> sums(bonds.nodes().n_owned());
        n_own_bonds = form->row_sums(sums.data());
      }
    OperatorSize size = DiffusionOperatorBase<dim>::size();
    size.bonds =
      static_cast<unsigned long long>(std::llround(Utilities::MPI::sum(n_own_bonds, communicator)));
    size.nonzeros = Utilities::MPI::sum(form->n_stored(), communicator);
    size.memory += families.memory_consumption() + bonds.memory_consumption() +
                   bonds.nodes().memory_consumption() + form->memory_consumption() +
                   loads.memory_consumption() + scratch.memory_consumption();
    size.form = form->name();
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
  void BondOperator<dim>::surrogate(TrilinosWrappers::SparseMatrix &matrix) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    const IndexSet   &owned = nodes.dof_handler().locally_owned_dofs();

    // Which columns are free has to be known of ghosts too.
    Vector free_nodes;
    this->initialize_vector(free_nodes);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      free_nodes.local_element(i) = constraints.kind(i) == NodeConstraints<dim>::free ? 1. : 0.;
    free_nodes.update_ghost_values();

    std::vector<typename DiffusionBonds<dim>::Bond> family;
    std::vector<unsigned int>                       starts{0};
    std::vector<double>                             of_outside(nodes.n_owned(), 0.);
    std::vector<std::pair<unsigned int, double>>    entries;
    std::vector<types::global_dof_index>            columns;
    std::vector<double>                             values;
    TrilinosWrappers::SparsityPattern               pattern(owned,
                                              nodes.communicator(),
                                              nodes.lattice() ? 2 * dim + 1 : 12);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        columns.assign(1, nodes.partitioner()->local_to_global(i));
        if (free_nodes.local_element(i) > 0.)
          {
            bonds.nearest_bonds_of(i, family);
            for (const auto &bond : family)
              if (const double c =
                    neighbor_conductance(bonds, body.material.interface_rule, i, bond);
                  c > 0.)
                {
                  if (bond.neighbor >= nodes.n_local())
                    {
                      // A fictitious node holds its neighbours as far as it does not follow its
                      // mirror.
                      of_outside[i] +=
                        (1. - bonds.neighbors().outside()[bond.neighbor - nodes.n_local()].sign) *
                        c;
                      continue;
                    }
                  entries.emplace_back(bond.neighbor, c);
                  columns.push_back(nodes.partitioner()->local_to_global(bond.neighbor));
                }
          }
        pattern.add_entries(columns[0], columns.begin(), columns.end());
        starts.push_back(static_cast<unsigned int>(entries.size()));
      }
    pattern.compress();
    matrix.reinit(pattern);
    std::vector<double> coefficients(nodes.n_owned(), 0.);
    for (const auto &load : loads.with_coefficient())
      if (free_nodes.local_element(load.node) > 0.)
        coefficients[load.node] += load.coefficient;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        double diag = coefficients[i] + of_outside[i];
        columns.assign(1, nodes.partitioner()->local_to_global(i));
        values.assign(1, 0.);
        for (unsigned int k = starts[i]; k < starts[i + 1]; ++k)
          {
            const auto [j, c] = entries[k];
            diag += c;
            columns.push_back(nodes.partitioner()->local_to_global(j));
            values.push_back(free_nodes.local_element(j) > 0. ? -c : 0.);
          }
        // A node without near neighbours keeps its own diagonal, so that the matrix stays regular.
        values[0] = diag > 0. ? diag : stiffness_diagonal.local_element(i);
        matrix.set(columns[0], columns.size(), columns.data(), values.data());
      }
    matrix.compress(VectorOperation::insert);
  }


  template class BondOperator<1>;
  template class BondOperator<2>;
  template class BondOperator<3>;
} // namespace PeriDeal
