// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_accessor.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <perideal/analysis/quadratic_elements.h>
#include <perideal/base/instantiate.h>
#include <perideal/operators/parts/element_layout.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>


// Second derivatives of a field of bilinear elements, and what they add in the middles of edges,
// faces and cells.

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    std::unique_ptr<DoFHandler<dim>> quadratic_dofs(const Triangulation<dim> &mesh)
    {
      auto dofs = std::make_unique<DoFHandler<dim>>(mesh);
      dofs->distribute_dofs(FE_Q<dim>(2));
      return dofs;
    }
  } // namespace


  template <int dim>
  void mark_side(const DoFHandler<dim>             &dofs,
                 const Utilities::MPI::Partitioner &layout,
                 const BodyParameters<dim>         &body,
                 const HangingNodes<dim>           &hanging,
                 const std::string                 &side,
                 Vector                            &marks)
  {
    BoundaryConditions<dim> conditions;
    conditions.parts = body.boundary_conditions.parts;
    for (SideCondition condition : body.boundary_conditions.dirichlet)
      {
        condition.value = Expression(condition.name == side ? 1. : 0.);
        conditions.dirichlet.push_back(condition);
      }
    const PrescribedValues<dim> values(
      dofs,
      layout,
      conditions,
      hanging,
      unknowns_of_parts(dofs, conditions, [&](const auto dof) { return hanging.is_hanging(dof); }));
    marks = 0.;
    values.distribute(marks, 0.);
  }


  template <int dim>
  std::string QuadraticElements<dim>::why_not(const BodyParameters<dim> &body)
  {
    if (body.finite_elements.degree != 1)
      return "'Degree' in section 'Finite elements' is not 1";
    if (body.initial_and_source.source.depends_on_temperature() ||
        depend_on_temperature(body.boundary_conditions.transfers))
      return "what enters through sides or in the body depends on the solution";
    for (const Part &part : body.boundary_conditions.parts)
      if (body.boundary_conditions.side_of(part.id) == numbers::invalid_boundary_id)
        return "there are conditions in regions or at points";
    return "";
  }


  template <int dim>
  QuadraticElements<dim>::QuadraticElements(const FieldOperator<dim>  &op,
                                            const BodyParameters<dim> &body,
                                            const Coupling<dim>       *coupling)
    : op(op)
    , body(body)
    , quadratic(quadratic_dofs(cells_of(op).dof_handler().get_triangulation()))
    , layout(element_layout(*quadratic, static_cast<const Coupling<dim> *>(nullptr)))
    , linear_layout(
        element_layout(cells_of(op).dof_handler(), static_cast<const Coupling<dim> *>(nullptr)))
    , hanging(*quadratic, *layout)
    , loads(*quadratic, layout, body.boundary_conditions, body.initial_and_source.source, hanging)
    , linear_loads(cells_of(op).dof_handler(),
                   linear_layout,
                   body.boundary_conditions,
                   body.initial_and_source.source,
                   cells_of(op).hanging_nodes())
    , material(*quadratic, body.material, body.initial_and_source.initial_value, true)
    , linear_material(cells_of(op).dof_handler(),
                      body.material,
                      body.initial_and_source.initial_value,
                      true)
    , prescribed(*quadratic, *layout, body.boundary_conditions, hanging, {})
    , prolongation(quadratic->get_fe().n_dofs_per_cell(), GeometryInfo<dim>::vertices_per_cell)
    , left_out(layout)
    , vertex(layout->locally_owned_size(), 0)
    , held(vertex)
  {
    const CellTerm<dim>      &cells = cells_of(op);
    const FiniteElement<dim> &fe    = quadratic->get_fe();
    for (unsigned int i = 0; i < prolongation.m(); ++i)
      for (unsigned int v = 0; v < prolongation.n(); ++v)
        prolongation(i, v) = cells.dof_handler().get_fe().shape_value(v, fe.unit_support_point(i));
    std::vector<types::global_dof_index> indices(fe.n_dofs_per_cell());
    for (const auto &cell : quadratic->active_cell_iterators())
      if (!cell->is_artificial())
        {
          cell->get_dof_indices(indices);
          for (const unsigned int v : cell->vertex_indices())
            if (layout->in_local_range(indices[v]))
              vertex[layout->global_to_local(indices[v])] = 1;
        }
    for (const unsigned int i : prescribed.held())
      held[i] = 1;
    mark_cells_left_out(coupling);
  }


  template <int dim>
  void QuadraticElements<dim>::mark_cells_left_out(const Coupling<dim> *coupling)
  {
    const CellTerm<dim>                 &cells = cells_of(op);
    const unsigned int                   n     = quadratic->get_fe().n_dofs_per_cell();
    std::vector<types::global_dof_index> indices(n);
    FullMatrix<double>                   matrix(prolongation.n(), prolongation.n()), mass(matrix);
    Vector                               at_cut(linear_layout); // vertices of cut cells
    std::vector<types::global_dof_index> vertices(prolongation.n());
    const auto                           for_each_own = [&](const auto &visit) {
      for (const auto &cell : cells.dof_handler().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            cell->get_dof_indices(vertices);
            visit(cell);
          }
    };
    for_each_own([&](const Cell &cell) {
      if (cells.cut_cells()[cell->active_cell_index()])
        for (const auto index : vertices)
          at_cut(index) += 1.;
    });
    at_cut.compress(VectorOperation::add);
    at_cut.update_ghost_values();
    const bool scaled = body.peridynamics.scales_beside_cracks();
    for_each_own([&](const Cell &cell) {
      bool out = cells.cut_cells()[cell->active_cell_index()];
      for (const auto index : vertices)
        out = out || (scaled && at_cut(index) > 0.);
      if (!out && coupling != nullptr)
        {
          linear_material.assemble(cell, matrix, mass);
          out = coupling->change_cell(cell, matrix);
        }
      if (!out)
        return;
      same_cell(cell, *quadratic)->get_dof_indices(indices);
      for (const auto index : indices)
        {
          left_out(index) += 1.;
          if (const auto *const masters = hanging.constraints().get_constraint_entries(index);
              hanging.is_hanging(index) && masters != nullptr)
            for (const auto &[master, weight] : *masters)
              left_out(master) += 1.;
        }
    });
    left_out.compress(VectorOperation::add);
    left_out.update_ghost_values();
  }


  template <int dim>
  bool QuadraticElements<dim>::is_left_out(const Cell &cell) const
  {
    return left_out(same_cell(cell, *quadratic)->dof_index(0)) > 0.; // that of the cell's middle
  }


  template <int dim>
  double QuadraticElements<dim>::share_left_out() const
  {
    unsigned long long n = 0;
    for (const auto &cell : quadratic->active_cell_iterators())
      if (cell->is_locally_owned() && is_left_out(cell))
        ++n;
    return double(Utilities::MPI::sum(n, quadratic->get_communicator())) /
           quadratic->get_triangulation().n_global_active_cells();
  }


  /** Call visit(dof, dof of a vertex, weight) for the entries of P in rows of owned unknowns. */
  template <int dim>
  template <typename Visit>
  void QuadraticElements<dim>::for_each_prolonged(const Visit &visit) const
  {
    const CellTerm<dim>                 &cells = cells_of(op);
    std::vector<char>                    done(layout->locally_owned_size(), 0);
    std::vector<types::global_dof_index> indices(prolongation.m()), vertices(prolongation.n());
    for (const auto &cell : quadratic->active_cell_iterators())
      if (!cell->is_artificial())
        {
          cell->get_dof_indices(indices);
          same_cell(cell, cells.dof_handler())->get_dof_indices(vertices);
          for (unsigned int i = 0; i < indices.size(); ++i)
            if (layout->in_local_range(indices[i]) && !done[layout->global_to_local(indices[i])])
              {
                done[layout->global_to_local(indices[i])] = 1;
                for (unsigned int k = 0; k < vertices.size(); ++k)
                  visit(indices[i], vertices[k], prolongation(i, k));
              }
        }
  }


  template <int dim>
  Vector QuadraticElements<dim>::prolonged(const Vector &v) const
  {
    const Vector values = with_ghosts(v, linear_layout);
    Vector       w(layout);
    for_each_prolonged([&](const auto dof, const auto vertex_dof, const double weight) {
      w(dof) += weight * values(vertex_dof);
    });
    return w;
  }


  template <int dim>
  Vector QuadraticElements<dim>::restricted(const Vector &r) const
  {
    const CellTerm<dim> &cells = cells_of(op);
    Vector               result(linear_layout);
    for_each_prolonged([&](const auto dof, const auto vertex_dof, const double weight) {
      result(vertex_dof) += weight * r(dof);
    });
    result.compress(VectorOperation::add);
    cells.hanging_nodes().condense(result);
    return result;
  }


  template <int dim>
  Vector QuadraticElements<dim>::prescribed_bubbles(const Vector &v, const double t) const
  {
    Vector       w    = prolonged(v);
    const Vector flat = w;
    prescribed.distribute(w, t);
    w -= flat;
    for (unsigned int i = 0; i < vertex.size(); ++i)
      if (vertex[i] || left_out.local_element(i) > 0.)
        w.local_element(i) = 0.;
    hanging.interpolate(w);
    return w;
  }


  template <int dim>
  Vector QuadraticElements<dim>::boundary_bubbles(const std::string &side, const Vector &v) const
  {
    Vector       marks(layout);
    const Vector flat = prolonged(v);
    mark_side(*quadratic, *layout, body, hanging, side, marks);
    Vector w(layout);
    // An edge on which the field falls from 1 to 0 has half of the length too much or too little,
    // of which a bubble of height c has 2/3 c.
    for (const unsigned int i : prescribed.held())
      if (!vertex[i] && left_out.local_element(i) == 0.)
        w.local_element(i) = 1.5 * (marks.local_element(i) - flat.local_element(i));
    hanging.interpolate(w);
    return w;
  }


  namespace
  {
    /** f - K v of the cells that count, v with ghosts, on all unknowns that do not hang. */
    template <int dim, typename Counts>
    Vector residual_of(const DoFHandler<dim>   &dofs,
                       const Vector            &v,
                       CellMaterial<dim>       &material,
                       const HeatLoads<dim>    &loads,
                       const HangingNodes<dim> &hanging,
                       const Counts            &counts,
                       const double             t)
    {
      material.take(v);
      const unsigned int                   n = dofs.get_fe().n_dofs_per_cell();
      FullMatrix<double>                   stiffness(n, n), other(n, n);
      std::vector<types::global_dof_index> indices(n);
      Vector                               r(v.get_partitioner());
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned() && counts(cell))
          {
            material.assemble(cell, stiffness, other);
            if (cell->at_boundary())
              {
                loads.find_transfer(cell, other);
                stiffness.add(1., other);
              }
            cell->get_dof_indices(indices);
            for (unsigned int i = 0; i < n; ++i)
              for (unsigned int k = 0; k < n; ++k)
                r(indices[i]) -= stiffness(i, k) * v(indices[k]);
          }
      r.compress(VectorOperation::add);
      hanging.condense(r);
      r += loads.at(t);
      return r;
    }
  } // namespace


  template <int dim>
  Vector QuadraticElements<dim>::residual(const Vector &w, const double t) const
  {
    const auto counts = [this](const Cell &cell) { return !is_left_out(cell); };
    return residual_of(*quadratic, with_ghosts(w, layout), material, loads, hanging, counts, t);
  }


  template <int dim>
  Vector QuadraticElements<dim>::linear_residual(const Vector &v, const double t) const
  {
    const CellTerm<dim> &cells  = cells_of(op);
    const auto           counts = [this](const Cell &cell) { return !is_left_out(cell); };
    return residual_of(cells.dof_handler(),
                       with_ghosts(v, linear_layout),
                       linear_material,
                       linear_loads,
                       cells.hanging_nodes(),
                       counts,
                       t);
  }


  template <int dim>
  double QuadraticElements<dim>::root_mean_square(const Vector &w) const
  {
    const Vector  field = with_ghosts(w, layout);
    FEValues<dim> values(quadratic->get_fe(), QGauss<dim>(3), update_values | update_JxW_values);
    std::vector<double> at_points(values.n_quadrature_points);
    double              square = 0., volume = 0.;
    for (const auto &cell : quadratic->active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          values.get_function_values(field, at_points);
          for (const unsigned int q : values.quadrature_point_indices())
            {
              square += at_points[q] * at_points[q] * values.JxW(q);
              volume += values.JxW(q);
            }
        }
    const MPI_Comm communicator = quadratic->get_communicator();
    return std::sqrt(Utilities::MPI::sum(square, communicator) /
                     Utilities::MPI::sum(volume, communicator));
  }


  template <int dim>
  std::vector<double> QuadraticElements<dim>::shares_of_cells(const Vector &r,
                                                              const Vector &w) const
  {
    Vector                               share(layout), n_cells(layout);
    std::vector<types::global_dof_index> indices(prolongation.m());
    std::vector<double> result(quadratic->get_triangulation().n_active_cells(), 0.);
    const auto          for_each_own = [&](const auto &visit) {
      for (const auto &cell : quadratic->active_cell_iterators())
        if (cell->is_locally_owned())
          {
            cell->get_dof_indices(indices);
            for (const auto index : indices)
              visit(cell, index);
          }
    };
    for_each_own([&](const auto &, const auto index) { n_cells(index) += 1.; });
    n_cells.compress(VectorOperation::add);
    for (unsigned int i = 0; i < vertex.size(); ++i)
      if (!vertex[i])
        share.local_element(i) =
          r.local_element(i) * w.local_element(i) / std::max(1., n_cells.local_element(i));
    share.update_ghost_values();
    for_each_own([&](const auto &cell, const auto index) {
      result[cell->active_cell_index()] += share(index);
    });
    return result;
  }


  namespace
  {
    /** Powers of the coordinates up to the second: 1, x_a, x_a x_b with a <= b. */
    template <int dim>
    constexpr unsigned int n_monomials = 1 + dim + dim *(dim + 1) / 2;


    template <int dim>
    Eigen::Matrix<double, n_monomials<dim>, 1> monomials(const Tensor<1, dim> &x)
    {
      Eigen::Matrix<double, n_monomials<dim>, 1> m;
      unsigned int                               k = 0;
      m[k++]                                       = 1.;
      for (unsigned int a = 0; a < dim; ++a)
        m[k++] = x[a];
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = a; b < dim; ++b)
          m[k++] = x[a] * x[b];
      return m;
    }


    /** The normal equations of a quadratic polynomial of the coordinates relative to a vertex. */
    template <int dim>
    struct Fit
    {
      static constexpr unsigned int n      = n_monomials<dim>;
      Eigen::Matrix<double, n, n>   matrix = Eigen::Matrix<double, n, n>::Zero();
      Eigen::Matrix<double, n, 1>   loads  = Eigen::Matrix<double, n, 1>::Zero();

      void add(const Tensor<1, dim> &x, const double value)
      {
        const auto m = monomials<dim>(x);
        matrix.noalias() += m * m.transpose();
        loads += value * m;
      }

      /** The coefficients of the second powers; false where the points do not determine them. */
      bool solve(std::array<double, n - 1 - dim> &second) const
      {
        // Monomials of length one. The smallest eigenvalue is 0.2 with all neighbours of a lattice,
        // 0 with two rows of it.
        constexpr double                  least = 0.03;
        const Eigen::Matrix<double, n, 1> scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
        if (!scale.allFinite())
          return false;
        const Eigen::Matrix<double, n, n> scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, n, n>> solver(
          scaled,
          Eigen::EigenvaluesOnly);
        if (solver.eigenvalues()[0] < least)
          return false;
        const Eigen::Matrix<double, n, 1> coefficients =
          scale.cwiseProduct(scaled.ldlt().solve(scale.cwiseProduct(loads)));
        for (unsigned int k = 0; k < second.size(); ++k)
          second[k] = coefficients[1 + dim + k];
        return true;
      }
    };
  } // namespace


  /** Call visit(i) for owned unknowns that are free, of bubbles. */
  template <int dim>
  template <typename Visit>
  void QuadraticElements<dim>::for_each_bubble(const Visit &visit) const
  {
    for (unsigned int i = 0; i < vertex.size(); ++i)
      if (!vertex[i] && !held[i] && left_out.local_element(i) == 0.)
        visit(i);
  }


  /**
   * By vertex, with ghosts: the coefficients of x_a x_b, and at last whether they are known. Not
   * where the cells around are of several materials, or too few.
   */
  template <int dim>
  std::vector<Vector> QuadraticElements<dim>::second_derivatives(const Vector &v) const
  {
    const DoFHandler<dim>   &dofs           = cells_of(op).dof_handler();
    const HangingNodes<dim> &linear_hanging = cells_of(op).hanging_nodes();
    std::vector<Cell>        cells;
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial() && !is_left_out(cell))
        cells.push_back(cell);
    std::vector<std::vector<unsigned int>> around(linear_layout->locally_owned_size());
    for (unsigned int c = 0; c < cells.size(); ++c)
      for (const unsigned int k : cells[c]->vertex_indices())
        if (const auto dof = cells[c]->vertex_dof_index(k, 0);
            linear_layout->in_local_range(dof) && !linear_hanging.is_hanging(dof))
          around[linear_layout->global_to_local(dof)].push_back(c);
    std::vector<Vector>                       second(Fit<dim>::n - dim, Vector(linear_layout));
    std::array<double, Fit<dim>::n - 1 - dim> coefficients;
    for (unsigned int i = 0; i < around.size(); ++i)
      {
        if (around[i].empty())
          continue;
        Fit<dim>   fit;
        bool       one_material = true;
        Point<dim> middle;
        for (const unsigned int k : cells[around[i][0]]->vertex_indices())
          if (cells[around[i][0]]->vertex_dof_index(k, 0) == linear_layout->local_to_global(i))
            middle = cells[around[i][0]]->vertex(k);
        for (const unsigned int c : around[i])
          {
            one_material = one_material &&
                           cells[c]->material_id() == cells[around[i][0]]->material_id();
            for (const unsigned int k : cells[c]->vertex_indices())
              if (const auto dof = cells[c]->vertex_dof_index(k, 0);
                  !linear_hanging.is_hanging(dof))
                fit.add(cells[c]->vertex(k) - middle, v(dof));
          }
        if (!one_material || !fit.solve(coefficients))
          continue;
        for (unsigned int k = 0; k < coefficients.size(); ++k)
          second[k].local_element(i) = coefficients[k];
        second.back().local_element(i) = 1.;
      }
    for (Vector &component : second)
      component.update_ghost_values();
    return second;
  }


  template <int dim>
  Vector QuadraticElements<dim>::recovered_bubbles(const Vector &v) const
  {
    const CellTerm<dim>                 &cells  = cells_of(op);
    const std::vector<Vector>            second = second_derivatives(with_ghosts(v, linear_layout));
    const unsigned int                   n_second = second.size() - 1;
    Vector                               w(layout), n_cells(layout);
    std::vector<types::global_dof_index> indices(prolongation.m());
    std::vector<double>                  sum(n_second);
    for (const auto &cell : cells.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned() && !is_left_out(cell))
        {
          same_cell(cell, *quadratic)->get_dof_indices(indices);
          // Mean of what is known at some of the vertices; returns whether there is any.
          const auto mean = [&](const auto &takes_part) {
            double n = 0.;
            sum.assign(n_second, 0.);
            for (const unsigned int k : cell->vertex_indices())
              if (const auto dof = cell->vertex_dof_index(k, 0);
                  takes_part(k) && second.back()(dof) > 0.)
                {
                  n += 1.;
                  for (unsigned int s = 0; s < n_second; ++s)
                    sum[s] += second[s](dof);
                }
            for (double &s : sum)
              s /= std::max(n, 1.);
            return n > 0.;
          };
          for (unsigned int i = cell->n_vertices(); i < indices.size(); ++i)
            {
              const auto is_end = [&](const unsigned int k) { return prolongation(i, k) > 0.; };
              if (!mean(is_end) && !mean([](const unsigned int) { return true; }))
                continue;
              Point<dim> middle;
              for (const unsigned int k : cell->vertex_indices())
                middle += prolongation(i, k) * cell->vertex(k);
              double bubble = 0.;
              for (const unsigned int k : cell->vertex_indices())
                if (is_end(k))
                  {
                    const Tensor<1, dim> x = cell->vertex(k) - middle;
                    unsigned int         s = 0;
                    for (unsigned int a = 0; a < dim; ++a)
                      for (unsigned int b = a; b < dim; ++b)
                        bubble -= prolongation(i, k) * sum[s++] * x[a] * x[b];
                  }
              w(indices[i]) += bubble;
              n_cells(indices[i]) += 1.;
            }
        }
    w.compress(VectorOperation::add);
    n_cells.compress(VectorOperation::add);
    Vector bubbles(layout);
    for_each_bubble([&](const unsigned int i) {
      if (n_cells.local_element(i) > 0.)
        bubbles.local_element(i) = w.local_element(i) / n_cells.local_element(i);
    });
    hanging.interpolate(bubbles);
    return bubbles;
  }


  PERIDEAL_INSTANTIATE_CLASS(class QuadraticElements);
  PERIDEAL_INSTANTIATE_FUNCTION(mark_side);
} // namespace PeriDeal
