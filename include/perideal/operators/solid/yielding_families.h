// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/ordinary_plasticity.h>
#include <perideal/operators/solid/bond_table.h>
#include <perideal/operators/solid/family_forces.h>
#include <perideal/operators/solid/step_work.h>

#include <vector>

namespace PeriDeal
{
  /**
   * The bonds of a solid that yields (OrdinaryPlasticity), with linear kinematics. With the stretch
   * s = e/x of a bond, S = W x^2 and alpha = b/q an end makes of its family
   *
   *   theta = d sum S s/(V q),  s_e = s - theta/d - s_p,  D = alpha/(2 V) sum S s_e^2,
   *
   * and pulls along W xi by d p/q + alpha r s_e. Of each end a bond remembers s_p: both numbers
   * stand in the rows of both ends (the history of BondRows, that of the row's own node first), so
   * that processes exchange what nodes make of their families and nothing of bonds. Fictitious
   * nodes have no families: of bonds to them one end counts.
   */
  template <int dim>
  class YieldingFamilies : public FamilyForces<dim>
  {
  public:
    static constexpr unsigned int n_history = 2; // of a bond

    /**
     * All have to outlive this object; springs of the bonds have been found. Collective. Throws
     * UserError: a yield stress that is not positive.
     */
    YieldingFamilies(const Families<dim>       &families,
                     const BondEnds<dim>       &ends,
                     BondTable<dim>            &bonds,
                     const NodeLaws<dim>       &laws,
                     const BodyParameters<dim> &body);

    bool is_linear() const override
    {
      return false;
    }

    /** What families make of u. Collective. */
    void find(const Vector &u) const;

    void find_forces(Vector &y, const Vector &u, const double = 0.) const override;

    void take_temperatures(const Vector &changes) override;

    /** By hardening, too. Collective. */
    double energy(const Vector &u) const override;

    /**
     * The yield stress without hardening times what plastic strains have grown by in the step to u,
     * by volume. Collective.
     */
    double plastic_work(const Vector &u) const;

    /** Where steps are short what it returns is plastic_work(). Collective. */
    double accept(const Vector &u, const double = 0.) override;

    void exchange(Archive &archive, const NodeKeys &keys) override;
    void linearize(const Vector &u) override;

    /** Nodes yielded at the last linearize(): else K is that of the elastic body. */
    bool has_tangent() const override
    {
      return tangent.any;
    }

    void forget_tangent() override
    {
      tangent.any = false;
    }

    void multiply(Vector &y, const Vector &x) const override;

    /** The equivalent plastic strain of an owned node, at the last accepted step. */
    double plastic_strain(const unsigned int i) const
    {
      return states[i].strain;
    }

    /** In plane strain, the stress of an owned node out of the plane, at the last find(). */
    double out_of_plane(const unsigned int i) const
    {
      return trial.answers[i].out_of_plane;
    }

    /**
     * By what a bond of an owned node pulls along W xi, at the last find(): this end alone, or
     * half of both.
     */
    double force(const unsigned int i, const SolidBond<dim> &bond, const bool half_of_both) const;

    std::size_t memory_consumption() const override;

  private:
    /** Of the owned nodes at these temperatures; empty: at those of the start. Collective. */
    void find_materials(const std::vector<double> &temperatures);

    /** Numbers of each bond, in the order of rows. */
    struct OfBonds
    {
      std::vector<double> body, beyond;
    };

    /** What the other ends of bonds have to know of a node. */
    enum Number : unsigned int
    {
      tension,    // d p/q - alpha r theta/d
      stiffness,  // alpha r
      dilatation, // theta/d
      lost,       // 1 - r
      n_numbers
    };

    /** The same where it is linear: changes of the tension, of alpha r; alpha r. */
    enum Change : unsigned int
    {
      of_tension,
      of_stiffness,
      kept,
      n_changes
    };

    bool        knows(const Vector &u) const;
    void        remember();
    std::size_t size_of(const OfBonds &numbers) const
    {
      return (numbers.body.capacity() + numbers.beyond.capacity()) * sizeof(double);
    }

    const Families<dim>                   &families;
    const BondEnds<dim>                   &ends;
    BondTable<dim>                        &bonds;
    const NodeLaws<dim>                   &laws;
    const BodyParameters<dim>             &of_scene;
    std::vector<double>                    expansions; // alpha dT of all nodes; empty: it is cold
    std::vector<OrdinaryPlasticity>        materials;  // of owned nodes, or a single one
    std::vector<OrdinaryPlasticity::State> states;     // of owned nodes

    struct
    {
      bool                                    known = false, has_forces = false;
      Vector                                  displacement, forces, numbers;
      std::vector<OrdinaryPlasticity::Answer> answers;
      OfBonds                                 stretches;
    } mutable trial;

    StepWork accepted;

    struct
    {
      bool                                    any = false;
      mutable Vector                          changes;
      std::vector<OrdinaryPlasticity::Answer> answers;
      OfBonds                                 elastic; // s_e of both ends
    } tangent;
  };
} // namespace PeriDeal
