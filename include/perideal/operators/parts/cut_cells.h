// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/full_matrix.h>

#include <perideal/bonds/broken_bonds.h>
#include <perideal/scene/crack_geometry.h>

#include <functional>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * What cracks do to the cells of a finite element mesh, at one time. A cell is cut if a crack
   * separates two of its vertices; where cut cells are removed, if is_removed() says so.
   *
   * In a cut cell that is not removed (Q1, one unknown at each vertex) pairs of vertices conduct
   * w_ab = k_ab max(0, -K_ab), where k_ab is the product over the cracks between the two of what
   * each crack lets through: its transmission, or what a contact conductance does in series with
   * the cell. Where materials vary, K is that of pairs, each of which conducts as what lies along
   * it: on both sides of a crack the material is that of the side. Where several pieces of one
   * crack lie between them, the one counts that lets least through.
   *
   * No function is collective.
   */
  template <int dim>
  class CutCells
  {
  public:
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    struct Rule
    {
      bool                    in_mesh; // cracks are cut into the mesh, so that no cell is cut
      bool                    removes; // cut cells carry nothing
      double                  contact; // conductance per area of a crack; negative: transmission
      std::function<double()> horizon; // asked only where a transmission lies between 0 and 1
      bool                    in_part = false; // ends of cracks remove cells in part
      bool                    mouths  = false; // is_removed(): there are bonds about all cracks
    };

    /** No cell is cut yet. The dofs must outlive this. */
    CutCells(const dealii::DoFHandler<dim> &dofs, const Rule &rule);

    /** Take the cracks of another time, of which all cells may know. */
    void set(const std::vector<CrackPiece<dim>> &pieces, const double transmission);

    /**
     * The same where nothing has changed outside the given cells.
     * @param broken bonds, or null: a cell is cut, too, where one of those between its vertices has
     *               broken, and what is left of the cell then are the pairs of its vertices
     */
    void set(const std::vector<Cell>            &cells,
             const std::vector<CrackPiece<dim>> &pieces,
             const double                        transmission,
             const BrokenBonds                  *broken = nullptr);

    /** A cell of this process or a ghost. */
    bool is_cut(const Cell &cell) const;

    /**
     * What is left of a cell's stiffness where cut cells are removed: 1, 0 if it is cut, or where
     * tips remove in part that of kept_of_cell().
     */
    double kept_of_removed(const Cell &cell) const;

    /** Of all cells, by active cell index; false for artificial ones. */
    const std::vector<bool> &flags() const
    {
      return cut;
    }

    bool removes() const;

    /** Cracks let something through. */
    bool conducts() const;

    using PairConductivity = std::function<double(const unsigned int a, const unsigned int b)>;

    /** Of the material at a point of a cell, which is on the same side of cracks as a vertex. */
    using Conductivity =
      std::function<double(const dealii::Point<dim> &p, const unsigned int vertex)>;

    /**
     * Of what lies between two vertices in series, without what cracks do: the length over the
     * integral of 1/k.
     */
    double conductivity_between(const Cell         &cell,
                                const unsigned int  a,
                                const unsigned int  b,
                                const Conductivity &conductivity) const;

    /**
     * Turn the matrix of a cell of conductivity 1 into that of its pairs, each with its
     * conductivity_between().
     */
    void conduct_in_pairs(const Cell                 &cell,
                          const Conductivity         &conductivity,
                          dealii::FullMatrix<double> &stiffness) const;

    /**
     * k_ab.
     *
     * @param conductivity between two vertices, asked only where it counts
     * @param crossed      if given, the cracks between the two vertices are appended, with 1 where
     *                     vertex a lies on their left and else -1
     */
    double kept_fraction(const Cell                                &cell,
                         const unsigned int                         a,
                         const unsigned int                         b,
                         const PairConductivity                    &conductivity,
                         std::vector<std::pair<unsigned int, int>> *crossed = nullptr) const;

    /** A pair of a cell's vertices that some crack separates. */
    struct SeparatedPair
    {
      unsigned int a, b;
      double       kept, whole; // w_ab, and w_ab without cracks
    };

    /**
     * Turn the matrix of a whole cell into that of a cut one: of its pairs, or nothing.
     * @param separated if given, the separated pairs are appended
     */
    void cut_matrix(const Cell                 &cell,
                    const PairConductivity     &conductivity,
                    dealii::FullMatrix<double> &stiffness,
                    std::vector<SeparatedPair> *separated = nullptr) const;

    /**
     * The pairs of some cell conduct more than it did as a whole, since K_ab > 0 somewhere (cells
     * of very unequal sides). Of all calls of cut_matrix() until now, on this process.
     */
    bool pairs_are_stiffer() const
    {
      return stiffer;
    }

  private:
    /** What damage leaves of a pair of vertices. */
    double kept_of_broken(const Cell &cell, const unsigned int a, const unsigned int b) const;

    const dealii::DoFHandler<dim>  &dofs;
    const Rule                      rule;
    std::vector<CrackGeometry<dim>> cracks;
    double                          transmission = 0.;
    std::vector<double>             kept;         // if ends remove in part, else empty
    std::vector<bool>               cut, damaged; // the latter empty without damage
    const BrokenBonds              *broken  = nullptr;
    mutable bool                    stiffer = false;
  };
} // namespace PeriDeal
