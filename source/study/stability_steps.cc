// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/output/tables.h>
#include <perideal/problems/solid_problem.h>
#include <perideal/scene/expression.h>
#include <perideal/solvers/step_bounds.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "stability_growth.h"
#include "stability_map.h"
#include "stability_scene.h"

namespace PeriDeal
{
  namespace
  {
    using Value = StabilityPoint::Value;

    /** What may happen to bonds in a motion. */
    const std::string never = "never break", may = "may break", broken = "some broken";


    /** What steps depend on, but for their length and the method. */
    struct SteppedBody
    {
      ModelKind    model = ModelKind::peridynamics;
      std::string  kernel;
      unsigned int exponent = 0;
      double       ratio    = 0.;
      std::string  bonds; // of motions; empty elsewhere

      bool has_bonds() const
      {
        return model != ModelKind::finite_elements;
      }

      /** For readers. */
      std::string text() const
      {
        return to_string(model) +
               (has_bonds() ? ", kernel " + kernel + ", m = " + Value(ratio).dump() : "") +
               (bonds.empty() ? "" : ", bonds " + bonds);
      }

      std::vector<Setting> settings() const
      {
        std::vector<Setting> list;
        if (has_bonds())
          list = {{"Peridynamics/Kernel", kernel},
                  {"Peridynamics/Kernel exponent", std::to_string(exponent)},
                  {"Peridynamics/Horizon ratio", full_precision(ratio)}};
        return list;
      }
    };


    std::vector<std::pair<std::string, Value>> parameters_of(const SteppedBody    &body,
                                                             const ExplicitMethod &method)
    {
      const auto if_bonds = [&](const Value &value) { return body.has_bonds() ? value : Value(); };
      return {{"model", to_string(body.model)},
              {"method", method.name},
              {"stages", method.n_stages > 0 ? Value(method.n_stages) : Value()},
              {"kernel", if_bonds(body.kernel)},
              {"kernel exponent", if_bonds(body.exponent)},
              {"m", if_bonds(body.ratio)},
              {"bonds", body.bonds.empty() ? Value() : Value(body.bonds)}};
    }


    /** The predicted limit of a step. */
    double predicted_step(const ExplicitMethod &method, const double eigenvalue)
    {
      const double limit = stability_limit(method.name, method.n_stages);
      return method.name == "verlet" ? limit / std::sqrt(eigenvalue) : limit / eigenvalue;
    }


    /**
     * Largest eigenvalues: of the whole body, whose limit the program refuses to exceed, and of
     * the body without the bonds that its load breaks during a run.
     */
    struct LargestEigenvalues
    {
      double whole = 0., left = 0.;
    };


    /** What the program predicts the longest stable step of each method from, and what steps do. */
    struct Stepping
    {
      LargestEigenvalues                                                     eigenvalues;
      std::function<Growth(const ExplicitMethod &method, const double step)> run;
      bool allows_chebyshev = false;
    };

    using SteppingAction = std::function<void(const Stepping &stepping)>;


    /** Numbers that grow until bonds break, some hundredths of them. Collective. */
    void break_some(ElasticOperator &op, const Vector &field, const double size)
    {
      constexpr double share = 0.02, farthest = 1e6;
      const double     enough = share * op.size().bonds;
      for (double factor = 1e-6 * size; factor < farthest * size; factor *= 1.2)
        {
          Vector u(field);
          u *= factor;
          op.distribute_homogeneous(u);
          op.break_bonds(u, 0.);
          if (op.n_broken_bonds() > enough)
            return;
        }
    }


    /** Base of the maps of steps. */
    class StepMap : public StabilityMap
    {
    public:
      explicit StepMap(const StabilityScene &scene)
        : scene(scene)
      {}

