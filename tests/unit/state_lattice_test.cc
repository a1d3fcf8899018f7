// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The lattice form of the state-based operator against the stored one.


#include "elastic_test_tools.h"
#include "scene_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  Settings form(const std::string &name)
  {
    return {{"Peridynamics/Operator form", name}};
  }


  /**
   * Largest difference of two lists of the same length, over the largest number of the second one
   * on any process.
   */
  double relative_gap(const std::vector<double> &a, const std::vector<double> &b)
  {
    double gap = a.size() == b.size() ? 0. : INFINITY, size = 0.;
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
      {
        gap  = std::max(gap, std::abs(a[k] - b[k]));
        size = std::max(size, std::abs(b[k]));
      }
    return max_of_all(gap) / max_of_all(size);
  }


  std::vector<double> numbers_of(const Vector &v)
  {
    return {v.begin(), v.begin() + v.locally_owned_size()};
  }


  template <int dim>
  std::vector<double> numbers_of(const std::vector<dealii::SymmetricTensor<2, dim>> &tensors)
  {
    std::vector<double> numbers;
    for (const auto &tensor : tensors)
      for (unsigned int c = 0; c < tensor.n_independent_components; ++c)
        numbers.push_back(tensor.access_raw_entry(c));
    return numbers;
  }


  /** All that an operator says, in a fixed order. */
  template <int dim>
  std::vector<std::pair<std::string, std::vector<double>>> answers_of(const Body<dim> &body)
  {
    const StateOperator<dim>                                &op = *body.states;
    const Vector                                             u  = body.values(bumpy_vector<dim>);
    Vector                                                   y  = body.product(u);
    std::vector<std::pair<std::string, std::vector<double>>> answers;
    answers.emplace_back("multiply", numbers_of(y));
    op.apply(y, u);
    answers.emplace_back("apply", numbers_of(y));
    op.residual(y, u, 0.3);
    answers.emplace_back("residual", numbers_of(y));
    op.damping_force(y, u);
    answers.emplace_back("damping force", numbers_of(y));
    answers.emplace_back("diagonal", numbers_of(op.diagonal()));
    const std::vector<double> theta = nodal_dilatations(op.bonds(), u);
    answers.emplace_back("dilatations", theta);
    const NodalTensors<dim> tensors = op.tensors(u);
    answers.emplace_back("stress", numbers_of<dim>(tensors.stress));
    answers.emplace_back("strain", numbers_of<dim>(tensors.strain));
    answers.emplace_back("energy", std::vector<double>{op.energy(u)});
    answers.emplace_back("bound of the spectrum", std::vector<double>{op.spectrum().safe});
    answers.emplace_back("damping bound", std::vector<double>{op.damping_bound()});
    answers.emplace_back("bonds", std::vector<double>{static_cast<double>(op.size().bonds)});
    answers.emplace_back("damage", op.breaking().damage());
    answers.back().second.push_back(1.); // a size, where nothing is cut
    return answers;
  }


  /** Both forms agree, and at most this share of the bonds is stored. */
  template <int dim>
  void expect_same(const Settings &more, const double stored_share)
  {
    const Body<dim> lattice(box<dim>() + form("lattice") + more, ModelKind::peridynamics),
      stored(box<dim>() + form("stored") + more, ModelKind::peridynamics);
    std::string what = std::to_string(dim) + "D";
    for (const auto &[entry, value] : more)
      what += ", " + entry + " = " + value;
    EXPECT_EQ(lattice.states->size().form, "lattice") << what;
    EXPECT_EQ(stored.states->size().form, "stored") << what;
    const auto found = answers_of(lattice), expected = answers_of(stored);
    for (std::size_t k = 0; k < found.size(); ++k)
      EXPECT_LT(relative_gap(found[k].second, expected[k].second), 1e-12)
        << found[k].first << " of " << what;
    EXPECT_NEAR(lattice.states->spectrum().sharp,
                stored.states->spectrum().sharp,
                1e-9 * stored.states->spectrum().sharp)
      << what;
    const auto n_stored = [](const Body<dim> &body) {
      return static_cast<double>(sum_of_all(body.states->bonds().rows.body.size()));
    };
    EXPECT_EQ(n_stored(stored), 2. * static_cast<double>(stored.states->size().bonds)) << what;
    EXPECT_LE(n_stored(lattice), stored_share * n_stored(stored)) << what;
  }


  const char *const loaded[] = {"", "right: 1 + t", "right: 1 + t, 2", "right: 1 + t, 2, y"};
  const char *const force[]  = {"", "x", "x, y*t", "x, y*t, z"};

  template <int dim>
  Settings loads()
  {
    return {{"Boundary conditions/Traction", loaded[dim]},
            {"Initial and source/Body force", force[dim]}};
  }
} // namespace


