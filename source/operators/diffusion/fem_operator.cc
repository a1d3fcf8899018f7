// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/matrix_product.h>
#include <perideal/base/matrix_rows.h>
#include <perideal/base/user_error.h>
#include <perideal/base/worst_trip.h>
#include <perideal/operators/diffusion/fem_operator.h>
#include <perideal/operators/parts/element_layout.h>
#include <perideal/operators/parts/lumped_mass.h>
#include <perideal/scene/not_positive.h>

#include <algorithm>
#include <cmath>

// The matrix, and how it changes with cracks and temperatures.

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  FEMOperator<dim>::FEMOperator(const DoFHandler<dim>         &dof_handler,
                                const BodyParameters<dim>     &body,
                                std::unique_ptr<Coupling<dim>> coupling,
                                const double                   start)
    : FieldOperator<dim>(body,
                         start,
                         element_layout(dof_handler, coupling.get()),
                         [this](Vector &vector) { fill_noise(vector); })
    , dofs(dof_handler)
    , zone_bonds(coupling ?
                   std::make_unique<BondsBesideElements<dim>>(std::move(coupling), crack_factors) :
                   nullptr)
    , hanging(dofs, *layout)
    , contact(contact_pairs(dofs, body.cracks))
    , loads(dofs, layout, body.boundary_conditions, body.initial_and_source.source, hanging)
    , cell_material(dofs, body.material, body.initial_and_source.initial_value, body.run.steady)
    , prescribed(dofs, *layout, body.boundary_conditions, hanging, loads.part_unknowns())
    , cells(dofs,
            cell_material,
            zone_bonds.get(),
            crack_factors,
            {body.cracks.on_faces(),
             body.cracks.mesh == CrackMesh::removed,
             body.cracks.contact_conductance,
             [&body] { return body.horizon(); }})
    , cell_term(!apart(), !zone_bonds || zone_bonds->coupling().symmetric())
  {
    if (apart())
      this->set_parts(prescribed, loads, {zone_bonds.get(), &cell_term});
    else
      this->set_parts(prescribed, loads, {&cell_term});
    if (zone_bonds && start > 0.)
      {
        ChangeSet<dim> from_start;
        from_start.to = this->cracks_of;
        zone_bonds->apply_change(from_start, {});
      }
    cells.cut().set(history.pieces(this->cracks_of), history.transmission(this->cracks_of));
    assemble();
    if (apart())
      zone_bonds->make_form(body.peridynamics.form);
    const Rows all = this->all_rows();
    find_bounds(all, this->take_rows(all));
  }


  template <int dim>
  bool FEMOperator<dim>::counts(const unsigned int row) const
  {
    return !std::binary_search(hanging.owned().begin(), hanging.owned().end(), row);
  }


  template <int dim>
  void FEMOperator<dim>::find_bounds(const Rows &all, const std::vector<double> &sums)
  {
    std::string message;
    for (const unsigned int i : all)
      if (!(zone_bonds && zone_bonds->has_damage()) && !(stiffness_diagonal.local_element(i) > 0.))
        message =
          zone_bonds ?
            "The node at " + this->place_of(i) +
              " is isolated: the cracks of section 'Cracks' cut all of its bonds and pairs." :
            "'Mesh' in section 'Cracks': the cracks leave a finite element node without any "
            "conducting cell. Use 'pairs' or a finer mesh.";
    throw_on_all_if_any(dofs.get_communicator(), message);
    bounds.set(this->largest_rate(all, sums));
    prescribed.mask(stiffness_diagonal, 1.);
  }


  template <int dim>
  bool FEMOperator<dim>::capacity_is_diagonal() const
  {
    return zone_bonds || !body.finite_elements.consistent_capacity; // bonds need it diagonal
  }

  template <int dim>
  void FEMOperator<dim>::apply_capacity(Vector &y, const Vector &x) const
  {
    if (capacity_is_diagonal())
      DiffusionOperatorBase<dim>::apply_capacity(y, x);
    else
      MatrixProduct(mass).vmult(y, x);
  }


  template <int dim>
  void FEMOperator<dim>::fill_noise(Vector &vector) const
  {
    for_each_support_point(dofs, [&](const auto dof, const Point<dim> &p) {
      if (layout->in_local_range(dof))
        vector(dof) = position_noise(p);
    });
  }


  template <int dim>
  Point<dim> FEMOperator<dim>::position(const unsigned int local_index) const
  {
    const auto wanted = layout->local_to_global(local_index);
    Point<dim> found;
    for_each_support_point(dofs, [&](const auto dof, const Point<dim> &p) {
      if (dof == wanted)
        found = p;
    });
    return found;
  }


  template <int dim>
  void FEMOperator<dim>::add_crack_heat(Balance &balance, const Vector &u) const
  {
    if (zone_bonds)
      zone_bonds->add_heat(u, balance);
    cells.add_heat(u, balance);
    // Each pair comes up at both of its ends.
    const Vector wide = with_columns_as_ghosts(u, cell_term.matrix);
    for (const ContactPair &pair : contact)
      balance.cracks[pair.crack] +=
        0.5 * pair.side * pair.conductance * (wide(pair.other) - wide(pair.own));
  }


  template <int dim>
  OperatorSize FEMOperator<dim>::size() const
  {
    OperatorSize size = FieldOperator<dim>::size();
    size.memory += mass.memory_consumption();
    if (zone_bonds && !apart())
      zone_bonds->add_to(size);
    return size;
  }


  template <int dim>
  void FEMOperator<dim>::heat_between(Vector &y, const Vector &u, const Vector &v) const
  {
    if (this->capacity_depends_on_solution())
      {
        cell_material.heat_between(y, u, v, capacity_is_diagonal());
        hanging.condense(y);
        return;
      }
    Operator::heat_between(y, u, v);
    hanging.set(y, 0.); // the nodes they follow from have all of it
  }


  template <int dim>
  double FEMOperator<dim>::heat(const Vector &u) const
  {
    return Utilities::MPI::sum(content(u), dofs.get_communicator());
  }


  template <int dim>
  double FEMOperator<dim>::content(const Vector &u) const
  {
    if (this->capacity_depends_on_solution() || body.run.steady)
      return cell_material.content(u);
    double heat = 0.;
    for (unsigned int i = 0; i < capacity.locally_owned_size(); ++i)
      heat += capacity.local_element(i) * u.local_element(i);
    for (const unsigned int node : hanging.owned())
      heat -= capacity.local_element(node) * u.local_element(node);
    return heat;
  }


  namespace
  {
    template <int dim>
    TrilinosWrappers::SparsityPattern empty_pattern(const DoFHandler<dim> &dofs)
    {
      const IndexSet &owned = dofs.locally_owned_dofs();
      IndexSet        relevant;
      DoFTools::extract_locally_relevant_dofs(dofs, relevant);
      return TrilinosWrappers::SparsityPattern(owned, owned, relevant, dofs.get_communicator());
    }


    void add_to(TrilinosWrappers::SparsityPattern &pattern, const ContactPair &pair)
    {
      pattern.add(pair.own, pair.own);
      pattern.add(pair.own, pair.other);
    }


    void add_to(TrilinosWrappers::SparseMatrix &matrix, const ContactPair &pair)
    {
      matrix.add(pair.own, pair.own, pair.conductance);
      matrix.add(pair.own, pair.other, -pair.conductance);
    }


    /** Of the cells of this process; empty if all is positive. Collective. */
    template <int dim>
    Trip lowest_material(const DoFHandler<dim> &dofs,
                         const Material        &material,
                         const bool             steady,
                         const Vector          &u)
    {
      FEValues<dim>       values(dofs.get_fe(),
                           QGauss<dim>(dofs.get_fe().degree + 1),
                           update_values | update_quadrature_points);
      std::vector<double> temperatures(values.n_quadrature_points);
      Vector              with_ghosts(u);
      with_ghosts.update_ghost_values();
      Trip worst;
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            values.reinit(cell);
            values.get_function_values(with_ghosts, temperatures);
            for (const unsigned int q : values.quadrature_point_indices())
              {
                const Point<dim> &p       = values.quadrature_point(q);
                const double      T       = temperatures[q];
                const double      kappa   = material.conductivity.value(p, T);
                const double      storage = steady ? 1. : material.storage(p, T);
                if (!(kappa > 0.))
                  keep_lower(worst, not_positive("'Conductivity'", kappa, T, p));
                if (!(storage > 0.))
                  keep_lower(worst, not_positive("'Density' times 'Heat capacity'", storage, T, p));
              }
          }
      return worst;
    }
  } // namespace


  template <int dim>
  void FEMOperator<dim>::assemble()
  {
    TrilinosWrappers::SparsityPattern pattern = empty_pattern(dofs);
    if (!apart())
      DoFTools::make_sparsity_pattern(dofs, pattern, hanging.constraints(), false);
    if (zone_bonds)
      zone_bonds->add_pattern(dofs, pattern);
    for (const ContactPair &pair : contact)
      add_to(pattern, pair);
    pattern.compress();
    cell_term.matrix.reinit(pattern);
    if (!capacity_is_diagonal())
      mass.reinit(pattern);
    fill();
  }


  template <int dim>
  void FEMOperator<dim>::fill()
  {
    if (body.peridynamics.scales_beside_cracks() && body.cracks.cut_pairs() &&
        !body.cracks.cracks.empty())
      cells.find_factors(Vector(layout));
    dealii::Vector<double> lumps(dofs.get_fe().n_dofs_per_cell()), diagonal(lumps.size());
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const bool empty = zone_bonds && zone_bonds->leaves_nothing(cell);
          auto      &data  = cells.assemble(cell);
          loads.find_transfer(cell, data.transfer);
          data.stiffness.add(1., data.transfer);
          if (!empty)
            hanging.add_to(cell_term.matrix, data.stiffness, data.indices);
          if (!capacity_is_diagonal())
            hanging.add_to(mass, data.mass, data.indices);
          for (unsigned int a = 0; a < data.indices.size(); ++a)
            {
              lumps(a)    = 0.;
              diagonal(a) = data.mass(a, a);
              for (unsigned int b = 0; b < data.indices.size(); ++b)
                lumps(a) += data.mass(a, b);
            }
          make_positive(diagonal, lumps);
          for (unsigned int a = 0; a < data.indices.size(); ++a)
            capacity(data.indices[a]) += lumps(a);
        }
    if (zone_bonds)
      zone_bonds->add_to(cell_term.matrix);
    for (const ContactPair &pair : contact)
      add_to(cell_term.matrix, pair);
    cell_term.matrix.compress(VectorOperation::add);
    if (apart())
      cell_term.keep_rows(*layout);
    if (!capacity_is_diagonal())
      mass.compress(VectorOperation::add);
    capacity.compress(VectorOperation::add);
    hanging.condense(capacity);
    if (hanging.any()) // any value that is positive
      hanging.set(capacity, capacity.l2_norm() / std::sqrt(capacity.size()));
  }


  template <int dim>
  void FEMOperator<dim>::take_material_at(const Vector &u)
  {
    if (!this->depends_on_solution())
      return;
    cell_material.take(u);
    if (zone_bonds && body.material.conductivity.depends_on_temperature())
      zone_bonds->take_conductivities_at(cell_material.temperatures_taken());
    cell_term.matrix = 0.;
    mass             = 0.;
    capacity         = 0.;
    fill();
    const Rows  all         = this->all_rows();
    const auto  sums        = this->take_rows(all);
    const bool  may_isolate = zone_bonds && zone_bonds->has_damage();
    std::string message;
    for (unsigned int i = 0; i < capacity.locally_owned_size() && message.empty(); ++i)
      {
        if ((!may_isolate && !(stiffness_diagonal.local_element(i) > 0.)) ||
            !(capacity.local_element(i) > 0.))
          message =
            "'Conductivity', 'Density' or 'Heat capacity' in section 'Material' is not positive at the temperatures near " +
            this->place_of(i) +
            "; they must be positive at every temperature that the run reaches.";
      }
    if (Utilities::MPI::max(message.empty() ? 0 : 1, dofs.get_communicator()) > 0)
      throw_lowest_if_any(dofs.get_communicator(),
                          lowest_material(dofs, body.material, body.run.steady, u));
    throw_on_all_if_any(dofs.get_communicator(), message);
    find_bounds(all, sums);
  }


  template <int dim>
  bool FEMOperator<dim>::apply_change(const ChangeSet<dim> &change)
  {
    const auto  &cuts = change.cuts;
    const double to   = change.to;
    if (cuts.empty())
      return false;
    if (!event)
      event = std::make_unique<EventWork<dim>>(dofs, capacity, prescribed.held());
    const auto   joins  = boxes_beside(cuts,
                                    zone_bonds ? zone_bonds->coupling().joining_by(to) :
                                                    std::vector<BoundingBox<dim>>(),
                                    dofs.get_communicator());
    const bool   scaled = !crack_factors.empty();
    const double reach  = zone_bonds ? zone_bonds->coupling().families().weights().reach() : 0.;
    // The factors of crack-side scaling change at the vertices of the cells whose own matrix does,
    // and of all cells around these.
    const double wide       = scaled ? event->search.largest_diameter() : 0.;
    const auto   cells_near = [&](const double beyond) { // bonds change the cells that they pass
      return event->cells_near(cuts, beyond + (scaled ? reach : 0.), joins, beyond + reach);
    };
    const std::vector<Cell>         near = cells_near(wide);
    std::vector<FullMatrix<double>> old(near.size());
    for (std::size_t k = 0; k < near.size(); ++k)
      if (near[k]->is_locally_owned())
        old[k] = cells.assemble(near[k]).stiffness;
    std::vector<unsigned int>                       nodes;
    typename BondsBesideElements<dim>::Conductances old_rows;
    if (zone_bonds)
      {
        const double beyond = scaled ? reach + wide : 0.; // bonds have the factors of both ends
        auto         boxes  = cuts;
        boxes.insert(boxes.end(), joins.begin(), joins.end());
        nodes    = zone_bonds->coupling().families().neighbors().nodes_near(boxes, reach + beyond);
        old_rows = zone_bonds->apply_change(change, nodes);
      }
    const BrokenBonds *const broken =
      zone_bonds ? &zone_bonds->coupling().families().cracks().broken() : nullptr;
    cells.cut().set(near, history.pieces(to), history.transmission(to), broken);
    if (scaled)
      {
        const auto beside = owned_unknowns<dim>(cells_near(0.), *layout);
        cells.find_factors(near, beside, event->factors);
        event->factors.clear(owned_unknowns<dim>(near, *layout));
        event->factors.clear(beside);
      }
    add_changes(near, old);
    if (zone_bonds)
      zone_bonds->add_changes(nodes, old_rows, cell_term.matrix, event->touched);
    cell_term.matrix.compress(VectorOperation::add);
    if (apart())
      {
        zone_bonds->change_form(nodes, event->touched);
        cell_term.keep_rows(*layout);
      }
    event->touched.compress();
    event->touched.sort();
    update_rows(!joins.empty(), broken && !broken->empty());
    event->touched.clear();
    return true;
  }


  template <int dim>
  void FEMOperator<dim>::add_changes(const std::vector<Cell>               &changed,
                                     const std::vector<FullMatrix<double>> &old)
  {
    for (std::size_t k = 0; k < changed.size(); ++k)
      if (changed[k]->is_locally_owned())
        {
          auto &data = cells.assemble(changed[k]);
          data.stiffness.add(-1., old[k]);
          if (data.stiffness.linfty_norm() == 0.)
            continue;
          if (!(zone_bonds && zone_bonds->leaves_nothing(changed[k])))
            hanging.add_to(cell_term.matrix, data.stiffness, data.indices);
          event->touch(data.indices, hanging);
        }
  }


  template <int dim>
  void FEMOperator<dim>::update_rows(const bool zone_moves, const bool may_isolate)
  {
    const Rows &rows = event->touched.rows();
    const auto  sums = this->take_rows(rows);
    std::string message;
    for (std::size_t k = 0; k < rows.size(); ++k)
      // Cells are taken away by subtraction, which leaves round-off behind.
      if (!may_isolate && message.empty() &&
          !(sums[k] > 1e-13 * bounds.safe() * capacity.local_element(rows[k])))
        message =
          zone_bonds ?
            "The node at " + this->place_of(rows[k]) +
              " becomes isolated: the growing cracks cut all of its bonds and pairs." :
            "'Mesh' in section 'Cracks': the growing cracks leave the finite element node at " +
              this->place_of(rows[k]) +
              " without any conducting cell. Use 'pairs' or a finer mesh.";
    throw_on_all_if_any(dofs.get_communicator(), message);
    const bool stiffer =
      Utilities::MPI::max(cells.cut().pairs_are_stiffer() ? 1 : 0, dofs.get_communicator()) > 0;
    if (stiffer || zone_moves || !crack_factors.empty() || history.may_close())
      {
        // Rates can have grown. Where cells are only cut, the old bounds still hold.
        bounds.raise(this->largest_rate(rows, sums), rows, [&](const double enough) {
          return apart() || !this->symmetric() ?
                   -1. :
                   event
                     ->bound(cell_term.matrix, capacity, event->held, rows, this->noise(), enough);
        });
      }
    prescribed.mask(stiffness_diagonal, 1.);
  }


  template <int dim>
  void FEMOperator<dim>::visit_conductances(
    const std::function<void(const unsigned int, const unsigned int, const double)> &visit) const
  {
    for_each_entry(cell_term.matrix,
                   [&](const unsigned int i, const auto column, const double value) {
                     // The neighbours of a hanging node's neighbours may be unknown here.
                     if (!layout->in_local_range(column) && !layout->is_ghost_entry(column))
                       return;
                     const unsigned int j = layout->global_to_local(column);
                     if (i != j && value != 0.)
                       visit(i, j, -value);
                   });
    if (!apart())
      return;
    std::vector<unsigned int> node(1);
    for (node[0] = 0; node[0] < layout->locally_owned_size(); ++node[0])
      {
        const auto rows = zone_bonds->rows(node);
        for (const auto &[neighbor, conductance] : rows[0])
          visit(node[0], neighbor, conductance);
      }
  }


  template <int dim>
  void FEMOperator<dim>::assemble_intact(TrilinosWrappers::SparseMatrix &matrix,
                                         const bool                      with_bonds) const
  {
    TrilinosWrappers::SparsityPattern pattern = empty_pattern(dofs);
    DoFTools::make_sparsity_pattern(dofs, pattern, hanging.constraints(), false);
    std::vector<typename Coupling<dim>::Bond> bonds;
    std::vector<types::global_dof_index>      columns;
    std::vector<double>                       values;
    const auto                                for_each_row = [&](const auto &visit) {
      for (unsigned int i = 0; i < layout->locally_owned_size() && with_bonds; ++i)
        {
          zone_bonds->coupling().bonds_of(i, bonds);
          const auto own = layout->local_to_global(i);
          columns.assign(1, own);
          values.assign(1, 0.);
          for (const auto &bond : bonds)
            {
              columns.push_back(layout->local_to_global(bond.neighbor));
              values.push_back(-bond.intact);
              values[0] += bond.intact;
            }
          visit(own);
        }
    };
    for_each_row([&](const auto row) { pattern.add_entries(row, columns.begin(), columns.end()); });
    pattern.compress();
    matrix.reinit(pattern);
    for_each_row(
      [&](const auto row) { matrix.add(row, columns.size(), columns.data(), values.data()); });
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const auto &data = cells.assemble_intact(cell, with_bonds);
          hanging.add_to(matrix, data.stiffness, data.indices);
        }
    matrix.compress(VectorOperation::add);
  }


  template <int dim>
  void FEMOperator<dim>::make_surrogate(TrilinosWrappers::SparseMatrix &matrix) const
  {
    if (!apart())
      {
        matrix.copy_from(cell_term.matrix);
        return;
      }
    // Finite elements with the same cracks conduct nearly like the bonds.
    TrilinosWrappers::SparsityPattern pattern = empty_pattern(dofs);
    DoFTools::make_sparsity_pattern(dofs, pattern, hanging.constraints(), false);
    for (const ContactPair &pair : contact)
      add_to(pattern, pair);
    pattern.compress();
    matrix.reinit(pattern);
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          auto &data = cells.assemble(cell, false);
          loads.find_transfer(cell, data.transfer);
          data.stiffness.add(1., data.transfer);
          hanging.add_to(matrix, data.stiffness, data.indices);
        }
    for (const ContactPair &pair : contact)
      add_to(matrix, pair);
    matrix.compress(VectorOperation::add);
  }


  PERIDEAL_INSTANTIATE_CLASS(class FEMOperator);
} // namespace PeriDeal
