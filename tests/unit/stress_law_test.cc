// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Laws of stresses: J2 plasticity at a point against closed forms, its tangent and energies, plane
// stress; in finite elements uniform strains on distorted cells, forces and tangents, archives.

#include <perideal/base/archive.h>
#include <perideal/laws/elasticity.h>
#include <perideal/laws/j2_plasticity.h>
#include <perideal/mesh/node_keys.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "distorted_mesh.h"
#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;
using dealii::Point;
using dealii::Tensor;

namespace
{
  using Strain = StressLaw::Tensor;

  constexpr double young = 1000., poisson = 0.3, yield = 1.;

  /** One point of a body, which goes from strain to strain. */
  struct PointOfBody
  {
    PointOfBody(const StressState kind, const double hardening)
      : law(kind)
      , parameters(law.parameters(moduli_from(Modulus::young, young, Modulus::poisson, poisson),
                                  yield,
                                  hardening))
      , state(law.n_state(), 0.)
      , next(state)
    {}

    StressLaw::Response look(const Strain &strain, StressLaw::Tangent *tangent = nullptr)
    {
      return law.update({strain, parameters.data(), state.data()}, next.data(), tangent);
    }

    StressLaw::Response go(const Strain &strain)
    {
      const auto response = look(strain);
      state               = next;
      dissipated += response.dissipated;
      return response;
    }

    double plastic_strain() const
    {
      return state.back();
    }

    const J2Plasticity        law;
    const std::vector<double> parameters;
    std::vector<double>       state, next;
    double                    dissipated = 0.;
  };


  /** A strain that changes its way every eight steps, by about a fifth of that of yielding. */
  class RandomPath
  {
  public:
    explicit RandomPath(const StressState kind)
      : kind(kind)
    {}

    const Strain &step()
    {
      std::normal_distribution<double> normal(0., 2e-4);
      if (n++ % 8 == 0)
        for (unsigned int k = 0; k < 6; ++k)
          way.access_raw_entry(k) = is_there(k) ? normal(generator) : 0.;
      return at += way;
    }

    /** A component of strains. */
    bool is_there(const unsigned int k) const
    {
      return kind == StressState::three_dimensional || k < 2 || k == 3;
    }

  private:
    const StressState kind;
    std::mt19937      generator{1};
    unsigned int      n = 0;
    Strain            at, way;
  };


  const StressState kinds[] = {StressState::three_dimensional, StressState::plane_stress};


  TEST(J2Plasticity, shear_and_what_is_left_of_it)
  {
    for (const StressState kind : kinds)
      for (const double H : {0., 50.})
        {
          PointOfBody  point(kind, H);
          const double G       = 0.5 * young / (1. + poisson),
                       largest = 10. * yield / (std::sqrt(3.) * G);
          Strain strain;
          double stress = 0.;
          for (unsigned int k = 1; k <= 40; ++k)
            {
              strain[0][1] = 0.5 * k / 40. * largest;
              stress       = point.go(strain).stress[0][1];
            }
          // sqrt(3) stress = sy + H kappa, sqrt(3) kappa = shear - stress/G
          const double kappa = (std::sqrt(3.) * G * largest - yield) / (3. * G + H);
          EXPECT_NEAR(point.plastic_strain(), kappa, 1e-12 * kappa);
          EXPECT_NEAR(std::sqrt(3.) * stress, yield + H * kappa, 1e-12);
          EXPECT_NEAR(point.dissipated, yield * kappa, 1e-12);
          strain[0][1] -= 0.5 * stress / G;
          const auto rest = point.go(strain);
          EXPECT_LT(rest.stress.norm(), 1e-12);
          EXPECT_NEAR(2. * strain[0][1], std::sqrt(3.) * kappa, 1e-10 * largest);
          EXPECT_NEAR(rest.stored, 0.5 * H * kappa * kappa, 1e-14);
        }
  }


