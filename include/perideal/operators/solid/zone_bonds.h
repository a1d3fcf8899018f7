// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/coupling/coupling.h>
#include <perideal/operators/coupling/lattice_bonds.h>
#include <perideal/operators/parts/crack_side_factors.h>

#include <utility>
#include <vector>

namespace dealii::TrilinosWrappers
{
  class SparseMatrix;
}

namespace PeriDeal
{
  /**
   * The active bonds of an exchange in a solid as a list beside the matrix of the elements, so that
   * bonds appear and break at a cost that goes with their number:
   *
   *   K u = sum over bonds of W xi (xi . (u_i - u_j)).
   *
   * Each owned node of the zone has a row of its bonds, in the order of their offsets; bonds of
   * two processes stand in rows of both. Not collective.
   */
  template <int dim>
  class ZoneBonds
  {
  public:
    struct Bond
    {
      unsigned int neighbor; // local number
      unsigned int vector;   // number of xi
      double       strength; // W, times the factors beside cracks; 0: broken, or cut by a crack
    };

    /** Both have to outlive this object, which has no bonds yet. */
    ZoneBonds(const Coupling<dim> &coupling, const LatticeBonds<dim> &bonds);

    /** Take the rows of some owned nodes anew, each once, as the coupling has them now. */
    void set_rows(const std::vector<unsigned int> &of_nodes, const CrackSideFactors &factors);

    /** The bond between an owned node and another one bears nothing any more. */
    void release(const unsigned int node, const unsigned int neighbor);

    /** Add K u to the owned unknowns of y; ghosts of u are up to date. */
    void add_forces(Vector &y, const Vector &u) const;

    /** Add a multiple of K u in the rows of some nodes; ghosts as above. */
    void add_forces_of(const std::vector<unsigned int> &of_nodes,
                       const double                     multiple,
                       Vector                          &y,
                       const Vector                    &u) const;

    /** Add the diagonal of K to a vector of unknowns. */
    void add_diagonal(Vector &diagonal) const;

    /** Add the sums over the absolute values of rows of K. */
    void add_row_sums(std::vector<double> &sums) const;

    /** Add to a matrix what whole bonds between vertices of a cell have of K. Not compressed. */
    void add_between_vertices(dealii::TrilinosWrappers::SparseMatrix &matrix) const;

    /** The energy of the bonds in rows of these nodes, half of it for each end; ghosts as above. */
    double energy(const Vector                    &u,
                  const std::vector<unsigned int> &of_nodes,
                  const std::vector<double>       &thermal) const;

    /**
     * Add the loads of thermal strains at nodes, means of both ends, in the rows of these nodes.
     * Returns the energy of a body that is held everywhere.
     */
    double add_thermal(Vector                          &loads,
                       const std::vector<unsigned int> &of_nodes,
                       const std::vector<double>       &thermal,
                       const double                     multiple) const;

    /** Owned nodes with a row. */
    const std::vector<unsigned int> &nodes() const
    {
      return with_rows;
    }

    /** Call visit(bond, xi) for the bonds in the row of an owned node, those at rest included. */
    template <typename Visit>
    void for_each(const unsigned int node, const Visit &visit) const
    {
      const Row &row = rows[node];
      for (std::size_t k = row.first; k < row.first + row.n; ++k)
        visit(bonds[k], vectors[bonds[k].vector]);
    }

    /** A bond starts at the first of its nodes in this row. */
    bool starts(const Bond &bond) const
    {
      return bond.vector > vectors.size() / 2;
    }

    /** Of this process: each whole bond is counted half in a row. */
    double n_whole() const;

    std::size_t memory_consumption() const;

  private:
    struct Row
    {
      std::size_t  first = 0; // among all bonds
      unsigned int n     = 0;
    };

    unsigned int vector_between(const unsigned int node, const unsigned int neighbor) const;
    void         pack();

    const Coupling<dim>                &coupling;
    const LatticeBonds<dim>            &of_lattice;
    typename LatticeBonds<dim>::Site    reach; // offsets in each direction
    std::vector<dealii::Tensor<1, dim>> vectors;
    std::vector<bool>                   is_between_vertices; // by number of the vector
    std::vector<Bond>                   bonds;
    std::vector<Row>                    rows;       // of owned nodes
    std::vector<unsigned int>           with_rows;  // ascending
    std::size_t                         unused = 0; // of the bonds, in rows that were taken anew
  };
} // namespace PeriDeal
