// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/bond_state.h>
#include <perideal/operators/solid/bond_strengths.h>
#include <perideal/operators/solid/fictitious_bond_search.h>
#include <perideal/operators/solid/fictitious_images.h>
#include <perideal/operators/solid/solid_rows.h>
#include <perideal/operators/solid/thermal_strains.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** Numbers of bonds, ascending, and how far each is stretched over the critical stretch. */
  using Overstretched = std::vector<std::pair<std::size_t, double>>;


  /**
   * The bonds of the linear peridynamic solid that lead beyond the sides of the body, to fictitious
   * nodes (FictitiousExtension, of meshes BoundaryImage) whose displacement u_g = P u is linear in
   * that of the nodes. Only families of nodes of the body have energy: a bond (i, g) is one of i
   * alone, in theta_i and q_i, with the spring (b_i/q_i)/(W x^2) of its own end. The force on i is
   * that of any bond; the opposite one on g is passed on through P^T, so that K stays symmetric and
   * forces and moments balance.
   *
   * A bond whose node is cut off by a crack from one that g follows is none; beyond a plane of
   * symmetry cracks are mirrored. Vectors: u has a value for each component of owned nodes and
   * ghosts, the latter up to date. tau = c theta/q of the nodes is zero without dilatations.
   */
  template <int dim>
  class FictitiousBonds
  {
  public:
    struct Bond
    {
      std::size_t            number;
      unsigned int           node, image;
      dealii::Tensor<1, dim> moment; // W xi, of the tangent W x Y/|Y|
      double                 spring;
      bool                   whole;
    };

    /**
     * Families have to outlive this object, with the cracks that they have now. Collective.
     * @param completes what ends at other sides and at voids is made up for (FamilyCompletion)
     * @param may_pack  store which of their family bonds are: with linear kinematics, where cracks
     *                  do not grow
     */
    FictitiousBonds(const Families<dim>                   &families,
                    const std::array<BeyondSide, 2 * dim> &beyond,
                    const bool                             completes,
                    const bool                             may_pack);

    /** The same of a mesh, as FictitiousBondSearch::on_mesh(). Collective. */
    FictitiousBonds(const Families<dim>                   &families,
                    const std::vector<BoundaryImage<dim>> &beyond,
                    const std::vector<BoundaryImage<dim>> &everywhere);

    /** Add sum W x^2/V_i to q of the owned nodes. */
    void add_weights(Vector &q) const;

    /** Make the springs those of b_i/q_i; @p full: of full kinematics. Laws are referred to. */
    void find_springs(const NodeLaws<dim> &laws, const bool full);

    void set_thermal_strains(const ThermalStrains &strain);

    /** Visit the unbroken and broken ones of an owned node: visit(bond). */
    template <typename Visit>
    void for_each_of(const unsigned int i, const Visit &visit) const
    {
      if (const std::size_t place = place_of(i); place < list.size())
        visit_place(place, visit);
    }

    template <typename Visit>
    void for_each(const Visit &visit) const
    {
      for (std::size_t place = 0; place < list.size(); ++place)
        visit_place(place, visit);
    }

    /** The fictitious nodes. Their displacements have to be found for the next four functions. */
    const FictitiousImages<dim> &images() const
    {
      return fictitious;
    }

    /** See FictitiousImages. */
    void keep_forces()
    {
      fictitious.keep_forces();
    }

    /** u_g - u_i. */
    dealii::Tensor<1, dim> change(const Bond &bond, const double *u) const;
    dealii::Tensor<1, dim> bond_vector(const Bond &bond) const
    {
      return fictitious[bond.image].place - families.nodes().position(bond.node);
    }

    /** W x e, thermal extension taken off. */
    double extension_moment(const Bond &bond, const double *u) const;

    /** Adds K x to y, with tau of owned nodes (or null) that of dilatations. Collective. */
    void add_forces(Vector &y, const Vector &x, const double *tau) const;

    /** W x, also in the deformed body; and the tangent's stiffness across the bond. */
    double length(const Bond &bond) const
    {
      return lengths.empty() ? bond.moment.norm() : lengths[bond.number];
    }

    double stiffness_across(const Bond &bond) const
    {
      return across.empty() ? 0. : across[bond.number];
    }

    /** Add to c theta/q; @p strained: for thermal strains and with full kinematics. */
    void add_tensions(Vector              &tau,
                      const Vector        &u,
                      const NodeLaws<dim> &laws,
                      const bool           strained) const;

    /** -F of the deformed or warmer body. Collective. */
    void add_strained_forces(Vector &y, const Vector &u, const Vector &tau) const;

    /** The tangent of the deformed body; across bonds add_geometric_forces(), collective. */
    void linearize(const Vector &u, const Vector &tau);
    void add_geometric_forces(Vector &y, const Vector &x) const;

    /** Without what dilatations store; on this process. */
    double energy(const Vector &u) const;

    /**
     * Add what these bonds change of the diagonal of K, whose dilatations of node i have the factor
     * c d/(q^2 V) in @p factor. Collective.
     */
    void add_to_diagonal(Vector                    &diagonal,
                         const SolidRows<dim>      &rows,
                         const std::vector<double> &factor) const;

    /**
     * What these bonds add to the sums over rows of |K|, by node, if the dilatation of a node has
     * so much that counts with |W xi| in each row. Collective.
     */
    Vector row_sums(const Vector &of_dilatations) const;

    /** Sum of W x and of the factors of all nodes that follow. */
    double sum_of_lengths(const unsigned int i) const;

    /** The image is that of the node itself in a plane of symmetry alone. */
    bool is_own_image(const Bond &bond) const;

    /**
     * Beyond planes of symmetry bonds break as those of the whole body; a bond that lies in the
     * plane counts at no end.
     */
    bool may_break(const Bond &bond) const
    {
      return fictitious.is_mirrored_alone(bond.image);
    }

    unsigned int n_ends(const Bond &bond) const;

    Overstretched find_overstretched(const double *u, const BondStrengths<dim> &critical) const;

    /** Visit the bonds of a list: visit(bond, ratio). */
    template <typename Visit>
    void for_each_in(const Overstretched &bonds, const Visit &visit) const
    {
      std::size_t next = 0; // both are in the same order
      for_each([&](const Bond &bond) {
        if (next < bonds.size() && bonds[next].first == bond.number)
          visit(bond, bonds[next++].second);
      });
    }

    void break_bond(const std::size_t number, const BondState::Mark mark, const double t);

    /**
     * Break those bonds of a node that others, broken by now, would have to hold: of its neighbours
     * @p lost in the body.
     */
    void break_dependent(const unsigned int               node,
                         const std::vector<unsigned int> &lost,
                         const double                     t);

    /** Cut those bonds of a node that cracks cut as they are now. @param t since when */
    void part(const unsigned int node, const double t);

    /** Some bond of a node has been cut by a crack that grows. */
    bool is_parted(const unsigned int node) const;

    /** What they add to q of a node, with the cracks as they are; broken ones included. */
    double weight_left(const unsigned int node) const;

    /** Where cracks grow: make the springs of a node those of b_i/q_i as it is now. */
    void renew_springs(const unsigned int node, const NodeLaws<dim> &laws);

    /** As BondState::exchange(); what is returned is to be broken. */
    std::vector<BondState::Kept> exchange(Archive          &archive,
                                          const NodeKeys   &keys,
                                          const std::size_t n_first);

    /** How many are not whole. */
    std::size_t n_marks() const
    {
      return state.n_marks();
    }

    std::size_t memory_consumption() const;

  private:
    void release(const std::size_t number); // bears nothing any more

    std::size_t place_of(const unsigned int node) const // in the list, or its size
    {
      const auto found = std::lower_bound(list.begin(), list.end(), node);
      return found != list.end() && *found == node ? found - list.begin() : list.size();
    }

    template <typename Visit>
    void visit_place(const std::size_t place, const Visit &visit) const
    {
      for (std::size_t k = starts[place]; k < starts[place + 1]; ++k)
        visit(bond_at(k, list[place]));
    }

    Bond bond_at(const std::size_t number, const unsigned int node) const;

    using Term = typename FictitiousImages<dim>::Term;

    void take(FictitiousBondList<dim> &&found, const bool may_pack);

    /** Y, with full kinematics W x Y/|Y|, else the moment. */
    dealii::Tensor<1, dim> direction(const Bond &bond, const double *u) const;

    /** A force of a bond: y less it, and the opposite one to the image. */
    void subtract_force(Vector &y, const Bond &bond, const dealii::Tensor<1, dim> &force) const;

    const Families<dim>                &families;
    FictitiousImages<dim>               fictitious;
    std::vector<unsigned int>           list;   // owned nodes that have such bonds
    std::vector<std::size_t>            starts; // of the bonds of these
    std::vector<unsigned int>           image_of_bond;
    BondState                           state;
    std::vector<dealii::Tensor<1, dim>> moments;
    std::vector<double>                 springs, lengths, across, strains; // springs: first W x^2
    std::vector<double>                 squares;       // W x^2, where cracks grow
    bool                                packs = false; // then instead of moments and springs:
    std::vector<BondCode::Code>         codes;
    std::vector<UnitBond<dim>>          units;
    const NodeLaws<dim>                *laws = nullptr; // once springs are found
  };
} // namespace PeriDeal
