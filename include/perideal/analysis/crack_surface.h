// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <perideal/bonds/bond_break.h>
#include <perideal/bonds/families.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * A face of the cells about the nodes of a lattice (an edge in 2D, a rectangle in 3D), between
   * two nodes one spacing apart whose bond has broken.
   */
  template <int dim>
  struct CrackFacet
  {
    dealii::Point<dim> lower, upper; // opposite corners, which differ but for the normal direction
    double             time;         // when the bond broke
    double             damage;       // the larger one of its ends

    unsigned int normal() const;

    /** Two in 2D; four in 3D, in a circle. */
    std::vector<dealii::Point<dim>> corners() const;
  };


  /**
   * The surface of what has broken in a body, by its bonds.
   *
   * Its area (length in 2D) is the sum over the broken bonds of their shares
   *   a_ij = V_i V_j g/2 (1/S_i + 1/S_j),  g = omega f x^2,
   *   S_i  = 1/2 sum over the family of g V_j |xi_n|,
   * omega f the weight of the bond xi of length x: what bonds store at a common stretch goes with
   * g. The shares of all bonds that cross a plane along the lattice are its area; where families
   * end at the surface of the body, to a twentieth of a spacing. The mean of S over the axes n has
   * as weights the squares of the components of the sum over the node's broken bonds of g V_j xi,
   * which is normal to a straight crack beside it.
   */
  template <int dim>
  class CrackSurface
  {
  public:
    /** The families have to outlive this object. Collective. */
    explicit CrackSurface(const Families<dim> &families);

    /** The same on any number of processes and in any order, but for round-off. Collective. */
    double area(const std::vector<BondBreak> &breaks) const;

    /**
     * Volume of the nodes with a broken bond whose damage is above a threshold, the same as above.
     * Collective.
     * @param damage of owned nodes
     */
    double damaged_volume(const std::vector<BondBreak> &breaks,
                          const std::vector<double>    &damage,
                          const double                  threshold) const;

    /**
     * Of all processes, in the order of their lower corners; none without a lattice or with cracks
     * that are cut into the mesh. Collective.
     */
    std::vector<CrackFacet<dim>> facets(const std::vector<BondBreak> &breaks,
                                        const std::vector<double>    &damage) const;

  private:
    /** A sum over all processes of what lies between 0 and a common scale, without round-off. */
    double exact_sum(const std::vector<double> &shares, const double scale) const;

    /** g of each, without the volumes. */
    std::vector<double> weights_of(const std::vector<BondBreak> &breaks) const;

    /** S of owned nodes and ghosts. Collective. */
    Vector sums_across(const std::vector<BondBreak> &breaks,
                       const std::vector<double>    &weights) const;

    const Families<dim>    &families;
    std::array<Vector, dim> sums; // S of each axis, with ghosts
  };


  /** From where a crack may grow: a point (2D: both ends are the same), or edges (3D). */
  template <int dim>
  struct CrackFront
  {
    std::string                                    name;
    std::vector<std::array<dealii::Point<dim>, 2>> edges;

    double distance(const dealii::Point<dim> &p) const;
  };


  /** How far a crack has grown from a front. */
  template <int dim>
  struct CrackAdvance
  {
    dealii::Point<dim> tip;
    double             length = 0.; // of the shortest path along the crack, from front to tip
    double             speed  = 0.;
    unsigned int       n_tips = 0;
  };


  /**
   * Facets have been reached from a front if they are connected, with gaps of at most @p reach
   * between their corners and at the front; a corner belongs to the nearest front along this path.
   * The tip is the farthest one; of several that are equally far (to 0.05 reach) the mean of those
   * that are connected, of separate ones the first in space. Where no other corner of the same
   * front within the reach is farther, that is a tip, too: `n_tips` counts those that are connected
   * as one.
   *
   * The speed is that of a straight line fitted, in the mean over all instants, to the path length
   * as a function of time since the crack was 4 reach shorter; 0 before it has grown by one.
   *
   * The same on all processes if facets are. Not collective.
   * @param time the current one
   */
  template <int dim>
  std::vector<CrackAdvance<dim>> find_advances(const std::vector<CrackFacet<dim>> &facets,
                                               const std::vector<CrackFront<dim>> &fronts,
                                               const double                        reach,
                                               const double                        time);

  /**
   * The speed of what has come so far at some times, @p now the last one, over the last @p span of
   * its path.
   */
  double fitted_speed(std::vector<std::pair<double, double>> times_and_ways,
                      const double                           span,
                      const double                           now);
} // namespace PeriDeal
