// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/softening_curve.h>
#include <perideal/operators/solid/interface_bonds.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * Bonds that soften (Law = softening): all that crosses a row begins to at the stretch s_0 at
   * which it bears the tensile strength, s_0 = f_t/(stress + max(0, stress_of_dilatations)/2), in
   * plane stress f_t (1 - nu)/E of bonds' own nu, and then bears (1 - d) s = s_0 T(z),
   * z = (s - s_0) x/w, T that of SofteningCurve. z goes with the opening, so that the stress over
   * the opening of the row is T itself. w is such that the row dissipates the fracture energy, with
   * the symbols of CrossingEnergy and l their mean length,
   *
   *   G = s_0^2 (extensions + dilatations) + 2 s_0 w over_lengths
   *     + 2 s_0^2 dilatations I,  I = integral of T^2/s ds from s_0 on, of bonds of the length l.
   *
   * Where the bonds have stored more than G at s_0 they break at once, at the stretch at which they
   * have stored G. A bond has the values of its end that softens earlier, both by the strength and
   * energy of an interface of two phases where it crosses one (Material::Law::Interface).
   */
  template <int dim>
  class SofteningStrengths : public DamageCriterion<dim>
  {
  public:
    /** Throws UserError for strengths and energies that are not above 0. Collective. */
    explicit SofteningStrengths(const BreakableBonds<dim> &bonds);

    BondMeasure measure(const unsigned int i,
                        const unsigned int j,
                        const double       extension,
                        const double       length) const override
    {
      return {extension, length * limits(i, j).onset};
    }

    bool softens() const override
    {
      return true;
    }

    double integrity(const unsigned int i,
                     const unsigned int j,
                     const double       length,
                     const double       ratio) const override
    {
      const Limits of_bond = limits(i, j);
      return of_bond.opening > 0. ? curve((ratio - 1.) * of_bond.onset * length / of_bond.opening) /
                                      std::max(1., ratio) :
                                    0.;
    }

    double stored_at_onset() const override
    {
      return stored;
    }

    const std::vector<double> &least_stretches() const override
    {
      return least.empty() ? onsets : least;
    }

    const std::vector<double> &of_nodes() const override
    {
      return onsets;
    }

    std::size_t memory_consumption() const override
    {
      return (onsets.capacity() + least.capacity()) * sizeof(double) +
             nodes.capacity() * sizeof(Limits) + interfaces.memory_consumption();
    }

  private:
    /** s_0 and w, 0: brittle. */
    struct Limits
    {
      double onset, opening;

      bool operator<(const Limits &other) const
      {
        return std::make_pair(onset, opening) < std::make_pair(other.onset, other.opening);
      }
    };

    /** Of a bond. */
    Limits limits(const unsigned int i, const unsigned int j) const
    {
      const std::size_t first = (interfaces.between(i, j) + 1) * onsets.size();
      return std::min(nodes[first + i], nodes[first + j]);
    }

    /** @param strength, @param energy the fracture energy, of a node */
    Limits of_node(const CrossingEnergy &crossing, const double strength, const double energy);

    const SofteningCurve      curve;
    const InterfaceBonds<dim> interfaces;
    std::vector<Limits>       nodes; // owned ones and ghosts; then the same at each interface
    std::vector<double>       onsets, least; // s_0 of nodes, of their bonds (empty: the same)
    double                    stored = 0.;
  };
} // namespace PeriDeal
