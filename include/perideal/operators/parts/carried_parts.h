// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/quadrature.h>
#include <deal.II/grid/tria.h>

#include <perideal/scene/body_parameters.h>
#include <perideal/scene/crack_geometry.h>

#include <array>
#include <optional>
#include <vector>

namespace PeriDeal
{
  /**
   * Where cells of a lattice that cracks cut are removed: what lies of them on each side of a
   * crack is carried by the next whole cell on that side, in the direction across the crack: its
   * fields go on to the crack (aggregated elements: Badia, Verdugo and Martin 2018). So a crack
   * lies where it is, linear fields stay exact, and there are no unknowns but those at vertices.
   * Ahead of a tip the fields of a cut cell are its own.
   *
   * Cells that cracks cut across different directions, and parts that no whole cell comes after,
   * are lost. What a cell carries follows from the cracks and the lattice alone, so that no process
   * asks another.
   */
  template <int dim>
  class CarriedParts
  {
  public:
    using Cell = typename dealii::Triangulation<dim>::cell_iterator;

    /** There are such cracks, which do not grow, and a lattice. */
    static bool apply_to(const BodyParameters<dim> &body);

    /** The domain must outlive this. */
    explicit CarriedParts(const Domain<dim> &domain);

    /** Take the cracks of another time. */
    void set(const std::vector<CrackPiece<dim>> &pieces);

    /**
     * Where the fields of a cell hold, in its unit coordinates: beyond it, too. Nothing: in the
     * cell alone, or the cell is one of those that are lost where they are cut.
     * @param n_points of the Gauss rules
     */
    std::optional<dealii::Quadrature<dim>> region(const Cell        &cell,
                                                  const unsigned int n_points) const;

    /** So far from a crack cells change with it. */
    double reach() const;

  private:
    struct Box
    {
      dealii::Point<dim>     lower;
      dealii::Tensor<1, dim> size;
    };

    struct Crack
    {
      CrackGeometry<dim> geometry;
      unsigned int       axis; // that it lies across
    };

    /** Points of the unit cell across an axis, where that coordinate is 0. */
    using Across = std::vector<std::pair<dealii::Point<dim>, double>>;

    using Near = std::vector<const Crack *>;

    /** The place above a point along the crack's axis, if the crack itself is there. */
    static std::optional<double> height(const Crack &crack, dealii::Point<dim> p);

    bool   exists(const Box &box) const;
    Across points_across(const Box         &box,
                         const unsigned int axis,
                         const Near        &near,
                         const unsigned int n_points) const;
    Near   cutting(const Box &box, const Near &near, const unsigned int n_points) const;
    std::optional<dealii::Quadrature<dim>> own_part(const Box         &box,
                                                    const Near        &near,
                                                    const Near        &through,
                                                    const unsigned int n_points) const;
    /** How many removed cells in a row follow a whole one; 0: it carries none of them. */
    unsigned int n_removed_beyond(const Cell        &cell,
                                  const Box         &box,
                                  const unsigned int axis,
                                  const int          way,
                                  const Near        &near,
                                  const unsigned int n_points) const;

    const Domain<dim> &domain;
    std::vector<Crack> cracks;
  };
} // namespace PeriDeal
