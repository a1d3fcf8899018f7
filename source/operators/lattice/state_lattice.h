// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include "edge_nodes.h"
#include "lattice_stretches.h"

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
    /** Why the bonds of a body have no such form, or empty. */
    static std::string obstacle(const BodyParameters<dim> &body);

    /** @param computed the owned nodes that have no bond cut, whose sums are computed */
    StateLattice(const Families<dim>       &families,
                 const LatticeCoefficients &coefficients,
                 const std::vector<bool>   &computed);

    /** tau of the computed nodes. @p u has ghosts. */
    void dilatation_forces(double *tau, const double *u) const;

    /**
     * -F of the computed nodes. Owned and ghost values; without tau (null) only what the extensions
     * of bonds do; without u what tensions do. With both the displacements have to be those of
     * dilatation_forces(), called just before.
     */
    void forces(double *y, const double *u, const double *tau) const;

    /**
     * Whether s, c d/q^2, volumes and laws in the family are those of most nodes. For computed
     * nodes.
     */
    bool is_regular(const unsigned int node) const;

    std::size_t memory_consumption() const;

  private:
    using Stretch = typename LatticeStretches<dim>::Stretch;

    static constexpr std::uint32_t none = EdgeNodes<dim>::none;

    /** Consecutive nodes with e != 0 at consecutive slots. */
    struct ExcessRun
    {
      std::size_t   slot;
      std::uint32_t node, n;
    };

    void find_excesses(const std::vector<double> &excesses, const std::vector<double> &volumes);
    void set_terms();
    template <int n_components>
    void fill(std::vector<double> *to, const std::size_t group, const double *values) const;
    void add_up_at_edges(const std::size_t group, std::array<std::vector<double>, dim> &to) const;
    void add_excess(double *y, const double *u) const;
    void finish(const Stretch &stretch, double *y) const;
    void finish_edge(const Stretch &stretch, const double *u, const double *tau, double *y) const;

    const Families<dim>        &families;
    const CompleteFamilies<dim> complete;
    const EdgeNodes<dim>        edges;
    LatticeLayout<dim>          layout;
    const LatticeStretches<dim> stretches;
    std::vector<ExcessRun>      excess_runs;
    std::vector<double>         excess_factors; // V e of their nodes

    mutable std::array<std::vector<double>, dim>      displacements;  // padded: V u
    mutable std::vector<double>                       tensions;       // padded: V tau
    mutable std::array<std::vector<double>, dim>      sums, own_sums; // of a group
    std::vector<StencilKernel::Term>                  dilatation_terms;
    std::array<std::vector<StencilKernel::Term>, dim> force_terms; // tau first
  };
} // namespace PeriDeal
