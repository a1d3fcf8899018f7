// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Correspondence: uniform strains, forces and tangents against energies, bounds of steps, what
// bodies that flow remember, bodies on any number of processes.

#include <deal.II/base/symmetric_tensor.h>

#include <perideal/base/archive.h>
#include <perideal/laws/elasticity.h>
#include <perideal/laws/j2_plasticity.h>

#include <cmath>

#include "body_waves.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;
using dealii::Point;
using dealii::SymmetricTensor;
using dealii::Tensor;

namespace
{
  const Settings nodal{{"Elasticity/Model", "correspondence"}, {"Peridynamics/Horizon ratio", "2"}};

  const Settings plastic{{"Material/Law", "plastic"},
                         {"Material/Yield stress", "0.3"},
                         {"Material/Hardening modulus", "0.2"},
                         {"Elasticity/Solver", "newton"}};

  const Settings completed{{"Peridynamics/Surface correction", "fictitious nodes"}};
  const Settings in_strain{{"Elasticity/Plane", "strain"}},
    in_stress{{"Elasticity/Plane", "stress"}};

  /** Without the moduli of box(). */
  Settings orthotropic(const unsigned int dim)
  {
    return {{"Material/Young modulus", ""},
            {"Material/Poisson ratio", ""},
            {"Material/Young moduli", "15, 2, 3"},
            {"Material/Shear moduli", "1, 0.8, 0.7"},
            {"Material/Poisson ratios", "0.3, 0.25, 0.2"},
            {"Material/Material angle", dim == 3 ? "20, 30, 40" : "25"}};
  }

  struct Kind
  {
    const char *name;
    Settings    more;
  };

  template <int dim>
  std::vector<Kind> linear_kinds()
  {
    if (dim == 3)
      return {{"3D", {}}, {"3D, completed", completed}, {"3D, orthotropic", orthotropic(3)}};
    const Settings cracked{{"Cracks/Segments", "0.21,0.34 ; 0.66,0.43"},
                           {"Elasticity/Contact", "false"}};
    return {{"plane strain", in_strain},
            {"plane stress, completed", in_stress + completed},
            {"cracked", in_strain + cracked},
            {"orthotropic, plane stress", orthotropic(2) + in_stress},
            {"orthotropic, plane strain, completed", orthotropic(2) + in_strain + completed},
            {"phases, symmetry",
             in_stress + Settings{{"Material/Young modulus", "3 + y"},
                                  {"Boundary conditions/Symmetry", "bottom"},
                                  {"Peridynamics/Surface correction", "auto"}}}};
  }


  template <int dim>
  std::vector<Kind> flowing_kinds()
  {
    if (dim == 3)
      return {{"3D", {}}, {"3D, completed", completed}};
    return {{"plane strain", in_strain},
            {"plane strain, completed", in_strain + completed},
            {"plane stress", in_stress},
            {"plane stress, phases",
             in_stress + Settings{{"Material/Yield stress", "0.3 + 0.4*x"},
                                  {"Material/Hardening modulus", "0.1 + y"},
                                  {"Material/Young modulus", "3 + y"}}}};
  }


  template <int dim>
  const Correspondence<dim> &correspondence(const Body<dim> &body)
  {
    return *body.states->bonds().correspondence();
  }


  /** What a step to u would dissipate. Collective. */
  template <int dim>
  double plastic_work(const Body<dim> &body, const Vector &u)
  {
    const Correspondence<dim> &nodal = correspondence(body);
    nodal.tensors(u); // which asks the law
    double sum = 0.;
    for (unsigned int i = 0; i < body.n_owned(); ++i)
      sum += nodal.shapes[i].share * body.nodes->volume(i) * nodal.stresses[i].dissipated;
    return dealii::Utilities::MPI::sum(sum, body.nodes->communicator());
  }


  template <int dim>
  NodeKeys keys(const Body<dim> &body)
  {
    NodeKeys list;
    for (unsigned int i = 0; i < body.n_owned(); ++i)
      {
        std::uint64_t key = 0;
        for (unsigned int d = 0; d < dim; ++d)
          key = (key << 20) + std::llround(1e4 * (body.position(i)[d] + 1.));
        list.push_back(key);
      }
    return list;
  }


