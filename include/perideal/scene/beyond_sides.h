// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/body_parameters.h>

#include <array>
#include <string>

namespace PeriDeal
{
  /** How the families of an elastic body go on beyond a flat side of a lattice. */
  enum class BeyondSide
  {
    nothing,   // they end there
    mirrored,  // as in the mirror image of the body, at planes of symmetry
    continued, // by a linear continuation of its displacement
    in_part    // by half of that; a quarter where a side is continued, too; not beyond two
  };


  /**
   * Of the sides left, right, bottom, top, back, front. With `Surface correction = fictitious
   * nodes` all go on. With `auto` they do where the scene allows, for `Models = peridynamics`; in
   * motion, where bonds may break, and along directions in which a body without holes on a lattice
   * is a third as long as along another one or less, and 16 horizons at most, those without
   * conditions do in part: the nodes that fictitious ones follow are stiff, at corners most, and
   * explicit steps would be short; and slender bodies would bend too little. Not collective.
   */
  template <int dim>
  std::array<BeyondSide, 2 * dim> beyond_sides(const BodyParameters<dim> &body);


  /** Lengths of a lattice along its axes, with the mirror image at planes of symmetry. */
  template <int dim>
  dealii::Tensor<1, dim> whole_extent(const BodyParameters<dim> &body);


  /**
   * In motion, where bonds may break, and in slender bodies on a lattice, families of an elastic
   * body that end elsewhere, at voids and free sides, are completed by their own bonds (on a
   * lattice FamilyCompletion, on a mesh FictitiousBondSearch::on_mesh()), with `Surface correction
   * = auto`; so are those at thin parts of meshes at rest (ThinParts). Not collective.
   */
  template <int dim>
  bool completes_at_surfaces(const BodyParameters<dim> &body);


  /**
   * Some families end where the body does, and nothing makes up for it, or, on a mesh whose bonds
   * may break or in motion, their own bonds as far as they can. Not collective.
   */
  template <int dim>
  bool families_end(const BodyParameters<dim> &body);


  /**
   * Families of an elastic body on a mesh from a file go on beyond its sides, with `Surface
   * correction = auto`. Not collective.
   */
  template <int dim>
  bool completes_mesh(const BodyParameters<dim> &body);


  /** Then: beyond this one, of those that are no planes of symmetry. Not collective. */
  template <int dim>
  bool goes_on_beyond(const BodyParameters<dim> &body, const dealii::types::boundary_id side);


  /** A side without displacements and tractions. Not collective. */
  template <int dim>
  bool is_free(const BodyParameters<dim> &body, const dealii::types::boundary_id side);


  /**
   * On a mesh from a file families go on in part beyond free sides where the body behind them is
   * thinner than this: what linear continuation adds makes parts that are n cells thick about 1 +
   * (2.45 + 0.25 m^2)/n^2 times as stiff in bending. Not collective.
   */
  template <int dim>
  double thin_on_mesh(const BodyParameters<dim> &body);


  /**
   * With `Surface correction = auto`: why no families can go on; empty where they can, and with
   * other corrections.
   */
  template <int dim>
  std::string hindrance_of_fictitious_nodes(const BodyParameters<dim> &body);


  /**
   * For `Models = peridynamics`: that families end at the sides, with `none` or since `auto` is
   * hindered, and where one row of nodes bears what acts there; with what to do. With `none` empty
   * where nothing is held or loaded so. Not collective.
   */
  template <int dim>
  std::string note_on_cut_sides(const BodyParameters<dim> &body);


  /**
   * For `Models = peridynamics` with nodes at cell centers: that a displacement holds a row of
   * nodes inside the side, and what this does; empty where no families go on beyond such a side, or
   * a layer of two rows is held. Not collective.
   */
  template <int dim>
  std::string note_on_held_rows(const BodyParameters<dim> &body);


  /**
   * What `Surface correction = auto` does, for reports: "fictitious nodes beyond left, right", or
   * "none" and why.
   */
  template <int dim>
  std::string automatic_correction(const BodyParameters<dim> &body);
} // namespace PeriDeal