  TEST(J2Plasticity, tangent_and_energy_along_random_paths)
  {
    for (const StressState kind : kinds)
      for (const double H : {0., 50., 500.})
        {
          PointOfBody        point(kind, H);
          RandomPath         path(kind);
          const double       h         = 1e-9;
          unsigned int       n_flowing = 0;
          StressLaw::Tangent tangent;
          for (unsigned int n = 0; n < 200; ++n)
            {
              const Strain strain   = path.step();
              const auto   response = point.look(strain, &tangent);
              for (unsigned int k = 0; k < 6; ++k)
                if (path.is_there(k))
                  {
                    Strain up = strain, down = strain, unit;
                    up.access_raw_entry(k) += h;
                    down.access_raw_entry(k) -= h;
                    unit.access_raw_entry(k) = 1.;
                    const auto   above = point.look(up), below = point.look(down);
                    const Strain change = (above.stress - below.stress) / (2. * h);
                    EXPECT_LT((tangent * unit - change).norm(), 1e-6 * young) << n << ' ' << k;
                    EXPECT_NEAR(
                      (above.stored + above.dissipated - below.stored - below.dissipated) /
                        (2. * h),
                      response.stress * unit,
                      1e-6 * yield);
                  }
              const double before = point.plastic_strain();
              point.go(strain);
              const double limit = yield + H * point.plastic_strain();
              EXPECT_LE(von_mises(response.stress), limit * (1. + 1e-13));
              if (point.plastic_strain() > before)
                {
                  ++n_flowing;
                  EXPECT_NEAR(von_mises(response.stress), limit, 1e-12 * limit);
                }
              EXPECT_NEAR(point.state[0] + point.state[1] + point.state[2], 0., 1e-15);
            }
          EXPECT_GT(n_flowing, 40u);
          EXPECT_LT(n_flowing, 200u);
        }
  }


  TEST(J2Plasticity, plane_stress_is_a_body_that_is_free_out_of_the_plane)
  {
    for (const double H : {0., 50.})
      {
        PointOfBody plane(StressState::plane_stress, H), full(StressState::three_dimensional, H);
        RandomPath  path(StressState::plane_stress);
        double      out_of_plane = 0.;
        for (unsigned int n = 0; n < 100; ++n)
          {
            Strain              strain = path.step();
            StressLaw::Response of_full;
            StressLaw::Tangent  tangent;
            for (unsigned int k = 0; k < 50; ++k)
              {
                strain[2][2] = out_of_plane;
                of_full      = full.look(strain, &tangent);
                if (std::abs(of_full.stress[2][2]) < 1e-13)
                  break;
                out_of_plane -= of_full.stress[2][2] / tangent[2][2][2][2];
              }
            full.go(strain);
            const auto of_plane = plane.go(strain);
            EXPECT_EQ(of_plane.stress[2][2], 0.);
            EXPECT_LT((of_plane.stress - of_full.stress).norm(), 1e-11);
            EXPECT_NEAR(of_plane.stored, of_full.stored, 1e-13);
            for (unsigned int k = 0; k < plane.state.size(); ++k)
              EXPECT_NEAR(plane.state[k], full.state[k], 1e-14);
          }
      }
  }


  /** Stored and dissipated less the work of the mean stresses of so many steps. */
  double error_of_work(const StressState kind, const unsigned int n_steps)
  {
    PointOfBody         point(kind, 50.);
    StressLaw::Response last;
    Strain              before;
    double              work = 0.;
    for (unsigned int n = 1; n <= n_steps; ++n)
      {
        const double x = 1. * n / n_steps;
        Strain       strain;
        strain[0][0]        = 5e-3 * x;
        strain[0][1]        = 4e-3 * x * x;
        strain[1][1]        = -2e-3 * x * x * x;
        const auto response = point.go(strain);
        work += 0.5 * (response.stress + last.stress) * (strain - before);
        last   = response;
        before = strain;
      }
    return last.stored + point.dissipated - work;
  }


  TEST(J2Plasticity, energies_are_the_work_of_small_steps)
  {
    for (const StressState kind : kinds)
      {
        const double coarse = error_of_work(kind, 100), fine = error_of_work(kind, 200),
                     finest = error_of_work(kind, 400);
        EXPECT_LT(std::abs(finest), 1e-5);
        EXPECT_GT(std::abs(coarse / fine), 1.8);
        EXPECT_GT(std::abs(fine / finest), 1.8);
      }
  }


