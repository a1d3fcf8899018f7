// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

/*
 * A deal.II program that deforms a body with PeriDeal, in peridynamics and in finite elements on
 * the same dofs: pulls it, lets it vibrate, and cuts it by a crack that grows. Each result is
 * compared with one that is known exactly, or the models with each other; exit status 1 if one is
 * wrong.
 */

#include <deal.II/base/conditional_ostream.h>
#include <deal.II/base/mpi.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_generator.h>

#include <perideal/base/user_error.h>
#include <perideal/operators/solid/elastic_elements.h>
#include <perideal/operators/solid/state_operator.h>
#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/static_solver.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <string>

namespace
{
  using namespace dealii;
  using Vector = LinearAlgebra::distributed::Vector<double>; // the same as PeriDeal::Vector

  constexpr double young = 3., poisson = 0.3, pull = 0.6; // plane stress


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


  /** The square (0,1)^2 with 32 x 32 cells. */
  class Square
  {
  public:
    explicit Square(const MPI_Comm communicator)
      : mesh(communicator)
      , element(1)
      , dofs(mesh)
    {
      GridGenerator::subdivided_hyper_cube(mesh, 4, 0., 1., true); // boundary ids 0 to 3
      mesh.refine_global(3);
      dofs.distribute_dofs(element);
    }

    parallel::distributed::Triangulation<2> mesh;
    FE_Q<2>                                 element;
    DoFHandler<2>                           dofs; // of the nodes: one number each
  };


  enum Side // deal.II's numbers
  {
    left,
    right,
    bottom,
    top
  };


  /** The square's material, with families of three spacings. */
  void describe_square(PeriDeal::SolidParameters<2> &body)
  {
    body.set_box({0., 0.}, {1., 1.}, {{32, 32}});
    body.material.set_moduli(PeriDeal::Modulus::young, young, PeriDeal::Modulus::poisson, poisson);
    body.elasticity.plane           = PeriDeal::PlaneState::stress;
    body.peridynamics.horizon_ratio = 3.;
  }


  /** The largest |u - G x| over the nodes. */
  double distance_from_linear(const PeriDeal::SolidOperator<2> &op,
                              const Vector                     &u,
                              const Tensor<2, 2>               &gradient)
  {
    double largest = 0.;
    for (unsigned int i = 0; i < u.locally_owned_size() / 2; ++i)
      for (unsigned int d = 0; d < 2; ++d)
        largest =
          std::max(largest, std::abs(u.local_element(2 * i + d) - (gradient * op.position(i))[d]));
    return Utilities::MPI::max(largest, u.get_mpi_communicator());
  }


  Vector equilibrium(PeriDeal::SolidOperator<2> &op)
  {
    PeriDeal::StaticOptions options;
    options.tolerance = 1e-12;
    Vector u;
    op.initialize_vector(u);
    const double size   = PeriDeal::start_statics(op, u, 0., options);
    const auto   solver = PeriDeal::make_static_solver("linear", op, options);
    solver->solve(u, 0., size);
    op.distribute(u, 0.);
    return u;
  }


  /** Pulled at its right side, the square is longer by pull/E and narrower by nu times that. */
  void check_tension(const std::string          &model,
                     PeriDeal::SolidOperator<2> &op,
                     const double                limit,
                     Checks                     &checks)
  {
    const Vector u = equilibrium(op);
    Tensor<2, 2> gradient;
    gradient[0][0] = pull / young;
    gradient[1][1] = -poisson * pull / young;
    checks.out << "Tension, " << model << ": " << op.size().unknowns << " unknowns, "
               << op.size().bonds << " bonds" << std::endl;
    checks.smaller("u = (s/E) (x, -nu y), largest error over the largest displacement",
                   distance_from_linear(op, u, gradient) / gradient[0][0],
                   limit);
    checks.smaller("energy over s^2/(2 E), difference from 1",
                   std::abs(op.energy(u) / (0.5 * pull * pull / young) - 1.),
                   limit);
    const PeriDeal::ForceBalance forces = op.forces(u, 0.);
    checks.smaller("force on the left side over that on the right, difference from -1",
                   std::abs(forces.sides.at("left")[0] / forces.sides.at("right")[0] + 1.),
                   1e-8);
  }


