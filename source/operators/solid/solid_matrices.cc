// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/operators/solid/solid_matrices.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Adds the stiffness across a bond whose moment is as long as @p length. */
    template <int dim>
    void add_across(const double          across,
                    const double          length,
                    const Tensor<1, dim> &moment,
                    Tensor<2, dim>       &block)
    {
      block += across * (Tensor<2, dim>(unit_symmetric_tensor<dim>()) -
                         outer_product(moment, moment) / (length * length));
    }
  } // namespace


  /*
   * With g_i . u = sum_j W xi . (u_j - u_i) over the bonds of node i,
   *
   *   K = sum_i c d/(V q^2) g_i g_i^T + sum over bonds of spring (W xi) (W xi)^T (1 -1; -1 1)
   *
   * so that the visit of node i gives rows of its whole family, also of those nodes that other
   * processes own.
   */
  template <int dim>
  void assemble_matrix(const SolidBonds<dim>             &bonds,
                       const BondState                   &state,
                       const Utilities::MPI::Partitioner &unknowns,
                       TrilinosWrappers::SparseMatrix    &matrix)
  {
    const Nodes<dim>                    &nodes      = bonds.families.nodes();
    const FictitiousBonds<dim>          *beyond     = bonds.beyond.get();
    const bool                           volumetric = bonds.laws.volumetric;
    const IndexSet                       owned      = unknowns.locally_owned_range();
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
          indices.push_back(unknowns.local_to_global(dim * j + d));
        moment.push_back(p);
        members.push_back(j);
      };
      indices.clear();
      moment.clear();
      members.clear();
      add(i, Tensor<1, dim>());
      bonds.rows.for_each(i, [&](const auto &bond) {
        add(bond.neighbor, bond.moment);
        moment[0] -= bond.moment;
      });
      if (!beyond)
        return;
      beyond->for_each_of(i, [&](const auto &bond) {
        moment[0] -= bond.moment;
        beyond->images().for_each_term(bond.image, [&](const auto &term) {
          const std::size_t place = place_of_member(term.node);
          if (place == members.size())
            add(term.node, Tensor<1, dim>());
          for (unsigned int d = 0; d < dim; ++d)
            moment[place][d] += term.of_component(d) * bond.moment[d];
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
      written.add_index(unknowns.local_to_global(k));
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
        const double size = bonds.laws.tension(i, 1.);
        for (std::size_t row = 0; volumetric && row < indices.size(); ++row)
          for (std::size_t column = 0; column < indices.size(); ++column)
            local(row, column) =
              size * moment[row / dim][row % dim] * moment[column / dim][column % dim];
        std::size_t k = 1;
        bonds.rows.for_each(i, [&](const auto &bond) {
          Tensor<2, dim> block = bond.spring * outer_product(bond.moment, bond.moment);
          if (bonds.kinematics.is_full() && state.is_whole(bond.number))
            add_across(bonds.kinematics.stiffness_across(bond),
                       bonds.kinematics.length(bond),
                       bond.moment,
                       block);
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
            beyond->images().for_each_term(bond.image, [&](const auto &term) {
              Tensor<1, dim> of_term;
              for (unsigned int d = 0; d < dim; ++d)
                of_term[d] = term.of_component(d);
              parts.emplace_back(place_of_member(term.node), of_term);
            });
            Tensor<2, dim> block = bond.spring * outer_product(bond.moment, bond.moment);
            if (bond.whole)
              add_across(beyond->stiffness_across(bond), beyond->length(bond), bond.moment, block);
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


  template <int dim>
  void make_surrogate(const SolidBonds<dim>          &bonds,
                      const BondState                &state,
                      const BodyParameters<dim>      &body,
                      const Vector                   &diagonal,
                      const Vector                   &held,
                      TrilinosWrappers::SparseMatrix &matrix)
  {
    using LatticeBond                           = typename SolidRows<dim>::LatticeBond;
    const Families<dim>               &families = bonds.families;
    const Nodes<dim>                  &nodes    = families.nodes();
    const Utilities::MPI::Partitioner &unknowns = *diagonal.get_partitioner();
    const IndexSet                     owned    = unknowns.locally_owned_range();
    std::vector<std::size_t>           first{0};
    std::vector<unsigned int>          near; // neighbours, of unbroken bonds
    std::vector<bool>                  damaged(nodes.n_owned(), false);
    Vector                             sums(nodes.partitioner());
    const auto is_near = [&](const unsigned int i, const Tensor<1, dim> &xi) {
      if (!nodes.lattice())
        return xi.norm() < 1.8 * std::pow(nodes.volume(i), 1. / dim);
      bool is = true;
      for (unsigned int d = 0; d < dim; ++d)
        is = is && std::abs(xi[d]) < 1.5 * nodes.lattice()->spacing[d];
      return is;
    };
    std::vector<LatticeBond> close; // those that are near
    std::copy_if(bonds.rows.bonds_on_lattice().begin(),
                 bonds.rows.bonds_on_lattice().end(),
                 std::back_inserter(close),
                 [](const LatticeBond &bond) {
                   return std::all_of(bond.offset.begin(), bond.offset.end(), [](const int n) {
                     return std::abs(n) <= 1;
                   });
                 });
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const auto add_near = [&](const auto &bond) {
          const Tensor<1, dim> xi = families.neighbors().bond_vector(i, bond.neighbor);
          if (!is_near(i, xi) && !is_near(bond.neighbor, xi))
            return;
          // As q, that of the body before bonds broke.
          sums.local_element(i) += nodes.volume(bond.neighbor) * xi.norm_square();
          if (bond.number == SolidRows<dim>::not_stored || state.is_whole(bond.number))
            near.push_back(bond.neighbor);
          else
            damaged[i] = true;
        };
        if (bonds.rows.is_on_lattice(i))
          bonds.rows.for_each_of(i, close, add_near);
        else
          bonds.rows.for_each_stored(i, add_near);
        first.push_back(near.size());
      }
    sums.update_ghost_values();

    TrilinosWrappers::SparsityPattern    pattern(owned,
                                              nodes.communicator(),
                                              dim * (dim == 3 ? 27 :
                                                        dim == 2 ? 9 :
                                                                   3));
    std::vector<types::global_dof_index> columns;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        columns.clear();
        for (unsigned int d = 0; d < dim; ++d)
          columns.push_back(unknowns.local_to_global(dim * i + d));
        for (std::size_t n = first[i]; n < first[i + 1]; ++n)
          for (unsigned int d = 0; d < dim; ++d)
            columns.push_back(unknowns.local_to_global(dim * near[n] + d));
        for (unsigned int d = 0; d < dim; ++d)
          pattern.add_entries(columns[d], columns.begin(), columns.end());
      }
    pattern.compress();
    matrix.reinit(pattern);
    const auto stiffness_of = [&](const unsigned int i) {
      const Moduli moduli = body.material.moduli(nodes.position(i));
      return bond_law(moduli, dim, body.elasticity.plane).extension;
    };
    std::vector<double> extension(nodes.n_local());
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      extension[i] = stiffness_of(i);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        Tensor<2, dim> own;
        const auto     add = [&](const unsigned int j, const Tensor<2, dim> &block) {
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int e = 0; e < dim; ++e)
              {
                const unsigned int row = dim * i + d, column = dim * j + e;
                const bool         is_held = held.local_element(row) > 0. ||
                                     held.local_element(column) > 0.;
                const double value = !is_held ? block[d][e] : (row == column ? 1. : 0.);
                matrix.set(unknowns.local_to_global(row), unknowns.local_to_global(column), value);
              }
        };
        for (std::size_t n = first[i]; n < first[i + 1]; ++n)
          {
            const unsigned int   j  = near[n];
            const Tensor<1, dim> xi = families.neighbors().bond_vector(i, j);
            const double         spring =
              nodes.volume(i) * nodes.volume(j) *
              (extension[i] / sums.local_element(i) + extension[j] / sums.local_element(j)) /
              xi.norm_square();
            const Tensor<2, dim> block = spring * outer_product(xi, xi);
            own += block;
            add(j, -block);
          }
        // Between cell centres a plane of symmetry holds nodes by bonds to their own images.
        if (bonds.beyond)
          bonds.beyond->for_each_of(i, [&](const auto &bond) {
            const Tensor<1, dim> xi = bonds.beyond->bond_vector(bond);
            if (bond.whole && bonds.beyond->is_own_image(bond) && is_near(i, xi))
              own += 4. * nodes.volume(i) * bonds.beyond->images()[bond.image].volume *
                     extension[i] / sums.local_element(i) / xi.norm_square() *
                     outer_product(xi, xi);
          });
        // Springs alone would not hold every node, and hardly those that few are left of.
        const double share = own == Tensor<2, dim>() ? 1. : damaged[i] ? 1e-2 : 1e-8;
        for (unsigned int d = 0; d < dim; ++d)
          own[d][d] += share * diagonal.local_element(dim * i + d);
        add(i, own);
      }
    matrix.compress(VectorOperation::insert);
  }


  namespace
  {
    /** @param factor of the dilatation of a node k, m = c d/(q^2 V) */
    template <int dim, typename Factor>
    void find_diagonal_of(const SolidBonds<dim> &bonds,
                          const unsigned int     i,
                          const Factor          &factor,
                          Vector                &diagonal)
    {
      // The energy is 1/4 sum over directed bonds of s (p . eta)^2 + 1/2 sum m_k (sum p . eta)^2.
      Tensor<1, dim> sum, own;
      bonds.rows.for_each(i, [&](const auto &bond) {
        const double factors = bond.spring + factor(bond.neighbor);
        sum += bond.moment;
        for (unsigned int d = 0; d < dim; ++d)
          own[d] += factors * bond.moment[d] * bond.moment[d];
      });
      for (unsigned int d = 0; d < dim; ++d)
        diagonal.local_element(dim * i + d) = own[d] + factor(i) * sum[d] * sum[d];
    }


    /** Nodes without bonds, all of them broken: any positive number. */
    template <int dim>
    void hold_diagonal(const SolidBonds<dim> &bonds, const unsigned int i, Vector &diagonal)
    {
      for (unsigned int d = 0; d < dim; ++d)
        if (double &entry = diagonal.local_element(dim * i + d); !(entry > 0.))
          entry =
            bonds.laws[i].extension * std::pow(bonds.families.nodes().volume(i), 1. - 2. / dim);
    }
  } // namespace


  template <int dim>
  void find_stiffness_diagonal(const SolidBonds<dim> &bonds, Vector &diagonal)
  {
    const Nodes<dim>   &nodes = bonds.families.nodes();
    std::vector<double> factors(nodes.n_local(), 0.);
    for (unsigned int i = 0; i < nodes.n_local() && bonds.laws.volumetric; ++i)
      factors[i] = bonds.laws.tension(i, 1.);
    unsigned int regular = numbers::invalid_unsigned_int; // the first of those that are all alike
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const bool is_regular = bonds.rows.is_regular(i);
        if (is_regular && regular != numbers::invalid_unsigned_int)
          {
            for (unsigned int d = 0; d < dim; ++d)
              diagonal.local_element(dim * i + d) = diagonal.local_element(dim * regular + d);
            continue;
          }
        find_diagonal_of(
          bonds,
          i,
          [&](const unsigned int k) { return factors[k]; },
          diagonal);
        if (is_regular)
          regular = i;
      }
    if (bonds.beyond)
      bonds.beyond->add_to_diagonal(diagonal, bonds.rows, factors);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      hold_diagonal(bonds, i, diagonal);
  }


  template <int dim>
  void mend_stiffness_diagonal(const SolidBonds<dim>           &bonds,
                               const std::vector<unsigned int> &of_nodes,
                               Vector                          &diagonal)
  {
    for (const unsigned int i : of_nodes)
      {
        find_diagonal_of(
          bonds,
          i,
          [&](const unsigned int k) {
            return bonds.laws.volumetric ? bonds.laws.tension(k, 1.) : 0.;
          },
          diagonal);
        hold_diagonal(bonds, i, diagonal);
      }
  }


#define PERIDEAL_INSTANTIATE(dim)                                           \
  template void find_stiffness_diagonal(const SolidBonds<dim> &, Vector &); \
  template void mend_stiffness_diagonal(const SolidBonds<dim> &,            \
                                        const std::vector<unsigned int> &,  \
                                        Vector &);                          \
  template void assemble_matrix(const SolidBonds<dim> &,                    \
                                const BondState &,                          \
                                const Utilities::MPI::Partitioner &,        \
                                TrilinosWrappers::SparseMatrix &);          \
  template void make_surrogate(const SolidBonds<dim> &,                     \
                               const BondState &,                           \
                               const BodyParameters<dim> &,                 \
                               const Vector &,                              \
                               const Vector &,                              \
                               TrilinosWrappers::SparseMatrix &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
