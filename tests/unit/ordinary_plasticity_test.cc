// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The law of a node that yields, in homogeneous strains of a lattice family, against closed forms
// and against the return of a point of the classical body, which is written down here by itself.

#include <deal.II/base/symmetric_tensor.h>

#include <perideal/laws/ordinary_plasticity.h>

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <vector>

using namespace PeriDeal;
using dealii::SymmetricTensor;
using dealii::Tensor;

namespace
{
  constexpr double young = 1., poisson = 0.3, limit = 1e-3;

  Moduli moduli()
  {
    return moduli_from(Modulus::young, young, Modulus::poisson, poisson);
  }


  /** Powers of the components of a unit vector, all of the fourth degree, less their means. */
  template <int dim>
  Eigen::VectorXd harmonics(const Tensor<1, dim> &n)
  {
    std::vector<double> values;
    for (int a = 0; a <= 4; ++a)
      for (int b = 0; a + b <= 4; ++b)
        {
          const int c = 4 - a - b;
          if (dim == 2 && c > 0)
            continue;
          double mean = 0.;
          if (a % 2 == 0 && b % 2 == 0 && c % 2 == 0)
            mean = (a == 4 || b == 4 || c == 4 ? 3. : 1.) / (dim * (dim + 2.));
          values.push_back(std::pow(n[0], a) * std::pow(n[1], b) *
                             (dim == 3 ? std::pow(n[dim - 1], c) : 1.) -
                           mean);
        }
    return Eigen::Map<Eigen::VectorXd>(values.data(), values.size());
  }


  /** A complete family of the lattice and what its bonds remember, as one node sees it. */
  template <int dim>
  struct Node
  {
    struct Bond
    {
      Tensor<1, dim> xi;
      double         weight; // omega V
      double         plastic = 0.;
    };

    std::vector<Bond>         bonds;
    double                    q = 0., alpha;
    OrdinaryPlasticity        law;
    OrdinaryPlasticity::State state;

    Node(const PlaneState plane, const double hardening, const bool isotropic)
      : law(moduli(), dim, plane, limit, hardening)
    {
      constexpr int m = 3;
      for (int a = -m; a <= m; ++a)
        for (int b = -m; b <= m; ++b)
          for (int c = dim == 3 ? -m : 0; c <= (dim == 3 ? m : 0); ++c)
            {
              Tensor<1, dim> xi;
              xi[0] = a;
              xi[1] = b;
              if (dim == 3)
                xi[dim - 1] = c;
              const double x = xi.norm(), part = std::min(1., m + 0.5 - x);
              if (x > 0. && part > 0.)
                bonds.push_back({xi, part / x});
            }
      if (isotropic)
        even_out();
      for (const Bond &bond : bonds)
        q += bond.weight * bond.xi.norm_square();
      alpha = dim * (dim + 2.) * moduli().shear / q;
    }

    /** Weights whose moments up to the fourth are those of a ball. */
    void even_out()
    {
      const unsigned int n = harmonics<dim>(bonds[0].xi).size();
      Eigen::MatrixXd    matrix(Eigen::MatrixXd::Zero(n, n));
      Eigen::VectorXd    right(Eigen::VectorXd::Zero(n));
      for (const Bond &bond : bonds)
        {
          const Eigen::VectorXd y = harmonics<dim>(bond.xi / bond.xi.norm());
          matrix += bond.weight * bond.xi.norm_square() * y * y.transpose();
          right -= bond.weight * bond.xi.norm_square() * y;
        }
      const Eigen::VectorXd factors = matrix.completeOrthogonalDecomposition().solve(right);
      for (Bond &bond : bonds)
        bond.weight *= 1. + factors.dot(harmonics<dim>(bond.xi / bond.xi.norm()));
    }

    /** The shear modulus of the family in a plane of two axes. */
    double shear_modulus() const
    {
      double sum = 0.;
      for (const Bond &bond : bonds)
        sum += bond.weight * std::pow(bond.xi[0] * bond.xi[1] / bond.xi.norm(), 2);
      return alpha * sum;
    }

