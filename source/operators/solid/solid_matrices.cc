// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/bond_softness.h>
#include <perideal/operators/solid/solid_matrices.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  /** The nearest neighbours of owned nodes over unbroken bonds. */
  struct NearBonds
  {
    std::vector<std::size_t>  first{0};
    std::vector<unsigned int> near;
    std::vector<double>       left;    // of these bonds, where they soften; empty: all
    std::vector<bool>         damaged; // nodes that have lost some
    Vector                    sums;    // of V x^2 of all of them, as q; ghosts up to date
  };


  namespace
  {
    /** Neighbours so near that they share a cell, by the size of the cells at a node. */
    template <int dim>
    bool is_near(const Nodes<dim> &nodes, const unsigned int i, const Tensor<1, dim> &xi)
    {
      if (!nodes.lattice())
        return xi.norm() < 1.8 * std::pow(nodes.volume(i), 1. / dim);
      bool is = true;
      for (unsigned int d = 0; d < dim; ++d)
        is = is && std::abs(xi[d]) < 1.5 * nodes.lattice()->spacing[d];
      return is;
    }


    template <int dim>
    NearBonds find_near_bonds(const SolidBonds<dim> &bonds)
    {
      const Families<dim> &families = bonds.families;
      const Nodes<dim>    &nodes    = families.nodes();
      NearBonds            found;
      found.damaged.resize(nodes.n_owned(), false);
      found.sums.reinit(nodes.partitioner());
      std::vector<UnitBond<dim>> close; // those that are near
      std::copy_if(bonds.rows.body.units.begin(),
                   bonds.rows.body.units.end(),
                   std::back_inserter(close),
                   [](const UnitBond<dim> &bond) {
                     return std::all_of(bond.offset.begin(), bond.offset.end(), [](const int n) {
                       return std::abs(n) <= 1;
                     });
                   });
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        {
          const auto add_near = [&](const auto &bond) {
            const Tensor<1, dim> xi = families.neighbors().bond_vector(i, bond.neighbor);
            if (!is_near(nodes, i, xi) && !is_near(nodes, bond.neighbor, xi))
              return;
            // As q, that of the body before bonds broke.
            found.sums.local_element(i) += nodes.volume(bond.neighbor) * xi.norm_square();
            if (!bonds.rows.is_whole(bond.number))
              {
                found.damaged[i] = true;
                return;
              }
            found.near.push_back(bond.neighbor);
            if (!bonds.laws.counts_cut) // and do not soften
              return;
            const double lost = softness_of(bonds.rows, bond.number).lost;
            found.left.push_back(1. - lost);
            found.damaged[i] = found.damaged[i] || lost > 0.5;
          };
          if (bonds.rows.is_on_lattice(i))
            bonds.rows.for_each_of(i, close, add_near);
          else
            bonds.rows.for_each_stored(i, add_near);
          found.first.push_back(found.near.size());
        }
      found.sums.update_ghost_values();
      return found;
    }


    /** By which bonds of each node resist extension, ghosts included. Collective. */
    template <int dim>
    std::vector<double> extension_stiffnesses(const SolidBonds<dim>     &bonds,
                                              const BodyParameters<dim> &body)
    {
      const Nodes<dim>   &nodes = bonds.families.nodes();
      std::vector<double> extension(nodes.n_local());
      if (const auto *const nodal = bonds.correspondence()) // whose law need not have two moduli
        {
          Vector shear(nodes.partitioner());
          for (unsigned int i = 0; i < nodes.n_owned(); ++i)
            shear.local_element(i) = nodal->shapes[i].shear;
          shear.update_ghost_values();
          for (unsigned int i = 0; i < nodes.n_local(); ++i)
            extension[i] = dim * (dim + 2.) * shear.local_element(i);
        }
      else
        for (unsigned int i = 0; i < nodes.n_local(); ++i)
          extension[i] = bond_law(bonds.laws.moduli(i), dim, body.elasticity.plane).extension;
      return extension;
    }


    /** A matrix of zeros with these bonds. Collective. */
    template <int dim>
    void make_pattern(const Nodes<dim>                  &nodes,
                      const Utilities::MPI::Partitioner &unknowns,
                      const NearBonds                   &found,
                      TrilinosWrappers::SparseMatrix    &matrix)
    {
      TrilinosWrappers::SparsityPattern    pattern(unknowns.locally_owned_range(),
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
          for (std::size_t n = found.first[i]; n < found.first[i + 1]; ++n)
            for (unsigned int d = 0; d < dim; ++d)
              columns.push_back(unknowns.local_to_global(dim * found.near[n] + d));
          for (unsigned int d = 0; d < dim; ++d)
            pattern.add_entries(columns[d], columns.begin(), columns.end());
        }
      pattern.compress();
      matrix.reinit(pattern);
    }
  } // namespace


  template <int dim>
  void make_surrogate(const SolidBonds<dim>          &bonds,
                      const BodyParameters<dim>      &body,
                      const Vector                   &diagonal,
                      const Vector                   &held,
                      TrilinosWrappers::SparseMatrix &matrix)
  {
    const Families<dim>               &families = bonds.families;
    const Nodes<dim>                  &nodes    = families.nodes();
    const Utilities::MPI::Partitioner &unknowns = *diagonal.get_partitioner();
    const NearBonds                    found    = find_near_bonds(bonds);
    make_pattern(nodes, unknowns, found, matrix);
    const std::vector<double> extension = extension_stiffnesses(bonds, body);
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
        for (std::size_t n = found.first[i]; n < found.first[i + 1]; ++n)
          {
            const unsigned int   j  = found.near[n];
            const Tensor<1, dim> xi = families.neighbors().bond_vector(i, j);
            const double spring     = (found.left.empty() ? 1. : found.left[n]) * nodes.volume(i) *
                                  nodes.volume(j) *
                                  (extension[i] / found.sums.local_element(i) +
                                   extension[j] / found.sums.local_element(j)) /
                                  xi.norm_square();
            const Tensor<2, dim> block = spring * outer_product(xi, xi);
            own += block;
            add(j, -block);
          }
        // Between cell centres a plane of symmetry holds nodes by bonds to their own images.
        bonds.rows.for_each_beyond(i, [&](const auto &bond) {
          const Tensor<1, dim> xi = bonds.ends.vector(i, bond.neighbor);
          if (bonds.rows.is_whole(bond.number) && bonds.ends.is_own_image(i, bond.neighbor) &&
              is_near(nodes, i, xi))
            own += 4. * nodes.volume(i) * bonds.ends.volume(bond.neighbor) * extension[i] /
                   found.sums.local_element(i) / xi.norm_square() * outer_product(xi, xi);
        });
        // Springs alone would not hold every node, and hardly those that few are left of.
        const double share = own == Tensor<2, dim>() ? 1. : found.damaged[i] ? 1e-2 : 1e-8;
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
      bonds.rows.for_each_in_body(i, [&](const auto &bond) {
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


  namespace
  {
    /**
     * Add what bonds to fictitious nodes change of the diagonal of K, whose dilatations of node i
     * have the factor c d/(q^2 V) in @p factor. Collective.
     */
    template <int dim>
    void add_diagonal_beyond(const SolidBonds<dim>     &bonds,
                             const std::vector<double> &factor,
                             Vector                    &diagonal)
    {
      // theta_i is a sum over coefficients of displacements. What images change of these, and what
      // was counted without them:
      Vector                      sum(diagonal.get_partitioner());
      std::vector<Tensor<1, dim>> own(bonds.families.nodes().n_local()), change(own.size());
      std::vector<unsigned int>   touched;
      std::vector<bool>           is_touched(own.size(), false);
      const auto                  touch = [&](const unsigned int node) {
        if (!is_touched[node])
          touched.push_back(node);
        is_touched[node] = true;
      };
      const auto add = [&](const unsigned int node, const double size, const Tensor<1, dim> &p) {
        for (unsigned int d = 0; d < dim; ++d)
          sum.local_element(dim * node + d) += size * p[d] * p[d];
      };
      for (const unsigned int i : bonds.rows.beyond.nodes)
        {
          touched.clear();
          bonds.rows.for_each_beyond(i, [&](const auto &bond) {
            Tensor<1, dim> of_node = bond.moment;
            touch(i);
            change[i] -= bond.moment;
            bonds.ends.images->for_each_term(bonds.ends.image(bond.neighbor),
                                             [&](const auto &term) {
                                               Tensor<1, dim> p;
                                               for (unsigned int d = 0; d < dim; ++d)
                                                 p[d] = term.of_component(d) * bond.moment[d];
                                               if (term.node == i)
                                                 of_node -= p;
                                               else
                                                 add(term.node, bond.spring, p);
                                               touch(term.node);
                                               change[term.node] += p;
                                             });
            add(i, bond.spring, of_node);
          });
          own[i] = Tensor<1, dim>();
          bonds.rows.for_each_in_body(i, [&](const auto &bond) {
            own[bond.neighbor] = bond.moment;
            own[i] -= bond.moment;
          });
          for (const unsigned int node : touched)
            {
              for (unsigned int d = 0; d < dim; ++d)
                sum.local_element(dim * node + d) +=
                  factor[i] * change[node][d] * (change[node][d] + 2. * own[node][d]);
              change[node]     = Tensor<1, dim>();
              is_touched[node] = false;
            }
          bonds.rows.for_each_in_body(i, [&](const auto &bond) {
            own[bond.neighbor] = Tensor<1, dim>();
          });
          own[i] = Tensor<1, dim>();
        }
      sum.compress(VectorOperation::add);
      diagonal += sum;
    }
  } // namespace


  template <int dim>
  void find_stiffness_diagonal(const SolidBonds<dim> &bonds, Vector &diagonal)
  {
    const Nodes<dim> &nodes = bonds.families.nodes();
    if (const auto *const nodal = bonds.correspondence())
      {
        nodal->shapes.find_diagonal(diagonal);
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          hold_diagonal(bonds, i, diagonal);
        return;
      }
    std::vector<double> factors(nodes.n_local(), 0.);
    for (unsigned int i = 0; i < nodes.n_local() && bonds.laws.volumetric; ++i)
      factors[i] = bonds.laws.tension(i, 1.);
    unsigned int regular = numbers::invalid_unsigned_int; // the first of those that are all alike
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const bool is_regular = bonds.sums.is_regular(i);
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
    if (bonds.ends.images)
      add_diagonal_beyond(bonds, factors, diagonal);
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


  template <int dim>
  Vector find_sums_of_dilatations(const SolidBonds<dim> &bonds)
  {
    const Nodes<dim> &nodes = bonds.families.nodes();
    Vector            sums(nodes.partitioner());
    for (unsigned int i = 0; i < nodes.n_owned() && bonds.laws.volumetric; ++i)
      {
        double         length = 0.;
        Tensor<1, dim> sum;
        bonds.rows.for_each(i, [&](const auto &bond) {
          if (bonds.ends.is_fictitious(bond.neighbor))
            length += bond.moment.norm() *
                      (1. + bonds.ends.images->sum_of_factors(bonds.ends.image(bond.neighbor)));
          else
            {
              length += bond.moment.norm();
              sum += bond.moment;
            }
        });
        length += sum.norm();
        sums.local_element(i) = std::abs(bonds.laws.tension(i, length));
      }
    sums.update_ghost_values();
    return sums;
  }


  template <int dim>
  Vector find_row_sums(const SolidBonds<dim> &bonds,
                       const Vector          &of_dilatations,
                       const bool             of_tangent)
  {
    if (const auto *const nodal = bonds.correspondence())
      return nodal->shapes.row_sums();
    Vector     rows(bonds.families.nodes().partitioner());
    const bool across = bonds.kinematics.is_full();
    for (const unsigned int i : bonds.rows.beyond.nodes)
      bonds.rows.for_each_beyond(i, [&](const auto &bond) {
        const FictitiousImages<dim> &images = *bonds.ends.images;
        const unsigned int           image  = bonds.ends.image(bond.neighbor);
        const double                 p      = bond.moment.norm();
        const double                 all    = 1. + images.sum_of_factors(image);
        const double                 size = bond.spring * p * all + of_dilatations.local_element(i);
        const double aside = across ? std::abs(bonds.forces.stiffness_across(bond)) : 0.;
        rows.local_element(i) += size * p;
        images.for_each_term(image, [&](const auto &term) {
          double largest = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            largest = std::max(largest, std::abs(term.of_component(d)));
          rows.local_element(term.node) += size * largest * p;
          rows.local_element(term.node) += largest * aside * all;
        });
        rows.local_element(i) += aside * all;
      });
    rows.compress(VectorOperation::add);
    for (unsigned int i = 0; i < rows.locally_owned_size(); ++i)
      {
        double        &row = rows.local_element(i);
        Tensor<1, dim> sum;
        bonds.rows.for_each_in_body(i, [&](const auto &bond) {
          row += 2. * bond.spring * bond.moment.norm_square() +
                 of_dilatations.local_element(bond.neighbor) * bond.moment.norm();
          sum += bond.moment;
        });
        if (of_tangent && across)
          bonds.rows.for_each_stored(i, [&](const auto &bond) {
            row += 2. * std::abs(bonds.forces.stiffness_across(bond));
          });
        row += of_dilatations.local_element(i) * sum.norm();
      }
    return rows;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(find_stiffness_diagonal);
  PERIDEAL_INSTANTIATE_FUNCTION(mend_stiffness_diagonal);
  PERIDEAL_INSTANTIATE_FUNCTION(find_sums_of_dilatations);
  PERIDEAL_INSTANTIATE_FUNCTION(find_row_sums);
  PERIDEAL_INSTANTIATE_FUNCTION(make_surrogate);
} // namespace PeriDeal
