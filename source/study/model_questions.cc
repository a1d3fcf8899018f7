// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/analysis/coupling_certificate.h>
#include <perideal/base/user_error.h>
#include <perideal/bonds/kernel_weights.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/solid_problem.h>
#include <perideal/scene/expression.h>
#include <perideal/solvers/linear_solver.h>
#include <perideal/solvers/static_solver.h>
#include <perideal/solvers/step_tools.h>
#include <perideal/study/model_questions.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "checked_row.h"
#include "stability_growth.h"

namespace PeriDeal
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    /** JSON has no infinity: a text in its place. */
    Json number(const double value)
    {
      return std::isfinite(value) ? Json(value) :
             std::isnan(value)    ? Json("nan") :
                                    Json(value > 0. ? "inf" : "-inf");
    }


    /** Call action(problem, scene) with the first model of the scene. Not within itself. */
    template <typename Action>
    void with_model(const SceneText &text, const Action &action)
    {
      with_scene(text, [&](const auto &scene) {
        constexpr int            dim = std::decay_t<decltype(scene.domain.lower)>::dimension;
        std::vector<std::string> notes;
        const auto               mesh = build_mesh(scene, text.communicator, notes);
        Model<dim>               body(scene.general.models.front(), *mesh);
        body.problem = problem_factory(scene).make_problem(body, scene);
        action(*body.problem, scene);
      });
    }


    // What may happen to bonds in a motion, besides that they never break.
    const std::string may_break = "may break", some_broken = "some broken";


    /** The predicted limit of a step. */
    double predicted_step(const ExplicitMethod &method, const double eigenvalue)
    {
      const double limit = stability_limit(method.name, method.n_stages);
      return method.name == "verlet" ? limit / std::sqrt(eigenvalue) : limit / eigenvalue;
    }


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


    /** Call action(op, disturbance) of a body in motion that has just been built. */
    template <typename Action>
    void with_mover(const SceneText &text, const std::string &bonds, const Action &action)
    {
      with_model(text, [&](auto &problem, const auto &scene) {
        with_formulas(text.communicator, [&] {
          auto        &op      = dynamic_cast<ElasticOperator &>(problem.op());
          const auto   h       = scene.domain.spacing();
          const double spacing = *std::min_element(h.begin_raw(), h.end_raw());
          Vector       field   = fast_field(problem);
          if (bonds == some_broken)
            break_some(op, field, spacing);
          field *= 1e-7 * spacing;
          action(op, field);
        });
      });
    }


    /** What the program predicts the longest stable step of each method from, and what steps do. */
    struct Stepping
    {
      // Largest eigenvalues: of the whole body, whose limit the program refuses to exceed, and of
      // the body without the bonds that its load breaks during a run.
      double                                                                 whole = 0., left = 0.;
      std::function<Growth(const ExplicitMethod &method, const double step)> run;
      bool allows_chebyshev = false;
    };


    /** The longest stable step of a method. */
    Json limit_of(const Stepping &stepping, const ExplicitMethod &method)
    {
      if (method.name == "chebyshev" && !stepping.allows_chebyshev)
        return {};
      const double predicted = predicted_step(method, stepping.left);
      const auto   grows     = [&](const double step) { return stepping.run(method, step); };
      double       observed  = 1e2 / stepping.whole;
      if (std::isfinite(predicted))
        observed = observed_limit(predicted, grows);
      else if (!grows(1e2 / stepping.whole).grows && !grows(3e3 / stepping.whole).grows)
        observed = std::numeric_limits<double>::infinity();
      return {{"predicted", number(predicted)},
              {"refused", number(predicted_step(method, stepping.whole))},
              {"observed", number(observed)}};
    }


    /** What steps of a share of the longest stable one do. */
    Json growth_of(const Stepping &stepping, const ExplicitMethod &method, const double share)
    {
      const double eigenvalue = share > 1. ? stepping.left : stepping.whole;
      const double step       = share * predicted_step(method, eigenvalue);
      const double z = method.name == "verlet" ? step * std::sqrt(eigenvalue) : step * eigenvalue;
      const Growth growth = stepping.run(method, step);
      return {{"step", step},
              {"predicted", number(std::max(1., amplification(method.name, z, method.n_stages)))},
              {"observed", number(growth.per_step)},
              {"grows", growth.grows}};
    }


    /** To each of the "runs" its answer, null where the method is not for the model. */
    Json answers_of_steps(const Json &question, const Stepping &stepping)
    {
      Json answers = Json::array();
      for (const Json &run : question.at("runs"))
        {
          const ExplicitMethod method{run.at("method"), run.value("stages", 0u)};
          answers.push_back(run.contains("share") ?
                              growth_of(stepping, method, run["share"].get<double>()) :
                              limit_of(stepping, method));
        }
      return {{"answers", answers}};
    }


    Json steps_of_diffusion(const SceneText &text, const Json &question)
    {
      Json answer;
      with_model(text, [&](auto &problem, const auto &) {
        with_formulas(text.communicator, [&] {
          auto        &op    = dynamic_cast<DiffusionOperator &>(problem.op());
          const Vector field = fast_field(problem), start = problem.state();
          Stepping     stepping;
          stepping.whole = stepping.left = op.spectrum().sharp;
          stepping.allows_chebyshev      = choose_stepper(op) == "chebyshev";
          stepping.run                   = [&](const ExplicitMethod &method, const double step) {
            return growth_of_diffusion(op, start, field, method, step);
          };
          answer = answers_of_steps(question, stepping);
        });
      });
      return answer;
    }


    /** A body breaks in a run: each run has its own. */
    Json steps_of_motion(const SceneText &text, const Json &question, const std::string &bonds)
    {
      Stepping stepping;
      with_mover(text, bonds, [&](ElasticOperator &op, const Vector &) {
        stepping.whole = stepping.left = op.spectrum().sharp;
        if (bonds != may_break)
          return;
        load_body(op, predicted_step({"verlet", 0}, stepping.whole));
        stepping.left = op.spectrum().sharp;
      });
      stepping.run = [&](const ExplicitMethod &, const double step) {
        Growth growth;
        with_mover(text, bonds, [&](ElasticOperator &op, const Vector &disturbance) {
          growth = growth_of_motion(op, disturbance, step);
        });
        return growth;
      };
      return answers_of_steps(question, stepping);
    }


    Json steps(const SceneText &text, const Json &question)
    {
      const std::string bonds = question.value("bonds", ""); // of motions; empty elsewhere
      return bonds.empty() ? steps_of_diffusion(text, question) :
                             steps_of_motion(text, question, bonds);
    }


    /** What a coupling of diffusion is worth. */
    Json certificate(const SceneText &text, const Json &)
    {
      CouplingCertificate found;
      with_model(text, [&](auto &problem, const auto &scene) {
        constexpr int dim = std::decay_t<decltype(scene.domain.lower)>::dimension;
        const auto   &op  = dynamic_cast<const FieldOperator<dim> &>(problem.op());
        found             = examine_coupling(op, op.symmetric());
      });
      return {{"lowest remainder", number(found.lowest_remainder)},
              {"lowest eigenvalue", number(found.lowest_eigenvalue)},
              {"fault", found.fault()}};
    }


    template <int dim>
    double iterations_of(Problem<dim> &problem, const Scene<dim> &scene, const unsigned int direct)
    {
      double n = 0.;
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
          n = solve_steady(dynamic_cast<DiffusionOperator &>(problem.op()),
                           u,
                           0.,
                           scene.solver.tolerance,
                           scene.solver.max_iterations,
                           direct);
      });
      return n;
    }


    /** Of a steady state or an equilibrium; "fault" where they do not suffice. */
    Json iterations(const SceneText &text, const Json &question)
    {
      Json answer;
      try
        {
          with_model(text, [&](auto &problem, const auto &scene) {
            answer["allowed"]    = scene.solver.max_iterations;
            answer["iterations"] = iterations_of(problem, scene, question.at("direct up to"));
          });
        }
      catch (const UserError &error)
        {
          if (answer.is_null()) // not begun
            throw;
          answer["fault"] = mistake_in_overrides(error);
        }
      return answer;
    }


    /** Call action(problem) with the first model, which has to be one of diffusion. */
    template <typename Action>
    void with_diffusion(const SceneText &text, const Action &action)
    {
      with_model(text, [&](auto &problem, const auto &scene) {
        constexpr int dim = std::decay_t<decltype(scene.domain.lower)>::dimension;
        action(dynamic_cast<DiffusionProblem<dim> &>(problem));
      });
    }


    /** The heat in the body at the start, and at "times". */
    Json heat(const SceneText &text, const Json &question)
    {
      Json contents = Json::array();
      with_diffusion(text, [&](auto &body) {
        body.begin_stepping();
        const auto add = [&] {
          contents.push_back(number(body.op().balance(body.solution, 0., false).content));
        };
        add();
        for (const Json &time : question.at("times"))
          {
            body.advance_through_events(time, {});
            add();
          }
      });
      return {{"contents", contents}};
    }


    /** The heat that flows through a "side" of a steady state. */
    Json flow(const SceneText &text, const Json &question)
    {
      double through = 0.;
      with_diffusion(text, [&](auto &body) {
        body.solve();
        through = body.op()
                    .balance(body.solution, 0., true)
                    .sides.at(question.at("side").get<std::string>());
      });
      return {{"flow", number(through)}};
    }


    /** What bonds of a lattice of unit spacing conduct, and in 2D lack at a side, at each "m". */
    Json families(const SceneText &text, const Json &question)
    {
      Json answers = Json::array();
      with_scene(text, [&](const auto &scene) {
        constexpr int          dim = std::decay_t<decltype(scene.domain.lower)>::dimension;
        dealii::Tensor<1, dim> spacing;
        for (unsigned int d = 0; d < dim; ++d)
          spacing[d] = 1.;
        const auto &bonds = scene.peridynamics;
        for (const Json &ratio : question.at("m"))
          {
            const KernelWeights<dim> weights({bonds.kernel,
                                              bonds.kernel_exponent,
                                              bonds.sampling.volume_fraction,
                                              bonds.sampling.calibration,
                                              SelfTerm::none,
                                              ratio.get<double>()},
                                             spacing,
                                             1.);
            Json answer = {{"effective conductivity", number(weights.effective_conductivity())}};
            if constexpr (dim == 2)
              {
                const double first_row  = scene.domain.has_nodes_at_centers() ? 1. : 0.5;
                answer["missing width"] = number(missing_width<2>(weights.members(), 1, first_row));
              }
            answers.push_back(answer);
          }
      });
      return {{"answers", answers}};
    }
  } // namespace


  std::string answer_about_model(const SceneText &text, const std::string &question)
  {
    using Answer = Json (*)(const SceneText &, const Json &);
    const std::vector<std::pair<std::string, Answer>> kinds = {{"steps", steps},
                                                               {"certificate", certificate},
                                                               {"iterations", iterations},
                                                               {"heat", heat},
                                                               {"flow", flow},
                                                               {"families", families}};
    try
      {
        const Json        parsed = Json::parse(question);
        const std::string asked  = parsed.at("ask");
        for (const auto &[name, answer] : kinds)
          if (name == asked)
            return answer(text, parsed).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
        AssertThrow(false, UserError("--ask: there is no question '" + asked + "'."));
      }
    catch (const Json::exception &error)
      {
        AssertThrow(false, UserError(std::string("--ask: this is no question: ") + error.what()));
      }
    catch (const std::bad_cast &)
      {
        AssertThrow(false, UserError("--ask: the question is not for this model."));
      }
    return {};
  }
} // namespace PeriDeal
