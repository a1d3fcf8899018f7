// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/bonds/boundary_facets.h>
#include <perideal/bonds/boundary_images.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The images of nodes, one node at a time. */
    template <int dim>
    class ImageFinder
    {
    public:
      ImageFinder(const Nodes<dim> &nodes, const BoundaryFacets<dim> &facets, const double reach)
        : nodes(nodes)
        , facets(facets)
        , reach(reach)
      {}

      /** Add the images of a node through the sides that go on. */
      void find(const unsigned int m, std::vector<BoundaryImage<dim>> &images) const
      {
        const Point<dim>       &p      = nodes.position(m);
        const std::vector<Foot> feet   = facets.feet(p, global(m), nodes.crack_point(m) - p);
        const unsigned int      n      = std::min<std::size_t>(feet.size(), 2 * dim);
        const Corner            corner = reentrant_corner(m, feet);
        for (unsigned int set = 1; set < (1u << n); ++set)
          {
            const unsigned int common = set & corner.set;
            if (common == 0)
              add(m, feet, set, 1., images);
            else if ((common & (common - 1)) == 0) // a single one of these sides
              add(m, feet, set, corner.share, images);
          }
      }

    private:
      using Foot = typename BoundaryFacets<dim>::Foot;
      using Term = typename BoundaryImage<dim>::Term;

      /** A point with the displacement sum w u over nodes. */
      struct Part
      {
        double                                                  factor;
        Point<dim>                                              place;
        std::vector<std::pair<types::global_dof_index, double>> weights;
        std::vector<Point<dim>>                                 places;
      };

      /** A side where it meets a node, or its mirror image beyond a plane of symmetry. */
      struct Side
      {
        Tensor<1, dim>              normal;
        std::array<Point<dim>, dim> corners; // of its facet
        bool                        is_mirrored;
      };

      /** The sides of feet, a bit for each, of a reentrant corner in which the node lies. */
      struct Corner
      {
        unsigned int set   = 0;
        double       share = 1.; // of the node's volume, for an image through one of them
      };

      types::global_dof_index global(const unsigned int m) const
      {
        return nodes.partitioner()->local_to_global(m);
      }

      Part part_of(const Foot &foot, const double factor) const
      {
        Part part{factor, foot.point, {}, {}};
        for (unsigned int k = 0; k < dim; ++k)
          if (foot.weights[k] != 0.)
            {
              part.weights.emplace_back(facets.node(foot.facet, k), foot.weights[k]);
              part.places.push_back(facets.corner(foot.facet, k));
            }
        return part;
      }

      /** Through one side, or at a convex edge through several, one after the other. */
      void add(const unsigned int               m,
               const std::vector<Foot>         &feet,
               const unsigned int               set,
               const double                     share,
               std::vector<BoundaryImage<dim>> &images) const
      {
        std::vector<Part>  parts{{1., nodes.position(m), {{global(m), 1.}}, {nodes.position(m)}}};
        std::vector<Foot>  through;
        BoundaryImage<dim> image;
        double             farthest = 0.;
        image.volume                = nodes.volume(m) * share;
        image.origin                = m;
        image.planes.fill(numbers::invalid_boundary_id);
        for (unsigned int k = 0; k < feet.size(); ++k)
          if ((set >> k) & 1)
            {
              const Foot &foot = feet[k];
              image.volume *= facets.growth(foot) * share_of_edge(foot, through);
              if (image.volume <= 0.)
                return;
              reflect(parts, foot);
              farthest = std::max(farthest, foot.distance);
              through.push_back(foot);
            }
        image.volume *= facets.share(through);
        if (image.volume <= 0.)
          return;
        for (const Part &part : parts)
          image.place += part.factor * part.place;
        // Beyond reentrant corners and narrow gaps there are other sides, or the body itself.
        constexpr double nearly = 0.9;
        if (farthest > 1e-9 * reach && facets.is_nearer(image.place, nearly * farthest))
          return;
        for (const SymmetryPlane &plane : facets.planes())
          if ((image.place[plane.axis] - plane.at) * (plane.above ? 1. : -1.) > 1e-9 * reach)
            return; // there are mirror images
        find_terms(parts, image);
        images.push_back(image);
      }

      /** The sides that meet where a node is: those of feet, then others, then mirrored ones. */
      std::vector<Side> sides_at(const unsigned int m, const std::vector<Foot> &feet) const
      {
        const Point<dim> &p = nodes.position(m);
        std::vector<Side> sides;
        const auto        add_side = [&](const Side &side) {
          if (std::none_of(sides.begin(), sides.end(), [&](const Side &other) {
                return BoundaryFacets<dim>::are_alike(other.normal, side.normal);
              }))
            sides.push_back(side);
        };
        const auto add_facet = [&](const Foot &foot) {
          Side side{facets.normal(foot.facet), {}, false};
          for (unsigned int k = 0; k < dim; ++k)
            side.corners[k] = facets.corner(foot.facet, k);
          add_side(side);
        };
        for (unsigned int a = 0; a < feet.size() && a < 2 * dim && is_at_node(feet[a]); ++a)
          add_facet(feet[a]);
        if (sides.empty())
          return sides;
        for (const Foot &foot : facets.at(p, global(m)))
          add_facet(foot);
        for (const SymmetryPlane &plane : facets.planes())
          if (std::abs(p[plane.axis] - plane.at) < 1e-9 * reach)
            for (std::size_t k = 0, n = sides.size(); k < n; ++k)
              {
                Side side = sides[k];
                side.normal[plane.axis] *= -1.;
                for (Point<dim> &corner : side.corners)
                  corner[plane.axis] = 2. * plane.at - corner[plane.axis];
                side.is_mirrored = true;
                add_side(side);
              }
        return sides;
      }

      bool is_at_node(const Foot &foot) const
      {
        return foot.distance < 1e-9 * reach;
      }

      /**
       * Beyond the sides of a reentrant corner the body lacks a part v of the surroundings of its
       * node: 1/2 beyond one side, times (2 pi - b)/pi for each other at an angle b in the body.
       * The image through each of n sides is v/(n (1 - v)) of the node; beside a plane of symmetry
       * node and images are half of those of the whole body.
       */
      Corner reentrant_corner(const unsigned int m, const std::vector<Foot> &feet) const
      {
        const Point<dim>       &p        = nodes.position(m);
        const std::vector<Side> sides    = sides_at(m, feet);
        const auto              is_ahead = [&](const Side &of, const Side &other) {
          return std::any_of(other.corners.begin(), other.corners.end(), [&](const auto &corner) {
            return (corner - p) * of.normal > 1e-3 * corner.distance(p);
          });
        };
        std::vector<bool> is_of_corner(sides.size(), false);
        for (std::size_t a = 0; a < sides.size(); ++a)
          for (std::size_t b = 0; b < a; ++b)
            if ((is_ahead(sides[a], sides[b]) && is_ahead(sides[b], sides[a])) ||
                sides[a].normal * sides[b].normal < -1. + 1e-9) // at the tip of a crack
              is_of_corner[a] = is_of_corner[b] = true;
        Corner       corner;
        double       missing = 0.5;
        unsigned int n       = 0;
        for (std::size_t a = 0; a < sides.size(); ++a)
          if (is_of_corner[a])
            {
              double part = 1.;
              for (std::size_t b = 0; b < a; ++b)
                if (is_of_corner[b])
                  part = std::min(part, 1. - angle(sides[a].normal, sides[b].normal) / numbers::PI);
              missing *= part;
              n += !sides[a].is_mirrored;
              if (a < feet.size() && a < 2 * dim && is_at_node(feet[a]))
                corner.set |= 1u << a;
            }
        if (n > 0)
          corner.share = missing / ((1. - missing) * n);
        return corner;
      }

      static double angle(const Tensor<1, dim> &a, const Tensor<1, dim> &b)
      {
        return std::acos(std::clamp(a * b, -1., 1.));
      }

      /**
       * What is left at the edge for images through both of its sides: (2 pi - 3 a)/a at an angle
       * a, at most 1.
       */
      double share_of_edge(const Foot &foot, const std::vector<Foot> &through) const
      {
        double share = 1.;
        for (const Foot &other : through)
          {
            const double cosine =
              std::clamp(facets.normal(foot.facet) * facets.normal(other.facet), -1., 1.);
            if (cosine < -0.9)
              return 0.; // both sides of a thin body
            const double inside = numbers::PI - std::acos(cosine);
            share = std::min(share, std::clamp(2. * numbers::PI / inside - 3., 0., 1.));
          }
        return share < 1e-9 ? 0. : share;
      }

      /** Each point has an image through its nearest point of that side. */
      void reflect(std::vector<Part> &parts, const Foot &foot) const
      {
        std::vector<Part> result;
        for (Part &part : parts)
          {
            const Foot nearest = parts.size() > 1 ? facets.nearest(part.place, foot.facet) : foot;
            result.push_back(part_of(nearest, 2. * part.factor));
            part.factor *= -1.;
            result.push_back(part);
          }
        parts.swap(result);
      }

      void find_terms(const std::vector<Part> &parts, BoundaryImage<dim> &image) const
      {
        std::vector<types::global_dof_index> found;
        for (const Part &part : parts)
          for (unsigned int k = 0; k < part.weights.size(); ++k)
            {
              const auto [node, weight] = part.weights[k];
              std::size_t at = std::find(found.begin(), found.end(), node) - found.begin();
              if (at == found.size())
                {
                  found.push_back(node);
                  const auto &layout = *nodes.partitioner();
                  const bool  known  = layout.in_local_range(node) || layout.is_ghost_entry(node);
                  image.terms.push_back(
                    {known ? layout.global_to_local(node) : numbers::invalid_unsigned_int, 0, 0.});
                  image.term_places.push_back(part.places[k]);
                }
              image.terms[at].factor += part.factor * weight;
            }
      }

      const Nodes<dim>          &nodes;
      const BoundaryFacets<dim> &facets;
      const double               reach;
    };


    /** Append the mirror images of all nodes and images near a plane of symmetry. */
    template <int dim>
    void mirror(const Nodes<dim>                &nodes,
                const SymmetryPlane             &plane,
                const double                     reach,
                std::vector<BoundaryImage<dim>> &images)
    {
      const unsigned int              axis = plane.axis;
      std::vector<BoundaryImage<dim>> mirrored;
      const auto                      add = [&](BoundaryImage<dim> image) {
        const double depth = (plane.at - image.place[axis]) * (plane.above ? 1. : -1.);
        if (depth < -1e-9 * reach || depth > reach)
          return;
        if (depth > 1e-9 * reach) // else the other part of a volume in the plane
          {
            image.place[axis]        = 2. * plane.at - image.place[axis];
            image.planes[axis]       = plane.side;
            image.twice_planes[axis] = 2. * plane.at;
            for (auto &term : image.terms)
              term.mirrored ^= 1u << axis;
          }
        mirrored.push_back(image);
      };
      for (unsigned int m = 0; m < nodes.n_local(); ++m)
        {
          BoundaryImage<dim> image;
          image.place  = nodes.position(m);
          image.volume = nodes.volume(m);
          image.origin = m;
          image.planes.fill(numbers::invalid_boundary_id);
          image.terms.push_back({m, 0, 1.});
          image.term_places.push_back(image.place);
          add(image);
        }
      for (const BoundaryImage<dim> &image : images)
        add(image);
      images.insert(images.end(), mirrored.begin(), mirrored.end());
    }
  } // namespace


  double halo_of_images(const double reach)
  {
    // Beyond a flat side an image's node is as near as the image, beyond a hole somewhat farther.
    return 1.5 * reach;
  }


  template <int dim>
  std::vector<BoundaryImage<dim>> boundary_images(
    const Nodes<dim>                                    &nodes,
    const std::vector<types::boundary_id>               &symmetry,
    const std::function<bool(const types::boundary_id)> &goes_on,
    const double                                         reach,
    ThinParts                                           *thin)
  {
    std::vector<BoundaryImage<dim>> images;
    if constexpr (dim > 1)
      {
        BoundaryFacets<dim> facets(nodes, symmetry, goes_on, reach);
        if (thin != nullptr)
          facets.go_on_in_part(*thin);
        const ImageFinder<dim> finder(nodes, facets, reach);
        for (unsigned int m = 0; m < nodes.n_local(); ++m)
          finder.find(m, images);
        for (const SymmetryPlane &plane : facets.planes())
          mirror(nodes, plane, reach, images);
      }
    return images;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(boundary_images);
} // namespace PeriDeal
