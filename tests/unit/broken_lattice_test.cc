// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bonds that break where most nodes store none.

#include <perideal/solvers/motion_stepper.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dimensions.h"
#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  using dealii::Point;
  using dealii::Tensor;

  /** A body of a scene file at nodes of a lattice. */
  template <int dim>
  struct BodyOfScene
  {
    BodyOfScene(const std::string &file, const std::vector<std::string> &overrides)
    {
      const std::string name = std::string(PERIDEAL_SOURCE_DIR) + "/prm/fracture/" + file;
      parse_scene(read_scene(name, overrides, MPI_COMM_WORLD), scene);
      std::vector<std::string> notes;
      mesh = build_mesh(scene, MPI_COMM_WORLD, notes);
      handler.reinit(*mesh);
      if (scene.domain.nodes == NodePlacement::cell_centers)
        handler.distribute_dofs(dealii::FE_DGQ<dim>(0));
      else
        handler.distribute_dofs(dealii::FE_Q<dim>(1));
      number_along_lattice(handler, scene.domain);
      nodes =
        std::make_unique<Nodes<dim>>(handler, scene.domain, scene.cracks, NodalVolume::partial);
      states = std::make_unique<StateOperator<dim>>(*nodes, scene);
    }

    Scene<dim>                                  scene;
    std::unique_ptr<dealii::Triangulation<dim>> mesh;
    dealii::DoFHandler<dim>                     handler;
    std::unique_ptr<Nodes<dim>>                 nodes;
    std::unique_ptr<StateOperator<dim>>         states;
  };


  /** Whole bonds of owned nodes that are stretched beyond what they bear, all of them looked at. */
  template <int dim>
  std::size_t count_overstretched(const StateOperator<dim> &op, const Vector &u)
  {
    const SolidBonds<dim>     &bonds    = op.bonds();
    const std::vector<double> &critical = op.breaking().critical_stretches();
    std::size_t                n        = 0;
    u.update_ghost_values();
    for (unsigned int i = 0; i < bonds.families.nodes().n_owned(); ++i)
      bonds.rows.for_each_in_body(i, [&](const auto &bond) {
        const Tensor<1, dim> xi = bonds.families.neighbors().bond_vector(i, bond.neighbor);
        const double         limit =
          (bond.moment * xi) * std::min(critical[i], critical[bond.neighbor]) * (1. + 1e-12);
        if (bonds.rows.is_whole(bond.number) &&
            bonds.kinematics.extension_moment(u.begin(), i, bond) > limit)
          ++n;
      });
    u.set_ghost_state(false);
    return n;
  }


  /** The bonds that break in a motion from rest. No whole one should have broken at any step. */
  template <int dim>
  std::vector<NodePair> broken_bonds(BodyOfScene<dim> &body, const double t_end)
  {
    StateOperator<dim> &op = *body.states;
    Vector              u, v;
    op.initialize_vector(u);
    op.initialize_vector(v);
    op.distribute(u, 0.);
    StepperOptions options;
    options.time_step  = -1.;
    const auto stepper = make_motion_stepper("verlet", op, options);
    stepper->advance(u, v, 0., t_end, [&](const double t) {
      EXPECT_EQ(count_overstretched(op, u), 0u) << "at t = " << t;
    });
    EXPECT_EQ(count_overstretched(op, u), 0u);
    std::size_t           n_known = 0;
    std::vector<NodePair> pairs   = op.broken_since(n_known);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  }


  /**
   * In a run of a scene the same bonds break in both forms, and none is missed; few nodes store
   * bonds.
   */
  template <int dim>
  void expect_same_bonds(const std::string              &file,
                         const double                    t_end,
                         const std::vector<std::string> &overrides)
  {
    const auto body = [&](const std::string &form) {
      std::vector<std::string> all{"Elasticity/Solver=dynamics",
                                   "Peridynamics/Operator form=" + form};
      all.insert(all.end(), overrides.begin(), overrides.end());
      return std::make_unique<BodyOfScene<dim>>(file, all);
    };
    const auto lattice = body("lattice"), stored = body("stored");
    const auto found = broken_bonds(*lattice, t_end), expected = broken_bonds(*stored, t_end);
    EXPECT_GT(sum_of_all(expected.size()), 20.) << file;
    EXPECT_EQ(sum_of_all(found.size()), sum_of_all(expected.size())) << file;
    EXPECT_TRUE(found == expected) << file;
    const BreakHistory &a = *lattice->states->break_history(),
                       &b = *stored->states->break_history();
    EXPECT_EQ(a.n_broken, b.n_broken);
    EXPECT_NEAR(a.released, b.released, 1e-6 * b.released);
    EXPECT_EQ(a.places.first, b.places.first);
    EXPECT_EQ(lattice->states->size().form, "lattice");
    EXPECT_DOUBLE_EQ(sum_of_all(lattice->states->bonds().rows.n_bonds),
                     sum_of_all(stored->states->bonds().rows.n_bonds));
    const std::vector<double> damage          = lattice->states->breaking().damage(),
                              expected_damage = stored->states->breaking().damage();
    for (std::size_t i = 0; i < damage.size(); ++i)
      EXPECT_NEAR(damage[i], expected_damage[i], 1e-12) << file;
    EXPECT_LT(sum_of_all(lattice->states->bonds().rows.body.size()),
              0.6 * sum_of_all(stored->states->bonds().rows.body.size()))
      << file;
  }


  template <int dim>
  Tensor<1, dim> rough_vector(const Point<dim> &p, const double roughness)
  {
    Tensor<1, dim> value = 0.1 * bumpy_vector<dim>(p);
    for (unsigned int d = 0; d < dim; ++d)
      {
        double phase = 7. * d;
        for (unsigned int e = 0; e < dim; ++e)
          phase += (1234.5 + 77. * e) * p[e];
        value[d] += roughness * std::sin(phase * phase);
      }
    return value;
  }


  /** The bound holds for all pairs, and nodes that are no suspects have no bond above. */
  template <int dim>
  void expect_bounds(const Settings &more, const double roughness, const bool some_unbounded)
  {
    const Body<dim> body(
      box<dim>() + more +
        Settings{{"Elasticity/Solver", "dynamics"}, {"Material/Critical stretch", "0.05 + 0.02*x"}},
      ModelKind::peridynamics);
    const SolidBonds<dim>     &bonds    = body.states->bonds();
    const Families<dim>       &families = bonds.families;
    const std::vector<double> &critical = body.states->breaking().critical_stretches();
    const StretchScreen<dim>   screen(families, critical);
    Vector u = body.values([&](const Point<dim> &p) { return rough_vector<dim>(p, roughness); });
    u.update_ghost_values();
    const std::vector<unsigned int> &suspects  = screen.suspects(u.begin(), 0.);
    double                           unbounded = 0., n_above = 0.;
    for (unsigned int i = 0; i < families.nodes().n_owned(); ++i)
      {
        double largest = -1e300;
        bool   above   = false;
        bonds.rows.for_each_in_body(i, [&](const auto &bond) {
          const Tensor<1, dim> xi = families.neighbors().bond_vector(i, bond.neighbor);
          double               e  = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            e += xi[d] * (u.local_element(dim * bond.neighbor + d) - u.local_element(dim * i + d));
          e /= xi.norm_square();
          largest = std::max(largest, e);
          above   = above || e > std::min(critical[i], critical[bond.neighbor]);
        });
        const bool is_suspect = std::binary_search(suspects.begin(), suspects.end(), i);
        unbounded += std::isfinite(screen.bound(i)) ? 0. : 1.;
        n_above += above ? 1. : 0.;
        EXPECT_LE(largest, screen.bound(i) * (1. + 1e-9) + 1e-9);
        EXPECT_TRUE(is_suspect || !above);
        EXPECT_TRUE(screen.may_reach(i, u.begin(), 0.) || !above);
      }
    EXPECT_EQ(sum_of_all(unbounded) > 0., some_unbounded);
    EXPECT_GT(sum_of_all(n_above), 0.);
  }


  const char *const fine[] = {"", "", "50, 37", "19, 15, 11"};

} // namespace


