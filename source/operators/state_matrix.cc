// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// K of the state-based operator as a matrix, on request.

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/operators/state_operator.h>

#include <algorithm>
#include <utility>

#include "state_lattice.h"

namespace PeriDeal
{
  using namespace dealii;

  /*
   * With g_i . u = sum_j W xi . (u_j - u_i) over the bonds of node i,
   *
   *   K = sum_i c d/(V q^2) g_i g_i^T + sum over bonds of spring (W xi) (W xi)^T (1 -1; -1 1)
   *
   * so that the visit of node i gives rows of its whole family, also of those nodes that other
   * processes own.
   */
  template <int dim>
  void StateOperator<dim>::matrix(TrilinosWrappers::SparseMatrix &matrix) const
  {
    const Nodes<dim>                    &nodes = bonds.nodes();
    const IndexSet                       owned = unknowns->locally_owned_range();
    IndexSet                             written(owned.size());
    std::vector<types::global_dof_index> indices;
    std::vector<Tensor<1, dim>>          moment;
    std::vector<unsigned int>            members; // of the family, the node itself first
    const auto                           place_of_member = [&](const unsigned int j) {
      return std::find(members.begin(), members.end(), j) - members.begin();
    };
    const auto find_family = [&](const unsigned int i) {
      const auto add = [&](const unsigned int j, const Tensor<1, dim> &p) {
        for (unsigned int d = 0; d < dim; ++d)
          indices.push_back(unknowns->local_to_global(dim * j + d));
        moment.push_back(p);
        members.push_back(j);
      };
      indices.clear();
      moment.clear();
      members.clear();
      add(i, Tensor<1, dim>());
      for_each_bond(i, [&](const Bond &bond) {
        add(bond.neighbor, bond.moment);
        moment[0] -= bond.moment;
      });
      if (!beyond)
        return;
      beyond->for_each_of(i, [&](const auto &bond) {
        moment[0] -= bond.moment;
        beyond->for_each_term(bond.image, [&](const auto node, const auto &factors) {
          const std::size_t place = place_of_member(node);
          if (place == members.size())
            add(node, Tensor<1, dim>());
          for (unsigned int d = 0; d < dim; ++d)
            moment[place][d] += factors[d] * bond.moment[d];
        });
      });
    };
    const auto has_images = [&](const unsigned int i) {
      bool has = false;
      if (beyond)
        beyond->for_each_of(i, [&](const auto &) { has = true; });
      return has;
    };
    for (unsigned int k = 0; k < dim * nodes.n_local(); ++k)
      written.add_index(unknowns->local_to_global(k));
    TrilinosWrappers::SparsityPattern pattern(owned, owned, written, nodes.communicator());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        find_family(i);
        for (std::size_t row = 0; row < indices.size(); ++row)
          if (volumetric || row < dim || has_images(i))
            pattern.add_entries(indices[row], indices.begin(), indices.end());
      }
    pattern.compress();
    matrix.reinit(pattern);

    FullMatrix<double> local;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        find_family(i);
        local.reinit(indices.size(), indices.size());
        const StateLaw &law = laws[i].law;
        const double    q   = weighted.local_element(i);
        const double    size =
          volumetric ? law.volumetric * law.dilatation / (nodes.volume(i) * q * q) : 0.;
        for (std::size_t row = 0; volumetric && row < indices.size(); ++row)
          for (std::size_t column = 0; column < indices.size(); ++column)
            local(row, column) =
              size * moment[row / dim][row % dim] * moment[column / dim][column % dim];
        std::size_t k = 1;
        for_each_bond(i, [&](const Bond &bond) {
          Tensor<2, dim> block = bond.spring * outer_product(bond.moment, bond.moment);
          if (full && bond.whole)
            block += across[starts[i] + k - 1] *
                     (Tensor<2, dim>(unit_symmetric_tensor<dim>()) -
                      outer_product(bond.moment, bond.moment) / (bond.length * bond.length));
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int e = 0; e < dim; ++e)
              {
                local(d, e) += block[d][e];
                local(d, dim * k + e) -= block[d][e];
              }
          ++k;
        });
        if (beyond)
          beyond->for_each_of(i, [&](const auto &bond) {
            // What the bond has of its extension, and of what is across it.
            std::vector<std::pair<std::size_t, Tensor<1, dim>>> parts;
            Tensor<1, dim>                                      own;
            for (unsigned int d = 0; d < dim; ++d)
              own[d] = -1.;
            parts.emplace_back(0, own);
            beyond->for_each_term(bond.image, [&](const auto node, const auto &factors) {
              parts.emplace_back(place_of_member(node), factors);
            });
            const double   length = beyond->length(bond), aside = beyond->stiffness_across(bond);
            Tensor<2, dim> block = bond.spring * outer_product(bond.moment, bond.moment);
            if (aside != 0.)
              block += aside * (Tensor<2, dim>(unit_symmetric_tensor<dim>()) -
                                outer_product(bond.moment, bond.moment) / (length * length));
            for (const auto &[row, of_row] : parts)
              for (const auto &[column, of_column] : parts)
                for (unsigned int d = 0; d < dim; ++d)
                  for (unsigned int e = 0; e < dim; ++e)
                    local(dim * row + d, dim * column + e) +=
                      of_row[d] * block[d][e] * of_column[e];
          });
        const std::size_t n_rows = volumetric || has_images(i) ? indices.size() : dim;
        for (std::size_t row = 0; row < n_rows; ++row)
          matrix.add(indices[row],
                     static_cast<types::global_dof_index>(indices.size()),
                     indices.data(),
                     &local(row, 0));
      }
    matrix.compress(VectorOperation::add);
  }


#define PERIDEAL_INSTANTIATE(dim) \
  template void StateOperator<dim>::matrix(TrilinosWrappers::SparseMatrix &) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
