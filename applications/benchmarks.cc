// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Speed and memory of the operators and steppers on one core, next to what the machine can do,
// measured in the same run. Timings are never tests: the exit status is 0 whatever comes out.
// Options are those of Google Benchmark; --quick leaves out the run with four million nodes,
// --coupling leaves out all but coupled operators, --elasticity all but elastic ones, --peers all
// but those that other programs, if they are installed, run beside.

#include <deal.II/base/mpi.h>

#include <perideal/solvers/stepper.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>

#include "benchmark_findings.h"
#include "benchmark_problem.h"
#include "machine_limits.h"

namespace PeriDeal
{
  namespace
  {
    /** Keeps the best time of each benchmark. */
    class BestTimes : public benchmark::ConsoleReporter
    {
    public:
      void ReportRuns(const std::vector<Run> &runs) override
      {
        for (const Run &run : runs)
          if (run.run_type == Run::RT_Iteration)
            {
              const double time = run.real_accumulated_time / static_cast<double>(run.iterations);
              const auto [entry, is_new] = times.try_emplace(run.run_name.function_name, time);
              entry->second              = std::min(entry->second, time);
            }
        ConsoleReporter::ReportRuns(runs);
      }

      std::map<std::string, double> times;
    };

    constexpr int n_repetitions = 8;


    struct FormResult
    {
      double n_nodes = 0., n_bonds = 0., time = 0., to_triad = 0.;
      double rate() const
      {
        return n_bonds / time;
      }
    };


    /**
     * Memory traffic of the stored form relative to the triad's: each application is followed by a
     * pass of the triad, so that other work on the machine hits both alike. The median of some
     * pairs.
     */
    template <int dim>
    double compare_with_triad(const Problem<dim> &problem, Vector &y, const Vector &x)
    {
      // 12 bytes a bond; x, y (read and written) and the starts of rows.
      const double        bytes = 12. * problem.n_bonds() + 32. * problem.nodes->n_owned();
      Triad               triad;
      std::vector<double> ratios(15);
      for (double &ratio : ratios)
        {
          const double before = triad.rate();
          const auto   start  = std::chrono::steady_clock::now();
          problem.bonds->apply(y, x);
          const double rate = bytes / seconds_since(start);
          ratio             = rate / (0.5 * (before + triad.rate()));
        }
      std::nth_element(ratios.begin(), ratios.begin() + ratios.size() / 2, ratios.end());
      return ratios[ratios.size() / 2];
    }


    /** The operator as solvers call it. */
    template <int dim>
    FormResult measure_form(BestTimes         &times,
                            const std::string &name,
                            const unsigned int n_cells,
                            const double       m,
                            const std::string &form)
    {
      const Problem<dim> problem(n_cells, m, form);
      Vector             x = problem.initial_value(), y(x);
      for (unsigned int i = 0; i < x.locally_owned_size(); ++i)
        x.local_element(i) *= 1. + 1e-3 * (i % 101);
      problem.bonds->distribute_homogeneous(x);
      const std::string label = name + " " + form;
      benchmark::RegisterBenchmark(label.c_str(),
                                   [&](benchmark::State &state) {
                                     for (auto _ : state)
                                       problem.bonds->apply(y, x);
                                     state.counters["bonds/s"] = benchmark::Counter(
                                       problem.n_bonds() * static_cast<double>(state.iterations()),
                                       benchmark::Counter::kIsRate);
                                   })
        ->Repetitions(n_repetitions)
        ->MinTime(0.05)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond)
        ->ReportAggregatesOnly(false);
      benchmark::RunSpecifiedBenchmarks(&times);
      benchmark::ClearRegisteredBenchmarks();
      return {static_cast<double>(problem.nodes->n_owned()),
              problem.n_bonds(),
              times.times[label],
              form == "stored" ? compare_with_triad(problem, y, x) : 0.};
    }


    /** A line with a ratio and, if it is positive, its least admitted value. */
    void found_ratio(const std::string &what,
                     const char        *format,
                     const double       factor,
                     const double       ratio,
                     const double       least)
    {
      const std::string measured = text(format, factor * ratio);
      if (least > 0.)
        found(what, measured, ">= " + text(format, factor * least), ratio >= least);
      else
        found(what, measured);
    }


    void compare_forms(const MachineLimits &machine,
                       const std::string   &name,
                       const FormResult    &lattice,
                       const FormResult    &stored,
                       const double         least_ratio,
                       const double         least_of_peak,
                       const double         least_of_triad)
    {
      found(name + ": lattice form",
            text("%.1f G bonds/s, %.2f ms", 1e-9 * lattice.rate(), 1e3 * lattice.time));
      found(name + ": stored form",
            text("%.2f G bonds/s, %.2f ms", 1e-9 * stored.rate(), 1e3 * stored.time));
      found_ratio(name + ": lattice / FMA peak",
                  "%.0f %%",
                  100.,
                  lattice.rate() / machine.fma,
                  least_of_peak);
      found_ratio(name + ": lattice / unaligned loads",
                  "%.0f %%",
                  100.,
                  lattice.rate() / machine.unaligned,
                  0.);
      found_ratio(name + ": lattice / stored",
                  "%.1f",
                  1.,
                  lattice.rate() / stored.rate(),
                  least_ratio);
      found_ratio(name + ": stored / triad-limited rate",
                  "%.0f %%",
                  100.,
                  stored.to_triad,
                  least_of_triad);
    }


