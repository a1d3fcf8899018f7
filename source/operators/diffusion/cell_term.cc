// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/matrix_rows.h>
#include <perideal/base/place_text.h>
#include <perideal/base/user_error.h>
#include <perideal/base/worst_trip.h>
#include <perideal/operators/diffusion/cell_term.h>
#include <perideal/operators/parts/element_layout.h>
#include <perideal/scene/not_positive.h>

#include <algorithm>
#include <numeric>

// The matrix, and how it changes with cracks and temperatures.

namespace PeriDeal
{
  using namespace dealii;

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


    void add_pair(TrilinosWrappers::SparsityPattern &pattern, const ContactPair &pair)
    {
      pattern.add(pair.own, pair.own);
      pattern.add(pair.own, pair.other);
    }


    void add_pair(TrilinosWrappers::SparseMatrix &matrix, const ContactPair &pair)
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


    /** Call visit(owned unknown, place), once for each of its cells. Not collective. */
    template <int dim, typename Visit>
    void for_each_owned_place(const DoFHandler<dim>             &dofs,
                              const Utilities::MPI::Partitioner &layout,
                              const Visit                       &visit)
    {
      for_each_support_point(dofs, [&](const auto dof, const Point<dim> &p) {
        if (layout.in_local_range(dof))
          visit(layout.global_to_local(dof), p);
      });
    }