TEST_IN_DIMENSIONS(BrokenLattice, bounds_of_a_uniform_strain_are_sharp, 2, 3)
{
  const Body<dim>          body(box<dim>() + Settings{{"Domain/Cells", fine[dim]},
                                             {"Elasticity/Solver", "dynamics"},
                                             {"Material/Critical stretch", "0.05"}},
                       ModelKind::peridynamics);
  const StretchScreen<dim> screen(body.states->bonds().families,
                                  body.states->breaking().critical_stretches());
  Vector                   u = body.values(linear_field<dim>);
  u.update_ghost_values();
  const double largest = dealii::eigenvalues(dealii::symmetrize(some_gradient<dim>()))[0];
  screen.suspects(u.begin(), 0.);
  for (unsigned int i = 0; i < body.nodes->n_owned(); ++i)
    EXPECT_NEAR(screen.bound(i), largest, 1e-8);
  u *= 0.0499 / largest;
  EXPECT_TRUE(screen.suspects(u.begin(), 0.).empty());
  EXPECT_EQ(screen.suspects(u.begin(), -0.001).size(), body.nodes->n_owned());
  // Of a criterion that knows no stretch below which nothing breaks.
  const std::vector<double> unknown(body.nodes->n_local(),
                                    -std::numeric_limits<double>::infinity());
  const StretchScreen<dim>  blind(body.states->bonds().families, unknown);
  EXPECT_EQ(blind.suspects(u.begin(), 0.).size(), body.nodes->n_owned());
  EXPECT_TRUE(blind.may_reach(0, u.begin(), 0.));
  EXPECT_EQ(blind.least_critical(), unknown[0]);
}


TEST(BrokenLattice, no_stretch_is_above_its_bound)
{
  for (const double roughness : {0., 1e-4, 1e-2})
    {
      expect_bounds<2>({{"Domain/Cells", fine[2]}}, roughness, false);
      expect_bounds<2>({{"Domain/Cells", fine[2]}, {"Peridynamics/Horizon ratio", "5.2"}},
                       roughness,
                       false);
      expect_bounds<2>({{"Domain/Cells", "40, 30"},
                        {"Domain/Shape", "plate with hole"},
                        {"Domain/Hole center", "0.5, 0.4"},
                        {"Domain/Hole radius", "0.13"}},
                       roughness,
                       true);
      expect_bounds<3>({{"Domain/Cells", fine[3]}}, roughness, false);
    }
}


TEST(BrokenLattice, a_crack_that_branches)
{
  expect_same_bonds<2>("branching_crack.prm", 3e-5, {"Domain/Cells=100, 40"});
}


TEST(BrokenLattice, a_struck_plate)
{
  expect_same_bonds<2>("kalthoff_winkler.prm", 5e-5, {"Domain/Cells=50, 100"});
}


TEST(BrokenLattice, a_warm_strip_with_a_weak_part)
{
  expect_same_bonds<2>("torn_strip.prm",
                       0.9,
                       {"Domain/Cells=80, 20",
                        "Elasticity/Temperature change=30*x",
                        "Initial and source/Initial value=0",
                        "Elasticity/Breaking=auto",
                        "Boundary conditions/Dirichlet="});
}


TEST(BrokenLattice, a_block)
{
  expect_same_bonds<3>("cracked_block.prm", 0.8, {"Domain/Cells=20, 40, 4", "Time/Time step=auto"});
}
