// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/tensor.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <perideal/bonds/families.h>
#include <perideal/scene/zone.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * How peridynamic bonds in a zone and finite elements Q1 share one elastic body: which forces the
   * bonds exert, and what is left of each cell's matrix. Both act on the same nodes, the vertices
   * of the mesh; ElasticElements adds up
   *
   *   force on i = sum_j B_ij (u_j - u_i) - (sum of families K_f u)_i - (sum of cells R_c u)_i.
   *
   * Bonds that act one by one are pairs; where a dilatation joins all bonds of a node, they are a
   * family with a matrix over all of its nodes. Every process asks for the bonds of its own nodes
   * and for its own cells only. Not collective unless stated.
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

    /** What the family of a node adds to the body, or a part of it. */
    struct Family
    {
      std::vector<unsigned int>  nodes;     // the node, and its neighbours
      std::vector<bool>          has_row;   // of these nodes those to whose rows it adds
      dealii::FullMatrix<double> stiffness; // K_f, rows and columns interleaved like the unknowns
      dealii::Vector<double>     thermal;   // the load by thermal strains
      double                     thermal_energy = 0.; // of a family that is held everywhere
      double n_bonds = 0.; // unbroken ones in the zone; of all families each is counted once
    };

    /** The thermal strain at a node, by its local number. */
    using ThermalStrain = std::function<double(const unsigned int)>;

    virtual ~ElasticCoupling() = default;

    /**
     * What the rows of an owned node have of pairs, in a fixed order, broken bonds included.
     * @p bonds is overwritten.
     */
    virtual void bonds_of(const unsigned int node, std::vector<Bond> &bonds) const = 0;

    /**
     * Visit what the family of an owned node adds, also to rows of other processes.
     *
     * @param intact as if no crack were there
     * @param strain empty: without thermal strains
     */
    virtual void visit_family(const unsigned int /*node*/,
                              const bool /*intact*/,
                              const ThermalStrain & /*strain*/,
                              const std::function<void(const Family &)> & /*visit*/) const
    {}

    /** The same, with `nodes` and `has_row` of the intact body only. */
    virtual void visit_nodes_of_family(const unsigned int /*node*/,
                                       const std::function<void(const Family &)> & /*visit*/) const
    {}

    /** What is wrong with an owned node of the body with its cracks, or nothing. */
    virtual std::string fault_of(const unsigned int /*node*/) const
    {
      return {};
    }

    /**
     * Turn the matrix K_c of an intact cell (rows and columns interleaved) into what is left of it,
     * R_c; broken bonds count as whole ones. Returns whether anything has changed.
     */
    virtual bool change_cell(const Cell &cell, dealii::FullMatrix<double> &stiffness) const = 0;

    /**
     * Planes of symmetry beyond which families go on: what the other half of the body does normal
     * to them acts on all nodes near them, not on those in the plane alone. At most one along each
     * axis.
     */
    virtual std::vector<dealii::types::boundary_id> mirrors() const
    {
      return {};
    }

    /** The matrix that ElasticElements adds up is symmetric. */
    virtual bool symmetric() const = 0;

    /** Whether an owned node is in the zone. */
    virtual bool in_zone(const unsigned int node) const = 0;

    /** The bonds between nodes, and the nodes. */
    virtual const Families<dim> &families() const = 0;

    /**
     * Let cracks be those of another representative time (CrackHistory). The zone is that of their
     * whole way from the start.
     */
    virtual void set_cracks_of(const double time) = 0;

    virtual std::size_t memory_consumption() const = 0;

    /** Share of the body's volume whose nodes are in the zone. Collective. */
    double zone_share() const;
  };


  /** The coupling of a scene. Adds the halo to the nodes. Collective. Throws UserError. */
  template <int dim>
  std::unique_ptr<ElasticCoupling<dim>> make_elastic_coupling(Nodes<dim>       &nodes,
                                                              const Scene<dim> &scene);

  /**
   * Families everywhere, with nothing left to the elements: peridynamics alone. Otherwise the same.
   */
  template <int dim>
  std::unique_ptr<ElasticCoupling<dim>> make_families_everywhere(Nodes<dim>       &nodes,
                                                                 const Scene<dim> &scene);
} // namespace PeriDeal