    /** The stress, after which the strain is accepted or not. */
    SymmetricTensor<2, dim> stress(const SymmetricTensor<2, dim> &strain, const bool accept)
    {
      double theta = 0., sum = 0.;
      for (const Bond &bond : bonds)
        theta += dim * bond.weight * (bond.xi * (strain * bond.xi)) / q;
      const auto elastic = [&](const Bond &bond) {
        const double x = bond.xi.norm();
        return bond.xi * (strain * bond.xi) / x - theta * x / dim - bond.plastic;
      };
      for (const Bond &bond : bonds)
        sum += 0.5 * alpha * bond.weight * elastic(bond) * elastic(bond);
      const auto              answer = law.answer(theta, sum, state);
      SymmetricTensor<2, dim> result;
      for (Bond &bond : bonds)
        {
          const double x = bond.xi.norm();
          const double t = dim * answer.mean / q * x + alpha * answer.ratio * elastic(bond);
          result += bond.weight * t / x * symmetrize(outer_product(bond.xi, bond.xi));
          if (accept)
            bond.plastic += (1. - answer.ratio) * elastic(bond);
        }
      if (accept)
        {
          state.strain += answer.change.strain;
          state.plane += answer.change.plane;
        }
      return result;
    }
  };


  /** Radial return of the classical body in three dimensions. */
  struct Point
  {
    SymmetricTensor<2, 3> plastic;
    double                kappa = 0.;

    SymmetricTensor<2, 3> stress(const SymmetricTensor<2, 3> &strain,
                                 const double                 hardening,
                                 const bool                   accept)
    {
      const double          G = moduli().shear, K = moduli().bulk;
      SymmetricTensor<2, 3> s     = 2. * G * (deviator(strain) - plastic);
      const double          mises = std::sqrt(1.5) * s.norm();
      const double step = std::max(0., (mises - limit - hardening * kappa) / (3. * G + hardening));
      if (step > 0.)
        {
          const SymmetricTensor<2, 3> flow = 1.5 / mises * s;
          s -= 2. * G * step * flow;
          if (accept)
            plastic += step * flow;
        }
      if (accept)
        kappa += step;
      return K * trace(strain) * dealii::unit_symmetric_tensor<3>() + s;
    }
  };


  template <int dim>
  SymmetricTensor<2, dim> shear_by(const double gamma)
  {
    SymmetricTensor<2, dim> strain;
    strain[0][1] = 0.5 * gamma;
    return strain;
  }


  /** Sheared to five times the strain at which it yields, in steps, and let go. */
  template <int dim>
  void expect_plateau(const PlaneState plane, const double hardening, const bool isotropic)
  {
    Node<dim>    node(plane, hardening, isotropic);
    const double G = moduli().shear, own = node.shear_modulus(), rate = std::sqrt(3. * G * own),
                 gamma = 5. * limit / rate;
    if (isotropic)
      {
        EXPECT_NEAR(own, G, 1e-13 * G);
      }
    for (unsigned int k = 1; k <= 40; ++k)
      node.stress(shear_by<dim>(gamma * k / 40.), true);
    const double kappa = (rate * gamma - limit) / (3. * G + hardening);
    EXPECT_NEAR(node.state.strain, kappa, 1e-10 * kappa);
    const double tau = own * (gamma - 3. * G / rate * kappa);
    EXPECT_NEAR(node.stress(shear_by<dim>(gamma), false)[0][1], tau, 1e-10 * tau);
    if (hardening == 0.)
      {
        EXPECT_NEAR(tau, limit / std::sqrt(3.) * std::sqrt(own / G), 1e-10 * tau);
      }
    EXPECT_NEAR(node.stress(shear_by<dim>(gamma - tau / own), false)[0][1], 0., 1e-10 * tau);
  }


