// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/recovery.h>
#include <perideal/base/timing.h>
#include <perideal/bonds/families.h>
#include <perideal/problems/model.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  struct CouplingCertificate;

  /** What was chosen, for the report: name and value. */
  using ChosenSettings = std::vector<std::pair<std::string, std::string>>;

  /**
   * A field on the nodes of a model: its unknowns, @p n_components of them at each node,
   * interleaved, their values, and the operator. The model and the scene have to outlive it.
   */
  template <int dim>
  class Field
  {
  public:
    /** Numbers nothing yet. Not collective. */
    Field(Model<dim> &on, const Scene<dim> &scene, const unsigned int n_components);

    virtual ~Field() = default;

    virtual Operator &op() const = 0;

    /** Place of an owned node. Not of finite elements alone for diffusion. Not collective. */
    virtual dealii::Point<dim> position(const unsigned int node) const;

    /** What an owned node has of the body's volume; as position(). Not collective. */
    virtual double volume(const unsigned int node) const;

    /** Collective. */
    virtual ChosenSettings settings() const = 0;

    /**
     * What the user should know of them: where they are known to fail, and what to choose instead.
     * Collective.
     */
    virtual std::vector<std::string> notes() const
    {
      return {};
    }

    Model<dim>                                &on;
    const Scene<dim>                          &scene;
    const unsigned int                         n_components;
    const dealii::DoFHandler<dim>             &handler;            // of the model
    Nodes<dim>                                *node_set = nullptr; // likewise; null: there are none
    Vector                                     solution;
    std::shared_ptr<const CouplingCertificate> certificate; // what is known of a coupling, or null
    Timings                                    timings;

  protected:
    /** Number the nodes of peridynamics by bonds alone, and make them. Collective. */
    void make_bond_nodes();

    /** What was chosen for bonds. Not collective. */
    ChosenSettings bond_settings(const Families<dim> &families) const;
  };


  /** What a problem has more where its mesh is adapted. Functions are collective. */
  class AdaptiveProblem
  {
  public:
    virtual ~AdaptiveProblem() = default;

    /** Square of the error that the recovered flux shows in each cell, which guides the mesh. */
    virtual RecoveryIndicators indicators() const = 0;

    /** The initial state on the mesh as it is now. */
    virtual void start_anew() = 0;

    /** The mesh is about to be adapted: what the solution needs to move on. */
    virtual void before_remesh() = 0;

    /**
     * Unknowns, operator and solution on the mesh as it is now, with the cracks of time t. The heat
     * in the body stays what it was, unless steady.
     */
    virtual void after_remesh(const double t, const bool steady) = 0;

    /** The same without the solution, which is nothing until it is loaded. */
    virtual void rebuild(const double t) = 0;

    /** After after_remesh() of all: a stepper of the new operator, with the cost of the old one. */
    virtual void renew_stepper() = 0;
  };


  /**
   * One component of a vector with @p n of them at each node, as a vector of the nodes with the
   * ghosts of their cells. Collective.
   */
  template <int dim>
  Vector component_of(const dealii::DoFHandler<dim> &dofs,
                      const Vector                  &u,
                      const unsigned int             n,
                      const unsigned int             component);
} // namespace PeriDeal