  /** Strains of a linear displacement at all nodes, and no forces where families are alike. */
  template <int dim>
  void expect_uniform(const Kind &kind)
  {
    SCOPED_TRACE(kind.name);
    Body<dim>    body(box<dim>() + nodal + kind.more, ModelKind::peridynamics);
    const Vector u            = body.values(linear_field<dim>);
    const auto   tensors      = correspondence(body).tensors(u);
    const auto   expected     = symmetrize(some_gradient<dim>());
    const Moduli moduli       = body.scene.material.moduli(Point<dim>());
    const bool   is_isotropic = body.scene.material.uniform_moduli();
    const auto   stress = PeriDeal::stress<dim>(moduli, body.scene.elasticity.plane, expected);
    const double reach  = body.states->bonds().families.weights().reach();
    Vector       forces(u);
    body.op().unbalanced(forces, u, 0.);
    unsigned int n_inside = 0;
    for (unsigned int i = 0; i < body.n_owned(); ++i)
      {
        EXPECT_LT((tensors.strain[i] - expected).norm(), 1e-12);
        if (!is_isotropic)
          continue;
        EXPECT_LT((tensors.stress[i] - stress).norm(), 1e-12 * stress.norm());
        bool is_inside = body.scene.cracks.cracks.empty();
        for (unsigned int d = 0; d < dim; ++d)
          is_inside = is_inside && body.position(i)[d] > 2.1 * reach &&
                      body.position(i)[d] < body.scene.domain.upper[d] - 2.1 * reach;
        n_inside += is_inside ? 1 : 0;
        for (unsigned int d = 0; is_inside && d < dim; ++d)
          EXPECT_NEAR(forces.local_element(dim * i + d), 0., 1e-13);
      }
    const unsigned int n = dealii::Utilities::MPI::sum(n_inside, body.nodes->communicator());
    EXPECT_TRUE(dim == 3 || !is_isotropic || !body.scene.cracks.cracks.empty() || n > 0);
    if (!body.states->bonds().ends.images || !is_isotropic)
      return;
    // Completed families store what the classical body does.
    double volume = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      volume *= body.scene.domain.upper[d];
    EXPECT_NEAR(body.op().energy(u), 0.5 * volume * (stress * expected), 1e-12);
  }


  /** The energy is that of K, K symmetric and positive, bounds and diagonal are K's. */
  template <int dim>
  void expect_linear(const Kind &kind)
  {
    SCOPED_TRACE(kind.name);
    Body<dim>    body(box<dim>() + nodal + kind.more, ModelKind::peridynamics);
    const Vector u = waves(body, 0.1, 0.3), other = waves(body, 1., 2.);
    const Vector Ku = body.product(u), K_other = body.product(other);
    const double size = Ku.l2_norm() * other.l2_norm();
    EXPECT_NEAR(other * Ku, u * K_other, 1e-13 * size);
    EXPECT_NEAR(body.op().energy(u), 0.5 * (u * Ku), 1e-13 * (u * Ku));
    EXPECT_GT(u * Ku, 0.);
    Vector shift = body.values([](const Point<dim> &p) {
      Tensor<1, dim> turned;
      turned[0] = 1. - p[1];
      turned[1] = 2. + p[0];
      return turned;
    });
    EXPECT_TRUE(!body.scene.boundary_conditions.symmetry.empty() ||
                body.product(shift).linfty_norm() < 1e-12 * K_other.linfty_norm());
    const Spectrum spectrum = body.op().spectrum();
    EXPECT_LE(spectrum.sharp, spectrum.safe * (1. + 1e-12));
    EXPECT_GT(spectrum.sharp, 0.15 * spectrum.safe); // measured: 0.19 to 0.5
    // Entries of the diagonal where no fictitious node follows the node.
    if (body.states->bonds().ends.images)
      return;
    for (const unsigned int k : {0U, 37U, 90U})
      {
        Vector unit(u);
        unit = 0.;
        if (dealii::Utilities::MPI::this_mpi_process(body.nodes->communicator()) == 0)
          unit.local_element(k) = 1.;
        const Vector column   = body.product(unit);
        const double expected = unit * column;
        Vector       diagonal(u);
        correspondence(body).shapes.find_diagonal(diagonal);
        EXPECT_NEAR(diagonal * unit, expected, 1e-13 * expected);
      }
  }


