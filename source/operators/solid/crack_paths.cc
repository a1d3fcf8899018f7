// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/crack_paths.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    // In horizons: what the tension is a mean over, how far ahead of a tip bonds may break, and up
    // to where beside its way not.
    constexpr double about = 1.5, ahead = 2., aside = 2.;


    double cross(const Tensor<1, 2> &a, const Tensor<1, 2> &b)
    {
      return a[0] * b[1] - a[1] * b[0];
    }


    /**
     * Where the line from a to b meets the one from p to q, as a part of the latter; or -1. What
     * lies on the latter is on its left.
     */
    double part_at_crossing(const Point<2> &a,
                            const Point<2> &b,
                            const Point<2> &p,
                            const Point<2> &q)
    {
      constexpr double   round_off = 1e-10;
      const Tensor<1, 2> bond = b - a, way = q - p;
      const double       least = -round_off * way.norm() * bond.norm();
      if ((cross(way, a - p) > least) == (cross(way, b - p) > least))
        return -1.;
      const double of_way = cross(a - p, bond) / cross(way, bond);
      return of_way > -round_off && of_way < 1. + round_off ? std::max(of_way, 0.) : -1.;
    }


    double distance_to(const Point<2> &x, const Point<2> &p, const Point<2> &q)
    {
      const Tensor<1, 2> way  = q - p;
      const double       part = std::clamp((x - p) * way / way.norm_square(), 0., 1.);
      return x.distance(p + part * way);
    }
  } // namespace


  template <int dim>
  CrackPaths<dim>::CrackPaths(const std::vector<std::vector<Point<dim>>> &cracks,
                              const double                                horizon)
    : horizon(horizon)
  {
    if constexpr (dim == 2)
      {
        // Ends at which a further crack goes on are none.
        const auto is_free = [&](const Point<2> &end, const std::size_t of) {
          for (std::size_t k = 0; k < cracks.size(); ++k)
            if (k != of && distance_to(end, cracks[k][0], cracks[k][1]) < 1e-6 * horizon)
              return false;
          return true;
        };
        for (std::size_t k = 0; k < cracks.size(); ++k)
          for (const unsigned int end : {0, 1})
            if (const Tensor<1, 2> way = cracks[k][end] - cracks[k][1 - end];
                way.norm() > 0. && is_free(cracks[k][end], k))
              ways.push_back({{cracks[k][end]}, way / way.norm(), {}});
      }
  }


  template <int dim>
  double CrackPaths<dim>::reach() const
  {
    return about * horizon;
  }


  template <int dim>
  std::vector<Tensor<1, dim>> CrackPaths<dim>::directions() const
  {
    std::vector<Tensor<1, dim>> list;
    for (const Way &way : ways)
      list.push_back(way.direction);
    return list;
  }


  template <int dim>
  bool CrackPaths<dim>::any_tip_near(const Point<dim> &place, const double distance) const
  {
    return std::any_of(ways.begin(), ways.end(), [&](const Way &way) {
      return (place - way.points.back()).norm_square() < distance * distance;
    });
  }


  template <int dim>
  void CrackPaths<dim>::begin()
  {
    for (Way &way : ways)
      way.tension = 0.;
  }


  template <int dim>
  void CrackPaths<dim>::add(const Point<dim> &middle, const Tensor<1, dim> &xi, const double moment)
  {
    for (Way &way : ways)
      {
        const double part = (middle - way.points.back()).norm_square() / (reach() * reach());
        if (part < 1.)
          way.tension += (1. - part) * (1. - part) * moment / xi.norm_square() *
                         symmetrize(outer_product(xi, xi));
      }
  }


  template <int dim>
  void CrackPaths<dim>::turn(const MPI_Comm communicator)
  {
    if constexpr (dim == 2)
      for (Way &way : ways)
        {
          const auto sum = Utilities::MPI::sum(way.tension, communicator);
          if (!(sum.norm() > 0.))
            continue;
          const double       half = 0.5 * std::atan2(2. * sum[0][1], sum[0][0] - sum[1][1]);
          const Tensor<1, 2> across({-std::sin(half), std::cos(half)});
          way.direction = across * way.direction < 0. ? -across : across;
        }
    else
      (void)communicator;
  }


  template <int dim>
  bool CrackPaths<dim>::may_break(const Ends &ends) const
  {
    if constexpr (dim == 2)
      {
        const Point<2> middle  = ends.first + 0.5 * (ends.second - ends.first);
        bool           is_near = false;
        for (const Way &way : ways)
          for (std::size_t k = 0; k < way.points.size(); ++k)
            {
              const Point<2> &p        = way.points[k];
              const Point<2>  q        = k + 1 < way.points.size() ? way.points[k + 1] :
                                                                     p + ahead * horizon * way.direction;
              const double    distance = distance_to(middle, p, q);
              if (distance < horizon && part_at_crossing(ends.first, ends.second, p, q) >= 0.)
                return true;
              is_near = is_near || distance < aside * horizon;
            }
        return !is_near;
      }
    (void)ends;
    return true;
  }


  template <int dim>
  void CrackPaths<dim>::advance(const std::vector<Ends> &breaking, const MPI_Comm communicator)
  {
    if constexpr (dim == 2)
      for (Way &way : ways)
        {
          const Point<2> p = way.points.back(), q = p + ahead * horizon * way.direction;
          double         most = 0.;
          for (const Ends &ends : breaking)
            most = std::max(most, part_at_crossing(ends.first, ends.second, p, q));
          most = Utilities::MPI::max(most, communicator);
          if (most > 1e-6)
            way.points.push_back(p + most * (q - p));
        }
    else
      {
        (void)breaking;
        (void)communicator;
      }
  }


  template <int dim>
  void CrackPaths<dim>::exchange(Archive &archive)
  {
    const Archive::Part part(archive, "paths");
    for (std::size_t k = 0; k < ways.size(); ++k)
      {
        std::vector<double> values;
        for (const Point<dim> &p : ways[k].points)
          values.insert(values.end(), p.begin_raw(), p.end_raw());
        values.insert(values.end(), ways[k].direction.begin_raw(), ways[k].direction.end_raw());
        archive.exchange(std::to_string(k), values);
        ways[k].points.clear();
        for (std::size_t v = 0; v + dim < values.size(); v += dim)
          {
            ways[k].points.emplace_back();
            std::copy_n(values.begin() + v, dim, ways[k].points.back().begin_raw());
          }
        std::copy_n(values.end() - dim, dim, ways[k].direction.begin_raw());
      }
  }


  template <int dim>
  std::size_t CrackPaths<dim>::memory_consumption() const
  {
    std::size_t bytes = ways.capacity() * sizeof(Way);
    for (const Way &way : ways)
      bytes += way.points.capacity() * sizeof(Point<dim>);
    return bytes;
  }


  PERIDEAL_INSTANTIATE_CLASS(class CrackPaths);
} // namespace PeriDeal
