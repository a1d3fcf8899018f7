// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene.h>
#include <perideal/study/cracked_box.h>

#include <optional>
#include <string>
#include <vector>

#include "body_of_choice.h"
#include "formula_scan.h"
#include "lines_of_choice.h"
#include "material_planes.h"

namespace PeriDeal
{
  /** A model on a mesh, as entries of a scene. */
  struct Attempt
  {
    ModelKind            model    = ModelKind::finite_elements;
    double               fineness = 0.; // in proportion to 1/h; of a graded mesh where it is coarse
    std::vector<Setting> settings;
  };


  /** What a solution is compared with: the classical one, or the nonlocal one of the horizon. */
  enum class LimitOfAttempts
  {
    classical,
    nonlocal
  };


  /**
   * The models and meshes that are worth trying for a scene, one family from coarse to fine. For
   * the classical solution:
   *
   * - without cracks quadratic elements on a lattice;
   * - with cracks along the axes the same with the crack on faces, graded to its ends, so that the
   *   cells there are the cube of those far away: on a lattice, or between lines of unequal
   *   distance where a lattice with the cracks on its faces would have many more cells;
   * - with others, diffusion: linear elements, pairs of nodes in cut cells, scaled, fine along the
   *   cracks, so that the cells there are the square of those far away; elastic bodies: bonds
   *   around the cracks on such a mesh.
   *
   * Points that are held or loaded are put on nodes where a lattice not much finer does it: a model
   * takes the nearest node.
   *
   * A body that is no box has the mesh that it is given with, or one that follows the rims of its
   * holes, whose cells are halved: quadratic elements, graded to the corners of the body and the
   * ends of cracks on faces; with cracks across cells, in diffusion, linear ones with pairs of
   * nodes.
   *
   * For the nonlocal one of a horizon that is a length: peridynamics, with ever more nodes in it.
   */
  template <int dim>
  class Attempts
  {
  public:
    Attempts(const BodyOfChoice<dim> &body, const LimitOfAttempts limit);

    /**
     * The coarsest that is worth a try: formulas of the scene and gaps beside cracks are seen by
     * it. Not collective.
     */
    double coarsest() const;

    /** The one with about this fineness, as close as lattices allow. Not collective. */
    Attempt at(const double fineness) const;

    /** How the error goes with 1/fineness where nothing disturbs it. Not collective. */
    double best_order() const;

    /** The lowest with which that is believed to go. Not collective. */
    double lowest_order() const;

    /** Of finenesses, from one to the next, while little is known. Not collective. */
    double first_ratio() const;

    /** How the cost grows with the fineness. Not collective. */
    double growth_of_cost() const;

    /** Finer meshes follow the body better. Not collective. */
    bool is_round() const
    {
      return is_given() && body.given->is_round;
    }

    /** In a sentence, why this family. Not collective. */
    std::string reason() const;

  private:
    enum class Family
    {
      whole,
      faces,
      pairs,
      zone,
      bonds,
      given,      // a mesh without cracks across its cells
      given_pairs // with such cracks
    };

    static Family family_for(const BodyOfChoice<dim> &body,
                             const LimitOfAttempts    limit,
                             const bool               on_faces);

    /** The given mesh is that of the body. */
    bool is_given() const
    {
      return family == Family::given || family == Family::given_pairs;
    }

    /** A plate in 3D whose cells need not be halved: others are taken, not many times as many. */
    bool grows_by_cells() const
    {
      return dim == 3 && family == Family::given && !body.settings.empty() &&
             !body.given->has_corners && scene.cracks.cracks.empty();
    }

    /** Halvings of the given mesh's cells. */
    unsigned int refinements(const double fineness) const;
    void         refine_given(const double fineness, Attempt &attempt) const;

    /**
     * Values are measured beside an end of a crack, where errors are as the root of the size of
     * the cells there.
     */
    bool probes_at_ends() const;

    double              order_of_elements() const;
    std::vector<double> first_counts() const;
    CellCounts          counts(const double fineness) const;
    bool                planes_on_lines(const unsigned int direction, const unsigned int n) const;
    unsigned int with_points_on_planes(const unsigned int direction, const unsigned int n) const;
    void         set_mesh(const double fineness, Attempt &attempt) const;
    std::optional<CellCounts> on_faces(const double fineness) const;
    std::optional<CellLines>  lines_for_cracks() const;
    void                      set_lines(const double fineness, Attempt &attempt) const;
    double                    fineness_of(const CellCounts &cells) const;

    const BodyOfChoice<dim> &body;
    const Scene<dim>        &scene;
    CrackedBox               box, points; // points: those of parts in place of cracks
    double                   longest = 0.;
    NeedsOfFormulas          needs;
    std::optional<std::vector<std::vector<double>>> planes; // of materials, to be on lines
    std::optional<CellLines>                        lines;  // of the coarsest mesh, not a lattice
    Family                                          family = Family::whole;
    std::vector<double> first; // cells of the first mesh, of a family other than `bonds`
    double              first_fineness = 0.; // of the coarsest mesh; 0 until it is known
    double faces_unit = 0.; // fineness of the coarsest mesh that has the cracks on faces
  };
} // namespace PeriDeal
