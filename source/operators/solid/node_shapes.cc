// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/smallest_eigenvalue.h>
#include <perideal/laws/nodal_stiffness.h>
#include <perideal/operators/solid/node_shapes.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The largest eigenvalue of a stiffness, of its symmetric part, as a map of strains. */
    template <int dim>
    double largest_modulus(const SymmetricTensor<4, dim> &C)
    {
      constexpr unsigned int      n = SymmetricTensor<2, dim>::n_independent_components;
      Eigen::Matrix<double, n, n> matrix;
      for (unsigned int k = 0; k < n; ++k)
        for (unsigned int l = 0; l < n; ++l)
          {
            const auto a = SymmetricTensor<2, dim>::unrolled_to_component_indices(k),
                       b = SymmetricTensor<2, dim>::unrolled_to_component_indices(l);
            matrix(k, l) = (k < dim ? 1. : std::sqrt(2.)) * (l < dim ? 1. : std::sqrt(2.)) * 0.5 *
                           (C[a[0]][a[1]][b[0]][b[1]] + C[b[0]][b[1]][a[0]][a[1]]);
          }
      return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, n, n>>(matrix,
                                                                        Eigen::EigenvaluesOnly)
        .eigenvalues()[n - 1];
    }
  } // namespace


  template <int dim>
  NodeShapes<dim>::NodeShapes(const Families<dim>  &families,
                              const BondEnds<dim>  &ends,
                              const BondTable<dim> &bonds,
                              const NodeLaws<dim>  &laws)
    : families(families)
    , ends(ends)
    , bonds(bonds)
    , laws(laws)
  {}


  template <int dim>
  void NodeShapes<dim>::set_stiffness(const unsigned int i,
                                      const Stiffness   &stiffness,
                                      const bool         is_known)
  {
    if (i == 0)
      stiffnesses.clear();
    if (i == list.size())
      list.emplace_back();
    Shape &shape = list[i];
    if (stiffnesses.empty() || !(stiffnesses.back() == stiffness))
      {
        stiffnesses.push_back(stiffness);
        shape.shear = is_known ? soft_shear(stiffness) : 0.;
      }
    else
      shape.shear = list[i - 1].shear;
    shape.stiffness = static_cast<unsigned int>(stiffnesses.size() - 1);
  }


  template <int dim>
  void NodeShapes<dim>::renew(const std::vector<unsigned int> &nodes)
  {
    const std::size_t known = of_bonds.body.size();
    of_bonds.resize(bonds);
    for (std::size_t k = known; k < bonds.body.size(); ++k) // of nodes that have got a row
      {
        const Tensor<1, dim> xi = ends.vector(bonds.body.node_of(k), bonds.body.neighbors[k]);
        of_bonds.body[k]        = (bonds.body.moments[k] * xi) / xi.norm_square();
      }
    for (const unsigned int i : nodes)
      {
        Full M;
        bool lost = false;
        bonds.for_each(i, [&](const auto &bond) {
          const Tensor<1, dim> xi = ends.vector(i, bond.neighbor);
          M += symmetrize(outer_product(bond.moment, xi));
          if (bond.number == BondTable<dim>::not_stored)
            return;
          const bool is_beyond = &bonds.rows_of(bond.number) == &bonds.beyond;
          of_bonds.of(is_beyond)[bonds.place(bond.number)] = (bond.moment * xi) / xi.norm_square();
          lost                                             = lost || !bonds.is_whole(bond.number);
        });
        Shape       &shape = list[i];
        const double q     = laws.weighted.local_element(i);
        const bool   holds = !lost ? trace(M) > 0. : // else beside a zone, without bonds
                                   bonds_hold(M, q * families.nodes().volume(i));
        shape.inverse      = holds ? invert(M) : Full();
        shape.stabilizer   = holds ? PeriDeal::stabilizer<dim>(shape.shear, q) : 0.;
      }
  }


  template <int dim>
  void NodeShapes<dim>::find_diagonal(Vector &diagonal) const
  {
    Vector sum(diagonal.get_partitioner());
    for (unsigned int i = 0; i < size(); ++i)
      {
        const Shape     &shape = list[i];
        const Stiffness &C     = elastic(i);
        // A displacement along d of one node, which the gradient e_d b^T follows.
        const auto stiffness = [&](const unsigned int d, const Tensor<1, dim> &b) {
          double product = 0.;
          for (unsigned int a = 0; a < dim; ++a)
            for (unsigned int c = 0; c < dim; ++c)
              product += b[a] * b[c] * C[d][a][d][c];
          return shape.share * families.nodes().volume(i) * product;
        };
        Tensor<1, dim> of_node;
        double         all = 0.;
        for_each_bond(
          i,
          [&](const unsigned int j, const Tensor<1, dim> &moment, const double w, std::size_t) {
            const Tensor<1, dim> b     = shape.inverse * moment;
            const double         aside = shape.share * shape.stabilizer * (w - b * moment);
            of_node += moment;
            all += w;
            const auto add =
              [&](const unsigned int node, const unsigned int d, const double square) {
                sum.local_element(dim * node + d) += square * (stiffness(d, b) + aside);
              };
            if (!ends.is_fictitious(j))
              for (unsigned int d = 0; d < dim; ++d)
                add(j, d, 1.);
            else // as if these nodes had no other part in the family
              ends.images->for_each_term(ends.image(j), [&](const auto &term) {
                for (unsigned int d = 0; d < dim; ++d)
                  add(term.node, d, term.of_component(d) * term.of_component(d));
              });
          });
        const Tensor<1, dim> b = shape.inverse * of_node;
        for (unsigned int d = 0; d < dim; ++d)
          sum.local_element(dim * i + d) +=
            stiffness(d, b) + shape.share * shape.stabilizer * (all - b * of_node);
      }
    sum.compress(VectorOperation::add);
    std::copy(sum.begin(), sum.begin() + sum.locally_owned_size(), diagonal.begin());
  }


  template <int dim>
  Vector NodeShapes<dim>::row_sums() const
  {
    const Nodes<dim>   &nodes = families.nodes();
    Vector              rows(nodes.partitioner());
    std::vector<double> largest;
    for (const Stiffness &C : stiffnesses)
      largest.push_back(largest_modulus(C));
    for (unsigned int i = 0; i < size(); ++i)
      {
        const Shape &shape   = list[i];
        double       modulus = largest[shape.stiffness];
        if (!deformed.empty())
          modulus = largest_modulus(deformed[i].stiffness) * deformed[i].gradient.norm_square() +
                    deformed[i].stress.norm();
        const double kappa =
          shape.share * std::max(shape.stabilizer,
                                 modulus * nodes.volume(i) * -smallest_eigenvalue(-shape.inverse));
        for_each_bond(
          i,
          [&](const unsigned int j, const Tensor<1, dim> &, const double w, std::size_t) {
            if (!ends.is_fictitious(j))
              {
                rows.local_element(i) += 2. * kappa * w;
                rows.local_element(j) += 2. * kappa * w;
                return;
              }
            const FictitiousImages<dim> &images = *ends.images;
            const unsigned int           image  = ends.image(j);
            const double                 size   = kappa * w * (1. + images.sum_of_factors(image));
            rows.local_element(i) += size;
            images.for_each_term(image, [&](const auto &term) {
              double most = 0.;
              for (unsigned int d = 0; d < dim; ++d)
                most = std::max(most, std::abs(term.of_component(d)));
              rows.local_element(term.node) += size * most;
            });
          });
      }
    rows.compress(VectorOperation::add);
    return rows;
  }


  template <int dim>
  std::size_t NodeShapes<dim>::memory_consumption() const
  {
    return list.capacity() * sizeof(Shape) + stiffnesses.capacity() * sizeof(Stiffness) +
           of_bonds.memory_consumption() + deformed.capacity() * sizeof(Deformed);
  }


  PERIDEAL_INSTANTIATE_CLASS(class NodeShapes);
} // namespace PeriDeal