TEST(StateLattice, boxes)
{
  for (const char *const placement : {"vertices", "cell centers"})
    {
      const Settings at = {{"Domain/Nodes", placement}};
      expect_same<1>(at + loads<1>(), 0.);
      for (const char *const plane : {"stress", "strain"})
        for (const char *const model : {"state-based", "bond-based"})
          expect_same<2>(at + loads<2>() +
                           Settings{{"Elasticity/Plane", plane}, {"Elasticity/Model", model}},
                         0.);
      expect_same<3>(at + loads<3>(), 0.);
    }
}


TEST(StateLattice, cells_that_are_not_square)
{
  expect_same<2>({{"Domain/Upper corner", "1, 1.6"}}, 0.);
  expect_same<2>({{"Domain/Upper corner", "1, 0.4"}, {"Peridynamics/Horizon ratio", "4.3"}}, 0.);
  expect_same<3>({{"Domain/Upper corner", "1, 0.9, 0.7"}}, 0.);
}


TEST(StateLattice, wide_bodies)
{
  // Longer than a block of rows of the stencil, with inner nodes.
  expect_same<1>({{"Domain/Cells", "400"}, {"Peridynamics/Horizon ratio", "5"}}, 0.);
  expect_same<2>({{"Domain/Cells", "72, 70"},
                  {"Domain/Upper corner", "0.72, 0.7"},
                  {"Peridynamics/Horizon ratio", "5"}},
                 0.);
  expect_same<3>({{"Domain/Cells", "10, 40, 12"},
                  {"Domain/Upper corner", "0.25, 1, 0.3"},
                  {"Peridynamics/Horizon ratio", "1.8"}},
                 0.);
}


TEST(StateLattice, mixed_conditions)
{
  expect_same<2>({{"Boundary conditions/Displacement", "left: 0, free ; bottom: free, 0.1*x"},
                  {"Boundary conditions/Traction", "top: 0.3, t"}},
                 0.);
  expect_same<2>({{"Boundary conditions/Displacement", ""},
                  {"Boundary conditions/Symmetry", "left, bottom"},
                  {"Domain/Nodes", "vertices"}},
                 0.);
}


TEST(StateLattice, holes_and_cracks)
{
  const Settings fine = {{"Domain/Cells", "40, 30"}};
  for (const auto &[voids, stored_share] : {std::pair("keep", 0.), std::pair("cut", 0.25)})
    expect_same<2>(fine + Settings{{"Domain/Shape", "plate with hole"},
                                   {"Domain/Hole center", "0.5, 0.4"},
                                   {"Domain/Hole radius", "0.13"},
                                   {"Peridynamics/Bonds across voids", voids}},
                   stored_share);
  for (const char *const placement : {"vertices", "cell centers"})
    expect_same<2>(
      fine + loads<2>() +
        Settings{{"Domain/Nodes", placement}, {"Cracks/Segments", "0.3,0.412 ; 0.61,0.33"}},
      0.3);
  expect_same<3>({{"Domain/Cells", "12, 9, 6"},
                  {"Cracks/Polygons", "0.4,0.2,0.1 ; 0.7,0.2,0.1 ; 0.7,0.5,0.4 ; 0.4,0.5,0.4"}},
                 0.6);
}


