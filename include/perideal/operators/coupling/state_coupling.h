// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/fictitious_extension.h>
#include <perideal/laws/elasticity.h>
#include <perideal/operators/coupling/family_zone.h>
#include <perideal/operators/coupling/node_families.h>
#include <perideal/operators/coupling/weighted_coupling.h>
#include <perideal/scene/body_parameters.h>

#include <optional>
#include <vector>

namespace PeriDeal
{
  /**
   * Splice and blending of state-based peridynamics with finite elements. The strain energy of the
   * family of node i is u . K_i u/2 with
   *
   *   K_i = c d/(V_i q_i^2) g_i g_i^T + b/q_i sum_j W_ij M_ij M_ij^T,
   *   g_i . u = sum_j W_ij xi . (u_j - u_i),   M_ij . u = xi/x . (u_j - u_i),
   *
   * the symbols as in StateOperator (d, c, b the factors of StateLaw); the sum of all K_i is its K.
   * Families are cut off at the surface of the body; with `Surface correction = fictitious nodes`
   * they are completed beyond flat sides by nodes whose displacement follows from those inside
   * (FictitiousExtension), in K_i only, since what is beyond has no energy. So K stays symmetric
   * and positive semidefinite, and away from holes and cracks a uniform strain has its energy at
   * each node; its forces are those of the stress on the sides, but for one horizon from edges and
   * corners. q_i is summed over the bonds that are left by cracks.
   *
   * Where bonds break, FamilyBonds has the families, beside the matrix, and q_i is of the body
   * before; what is visited here knows nothing of broken bonds.
   *
   * With correspondence (`Model`) K_i is that of NodalFamily, of families that end at the surface.
   *
   * In one dimension there is no dilatation, and the bonds of a family are visited one by one, so
   * that rows reach one horizon and not two.
   *
   * With blending, since no K_i strains a rigid motion, forces and moments balance. With splice
   * linear fields are exact where the zone with its overlap stays more than two horizons clear of
   * the surface.
   */
  template <int dim>
  class StateCoupling : public WeightedCoupling<dim>, public NodeFamilies<dim>
  {
  public:
    using typename Coupling<dim>::Bond;
    using typename Coupling<dim>::Cell;
    using typename NodeFamilies<dim>::Family;
    using typename NodeFamilies<dim>::ThermalStrain;

    /** As WeightedCoupling; with correspondence the body has to outlive this object. */
    StateCoupling(Nodes<dim>                &nodes,
                  const BodyParameters<dim> &body,
                  const Zone<dim>           &zone,
                  const CouplingScheme       scheme);

    BreakableZone<dim> *breakable() override
    {
      return breaks ? &*breaks : nullptr;
    }

    bool parts_cell(const Cell &cell) const override
    {
      return breaks && breaks->parts(cell);
    }

    const NodeFamilies<dim> *node_families() const override
    {
      return this;
    }
    void        bonds_of(const unsigned int node, std::vector<Bond> &bonds) const override; // none
    void        possible_neighbors_of(const unsigned int         node,
                                      std::vector<unsigned int> &neighbors) const override; // none
    void        visit_family(const unsigned int                         node,
                             const bool                                 intact,
                             const ThermalStrain                       &strain,
                             const std::function<void(const Family &)> &visit) const override;
    void        visit_nodes_of_family(const unsigned int                         node,
                                      const std::function<void(const Family &)> &visit) const override;
    std::string fault_of(const unsigned int node) const override;
    double      share_of(const unsigned int node) const override
    {
      return this->weighting.of_family(weights_now[node]);
    }

    double share_of(const Cell &cell) const override
    {
      return this->weighting.of_cell(weights_now.mean(cell));
    }

    std::vector<dealii::types::boundary_id> mirrors() const override
    {
      return symmetry_sides;
    }

  private:
    std::size_t memory_of_bonds() const override;

    using WeightedCoupling<dim>::own_families;
    using WeightedCoupling<dim>::weights_now;
    using WeightedCoupling<dim>::weights_at_end;

    struct Part
    {
      unsigned int           place = 0; // of a node in its family's list
      dealii::Tensor<1, dim> moment;    // factor of its displacement
    };

    /** W x e = sum of the parts' moments times displacements, less thermal strain. */
    struct BondOfFamily
    {
      std::vector<Part> parts;          // of a real bond -W xi and W xi
      double            square, strain; // W x^2, and the thermal strain
      double            count;          // as Family::n_bonds counts it
    };

    void find_nodes_that_act();

    /** The bonds of an owned node whose family has a weight. */
    bool find_family(const NodeWeights<dim>    &weights,
                     const unsigned int         node,
                     const bool                 intact,
                     const ThermalStrain       &strain,
                     std::vector<unsigned int> &nodes,
                     std::vector<BondOfFamily> &list) const;

    /** Of the first of the nodes. */
    void add_neighbors(const bool                 intact,
                       const ThermalStrain       &strain,
                       std::vector<unsigned int> &nodes,
                       std::vector<BondOfFamily> &list) const;
    void add_fictitious(const ThermalStrain       &strain,
                        std::vector<unsigned int> &nodes,
                        std::vector<BondOfFamily> &list) const;

    typename Lattice<dim>::Index site_of(const unsigned int node) const;
    static void                  set_size(Family &family);
    void                         find_rows(const NodeWeights<dim> &weights, Family &family) const;

    /** Add the energy factor/2 (sum of moments times displacements - thermal)^2. */
    static void add_square(const std::vector<Part> &parts,
                           const double             factor,
                           const double             thermal,
                           Family                  &family);
    static void add_bond(const BondOfFamily &bond, const double factor, Family &family);
    static void add_dilatation(const std::vector<BondOfFamily> &list,
                               const double                     factor,
                               Family                          &family);
    /** Of a node of correspondence, whose family has only real bonds. */
    void add_nodal(const std::vector<BondOfFamily> &list,
                   const ThermalStrain             &strain,
                   Family                          &family) const;
    void scale_rows(Family &family) const;

    std::optional<FictitiousExtension<dim>> extension;
    std::optional<FamilyZone<dim>>          breaks;         // none: no bonds break
    std::vector<dealii::types::boundary_id> symmetry_sides; // with an extension
    std::vector<bool>                acts;  // of owned nodes: the family ever reaches the zone
    std::vector<StateLaw>            laws;  // of owned nodes that act
    const BodyParameters<dim> *const nodal; // with correspondence; else null
  };

} // namespace PeriDeal
