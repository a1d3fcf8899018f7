// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/bond_pieces.h>
#include <perideal/operators/coupling.h>
#include <perideal/scene/scene.h>

#include <array>
#include <vector>

namespace PeriDeal
{
  /**
   * Bondwise exchange on a lattice of equal cells (doc/coupling.md): each active bond is added, and what the finite elements conduct along that very bond is
   * taken away from the cells that it passes,
   *
   *   R_c = K_c + kappa_c (M - Q[A]) - sum of active bonds W_b share L_b,
   *
   * M = sum over the full family of w V^2 share L, A = (1/2) sum w V xi xi^T over the full family, Q[A] the cell matrix of the conductivity A; M = Q[A]
   * on linear fields. So a linear field conducts the same with and without bonds, for any set of them, and R_c is
   * positive semidefinite.
   *
   * W_b = w(xi) V_i V_j kappa, kappa the smallest conductivity of the cells on the bond's way. A bond is active if both nodes are in the zone, its way
   * lies within the body's cells of lattice size, and the conductivity on it varies by less than the factor 1.5. On a graded mesh hanging nodes and others on
   * the side of a larger cell have no bonds.
   */
  template <int dim>
  class LatticeExchange : public Coupling<dim>
  {
  public:
    using typename Coupling<dim>::Bond;
    using typename Coupling<dim>::Cell;

    /** Collective. Throws UserError for a zone without nodes. */
    LatticeExchange(Nodes<dim> &nodes, const Scene<dim> &scene, const Zone<dim> &zone);

    void bonds_of(const unsigned int node, std::vector<Bond> &bonds) const override;
    void possible_neighbors_of(const unsigned int         node,
                               std::vector<unsigned int> &neighbors) const override;
    bool change_cell(const Cell &cell, dealii::FullMatrix<double> &stiffness) const override;
    bool leaves_nothing(const Cell &cell) const override;
    bool has_form() const override;
    std::unique_ptr<BondForm>             make_form() override;
    void                                  set_form_factors(std::vector<double> factors) override;
    bool                                  symmetric() const override;
    std::vector<dealii::BoundingBox<dim>> joining_by(const double time) const override;
    void                                  set_cracks_of(const double time) override;
    bool                                  in_zone(const unsigned int node) const override;
    const Families<dim>                  &families() const override;
    std::size_t                           memory_consumption() const override;


  private:
    using Site = typename Lattice<dim>::Index;

    /** What the lattice has at a site and in the cell whose lowest corner that is. */
    struct SiteData
    {
      unsigned int node    = dealii::numbers::invalid_unsigned_int;
      bool         in_zone = false, may_join = false; // now; at the end of the run
      bool         cell   = false; // the body has that cell, and it has lattice size
      double       volume = 0.;
      double       lowest = 0., highest = 0.; // conductivity in the cell
    };

    /** A bond of the half family. */
    struct Offset
    {
      Site                        site;
      double                      weight; // w of unit conductivity
      std::vector<BondPiece<dim>> pieces;
    };

    /** One piece of a bond within a cell, seen from the cell. */
    struct Passage
    {
      unsigned int                     offset, piece;
      Site                             start;  // of the bond, relative to the cell's lowest corner
      typename BondPiece<dim>::Corners change; // over the square root of the length
    };

    void            find_offsets();
    void            find_sites(const Scene<dim> &scene);
    void            set_table_around(const std::vector<bool> &candidates);
    void            find_cells(const Scene<dim> &scene);
    void            find_full_matrix();
    const SiteData *at(const Site &site) const;
    SiteData       &own(const Site &site);
    Site            site_of(const unsigned int node) const;
    double          conductivity_on(const Offset &offset, const Site &start) const;

    Families<dim>              bonds;
    Zone<dim>                  zone;
    double                     last; // time of the run
    OperatorForm               form       = OperatorForm::automatic;
    bool                       plain      = true; // no void, one conductivity, one cell size
    bool                       calibrated = true; // A is the unit matrix
    Site                       corner{}, extent{};
    std::vector<SiteData>      sites; // of the box around all nodes that may ever be in the zone
    std::vector<Offset>        offsets;
    std::vector<Passage>       passages;
    dealii::FullMatrix<double> surplus; // M - Q[A], for unit conductivity
    Site                       reach{};
  };
} // namespace PeriDeal
