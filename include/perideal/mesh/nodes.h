// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/partitioner.h>
#include <deal.II/dofs/dof_handler.h>

#include <perideal/mesh/lattice.h>
#include <perideal/scene/boundary_conditions.h>
#include <perideal/scene/choices.h>
#include <perideal/scene/cracks.h>
#include <perideal/scene/domain.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

namespace PeriDeal
{
  template <int dim>
  struct BodyParameters;
  template <int dim>
  class NodeSearch;

  /** What another process needs to know of a node to build bonds to it. */
  template <int dim>
  struct NodeRecord
  {
    dealii::types::global_dof_index global_index = 0;
    double                          volume       = 0.;
    std::array<double, dim>         position, crack_point;
  };


  /**
   * A node's share of the boundary: its part of the area (3D), length (2D) or 1 (1D) of the faces
   * of one boundary id, or of a Part. Of regions and points, which have no area, the shares of all
   * nodes have the sum 1.
   */
  struct BoundaryShare
  {
    unsigned int               node;
    dealii::types::boundary_id id;
    double                     area;
    bool                  inside = true; // the node lies in the part, not only some of its area
    std::array<double, 3> place{};       // of parts: where formulas are taken
  };


  /**
   * Peridynamic nodes on a deal.II mesh: one per FE_Q(1) dof (mesh vertex; the volume is the node's
   * share of the adjacent cells) or one per FE_DGQ(0) dof (cell centre; the volume is the cell's
   * measure).
   *
   * Node l < n_owned() is the dof with global index first_owned() + l; ghosts follow once a halo
   * has been added. All positions, volumes and shares are the same to the last bit on any number of
   * processes.
   */
  template <int dim>
  class Nodes
  {
  public:
    /**
     * @param dof_handler FE_Q(1) or FE_DGQ(0) with dofs distributed; on a lattice renumber them
     *                    first with number_along_lattice().
     * Collective.
     */
    Nodes(const dealii::DoFHandler<dim> &dof_handler,
          const Domain<dim>             &domain,
          const Cracks<dim>             &cracks,
          const NodalVolume              nodal_volume);

    /** The same, of the body's own parameters: those of peridynamics in the whole body. */
    Nodes(const dealii::DoFHandler<dim> &dof_handler, const BodyParameters<dim> &body);

    unsigned int n_owned() const;
    /** Owned nodes and ghosts. */
    unsigned int                    n_local() const;
    dealii::types::global_dof_index first_owned() const
    {
      return first;
    }
    dealii::types::global_dof_index n_global() const;

    const dealii::Point<dim> &position(const unsigned int node) const;
    double                    volume(const unsigned int node) const;

    /**
     * The point that decides on which side of a crack the node is: its position, or for a node
     * doubled by a crack cut into the mesh, or that touches a face of another piece of a mesh from
     * a file, a point slightly inside its own cells.
     */
    dealii::Point<dim> crack_point(const unsigned int node) const;

    /**
     * Shares of owned nodes in boundary faces (both faces of a crack cut into the mesh are not
     * listed). Of stairs in place of the rim of a hole what they have of the rim.
     */
    const std::vector<BoundaryShare> &boundary_shares() const
    {
      return shares;
    }

    /**
     * Find the shares of parts: a node on a part of a side has what of the area that it stands for
     * lies in the part (with vertices the integral of its shape function, so that sums are those of
     * the part), a node of a region its share of the region's volume.
     *
     * Throws UserError for parts without area, regions without nodes. Returns *this. Collective.
     */
    Nodes &find_parts(const BoundaryConditions<dim> &conditions);

    /** Those of boundary_shares() and behind them those of parts. */
    const std::vector<BoundaryShare> &condition_shares() const;

    /**
     * Where formulas of a condition are taken for a share: at the node, or in the middle of the
     * share's area if a part cuts it.
     */
    dealii::Point<dim> place_of(const BoundaryShare &share) const;

    /** The lattice of a box or a plate with a hole. Empty on mesh files. */
    const std::optional<Lattice<dim>> &lattice() const
    {
      return regular;
    }

    /** Some nodes have a crack point of their own. */
    bool has_doubled_nodes() const
    {
      return doubled;
    }

    /** Some cells of the lattice are merged (`Coarsening`), so that sites in them have no node. */
    bool is_graded() const
    {
      return graded;
    }

    /**
     * A node whose value follows from its neighbours', because it lies on the side of a larger
     * cell. For owned nodes.
     */
    bool is_hanging(const unsigned int node) const;

    /** Smallest edge of the lattice, or of the mesh's cells. */
    double smallest_spacing() const
    {
      return shortest_edge;
    }

    const dealii::DoFHandler<dim> &dof_handler() const
    {
      return *dofs;
    }
    MPI_Comm communicator() const;

    NodeRecord<dim> record(const unsigned int node) const;

    /** Append ghosts (sorted by global index here). Collective. */
    void set_ghosts(std::vector<NodeRecord<dim>> ghosts);

    /** Owned nodes and halo, for vectors. Valid after set_ghosts(). */
    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &partitioner() const;

    /**
     * Finds nodes, for all who have bonds on them; null before the first asks (Neighbors). Not
     * collective.
     */
    const std::shared_ptr<const NodeSearch<dim>> &search() const
    {
      return finder;
    }

    void set_search(std::shared_ptr<const NodeSearch<dim>> search);

    /**
     * Share of the body's volume that owned nodes have for which the test, of their local number,
     * holds. Collective.
     */
    double volume_share(const std::function<bool(const unsigned int)> &holds) const;

    /** Bytes held, for the report. */
    std::size_t memory_consumption() const;

  private:
    void find_positions();
    void find_volumes(const NodalVolume nodal_volume);
    void find_hanging();
    void find_boundary_shares(const Holes<dim> &holes);
    void find_crack_points(const Cracks<dim> &cracks);

    const dealii::DoFHandler<dim>                       *dofs;
    dealii::types::global_dof_index                      first;
    unsigned int                                         owned_count = 0;
    std::vector<dealii::Point<dim>>                      positions;
    std::vector<double>                                  volumes;
    std::unordered_map<unsigned int, dealii::Point<dim>> crack_points;
    std::vector<BoundaryShare>  shares, with_parts; // the latter empty without parts
    std::optional<Lattice<dim>> regular;
    bool                        doubled = false, graded = false;
    std::vector<bool>           hanging; // empty: none
    double                      shortest_edge = 0.;
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> layout;
    std::shared_ptr<const NodeSearch<dim>>                     finder;
  };


  template <int dim>
  inline unsigned int Nodes<dim>::n_owned() const
  {
    return owned_count;
  }


  template <int dim>
  inline unsigned int Nodes<dim>::n_local() const
  {
    return static_cast<unsigned int>(positions.size());
  }


  template <int dim>
  inline const dealii::Point<dim> &Nodes<dim>::position(const unsigned int node) const
  {
    AssertIndexRange(node, positions.size());
    return positions[node];
  }


  template <int dim>
  inline double Nodes<dim>::volume(const unsigned int node) const
  {
    AssertIndexRange(node, volumes.size());
    return volumes[node];
  }


  /**
   * Renumber dofs so that on each process x runs fastest, then y, then z. Only for meshes of a box.
   * Collective.
   */
  template <int dim>
  void number_along_lattice(dealii::DoFHandler<dim> &dof_handler, const Domain<dim> &domain);
} // namespace PeriDeal