      std::string obstacle() const override
      {
        const StabilityFacts &facts = scene.facts;
        if (facts.deforms && !facts.moves)
          return "the body is in equilibrium ('Solver' in section 'Elasticity'): there are no steps";
        if (facts.steady)
          return "'Steady' in section 'Time' is true: there are no steps";
        if (facts.depends_on_solution)
          return "the material depends on the temperature, and with it the limit of each step";
        if (!facts.lumped)
          return "'Capacity = consistent' in section 'Finite elements' has no explicit steps";
        return {};
      }

    protected:
      /** Bodies of the scene's models with the kernels and m of a map. */
      std::vector<SteppedBody> bodies(const std::vector<std::string> &kernels,
                                      const std::vector<double>      &ratios) const
      {
        std::vector<SteppedBody> list;
        for (const ModelKind model : scene.facts.models)
          {
            SteppedBody body{model, scene.facts.kernel, scene.facts.kernel_exponent, 0., ""};
            for (const std::string &bonds : fates(model))
              {
                body.bonds = bonds;
                if (!body.has_bonds())
                  {
                    list.push_back(body);
                    continue;
                  }
                for (const std::string &kernel : kernels)
                  for (const double ratio : ratios)
                    {
                      body.kernel = kernel;
                      body.ratio  = ratio;
                      list.push_back(body);
                    }
              }
          }
        return list;
      }

      /** @param with_chebyshev which has no limit, and is not for every operator */
      std::vector<ExplicitMethod> methods(const bool quick, const bool with_chebyshev) const
      {
        if (scene.facts.moves)
          return {{"verlet", 0}};
        std::vector<ExplicitMethod> list;
        for (const std::string &name : explicit_stepper_names())
          if (name == "rkc2")
            for (const unsigned int n :
                 quick ? std::vector<unsigned int>{5} : std::vector<unsigned int>{2, 3, 5, 10})
              list.push_back({name, n});
          else if (with_chebyshev || name != "chebyshev")
            list.push_back({name, 0});
        return list;
      }

      /** What may happen to the bonds of a model. */
      std::vector<std::string> fates(const ModelKind model) const
      {
        if (!scene.facts.moves)
          return {""};
        if (model == ModelKind::finite_elements)
          return {never};
        return scene.facts.breaks ? std::vector<std::string>{never, may, broken} :
                                    std::vector<std::string>{never, broken};
      }

      std::vector<Setting> settings_of(const SteppedBody &body) const
      {
        std::vector<Setting> list = body.settings();
        if (body.bonds == never)
          {
            list.emplace_back("Material/Fracture energy", "");
            list.emplace_back("Material/Critical stretch", "");
          }
        else if (body.bonds == broken && !scene.facts.breaks)
          list.emplace_back("Material/Critical stretch", "0.01");
        if (body.bonds == broken) // cracks that go on growing are not the steps' fault
          for (const char *const entry : {"Traction", "Displacement", "Velocity"})
            list.emplace_back(std::string("Boundary conditions/") + entry, "");
        return list;
      }

      /** Build a body and call action(stepping). Throws UserError where it cannot be had. */
      void with_steps(const SteppedBody &body, const SteppingAction &action) const
      {
        if (scene.facts.moves)
          return move(body, action);
        scene.with_problem(body.model, settings_of(body), [&](auto &problem, const auto &) {
          diffuse(problem, action);
        });
      }

      const StabilityScene &scene;

    private:
      template <int dim>
      static void diffuse(const Problem<dim> &problem, const SteppingAction &action)
      {
        with_formulas(problem.dofs().get_communicator(), [&] {
          Operator    &op    = problem.op();
          const Vector field = fast_field(problem), start = problem.state();
          const double eigenvalue = op.spectrum().sharp;
          const auto   run        = [&](const ExplicitMethod &method, const double step) {
            return growth_of_diffusion(op, start, field, method, step);
          };
          action({{eigenvalue, eigenvalue}, run, choose_stepper(op) == "chebyshev"});
        });
      }