  /** As of other bodies that flow: see yielding_families_test.cc. */
  template <int dim>
  void expect_slopes(const Kind &kind)
  {
    SCOPED_TRACE(kind.name);
    Body<dim>    body(box<dim>() + nodal + plastic + kind.more, ModelKind::peridynamics);
    const double size = dim == 3 ? 0.3 : 1.;
    body.op().accept(waves(body, 0.02 * size, 0.), 0.);
    body.op().accept(waves(body, 0.025 * size, 0.2), 1.);
    double                    yielded = 0.;
    const std::vector<double> strains = correspondence(body).stresses.shown()[0].second;
    for (const double strain : strains)
      yielded += strain > 0. ? 1. : 0.;
    yielded = dealii::Utilities::MPI::sum(yielded, body.nodes->communicator());
    EXPECT_GT(yielded, 0.2 * body.nodes->n_global());
    EXPECT_LT(yielded, 1. * body.nodes->n_global());
    const Vector u = waves(body, 0.03 * size, 0.5), direction = waves(body, 1., 2.),
                 other = waves(body, 1., 3.);
    const double step  = 1e-7;
    Vector       up(u), down(u), forces(u), of_up(u), of_down(u), image(u), of_other(u);
    up.add(step, direction);
    down.add(-step, direction);
    const auto spent = [&](const Vector &at) {
      return body.op().energy(at) + plastic_work(body, at);
    };
    body.op().unbalanced(of_up, up, 2.);
    const double above = spent(up);
    body.op().unbalanced(of_down, down, 2.);
    const double below = spent(down);
    body.op().unbalanced(forces, u, 2.);
    const double most = forces.l2_norm() * direction.l2_norm();
    EXPECT_NEAR((above - below) / (2. * step), -(forces * direction), 1e-7 * most);
    body.op().linearize(u);
    body.op().multiply(image, direction);
    body.op().multiply(of_other, other);
    of_up -= of_down;
    of_up *= -0.5 / step;
    EXPECT_LT(largest_difference(of_up, image), 1e-6 * image.linfty_norm());
    EXPECT_NEAR(other * image, direction * of_other, 1e-12 * other.l2_norm() * image.l2_norm());
    EXPECT_GT(direction * image, 0.);
    body.op().spectrum();
    body.op().multiply(of_other, direction);
    EXPECT_LT(direction * image, 0.9 * (direction * of_other));
  }


  Settings in_form(const std::string &form)
  {
    return {{"Peridynamics/Operator form", form}};
  }


  /** Bodies that store all bonds, and those that leave them to the lattice where they can. */
  template <int dim>
  void expect_same_of_forms(const Kind &kind, const std::string &m)
  {
    SCOPED_TRACE(kind.name);
    const Settings all =
      box<dim>() + nodal + kind.more + Settings{{"Peridynamics/Horizon ratio", m}};
    Body<dim> body(all + in_form("auto"), ModelKind::peridynamics),
      stored(all + in_form("stored"), ModelKind::peridynamics);
    ASSERT_TRUE(body.states->bonds().rows.body.leaves_out());
    ASSERT_FALSE(stored.states->bonds().rows.body.leaves_out());
    unsigned int n_lattice = 0;
    for (unsigned int i = 0; i < body.n_owned(); ++i)
      n_lattice += body.states->bonds().rows.is_on_lattice(i) ? 1 : 0;
    EXPECT_GT(n_lattice, 0U);
    const double size = dim == 3 ? 0.45 : 1.;
    Vector       a(body.vector()), b(body.vector());
    const auto   compare = [&](const double bound) {
      EXPECT_LT(largest_difference(a, b), bound * a.linfty_norm());
      EXPECT_GT(a.linfty_norm(), 0.);
    };
    unsigned int step = 0;
    for (const double strain : {0.002, 0.02, 0.025, 0.03, 0.01})
      {
        Vector u = waves(body, strain * size, 0.3 * step);
        // Far from where it was at first convolutions lose some digits.
        const bool is_far = step == 2;
        u.add(is_far ? 5. : 0.);
        body.op().unbalanced(a, u, step);
        stored.op().unbalanced(b, u, step);
        compare(is_far ? 1e-9 : 1e-12);
        EXPECT_NEAR(body.op().energy(u),
                    stored.op().energy(u),
                    (is_far ? 1e-9 : 1e-12) * stored.op().energy(u));
        EXPECT_NEAR(plastic_work(body, u), plastic_work(stored, u), 1e-12 * stored.op().energy(u));
        body.op().linearize(u);
        stored.op().linearize(u);
        body.op().multiply(a, waves(body, 1., 2.));
        stored.op().multiply(b, waves(body, 1., 2.));
        compare(1e-11);
        body.op().accept(u, step);
        stored.op().accept(u, step);
        ++step;
      }
    EXPECT_NEAR(body.op().released().by_law,
                stored.op().released().by_law,
                1e-9 * std::abs(stored.op().released().by_law));
    EXPECT_NEAR(body.op().spectrum().safe, stored.op().spectrum().safe, 1e-12);
  }
} // namespace


