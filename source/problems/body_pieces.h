// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/point.h>

#include <perideal/problems/solid_problem.h>

#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * The pieces of a body that no cells hold together, as blocks of a mesh file or phases apart by
   * voids, and whether a displacement lets them overlap: nothing is between them at rest, nor in
   * motion with small displacements.
   * What cracks cut is one piece; faces of cracks have a contact of their own (SolidContact).
   *
   * Looked for are corners of the surface of one piece that lie in cells of another one, both
   * deformed. With nodes at the centres of cells these move as they are: an overlap counts from
   * where it is larger than what neighbouring cells move against each other.
   */
  template <int dim>
  class BodyPieces
  {
  public:
    /** Collective. */
    explicit BodyPieces(const SolidProblem<dim> &run);

    /**
     * Where pieces overlap at t, as the end of a note that begins with @p start; empty: nowhere.
     * Nothing is done if the body is one piece. Collective. Throws UserError, with that start, of
     * equilibria, unless `Contact = false` allows it.
     */
    std::string overlap(const double t, const std::string &start) const;

  private:
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;
    using Box  = dealii::BoundingBox<dim>;

    struct Displacement; // of corners of cells

    /** A corner of the surface of a piece. */
    struct Corner
    {
      unsigned int       piece = 0;
      dealii::Point<dim> at, now; // before and after the displacement
    };

    /** The deepest of those that have been found. */
    struct Overlap
    {
      double       depth = 0.;
      Corner       corner;
      unsigned int other = 0; // the piece that it is in
    };

    template <typename Visit>
    void                for_each_own_cell(const Visit &visit) const;
    unsigned int        piece_of(const Cell &cell) const;
    std::vector<Box>    boxes(const Displacement &u) const;
    std::vector<Corner> corners_of_all(const std::vector<double> &own) const;
    /** Of surfaces, in the box of another piece. */
    std::vector<Corner> corners_near(const Displacement &u, const std::vector<Box> &boxes) const;
    /** Those in another piece, which is named, and farther than a slack from its surface. */
    std::vector<std::pair<unsigned int, Corner>> inside(const Displacement        &u,
                                                        const std::vector<Corner> &corners,
                                                        const double               slack) const;
    Overlap                                      deepest(const Displacement &u) const;
    std::string                                  text(const Overlap &overlap, const double t) const;

    const SolidProblem<dim>        &run;
    unsigned int                    n_pieces = 0;
    std::vector<unsigned int>       of_coarse; // piece of each coarse cell
    std::vector<dealii::Point<dim>> middles;   // of pieces
  };
} // namespace PeriDeal