  void tension(Square &square, Checks &checks)
  {
    PeriDeal::SolidParameters<2> body;
    describe_square(body);
    body.boundary_conditions.symmetry = {left, bottom}; // a quarter of a larger body
    body.boundary_conditions.pull(right, {pull, 0.});

    PeriDeal::Nodes<2>         nodes(square.dofs, body);
    PeriDeal::StateOperator<2> bonds(nodes, body);
    // The default strengthens bonds at the surface; with three spacings a per cent is left.
    check_tension("peridynamics", bonds, 0.02, checks);
    PeriDeal::ElasticElements<2> elements(square.dofs, body);
    check_tension("finite elements", elements, 1e-9, checks);
  }


  /** A free body that vibrates conserves its energy to round-off. */
  void motion(Square &square, Checks &checks)
  {
    PeriDeal::SolidParameters<2> body;
    describe_square(body);
    body.elasticity.solver = PeriDeal::ElasticSolver::dynamics; // its density is 1

    PeriDeal::Nodes<2>         nodes(square.dofs, body);
    PeriDeal::StateOperator<2> bonds(nodes, body);
    Vector                     u, v;
    bonds.initialize_vector(u);
    bonds.initialize_vector(v);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      v.local_element(2 * i) = std::cos(numbers::PI * nodes.position(i)[0]);
    const auto stepper = PeriDeal::make_motion_stepper("verlet", bonds, {});
    stepper->advance(u, v, 0., 1., {});
    const PeriDeal::MotionEnergy energy = stepper->energy(u, v);
    checks.out << "Motion: stepper " << stepper->name() << ", step " << stepper->current_step()
               << ", strain energy " << energy.strain << " of " << energy.start << std::endl;
    checks.smaller("what steps lose of the energy", std::abs(energy.drift) / energy.start, 1e-12);
    checks.smaller("strain and kinetic energy over that of the start, difference from 1",
                   std::abs((energy.strain + energy.kinetic) / energy.start - 1.),
                   1e-2);
  }


  /** A crack that grows releases energy; in both models about the same. */
  void growth(Square &square, Checks &checks)
  {
    PeriDeal::SolidParameters<2> body;
    describe_square(body);
    body.boundary_conditions.displace(bottom, {0., -0.01});
    body.boundary_conditions.displace(top, {0., 0.01});
    body.cracks.cracks = {{{-0.1, 0.515625}, {0.25, 0.515625}}};
    body.cracks.let_grow(0,
                         1,
                         Tensor<1, 2>({0.25, 0.}),
                         0.,
                         1.); // its second end, to the right until t = 1

    PeriDeal::Nodes<2>           nodes(square.dofs, body);
    PeriDeal::StateOperator<2>   bonds(nodes, body);
    PeriDeal::ElasticElements<2> elements(square.dofs, body);
    const auto                   lost = [&](PeriDeal::SolidOperator<2> &op) {
      const Vector before = equilibrium(op);
      const double energy = op.energy(before);
      op.grow_cracks(before, 1.);
      return (energy - op.energy(equilibrium(op))) / energy;
    };
    const double by_bonds = lost(bonds), by_elements = lost(elements);
    checks.out << "Growth: the crack takes " << 100. * by_bonds
               << " % of the energy (peridynamics), " << 100. * by_elements
               << " % (finite elements)" << std::endl;
    checks.smaller("no energy is released", -by_bonds, -0.05);
    checks.smaller("one model over the other, difference from 1",
                   std::abs(by_bonds / by_elements - 1.),
                   0.1);
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
      // Dofs in the order of the lattice make bonds fast; they are right in any order.
      PeriDeal::SolidParameters<2> body;
      describe_square(body);
      PeriDeal::number_along_lattice(square.dofs, body.domain);

      tension(square, checks);
      motion(square, checks);
      growth(square, checks);
    }
  catch (
    const PeriDeal::UserError &error) // something of the body is wrong: a sentence for the user
    {
      checks.out << error.message() << std::endl;
      return 1;
    }
  return checks.all_good ? 0 : 1;
}
