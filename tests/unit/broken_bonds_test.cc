// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Diffusion follows what a solid on the same nodes breaks.

#include <deal.II/base/mpi.h>

#include "operator_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  const Settings square{{"Domain/Lower corner", "0, 0"},
                        {"Domain/Upper corner", "1, 1"},
                        {"Domain/Cells", "12, 12"},
                        {"Boundary conditions/Dirichlet", "left: 1; right: 0"},
                        {"Time/End time", "1"}};

  // It ends inside a cell, and lies between rows of nodes.
  const Settings cracked{{"Cracks/Segments", "0,0.53 ; 0.62,0.46"}};


  /** Some bonds of owned nodes, chosen(node, bond), as if they had broken. */
  template <int dim, typename Chosen>
  ChangeSet<dim> damage_of(const Families<dim> &families, const Chosen &chosen)
  {
    ChangeSet<dim>                              damage;
    std::vector<typename Families<dim>::Member> members;
    std::vector<NodePair>                       own;
    std::vector<dealii::Point<dim>>             places;
    const Nodes<dim>                           &nodes = families.nodes();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        families.members_of(i, members);
        for (const auto &bond : members)
          if (chosen(i, bond))
            {
              const auto a = nodes.partitioner()->local_to_global(i),
                         b = nodes.partitioner()->local_to_global(bond.neighbor);
              own.push_back({std::min(a, b), std::max(a, b)});
              places.push_back(nodes.position(i));
            }
      }
    for (const auto &list : dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, own))
      damage.broken.insert(damage.broken.end(), list.begin(), list.end());
    for (const auto &list : dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, places))
      for (const auto &p : list)
        damage.cuts.push_back(dealii::BoundingBox<dim>({p, p}));
    std::sort(damage.broken.begin(), damage.broken.end());
    damage.damage = true;
    return damage;
  }


  /** All bonds that the cracks of a problem cut, each told by one of its ends. */
  template <int dim>
  ChangeSet<dim> as_damage(const Families<dim> &families)
  {
    const auto &layout = *families.nodes().partitioner();
    return damage_of(families, [&](const unsigned int i, const auto &bond) {
      return bond.kept == 0. && layout.local_to_global(i) < layout.local_to_global(bond.neighbor);
    });
  }


  /** A problem whose bonds conduct nothing once they have broken. */
  template <int dim>
  struct Following : Problem<dim>
  {
    explicit Following(const Settings &settings, const ModelKind model = ModelKind::peridynamics)
      : Problem<dim>(settings, model)
    {
      Scene<dim> &scene          = this->scene;
      scene.broken_bonds_conduct = 0.;
      this->field.reset();
      const bool alone = model == ModelKind::peridynamics;
      this->nodes      = std::make_unique<Nodes<dim>>(this->handler,
                                                 scene.domain,
                                                 scene.cracks,
                                                 alone ? scene.peridynamics.sampling.nodal_volume :
                                                              NodalVolume::partial);
      if (alone)
        this->field = field_of_bonds(*this->nodes, scene);
      else
        this->field =
          field_of_elements<dim>(this->handler,
                                 scene,
                                 make_coupling(*this->nodes,
                                               scene,
                                               Zone<dim>(scene.coupling, scene.horizon()),
                                               CouplingScheme::exchange));
    }
  };


  template <int dim>
  const Families<dim> &families_of(const Problem<dim> &problem)
  {
    const auto &term = problem.op().first_term();
    if (const auto *const cells = dynamic_cast<const CellTerm<dim> *>(&term))
      return cells->bonds().families();
    return bonds_of(problem.op()).diffusion_bonds().families();
  }


  /** K x of a body that breaks, and of one that had the crack from the start. */
  double gap(const Problem<2> &whole, const Problem<2> &cut, const std::function<bool()> &follow)
  {
    const Vector x = whole.values(bumpy<2>), expected = cut.product(x);
    EXPECT_GT(largest_difference(whole.product(x), expected), 1e-2);
    EXPECT_TRUE(follow());
    EXPECT_LT(largest_difference(whole.op().diagonal(), cut.op().diagonal()),
              1e-12 * expected.linfty_norm());
    return relative_difference(whole.product(x), expected);
  }


  TEST(BrokenBonds, are_as_a_crack_for_bonds_alone)
  {
    for (const std::string form : {"lattice", "stored"})
      for (const std::string nodes : {"vertices", "cell centers"})
        {
          const Settings     settings = square + Settings{{"Domain/Nodes", nodes},
                                                      {"Peridynamics/Boundary treatment", "none"},
                                                      {"Peridynamics/Operator form", form}};
          const Following<2> whole(settings);
          const Problem<2>   cut(settings + cracked);
          const auto         damage = as_damage(families_of(cut));
          EXPECT_GT(damage.broken.size(), 50u);
          EXPECT_LT(gap(whole, cut, [&] { return whole.op().follow(damage); }), 1e-14)
            << form << ", " << nodes;
        }
  }


  TEST(BrokenBonds, come_in_steps_beside_a_crack)
  {
    const Settings shorter{{"Cracks/Segments", "0,0.53 ; 0.3,0.504838709677419"}};
    for (const std::string form : {"lattice", "stored"})
      {
        const Settings     settings = square + Settings{{"Peridynamics/Boundary treatment", "none"},
                                                    {"Peridynamics/Operator form", form}};
        const Following<2> whole(settings + shorter);
        const Problem<2>   cut(settings + cracked);
        const auto         damage = as_damage(bonds_of(cut.op()).diffusion_bonds().families());
        const auto         follow = [&] {
          for (std::size_t k = 0; k < damage.broken.size(); k += 40)
            {
              const std::size_t end  = std::min(k + 40, damage.broken.size());
              ChangeSet<2>      some = damage;
              some.broken.assign(damage.broken.begin() + k, damage.broken.begin() + end);
              EXPECT_TRUE(whole.op().follow(some));
            }
          return true;
        };
        EXPECT_LT(gap(whole, cut, follow), 1e-14) << form;
      }
  }


  TEST(BrokenBonds, are_as_a_crack_for_exchanged_bonds_and_their_cells)
  {
    for (const std::string zone : {"everywhere", "0.8 - x"})
      {
        const Settings settings =
          square + Settings{{"Coupling/Zone", zone}, {"Peridynamics/Horizon ratio", "3"}};
        const Following<2> whole(settings, ModelKind::coupled);
        const Problem<2>   cut(settings + cracked, ModelKind::coupled);
        const auto         damage = as_damage(families_of(cut));
        EXPECT_LT(gap(whole, cut, [&] { return whole.op().follow(damage); }), 1e-12) << zone;
      }
  }


  /**
   * What flows at rest through a body in which all bonds across a crack have broken, over that with
   * the crack in the scene, less one; the crack makes it less by a percent and more.
   */
  template <int dim>
  double excess_of_heat(const Settings &settings, const Settings &crack, const ModelKind model)
  {
    const std::string    side = dim == 2 ? "top" : "front";
    const Following<dim> made(settings, model);
    const Problem<dim>   given(settings + crack, model);
    const auto           heat = [&](const Problem<dim> &problem) {
      return problem.op().balance(problem.steady(), 0., true).sides.at(side);
    };
    const double whole = heat(made), expected = heat(given);
    EXPECT_LT(expected, 0.99 * whole);
    EXPECT_TRUE(made.op().follow(as_damage(families_of(given))));
    return heat(made) / expected - 1.;
  }


  TEST(BrokenBonds, let_through_as_much_heat_as_a_crack)
  {
    const Settings box{{"Domain/Lower corner", "0, 0, 0"},
                       {"Domain/Upper corner", "0.8, 0.7, 0.6"},
                       {"Domain/Cells", "8, 7, 6"},
                       {"Peridynamics/Horizon ratio", "2"},
                       {"Boundary conditions/Dirichlet", "back: 0; front: 1"},
                       {"Time/End time", "1"}};
    const Settings across{{"Boundary conditions/Dirichlet", "bottom: 0; top: 1"}};
    const Settings plain{{"Peridynamics/Surface correction", "none"}};
    const Settings alone{{"Peridynamics/Boundary treatment", "none"}};
    const Settings beside{{"Coupling/Zone", "everywhere"}};
    const Settings disc{{"Cracks/Polygons", "disc: 0.4, 0.35, 0.35, 0, 0, 1, 0.23"}};
    const Settings quad{
      {"Cracks/Polygons", "0.15,0.15,0.25 ; 0.55,0.15,0.25 ; 0.55,0.55,0.25 ; 0.15,0.55,0.25"}};
    for (const ModelKind model : {ModelKind::peridynamics, ModelKind::coupled})
      {
        const Settings more = plain + (model == ModelKind::coupled ? beside : alone);
        EXPECT_LT(std::abs(excess_of_heat<2>(square + across + more, cracked, model)), 1e-3);
        for (const Settings &crack : {disc, quad})
          EXPECT_LT(std::abs(excess_of_heat<3>(box + more, crack, model)), 1e-3);
      }
  }


  /**
   * Largest change of K x, x even about x = 0.5, by breaking the bond at y = 0.5 from the crack in
   * the mesh at x = 0.5 to the next node on one side.
   */
  double change_beside_faces(const double side)
  {
    const Following<2>    body(square + Settings{{"Cracks/Segments", "0.5,0.25 ; 0.5,0.75"},
                                              {"Cracks/Mesh", "faces"},
                                              {"Coupling/Zone", "everywhere"}},
                            ModelKind::coupled);
    const Nodes<2>       &nodes = *body.nodes;
    std::vector<NodePair> ends{{0, 0}};
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const dealii::Point<2> p = nodes.position(i), beside = nodes.crack_point(i);
        if (std::abs(p[1] - 0.5) > 1e-9)
          continue;
        if (std::abs(p[0] - 0.5) < 1e-9 && side * (beside[0] - 0.5) > 0.)
          ends[0][0] = nodes.partitioner()->local_to_global(i);
        if (std::abs(p[0] - 0.5 - side / 12.) < 1e-9)
          ends[0][1] = nodes.partitioner()->local_to_global(i);
      }
    for (auto &node : ends[0])
      node = max_of_all(node);
    ChangeSet<2> damage;
    damage.damage = true;
    damage.broken = {{std::min(ends[0][0], ends[0][1]), std::max(ends[0][0], ends[0][1])}};
    for (const double x : {0.5, 0.5 + side / 12.})
      damage.cuts.push_back(
        dealii::BoundingBox<2>({dealii::Point<2>(x, 0.5), dealii::Point<2>(x, 0.5)}));
    const Vector x      = body.values([](const dealii::Point<2> &p) {
      return std::cos(3. * (p[0] - 0.5)) + std::abs(p[0] - 0.5) * (1. + p[1]);
    });
    const Vector before = body.product(x);
    EXPECT_TRUE(body.op().follow(damage));
    return largest_difference(body.product(x), before);
  }


  TEST(BrokenBonds, do_the_same_on_both_sides_of_a_crack_in_the_mesh)
  {
    const double left = change_beside_faces(-1.), right = change_beside_faces(1.);
    EXPECT_GT(left, 1e-3);
    EXPECT_NEAR(left, right, 1e-12);
  }


  /** All bonds of the node at a point. */
  ChangeSet<2> freeing(const Families<2> &families, const dealii::Point<2> &p)
  {
    return damage_of(families, [&](const unsigned int i, const auto &) {
      return families.nodes().position(i).distance(p) < 0.01;
    });
  }


  TEST(BrokenBonds, of_a_node_that_is_free_and_a_crack_that_grows_past)
  {
    const Settings         start{{"Cracks/Segments", "0,0.53 ; 0.3,0.505"},
                         {"Cracks/Growth", "2: 0, 0.5,-0.04, 0.7"}};
    const Settings         grown{{"Cracks/Segments", "0,0.53 ; 0.65,0.477"}};
    const dealii::Point<2> free(5. / 12., 0.5);
    for (const auto &[more, model] :
         {std::make_pair(Settings{{"Peridynamics/Boundary treatment", "none"}},
                         ModelKind::peridynamics),
          std::make_pair(Settings{{"Coupling/Zone", "0.9 - x"}}, ModelKind::coupled)})
      {
        const Settings settings = square + more +
                                  Settings{{"Domain/Nodes", "vertices"},
                                           {"Peridynamics/Horizon ratio", "3"},
                                           {"Cracks/Growth step", "0.02"}};
        const Following<2> body(settings + start, model), built(settings + grown, model);
        const auto         follow = [&](const Problem<2> &problem) {
          const ChangeSet<2> damage = freeing(families_of(problem), free);
          EXPECT_GT(damage.broken.size(), 20u);
          return problem.op().follow(damage);
        };
        EXPECT_TRUE(follow(body));
        for (double t = 0.; t < 1.; t = body.op().next_event(t))
          body.op().update(t);
        EXPECT_TRUE(follow(built));
        const Vector x = body.values(bumpy<2>), y = body.product(x), expected = built.product(x);
        EXPECT_LT(relative_difference(y, expected), 1e-13);
        const double size = expected.linfty_norm();
        // Nothing flows to the node any more.
        for (unsigned int i = 0; i < body.nodes->n_owned(); ++i)
          if (body.nodes->position(i).distance(free) < 0.01)
            {
              EXPECT_LT(std::abs(y.local_element(i)), 1e-14 * size);
            }
      }
  }


  TEST(BrokenBonds, let_through_what_they_are_told)
  {
    BrokenBonds broken(0.25);
    EXPECT_FALSE(broken.touch(3));
    EXPECT_EQ(broken.kept_fraction(3, 7), 1.);
    broken.add({{3, 7}, {5, 6}});
    broken.add({{1, 7}, {4, 9}});
    EXPECT_EQ(broken.kept_fraction(7, 3), 0.25);
    EXPECT_EQ(broken.kept_fraction(9, 4), 0.25);
    EXPECT_EQ(broken.kept_fraction(3, 6), 1.);
    EXPECT_TRUE(broken.touch(1) && broken.touch(9));
    EXPECT_FALSE(broken.touch(2));
  }
} // namespace
