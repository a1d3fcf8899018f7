// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/mesh/cell_corners.h>
#include <perideal/operators/solid/bond_breaking.h>
#include <perideal/operators/solid/short_range_contact.h>
#include <perideal/operators/solid/solid_operator.h>
#include <perideal/operators/solid/solid_tensors.h>
#include <perideal/scene/rules.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * Linear peridynamic solid (Silling 2007; in 2D Le 2014 section 2 in the corrected form of
   * doc/elasticity.md), and the bond-based solid as the same without dilatation. With xi the bond,
   * x its length, M = xi/x, the extension e = M . (u_j - u_i) - s x, s the mean thermal strain of
   * both ends, and W_ij = V_i V_j omega f (f the volume fraction) over unbroken bonds:
   *
   *   q_i = sum_j W_ij x^2 / V_i,  theta_i = d sum_j W_ij x e_ij / (V_i q_i)
   *   F_i = sum_j W_ij [ (c_i theta_i/q_i + c_j theta_j/q_j) x + (b_i/q_i + b_j/q_j) e_ij ] M
   *
   * with d, c, b the factors dilatation, volumetric and extension of StateLaw. The prefactor of
   * omega drops out. `Surface correction` multiplies W by a bond's factor a in theta and in the
   * forces from it, by s in those of e, and changes q (surface_factors.h), or lets families go on
   * beyond the sides (BondTable). An application takes two passes over the bonds, the
   * dilatations first.
   *
   * With full kinematics Y = xi + u_j - u_i, e = |Y| - x - s x, and the force acts along Y/|Y|; a
   * rotation makes none (BondKinematics). q is that of the undeformed body. In motion what has no
   * bonds between it repels each other (ShortRangeContact).
   *
   * With another law than the linear one forces follow from extensions bond by bond, and K is the
   * tangent (BondKinematics, BondLaw); where the body yields, and with correspondence in place of
   * the formulas above, family by family (FamilyForces).
   *
   * Viscosity (Le 2014 eq 2.43) is K without the dilatations. Bonds are those of SolidBonds; which
   * break, BondBreaking decides.
   */
  template <int dim>
  class StateOperator : public SolidOperator<dim>
  {
  public:
    /** Throws UserError for a body that it cannot deform. Not collective. */
    static void require(const BodyParameters<dim> &body)
    {
      SolidOperator<dim>::require(body);
      SolidBonds<dim>::require(body);
      require_traction_layer(body);
      refuse_law(body, false, false);
    }

    /** Adds the halo to the nodes. Collective. Throws UserError, among others: isolated nodes. */
    StateOperator(Nodes<dim> &nodes, const BodyParameters<dim> &body);

    Spectrum spectrum() const override;
    bool     surrogate_is_exact() const override
    {
      return false;
    }

    OperatorSize size() const override;
    ForceBalance forces(const Vector &u, const double t) const override;
    double       energy(const Vector &u) const override;
    void         multiply(Vector &y, const Vector &x) const override;
    void         set_temperature_change(const Vector &nodal) override;
    void         damping_force(Vector &y, const Vector &v) const override;
    double       damping_bound() const override;
    bool         nonlinear() const override
    {
      return solid.kinematics.is_full() || solid.flows() ||
             (solid.law.any() && !solid.law->is_linear());
    }

    void accept(const Vector &u, const double t) override;

    void                mend_unbalanced(Vector &r, const Vector &u, const double t) const override;
    void                linearize(const Vector &u) override;
    double              largest_stretch(const Vector &u) const override;
    Inversion           inverted(const Vector &u) const override;
    const BreakHistory *break_history() const override
    {
      return breakage.history();
    }

    std::vector<NodePair> broken_since(std::size_t &n_known) const override
    {
      return breakage.broken_since(n_known);
    }

    unsigned long long break_bonds(const Vector &u, double t, double share = 0.) override;

    double stretch_over_critical(const Vector &u, const double t) override
    {
      return breakage.stretch_over_critical(u, t);
    }

    const dealii::Point<dim> &position(const unsigned int node) const override
    {
      return solid.families.nodes().position(node);
    }

    const SolidBonds<dim> &bonds() const
    {
      return solid;
    }

    const BondBreaking<dim> &breaking() const
    {
      return breakage;
    }

    /** See nodal_tensors(). Collective. */
    NodalTensors<dim> tensors(const Vector &u) const;

  protected:
    void assemble_surrogate(dealii::TrilinosWrappers::SparseMatrix &matrix) const override;
    void surrogate_made() const override
    {
      marks_of_surrogate = breakage.n_marks();
    }

    void exchange_bonds(Archive                     &archive,
                        const NodeKeys              &keys,
                        const std::function<void()> &at_surrogate) override;
    void apply_change(const ChangeSet<dim> &change, const bool loaded) override;
    void find_forces(Vector &y, const Vector &u, const double t) const override;
    void find_loads(Vector &loads, const double t) const override;
    void take_released(const double energy) override
    {
      breakage.add_released(energy);
    }

  private:
    using SolidOperator<dim>::body;
    using SolidOperator<dim>::conditions;
    using SolidOperator<dim>::contact;
    using SolidOperator<dim>::mass;
    using SolidOperator<dim>::stiffness_diagonal;
    using SolidOperator<dim>::thermal_loads;
    using SolidOperator<dim>::scratch;

    void find_conditions(const Nodes<dim> &nodes);
    void make_contact();
    void find_thermal_strains();
    void find_thermal_loads();

    /**
     * tau of the nodes that have just lost bonds, and what it has changed by, of owned nodes and
     * ghosts; returns where, in the order of all processes. Collective.
     */
    std::vector<unsigned int> renew_tensions(const Vector &u, Vector &change) const;

    /** Of mend_unbalanced(): loads are in scratch. */
    void mend_linear(Vector                          &r,
                     const Vector                    &u,
                     const std::vector<unsigned int> &changed,
                     const Vector                    &change) const;

    /** The same with full kinematics: the rows of these nodes and of their neighbours. */
    void sum_again(Vector &r, const Vector &u, const std::vector<unsigned int> &changed) const;

    /** What is found of all bonds, or of those of nodes that have lost some. */
    void follow_bonds(const std::vector<unsigned int> *of_nodes = nullptr);

    /** tau; the functions below leave ghosts of displacements as they are, up to date. */
    void find_tensions(const Vector &u, const bool strained) const;
    void sum_forces(Vector &y, const Vector &x, const bool with_dilatations) const;

    /** Gershgorin's largest, with the norms of the blocks, over the mass, times a factor. */
    double largest_row(const Vector &of_dilatations, const bool of_tangent, double factor) const;

    bool holds(const CellCorner<dim> &corner) const; // no bond of its node has broken

    SolidBonds<dim>                        solid;
    SolidLoads<dim>                        loads;
    BondBreaking<dim>                      breakage;
    mutable typename BondTable<dim>::Count marks_of_surrogate{};
    mutable Vector                         tau; // tau_i = c_i theta_i/q_i; 0 without dilatations
    mutable std::vector<CellCorner<dim>>   corners; // once they have been asked for
  };
} // namespace PeriDeal
