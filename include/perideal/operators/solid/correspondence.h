// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/family_forces.h>
#include <perideal/operators/solid/nodal_tensors.h>
#include <perideal/operators/solid/node_shapes.h>
#include <perideal/operators/solid/node_stresses.h>
#include <perideal/operators/solid/step_work.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  struct Span;

  template <int dim>
  class GradientLattice;

  template <int dim>
  class LatticeHistories;


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
   * Nodes that store no bonds (BondTable) have their sums from convolutions (GradientLattice), and
   * the z_p of those that have flowed in LatticeHistories. Of others B is bounded first, from
   * sum W |z|^2 = sum W |du|^2 - G : sum W du xi^T, and found bond by bond only where the bound
   * might let them flow. The energy of the body needs no B of them: what z stores is half of the
   * work of its forces, so that with F.u all of it follows from stresses.
   *
   * Beside finite elements a node counts by its share (Shape::share) of energy and forces.
   *
   * With full kinematics the law is one of large deformations (StressLaw), and P = F S stands for
   * sigma, F = 1 + G. Then z = (xi + du) - F xi is what the deformed bonds have beside F; no
   * rotation changes |z|. Where a node is inside out, all that is collective throws Diverged
   * (`inversion`). Such bodies store all bonds.
   */
  template <int dim>
  class Correspondence : public FamilyForces<dim>
  {
  public:
    static constexpr unsigned int n_history = 2 * dim; // of a bond of a body that flows

    /**
     * All have to outlive this object; rows are not packed, q is final. Throws UserError: a yield
     * stress that is not positive, what a law of the user throws; all that is collective throws
     * that (StressSteps). Collective.
     */
    Correspondence(const Families<dim>       &families,
                   const BondEnds<dim>       &ends,
                   BondTable<dim>            &bonds,
                   const NodeLaws<dim>       &laws,
                   const BodyParameters<dim> &body);
    ~Correspondence() override;

    bool is_linear() const override
    {
      return stresses.is_linear();
    }

    void   multiply(Vector &y, const Vector &x) const override;
    void   find_forces(Vector &y, const Vector &u, const double t) const override;
    void   take_temperatures(const Vector &changes) override;
    double energy(const Vector &u) const override;
    double accept(const Vector &u, const double t) override;
    void   exchange(Archive &archive, const NodeKeys &keys) override;
    void   linearize(const Vector &u) override;
    void   forget_tangent() override
    {
      tangent.any = false;
    }

    /** Of these owned nodes alone; or what shear stores in them. Collective. */
    double energy_of(const std::vector<unsigned int> &nodes,
                     const Vector                    &u,
                     const bool                       of_shear = false) const;

    /**
     * What the shear modulus and the bulk modulus do of multiply(), z with shear. The law is
     * linear, in three dimensions or in plane strain, with two moduli. Collective.
     */
    void multiply_apart(Vector &of_shear, Vector &of_bulk, const Vector &x) const;

    /**
     * Stresses of the law and strains sym G of the owned nodes, with full kinematics Cauchy's
     * stresses and the strains of Green and Lagrange. Collective.
     */
    NodalTensors<dim> tensors(const Vector &u) const;

    /** Bonds of these owned nodes bear nothing any more, or q has changed. Not collective. */
    void renew(const std::vector<unsigned int> &nodes);

    std::size_t memory_consumption() const override;

    NodeShapes<dim>   shapes;
    NodeStresses<dim> stresses; // what has been said last is of the last tensors(), or forces

  private:
    using Changes = OfBonds<dim, dealii::Tensor<1, dim>>;

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
    void find_changes(const Vector &x) const;           // in the tangent; ghosts are up to date
    void sum_changes(Vector &y, const Vector &x) const; // the same, of the last find_changes()
    void remember(const Vector &u);
    void keep_elastic(const Vector &u);

    /** What is stored at u, whose forces, if there is a lattice, are -F; of this process. */
    double stored(const Vector &u, const Vector &minus_F) const;

    /** What nodes that store no bonds make of u; its ghosts and images are up to date. */
    void find_on_lattice(const double *u) const;

    /** What a node makes of its gradient and of sums of W |z_e|^2 and of W z_e . du. */
    void settle(const unsigned int i, const double squares, const double products) const;

    /** What it makes of the change of its gradient, in the tangent, and of a sum of W z_e . du. */
    void settle_change(const unsigned int            i,
                       const dealii::Tensor<2, dim> &slopes,
                       const double                  products) const;

    const Families<dim> &families;
    const BondEnds<dim> &ends;
    BondTable<dim>      &bonds;
    struct
    {
      std::unique_ptr<GradientLattice<dim>>  sums; // or none
      std::unique_ptr<LatticeHistories<dim>> histories;
    } lattice;

    struct
    {
      bool                                known = false, has_forces = false;
      Vector                              displacement, forces, numbers;
      std::vector<dealii::Tensor<2, dim>> slopes;
      std::vector<double> squares, products, ratios; // sums of W |z_e|^2, W z_e . du; r
      std::vector<std::pair<unsigned int, dealii::Tensor<1, dim>>> pulls; // sums of W z_p
    } mutable trial;

    StepWork accepted;

    /** What counts of the elastic body in the tangent. */
    struct
    {
      double shear = 1., bulk = 1.;
    } mutable counted;

    /** Of a node that flows. */
    struct Flow
    {
      dealii::SymmetricTensor<4, dim> stiffness;
      dealii::SymmetricTensor<2, dim> stress_slope;
      double                          ratio = 1., ratio_slope = 0.;
    };

    struct
    {
      bool              any = false;
      mutable Vector    changes;
      std::vector<Flow> flows;
      Changes           own, far; // z_e of both ends
      // On the lattice: sums of W z_e . du; of W z_e, where it flows.
      mutable std::vector<double>                                  products;
      std::vector<std::pair<unsigned int, dealii::Tensor<1, dim>>> pulls;
    } tangent;
  };
} // namespace PeriDeal
