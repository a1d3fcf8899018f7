// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/diverged.h>
#include <perideal/laws/j2_plasticity.h>
#include <perideal/mesh/nodes.h>
#include <perideal/operators/solid/stress_laws.h>
#include <perideal/operators/solid/stress_steps.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * What a law of stresses says at the owned nodes, and what these went through until the last
   * accepted step. Not collective unless stated.
   */
  template <int dim>
  class NodeStresses
  {
  public:
    /**
     * Both have to outlive this object. Throws UserError: a yield stress that is not positive.
     * Collective.
     */
    NodeStresses(const Nodes<dim> &nodes, const BodyParameters<dim> &body);

    /** As FamilyForces::take_temperatures(). Collective. */
    void take_temperatures(const Vector &changes);

    /** Moduli follow a temperature that is computed. */
    bool moduli_change() const
    {
      return body.moduli_change();
    }

    /** The stiffness of the linear law at the temperature of now. */
    dealii::SymmetricTensor<4, dim> elastic(const unsigned int i) const;

    bool is_linear() const
    {
      return kind.is_linear;
    }

    /** Deformations are large: the law is one of S and the strain of Green and Lagrange. */
    bool is_full() const
    {
      return kind.is_full;
    }

    /** Whether it knows what is stored beside the strain of a point (J2Plasticity::Beside). */
    bool flows() const
    {
      return kind.j2 != nullptr;
    }

    /** What a node goes through counts, or the law may fail. */
    bool remembers() const
    {
      return law.law->n_state() > 0 || law.law->may_fail();
    }

    /** The node flowed in an accepted step. */
    bool has_flowed(const unsigned int i) const
    {
      return flows() && states[(i + 1) * law.law->n_state() - 1] > 0.;
    }

    /**
     * Ask about a displacement gradient, in a step to time `now`.
     * @param flow its square is set, 0 of other laws
     * @param tangent null: is not asked for; of large deformations dS/dE
     * Where large deformations turn the node inside out the answer is zero (throw_faults()).
     */
    void ask(const unsigned int               i,
             const dealii::Tensor<2, dim>    &slopes,
             J2Plasticity::Beside            &flow,
             dealii::SymmetricTensor<4, dim> *tangent) const;

    /** What has been said last. */
    const StressLaw::Response &operator[](const unsigned int i) const
    {
      return responses[i];
    }

    dealii::SymmetricTensor<2, dim> stress(const unsigned int i) const;

    /** The strain that the law is asked about, but for temperatures. */
    dealii::SymmetricTensor<2, dim> strain(const dealii::Tensor<2, dim> &slopes) const;

    /** Forces per area at rest of what has been said last of these: sigma, or P = F S. */
    dealii::Tensor<2, dim> pull(const unsigned int i, const dealii::Tensor<2, dim> &slopes) const;

    /** Forces per area of the deformed body. */
    StressLaw::Tensor cauchy(const unsigned int i, const dealii::Tensor<2, dim> &slopes) const;

    /**
     * Throw what the law has thrown on any process, or Diverged (`inversion`) of the node that is
     * farthest inside out. Collective.
     */
    void throw_faults() const;

    /** The tangents that nodes have said last are symmetric, on all processes. Collective. */
    bool have_symmetric_tangents() const;

    /** It has said nothing else than what was accepted last, on all processes. Collective. */
    bool same_states() const;

    /** Go on from what has been said last, if anything flows, at this time. */
    void accept(const double t, const bool flows, const bool changes);

    /** What StressLaw::shown() names. */
    std::vector<std::pair<std::string, std::vector<double>>> shown() const;

    /** Collective. */
    void exchange(Archive &archive, const NodeKeys &keys);

    double now() const
    {
      return steps.now;
    }

    void set_time(const double t) const
    {
      steps.now = t;
    }

    std::size_t memory_consumption() const;

  private:
    /** Parameters of the law at the temperatures of now. Collective. */
    void find_parameters();

    const Nodes<dim>          &nodes;
    const BodyParameters<dim> &body;
    PlacedStressLaw<dim>       law;
    struct
    {
      const J2Plasticity *j2        = nullptr; // if it is that
      bool                is_linear = false, is_full = false;
    } kind;
    std::vector<double>        parameters; // of nodes in a row that are alike
    std::vector<std::uint32_t> number_of;  // in these
    struct
    {
      std::vector<double> strains; // alpha dT, of the linear law thermal_strain(); empty: none
      std::vector<double> temperatures, accepted;
    } warm;
    std::vector<double>                      states;
    mutable std::vector<double>              next;
    mutable std::vector<StressLaw::Response> responses;
    mutable Trip                             inverted; // the worst one
    StressSteps                              steps;
  };
} // namespace PeriDeal
