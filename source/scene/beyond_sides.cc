// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/scene/beyond_sides.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    struct Hindrance
    {
      std::string reason, remedy;
    };


    /** Explicit steps are taken, which stiff nodes make short. */
    template <int dim>
    bool takes_steps(const BodyParameters<dim> &body)
    {
      return body.material.breaks() || body.elasticity.solver == ElasticSolver::dynamics;
    }


    /**
     * Directions along which a body on a lattice, without holes, is a third as long as along
     * another one or less, and 16 horizons at most, with its mirror image at planes of symmetry:
     * where a strip, bar or plate is thin. What a linear continuation adds beyond free sides makes
     * it too stiff in bending, by at most 0.4 % where it is thicker; stresses at free sides are
     * the more accurate with it.
     */
    template <int dim>
    std::array<bool, dim> thin_directions(const BodyParameters<dim> &body)
    {
      std::array<bool, dim> thin{};
      if (!body.domain.has_lattice() || body.domain.has_voids() || body.domain.has_extra_layers())
        return thin;
      const Tensor<1, dim> extent  = whole_extent(body);
      const double         longest = *std::max_element(extent.begin_raw(), extent.end_raw());
      for (unsigned int d = 0; d < dim; ++d)
        thin[d] = extent[d] < std::min(longest / 2.999, 16.001 * body.horizon());
      return thin;
    }


    /** What families lack at some free sides is made up for in part by their own bonds. */
    template <int dim>
    bool takes_own_bonds(const BodyParameters<dim> &body)
    {
      const auto thin = thin_directions(body);
      return takes_steps(body) || has(thin, true);
    }


    /** Why no families can go on beyond the sides; empty where they can. */
    template <int dim>
    Hindrance find_hindrance(const BodyParameters<dim> &body)
    {
      if (!body.domain.has_lattice() && (dim == 1 || body.domain.has_nodes_at_centers()))
        return {std::string("on a mesh from a file families do not go on ") +
                  (dim == 1 ? "in 1D" : "with nodes at cell centres"),
                "They do with 'Nodes = vertices' (section 'Domain')."};
      if (body.cracks.double_nodes())
        return {"cracks are cut into the mesh ('Mesh = faces')",
                "Families go on with 'Mesh = removed' (section 'Cracks')."};
      if (body.peridynamics.sampling.nodal_volume != NodalVolume::partial)
        return {"nodes on sides have whole cells ('Nodal volume = full')",
                "Families go on with 'Nodal volume = partial'."};
      if (body.elasticity.micromodulus == Micromodulus::constant)
        return {"bonds at sides are those inside ('Micromodulus = constant')",
                "Families go on with 'Micromodulus = family' (section 'Elasticity')."};
      return {};
    }


    /**
     * Sides and parts of sides where one row of nodes bears what acts, of the conditions that no
     * layer spreads.
     */
    template <int dim>
    std::vector<std::string> single_rows(const BodyParameters<dim>          &body,
                                         const std::vector<VectorCondition> &list,
                                         const double                        layer,
                                         bool                               &flat)
    {
      const auto               beyond = beyond_sides(body);
      std::vector<std::string> names;
      for (const VectorCondition &condition : list)
        {
          const types::boundary_id side = body.boundary_conditions.side_of(condition.id);
          if (layer > 0. || side == numbers::invalid_boundary_id || completes_mesh(body) ||
              (side < 2 * dim && beyond[side] != BeyondSide::nothing))
            continue;
          flat = flat && side < 2 * dim && body.domain.has_lattice();
          names.push_back("'" + body.boundary_conditions.name_of(condition.id) + "'");
        }
      return names;
    }
  } // namespace


  template <int dim>
  std::string hindrance_of_fictitious_nodes(const BodyParameters<dim> &body)
  {
    return body.peridynamics.surface_correction == SurfaceCorrection::automatic ?
             find_hindrance(body).reason :
             std::string();
  }


  template <int dim>
  std::string note_on_cut_sides(const BodyParameters<dim> &body)
  {
    const bool  automatic  = body.peridynamics.surface_correction == SurfaceCorrection::automatic;
    const auto &conditions = body.boundary_conditions;
    const Hindrance hindrance = find_hindrance(body);
    if (!(automatic && !hindrance.reason.empty()) &&
        body.peridynamics.surface_correction != SurfaceCorrection::none)
      return {};
    bool       flat = true;
    const auto held =
      single_rows(body, conditions.displacement, conditions.displacement_layer, flat);
    const auto loaded = single_rows(body, conditions.traction, conditions.traction_layer, flat);
    // With a constant micromodulus surfaces are meant to be soft.
    if (held.empty() && loaded.empty() &&
        (!automatic || body.elasticity.micromodulus == Micromodulus::constant))
      return {};
    std::string              text  = automatic ?
                                       "Families of peridynamics end at the sides, because " + hindrance.reason :
                                       std::string("Families of peridynamics end at the sides "
                                                   "('Surface correction = none' in section 'Peridynamics')");
    std::vector<std::string> names = held;
    std::copy_if(loaded.begin(), loaded.end(), std::back_inserter(names), [&](const auto &name) {
      return !has(held, name);
    });
    if (!names.empty())
      text += ", where one row of nodes bears what acts on " + join_names(names);
    text +=
      ". Displacements of sides that are held or loaded, and stresses within a horizon of all sides, "
      "do not converge as the nodes get denser. ";
    text += !hindrance.reason.empty() ? hindrance.remedy :
                                        "With 'auto' families go on beyond them.";
    if (names.empty() || !flat)
      return text;
    const std::string hold = "'Displacement layer' of two horizons",
                      pull = "'Traction layer' of a horizon";
    return text + " " +
           (held.empty()   ? pull :
            loaded.empty() ? hold :
                             hold + " and " + pull) +
           " (section 'Boundary conditions') " +
           (held.empty() || loaded.empty() ? "spreads" : "spread") + " it over a depth.";
  }


  template <int dim>
  std::string note_on_held_rows(const BodyParameters<dim> &body)
  {
    const auto              &conditions = body.boundary_conditions;
    const auto               beyond     = beyond_sides(body);
    std::vector<std::string> names;
    for (const VectorCondition &condition : conditions.displacement)
      if (const types::boundary_id side = conditions.side_of(condition.id);
          side < 2 * dim && beyond[side] == BeyondSide::continued)
        names.push_back("'" + conditions.name_of(condition.id) + "'");
    if (names.empty() || !body.domain.has_nodes_at_centers())
      return {};
    const Tensor<1, dim> spacing = body.domain.spacing();
    if (conditions.displacement_layer >
        1.499 * *std::max_element(spacing.begin_raw(), spacing.end_raw()))
      return {};
    return "With nodes at cell centers a displacement holds the outermost row of nodes at " +
           join_names(names) +
           ", half a cell inside, and of the forces beyond the side some act on the row behind it, which is free. "
           "The body is too stiff by that, as if it were 0.6 to 0.8 cells shorter at each of these sides. 'Nodes = vertices' (section 'Domain') "
           "lie on the sides; with a 'Displacement layer' of two cells (section 'Boundary conditions'), each node at the value of the formula at its own place, linear displacements are exact.";
  }


  template <int dim>
  std::array<BeyondSide, 2 * dim> beyond_sides(const BodyParameters<dim> &body)
  {
    std::array<BeyondSide, 2 * dim> beyond;
    beyond.fill(BeyondSide::nothing);
    const bool automatic = body.peridynamics.surface_correction == SurfaceCorrection::automatic;
    if (!automatic && !body.peridynamics.completes_families())
      return beyond;
    if (automatic && (!body.domain.has_lattice() || !hindrance_of_fictitious_nodes(body).empty()))
      return beyond;
    const auto &conditions = body.boundary_conditions;
    beyond.fill(!automatic || !takes_own_bonds(body) ? BeyondSide::continued :
                completes_at_surfaces(body)          ? BeyondSide::in_part :
                                                       BeyondSide::nothing);
    for (unsigned int side = 0; side < 2 * dim; ++side)
      if (!takes_steps(body) && !thin_directions(body)[side / 2])
        beyond[side] = BeyondSide::continued;
    const auto set = [&](const types::boundary_id side, const BeyondSide value) {
      if (side < 2 * dim)
        beyond[side] = value;
    };
    for (const auto *const list : {&conditions.displacement, &conditions.traction})
      for (const VectorCondition &condition : *list)
        set(conditions.side_of(condition.id), BeyondSide::continued);
    for (const types::boundary_id side : conditions.symmetry)
      set(side, BeyondSide::mirrored);
    for (unsigned int side = 0; side < 2 * dim; ++side)
      if (automatic && body.domain.has_extra_layers() && body.domain.extra.layers[side] > 0)
        beyond[side] = BeyondSide::nothing;
    return beyond;
  }


  template <int dim>
  Tensor<1, dim> whole_extent(const BodyParameters<dim> &body)
  {
    Tensor<1, dim> extent = body.domain.upper - body.domain.lower;
    for (const types::boundary_id side : body.boundary_conditions.symmetry)
      if (side < 2 * dim)
        extent[side / 2] *= 2.;
    return extent;
  }


  template <int dim>
  bool completes_at_surfaces(const BodyParameters<dim> &body)
  {
    return takes_own_bonds(body) && (body.domain.has_lattice() || completes_mesh(body)) &&
           !body.domain.has_extra_layers() &&
           body.peridynamics.surface_correction == SurfaceCorrection::automatic &&
           hindrance_of_fictitious_nodes(body).empty();
  }


  template <int dim>
  bool families_end(const BodyParameters<dim> &body)
  {
    const SurfaceCorrection correction = body.peridynamics.surface_correction;
    if (correction != SurfaceCorrection::automatic)
      return correction == SurfaceCorrection::none;
    return !hindrance_of_fictitious_nodes(body).empty() ||
           (completes_mesh(body) && takes_steps(body)) ||
           (body.domain.has_lattice() && !completes_at_surfaces(body) &&
            (takes_own_bonds(body) || body.domain.has_voids()));
  }


  template <int dim>
  bool completes_mesh(const BodyParameters<dim> &body)
  {
    return !body.domain.has_lattice() && body.deforms &&
           body.peridynamics.surface_correction == SurfaceCorrection::automatic &&
           hindrance_of_fictitious_nodes(body).empty();
  }


  template <int dim>
  bool goes_on_beyond(const BodyParameters<dim> &body, const types::boundary_id side)
  {
    return !takes_steps(body) || !is_free(body, side);
  }


  template <int dim>
  bool is_free(const BodyParameters<dim> &body, const types::boundary_id side)
  {
    const auto &conditions = body.boundary_conditions;
    for (const auto *const list : {&conditions.displacement, &conditions.traction})
      for (const VectorCondition &condition : *list)
        if (conditions.side_of(condition.id) == side)
          return false;
    return true;
  }


  template <int dim>
  double thin_on_mesh(const BodyParameters<dim> &body)
  {
    constexpr double horizons = 5.;
    return horizons * body.horizon();
  }


  template <int dim>
  std::string automatic_correction(const BodyParameters<dim> &body)
  {
    if (const std::string reason = hindrance_of_fictitious_nodes(body); !reason.empty())
      return "none, because " + reason;
    if (completes_mesh(body))
      return takes_steps(body) ?
               "fictitious nodes beyond sides with conditions, weights of bonds elsewhere" :
               "fictitious nodes beyond the boundary, in part at free sides of thin parts";
    const auto               beyond = beyond_sides(body);
    std::vector<std::string> names;
    for (unsigned int side = 0; side < 2 * dim; ++side)
      if (beyond[side] != BeyondSide::nothing)
        names.push_back(name_of_side(side, true));
    const std::string where = names.empty() ? "" : "fictitious nodes beyond " + join_names(names);
    const std::string rest  = completes_at_surfaces(body) ? "weights of bonds elsewhere" : "";
    return where.empty() && rest.empty() ? "none" :
           where.empty() || rest.empty() ? where + rest :
                                           where + ", " + rest;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(whole_extent);
  PERIDEAL_INSTANTIATE_FUNCTION(goes_on_beyond);
  PERIDEAL_INSTANTIATE_FUNCTION(is_free);
  PERIDEAL_INSTANTIATE_FUNCTION(thin_on_mesh);
  PERIDEAL_INSTANTIATE_FUNCTION(completes_at_surfaces);
  PERIDEAL_INSTANTIATE_FUNCTION(families_end);
  PERIDEAL_INSTANTIATE_FUNCTION(note_on_held_rows);
  PERIDEAL_INSTANTIATE_FUNCTION(beyond_sides);
  PERIDEAL_INSTANTIATE_FUNCTION(completes_mesh);
  PERIDEAL_INSTANTIATE_FUNCTION(automatic_correction);
  PERIDEAL_INSTANTIATE_FUNCTION(note_on_cut_sides);
} // namespace PeriDeal
