// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What ends a motion or an equilibrium: bodies inside out, steps that have become too long, nodes
// without mass.

#include <perideal/base/diverged.h>
#include <perideal/base/place_text.h>
#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/slow_loading.h>

#include <memory>

#include "elastic_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using namespace SceneTests;
  using dealii::Point;
  using dealii::Tensor;

  namespace
  {
    const Settings moving{{"Elasticity/Solver", "dynamics"}};
    const Settings full = moving + Settings{{"Elasticity/Kinematics", "full"}};
    const Settings centers{{"Domain/Nodes", "cell centers"}};


    bool is_near(const Point<2> &p, const double x, const double y)
    {
      return std::abs(p[0] - x) + std::abs(p[1] - y) < 1e-9;
    }


    template <int dim>
    void check_inversions(const Settings &more, const ModelKind model = ModelKind::peridynamics)
    {
      const Body<dim>          body(box<dim>() + more, model);
      const unsigned long long all   = body.op().lumped_capacity().size() / dim;
      const auto               found = [&](const auto &field) {
        return body.op().inverted(body.values(field)).n_nodes;
      };
      EXPECT_EQ(found([](const Point<dim> &) { return Tensor<1, dim>(); }), 0u);
      // Half a turn, and squeezed to a thousandth.
      const auto turned = [](const Point<dim> &p) {
        Tensor<1, dim> u;
        for (unsigned int d = 0; d < dim; ++d)
          u[d] = d < 2 && dim > 1 ? -2. * p[d] : -0.999 * p[d];
        return u;
      };
      EXPECT_EQ(found(turned), 0u);
      // Turned inside out by a mirror; nothing left of a direction.
      for (const double share : {2., 1.})
        EXPECT_EQ(found([&](const Point<dim> &p) {
                    Tensor<1, dim> u;
                    u[0] = -share * p[0];
                    return u;
                  }),
                  all);
    }


    double largest_eigenvalue(const Body<2> &body, const Vector &u)
    {
      body.op().linearize(u);
      return body.op().spectrum().sharp;
    }


    /** Three times as long at the end and a half, in a time of many sound waves. */
    const Settings stretched =
      full + Settings{{"Domain/Cells", "16, 4"},
                      {"Domain/Upper corner", "1, 0.25"},
                      {"Boundary conditions/Displacement", "left: 0, 0; right: 2.5*(t/20)^2, 0"}};
  } // namespace


  TEST(Inversion, mirrored_and_turned)
  {
    check_inversions<1>({});
    check_inversions<2>({});
    check_inversions<3>({});
    check_inversions<2>(full);
    check_inversions<3>(full);
    check_inversions<1>(centers);
    check_inversions<2>(full + centers);
    check_inversions<3>(centers);
    check_inversions<2>({}, ModelKind::finite_elements);
    check_inversions<3>({}, ModelKind::finite_elements);
  }


  TEST(Inversion, single_node)
  {
    // A node that has passed its right neighbour: its own corners and some of those around it.
    const Body<2> body(box<2>() + full + Settings{{"Domain/Cells", "8, 6"}},
                       ModelKind::peridynamics);
    for (const double share : {0.9, 1.1})
      {
        const Vector    u     = body.values([&](const Point<2> &p) {
          return Tensor<1, 2>({is_near(p, 0.5, 0.375) ? 0.125 * share : 0., 0.});
        });
        const Inversion found = body.op().inverted(u);
        EXPECT_EQ(found.n_nodes, share < 1. ? 0u : 2u);
        if (share > 1.)
          {
            EXPECT_TRUE(found.place == "(0.5, 0.375)" || found.place == "(0.625, 0.375)");
          }
        // The bond to the left neighbour.
        EXPECT_NEAR(body.op().largest_stretch(u), share < 1. ? 0.9 : 1.1, 1e-12);
      }
  }


  TEST(Inversion, what_has_broken_off_may_fold)
  {
    // The node is torn out of the body far away, and lies on the other side of its neighbours.
    const Body<2> body(box<2>() + full +
                         Settings{{"Domain/Cells", "8, 6"}, {"Material/Critical stretch", "0.5"}},
                       ModelKind::peridynamics);
    const auto    moved = [&](const double by) {
      return body.values([&](const Point<2> &p) {
        return Tensor<1, 2>({is_near(p, 1., 0.375) ? by : 0., 0.});
      });
    };
    EXPECT_GT(body.op().inverted(moved(-0.3)).n_nodes, 0u);
    EXPECT_GT(body.op().break_bonds(moved(10.), 0.), 10u);
    EXPECT_EQ(body.op().inverted(moved(-0.3)).n_nodes, 0u);
  }


  namespace
  {
    /** A plate that is pushed through its own support. */
    struct PushedThrough
    {
      PushedThrough()
        : body(box<2>() + full_at_rest, ModelKind::peridynamics)
      {
        options.tolerance = 1e-6;
        loading           = std::make_unique<SlowLoading>(
          body.op(),
          make_static_solver("conjugate gradients", body.op(), options),
          options);
      }

      const Settings full_at_rest{
        {"Domain/Cells", "8, 6"},
        {"Elasticity/Solver", "conjugate gradients"},
        {"Elasticity/Kinematics", "full"},
        {"Boundary conditions/Displacement", "left: 0, 0; right: -1.5, 0"}};
      const Body<2>                body;
      StaticOptions                options;
      std::unique_ptr<SlowLoading> loading;
    };
  } // namespace


  TEST(Inversion, ends_equilibria)
  {
    const PushedThrough plate;
    Vector              u;
    try
      {
        plate.loading->begin(u, 0.);
        FAIL();
      }
    catch (const Diverged &error)
      {
        expect_parts(error.message(),
                     {"inside out", "t = 0", "'conjugate gradients'", "make the load smaller"});
        ASSERT_EQ(error.trip.place.size(), 2u);
        expect_parts(
          error.message(),
          {"worst at " + place_text(Point<2>(error.trip.place[0], error.trip.place[1]))});
      }
  }


  TEST(Inversion, waits_to_be_told)
  {
    const PushedThrough plate;
    Findings           &found = plate.loading->findings();
    found.let_wait();
    Vector u;
    plate.loading->begin(u, 0.);
    EXPECT_EQ(found.take().monitor, "inversion");
    EXPECT_FALSE(found.take());
    EXPECT_GT(plate.body.op().inverted(u).n_nodes, 0u); // the state that it has found
  }


  TEST(StepLimit, follows_the_deformation)
  {
    const Body<2> body(box<2>() + stretched, ModelKind::peridynamics);
    const double  limit   = stable_motion_step(body.op());
    const auto    stepper = make_motion_stepper("auto", body.op(), {});
    Vector        u = body.vector(), v = u;
    EXPECT_DOUBLE_EQ(stepper->current_step(), 0.8 * limit);
    stepper->advance(u, v, 0., 20.);
    const double omega = std::sqrt(largest_eigenvalue(body, u));
    // The step at the start would be within a few percent of the limit, or above it.
    EXPECT_GT(0.8 * limit * omega, 1.84);
    EXPECT_LT(stepper->current_step() * omega, 1.82);
    EXPECT_GT(stepper->current_step() * omega, 1.4);
    EXPECT_EQ(stepper->shortest_step(), stepper->current_step());
    const MotionEnergy energy = stepper->energy(u, v);
    EXPECT_LT(std::abs(energy.drift), 1e-3 * energy.exchanged);
    // What it takes to follow.
    EXPECT_LT(body.op().n_applications(), 1.5 * stepper->cost().steps);
  }


  TEST(StepLimit, refuses_a_given_step_that_has_become_too_long)
  {
    const Body<2>  body(box<2>() + stretched, ModelKind::peridynamics);
    StepperOptions options;
    options.time_step  = 0.97 * stable_motion_step(body.op());
    const auto stepper = make_motion_stepper("verlet", body.op(), options);
    Vector     u = body.vector(), v = u;
    expect_error([&] { stepper->advance(u, v, 0., 20.); },
                 {"'Time step' in section 'Time'", "but at t =", "stable up to", "auto"});
  }


  TEST(MotionSteppers, nodes_without_mass)
  {
    for (const std::string density : {"max(0, x - 0.5)", "x - 0.5"})
      for (const std::string name : {"verlet", "newmark"})
        {
          const Body<2> body(box<2>() + moving + Settings{{"Material/Density", density}},
                             ModelKind::peridynamics);
          expect_error([&] { make_motion_stepper(name, body.op(), {}); },
                       {"'Density' in section 'Material'",
                        density[0] == 'm' ? "zero at (" : "negative at (",
                        "positive density everywhere"});
        }
  }
} // namespace PeriDeal
