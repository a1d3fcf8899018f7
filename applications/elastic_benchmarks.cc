// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The state-based operator, and one static solution of the size of published ones.

#include <perideal/solvers/static_solver.h>

#include "benchmark_findings.h"
#include "elastic_body.h"

namespace PeriDeal
{
  namespace
  {
    /** A unit square or cube that is held at the bottom and pulled at the top. */
    template <int dim>
    std::string pulled_text(const unsigned int n_cells,
                            const std::string &m,
                            const std::string &model,
                            const std::string &form)
    {
      const auto list = [](const std::string &entry) {
        return entry + (dim > 1 ? ", " + entry : "") + (dim > 2 ? ", " + entry : "");
      };
      const std::string none = dim == 2 ? "0, 0" : "0, 0, 0", up = dim == 2 ? "0, 1" : "0, 1, 0";
      return "set Dimension = " + std::to_string(dim) +
             "\nset Physics = elasticity\nset Models = peridynamics\nsubsection Domain\nset Lower corner = " +
             list("0") + "\nset Upper corner = " + list("1") +
             "\nset Cells = " + list(std::to_string(n_cells)) +
             "\nset Nodes = cell centers\nend\nsubsection Material\nset Young modulus = 200\nset Poisson ratio = 0.3\nend\n"
             "subsection Boundary conditions\nset Displacement = bottom: " +
             none + "\nset Traction = top: " + up +
             "\nend\nsubsection Peridynamics\nset Horizon ratio = " + m +
             "\nset Operator form = " + form +
             "\nend\nsubsection Elasticity\nset Model = " + model + "\nend\n";
    }


    template <int dim>
    void measure_application(const std::string &name,
                             const unsigned int n_cells,
                             const std::string &m,
                             const std::string &model)
    {
      constexpr unsigned int n_runs = 15;
      double                 rates[2], bytes[2]; // of the stored form, of the lattice form
      for (const bool lattice : {false, true})
        {
          const ElasticBody<dim> body(
            pulled_text<dim>(n_cells, m, model, lattice ? "lattice" : "stored"));
          Vector x, y;
          body.op->initialize_vector(x);
          body.op->initialize_vector(y);
          for (unsigned int i = 0; i < x.locally_owned_size(); ++i)
            x.local_element(i) = 1e-3 * (i % 17);
          double best = 1e300;
          for (unsigned int k = 0; k < n_runs; ++k)
            {
              const auto start = std::chrono::steady_clock::now();
              body.op->multiply(y, x);
              best = std::min(best, seconds_since(start));
            }
          const OperatorSize size = body.op->size();
          rates[lattice]          = 2. * static_cast<double>(size.bonds) / best;
          bytes[lattice]          = static_cast<double>(size.memory) * dim / size.unknowns;
          const double least      = lattice ? 4e8 : 1e8;
          found(name + ", " + model + ": " + size.form + " form",
                text("%.0f M bonds/s", 1e-6 * rates[lattice]),
                text(">= %.0f M", 1e-6 * least),
                rates[lattice] >= least);
          found(name + ", " + model + ": " + size.form + " form, memory",
                text("%.0f bytes per node", bytes[lattice]));
        }
      found(name + ", " + model + ": lattice / stored",
            text("%.1f x, memory %.3f x", rates[1] / rates[0], bytes[1] / bytes[0]));
    }


    void measure_solution()
    {
      const auto           start = std::chrono::steady_clock::now();
      const ElasticBody<2> body(pulled_text<2>(592, "5", "state-based", "auto"));
      StaticOptions        options;
      options.tolerance = 1e-6;
      Vector             u;
      const double       size = start_statics(*body.op, u, 0., options);
      const unsigned int n    = make_static_solver("linear", *body.op, options)->solve(u, 0., size);
      const double       seconds = seconds_since(start);
      found("350,464 nodes, m = 5, plane stress: mesh to solution",
            text("%.1f s, %u iterations", seconds, n),
            "<= 90 s on 2 cores",
            seconds <= 90.);
      found("350,464 nodes: resident memory",
            text("%.2f GB", 1e-9 * resident_memory()),
            "<= 4 GiB",
            resident_memory() <= 4. * 1073741824.);
    }
  } // namespace


  void measure_elasticity()
  {
    measure_solution(); // first: memory once taken stays with the process
    for (const char *model : {"state-based", "bond-based"})
      {
        measure_application<2>("elastic bonds, 2D 400 x 400, m = 5", 400, "5", model);
        measure_application<3>("elastic bonds, 3D 50^3, m = 3", 50, "3", model);
      }
  }
} // namespace PeriDeal