/** What is beside the strain of a point counts as shear: slopes against differences. */
TEST(Correspondence, shear_beside_that_of_a_point)
{
  for (const StressState kind : {StressState::three_dimensional, StressState::plane_stress})
    {
      const J2Plasticity        law(kind);
      const double              G = 1.3, step = 1e-5;
      const std::vector<double> parameters = law.parameters(Moduli{2., G}, 0.5, 0.1);
      std::vector<double>       state(law.n_state(), 0.), next(state);
      StressLaw::Tensor         strain;
      strain[0][0]  = 0.5;
      strain[1][1]  = -0.3;
      strain[0][1]  = 0.1;
      const auto at = [&](const double square, J2Plasticity::Beside &beside) {
        beside.square = square;
        return law.update_with(beside,
                               {strain, parameters.data(), state.data()},
                               next.data(),
                               nullptr);
      };
      J2Plasticity::Beside none, beside, above, below;
      const auto           alone = at(0., none), response = at(0.4, beside);
      const auto           more = at(0.4 + step, above), less = at(0.4 - step, below);
      EXPECT_LT(beside.ratio, none.ratio);
      EXPECT_LT(beside.ratio, 0.5);
      EXPECT_LT(response.stress.norm(), alone.stress.norm());
      EXPECT_NEAR((above.ratio - below.ratio) / (2. * step),
                  beside.ratio_slope,
                  1e-8 * std::abs(beside.ratio_slope));
      EXPECT_LT(((more.stress - less.stress) / (2. * step) - beside.stress_slope).norm(),
                1e-8 * beside.stress_slope.norm());
      const auto spent = [&](const auto &of, const J2Plasticity::Beside &with) {
        return of.stored + with.ratio * with.ratio * with.square / (6. * G) + of.dissipated;
      };
      EXPECT_NEAR((spent(more, above) - spent(less, below)) / (2. * step),
                  beside.ratio / (6. * G),
                  1e-8);
    }
}


TEST(Correspondence, uniform_strain_2D)
{
  for (const Kind &kind : linear_kinds<2>())
    if (std::string(kind.name) != "phases, symmetry") // that a linear displacement has not
      expect_uniform<2>(kind);
}


TEST(Correspondence, uniform_strain_3D)
{
  for (const Kind &kind : linear_kinds<3>())
    expect_uniform<3>(kind);
}


TEST(Correspondence, linear_2D)
{
  for (const Kind &kind : linear_kinds<2>())
    expect_linear<2>(kind);
}


TEST(Correspondence, linear_3D)
{
  for (const Kind &kind : linear_kinds<3>())
    expect_linear<3>(kind);
}


TEST(Correspondence, slopes_2D)
{
  for (const Kind &kind : flowing_kinds<2>())
    expect_slopes<2>(kind);
}


TEST(Correspondence, slopes_3D)
{
  for (const Kind &kind : flowing_kinds<3>())
    expect_slopes<3>(kind);
}


TEST(Correspondence, on_the_lattice_as_with_stored_bonds_2D)
{
  for (const Kind &kind : linear_kinds<2>())
    expect_same_of_forms<2>(kind, "3");
  for (Kind kind : flowing_kinds<2>())
    {
      kind.more = plastic + kind.more;
      expect_same_of_forms<2>(kind, "2");
    }
  expect_same_of_forms<2>(
    {"cracked, flows",
     plastic + in_stress + completed +
       Settings{{"Cracks/Segments", "0.21,0.34 ; 0.66,0.43"}, {"Elasticity/Contact", "false"}}},
    "3");
}


TEST(Correspondence, on_the_lattice_as_with_stored_bonds_3D)
{
  for (const Kind &kind : linear_kinds<3>())
    expect_same_of_forms<3>(kind, "2");
  for (Kind kind : flowing_kinds<3>())
    {
      kind.more = plastic + kind.more;
      expect_same_of_forms<3>(kind, "2");
    }
}


TEST(Correspondence, below_the_yield_stress_the_linear_body)
{
  for (const Kind &kind : flowing_kinds<2>())
    {
      if (std::string(kind.name) == "plane stress, phases")
        continue;
      SCOPED_TRACE(kind.name);
      const Settings high{{"Material/Yield stress", "100"}};
      Body<2>        linear(box<2>() + nodal + kind.more, ModelKind::peridynamics),
        body(box<2>() + nodal + plastic + kind.more + high, ModelKind::peridynamics);
      const Vector u = waves(body, 0.05, 0.);
      Vector       a(u), b(u);
      linear.op().unbalanced(a, u, 0.);
      body.op().unbalanced(b, u, 0.);
      EXPECT_LT(largest_difference(a, b), 1e-12 * a.linfty_norm());
      EXPECT_NEAR(linear.op().energy(u), body.op().energy(u), 1e-12 * linear.op().energy(u));
      body.op().accept(waves(body, 0.02, 0.), 0.);
      body.op().accept(u, 1.);
      EXPECT_EQ(body.op().released().by_law, 0.);
      body.op().linearize(u);
      EXPECT_LT(largest_difference(linear.product(u), body.product(u)), 1e-12 * a.linfty_norm());
    }
}