TEST(StateLattice, phases_and_temperatures)
{
  const Settings phases = {{"Material/Phases/Regions", "stiff: x > 0.6 && y > 0.3 ; soft: y < 0.3"},
                           {"Material/Phases/Young modulus", "stiff: 30 ; soft: 0.5"},
                           {"Material/Phases/Poisson ratio", "stiff: 0.1 ; soft: 0.3"}},
                 warm   = {{"Material/Thermal expansion", "0.1"},
                           {"Elasticity/Temperature change", "1 + x*x"}};
  expect_same<2>(phases, 0.);
  expect_same<2>(warm + loads<2>(), 0.);
  expect_same<2>(phases + warm + loads<2>(), 0.);
  expect_same<2>({{"Material/Young modulus", "3 + x"}, {"Material/Poisson ratio", "0.1 + 0.1*y"}},
                 0.);
  expect_same<3>(phases + warm, 0.);
  // Without a volumetric part: k = 5 mu/3.
  expect_same<3>({{"Material/Poisson ratio", "0.25"}}, 0.);
}


TEST(StateLattice, soft_beside_stiff)
{
  // Forces in the soft part keep their digits, for themselves.
  const Settings settings = box<2>() + Settings{{"Domain/Cells", "40, 30"},
                                                {"Material/Phases/Regions", "stiff: x > 0.3"},
                                                {"Material/Phases/Young modulus", "stiff: 3e6"},
                                                {"Material/Phases/Poisson ratio", "stiff: 0.2"}};
  const auto     forces   = [&](const std::string &name) {
    const Body<2>       body(settings + form(name), ModelKind::peridynamics);
    const Vector        y = body.product(body.values(bumpy_vector<2>));
    std::vector<double> soft;
    for (unsigned int i = 0; i < y.locally_owned_size(); ++i)
      if (body.position(i / 2)[0] < 0.22)
        soft.push_back(y.local_element(i));
    return soft;
  };
  EXPECT_LT(relative_gap(forces("lattice"), forces("stored")), 1e-12);
}


TEST(StateLattice, does_not_depend_on_the_number_of_processes)
{
  const Settings settings = box<2>() + form("lattice") +
                            Settings{{"Domain/Cells", "48, 36"},
                                     {"Cracks/Segments", "0.3,0.412 ; 0.61,0.33"},
                                     {"Material/Phases/Regions", "stiff: x > 0.6"},
                                     {"Material/Phases/Young modulus", "stiff: 30"}};
  const Body<2> all(settings, ModelKind::peridynamics),
    alone(settings, ModelKind::peridynamics, MPI_COMM_SELF);
  EXPECT_EQ(difference(all,
                       all.product(all.values(bumpy_vector<2>)),
                       alone,
                       alone.product(alone.values(bumpy_vector<2>))),
            0.);
}


TEST(StateLattice, choice_of_the_form)
{
  const auto form_of = [](const Settings &more) {
    return Body<2>(box<2>() + more, ModelKind::peridynamics).states->size().form;
  };
  EXPECT_EQ(form_of({}), "lattice");
  EXPECT_EQ(Body<1>(box<1>(), ModelKind::peridynamics).states->size().form, "stored");
  EXPECT_EQ(form_of(form("stored")), "stored");
  EXPECT_EQ(form_of({{"Material/Critical stretch", "0.1"}}), "stored");
  EXPECT_EQ(
    form_of({{"Elasticity/Kinematics", "full"}, {"Elasticity/Solver", "conjugate gradients"}}),
    "stored");
  const Settings faces = {{"Cracks/Segments", "0.25,0.375 ; 0.75,0.375"},
                          {"Cracks/Mesh", "faces"},
                          {"Domain/Nodes", "vertices"}};
  EXPECT_EQ(form_of(faces), "stored");
  SceneTests::expect_error([&] { form_of(faces + form("lattice")); },
                           {"'Operator form = lattice'"});
}
