// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/mesh/cell_paths.h>
#include <perideal/operators/coupling/coupling.h>
#include <perideal/operators/coupling/exchange_laws.h>
#include <perideal/scene/body_parameters.h>

#include <map>
#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * Bondwise exchange on any mesh of quadrilaterals or hexahedra (doc/coupling.md): each bond is
   * followed through the cells on its way, and cells may be distorted. What the bonds of a zone
   * would take from a distorted cell can be more than it has: with lambda_c the largest eigenvalue
   * of sum W_b L_b (x) v v^T against what bonds can carry there (of a solid k_c (dd + dd + dd),
   * else K_c) on linear fields each bond is scaled by
   *
   *   s_b = min(1, 0.9 min over its way of 1/lambda_c),
   *
   * and R_c = K_c + H E H^T - sum s_b W_b L_b (x) v v^T, H orthonormal and orthogonal to linear
   * fields, E the smallest that makes R_c positive semidefinite: the positive part of
   * B^T A^+ B - C, with A, B, C the linear, mixed and hourglass blocks of the rest of R_c. The law,
   * ConductingBonds or ElasticBonds, gives v and k.
   */
  template <int dim, typename Law>
  class MeshExchange : public Coupling<dim>
  {
  public:
    using typename Coupling<dim>::Bond;
    using typename Coupling<dim>::Cell;

    /**
     * Collective. Throws UserError for a zone without nodes, and for cells so distorted that hardly
     * any bond is left.
     */
    MeshExchange(Nodes<dim> &nodes, const BodyParameters<dim> &body, const Zone<dim> &zone);
    ~MeshExchange() override;

    void bonds_of(const unsigned int node, std::vector<Bond> &bonds) const override;
    void possible_neighbors_of(const unsigned int         node,
                               std::vector<unsigned int> &neighbors) const override;
    bool change_cell(const Cell &cell, dealii::FullMatrix<double> &stiffness) const override;
    std::vector<dealii::BoundingBox<dim>> joining_by(const double time) const override;
    void                                  join(const double time) override;
    bool                                  in_zone(const unsigned int node) const override;
    void                                  take_conductivities_at(const Vector &u) override;
    std::size_t                           memory_consumption() const override;

    /** sum s_b W_b over sum W_b. */
    double kept_share() const override;

  private:
    static constexpr unsigned int n_corners = dealii::GeometryInfo<dim>::vertices_per_cell;
    static constexpr unsigned int n_values  = Law::n_components * n_corners;

    /** Of a cell of this process, or of a copy of one of another. */
    struct CellState
    {
      typename CellStiffness<dim>::Range of_stiffness; // k
      double                             strain = 0.;  // lambda_c
    };

    /** Between two nodes known here, the first one of them where the bond starts. */
    struct ZoneBond
    {
      unsigned int nodes[2];
      double       intact; // without cracks and scaling
      double       scale = 1.;
    };

    void                   find_cells();
    void                   send_cells();
    void                   share_states();
    void                   find_paths(const std::vector<bool> &hanging);
    void                   find_bonds();
    void                   scale_bonds(const std::vector<unsigned int> &way_cells,
                                       const std::vector<std::size_t>  &way_ends);
    dealii::Tensor<1, dim> vector_of(const ZoneBond &bond) const; // xi

    bool follow(const ZoneBond &bond, std::vector<PathPiece<dim>> &way);

    /**
     * Which end of a bond it is followed from: a matter of round-off on the surface of the body, so
     * it is that of lower coordinates, on any process.
     */
    bool starts_at(const unsigned int one, const unsigned int other) const;

    void take(const ZoneBond &bond, const double weight, const std::vector<PathPiece<dim>> &way);
    void find_strains();

    using Coupling<dim>::own_families;
    using Coupling<dim>::zone;

    Law                                               law;
    const CellStiffness<dim>                          stiffness;
    std::vector<bool>                                 joined, may_join; // by local number of nodes
    bool                                              stays = false;    // all have joined
    std::vector<PathCell<dim>>                        cells;            // this process's first
    std::vector<CellState>                            states;           // of cells
    std::vector<unsigned int>                         cell_of_index;    // by active cell index
    std::map<unsigned int, std::vector<unsigned int>> sent, received;   // cells, by process
    std::unique_ptr<CellPaths<dim>>                   paths;
    std::vector<ZoneBond>                             zone_bonds;
    std::vector<std::vector<unsigned int>>            bonds_of_node; // owned
    std::vector<std::vector<double>>                  taken;         // of own cells; empty: no bond
  };
} // namespace PeriDeal
