// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Peridynamic solids under uniform strains, against classical ones and sums over the lattice.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  /**
   * Influence functions, and how stiff bonds of full families are against shear strains of the
   * axes, relative to the shear modulus (sums over the lattice).
   */
  struct ShearOfLattice
  {
    const char *kernel, *exponent, *ratio, *cells;
    double      shear, digits = 2.2e-5; // those that the former is given with
  };


  /**
   * All uniform strains where families are complete. theta and the mean stress are exact; bonds see
   * the fourth moments of the lattice, so that shear of the axes has the shear modulus g G, and
   * differences of stretches (2 - g) G in two dimensions, (5 - 3 g)/2 G in three.
   */
  template <int dim>
  void all_uniform_strains(const ShearOfLattice &lattice,
                           const std::string    &plane,
                           const std::string    &nu,
                           const Settings       &more = {})
  {
    const Body<dim> body(box<dim>() +
                           Settings{{"Domain/Upper corner", dim == 2 ? "1, 1" : "1, 1, 1"},
                                    {"Domain/Cells", lattice.cells},
                                    {"Elasticity/Plane", plane},
                                    {"Material/Poisson ratio", nu},
                                    {"Peridynamics/Horizon ratio", lattice.ratio},
                                    {"Peridynamics/Kernel", lattice.kernel},
                                    {"Peridynamics/Kernel exponent", lattice.exponent},
                                    {"Peridynamics/Calibration", "discrete"}} +
                           more,
                         ModelKind::peridynamics);
    const Moduli    moduli = body.scene.material.moduli(dealii::Point<dim>());
    const double    reach  = body.states->bonds().families.weights().reach();
    double          n = 0., worst = 0.;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a; b < dim; ++b)
        {
          dealii::SymmetricTensor<2, dim> strain;
          strain[a][b]       = 1.;
          const auto   sigma = stress(moduli, body.scene.elasticity.plane, strain);
          const Vector u     = body.values(
            [&](const dealii::Point<dim> &p) { return dealii::Tensor<1, dim>(strain * p); });
          const double shear              = lattice.shear,
                       stretch            = dim == 2 ? 2. - shear : (5. - 3. * shear) / 2.;
          const double              size  = std::max(sigma.norm(), moduli.shear);
          const std::vector<double> theta = nodal_dilatations(body.states->bonds(), u);
          const NodalTensors<dim>   found = body.states->tensors(u);
          for (unsigned int i = 0; i < theta.size(); ++i)
            {
              bool complete = true;
              for (unsigned int d = 0; d < dim; ++d)
                complete = complete &&
                           std::abs(body.position(i)[d] - 0.5) < 0.5 - reach * (1. - 1e-9);
              if (!complete)
                continue;
              n += 1.;
              EXPECT_NEAR(theta[i], trace(strain), 1e-12);
              EXPECT_NEAR(trace(found.stress[i]), trace(sigma), 1e-12 * size);
              const auto difference = deviator(found.stress[i]), wanted = deviator(sigma);
              for (unsigned int c = 0; c < dim; ++c)
                for (unsigned int d = c; d < dim; ++d)
                  {
                    const double factor = c == d ? stretch : shear;
                    worst =
                      std::max(worst,
                               std::abs(difference[c][d] - factor * wanted[c][d]) / moduli.shear);
                  }
            }
        }
    EXPECT_GT(sum_of_all(n), 0.);
    // Nothing else is missing.
    EXPECT_LT(max_of_all(worst), lattice.digits)
      << dim << ' ' << plane << ' ' << nu << ' ' << lattice.kernel << ' ' << lattice.ratio;
  }


  /** Energy of a square of n x n cells of size 1 under a uniform strain. */
  double energy_of_square(const unsigned int                   n,
                          const std::string                   &nu,
                          const dealii::SymmetricTensor<2, 2> &strain)
  {
    const std::string size = std::to_string(n);
    const Body<2>     body(box<2>() + Settings{{"Domain/Upper corner", size + ", " + size},
                                           {"Domain/Cells", size + ", " + size},
                                           {"Material/Poisson ratio", nu}},
                       ModelKind::peridynamics);
    return body.op().energy(
      body.values([&](const dealii::Point<2> &p) { return dealii::Tensor<1, 2>(strain * p); }));
  }
} // namespace


