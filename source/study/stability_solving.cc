// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/output/tables.h>
#include <perideal/problems/diffusion_problem.h>
#include <perideal/scene/expression.h>
#include <perideal/solvers/linear_solver.h>
#include <perideal/solvers/static_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "stability_map.h"
#include "stability_scene.h"

namespace PeriDeal
{
  namespace
  {
    using Value = StabilityPoint::Value;

    /** A steady state, or an equilibrium, that is hard to find. */
    struct HardBody
    {
      ModelKind    model    = ModelKind::finite_elements;
      double       contrast = 1., poisson = 0.3, aspect = 1.;
      unsigned int n_cracks = 0;
    };


    /** `0, 0, 0`: one number for each direction, the first another one. */
    std::string corner(const unsigned int dim, const double first, const double others)
    {
      std::string text = full_precision(first);
      for (unsigned int d = 1; d < dim; ++d)
        text += ", " + full_precision(others);
      return text;
    }


    class IterationsMap : public StabilityMap
    {
    public:
      explicit IterationsMap(const StabilityScene &scene)
        : scene(scene)
      {}

      std::string meaning_of_predicted() const override
      {
        return "the most iterations that a run allows ('Maximum iterations' by default): beyond, it ends with an error";
      }

      std::string meaning_of_observed() const override
      {
        return "the iterations to a relative residual of 1e-10, without a direct solution; infinite if they do not suffice";
      }

      std::string bound() const override
      {
        return "'safe' where the iterations converge within those allowed, else the run ends with an error; random points are chosen inside by what the map has found: cells up to 10 times (diffusion: 100 times) as long as wide, Poisson ratios up to 0.498";
      }

      std::string obstacle() const override
      {
        return scene.facts.dim == 1 ? "it is of bodies in two and three dimensions" : "";
      }

      std::vector<StabilityPoint> points(const bool quick) override
      {
        std::vector<StabilityPoint> list;
        for (const ModelKind model : scene.facts.models)
          for (const HardBody &body :
               scene.facts.deforms ? bodies(model, quick) : plates(model, quick))
            list.push_back(point(body));
        return list;
      }

      std::optional<StabilityPoint> random_point(const bool inside, std::mt19937 &random) override
      {
        // Where iterations suffice was found by this map: the program has no bound of its own.
        constexpr double slim = 10., flat = 100.;
        HardBody         body;
        body.model            = any_of_list(random, scene.facts.models);
        const bool   can_fail = scene.facts.deforms || body.model == ModelKind::finite_elements;
        const double largest =
          std::min(largest_aspect(body.model), scene.facts.deforms ? slim : flat);
        body.aspect = std::pow(largest, uniform(random, 0., 1.));
        if (scene.facts.deforms)
          body.poisson = 0.5 - 0.3 * std::pow(10., uniform(random, -2.4, 0.));
        else
          {
            body.contrast = std::pow(10., uniform(random, 0., 8.));
            body.n_cracks = scene.facts.dim == 2 ? random() % 5 : 0;
          }
        if (inside)
          return point(body);
        if (!can_fail || scene.facts.dim == 3) // 10 cells in a direction are few
          return {};
        body.contrast = std::max(body.contrast, 100.);
        if (body.model == ModelKind::finite_elements)
          body.aspect = flat * uniform(random, scene.facts.deforms ? 1. : 20., 40.);
        else
          body.poisson = 0.5 - 1e-5 * uniform(random, 1., 10.);
        return point(body);
      }

    private:
      /** Horizons cannot be shorter than the longest edge of a cell. */
      double largest_aspect(const ModelKind model) const
      {
        return model == ModelKind::finite_elements ? 100. : std::max(1., scene.facts.ratio - 1.);
      }

      std::vector<double> aspects(const ModelKind model, const bool quick) const
      {
        const double largest = largest_aspect(model);
        return quick ? std::vector<double>{1., largest} :
                       std::vector<double>{1., std::sqrt(largest), largest};
      }

      std::vector<HardBody> plates(const ModelKind model, const bool quick) const
      {
        std::vector<HardBody>           list;
        const std::vector<unsigned int> cracks =
          scene.facts.dim == 2 ? std::vector<unsigned int>{0, 4} : std::vector<unsigned int>{0};
        for (const double contrast :
             quick ? std::vector<double>{1., 1e8} : std::vector<double>{1., 1e2, 1e4, 1e6, 1e8})
          for (const unsigned int n_cracks : cracks)
            for (const double aspect : aspects(model, quick))
              list.push_back({model, contrast, 0.3, aspect, n_cracks});
        return list;
      }

