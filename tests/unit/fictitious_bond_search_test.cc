// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Which bonds lead beyond the sides, and that families are whole with them.

#include <perideal/operators/solid/fictitious_bond_search.h>

#include "elastic_scene_tools.h"
#include "elastic_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Tensor;

  namespace
  {
    /**
     * Sums of w x^2 n_a^2 n_b^2 over the bonds of each node in the body and those that are found,
     * over those of a complete family: the one that is furthest from 1.
     */
    template <int dim>
    double worst_moment(const Settings &more, const BeyondSide kind, const bool completes)
    {
      const Body<dim>                 body(box<dim>() + more, ModelKind::peridynamics);
      const Families<dim>            &families = body.states->bonds().families;
      const Nodes<dim>               &nodes    = families.nodes();
      FictitiousImages<dim>           images(nodes);
      std::array<BeyondSide, 2 * dim> beyond;
      beyond.fill(kind);
      const auto  list = FictitiousBondSearch<dim>(families, images).on_lattice(beyond, completes);
      const auto &members = families.weights().members();
      const auto  moment =
        [&](const FamilyMember<dim> &member, const unsigned int a, const unsigned int b) {
          const auto &h = nodes.lattice()->spacing;
          return member.weight *
                 std::pow(member.offset[a] * h[a] * member.offset[b] * h[b] / member.r, 2);
        };
      double worst = 0.;
      for (unsigned int place = 0; place < list.nodes.size(); ++place)
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = a; b < dim; ++b)
            {
              const unsigned int i     = list.nodes[place];
              const auto         index = nodes.lattice()->index(nodes.position(i));
              double             sum = 0., whole = 0.;
              for (const auto &member : members)
                {
                  whole += moment(member, a, b) * nodes.lattice()->cell_volume();
                  const unsigned int j = families.neighbors().node_at(index + member.offset);
                  if (j != dealii::numbers::invalid_unsigned_int)
                    sum += moment(member, a, b) * nodes.volume(j);
                }
              for (std::size_t k = list.starts[place]; k < list.starts[place + 1]; ++k)
                {
                  const UnitBond<dim> &unit = list.units[list.unit_of[k]];
                  const double         w    = (unit.moment * unit.moment) / unit.weight;
                  const Tensor<1, dim> xi   = unit.moment / w;
                  sum += images[list.images[k]].volume * w * std::pow(xi[a] * xi[b], 2) /
                         xi.norm_square();
                }
              worst = std::max(worst, std::abs(sum / whole - 1.));
            }
      return max_of_all(worst);
    }
  } // namespace


  // What completes families is found with a matrix that is made regular by 1e-9 of its size.
  TEST(FictitiousBondSearch, families_are_whole)
  {
    for (const std::string ratio : {"2", "3", "4"})
      for (const std::string placement : {"vertices", "cell centers"})
        {
          const Settings more{{"Peridynamics/Horizon ratio", ratio}, {"Domain/Nodes", placement}};
          EXPECT_LT(worst_moment<2>(more, BeyondSide::continued, false), 1e-12) << ratio;
          EXPECT_LT(worst_moment<2>(more, BeyondSide::in_part, true), 1e-6) << ratio;
          EXPECT_LT(worst_moment<2>(more, BeyondSide::nothing, true), 1e-6) << ratio;
        }
    EXPECT_LT(worst_moment<3>({}, BeyondSide::continued, false), 1e-12);
    EXPECT_LT(worst_moment<3>({}, BeyondSide::in_part, true), 1e-6);
  }
} // namespace PeriDeal