    /**
     * Four million nodes, explicit in time: what PeriDeal holds, by its own count and by the
     * process' growth.
     */
    void measure_memory()
    {
      Problem<2>     problem(2000, 6.5, "lattice");
      const double   n = static_cast<double>(problem.nodes->n_global());
      Vector         u = problem.initial_value();
      StepperOptions options;
      const auto     stepper = make_stepper("auto", *problem.bonds, options);
      const double   span    = 50. / problem.bonds->spectrum().sharp;
      const auto     start   = std::chrono::steady_clock::now();
      const auto     applied = problem.bonds->n_applications();
      stepper->advance(u, 0., span);
      const double seconds        = seconds_since(start);
      const double applications   = static_cast<double>(problem.bonds->n_applications() - applied);
      const double resident       = resident_memory();
      const double operator_bytes = static_cast<double>(problem.bonds->size().memory),
                   vector_bytes   = static_cast<double>(u.memory_consumption()),
                   stepper_bytes  = static_cast<double>(stepper->memory_consumption()),
                   counted        = operator_bytes + vector_bytes + stepper_bytes,
                   growth         = resident - problem.memory_handler;
      const std::string name      = "2D 2001 x 2001, m = 6.5";
      found(name + ": deal.II mesh",
            text("%.0f bytes/node", (problem.memory_mesh - problem.memory_before) / n));
      found(name + ": deal.II DoFHandler",
            text("%.0f bytes/node", (problem.memory_handler - problem.memory_mesh) / n));
      found(name + ": nodes, families, operator", text("%.1f bytes/node", operator_bytes / n));
      found(name + ": solution", text("%.1f bytes/node", vector_bytes / n));
      found(name + ": stepper (" + stepper->name() + ")",
            text("%.1f bytes/node", stepper_bytes / n));
      found(name + ": all three, counted",
            text("%.1f bytes/node", counted / n),
            "<= 150",
            counted <= 150. * n);
      found(name + ": growth of the process",
            text("%.1f bytes/node", growth / n),
            "<= 150",
            growth <= 150. * n);
      found(name + ": one application in a run",
            text("%.1f ms, %.1f G bonds/s",
                 1e3 * seconds / applications,
                 1e-9 * problem.n_bonds() * applications / seconds));
    }


    struct RunResult
    {
      double             seconds = 1e300, error = 0.;
      unsigned long long applications = 0, steps = 0;
    };


    /** Best of some runs of one stepper. */
    RunResult time_run(const Problem<2>     &problem,
                       const std::string    &name,
                       const StepperOptions &options,
                       const double          end,
                       const Vector         *reference,
                       Vector               &u,
                       const unsigned int    n_runs)
    {
      RunResult result;
      for (unsigned int k = 0; k < n_runs; ++k)
        {
          u                  = problem.initial_value();
          const auto stepper = make_stepper(name, *problem.bonds, options);
          const auto before  = problem.bonds->n_applications();
          const auto start   = std::chrono::steady_clock::now();
          stepper->advance(u, 0., end);
          result.seconds      = std::min(result.seconds, seconds_since(start));
          result.applications = problem.bonds->n_applications() - before;
          result.steps        = stepper->cost().steps;
        }
      if (reference != nullptr)
        {
          Vector difference(u);
          difference -= *reference;
          result.error = difference.l2_norm() / reference->l2_norm();
        }
      return result;
    }


    std::string describe(const RunResult &result)
    {
      return text("%.1f ms, %llu applications, error %.1e",
                  1e3 * result.seconds,
                  result.applications,
                  result.error);
    }


