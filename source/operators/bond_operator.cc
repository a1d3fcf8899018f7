// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/node_loops.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/bond_operator.h>
#include <perideal/operators/spectrum.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  BondOperator<dim>::BondOperator(Nodes<dim> &nodes, const Scene<dim> &scene)
    : scene(scene)
    , families(nodes.find_parts(scene.boundary_conditions), scene)
    , bonds(families, scene)
    , constraints(std::make_unique<NodeConstraints<dim>>(bonds, scene))
    , cracks_of(bonds.cracks().history().representative(0.))
    , bounds(*this, [this](Vector &vector) {
      for (unsigned int i = 0; i < vector.locally_owned_size(); ++i)
        vector.local_element(i) = position_noise(bonds.nodes().position(i));
    })
  {
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      if (constraints->kind(i) != NodeConstraints<dim>::free)
        held.push_back(i);
    if (constraints->any_slave())
      initialize_vector(scratch);
    initialize_vector(capacity);
    find_capacity(nullptr);
    find_side_loads();
    if (scene.peridynamics.surface_correction != SurfaceCorrection::none)
      correct_surface(rows_to_correct());
    choose_form(scene.peridynamics.form);
    find_diagonal();
    outside_values.resize(bonds.neighbors().outside().size());
    outside_signs_only.resize(bonds.neighbors().outside().size());
    loads_vary = scene.initial_and_source.source.depends_on_time() ||
                 scene.boundary_conditions.depends_on_time();
    if (!loads_vary)
      {
        Vector loads;
        initialize_vector(loads);
        free_loads = add_loads_now(loads, 0.);
        if (std::any_of(loads.begin(), loads.end(), [](const double load) { return load != 0.; }))
          constant_loads.swap(loads);
      }
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
    std::string       message;
    if (scene.time.steady) // it only sets a scale then
      {
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          capacity.local_element(i) = nodes.volume(i);
        return;
      }
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const double T       = u != nullptr ?
                                 u->local_element(i) :
                                 scene.initial_and_source.initial_value.value(nodes.position(i));
        const double storage = scene.material.storage(nodes.position(i), T);
        if (!(storage > 0.) && message.empty())
          message =
            "'Density' times 'Heat capacity' in section 'Material' is " + std::to_string(storage) +
            " at a node; it must be positive everywhere in the body, at every temperature that the run reaches.";
        capacity.local_element(i) = storage * nodes.volume(i);
      }
    throw_on_all_if_any(nodes.communicator(), message);
  }


  template <int dim>
  void BondOperator<dim>::find_side_loads()
  {
    const bool        natural    = scene.peridynamics.natural_fluxes();
    const auto       &conditions = scene.boundary_conditions;
    const Nodes<dim> &nodes      = bonds.nodes();
    for (const BoundaryShare &share : nodes.condition_shares())
      {
        // Prescribed nodes have no equation, but what enters there counts in the balance of heat.
        if (constraints->kind(share.node) == NodeConstraints<dim>::slave)
          continue;
        const auto *flux       = BoundaryConditions<dim>::find(conditions.flux, share.id);
        const auto *convection = BoundaryConditions<dim>::find(conditions.convection, share.id);
        if (flux != nullptr && natural)
          fluxes.push_back({share.node, share.area, flux, nodes.place_of(share)});
        if (convection != nullptr)
          convections.push_back({share.node, share.area, convection, nodes.place_of(share)});
      }
    std::stable_sort(convections.begin(),
                     convections.end(),
                     [](const SideLoad &a, const SideLoad &b) { return a.node < b.node; });
    for (const SideLoad &load : convections)
      convection_diagonal.emplace_back(load.node,
                                       load.area * load.condition->coefficient.value(load.place));
  }


  template <int dim>
  void BondOperator<dim>::find_diagonal()
  {
    const Nodes<dim> &nodes = bonds.nodes();
    initialize_vector(bond_diagonal);
    const double n_own = form->row_sums(bond_diagonal.begin());
    std::string  message;
    for (unsigned int i = 0; i < nodes.n_owned() && message.empty(); ++i)
      message = isolation(i);
    throw_on_all_if_any(nodes.communicator(), message);
    for (const auto &[node, h] : convection_diagonal)
      bond_diagonal.local_element(node) += h;
    double bound = 0.;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      bound = std::max(bound, row_bound(i));
    bounds.set(Utilities::MPI::max(bound, nodes.communicator()));
    count_bonds(n_own);
    constraints->mask(bond_diagonal, 1.);
  }


  template <int dim>
  std::string BondOperator<dim>::isolation(const unsigned int node) const
  {
    if (bond_diagonal.local_element(node) > 0. ||
        constraints->kind(node) != NodeConstraints<dim>::free)
      return "";
    return "The node at " + place_of(node) +
           " is isolated: no bond of it is left. Check 'Horizon' in section 'Peridynamics' and the cracks in section "
           "'Cracks', which may cut all bonds of a node (a crack in 'Horizon ratio' close to 1).";
  }


  template <int dim>
  double BondOperator<dim>::row_bound(const unsigned int node) const
  {
    return constraints->kind(node) == NodeConstraints<dim>::free ?
             2. * bond_diagonal.local_element(node) / capacity.local_element(node) :
             0.;
  }


  template <int dim>
  void BondOperator<dim>::count_bonds(const double n_own) const
  {
    const MPI_Comm communicator = bonds.nodes().communicator();
    n_bonds =
      static_cast<unsigned long long>(std::llround(Utilities::MPI::sum(n_own, communicator)));
    n_nonzeros = Utilities::MPI::sum(form->n_stored(), communicator);
  }


  template <int dim>
  void BondOperator<dim>::initialize_vector(Vector &vector) const
  {
    vector.reinit(bonds.nodes().partitioner());
  }


  template <int dim>
  void BondOperator<dim>::sum_bonds(Vector &y, const Vector &x, const double *outside) const
  {
    form->apply(y.begin(), x.begin(), outside);
  }


  template <int dim>
  void BondOperator<dim>::fictitious_values(const Vector        &u,
                                            const double         t,
                                            std::vector<double> &values) const
  {
    const auto &fictitious = bonds.neighbors().outside();
    values.resize(fictitious.size());
    for (std::size_t f = 0; f < fictitious.size(); ++f)
      values[f] =
        fictitious[f].sign * u.local_element(fictitious[f].mirror) + fictitious[f].constant(t);
  }


  template <int dim>
  void BondOperator<dim>::add_convection(Vector            &y,
                                         const Vector      &x,
                                         const unsigned int begin,
                                         const unsigned int end) const
  {
    for (auto entry =
           std::lower_bound(convection_diagonal.begin(),
                            convection_diagonal.end(),
                            begin,
                            [](const auto &a, const unsigned int b) { return a.first < b; });
         entry != convection_diagonal.end() && entry->first < end;
         ++entry)
      y.local_element(entry->first) += entry->second * x.local_element(entry->first);
  }


  template <int dim>
  void BondOperator<dim>::clear_held(Vector            &y,
                                     const unsigned int begin,
                                     const unsigned int end) const
  {
    for (auto node = std::lower_bound(held.begin(), held.end(), begin);
         node != held.end() && *node < end;
         ++node)
      y.local_element(*node) = 0.;
  }


  template <int dim>
  void BondOperator<dim>::apply(Vector &y, const Vector &x) const
  {
    apply_then(y, x, [](const unsigned int, const unsigned int) {});
  }


  template <int dim>
  void BondOperator<dim>::apply_then(Vector &y, const Vector &x, const RowsAction &finish) const
  {
    ++applications;
    const Vector *input = &x;
    if (constraints->any_slave())
      {
        scratch = x;
        constraints->distribute_homogeneous(scratch);
        input = &scratch;
      }
    input->update_ghost_values();
    const auto &fictitious = bonds.neighbors().outside();
    for (std::size_t f = 0; f < fictitious.size(); ++f)
      outside_signs_only[f] = fictitious[f].sign * input->local_element(fictitious[f].mirror);
    entering_now = through_sides(*input, outside_signs_only.data());
    form->apply(y.begin(),
                input->begin(),
                outside_signs_only.data(),
                [&](const unsigned int begin, const unsigned int end) {
                  add_convection(y, *input, begin, end);
                  entering_now += through_prescribed(y, begin, end);
                  clear_held(y, begin, end);
                  finish(begin, end);
                });
    input->set_ghost_state(false);
  }


  template <int dim>
  void BondOperator<dim>::residual(Vector &r, const Vector &u, const double t) const
  {
    residual_then(r, u, t, [](const unsigned int, const unsigned int) {});
  }


  template <int dim>
  void BondOperator<dim>::residual_then(Vector           &r,
                                        const Vector     &u,
                                        const double      t,
                                        const RowsAction &finish) const
  {
    ++applications;
    u.update_ghost_values();
    fictitious_values(u, t, outside_values);
    entering_now         = through_sides(u, outside_values.data()) + through_slaves(t) + free_loads;
    double       *values = r.begin();
    const double *loads  = constant_loads.size() > 0 ? constant_loads.begin() : nullptr;
    form->apply(values,
                u.begin(),
                outside_values.data(),
                [&](const unsigned int begin, const unsigned int end) {
                  add_convection(r, u, begin, end);
                  entering_now += through_prescribed(r, begin, end);
                  if (loads != nullptr)
                    NodeLoops::subtract_from(values + begin, loads + begin, end - begin);
                  else
                    NodeLoops::negate(values + begin, end - begin);
                  clear_held(r, begin, end);
                  if (!loads_vary)
                    finish(begin, end);
                });
    u.set_ghost_state(false);
    if (loads_vary)
      {
        entering_now += add_loads_now(r, t);
        const unsigned int n = r.locally_owned_size();
        clear_held(r, 0, n);
        finish(0, n);
      }
  }


  template <int dim>
  void BondOperator<dim>::add_loads(Vector &r, const double t) const
  {
    if (loads_vary)
      add_loads_now(r, t);
    else if (constant_loads.size() > 0)
      r += constant_loads;
  }


  template <int dim>
  double BondOperator<dim>::add_loads_now(Vector &r, const double t) const
  {
    const Nodes<dim> &nodes  = bonds.nodes();
    const Expression &source = scene.initial_and_source.source;
    double            sum    = 0.;
    const auto        add    = [&](const unsigned int i, const double load) {
      r.local_element(i) += load;
      if (constraints->kind(i) == NodeConstraints<dim>::free)
        sum += load;
    };
    if (!source.is_constant() || source.value(Point<dim>()) != 0.)
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        add(i, nodes.volume(i) * source.value(nodes.position(i), t));
    for (const SideLoad &load : fluxes)
      add(load.node, load.area * load.condition->value.value(load.place, t));
    for (std::size_t k = 0; k < convections.size(); ++k)
      add(convections[k].node,
          convection_diagonal[k].second *
            convections[k].condition->value.value(convections[k].place, t));
    return sum;
  }


  template <int dim>
  void BondOperator<dim>::distribute(Vector &u, const double t) const
  {
    constraints->distribute(u, t);
  }

  template <int dim>
  void BondOperator<dim>::distribute_homogeneous(Vector &x) const
  {
    constraints->distribute_homogeneous(x);
  }

  template <int dim>
  void BondOperator<dim>::clear_constrained(Vector &y) const
  {
    constraints->mask(y);
  }

  template <int dim>
  const Vector &BondOperator<dim>::lumped_capacity() const
  {
    return capacity;
  }

  template <int dim>
  bool BondOperator<dim>::capacity_is_diagonal() const
  {
    return true;
  }

  template <int dim>
  void BondOperator<dim>::apply_capacity(Vector &y, const Vector &x) const
  {
    y = x;
    y.scale(capacity);
  }

  template <int dim>
  const Vector &BondOperator<dim>::diagonal() const
  {
    return bond_diagonal;
  }

  template <int dim>
  Spectrum BondOperator<dim>::spectrum() const
  {
    return bounds.get();
  }

  template <int dim>
  bool BondOperator<dim>::symmetric() const
  {
    return bonds.symmetric() && !constraints->any_slave();
  }

  template <int dim>
  bool BondOperator<dim>::depends_on_time() const
  {
    return loads_vary;
  }

  template <int dim>
  bool BondOperator<dim>::has_steady_state() const
  {
    return constraints->any_prescribed() || !scene.boundary_conditions.convection.empty() ||
           !scene.boundary_conditions.dirichlet.empty();
  }

  template <int dim>
  bool BondOperator<dim>::surrogate_is_exact() const
  {
    return false;
  }

  template <int dim>
  const DiffusionBonds<dim> &BondOperator<dim>::diffusion_bonds() const
  {
    return bonds;
  }

  template <int dim>
  const std::string &BondOperator<dim>::form_note() const
  {
    return note;
  }

  template <int dim>
  std::string BondOperator<dim>::place_of(const unsigned int local_index) const
  {
    std::ostringstream out;
    out << "(" << bonds.nodes().position(local_index) << ")";
    return out.str();
  }

  template <int dim>
  OperatorSize BondOperator<dim>::size() const
  {
    if (recount_bonds)
      {
        std::vector<double> sums(bonds.nodes().n_owned());
        count_bonds(form->row_sums(sums.data()));
        recount_bonds = false;
      }
    OperatorSize size;
    size.unknowns = bonds.nodes().n_global();
    size.bonds    = n_bonds;
    size.nonzeros = n_nonzeros;
    size.memory   = families.memory_consumption() + bonds.memory_consumption() +
                  bonds.nodes().memory_consumption() + form->memory_consumption() +
                  capacity.memory_consumption() + bond_diagonal.memory_consumption() +
                  constant_loads.memory_consumption() + scratch.memory_consumption();
    size.form = form->name();
    return size;
  }

  template class BondOperator<1>;
  template class BondOperator<2>;
  template class BondOperator<3>;
} // namespace PeriDeal
