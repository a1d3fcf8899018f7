// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/mesh_groups.h>
#include <perideal/scene/scene.h>

/*
 * What Scene::parse_and_validate() asks of the sections together, each in a source of its own. All
 * throw UserError.
 */

namespace PeriDeal
{
  /**
   * What a mesh file gives names to: sides and points of section `Boundary conditions`, materials
   * of regions, which get their numbers in the text of `Regions`. Reads the file, so that it is
   * refused before anything else is. To be called before those sections are parsed. Collective.
   */
  template <int dim>
  MeshGroups take_groups_of_mesh(Scene<dim> &scene);

  /**
   * The faces of a mesh file that `Interfaces` names, as cracks: in 2D a line of edges is one, in
   * 3D what lies in one plane and hangs together. To be called once the others are there.
   */
  template <int dim>
  void add_interfaces(Scene<dim> &scene, const MeshGroups &groups);

  /**
   * `Mesh = auto` of solids in 2D with elements: cracks along the axes are cut into the mesh,
   * for which `Cells` may change by some percent, and their ends by half a cell; others are removed
   * with their cells. To be called before keep_cracks_off_nodes().
   */
  template <int dim>
  void lay_cracks_on_faces(Scene<dim> &scene);

  /** Changes `Cells` where a crack runs along a row of nodes, or says in a note what that means. */
  template <int dim>
  void keep_cracks_off_nodes(Scene<dim> &scene);

  /** Finds Scene::heat. */
  template <int dim>
  void make_heat_problem(Scene<dim> &scene);

  /** Islands and thin voids of an image: takes them out, holds them, or notes them. */
  template <int dim>
  void check_image(Scene<dim> &scene);

  /**
   * Appends to the notes of the domain what is allowed, but rarely meant: a body in motion without
   * a density, velocities beyond that of waves, wetness that is not from 0 to 1, parts that no
   * condition names. To be called when all is parsed.
   */
  template <int dim>
  void note_doubtful_entries(Scene<dim> &scene);
} // namespace PeriDeal
