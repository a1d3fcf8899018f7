// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/mapping_q1.h>

#include <perideal/base/matrix_product.h>
#include <perideal/base/matrix_rows.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/diffusion/fem_operator.h>
#include <perideal/operators/parts/element_layout.h>

#include <algorithm>

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


  template class FEMOperator<1>;
  template class FEMOperator<2>;
  template class FEMOperator<3>;
} // namespace PeriDeal
