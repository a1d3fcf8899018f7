// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

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

  namespace
  {
    /** Each pair comes up at both of its ends. */
    void add_contact_heat(Balance &balance, const std::vector<ContactPair> &pairs, const Vector &u)
    {
      for (const ContactPair &pair : pairs)
        balance.cracks[pair.crack] +=
          0.5 * pair.side * pair.conductance * (u(pair.other) - u(pair.own));
    }
  } // namespace


  template <int dim>
  void FEMOperator<dim>::require(const BodyParameters<dim> &body, const bool coupled)
  {
    DiffusionOperatorBase<dim>::require(body);
    if (coupled)
      return Coupling<dim>::require(body);
    body.finite_elements.refuse(
      body.finite_elements.degree > 1 && !body.cracks.cracks.empty() && body.cracks.cut_pairs(),
      "Degree",
      "found " + std::to_string(body.finite_elements.degree) +
        "; cracks with 'Mesh' in section 'Cracks' = pairs need degree 1.");
  }


  template <int dim>
  FEMOperator<dim>::FEMOperator(const DoFHandler<dim>         &dof_handler,
                                const BodyParameters<dim>     &body,
                                std::unique_ptr<Coupling<dim>> coupling,
                                const double                   start)
    : DiffusionOperatorBase<dim>(body,
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
    , cell_material(dofs, body.material, body.initial_and_source.initial_value, body.steady)
    , prescribed(dofs, *layout, body.boundary_conditions, hanging, loads.part_unknowns())
    , cells(dofs,
            cell_material,
            zone_bonds.get(),
            crack_factors,
            {body.cracks.on_faces(),
             body.cracks.mesh == CrackMesh::removed,
             body.cracks.contact_conductance,
             [&body] { return body.horizon(); }})
  {
    if (zone_bonds && start > 0.)
      {
        ChangeSet<dim> from_start;
        from_start.to = this->cracks_of;
        zone_bonds->apply_change(from_start, {});
      }
    cells.cut().set(history.pieces(this->cracks_of), history.transmission(this->cracks_of));
    assemble();
    find_diagonal();
    find_gershgorin();
  }


  template <int dim>
  void FEMOperator<dim>::find_diagonal()
  {
    if (apart())
      {
        zone_bonds->make_form();
        for (unsigned int i = 0; i < stiffness_diagonal.locally_owned_size(); ++i)
          stiffness_diagonal.local_element(i) = zone_bonds->sum_of(i);
      }
    for_each_entry(stiffness, [&](const unsigned int i, const auto column, const double value) {
      if (column == layout->local_to_global(i))
        stiffness_diagonal.local_element(i) += value;
    });
  }


  template <int dim>
  void FEMOperator<dim>::find_gershgorin()
  {
    const bool          may_isolate = zone_bonds && zone_bonds->has_damage();
    std::string         message;
    double              bound = 0.;
    std::vector<double> row_sums(stiffness_diagonal.locally_owned_size(), 0.);
    for (unsigned int i = 0; zone_bonds && i < row_sums.size(); ++i)
      row_sums[i] = 2. * zone_bonds->sum_of(i);
    for_each_entry(stiffness, [&](const unsigned int row, const auto, const double value) {
      row_sums[row] += std::abs(value);
    });
    for (const unsigned int node : hanging.owned())
      row_sums[node] = 0.;
    for (unsigned int i = 0; i < stiffness_diagonal.locally_owned_size(); ++i)
      {
        if (!may_isolate && !(stiffness_diagonal.local_element(i) > 0.))
          message =
            zone_bonds ?
              "The node at " + this->place_of(i) +
                " is isolated: the cracks of section 'Cracks' cut all of its bonds and pairs." :
              "'Mesh' in section 'Cracks': the cracks leave a finite element node without any "
              "conducting cell. Use 'pairs' or a finer mesh.";
        bound = std::max(bound, row_sums[i] / capacity.local_element(i));
      }
    throw_on_all_if_any(dofs.get_communicator(), message);
    bounds.set(Utilities::MPI::max(bound, dofs.get_communicator()));
    prescribed.mask(stiffness_diagonal, 1.);
  }


  template <int dim>
  void FEMOperator<dim>::multiply_then(Vector &y, const Vector &x, const RowsAction &finish) const
  {
    if (apart())
      {
        zone_bonds->multiply_then(y, x, finish);
        return;
      }
    MatrixProduct(stiffness).vmult(y, x);
    finish(0, y.locally_owned_size());
  }


  template <int dim>
  void FEMOperator<dim>::multiply(Vector &y, const Vector &x) const
  {
    multiply_then(y, x, [](const unsigned int, const unsigned int) {});
  }


  template <int dim>
  void FEMOperator<dim>::apply_then(Vector &y, const Vector &x, const RowsAction &finish) const
  {
    ++this->applications;
    double &entered = this->entering_now;
    entered         = loads.through_transfer(x);
    multiply_then(y, x, [&](const unsigned int begin, const unsigned int end) {
      entered += prescribed.sum(y, begin, end);
      prescribed.mask(y, 0., begin, end);
      finish(begin, end);
    });
  }


  template <int dim>
  void FEMOperator<dim>::residual_then(Vector           &r,
                                       const Vector     &u,
                                       const double      t,
                                       const RowsAction &finish) const
  {
    ++this->applications;
    multiply(r, u);
    const Vector      &now = loads.at(t);
    const unsigned int n   = r.locally_owned_size();
    this->entering_now     = loads.through_transfer(u) + prescribed.sum(r, 0, n) +
                         (loads.sum() - prescribed.sum(now, 0, n));
    r.sadd(-1., 1., now);
    prescribed.mask(r);
    finish(0, n);
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
    const MappingQ1<dim>                 mapping;
    std::vector<types::global_dof_index> indices(dofs.get_fe().n_dofs_per_cell());
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial())
        {
          cell->get_dof_indices(indices);
          for (unsigned int i = 0; i < indices.size(); ++i)
            if (vector.in_local_range(indices[i]))
              vector(indices[i]) = position_noise(
                mapping.transform_unit_to_real_cell(cell, dofs.get_fe().unit_support_point(i)));
        }
  }


  template <int dim>
  void FEMOperator<dim>::surrogate(TrilinosWrappers::SparseMatrix &matrix) const
  {
    if (apart())
      assemble_surrogate(matrix);
    else
      matrix.copy_from(stiffness);
    Vector marked(layout);
    prescribed.mask(marked, 1.);
    const Vector held = with_columns_as_ghosts(marked, matrix);
    for_each_entry(matrix, [&](const unsigned int i, const auto column, double &value) {
      const bool is_held = held.local_element(i) > 0.;
      if (column == held.get_partitioner()->local_to_global(i))
        value = is_held ? 1. : value;
      else if (is_held || held(column) > 0.)
        value = 0.;
    });
  }


  template <int dim>
  void FEMOperator<dim>::find_flows(Balance      &balance,
                                    Vector       &heat,
                                    const Vector &u,
                                    const double  t) const
  {
    multiply(heat, u);
    heat -= loads.at(t);
    prescribed.add_to(balance.sides, heat);
    loads.add_to(balance, u, t);
    if (body.cracks.conduct())
      {
        if (zone_bonds)
          zone_bonds->add_heat(u, balance);
        cells.add_heat(u, balance);
        add_contact_heat(balance, contact, with_columns_as_ghosts(u, stiffness));
      }
    balance.content = heat_of(u);
  }


  template <int dim>
  Point<dim> FEMOperator<dim>::position(const unsigned int local_index) const
  {
    const auto                           dof = layout->local_to_global(local_index);
    std::vector<types::global_dof_index> indices(dofs.get_fe().n_dofs_per_cell());
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial())
        {
          cell->get_dof_indices(indices);
          const auto found = std::find(indices.begin(), indices.end(), dof);
          if (found != indices.end())
            return MappingQ1<dim>().transform_unit_to_real_cell(
              cell,
              dofs.get_fe().unit_support_point(found - indices.begin()));
        }
    Assert(false, ExcInternalError());
    return Point<dim>();
  }


  template <int dim>
  OperatorSize FEMOperator<dim>::size() const
  {
    OperatorSize size = DiffusionOperatorBase<dim>::size();
    size.form         = "matrix";
    size.nonzeros     = stiffness.n_nonzero_elements();
    size.memory +=
      stiffness.memory_consumption() + mass.memory_consumption() + loads.memory_consumption();
    if (!apart())
      {
        const Utilities::MPI::MinMaxAvg work =
          Utilities::MPI::min_max_avg(stiffness.trilinos_matrix().NumMyNonzeros(),
                                      dofs.get_communicator());
        size.busiest = work.max / work.avg;
      }
    if (zone_bonds)
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
    return Utilities::MPI::sum(heat_of(u), dofs.get_communicator());
  }


  template <int dim>
  double FEMOperator<dim>::heat_of(const Vector &u) const
  {
    if (this->capacity_depends_on_solution() || body.steady)
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
    stiffness.reinit(pattern);
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
            hanging.add_to(stiffness, data.stiffness, data.indices);
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
      zone_bonds->add_to(stiffness);
    for (const ContactPair &pair : contact)
      add_to(stiffness, pair);
    stiffness.compress(VectorOperation::add);
    if (apart())
      zone_bonds->take_remainder(stiffness);
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
    stiffness = 0.;
    mass      = 0.;
    capacity  = 0.;
    fill();
    const bool  may_isolate = zone_bonds && zone_bonds->has_damage();
    std::string message;
    for (unsigned int i = 0; i < capacity.locally_owned_size() && message.empty(); ++i)
      {
        const auto index = capacity.get_partitioner()->local_to_global(i);
        stiffness_diagonal.local_element(i) =
          stiffness.diag_element(index) + (zone_bonds ? zone_bonds->sum_of(i) : 0.);
        if ((!may_isolate && !(stiffness_diagonal.local_element(i) > 0.)) ||
            !(capacity.local_element(i) > 0.))
          message =
            "'Conductivity', 'Density' or 'Heat capacity' in section 'Material' is not positive at the temperatures near " +
            this->place_of(i) +
            "; they must be positive at every temperature that the run reaches.";
      }
    if (Utilities::MPI::max(message.empty() ? 0 : 1, dofs.get_communicator()) > 0)
      throw_lowest_if_any(dofs.get_communicator(),
                          lowest_material(dofs, body.material, body.steady, u));
    throw_on_all_if_any(dofs.get_communicator(), message);
    find_gershgorin();
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
    std::vector<unsigned int>               nodes;
    typename BondsBesideElements<dim>::Rows old_rows;
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
      zone_bonds->add_changes(nodes, old_rows, stiffness, event->touched);
    stiffness.compress(VectorOperation::add);
    if (apart())
      {
        zone_bonds->change_form(nodes, event->touched);
        zone_bonds->take_remainder(stiffness);
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
            hanging.add_to(stiffness, data.stiffness, data.indices);
          event->touch(data.indices, hanging);
        }
  }


  template <int dim>
  void FEMOperator<dim>::update_rows(const bool zone_moves, const bool may_isolate)
  {
    const auto &partitioner = *stiffness_diagonal.get_partitioner();
    std::string message;
    double      bound = 0.;
    for (const unsigned int i : event->touched.rows())
      {
        const double from_form              = zone_bonds ? zone_bonds->sum_of(i) : 0.;
        double       sum                    = 2. * from_form;
        stiffness_diagonal.local_element(i) = from_form;
        for_each_entry_of_row(stiffness, i, [&](const auto column, const double value) {
          sum += std::abs(value);
          if (column == partitioner.local_to_global(i))
            stiffness_diagonal.local_element(i) = from_form + value;
        });
        bound = std::max(bound, sum / capacity.local_element(i));
        // Cells are taken away by subtraction, which leaves round-off behind.
        if (!may_isolate && message.empty() &&
            !(sum > 1e-13 * bounds.safe() * capacity.local_element(i)))
          message =
            zone_bonds ?
              "The node at " + this->place_of(i) +
                " becomes isolated: the growing cracks cut all of its bonds and pairs." :
              "'Mesh' in section 'Cracks': the growing cracks leave the finite element node at " +
                this->place_of(i) + " without any conducting cell. Use 'pairs' or a finer mesh.";
        if (event->held.contains(i))
          stiffness_diagonal.local_element(i) = 1.;
      }
    throw_on_all_if_any(dofs.get_communicator(), message);
    const bool stiffer =
      Utilities::MPI::max(cells.cut().pairs_are_stiffer() ? 1 : 0, dofs.get_communicator()) > 0;
    if (stiffer || zone_moves || !crack_factors.empty() || history.may_close())
      {
        // Rates can have grown. Where cells are only cut, the old bounds still hold.
        bounds.raise(Utilities::MPI::max(bound, dofs.get_communicator()),
                     event->touched.rows(),
                     [&](const double enough) {
                       return apart() || !symmetric() ? -1. :
                                                        event->bound(stiffness,
                                                                     capacity,
                                                                     event->held,
                                                                     event->touched.rows(),
                                                                     this->noise(),
                                                                     enough);
                     });
      }
  }


  template <int dim>
  void FEMOperator<dim>::visit_conductances(
    const std::function<void(const unsigned int, const unsigned int, const double)> &visit) const
  {
    for_each_entry(stiffness, [&](const unsigned int i, const auto column, const double value) {
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
  void FEMOperator<dim>::assemble_surrogate(TrilinosWrappers::SparseMatrix &matrix) const
  {
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


  template class FEMOperator<1>;
  template class FEMOperator<2>;
  template class FEMOperator<3>;
} // namespace PeriDeal
