// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene.h>

/**
 * @file
 * Combinations of entries that cannot be computed. A rule is a statement,
 * `section.refuse(condition, entry, words)`, in the group of what cannot compute them. Those of a
 * group are asked in their order; the first that is broken throws its UserError. What one section
 * can say alone stands in its parse(). Nothing here is collective.
 */

namespace PeriDeal
{
  /** Of section `Cracks`. */
  template <int dim>
  void refuse_cracks(const Scene<dim> &scene);

  /** Of bonds alone, whatever the physics: kernels, and horizons between spacing and body. */
  template <int dim>
  void refuse_families(const BodyParameters<dim> &body);

  /** Of `Surface correction = fictitious nodes`: elastic families that go on beyond the sides. */
  template <int dim>
  void refuse_beyond_sides(const BodyParameters<dim> &body);

  /** Of bonds that share nodes with finite elements (`Models = coupled`). */
  template <int dim>
  void refuse_coupling(const BodyParameters<dim> &body);

  /** Of splice and blending of elastic bodies, whose zone has families joined by a dilatation. */
  template <int dim>
  void refuse_coupled_families(const BodyParameters<dim> &body);

  /**
   * Of another `Law` than the linear one.
   * @param by_elements finite elements are in the model, @p coupled beside bonds
   */
  template <int dim>
  void refuse_law(const BodyParameters<dim> &body, const bool by_elements, const bool coupled);

  /**
   * The viscoelastic law keeps what bodies of bonds went through at nodes: their forces are linear
   * in displacements, which they are not with full kinematics or thermal strains; nor with
   * `Operator form = stored`, where each bond of the ordinary solid has a history.
   */
  template <int dim>
  bool relaxes_at_nodes(const BodyParameters<dim> &body);

  /** Of the models of diffusion that a scene names, one after the other. */
  template <int dim>
  void refuse_diffusion(const Scene<dim> &scene);

  /** Of elastic bodies: what none of the models has that a scene names. */
  template <int dim>
  void refuse_deformation(const Scene<dim> &scene);

  /** Of graded meshes (`Coarsening`), and of those that follow cracks (`Zone = adaptive`). */
  template <int dim>
  void refuse_grading(const Scene<dim> &scene);

  /** Of section `Accuracy`. */
  template <int dim>
  void refuse_measure(const Scene<dim> &scene);

  /** Of `Models = auto`. */
  template <int dim>
  void refuse_choice(const Scene<dim> &scene);


  /**
   * What `Calibration` is, `auto` resolved: isotropic for solids on lattices whose bonds stay and
   * are enough for it (doc/elasticity.md), else discrete.
   */
  template <int dim>
  Calibration calibration_of(const BodyParameters<dim> &body);
} // namespace PeriDeal
