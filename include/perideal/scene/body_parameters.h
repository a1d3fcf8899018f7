// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/boundary_conditions.h>
#include <perideal/scene/coupling_control.h>
#include <perideal/scene/crack_history.h>
#include <perideal/scene/domain.h>
#include <perideal/scene/elasticity_control.h>
#include <perideal/scene/material.h>
#include <perideal/scene/models.h>

#include <array>

namespace PeriDeal
{
  /**
   * What operators are built from: a body, its material, what acts on it, its cracks, and the
   * choices of both models. How a run goes on is no matter here.
   *
   * A Scene has them from a file; a program sets the members of HeatParameters or SolidParameters.
   */
  template <int dim>
  struct BodyParameters
  {
    Domain<dim>             domain;
    Material                material;
    InitialAndSource        initial_and_source;
    BoundaryConditions<dim> boundary_conditions;
    Cracks<dim>             cracks;
    Peridynamics            peridynamics;
    CouplingControl         coupling;
    ElasticityControl       elasticity;
    FiniteElements          finite_elements;

    bool deforms = false; // a solid; else diffusion

    struct Run
    {
      bool   steady    = false; // nothing is stored
      double time_step = -1.;   // of diffusion with a given step; negative: none is given
    };

    Run run;

    /**
     * Diffusion: a solid on the same nodes may break its bonds (ChangeSet::broken), which then
     * conduct this part; 1: as before, so that there is nothing to follow.
     */
    double broken_bonds_conduct = 1.;

    /**
     * The horizon as a length: `Horizon`, or `Horizon ratio` times the smallest spacing of the
     * lattice.
     */
    double horizon() const;

    /**
     * Moduli at a place where the temperature has changed by this (section `Elasticity`), or by
     * what is given there; nothing before it has been computed. Errors as Material::moduli().
     */
    Moduli moduli(const dealii::Point<dim> &p, const double temperature_change) const;
    Moduli moduli(const dealii::Point<dim> &p) const;

    /**
     * alpha(T) dT: by what a change of the temperature strains the body where nothing holds it,
     * alpha the mean coefficient between the reference and this temperature.
     */
    double free_expansion(const dealii::Point<dim> &p, const double temperature_change) const;

    /** Moduli follow a temperature that is computed, and are others at each step. */
    bool moduli_change() const
    {
      return elasticity.computes_temperature && material.given.depend_on_temperature();
    }

    /** Ends of cracks cut bonds and cells in part (solids in 2D; check_tips_in_part()). */
    bool cuts_in_part_at_tips() const;

    /**
     * The entry that bonds which share nodes with finite elements (`coupled`, and the treatment
     * `exchange`) cannot have, and why; empty if there is none.
     */
    std::pair<std::string, std::string> obstacle_to_bonds_on_elements() const;

    /**
     * When the cracks change, and how they are in between. Throws UserError, among others where a
     * mesh file needs `Growth step`. The parameters must outlive it.
     */
    CrackHistory<dim> crack_history() const;

    /**
     * For programs whose mesh is a box of equal cells, the lattice of the nodes, with deal.II's
     * boundary ids 0 (left), 1 (right), 2 (bottom), ...
     */
    void set_box(const dealii::Point<dim>            &lower,
                 const dealii::Point<dim>            &upper,
                 const std::array<unsigned int, dim> &cells);

    /**
     * For programs that bring a mesh of any shape, with any boundary ids, and families with this
     * horizon.
     */
    void set_own_mesh(const double horizon);
  };


  /** Beside elements bonds are a list: they may break, or have another law than the linear one. */
  template <int dim>
  bool lists_bonds(const BodyParameters<dim> &body)
  {
    return body.material.breaks() || body.material.law.kind != SolidLaw::linear;
  }


  /**
   * A body with diffusion, as a program describes it: the defaults of a scene, bonds that end at
   * its surface. Conductivity, density and heat capacity are 1 until they are set.
   */
  template <int dim>
  struct HeatParameters : BodyParameters<dim>
  {
    HeatParameters();
  };


  /** An elastic body, likewise. Its moduli have to be set (Material::set_moduli()). */
  template <int dim>
  struct SolidParameters : BodyParameters<dim>
  {
    SolidParameters();
  };
} // namespace PeriDeal
