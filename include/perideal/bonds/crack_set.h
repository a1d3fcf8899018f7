// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/body_voids.h>
#include <perideal/bonds/bond_conductivities.h>
#include <perideal/bonds/broken_bonds.h>
#include <perideal/scene/change_set.h>
#include <perideal/scene/crack_geometry.h>
#include <perideal/scene/crack_history.h>

#include <functional>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * The cracks of one time as bonds see them: which bonds they cut and what they let through. Voids
   * that bonds must not cross count as cracks that let nothing through.
   */
  template <int dim>
  class CrackSet
  {
  public:
    /**
     * The cracks at the beginning. Neighbours and voids have to outlive this object.
     * @param cut_at_tips          bonds that only touch a tip are cut, too
     * @param contact_conductance  of cracks; negative: none is given, they let through their
     *                             transmission
     * @param voids                that bonds must not cross, or nullptr
     * @param transmission_of_broken what bonds let through that another physics breaks
     * @param in_part_at_tips      in 2D kept_part() goes from 1 to 0 over a spacing about each tip
     */
    CrackSet(const Neighbors<dim>    &neighbors,
             const CrackHistory<dim> &history,
             const bool               cut_at_tips,
             const double             contact_conductance,
             const BodyVoids<dim>    *voids,
             const double             transmission_of_broken = 1.,
             const bool               in_part_at_tips        = false);

    /** Whether a bond crosses some crack. */
    bool cuts(const unsigned int node, const unsigned int neighbor) const;

    /**
     * What the cracks leave of an elastic bond, the product over those that it crosses of 0 or 1;
     * with in_part_at_tips (1 - p)/(1 + p/2), p of CrackGeometry::cut_part() over one spacing along
     * the crack. A bond of half the stiffness bears more than half of its force, and
     * with this law the crack is as good as longer by p spacings. Where tips that are touched cut
     * nothing (not @p cut_at_tips) the crack is taken to be shorter by a fifth of a spacing at
     * each tip.
     */
    double kept_part(const unsigned int node, const unsigned int neighbor) const;

    /** Whether some crack, wherever it is, lies between two points. */
    bool separate(const dealii::Point<dim> &a, const dealii::Point<dim> &b) const;

    /** No crack; there may be voids. */
    bool empty() const;

    /**
     * A point slightly to the left of a crack for each local node on it: it belongs to that side,
     * and has its material. So at all times where the crack comes to grow to.
     */
    std::unordered_map<unsigned int, dealii::Point<dim>> side_points() const;

    /**
     * What the cracks leave of a bond's conductance, and whether it crosses any. A contact
     * conductance H is in series with the materials on both of its sides,
     *
     *   |xi.n|/kappa = d_i/k_i + 1/H + d_j/k_j,
     *
     * with d the distances of the ends from the crack: the flow through a plane contact is exact.
     * @param conductivities  without effect unless a contact conductance is given
     * @param of_way          the bond conducts as what lies along its way, else by of_bond()
     */
    double kept_fraction(const unsigned int             node,
                         const unsigned int             neighbor,
                         const BondConductivities<dim> &conductivities,
                         bool                          &cut,
                         const bool                     of_way = false) const;

    /**
     * The cracks that a bond crosses: +1 if the node lies on the left side, -1 if its neighbour
     * does. @p crossed is overwritten.
     */
    void crossed_cracks(const unsigned int                         node,
                        const unsigned int                         neighbor,
                        std::vector<std::pair<unsigned int, int>> &crossed) const;

    /** Whether the way from a node to a site of a lattice beyond flat sides leads through voids. */
    bool leaves_body(const unsigned int node, const typename Lattice<dim>::Index &site) const;

    /** Whether the way between two real nodes leads through voids. */
    bool leaves_body(const unsigned int node, const unsigned int neighbor) const;

    /** Whether some crack or void is within a distance of a node. */
    bool is_near(const unsigned int node, const double distance) const;

    /** Take the cracks after a change, and the bonds that it has broken. */
    void apply_change(const ChangeSet<dim> &change);

    /** What another physics of the model has broken. */
    const BrokenBonds &broken() const
    {
      return broken_bonds;
    }

    /** The representative time of the cracks as they are now. */
    double now() const
    {
      return time;
    }

    /** When the cracks or their transmission change. */
    const CrackHistory<dim> &history() const
    {
      return past;
    }

  private:
    template <typename Test>
    void   test_crossings(const unsigned int        node,
                          const unsigned int        neighbor,
                          const CrackGeometry<dim> &crack,
                          const Test               &test) const;
    double contact_fraction_of(
      const CrackGeometry<dim>                                 &crack,
      const dealii::Point<dim>                                 &a,
      const dealii::Point<dim>                                 &b,
      const std::function<std::pair<double, double>(double s)> &conductivities) const;
    void   make_soft_cracks();
    double spacing_along(const CrackPiece<dim> &piece) const; // of the nodes, along a crack
    bool   is_near_soft(const std::size_t k, const unsigned int node, const double distance) const;
    /** What is left of a bond that may have broken. */
    double kept_of_broken(const unsigned int node, const unsigned int neighbor) const;

    /** Those that a bond of the node may cross. */
    const std::vector<unsigned int> &cracks_near(const unsigned int node) const;

    /** Of the node that was asked for last: bonds come by families. */
    struct Near
    {
      unsigned int              node = dealii::numbers::invalid_unsigned_int;
      std::vector<unsigned int> cracks;
    };

    dealii::types::global_dof_index global(const unsigned int node) const;
    template <typename Test>
    void test_images(const unsigned int         node,
                     const FictitiousNode<dim> &fictitious,
                     const Test                &test) const;

    const Neighbors<dim>           &neighbors;
    const CrackHistory<dim>         past;
    const bool                      cut_at_tips;
    const double                    contact_conductance;
    const BodyVoids<dim>           *voids;
    double                          time; // the representative one
    std::vector<CrackGeometry<dim>> cracks;
    mutable Near                    near;
    std::vector<CrackGeometry<dim>> soft_cracks; // if they cut in part at tips
    std::vector<double>             widths;      // of their tips
    double                          transmission;
    BrokenBonds                     broken_bonds;
  };
} // namespace PeriDeal
