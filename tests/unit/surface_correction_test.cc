// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Surface corrections of the linear peridynamic solid: the laws alone, and what they do to uniform
// strains.

#include <perideal/base/user_error.h>
#include <perideal/laws/family_moments.h>
#include <perideal/laws/stretch_energy.h>

#include <algorithm>
#include <tuple>

#include "dimensions.h"
#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

TEST(StretchEnergy, sums_and_ellipsoid)
{
  StretchSums<2>             sums;
  const dealii::Tensor<1, 2> xi({3., 4.});
  sums.add(xi, 2.);
  EXPECT_DOUBLE_EQ(sums.dilatation[0], 18.);
  EXPECT_DOUBLE_EQ(sums.energy[1], 2. * 256. / 25.);
  const dealii::Tensor<1, 2> one({1., 2.}), other({3., 4.});
  EXPECT_DOUBLE_EQ(axis_factors(other, one)[0], 3.);
  EXPECT_DOUBLE_EQ(axis_factors(other, one)[1], 2.);
  // Half axes 2 and 3: along the axes the factors themselves, the same for both ends.
  EXPECT_DOUBLE_EQ(ellipsoid_factor<2>(one, other, dealii::Tensor<1, 2>({0.5, 0.})), 2.);
  EXPECT_DOUBLE_EQ(ellipsoid_factor<2>(other, one, dealii::Tensor<1, 2>({0., -7.})), 3.);
  EXPECT_DOUBLE_EQ(ellipsoid_factor<2>(one, other, xi),
                   1. / std::sqrt(0.6 * 0.6 / 4. + 0.8 * 0.8 / 9.));
  const dealii::Tensor<1, 3> alike({1.7, 1.7, 1.7});
  EXPECT_NEAR(ellipsoid_factor<3>(alike, alike, dealii::Tensor<1, 3>({1., -2., 0.3})), 1.7, 1e-14);
}


TEST_IN_DIMENSIONS(FamilyMoments, fourth_moments, 1, 2, 3)
{
  // Unit norm, even, a product is (n.m)^4.
  dealii::Tensor<1, dim> a, b;
  for (unsigned int d = 0; d < dim; ++d)
    {
      a[d] = 1. + 0.7 * d;
      b[d] = 2. - 1.3 * d;
    }
  const FourthMoments<dim> ma = fourth_moments(a), mb = fourth_moments(b);
  EXPECT_EQ(fourth_moments(-a), ma);
  EXPECT_NEAR(scalar_product<dim>(ma, ma), 1., 1e-14);
  EXPECT_NEAR(scalar_product<dim>(ma, mb), std::pow(a * b / (a.norm() * b.norm()), 4), 1e-14);
  // The mean of (n.m)^4 over all m is 3/(dim (dim + 2)), whatever n.
  EXPECT_NEAR(scalar_product<dim>(ma, isotropic_fourth_moments<dim>()),
              3. / (dim * (dim + 2.)),
              1e-14);
}


TEST(FamilyMoments, matrices_and_positive_factors)
{
  // Directions of a half circle have the moments of a whole one but for the factor 2; those of a
  // quarter cannot with positive factors.
  const auto directions = [](const double angle) {
    std::vector<FourthMoments<2>> list;
    for (unsigned int k = 0; k <= 40; ++k)
      list.push_back(fourth_moments(
        dealii::Tensor<1, 2>({std::cos(angle * k / 40.), std::sin(angle * k / 40.)})));
    return list;
  };
  for (const double angle : {dealii::numbers::PI, 0.5 * dealii::numbers::PI})
    {
      const auto       list = directions(angle);
      MomentMatrix<2>  matrix;
      FourthMoments<2> missing = isotropic_fourth_moments<2>();
      for (double &m : missing)
        m *= 82.;
      for (const FourthMoments<2> &m : list)
        {
          matrix.add(m, 1.);
          for (unsigned int a = 0; a < m.size(); ++a)
            missing[a] -= m[a];
        }
      ASSERT_TRUE(matrix.factorize());
      const FourthMoments<2> y = matrix.solve(missing);
      FourthMoments<2>       found{};
      for (const FourthMoments<2> &m : list)
        for (unsigned int a = 0; a < m.size(); ++a)
          found[a] += scalar_product<2>(y, m) * m[a];
      for (unsigned int a = 0; a < found.size(); ++a)
        EXPECT_NEAR(found[a], missing[a], 1e-9);
      EXPECT_EQ(positive_factors_exist<2>(list, matrix, missing), angle > 2.);
    }
  MomentMatrix<2> few;
  for (const FourthMoments<2> &m : directions(0.))
    few.add(m, 1.);
  EXPECT_FALSE(few.factorize());
}


