// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/diverged.h>
#include <perideal/laws/j2_plasticity.h>
#include <perideal/operators/solid/bond_table.h>
#include <perideal/operators/solid/family_forces.h>
#include <perideal/operators/solid/nodal_tensors.h>
#include <perideal/operators/solid/step_work.h>
#include <perideal/operators/solid/stress_steps.h>
#include <perideal/operators/solid/thermal_strains.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  struct Span;


  /**
   * State-based correspondence (Silling et al. 2007): nodes have a displacement gradient, of which
   * a law of stresses makes the forces of their bonds. With W = V_i V_j omega f of the bonds xi of
   * node i, du = u_j - u_i,
   *
   *   M_i = sum W xi xi^T,  G_i = (sum W du xi^T) M_i^-1,  sigma_i of the strain sym G_i,
   *
   * a uniform strain is exact whatever the family. What the gradient does not tell of the family,
   * z = du - G_i xi, stores (c_i/2) sum W |z|^2 (Wan et al. 2019): c_i = d (d + 2) mu/q_i is what
   * the ordinary solid of a full family stores of it, q_i = tr M_i/V_i, and mu the shear modulus,
   * of bodies with other ones Reuss's mean over all directions, the softer one. A bond pulls at i
   * by
   *
   *   W [(P_i + P_j) xi + (c_i + c_j) du - (c_i G_i + c_j G_j) xi],  P_i = V_i sigma_i M_i^-1,
   *
   * the slope of the energy; of one to a fictitious node the end i alone counts.
   *
   * J2 plasticity knows what is stored beside (J2Plasticity::Beside): else a body that flows would
   * bear more and more by its z. B = 3 mu c_i/V_i sum W |z_e|^2, of z_e = z - z_p, flow leaves r
   * z_e, and z_p, which each end of a bond has its own of, grows by (1 - r) z_e. Both stand in the
   * rows of both ends, that of the row's own node first, both along the row's own bond.
   *
   * With full kinematics the law is one of large deformations (StressLaw), and P = F S stands for
   * sigma, F = 1 + G. Then z = (xi + du) - F xi is what the deformed bonds have beside F; no
   * rotation changes |z|. Where a node is inside out, all that is collective throws Diverged
   * (`inversion`).
   */
  template <int dim>
  class Correspondence : public FamilyForces<dim>
  {
  public:
    static constexpr unsigned int n_history = 2 * dim; // of a bond of a body that flows

    /**
     * All have to outlive this object; rows are neither packed nor left out, q is final. Throws
     * UserError: a yield stress that is not positive, what a law of the user throws; all that is
     * collective throws that (StressSteps). Collective.
     */
    Correspondence(const Families<dim>       &families,
                   const BondEnds<dim>       &ends,
                   BondTable<dim>            &bonds,
                   const NodeLaws<dim>       &laws,
                   const ThermalStrains      &thermal,
                   const BodyParameters<dim> &body);

    bool is_linear() const override
    {
      return law.is_linear;
    }

    void   multiply(Vector &y, const Vector &x) const override;
    void   find_forces(Vector &y, const Vector &u, const double t) const override;
    double energy(const Vector &u) const override;
    double accept(const Vector &u, const double t) override;
    void   exchange(Archive &archive, const NodeKeys &keys) override;
    void   linearize(const Vector &u) override;
    void   forget_tangent() override
    {
      tangent.any = tangent.any && law.is_full; // a deformed body may be stiffer
    }

    /** Of these owned nodes alone. Collective. */
    double energy_of(const std::vector<unsigned int> &nodes, const Vector &u) const;

    /** As YieldingFamilies::plastic_work(). Collective. */
    double plastic_work(const Vector &u) const;

    /**
     * Stresses of the law and strains sym G of the owned nodes, with full kinematics Cauchy's
     * stresses and the strains of Green and Lagrange. Collective.
     */
    NodalTensors<dim> tensors(const Vector &u) const;

    /** mu of an owned node. */
    double shear(const unsigned int i) const
    {
      return shapes[i].shear;
    }

    /** In two dimensions, the stress of an owned node out of the plane, at the last tensors(). */
    double out_of_plane(const unsigned int i) const;

    /** What StressLaw::shown() names, of the owned nodes at the last accepted step. */
    std::vector<std::pair<std::string, std::vector<double>>> shown() const;

    /** Bonds of these owned nodes bear nothing any more, or q has changed. Not collective. */
    void renew(const std::vector<unsigned int> &nodes);

    /** The diagonal of the elastic K without conditions. Collective. */
    void find_diagonal(Vector &diagonal) const;

    /**
     * By node, no less than the sums of the rows of the elastic K, as one of numbers: what G does
     * is no stiffer than bonds that are kappa W stiff in all directions, kappa = max(c, lambda V
     * |M^-1|) with the largest eigenvalue lambda of the stiffness, with full kinematics |F|^2 times
     * that and |S| of the last linearize(). Collective.
     */
    Vector row_sums() const;

    std::size_t memory_consumption() const override;

  private:
    using Full = dealii::SymmetricTensor<2, dim>;

    /** What of a node its bonds and moduli tell. */
    struct Shape
    {
      Full                            inverse; // M^-1
      dealii::SymmetricTensor<4, dim> elastic;
      double                          shear = 0., stabilizer = 0.; // mu, c
    };

    /** Numbers of each bond, in the order of rows. */
    template <typename Number>
    struct OfBonds
    {
      const std::vector<Number> &of(const bool is_beyond) const
      {
        return is_beyond ? beyond : body;
      }

      void resize(const BondTable<dim> &bonds)
      {
        body.resize(bonds.body.size());
        beyond.resize(bonds.beyond.size());
      }

      std::vector<Number> body, beyond;
    };

    using Changes = OfBonds<dealii::Tensor<1, dim>>;

    /** What the other ends of bonds have to know of a node: places of numbers. */
    enum Place : unsigned int
    {
      at_force     = 0,                  // P - c r G
      at_stiffness = dim * dim,          // c r
      n_numbers,                         // that is all where nothing flows
      at_slopes = n_numbers,             // G; in the tangent: c times the change of r
      at_lost   = at_slopes + dim * dim, // 1 - r
      n_of_flow
    };

    void find(const Vector &u) const;
    void find_changes(const Vector &x) const; // in the tangent; ghosts are up to date
    bool knows(const Vector &u) const;
    void remember();

    /** What an owned node makes of displacements, whose ghosts and images are up to date. */
    void find_at(const double      *u,
                 const unsigned int i,
                 const Span        &inside,
                 const Span        &outside) const;

    /** What the law says at an owned node. */
    void ask(const unsigned int               i,
             const double                     beside,
             dealii::SymmetricTensor<4, dim> *of_tangent,
             typename J2Plasticity::Beside   &flow) const;

    const Families<dim>  &families;
    const BondEnds<dim>  &ends;
    BondTable<dim>       &bonds;
    const NodeLaws<dim>  &laws;
    const ThermalStrains &thermal;

    struct
    {
      std::unique_ptr<const StressLaw> law;
      const J2Plasticity              *j2        = nullptr; // if it is that
      bool                             is_linear = false, is_full = false;
      std::vector<double>              parameters, states;
    } law;

    std::vector<Shape> shapes;  // of owned nodes
    OfBonds<double>    weights; // W

    struct
    {
      bool                                known = false, has_forces = false;
      Vector                              displacement, forces, numbers;
      std::vector<StressLaw::Response>    responses;
      std::vector<dealii::Tensor<2, dim>> slopes;
      std::vector<double>                 squares, ratios, states; // sum of W |z_e|^2; next
      Changes                             changes;                 // du, where the law flows
      Trip                                inverted;                // the worst one
    } mutable trial;

    StepWork    accepted;
    StressSteps steps;

    /** Of a node that flows. */
    struct Flow
    {
      dealii::SymmetricTensor<4, dim> stiffness;
      Full                            stress_slope;
      double                          ratio = 1., ratio_slope = 0.;

      // With full kinematics.
      dealii::Tensor<2, dim> deformation; // F
      Full                   stress;      // S
    };

    struct
    {
      bool              any = false;
      mutable Vector    changes;
      std::vector<Flow> flows;
      Changes           own, far; // z_e of both ends
    } tangent;
  };
} // namespace PeriDeal
