// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bodies in motion: from the initial displacement and velocity through the times of output.

#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/simulation/elastic_simulation.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "elastic_notes.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void ElasticSimulation<dim>::make_steppers()
  {
    for (const auto &model : models)
      model->begin_motion(context());
  }


  template <int dim>
  double ElasticSimulation<dim>::share_of_models(const unsigned int n, const double span) const
  {
    double some = 0., all = 0.;
    for (unsigned int k = 0; k < models.size(); ++k)
      {
        const OperatorSize size = models[k]->op().size();
        // A step costs about as much as the product with what is stored.
        const double cost = std::max(1., span / models[k]->stepper->current_step()) *
                            static_cast<double>(size.unknowns + size.nonzeros + size.bonds);
        all += cost;
        if (k < n)
          some += cost;
      }
    return some / all;
  }


  template <int dim>
  void ElasticSimulation<dim>::move()
  {
    constexpr unsigned int n_reports = 50; // of the progress between two times of output
    progress.begin("time");
    if (scene.output.starts_at_zero())
      output->write_fields(0.);
    double now = 0.;
    for (const double t : times_of_output())
      {
        if (t > now)
          for (unsigned int k = 0; k < models.size(); ++k)
            {
              ElasticRun<dim> &model = *models[k];
              const double     done  = share_of_models(k, t - now),
                           more      = share_of_models(k + 1, t - now);
              const auto share       = [&](const double of_model) {
                return (now + (done + (more - done) * of_model) * (t - now)) / scene.time.end_time;
              };
              progress.doing(model.name() + ": time stepping");
              progress.advancing(now, t, share(0.), share(1.));
              Timings::Scope scope(model.timings, "time stepping");
              // Whole steps between two reports, so that these change no step.
              const double       span = t - now, step = model.stepper->current_step();
              const double       n_steps = std::max(1., std::ceil(span / step * (1. - 1e-10)));
              const unsigned int n_parts = std::min(n_steps, static_cast<double>(n_reports));
              double             from    = now;
              for (unsigned int part = 1; part <= n_parts; ++part)
                {
                  const double to = part == n_parts ?
                                      t :
                                      now + span * std::floor(n_steps * part / n_parts) / n_steps;
                  model.stepper->advance(model.displacement, model.velocity, from, to);
                  from = to;
                  if (model.op().brittle())
                    {
                      tell_broken_bonds(model.op().n_broken_bonds());
                      tell_first_break(model, to, context());
                    }
                  progress.update(share(static_cast<double>(part) / n_parts));
                }
            }
        now = t;
        for (const auto &model : models)
          model->stepper->examine(model->displacement, model->velocity, t);
        write_output(t);
      }
    progress.end();
    for (const auto &model : models)
      note_end(*model, context());
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                  \
  template void   ElasticSimulation<dim>::make_steppers();                                         \
  template double ElasticSimulation<dim>::share_of_models(const unsigned int, const double) const; \
  template void   ElasticSimulation<dim>::move();
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
