// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <array>

#include "../lattice/lattice_stretches.h"

namespace PeriDeal
{
  /**
   * The sums over families of correspondence on a lattice, no bond stored. With w = omega f of an
   * offset xi, those of a node none of whose bonds is cut are
   *
   *   sum_j V_j w (u_j - u_i) xi^T = conv(w xi, V u) - u_i m_i^T,      m_i = sum_j V_j w xi,
   *   sum_j V_j w |u_j - u_i|^2    = conv(w, V |u|^2) - 2 u_i . conv(w, V u) + n_i |u_i|^2,
   *   F_i/V_i = Q_i m_i + conv(w xi, V Q) + c_i (conv(w, V u) - n_i u_i)
   *             + conv(w, V c u) - u_i conv(w, V c),                   n_i = sum_j V_j w,
   *
   * the latter of Q = P - c G. V = 0 where there is no node: volumes, surfaces, holes and c may be
   * any. Evaluation is not collective.
   */
  template <int dim>
  class GradientLattice
  {
  public:
    /** @param computed the owned nodes whose sums are found */
    GradientLattice(const Families<dim> &families, const std::vector<bool> &computed);

    /** Of a node, but for its own volume. */
    struct Sums
    {
      dealii::Tensor<2, dim> changes;               // of w du xi^T
      double                 square = 0., off = 0.; // of w |du|^2, and how far off that may be
    };

    /**
     * visit(node, sums) of the computed nodes. @p u has ghosts.
     * @param squares are asked for, else they are 0
     */
    template <typename Visit>
    void find_sums(const double *u, const bool squares, const Visit &visit) const;

    /**
     * -F of the computed nodes, of the displacements of the last find_sums().
     * @param numbers n of each node, owned and ghosts: Q row by row, c, others
     */
    void find_forces(double *y, const double *u, const double *numbers, const unsigned int n) const;

    std::size_t memory_consumption() const;

    LatticeLayout<dim> layout;

  private:
    /** value(node) times V, of what the group needs first. */
    template <typename Value>
    void fill(const std::size_t group, std::vector<double> &grid, const Value &value) const;

    void sum_group(const std::size_t group, const double *u, const bool squares) const;

    const Families<dim>        &families;
    const LatticeStretches<dim> stretches;
    std::vector<StencilKernel>  kernels; // w xi_a, w

    struct Edge
    {
      dealii::Tensor<1, dim> moment;   // m
      double                 all = 0.; // n
    };
    std::vector<Edge> edges; // of owned nodes

    mutable std::array<std::vector<double>, dim>       displacements; // padded: V u
    mutable std::vector<double>                        squares_of;    // padded: V |u|^2
    mutable std::array<std::vector<double>, dim * dim> tensors;       // padded: V Q
    mutable std::array<std::vector<double>, dim>       products;      // padded: V c u
    mutable std::vector<double>                        stiffnesses;   // padded: V c
    mutable std::vector<double>                        found;         // of a group
    mutable std::vector<double>                        smooth;        // conv(w, V u) of owned nodes
  };


  template <int dim>
  template <typename Visit>
  void GradientLattice<dim>::find_sums(const double *u,
                                       const bool    squares,
                                       const Visit  &visit) const
  {
    // Of sums of some hundred numbers, all of one sign: many times round-off.
    constexpr double  round_off = 1e-13;
    const std::size_t n         = stretches.n_sums;
    std::size_t       s         = 0;
    for (std::size_t group = 0; group < stretches.groups.size(); ++group)
      {
        sum_group(group, u, squares);
        for (; s < stretches.groups[group].stretches; ++s)
          for (std::uint32_t k = 0; k < stretches.list[s].n; ++k)
            {
              const std::uint32_t node = stretches.list[s].node + k;
              const double *const own  = u + static_cast<std::size_t>(dim) * node,
                                  *at  = found.data() + stretches.list[s].at + k;
              const Edge &edge         = edges[node];
              Sums        sums;
              double      square = 0., product = 0.;
              for (unsigned int a = 0; a < dim; ++a)
                {
                  for (unsigned int b = 0; b < dim; ++b)
                    sums.changes[a][b] = at[(dim * a + b) * n] - own[a] * edge.moment[b];
                  const double around                              = at[(dim * dim + a) * n];
                  smooth[static_cast<std::size_t>(dim) * node + a] = around;
                  square += own[a] * own[a];
                  product += own[a] * around;
                }
              if (squares)
                {
                  const double all = at[(dim * dim + dim) * n];
                  sums.square      = all - 2. * product + edge.all * square;
                  sums.off         = round_off * (all + edge.all * square);
                }
              visit(node, sums);
            }
      }
  }
} // namespace PeriDeal
