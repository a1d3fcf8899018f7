// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Explicit steps of bodies whose bonds may break, and the same bonds in LAMMPS, if it is installed.

#include <perideal/solvers/motion_stepper.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "benchmark_findings.h"
#include "elastic_body.h"

namespace PeriDeal
{
  namespace
  {
    /** A square or cube with a short crack from its left side, pulled open at once. */
    template <int dim>
    std::string cracked_text(const unsigned int n_cells,
                             const std::string &m,
                             const std::string &form,
                             const std::string &kinematics,
                             const std::string &law = "set Critical stretch = 0.01\n")
    {
      const auto list = [](const std::string &entry) {
        return entry + ", " + entry + (dim > 2 ? ", " + entry : "");
      };
      const std::string crack = dim == 2 ? "Segments = 0,0.5 ; 0.05,0.5" :
                                           "Polygons = 0,0.5,0 ; 0.05,0.5,0 ; 0.05,0.5,1 ; 0,0.5,1",
                        last  = dim == 2 ? "" : ", 0";
      return "set Dimension = " + std::to_string(dim) +
             "\nset Physics = elasticity\nset Models = peridynamics\nsubsection Domain\nset "
             "Lower corner = " +
             list("0") + "\nset Upper corner = " + list("1") +
             "\nset Cells = " + list(std::to_string(n_cells)) +
             "\nset Nodes = cell centers\nend\nsubsection Material\nset Young modulus = "
             "200\nset Poisson ratio = 0.25\nset Density = 1.0\n" +
             law + "end\nsubsection Boundary conditions\nset Traction = top: 0, 0.7" + last +
             "; bottom: 0, -0.7" + last + "\nend\nsubsection Cracks\nset " + crack +
             "\nend\nsubsection Peridynamics\nset Horizon ratio = " + m +
             "\nset Operator form = " + form +
             "\nset Surface correction = none" // as LAMMPS has it
             "\nend\nsubsection Elasticity\nset Solver = dynamics\nset Kinematics = " +
             kinematics + "\nend\nsubsection Time\nset End time = 1\nend\n";
    }


    struct Rates
    {
      double whole = 0., breaking = 0.; // bonds at each end, by second of a processor
      double bytes = 0., damaged = 0.;  // of a node at the end; share of nodes that lost a bond
    };


    template <int dim>
    Rates measure_motion(const std::string &name,
                         const unsigned int n_cells,
                         const std::string &m,
                         const std::string &form,
                         const double       end,
                         const std::string &kinematics = "linear")
    {
      constexpr unsigned int n_steps = 10; // at a time
      ElasticBody<dim>       body(cracked_text<dim>(n_cells, m, form, kinematics));
      StateOperator<dim>    &op      = *body.op;
      const double           n_bonds = static_cast<double>(op.size().bonds);
      Vector                 u, v;
      op.initialize_vector(u);
      op.initialize_vector(v);
      StepperOptions options;
      options.time_step    = -1.;
      const auto   stepper = make_motion_stepper("verlet", op, options);
      const double dt      = stepper->current_step();
      Rates        rates;
      double       t = 0., best = 1e300, seconds = 0.;
      unsigned int n_spans = 0;
      while (t < end)
        {
          const unsigned long long before = op.n_broken_bonds();
          const double             start  = processor_seconds();
          stepper->advance(u, v, t, t + n_steps * dt);
          const double taken = processor_seconds() - start;
          t += n_steps * dt;
          if (op.n_broken_bonds() == 0)
            best = std::min(best, taken);
          else if (op.n_broken_bonds() > before)
            {
              seconds += taken;
              ++n_spans;
            }
        }
      const std::vector<double> damage = op.breaking().damage();
      rates.whole                      = 2. * n_bonds * n_steps / best;
      rates.breaking = n_spans > 0 ? 2. * n_bonds * n_steps * n_spans / seconds : 0.;
      rates.bytes    = static_cast<double>(op.size().memory) * dim / op.size().unknowns;
      rates.damaged =
        static_cast<double>(std::count_if(op.break_history() ? damage.begin() : damage.end(),
                                          damage.end(),
                                          [](const double d) { return d > 0.; })) /
        static_cast<double>(damage.size());
      found(name + ", " + form + ": explicit steps, no bond breaks yet",
            text("%.0f M bonds/s", 1e-6 * rates.whole));
      found(name + ", " + form + ": while a crack runs",
            text("%.0f M bonds/s, %llu broken", 1e-6 * rates.breaking, op.n_broken_bonds()));
      found(name + ", " + form + ": memory of the operator",
            text("%.0f bytes per node, %.1f %% of the nodes damaged",
                 rates.bytes,
                 100. * rates.damaged));
      return rates;
    }


