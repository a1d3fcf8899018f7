// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Kinds that the program does not have, known to all of it by their lines in the list.

#include <perideal/problems/check_sides.h>
#include <perideal/problems/diffusion_problem.h>
#include <perideal/scene/lists.h>

#include <nlohmann/json.hpp>

#include "elastic_scene_tools.h"
#include "operator_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using namespace SceneTests;
  using dealii::Point;

  namespace
  {
    using Body = OperatorTests::Problem<2>;

    const std::string bc = "Boundary conditions";

    double number(const Expression &formula)
    {
      return formula.value(Point<1>());
    }


    class SurfaceTransfers : public testing::Test
    {
    protected:
      SurfaceTransfers()
      {
        transfer_kinds().push_back({"Contact layer",
                                    "",
                                    "",
                                    {"conductivity", "thickness", "ambient value"},
                                    "contact layer",
                                    true,
                                    [](SurfaceTransfer &transfer, const std::string &where) {
                                      const auto &given = transfer.formulas;
                                      if (!(number(given[1]) > 0.))
                                        entry_error(where, "the layer has no thickness.");
                                      transfer.coefficient = number(given[0]) / number(given[1]);
                                      transfer.ambient     = given[2];
                                    }});
        transfer_kinds().push_back({"Lamp",
                                    "",
                                    "",
                                    {"power", "area"},
                                    "lamp",
                                    false,
                                    [](SurfaceTransfer &transfer, const std::string &) {
                                      const auto &given = transfer.formulas;
                                      transfer.flux     = number(given[0]) / number(given[1]);
                                    }});
      }

      ~SurfaceTransfers() override
      {
        transfer_kinds().pop_back();
        transfer_kinds().pop_back();
      }
    };


    /** The same loads, matrix and balance, to the last bit. */
    void expect_same(const Settings &settings, const Settings &other, const ModelKind model)
    {
      const Settings plate{{"Domain/Cells", "12, 10"},
                           {bc + "/Dirichlet", "left: 1"},
                           {bc + "/Parts", "half: top if x < 0.53 ; core: region x > 0.7"}};
      const Body     a(plate + settings, model), b(plate + other, model);
      Vector         u = a.values(bumpy<2>);
      a.op().distribute(u, 0.3);
      const Vector r = a.residual(u, 0.3);
      EXPECT_GT(r.l2_norm(), 0.);
      EXPECT_EQ(largest_difference(r, b.residual(u, 0.3)), 0.);
      EXPECT_EQ(largest_difference(a.op().diagonal(), b.op().diagonal()), 0.);
      EXPECT_EQ(a.op().entering(), b.op().entering());
      EXPECT_EQ(a.op().balance(u, 0.3, false).sides, b.op().balance(u, 0.3, false).sides);
    }
  } // namespace


  TEST_F(SurfaceTransfers, both_models_and_the_balance)
  {
    const Settings layer{{bc + "/Contact layer", "right: 2, 0.5, 3*t ; half: 1, 4, y"}},
      convection{{bc + "/Convection", "right: 4, 3*t ; half: 0.25, y"}},
      lamp{{bc + "/Lamp", "bottom: 6, 2 ; core: 10, 2"}},
      flux{{bc + "/Flux", "bottom: 3 ; core: 5"}},
      extrapolated{{"Peridynamics/Flux treatment", "extrapolation"}};
    for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
      expect_same(layer + lamp, convection + flux, model);
    expect_same(extrapolated + Settings{{bc + "/Lamp", "bottom: 6, 2"}},
                extrapolated + Settings{{bc + "/Flux", "bottom: 3"}},
                ModelKind::peridynamics);
    HeatParameters<2> body;
    body.boundary_conditions.let_in("Contact layer", 1, {2., 0.5, 3.});
    EXPECT_EQ(body.boundary_conditions.transfers[0].entering(Point<2>(), 0., 1.), 8.);
  }


  TEST_F(SurfaceTransfers, summary)
  {
    const Body             body(Settings{{"Domain/Cells", "4, 4"},
                             {bc + "/Contact layer", "right: 2, 0.5, 3*t"},
                             {bc + "/Lamp", "bottom: 6, 2 ; right: 0, 1"}},
                    ModelKind::finite_elements);
    nlohmann::ordered_json summary;
    Model<2>               model(ModelKind::finite_elements, *body.mesh);
    DiffusionProblem<2>(make_diffusion_field(model, body.scene)).describe_scene(summary, true);
    EXPECT_EQ(summary["sides"]["right"], "contact layer 2, 0.5, 3*t");
    EXPECT_EQ(summary["sides"]["bottom"], "lamp 6, 2");
    EXPECT_EQ(summary["sides"]["top"], "insulated");
  }


  TEST_F(SurfaceTransfers, slopes)
  {
    HeatParameters<2> body;
    auto             &sides   = body.boundary_conditions;
    const auto        formula = [](const std::string &text) {
      return Expression(text, "", "x, y, z, t, T", true);
    };
    const Expression of_T = formula("0.2 + 1e-4*T"), flux = formula("1e3 - exp(T/100)"),
                     roots = formula("1e3*sqrt(T)");
    sides.absolute_zero    = -20.;
    sides.let_in("Radiation", 0, {of_T, 400.});
    sides.let_in("Flux", 1, {flux});
    sides.let_in("Convection", 2, {of_T, roots});
    const Point<2> p(0.3, 0.7);
    for (const SurfaceTransfer &side : sides.transfers)
      for (const double T : {10., 250., 900.})
        {
          const double d = 1e-3,
                       growth =
                         (side.entering(p, 0., T + d) - side.entering(p, 0., T - d)) / (2. * d);
          EXPECT_TRUE(side.depends_on_temperature() && side.fixes_level());
          EXPECT_NEAR(side.slope(p, 0., T, false), std::max(0., -growth), 1e-6 * std::abs(growth));
        }
    const double sigma = 5.670374419e-8;
    EXPECT_NEAR(sides.transfers[0].slope(p, 0., -20., true), // of the chord
                0.198 * sigma * std::pow(420., 3) - 1e-4 * sigma * std::pow(420., 4),
                1e-9);
    EXPECT_EQ(sides.transfers[0].slope(p, 0., -20., false), 0.);
    EXPECT_EQ(roots.slope(p, 0., 0.), roots.value(p, 0., 1e-5) / 1e-5); // on one side
    EXPECT_EQ(sides.transfers[0].fault(p, 0., 30.), "");
    expect_parts(sides.transfers[0].fault(p, 0., -21.),
                 {"'Radiation'", "-21", "'Absolute zero'", "-20"});
    EXPECT_EQ(sides.transfers[0].fault(p, 0., -21., 2.), "");
    expect_parts(sides.transfers[0].fault(p, 0., 1e4),
                 {"'Radiation'", "emissivity", "1.2", "from 0 to 1"});
  }


  /** K is the tangent of the residual, which at the temperatures that were taken is that of q. */
  TEST_F(SurfaceTransfers, tangents)
  {
    const Settings plate{{"Domain/Cells", "9, 8"},
                         {"Material/Conductivity", "2"},
                         {bc + "/Parts", "half: top if x < 0.53"},
                         {bc + "/Dirichlet", "left: 300"},
                         {bc + "/Radiation", "right: 0.9, 400 + 10*t ; half: 0.3 + 1e-4*T, 200"},
                         {bc + "/Flux", "bottom: -T^2/100 + x"},
                         {"Initial and source/Source", "5 - T - 1e-3*T^2"}};
    for (const auto &[model, more] :
         {std::make_pair(ModelKind::finite_elements, Settings()),
          std::make_pair(ModelKind::peridynamics, Settings()),
          std::make_pair(ModelKind::coupled, Settings{{"Coupling/Zone", "x - 0.4"}})})
      {
        const Body body(plate + more, model);
        const auto field = [](const double size) {
          return [size](const Point<2> &p) { return 300. + size * p[0] * std::cos(3. * p[1]); };
        };
        const double t = 0.4, d = 1e-3;
        const auto   residual = [&](const double size) {
          Vector u = body.values(field(size));
          body.op().distribute(u, t);
          body.op().take_material_at(u, t);
          return body.residual(u, t);
        };
        Vector       change = residual(50. + d);
        const Vector before = residual(50. - d);
        change -= before;
        change /= -2. * d;
        Vector direction =
          body.values([](const Point<2> &p) { return p[0] * std::cos(3. * p[1]); });
        body.op().distribute_homogeneous(direction);
        residual(50.);
        EXPECT_LT(largest_difference(body.product(direction), change), 1e-6 * change.linfty_norm());
        // What has entered is what the balance of q says.
        Vector u = body.values(field(50.));
        body.op().distribute(u, t);
        const Balance balance = body.op().balance(u, t, false);
        body.residual(u, t);
        double entering = balance.sources;
        for (const auto &[name, value] : balance.sides)
          entering += value;
        EXPECT_NEAR(dealii::Utilities::MPI::sum(body.op().entering(), MPI_COMM_WORLD),
                    entering,
                    1e-9 * std::abs(balance.sources));
        EXPECT_NEAR(balance.imbalance(), 0., 1e-9 * std::abs(balance.sources));
      }
  }


  TEST_F(SurfaceTransfers, checks)
  {
    const std::string steady = "subsection Time\nset Steady = true\nend\nsubsection " + bc + "\n";
    EXPECT_EQ(fault(steady + "set Contact layer = left: 2, 0.5, 3\nend\n"), "");
    expect_fault(fault(steady + "set Contact layer = left: 2, 0.5, t\nend\n"),
                 bc,
                 "Contact layer",
                 {"depends on t"});
    expect_fault(fault(steady + "set Lamp = left: 2, 1\nend\n"),
                 "Time",
                 "Steady",
                 {"'Dirichlet' or 'Convection' or 'Radiation' or 'Contact layer' (section"});
    expect_fault(fault(bc, "Contact layer = left: 2, 1"),
                 bc,
                 "Contact layer",
                 {"needs 3 formulas: conductivity, thickness, ambient value."});
    expect_fault(fault(bc, "Contact layer = left: 2, 0, 1"), bc, "Contact layer", {"no thickness"});
    expect_fault(fault(bc, "Contact layer = left: -2, 4, 1"),
                 bc,
                 "Contact layer",
                 {"the coefficient -0.5 is negative"});
    for (const std::string other : {"Dirichlet = left: 1", "Symmetry = left"})
      for (const std::string kind : {"Contact layer", "Lamp"})
        expect_fault(
          fault(bc, other + " & " + kind + " = left: 2, 4" + (kind == "Lamp" ? "" : ", 1")),
          bc,
          kind,
          {"which contradicts it"});
    const std::string parts = "Parts = core: region x > 0.5 & ";
    EXPECT_EQ(fault(bc, parts + "Lamp = core: 2, 4"), "");
    expect_fault(fault(bc, parts + "Contact layer = core: 2, 4, 1"), bc, "Contact layer", {"area"});
    expect(elastic_fault({bc + "/Lamp=top: 1, 2"}), bc + "/Lamp", {"Use 'Traction'"});
    expect(elastic_fault({bc + "/Contact layer=top: 1, 2, 3"}),
           bc + "/Contact layer",
           {"'Displacement' or 'Traction'"});
    const Body body(Settings{{"Domain/Cells", "4, 4"},
                             {bc + "/Parts", "a: top if x < 0.7 ; b: top if x > 0.3"},
                             {bc + "/Contact layer", "a: 2, 0.5, 3 ; b: 2, 0.5, 1"}},
                    ModelKind::finite_elements);
    expect_parts(message_of([&] { check_sides(body.scene, *body.mesh); }),
                 {"'Contact layer'", "'b' overlaps 'a'", "loads are not added"});
  }
} // namespace PeriDeal