      std::vector<HardBody> bodies(const ModelKind model, const bool quick) const
      {
        std::vector<HardBody> list;
        for (const double poisson :
             quick ? std::vector<double>{0.2, 0.4999} :
                     std::vector<double>{0., 0.2, 0.3, 0.4, 0.45, 0.49, 0.499, 0.4999})
          for (const double aspect : aspects(model, quick))
            list.push_back({model, 1., poisson, aspect, 0});
        return list;
      }

      std::vector<Setting> settings_of(const HardBody &body) const
      {
        const unsigned int   dim = scene.facts.dim, n = dim == 3 ? 10 : 32;
        std::vector<Setting> settings{{"Domain/Lower corner", corner(dim, 0., 0.)},
                                      {"Domain/Upper corner", corner(dim, body.aspect, 1.)},
                                      {"Domain/Cells", to_text(CellCounts(dim, n))}};
        if (body.model != ModelKind::finite_elements)
          settings.emplace_back("Peridynamics/Horizon ratio", full_precision(scene.facts.ratio));
        if (body.model == ModelKind::coupled)
          settings.emplace_back("Coupling/Zone", "0.3 - abs(y - 0.5)");
        if (scene.facts.deforms)
          {
            const std::string stretch =
              "right: 1e-3" + std::string(dim == 2 ? ", free" : ", free, free");
            settings.insert(
              settings.end(),
              {{"Material/Young modulus", "1"},
               {"Material/Poisson ratio", full_precision(body.poisson)},
               {"Elasticity/Plane", "strain"},
               {"Boundary conditions/Displacement",
                "left: " + std::string(dim == 2 ? "0, 0; " : "0, 0, 0; ") + stretch}});
            return settings;
          }
        settings.insert(settings.end(),
                        {{"Boundary conditions/Dirichlet", "left: 1; right: 0"},
                         {"Material/Conductivity",
                          "if(sin(9*x/" + full_precision(body.aspect) + ")*sin(9*y) > 0, 1, " +
                            full_precision(body.contrast) + ")"},
                         {"Time/Steady", "true"}});
        std::string cracks;
        for (unsigned int k = 0; k < body.n_cracks; ++k)
          {
            const double x = body.aspect * (0.21 + 0.19 * k), y = 0.23 + 0.17 * ((2 * k) % 4);
            cracks += (k > 0 ? " ; " : "") + full_precision(x) + ", " + full_precision(y) + " ; " +
                      full_precision(x + 0.11 * body.aspect) + ", " + full_precision(y + 0.21);
          }
        if (!cracks.empty())
          settings.emplace_back("Cracks/Segments", cracks);
        return settings;
      }

      StabilityPoint point(const HardBody &body) const
      {
        StabilityPoint point;
        point.parameters = {{"model", to_string(body.model)}, {"aspect ratio", body.aspect}};
        if (scene.facts.deforms)
          point.parameters.emplace_back("Poisson ratio", body.poisson);
        else
          {
            point.parameters.emplace_back("contrast", body.contrast);
            point.parameters.emplace_back("cracks", body.n_cracks);
          }
        try
          {
            scene.with_body(body.model, settings_of(body), [&](auto &problem, const auto &parsed) {
              point.predicted = parsed.solver.max_iterations;
              point.observed  = solve(problem, parsed);
            });
            point.verdict = "safe";
          }
        catch (const UserError &error)
          {
            const bool begun = point.predicted > 0.;
            if (!begun) // the coupling is refused, for instance
              point.predicted = std::numeric_limits<double>::quiet_NaN();
            point.observed = std::numeric_limits<double>::infinity();
            point.verdict  = begun ? "fails" : "refused";
            point.parameters.emplace_back("fault", mistake_in_overrides(error));
          }
        return point;
      }

      template <int dim>
      static double solve(Problem<dim> &problem, const Scene<dim> &scene)
      {
        constexpr unsigned int direct = 50; // of 1000 unknowns: multigrid has levels
        double                 n      = 0.;
        with_formulas(problem.dofs().get_communicator(), [&] {
          Vector u = problem.state();
          if (auto *const op = dynamic_cast<ElasticOperator *>(&problem.op()))
            {
              StaticOptions options;
              options.tolerance      = scene.solver.tolerance;
              options.max_iterations = scene.solver.max_iterations;
              options.direct_up_to   = direct;
              if (u.size() == 0)
                op->initialize_vector(u);
              op->distribute(u, 0.);
              n = make_static_solver("linear", *op, options)->solve(u, 0.);
            }
          else
            n = solve_steady(problem.op(),
                             u,
                             0.,
                             scene.solver.tolerance,
                             scene.solver.max_iterations,
                             direct);
        });
        return n;
      }