    template <int dim>
    void compare_forms(const std::string &name,
                       const unsigned int n_cells,
                       const std::string &m,
                       const double       end,
                       const double       target)
    {
      const Rates stored  = measure_motion<dim>(name, n_cells, m, "stored", end),
                  lattice = measure_motion<dim>(name, n_cells, m, "lattice", end);
      found(
        name + ": lattice, no bond breaks yet",
        text("%.0f M bonds/s, %.1f x stored", 1e-6 * lattice.whole, lattice.whole / stored.whole),
        text(">= %.0f M", 1e-6 * target),
        lattice.whole >= target);
      found(name + ": lattice, while a crack runs",
            text("%.0f M bonds/s, %.1f x stored",
                 1e-6 * lattice.breaking,
                 lattice.breaking / stored.breaking));
    }


    /**
     * Explicit steps of a cracked cube with a law: bonds at each end, by second of a processor, in
     * the second half of a short run.
     */
    double measure_law(const std::string &name, const std::string &law, const std::string &model)
    {
      constexpr unsigned int n_cells = 31, n_steps = 60;
      ElasticBody<3>         body(
        cracked_text<3>(n_cells, "3", "auto", "linear\nset Model = " + model, law));
      StateOperator<3> &op = *body.op;
      Vector            u, v;
      op.initialize_vector(u);
      op.initialize_vector(v);
      StepperOptions options;
      options.time_step    = -1.;
      const auto   stepper = make_motion_stepper("verlet", op, options);
      const double dt      = stepper->current_step();
      stepper->advance(u, v, 0., n_steps * dt);
      const double start = processor_seconds();
      stepper->advance(u, v, n_steps * dt, 2 * n_steps * dt);
      const double seconds = (processor_seconds() - start) / n_steps,
                   bonds   = 2e-6 * static_cast<double>(op.size().bonds) / seconds;
      if (const Correspondence<3> *const nodal = op.bonds().correspondence())
        for (const auto &[of, strains] : nodal->stresses.shown())
          found("laws, 3D 31^3, m = 3: " + name + ": nodes that have yielded",
                text("%.1f %%",
                     100. *
                       static_cast<double>(std::count_if(strains.begin(),
                                                         strains.end(),
                                                         [](const double x) { return x > 0.; })) /
                       static_cast<double>(strains.size())));
      found("laws, 3D 31^3, m = 3: " + name,
            text("%.1f M bonds/s at both ends, %.2f M node updates/s, %.0f bytes per node",
                 bonds,
                 1e-6 * static_cast<double>(op.size().unknowns) / 3. / seconds,
                 static_cast<double>(op.size().memory) * 3. / op.size().unknowns));
      return bonds;
    }


    /** A law of LAMMPS: the pair style, and what follows its moduli, horizon and stretch. */
    struct LawOfLammps
    {
      std::string style, numbers;
    };


    /** Bonds at each end, by second of a processor, of LAMMPS; 0: it is not installed. */
    double rate_of_lammps(const LawOfLammps &law,
                          const unsigned int n_cells,
                          const double       m,
                          const unsigned int n_steps)
    {
      namespace fs = std::filesystem;
      if (std::system("command -v lmp > /dev/null 2>&1") != 0)
        return 0.;
      const fs::path folder =
        fs::temp_directory_path() / ("perideal_peers_" + std::to_string(getpid()));
      fs::create_directories(folder);
      const double h = 1. / n_cells;
      std::ofstream(folder / "in.peri")
        << "units si\ndimension 3\nboundary s s s\natom_style peri\natom_modify map array\n"
        << "neighbor " << 0.1 * h << " bin\nneigh_modify delay 1000\nlattice sc " << h
        << "\nregion box block 0 " << n_cells - 0.5 << " 0 " << n_cells - 0.5 << " 0 "
        << n_cells - 0.5 << " units lattice\ncreate_box 1 box\ncreate_atoms 1 box\npair_style peri/"
        << law.style << "\npair_coeff 1 1 133.0 80.0 " << (m + 1e-4) * h << " 0.01 0.25"
        << law.numbers << "\nset group all density 1.0\n"
        << "set group all volume " << h * h * h
        << "\nvelocity all set 0.0 0.0 0.0\nfix 1 all nve\ntimestep " << 1e-2 * h
        << "\nthermo 1000\nrun " << n_steps << "\n";
      const std::string command =
        "cd " + folder.string() + " && OMP_NUM_THREADS=1 lmp -in in.peri -log log > out 2>&1";
      double rate = 0.;
      if (std::system(command.c_str()) == 0)
        {
          std::ifstream log(folder / "log");
          double        n_bonds = 0., seconds = 0., share = 100.; // of a processor, in percent
          for (std::string line; std::getline(log, line);)
            {
              std::sscanf(line.c_str(), " total # of bonds = %lf", &n_bonds); // at each end
              std::sscanf(line.c_str(), "Loop time of %lf", &seconds);
              if (line.find("% CPU use") != std::string::npos)
                std::sscanf(line.c_str(), "%lf%%", &share);
            }
          if (seconds > 0.)
            rate = n_bonds * n_steps / (0.01 * share * seconds);
        }
      fs::remove_all(folder);
      return rate;
    }
  } // namespace


