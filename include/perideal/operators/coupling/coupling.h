// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/full_matrix.h>

#include <perideal/bonds/diffusion_bonds.h>
#include <perideal/operators/lattice/bond_form.h>
#include <perideal/scene/zone.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  template <int dim>
  class BreakableZone;
  template <int dim>
  class NodeFamilies;


  /**
   * How peridynamic bonds in a zone and finite elements Q1 share one body: which bonds there are,
   * how strong they are, and what is left of each cell's matrix. Both act on the same nodes, the
   * vertices of the mesh, with one unknown each in diffusion, dim in a solid (rows and columns
   * interleaved). The operators of the elements add up
   *
   *   K u = sum of bonds W_ij v (v . (u_i - u_j)) + sum of families K_f u + sum of cells R_c u,
   *
   * v = 1 for diffusion, the bond's vector xi in a solid. Where a dilatation joins all bonds of
   * a node, they are a family (NodeFamilies).
   *
   * Every process asks for the bonds of its own nodes and for its own cells only. Not collective
   * unless stated.
   */
  template <int dim>
  class Coupling
  {
  public:
    using Bond = typename DiffusionBonds<dim>::Bond;
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    virtual ~Coupling() = default;

    Coupling(const Coupling &)            = delete;
    Coupling &operator=(const Coupling &) = delete;

    /**
     * What the row of an owned node has of bonds, in a fixed order: `weight` W_ij, and `intact` as
     * if no crack were there, broken bonds included. @p bonds is overwritten.
     */
    virtual void bonds_of(const unsigned int node, std::vector<Bond> &bonds) const = 0;

    /** What acts as families of nodes; null where bonds act one by one. */
    virtual const NodeFamilies<dim> *node_families() const
    {
      return nullptr;
    }

    /** Where bonds may break; null where they cannot. */
    virtual BreakableZone<dim> *breakable()
    {
      return nullptr;
    }

    /** A bond between two vertices of a cell has broken, so that nothing is left of the cell. */
    virtual bool parts_cell(const Cell &) const
    {
      return false;
    }

    /**
     * Nodes that an owned node may ever have a bond to, however the zone moves. @p neighbors is
     * overwritten.
     */
    virtual void possible_neighbors_of(const unsigned int         node,
                                       std::vector<unsigned int> &neighbors) const = 0;

    /**
     * Turn the matrix K_c of an intact cell into what is left of it, R_c; broken bonds count as
     * whole ones. Returns whether anything has changed.
     */
    virtual bool change_cell(const Cell &cell, dealii::FullMatrix<double> &stiffness) const = 0;

    /** Last change of a cell's matrix, after cracks have cut it. Returns as change_cell(). */
    virtual bool finish_cell(const Cell &, dealii::FullMatrix<double> &) const
    {
      return false;
    }

    /** Whether change_cell() leaves nothing at all of a cell, now and whatever cracks do. */
    virtual bool leaves_nothing(const Cell &) const
    {
      return false;
    }

    /**
     * Bonds that are better kept as a form of their own (BondForm) than in a matrix; null where
     * they are not. The same on all processes.
     */
    virtual DiffusionBonds<dim> *bonds_of_form()
    {
      return nullptr;
    }

    /** K is symmetric. */
    virtual bool symmetric() const
    {
      return true;
    }

    /** Nodes join the zone as cracks grow. The same on all processes. */
    bool zone_follows_cracks() const
    {
      return zone.follows_cracks();
    }

    /**
     * Boxes around the nodes that join the zone on the way to the cracks of that representative
     * time.
     */
    virtual std::vector<dealii::BoundingBox<dim>> joining_by(const double time) const = 0;

    /** The nodes join that joining_by() names; cracks stay as they are. Collective. */
    virtual void join(const double time) = 0;

    /**
     * Move on to the cracks after a change, and the zone with them. A bond's strength follows from
     * the cracks as they are then, their whole path included: bonds that join find themselves
     * broken where a crack has passed before. Collective.
     */
    void apply_change(const ChangeSet<dim> &change)
    {
      join(change.to);
      own_families.cracks().apply_change(change);
    }

    /** Part of the bonds' strength that distorted cells leave. Collective. */
    virtual double kept_share() const
    {
      return 1.;
    }

    /** Share of the body's volume whose nodes are in the zone. Collective. */
    double zone_share() const;

    /** Whether an owned node is in the zone. */
    virtual bool in_zone(const unsigned int node) const = 0;

    /** Of all nodes, whole. */
    const Families<dim> &families() const
    {
      return own_families;
    }

    virtual std::size_t memory_consumption() const = 0;

    /**
     * Bonds and cells get the conductivities at the temperatures u, whose ghosts are up to date.
     * Collective. Throws UserError where one is not positive.
     */
    virtual void take_conductivities_at(const Vector &) {}

  protected:
    using HasBonds = typename Families<dim>::HasBonds;

    /**
     * With the zone as it is with the first cracks.
     * @param has_bonds as Families has it
     *
     * Adds the halo to the nodes. Collective.
     */
    Coupling(Nodes<dim>                &nodes,
             const BodyParameters<dim> &body,
             const Zone<dim>           &given,
             const HasBonds            &has_bonds = {})
      : own_families(nodes, body, HaloAround::cells, has_bonds)
      , zone(given)
    {
      zone = zone_at(own_families.cracks().history().representative(0.));
    }

    /** The zone with the cracks of another time. */
    Zone<dim> zone_at(const double time) const
    {
      Zone<dim> then = zone;
      then.set_cracks(own_families.cracks().history().pieces(time));
      return then;
    }

    Families<dim> own_families;
    Zone<dim>     zone; // now
  };


  /** Of all nodes known here, ghosts included: which are hanging and have no bonds. Collective. */
  template <int dim>
  std::vector<bool> hanging_nodes(const Nodes<dim> &nodes);

  /** Throws the UserError of a zone that has no node on any process. Collective. */
  void throw_if_zone_empty(const double n_nodes, const MPI_Comm communicator);


  /** The coupling of diffusion. Adds the halo to the nodes. Collective. Throws UserError. */
  template <int dim>
  std::unique_ptr<Coupling<dim>> make_coupling(Nodes<dim>                &nodes,
                                               const BodyParameters<dim> &body,
                                               const Zone<dim>           &zone,
                                               const CouplingScheme       scheme);

  /** The coupling of a solid. Otherwise the same. */
  template <int dim>
  std::unique_ptr<Coupling<dim>> make_solid_coupling(Nodes<dim>                &nodes,
                                                     const BodyParameters<dim> &body);
} // namespace PeriDeal