  /** A cell of a unit square or cube of n^dim, inner vertices moved. */
  template <int dim>
  std::string distorted_mesh()
  {
    constexpr unsigned int n = dim == 3 ? 3 : 5;
    return lattice_mesh<dim>("stress_law", n, [](const std::array<unsigned int, 3> &k) {
      std::array<double, 3> p{{1. * k[0] / n, 1. * k[1] / n, 1. * k[2] / n}};
      bool                  inside = true;
      for (unsigned int d = 0; d < dim; ++d)
        inside = inside && k[d] > 0 && k[d] < n;
      for (unsigned int d = 0; d < dim && inside; ++d)
        p[d] += 0.2 / n * std::sin(3. * k[0] + 5. * k[1] + 7. * k[2] + 2. * d);
      return p;
    });
  }


  template <int dim>
  Settings yielding(const unsigned int degree, const std::string &plane)
  {
    Settings settings = {{"Finite elements/Degree", std::to_string(degree)},
                         {"Material/Young modulus", std::to_string(young)},
                         {"Material/Poisson ratio", std::to_string(poisson)},
                         {"Material/Law", "plastic"},
                         {"Material/Yield stress", std::to_string(yield)},
                         {"Material/Hardening modulus", "20"},
                         {"Elasticity/Solver", "newton"}};
    if (dim == 2)
      settings.push_back({"Elasticity/Plane", plane});
    return settings;
  }


  template <int dim>
  Settings yielding_box(const unsigned int degree, const std::string &plane)
  {
    Settings settings = box<dim>();
    for (const auto &setting : yielding<dim>(degree, plane))
      settings.push_back(setting);
    return settings;
  }


  /** Some strain of so many times the one that yields. */
  template <int dim>
  Vector stretched(const Body<dim> &body, const double times)
  {
    return body.values(
      [&](const Point<dim> &p) { return times * yield / young * linear_field<dim>(p); });
  }


