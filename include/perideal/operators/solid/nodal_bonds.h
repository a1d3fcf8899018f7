// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/family_bonds.h>

#include <vector>

namespace PeriDeal
{
  /**
   * The families of correspondence of a blending whose bonds may break, of the linear law with two
   * moduli. With the symbols of Correspondence and the thermal strain s of a node, a family stores
   * its share beta_i (WeightedCoupling) of
   *
   *   V/2 (eps - s I) : C : (eps - s I) + c/2 sum W |z|^2,
   *
   * with the sums over unbroken bonds, and c of the body before. Nodes that hold nothing any more
   * bear nothing (bonds_hold()). The diagonal is that of the ordinary solid.
   */
  template <int dim>
  class NodalBonds : public FamilyBonds<dim>
  {
  public:
    /** Both have to outlive this object. */
    NodalBonds(Coupling<dim> &coupling, const BodyParameters<dim> &body);

    void set_rows(const std::vector<unsigned int> &of_nodes,
                  const CrackSideFactors          &factors) override;
    void add_row_sums(std::vector<double> &sums) const override;

  protected:
    void   add_forces_of(const std::vector<unsigned int> &of_nodes,
                         const double                     multiple,
                         Vector                          &y,
                         const double                    *u,
                         const double                    *thermal,
                         const bool                       of_tangent = false) const override;
    double energy(const double                    *u,
                  const std::vector<unsigned int> &of_nodes,
                  const double                    *thermal,
                  const bool                       dissipated = false) const override;

  private:
    using Bond = typename ZoneBonds<dim>::Bond;

    /** Of an owned node. */
    struct Node
    {
      double lambda = 0., shear = 0., volume = 0.;
      double share = 0., stabilizer = 0., weight = 0.; // beta, c, q V
    };

    /** What it makes of displacements. */
    struct State
    {
      dealii::SymmetricTensor<2, dim> inverse, strain, stress; // M^-1
      dealii::Tensor<2, dim>          slopes;                  // G
      double                          stabilizer = 0.;
    };

    /** @param u, thermal may be null: at rest, without thermal strain */
    State state_of(const unsigned int i, const double *u, const double *thermal) const;

    static dealii::Tensor<1, dim> change(const double      *u,
                                         const unsigned int i,
                                         const unsigned int j);

    std::vector<Node> nodes_of_zone;
    mutable Vector    numbers; // of nodes: beta (V sigma M^-1 - c G) row by row, beta c
  };
} // namespace PeriDeal