      /** A body breaks in a run: each run has its own. */
      void move(const SteppedBody &body, const SteppingAction &action) const
      {
        LargestEigenvalues eigenvalues;
        with_mover(body, [&](ElasticOperator &op, const Vector &) {
          eigenvalues.whole = eigenvalues.left = op.spectrum().sharp;
          if (body.bonds != may)
            return;
          load_body(op, predicted_step({"verlet", 0}, eigenvalues.whole));
          eigenvalues.left = op.spectrum().sharp;
        });
        const auto run = [&](const ExplicitMethod &, const double step) {
          Growth growth;
          with_mover(body, [&](ElasticOperator &op, const Vector &disturbance) {
            growth = growth_of_motion(op, disturbance, step);
          });
          return growth;
        };
        action({eigenvalues, run, false});
      }

      /** Call action(op, disturbance) of a body that has just been built. */
      template <typename Action>
      void with_mover(const SteppedBody &body, const Action &action) const
      {
        scene.with_problem(body.model, settings_of(body), [&](auto &problem, const auto &parsed) {
          with_formulas(scene.communicator, [&] {
            auto        &op      = dynamic_cast<ElasticOperator &>(problem.op());
            const auto   h       = parsed.domain.spacing();
            const double spacing = *std::min_element(h.begin_raw(), h.end_raw());
            Vector       field   = fast_field(problem);
            if (body.bonds == broken)
              break_some(op, field, spacing);
            field *= 1e-7 * spacing;
            action(op, field);
          });
        });
      }
    };


    class StepLimitMap : public StepMap
    {
    public:
      using StepMap::StepMap;

      std::string meaning_of_predicted() const override
      {
        return "the longest stable step, from the largest eigenvalue as the program estimates it (with the bonds that are left where the load breaks some); infinite: any";
      }

      std::string meaning_of_observed() const override
      {
        return "the step from which on a disturbance grows in runs of the stepper";
      }

      std::string bound() const override
      {
        return "'safe' where steps up to the limit of the program, which is that of the whole body, do not grow: 2/lambda (euler), 2.785/lambda (rk4), about 0.65 (s^2 - 1)/lambda (rkc2 with s stages), 2/omega (verlet)";
      }

      std::vector<StabilityPoint> points(const bool quick) override
      {
        std::vector<StabilityPoint> list;
        const auto                  all =
          bodies(quick ? std::vector<std::string>{scene.facts.kernel} :
                         std::vector<std::string>{"constant", "conical", "gaussian"},
                 quick ? std::vector<double>{2., 3.} : std::vector<double>{2., 3., 4., 6.});
        for (const SteppedBody &body : all)
          try
            {
              with_steps(body, [&](const Stepping &stepping) {
                for (const ExplicitMethod &method : methods(quick, stepping.allows_chebyshev))
                  list.push_back(point(body, method, stepping));
                if (!stepping.allows_chebyshev && !scene.facts.moves)
                  left_out.push_back(
                    to_string(body.model) +
                    ", chebyshev: it needs loads and values at sides that do not change with time, and a symmetric operator");
              });
            }
          catch (const UserError &error)
            {
              left_out.push_back(body.text() + ": " + mistake_in_overrides(error));
            }
        return list;
      }

      std::optional<StabilityPoint> random_point(const bool, std::mt19937 &) override
      {
        return {}; // those of the map of growth are on both sides of these limits
      }

    private:
      static StabilityPoint point(const SteppedBody    &body,
                                  const ExplicitMethod &method,
                                  const Stepping       &stepping)
      {
        const LargestEigenvalues &eigenvalues = stepping.eigenvalues;
        StabilityPoint            point;
        point.parameters = parameters_of(body, method);
        point.predicted  = predicted_step(method, eigenvalues.left);
        const auto grows = [&](const double step) { return stepping.run(method, step); };
        if (std::isfinite(point.predicted))
          point.observed = observed_limit(point.predicted, grows);
        else
          point.observed = !grows(1e2 / eigenvalues.whole).grows &&
                               !grows(3e3 / eigenvalues.whole).grows ?
                             std::numeric_limits<double>::infinity() :
                             1e2 / eigenvalues.whole;
        const double refused = predicted_step(method, eigenvalues.whole);
        point.verdict        = point.observed >= refused * (1. - 1e-3) ? "safe" : "fails";
        return point;
      }
    };


