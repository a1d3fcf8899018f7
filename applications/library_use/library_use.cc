// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

/*
 * A deal.II program with a mesh and a DoFHandler of its own, which lets PeriDeal build peridynamic
 * bonds on its dofs and uses the resulting operator: applies it, bounds its spectrum, integrates in
 * time and solves a steady state. Each result is compared with one that is known exactly; exit
 * status 1 if one of them is wrong.
 */

#include <deal.II/base/conditional_ostream.h>
#include <deal.II/base/mpi.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_generator.h>

#include <perideal/analysis/decay_rate.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/diffusion/extended_bond_term.h>
#include <perideal/solvers/linear_solver.h>
#include <perideal/solvers/stepper.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <iostream>

namespace
{
  using namespace dealii;
  using Vector = LinearAlgebra::distributed::Vector<double>; // the same as PeriDeal::Vector

  constexpr double       conductivity = 2.5, storage = 4.;
  constexpr unsigned int n_cells = 32; // per direction


  /** Prints comparisons and remembers whether all of them held. */
  class Checks
  {
  public:
    explicit Checks(const MPI_Comm communicator)
      : out(std::cout, Utilities::MPI::this_mpi_process(communicator) == 0)
    {}

    void smaller(const std::string &what, const double found, const double limit)
    {
      const bool good = found <= limit; // false for NaN
      out << "  " << std::left << std::setw(64) << what << std::setw(13) << found
          << (good ? "<= " : "ABOVE ") << limit << std::endl;
      all_good = all_good && good;
    }

    ConditionalOStream out;
    bool               all_good = true;
  };


  /** The dofs of the square (0,1)^2 with equal cells. */
  class Square
  {
  public:
    explicit Square(const MPI_Comm communicator)
      : mesh(communicator)
      , element(1)
      , dofs(mesh)
    {
      GridGenerator::subdivided_hyper_cube(mesh, n_cells / 8, 0., 1., true); // boundary ids 0 to 3
      mesh.refine_global(3);
      dofs.distribute_dofs(element);
    }

    parallel::distributed::Triangulation<2> mesh;
    FE_Q<2>                                 element;
    DoFHandler<2>                           dofs;
  };


  /** What PeriDeal has to know of the square. All else is as in a scene that does not tell. */
  void describe_square(PeriDeal::HeatParameters<2> &body)
  {
    body.set_box({0., 0.}, {1., 1.}, {{n_cells, n_cells}});
    body.material.conductivity      = conductivity;
    body.material.density           = storage; // the heat capacity is 1
    body.peridynamics.horizon_ratio = 4.;
  }


  /**
   * Values of a function at the nodes. Node i of this process is the dof nodes.first_owned() + i.
   */
  void interpolate(const PeriDeal::Nodes<2>                      &nodes,
                   const std::function<double(const Point<2> &)> &f,
                   Vector                                        &u)
  {
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      u.local_element(i) = f(nodes.position(i));
  }


  double largest_difference(const Vector &a, const Vector &b)
  {
    Vector difference(a);
    difference -= b;
    return difference.linfty_norm();
  }


  /** In the interior, K u = -kappa V Laplacian(u) holds exactly for a quadratic polynomial. */
  void apply_operator(Square &square, Checks &checks)
  {
    PeriDeal::HeatParameters<2> body;
    describe_square(body);
    PeriDeal::Nodes<2> nodes(square.dofs, body);
    const auto         field = PeriDeal::field_of_bonds(nodes, body);
    checks.out << "Apply: " << field->size().unknowns << " dofs, " << field->size().bonds
               << " bonds, " << PeriDeal::bonds_of(*field).form_note() << std::endl;

    Vector u, y;
    field->initialize_vector(u);
    field->initialize_vector(y);
    interpolate(
      nodes,
      [](const Point<2> &p) { return p[0] * p[0] + 3. * p[1] - p[0] * p[1]; },
      u);
    field->apply(y, u);

    double       worst = 0.;
    const double reach = PeriDeal::bonds_of(*field).diffusion_bonds().weights().reach();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const Point<2> &p = nodes.position(i);
        if (std::min({p[0], p[1], 1. - p[0], 1. - p[1]}) > reach)
          {
            const double expected = -2. * conductivity * nodes.volume(i);
            worst                 = std::max(worst, std::abs(y.local_element(i) / expected - 1.));
          }
      }
    checks.smaller("K u = -2 kappa V for u = x^2 + 3 y - x y, relative error",
                   Utilities::MPI::max(worst, square.mesh.get_communicator()),
                   1e-9);

