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
    std::vector<double> stiffnesses;                     // s, owned and ghosts
    std::vector<double> dilatations;                     // c d/q^2, owned; empty: none
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
      dealii::Tensor<1, dim>                 moment;             // sum_j V_j w xi
      std::array<double, dim *(dim + 1) / 2> block; // of -u_i; less what is in the stencils
    };

    EdgeNodes(const Families<dim>         &families,
              const CompleteFamilies<dim> &complete,
              const LatticeCoefficients   &coefficients,
              const std::vector<bool>     &computed);

    std::size_t memory_consumption() const;

    std::vector<double>        excess;    // e, owned and ghosts
    std::vector<std::uint32_t> number_of; // an owned node, in the list, or none
    std::vector<Node>          list;

  private:
    Node find(const Families<dim>         &families,
              const CompleteFamilies<dim> &complete,
              const LatticeCoefficients   &coefficients,
              const unsigned int           i) const;
  };
} // namespace PeriDeal
