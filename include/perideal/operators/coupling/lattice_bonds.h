// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/bond_pieces.h>
#include <perideal/laws/interface.h>
#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/coupling/breakable_zone.h>
#include <perideal/operators/coupling/cell_stiffness.h>
#include <perideal/operators/coupling/coupling.h>
#include <perideal/scene/body_parameters.h>

#include <limits>
#include <vector>

namespace PeriDeal
{
  /**
   * A coupling by exchange on a lattice of equal cells, as far as diffusion and elasticity have it
   * in common: its active bonds, and the cells that they pass.
   *
   * A bond has the strength w(xi) V_i V_j k, with k the smallest stiffness (conductivity) of the
   * cells on its way, and along the rim of a void no more than cells have to give: w(xi) V^2 k, V
   * of a cell, times the part of the cells around its way that exist. It is active if both nodes
   * are in the zone, its way lies within the body's cells of lattice size, and the stiffness on it
   * varies by less than the factor largest_contrast; where it depends on the temperature,
   * kept_at_contrast() of the bond is active.
   * On a graded mesh hanging nodes and others on the side of a larger cell have no bonds.
   */
  template <int dim>
  class LatticeBonds : public Coupling<dim>, public BreakableZone<dim>
  {
  public:
    using typename BreakableZone<dim>::Joining;
    using typename Coupling<dim>::Cell;
    using Site = typename Lattice<dim>::Index;

    /** What the lattice has at a site and in the cell whose lowest corner that is. */
    struct SiteData
    {
      unsigned int node    = dealii::numbers::invalid_unsigned_int;
      bool         in_zone = false, may_join = false; // now; at the end of the run
      bool         cell   = false; // the body has that cell, and it has lattice size
      double       volume = 0.;
      double       lowest = 0., highest = 0.; // stiffness in the cell
    };

    /** A bond of the half family. */
    struct Offset
    {
      Site   site;
      double weight; // w of unit stiffness; from the families' lattice members at first
      std::vector<BondPiece<dim>> pieces;
    };

    /** One piece of a bond within a cell, seen from the cell. */
    struct Passage
    {
      unsigned int                     offset, piece;
      Site                             start;  // of the bond, relative to the cell's lowest corner
      typename BondPiece<dim>::Corners change; // over the square root of the length
    };

    /** Collective. Throws UserError for a zone without nodes. */
    LatticeBonds(Nodes<dim>                &nodes,
                 const BodyParameters<dim> &body,
                 const Zone<dim>           &zone,
                 const CellStiffness<dim>  &stiffness);

    /** xi. */
    dealii::Tensor<1, dim> vector_of(const Offset &offset) const;

    /**
     * Visit (neighbour, offset, strength, whether it has been marked broken) for the active bonds
     * of an owned node, broken ones included, in a fixed order.
     */
    template <typename Visit>
    void for_each_bond(const unsigned int node, const Visit &visit) const;

    /**
     * Visit (passage, strength of the bond in this cell) for the active bonds that pass the cell
     * with that lowest corner.
     */
    template <typename Visit>
    void for_each_passage(const Site &cell, const Visit &visit) const;

    /** The same for the full family, with whole volumes and unit stiffness. */
    template <typename Visit>
    void for_each_full_passage(const Visit &visit) const;

    BreakableZone<dim> *breakable() override
    {
      return this;
    }

    const Families<dim> &families_of_bonds() const override
    {
      return own_families;
    }

    double weight_of(const unsigned int node) const override
    {
      return in_zone(node) ? 1. : 0.;
    }

    /** A cell keeps nothing once a bond of its own breaks. */
    bool is_free(const unsigned int node) const override
    {
      return in_zone(node);
    }

    bool may_break(const unsigned int, const unsigned int) const override
    {
      return true;
    }

    bool parts_cell(const Cell &cell) const override
    {
      return this->parts(cell);
    }

    /** Nodes within one horizon that may join the zone. */
    void find_joining(const dealii::Point<dim> &place, std::vector<Joining> &list) const override;
    void join_nodes(const std::vector<Joining> &list) override;

    void possible_neighbors_of(const unsigned int         node,
                               std::vector<unsigned int> &neighbors) const override;

    /** Cells of lattice size only have bonds. */
    bool is_of_lattice(const Cell &cell) const;

    /** Stiffness of a cell of the table, the smallest in it. */
    double stiffness_of(const Site &cell) const;

    std::vector<dealii::BoundingBox<dim>> joining_by(const double time) const override;
    void                                  join(const double time) override;
    void                                  take_conductivities_at(const Vector &u) override;
    bool                                  in_zone(const unsigned int node) const override;
    std::size_t                           memory_consumption() const override;

