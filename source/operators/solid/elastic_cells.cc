// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>

#include <perideal/base/instantiate.h>
#include <perideal/laws/elasticity.h>
#include <perideal/operators/bounds/spectrum.h>
#include <perideal/operators/solid/elastic_cells.h>
#include <perideal/operators/solid/thermal_strains.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  ElasticCells<dim>::Data::Data(const FiniteElement<dim> &fe)
    : values(fe,
             QGauss<dim>(fe.degree + 1),
             update_values | update_gradients | update_quadrature_points | update_JxW_values)
    , stiffness(dim * fe.n_dofs_per_cell(), dim * fe.n_dofs_per_cell())
    , shear(stiffness)
    , thermal(dim * fe.n_dofs_per_cell())
    , mass(fe.n_dofs_per_cell())
    , diagonal(fe.n_dofs_per_cell())
    , volume(fe.n_dofs_per_cell())
    , indices(fe.n_dofs_per_cell())
    , unknowns(dim * fe.n_dofs_per_cell())
  {}


  template <int dim>
  double ElasticCells<dim>::Data::force(const unsigned int unknown, const Vector &u) const
  {
    double sum = 0.;
    for (unsigned int j = 0; j < unknowns.size(); ++j)
      sum += stiffness(unknown, j) * u(unknowns[j]);
    return sum;
  }


  template <int dim>
  double ElasticCells<dim>::Data::energy(const Vector &u) const
  {
    double sum = thermal_energy;
    for (unsigned int i = 0; i < unknowns.size(); ++i)
      sum += (0.5 * force(i, u) - thermal(i)) * u(unknowns[i]);
    return sum;
  }


  template <int dim>
  ElasticCells<dim>::ElasticCells(const DoFHandler<dim>               &dofs,
                                  const BodyParameters<dim>           &body,
                                  const SolidBondsBesideElements<dim> *bonds,
                                  const Vector                        &temperatures)
    : by_cracks(dofs,
                {body.cracks.on_faces(),
                 true,
                 body.cracks.contact_conductance,
                 [&body] { return body.horizon(); },
                 body.cuts_in_part_at_tips(),
                 bonds && body.coupling.zone != ZoneKind::formula &&
                   body.coupling.zone != ZoneKind::adaptive})
    , stresses(StressCells<dim>::of_scene(
        dofs,
        body,
        by_cracks,
        bonds && bonds->nodal() ?
          [bonds](const Cell &cell) { return bonds->coupling().node_families()->share_of(cell); } :
          typename StressCells<dim>::Share()))
    , dofs(dofs)
    , body(body)
    , bonds(bonds)
    , temperatures(temperatures)
    , data(dofs.get_fe())
  {}


  template <int dim>
  const std::vector<types::global_dof_index> &ElasticCells<dim>::unknowns_of(const Cell &cell) const
  {
    cell->get_dof_indices(data.indices);
    for (unsigned int i = 0; i < data.unknowns.size(); ++i)
      data.unknowns[i] = dim * data.indices[i / dim] + i % dim;
    return data.unknowns;
  }


  template <int dim>
  void ElasticCells<dim>::assemble(const Cell &cell) const
  {
    const FEValues<dim> &values = data.values;
    const unsigned int   n      = data.indices.size();
    data.values.reinit(cell);
    unknowns_of(cell);
    data.stiffness = 0.;
    data.shear     = 0.;
    for (dealii::Vector<double> *v : {&data.thermal, &data.mass, &data.diagonal, &data.volume})
      *v = 0.;
    data.thermal_energy = 0.;
    for (const unsigned int q : values.quadrature_point_indices())
      {
        const Point<dim> &p      = values.quadrature_point(q);
        const double      JxW    = values.JxW(q);
        double            change = 0.; // of the temperature
        if (temperatures.size() == 0)
          change = body.elasticity.temperature_change.value(p);
        else
          for (unsigned int a = 0; a < n; ++a)
            change += temperatures(data.indices[a]) * values.shape_value(a, q);
        const Moduli moduli = body.moduli(p, change);
        // A bar has E alone.
        const double lambda   = dim == 1 ? 0. : lambda_of(moduli, dim, body.elasticity.plane),
                     mu       = dim == 1 ? 0.5 * moduli.young() : moduli.shear;
        const double strain   = stresses ? 0. : thermal_strain(body, p, change); // it is in them
        const double pressure = (dim * lambda + 2. * mu) * strain;
        const double density  = body.elasticity.is_static() ? 1. : body.material.density.value(p);
        data.thermal_energy += 0.5 * dim * pressure * strain * JxW;
        for (unsigned int a = 0; a < n; ++a)
          {
            const Tensor<1, dim> &ga    = values.shape_grad(a, q);
            const double          shape = values.shape_value(a, q);
            data.volume(a) += shape * JxW;
            data.mass(a) += density * shape * JxW;
            data.diagonal(a) += density * shape * shape * JxW;
            for (unsigned int d = 0; d < dim; ++d)
              data.thermal(dim * a + d) += pressure * ga[d] * JxW;
            for (unsigned int b = 0; b < n; ++b)
              {
                const Tensor<1, dim> &gb      = values.shape_grad(b, q);
                const double          product = mu * (ga * gb) * JxW;
                for (unsigned int d = 0; d < dim; ++d)
                  {
                    data.stiffness(dim * a + d, dim * b + d) += product;
                    for (unsigned int e = 0; e < dim; ++e)
                      data.stiffness(dim * a + d, dim * b + e) +=
                        (lambda * ga[d] * gb[e] + mu * ga[e] * gb[d]) * JxW;
                    if (!with_shear)
                      continue;
                    data.shear(dim * a + d, dim * b + d) += product;
                    for (unsigned int e = 0; e < dim; ++e)
                      data.shear(dim * a + d, dim * b + e) +=
                        mu * (ga[e] * gb[d] - 2. / 3. * ga[d] * gb[e]) * JxW;
                  }
              }
          }
      }
    if (stresses)
      stresses->find_stiffness(cell, data.stiffness);
  }


  template <int dim>
  void ElasticCells<dim>::change(const Cell &cell) const
  {
    if (bonds && bonds->leave_remainder(cell, data.stiffness))
      {
        // The remainder carries a uniform thermal strain like the whole cell less its bonds.
        double change = 0.;
        if (temperatures.size() == 0)
          change = body.elasticity.temperature_change.value(cell->center());
        else
          for (const auto i : data.indices)
            change += temperatures(i) / data.indices.size();
        const double           strain = thermal_strain(body, cell->center(), change);
        dealii::Vector<double> free(data.thermal.size());
        for (unsigned int a = 0; a < data.indices.size(); ++a)
          for (unsigned int d = 0; d < dim; ++d)
            free(dim * a + d) = strain * (cell->vertex(a)[d] - cell->center()[d]);
        data.stiffness.vmult(data.thermal, free);
        data.thermal_energy = 0.5 * (free * data.thermal);
      }
    if (bonds && with_shear)
      bonds->leave_remainder(cell, data.shear);
    const double factor = by_cracks.kept_of_removed(cell) * factors.of_cell(data.indices);
    if (factor == 1.)
      return;
    data.stiffness *= factor;
    data.shear *= factor;
    data.thermal *= factor;
    data.thermal_energy *= factor;
  }


  template <int dim>
  std::vector<typename ElasticCells<dim>::Cell> ElasticCells<dim>::near(const Boxes &boxes,
                                                                        const double distance)
  {
    if (!search)
      search = std::make_unique<CellSearch<dim>>(dofs);
    std::vector<Cell> cells;
    search->find(boxes, distance, cells);
    return cells;
  }


  template <int dim>
  void ElasticCells<dim>::find_factors(const Vector &layout)
  {
    CrackSideFactors::Sums sums(layout);
    factors.start(layout); // sums are those without factors
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && by_cracks.is_cut(cell))
        {
          unknowns_of(cell);
          sums.mark(data.indices);
        }
    sums.marked.compress(VectorOperation::max);
    bonds->add_to(sums);
    for_each([&](const Cell &cell, const Data &of_cell) {
      const Moduli moduli = body.moduli(cell->center());
      const double mu     = dim == 1 ? 0.5 * moduli.young() : moduli.shear,
                   lambda = dim == 1 ? 0. : lambda_of(moduli, dim, body.elasticity.plane);
      sums.add(cell, of_cell.indices, of_cell.stiffness, dim * lambda + dim * (dim + 1) * mu);
    });
    sums.compress();
    std::vector<unsigned int> owned(layout.locally_owned_size());
    std::iota(owned.begin(), owned.end(), 0);
    factors.find(owned, sums);
  }


  template <int dim>
  void ElasticCells<dim>::note_parted(const std::vector<Cell> *of)
  {
    if (parted.empty())
      parted = by_cracks.flags();
    const auto note = [&](const Cell &cell) {
      parted[cell->active_cell_index()] = by_cracks.is_cut(cell) ||
                                          bonds->coupling().parts_cell(cell);
    };
    if (of)
      std::for_each(of->begin(), of->end(), note);
    else
      for (const auto &cell : dofs.active_cell_iterators())
        if (!cell->is_artificial())
          note(cell);
  }


  template <int dim>
  double ElasticCells<dim>::lowest_remainder() const
  {
    double lowest = std::numeric_limits<double>::infinity();
    if (bonds)
      for_each_whole([&](const Cell &cell, Data &of_cell) {
        if (bonds->leave_remainder(cell, of_cell.stiffness))
          lowest = std::min(
            lowest,
            lowest_eigenvalue(of_cell.stiffness) /
              (body.moduli(cell->center()).shear * std::pow(cell->measure(), 1. - 2. / dim)));
      });
    return lowest;
  }


  PERIDEAL_INSTANTIATE_CLASS(class ElasticCells);
} // namespace PeriDeal