    /** Example 1 of Bobaru and Duangpanya 2012: how long until the solution is right to 1e-3. */
    void compare_steppers()
    {
      constexpr double end = 0.025, allowed = 1e-3;
      const Problem<2> problem(240, 6.5, "auto");
      const auto       start    = std::chrono::steady_clock::now();
      const Spectrum   spectrum = problem.bonds->spectrum();
      const double     bound    = seconds_since(start);
      Vector           reference, u;
      StepperOptions   options;
      options.tolerance = 1e-12;
      time_run(problem, "chebyshev", options, end, nullptr, reference, 1);

      const std::string name = "Example 1, 241 x 241";
      found(name + ": largest eigenvalue, once", text("%.1f ms", 1e3 * bound));
      RunResult         best[2];
      const std::string names[2] = {"chebyshev", "rkc2"};
      for (unsigned int k = 0; k < 2; ++k)
        for (options.tolerance = 1e-1; options.tolerance > 1e-7; options.tolerance /= 3.)
          {
            best[k] = time_run(problem, names[k], options, end, &reference, u, 1);
            if (best[k].error > allowed)
              continue;
            best[k] = time_run(problem, names[k], options, end, &reference, u, 7);
            found(name + ": " + names[k] + text(" (Tolerance %.1g)", options.tolerance),
                  describe(best[k]));
            break;
          }
      StepperOptions limit;
      limit.time_step     = 0.999 * stable_step("rk4", spectrum.sharp);
      const RunResult rk4 = time_run(problem, "rk4", limit, end, &reference, u, 3);
      found(name + text(": rk4 at its limit, step %.2e", limit.time_step), describe(rk4));
      StepperOptions published;
      published.time_step   = 1e-6;
      const RunResult part  = time_run(problem, "rk4", published, 500e-6, nullptr, u, 3);
      const double    whole = part.seconds * end / 500e-6;
      found(name + ": rk4 at 1e-6, extrapolated from 500 steps", text("%.1f s", whole));
      for (unsigned int k = 0; k < 2; ++k)
        {
          const double ratio = rk4.seconds / best[k].seconds;
          if (k == 0)
            found(name + ": " + names[k] + " faster than rk4 at its limit",
                  text("%.1f x", ratio),
                  ">= 8 x (either)",
                  std::max(ratio, rk4.seconds / best[1].seconds) >= 8.);
          else
            found(name + ": " + names[k] + " faster than rk4 at its limit", text("%.1f x", ratio));
          found(name + ": " + names[k] + " faster than rk4 at 1e-6",
                text("%.0f x", whole / best[k].seconds));
        }
    }


    void print_findings(const MachineLimits &machine)
    {
      std::printf(
        "\nOne core, %s: %.1f G FMA/s, %.1f G doubles/s loaded aligned, %.1f unaligned, triad %.1f GB/s.\n"
        "A bond is counted at each of its nodes: one FMA. Times are the best of several.\n\n",
        machine.target.c_str(),
        1e-9 * machine.fma,
        1e-9 * machine.loads,
        1e-9 * machine.unaligned,
        1e-9 * machine.triad);
      std::printf("%-62s %-46s %-16s %s\n", "what", "measured", "target", "met");
      for (const Finding &line : findings)
        std::printf("%-62s %-46s %-16s %s\n",
                    line.what.c_str(),
                    line.measured.c_str(),
                    line.target.c_str(),
                    line.met < 0 ? "" :
                    line.met > 0 ? "yes" :
                                   "NO");
    }


    void run(int argc, char **argv)
    {
      const auto take = [&](const char *option) {
        for (int k = 1; k < argc; ++k)
          if (std::strcmp(argv[k], option) == 0)
            {
              std::rotate(argv + k, argv + k + 1, argv + argc);
              --argc;
              return true;
            }
        return false;
      };
      const bool quick = take("--quick"), coupling_alone = take("--coupling"),
                 elasticity_alone = take("--elasticity"), peers_alone = take("--peers");
      benchmark::Initialize(&argc, argv);
#if defined(__GLIBC__)
      mallopt(M_MMAP_THRESHOLD,
              1 << 20); // what is freed goes back at once, so that growth means something
#endif
      MachineLimits machine;
      if (coupling_alone || elasticity_alone || peers_alone)
        {
          measure_machine(machine);
          if (coupling_alone)
            measure_coupling();
          if (elasticity_alone)
            {
              measure_elasticity();
              measure_breaking();
            }
          if (peers_alone)
            measure_peers();
          print_findings(machine);
          return;
        }
      if (!quick)
        measure_memory(); // first, before anything has been freed
      // The machine may be busy with other things for a while: all is measured more than once.
      BestTimes  times;
      FormResult results[6];
      for (unsigned int round = 0; round < 2; ++round)
        {
          measure_machine(machine);
          results[0] = measure_form<2>(times, "2D", 999, 6.5, "lattice");
          results[1] = measure_form<2>(times, "2D", 999, 6.5, "stored");
          measure_machine(machine);
          results[2] = measure_form<3>(times, "3D", 99, 3., "lattice");
          results[3] = measure_form<3>(times, "3D", 99, 3., "stored");
          measure_machine(machine);
          results[4] = measure_form<1>(times, "1D", 999999, 6.5, "lattice");
          results[5] = measure_form<1>(times, "1D", 999999, 6.5, "stored");
        }
      compare_forms(machine, "2D 1000 x 1000, m = 6.5", results[0], results[1], 6., 0.3, 0.7);
      compare_forms(machine, "3D 100 x 100 x 100, m = 3", results[2], results[3], 5., 0., 0.7);
      compare_forms(machine, "1D 1000000, m = 6.5", results[4], results[5], 0., 0., 0.);
      compare_steppers();
      measure_coupling();
      measure_elasticity();
      measure_breaking();
      print_findings(machine);
    }
  } // namespace
} // namespace PeriDeal


int main(int argc, char **argv)
{
  int n_words = 1; // the others are not for the libraries: PETSc would complain of them
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(n_words, argv, 1);
  try
    {
      PeriDeal::run(argc, argv);
    }
  catch (const std::exception &error)
    {
      std::printf("%s\n", error.what());
    }
  return 0;
}
