// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/lac/full_matrix.h>

#include <perideal/base/types.h>

#include <vector>

namespace PeriDeal
{
  /** What the bonds and the pairs of cut cells that cracks cross add to a node's trace. */
  struct CrossingShare
  {
    double kept  = 0.; // as they conduct
    double whole = 0.; // as they would without cracks
  };


  /**
   * The factor of crack-side scaling, for a node that is not beside a crack 1, else
   *
   *   1 + (1 - t)^2 (g - 1),   g = (expected - kept)/(trace - kept), clipped to [0.5, 4],
   *
   * with t = kept/whole, what cracks let through, 0 where nothing crosses them. g is 1 where what
   * is left of the trace is not positive.
   */
  double crack_side_factor(const bool           beside_crack,
                           const double         expected,
                           const double         trace,
                           const CrossingShare &crossing = {});


  /**
   * Crack-side scaling (`Surface correction = crack scaling`): what a node loses with its broken
   * bonds and cut cells, the others make up for. Node i has the factor
   *
   *   g_i = (E_i - X_i)/(T_i - X_i), T_i = -(1/2) sum_j tr K_ij r_ij^2, clipped to [0.5, 4],
   *
   * where E_i is T_i of an infinite body: V_i d kappa for heat and V_i C_abab for a solid, and X_i
   * what crosses a crack that conducts, 0 for others; such cracks blend g_i with 1
   * (crack_side_factor()). Nodes that are not beside a crack have the factor 1. Bonds are
   * multiplied by the mean of both ends' factors, cells by that of their vertices', but not what
   * crosses a crack: a contact conductance says what that conducts.
   *
   * Both sums are those of bonds and cells without factors: add up Sums, then call find().
   */
  class CrackSideFactors
  {
  public:
    /**
     * Memory for the sums, by nodes: which are beside a crack (above 0), T, E, X and X without
     * cracks. Zero outside of the search for factors.
     */
    struct Sums
    {
      explicit Sums(const Vector &layout);

      /** Mark the nodes of a cell that a crack cuts. Not collective. */
      void mark(const std::vector<dealii::types::global_dof_index> &of_cell);

      /**
       * Whether a cell has a node that is marked; marks have been compressed, and their ghosts
       * updated.
       */
      bool any_marked(const std::vector<dealii::types::global_dof_index> &of_cell) const;

      /**
       * Add what is left of a cell's matrix. Not collective.
       *
       * @param cell      with a node at each vertex
       * @param of_cell   its nodes
       * @param stiffness unknowns of a node, one or more, stand together
       * @param modulus   d kappa or C_abab
       */
      template <typename Cell>
      void add(const Cell                                         &cell,
               const std::vector<dealii::types::global_dof_index> &of_cell,
               const dealii::FullMatrix<double>                   &stiffness,
               const double                                        modulus);

      /** Add what two vertices of a cell that a crack separates conduct. Not collective. */
      void add_crossing(const dealii::types::global_dof_index a,
                        const dealii::types::global_dof_index b,
                        const double                          distance_square,
                        const CrossingShare                  &conductance);

      /** Add what nodes have on other processes. Collective. */
      void compress();

      /**
       * Of cracks that conduct: those of the owned nodes lose nothing that nothing leaves through a
       * crack. The sums have been compressed. Not collective.
       */
      void leave_out_uncrossed(const std::vector<unsigned int> &nodes);

      /** Set owned nodes to zero, and all ghosts. Not collective. */
      void clear(const std::vector<unsigned int> &nodes);

      Vector marked, trace, expected, crossing, crossing_whole;
    };

    /** No node has a factor, which is a factor of 1. */
    bool empty() const
    {
      return factors.size() == 0;
    }

    /** Give each node the factor 1. @p layout of nodes. */
    void start(const Vector &layout);

    /** Set the factors of some owned nodes, all others keep theirs. Collective. */
    void find(const std::vector<unsigned int> &nodes, const Sums &sums);

    /** Of an owned node or a ghost. Only if not empty. */
    double at(const unsigned int node) const;

    /** By which a bond is multiplied. */
    double of_bond(const unsigned int i, const unsigned int j) const
    {
      return empty() ? 1. : 0.5 * (factors.local_element(i) + factors.local_element(j));
    }

    /** By which a cell with these nodes is multiplied. */
    double of_cell(const std::vector<dealii::types::global_dof_index> &nodes) const;

  private:
    Vector factors;
  };


  template <typename Cell>
  void CrackSideFactors::Sums::add(const Cell                                         &cell,
                                   const std::vector<dealii::types::global_dof_index> &of_cell,
                                   const dealii::FullMatrix<double>                   &stiffness,
                                   const double                                        modulus)
  {
    const unsigned int n = of_cell.size(), n_components = stiffness.m() / n;
    const double       share = modulus * cell->measure() / n;
    for (unsigned int a = 0; a < n; ++a)
      {
        expected(of_cell[a]) += share;
        for (unsigned int b = 0; b < n; ++b)
          for (unsigned int c = 0; c < n_components; ++c)
            trace(of_cell[a]) -= 0.5 * stiffness(n_components * a + c, n_components * b + c) *
                                 (cell->vertex(b) - cell->vertex(a)).norm_square();
      }
  }
} // namespace PeriDeal