  void measure_breaking()
  {
    compare_forms<3>("breaking, 3D 41^3, m = 3", 41, "3", 0.15, 4e8);
    compare_forms<2>("breaking, 2D 300 x 300, m = 4", 300, "4", 0.06, 1.5e9);
  }


  namespace
  {
    /** The same body with other laws, and those of LAMMPS. */
    void measure_laws()
    {
      measure_law("linear", "", "state-based");
      measure_law("viscoelastic",
                  "set Law = viscoelastic\nset Relaxation = 0.5, 1\n",
                  "state-based");
      measure_law("plastic, a part of it yields",
                  "set Law = plastic\nset Yield stress = 0.5\n",
                  "state-based");
      measure_law("softening, before it does",
                  "set Law = softening\nset Tensile strength = 1e3\nset Fracture energy = 1e9\n",
                  "state-based");
      measure_law("linear, correspondence", "", "correspondence");
      measure_law("viscoelastic, correspondence",
                  "set Law = viscoelastic\nset Relaxation = 0.5, 1\n",
                  "correspondence");
      for (const auto &[name, yield_stress] : {std::make_pair("no node has yielded", "100"),
                                               std::make_pair("a part of it yields", "0.5"),
                                               std::make_pair("all nodes have yielded", "0.001")})
        measure_law(std::string("plastic, correspondence, ") + name,
                    std::string("set Law = plastic\nset Yield stress = ") + yield_stress + "\n",
                    "correspondence");
      for (const LawOfLammps &law :
           {LawOfLammps{"lps", ""}, LawOfLammps{"ves", " 0.5 1"}, LawOfLammps{"eps", " 0.5"}})
        if (const double rate = rate_of_lammps(law, 31, 3., 40); rate > 0.)
          found("laws, 3D 31^3, m = 3: LAMMPS' peri/" + law.style,
                text("%.1f M bonds/s at both ends", 1e-6 * rate));
    }
  } // namespace


  void measure_peers()
  {
    const Rates  linear = measure_motion<3>("peers, 3D 41^3, m = 3", 41, "3", "auto", 0.05);
    const double ours   = linear.whole,
                 full   = measure_motion<3>("peers, 3D 41^3, m = 3, full kinematics",
                                          41,
                                          "3",
                                          "auto",
                                          0.05,
                                          "full")
                          .whole,
                 theirs = rate_of_lammps({"lps", ""}, 41, 3., 20);
    found("peers, 3D 41^3, m = 3: memory, few nodes damaged",
          text("%.0f bytes per node", linear.bytes),
          "<= 250 bytes",
          linear.bytes <= 250.);
    if (theirs == 0.)
      found("peers: LAMMPS", "not installed (lmp), or without peri/lps");
    else
      {
        found("peers, 3D 41^3, m = 3: over LAMMPS' peri/lps",
              text("%.1f x, its rate %.1f M bonds/s", ours / theirs, 1e-6 * theirs),
              ">= 12 x",
              ours >= 12. * theirs);
        found("peers, 3D 41^3, m = 3, full kinematics: over LAMMPS' peri/lps",
              text("%.1f x", full / theirs),
              ">= 1.5 x",
              full >= 1.5 * theirs);
      }
    measure_laws();
  }
} // namespace PeriDeal
