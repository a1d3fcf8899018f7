// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "body_of_choice.h"

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/fitted_plate.h>
#include <perideal/study/cracked_box.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** A polygon whose edges run along the axes. */
    bool is_upright(const Hole &hole)
    {
      const std::size_t n = hole.corners.size();
      for (std::size_t k = 0; k < n; ++k)
        {
          const Point<2> &a = hole.corners[k], &b = hole.corners[(k + 1) % n];
          if (std::min(std::abs(a[0] - b[0]), std::abs(a[1] - b[1])) > 1e-9 * a.distance(b))
            return false;
        }
      return n > 0;
    }


    /** What should lie on lines of the lattice: corners of upright holes, cracks along the axes. */
    template <int dim>
    CrackedBox wanted_on_lines(const Scene<dim> &scene)
    {
      CrackedBox box = cracked_box(scene);
      if (!along_axes(box))
        box.cracks.clear();
      for (const Hole &hole : scene.domain.holes.all())
        if (is_upright(hole))
          {
            box.cracks.emplace_back();
            for (const Point<2> &corner : hole.corners)
              {
                box.cracks.back().push_back({corner[0], corner[1]});
                if (dim == 3)
                  box.cracks.back().back().push_back(box.lower[2]);
              }
          }
      return box;
    }


    /** The number of lines nearest to the wanted one that has all planes, if there is one near. */
    unsigned int fitting_count(const CrackedBox &box, const unsigned int d, const unsigned int n)
    {
      for (unsigned int k = n; k <= 2 * n + 4; ++k)
        if (corners_on_planes(box, d, k))
          return k;
      return n;
    }


    /** Why no mesh can be made of a lattice that follows all rims, or nothing. */
    template <int dim>
    std::string obstacle_to_rims(const Domain<dim> &domain, const CellCounts &cells)
    {
      try
        {
          fitted_plate({domain.lower[0], domain.lower[1]},
                       {domain.upper[0], domain.upper[1]},
                       {{cells[0], cells[1]}},
                       domain.holes.all(),
                       domain.where("Rims"));
          return "";
        }
      catch (const UserError &error)
        {
          return error.message();
        }
    }


    /** Cells of the coarsest lattice from which a mesh can be made that follows all rims. */
    template <int dim>
    CellCounts cells_of_fitted_plate(const Scene<dim> &scene)
    {
      const Domain<dim>   &domain  = scene.domain;
      const CrackedBox     wanted  = wanted_on_lines(scene);
      const Tensor<1, dim> edges   = domain.upper - domain.lower;
      const double         longest = *std::max_element(edges.begin_raw(), edges.end_raw());
      // Cells are at most about twice as long as wide.
      const unsigned int n_least = std::ceil(longest / std::min(edges[0], edges[1])),
                         first = std::max(3u, n_least), step = std::max(1u, first / 16),
                         n_tries = 64;
      std::string reason;
      for (unsigned int n = first; n < first + n_tries * step; n += step)
        {
          CellCounts cells;
          for (unsigned int d = 0; d < dim; ++d)
            cells.push_back(
              fitting_count(wanted, d, std::max(2l, std::lround(n * edges[d] / longest))));
          reason = obstacle_to_rims(domain, cells);
          if (reason.empty())
            return cells;
        }
      reason = reason.substr(0, reason.find(" Choose more"));
      domain.refuse(
        true,
        "Holes",
        "cannot be followed by the cells of a mesh, which 'Models = auto' needs: holes with round or "
        "oblique rims have to lie apart from each other and from the sides (" +
          reason + ").");
      return {};
    }


    template <int dim>
    std::vector<Setting> settings_of_body(const Scene<dim> &scene)
    {
      if constexpr (dim > 1)
        if (scene.domain.shape == Shape::plate_with_hole)
          return {{"Domain/Node spacing", ""},
                  {"Domain/Cells", to_text(cells_of_fitted_plate(scene))},
                  {"Domain/Rims", "fitted"}};
      return {};
    }
  } // namespace


  template <int dim>
  BodyOfChoice<dim>::BodyOfChoice(const Scene<dim> &original, const MPI_Comm communicator)
    : settings(settings_of_body(original))
  {
    std::vector<Setting> once = settings;
    for (const auto &[entry, text] : {Setting("Domain/Refinements", "0"),
                                      Setting("Domain/Coarsening", "0"),
                                      Setting("Domain/Fine where", "auto")})
      once.emplace_back(entry, text);
    scene = scene_variant(original, once);
    if (scene->domain.has_lattice())
      {
        sides = sides_of_box(*scene);
        return;
      }
    given = std::make_unique<GivenBody<dim>>(*scene, communicator);
    sides = given->sides;
    std::tie(scene->domain.lower, scene->domain.upper) = given->box.get_boundary_points();
    AssertThrow(
      !scene->deforms || scene->cracks.cracks.empty() || given->cracks_on_faces,
      UserError(
        "Entry 'Models': 'auto' does not choose for cracks across cells of elastic bodies other than a box "
        "('Shape' and 'Holes' in section 'Domain'). Name models instead: finite elements, "
        "peridynamics, coupled."));
  }


  template <int dim>
  std::pair<CellCounts, double> BodyOfChoice<dim>::finer_plate(const double times) const
  {
    constexpr double   rounding = 0.25, more = 1.03;
    constexpr unsigned most   = 100;
    const auto        &coarse = scene->domain.cells;
    CellCounts         cells(dim);
    double             least = 1.;
    double             now   = times;
    for (unsigned int k = 0; k < most; ++k, now *= more)
      {
        least = std::numeric_limits<double>::max();
        for (unsigned int d = 0; d < dim; ++d)
          {
            cells[d] = std::max<unsigned int>(coarse[d], std::ceil(coarse[d] * now - rounding));
            least    = std::min(least, static_cast<double>(cells[d]) / coarse[d]);
          }
        if constexpr (dim > 1)
          if (obstacle_to_rims(scene->domain, cells).empty())
            break;
      }
    return {cells, least};
  }


  template struct BodyOfChoice<1>;
  template struct BodyOfChoice<2>;
  template struct BodyOfChoice<3>;
} // namespace PeriDeal
