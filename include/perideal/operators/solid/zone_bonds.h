// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/linear_peridynamic_solid.h>
#include <perideal/operators/coupling/coupling.h>
#include <perideal/operators/parts/crack_side_factors.h>
#include <perideal/operators/solid/damage_criterion.h>
#include <perideal/operators/solid/nodal_law.h>

#include <array>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace dealii::TrilinosWrappers
{
  class SparseMatrix;
}

namespace PeriDeal
{
  /**
   * The bonds of a coupled solid on a lattice as a list beside the matrix of the elements, so that
   * the matrix stays where bonds appear and break. They are the linear peridynamic solid, by the
   * energies of nodes
   *
   *   E_i = k_i/2 sum_j W_ij c_ij^2/x^2 + a_i/2 (sum_j W_ij c_ij)^2,
   *   c_ij = xi . (u_j - u_i) - s x^2,
   *
   * with k and a of FamilyBonds (blending), or each bond by itself: k = x^2/2, a = 0 (PairBonds,
   * exchange); another law (NodalLaw) has c* in the place of c. An application takes two passes
   * over the rows, the dilatations first.
   *
   * Each owned node that bonds act on has a row of them, in the order of their offsets; bonds of
   * two processes stand in rows of both. Not collective unless stated.
   */
  template <int dim>
  class ZoneBonds
  {
  public:
    struct Bond
    {
      unsigned int neighbor; // local number
      unsigned int vector;   // number of xi
      double       strength; // W; 0: broken, or cut by a crack
    };

    virtual ~ZoneBonds() = default;

    /** BreakableBonds::crossing_energy. */
    virtual std::function<CrossingEnergy(unsigned int)> crossing_energies(
      const BodyParameters<dim> &body) const = 0;

    /**
     * Take the rows of some owned nodes anew, each once, as the coupling has them now, W times the
     * factors beside cracks. Collective.
     */
    virtual void set_rows(const std::vector<unsigned int> &of_nodes,
                          const CrackSideFactors          &factors) = 0;

    /**
     * The owned nodes whose forces change with bonds, ascending. @p ends are those of the bonds,
     * others included, ascending and each once.
     */
    virtual std::vector<unsigned int> rows_at(const std::vector<unsigned int> &ends) const = 0;

    /** The bond between an owned node and another one bears nothing any more. */
    void release(const unsigned int node, const unsigned int neighbor);

    /**
     * Add F(u) to the owned unknowns of y, or K u of the tangent at the last linearize(); ghosts of
     * u are up to date. Collective.
     */
    void add_forces(Vector &y, const Vector &u, const bool of_tangent = false) const
    {
      add_forces_of(with_rows, 1., y, u.begin(), nullptr, of_tangent);
    }

    /**
     * With a law that is not linear: K is the tangent at u, ghosts as above. Returns the largest
     * slope, at least 1.
     */
    double linearize(const Vector &u);

    /** Add a multiple of K u in the rows of some nodes; ghosts as above. Collective. */
    void add_forces_of(const std::vector<unsigned int> &of_nodes,
                       const double                     multiple,
                       Vector                          &y,
                       const Vector                    &u) const
    {
      add_forces_of(of_nodes, multiple, y, u.begin(), nullptr);
    }

    /** What an owned node has of the diagonal of K. */
    dealii::Tensor<1, dim> diagonal_of(const unsigned int node) const;

    /** Add the sums over the absolute values of rows of K, or more. Collective. */
    virtual void add_row_sums(std::vector<double> &sums) const;

    /** Add to a matrix what whole bonds between vertices of a cell have of K. Not compressed. */
    void add_between_vertices(dealii::TrilinosWrappers::SparseMatrix &matrix) const;

