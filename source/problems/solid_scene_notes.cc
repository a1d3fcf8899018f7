// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "solid_scene_notes.h"

#include <perideal/laws/elasticity.h>
#include <perideal/scene/beyond_sides.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    bool breaks(const Scene<dim> &scene)
    {
      return scene.material.fracture_energy || scene.material.critical_stretch;
    }


    /**
     * Of the end of a crack along an axis: how much farther than it the cells go that it takes
     * away, in cells. A cell goes from its middle on.
     */
    double beyond_tip(const double place, const bool upwards)
    {
      const double part = place - std::floor(place), here = upwards ? part : 1. - part;
      return here < 0.5 ? -here : 1. - here;
    }


    /** What of a crack along an axis is in a box. */
    struct CrackAlongAxis
    {
      unsigned int        axis;
      double              length, ligament; // what of its line is crack, and what is whole
      double              arm;              // up to the nearest side that it runs along
      std::vector<double> beyond;           // beyond_tip() of its ends in the body
    };


    /** Nothing where a crack lies across the cells: there it is a staircase. */
    std::optional<CrackAlongAxis> along_axis(const Scene<2>              &scene,
                                             const std::vector<Point<2>> &crack)
    {
      const Tensor<1, 2> h     = scene.domain.spacing();
      const Point<2>     lower = scene.domain.lower, upper = scene.domain.upper;
      const Point<2>    &a = crack[0], &b = crack[1];
      const unsigned int axis   = std::abs(b[0] - a[0]) > std::abs(b[1] - a[1]) ? 0 : 1,
                         across = 1 - axis;
      if (std::abs(b[across] - a[across]) > 1e-9 * h[across])
        return {};
      const double from = std::max(lower[axis], std::min(a[axis], b[axis])),
                   to   = std::min(upper[axis], std::max(a[axis], b[axis]));
      CrackAlongAxis found{axis,
                           to - from,
                           upper[axis] - lower[axis] - (to - from),
                           std::min(a[across] - lower[across], upper[across] - a[across]),
                           {}};
      for (const bool upwards : {false, true})
        {
          const double tip = upwards ? to : from;
          if (tip > lower[axis] + 1e-9 * h[axis] && tip < upper[axis] - 1e-9 * h[axis])
            found.beyond.push_back(
              beyond_tip((tip - lower[axis]) / h[axis] + (upwards ? 1e-9 : -1e-9), upwards));
        }
      return found;
    }


    /** A crack is twice as long as the arms beside it are high, for each of its ends. */
    bool is_slender(const CrackAlongAxis &crack)
    {
      return crack.beyond.size() > 0 && crack.arm > 0. &&
             crack.length > 2. * crack.arm * crack.beyond.size();
    }
  } // namespace


  template <int dim>
  void note_locking(const Scene<dim> &scene, const double poisson, std::vector<std::string> &notes)
  {
    constexpr double hardly_changes = 0.45, tolerable = 1.1;
    const bool       elements =
      (runs(scene, ModelKind::finite_elements) && scene.finite_elements.degree == 1) ||
      runs(scene, ModelKind::coupled);
    const bool plane_strain = dim == 3 || scene.elasticity.plane == PlaneState::strain;
    if (dim == 1 || !elements || !plane_strain || scene.domain.shape != Shape::box ||
        poisson < hardly_changes)
      return;
    const Tensor<1, dim> h    = scene.domain.spacing();
    unsigned int         thin = 0, slender = 0;
    for (unsigned int d = 1; d < dim; ++d)
      {
        const auto extent = [&](const unsigned int e) {
          return scene.domain.upper[e] - scene.domain.lower[e];
        };
        thin    = extent(d) < extent(thin) ? d : thin;
        slender = extent(d) > extent(slender) ? d : slender;
      }
    if (thin == slender)
      slender = (thin + 1) % dim;
    // A rectangle a x b bent along a, of the displacement (x y, 0): over the exact energy; of n of
    // them over the height 1/n^2 is bending of cells.
    const double nu = poisson / (1. - poisson), aspect = h[slender] / h[thin];
    const double one_cell = (1. / (1. - nu) + 0.5 * aspect * aspect) / (1. + nu);
    const double n        = scene.domain.cells[thin];
    const double stiffer  = 1. + (one_cell - 1.) / (n * n);
    if (stiffer < tolerable)
      return;
    notes.push_back(
      "elements of degree 1 cannot bend without changing their volume, and with a Poisson ratio of " +
      number_text(poisson) + " that takes almost any force: " + rounded_text(n) +
      " cells across make the body up to " + rounded_text(stiffer) +
      " times too stiff in bending. 'Degree = 2' in section 'Finite elements' does not lock.");
  }


  template <int dim>
  void note_tips_in_cells(const Scene<dim> &scene, std::vector<std::string> &notes)
  {
    constexpr double tolerable = 0.1; // of a cell
    if constexpr (dim == 2)
      {
        const auto &cracks = scene.cracks;
        if (!runs(scene, ModelKind::finite_elements) || cracks.mesh != CrackMesh::removed ||
            scene.domain.shape != Shape::box || !cracks.tips.empty() ||
            scene.cuts_in_part_at_tips())
          return;
        for (unsigned int k = 0; k < cracks.cracks.size(); ++k)
          {
            const auto crack = along_axis(scene, cracks.cracks[k]);
            if (!crack || is_slender(*crack))
              continue;
            const double h      = scene.domain.spacing()[crack->axis];
            double       gained = 0., most = 0.;
            for (const double beyond : crack->beyond)
              {
                gained += beyond;
                most = std::max(most, std::abs(beyond));
              }
            if (most < tolerable)
              continue;
            // K goes with the root of the length over that of the ligament (Feddersen's centre
            // crack), where the crack comes from a side with its third power: the ligament bends.
            const double of_ligament = crack->beyond.size() == 1 ? 1.5 : 0.5;
            const double share = gained * h * (0.5 / crack->length + of_ligament / crack->ligament);
            notes.push_back(
              "crack " + std::to_string(k + 1) + " (section 'Cracks') ends " + rounded_text(most) +
              " of a cell from the cells that it takes away ('Mesh = removed'): to finite elements it is " +
              rounded_text(std::abs(gained) * h) + (gained > 0. ? " longer" : " shorter") +
              " in all, which makes stress intensities " + rounded_text(100. * std::abs(share)) +
              " % or more too " + (gained > 0. ? "large" : "small") +
              ". 'Cells' in section 'Domain' with which its ends lie on edges of cells, or 'Mesh = faces', make up for it.");
          }
      }
  }


  template <int dim>
  void note_slender_cracks(const Scene<dim> &scene, std::vector<std::string> &notes)
  {
    if constexpr (dim == 2)
      {
        const auto &cracks  = scene.cracks;
        const bool  removed = cracks.mesh == CrackMesh::removed,
                   bonds    = runs(scene, ModelKind::peridynamics);
        if (scene.domain.shape != Shape::box || !cracks.tips.empty() ||
            !scene.elasticity.is_static() || breaks(scene) || !(removed || bonds))
          return;
        for (unsigned int k = 0; k < cracks.cracks.size(); ++k)
          {
            const auto crack = along_axis(scene, cracks.cracks[k]);
            if (!crack || !is_slender(*crack))
              continue;
            // Measured (doc/fracture.md), over the heights of arms.
            const Tensor<1, 2> h     = scene.domain.spacing();
            const double       along = h[crack->axis] / crack->arm,
                         cell        = h[1 - crack->axis] / crack->arm,
                         m           = scene.horizon() / h[1 - crack->axis];
            std::vector<std::string> parts;
            const auto add = [&](const ModelKind kind, const double first, const double second) {
              const auto size = [](const double share) {
                return rounded_text(100. * std::abs(share)) + " % too " +
                       (share > 0. ? "large" : "small");
              };
              if (runs(scene, kind))
                parts.push_back("K_I " + size(first) + " and K_II " + size(second) + " (" +
                                to_string(kind) + ")");
            };
            if (removed && !scene.cuts_in_part_at_tips())
              {
                double first = 0., second = 0.;
                for (const double beyond : crack->beyond)
                  if (const double found = 0.63 * cell + 2.1 * beyond * along;
                      first == 0. || std::abs(found) > std::abs(first))
                    {
                      first  = found;
                      second = 2.7 * cell + 0.9 * beyond * along;
                    }
                add(ModelKind::finite_elements, first, second);
              }
            if (removed)
              add(ModelKind::coupled, 0.09 * m * cell, 0.5 * m * cell);
            if (bonds)
              parts.push_back("K_I up to " + rounded_text(100. * (removed ? 0.25 : 0.5) * cell) +
                              " % off and K_II " + rounded_text(60. * cell) +
                              " % too small (peridynamics)");
            if (parts.empty())
              continue;
            notes.push_back(
              "crack " + std::to_string(k + 1) + " (section 'Cracks') parts slender arms" +
              (removed ? ", which the cells that it takes away ('Mesh = removed') make thinner" :
                         "") +
              ". By what double cantilevers and end-notched beams have shown, expect " +
              join_names(parts) + "." +
              (removed ?
                 " To elements twice as many cells halve that; on faces ('Mesh = faces') they are off by some tenths of a percent." :
                 ""));
          }
      }
  }


  template <int dim>
  void note_loaded_holes(const Scene<dim> &scene, std::vector<std::string> &notes)
  {
    const auto &conditions = scene.boundary_conditions;
    if (dim == 1 || !scene.domain.has_lattice() ||
        std::none_of(conditions.traction.begin(),
                     conditions.traction.end(),
                     [&](const VectorCondition &condition) {
                       return conditions.side_of(condition.id) == hole_boundary_id;
                     }))
      return;
    // The radius of the circle of the same area, of holes that are about as long as wide and have
    // a side that is not along the cells.
    const Holes<dim> &holes  = scene.domain.holes;
    double            radius = std::numeric_limits<double>::max();
    if (holes.has_one &&
        (holes.shape == HoleShape::circle || std::abs(std::remainder(holes.angle, 90.)) > 1e-9))
      radius = holes.radius;
    for (const Hole &hole : holes.listed)
      if (const auto [low, high] = hole.box();
          !hole.text.empty() && hole.area() > 0.3 * low.distance_square(high) / 2. &&
          hole.area() < (1. - 1e-9) * (high[0] - low[0]) * (high[1] - low[1]))
        radius = std::min(radius, std::sqrt(hole.area() / numbers::PI));
    const Tensor<1, dim> h     = scene.domain.spacing();
    const double         cells = radius / std::max(h[0], h[std::min(1, dim - 1)]);
    // Measured (doc/parts.md).
    std::vector<std::string> parts;
    const auto               add = [&](const ModelKind kind, const double share) {
      if (runs(scene, kind) && share >= 0.05 * cells)
        parts.push_back(rounded_text(100. * share / cells) + " % (" + to_string(kind) + ")");
    };
    add(ModelKind::finite_elements, 0.6);
    add(ModelKind::coupled, 0.6);
    add(ModelKind::peridynamics, 1.5);
    if (!parts.empty())
      notes.push_back(
        "A hole with a load on its rim has " + rounded_text(cells) +
        " cells to its radius, and stairs of cells in place of the rim. What acts there is that of the true rim, but circular bores under pressure were found up to " +
        join_names(parts) +
        " too wide at their rims. Twice as many cells halve that; on a mesh from a file faces can lie on the rim.");
  }


  template <int dim>
  void note_slow_oblique_cracks(const Scene<dim> &scene, std::vector<std::string> &notes)
  {
    constexpr double from = 3., to = 42.; // degrees
    if constexpr (dim == 2)
      {
        if (!breaks(scene) || !scene.elasticity.is_static() ||
            scene.elasticity.breaks_in_motion() || !scene.domain.has_lattice())
          return;
        for (unsigned int k = 0; k < scene.cracks.cracks.size(); ++k)
          {
            const Tensor<1, 2> way   = scene.cracks.cracks[k][1] - scene.cracks.cracks[k][0];
            const double       angle = std::atan2(std::min(std::abs(way[0]), std::abs(way[1])),
                                            std::max(std::abs(way[0]), std::abs(way[1]))) *
                                 180. / numbers::PI;
            if (angle > from && angle < to)
              notes.push_back(
                "crack " + std::to_string(k + 1) + " (section 'Cracks') lies at " +
                rounded_text(angle) +
                " degrees to the rows of nodes. In slow loading bonds break in groups where bodies are at rest, and it turns into the rows, where fewest are in its way. "
                "With 'Breaking = in motion' in section 'Elasticity' it hardly does, with 'Solver = dynamics' it does not, nor where the lattice lies along it.");
          }
      }
  }


  template <int dim>
  std::string note_on_few_bonds(const Scene<dim>                     &scene,
                                const std::vector<FamilyMember<dim>> &family)
  {
    constexpr double tolerable = 0.02, tolerable_shear = 0.05;
    if (dim == 1 || family.empty() || !scene.material.uniform_moduli())
      return {};
    const Tensor<1, dim> h = scene.domain.spacing();
    const Moduli         moduli =
      scene.material.moduli(scene.domain.lower + 0.5 * (scene.domain.upper - scene.domain.lower));
    const StateLaw law = scene.elasticity.is_bond_based() ?
                           bond_law(moduli, dim, scene.elasticity.plane) :
                           state_law(moduli, dim, scene.elasticity.plane);
    // Means of n_a^2 n_b^2 over bonds in all directions, and over the family.
    double         all = 0.;
    Tensor<2, dim> even, found;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = 0; b < dim; ++b)
        even[a][b] = (a == b ? 3. : 1.) / (dim * (dim + 2.));
    for (const FamilyMember<dim> &member : family)
      {
        Tensor<1, dim> squares; // of the direction, times the length
        for (unsigned int d = 0; d < dim; ++d)
          squares[d] = std::pow(member.offset[d] * h[d], 2) / member.r;
        found += member.weight * outer_product(squares, squares);
        all += member.weight * member.r * member.r;
      }
    found /= all;
    const auto compliance = [&](const Tensor<2, dim> &means) {
      Tensor<2, dim> stiffness = law.extension * means;
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = 0; b < dim; ++b)
          stiffness[a][b] += law.volumetric / dim;
      return invert(stiffness);
    };
    const Tensor<2, dim> of_family = compliance(found), of_body = compliance(even);
    double               g = 1., young = 1.;
    unsigned int         first = 0, second = 1, axis = 0;
    for (unsigned int a = 0; a < dim; ++a)
      {
        if (const double E = of_body[a][a] / of_family[a][a];
            std::abs(E - 1.) > std::abs(young - 1.) + 1e-9)
          {
            young = E;
            axis  = a;
          }
        for (unsigned int b = a + 1; b < dim; ++b)
          if (const double G = found[a][b] / even[a][b]; std::abs(G - 1.) > std::abs(g - 1.) + 1e-9)
            {
              g      = G;
              first  = a;
              second = b;
            }
      }
    if (std::abs(g - 1.) < tolerable_shear && std::abs(young - 1.) < tolerable)
      return {};
    const double shortest = *std::min_element(h.begin_raw(), h.end_raw()),
                 longest  = *std::max_element(h.begin_raw(), h.end_raw());
    const bool oblong     = longest > (1. + 1e-6) * shortest;
    return "families of m = " + rounded_text(scene.horizon() / shortest) +
           (oblong ? ", but " + rounded_text(scene.horizon() / longest) +
                       " along the long edges of cells," :
                     "") +
           " with this kernel have a shear modulus of " + rounded_text(g) +
           " times that of 'Material' in the plane of " + "xyz"[first] + " and " + "xyz"[second] +
           ", and a body pulled along " + "xyz"[axis] + " is " + rounded_text(young) +
           " times as stiff as it should be. " +
           (oblong ? "Cells as long as wide ('Cells' in section 'Domain'), or" :
                     "'Kernel exponent = 0' in section 'Peridynamics' and") +
           " a larger 'Horizon ratio' bring both near 1.";
  }


  template <int dim>
  std::string note_on_bending(const Scene<dim> &scene)
  {
    constexpr double tolerable = 0.05, slender = 3.;
    if (dim == 1 || !scene.domain.has_lattice())
      return {};
    const auto           beyond = beyond_sides(scene);
    const Tensor<1, dim> h = scene.domain.spacing(), size = whole_extent(scene);
    const double         longest = *std::max_element(size.begin_raw(), size.end_raw());
    double               bent = 0., twisted = 0.;
    unsigned int         thin = 0;
    for (unsigned int d = 0; d < dim; ++d)
      {
        // Of sides of which one is loaded as where both are in part; with the mirror image.
        const auto has = [&](const BeyondSide what) {
          return beyond[2 * d] == what || beyond[2 * d + 1] == what;
        };
        const bool whole = !has(BeyondSide::in_part);
        if (has(BeyondSide::nothing) || (whole && !has(BeyondSide::continued)) ||
            longest < slender * size[d])
          continue;
        // Measured (doc/elasticity.md).
        const double m = scene.horizon() / h[d], n = size[d] / h[d],
                     more = (dim == 2 ? 1. : 1.25) * (2.45 + 0.25 * m * m) / (n * n),
                     less = (dim == 2 ? 1. : 0.7) * std::pow((0.4 + 0.475 * m) / n, m);
        if ((whole ? more : less) > bent || (dim == 3 && more > twisted))
          thin = d;
        bent    = std::max(bent, whole ? more : less);
        twisted = std::max(twisted, dim == 3 ? more : 0.);
      }
    if (std::max(bent, twisted) < tolerable)
      return {};
    const std::string in_bending =
      bent < tolerable ? "" :
                         rounded_text(1. + bent) + " times as stiff as it should be in bending";
    const std::string in_torsion =
      twisted < tolerable ?
        "" :
        rounded_text(1. + twisted) +
          (in_bending.empty() ? " times as stiff as it should be in torsion" : " times in torsion");
    return "with m = " + rounded_text(scene.horizon() / h[thin]) + " and " +
           std::to_string(scene.domain.cells[thin]) + " cells along " + "xyz"[thin] +
           " this body is about " + in_bending +
           (in_bending.empty() || in_torsion.empty() ? "" : " and ") + in_torsion +
           " (not where it is pulled). Twice as many cells there make that a quarter or less, 'Models = finite elements' has none of it.";
  }


  std::string note_on_thin_parts(const double n_cells, const double m, const bool ends)
  {
    constexpr double tolerable = 0.05;
    const double     more      = ends ? 0.3 * std::pow(2. / n_cells, 8.) :
                                        0.045 * std::pow(m / 3., 1.4) * std::pow(4. / n_cells, 3.8),
                 less          = ends ? std::min(0.15, 0.24 * (m - 2.4) / n_cells) :
                                        0.5 * (m / 3. - 1.) / n_cells;
    if (more < tolerable && less < tolerable)
      return {};
    const std::string size = n_cells < 2. || more > 1. ?
                               "much too stiff" :
                               "about " + rounded_text(more < tolerable ? 1. - less : 1. + more) +
                                 " times as stiff as they should be";
    return "behind free sides this mesh is " + rounded_text(n_cells) +
           " cells of mean size thick where it is thinnest. With m = " + rounded_text(m) +
           " strips of that thickness with two free long sides are " + size +
           " in bending (not where they are pulled). Smaller cells, with a smaller 'Horizon' in section 'Peridynamics', make that less; 'Models = finite elements' has none of it.";
  }


  template <int dim>
  std::string note_on_trapping(const Scene<dim>                     &scene,
                               const std::vector<FamilyMember<dim>> &family)
  {
    constexpr double few = 3.5;
    if (dim == 1 || family.empty() || !scene.material.fracture_energy)
      return {};
    const Tensor<1, dim> h = scene.domain.spacing();
    const double         m = scene.horizon() / *std::min_element(h.begin_raw(), h.end_raw());
    if (m >= few)
      return {};
    int    n_bonds   = 0;
    double strongest = 0., all = 0.;
    for (const FamilyMember<dim> &member : family)
      if (member.offset[0] > 0)
        {
          const double energy = member.offset[0] * member.weight * member.r * member.r;
          n_bonds += member.offset[0];
          all += energy;
          strongest = std::max(strongest, energy / member.offset[0]);
        }
    return "with m = " + rounded_text(m) +
           " a crack along the rows gets on a column at a time, by " + std::to_string(n_bonds) +
           " bonds that hold it back until the last breaks (one of them has " +
           rounded_text(100. * strongest / all) +
           " % of the energy): loads at which it runs come out 10 to 20 % too large however fine the lattice is. "
           "'Horizon ratio' of 4 or 5 (section 'Peridynamics') takes that away.";
  }


  template <int dim>
  std::string note_on_stretch(const Scene<dim> &scene, const double energy, const double of_ball)
  {
    constexpr double tolerable = 0.05;
    if (std::abs(energy / of_ball - 1.) < tolerable)
      return {};
    const Tensor<1, dim> h = scene.domain.spacing();
    return "'Critical stretch' in section 'Material' is a fracture energy of " +
           rounded_text(energy) + " on this lattice of m = " +
           rounded_text(scene.horizon() / *std::min_element(h.begin_raw(), h.end_raw())) + ", " +
           rounded_text(energy / of_ball) +
           " times that of a ball, from which textbooks have their formulas. 'Fracture energy' in its place is the same on every lattice.";
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                  \
  template void        note_locking(const Scene<dim> &, const double, std::vector<std::string> &); \
  template void        note_tips_in_cells(const Scene<dim> &, std::vector<std::string> &);         \
  template void        note_slender_cracks(const Scene<dim> &, std::vector<std::string> &);        \
  template void        note_loaded_holes(const Scene<dim> &, std::vector<std::string> &);          \
  template void        note_slow_oblique_cracks(const Scene<dim> &, std::vector<std::string> &);   \
  template std::string note_on_few_bonds(const Scene<dim> &,                                       \
                                         const std::vector<FamilyMember<dim>> &);                  \
  template std::string note_on_bending(const Scene<dim> &);                                        \
  template std::string note_on_trapping(const Scene<dim> &,                                        \
                                        const std::vector<FamilyMember<dim>> &);                   \
  template std::string note_on_stretch(const Scene<dim> &, const double, const double);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
