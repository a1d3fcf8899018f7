// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <perideal/scene/choices.h>
#include <perideal/scene/crack_tips.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/physics.h>
#include <perideal/scene/section.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * What FEM and the mesh do with a crack (entry `Mesh` of section `Cracks`). The scene resolves
   * `automatic`.
   */
  enum class CrackMesh
  {
    pairs,
    faces,
    removed,
    automatic
  };

  /** Entry `Bonds through tips` of section `Cracks`. */
  enum class ThroughTips
  {
    automatic,
    cut,
    keep,
    in_part // elastic bodies in 2D only
  };


  /** Entry `Nodes on cracks` of section `Cracks`. */
  enum class NodesOnCracks
  {
    avoid,
    left
  };


  /**
   * Section `Cracks`: segments in 2D (two points each), planar polygons in 3D (three or more
   * corners each), and how their ends and corners move.
   */
  template <int dim>
  class Cracks : public SceneSection
  {
  public:
    Cracks();

    std::vector<std::vector<dealii::Point<dim>>>
                               cracks; // before they grow; a segment that grows may have no length
    std::vector<CrackTip<dim>> tips;   // that move
    CrackMesh                  mesh;
    ThroughTips                through_tips;
    NodesOnCracks              nodes_on_cracks;
    Expression                 transmission;        // of t alone
    double                     contact_conductance; // negative: not given
    double                     growth_step;         // length; negative: not given
    double end_time = 0.; // of the run, 0 if it has no time; from section `Time`

    /**
     * Throws UserError: wrong points, no length or area, not planar, cracks of another dimension,
     * contradicting entries, tips twice or not there or going back, polygons that do not grow in
     * their plane.
     */
    void parse(const Physics physics = Physics::heat);

    /**
     * For programs: let an end (a corner in 3D) of a crack move with a velocity from one time to
     * another, no sooner than which the run ends.
     */
    void let_grow(const unsigned int            crack,
                  const unsigned int            corner,
                  const dealii::Tensor<1, dim> &velocity,
                  const double                  from,
                  const double                  to);

    /** Cells that a crack cuts conduct between the nodes that it does not part. */
    bool cut_pairs() const
    {
      return mesh == CrackMesh::pairs;
    }

    /** Cracks run along faces of the mesh, on both sides of which there are nodes. */
    bool on_faces() const
    {
      return mesh == CrackMesh::faces;
    }

    /** There are some along faces of the mesh: two nodes are at one place. */
    bool double_nodes() const
    {
      return on_faces() && !cracks.empty();
    }

    /** Cracks or their transmission change with time. */
    bool change() const
    {
      return !tips.empty() || (!cracks.empty() && transmission.depends_on_time());
    }

    /** Some heat may pass through a crack at some time. */
    bool conduct() const
    {
      return !transmission.is_constant() || transmission.value(dealii::Point<dim>()) > 0. ||
             contact_conductance > 0.;
    }

    /**
     * The pieces of all cracks at time t, the whole path of each tip included. With @p cut_at_tips
     * their ends are closed: what touches a tip is cut. Ends on a side of the box always are, and
     * without a box all ends.
     */
    std::vector<CrackPiece<dim>> pieces(const double t, const bool cut_at_tips = true) const;

    /** Between a side of the box and the nearest corner of a crack at the end of the run. */
    double distance_to_side(const dealii::types::boundary_id side) const;

    /** What `Bonds through tips` means for bonds with this correction. */
    bool cuts_bonds_at_tips(const SurfaceCorrection correction) const
    {
      return through_tips == ThroughTips::cut ||
             (through_tips == ThroughTips::automatic && correction != SurfaceCorrection::energy);
    }

    /**
     * The box that the body fills, so that ends on its sides are known. Without it any end may lie
     * on the surface of the body.
     */
    void set_box(const dealii::Point<dim> &lower, const dealii::Point<dim> &upper)
    {
      lowest  = lower;
      highest = upper;
      in_box  = true;
    }

    /**
     * Throws UserError naming the first crack that lies completely outside the box, or the first
     * tip that leaves it before the end of the run.
     */
    void check_inside() const;

    /** What the user should know of cracks that are partly outside a box. */
    std::vector<std::string> parts_outside(const dealii::Point<dim> &lower,
                                           const dealii::Point<dim> &upper) const;

    /** Throws UserError naming the entry that makes this tip move. */
    [[noreturn]] void tip_error(const CrackTip<dim> &tip, const std::string &what) const;

  private:
    /** `Segments` and `Polygons`. */
    void parse_corners();

    void parse_conductance();

    void parse_growth();

    void parse_paths();

    CrackTip<dim> tip_of(const std::string &number, const std::string &entry) const;

    bool grows(const unsigned int crack) const;

    /** 2D: no tip goes back on its own path; @p last is a time after all stops. */
    void check_turns(const double last) const;

    /** 3D: polygons stay in their planes and grow from each of the tips' stops to the next. */
    void check_polygons(const std::vector<double> &stops) const;

    bool on_side(const dealii::Point<dim> &p, const unsigned int side) const;

    dealii::Point<dim> lowest, highest; // of the box
    bool               in_box = false;
  };
} // namespace PeriDeal
