// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/lattice_family.h>

#include <optional>
#include <vector>

namespace PeriDeal
{
  template <int dim>
  struct BodyParameters;

  /** What the weight of a bond follows from. */
  struct KernelParameters
  {
    KernelShape    kernel;
    unsigned int   exponent; // n
    VolumeFraction fraction;
    Calibration    calibration;
    SelfTerm       self_term;
    double         horizon;
  };


  /**
   * The weights of bonds of unit conductivity, w = kernel * volume fraction / r^n: of the members
   * of a lattice's family, or of any length between other nodes. They know no nodes.
   */
  template <int dim>
  class KernelWeights
  {
  public:
    /**
     * Throws UserError as lattice_family() does.
     * @param spacing           of the lattice; none: nodes of any places
     * @param smallest_spacing  of the nodes
     */
    KernelWeights(const KernelParameters                      &parameters,
                  const std::optional<dealii::Tensor<1, dim>> &spacing,
                  const double                                 smallest_spacing);

    /** On a lattice: the full family, self term not included. Else empty. */
    const std::vector<FamilyMember<dim>> &members() const
    {
      return family;
    }

    /** Self term additions (own volume), empty if none. */
    const std::vector<FamilyMember<dim>> &self_members() const
    {
      return self_additions;
    }

    /** The members one step away along an axis. */
    const std::vector<FamilyMember<dim>> &nearest_members() const
    {
      return nearest;
    }

    /** The member at a relative position, or nullptr. On lattices only. */
    const FamilyMember<dim> *find(const dealii::Tensor<1, dim> &xi) const;

    /** Whether a relative position is that of a member. On lattices only. */
    bool is_offset(const dealii::Tensor<1, dim> &xi, const FamilyMember<dim> &member) const;

    /** Off the lattice: w of a bond of this length. */
    double of_length(const double r) const;

    /**
     * Horizon as a length, and the largest distance of a bond (volume fractions may reach half a
     * spacing farther).
     */
    double horizon() const;
    double reach() const
    {
      return farthest;
    }

    /** The largest offset of a member in each direction. */
    std::array<int, dim> reach_in_sites() const;

    /** Weights of lengths have to be multiplied by a factor that follows from the nodes. */
    bool wants_calibration() const;

    /**
     * That factor is n/moments, the sum of sum_j w V_j r^2/(2 dim) over n complete families. Where
     * there are none it is 1: the weights are analytic.
     */
    void calibrate(const double moments, const double n);

    /**
     * Discrete calibration had a complete family to sum over. Off the lattice a body may be too
     * narrow for any; then it is analytic.
     */
    bool has_complete_families() const
    {
      return complete_families;
    }

    /**
     * What the bonds of a complete family conduct of a linear field, over what the conductivity
     * asks for: the mean over the directions of sum_j w V_j xi_a^2/(2 kappa), self term included. 1
     * with discrete calibration; also 1 off the lattice, where it is not known.
     */
    double effective_conductivity() const;

  private:
    void make_members();

    const KernelParameters                      parameters;
    const std::optional<dealii::Tensor<1, dim>> spacing;
    const double                                smallest_spacing;
    const double                   scale; // of the kernel, before calibration by the factor
    double                         factor = 1., farthest = 0.;
    bool                           complete_families = true;
    std::vector<FamilyMember<dim>> family, self_additions, nearest;
  };
} // namespace PeriDeal