namespace
{
  /**
   * Uniform strains of a box that is cut off on all sides: theta and stress are those inside at all
   * nodes but the ones that the operator counts.
   */
  template <int dim>
  void uniform_strains_up_to_the_surface(const Settings &more)
  {
    const Body<dim>   body(box<dim>() + Settings{{"Peridynamics/Surface correction", "moments"}} +
                           more,
                         ModelKind::peridynamics);
    std::vector<bool> wrong(body.nodes->n_owned(), false);
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a; b < dim; ++b)
        {
          dealii::SymmetricTensor<2, dim> strain;
          strain[a][b]   = 1.;
          const Vector u = body.values(
            [&](const dealii::Point<dim> &p) { return dealii::Tensor<1, dim>(strain * p); });
          const std::vector<double> theta = nodal_dilatations(body.states->bonds(), u);
          const NodalTensors<dim>   found = body.states->tensors(u);
          // The stress of a node in the middle, whose family is complete.
          double                          nearest = 1e300;
          dealii::SymmetricTensor<2, dim> inside;
          for (unsigned int i = 0; i < theta.size(); ++i)
            if (const double distance = body.position(i).distance(0.5 * body.scene.domain.upper);
                distance < nearest)
              {
                nearest = distance;
                inside  = found.stress[i];
              }
          for (const auto &other :
               dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, std::make_pair(nearest, inside)))
            if (other.first < nearest)
              std::tie(nearest, inside) = other;
          for (unsigned int i = 0; i < theta.size(); ++i)
            if (std::abs(theta[i] - trace(strain)) > 1e-11 ||
                (found.stress[i] - inside).norm() > 1e-11 * inside.norm())
              wrong[i] = true;
        }
    const unsigned int n_wrong =
      sum_of_all(static_cast<unsigned int>(std::count(wrong.begin(), wrong.end(), true)));
    EXPECT_LE(n_wrong, body.states->bonds().corrections.n_left) << dim;
    EXPECT_LT(body.states->bonds().corrections.n_left,
              (dim == 3 ? 0.5 : 0.1) * body.nodes->n_global());
  }
} // namespace


TEST(SurfaceCorrection, moments_make_uniform_strains_exact)
{
  for (const std::string nodes : {"vertices", "cell centers"})
    {
      const Settings placed{{"Domain/Nodes", nodes}};
      uniform_strains_up_to_the_surface<1>(placed);
      for (const std::string nu : {"-0.9", "0.3", "0.499"})
        uniform_strains_up_to_the_surface<2>(
          placed + Settings{{"Domain/Cells", "20, 15"}, {"Material/Poisson ratio", nu}});
      const Settings cube{{"Domain/Upper corner", "1, 1, 1"},
                          {"Domain/Cells", "9, 9, 9"},
                          {"Peridynamics/Horizon ratio", "3"}};
      uniform_strains_up_to_the_surface<3>(placed + cube);
    }
}


TEST(SurfaceCorrection, corners_are_left)
{
  const Settings moments{{"Peridynamics/Surface correction", "moments"}};
  const Body<1>  bar(box<1>() + moments, ModelKind::peridynamics);
  EXPECT_EQ(bar.states->bonds().corrections.n_left, 0u);
  for (const std::string cells : {"20, 20", "30, 30"})
    {
      const Body<2> square(
        box<2>() + Settings{{"Domain/Upper corner", "1, 1"}, {"Domain/Cells", cells}} + moments,
        ModelKind::peridynamics);
      EXPECT_EQ(square.states->bonds().corrections.n_left, 4u);
    }
}


TEST(SurfaceCorrection, refuses_energies_that_are_not_positive)
{
  const Settings auxetic = box<2>() + Settings{{"Material/Poisson ratio", "-0.95"}};
  const auto     make    = [&](const std::string &law) {
    Body<2>(auxetic + Settings{{"Peridynamics/Surface correction", law}}, ModelKind::peridynamics);
  };
  for (const std::string law : {"none", "moments"})
    EXPECT_NO_THROW(make(law));
  EXPECT_THROW(make("energy"), UserError);
}
