// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/point_bins.h>
#include <perideal/mesh/nodes.h>

#include <algorithm>
#include <array>
#include <functional>
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


  /** A segment (2D) or triangle (3D) of the boundary of a mesh. */
  template <int dim>
  struct BoundaryFacet
  {
    std::array<dealii::types::global_dof_index, dim> nodes; // on the corners, or 0
    std::array<dealii::Point<dim>, dim>              corners;
    dealii::Tensor<1, dim>                           normal; // outwards
    double                                           area;
    dealii::types::boundary_id                       side;

    /** Weights of the corners in the point of it that is nearest to p. */
    std::array<double, dim> nearest_weights(const dealii::Point<dim> &p) const;

    dealii::Point<dim> at(const std::array<double, dim> &weights) const;
  };

  /**
   * All of the boundary, on each process, in an order that does not depend on who owns what; with
   * nodes where they are those of vertices. Collective.
   */
  template <int dim>
  std::vector<BoundaryFacet<dim>> gather_boundary_facets(const Nodes<dim> &nodes);

  /** Numbers of facets, so that visit_near() finds all that come within the reach of a point. */
  template <int dim, typename Facet>
  PointBins<dim> bins_of_facets(const std::vector<Facet> &facets, const double reach)
  {
    double size = 0.; // of the largest
    for (const Facet &facet : facets)
      for (const dealii::Point<dim> &corner : facet.corners)
        size = std::max(size, corner.distance(facet.corners[0]));
    PointBins<dim> bins(reach + size);
    for (unsigned int f = 0; f < facets.size(); ++f)
      bins.add(facets[f].corners[0], f);
    return bins;
  }


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

    const std::vector<SymmetryPlane> &planes() const;

    /** Global index and place of a facet's node. */
    dealii::types::global_dof_index node(const unsigned int facet, const unsigned int k) const;
    const dealii::Point<dim>       &corner(const unsigned int facet, const unsigned int k) const;
    const dealii::Tensor<1, dim>   &normal(const unsigned int facet) const;

    /**
     * The points of the boundary within the reach that are nearest to p among those around them,
     * the nearest first, one for each direction: of those whose facets' normals differ by less
     * than some 37 degrees the nearest.
     */
    std::vector<Foot> feet(const dealii::Point<dim> &p) const;

    /** The facets in which p lies, one for each direction, whether their sides go on or not. */
    std::vector<Foot> at(const dealii::Point<dim> &p) const;

    /** Whether normals are those of one side: they differ by less than those 37 degrees. */
    static bool are_alike(const dealii::Tensor<1, dim> &a, const dealii::Tensor<1, dim> &b);

    /**
     * The nearest point of facets whose normals differ from @p normal by less than that; false if
     * there is none within the reach and a facet's size.
     */
    bool nearest(const dealii::Point<dim>     &p,
                 const dealii::Tensor<1, dim> &normal,
                 Foot                         &foot) const;

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
      std::array<dealii::Tensor<1, dim>, dim> corner_normals;
    };

    void take_out_planes(const std::vector<dealii::types::boundary_id> &symmetry);
    void find_corner_normals();
    Foot foot_on(const dealii::Point<dim> &p, const unsigned int facet) const;
    bool is_lowest(const dealii::Point<dim> &p, const Foot &foot) const;

    double                                 reach;
    std::vector<Facet>                     facets;
    std::vector<SymmetryPlane>             symmetry_planes;
    PointBins<dim>                         bins;
    std::vector<std::vector<unsigned int>> touching; // facets, by facet, itself included
  };
} // namespace PeriDeal
