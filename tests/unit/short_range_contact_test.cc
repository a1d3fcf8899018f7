// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bodies and fragments that repel each other, with full kinematics.

#include <perideal/solvers/motion_stepper.h>

#include <algorithm>
#include <cmath>

#include "dimensions.h"
#include "elastic_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;
  using dealii::Tensor;

  namespace
  {
    constexpr double h = 0.0625, gap = 4. * h; // farther than a family reaches

    const Settings moving{{"Elasticity/Solver", "dynamics"},
                          {"Elasticity/Kinematics", "full"},
                          {"Boundary conditions/Displacement", ""},
                          {"Material/Density", "1"}};


    /** Two boxes side by side, free, with a gap from 0.5 - gap to 0.5 between them. */
    template <int dim>
    Settings two_boxes()
    {
      return box<dim>() + moving +
             Settings{{"Domain/Holes", "rectangle: 0.25, -1, 0.5, 2"},
                      {"Domain/Lower corner", zeros[dim]},
                      {"Domain/Upper corner", dim == 2 ? "0.75, 0.25" : "0.75, 0.25, 0.1875"},
                      {"Domain/Cells", dim == 2 ? "12, 4" : "12, 4, 3"}};
    }


    /** The right box moves by so much to the left; both are deformed a little. */
    template <int dim>
    Vector moved(const Body<dim> &body, const double by)
    {
      return body.values([&](const Point<dim> &p) {
        Tensor<1, dim> value = 0.05 * h * bumpy_vector<dim>(p);
        value[0] -= p[0] > 0.4 ? by : 0.;
        return value;
      });
    }


    template <int dim>
    Vector forces_at(const Body<dim> &body, const Vector &u)
    {
      body.op().update_contact(u);
      return body.unbalanced(u);
    }


    template <int dim>
    double sum_on_left(const Body<dim> &body, const Vector &r)
    {
      double sum = 0.;
      for (unsigned int i = 0; i < r.locally_owned_size() / dim; ++i)
        if (body.position(i)[0] < 0.4)
          sum += r.local_element(dim * i);
      return sum_of_all(sum);
    }


    /** The sum of the forces and of their moments, over the sum of their sizes. */
    template <int dim>
    double imbalance(const Body<dim> &body, const Vector &u, const Vector &r)
    {
      std::vector<double> sums(dim + dim * dim + 1);
      for (unsigned int i = 0; i < r.locally_owned_size() / dim; ++i)
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double force = r.local_element(dim * i + d);
            sums[d] += force;
            sums.back() += std::abs(force);
            for (unsigned int e = 0; e < dim; ++e)
              {
                const double arm = body.position(i)[e] + u.local_element(dim * i + e);
                sums[dim + dim * d + e] += arm * force;
                sums[dim + dim * e + d] -= arm * force;
              }
          }
      dealii::Utilities::MPI::sum(sums, MPI_COMM_WORLD, sums);
      double most = 0.;
      for (unsigned int k = 0; k + 1 < sums.size(); ++k)
        most = std::max(most, std::abs(sums[k]));
      return most / sums.back();
    }


  } // namespace


  TEST_IN_DIMENSIONS(ShortRangeContact, forces, 2, 3)
  {
    const Body<dim>  body(two_boxes<dim>(), ModelKind::peridynamics);
    ElasticOperator &op = body.op();
    // Out of reach of each other, near, and out of reach again.
    EXPECT_LT(std::abs(sum_on_left(body, forces_at(body, moved(body, gap - 1.5 * h)))), 1e-14);
    const Vector u = moved(body, gap - 1.1 * h), r = forces_at(body, u);
    EXPECT_LT(sum_on_left(body, r), -1e-3); // pushed to the left
    EXPECT_LT(imbalance(body, u, r), 1e-13);

    // The forces are the energy's derivative, the tangent is theirs.
    Vector y(u);
    op.linearize(u);
    op.apply(y, body.values(bumpy_vector<dim>));
    expect_derivatives(body, u, y, 1e-7, 1e-7, 1e-6);
  }


  /** Pressed faces are no stiffer than the inside of the body. */
  TEST(ShortRangeContact, hardly_changes_the_stable_step)
  {
    for (const char *exponent : {"0", "1"})
      {
        const Body<2> body(two_boxes<2>() + Settings{{"Peridynamics/Kernel exponent", exponent}},
                           ModelKind::peridynamics);
        const double  apart = stable_motion_step(body.op());
        for (const double left : {1.3, 1.1, 0.9})
          {
            const Vector u = body.values([&](const Point<2> &p) {
              return Tensor<1, 2>({p[0] > 0.4 ? left * h - gap : 0., 0.});
            });
            body.op().update_contact(u);
            body.op().linearize(u);
            EXPECT_GT(stable_motion_step(body.op()), 0.95 * apart) << left;
          }
      }
  }


  /** What is found does not depend on what has been found before, nor on who has which node. */
  TEST(ShortRangeContact, depends_on_places_alone)
  {
    const Body<2> body(two_boxes<2>(), ModelKind::peridynamics),
      fresh(two_boxes<2>(), ModelKind::peridynamics),
      alone(two_boxes<2>(), ModelKind::peridynamics, MPI_COMM_SELF);
    for (double by = 0.; by < gap - 1.1 * h; by += 0.1 * h)
      forces_at(body, moved(body, by));
    forces_at(body, moved(body, gap - 1.0 * h));
    const double last = gap - 1.1 * h;
    const Vector r = forces_at(body, moved(body, last)), s = forces_at(fresh, moved(fresh, last)),
                 all = forces_at(alone, moved(alone, last));
    EXPECT_EQ(largest_difference(r, s), 0.);
    EXPECT_LE(difference(body, r, alone, all), 1e-13 * all.linfty_norm());
  }


  /** A whole convex body feels nothing of it, unless it is pressed very much. */
  TEST(ShortRangeContact, is_none_of_a_whole_body)
  {
    // Of pairs without a common neighbour the nearest are sqrt(5), sqrt(13), and 5 spacings apart.
    for (const auto &[ratio, left] : {std::make_pair("1.1", 0.65), {"2", 0.4}, {"3", 0.3}})
      {
        const Settings settings =
          box<2>() + moving + Settings{{"Peridynamics/Horizon ratio", ratio}};
        const Body<2> body(settings, ModelKind::peridynamics),
          without(settings + Settings{{"Elasticity/Contact", "false"}}, ModelKind::peridynamics);
        const auto deformation = [&](const Point<2> &p) {
          return Tensor<1, 2>({(left - 1.) * p[0], (left - 1.) * p[1]});
        };
        const Vector u = body.values(deformation);
        Vector       r = forces_at(body, u);
        EXPECT_GT(r.linfty_norm(), 0.);
        r -= forces_at(without, without.values(deformation));
        EXPECT_EQ(r.linfty_norm(), 0.) << ratio;
      }
  }


  /** The ends of bonds that have broken, pressed together. */
  TEST(ShortRangeContact, follows_bonds_that_break)
  {
    const Settings brittle = box<2>() + moving + Settings{{"Material/Critical stretch", "0.3"}};
    const Body<2>  body(brittle, ModelKind::peridynamics);
    const auto     parted = [&](const double by) {
      return body.values([&](const Point<2> &p) {
        return Tensor<1, 2>({p[0] > 0.53 ? by : 0., 0.});
      });
    };
    ElasticOperator &op = body.op();
    forces_at(body, parted(0.));
    EXPECT_GT(op.break_bonds(parted(10. * h), 0.), 50u);
    EXPECT_LT(forces_at(body, parted(10. * h)).linfty_norm(), 1e-14); // found late, a long way off
    EXPECT_LT(forces_at(body, parted(0.)).linfty_norm(), 1e-14);
    EXPECT_LT(sum_on_left(body, forces_at(body, parted(-0.05 * h))), 1e-12);
    const Vector pressed = parted(-0.5 * h), r = forces_at(body, pressed);
    double       sum = 0.;
    for (unsigned int i = 0; i < r.locally_owned_size() / 2; ++i)
      sum += body.position(i)[0] < 0.53 ? r.local_element(2 * i) : 0.;
    EXPECT_LT(sum_of_all(sum), -1e-3);
    EXPECT_GT(op.energy(pressed), 0.);
  }


  namespace
  {
    /** A long box, whose bonds may break, and a short one on its right. */
    Settings long_box()
    {
      return two_boxes<2>() + Settings{{"Domain/Upper corner", "2.25, 0.25"},
                                       {"Domain/Cells", "36, 4"},
                                       {"Domain/Holes", "rectangle: 1.75, -1, 2, 2"},
                                       {"Material/Critical stretch", "0.05"}};
    }


    /** The short box presses, by an amount, and first columns of the long one are pulled off. */
    Vector pressed_and_pulled(const Body<2> &body, const double pressed, const double pulled)
    {
      return body.values([&](const Point<2> &p) {
        Tensor<1, 2> value = 0.02 * h * bumpy_vector<2>(p);
        value[0] -= p[0] > 1.9 ? gap - (1.2 - pressed) * h : p[0] < h ? pulled * h : 0.;
        return value;
      });
    }
  } // namespace


  /** Also if forces have been asked for at other displacements meanwhile, as steps do. */
  TEST(ShortRangeContact, forces_that_are_mended_are_those_of_a_fresh_body)
  {
    for (const Settings &more :
         {Settings(),
          Settings{{"Elasticity/Model", "bond-based"}},
          Settings{{"Material/Thermal expansion", "1e-3"}, {"Elasticity/Temperature change", "x"}}})
      {
        const Body<2> body(long_box() + more, ModelKind::peridynamics),
          fresh(long_box() + more, ModelKind::peridynamics);
        const Vector     u  = pressed_and_pulled(body, 0.1, 0.1);
        const Vector     v  = pressed_and_pulled(body, 0.25, 0.02);
        ElasticOperator &op = body.op();
        Vector           r  = forces_at(body, v), meanwhile(r), from_scratch(r);
        for (const Vector *at : {&u, &v, &u})
          op.unbalanced(at == &v ? meanwhile : r, *at, 0.);
        const auto n = op.break_bonds(u, 0.);
        EXPECT_GT(n, 5U);
        const Vector before = r;
        op.mend_unbalanced(r, u, 0.);
        fresh.op().update_contact(v);
        EXPECT_EQ(fresh.op().break_bonds(u, 0.), n);
        fresh.op().unbalanced(from_scratch, u, 0.);
        const double size = from_scratch.linfty_norm();
        EXPECT_GT(largest_difference(before, r), 1e-3 * size);
        EXPECT_LE(largest_difference(r, from_scratch), 1e-12 * size);
        // The short box is pushed away.
        double push = 0.;
        for (unsigned int i = 0; i < r.locally_owned_size() / 2; ++i)
          push += body.position(i)[0] > 1.9 ? r.local_element(2 * i) : 0.;
        EXPECT_GT(sum_of_all(push), 1e-3);
      }
  }


  namespace
  {
    /** Asks for the forces anew whenever they are mended. */
    struct WatchedOperator : StateOperator<2>
    {
      using StateOperator<2>::StateOperator;

      void mend_unbalanced(Vector &r, const Vector &u, const double t) const override
      {
        Vector from_scratch(r);
        StateOperator<2>::mend_unbalanced(r, u, t);
        this->unbalanced(from_scratch, u, t);
        ++n_mended;
        apart = std::max(apart, largest_difference(r, from_scratch) / from_scratch.linfty_norm());
      }

      mutable unsigned int n_mended = 0;
      mutable double       apart    = 0.;
    };
  } // namespace


  /** Bonds break in the step in which their support jumps, while bodies touch elsewhere. */
  TEST(ShortRangeContact, steps_mend_forces_after_a_jump_of_supports)
  {
    const Settings jumping{
      {"Boundary conditions/Displacement", "left: if(t > 0.05, -0.007, 0), free"}};
    Body<2>     body(long_box() + jumping, ModelKind::peridynamics);
    auto        watched = std::make_unique<WatchedOperator>(*body.nodes, body.scene);
    const auto &op      = *watched;
    body.states         = std::move(watched);
    Vector u            = pressed_and_pulled(body, 0.1, 0.);
    Vector v            = body.values([&](const Point<2> &p) {
      return Tensor<1, 2>({p[0] > 1.9 ? -0.5 : 0., 0.});
    });
    body.op().distribute(u, 0.);
    StepperOptions options;
    options.time_step  = 0.5 * stable_motion_step(body.op());
    const auto stepper = make_motion_stepper("verlet", body.op(), options);
    stepper->advance(u, v, 0., 0.1);
    EXPECT_GT(op.n_broken_bonds(), 5U);
    EXPECT_GT(op.n_mended, 0U);
    EXPECT_LT(op.apart, 1e-12);
  }


  namespace
  {
    struct Impact
    {
      double drift, left, right; // of the energy over itself; momenta over that of the start
    };


    /** The right box flies to the left, and strikes the other one. */
    Impact impact(const double share_of_step)
    {
      const Body<2>  body(two_boxes<2>(), ModelKind::peridynamics);
      const double   speed = 0.05;
      Vector         u     = body.values([&](const Point<2> &p) {
        return Tensor<1, 2>({p[0] > 0.4 ? 1.5 * h - gap : 0., 0.});
      });
      Vector         v     = body.values([&](const Point<2> &p) {
        return Tensor<1, 2>({p[0] > 0.4 ? -speed : 0., 0.});
      });
      StepperOptions options;
      options.time_step    = share_of_step * stable_motion_step(body.op());
      const auto   stepper = make_motion_stepper("verlet", body.op(), options);
      Impact       result{0., 0., 0.};
      const double start = body.op().lumped_capacity() * v;
      for (unsigned int k = 0; k < 40; ++k)
        {
          stepper->advance(u, v, 0.05 * k, 0.05 * (k + 1));
          const MotionEnergy energy = stepper->energy(u, v);
          result.drift = std::max(result.drift, std::abs(energy.imbalance()) / energy.exchanged);
        }
      Vector momenta = v;
      momenta.scale(body.op().lumped_capacity());
      result.left  = sum_on_left(body, momenta) / start;
      Vector ones  = body.values([](const Point<2> &) { return Tensor<1, 2>({1., 0.}); });
      result.right = momenta * ones / start - result.left;
      return result;
    }
  } // namespace


  TEST(ShortRangeContact, keeps_momentum_and_energy)
  {
    const Impact coarse = impact(0.4), fine = impact(0.2);
    for (const Impact &found : {coarse, fine})
      {
        EXPECT_NEAR(found.left + found.right, 1., 1e-12);
        EXPECT_NEAR(found.left, 1., 0.1); // what vibrates takes some of the energy
      }
    EXPECT_LT(coarse.drift, 5e-3);
    EXPECT_NEAR(std::log2(coarse.drift / fine.drift), 2., 0.5);
  }
} // namespace PeriDeal
