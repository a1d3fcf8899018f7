// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/relaxing_families.h>
#include <perideal/operators/solid/yielding_families.h>

#include <limits>
#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * The bonds of the linear peridynamic solid, inside the body and beyond its sides, with what
   * their forces follow from.
   */
  template <int dim>
  struct SolidBonds
  {
    /** Throws UserError for a body that cannot have them. Not collective. */
    static void require(const BodyParameters<dim> &body);

    /** Adds the halo to the nodes. Collective. Throws UserError, among others: isolated nodes. */
    SolidBonds(Nodes<dim> &nodes, const BodyParameters<dim> &body);

    SolidBonds(const SolidBonds &) = delete;

    /**
     * Let the cracks be those of a later time: bonds that they cut bear nothing any more, and q and
     * the springs that follow from it are those of the bonds that are left, as if the cracks had
     * been there from the start. Collective. Throws UserError: nodes without hold.
     * @param marked bonds that it cuts have been marked already
     */
    void apply_change(const ChangeSet<dim> &change, const bool marked);

    /**
     * Temperatures have become those of nodes, ghosts up to date; moduli that depend on them
     * follow. Not of a lattice. Collective.
     */
    void take_temperatures(const Vector &changes);

    Families<dim>       families;
    NodeLaws<dim>       laws;
    ThermalStrains      thermal;
    LawSteps            law;
    BondEnds<dim>       ends;
    BondTable<dim>      rows;
    SolidSums<dim>      sums;
    BondKinematics<dim> kinematics;
    BondForces<dim>     forces;

    std::unique_ptr<FamilyForces<dim>> by_family; // or none: in place of the forces

    /** by_family if it is that, else null. */
    const YieldingFamilies<dim> *yielding() const
    {
      return dynamic_cast<const YieldingFamilies<dim> *>(by_family.get());
    }

    const RelaxingFamilies<dim> *relaxing() const
    {
      return dynamic_cast<const RelaxingFamilies<dim> *>(by_family.get());
    }

    /** Families of correspondence, whose body relaxes or not; or null. */
    Correspondence<dim> *correspondence() const
    {
      return relaxing() != nullptr ? relaxing()->correspondence() :
                                     dynamic_cast<Correspondence<dim> *>(by_family.get());
    }

    /** Families make forces that follow from what was accepted, or are not linear. */
    bool remembers() const
    {
      return by_family && by_family->remembers();
    }

    /** Families make forces that are not linear. */
    bool flows() const
    {
      return by_family && !by_family->is_linear();
    }

    /** Some bonds of these owned nodes bear nothing any more. Not collective. */
    void renew_gradients(const std::vector<unsigned int> &of_nodes)
    {
      if (auto *const nodal = correspondence())
        nodal->renew(of_nodes);
      if (auto *const of_law = dynamic_cast<RelaxingFamilies<dim> *>(by_family.get());
          of_law != nullptr && !of_nodes.empty())
        of_law->renew();
    }

    /** What has been found at surfaces. */
    struct Corrections
    {
      // By `Surface correction = moments`:
      unsigned long long n_left = 0;  // nodes of all processes that are as they were
      double             gap    = 0.; // SurfaceFactors
      // Of a mesh: least thickness of the body behind free sides, where it is thin
      // (thin_on_mesh()).
      double thinnest = std::numeric_limits<double>::infinity();
    } corrections;

  private:
    void                               complete_families(const BodyParameters<dim> &body);
    std::unique_ptr<FamilyForces<dim>> make_families(const BodyParameters<dim> &body);
    void                               correct_surface(const BodyParameters<dim> &body);
    void                               part(const unsigned int i, const double t);
    bool                               has_parted(const unsigned int i) const; // since the start

    /** q with the cracks as they are, broken bonds included. */
    double     weight_left(const unsigned int i, std::string &message) const;
    void       renew_springs(const unsigned int i);
    void       renew_weights(const std::vector<unsigned int> &of_nodes);
    const bool weights_follow; // q is that of the family, and not of a complete one
  };
} // namespace PeriDeal
