// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <algorithm>
#include <cmath>

#include "elastic_coupling_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;
using dealii::Point;
using dealii::Tensor;

namespace
{
  constexpr double height = 0.34375; // of the crack in the middle of the body


  /** A free box that a crack cuts right through across its second axis, at an angle in 2D. */
  template <int dim>
  Settings parted(const double nu, const double slope = 0.)
  {
    Settings   settings = box<dim>() + Settings{{"Boundary conditions/Displacement", ""},
                                              {"Elasticity/Solver", "dynamics"},
                                              {"Elasticity/Contact", "true"},
                                              {"Material/Density", "1"},
                                              {"Material/Poisson ratio", std::to_string(nu)}};
    const auto at = [&](const double x) { return std::to_string(height + slope * (x - 0.5)); };
    settings.push_back(
      dim == 2 ?
        std::pair<std::string, std::string>("Cracks/Segments", "-1," + at(-1.) + " ; 2," + at(2.)) :
        std::pair<std::string, std::string>(
          "Cracks/Polygons",
          "-1,0.3125,-1 ; 2,0.3125,-1 ; 2,0.3125,2 ; -1,0.3125,2"));
    return settings;
  }


  template <int dim>
  bool is_above(const Point<dim> &p, const double slope = 0.)
  {
    return p[1] > (dim == 2 ? height + slope * (p[0] - 0.5) : 0.3125);
  }


  /** What acts on the body at u, of no loads. */
  template <int dim>
  Vector forces_at(const Body<dim> &body, const Vector &u)
  {
    body.op().update_contact(u);
    return body.unbalanced(u);
  }


  /** The part above moves by this, that below stands still. */
  template <int dim>
  Vector moved(const Body<dim> &body, const Tensor<1, dim> &by, const double slope = 0.)
  {
    return body.values(
      [&](const Point<dim> &p) { return is_above(p, slope) ? by : Tensor<1, dim>(); });
  }


  /** Sum of a component over the nodes above. */
  template <int dim>
  double sum_above(const Body<dim> &body, const Vector &r, const unsigned int d)
  {
    double sum = 0.;
    for (unsigned int i = 0; i < r.locally_owned_size() / dim; ++i)
      if (is_above(body.position(i)))
        sum += r.local_element(dim * i + d);
    return sum_of_all(sum);
  }


  /** The largest component at nodes more than two horizons off the sides that the crack meets. */
  template <int dim>
  double largest_inside(const Body<dim> &body, const Vector &r)
  {
    double largest = 0.;
    for (unsigned int k = 0; k < r.locally_owned_size(); ++k)
      if (std::abs(body.position(k / dim)[0] - 0.5) < 0.1)
        largest = std::max(largest, std::abs(r.local_element(k)));
    return max_of_all(largest);
  }


  template <int dim>
  void check_faces(const ModelKind model, const double nu)
  {
    const Body<dim> body(parted<dim>(nu), model);
    Tensor<1, dim>  normal, tangent;
    normal[1]  = 1e-3;
    tangent[0] = 1e-3;
    if (dim == 3)
      tangent[2] = 2e-3;
    const Vector pressed = moved(body, -1. * normal), forces = forces_at(body, pressed);
    const double most = forces.linfty_norm();
    ASSERT_GT(most, 0.);
    EXPECT_GT(sum_above(body, forces, 1), 0.); // pushed back
    EXPECT_LT(std::abs(sum_above(body, forces, 0)), 1e-10 * sum_above(body, forces, 1));
    for (const Vector &motion : body.op().near_null_space())
      EXPECT_LT(std::abs(motion * forces), 1e-12 * motion.linfty_norm() * forces.l1_norm());
    // Neither what opens nor what slides or turns as a whole feels anything.
    EXPECT_LT(forces_at(body, moved(body, normal)).linfty_norm(), 1e-12 * most);
    const Vector slid = forces_at(body, moved(body, tangent));
    if (dim == 2)
      {
        EXPECT_LT(largest_inside(body, slid), 3e-4 * most); // normals are smoothed from sides on
      }
    EXPECT_LT(slid.linfty_norm(), 0.1 * most); // beside sides families are cut
    for (Vector motion : body.op().near_null_space())
      {
        motion *= 1e-3 / motion.linfty_norm();
        EXPECT_LT(forces_at(body, motion).linfty_norm(), 1e-9 * most);
        motion *= -1.;
        EXPECT_LT(forces_at(body, motion).linfty_norm(), 1e-9 * most);
      }
  }


  /** Forces are those of the energy, where it is that of the nodes that touch. */
  template <int dim>
  void check_energy(const ModelKind model)
  {
    const Settings  warm{{"Material/Thermal expansion", "1e-3"},
                        {"Elasticity/Temperature change", "0.01"}};
    const Body<dim> body(parted<dim>(0.25) + warm, model);
    Tensor<1, dim>  by;
    by[1]          = -1e-3;
    const Vector u = moved(body, by), r = forces_at(body, u);
    Vector       way = body.values(bumpy_vector<dim>);
    way *= 1e-5 / way.linfty_norm();
    Vector forth(u), back(u);
    forth += way;
    back -= way;
    const double gain = 0.5 * (body.op().energy(forth) - body.op().energy(back));
    EXPECT_NEAR(gain / (-1. * (r * way)), 1., 1e-8);
    // A warm body is free: faces are as far from each other as they want to be.
    const Vector free = body.values([](const Point<dim> &p) { return Tensor<1, dim>(1e-5 * p); });
    EXPECT_LT(forces_at(body, free).linfty_norm(), 1e-9 * r.linfty_norm());
  }


