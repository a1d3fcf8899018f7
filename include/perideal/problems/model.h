// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/mesh/node_search.h>
#include <perideal/scene/scene.h>

#include <memory>
#include <utility>
#include <vector>

namespace PeriDeal
{
  template <int dim>
  class Problem;

  /**
   * Finite elements, peridynamics or both coupled, during a run: the numbering of the mesh's nodes,
   * the nodes with their halo and neighbours, and the problems that live on them. All problems of a
   * model have one unknown, or interleaved ones, at each of the same nodes.
   */
  template <int dim>
  class Model
  {
  public:
    /** The mesh has to outlive this object. Not collective. */
    Model(const ModelKind kind, const dealii::Triangulation<dim> &mesh);
    ~Model();

    /** Number the nodes of an element, unless that has been done. Collective. */
    void number(const dealii::FiniteElement<dim> &element,
                const Domain<dim>                &domain,
                const bool                        along_lattice);

    /** Those of number(). Not collective. */
    dealii::DoFHandler<dim> &dofs()
    {
      return handler;
    }

    /**
     * The peridynamic nodes with this kind of volumes: made when a problem asks for them first,
     * shared by all. Collective.
     */
    Nodes<dim> &nodes(const BodyParameters<dim> &body, const NodalVolume volume);

    /**
     * To be called, before nodes() is, for each body of several problems: the nodes get a halo that
     * is wide enough for the bonds of all. The body has to outlive this object. Not collective.
     */
    void share_nodes(const BodyParameters<dim> &body);

    /** The mesh has changed: nodes have to be numbered and made anew. Not collective. */
    void forget();

    const ModelKind                   kind;
    const dealii::Triangulation<dim> &mesh;

  private:
    void prepare(Nodes<dim> &nodes) const;

    dealii::DoFHandler<dim>                                          handler;
    bool                                                             numbered = false;
    std::vector<const BodyParameters<dim> *>                         bodies; // that share nodes
    std::vector<std::pair<NodalVolume, std::unique_ptr<Nodes<dim>>>> node_sets;

  public:
    std::vector<std::unique_ptr<Problem<dim>>> companions; // advance before the problem
    std::unique_ptr<Problem<dim>>              problem;    // the one that is reported
  };


  template <int dim>
  using Models = std::vector<std::unique_ptr<Model<dim>>>;
} // namespace PeriDeal
