// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "growth_lattices.h"

#include <perideal/analysis/crack_surface.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/problems/solid_problem.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/rules.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  template <int dim>
  GrowthLattices<dim>::GrowthLattices(const Scene<dim> &scene)
    : scene(scene)
    , box(cracked_box(scene))
  {
    try
      {
        refuse_deformation(*scene_variant(scene, attempt(2).settings));
      }
    catch (const UserError &)
      {
        coupled = false;
      }
  }


  template <int dim>
  unsigned int GrowthLattices<dim>::with_cracks_between_rows(const unsigned int direction,
                                                             const unsigned int n) const
  {
    constexpr unsigned int choices = 4;
    constexpr double       slack   = 1e-9;
    const double           lower = box.lower[direction], edge = box.upper[direction] - lower;
    unsigned int           best     = n;
    double                 farthest = 1.;
    for (unsigned int k = n; k < n + choices; ++k)
      {
        double from_middle = 0.; // between two rows of nodes, in cells
        for (const auto &crack : box.cracks)
          {
            const double s     = (crack[0][direction] - lower) / edge;
            const bool   along = std::all_of(crack.begin(), crack.end(), [&](const auto &corner) {
              return std::abs((corner[direction] - lower) / edge - s) < slack;
            });
            if (along)
              from_middle = std::max(from_middle, std::abs(s * k - std::floor(s * k) - 0.5));
          }
        if (from_middle < farthest - slack)
          {
            farthest = from_middle;
            best     = k;
          }
      }
    return best;
  }


  template <int dim>
  Attempt GrowthLattices<dim>::attempt(const unsigned int m) const
  {
    constexpr double share_of_step = 0.25; // of the tolerance
    Attempt          one;
    const auto       set = [&](const std::string &entry, const std::string &text) {
      one.settings.emplace_back(entry, text);
    };
    CellCounts cells;
    for (unsigned int d = 0; d < dim; ++d)
      cells.push_back(with_cracks_between_rows(
        d,
        std::max(2l, std::lround(m * (box.upper[d] - box.lower[d]) / scene.peridynamics.horizon))));
    one.fineness = m;
    set("Domain/Node spacing", "");
    set("Domain/Cells", to_text(cells));
    set("Domain/Coarsening", "0");
    set("Domain/Nodes", "vertices"); // rows between which cracks lie
    if (coupled)
      {
        one.model = ModelKind::coupled;
        set("Coupling/Zone", "follow");
        set("Coupling/Scheme", "exchange");
        set("Coupling/Overlap", "0");
        set("Coupling/Certificate", "false");
      }
    else
      one.model = ModelKind::peridynamics;
    set("Time/Time step",
        number_text(share_of_step * scene.accuracy.tolerance * scene.time.end_time));
    set("Models", to_string(one.model));
    return one;
  }


  template <int dim>
  Attempt GrowthLattices<dim>::at(const unsigned int m) const
  {
    return attempt(m);
  }


  template <int dim>
  std::vector<std::array<double, 3>> points_of_new_cracks(const Problem<dim> &problem)
  {
    constexpr double                   parted = 0.3; // of a node's family; beside a plane 0.4
    std::vector<std::array<double, 3>> points;
    const auto *const                  solid = dynamic_cast<const SolidProblem<dim> *>(&problem);
    if (solid == nullptr || solid->body.families() == nullptr)
      return points;
    if constexpr (dim > 1)
      for (const CrackFacet<dim> &facet : CrackSurface<dim>(*solid->body.families())
                                            .facets(solid->body.breaks(), solid->body.damage()))
        if (facet.damage > parted)
          {
            points.push_back({{0., 0., 0.}});
            for (unsigned int d = 0; d < dim; ++d)
              points.back()[d] = 0.5 * (facet.lower[d] + facet.upper[d]);
          }
    return points;
  }


  double distance_of_points(const std::vector<std::array<double, 3>> &one,
                            const std::vector<std::array<double, 3>> &other)
  {
    double farthest = 0.;
    for (const auto &[from, to] : {std::make_pair(&one, &other), std::make_pair(&other, &one)})
      for (const auto &p : *from)
        {
          double nearest = std::numeric_limits<double>::max();
          for (const auto &q : *to)
            nearest = std::min(nearest,
                               std::pow(p[0] - q[0], 2) + std::pow(p[1] - q[1], 2) +
                                 std::pow(p[2] - q[2], 2));
          farthest = std::max(farthest, nearest);
        }
    return std::sqrt(farthest);
  }


  PERIDEAL_INSTANTIATE_CLASS(class GrowthLattices);
  PERIDEAL_INSTANTIATE_FUNCTION(points_of_new_cracks);
} // namespace PeriDeal
