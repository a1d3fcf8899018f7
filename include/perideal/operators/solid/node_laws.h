// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>
#include <perideal/bonds/families.h>
#include <perideal/laws/linear_peridynamic_solid.h>
#include <perideal/scene/body_parameters.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * The law of each node of the linear peridynamic solid (StateOperator), and q of its family: what
   * makes forces of extensions.
   */
  template <int dim>
  class NodeLaws
  {
  public:
    /** @param nodes with their halo. q is to be filled in. Collective. */
    NodeLaws(const Nodes<dim> &nodes, const BodyParameters<dim> &body);

    /**
     * Temperatures have become those of nodes, ghosts up to date: so have moduli that depend on
     * them. Springs are left as they are. Collective.
     */
    void take_temperatures(const Vector &changes);

    /** Of an owned node or a ghost, at the temperature that was taken last. */
    Moduli moduli(const unsigned int i) const
    {
      return changes.empty() ? body.moduli(nodes.position(i)) :
                               body.moduli(nodes.position(i), changes[i]);
    }

    const StateLaw &operator[](const unsigned int node) const
    {
      return laws[laws.size() > 1 ? node : 0];
    }

    /** b_i/q_i. */
    double stiffness(const unsigned int i) const
    {
      return LinearPeridynamicSolid::stiffness((*this)[i], weighted.local_element(i));
    }

    /** c_i theta_i/q_i, of the sum of W x e over the family. */
    double tension(const unsigned int i, const double sum) const
    {
      return LinearPeridynamicSolid::tension((*this)[i],
                                             weighted.local_element(i),
                                             nodes.volume(i),
                                             sum);
    }

    double shear_tension(const unsigned int i, const double sum) const
    {
      return LinearPeridynamicSolid::shear_tension((*this)[i],
                                                   weighted.local_element(i),
                                                   nodes.volume(i),
                                                   sum);
    }

    /** tension() of c = 1. */
    double unit_tension(const unsigned int i, const double sum) const
    {
      const double q = weighted.local_element(i);
      return (*this)[i].dilatation * sum / (q * q * nodes.volume(i));
    }

    /** tension() in the tangent (slope). */
    double tangent_tension(const unsigned int i, const double sum) const
    {
      return slope == 1. ? tension(i, sum) : tension(i, sum) + (slope - 1.) * shear_tension(i, sum);
    }

    /**
     * q of an owned node with this family; @p message is set, if it is empty, where its bonds do
     * not hold it.
     */
    double weight_of(const Families<dim>                               &families,
                     const unsigned int                                 i,
                     const std::vector<typename Families<dim>::Member> &family,
                     std::string                                       &message) const;

    /** Of several laws that of most nodes, if it is the softest or the stiffest one. Collective. */
    StateLaw reference() const;

    std::size_t memory_consumption() const
    {
      return laws.capacity() * sizeof(StateLaw) + changes.capacity() * sizeof(double);
    }

    Vector         weighted;   // q_i; ghosts up to date
    const bool     volumetric; // there are dilatations
    const bool     counts_cut; // q is that of the body before cracks cut it, as where bonds soften
    mutable double slope          = 1.;    // of a linear BondLaw, in its step
    bool           several_phases = false; // nodes differ in b

  private:
    void find_laws();

    const Nodes<dim>          &nodes;
    const BodyParameters<dim> &body;
    const double               horizon;
    std::vector<StateLaw>      laws; // owned and ghosts; a single one: all have it
    std::vector<double> changes; // of temperatures that moduli follow; empty: those of the scene
  };
} // namespace PeriDeal