      const StabilityScene &scene;
    };


    /** A pulse of heat in an insulated plate, half of which has bonds. */
    class HeatMap : public StabilityMap
    {
    public:
      explicit HeatMap(const StabilityScene &scene)
        : scene(scene)
      {}

      std::string meaning_of_predicted() const override
      {
        return "the heat that may be lost: none but round-off where the matrix is symmetric and its rows sum to zero; infinite where nothing keeps it";
      }

      std::string meaning_of_observed() const override
      {
        return "the change of the heat in the plate since the start, over what there was, either sign";
      }

      std::string bound() const override
      {
        return "'safe' where heat stays to 1e-10; 'splice' does not conserve it, which its certificate says ('warned')";
      }

      std::string obstacle() const override
      {
        return scene.facts.dim == 2 || scene.facts.deforms ?
                 scene.no_diffusion_with(ModelKind::coupled) :
                 "it is of plane bodies";
      }

      std::vector<StabilityPoint> points(const bool quick) override
      {
        std::vector<StabilityPoint> list;
        for (const std::string &scheme : schemes)
          for (const double ratio :
               quick ? std::vector<double>{3.} : std::vector<double>{2., 3., 4.})
            try
              {
                add_points(scheme, ratio, 0.4, quick ? 3 : 10, list);
              }
            catch (const UserError &error)
              {
                left_out.push_back(scheme + ", m = " + Value(ratio).dump() + ": " +
                                   mistake_in_overrides(error));
              }
        return list;
      }

      std::optional<StabilityPoint> random_point(const bool inside, std::mt19937 &random) override
      {
        const std::string scheme = inside ? (random() % 2 == 0 ? "exchange" : "blending") :
                                            "splice";
        std::vector<StabilityPoint> list;
        add_points(scheme,
                   uniform(random, 2., 4.),
                   uniform(random, 0.3, 0.7),
                   1 + random() % 3,
                   list);
        return list.back();
      }

    private:
      /** At @p n equal times until heat from the middle of the pulse has come to the sides. */
      void add_points(const std::string           &scheme,
                      const double                 ratio,
                      const double                 place,
                      const unsigned int           n,
                      std::vector<StabilityPoint> &list) const
      {
        constexpr double           end = 0.05, kept = 1e-10;
        const std::vector<Setting> settings{
          {"Domain/Lower corner", "0, 0"},
          {"Domain/Upper corner", "1, 1"},
          {"Domain/Cells", "24, 24"},
          {"Initial and source/Initial value",
           "exp(-((x - " + full_precision(place) + ")^2 + (y - 0.5)^2)/0.005)"},
          {"Boundary conditions/Flux", "left: 0; right: 0; bottom: 0; top: 0"},
          {"Peridynamics/Horizon ratio", full_precision(ratio)},
          {"Coupling/Scheme", scheme},
          {"Coupling/Zone", "0.5 - x"},
          {"Coupling/Certificate", "false"},
          {"Time/End time", full_precision(end)}};
        scene.with_body(ModelKind::coupled, settings, [&](auto &problem, const auto &parsed) {
          constexpr int dim  = std::decay_t<decltype(parsed.domain.lower)>::dimension;
          auto         &body = dynamic_cast<DiffusionProblem<dim> &>(problem);
          body.begin_stepping();
          const auto   heat   = [&] { return body.op().balance(body.solution, 0., false).content; };
          const double before = heat();
          for (unsigned int k = 1; k <= n; ++k)
            {
              body.advance_through_events(k * end / n, {});
              StabilityPoint point;
              point.parameters = {{"scheme", scheme},
                                  {"m", ratio},
                                  {"place", place},
                                  {"time", k * end / n}};
              point.predicted = scheme == "splice" ? std::numeric_limits<double>::infinity() : kept;
              point.observed  = std::abs(heat() / before - 1.);
              point.verdict   = point.observed <= kept ? "safe" :
                                scheme == "splice"     ? "warned" :
                                                         "fails";
              list.push_back(point);
            }
        });
      }

      const StabilityScene          &scene;
      const std::vector<std::string> schemes = {"exchange", "splice", "blending"};
    };
  } // namespace


  std::unique_ptr<StabilityMap> make_iterations_map(const StabilityScene &scene)
  {
    return std::make_unique<IterationsMap>(scene);
  }


  std::unique_ptr<StabilityMap> make_heat_map(const StabilityScene &scene)
  {
    return std::make_unique<HeatMap>(scene);
  }
} // namespace PeriDeal
