// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/mesh/boundary_facet.h>
#include <perideal/mesh/nodes.h>

#include <array>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** A plane of symmetry of a mesh: the points whose coordinate along an axis is @p at. */
  struct SymmetryPlane
  {
    unsigned int               axis;
    double                     at;
    bool                       above; // the body lies below it
    dealii::types::boundary_id side;
  };


  /**
   * Families go on in part beyond facets of free sides where the body behind them, along their
   * normal, is thinner than @p most (at hollow rims, as of round holes, than 0.6 of that) and than
   * half of the extent of all along an axis, with the mirror image beyond planes of symmetry. What
   * lies opposite is within 41 degrees of parallel; else the body is no strip there.
   */
  struct ThinParts
  {
    std::function<bool(const dealii::types::boundary_id)> are_free; // sides
    double                                                most;

    // Found: whether families go on in part anywhere, and the least thickness between facets that
    // are parallel within 14 degrees, on sides that go on or do not.
    bool   any      = false;
    double thinnest = std::numeric_limits<double>::infinity();
  };


  /**
   * The boundary of a mesh but for its planes of symmetry, as facets between nodes on its vertices;
   * all of it is known to each process.
   */
  template <int dim>
  class BoundaryFacets
  {
  public:
    /** A point of the boundary, which moves with the nodes of its facet by their weights. */
    struct Foot
    {
      dealii::Point<dim>      point;
      double                  distance;
      unsigned int            facet;
      std::array<double, dim> weights;
    };

    /**
     * @param goes_on  of a side; feet are on such sides alone
     * @param reach    of searches
     * Planes of symmetry are normal to an axis, which DisplacementConditions checks. Collective.
     */
    BoundaryFacets(const Nodes<dim>                                            &nodes,
                   const std::vector<dealii::types::boundary_id>               &symmetry,
                   const std::function<bool(const dealii::types::boundary_id)> &goes_on,
                   const double                                                 reach);

    void go_on_in_part(ThinParts &parts);

    const std::vector<SymmetryPlane> &planes() const
    {
      return symmetry_planes;
    }

    /** Global index and place of a facet's node. */
    dealii::types::global_dof_index node(const unsigned int facet, const unsigned int k) const;
    const dealii::Point<dim>       &corner(const unsigned int facet, const unsigned int k) const;
    const dealii::Tensor<1, dim>   &normal(const unsigned int facet) const;

    /**
     * The points of the boundary within the reach that are nearest to p among those around them,
     * the nearest first, one for each direction: of those whose facets' normals differ by less
     * than some 37 degrees the nearest. Of facets at p itself, where a node is, the node's own.
     * @param inwards from a node where pieces of the body touch into its own cells, else 0
     */
    std::vector<Foot> feet(const dealii::Point<dim>             &p,
                           const dealii::types::global_dof_index node,
                           const dealii::Tensor<1, dim>         &inwards) const;

    /** The facets that end at a node, one for each direction, whether their sides go on or not. */
    std::vector<Foot> at(const dealii::Point<dim>             &p,
                         const dealii::types::global_dof_index node) const;

    /** Whether normals are those of one side: they differ by less than those 37 degrees. */
    static bool are_alike(const dealii::Tensor<1, dim> &a, const dealii::Tensor<1, dim> &b);

    /**
     * The nearest point of a side, which is what hangs together with a facet by others whose
     * normals differ from its own by less than that, within two reaches.
     */
    Foot nearest(const dealii::Point<dim> &p, const unsigned int facet) const;

    /**
     * Of an image through these facets: what of it counts. 0.15 through one beyond which families
     * go on in part, half of that where they go on wholly beyond another, nothing through two;
     * between facets that differ the mean of both.
     */
    double share(const std::vector<Foot> &through) const;

    /** Whether a point of the boundary is nearer than that. */
    bool is_nearer(const dealii::Point<dim> &p, const double distance) const;

    /**
     * How much larger the mirror image of a small volume beyond a curved side is; 1 beyond a flat
     * one, 0 where there is none.
     */
    double growth(const Foot &foot) const;

  private:
    struct Facet : BoundaryFacet<dim>
    {
      bool                                    goes_on;
      std::array<double, dim>                 thin{}; // at the corners, from 0 to 1
      std::array<dealii::Tensor<1, dim>, dim> corner_normals;
    };

    /** Its centre of curvature lies outside the body, within 25 of these lengths. */
    bool is_hollow(const unsigned int facet, const double length) const;
    /**
     * From the middle of a facet to what lies opposite within a length, and the cosine of the angle
     * there; else infinity and 0.
     */
    std::pair<double, double> opposite(const unsigned int facet, const double most) const;
    /** Of the body, with its mirror image. */
    double extent() const;
    void   take_out_planes(const std::vector<dealii::types::boundary_id> &symmetry);
    void   find_corner_normals();
    Foot   foot_on(const dealii::Point<dim> &p, const unsigned int facet) const;
    bool   is_lowest(const dealii::Point<dim> &p, const Foot &foot) const;
    bool   ends_at(const unsigned int facet, const dealii::types::global_dof_index node) const;

    double                                 reach;
    std::vector<Facet>                     facets;
    std::vector<SymmetryPlane>             symmetry_planes;
    PointBins<dim>                         bins;
    std::vector<std::vector<unsigned int>> touching; // facets, by facet, itself included
  };
} // namespace PeriDeal
