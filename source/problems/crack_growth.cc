// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/problems/solid_problem.h>

#include <algorithm>

#include "solid_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Nodes beside a straight crack have lost more than that. */
    constexpr double damaged = 0.35;

    /** Round-off of distances of one horizon. */
    constexpr double slack = 1. + 1e-6;


    /**
     * The open ends of the scene's cracks at t (3D: the open edges of each crack), and where the
     * first bond broke if that is farther from all of them than the reach.
     */
    template <int dim>
    std::vector<CrackFront<dim>> fronts_at(const SolidProblem<dim> &solid,
                                           const double             t,
                                           const double             reach)
    {
      std::vector<CrackFront<dim>> fronts;
      const auto                   pieces = solid.scene.cracks.pieces(t, false);
      for (std::size_t k = 0; k < pieces.size(); ++k)
        {
          const CrackPiece<dim> &piece = pieces[k];
          const std::string      name  = "crack " + std::to_string(piece.crack + 1);
          if constexpr (dim == 2)
            {
              const auto is_other = [&](const std::size_t l) {
                return l >= pieces.size() || pieces[l].crack != piece.crack;
              };
              for (unsigned int end = 0; end < 2; ++end)
                if (is_other(end == 0 ? k - 1 : k + 1) && !piece.closed[end])
                  fronts.push_back({name + " end " + std::to_string(end + 1),
                                    {{piece.corners[end], piece.corners[end]}}});
            }
          else
            {
              if (fronts.empty() || fronts.back().name != name)
                fronts.push_back({name, {}});
              const std::size_t n = piece.corners.size();
              for (std::size_t i = 0; i < n; ++i)
                if (!piece.closed[i])
                  fronts.back().edges.push_back({piece.corners[i], piece.corners[(i + 1) % n]});
              if (fronts.back().edges.empty())
                fronts.pop_back();
            }
        }
      const std::vector<double> &first = solid.op().break_places().first;
      if (first.size() != dim)
        return fronts;
      Point<dim> place;
      for (unsigned int d = 0; d < dim; ++d)
        place[d] = first[d];
      if (std::all_of(fronts.begin(), fronts.end(), [&](const CrackFront<dim> &front) {
            return front.distance(place) > reach;
          }))
        fronts.push_back({"the first broken bond", {{place, place}}});
      return fronts;
    }
  } // namespace


  template <int dim>
  void CrackGrowth<dim>::look_at(const SolidProblem<dim> &solid)
  {
    const unsigned long long n = solid.op().n_broken_bonds();
    if (n == 0 || solid.body.families() == nullptr ||
        (n == n_broken && !solid.op().has_growing_cracks()))
      return;
    if (!surface)
      surface = std::make_unique<CrackSurface<dim>>(*solid.body.families());
    n_broken                            = n;
    const std::vector<BondBreak> breaks = solid.body.breaks();
    const std::vector<double>    damage = solid.body.damage();
    area                                = surface->area(breaks);
    damaged_volume                      = surface->damaged_volume(breaks, damage, damaged);
    facets                              = surface->facets(breaks, damage);
  }


  template <int dim>
  void CrackGrowth<dim>::add_totals(const SolidProblem<dim> &solid,
                                    const double             t,
                                    const RunContext        &context)
  {
    if (dim == 1 || !solid.op().brittle())
      return;
    look_at(solid);
    nlohmann::ordered_json &summary = context.record.balances[solid.name()]["new cracks"];
    const std::string       measure = dim == 2 ? "length" : "area";
    context.record.add_row(solid.name(), "crack " + measure, area, t);
    context.record.add_row(solid.name(), "damaged volume", damaged_volume, t);
    summary = {{measure, area}, {"damaged volume", damaged_volume}};
    if constexpr (dim > 1)
      if (!facets.empty())
        add_tips(solid, t, context, summary);
  }


  template <int dim>
  void CrackGrowth<dim>::add_tips(const SolidProblem<dim> &solid,
                                  const double             t,
                                  const RunContext        &context,
                                  nlohmann::ordered_json  &summary) const
  {
    const double reach    = slack * solid.body.families()->weights().horizon();
    const auto   fronts   = fronts_at(solid, t, reach);
    const auto   advances = find_advances(facets, fronts, reach, t);
    unsigned int n_tips   = 0;
    for (const CrackAdvance<dim> &advance : advances)
      n_tips += advance.n_tips;
    if (dim == 2)
      context.record.add_row(solid.name(), "number of tips", n_tips, t);
    for (std::size_t k = 0; k < fronts.size(); ++k)
      {
        const CrackAdvance<dim> &advance = advances[k];
        if (advance.n_tips == 0)
          continue;
        nlohmann::ordered_json &entry = summary["tips"][fronts[k].name];
        const auto              add   = [&](const std::string &quantity, const double value) {
          context.record.add_row(solid.name(), quantity + " at " + fronts[k].name, value, t);
        };
        for (unsigned int d = 0; d < dim; ++d)
          {
            add(std::string("tip ") + "xyz"[d], advance.tip[d]);
            entry["place"].push_back(advance.tip[d]);
          }
        add("crack length", advance.length);
        entry["length"] = advance.length;
        if (solid.stepper)
          {
            add("tip speed", advance.speed);
            entry["speed"] = advance.speed;
          }
      }
    if (dim == 2)
      summary["number of tips"] = n_tips;
  }


  template <int dim>
  NewCracks CrackGrowth<dim>::surfaces(const SolidProblem<dim> &solid)
  {
    NewCracks list;
    if (dim == 1)
      return list;
    look_at(solid);
    for (const CrackFacet<dim> &facet : facets)
      {
        list.pieces.emplace_back();
        for (const Point<dim> &corner : facet.corners())
          {
            list.pieces.back().push_back({{0., 0., 0.}});
            for (unsigned int d = 0; d < dim; ++d)
              list.pieces.back().back()[d] = corner[d];
          }
        list.numbers["broken_since"].push_back(facet.time);
        list.numbers["damage"].push_back(facet.damage);
      }
    return list;
  }


  PERIDEAL_INSTANTIATE_CLASS(class CrackGrowth);
} // namespace PeriDeal
