// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>
#include <perideal/bonds/fictitious_nodes.h>
#include <perideal/bonds/halo.h>
#include <perideal/laws/lattice_family.h>
#include <perideal/mesh/nodes.h>
#include <perideal/scene/crack_geometry.h>
#include <perideal/scene/crack_history.h>
#include <perideal/scene/scene.h>

#include <functional>
#include <memory>
#include <unordered_map>
#include <vector>

namespace PeriDeal
{
  /**
   * The bonds of each node, one family at a time: who is bonded to whom and with which conductance.
   * This is the plain definition of the peridynamic model, from which both forms of the operator
   * are built.
   *
   * The heat that flows from j to i is W_ij (T_j - T_i) with
   *
   *   W_ij = V_i V_j w(xi) k_ij g_ij t_ij,   w = kernel * volume fraction / r^n
   *
   * (power; 2D per unit thickness, 1D per unit area), k_ij the bond's conductivity by the interface
   * rule, t_ij the cracks' transmission, g_ij the surface correction. `Self term = paper` adds
   * V_i^2 s(xi) k_ij for the touching neighbours, with the node's own volume; only then W is not
   * symmetric.
   *
   * Neighbours are numbered like the nodes: owned, ghosts, then fictitious nodes from n_local() on.
   * The order of a family is that of the lattice offsets (or of the relative positions), never of
   * local numbers, so that sums come out the same on any number of processes.
   */
  template <int dim>
  class Families
  {
  public:
    struct Bond
    {
      unsigned int neighbor;
      double       weight; // W_ij as above
      double       intact; // W_ij without t_ij and g_ij
      bool         cut;    // some crack separates the nodes
    };

    /** Whether the node at a place has bonds at all, now or later. */
    using HasBonds = std::function<bool(const dealii::Point<dim> &)>;

    /**
     * Adds the halo to the nodes. Collective. Throws UserError for empty families and isolated
     * nodes.
     * @param has_bonds all nodes if empty. Off the lattice discrete calibration is the mean over
     *                  these, and no other has to have neighbours.
     */
    Families(Nodes<dim>       &nodes,
             const Scene<dim> &scene,
             const HaloAround  halo      = HaloAround::nodes,
             const HasBonds   &has_bonds = {});
    ~Families();

    /**
     * The family of an owned node, in its fixed order. @p bonds is overwritten, its memory is
     * reused.
     */
    void bonds_of(const unsigned int node,
                  std::vector<Bond> &bonds,
                  const bool         with_self_term = true) const;

    /**
     * The same for any node known here: the bonds whose other ends are known here, too. Without
     * self term.
     */
    void known_bonds_of(const unsigned int node, std::vector<Bond> &bonds) const;

    /** A crack that is cut into the mesh lies between two nodes. */
    bool is_parted(const unsigned int node, const unsigned int neighbor) const;

    /**
     * On a lattice only: the bonds to neighbours one spacing away along an axis, without self term.
     * Else as bonds_of().
     */
    void nearest_bonds_of(const unsigned int node, std::vector<Bond> &bonds) const;

    /** Relative position of a neighbour. */
    dealii::Tensor<1, dim> bond_vector(const unsigned int node, const unsigned int neighbor) const;

    const Nodes<dim>                       &nodes() const;
    const std::vector<FictitiousNode<dim>> &fictitious() const;

    /**
     * On a lattice: the full family with weights w (unit conductivity), self term not included.
     * Else empty.
     */
    const std::vector<FamilyMember<dim>> &lattice_members() const;

    /** Self term additions (own volume), empty if none. */
    const std::vector<FamilyMember<dim>> &self_members() const;

    /**
     * Horizon as a length, and the largest distance of a bond (volume fractions may reach half a
     * spacing farther).
     */
    double horizon() const;
    double reach() const;

    /** Off the lattice: w of a bond of this length (unit conductivity). */
    double weight_off_lattice(const double r) const;

    /** One conductivity everywhere, so that the lattice form needs no corrections for it. */
    bool   uniform_conductivity() const;
    double conductivity(const unsigned int node) const;

    bool conductivity_depends_on_temperature() const;

    /** The conductivity of a bond by the interface rule. */
    double bond_conductivity(const unsigned int node, const unsigned int neighbor) const;

    /**
     * Conductivities at the temperatures u, whose ghosts are up to date. Collective. Throws
     * UserError where one is not positive.
     */
    void take_conductivities_at(const Vector &u);

    /** Surface correction by energy: bonds everywhere may have factors. */
    bool corrects_every_bond() const;

    /** Whether a relative position is that of a lattice member. */
    bool is_offset(const dealii::Tensor<1, dim> &xi, const FamilyMember<dim> &member) const;

    /** The nodes lie on a lattice, one per site. */
    bool has_unique_sites() const;

    /** Some bond of this node may cross a crack, or be scaled for one. */
    bool near_crack(const unsigned int node) const;

    /**
     * Local number of the real node at a lattice site, or numbers::invalid_unsigned_int. Only
     * without doubled nodes.
     */
    unsigned int node_at(const typename Lattice<dim>::Index &site) const;

