// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/types.h>

#include <perideal/scene/expression.h>
#include <perideal/scene/holes.h>
#include <perideal/scene/mesh_groups.h>
#include <perideal/scene/parts.h>
#include <perideal/scene/physics.h>
#include <perideal/scene/section.h>
#include <perideal/scene/surface_transfer.h>
#include <perideal/scene/vector_conditions.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** Boundary id of the hole of a plate with a hole. */
  constexpr dealii::types::boundary_id hole_boundary_id = 6;

  /**
   * Name of a side for messages and results: of a box side or the hole (@p box_sides), else the
   * number.
   */
  std::string name_of_side(const dealii::types::boundary_id id, const bool box_sides);

  /**
   * A given value on one side or part: `name` as the user wrote it, `id` the deal.II boundary id
   * (box: 0 left, 1 right, 2 bottom, 3 top, 4 back, 5 front) or that of the part.
   */
  struct SideCondition
  {
    std::string                name;
    dealii::types::boundary_id id = 0;
    Expression                 value;

    bool depends_on_time() const
    {
      return value.depends_on_time();
    }
  };

  /**
   * Section `Boundary conditions`. The lists keep the user's order: where two sides with values
   * meet, the one named first holds. A side named nowhere is insulated, or with elasticity free.
   */
  template <int dim>
  class BoundaryConditions : public SceneSection
  {
  public:
    BoundaryConditions();

    std::vector<SideCondition>   dirichlet;
    std::vector<SurfaceTransfer> transfers; // fluxes, convection, ...: kind by kind
    std::vector<dealii::types::boundary_id>
      symmetry; // elasticity: no displacement normal to the side

    /** Elasticity only. Velocities stand behind the displacements, as rates of one. */
    std::vector<VectorCondition> displacement, traction;
    double displacement_layer = -1., traction_layer = -1.; // lengths; negative: not given
    std::vector<Part> parts;
    /** Of a lattice: whose rims the stairs of its cells stand for. */
    Holes<dim> holes;
    /** Names of a mesh file for its boundary ids. To be set before parse(). */
    MeshGroups::Numbers physical_names;
    /** On the scale of the temperatures, for `Radiation`. To be set before parse(). */
    double absolute_zero = 0.;

    /**
     * For programs: a value, or what enters by the kind with this entry (`Flux`, `Convection`, ...)
     * and its formulas, on the side with this boundary id, for diffusion; a displacement
     * (components without a value are free) or a traction of a solid. Where two sides with values
     * meet, the one given first holds.
     */
    void prescribe(const dealii::types::boundary_id id, const Expression &value)
    {
      dirichlet.push_back({name_of(id), id, value});
    }

    void let_in(const std::string               &entry,
                const dealii::types::boundary_id id,
                const std::vector<Expression>   &formulas)
    {
      SurfaceTransfer transfer;
      transfer.name          = name_of(id);
      transfer.id            = id;
      transfer.absolute_zero = absolute_zero;
      transfer.set(transfer_kind(entry), formulas, where(entry));
      transfers.push_back(transfer);
    }

    void displace(const dealii::types::boundary_id              id,
                  const std::vector<std::optional<Expression>> &values)
    {
      AssertDimension(values.size(), dim);
      displacement.emplace_back(name_of(id), id, values);
    }

    void pull(const dealii::types::boundary_id id, const std::vector<Expression> &values)
    {
      AssertDimension(values.size(), dim);
      traction.emplace_back(name_of(id),
                            id,
                            std::vector<std::optional<Expression>>(values.begin(), values.end()));
    }

    /** Sides have no names of a box. */
    void name_sides_by_number()
    {
      box_sides = false;
    }

    /** Call visit(entry, condition) for all conditions, of each kind in turn, but Symmetry. */
    template <typename Visit>
    void for_each(const Visit &visit) const
    {
      for (const SideCondition &condition : dirichlet)
        visit("Dirichlet", condition);
      for (const SurfaceTransfer &transfer : transfers)
        visit(transfer.kind->entry, transfer);
      for (const VectorCondition &condition : displacement)
        visit(condition.rate ? "Velocity" : "Displacement", condition);
      for (const VectorCondition &condition : traction)
        visit("Traction", condition);
    }

    /** Some flux or ambient value changes with time. */
    bool transfers_depend_on_time() const;

    /** Some transfer determines a steady state. */
    bool transfers_fix_level() const;

    /**
     * The number of a side or part. @param at entry and section for messages. Throws UserError.
     */
    dealii::types::boundary_id side_id(const std::string &name,
                                       const std::string &at,
                                       const bool         or_part = true);

    /**
     * The first given value that holds at a place on a side, on the whole side or on a part of it;
     * or nullptr.
     */
    const SideCondition *value_at(const dealii::types::boundary_id side,
                                  const dealii::Point<dim>        &p) const
    {
      for (const SideCondition &condition : dirichlet)
        if (side_of(condition.id) == side && holds_at(condition.id, p))
          return &condition;
      return nullptr;
    }

    /** The part with this id, nullptr for a side. */
    const Part *part(const dealii::types::boundary_id id) const
    {
      return id >= first_part_id && id - first_part_id < parts.size() ? &parts[id - first_part_id] :
                                                                        nullptr;
    }

    /** The side that a condition of this id is on; invalid_boundary_id for regions and points. */
    dealii::types::boundary_id side_of(const dealii::types::boundary_id id) const
    {
      return part(id) != nullptr ? part(id)->side : id;
    }

    /**
     * Whether a condition of this id holds at a place (of its side, for a part of one): true for
     * sides, false for points.
     */
    bool holds_at(const dealii::types::boundary_id id, const dealii::Point<dim> &p) const
    {
      const Part *const of = part(id);
      return of == nullptr || (of->kind != Part::point && of->holds(p));
    }

    /**
     * How messages and results name a side or part: as the user did, else by its name in the mesh
     * file, or its number.
     */
    std::string name_of(const dealii::types::boundary_id id) const;

    /** Some value, flux, ambient value, displacement or traction changes with time. */
    bool depends_on_time() const;

    /**
     * @param box_sides whether sides have the names of a box; else they are numbers (mesh boundary
     *                  ids) and
     * `physical_names`.
     * @param hole      whether there is a side `hole` (boundary id 6).
     * @param physics   elasticity has displacements and tractions, all others have values and
     *                  fluxes.
     * @param with_heat elasticity with a computed temperature, which has both.
     * Throws UserError: unknown sides, sides named twice, conditions that contradict each other on
     * a side, wrong formulas, conditions of another physics.
     */
    void parse(const bool    box_sides,
               const bool    hole      = false,
               const Physics physics   = Physics::heat,
               const bool    with_heat = false);

  private:
    /** The names of sides that there are, without those of parts and numbers. */
    std::vector<std::string> side_names() const;

    void parse_parts();

    /** What parts cannot carry. */
    void check_parts() const;

    /**
     * The pieces `side: text` of an entry as conditions with name and id, of which
     * read(condition, text, where) makes the rest.
     */
    template <typename Condition, typename Read>
    std::vector<Condition> parse_list(const std::string &entry, const Read &read);

    void parse_symmetry();

    void refuse_other_physics(const Physics physics, const bool with_heat) const;

    /**
     * Contradictions between values, fluxes and symmetry; and between displacements, tractions and
     * symmetry.
     */
    void check_scalar_conditions() const;
    void check_vector_conditions() const;

    bool box_sides = true, has_hole = false;
    std::map<dealii::types::boundary_id, std::string>
      used_names; // of sides, as the user wrote them first
  };

  /**
   * left, right, bottom, top, back, front in the order of deal.II's boundary ids, 2 dim of them.
   */
  const std::vector<std::string> &box_side_names();
} // namespace PeriDeal
