// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/solid/bond_ends.h>
#include <perideal/operators/solid/bond_rows.h>
#include <perideal/operators/solid/fictitious_bond_search.h>
#include <perideal/operators/solid/node_laws.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** A bond of an owned node, as sums see it; broken ones bear nothing. */
  template <int dim>
  struct SolidBond
  {
    std::size_t            number;   // of BondTable
    unsigned int           neighbor; // of BondEnds
    dealii::Tensor<1, dim> moment;   // W xi, of the tangent W x Y/|Y|
    double                 spring;   // LinearPeridynamicSolid
  };


  /**
   * The bonds of a solid (StateOperator), node by node: those to nodes of the body, then those that
   * lead beyond its sides to fictitious nodes (FictitiousBondList), whose displacement u_g = P u is
   * linear in that of nodes of the body. Only families of nodes of the body store energy: a bond to
   * a fictitious node is one of its node alone, with the spring of this end. The force on the node
   * is that of any bond; the opposite one is passed on through P^T, so that K stays symmetric and
   * forces and moments balance.
   *
   * On a lattice in 2D and 3D, with linear kinematics, where no surface is corrected, nodes store
   * no bonds in the body (SolidSums) whose bonds no crack cuts, now or later. A node gets a row
   * when the first of its bonds is about to break (store_row()): its sums then are those of the
   * row, what the lattice finds there is overwritten.
   *
   * Which bonds are whole, since when others are not, and what did that, stands here and nowhere
   * else. Displacements have up-to-date ghosts. Not collective unless stated.
   */
  template <int dim>
  class BondTable
  {
  public:
    using Bond = SolidBond<dim>;

    static constexpr std::size_t not_stored = static_cast<std::size_t>(-1);

    /**
     * The bonds in the body. Sets q of the owned nodes to the sums over these. Families, laws and
     * ends have to outlive this object. Collective. Throws UserError: isolated nodes.
     * @param of_nodes empty, or of owned nodes those that have bonds, all of which they store;
     *                 others, on a lattice, have none, and the q of a complete family
     */
    BondTable(const Families<dim>       &families,
              NodeLaws<dim>             &laws,
              const BondEnds<dim>       &ends,
              const BodyParameters<dim> &body,
              const std::vector<bool>   &of_nodes = {});

    /**
     * The bonds to the fictitious nodes of @p ends; adds to q of the owned nodes.
     * @param may_pack linear kinematics, and cracks do not grow
     */
    void go_on_beyond(FictitiousBondList<dim> &&found, const bool may_pack);

    /**
     * Make springs of W x^2, once q is final, and on ghosts.
     * @param full of full kinematics @param n_history of each bond
     */
    void find_springs(const bool full, const unsigned int n_history);

    /** Visit the bonds of an owned node, broken or not, stored or not, in its family's order. */
    template <typename Visit>
    void for_each(const unsigned int i, const Visit &visit) const
    {
      for_each_in_body(i, visit);
      for_each_beyond(i, visit);
    }

    template <typename Visit>
    void for_each_in_body(const unsigned int i, const Visit &visit) const
    {
      if (is_on_lattice(i))
        for_each_of(i, body.units, visit);
      else
        for_each_stored(i, visit);
    }

    template <typename Visit>
    void for_each_stored(const unsigned int i, const Visit &visit) const
    {
      if (!is_on_lattice(i))
        visit_row(body, row_in_body(i), visit);
    }

    template <typename Visit>
    void for_each_beyond(const unsigned int i, const Visit &visit) const
    {
      const auto &nodes = beyond.nodes;
      const auto  place = std::lower_bound(nodes.begin(), nodes.end(), i);
      if (place != nodes.end() && *place == i)
        visit_row(beyond, place - nodes.begin(), visit);
    }

    /** Those of a list of a node that stores none, to the last bit as it would store them. */
    template <typename Visit>
    void for_each_of(const unsigned int                i,
                     const std::vector<UnitBond<dim>> &list,
                     const Visit                      &visit) const;

    /** The owned node stores no bonds in the body. */
    bool is_on_lattice(const unsigned int i) const
    {
      return !row_of.empty() && row_of[i] == no_row;
    }

    /** Let an owned node store its bonds, which gives them the next numbers. */
    void store_row(const unsigned int i);

    /**
     * Whether a bond that an owned node stores in the body may have e/x, thermal strains left
     * aside, above a positive number; errs to the side of yes, by round-off. With a lattice.
     */
    bool may_exceed(const unsigned int i, const double *u, const double stretch) const;

    /** A bond that was whole bears nothing any more. @param t since when */
    void mark(const std::size_t number, const BondState::Mark mark, const double t);

    /** Also of bonds that are not stored. */
    bool is_whole(const std::size_t number) const
    {
      return number == not_stored || rows_of(number).state.is_whole(place(number));
    }

    /** How many bonds are not whole any more, inside and beyond; those at the start apart. */
    using Count = std::array<std::size_t, 2>;

    /** As BondState::exchange(), of all bonds; what is returned is to be marked. Collective. */
    std::vector<BondState::Kept> exchange(Archive        &archive,
                                          const NodeKeys &keys,
                                          const Count    &n_first);

    /** To places in BondTable::beyond this is added, which makes numbers of bonds. */
    static constexpr std::size_t of_beyond = std::size_t(1) << 62;

    const BondRows<dim> &rows_of(const std::size_t number) const
    {
      return (number & of_beyond) != 0 ? beyond : body;
    }

    /** Of a stored bond among its rows. */
    static std::size_t place(const std::size_t number)
    {
      return number & ~of_beyond;
    }

    /** The ends of a stored bond: the node in whose row it is, and the other one. */
    unsigned int node_of(const std::size_t number) const
    {
      return rows_of(number).node_of(place(number));
    }

    unsigned int neighbor(const std::size_t number) const
    {
      return rows_of(number).neighbors[place(number)];
    }

    /** The row of an owned node among BondTable::body; not of one that stores none. */
    std::size_t row_in_body(const unsigned int i) const
    {
      return row_of.empty() ? i : row_of[i];
    }

    std::size_t memory_consumption() const;

    BondRows<dim> body, beyond;

    /** V_i V_j and what cracks leave of it. */
    double volumes_of(const BondRows<dim> &rows, const unsigned int i, const std::size_t k) const
    {
      const double w = families.nodes().volume(i) * ends.volume(rows.neighbors[k]);
      if (!BondCode::is_in_part(rows.codes[k]))
        return w;
      const auto &parts = rows.parts;
      return w * std::lower_bound(parts.begin(), parts.end(), std::make_pair(k, 0.))->second;
    }

    /** b/q of both ends, fictitious ones without. */
    double stiffnesses(const unsigned int i, const unsigned int j) const
    {
      return laws.stiffness(i) + (ends.is_fictitious(j) ? 0. : laws.stiffness(j));
    }

    /** Whole bonds in the body of this process, those to other processes counted half. */
    double n_bonds = 0.;

    /** q of a complete family on the lattice. */
    double complete_weighted = 0.;

  private:
    using Family = std::vector<typename Families<dim>::Member>;

    static constexpr std::uint32_t no_row = static_cast<std::uint32_t>(-1);

    void add_row(const unsigned int i, const Family &family); // springs are W x^2

    Bond bond_at(const BondRows<dim> &rows, const unsigned int i, const std::size_t k) const;

    template <typename Visit>
    void visit_row(const BondRows<dim> &rows, const std::size_t row, const Visit &visit) const
    {
      for (std::size_t k = rows.starts[row]; k < rows.starts[row + 1]; ++k)
        visit(bond_at(rows, rows.nodes[row], k));
    }

    const Families<dim>       &families;
    NodeLaws<dim>             &laws;
    const BondEnds<dim>       &ends;
    std::vector<std::uint32_t> row_of; // of owned nodes; empty: all in their order
  };


  template <int dim>
  inline typename BondTable<dim>::Bond BondTable<dim>::bond_at(const BondRows<dim> &rows,
                                                               const unsigned int   i,
                                                               const std::size_t    k) const
  {
    const std::size_t  number = &rows == &beyond ? k | of_beyond : k;
    const unsigned int j      = rows.neighbors[k];
    if (!rows.is_packed())
      return {number, j, rows.moments[k], rows.springs[k]};
    if (rows.codes[k] == BondCode::gone)
      return {number, j, dealii::Tensor<1, dim>(), 0.};
    const UnitBond<dim> &unit = rows.units[BondCode::number(rows.codes[k])];
    const double         w    = volumes_of(rows, i, k);
    return {number,
            j,
            w * unit.moment,
            LinearPeridynamicSolid::spring(stiffnesses(i, j), w * unit.weight)};
  }


  template <int dim>
  template <typename Visit>
  inline void BondTable<dim>::for_each_of(const unsigned int                i,
                                          const std::vector<UnitBond<dim>> &list,
                                          const Visit                      &visit) const
  {
    const Nodes<dim> &nodes  = families.nodes();
    const auto        site   = nodes.lattice()->index(nodes.position(i));
    const double      volume = nodes.volume(i);
    for (const UnitBond<dim> &unit : list)
      {
        const unsigned int j = families.neighbors().node_at(site + unit.offset);
        if (j == dealii::numbers::invalid_unsigned_int)
          continue;
        const double w = volume * nodes.volume(j);
        visit(Bond{not_stored,
                   j,
                   w * unit.moment,
                   LinearPeridynamicSolid::spring(stiffnesses(i, j), w * unit.weight)});
      }
  }


  /** Exchange the histories of all bonds, n numbers of each. Collective. */
  template <int dim>
  void exchange_histories(BondTable<dim>    &bonds,
                          Archive           &archive,
                          const NodeKeys    &keys,
                          const unsigned int n);


  /** Sum of product(bond) over the bonds of an owned node. */
  template <int dim, typename Product>
  double sum_over_bonds(const BondTable<dim> &bonds, const unsigned int i, const Product &product)
  {
    double sum = 0.;
    bonds.for_each(i, [&](const SolidBond<dim> &bond) { sum += product(bond); });
    return sum;
  }
} // namespace PeriDeal
