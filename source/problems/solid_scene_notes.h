// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/lattice_family.h>
#include <perideal/scene/scene.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /*
   * Where methods for elastic bodies are known to fail (prm/failures), by numbers of the scene at
   * hand. An empty text: nothing to say. Not collective.
   */

  /**
   * Elements of degree 1 in a box of a material that hardly changes its volume.
   * @param poisson the largest Poisson ratio in the body
   */
  template <int dim>
  void note_locking(const Scene<dim> &scene, const double poisson, std::vector<std::string> &notes);

  /** Ends of cracks inside the cells that they take away, or leave. */
  template <int dim>
  void note_tips_in_cells(const Scene<dim> &scene, std::vector<std::string> &notes);

  /**
   * Cracks along sides nearer than they are long, as in cantilevers: what stress intensities are
   * off, by models.
   */
  template <int dim>
  void note_slender_cracks(const Scene<dim> &scene, std::vector<std::string> &notes);

  /** Round holes of few cells with a load on their rim: how much too wide they get, by models. */
  template <int dim>
  void note_loaded_holes(const Scene<dim> &scene, std::vector<std::string> &notes);

  /** Cracks at an angle to the rows of nodes, from which bonds break in groups. */
  template <int dim>
  void note_slow_oblique_cracks(const Scene<dim> &scene, std::vector<std::string> &notes);

  /** The stiffness of a lattice whose families have few bonds, or oblong cells. */
  template <int dim>
  std::string note_on_few_bonds(const Scene<dim>                     &scene,
                                const std::vector<FamilyMember<dim>> &family);

  /**
   * By how much families that go on beyond the sides of a thin body make it too stiff where it is
   * bent, or twisted: for `Models = peridynamics`.
   */
  template <int dim>
  std::string note_on_bending(const Scene<dim> &scene);

  /**
   * The same of a mesh from a file, as measured (doc/elasticity.md).
   * @param n_cells what of it is thinnest, in cells of mean size
   * @param m       of these
   * @param ends    families end at free sides, since bonds may break or in motion
   */
  std::string note_on_thin_parts(const double n_cells, const double m, const bool ends);

  /** Cracks that are held back between two rows of nodes. */
  template <int dim>
  std::string note_on_trapping(const Scene<dim>                     &scene,
                               const std::vector<FamilyMember<dim>> &family);

  /**
   * A critical stretch where a fracture energy is meant.
   * @param energy  per area of new crack, of the bonds that cross a plane of the lattice
   * @param of_ball the same of the integral over a ball
   */
  template <int dim>
  std::string note_on_stretch(const Scene<dim> &scene, const double energy, const double of_ball);
} // namespace PeriDeal
