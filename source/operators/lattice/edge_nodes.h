// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <array>

#include "lattice_layout.h"

namespace PeriDeal
{
  /** Coefficients of the nodes of StateLattice. */
  struct LatticeCoefficients
  {
    double              stiffness = 0., dilatation = 0.; // of most nodes, with complete families
    std::vector<double> excesses;    // e, owned and ghosts; 0 to the last bit at most nodes
    std::vector<double> dilatations; // c d/q^2, owned; empty: none
  };


  /**
   * The nodes that are like most: with the volume of a cell of the lattice and the same s, those of
   * their families, which are complete, included.
   */
  template <int dim>
  struct CompleteFamilies
  {
    CompleteFamilies(const Families<dim> &families, const LatticeCoefficients &coefficients);

    /** Number of the pair in a list of those a <= b. */
    static constexpr unsigned int pair(const unsigned int a, const unsigned int b)
    {
      return a <= b ? a * dim - a * (a + 1) / 2 + b : pair(b, a);
    }

    double                     volume, stiffness, dilatation; // V, s, c d/q^2
    std::array<double, dim>    center{};                      // of the even stencils, negative
    std::vector<StencilKernel> moments, springs;              // w xi_a; 2 s w xi_a xi_b/x^2
  };


  /** The computed nodes that are not, and what they have of their own. */
  template <int dim>
  class EdgeNodes
  {
  public:
    static constexpr std::uint32_t none = LatticePiece::none;

    struct Node
    {
      double                                 excess, dilatation; // e, c d/q^2
      std::array<double, dim *(dim + 1) / 2> block; // of -u_i; less what is in the stencils
    };

    EdgeNodes(const Families<dim>         &families,
              const CompleteFamilies<dim> &complete,
              const LatticeCoefficients   &coefficients,
              const std::vector<bool>     &computed);

    /** sum_j V_j w xi of a node of the list. */
    const dealii::Tensor<1, dim> &moment(const std::size_t edge) const
    {
      return moments[moment_of[edge]];
    }

    std::size_t memory_consumption() const;

    std::vector<std::uint32_t> number_of; // an owned node, in the list, or none
    std::vector<Node>          list;

  private:
    void add(const Families<dim>         &families,
             const CompleteFamilies<dim> &complete,
             const LatticeCoefficients   &coefficients,
             const unsigned int           i,
             dealii::Tensor<1, dim>      &moment);

    // Along sides of the body all nodes have the same ones, to the last bit.
    std::vector<dealii::Tensor<1, dim>> moments;
    std::vector<std::uint32_t>          moment_of; // the nodes of the list
  };
} // namespace PeriDeal
