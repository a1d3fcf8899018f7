// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Displacements of sides between cell centers (HeldRows).

#include <perideal/scene/beyond_sides.h>
#include <perideal/scene/held_sides.h>

#include <cmath>
#include <string>
#include <vector>

#include "elastic_scene_tools.h"
#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  using dealii::Point;
  using dealii::Tensor;

  const char *const displacement = "Boundary conditions/Displacement";
  const char *const sides[]      = {"left", "right", "bottom", "top", "back", "front"};
  const Settings    full{{"Elasticity/Kinematics", "full"},
                      {"Elasticity/Solver", "conjugate gradients"}};


  /** Component d of the field, a formula; without shear that of stretches. */
  template <int dim>
  std::string component(const unsigned int d, const bool with_shear)
  {
    std::string text = "0";
    for (unsigned int e = 0; e < dim; ++e)
      if (with_shear || d == e)
        text += "+(" + std::to_string(some_gradient<dim>()[d][e]) + ")*" + "xyz"[e];
    return text;
  }


  /** All sides hold all components of a field, or (rollers) their normal one. */
  template <int dim>
  std::string all_sides(const bool rollers)
  {
    std::string text;
    for (unsigned int side = 0; side < 2 * dim; ++side)
      {
        text += std::string(side > 0 ? " ; " : "") + sides[side] + ": ";
        for (unsigned int d = 0; d < dim; ++d)
          text += std::string(d > 0 ? ", " : "") +
                  (rollers && d != side / 2 ? "free" : component<dim>(d, !rollers));
      }
    return text;
  }


  template <int dim>
  Settings held(const bool rollers, const Settings &more)
  {
    return box<dim>() +
           Settings{{"Domain/Nodes", "cell centers"},
                    {"Peridynamics/Surface correction", "auto"},
                    {displacement, all_sides<dim>(rollers)}} +
           more;
  }


  template <int dim>
  Vector field(const Body<dim> &body, const bool with_shear)
  {
    return body.values([&](const Point<dim> &p) {
      Tensor<1, dim> u;
      for (unsigned int d = 0; d < dim; ++d)
        for (unsigned int e = 0; e < dim; ++e)
          if (with_shear || d == e)
            u[d] += some_gradient<dim>()[d][e] * p[e];
      return u;
    });
  }


  /** A linear field is what the conditions give, an equilibrium, and bears on the sides. */
  template <int dim>
  void check_linear_field(const bool rollers, const Settings &more = {})
  {
    const Body<dim>           body(held<dim>(rollers, more), ModelKind::peridynamics);
    const StateOperator<dim> &op   = *body.states;
    const Vector              u    = field(body, !rollers);
    const double              size = u.linfty_norm();
    Vector                    v(u), r(u);
    op.distribute(v, 0.);
    v -= u;
    EXPECT_LT(v.linfty_norm(), 1e-14 * size);
    op.unbalanced(r, u, 0.);
    const double largest = r.linfty_norm();
    op.clear_constrained(r);
    EXPECT_LT(r.linfty_norm(), 1e-12 * largest) << dim << ' ' << rollers;
    const ForceBalance balance = op.forces(u, 0.);
    const auto         stress  = op.tensors(u).stress;
    Tensor<1, dim>     sum;
    double             all = 0.;
    for (unsigned int side = 0; side < 2 * dim; ++side)
      {
        const std::vector<double> &force = balance.sides.at(sides[side]);
        for (unsigned int d = 0; d < dim; ++d)
          {
            sum[d] += force[d];
            all += std::abs(force[d]);
          }
        double area = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          area *= d == side / 2 ? 1. : body.scene.domain.upper[d];
        if (rollers && !op.nonlinear() && !stress.empty())
          {
            EXPECT_NEAR(force[side / 2],
                        (side % 2 == 0 ? -area : area) * stress[0][side / 2][side / 2],
                        1e-11 * std::abs(force[side / 2]));
          }
      }
    EXPECT_LT(sum.norm(), 1e-12 * all);
  }


  /** K of the free unknowns is the second derivative of the energy. */
  template <int dim>
  void check_energy(const Settings &more = {})
  {
    const Body<dim>           body(held<dim>(false, more), ModelKind::peridynamics);
    const StateOperator<dim> &op   = *body.states;
    const auto                wave = [&](const double k) {
      Vector x = body.values([&](const Point<dim> &p) {
        Tensor<1, dim> u;
        for (unsigned int d = 0; d < dim; ++d)
          u[d] = std::sin(k * p[0] + 3. * d) + (dim > 1 ? std::cos(2. * k * p[dim - 1] + d) : 0.);
        return u;
      });
      op.clear_constrained(x);
      return x;
    };
    const Vector x = wave(7.), y = wave(23.);
    Vector       of_x(x), of_y(y), moved(x), still(x);
    op.apply(of_x, x);
    op.apply(of_y, y);
    EXPECT_NEAR(of_x * y, of_y * x, 1e-12 * std::abs(of_x * x));
    still = 0.;
    op.distribute(still, 0.);
    moved = x;
    op.distribute(moved, 0.);
    Vector r(x), opposite(x);
    op.residual(r, still, 0.);
    opposite = x;
    opposite *= -1.;
    op.distribute(opposite, 0.);
    const double up = op.energy(moved), down = op.energy(opposite), middle = op.energy(still);
    EXPECT_NEAR(up + down - 2. * middle, of_x * x, 1e-11 * (up + down));
    EXPECT_NEAR(0.5 * (up - down), -(r * x), 1e-11 * (up + down));
    // What solvers move without distributing it.
    Vector stale(still), other(x);
    stale += x;
    op.residual(r, stale, 0.);
    op.residual(other, moved, 0.);
    other -= r;
    EXPECT_LT(other.linfty_norm(), 1e-13 * r.linfty_norm());
    const Spectrum spectrum = op.spectrum();
    double         sum      = 0.;
    for (unsigned int i = 0; i < x.locally_owned_size(); ++i)
      sum += x.local_element(i) * x.local_element(i) * op.lumped_capacity().local_element(i);
    EXPECT_LE(of_x * x, spectrum.sharp * dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD));
    EXPECT_LE(spectrum.sharp, spectrum.safe);
  }


  /** Which sides of a body hold themselves, and whether a note is due. */
  void expect_sides(const Settings &more, const std::vector<bool> &wanted, const std::string &word)
  {
    const Body<2> body(held<2>(false, more), ModelKind::peridynamics);
    const auto    found = sides_held_themselves(body.scene);
    EXPECT_EQ(std::vector<bool>(found.begin(), found.end()), wanted) << word;
    const std::string note = note_on_held_rows(body.scene);
    EXPECT_EQ(note.empty(), word.empty()) << note;
    EXPECT_NE(note.find(word), std::string::npos) << note;
  }
} // namespace


