// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/families.h>
#include <perideal/bonds/stencil_kernel.h>

#include <array>
#include <cstdint>
#include <vector>

#include "lattice_layout.h"

namespace PeriDeal
{
  /**
   * Dilatations and forces of the linear peridynamic solid on a lattice, no bond stored. With w =
   * omega f of an offset xi of length x, s = b/q (extension/q) and tau = c theta/q of
   * StateOperator, both of a node, a node none of whose bonds is cut has
   *
   *   tau_i   = c_i d/q_i^2 sum_j V_j w xi . (u_j - u_i)
   *   F_i/V_i = sum_j V_j w xi (tau_i + tau_j) + sum_j (s_i + s_j) V_j w xi xi^T/x^2 (u_j - u_i)
   *
   * Both are sums of convolutions of V u, V tau and V s u with stencils that are odd or even in
   * each coordinate, whatever s, V and tau: of nodes at the body's surface, in holes (V = 0) and in
   * several phases. With s_i = s (1 + 2 e_i), s that of a complete family of one phase, e vanishes
   * at most nodes: what has a factor e is computed only for those in whose families it does not.
   *
   * Evaluation allocates nothing and is not collective.
   */
  template <int dim>
  class StateLattice
  {
  public:
    /** Coefficients of the nodes. */
    struct Coefficients
    {
      double              stiffness = 0., dilatation = 0.; // of most nodes, with complete families
      std::vector<double> stiffnesses;                     // s, owned and ghosts
      std::vector<double> dilatations;                     // c d/q^2, owned; empty: none
    };

    /** Why the bonds of a body have no such form, or empty. */
    static std::string obstacle(const BodyParameters<dim> &body);

    /** @param computed the owned nodes that have no bond cut, whose sums are computed */
    StateLattice(const Families<dim>     &families,
                 const Coefficients      &coefficients,
                 const std::vector<bool> &computed);

    /** tau of the computed nodes. @p u has ghosts. */
    void dilatation_forces(double *tau, const double *u) const;

    /**
     * -F of the computed nodes. Owned and ghost values; without tau (null) only what the extensions
     * of bonds do. With tau the displacements u have to be those of the last call of
     * dilatation_forces().
     */
    void forces(double *y, const double *u, const double *tau) const;

    /**
     * Whether s, c d/q^2, volumes and laws in the family are those of most nodes. For computed
     * nodes.
     */
    bool is_regular(const unsigned int node) const;

    std::size_t memory_consumption() const;

  private:
    static constexpr std::uint32_t none = LatticePiece::none;

    /** What a node has whose family is not like those of most. */
    struct EdgeNode
    {
      double                                 excess, dilatation; // e, c d/q^2
      dealii::Tensor<1, dim>                 moment;             // sum_j V_j w xi
      std::array<double, dim *(dim + 1) / 2> block; // of -u_i; less what is in the stencils
    };

    /** Consecutive nodes of one run, all of them edge nodes or none. */
    struct Stretch
    {
      std::uint32_t node, n, at; // in the sums of the group
      std::uint32_t edge;        // the first in the list of edge nodes, or none
    };

    /** Ends of the group's parts of lists. */
    struct Group
    {
      std::size_t stretches = 0, clusters = 0;
    };

    struct ExcessSlot
    {
      std::size_t   slot;
      std::uint32_t node;
      double        factor; // V e
    };

    /** Number of the pair in a list of those a <= b. */
    static constexpr unsigned int pair(const unsigned int a, const unsigned int b)
    {
      return a <= b ? a * dim - a * (a + 1) / 2 + b : pair(b, a);
    }

    void     make_kernels();
    void     find_edges(const Coefficients &coefficients, const std::vector<bool> &computed);
    EdgeNode edge_node(const unsigned int node, const Coefficients &coefficients) const;
    void     find_stretches();
    void     find_clusters(const std::size_t begin, const std::size_t end);
    void     set_terms();
    template <int n_components>
    void fill(std::vector<double> *to, const std::size_t group, const double *values) const;
    void fill_excess(const double *u) const;
    void convolve(const std::vector<StencilKernel::Term> &terms,
                  const std::size_t                       first_term,
                  const std::size_t                       group,
                  double                                 *to) const;
    void convolve_edges(const std::size_t group) const;
    void finish(const Stretch &stretch, double *y) const;
    void finish_edge(const Stretch &stretch, const double *u, const double *tau, double *y) const;

    const Families<dim>       &families;
    double                     volume, reference, dilatation; // V, s, c d/q^2 of most
    double                     center[dim];                   // of the even stencils, negative
    std::vector<double>        excess;                        // e, owned and ghosts
    std::vector<StencilKernel> moments, springs;              // w xi_a; 2 s w xi_a xi_b/x^2
    std::vector<std::uint32_t> edge_of;                       // owned node
    std::vector<EdgeNode>      edges;
    LatticeLayout<dim>         layout;
    std::vector<Group>         groups;
    std::vector<std::uint32_t> places; // of the runs in the sums of their groups
    std::vector<Stretch>       stretches;
    std::vector<std::size_t>   clusters; // ends of what is computed together in edge_runs
    std::vector<std::uint32_t> edge_places;
    std::vector<ExcessSlot>    excess_slots;

    mutable std::vector<StencilKernel::Run>           runs, edge_runs;
    mutable std::array<std::vector<double>, dim>      displacements, excesses; // padded: V u, V e u
    mutable std::vector<double>                       tensions;                // padded: V tau
    mutable std::array<std::vector<double>, dim>      sums, own_sums, other_sums; // of a group
    std::vector<StencilKernel::Term>                  dilatation_terms;
    std::array<std::vector<StencilKernel::Term>, dim> force_terms, excess_terms; // tau first
  };
} // namespace PeriDeal