    /**
     * Sum of E_i over these nodes; over all nodes, all of it. Ghosts as above.
     * @param thermal strains of nodes known here; empty: none
     * @param dissipated what the law dissipates in the step, instead
     */
    double energy(const Vector                    &u,
                  const std::vector<unsigned int> &of_nodes,
                  const std::vector<double>       &thermal,
                  const bool                       dissipated = false) const
    {
      return energy(u.begin(), of_nodes, thermal.empty() ? nullptr : thermal.data(), dissipated);
    }

    /**
     * Add the loads of thermal strains at nodes, means of both ends, in the rows of these nodes.
     * Returns the energy of a body that is held everywhere. Collective.
     */
    double add_thermal(Vector                          &loads,
                       const std::vector<unsigned int> &of_nodes,
                       const std::vector<double>       &thermal,
                       const double                     multiple) const
    {
      add_forces_of(of_nodes, -multiple, loads, nullptr, thermal.data());
      return multiple * energy(nullptr, of_nodes, thermal.data());
    }

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

    /** k_i/x^2 + k_j/x^2. */
    double spring(const unsigned int i, const Bond &bond) const
    {
      return coefficients.stiffness.size() == 0 ?
               1. :
               LinearPeridynamicSolid::spring(coefficients.stiffness.local_element(i) +
                                                coefficients.stiffness.local_element(bond.neighbor),
                                              vectors[bond.vector].norm_square());
    }

    /** Of this process: each whole bond is counted half in a row. */
    double n_whole() const;

    std::size_t memory_consumption() const;

  protected:
    /** All have to outlive this object, which has no bonds yet. @param law null: linear */
    ZoneBonds(const Families<dim> &bonds_of_zone, const NodalLaw *law);

    void set_row(const unsigned int                                     node,
                 const std::vector<typename DiffusionBonds<dim>::Bond> &list);
    void finish_rows();

    const Families<dim> &families;
    /** Of nodes, with ghosts. */
    struct
    {
      Vector              stiffness, dilatation; // k, a; empty: bonds by themselves
      Vector              shear;  // what of a the shear modulus multiplies; empty: nobody asks
      std::vector<double> slopes; // of bonds, by a law that is not linear; empty: 1
    } coefficients;
    const NodalLaw *const law; // null: the linear solid

    /** Of the public functions. @param u, thermal may be null: none */
    virtual void   add_forces_of(const std::vector<unsigned int> &of_nodes,
                                 const double                     multiple,
                                 Vector                          &y,
                                 const double                    *u,
                                 const double                    *thermal,
                                 const bool                       of_tangent = false) const;
    virtual double energy(const double                    *u,
                          const std::vector<unsigned int> &of_nodes,
                          const double                    *thermal,
                          const bool                       dissipated = false) const;

  private:
    struct Row
    {
      std::size_t  first = 0; // among all bonds
      unsigned int n     = 0;
    };

    /** c_ij. @param u null: at rest @param thermal null: without thermal strains */
    double change(const unsigned int i,
                  const Bond        &bond,
                  const double      *u,
                  const double      *thermal) const;

    /** Whether nodes have any a_i sum_j W_ij c_ij, which is found. */
    bool find_tensions(const double *u, const double *thermal, const bool of_tangent) const;

    std::vector<dealii::Tensor<1, dim>> vectors;
    mutable Vector                      tensions;            // a_i sum_j W_ij c_ij
    std::array<int, dim>                reach{};             // offsets in each direction
    std::vector<bool>                   is_between_vertices; // by number of the vector
    std::vector<Bond>                   bonds;
    std::vector<Row>                    rows;       // of owned nodes
    std::vector<unsigned int>           with_rows;  // ascending
    std::size_t                         unused = 0; // of the bonds, in rows that were taken anew
    bool more = false;                              // or fewer nodes have rows than with_rows says
  };


  /** The bonds of a coupling that has a zone in which they may break, without rows. */
  template <int dim>
  std::unique_ptr<ZoneBonds<dim>> make_zone_bonds(Coupling<dim>             &coupling,
                                                  const BodyParameters<dim> &body,
                                                  const NodalLaw            *law);
} // namespace PeriDeal
