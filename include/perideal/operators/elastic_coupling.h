// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/tensor.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/full_matrix.h>

#include <perideal/bonds/families.h>
#include <perideal/scene/zone.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * How peridynamic bonds in a zone and finite elements Q1 share one elastic body: which forces the bonds exert, and what is left of each cell's matrix. Both
   * act on the same nodes, the vertices of the mesh; ElasticElements adds up
   *
   *   force on i = sum_j B_ij (u_j - u_i) - (sum of cells R_c u)_i.
   *
   * Every process asks for the bonds of its own nodes and for its own cells only. Not collective unless stated.
   */
  template <int dim>
  class ElasticCoupling
  {
  public:
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    struct Bond
    {
      unsigned int           neighbor;
      dealii::Tensor<2, dim> block; // B_ij, as if no crack were there
      bool                   cut;   // some crack separates the nodes: the bond is broken
    };

    virtual ~ElasticCoupling() = default;

    /** What the rows of an owned node have of bonds, in a fixed order, broken bonds included. @p bonds is overwritten. */
    virtual void bonds_of(const unsigned int node, std::vector<Bond> &bonds) const = 0;

    /**
     * Turn the matrix K_c of an intact cell (rows and columns interleaved) into what is left of it, R_c; broken bonds count as whole ones. Returns whether anything has
     * changed.
     */
    virtual bool change_cell(const Cell &cell, dealii::FullMatrix<double> &stiffness) const = 0;

    /** The matrix that ElasticElements adds up is symmetric. */
    virtual bool symmetric() const = 0;

    /** Whether an owned node is in the zone. */
    virtual bool in_zone(const unsigned int node) const = 0;

    /** The bonds between nodes, and the nodes. */
    virtual const Families<dim> &families() const = 0;

    virtual std::size_t memory_consumption() const = 0;

    /** Share of the body's volume whose nodes are in the zone. Collective. */
    double zone_share() const;
  };


  /** The coupling of a scene. Adds the halo to the nodes. Collective. Throws UserError. */
  template <int dim>
  std::unique_ptr<ElasticCoupling<dim>> make_elastic_coupling(Nodes<dim>       &nodes,
                                                              const Scene<dim> &scene);
} // namespace PeriDeal