    // A program has vectors of its own. Their owned entries are in the same order.
    Vector own(square.dofs.locally_owned_dofs(), square.mesh.get_communicator());
    own = 1.;
    u.copy_locally_owned_data_from(own);
    field->apply(y, u);
    checks.smaller("K u = 0 for u = 1", y.linfty_norm(), 1e-12);
  }


  /**
   * With mirrored fictitious nodes, products of sines are eigenvectors: spectrum and decay are
   * known.
   */
  void decay_of_a_harmonic(Square &square, Checks &checks)
  {
    PeriDeal::HeatParameters<2> body;
    describe_square(body);
    for (unsigned int side = 0; side < 4; ++side)
      body.boundary_conditions.prescribe(side, 0.);
    body.peridynamics.treatment = PeriDeal::BoundaryTreatment::fictitious_mirror;
    PeriDeal::Nodes<2> nodes(square.dofs, body);
    const auto         field = PeriDeal::field_of_bonds(nodes, body);
    const auto         terms =
      PeriDeal::lattice_terms<2>(PeriDeal::bonds_of(*field).diffusion_bonds().weights().members(),
                                 nodes.lattice()->spacing,
                                 conductivity);
    const auto rate = [&](const unsigned int a, const unsigned int b) {
      return PeriDeal::lattice_decay_rate(terms, {{a * numbers::PI, b * numbers::PI, 0.}}, storage);
    };

    double fastest = 0.;
    for (unsigned int a = 1; a < n_cells; ++a)
      for (unsigned int b = 1; b < n_cells; ++b)
        fastest = std::max(fastest, rate(a, b));
    const PeriDeal::Spectrum spectrum = field->spectrum();
    checks.out << "Spectrum: largest eigenvalue " << fastest << ", sharp bound " << spectrum.sharp
               << ", safe bound " << spectrum.safe << std::endl;
    checks.smaller("largest eigenvalue / sharp bound", fastest / spectrum.sharp, 1.);
    checks.smaller("sharp bound / largest eigenvalue", spectrum.sharp / fastest, 1.02);
    checks.smaller("sharp bound / safe bound", spectrum.sharp / spectrum.safe, 1.);

    const auto harmonic = [](const Point<2> &p) {
      return std::sin(numbers::PI * p[0]) * std::sin(2. * numbers::PI * p[1]);
    };
    const double             t_end = 1. / rate(1, 2); // time to decay to 1/e
    PeriDeal::StepperOptions options;
    options.tolerance  = 1e-12;
    const auto stepper = PeriDeal::make_stepper("auto", *field, options);
    Vector     u, expected;
    field->initialize_vector(u);
    field->initialize_vector(expected);
    interpolate(nodes, harmonic, u);
    interpolate(
      nodes,
      [&](const Point<2> &p) { return std::exp(-1.) * harmonic(p); },
      expected);
    field->distribute(u, 0.);
    stepper->advance(u, 0., t_end);
    checks.out << "Decay: stepper " << stepper->name() << ", " << field->n_applications()
               << " operator applications" << std::endl;
    checks.smaller("sin(pi x) sin(2 pi y) decays to 1/e, largest error",
                   largest_difference(u, expected),
                   1e-10);
  }


  /** A linear field between a cold and a hot side is the exact steady state. */
  void steady_state(Square &square, Checks &checks)
  {
    PeriDeal::HeatParameters<2> body;
    describe_square(body);
    body.boundary_conditions.prescribe(0, 0.);
    body.boundary_conditions.prescribe(1, 10.);
    body.peridynamics.treatment = PeriDeal::BoundaryTreatment::fictitious_mirror;
    PeriDeal::Nodes<2> nodes(square.dofs, body);
    const auto         field = PeriDeal::field_of_bonds(nodes, body);
    Vector             u, expected;
    field->initialize_vector(u);
    field->initialize_vector(expected);
    const unsigned int n = PeriDeal::solve_steady(*field, u, 0., 1e-12, 200);
    interpolate(
      nodes,
      [](const Point<2> &p) { return 10. * p[0]; },
      expected);
    checks.out << "Steady: " << n << " iterations" << std::endl;
    checks.smaller("T = 10 x between sides at 0 and 10, largest error",
                   largest_difference(u, expected),
                   1e-9);
  }


  /** A mesh of any shape: bonds are found by a search and stored. */
  void disc(const MPI_Comm communicator, Checks &checks)
  {
    parallel::distributed::Triangulation<2> mesh(communicator);
    GridGenerator::hyper_ball_balanced(mesh);
    mesh.refine_global(4);
    DoFHandler<2> dofs(mesh);
    const FE_Q<2> element(1);
    dofs.distribute_dofs(element);

    const auto of_place = [](const std::function<double(const Point<3> &)> &f) {
      return PeriDeal::Expression([f](const Point<3> &p, const double) { return f(p); }, false);
    };
    PeriDeal::HeatParameters<2> body;
    body.set_own_mesh(0.12); // the horizon
    body.material.conductivity     = of_place([](const Point<3> &p) { return 1. + p[0] * p[0]; });
    body.initial_and_source.source = 5.;
    body.boundary_conditions.prescribe(0, of_place([](const Point<3> &p) { return p[0] * p[1]; }));

    PeriDeal::Nodes<2> nodes(dofs, body);
    const auto         field = PeriDeal::field_of_bonds(nodes, body);
    Vector             u;
    field->initialize_vector(u);
    PeriDeal::solve_steady(*field, u, 0., 1e-12, 200);
    const PeriDeal::Balance balance = field->balance(u, 0., true);
    checks.out << "Disc: " << field->size().bonds << " bonds, "
               << PeriDeal::bonds_of(*field).form_note() << std::endl;
    checks.smaller("what the source gives leaves through the rim, relative error",
                   std::abs(balance.imbalance()) / balance.throughput(),
                   1e-9);
  }
} // namespace


int main(int, char **argv)
{
  int n_words = 1; // the others are not for the libraries: PETSc would complain of them
  Utilities::MPI::MPI_InitFinalize mpi(n_words, argv, 1);
  Checks                           checks(MPI_COMM_WORLD);
  try
    {
      Square square(MPI_COMM_WORLD);
      // Dofs in the order of the lattice make the lattice form fast; it is right in any order.
      PeriDeal::HeatParameters<2> body;
      describe_square(body);
      PeriDeal::number_along_lattice(square.dofs, body.domain);

      apply_operator(square, checks);
      decay_of_a_harmonic(square, checks);
      steady_state(square, checks);
      disc(MPI_COMM_WORLD, checks);
    }
  catch (
    const PeriDeal::UserError &error) // something of the body is wrong: a sentence for the user
    {
      checks.out << error.message() << std::endl;
      return 1;
    }
  return checks.all_good ? 0 : 1;
}
