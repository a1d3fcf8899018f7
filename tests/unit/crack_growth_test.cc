// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Cracks that grow or close: when, where, and what becomes of bonds, cells and heat.

#include <perideal/scene/crack_geometry.h>
#include <perideal/solvers/stepper.h>

#include "growth_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    const Settings square{{"Domain/Cells", "24, 20"}, {"Domain/Upper corner", "1.2, 1"}};

    // One end grows, the other turns a corner, and they meet a crack that rests.
    const Settings growing{{"Cracks/Segments", "0.31,0.52 ; 0.31,0.52 ; 0.7,0.13 ; 0.72,0.83"},
                           {"Cracks/Growth", "1: 0.1, -0.2,0.1, 0.7"},
                           {"Cracks/Paths", "2: 0, 0.31,0.52 | 0.4, 0.61,0.44 | 0.8, 0.9,0.71"},
                           {"Time/End time", "1"}};

    const Settings at_end{
      {"Cracks/Segments",
       "0.19,0.58 ; 0.31,0.52 ; 0.31,0.52 ; 0.61,0.44 ; 0.61,0.44 ; 0.9,0.71 ; 0.7,0.13 ; 0.72,0.83"}};


    template <int dim>
    Vector advanced(const Problem<dim> &problem, const std::string &stepper, const double end)
    {
      StepperOptions options;
      options.tolerance = 1e-6;
      if (stepper == "euler")
        options.time_step = 0.8 / problem.op().spectrum().safe;
      Vector u = problem.values(bumpy<dim>);
      problem.op().distribute(u, 0.);
      const auto method = make_stepper(stepper, problem.op(), options);
      for (double t = 0.; t < end;)
        {
          if (problem.op().update(t))
            method->restart();
          const double to = std::min(end, problem.op().next_event(t));
          method->advance(u, t, to);
          t = to;
        }
      return u;
    }
  } // namespace


  TEST(CrackGrowth, events_follow_the_spacing)
  {
    Scene<2> scene;
    OperatorTests::set(scene,
                       {{"Domain/Cells", "10, 10"},
                        {"Cracks/Segments", "0.2,0.5 ; 0.2,0.5"},
                        {"Cracks/Growth", "2: 0.5, 0.2,0, 1.5"},
                        {"Time/End time", "2"}});
    const CrackHistory<2> history = scene.crack_history();
    // A way of 0.2 in steps of 0.025, from 0.5 to 1.5.
    ASSERT_EQ(history.events().size(), 9u);
    for (unsigned int k = 0; k < 9; ++k)
      EXPECT_NEAR(history.events()[k], 0.5 + 0.125 * k, 1e-14);
    EXPECT_NEAR(history.longest_advance(), 0.025, 1e-14);
    EXPECT_NEAR(history.next_event(0.), 0.5, 1e-14);
    EXPECT_EQ(history.next_event(1.6), std::numeric_limits<double>::infinity());
    EXPECT_NEAR(history.representative(0.1), 0.25, 1e-14);
    EXPECT_NEAR(history.representative(0.5), 0.5625, 1e-14);
    EXPECT_NEAR(history.representative(1.9), 1.75, 1e-14);
    EXPECT_TRUE(history.pieces(0.25).empty());
    ASSERT_EQ(history.pieces(0.75).size(), 1u);
    EXPECT_NEAR(history.pieces(0.75)[0].corners[1][0], 0.25, 1e-14);
    EXPECT_NEAR(history.pieces(2.)[0].corners[1][0], 0.4, 1e-14);
    const auto boxes = history.changes(0.5625, 0.6875);
    ASSERT_EQ(boxes.size(), 1u);
    EXPECT_NEAR(boxes[0].lower_bound(0), 0.2125, 1e-14);
    EXPECT_NEAR(boxes[0].upper_bound(0), 0.2375, 1e-14);
    EXPECT_TRUE(history.changes(1.6, 1.9).empty());
    // Fixed steps are never divided: two of 0.05 are the most within 0.125.
    const CrackHistory<2> fixed(scene.cracks, 0.025, 2., 0.05);
    for (const double t : fixed.events())
      EXPECT_NEAR(std::remainder(t - 0.5, 0.1), 0., 1e-12);
    // Starts between steps and changes of the transmission move to whole steps, too.
    OperatorTests::set(scene,
                       {{"Cracks/Growth", "2: 0.513, 0.2,0, 1.5"}, {"Cracks/Transmission", "t/2"}});
    const CrackHistory<2> moved(scene.cracks, 0.025, 2., 0.05);
    EXPECT_EQ(moved.events().size(), 39u);
    for (const double t : moved.events())
      EXPECT_NEAR(std::remainder(t, 0.05), 0., 1e-12);
  }


  TEST(CrackGrowth, pieces_keep_one_left_side)
  {
    Scene<2> scene;
    OperatorTests::set(scene, square + growing);
    const auto pieces = scene.cracks.pieces(1.);
    ASSERT_EQ(pieces.size(), 4u);
    EXPECT_EQ(pieces[0].crack, 0u);
    EXPECT_EQ(pieces[2].crack, 0u);
    EXPECT_EQ(pieces[3].crack, 1u);
    for (unsigned int k = 0; k < 2; ++k)
      EXPECT_LT(pieces[k].corners[1].distance(pieces[k + 1].corners[0]), 1e-15);
    EXPECT_NEAR(pieces[0].corners[0][0], 0.19, 1e-14);
    EXPECT_NEAR(pieces[2].corners[1][0], 0.9, 1e-14);
    // In one line: one piece.
    OperatorTests::set(scene,
                       {{"Cracks/Segments", "0.3,0.3 ; 0.4,0.4"},
                        {"Cracks/Growth", "1: 0, -0.1,-0.1 ; 2: 0, 0.1,0.1"},
                        {"Cracks/Paths", ""}});
    ASSERT_EQ(scene.cracks.pieces(1.).size(), 1u);
    EXPECT_NEAR(scene.cracks.pieces(1.)[0].corners[0][0], 0.2, 1e-14);
    EXPECT_NEAR(scene.cracks.pieces(1.)[0].corners[1][1], 0.5, 1e-14);
  }


  /**
   * The zone moves with the cracks; bonds that join behind a tip are broken by what it has done
   * before.
   */
  TEST(CrackGrowth, moving_zones_end_where_a_new_operator_starts)
  {
    for (const std::string scheme : {"exchange", "blending", "splice"})
      for (const std::string zone : {"cracks: 1", "cracks: 0.4", "everywhere", "0.7 - x"})
        for (const std::string correction : {"none", "crack scaling"})
          expect_grown<2>(scheme + ", " + zone + ", " + correction,
                          square +
                            Settings{{"Coupling/Scheme", scheme},
                                     {"Coupling/Zone", zone},
                                     {"Coupling/Overlap", scheme == "exchange" ? "0" : "0.8"},
                                     {"Boundary conditions/Dirichlet", "left: y"},
                                     {"Boundary conditions/Convection", "top: 2, 1"},
                                     {"Peridynamics/Surface correction", correction}},
                          growing,
                          at_end,
                          ModelKind::coupled);
  }


  TEST(CrackGrowth, bonds_that_join_a_zone_know_all_of_the_crack)
  {
    for (const std::string scheme : {"exchange", "blending", "splice"})
      for (const std::string zone : {"cracks: 1", "cracks: 0.4"})
        {
          const Problem<2>   problem(square + growing +
                                     Settings{{"Coupling/Scheme", scheme}, {"Coupling/Zone", zone}},
                                   ModelKind::coupled);
          const unsigned int n_broken = expect_history_kept(problem, scheme + ", " + zone);
          // With the other schemes a bond joins with its first node, ahead of the tip.
          if (scheme == "exchange")
            {
              EXPECT_GT(n_broken, 0u) << zone;
            }
        }
  }


  TEST(CrackGrowth, updates_end_where_a_new_operator_starts)
  {
    for (const std::string placement : {"vertices", "cell centers"})
      for (const std::string form : {"lattice", "stored"})
        for (const std::string treatment : {"none", "fictitious mirror"})
          for (const std::string correction : {"none", "crack scaling"})
            expect_grown<2>(placement + ", " + form + ", " + treatment + ", " + correction,
                            square + Settings{{"Domain/Nodes", placement},
                                              {"Peridynamics/Operator form", form},
                                              {"Peridynamics/Boundary treatment", treatment},
                                              {"Boundary conditions/Dirichlet", "left: y"},
                                              {"Boundary conditions/Convection", "top: 2, 1"},
                                              {"Peridynamics/Surface correction", correction}},
                            growing,
                            at_end);
    for (const std::string direction : {"both", "y"})
      expect_grown<2>("energy, " + direction,
                      square + Settings{{"Material/Conductivity", "1 + x"},
                                        {"Peridynamics/Surface correction", "energy"},
                                        {"Peridynamics/Correction direction", direction}},
                      growing,
                      at_end);
    expect_grown<2>("slaves",
                    square + Settings{{"Boundary conditions/Flux", "bottom: 1"},
                                      {"Peridynamics/Flux treatment", "extrapolation"}},
                    growing,
                    at_end);
    for (const std::string correction : {"none", "crack scaling"})
      expect_grown<2>("finite elements, " + correction,
                      square + Settings{{"Peridynamics/Surface correction", correction}},
                      growing,
                      at_end,
                      ModelKind::finite_elements);
    const Settings block{{"Domain/Lower corner", "0, 0, 0"},
                         {"Domain/Upper corner", "1, 1, 1"},
                         {"Domain/Cells", "8, 8, 8"},
                         {"Cracks/Segments", ""},
                         {"Time/End time", "1"}},
      small{{"Cracks/Polygons", "0.3,0.3,0.44 ; 0.5,0.3,0.44 ; 0.5,0.6,0.44 ; 0.3,0.6,0.44"},
            {"Cracks/Growth", "2: 0, 0.3,0,0, 0.6 ; 3: 0, 0.3,0.1,0, 0.6"}},
      large{{"Cracks/Polygons", "0.3,0.3,0.44 ; 0.68,0.3,0.44 ; 0.68,0.66,0.44 ; 0.3,0.6,0.44"}};
    for (const ModelKind model : {ModelKind::peridynamics, ModelKind::finite_elements})
      expect_grown<3>("3D, " + to_string(model), block, small, large, model);
    expect_grown<3>("3D, energy",
                    block + Settings{{"Peridynamics/Surface correction", "energy"}},
                    small,
                    large);
  }


  TEST(CrackGrowth, heat_stays_through_every_cut)
  {
    const Settings graded{{"Domain/Cells", "48, 40"}, {"Domain/Coarsening", "2"}};
    // What a stepper does is the same on any number of processes.
    std::vector<std::string> steppers{"chebyshev", "sdirk2"};
    if (n_processes() == 1)
      steppers.insert(steppers.end(), {"euler", "rkc2"});
    for (const ModelKind model :
         {ModelKind::peridynamics, ModelKind::finite_elements, ModelKind::coupled})
      for (const std::string &stepper : steppers)
        {
          const bool       merged = model == ModelKind::coupled;
          const Problem<2> problem(square + growing + (merged ? graded : Settings()), model);
          Vector           start = problem.values(bumpy<2>);
          const double     heat  = problem.op().balance(start, 0., false).content;
          const Vector     u     = advanced(problem, stepper, 0.9);
          EXPECT_GT(largest_difference(start, u), 0.1);
          EXPECT_NEAR(problem.op().balance(u, 0.9, false).content,
                      heat,
                      (stepper == "sdirk2" ? 1e-8 : 1e-12) * std::abs(heat))
            << to_string(model) << ", " << stepper;
        }
  }


  TEST(CrackGrowth, same_on_every_number_of_processes)
  {
    // A capacity that lets explicit steps be long: some for each step of the cracks.
    const Settings held{{"Boundary conditions/Dirichlet", "left: y ; top: 2"},
                        {"Material/Heat capacity", "20"}};
    const auto gap = [&](const Settings &more, const ModelKind model, const std::string &stepper) {
      const Problem<2> all(square + growing + held + more, model),
        alone(square + growing + held + more, model, MPI_COMM_SELF);
      return difference(all, advanced(all, stepper, 0.9), alone, advanced(alone, stepper, 0.9));
    };
    for (const std::string stepper : {"euler", "chebyshev"})
      for (const std::string correction : {"none", "crack scaling", "energy"})
        EXPECT_EQ(
          gap({{"Peridynamics/Surface correction", correction}}, ModelKind::peridynamics, stepper),
          0.)
          << stepper << ", " << correction;
    EXPECT_EQ(
      gap({{"Cracks/Transmission", "if(t < 0.3, 0, t - 0.3)"}}, ModelKind::peridynamics, "euler"),
      0.);
    EXPECT_LE(gap({}, ModelKind::finite_elements, "chebyshev"), 1e-12);
    EXPECT_LE(gap({}, ModelKind::peridynamics, "sdirk2"), 1e-7);
  }


  TEST(CrackGrowth, a_crack_that_closes_conducts_again)
  {
    for (const ModelKind model : {ModelKind::peridynamics, ModelKind::finite_elements})
      {
        const Settings   crack{{"Cracks/Segments", "-0.1,0.52 ; 1.3,0.52"},
                             {"Boundary conditions/Dirichlet", "top: 1; bottom: 0"},
                             {"Time/End time", "1"}};
        const Problem<2> closing(square + crack +
                                   Settings{{"Cracks/Transmission", "max(0, min(1, 2*t - 1))"}},
                                 model),
          intact(square + crack + Settings{{"Cracks/Transmission", "1"}}, model);
        const Vector cut  = image(closing);
        const double size = intact.op().diagonal().linfty_norm();
        EXPECT_GT(largest_difference(cut, image(intact)), 0.05 * size);
        // A straight field: nothing passes the crack, then all that passes the body.
        Vector u = closing.values([](const Point<2> &p) { return p[1]; });
        EXPECT_EQ(closing.op().balance(u, 0., false).cracks.at(0), 0.);
        double previous = 0.;
        for (double t = 0.5; t < 1.; t = closing.op().next_event(t))
          {
            closing.op().update(t);
            const double heat = closing.op().balance(u, t, false).cracks.at(0);
            EXPECT_LT(heat, previous); // against the normal, which is up
            previous = heat;
          }
        // Transmission changes by at most 0.02 between events.
        EXPECT_LE(largest_difference(image(closing), image(intact)), 0.021 * size);
        const double through = intact.op().balance(u, 1., false).cracks.at(0);
        EXPECT_NEAR(through, -1.2, model == ModelKind::peridynamics ? 0.1 : 1e-12);
        EXPECT_NEAR(previous, through, 0.02 * 1.2);
      }
  }


  TEST(CrackGrowth, mistakes)
  {
    using SceneTests::expect_error;
    const auto expect = [&](const Settings &more, const std::vector<std::string> &parts) {
      Scene<2> scene;
      expect_error([&] { OperatorTests::set(scene, square + growing + more); }, parts);
    };
    expect({{"Cracks/Growth", "7: 0, 1,0"}},
           {"'Growth' in section 'Cracks'", "no end point 7", "1 to 4"});
    expect({{"Cracks/Growth", "2: 0, 1,0"}}, {"'Paths'", "named twice"});
    expect({{"Cracks/Growth", "1: 0, 1"}}, {"'Growth'", "2 components of a velocity"});
    expect({{"Cracks/Growth", "1: 0, 0,0"}}, {"'Growth'", "no velocity"});
    expect({{"Cracks/Growth", "1: -1, 1,0"}}, {"'Growth'", "before t = 0"});
    expect({{"Cracks/Growth", "1: 0.5, 1,0, 0.4"}}, {"'Growth'", "stops before it starts"});
    expect({{"Cracks/Growth", "1: 0, -1,0"}},
           {"'Growth'", "end point 1 has left the body at t = 1"});
    expect({{"Cracks/Paths", "2: 0, 0,0 | 1, 0.5,0.5"}},
           {"'Paths'", "begins at (0, 0)", "(0.31, 0.52)"});
    expect({{"Cracks/Paths", "2: 0, 0.31,0.52 | 0, 0.5,0.5"}}, {"'Paths'", "ascend"});
    expect({{"Cracks/Paths", "2: 0, 0.31,0.52"}}, {"'Paths'", "no position to go to"});
    expect({{"Cracks/Paths", "2: 0, 0.31,0.52 | 0.3, 0.6,0.52 | 0.6, 0.4,0.52"}},
           {"'Paths'", "end point 2 turns back at (0.6, 0.52)"});
    expect({{"Cracks/Growth", "4: 0, -0.02,-0.7, 0.5"}},
           {"'Growth'", "end point 4 turns back at (0.72, 0.83)"});
    for (const std::string path : {"2: 0, 0.5,0.3,0.4 | 0.5, 0.7,0.3,0.4 | 1, 0.4,0.3,0.4",
                                   "2: 0, 0.5,0.3,0.4 | 1, 0.4,0.4,0.4"})
      {
        Scene<3> scene;
        expect_error(
          [&] {
            OperatorTests::set(scene,
                               {{"Cracks/Polygons", "0.3,0.3,0.4 ; 0.5,0.3,0.4 ; 0.5,0.6,0.4"},
                                {"Cracks/Paths", path}});
          },
          {"'Paths'", "corner 2 moves into its polygon"});
      }
    expect({{"Cracks/Growth", ""}, {"Cracks/Paths", ""}}, {"'Segments'", "no length", "Growth"});
    expect({{"Cracks/Mesh", "faces"}}, {"'Mesh' in section 'Cracks'", "pairs"});
    expect({{"Time/Stepper", "euler"}, {"Time/Time step", "0.3"}},
           {"'Paths'", "advances by", "'Time step'"});
    expect({{"Cracks/Growth step", "1e-9"}}, {"'Paths'", "events", "larger"});
    expect({{"Cracks/Growth step", "0"}}, {"'Growth step'", "greater than 0"});
    expect({{"Time/Steady", "true"}, {"Boundary conditions/Dirichlet", "left: 0"}},
           {"'Growth'", "'Steady'"});
    expect({{"Cracks/Transmission", "2*t"}}, {"'Transmission'", "2*t", "from 0 to 1"});
    // Between the first samples, and more often than there may be events.
    expect({{"Cracks/Transmission", "2*exp(-((t - 0.50390625)/0.001)^2)"}},
           {"'Transmission'", "at t = 0.50390625", "from 0 to 1"});
    expect({{"Cracks/Transmission", "0.5 + 0.5*sin(1e9*t)"}}, {"'Transmission'", "events"});
    expect({{"Cracks/Transmission", "x"}}, {"'Transmission'", "time t only"});
    expect({{"Cracks/Transmission", "-1"}}, {"'Transmission'", "from 0 to 1"});
    // The last of four cracks around a node.
    for (const ModelKind model : {ModelKind::peridynamics, ModelKind::finite_elements})
      expect_error(
        [&] {
          const Problem<2> problem(
            square +
              Settings{
                {"Cracks/Segments",
                 "0.58,-1 ; 0.58,2 ; 0.62,-1 ; 0.62,2 ; -1,0.48 ; 2,0.48 ; 0.2,0.52 ; 0.3,0.52"},
                {"Cracks/Growth", "8: 0, 0.6,0"},
                {"Time/End time", "1"}},
            model);
          grow(problem.op());
        },
        {"node at (0.6, 0.5)", "'Cracks'"});
    // A node between cracks has no bond upwards or downwards.
    expect_error(
      [] {
        Problem<2>(square + Settings{{"Cracks/Segments", "-1,0.48 ; 2,0.48 ; -1,0.52 ; 2,0.52"},
                                     {"Peridynamics/Surface correction", "energy"}});
      },
      {"'Surface correction = energy'", "'Peridynamics'", "no bond left", "y"});
  }
} // namespace PeriDeal
