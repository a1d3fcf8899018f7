// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/family_completion.h>
#include <perideal/operators/solid/fictitious_images.h>
#include <perideal/operators/solid/unit_bonds.h>

#include <array>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace PeriDeal
{
  template <int dim>
  class PointBins;


  /**
   * Bonds that lead to fictitious nodes, node by node. On a lattice each is a unit bond, which
   * volumes of both ends make its own; on a mesh it has its W xi and W x^2. What cracks cut bears
   * nothing.
   */
  template <int dim>
  struct FictitiousBondList
  {
    static constexpr unsigned int gone = static_cast<unsigned int>(-1);

    std::vector<unsigned int> nodes;     // owned ones that have such bonds, in ascending order
    std::vector<std::size_t>  starts{0}; // of the bonds of these
    std::vector<unsigned int> images;    // by bond
    std::vector<std::size_t>  cut;       // bonds

    std::vector<UnitBond<dim>> units;   // those of a complete family first
    std::vector<unsigned int>  unit_of; // by bond; or gone

    std::vector<dealii::Tensor<1, dim>> moments; // on a mesh
    std::vector<double>                 squares;
  };


  /**
   * Finds the bonds of a solid's nodes that lead beyond the sides of the body, and those in the
   * body that count more where a family is completed by its own bonds: these lead to an image that
   * is a node of the body itself. Used once.
   */
  template <int dim>
  class FictitiousBondSearch
  {
  public:
    /** Families and images, to which the fictitious nodes are added, have to outlive this. */
    FictitiousBondSearch(const Families<dim> &families, FictitiousImages<dim> &images);

    /**
     * On a lattice. Collective.
     * @param completes what ends at other sides and at voids is made up for
     */
    FictitiousBondList<dim> on_lattice(const std::array<BeyondSide, 2 * dim> &beyond,
                                       const bool                             completes);

    /**
     * On a mesh. Collective.
     * @param everywhere if any, the images beyond all sides: what of these are none of @p beyond is
     *                   made up for
     */
    FictitiousBondList<dim> on_mesh(const std::vector<BoundaryImage<dim>> &beyond,
                                    const std::vector<BoundaryImage<dim>> &everywhere);

  private:
    using Site  = typename FictitiousExtension<dim>::Site;
    using Index = typename FictitiousExtension<dim>::Index;
    using Term  = typename Site::Term;

    /** What lies at the site of a member of a family, as its node sees it. */
    struct Member
    {
      unsigned int node;           // to which it has a bond, or none
      double       inside, beyond; // volumes of this, and beyond the sides
    };

    template <typename Find>
    FictitiousBondList<dim> find_all(const Find &find);

    void add(const unsigned int image, const unsigned int member, double factor, const bool cut);
    void add_beyond(const unsigned int i, const unsigned int member, const double more);

    void                       find_on_lattice(const unsigned int i);
    void                       find_site(const unsigned int i, const unsigned int member);
    const std::vector<double> *completing_factors(const unsigned int i);

    struct MeshImages;
    struct MeshBond;
    using FourthMoments = std::array<double, dim *(dim + 1) * (dim + 2) * (dim + 3) / 24>;

    std::vector<MeshBond> bonds_to(const unsigned int i, const MeshImages &beyond) const;
    void                  add(const unsigned int image, const MeshBond &bond);
    void                  complete_on_mesh(const unsigned int           i,
                                           const std::vector<MeshBond> &bonds,
                                           MeshImages                  &beyond,
                                           const std::vector<MeshBond> &everywhere);
    static FourthMoments  fourth_moments(const dealii::Tensor<1, dim> &xi);

    // A second image at the place of one, for what does not break by itself.
    unsigned int beside_of(const unsigned int        image,
                           const std::vector<Term>  &terms,
                           const dealii::Point<dim> *twice_planes);
    unsigned int beside_on_mesh(const unsigned int g, MeshImages &beyond);
    unsigned int image_on_mesh(const unsigned int g, MeshImages &beyond);
    unsigned int image_of(const unsigned int node); // that is the node itself
    unsigned int image_at(const Index &index, const double volume);

    const Families<dim>                                    &families;
    FictitiousImages<dim>                                  &images;
    FictitiousBondList<dim>                                 list;
    std::optional<FictitiousExtension<dim>>                 extension;
    std::optional<FamilyCompletion<dim>>                    completion;
    std::unordered_map<std::size_t, unsigned int>           at_site;   // images, by the site's key
    std::unordered_map<unsigned int, unsigned int>          of_node;   // by the node itself
    std::unordered_map<unsigned int, unsigned int>          beside;    // by the image at its place
    std::map<std::pair<unsigned int, double>, unsigned int> unit_with; // a factor
    std::vector<Member>                                     family;    // of the node at work
    std::vector<double>                                     volumes;
    Site                                                    site;
  };
} // namespace PeriDeal
