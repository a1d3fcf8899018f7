// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/coupling/coupling.h>
#include <perideal/operators/coupling/node_families.h>
#include <perideal/operators/parts/crack_side_factors.h>
#include <perideal/operators/solid/crack_contact.h>
#include <perideal/operators/solid/nodal_zone.h>

#include <memory>
#include <vector>

namespace dealii::TrilinosWrappers
{
  class SparseMatrix;
  class SparsityPattern;
} // namespace dealii::TrilinosWrappers

namespace PeriDeal
{
  /**
   * What the bonds and families of a coupling add to the finite elements of a solid, its unknowns
   * interleaved. Broken bonds add nothing; others are multiplied by the mean of the crack-side
   * factors of both ends. Thermal strains of bonds are the means of both ends.
   *
   * Matrices and vectors are compressed by the caller. Not collective unless stated.
   */
  template <int dim>
  class SolidBondsBesideElements
  {
  public:
    using ThermalStrain = typename NodeFamilies<dim>::ThermalStrain;

    /** Throws UserError for a body that cannot have them. Not collective. */
    static void require(const BodyParameters<dim> &body);

    /** The body has to outlive this object. Collective. Throws UserError (NodalZone). */
    SolidBondsBesideElements(std::unique_ptr<Coupling<dim>> coupling,
                             const BodyParameters<dim>     &body);

    const Coupling<dim> &coupling() const
    {
      return *coupled;
    }

    Coupling<dim> &coupling()
    {
      return *coupled;
    }

    /** Null, or the families, of which no matrix knows then. */
    NodalZone<dim> *nodal() const
    {
      return own_nodal.get();
    }

    const Nodes<dim> &nodes() const
    {
      return coupled->families().nodes();
    }

    /** NodeFamilies::mirrors(), if the coupling has families. */
    std::vector<dealii::types::boundary_id> mirrors() const
    {
      return coupled->node_families() != nullptr ? coupled->node_families()->mirrors() :
                                                   std::vector<dealii::types::boundary_id>();
    }

    /**
     * Turn the matrix of an intact cell into what the coupling leaves of it. Returns whether
     * anything has changed.
     */
    bool leave_remainder(const typename Coupling<dim>::Cell &cell,
                         dealii::FullMatrix<double>         &stiffness) const
    {
      const bool changed = coupled->change_cell(cell, stiffness);
      return coupled->finish_cell(cell, stiffness) || changed;
    }

    /** How far bonds and families reach. */
    double reach() const
    {
      return coupled->families().weights().reach();
    }

    /** Owned nodes whose bonds or families may change with what is in boxes, ascending. */
    std::vector<unsigned int> nodes_near(const std::vector<dealii::BoundingBox<dim>> &boxes) const
    {
      return coupled->families().neighbors().nodes_near(boxes, reach());
    }

    /** @param ever of all nodes that may join the zone, else of those in it */
    void add_pattern(dealii::TrilinosWrappers::SparsityPattern &pattern, const bool ever) const;

    /**
     * Add to K. Returns the number of this process's unbroken bonds, those with other processes
     * counted half.
     * @param factors null: as if no crack were there
     */
    double add_to(dealii::TrilinosWrappers::SparseMatrix &matrix,
                  const CrackSideFactors                 *factors) const;

    /**
     * Add a multiple of what these owned nodes, each once, have of that: the rows of their pairs,
     * and their families. Returns that multiple of the number.
     */
    double add_to(dealii::TrilinosWrappers::SparseMatrix &matrix,
                  const CrackSideFactors                 &factors,
                  const std::vector<unsigned int>        &of_nodes,
                  const double                            multiple) const;

    /**
     * Add the loads that hold a body with thermal strains at rest. Returns this process's energy
     * of a body that is held everywhere.
     */
    double add_thermal(Vector                 &loads,
                       const CrackSideFactors &factors,
                       const ThermalStrain    &strain) const;

    /** Across the bonds that are broken or cut; this has to outlive it. Layout as there. */
    std::unique_ptr<CrackContact<dim>> make_contact(
      const typename CrackContact<dim>::Layout &layout) const;

    /** Mark owned nodes with broken bonds, and add what the others give to the trace. */
    void add_to(CrackSideFactors::Sums &sums) const;

  private:
    using Bond   = typename Coupling<dim>::Bond;
    using Family = typename NodeFamilies<dim>::Family;

    /** Memory of the functions that add. */
    struct Rows
    {
      std::vector<Bond>                            bonds;
      std::vector<dealii::types::global_dof_index> columns;
      std::vector<double>                          values[dim];
    };

    /** @param factors null: as if no crack were there. Returns the number as add_to() does. */
    double add_bonds(dealii::TrilinosWrappers::SparseMatrix &matrix,
                     const CrackSideFactors                 *factors,
                     const unsigned int                      node,
                     const double                            multiple,
                     Rows                                   &rows) const;
    double add_family(dealii::TrilinosWrappers::SparseMatrix &matrix,
                      const bool                              intact,
                      const unsigned int                      node,
                      const double                            multiple,
                      Rows                                   &rows) const;
    /** CrackContact::FamilyOf. */
    double contact_family(const unsigned int node, std::vector<FacingBond<dim>> &list) const;
    /** xi xi^T, of which a bond's weight is the factor. */
    dealii::Tensor<2, dim> block_of(const unsigned int node, const Bond &bond) const;
    void                   unknowns_of(const Family                                 &family,
                                       std::vector<dealii::types::global_dof_index> &indices) const;

    std::unique_ptr<Coupling<dim>>  coupled;
    std::unique_ptr<NodalZone<dim>> own_nodal;
  };
} // namespace PeriDeal