  /** A path of turns against that of a point. */
  template <int dim>
  void expect_return(const PlaneState plane, const double hardening)
  {
    Node<dim>                        node(plane, hardening, true);
    Point                            point;
    std::mt19937                     random(1);
    std::normal_distribution<double> normal;
    SymmetricTensor<2, dim>          strain, change;
    SymmetricTensor<2, 3>            full;
    for (unsigned int k = 0; k < 60; ++k)
      {
        for (unsigned int a = 0; k % 10 == 0 && a < dim; ++a)
          for (unsigned int b = a; b < dim; ++b)
            change[a][b] = normal(random) * limit / 3. / (a == b ? 1. : std::sqrt(2.));
        strain += change;
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = a; b < dim; ++b)
            full[a][b] = strain[a][b];
        if (dim == 2 && plane == PlaneState::stress)
          {
            // Between bounds for sure: the stress out of the plane grows with the strain there.
            double below = -1., above = 1.;
            for (unsigned int n = 0; n < 200; ++n)
              {
                full[2][2] = 0.5 * (below + above);
                (point.stress(full, hardening, false)[2][2] < 0. ? below : above) = full[2][2];
              }
          }
        const SymmetricTensor<2, 3>   wanted = point.stress(full, hardening, true);
        const SymmetricTensor<2, dim> found  = node.stress(strain, true);
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = a; b < dim; ++b)
            EXPECT_NEAR(found[a][b], wanted[a][b], 1e-12 * limit) << "step " << k;
        EXPECT_NEAR(node.state.strain, point.kappa, 1e-11 * (point.kappa + limit));
      }
    EXPECT_GT(point.kappa, 3. * limit);
  }


  template <typename Test>
  void for_each_kind(const Test &test)
  {
    for (const double hardening : {0., 0.1 * young})
      {
        SCOPED_TRACE("H = " + std::to_string(hardening));
        {
          SCOPED_TRACE("3D");
          test(std::integral_constant<int, 3>(), PlaneState::strain, hardening);
        }
        {
          SCOPED_TRACE("plane strain");
          test(std::integral_constant<int, 2>(), PlaneState::strain, hardening);
        }
        {
          SCOPED_TRACE("plane stress");
          test(std::integral_constant<int, 2>(), PlaneState::stress, hardening);
        }
      }
  }
} // namespace


TEST(OrdinaryPlasticity, shear_of_a_family_against_closed_forms)
{
  for (const bool isotropic : {false, true})
    for_each_kind([&](const auto dim, const PlaneState plane, const double hardening) {
      expect_plateau<decltype(dim)::value>(plane, hardening, isotropic);
    });
}


TEST(OrdinaryPlasticity, isotropic_families_return_as_points_do)
{
  for_each_kind([&](const auto dim, const PlaneState plane, const double hardening) {
    expect_return<decltype(dim)::value>(plane, hardening);
  });
}


TEST(OrdinaryPlasticity, mean_stress_and_ratio_are_derivatives)
{
  for_each_kind([&](const auto dim, const PlaneState plane, const double hardening) {
    const OrdinaryPlasticity        law(moduli(), decltype(dim)::value, plane, limit, hardening);
    const OrdinaryPlasticity::State state{0.3 * limit, -0.2 * limit};
    for (const double size : {0.3, 3.}) // elastic, and not
      {
        const double theta = 1.1 * size * limit, sum = 0.4 * size * size * limit * limit;
        const auto   at = law.answer(theta, sum, state);
        EXPECT_EQ(at.yields(), size > 1.);
        EXPECT_EQ(at.yields(), at.ratio < 1.);
        const double da = 1e-6 * theta, db = 1e-6 * sum;
        const auto   energy = [&](const double a, const double b) {
          const auto answer = law.answer(a, b, state);
          return answer.stored + answer.dissipated;
        };
        const double scale = energy(theta, sum);
        EXPECT_NEAR((energy(theta + da, sum) - energy(theta - da, sum)) / (2. * da),
                    at.mean,
                    1e-9 * scale / theta);
        EXPECT_NEAR((energy(theta, sum + db) - energy(theta, sum - db)) / (2. * db),
                    at.ratio,
                    1e-9 * scale / sum);
        const auto up    = law.answer(theta + da, sum, state),
                   down  = law.answer(theta - da, sum, state),
                   over  = law.answer(theta, sum + db, state),
                   under = law.answer(theta, sum - db, state);
        EXPECT_NEAR((up.mean - down.mean) / (2. * da), at.by_theta, 1e-8 * at.mean / theta);
        EXPECT_NEAR((up.ratio - down.ratio) / (2. * da), at.mixed, 1e-8 / theta);
        EXPECT_NEAR((over.ratio - under.ratio) / (2. * db), at.by_sum, 1e-8 / sum);
        EXPECT_NEAR((over.mean - under.mean) / (2. * db), at.mixed, 1e-8 * at.mean / sum);
      }
  });
}