    /**
     * Surface correction (doc/theory.md): the factors of nodes, owned and ghosts, one for each
     * direction in turn or a single one for all. From now on a bond's conductance is multiplied by
     * the mean of its nodes' factors, those of the directions weighted with the squares of the
     * bond's direction cosines. A fictitious node has the factor of its mirror, or 1. An empty list
     * takes the factors away.
     */
    void set_node_factors(std::vector<double> factors,
                          const unsigned int  n_directions,
                          const bool          mirrored);

    /**
     * Make the cracks those of the representative time (CrackHistory), and return the boxes around
     * what has changed: bonds of nodes farther from all of them than reach() are as before. Node
     * factors stay as they are.
     */
    std::vector<dealii::BoundingBox<dim>> set_cracks_of(const double time);

    /** Owned nodes within a distance of some box, in ascending order. */
    std::vector<unsigned int> nodes_near(const std::vector<dealii::BoundingBox<dim>> &boxes,
                                         const double distance) const;

    /** When the cracks or their transmission change. */
    const CrackHistory<dim> &crack_history() const;

    /** The representative time of the cracks as they are now. */
    double cracks_now() const;

    /** What the cracks leave of a bond's conductance, and whether it crosses any. */
    double kept_fraction(const unsigned int node, const unsigned int neighbor, bool &cut) const;

    /**
     * The cracks that a bond crosses: +1 if the node lies on the left side, -1 if its neighbour
     * does. @p crossed is overwritten.
     */
    void crossed_cracks(const unsigned int                         node,
                        const unsigned int                         neighbor,
                        std::vector<std::pair<unsigned int, int>> &crossed) const;

    /**
     * What the bonds of a complete family conduct of a linear field, over what the conductivity
     * asks for: the mean over the directions of sum_j w V_j xi_a^2/(2 kappa), self term included. 1
     * with discrete calibration; also 1 off the lattice, where it is not known.
     */
    double effective_conductivity() const;

    /**
     * Discrete calibration had a complete family to sum over. Off the lattice a body may be too
     * narrow for any; then it is analytic.
     */
    bool has_complete_families() const;

    /** Whether W is symmetric. */
    bool symmetric() const;

    std::size_t memory_consumption() const;

  private:
    struct Search; // neighbours off the lattice

    const FamilyMember<dim> *find_member(const dealii::Tensor<1, dim> &xi) const;
    void                     find_weights();
    void                     index_lattice();
    void                     calibrate_off_lattice(const HasBonds &has_bonds);
    void                     find_conductivities(const Scene<dim> &scene);
    void                     add_bond(const unsigned int node,
                                      const unsigned int neighbor,
                                      const double       w,
                                      std::vector<Bond> &bonds) const;
    void                     bonds_on_lattice(const unsigned int                    node,
                                              const std::vector<FamilyMember<dim>> &offsets,
                                              std::vector<Bond>                    &bonds) const;
    void   bonds_off_lattice(const unsigned int node, std::vector<Bond> &bonds) const;
    double node_factor(const unsigned int node, const unsigned int direction) const;
    double bond_factor(const unsigned int node, const unsigned int neighbor) const;
    template <typename Test>
    void test_crossings(const unsigned int        node,
                        const unsigned int        neighbor,
                        const CrackGeometry<dim> &crack,
                        const Test               &test) const;
    template <typename Test>
    void test_images(const unsigned int         node,
                     const FictitiousNode<dim> &fictitious,
                     const Test                &test) const;
    void add_self_term(const unsigned int node, std::vector<Bond> &bonds) const;
    void sites_in(const dealii::BoundingBox<dim> &box, std::vector<unsigned int> &found) const;
    dealii::Point<dim> position(const unsigned int node) const;

    Nodes<dim>                     *own_nodes;
    const Material                 &material;
    const Peridynamics             &parameters;
    const CrackHistory<dim>         history;
    double                          cracks_of; // the representative time
    bool                            cut_at_tips;
    std::vector<CrackGeometry<dim>> cracks;
    double                          transmission, contact_conductance;
    double                          delta, farthest = 0., factor = 1.,
                  conductivity_scale; // of the kernel, before calibration by the factor
    bool                             on_lattice = false, uniform = true, complete_families = true;
    std::vector<FamilyMember<dim>>   members, nearest, self_additions;
    std::vector<double>              conductivities, factors;
    unsigned int                     n_factor_directions = 1; // 1: all alike
    bool                             factors_mirrored    = true;
    std::vector<FictitiousNode<dim>> outside;
    const Domain<dim>               *voids = nullptr; // that bonds must not cross
    typename Lattice<dim>::Index     corner, extent;  // of the table of sites
    std::vector<unsigned int>        node_of_site;
    std::unordered_map<std::size_t, std::vector<unsigned int>> outside_of_site;
    std::unique_ptr<Search>                                    search;

    bool        in_table(const typename Lattice<dim>::Index &site) const;
    std::size_t site_key(const typename Lattice<dim>::Index &site) const;
  };
} // namespace PeriDeal
