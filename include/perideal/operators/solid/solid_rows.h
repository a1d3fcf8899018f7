// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/bond_state.h>
#include <perideal/bonds/families.h>
#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/solid/deformed_rows.h>
#include <perideal/operators/solid/node_laws.h>
#include <perideal/operators/solid/unit_bonds.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  template <int dim>
  class StateLattice;


  /**
   * The bonds of the linear peridynamic solid between nodes of the body (StateOperator), row by
   * row, and the sums over them that an application takes. On a lattice in 2D and 3D, with linear
   * kinematics, where no surface is corrected, nodes store none (StateLattice) whose bonds no crack
   * cuts, now or later. Other bonds are stored at both ends: W xi, one number, a column; on such a
   * lattice a column and which bond of its family it is, from which the others follow.
   *
   * A bond that breaks, or that a growing crack cuts, stays in its row and bears nothing
   * (release()). A node gets a row when the first of its bonds is about to break (store_row()): its
   * sums then are those of the row, what the lattice finds there is overwritten.
   */
  template <int dim>
  class SolidRows
  {
  public:
    /** A bond of an owned node. */
    struct Bond
    {
      std::size_t            number; // among those that are stored, or not_stored
      unsigned int           neighbor;
      dealii::Tensor<1, dim> moment; // W xi, of the tangent W x Y/|Y|
      double                 spring; // (b_i/q_i + b_j/q_j)/(W x^2)
    };

    static constexpr std::size_t not_stored = static_cast<std::size_t>(-1);

    using LatticeBond = UnitBond<dim>;

    /**
     * Sets q of the owned nodes to the sums over these bonds. Families and laws have to outlive
     * this object. Collective. Throws UserError: isolated nodes.
     */
    SolidRows(const Families<dim> &families, NodeLaws<dim> &laws, const BodyParameters<dim> &body);
    ~SolidRows();

    /** Once q is final, and on ghosts; `Surface correction` changes it here. Collective. */
    void find_springs(const BodyParameters<dim> &body);

    /** Visit the bonds of an owned node, broken or not, stored or not, in its family's order. */
    template <typename Visit>
    void for_each(const unsigned int i, const Visit &visit) const
    {
      if (is_on_lattice(i))
        for_each_of(i, lattice_bonds, visit);
      else
        for_each_stored(i, visit);
    }

    template <typename Visit>
    void for_each_stored(const unsigned int i, const Visit &visit) const
    {
      for (std::size_t k = begin_of(i); k < end_of(i); ++k)
        visit(packs ? packed(i, k) : Bond{k, neighbors[k], moments[k], springs[k]});
    }

    /** Those of a list of a node that stores none, to the last bit as it would store them. */
    template <typename Visit>
    void for_each_of(const unsigned int              i,
                     const std::vector<LatticeBond> &list,
                     const Visit                    &visit) const;

    /** The owned node stores no bonds. */
    bool is_on_lattice(const unsigned int i) const
    {
      return !row_of.empty() && row_of[i] == no_row;
    }

    /** Let an owned node store its bonds, which gives them the next numbers. */
    void store_row(const unsigned int i);

    /** Its family and those of its neighbours are like most others. */
    bool is_regular(const unsigned int i) const;

    /** Those of a complete family, if some nodes store none. */
    const std::vector<LatticeBond> &bonds_on_lattice() const
    {
      return lattice_bonds;
    }

    /** q of a complete family on the lattice. */
    double complete_weighted() const;

    /**
     * tau = c theta/q of the owned nodes, thermal strains left aside. @p u has ghosts. Not
     * collective.
     */
    void find_tensions(double *tau, const double *u) const;

    /**
     * y = -F of the owned nodes. Owned and ghost values; tau those of the last find_tensions(), or
     * null: only what the extensions of bonds do. Not collective.
     */
    void find_forces(double *y, const double *u, const double *tau) const;

    /**
     * Whether a bond that an owned node stores may have e/x, thermal strains left aside, above a
     * positive number; errs to the side of yes, by round-off. With a lattice; ghosts as above.
     */
    bool may_exceed(const unsigned int i, const double *u, const double stretch) const;

    /** Let a bond bear nothing any more. */
    void release(const std::size_t number);

    /**
     * q of the bonds in the body of an owned node that cracks leave it now, broken ones included;
     * @p message is set, if it is empty, where they do not hold it.
     */
    double weight_left(const unsigned int i, std::string &message) const;

    /** Make the springs of the whole bonds of an owned node those of q as it is now. */
    void renew_springs(const unsigned int i, const BondState &state);

    /** The rows of a body that stores all of its bonds; referred to. */
    void show(DeformedRows &to) const
    {
      to.starts    = starts.data();
      to.end       = starts.size() - 1;
      to.neighbors = neighbors.data();
      to.springs   = springs.data();
    }

    /** Make a stored bond that of the tangent. */
    void set_moment(const std::size_t number, const dealii::Tensor<1, dim> &moment)
    {
      moments[number] = moment;
    }

    unsigned int neighbor(const std::size_t number) const
    {
      return neighbors[number];
    }

    /** The owned node of which a stored bond is one. */
    unsigned int node_of(const std::size_t number) const
    {
      return stored_nodes[std::upper_bound(starts.begin(), starts.end(), number) - starts.begin() -
                          1];
    }

    /** The numbers of the bonds that an owned node stores. */
    std::size_t begin_of(const unsigned int i) const
    {
      return row_of.empty() ? starts[i] : is_on_lattice(i) ? 0 : starts[row_of[i]];
    }

    std::size_t end_of(const unsigned int i) const
    {
      return row_of.empty() ? starts[i + 1] : is_on_lattice(i) ? 0 : starts[row_of[i] + 1];
    }

    /**
     * Of the stored bonds; referred to. @param stores nodes that are asked for then store their
     * bonds
     */
    BondState::Numbering numbering(const bool stores);

    /** How many of this process's bonds are stored, each counted at both ends. */
    std::size_t n_stored() const
    {
      return neighbors.size();
    }

    /** Unbroken bonds of this process, those to other processes counted half. */
    double n_bonds() const
    {
      return n_whole;
    }

    /** Owned ones; numbers of bonds go up along this list. */
    const std::vector<unsigned int> &nodes_with_rows() const
    {
      return stored_nodes;
    }

    bool has_lattice() const
    {
      return lattice != nullptr;
    }

    std::size_t memory_consumption() const;

    /**
     * Nodes of all processes that `Surface correction = moments` leaves as they are, and
     * SurfaceFactors::gap.
     */
    unsigned long long n_uncorrected = 0;
    double             moments_gap   = 0.;

  private:
    using Family = std::vector<typename Families<dim>::Member>;

    static constexpr std::uint32_t no_row = static_cast<std::uint32_t>(-1);

    bool              has_complete_family(const unsigned int i) const; // cut or not
    std::vector<bool> find_changing(const BodyParameters<dim> &body) const;
    void              add_row(const unsigned int i, const Family &family); // springs are W x^2
    void              pack_row(const unsigned int i, const Family &family);
    double weight_of(const unsigned int i, const Family &family, std::string &message) const;
    void   correct_surface(const BodyParameters<dim> &body);
    void   make_lattice();

    Bond   packed(const unsigned int i, const std::size_t number) const;
    double volumes_of(const unsigned int i, const std::size_t number) const;

    /** Those that are not gone: visit(number, neighbor, unit bond). */
    template <typename Visit>
    void for_each_packed(const unsigned int i, const Visit &visit) const;

    const Families<dim>                &families;
    NodeLaws<dim>                      &laws;
    const double                        horizon;
    std::vector<std::size_t>            starts{0}; // of the rows, in the order of stored_nodes
    std::vector<unsigned int>           neighbors;
    std::vector<dealii::Tensor<1, dim>> moments;      // none where rows are packed
    std::vector<double>                 springs;      // at first W x^2; as moments
    std::vector<unsigned int>           stored_nodes; // of these the loops are made
    double                              n_whole = 0.;
    std::vector<std::uint32_t> row_of; // of owned nodes, or no_row; empty: all in their order
    std::vector<LatticeBond>   lattice_bonds;
    std::unique_ptr<StateLattice<dim>> lattice; // or none

    // Rows are packed where nodes may store none.
    bool                                        packs = false;
    std::vector<BondCode::Code>                 codes;
    std::vector<std::pair<std::size_t, double>> parts; // what cracks leave of bonds, ascending
  };


  template <int dim>
  template <typename Visit>
  inline void SolidRows<dim>::for_each_of(const unsigned int              i,
                                          const std::vector<LatticeBond> &list,
                                          const Visit                    &visit) const
  {
    const Nodes<dim> &nodes  = families.nodes();
    const auto        site   = nodes.lattice()->index(nodes.position(i));
    const double      volume = nodes.volume(i);
    const double      own    = laws.stiffness(i);
    for (const LatticeBond &bond : list)
      {
        const unsigned int j = families.neighbors().node_at(site + bond.offset);
        if (j == dealii::numbers::invalid_unsigned_int)
          continue;
        const double w = volume * nodes.volume(j);
        visit(Bond{not_stored, j, w * bond.moment, (own + laws.stiffness(j)) / (w * bond.weight)});
      }
  }


  template <int dim>
  inline double SolidRows<dim>::volumes_of(const unsigned int i, const std::size_t number) const
  {
    const double w = families.nodes().volume(i) * families.nodes().volume(neighbors[number]);
    if (!BondCode::is_in_part(codes[number]))
      return w;
    return w * std::lower_bound(parts.begin(), parts.end(), std::make_pair(number, 0.))->second;
  }


  template <int dim>
  inline typename SolidRows<dim>::Bond SolidRows<dim>::packed(const unsigned int i,
                                                              const std::size_t  number) const
  {
    const unsigned int j = neighbors[number];
    if (codes[number] == BondCode::gone)
      return {number, j, dealii::Tensor<1, dim>(), 0.};
    const LatticeBond &bond = lattice_bonds[BondCode::number(codes[number])];
    const double       w    = volumes_of(i, number);
    return {number,
            j,
            w * bond.moment,
            (laws.stiffness(i) + laws.stiffness(j)) / (w * bond.weight)};
  }
} // namespace PeriDeal
