// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/softening_curve.h>
#include <perideal/operators/solid/damage_criterion.h>

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
   * have stored G. A bond has the values of its end that softens earlier.
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
      return {extension, length * onsets[weaker(i, j)]};
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
      const unsigned int k = weaker(i, j);
      return openings[k] > 0. ?
               curve((ratio - 1.) * onsets[k] * length / openings[k]) / std::max(1., ratio) :
               0.;
    }

    double stored_at_onset() const override
    {
      return stored;
    }

    const std::vector<double> &least_stretches() const override
    {
      return onsets;
    }

    const std::vector<double> &of_nodes() const override
    {
      return onsets;
    }

    std::size_t memory_consumption() const override
    {
      return (onsets.capacity() + openings.capacity()) * sizeof(double);
    }

  private:
    unsigned int weaker(const unsigned int i, const unsigned int j) const
    {
      const bool first = std::make_pair(onsets[i], openings[i]) <
                         std::make_pair(onsets[j], openings[j]);
      return first ? i : j;
    }

    /** s_0 and w, 0: brittle. @param strength, @param energy the fracture energy, of a node */
    std::pair<double, double> of_node(const CrossingEnergy &crossing,
                                      const double          strength,
                                      const double          energy);

    const SofteningCurve curve;
    std::vector<double>  onsets, openings; // s_0 and w of owned nodes and ghosts
    double               stored = 0.;
  };
} // namespace PeriDeal