TEST(HeldRows, linear_fields)
{
  for (const bool rollers : {false, true})
    {
      check_linear_field<1>(rollers);
      check_linear_field<2>(rollers);
      check_linear_field<3>(rollers);
      check_linear_field<2>(rollers,
                            {{"Domain/Cells", "15, 9"}, {"Peridynamics/Horizon ratio", "4"}});
      check_linear_field<2>(rollers, {{"Domain/Cells", "12, 3"}});
      check_linear_field<2>(rollers, {{"Domain/Cells", "3, 3"}});
      check_linear_field<1>(rollers, {{"Domain/Cells", "3"}});
      check_linear_field<2>(rollers, {{"Peridynamics/Operator form", "stored"}});
      check_linear_field<2>(rollers, full);
    }
}


TEST(HeldRows, energy)
{
  check_energy<1>();
  check_energy<2>();
  check_energy<3>();
  check_energy<2>({{"Domain/Cells", "12, 3"}});
}


TEST(HeldRows, mass_is_kept)
{
  const Body<2> body(held<2>(false, {}), ModelKind::peridynamics);
  const Vector &mass = body.op().lumped_capacity();
  EXPECT_NEAR(mass.l1_norm(), 2. * 0.75, 1e-12);
}


TEST(HeldRows, where)
{
  const std::vector<bool> all(4, true), none(4, false);
  expect_sides({}, all, "");
  expect_sides({{displacement, "left: 0, 0 ; right: 0, free"}}, {true, true, false, false}, "");
  expect_sides({{"Boundary conditions/Displacement layer", "0.2"}}, none, "");
  expect_sides({{"Boundary conditions/Displacement layer", "0.05"}}, none, "Displacement layer");
  expect_sides({{"Material/Fracture energy", "1"}}, none, "bonds may break");
  expect_sides({{"Domain/Cells", "12, 2"}, {"Domain/Upper corner", "1, 0.2"}},
               {true, true, false, false},
               "too few cells wide");
  expect_sides({{"Cracks/Segments", "0.4,0.01 ; 0.4,0.3"}},
               {true, true, false, true},
               "a crack comes within two cells");
  expect_sides({{"Peridynamics/Surface correction", "none"}}, none, "");
  expect_sides({{"Domain/Nodes", "vertices"}}, none, "");
}