TEST(StateOperator, all_uniform_strains)
{
  const ShearOfLattice in_2d[] = {{"conical", "2", "3", "12, 12", 0.86047},
                                  {"conical", "2", "4", "12, 12", 0.91711},
                                  {"conical", "2", "5", "12, 12", 0.94626},
                                  {"conical", "2", "6", "14, 14", 0.96161},
                                  {"conical", "0", "3", "12, 12", 0.98421},
                                  {"conical", "0", "6", "14, 14", 0.99828},
                                  {"constant", "0", "3", "12, 12", 0.96376},
                                  {"constant", "1", "4", "12, 12", 0.99104}};
  for (const ShearOfLattice &lattice : in_2d)
    for (const std::string plane : {"stress", "strain"})
      for (const std::string nu : {"-0.9", "-0.3", "0", "0.3", "0.499"})
        all_uniform_strains<2>(lattice, plane, nu);
  const ShearOfLattice in_3d[] = {{"conical", "2", "2", "6, 6, 6", 0.7895},
                                  {"conical", "2", "3", "8, 8, 8", 0.92744},
                                  {"conical", "0", "3", "8, 8, 8", 0.99572}};
  for (const ShearOfLattice &lattice : in_3d)
    for (const std::string nu : {"-0.9", "0.3", "0.499"})
      all_uniform_strains<3>(lattice, "stress", nu);
}


TEST(StateOperator, isotropic_calibration_makes_uniform_strains_exact)
{
  const Settings isotropic = {{"Peridynamics/Calibration", "isotropic"}};
  // The last ones on cells that are not square.
  const ShearOfLattice in_2d[] = {{"conical", "0", "2", "8, 8", 1., 2e-13},
                                  {"conical", "2", "3", "12, 12", 1., 2e-13},
                                  {"conical", "0", "6", "14, 14", 1., 2e-13},
                                  {"constant", "1", "4", "12, 12", 1., 2e-13},
                                  {"conical", "0", "3", "8, 12", 1., 2e-13}};
  for (const ShearOfLattice &lattice : in_2d)
    for (const std::string plane : {"stress", "strain"})
      for (const std::string nu : {"-0.3", "0.3"})
        all_uniform_strains<2>(lattice, plane, nu, isotropic);
  all_uniform_strains<3>({"conical", "0", "2", "6, 6, 6", 1., 2e-13}, "stress", "0.3", isotropic);
  all_uniform_strains<3>({"conical", "2", "2", "8, 9, 8", 1., 2e-13}, "stress", "0.3", isotropic);
}


TEST(StateOperator, energy_of_uniform_strain)
{
  // What one more row and column adds to what the last ones added is a full family's energy: faces
  // and corners cancel.
  for (const std::string nu : {"-0.9", "0.3", "0.499"})
    {
      const double young = 3., value = std::stod(nu), shear = young / (2. * (1. + value));
      const double area = young / (2. * (1. - value)); // lambda + G of plane stress
      dealii::SymmetricTensor<2, 2> strain;
      strain[0][0]       = 0.3;
      strain[1][1]       = -0.1;
      strain[0][1]       = 0.2;
      const double added = energy_of_square(14, nu, strain) -
                           2. * energy_of_square(13, nu, strain) + energy_of_square(12, nu, strain);
      const double g = 0.86047; // m = 3
      const double wanted =
        0.5 * area * 0.2 * 0.2 + shear * ((2. - g) * 0.5 * 0.4 * 0.4 + g * 2. * 0.2 * 0.2);
      EXPECT_NEAR(0.5 * added, wanted, 3e-5 * wanted);
    }
}