  template <int dim>
  void expect_uniform_stress(const unsigned int degree, const std::string &plane)
  {
    Settings          settings = yielding<dim>(degree, plane);
    const std::string mesh     = distorted_mesh<dim>();
    settings.push_back({"Elasticity/Solver", "dynamics"}); // nothing holds it
    settings.push_back({"Material/Density", "1.0"});
    settings.push_back({"Domain/Shape", "mesh file"});
    settings.push_back({"Domain/Mesh file", mesh});
    Body<dim> body(settings, ModelKind::finite_elements);
    double    energy = 0.;
    for (const double times : {2., 5., 4.}) // on and on, then some of the way back
      {
        const Vector u      = stretched(body, times);
        const Vector forces = body.unbalanced(u);
        double       inside = 0.;
        for (unsigned int i = 0; i < body.n_owned(); ++i)
          {
            bool is_inside = true;
            for (unsigned int d = 0; d < dim; ++d)
              is_inside = is_inside && body.position(i)[d] > 1e-9 &&
                          body.position(i)[d] < 1. - 1e-9;
            for (unsigned int d = 0; d < dim && is_inside; ++d)
              inside = std::max(inside, std::abs(forces.local_element(dim * i + d)));
          }
        EXPECT_LT(dealii::Utilities::MPI::max(inside, MPI_COMM_WORLD), 1e-10 * forces.linfty_norm())
          << dim << ' ' << degree << ' ' << plane << ' ' << times;
        body.op().accept(u, times);
        energy = body.op().energy(u);
      }
    // The same at one point.
    PointOfBody point(dim == 2 && plane == "stress" ? StressState::plane_stress :
                                                      StressState::three_dimensional,
                      20.);
    double stored = 0.;
    for (const double times : {2., 5., 4.})
      {
        Strain strain;
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = a; b < dim; ++b)
            strain[a][b] = times * yield / young * 0.5 *
                           (some_gradient<dim>()[a][b] + some_gradient<dim>()[b][a]);
        stored = point.go(strain).stored;
      }
    EXPECT_GT(point.plastic_strain(), 0.);
    EXPECT_NEAR(energy, stored, 1e-10 * stored);
    EXPECT_NEAR(body.op().released().by_law, point.dissipated, 1e-10 * point.dissipated);
    std::remove(mesh.c_str());
  }


  TEST(StressCells, uniform_strains_on_distorted_cells)
  {
    for (const unsigned int degree : {1u, 2u})
      {
        expect_uniform_stress<2>(degree, "strain");
        expect_uniform_stress<2>(degree, "stress");
      }
    expect_uniform_stress<3>(1, "");
    expect_uniform_stress<3>(2, "");
  }


  /** Stored at u and dissipated on the way to it. Collective. */
  template <int dim>
  double spent(const Body<dim> &body, const Vector &u)
  {
    double sum = 0.;
    u.update_ghost_values();
    body.elements->beside().stresses->for_each(u, [&](const auto &, const auto &points) {
      for (const auto &point : points)
        sum += point.weight * (point.response.stored + point.response.dissipated);
    });
    u.set_ghost_state(false);
    return dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD);
  }


  template <int dim>
  Vector bumpy(const Body<dim> &body, const double times)
  {
    Vector u = stretched(body, times);
    u.add(0.3 * times * yield / young, body.values(bumpy_vector<dim>));
    return u;
  }


  template <int dim>
  void expect_slopes(const unsigned int degree, const std::string &plane)
  {
    const Body<dim> body(yielding_box<dim>(degree, plane), ModelKind::finite_elements);
    body.op().accept(bumpy(body, 4.), 1.);
    EXPECT_GT(body.op().released().by_law, 0.);
    Vector u = bumpy(body, 3.);
    u.add(yield / young, stretched(body, 1e3));
    const double h   = 1e-8;
    const Vector way = body.values(bumpy_vector<dim>);
    Vector       up = u, down = u;
    up.add(h, way);
    down.add(-h, way);
    const double slope = (spent(body, up) - spent(body, down)) / (2. * h);
    EXPECT_NEAR(slope, -(body.unbalanced(u) * way), 1e-6 * std::abs(slope));
    body.op().linearize(u);
    Vector change = body.unbalanced(down);
    change -= body.unbalanced(up);
    change *= 1. / (2. * h);
    EXPECT_LT(relative_difference(change, body.product(way)), 1e-5)
      << dim << ' ' << degree << plane;
  }


  TEST(StressCells, forces_are_slopes_of_energies_and_the_tangent_is_theirs)
  {
    expect_slopes<2>(1, "strain");
    expect_slopes<2>(1, "stress");
    expect_slopes<2>(2, "strain");
    expect_slopes<3>(1, "");
  }


  TEST(StressCells, states_go_to_any_number_of_processes)
  {
    const Settings settings = yielding_box<2>(1, "strain");
    Body<2>        body(settings, ModelKind::finite_elements);
    body.op().accept(bumpy(body, 4.), 1.);
    MemoryArchive saved(MPI_COMM_WORLD);
    body.op().exchange(saved, node_keys(body.handler));
    // On one process, and on all again.
    Body<2>       alone(settings, ModelKind::finite_elements, MPI_COMM_SELF);
    MemoryArchive for_one(saved, MPI_COMM_SELF);
    alone.op().exchange(for_one, node_keys(alone.handler));
    Body<2>       again(settings, ModelKind::finite_elements);
    MemoryArchive for_all(saved, MPI_COMM_WORLD);
    again.op().exchange(for_all, node_keys(again.handler));
    EXPECT_EQ(alone.op().released().by_law, body.op().released().by_law);
    const Vector forces = body.unbalanced(bumpy(body, 3.));
    EXPECT_LT(difference(body, forces, alone, alone.unbalanced(bumpy(alone, 3.))),
              1e-12 * forces.linfty_norm());
    EXPECT_LT(difference(body,
                         again.unbalanced(bumpy(again, 3.)),
                         alone,
                         alone.unbalanced(bumpy(alone, 3.))),
              1e-12 * forces.linfty_norm());
    // Not those of a body to which nothing has happened.
    Body<2> new_body(settings, ModelKind::finite_elements);
    Vector  others = new_body.unbalanced(bumpy(new_body, 3.));
    others -= forces;
    EXPECT_GT(others.linfty_norm(), 0.1 * forces.linfty_norm());
  }
} // namespace
