// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/elasticity.h>
#include <perideal/operators/solid/zone_bonds.h>

#include <vector>

namespace PeriDeal
{
  /**
   * The state-based families of a blending, by their energies
   *
   *   E_i = k_i/2 sum_j W_ij c_ij^2/x^2 + a_i/2 (sum_j W_ij c_ij)^2,   k_i = beta_i b/q_i,
   *   c_ij = xi . (u_j - u_i) - s x^2,   a_i = beta_i c d/(V_i q_i^2),
   *
   * the symbols as in StateOperator, beta the weight of peridynamics (WeightedCoupling): where it
   * is 1, the same forces, and the same critical stretch. Broken bonds are left out of the sums,
   * while q_i stays that of the body before, with what its cracks have left. Bonds of a node are
   * those with a family of which at least one end has a weight.
   *
   * An application takes two passes over the rows, the dilatations first.
   */
  template <int dim>
  class FamilyBonds : public ZoneBonds<dim>
  {
  public:
    using typename ZoneBonds<dim>::Bond;

    /** Both have to outlive this object. */
    FamilyBonds(Coupling<dim> &coupling, const BodyParameters<dim> &body);

    std::vector<double> critical_stretches(const BodyParameters<dim> &body) const override;
    void                set_rows(const std::vector<unsigned int> &of_nodes,
                                 const CrackSideFactors          &factors) override;

    /** Owned nodes within the reach of a family. */
    std::vector<unsigned int> rows_at(const std::vector<unsigned int> &ends) const override;

    void                   add_forces_of(const std::vector<unsigned int> &of_nodes,
                                         const double                     multiple,
                                         Vector                          &y,
                                         const Vector                    &u) const override;
    dealii::Tensor<1, dim> diagonal_of(const unsigned int node) const override;
    void                   add_row_sums(std::vector<double> &sums) const override;

    /** Of the families of these nodes. */
    double      energy(const Vector                    &u,
                       const std::vector<unsigned int> &of_nodes,
                       const std::vector<double>       &thermal) const override;
    double      add_thermal(Vector                          &loads,
                            const std::vector<unsigned int> &of_nodes,
                            const std::vector<double>       &thermal,
                            const double                     multiple) const override;
    std::size_t memory_consumption() const override;

  private:
    double spring(const unsigned int node, const Bond &bond) const override
    {
      return bond.strength *
             (stiffness.local_element(node) + stiffness.local_element(bond.neighbor)) /
             this->vectors[bond.vector].norm_square();
    }

    /** c_ij. @param u null: at rest @param thermal null: without thermal strains */
    double change(const unsigned int node,
                  const Bond        &bond,
                  const double      *u,
                  const double      *thermal) const
    {
      const dealii::Tensor<1, dim> &xi  = this->vectors[bond.vector];
      double                        sum = 0.;
      for (unsigned int d = 0; d < dim && u != nullptr; ++d)
        sum += xi[d] * (u[dim * bond.neighbor + d] - u[dim * node + d]);
      return thermal == nullptr ?
               sum :
               sum - 0.5 * (thermal[node] + thermal[bond.neighbor]) * xi.norm_square();
    }

    StateLaw law_of(const unsigned int node) const;
    void     set_row_of(const unsigned int node);
    void     find_tensions(const double *u, const double *thermal) const;
    void     add_forces_of(const std::vector<unsigned int> &of_nodes,
                           const double                     multiple,
                           Vector                          &y,
                           const double                    *u,
                           const double                    *thermal) const;

    double energy(const double                    *u,
                  const std::vector<unsigned int> &of_nodes,
                  const double                    *thermal) const;

    const BodyParameters<dim> &body;
    const BreakableZone<dim>  &zone;
    Vector                     stiffness, dilatation; // k, a; ghosts up to date
    mutable Vector             tensions;              // a_i sum_j W_ij c_ij
    // Memory of set_row_of().
    std::vector<typename Families<dim>::Member>     family;
    std::vector<typename DiffusionBonds<dim>::Bond> list;
  };
} // namespace PeriDeal
