// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/scene/rigid_motions.h>
#include <perideal/scene/scene.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** A component of the displacement that a side holds. */
    struct Held
    {
      types::boundary_id     side;
      unsigned int           component;
      const VectorCondition *condition; // null: symmetry
    };


    template <int dim>
    std::vector<Held> held_components(const Scene<dim> &scene)
    {
      std::vector<Held> list;
      for (const VectorCondition &condition : scene.boundary_conditions.displacement)
        for (unsigned int c = 0; c < dim; ++c)
          if (condition.values[c])
            list.push_back({condition.id, c, &condition});
      if (scene.domain.has_lattice())
        for (const types::boundary_id side : scene.boundary_conditions.symmetry)
          list.push_back({side, side / 2, nullptr});
      return list;
    }


    /** Corners of a side of the box, or points around the hole. */
    template <int dim>
    std::vector<Point<dim>> points_of_side(const Domain<dim> &domain, const types::boundary_id side)
    {
      std::vector<Point<dim>> points;
      for (unsigned int k = 0; k < (1u << dim); ++k)
        {
          Point<dim> p;
          for (unsigned int d = 0; d < dim; ++d)
            {
              const bool up = (k >> d) % 2 == 1;
              p[d]          = up ? domain.upper[d] : domain.lower[d];
              if (side == hole_boundary_id && d < 2 && domain.holes.has_one)
                p[d] = domain.holes.center[d] + (up ? 1. : -1.) * domain.holes.radius;
              else if (side == hole_boundary_id && d < 2 && !domain.holes.listed.empty())
                {
                  const auto box = domain.holes.listed.front().box();
                  p[d]           = up ? box.second[d] : box.first[d];
                }
            }
          if (side == hole_boundary_id || (k >> (side / 2)) % 2 == side % 2)
            points.push_back(p);
        }
      return points;
    }


    /**
     * From a node of a lattice to another one along each direction. At most 41 of them are seen
     * along each, the ends among them.
     */
    template <int dim>
    struct NodeRange
    {
      std::array<unsigned int, dim> first, last;

      unsigned int n_seen(const unsigned int d) const
      {
        return std::min(last[d] - first[d], 40u) + 1;
      }

      unsigned int seen(const unsigned int d, const unsigned int k) const
      {
        return n_seen(d) == 1 ? first[d] : first[d] + k * (last[d] - first[d]) / (n_seen(d) - 1);
      }
    };


    /**
     * The nodes seen in a range at which a component is held are added to @p points. Returns
     * whether there are any; the range becomes the one around them.
     */
    template <int dim, typename Holds>
    bool look_for_nodes(const Domain<dim>       &domain,
                        const types::boundary_id side,
                        const Holds             &holds,
                        NodeRange<dim>          &range,
                        std::vector<Point<dim>> &points)
    {
      const double   shift = domain.has_nodes_at_centers() ? 0.5 : 0.;
      NodeRange<dim> found{};
      unsigned int   count = 1;
      bool           any   = false;
      for (unsigned int d = 0; d < dim; ++d)
        count *= range.n_seen(d);
      for (unsigned int k = 0; k < count; ++k)
        {
          Point<dim>                    p;
          std::array<unsigned int, dim> seen{};
          unsigned int                  rest = k;
          for (unsigned int d = 0; d < dim; ++d)
            {
              seen[d] = rest % range.n_seen(d);
              rest /= range.n_seen(d);
              const double s = side < 2 * dim && d == side / 2 ?
                                 side % 2 :
                                 (range.seen(d, seen[d]) + shift) / domain.cells[d];
              p[d]           = domain.lower[d] + s * (domain.upper[d] - domain.lower[d]);
            }
          if (!holds(p))
            continue;
          points.push_back(p);
          for (unsigned int d = 0; d < dim; ++d)
            {
              const unsigned int before = range.seen(d, std::max(seen[d], 1u) - 1),
                                 after  = range.seen(d, std::min(seen[d] + 1, range.n_seen(d) - 1));
              found.first[d]            = any ? std::min(found.first[d], before) : before;
              found.last[d]             = any ? std::max(found.last[d], after) : after;
            }
          any = true;
        }
      if (any)
        range = found;
      return any;
    }


    /**
     * Some of the nodes of a lattice where a condition on a part, or one that is free elsewhere,
     * holds a component: of all of the body, then closer and closer around those that are held. If
     * it holds none that is seen: corners of the body, since what is not seen is not to be refused.
     */
    template <int dim>
    std::vector<Point<dim>> held_points(const Scene<dim> &scene, const Held &held)
    {
      const BoundaryConditions<dim> &conditions = scene.boundary_conditions;
      const Domain<dim>             &domain     = scene.domain;
      const Part *const              part       = conditions.part(held.side);
      const types::boundary_id       side       = conditions.side_of(held.side);
      if (part != nullptr && part->kind == Part::point)
        return {part->template position<dim>()};
      std::vector<Point<dim>> points;
      NodeRange<dim>          range{};
      for (unsigned int d = 0; d < dim; ++d)
        range.last[d] = side < 2 * dim && d == side / 2 ? 0 :
                        domain.has_nodes_at_centers()   ? domain.cells[d] - 1 :
                                                          domain.cells[d];
      constexpr unsigned int most_looks = 12;
      for (unsigned int look = 0; look < most_looks; ++look)
        {
          const NodeRange<dim> before = range;
          if (!look_for_nodes(
                domain,
                side,
                [&](const Point<dim> &p) {
                  return conditions.holds_at(held.side, p) &&
                         held.condition->holds(held.component, p);
                },
                range,
                points) ||
              (range.first == before.first && range.last == before.last))
            break;
        }
      if (points.empty())
        for (unsigned int k = 0; k < (1u << dim); ++k)
          {
            Point<dim> corner;
            for (unsigned int d = 0; d < dim; ++d)
              corner[d] = (k >> d) % 2 == 1 ? domain.upper[d] : domain.lower[d];
            points.push_back(corner);
          }
      constexpr std::size_t enough = 2000;
      if (points.size() <= enough)
        return points;
      std::vector<Point<dim>> some;
      for (std::size_t k = 0; k < enough; ++k)
        some.push_back(points[k * (points.size() - 1) / (enough - 1)]);
      return some;
    }


    constexpr unsigned int n_motions(const unsigned int dim)
    {
      return dim * (dim + 1) / 2;
    }


    /** Components of translations and rotations at a point, in the order of their names. */
    template <int dim>
    Eigen::RowVectorXd row(const Point<dim> &p, const unsigned int component)
    {
      Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(n_motions(dim));
      row[component]         = 1.;
      // about the axis a, the displacement is e_a x p
      for (unsigned int axis = dim == 3 ? 0 : 2; dim > 1 && axis < 3; ++axis)
        {
          const unsigned int next = (axis + 1) % 3, last = (axis + 2) % 3;
          const unsigned int k = dim == 3 ? 3 + axis : 2;
          if (component == next)
            row[k] = -p[last];
          else if (component == last)
            row[k] = p[next];
        }
      return row;
    }


    /**
     * Whether some vector of the space that the columns span has the unit vector @p k in its rows
     * from @p first on.
     */
    bool spans(const Eigen::MatrixXd &columns, const unsigned int first, const unsigned int k)
    {
      if (columns.cols() == 0)
        return false;
      const Eigen::MatrixXd part = columns.bottomRows(columns.rows() - first);
      Eigen::VectorXd       unit = Eigen::VectorXd::Zero(part.rows());
      unit[k - first]            = 1.;
      const Eigen::VectorXd x    = part.completeOrthogonalDecomposition().solve(unit);
      return (part * x - unit).norm() < 1e-6;
    }
  } // namespace


  template <int dim>
  std::vector<std::string> free_rigid_motions(const Scene<dim> &scene)
  {
    const std::vector<Held>  held = held_components(scene);
    std::vector<std::string> motions;
    if (!scene.domain.has_lattice())
      {
        std::array<bool, dim> holds{};
        for (const Held &entry : held)
          holds[entry.component] = true;
        for (unsigned int c = 0; c < dim && scene.boundary_conditions.symmetry.empty(); ++c)
          if (!holds[c])
            motions.push_back(std::string("translation in ") + "xyz"[c]);
        return motions;
      }

    const Domain<dim> &domain = scene.domain;
    const double       size   = (domain.upper - domain.lower).norm();
    Eigen::MatrixXd    rows(0, n_motions(dim));
    for (const Held &entry : held)
      for (const Point<dim> &p :
           entry.condition != nullptr && (scene.boundary_conditions.part(entry.side) != nullptr ||
                                          entry.condition->held[entry.component]) ?
             held_points(scene, entry) :
             points_of_side(domain, entry.side))
        {
          rows.conservativeResize(rows.rows() + 1, Eigen::NoChange);
          // about the middle of the body and in units of its size, so that all motions are alike
          const Point<dim> relative(2. / size * (p - (domain.lower + domain.upper) / 2.));
          rows.row(rows.rows() - 1) = row(relative, entry.component);
        }
    Eigen::MatrixXd null = Eigen::MatrixXd::Identity(n_motions(dim), n_motions(dim));
    if (rows.rows() > 0)
      {
        Eigen::FullPivLU<Eigen::MatrixXd> lu(rows);
        lu.setThreshold(1e-8);
        null = lu.dimensionOfKernel() > 0 ? Eigen::MatrixXd(lu.kernel()) :
                                            Eigen::MatrixXd(n_motions(dim), 0);
      }
    for (unsigned int c = 0; c < dim; ++c)
      if (spans(null, 0, c))
        motions.push_back(std::string("translation in ") + "xyz"[c]);
    for (unsigned int k = dim; k < n_motions(dim); ++k)
      if (spans(null, dim, k))
        motions.push_back(std::string("rotation about ") + "xyz"[dim == 3 ? k - 3 : 2]);
    if (motions.empty() && null.cols() > 0)
      motions.emplace_back("a rotation about an oblique axis");
    return motions;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(free_rigid_motions);
} // namespace PeriDeal
