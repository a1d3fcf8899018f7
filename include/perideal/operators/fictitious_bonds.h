// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>
#include <perideal/bonds/bond_state.h>
#include <perideal/bonds/boundary_images.h>

#include <functional>
#include <map>
#include <unordered_map>
#include <vector>

namespace PeriDeal
{
  template <int dim>
  class PointBins;


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
   * ghosts, the latter up to date.
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

    /** Families have to outlive this object, with the cracks that they have now. Not collective. */
    FictitiousBonds(const Families<dim> &families, const std::array<BeyondSide, 2 * dim> &beyond);

    /** The same of a mesh. Not collective. */
    FictitiousBonds(const Families<dim> &families, const std::vector<BoundaryImage<dim>> &beyond);

    /** Add sum W x^2/V_i to q of the owned nodes. */
    void add_weights(Vector &q) const;

    /**
     * Make the springs those of b_i/q_i at the owned nodes; @p full keeps what full kinematics
     * need.
     */
    void find_springs(const std::function<double(const unsigned int)> &stiffness, const bool full);

    /** @param strain of owned nodes and ghosts */
    void set_thermal_strains(const std::function<double(const unsigned int)> &strain);

    /** Owned nodes that have such bonds. */
    const std::vector<unsigned int> &nodes() const;

    /** Visit the unbroken and broken ones of an owned node: visit(bond). */
    template <typename Visit>
    void for_each_of(const unsigned int i, const Visit &visit) const
    {
      if (!starts.empty())
        for (std::size_t k = starts[i]; k < starts[i + 1]; ++k)
          visit(Bond{k, i, images[k], moments[k], springs[k], state.is_whole(k)});
    }

    template <typename Visit>
    void for_each(const Visit &visit) const
    {
      for (const unsigned int i : list)
        for_each_of(i, visit);
    }

    /** Find u_g for the functions below, until the next call. */
    void find_images(const double *u) const;

    /** u_g - u_i. */
    dealii::Tensor<1, dim> change(const Bond &bond, const double *u) const;
    dealii::Tensor<1, dim> bond_vector(const Bond &bond) const;

    /** W x, also in the deformed body. */
    double length(const Bond &bond) const;

    /** W x e, thermal extension taken off. */
    double extension_moment(const Bond &bond, const double *u) const;

    /** Y, with full kinematics W x Y/|Y|, else the moment. */
    dealii::Tensor<1, dim> direction(const Bond &bond, const double *u) const;

    /**
     * Beginning a sum of forces; then pull() for each force of a bond on its image, and pass_on()
     * to add what the nodes get of them. The last one is collective.
     */
    void begin_forces() const;
    void pull(const Bond &bond, const dealii::Tensor<1, dim> &force) const
    {
      for (unsigned int d = 0; d < dim; ++d)
        image_forces[dim * bond.image + d] += force[d];
    }
    void pass_on(Vector &y) const;

    /**
     * Let forces_of_planes() count the present forces to all later ones: those of thermal strains,
     * which are loads.
     */
    void keep_forces();

    /** The image is that of the node itself in a plane of symmetry alone. */
    bool is_own_image(const Bond &bond) const;

    /**
     * What planes of symmetry have added to the sum of all forces since begin_forces(), by side; on
     * this process.
     */
    std::map<dealii::types::boundary_id, dealii::Tensor<1, dim>> forces_of_planes() const;

    /**
     * K x of what does not depend on dilatations, and with tau of owned nodes of what does: adds to
     * y. Collective.
     */
    void add_forces(Vector &y, const Vector &x, const double *tau) const;

    /** Visit what an image follows from: visit(node, factors of the components). */
    template <typename Visit>
    void for_each_term(const unsigned int image, const Visit &visit) const
    {
      for (std::size_t k = term_starts[image]; k < term_starts[image + 1]; ++k)
        visit(terms[k].node, terms[k].of_component);
    }

    /**
     * Sum of W x and of the factors of all nodes that follow: how much a displacement of 1 may
     * count.
     */
    double sum_of_lengths(const unsigned int i) const;

    /** Of the largest factor of each of these. */
    double sum_of_factors(const unsigned int image) const;

    /** The tangent of the deformed body: directions, and a stiffness across the bond. */
    void   set_tangent(const Bond &bond, const dealii::Tensor<1, dim> &moment, const double across);
    double stiffness_across(const Bond &bond) const;

    /**
     * Beyond planes of symmetry bonds break as those of the whole body; a bond that lies in the
     * plane counts at no end.
     */
    bool         may_break(const Bond &bond) const;
    unsigned int n_ends(const Bond &bond) const;
    void         break_bond(const std::size_t number, const BondState::Mark mark, const double t);

    /** The node of the body that an image is one of, and its volume. */
    unsigned int origin(const unsigned int image) const;
    double       volume(const unsigned int image) const;

    /**
     * Break those bonds of a node that others, broken by now, would have to hold: of its neighbours
     * @p lost in the body. Returns whether there were any.
     */
    bool break_dependent(const unsigned int               node,
                         const std::vector<unsigned int> &lost,
                         const double                     t);

    /** What has broken. @param keys of the owned nodes. Collective. */
    void exchange(Archive &archive, const NodeKeys &keys);

    std::size_t size() const;
    std::size_t memory_consumption() const;

  private:
    using Site  = typename FictitiousExtension<dim>::Site;
    using Index = typename FictitiousExtension<dim>::Index;
    using Term  = typename Site::Term;

    void         find_bonds_of(const unsigned int i);
    void         find_bonds_of(const unsigned int                     i,
                               const std::vector<BoundaryImage<dim>> &beyond,
                               const PointBins<dim>                  &bins,
                               std::vector<unsigned int>             &number_of);
    void         make_room();
    void         release(const std::size_t number);
    unsigned int image_at(const Index &index, const Site &site, const double volume);
    bool         is_cut(const unsigned int                                     i,
                        const std::vector<Term>                               &of_image,
                        const std::function<dealii::Point<dim>(const Term &)> &twice_planes) const;
    bool         is_separated(const unsigned int        i,
                              const Term               &term,
                              const dealii::Point<dim> &twice_planes) const;
    bool         are_images_of_one(const unsigned int lost,
                                   const unsigned int image,
                                   const Term        &term) const;

    const Families<dim>                                     &families;
    const FictitiousExtension<dim>                           extension;
    std::unordered_map<std::size_t, unsigned int>            image_of; // while bonds are found
    std::vector<unsigned int>                                list;
    std::vector<std::size_t>                                 starts; // of all owned nodes, or empty
    std::vector<unsigned int>                                images;
    std::vector<std::size_t>                                 parted; // while bonds are found
    BondState                                                state;
    std::vector<dealii::Tensor<1, dim>>                      moments;
    std::vector<double>                                      springs, lengths, across, strains;
    std::vector<Index>                                       sites; // of the images, on a lattice
    std::vector<dealii::Point<dim>>                          places;
    std::vector<std::array<dealii::types::boundary_id, dim>> planes; // that images may lie beyond
    std::vector<double>                                      volumes;
    std::vector<unsigned int>                                origins;
    std::vector<std::size_t>                                 term_starts{0};
    std::vector<Term>                                        terms;
    mutable std::vector<double>                              values, image_forces;
    std::vector<double>                                      kept_forces;
    mutable Vector                                           passed;
  };
} // namespace PeriDeal
