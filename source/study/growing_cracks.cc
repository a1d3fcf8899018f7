// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/tensor.h>

#include <perideal/output/tables.h>
#include <perideal/study/growing_cracks.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr double touching = 1e-9; // of the longest edge


    double to_segment(const Point<2> &p, const Point<2> &a, const Point<2> &b)
    {
      const Tensor<1, 2> edge = b - a;
      const double       s =
        edge.norm_square() > 0. ? std::clamp(edge * (p - a) / edge.norm_square(), 0., 1.) : 0.;
      return (p - a - s * edge).norm();
    }


    double to_line(const Point<2> &p, const GrowingCracks::Path &line)
    {
      double nearest = p.distance(line[0]);
      for (std::size_t k = 1; k < line.size(); ++k)
        nearest = std::min(nearest, to_segment(p, line[k - 1], line[k]));
      return nearest;
    }
  } // namespace


  GrowingCracks::GrowingCracks(const CrackedBox &box)
    : box(box)
  {
    for (unsigned int d = 0; d < 2; ++d)
      longest = std::max(longest, box.upper[d] - box.lower[d]);
    for (const auto &crack : box.cracks)
      lines.push_back({Point<2>(crack[0][0], crack[0][1]), Point<2>(crack[1][0], crack[1][1])});
    for (std::size_t k = 0; k < lines.size(); ++k)
      {
        first.push_back(lines[k].front());
        last.push_back(lines[k].back());
        for (const bool is_last : {false, true})
          {
            const Point<2> &p    = is_last ? lines[k].back() : lines[k].front();
            bool            free = !on_side(p);
            for (std::size_t l = 0; l < lines.size(); ++l)
              free = free && (l == k || to_line(p, lines[l]) > touching * longest);
            if (free)
              open.push_back({k, is_last});
          }
      }
  }


  bool GrowingCracks::on_side(const Point<2> &p) const
  {
    for (unsigned int d = 0; d < 2; ++d)
      if (p[d] <= box.lower[d] + touching * longest || p[d] >= box.upper[d] - touching * longest)
        return true;
    return false;
  }


  const Point<2> &GrowingCracks::place(const End &end) const
  {
    return end.is_last ? lines[end.line].back() : lines[end.line].front();
  }


  std::string GrowingCracks::name(const End &end) const
  {
    std::size_t before = 0;
    for (std::size_t k = 0; k < end.line; ++k)
      before += lines[k].size() - 1;
    return "crack " + std::to_string(before + (end.is_last ? lines[end.line].size() - 1 : 1)) +
           (end.is_last ? " end 2" : " end 1");
  }


  std::string GrowingCracks::segments() const
  {
    const auto text = [](const Point<2> &p) {
      return full_precision(p[0]) + "," + full_precision(p[1]);
    };
    std::string all;
    for (const Path &line : lines)
      for (std::size_t k = 1; k < line.size(); ++k)
        all += (all.empty() ? "" : " ; ") + text(line[k - 1]) + " ; " + text(line[k]);
    return all;
  }


  double GrowingCracks::grown() const
  {
    double length = 0.;
    for (const Path &path : paths())
      for (std::size_t k = 1; k < path.size(); ++k)
        length += path[k].distance(path[k - 1]);
    return length;
  }


  double GrowingCracks::last_stretch(const End &end) const
  {
    const Path &line = lines[end.line];
    return end.is_last ? line.back().distance(line[line.size() - 2]) : line[0].distance(line[1]);
  }


  double GrowingCracks::way_ahead(const End &end) const
  {
    const Path        &line   = lines[end.line];
    const Point<2>    &tip    = place(end);
    const Point<2>    &before = end.is_last ? line[line.size() - 2] : line[1];
    const Tensor<1, 2> far    = 4. * longest / tip.distance(before) * (tip - before);
    return free_share(tip, tip + far, end.line) * far.norm();
  }


  double GrowingCracks::room(const End &end) const
  {
    const Point<2> &tip     = place(end);
    double          nearest = 0.5 * last_stretch(end);
    for (unsigned int d = 0; d < 2; ++d)
      nearest = std::min({nearest, tip[d] - box.lower[d], box.upper[d] - tip[d]});
    for (std::size_t l = 0; l < lines.size(); ++l)
      if (l != end.line)
        nearest = std::min(nearest, to_line(tip, lines[l]));
    return nearest;
  }


  double GrowingCracks::free_share(const Point<2>   &a,
                                   const Point<2>   &b,
                                   const std::size_t own) const
  {
    double             share  = 1.;
    const double       beyond = 1. + touching; // what just comes to it touches
    const Tensor<1, 2> way    = b - a;
    for (unsigned int d = 0; d < 2; ++d)
      for (const double side : {box.lower[d], box.upper[d]})
        if (const double s = way[d] != 0. ? (side - a[d]) / way[d] : -1.;
            s > touching && s < beyond)
          share = std::min(share, s);
    for (std::size_t l = 0; l < lines.size(); ++l)
      for (std::size_t k = 1; l != own && k < lines[l].size(); ++k)
        {
          const Tensor<1, 2> edge  = lines[l][k] - lines[l][k - 1];
          const double       cross = cross_product_2d(way) * edge;
          const Tensor<1, 2> to    = lines[l][k - 1] - a;
          if (std::abs(cross) <= touching * way.norm() * edge.norm())
            { // beside each other, or on one line, where the nearer end is met
              if (std::abs(cross_product_2d(way) * to) <= touching * longest * way.norm())
                for (const Tensor<1, 2> &there : {to, to + edge})
                  if (const double s = there * way / way.norm_square(); s > touching && s < beyond)
                    share = std::min(share, s);
              continue;
            }
          const double s = (cross_product_2d(to) * edge) / cross,
                       t = (cross_product_2d(to) * way) / cross;
          if (s > touching && s < beyond && t >= 0. && t <= 1.)
            share = std::min(share, s);
        }
    return share;
  }


  void GrowingCracks::grow(const End &end, const double angle, const double length)
  {
    Path &line = lines[end.line];
    if (!end.is_last)
      std::reverse(line.begin(), line.end());
    const Point<2>     tip   = line.back();
    const Tensor<1, 2> along = (tip - line[line.size() - 2]) / tip.distance(line[line.size() - 2]);
    const bool         turns = std::abs(angle) > straight;
    const double       c = turns ? std::cos(angle) : 1., s = turns ? std::sin(angle) : 0.;
    const Tensor<1, 2> ahead({c * along[0] - s * along[1], s * along[0] + c * along[1]});
    const double       share = free_share(tip, tip + length * ahead, end.line);
    if (turns)
      line.push_back(tip);
    line.back() = tip + share * length * ahead;
    bool ends   = share < 1. || on_side(line.back());
    for (std::size_t l = 0; l < lines.size(); ++l)
      ends = ends || (l != end.line && to_line(line.back(), lines[l]) <= touching * longest);
    if (!end.is_last)
      std::reverse(line.begin(), line.end());
    const Path &grown = lines[end.line];
    open.erase(std::remove_if(open.begin(),
                              open.end(),
                              [&](const End &one) {
                                if (one.line == end.line)
                                  return ends && one.is_last == end.is_last;
                                return to_line(place(one), grown) <= touching * longest;
                              }),
               open.end());
  }


  void GrowingCracks::let_through(const End &end)
  {
    grow(End(end), 0., 4. * longest);
  }


  bool GrowingCracks::part_the_body() const
  {
    const std::size_t         n = lines.size();
    std::vector<std::size_t>  group(n);
    std::vector<unsigned int> n_sides(n, 0);
    const auto                touch = [&](const Path &one, const Path &other) {
      return std::min(to_line(one.front(), other), to_line(one.back(), other)) <=
             touching * longest;
    };
    for (std::size_t k = 0; k < n; ++k)
      {
        group[k] = k;
        for (std::size_t l = 0; l < k; ++l)
          if (touch(lines[k], lines[l]) || touch(lines[l], lines[k]))
            std::replace(group.begin(),
                         group.begin() + k + 1,
                         std::size_t(group[l]),
                         std::size_t(group[k]));
      }
    for (std::size_t k = 0; k < n; ++k)
      for (const Point<2> &p : {lines[k].front(), lines[k].back()})
        n_sides[group[k]] += on_side(p);
    return *std::max_element(n_sides.begin(), n_sides.end()) > 1;
  }


  std::vector<GrowingCracks::Path> GrowingCracks::paths() const
  {
    std::vector<Path> all;
    const auto        add = [&](const Path &line, const Point<2> &from) {
      // Where an end goes straight on, the place that it began at is no corner.
      std::size_t k = line.size() - 1;
      while (k > 0 && to_segment(from, line[k - 1], line[k]) > touching * longest)
        --k;
      Path path = {from};
      for (; k < line.size(); ++k)
        if (k > 0 && line[k].distance(path.back()) > touching * longest)
          path.push_back(line[k]);
      if (path.size() > 1)
        all.push_back(path);
    };
    for (std::size_t k = 0; k < lines.size(); ++k)
      {
        add(lines[k], last[k]);
        add(Path(lines[k].rbegin(), lines[k].rend()), first[k]);
      }
    return all;
  }


  double distance_of_paths(const std::vector<GrowingCracks::Path> &one,
                           const std::vector<GrowingCracks::Path> &other)
  {
    constexpr unsigned int n_points = 16; // of each stretch
    double                 farthest = 0.;
    for (const auto &[from, to] : {std::make_pair(&one, &other), std::make_pair(&other, &one)})
      for (const auto &path : *from)
        for (std::size_t k = 1; k < path.size(); ++k)
          for (unsigned int l = 0; l <= n_points; ++l)
            {
              const Point<2> p =
                path[k - 1] + (static_cast<double>(l) / n_points) * (path[k] - path[k - 1]);
              double nearest = std::numeric_limits<double>::max();
              for (const auto &line : *to)
                nearest = std::min(nearest, to_line(p, line));
              farthest = std::max(farthest, nearest);
            }
    return farthest;
  }
} // namespace PeriDeal