TEST(Correspondence, warm_bodies_that_are_free_have_no_stress)
{
  Body<2> body(
    box<2>() + nodal + in_strain + completed +
      Settings{{"Elasticity/Temperature change", "2"}, {"Material/Thermal expansion", "0.01"}},
    ModelKind::peridynamics);
  const Vector u = body.values([](const Point<2> &p) { // (1 + nu) alpha dT
    return Tensor<1, 2>(0.024 * p);
  });
  Vector       forces(u);
  body.op().unbalanced(forces, u, 0.);
  EXPECT_LT(forces.linfty_norm(), 1e-14);
  EXPECT_NEAR(body.op().energy(u), 0., 1e-16);
}


TEST(Correspondence, archived_and_taken_up_again)
{
  const Settings settings = box<2>() + nodal + plastic + in_strain + completed;
  Body<2> body(settings, ModelKind::peridynamics), resumed(settings, ModelKind::peridynamics);
  body.op().accept(waves(body, 0.05, 0.), 0.);
  body.op().accept(waves(body, 0.06, 0.5), 1.);
  MemoryArchive saved(MPI_COMM_WORLD);
  body.op().exchange(saved, keys(body));
  MemoryArchive loaded(saved, MPI_COMM_WORLD);
  resumed.op().exchange(loaded, keys(resumed));
  const Vector u = waves(body, 0.07, 0.6);
  Vector       a(u), b(u);
  body.op().unbalanced(a, u, 2.);
  resumed.op().unbalanced(b, u, 2.);
  EXPECT_EQ(largest_difference(a, b), 0.);
  body.op().accept(u, 2.);
  resumed.op().accept(u, 2.);
  EXPECT_GT(body.op().released().by_law, 0.);
  EXPECT_EQ(body.op().released().by_law, resumed.op().released().by_law);
  EXPECT_EQ(correspondence(body).stresses.shown(), correspondence(resumed).stresses.shown());
}


TEST(Correspondence, same_on_every_number_of_processes)
{
  for (const unsigned int k : {0, 1, 3})
    {
      const Settings settings = box<2>() + nodal + plastic + flowing_kinds<2>()[k].more;
      Body<2>        body(settings, ModelKind::peridynamics),
        whole(settings, ModelKind::peridynamics, MPI_COMM_SELF);
      SCOPED_TRACE(flowing_kinds<2>()[k].name);
      Vector     forces = body.vector(), of_whole = whole.vector();
      const bool is_completed = k == 1; // forces are passed on in another order
      for (const double phase : {0.1, 0.4, 0.5})
        {
          body.op().unbalanced(forces, waves(body, 0.06, phase), phase);
          whole.op().unbalanced(of_whole, waves(whole, 0.06, phase), phase);
          for_each_pair(body, whole, [&](const unsigned int i, const unsigned int n) {
            for (unsigned int d = 0; d < 2; ++d)
              EXPECT_NEAR(forces.local_element(2 * i + d),
                          of_whole.local_element(2 * n + d),
                          is_completed ? 1e-13 : 0.);
          });
          body.op().accept(waves(body, 0.06, phase), phase);
          whole.op().accept(waves(whole, 0.06, phase), phase);
        }
      const auto strains = correspondence(body).stresses.shown()[0].second,
                 all     = correspondence(whole).stresses.shown()[0].second;
      body.op().linearize(waves(body, 0.08, 0.7));
      whole.op().linearize(waves(whole, 0.08, 0.7));
      body.op().multiply(forces, waves(body, 1., 3.));
      whole.op().multiply(of_whole, waves(whole, 1., 3.));
      for_each_pair(body, whole, [&](const unsigned int i, const unsigned int n) {
        EXPECT_NEAR(strains[i], all[n], 1e-14);
        for (unsigned int d = 0; d < 2; ++d)
          EXPECT_NEAR(forces.local_element(2 * i + d), of_whole.local_element(2 * n + d), 1e-12);
      });
      EXPECT_NEAR(body.op().released().by_law,
                  whole.op().released().by_law,
                  1e-12 * std::abs(whole.op().released().by_law));
    }
}
