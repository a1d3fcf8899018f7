// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/expression.h>
#include <perideal/scene/phase_map.h>
#include <perideal/scene/physics.h>
#include <perideal/scene/section.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * The material ids of a mesh file's cells, known once the mesh is (set_material_ids() of the room
   * mesh).
   */
  struct MeshMaterials
  {
    /**
     * Of the cell that holds a point, given by three coordinates; the smallest where several do.
     */
    std::function<int(const double *)> id_at;
  };


  /**
   * A part of the body with a material of its own: where a formula of x, y, z is greater than 0, or
   * one of the shapes circle, rectangle, polygon (2D), sphere, box (3D) with its rim, given by
   * numbers, or the cells of a mesh file with a material id.
   */
  class Region
  {
  public:
    /**
     * @param text  a formula, `circle(x, y, r)`, `rectangle(x0, y0, x1, y1)`, `polygon(x0, y0, x1,
     *              y1, x2, y2, ...)`, `sphere(x, y, z, r)` or `box(x0, y0, z0, x1, y1, z1)`
     * @param mesh  what `mesh(id)` asks
     * @param where entry and section for messages. Throws UserError for wrong formulas and shapes
     *              of no size.
     */
    Region(const std::string                          &text,
           const std::string                          &where,
           const std::shared_ptr<const MeshMaterials> &mesh = nullptr);

    /** Of a region given as `mesh(id)`, else -1. */
    int mesh_id() const;

    template <int dim>
    bool contains(const dealii::Point<dim> &p) const;

  private:
    enum class Kind
    {
      formula,
      ball,
      box,
      polygon,
      mesh
    };

    bool in_polygon(const double x, const double y) const;

    Kind                                 kind = Kind::formula;
    Expression                           formula;
    std::vector<double>                  numbers;
    unsigned int                         n_coordinates = 2; // of a shape
    double                               slack = 0.; // round-off that still counts as the rim
    std::shared_ptr<const MeshMaterials> mesh;
  };


  /**
   * The named regions of a scene. They must not overlap; where none is, the phases of the image
   * hold, and where there are none either, the entries of section `Material`.
   */
  struct Regions
  {
    std::vector<std::string>        names;
    std::vector<Region>             regions;
    std::string                     where;
    std::shared_ptr<MeshMaterials>  mesh;  // shared by the regions given by material ids
    std::shared_ptr<const PhaseMap> image; // its phases follow those of the regions; null: none

    /** Some region is given by a material id. */
    bool need_mesh() const;

    /**
     * Number of the region at a point from 0 on, or -1. Throws the UserError of an overlap, or
     * defers it (report_formula_error()).
     */
    template <int dim>
    int at(const dealii::Point<dim> &p) const;
  };


  /**
   * A property of the material, one formula of x, y, z for each phase that has its own and one for
   * all else.
   */
  class MaterialProperty
  {
  public:
    MaterialProperty() = default;

    /** The same formula everywhere. */
    MaterialProperty(const Expression &everywhere);
    MaterialProperty(const double everywhere);

    MaterialProperty(const Expression                             &elsewhere,
                     const std::shared_ptr<const Regions>         &regions,
                     const std::vector<std::optional<Expression>> &of_regions);

    /**
     * @param temperature the T of its formulas, the unknown field itself (the wetness with
     *                    moisture)
     */
    template <int dim>
    double value(const dealii::Point<dim> &p,
                 const double              temperature = 0.,
                 const double              t           = 0.) const
    {
      return formula_at(p).value(p, t, temperature);
    }

    /** Expression::marked_temperatures() of the formula at a point. */
    template <int dim>
    const std::vector<double> &marked_temperatures(const dealii::Point<dim> &p) const
    {
      return formula_at(p).marked_temperatures();
    }

    /** One number in the whole body. */
    bool is_constant() const;

    /** T is in some formula. */
    bool depends_on_temperature() const;

    /** t is in some formula. */
    bool depends_on_time() const;

    /** t or T is in some formula. */
    bool changes() const
    {
      return depends_on_time() || depends_on_temperature();
    }

    /** Formula of a region, or elsewhere (-1). */
    const Expression &formula(const int region) const;

  private:
    template <int dim>
    const Expression &formula_at(const dealii::Point<dim> &p) const
    {
      return formula(regions == nullptr ? -1 : regions->at(p));
    }

    Expression                             elsewhere{1.};
    std::shared_ptr<const Regions>         regions; // null: one formula everywhere
    std::vector<std::optional<Expression>> of_regions;
  };


  /** An entry of section `Material` that the phases can have, too, and what its formulas may be. */
  struct MaterialEntry
  {
    std::string name, unit;
    bool        diffusion, elasticity; // who takes it
    bool        with_temperature;      // T is a variable
    bool        positive;              // else of any sign
    bool        changes = false;       // with elasticity t and T are variables
  };

  const std::vector<MaterialEntry> &material_entries();

  const MaterialEntry &material_entry(const std::string &name);

  /**
   * A formula of such an entry. Throws UserError if it depends on t, or on T where it may not, and
   * for numbers that are not positive where they have to be, or at least 0 (@p may_vanish).
   */
  Expression material_formula(const std::string   &text,
                              const MaterialEntry &entry,
                              const bool           elastic,
                              const bool           may_vanish,
                              const std::string   &where);


  /** Section `Material/Phases`. */
  class Phases : public SceneSection
  {
  public:
    Phases();

    /**
     * Throws UserError: names twice, regions without a material that the physics takes, materials
     * of regions that do not exist, wrong formulas.
     * @param image whose phases are phases of the material, or null
     */
    void parse(const Physics                          physics       = Physics::heat,
               const std::shared_ptr<const PhaseMap> &image         = nullptr,
               const bool                             needs_storage = true);

    /** The property of that name, with the value elsewhere from section `Material`. */
    MaterialProperty property(const std::string &entry, const Expression &elsewhere) const;

    /** Some phase has its own value of that entry. */
    bool gives(const std::string &entry) const;

    const Regions &all() const
    {
      return *regions;
    }

    bool needs_storage = true; // else densities and heat capacities may be 0

  private:
    std::vector<std::optional<Expression>> read(const std::string &entry) const;


    std::shared_ptr<const Regions> regions;
    bool                           elastic = false;
  };
} // namespace PeriDeal
