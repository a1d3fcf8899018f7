// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/matrix_product.h>
#include <perideal/operators/parts/element_matrix.h>

#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  std::vector<std::uint64_t> places_on_lattice(const std::vector<Point<dim>> &positions,
                                               const Domain<dim>             &lattice)
  {
    constexpr double           finer = 8.;
    constexpr int              bits  = 21;
    std::vector<std::uint64_t> places(positions.size(), 0);
    for (unsigned int i = 0; i < positions.size(); ++i)
      for (unsigned int d = dim; d-- > 0;)
        {
          const double share =
            (positions[i][d] - lattice.lower[d]) / (lattice.upper[d] - lattice.lower[d]);
          places[i] = (places[i] << bits) + std::lround(finer * lattice.cells[d] * share);
        }
    return places;
  }


  template <int dim, int n>
  void ElementMatrix<dim, n>::reinit(const Pattern &pattern)
  {
    alike.reset();
    asked = false;
    matrix.reinit(pattern);
    number_of_entries = matrix.n_nonzero_elements();
  }


  template <int dim, int n>
  void ElementMatrix<dim, n>::add(const HangingNodes<dim>                    &hanging,
                                  const FullMatrix<double>                   &of_cell,
                                  const std::vector<types::global_dof_index> &unknowns)
  {
    if (alike)
      alike->add(of_cell, unknowns);
    else
      hanging.add_to(matrix, of_cell, unknowns);
  }


  template <int dim, int n>
  void ElementMatrix<dim, n>::compress()
  {
    if (alike)
      alike->compress();
    else
      matrix.compress(VectorOperation::add);
  }


  template <int dim, int n>
  void ElementMatrix<dim, n>::share_rows(const typename AlikeRows<n>::Layout &nodes,
                                         const std::vector<std::uint64_t>    &places)
  {
    if (asked)
      return;
    asked           = true;
    auto       rows = std::make_unique<AlikeRows<n>>(matrix, nodes, places);
    const bool pays = 2. * Utilities::MPI::sum(static_cast<double>(rows->memory_consumption()),
                                               matrix.get_mpi_communicator()) <
                      Utilities::MPI::sum(static_cast<double>(matrix.memory_consumption()),
                                          matrix.get_mpi_communicator());
    if (!pays)
      return;
    alike = std::move(rows);
    matrix.clear();
  }


  template <int dim, int n>
  void ElementMatrix<dim, n>::copy_to(Sparse &other, const Pattern &pattern) const
  {
    if (!alike)
      {
        other.copy_from(matrix);
        return;
      }
    other.reinit(pattern);
    const IndexSet owned = other.locally_owned_range_indices();
    alike->for_each_entry([&](const unsigned int row, const auto column, const double value) {
      other.set(owned.nth_index_in_set(row), column, value);
    });
    other.compress(VectorOperation::insert);
  }


  template <int dim, int n>
  void ElementMatrix<dim, n>::multiply(Vector &y, const Vector &x) const
  {
    if (alike)
      alike->multiply(y, x);
    else
      MatrixProduct(matrix).vmult(y, x);
  }


  template <int dim, int n>
  double ElementMatrix<dim, n>::diagonal(const unsigned int node,
                                         const unsigned int component) const
  {
    const unsigned int row = n * node + component;
    if (!alike)
      {
        const auto unknown = matrix.locally_owned_range_indices().nth_index_in_set(row);
        return matrix.el(unknown, unknown);
      }
    return alike->diagonal(node, component);
  }


  PERIDEAL_INSTANTIATE_FUNCTION(places_on_lattice);
  template class ElementMatrix<1, 1>;
  template class ElementMatrix<2, 1>;
  template class ElementMatrix<3, 1>;
  template class ElementMatrix<2, 2>;
  template class ElementMatrix<3, 3>;
} // namespace PeriDeal