    class GrowthMap : public StepMap
    {
    public:
      using StepMap::StepMap;

      std::string meaning_of_predicted() const override
      {
        return "the factor by which the fastest field grows in a step by theory; 1 where no field grows";
      }

      std::string meaning_of_observed() const override
      {
        return "the factor by which a disturbance grows or decays in a step, in a run of the stepper";
      }

      std::string bound() const override
      {
        return "'safe' up to the limit of the step, which the program refuses to exceed; 'fails' where the disturbance grows";
      }

      std::vector<StabilityPoint> points(const bool quick) override
      {
        const std::vector<double> shares =
          quick ? std::vector<double>{0.5, 0.97, 1.03, 1.5} :
                  std::vector<double>{0.3, 0.5, 0.7, 0.9, 0.97, 1.03, 1.1, 1.3, 1.6, 2.};
        std::vector<StabilityPoint> list;
        for (const SteppedBody &body :
             bodies({scene.facts.kernel},
                    quick ? std::vector<double>{2., 4.} :
                            std::vector<double>{2., 2.5, 3., 3.5, 4., 5., 6.}))
          try
            {
              with_steps(body, [&](const Stepping &stepping) {
                for (const ExplicitMethod &method : methods(true, false))
                  for (const double share : shares)
                    list.push_back(point(body, method, share, stepping));
              });
            }
          catch (const UserError &error)
            {
              left_out.push_back(body.text() + ": " + mistake_in_overrides(error));
            }
        return list;
      }

      std::optional<StabilityPoint> random_point(const bool inside, std::mt19937 &random) override
      {
        SteppedBody body;
        body.model    = any_of_list(random, scene.facts.models);
        body.kernel   = any_of_list<std::string>(random, {"constant", "conical", "gaussian"});
        body.exponent = scene.facts.kernel_exponent;
        body.ratio    = uniform(random, 2., scene.facts.dim == 3 ? 3. : 5.);
        body.bonds    = any_of_list(random, fates(body.model));
        const ExplicitMethod method = any_of_list(random, methods(false, false));
        // The limit of the program is up to 3 % on the safe side.
        const double   share = inside ? uniform(random, 0.1, 1.) : uniform(random, 1.03, 2.);
        StabilityPoint result;
        with_steps(body, [&](const Stepping &stepping) {
          result = point(body, method, share, stepping);
        });
        return result;
      }

    private:
      static StabilityPoint point(const SteppedBody    &body,
                                  const ExplicitMethod &method,
                                  const double          share,
                                  const Stepping       &stepping)
      {
        StabilityPoint point;
        point.parameters        = parameters_of(body, method);
        const double eigenvalue = share > 1. ? stepping.eigenvalues.left :
                                               stepping.eigenvalues.whole;
        const double step       = share * predicted_step(method, eigenvalue);
        point.parameters.emplace_back("step", step);
        point.parameters.emplace_back("step over limit", share);
        const double z = method.name == "verlet" ? step * std::sqrt(eigenvalue) : step * eigenvalue;
        point.predicted     = std::max(1., amplification(method.name, z, method.n_stages));
        const Growth growth = stepping.run(method, step);
        point.observed      = growth.per_step;
        point.verdict       = growth.grows ? "fails" : "safe";
        return point;
      }
    };
  } // namespace


  std::unique_ptr<StabilityMap> make_step_limit_map(const StabilityScene &scene)
  {
    return std::make_unique<StepLimitMap>(scene);
  }


  std::unique_ptr<StabilityMap> make_growth_map(const StabilityScene &scene)
  {
    return std::make_unique<GrowthMap>(scene);
  }
} // namespace PeriDeal
