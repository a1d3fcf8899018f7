// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/fe/fe_values.h>

#include <perideal/analysis/heat_flux.h>
#include <perideal/base/instantiate.h>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void bond_heat_flux(const DiffusionBonds<dim> &bonds,
                      const Vector              &u,
                      const std::vector<double> &outside,
                      VectorField<dim>          &two_sided,
                      VectorField<dim>          &one_sided)
  {
    const Nodes<dim>                               &nodes = bonds.nodes();
    std::vector<typename DiffusionBonds<dim>::Bond> family;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        bonds.bonds_of(i, family);
        Tensor<1, dim> both, hotter;
        for (const auto &bond : family)
          {
            const double         other      = bond.neighbor < nodes.n_local() ?
                                                u.local_element(bond.neighbor) :
                                                outside[bond.neighbor - nodes.n_local()];
            const double         difference = other - u.local_element(i);
            const Tensor<1, dim> q          = bond.weight / nodes.volume(i) * difference *
                                     bonds.neighbors().bond_vector(i, bond.neighbor);
            both -= 0.5 * q;
            if (difference > 0.)
              hotter -= q;
          }
        for (unsigned int d = 0; d < dim; ++d)
          {
            two_sided[d].local_element(i) = both[d];
            one_sided[d].local_element(i) = hotter[d];
          }
      }
  }


  namespace
  {
    /**
     * On a graded mesh beside larger cells, where rows of K are not those of a lattice, the flux is
     * that of the elements.
     */
    template <int dim>
    void take_element_flux_beside_large_cells(const CellTerm<dim> &cells,
                                              const Vector        &u,
                                              VectorField<dim>    &two_sided,
                                              VectorField<dim>    &one_sided)
    {
      const Nodes<dim>      &nodes   = cells.bonds().families().nodes();
      const DoFHandler<dim> &dofs    = cells.dof_handler();
      VectorField<dim>       element = two_sided;
      element_heat_flux<dim>(dofs, cells.material(), cells.cut_cells(), u, element);
      std::vector<types::global_dof_index> indices(dofs.get_fe().n_dofs_per_cell());
      for (const auto &cell : dofs.active_cell_iterators())
        if (!cell->is_artificial() &&
            cell->extent_in_direction(0) > 1.5 * nodes.lattice()->spacing[0])
          {
            cell->get_dof_indices(indices);
            for (const auto i : indices)
              if (u.in_local_range(i))
                for (unsigned int d = 0; d < dim; ++d)
                  two_sided[d](i) = one_sided[d](i) = element[d](i);
          }
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        if (nodes.is_hanging(i))
          for (unsigned int d = 0; d < dim; ++d)
            two_sided[d].local_element(i) = one_sided[d].local_element(i) =
              element[d].local_element(i);
    }
  } // namespace


  template <int dim>
  void coupled_heat_flux(const CellTerm<dim> &cells,
                         const Vector        &u,
                         VectorField<dim>    &two_sided,
                         VectorField<dim>    &one_sided)
  {
    const Nodes<dim> &nodes = cells.bonds().families().nodes();
    for (unsigned int d = 0; d < dim; ++d)
      {
        two_sided[d] = 0.;
        one_sided[d] = 0.;
      }
    cells.visit_conductances(
      [&](const unsigned int i, const unsigned int j, const double conductance) {
        const double         difference = u.local_element(j) - u.local_element(i);
        const Tensor<1, dim> q =
          conductance / nodes.volume(i) * difference * (nodes.position(j) - nodes.position(i));
        for (unsigned int d = 0; d < dim; ++d)
          {
            two_sided[d].local_element(i) -= 0.5 * q[d];
            if (difference > 0.)
              one_sided[d].local_element(i) -= q[d];
          }
      });
    if (nodes.is_graded())
      take_element_flux_beside_large_cells<dim>(cells, u, two_sided, one_sided);
  }


  template <int dim>
  void cut_fraction(const DiffusionBonds<dim> &bonds, Vector &fraction)
  {
    const Nodes<dim>                               &nodes = bonds.nodes();
    std::vector<typename DiffusionBonds<dim>::Bond> family;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        fraction.local_element(i) = 0.;
        if (!bonds.near_crack(i))
          continue;
        bonds.bonds_of(i, family);
        double all = 0., cut = 0.;
        for (const auto &bond : family)
          if (bond.neighbor < nodes.n_local())
            {
              all += nodes.volume(bond.neighbor);
              if (bond.cut)
                cut += nodes.volume(bond.neighbor);
            }
        fraction.local_element(i) = all > 0. ? cut / all : 0.;
      }
  }


  template <int dim>
  void element_heat_flux(const DoFHandler<dim>   &dofs,
                         const Material          &material,
                         const std::vector<bool> &cut,
                         const Vector            &u,
                         VectorField<dim>        &flux)
  {
    const FiniteElement<dim>            &fe = dofs.get_fe();
    FEValues<dim>                        values(fe,
                         Quadrature<dim>(fe.get_unit_support_points()),
                         update_values | update_gradients | update_quadrature_points);
    std::vector<Tensor<1, dim>>          gradients(fe.n_dofs_per_cell());
    std::vector<double>                  temperatures(fe.n_dofs_per_cell());
    std::vector<types::global_dof_index> indices(fe.n_dofs_per_cell());
    Vector                               weight(u.get_partitioner());
    for (Vector &component : flux)
      component = 0.;
    constexpr double share_of_cut_cells = 1e-12; // far below all others, but not zero
    // Owned dofs see all of their cells: owned ones and the layer of ghost cells.
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial())
        {
          values.reinit(cell);
          values.get_function_gradients(u, gradients);
          values.get_function_values(u, temperatures);
          cell->get_dof_indices(indices);
          const double size =
            cell->measure() * (cut[cell->active_cell_index()] ? share_of_cut_cells : 1.);
          for (unsigned int i = 0; i < indices.size(); ++i)
            if (weight.in_local_range(indices[i]))
              {
                const double kappa =
                  material.conductivity.value(values.quadrature_point(i), temperatures[i]);
                weight(indices[i]) += size;
                for (unsigned int d = 0; d < dim; ++d)
                  flux[d](indices[i]) -= size * kappa * gradients[i][d];
              }
        }
    for (unsigned int i = 0; i < weight.locally_owned_size(); ++i)
      for (Vector &component : flux)
        component.local_element(i) /= weight.local_element(i);
  }


  PERIDEAL_INSTANTIATE_FUNCTION(bond_heat_flux);
  PERIDEAL_INSTANTIATE_FUNCTION(coupled_heat_flux);
  PERIDEAL_INSTANTIATE_FUNCTION(cut_fraction);
  PERIDEAL_INSTANTIATE_FUNCTION(element_heat_flux);
} // namespace PeriDeal
