// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/matrix_product.h>
#include <perideal/operators/diffusion/cell_capacity.h>
#include <perideal/operators/parts/lumped_mass.h>

#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  CellCapacity<dim>::CellCapacity(const std::shared_ptr<const Utilities::MPI::Partitioner> &layout,
                                  const CellMaterial<dim> &material,
                                  const HangingNodes<dim> &hanging,
                                  const bool               depends,
                                  const bool               steady,
                                  const bool               consistent)
    : material(material)
    , hanging(hanging)
    , depends(depends)
    , steady(steady)
    , consistent(consistent)
  {
    this->diagonal.reinit(layout);
  }


  template <int dim>
  void CellCapacity<dim>::reinit(const TrilinosWrappers::SparsityPattern &pattern)
  {
    if (consistent)
      mass.reinit(pattern);
  }


  template <int dim>
  void CellCapacity<dim>::clear()
  {
    mass           = 0.;
    this->diagonal = 0.;
  }


  template <int dim>
  void CellCapacity<dim>::add(const FullMatrix<double>                   &of_cell,
                              const std::vector<types::global_dof_index> &indices)
  {
    if (consistent)
      hanging.add_to(mass, of_cell, indices);
    lumps.reinit(indices.size());
    of_diagonal.reinit(indices.size());
    for (unsigned int a = 0; a < indices.size(); ++a)
      {
        of_diagonal(a) = of_cell(a, a);
        for (unsigned int b = 0; b < indices.size(); ++b)
          lumps(a) += of_cell(a, b);
      }
    make_positive(of_diagonal, lumps);
    for (unsigned int a = 0; a < indices.size(); ++a)
      this->diagonal(indices[a]) += lumps(a);
  }


  template <int dim>
  void CellCapacity<dim>::compress()
  {
    if (consistent)
      mass.compress(VectorOperation::add);
    this->diagonal.compress(VectorOperation::add);
    hanging.condense(this->diagonal);
    if (hanging.any()) // any value that is positive
      hanging.set(this->diagonal, this->diagonal.l2_norm() / std::sqrt(this->diagonal.size()));
  }


  template <int dim>
  void CellCapacity<dim>::apply(Vector &y, const Vector &x) const
  {
    if (consistent)
      MatrixProduct(mass).vmult(y, x);
    else
      Capacity::apply(y, x);
  }


  template <int dim>
  void CellCapacity<dim>::heat_between(Vector &y, const Vector &u, const Vector &v) const
  {
    if (depends)
      {
        material.heat_between(y, u, v, !consistent);
        hanging.condense(y);
        return;
      }
    change = v;
    change -= u;
    apply(y, change);
    hanging.set(y, 0.); // the nodes they follow from have all of it
  }


  template <int dim>
  double CellCapacity<dim>::content(const Vector &u) const
  {
    if (depends || steady)
      return material.content(u);
    double heat = 0.;
    for (unsigned int i = 0; i < this->diagonal.locally_owned_size(); ++i)
      heat += this->diagonal.local_element(i) * u.local_element(i);
    for (const unsigned int node : hanging.owned())
      heat -= this->diagonal.local_element(node) * u.local_element(node);
    return heat;
  }


  template <int dim>
  std::size_t CellCapacity<dim>::memory_consumption() const
  {
    return Capacity::memory_consumption() + mass.memory_consumption();
  }


  PERIDEAL_INSTANTIATE_CLASS(class CellCapacity);
} // namespace PeriDeal
