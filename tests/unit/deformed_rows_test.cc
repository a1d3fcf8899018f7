// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Loops over several bonds at once beside sums bond by bond, with full kinematics.

#include <cmath>

#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  using dealii::Point;
  using dealii::Tensor;

  template <int dim>
  Body<dim> brittle_body(const Settings &more)
  {
    return Body<dim>(box<dim>() +
                       Settings{{"Elasticity/Kinematics", "full"},
                                {"Elasticity/Solver", "dynamics"},
                                {"Material/Critical stretch", "0.25 + 0.05*x"}} +
                       more,
                     ModelKind::peridynamics);
  }


  /** Large ones, none of which breaks bonds but those of nodes in the middle. */
  template <int dim>
  Vector large_displacements(const Body<dim> &body)
  {
    const double h        = dim == 1 ? 1. / 24. : dim == 2 ? 1. / 16. : 1. / 8.;
    const double middle[] = {0.5, 0.375, 0.25};
    Vector       u        = body.values([&](const Point<dim> &p) {
      Tensor<1, dim> value    = 0.01 * bumpy_vector<dim>(p) + 0.1 * p;
      double         farthest = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        farthest = std::max(farthest, std::abs(p[d] - middle[d]));
      if (farthest < 0.51 * h)
        value[0] += 0.35 * h;
      return value;
    });
    u.update_ghost_values();
    return u;
  }


  /** Forces, tensions, energies and stretches bond by bond. */
  template <int dim>
  void expect_plain_sums(const Body<dim> &body, const Vector &u)
  {
    const SolidBonds<dim>     &bonds      = body.states->bonds();
    const BondKinematics<dim> &kinematics = bonds.kinematics;
    const BondForces<dim>     &forces     = bonds.forces;
    const unsigned int         n          = body.nodes->n_owned();
    Vector                     tau(body.nodes->partitioner()), y;
    body.op().initialize_vector(y);
    forces.find_tensions(tau.begin(), u.begin());
    tau.update_ghost_values();
    forces.find_forces(y, u.begin(), tau);
    double gap = 0., gap_of_tau = 0., energy = 0., stretch = 0.;
    for (unsigned int i = 0; i < n; ++i)
      {
        double         sum = 0.;
        Tensor<1, dim> force;
        bonds.rows.for_each_stored(i, [&](const auto &bond) {
          const unsigned int   j  = bond.neighbor;
          const Tensor<1, dim> xi = bonds.families.neighbors().bond_vector(i, j);
          Tensor<1, dim>       along(xi);
          for (unsigned int d = 0; d < dim; ++d)
            along[d] += u.local_element(dim * j + d) - u.local_element(dim * i + d);
          const double product = kinematics.extension_moment(u.begin(), i, bond);
          sum += product;
          energy += 0.25 * bond.spring * product * product;
          force += (bond.spring * product + tau.local_element(i) + tau.local_element(j)) *
                   kinematics.length(bond) / along.norm() * along;
          if (bonds.rows.is_whole(bond.number))
            stretch = std::max(stretch, std::abs(along.norm() / xi.norm() - 1.));
        });
        gap_of_tau =
          std::max(gap_of_tau, std::abs(bonds.laws.tension(i, sum) - tau.local_element(i)));
        for (unsigned int d = 0; d < dim; ++d)
          gap = std::max(gap, std::abs(force[d] + y.local_element(dim * i + d)));
      }
    EXPECT_GT(y.linfty_norm(), 0.);
    EXPECT_LT(max_of_all(gap), 1e-14 * y.linfty_norm());
    if (bonds.laws.volumetric)
      {
        EXPECT_LT(max_of_all(gap_of_tau), 1e-14 * tau.linfty_norm());
      }
    EXPECT_NEAR(forces.energy_of_extensions(u.begin()), energy, 1e-13 * energy);
    EXPECT_NEAR(forces.largest_stretch(u.begin()), max_of_all(stretch), 1e-14);
  }


  /**
   * As it is, and once bonds have broken: the same ones, whether those that are stretched have been
   * looked for with the forces or all are walked through. Forces are mended where bonds are lost.
   */
  template <int dim>
  void check_rows(const Settings &more)
  {
    const Body<dim>        body = brittle_body<dim>(more), other = brittle_body<dim>(more);
    const BondForces<dim> &forces = body.states->bonds().forces;
    Vector                 u      = large_displacements(body);
    expect_plain_sums(body, u);

    Vector mended = body.unbalanced(u);
    u.update_ghost_values();
    EXPECT_EQ(other.states->bonds().forces.exceeding(u.begin()), nullptr);
    ASSERT_NE(forces.exceeding(u.begin()), nullptr);
    double n_suspects = 0.;
    for (unsigned int i = 0; i < body.nodes->n_owned(); ++i)
      n_suspects += forces.exceeding(u.begin())[i];
    n_suspects = sum_of_all(n_suspects);
    EXPECT_GT(n_suspects, 0.);
    EXPECT_LT(n_suspects, 0.3 * body.nodes->n_global());
    u.set_ghost_state(false);

    EXPECT_GT(body.op().break_bonds(u, 0.), 0u);
    body.op().mend_unbalanced(mended, u, 0.);
    EXPECT_LT(relative_difference(mended, body.unbalanced(u)), 1e-13);
    other.op().break_bonds(u, 0.);
    std::size_t n_known = 0, n_known_of_other = 0;
    EXPECT_TRUE(body.op().broken_since(n_known) == other.op().broken_since(n_known_of_other));
    EXPECT_EQ(body.op().break_bonds(u, 0.), 0u);
    u.update_ghost_values();
    expect_plain_sums(body, u);
  }
} // namespace


TEST(DeformedRows, sums_bond_by_bond)
{
  const Settings warm{{"Elasticity/Temperature change", "1 + x"},
                      {"Material/Thermal expansion", "0.01"}};
  for (const Settings &more : {Settings{}, warm})
    {
      check_rows<1>(more);
      check_rows<2>(more);
      check_rows<3>(more);
      check_rows<2>(more + Settings{{"Elasticity/Model", "bond-based"},
                                    {"Elasticity/Plane", "strain"},
                                    {"Peridynamics/Horizon ratio", "4"}});
    }
}