namespace
{
  /**
   * The energy of a bond-based cube of n^3 cells over the classical one, and the same by plain sums
   * over pairs of its vertices.
   */
  std::pair<double, double> energy_of_cube(const unsigned int                   n,
                                           const bool                           constant,
                                           const dealii::SymmetricTensor<2, 3> &strain)
  {
    const std::string size = std::to_string(n);
    const Body<3>     body(box<3>() +
                         Settings{{"Domain/Upper corner", size + "," + size + "," + size},
                                  {"Domain/Cells", size + "," + size + "," + size},
                                  {"Material/Poisson ratio", "0.25"},
                                  {"Elasticity/Model", "bond-based"},
                                  {"Elasticity/Micromodulus", constant ? "constant" : "family"}},
                       ModelKind::peridynamics);
    // Of Young modulus 3; lambda is equal to the shear modulus.
    const double lambda = 1.2, volume = n * n * n;
    const double classical = volume * (0.5 * lambda * trace(strain) * trace(strain) +
                                       lambda * strain.norm() * strain.norm());
    const double found     = body.op().energy(
      body.values([&](const dealii::Point<3> &p) { return dealii::Tensor<1, 3>(strain * p); }));

    const auto size_of = [&](const std::array<int, 3> &site) {
      double v = 1.;
      for (const int s : site)
        v *= s < 0 || s > static_cast<int>(n) ? 0. : s == 0 || s == static_cast<int>(n) ? 0.5 : 1.;
      return v;
    };
    double complete = 0., sum = 0.;
    for (const auto &member : body.states->bonds().families.weights().members())
      complete += member.weight * member.r * member.r;
    for (int x = 0; x <= static_cast<int>(n); ++x)
      for (int y = 0; y <= static_cast<int>(n); ++y)
        for (int z = 0; z <= static_cast<int>(n); ++z)
          {
            double q = 0., energy = 0.;
            for (const auto &member : body.states->bonds().families.weights().members())
              {
                dealii::Tensor<1, 3> xi;
                for (unsigned int d = 0; d < 3; ++d)
                  xi[d] = member.offset[d];
                const double weight = member.weight * size_of({{x + member.offset[0],
                                                                y + member.offset[1],
                                                                z + member.offset[2]}}),
                             e      = xi * (strain * xi) / member.r;
                q += weight * member.r * member.r;
                energy += weight * e * e;
              }
            // (9/2) k = 7.5 lambda for equal strains, e = r
            sum += 7.5 * lambda * size_of({{x, y, z}}) * energy / (constant ? complete : q);
          }
    return {found / classical, sum / classical};
  }
} // namespace


TEST(StateOperator, surfaces_of_bond_based_bodies)
{
  // Divided by the sums over their own families nodes have all of the energy of equal strains,
  // surfaces or not; the constant micromodulus has it inside, less by what families lack at
  // surfaces.
  dealii::SymmetricTensor<2, 3> equal = dealii::unit_symmetric_tensor<3>(), shear;
  shear[0][1]                         = 0.5;
  for (const bool constant : {false, true})
    for (const auto &strain : {equal, shear})
      {
        const auto [found, sums] = energy_of_cube(6, constant, strain);
        EXPECT_NEAR(found, sums, 1e-12);
        EXPECT_LT(found, constant ? 0.7 : 1. + 1e-12); // soft surfaces
      }
  EXPECT_NEAR(energy_of_cube(6, false, equal).first, 1., 1e-12);
  // Inside both are classical: third differences of the size leave out faces, edges and corners.
  for (const bool constant : {false, true})
    {
      double           sum       = 0.;
      constexpr double factors[] = {-1., 3., -3., 1.};
      for (unsigned int k = 0; k < 4; ++k)
        sum += factors[k] * std::pow(6. + k, 3) * energy_of_cube(6 + k, constant, equal).first;
      EXPECT_NEAR(sum / 6., 1., 1e-10);
    }
}


TEST(StateOperator, dilatation_on_rectangular_cells)
{
  // Direction factors of the lattice make theta exact on cells of any ratio.
  const dealii::Tensor<2, 2> g = some_gradient<2>();
  for (const std::string cells : {"40, 13", "14, 42"})
    {
      const Body<2>             body(box<2>() + Settings{{"Domain/Upper corner", "1, 1"},
                                             {"Domain/Cells", cells},
                                             {"Peridynamics/Horizon ratio", "6"}},
                         ModelKind::peridynamics);
      const std::vector<double> theta =
        nodal_dilatations(body.states->bonds(),
                          body.values([&](const dealii::Point<2> &p) { return g * p; }));
      const double reach = body.states->bonds().families.weights().reach();
      double       n     = 0.;
      for (unsigned int i = 0; i < theta.size(); ++i)
        if (std::max(std::abs(body.position(i)[0] - 0.5), std::abs(body.position(i)[1] - 0.5)) <
            0.5 - reach * (1. - 1e-9))
          {
            EXPECT_NEAR(theta[i], trace(g), 1e-12);
            n += 1.;
          }
      EXPECT_GT(sum_of_all(n), 0.);
    }
}