    using Coupling<dim>::zone;
    std::vector<Offset>  offsets;
    std::vector<Passage> passages;
    Site                 reach{};
    bool                 plain = true; // no void, one stiffness, one cell size

  protected:
    using Coupling<dim>::own_families;

  private:
    void            find_offsets();
    void            find_sites(const BodyParameters<dim> &body);
    void            set_table_around(const std::vector<bool> &candidates);
    void            find_cells(const BodyParameters<dim> &body);
    void            find_range(const Site &cell, const Vector *const u);
    const SiteData *at(const Site &site) const;
    SiteData       &own(const Site &site);
    Site            site_of(const unsigned int node) const;
    double strength_of(const Offset &offset, const Site &start, const double volumes) const;

    const CellStiffness<dim> stiffness;
    double                   last;                      // time of the run
    bool                     stays             = false; // all that may join the zone are in it
    bool                     uniform           = true;
    double                   uniform_stiffness = 0.;
    Site                     corner{}, extent{};
    std::vector<SiteData>    sites; // of the box around all nodes that may ever be in the zone
  };


  template <int dim>
  inline const typename LatticeBonds<dim>::SiteData *LatticeBonds<dim>::at(const Site &site) const
  {
    std::size_t key = 0;
    for (unsigned int d = dim; d-- > 0;)
      {
        const int x = site[d] - corner[d];
        if (x < 0 || x >= extent[d])
          return nullptr;
        key = key * extent[d] + x;
      }
    return key < sites.size() ? &sites[key] : nullptr;
  }


  /** @param volumes V_i V_j */
  template <int dim>
  inline double LatticeBonds<dim>::strength_of(const Offset &offset,
                                               const Site   &start,
                                               const double  volumes) const
  {
    if (plain)
      return uniform_stiffness * offset.weight * volumes;
    double lowest = std::numeric_limits<double>::max(), highest = 0., least = 1.;
    for (const BondPiece<dim> &piece : offset.pieces)
      {
        double n_around = 0.;
        for (const Site &cell : piece.cells)
          if (const SiteData *data = at(start + cell); data != nullptr && data->cell)
            {
              n_around += 1.;
              lowest  = std::min(lowest, data->lowest);
              highest = std::max(highest, data->highest);
            }
        if (n_around == 0.)
          return 0.;
        least = std::min(least, n_around / piece.cells.size());
      }
    const double whole = own_families.nodes().lattice()->cell_volume(),
                 most  = lowest * offset.weight * std::min(volumes, least * whole * whole);
    if (stiffness.depends_on_temperature())
      return most * kept_at_contrast(highest / lowest);
    return highest > largest_contrast * lowest ? 0. : most;
  }


  template <int dim>
  template <typename Visit>
  void LatticeBonds<dim>::for_each_bond(const unsigned int node, const Visit &visit) const
  {
    const Site      site = site_of(node);
    const SiteData *own  = at(site);
    if (own == nullptr || !own->in_zone)
      return;
    for (const bool forward : {false, true})
      for (const Offset &offset : offsets)
        {
          Site start = site, other = site;
          for (unsigned int d = 0; d < dim; ++d)
            (forward ? other : start)[d] += (forward ? 1 : -1) * offset.site[d];
          const SiteData *neighbor = at(forward ? other : start);
          if (neighbor == nullptr || !neighbor->in_zone)
            continue;
          const double strength = strength_of(offset, start, own->volume * neighbor->volume);
          if (strength != 0.)
            visit(neighbor->node, offset, strength, this->is_broken(node, neighbor->node));
        }
  }


  template <int dim>
  template <typename Visit>
  void LatticeBonds<dim>::for_each_passage(const Site &cell, const Visit &visit) const
  {
    for (const Passage &passage : passages)
      {
        const Offset   &offset = offsets[passage.offset];
        const Site      start  = cell + passage.start;
        const SiteData *a      = at(start);
        if (a == nullptr || !a->in_zone)
          continue;
        const SiteData *b = at(start + offset.site);
        if (b == nullptr || !b->in_zone)
          continue;
        const double strength = strength_of(offset, start, a->volume * b->volume);
        if (strength == 0.)
          continue;
        unsigned int n_around = 0;
        for (const Site &other : offset.pieces[passage.piece].cells)
          if (const SiteData *data = at(start + other); data != nullptr && data->cell)
            ++n_around;
        visit(passage, strength / n_around);
      }
  }


  template <int dim>
  template <typename Visit>
  void LatticeBonds<dim>::for_each_full_passage(const Visit &visit) const
  {
    const double volume = own_families.nodes().lattice()->cell_volume();
    for (const Passage &passage : passages)
      {
        const Offset &offset = offsets[passage.offset];
        visit(passage, offset.weight * volume * volume / offset.pieces[passage.piece].cells.size());
      }
  }
} // namespace PeriDeal
