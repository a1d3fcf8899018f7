// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>
#include <perideal/bonds/boundary_images.h>

#include <map>
#include <vector>

namespace PeriDeal
{
  /**
   * The fictitious nodes beyond the sides of a solid to which nodes of the body have bonds, and
   * those of its nodes that count more in the families of others, which their own bonds complete.
   * The displacement of each, u_g = P u, is linear in that of nodes of the body; the force on it is
   * passed on to them through P^T.
   *
   * Values and forces are scratch memory: they hold until the next find() and begin_forces().
   */
  template <int dim>
  class FictitiousImages
  {
  public:
    using Term  = typename FictitiousExtension<dim>::Site::Term;
    using Index = typename FictitiousExtension<dim>::Index;

    struct Image
    {
      dealii::Point<dim>                          place;
      double                                      volume;
      std::array<dealii::types::boundary_id, dim> planes;  // that it may lie beyond
      unsigned int                                origin;  // the node that it is an image of
      Index                                       site;    // on a lattice
      bool                                        is_real; // a node of the body itself
    };

    explicit FictitiousImages(const Nodes<dim> &nodes);

    /**
     * Returns its number. To be followed by make_room(), collective, after the last one.
     * @param twice_planes of a BoundaryImage; only on a mesh
     */
    unsigned int add(const Image              &image,
                     const std::vector<Term>  &of_image,
                     const dealii::Point<dim> *twice_planes = nullptr);
    void         make_room();

    unsigned int size() const
    {
      return images.size();
    }

    const Image &operator[](const unsigned int image) const
    {
      return images[image];
    }

    /** Those of the BoundaryImage, on a mesh. */
    const dealii::Point<dim> &twice_planes(const unsigned int image) const
    {
      return planes_of_mesh[image];
    }

    /** Visit what an image follows from: visit(term). */
    template <typename Visit>
    void for_each_term(const unsigned int image, const Visit &visit) const
    {
      for (std::size_t k = starts[image]; k < starts[image + 1]; ++k)
        visit(terms[k]);
    }

    /** The image mirrors one node, and is continued beyond no side. */
    bool is_mirrored_alone(const unsigned int image) const
    {
      return starts[image + 1] - starts[image] == 1 && !images[image].is_real;
    }

    bool any_mirrored_alone() const;

    /** Some image, on any process, follows from this owned node and passes forces on to it. */
    bool is_followed(const unsigned int node) const
    {
      return !followed.empty() && followed[node];
    }

    const Term &first_term(const unsigned int image) const
    {
      return terms[starts[image]];
    }

    /**
     * Sum of the largest factor of each node that it follows: how much a displacement of 1 may
     * count.
     */
    double sum_of_factors(const unsigned int image) const;

    /** @p lost is the image of the node of a term of @p image, with its mirrors. */
    bool are_images_of_one(const unsigned int lost,
                           const unsigned int image,
                           const Term        &term) const;

    /** Find u_g. @p u has up-to-date ghosts. */
    void find(const double *u) const;

    const double *value(const unsigned int image) const
    {
      return values.data() + dim * image;
    }

    /** Beginning a sum of forces; then pull() for each, and pass_on() the sums. */
    void begin_forces() const
    {
      std::fill(forces.begin(), forces.end(), 0.);
    }

    void pull(const unsigned int image, const dealii::Tensor<1, dim> &force) const
    {
      for (unsigned int d = 0; d < dim; ++d)
        forces[dim * image + d] += force[d];
    }

    /** Adds what the nodes get of the forces. Collective. */
    void pass_on(Vector &y) const;

    /** The forces since begin_forces(), by image and component. */
    std::vector<double> &sums_of_forces() const
    {
      return forces;
    }

    /**
     * What planes of symmetry have added to the sum of all forces since begin_forces(), by side; on
     * this process.
     */
    std::map<dealii::types::boundary_id, dealii::Tensor<1, dim>> forces_of_planes() const;

    std::size_t memory_consumption() const;

    /** What forces_of_planes() counts to all forces: those of thermal strains, which are loads. */
    std::vector<double> kept_forces;

  private:
    const Nodes<dim>               &nodes;
    std::vector<Image>              images;
    std::vector<dealii::Point<dim>> planes_of_mesh;
    std::vector<std::size_t>        starts{0};
    std::vector<Term>               terms;
    std::vector<unsigned int>       pulled;   // the nodes of all terms, in ascending order
    std::vector<unsigned int>       places;   // of each term's node in these
    std::vector<bool>               followed; // by owned node; empty: none
    mutable std::vector<double>     values, forces, sums; // sums: of the pulled nodes
    mutable Vector                  passed;               // where there are other processes
  };
} // namespace PeriDeal