    template <int dim>
    std::string place_of_unknown(const DoFHandler<dim>             &dofs,
                                 const Utilities::MPI::Partitioner &layout,
                                 const unsigned int                 unknown)
    {
      Point<dim> found;
      for_each_owned_place(dofs, layout, [&](const unsigned int i, const Point<dim> &p) {
        if (i == unknown)
          found = p;
      });
      return place_text(found);
    }
  } // namespace


  template <int dim>
  CellTerm<dim>::CellTerm(const DoFHandler<dim>         &dof_handler,
                          const BodyParameters<dim>     &body,
                          std::unique_ptr<Coupling<dim>> coupling,
                          const FieldParts<dim>         &parts)
    : MatrixTerm<dim>(!(coupling && coupling->bonds_of_form() != nullptr),
                      !coupling || coupling->symmetric())
    , dofs(dof_handler)
    , body(body)
    , zone_bonds(coupling ?
                   std::make_unique<BondsBesideElements<dim>>(std::move(coupling), crack_factors) :
                   nullptr)
    , hanging(std::make_shared<const HangingNodes<dim>>(dofs, *parts.layout))
    , contact(contact_pairs(dofs, body.cracks))
    , loads(std::make_shared<HeatLoads<dim>>(dofs,
                                             parts.layout,
                                             body.boundary_conditions,
                                             body.initial_and_source.source,
                                             *hanging))
    , cell_material(dofs, body.material, body.initial_and_source.initial_value, body.run.steady)
    , constraints(std::make_shared<ElementConstraints<dim>>(dofs,
                                                            *parts.layout,
                                                            body.boundary_conditions,
                                                            hanging,
                                                            loads->part_unknowns()))
    , capacity(std::make_shared<CellCapacity<dim>>(
        parts.layout,
        cell_material,
        *hanging,
        body.material.storage_depends_on_temperature(),
        body.run.steady,
        !zone_bonds && body.finite_elements.consistent_capacity)) // bonds need it diagonal
    , cells(dofs,
            cell_material,
            zone_bonds.get(),
            crack_factors,
            {body.cracks.on_faces(),
             body.cracks.mesh == CrackMesh::removed,
             body.cracks.contact_conductance,
             [&body] { return body.horizon(); }})
  {
    if (zone_bonds && parts.start > 0.)
      {
        ChangeSet<dim> from_start;
        from_start.to = parts.cracks_of;
        zone_bonds->change_bonds(from_start, {});
      }
    cells.cut().set(parts.history.pieces(parts.cracks_of),
                    parts.history.transmission(parts.cracks_of));
    TrilinosWrappers::SparsityPattern pattern = empty_pattern(dofs);
    if (!apart() || body.initial_and_source.source.depends_on_temperature())
      DoFTools::make_sparsity_pattern(dofs, pattern, hanging->constraints(), false);
    if (zone_bonds)
      zone_bonds->add_pattern(dofs, pattern);
    for (const ContactPair &pair : contact)
      add_pair(pattern, pair);
    pattern.compress();
    this->matrix.reinit(pattern);
    capacity->reinit(pattern);
    fill();
    if (apart())
      zone_bonds->make_form(body.peridynamics.form);
  }


  template <int dim>
  void CellTerm<dim>::give(FieldParts<dim> &parts) const
  {
    parts.capacity       = capacity;
    parts.values         = constraints;
    parts.loads          = loads;
    parts.for_each_place = [&dofs  = dofs,
                            layout = parts.layout](const typename FieldParts<dim>::Visit &visit) {
      for_each_owned_place(dofs, *layout, visit);
    };
  }


  template <int dim>
  void CellTerm<dim>::fill()
  {
    const auto &layout = capacity->lumped().get_partitioner();
    if (body.peridynamics.scales_beside_cracks() && body.cracks.cut_pairs() &&
        !body.cracks.cracks.empty())
      cells.find_factors(Vector(layout));
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          auto &data = cells.assemble(cell);
          loads->find_transfer(cell, data.transfer);
          data.stiffness.add(1., data.transfer);
          if (!(zone_bonds && zone_bonds->leaves_nothing(cell)))
            hanging->add_to(this->matrix, data.stiffness, data.indices);
          capacity->add(data.mass, data.indices);
        }
    if (zone_bonds)
      zone_bonds->add_to(this->matrix);
    for (const ContactPair &pair : contact)
      add_pair(this->matrix, pair);
    this->matrix.compress(VectorOperation::add);
    if (loads->depends_on_solution())
      {
        this->keep_matrix();
        add_tangents(this->matrix);
      }
    if (apart())
      this->keep_rows(*layout);
    capacity->compress();
  }


  template <int dim>
  void CellTerm<dim>::add_tangents(TrilinosWrappers::SparseMatrix &sum) const
  {
    const unsigned int                   n = dofs.get_fe().n_dofs_per_cell();
    FullMatrix<double>                   of_cell(n, n);
    std::vector<types::global_dof_index> indices(n);
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && loads->find_tangents(cell, of_cell))
        {
          cell->get_dof_indices(indices);
          hanging->add_to(sum, of_cell, indices);
        }
    sum.compress(VectorOperation::add);
  }


  template <int dim>
  void CellTerm<dim>::begin(const At &at, double &entering) const
  {
    if (apart())
      zone_bonds->begin(at, entering);
  }


  template <int dim>
  void CellTerm<dim>::set_then(Vector &y, const At &at, const Operator::RowsAction &finish) const
  {
    if (!apart())
      {
        MatrixTerm<dim>::set_then(y, at, finish);
        return;
      }
    zone_bonds->set_then(y, at, [&](const unsigned int begin, const unsigned int end) {
      this->add(y, at, begin, end);
      finish(begin, end);
    });
  }


  template <int dim>
  void CellTerm<dim>::add_rows(Vector &diagonal, std::vector<double> &sums, const Rows &rows) const
  {
    if (apart())
      zone_bonds->add_rows(diagonal, sums, rows);
    MatrixTerm<dim>::add_rows(diagonal, sums, rows);
  }


  template <int dim>
  void CellTerm<dim>::require_held(const RowsOfK &of_all) const
  {
    using After                        = RowsOfK::After;
    constexpr unsigned int none        = numbers::invalid_unsigned_int;
    const auto            &layout      = *capacity->lumped().get_partitioner();
    const bool             may_isolate = zone_bonds && zone_bonds->has_damage();
    const auto            &rows        = of_all.rows;
    unsigned int           found       = none;
    for (std::size_t k = 0; k < rows.size(); ++k)
      {
        const double stored = capacity->lumped().local_element(rows[k]);
        // Cells are taken away by subtraction, which leaves round-off behind.
        const bool holds = of_all.after == After::change ?
                             of_all.sums[k] > 1e-13 * of_all.largest_rate * stored :
                             of_all.diagonal.local_element(rows[k]) > 0.;
        if ((!may_isolate && !holds) || (of_all.after == After::new_temperatures && !(stored > 0.)))
          if (found == none || of_all.after == After::start) // then the last one
            found = rows[k];
      }
    std::string message;
    if (found != none)
      {
        const std::string place = place_of_unknown(dofs, layout, found);
        message =
          of_all.after == After::new_temperatures ?
            "'Conductivity', 'Density' or 'Heat capacity' in section 'Material' is not positive at the temperatures near " +
              place + "; they must be positive at every temperature that the run reaches." :
          zone_bonds && of_all.after == After::start ?
            "The node at " + place +
              " is isolated: the cracks of section 'Cracks' cut all of its bonds and pairs." :
          zone_bonds ?
            "The node at " + place +
              " becomes isolated: the growing cracks cut all of its bonds and pairs." :
          of_all.after == After::start ?
            "'Mesh' in section 'Cracks': the cracks leave a finite element node without any "
            "conducting cell. Use 'pairs' or a finer mesh." :
            "'Mesh' in section 'Cracks': the growing cracks leave the finite element node at " +
              place + " without any conducting cell. Use 'pairs' or a finer mesh.";
      }
    if (of_all.after == After::new_temperatures &&
        Utilities::MPI::max(message.empty() ? 0 : 1, dofs.get_communicator()) > 0)
      throw_lowest_if_any(
        dofs.get_communicator(),
        lowest_material(dofs, body.material, body.run.steady, cell_material.temperatures_taken()));
    throw_on_all_if_any(dofs.get_communicator(), message);
  }


  template <int dim>
  void CellTerm<dim>::take_material_at(const Vector &u)
  {
    if (!body.material.depends_on_temperature())
      {
        this->restore_matrix();
        add_tangents(this->matrix);
        if (apart())
          this->keep_rows(*capacity->lumped().get_partitioner());
        return;
      }
    cell_material.take(u);
    if (zone_bonds && body.material.conductivity.depends_on_temperature())
      zone_bonds->take_conductivities_at(cell_material.temperatures_taken());
    this->matrix = 0.;
    capacity->clear();
    fill();
  }


  template <int dim>
  Mended CellTerm<dim>::apply_change(const ChangeSet<dim> &change)
  {
    if (change.cuts.empty())
      return {};
    if (!event)
      event = std::make_unique<EventWork<dim>>(dofs, capacity->lumped(), constraints->held());
    const auto joins = boxes_beside(change.cuts,
                                    zone_bonds ? zone_bonds->coupling().joining_by(change.to) :
                                                 std::vector<BoundingBox<dim>>(),
                                    dofs.get_communicator());
    mend(change, joins);
    Mended mended;
    mended.rows = event->touched.rows();
    event->touched.clear();
    const bool stiffer =
      Utilities::MPI::max(cells.cut().pairs_are_stiffer() ? 1 : 0, dofs.get_communicator()) > 0;
    mended.stiffer     = stiffer || !joins.empty() || !crack_factors.empty();
    mended.local_bound = [this](const Rows &rows, const Vector &noise, const double enough) {
      return apart() ?
               -1. :
               event->bound(this->matrix, capacity->lumped(), event->held, rows, noise, enough);
    };
    return mended;
  }


  template <int dim>
  void CellTerm<dim>::mend(const ChangeSet<dim> &change, const std::vector<BoundingBox<dim>> &joins)
  {
    if (loads->depends_on_solution())
      this->restore_matrix();
    const auto  &layout = *capacity->lumped().get_partitioner();
    const auto  &cuts   = change.cuts;
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
        old_rows = zone_bonds->change_bonds(change, nodes);
      }
    cells.cut().set(near,
                    body.cracks.pieces(change.to),
                    body.cracks.transmission.value(Point<dim>(), change.to),
                    zone_bonds ? &zone_bonds->coupling().families().cracks().broken() : nullptr);
    if (scaled)
      {
        const auto beside = owned_unknowns<dim>(cells_near(0.), layout);
        cells.find_factors(near, beside, event->factors);
        event->factors.clear(owned_unknowns<dim>(near, layout));
        event->factors.clear(beside);
      }
    add_changes(near, old);
    if (zone_bonds)
      zone_bonds->add_changes(nodes, old_rows, this->matrix, event->touched);
    this->matrix.compress(VectorOperation::add);
    if (loads->depends_on_solution())
      {
        this->keep_matrix();
        add_tangents(this->matrix);
      }
    if (apart())
      {
        zone_bonds->change_form(nodes, event->touched);
        this->keep_rows(layout);
      }
    event->touched.compress();
    event->touched.sort();
  }


  template <int dim>
  void CellTerm<dim>::add_changes(const std::vector<Cell>               &changed,
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
            hanging->add_to(this->matrix, data.stiffness, data.indices);
          event->touch(data.indices, *hanging);
        }
  }


  template <int dim>
  void CellTerm<dim>::add_flows(Balance &balance, const At &at) const
  {
    if (!body.cracks.conduct())
      return;
    if (zone_bonds)
      zone_bonds->add_heat(at.u, balance);
    cells.add_heat(at.u, balance);
    // Each pair comes up at both of its ends.
    const Vector wide = with_columns_as_ghosts(at.u, this->matrix);
    for (const ContactPair &pair : contact)
      balance.cracks[pair.crack] +=
        0.5 * pair.side * pair.conductance * (wide(pair.other) - wide(pair.own));
  }


  template <int dim>
  void CellTerm<dim>::add_to(OperatorSize &size) const
  {
    MatrixTerm<dim>::add_to(size);
    if (zone_bonds)
      zone_bonds->add_to(size);
  }


  template <int dim>
  void CellTerm<dim>::visit_conductances(
    const std::function<void(const unsigned int, const unsigned int, const double)> &visit) const
  {
    const auto &layout = capacity->lumped().get_partitioner();
    for_each_entry(this->matrix, [&](const unsigned int i, const auto column, const double value) {
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
  void CellTerm<dim>::assemble_intact(TrilinosWrappers::SparseMatrix &matrix,
                                      const bool                      with_bonds) const
  {
    const auto                       &layout  = capacity->lumped().get_partitioner();
    TrilinosWrappers::SparsityPattern pattern = empty_pattern(dofs);
    DoFTools::make_sparsity_pattern(dofs, pattern, hanging->constraints(), false);
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
          hanging->add_to(matrix, data.stiffness, data.indices);
        }
    matrix.compress(VectorOperation::add);
  }


  template <int dim>
  void CellTerm<dim>::make_surrogate(TrilinosWrappers::SparseMatrix &matrix,
                                     const Vector                   &others) const
  {
    (void)others;
    Assert(others.linfty_norm() == 0., ExcMessage("What sides add is in the matrices of cells."));
    if (!apart())
      {
        matrix.copy_from(this->matrix);
        return;
      }
    // Finite elements with the same cracks conduct nearly like the bonds.
    TrilinosWrappers::SparsityPattern pattern = empty_pattern(dofs);
    DoFTools::make_sparsity_pattern(dofs, pattern, hanging->constraints(), false);
    for (const ContactPair &pair : contact)
      add_pair(pattern, pair);
    pattern.compress();
    matrix.reinit(pattern);
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          auto &data = cells.assemble(cell, false);
          loads->find_transfer(cell, data.transfer);
          data.stiffness.add(1., data.transfer);
          hanging->add_to(matrix, data.stiffness, data.indices);
        }
    for (const ContactPair &pair : contact)
      add_pair(matrix, pair);
    matrix.compress(VectorOperation::add);
    if (loads->depends_on_solution())
      add_tangents(matrix);
  }


  template <int dim>
  std::unique_ptr<FieldOperator<dim>> field_of_elements(const DoFHandler<dim>         &dof_handler,
                                                        const BodyParameters<dim>     &body,
                                                        std::unique_ptr<Coupling<dim>> coupling,
                                                        const double                   start)
  {
    FieldParts<dim> parts(body, start);
    parts.layout = element_layout(dof_handler, coupling.get());
    const auto cells =
      std::make_shared<CellTerm<dim>>(dof_handler, body, std::move(coupling), parts);
    cells->give(parts);
    parts.terms = {cells};
    return std::make_unique<FieldOperator<dim>>(body, parts);
  }


  PERIDEAL_INSTANTIATE_CLASS(class CellTerm);
  PERIDEAL_INSTANTIATE_FUNCTION(field_of_elements);
} // namespace PeriDeal