  /** Of bonds that broke as the part above was torn off, along a wavy line. */
  void check_broken_faces(const ModelKind model, const double slope)
  {
    const auto is_off = [&](const Point<2> &p) {
      return p[1] > height + slope * (p[0] - 0.5) + 0.02 * std::sin(9. * p[0]);
    };
    const Tensor<1, 2> along  = Point<2>(1., slope) / std::hypot(1., slope),
                       across = Point<2>(-slope, 1.) / std::hypot(1., slope);
    Settings settings         = parted<2>(0.25);
    settings.pop_back();
    settings.push_back({"Material/Critical stretch", "0.01"});
    if (model == ModelKind::coupled)
      settings.push_back({"Coupling/Zone", "everywhere"});
    Body<2>    body(settings, model);
    const auto displaced = [&](const Tensor<1, 2> &by) {
      return body.values([&](const Point<2> &p) { return is_off(p) ? by : Tensor<1, 2>(); });
    };
    ASSERT_GT(body.op().break_bonds(displaced(0.1 * across), 0.), 0U);
    const double pressed = forces_at(body, displaced(-1e-3 * across)).l1_norm();
    EXPECT_GT(pressed, 0.);
    EXPECT_LT(forces_at(body, displaced(1e-3 * across)).l1_norm(), 1e-2 * pressed);
    for (const double way : {1e-3, -1e-3})
      EXPECT_LT(forces_at(body, displaced(way * along)).l1_norm(), 0.2 * pressed);
  }


  /** Of a body that is pressed: what goes through the crack over what does without one. */
  template <int dim>
  void check_pressure(const ModelKind model, const double nu)
  {
    const auto field = [](const Point<dim> &p) {
      Tensor<1, dim> u;
      u[1] = -1e-3 * p[1];
      return u;
    };
    Settings whole = parted<dim>(nu);
    whole.pop_back();
    if (model == ModelKind::coupled)
      whole.push_back({"Coupling/Zone", "everywhere"});
    const Body<dim> body(parted<dim>(nu), model), intact(whole, model);
    const Vector    u = body.values(field), v = intact.values(field);
    const double    share =
      sum_above(body, forces_at(body, u), 1) / sum_above(intact, forces_at(intact, v), 1);
    EXPECT_GT(share, 0.4);
    // q of nodes beside a crack is that of what is left, which makes peridynamics stiffer there.
    const bool alone = model == ModelKind::peridynamics;
    EXPECT_LT(share, alone ? 1.05 : 1.0);
    EXPECT_LT(body.op().energy(u), (alone ? 1.15 : 1.) * intact.op().energy(v));
    const Body<dim> open(parted<dim>(nu) + Settings{{"Elasticity/Contact", "false"}}, model);
    EXPECT_GT(body.op().energy(u), open.op().energy(u));
    EXPECT_LT(std::abs(sum_above(open, forces_at(open, u), 1)),
              1e-12 * forces_at(open, u).l1_norm());
  }
} // namespace


TEST(CrackContact, PressedFacesPushBackAndSlideFreely)
{
  for (const ModelKind model : {ModelKind::peridynamics, ModelKind::coupled})
    {
      check_faces<2>(model, 0.);
      check_faces<2>(model, 0.4);
      check_faces<3>(model, 0.25);
    }
}


TEST(CrackContact, ForcesFollowFromTheEnergy)
{
  for (const ModelKind model : {ModelKind::peridynamics, ModelKind::coupled})
    {
      check_energy<2>(model);
      check_energy<3>(model);
    }
}


TEST(CrackContact, PressureGoesThroughAndTheBodyIsNoStiffer)
{
  for (const ModelKind model : {ModelKind::peridynamics, ModelKind::coupled})
    {
      check_pressure<2>(model, 0.);
      check_pressure<2>(model, 1. / 3.);
      check_pressure<3>(model, 0.25);
    }
}


/** A crack that bonds have left follows rows and leaps from one to another. */
TEST(CrackContact, FacesOfBrokenBondsPressAndHardlyHold)
{
  for (const ModelKind model : {ModelKind::peridynamics, ModelKind::coupled})
    for (const double slope : {0., 0.12, 0.45})
      check_broken_faces(model, slope);
}


/** The normal of an oblique crack is known to some degrees: sliding is felt that much. */
TEST(CrackContact, ObliqueFacesSlideNearlyFreely)
{
  for (const ModelKind model : {ModelKind::peridynamics, ModelKind::coupled})
    for (const double slope : {0.2, 0.45})
      {
        const Body<2>      body(parted<2>(0.25, slope), model);
        const Tensor<1, 2> along  = Point<2>(1., slope) / std::hypot(1., slope),
                           across = Point<2>(slope, -1.) / std::hypot(1., slope);
        const double pressed      = forces_at(body, moved<2>(body, 1e-3 * across, slope)).l1_norm();
        EXPECT_LT(forces_at(body, moved<2>(body, 1e-3 * along, slope)).l1_norm(), 0.1 * pressed);
        EXPECT_LT(forces_at(body, moved<2>(body, -1e-3 * along, slope)).l1_norm(), 0.1 * pressed);
        EXPECT_LT(forces_at(body, moved<2>(body, -1e-3 * across, slope)).l1_norm(),
                  1e-2 * pressed); // nodes beside sides
      }
}
