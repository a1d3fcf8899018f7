// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Full kinematics, viscosity, and the frequencies of plane waves.

#include "elastic_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;
  using dealii::Tensor;

  namespace
  {
    const Settings moving{{"Elasticity/Solver", "dynamics"}};
    const Settings full = moving + Settings{{"Elasticity/Kinematics", "full"}};


    template <int dim>
    Tensor<2, dim> rotation(const double angle)
    {
      Tensor<2, dim> r;
      for (unsigned int d = 0; d < dim; ++d)
        r[d][d] = 1.;
      r[0][0] = r[1][1] = std::cos(angle);
      r[0][1]           = -std::sin(angle);
      r[1][0]           = std::sin(angle);
      return r;
    }


    /** A rotation makes no force, and turns the forces of a deformed body. */
    template <int dim>
    void check_rotation(const Settings &more)
    {
      const Body<dim>      body(box<dim>() + full + more, ModelKind::peridynamics);
      const Tensor<2, dim> turn  = rotation<dim>(2.);
      const auto           place = [](const Point<dim> &p) {
        return Point<dim>(p + 0.1 * bumpy_vector<dim>(p));
      };
      const Vector f = body.unbalanced(
                     body.values([&](const Point<dim> &p) { return place(p) - p; })),
                   turned = body.unbalanced(
                     body.values([&](const Point<dim> &p) { return turn * place(p) - p; })),
                   rigid = body.values([&](const Point<dim> &p) { return turn * p - p; });
      const double size  = f.linfty_norm();
      double       gap   = 0.;
      for (unsigned int i = 0; i < f.locally_owned_size() / dim; ++i)
        for (unsigned int d = 0; d < dim; ++d)
          {
            double expected = 0.;
            for (unsigned int e = 0; e < dim; ++e)
              expected += turn[d][e] * f.local_element(dim * i + e);
            gap = std::max(gap, std::abs(expected - turned.local_element(dim * i + d)));
          }
      EXPECT_LT(gap, 1e-12 * size);
      EXPECT_LT(body.unbalanced(rigid).linfty_norm(), 1e-12 * size);
      EXPECT_LT(body.op().energy(rigid), 1e-24);
    }


    /** To first order the linear body; the energy's gradient; the tangent. */
    template <int dim>
    void check_derivatives(const Settings &more)
    {
      Body<dim>        body(box<dim>() + full + more, ModelKind::peridynamics);
      const Body<dim>  linear(box<dim>() + moving + more, ModelKind::peridynamics);
      ElasticOperator &op = body.op();
      const Vector     w = body.values(bumpy_vector<dim>), s = linear.residual(w);
      double           gaps[2];
      for (unsigned int k = 0; k < 2; ++k)
        {
          const double size = k == 0 ? 1e-4 : 1e-5;
          Vector       u    = w;
          u *= size;
          Vector r = body.residual(u);
          r *= 1. / size;
          gaps[k] = relative_difference(r, s);
        }
      if (dim > 1) // bars stretch linearly
        {
          EXPECT_NEAR(gaps[0] / gaps[1], 10., 0.1);
        }
      EXPECT_LT(gaps[1], dim > 1 ? 1e-3 : 1e-10);

      const Vector u = body.values([&](const Point<dim> &p) {
        Tensor<1, dim> value = 0.1 * bumpy_vector<dim>(p);
        value[0] += 0.3 * p[0];
        return value;
      });
      op.linearize(u);
      expect_derivatives(body, u, body.product(w), 1e-5, 1e-8, 1e-7);
    }


    template <int dim>
    void check_damping(const ModelKind model)
    {
      const Body<dim>        body(box<dim>(), model);
      const ElasticOperator &op = body.op();
      Vector                 y = body.vector(), z = y;
      Vector v = body.values(bumpy_vector<dim>), w = body.values([](const Point<dim> &p) {
        Point<dim> q(p);
        q *= 1.7;
        return bumpy_vector<dim>(q);
      });
      op.clear_constrained(v);
      op.clear_constrained(w);
      op.damping_force(y, v);
      op.damping_force(z, w);
      EXPECT_NEAR(y * w, z * v, 1e-12 * std::abs(y * v));
      double mass = 0.;
      for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
        mass += v.local_element(i) * v.local_element(i) * op.lumped_capacity().local_element(i);
      mass = sum_of_all(mass);
      EXPECT_GT(y * v, 0.);
      EXPECT_LT(y * v, op.damping_bound() * mass);
    }


    /**
     * omega^2 of plane waves along x, u along the direction: sums over the lattice written down
     * here.
     */
    template <int dim>
    double lattice_frequency_square(const double       m,
                                    const double       k,
                                    const unsigned int direction,
                                    const double       volumetric,
                                    const double       extension,
                                    const double       density)
    {
      // spacing 1, conical kernel over r^2, linear volume fraction
      const int reach = static_cast<int>(m + 1.);
      double    q = 0., odd = 0., even = 0.;
      for (int a = -reach; a <= reach; ++a)
        for (int b = dim > 1 ? -reach : 0; b <= (dim > 1 ? reach : 0); ++b)
          {
            const double r = std::hypot(a, b);
            if (r == 0. || r >= m + 0.5)
              continue;
            const double f = std::min(1., m + 0.5 - r);
            const double s = r < m - 0.5 ? r : r <= m ? r - 0.5 * (1. - f) : m - 0.5 * f;
            const double w = (1. - s / m) / (r * r) * f;
            q += w * r * r;
            odd += w * a * std::sin(k * a);
            const double along = direction == 0 ? a : b;
            even += w * along * along / (r * r) * (1. - std::cos(k * a));
          }
      return ((direction == 0 ? dim * volumetric * odd * odd / (q * q) : 0.) +
              2. * extension * even / q) /
             density;
    }


    template <int dim>
    void check_dispersion(const Settings &more, const double m, const unsigned int direction)
    {
      Settings        settings{{"Domain/Lower corner", zeros[dim]},
                        {"Domain/Upper corner", dim == 1 ? "40" : "40, 20"},
                        {"Domain/Cells", dim == 1 ? "40" : "40, 20"},
                        {"Peridynamics/Horizon ratio", std::to_string(m)},
                        {"Peridynamics/Kernel exponent", "2"},
                        {"Peridynamics/Calibration", "discrete"},
                        {"Material/Young modulus", "3"},
                        {"Material/Poisson ratio", "0.2"},
                        {"Material/Density", "0.7"}};
      const Body<dim> body(settings + moving + more, ModelKind::peridynamics);
      const StateLaw  law =
        state_law(body.scene.material.moduli(Point<dim>()), dim, body.scene.elasticity.plane);
      for (const double k : {0.05, 0.4, 1.5, 3.})
        {
          const Vector u = body.values([&](const Point<dim> &p) {
            Tensor<1, dim> value;
            value[direction] = std::cos(k * (p[0] - 20.));
            return value;
          });
          const Vector y = body.product(u);
          const double square =
            lattice_frequency_square<dim>(m, k, direction, law.volumetric, law.extension, 0.7);
          const double reach = 2. * (m + 1.);
          double       worst = 0.;
          for (unsigned int i = 0; i < y.locally_owned_size() / dim; ++i)
            {
              const Point<dim> &p = body.position(i);
              if (p[0] < reach || p[0] > 40. - reach ||
                  (dim > 1 && (p[dim - 1] < reach || p[dim - 1] > 20. - reach)))
                continue;
              const double mass = body.op().lumped_capacity().local_element(dim * i);
              for (unsigned int d = 0; d < dim; ++d)
                worst = std::max(worst,
                                 std::abs(y.local_element(dim * i + d) / mass -
                                          square * u.local_element(dim * i + d)));
            }
          EXPECT_LT(worst, 1e-12 * std::max(square, 1e-2)) << k;
        }
    }
  } // namespace


  TEST(FullKinematics, rotations_make_no_force)
  {
    for (const std::string nu : {"-0.3", "0.45"})
      {
        check_rotation<2>({{"Material/Poisson ratio", nu}});
        check_rotation<3>({{"Domain/Cells", "6, 4, 3"}, {"Material/Poisson ratio", nu}});
      }
    check_rotation<2>({{"Elasticity/Model", "bond-based"}, {"Elasticity/Plane", "strain"}});
  }


  TEST(FullKinematics, derivatives)
  {
    check_derivatives<1>({});
    check_derivatives<2>({{"Domain/Cells", "8, 6"}});
    check_derivatives<2>({{"Domain/Cells", "8, 6"}, {"Elasticity/Plane", "strain"}});
    check_derivatives<3>({{"Domain/Cells", "4, 3, 2"}});
  }


  TEST(ElasticOperator, viscosity)
  {
    for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
      check_damping<2>(model);
    check_damping<3>(ModelKind::peridynamics);
  }


  TEST(StateOperator, plane_waves)
  {
    check_dispersion<1>({}, 3., 0);
    check_dispersion<1>({}, 2., 0);
    for (const std::string nu : {"-0.3", "0.2", "0.45"})
      for (const unsigned int direction : {0u, 1u})
        check_dispersion<2>({{"Material/Poisson ratio", nu}}, 3., direction);
    check_dispersion<2>({{"Elasticity/Plane", "strain"}}, 2., 0);
  }
} // namespace PeriDeal
