// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "stability_growth.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/mapping_q.h>

#include <perideal/base/diverged.h>
#include <perideal/base/instantiate.h>
#include <perideal/operators/bounds/spectrum.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int n_spans = 8, steps_of_span = 20;
    // Beside the disturbance: it grows; nothing is left of it but round-off.
    constexpr double large = 1e8, nothing = 1e-8;


    std::unique_ptr<Stepper> make_fixed(const ExplicitMethod &method,
                                        DiffusionOperator    &op,
                                        const double          step)
    {
      StepperOptions options;
      options.time_step = step;
      options.tolerance = 1e-12; // of chebyshev, whose error would hide what is small
      // Not make_stepper(), which refuses what is to be seen here.
      return method.name == "euler" ? make_euler(op, options) :
             method.name == "rk4"   ? make_rk4(op, options) :
             method.name == "rkc2" ?
                                    (method.n_stages > 0 ? make_rkc2(op, options, method.n_stages) :
                                                           make_rkc2(op, options)) :
                                    make_chebyshev(op, options);
    }


    /** By the places of nodes, which a problem of finite elements does not keep. Collective. */
    template <int dim>
    void fill_noise(Vector &field, const Problem<dim> &problem)
    {
      const unsigned int                            n = problem.n_components();
      std::map<types::global_dof_index, Point<dim>> places;
      DoFTools::map_dofs_to_support_points(MappingQ<dim>(1), problem.dofs(), places);
      unsigned int node = 0;
      for (const types::global_dof_index index : problem.dofs().locally_owned_dofs())
        {
          for (unsigned int c = 0; c < n; ++c)
            field.local_element(n * node + c) = position_noise(places.at(index)) * (1. + c);
          ++node;
        }
    }


    double distance(const Vector &a, const Vector &b)
    {
      Vector difference(a);
      difference -= b;
      return difference.l2_norm();
    }


    /** A run of `verlet` that ends only where numbers are no longer finite. */
    struct Motion
    {
      Motion(ElasticOperator &op, const Vector &start, const double step)
        : step(step)
        , u(start)
        , v(start)
      {
        StepperOptions options;
        options.time_step = step;
        stepper           = make_verlet(op, options);
        stepper->findings().let_wait(); // energy from nowhere, which is what is to be seen here
        v = 0.;
        op.distribute(u, 0.);
      }

      /** The step with this number, which begins at 1. */
      void advance(const unsigned int k)
      {
        stepper->advance(u, v, (k - 1) * step, k * step);
      }

      const double                   step;
      Vector                         u, v;
      std::unique_ptr<MotionStepper> stepper;
    };
  } // namespace


  template <int dim>
  Vector fast_field(const Problem<dim> &problem)
  {
    constexpr unsigned int n_iterations = 60;
    const Operator        &op           = problem.op();
    Vector                 field, image;
    op.initialize_vector(field);
    op.initialize_vector(image);
    fill_noise(field, problem);
    op.distribute_homogeneous(field);
    for (unsigned int k = 0; k < n_iterations; ++k)
      {
        op.apply(image, field);
        for (unsigned int i = 0; i < image.locally_owned_size(); ++i)
          image.local_element(i) /= op.lumped_capacity().local_element(i);
        image /= image.linfty_norm();
        field.swap(image);
        op.distribute_homogeneous(field);
      }
    return field;
  }


  Growth growth_of_diffusion(DiffusionOperator    &op,
                             const Vector         &start,
                             const Vector         &disturbance,
                             const ExplicitMethod &method,
                             const double          step)
  {
    Vector plain(start), disturbed(start);
    disturbed.add(std::max(1., start.linfty_norm()), disturbance);
    op.distribute(disturbed, 0.);
    const auto of_plain = make_fixed(method, op, step), of_disturbed = make_fixed(method, op, step);
    const double first = distance(plain, disturbed);
    double       half = first, now = first;
    try
      {
        for (unsigned int k = 0; k < n_spans; ++k)
          {
            const double t = k * steps_of_span * step, t_end = (k + 1) * steps_of_span * step;
            of_plain->advance(plain, t, t_end);
            of_disturbed->advance(disturbed, t, t_end);
            now              = distance(plain, disturbed);
            const bool grows = !(now < large * first);
            if (grows || now < nothing * first)
              return {std::pow(now / first, 1. / ((k + 1.) * steps_of_span)), grows};
            if (2 * (k + 1) == n_spans)
              half = now; // what is damped has gone
          }
      }
    catch (const Diverged &) // no longer finite
      {
        return {std::numeric_limits<double>::infinity(), true};
      }
    const double per_step = std::pow(now / half, 2. / (n_spans * steps_of_span));
    return {per_step, per_step > 1.};
  }


  Growth growth_of_motion(ElasticOperator &op, const Vector &disturbance, const double step)
  {
    constexpr double much = 4.; // more than waves that oscillate ever add up to
    Vector           at_rest(disturbance);
    at_rest = 0.;
    Motion plain(op, at_rest, step), disturbed(op, disturbance, step);
    disturbed.stepper->leave_bonds();
    const double first = distance(plain.u, disturbed.u);
    double       size  = 1.;
    Vector       before(disturbance);
    for (unsigned int k = 1; k <= n_spans * steps_of_span; ++k)
      try
        {
          before = disturbed.u;
          before -= plain.u;
          disturbed.advance(k);
          const auto n_broken = op.n_broken_bonds();
          plain.advance(k);
          if (op.n_broken_bonds() != n_broken || op.has_growing_cracks())
            disturbed.stepper->restart();
          if (k % steps_of_span != 0)
            continue;
          before += plain.u;
          size = 0.5 * distance(disturbed.u, before) / first;
          if (!(size < much))
            return {std::pow(size, 1. / k), true};
        }
      catch (const Diverged &) // no longer finite
        {
          return {std::numeric_limits<double>::infinity(), true};
        }
    return {std::min(1., std::pow(size, 1. / (n_spans * steps_of_span))), false};
  }


  void load_body(ElasticOperator &op, const double step)
  {
    Vector at_rest;
    op.initialize_vector(at_rest);
    Motion motion(op, at_rest, step);
    for (unsigned int k = 1; k <= n_spans * steps_of_span; ++k)
      motion.advance(k);
  }


  double observed_limit(const double predicted, const std::function<Growth(const double step)> &run)
  {
    constexpr double resolution = 1e-3, farthest = 1e3;
    double           stable = 0.9 * predicted, unstable = 1.1 * predicted;
    while (run(stable).grows)
      {
        unstable = stable;
        stable *= 0.5;
        if (stable < predicted / farthest)
          return 0.;
      }
    while (!run(unstable).grows)
      {
        stable = unstable;
        unstable *= 2.;
        if (unstable > farthest * predicted)
          return std::numeric_limits<double>::infinity();
      }
    while (unstable > (1. + resolution) * stable)
      {
        const double middle                     = std::sqrt(stable * unstable);
        (run(middle).grows ? unstable : stable) = middle;
      }
    return std::sqrt(stable * unstable);
  }


  PERIDEAL_INSTANTIATE_FUNCTION(fast_field);
} // namespace PeriDeal
