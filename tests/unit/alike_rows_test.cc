// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/alike_rows.h>

#include <cmath>

#include "dimensions.h"
#include "elastic_coupling_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;
using dealii::Point;
using dealii::Tensor;

namespace
{
  template <int dim>
  Settings many_cells()
  {
    const char *const counts[] = {"", "200", "40, 36", "16, 14, 12"};
    const char *const corner[] = {"", "2", "0.4, 0.36", "0.4, 0.35, 0.3"};
    return box<dim>() +
           Settings{{"Domain/Cells", counts[dim]}, {"Domain/Upper corner", corner[dim]}};
  }


  /** Largest difference of K x, over the largest of the second. */
  template <int dim>
  double difference(const Body<dim> &of, const Body<dim> &plain)
  {
    const Vector x = plain.values(bumpy_vector<dim>);
    return relative_difference(of.product(x), plain.product(x));
  }


  /** Bodies with Trilinos' matrix and with rows that share values: the same but for memory. */
  template <int dim>
  void check_same(const Settings &settings, const ModelKind model, const bool shares)
  {
    Body<dim> plain(settings, model), sharing(settings, model);
    sharing.op().stepping.follow = true;
    EXPECT_LT((difference<dim>(sharing, plain)), 1e-13);
    const OperatorSize before = plain.op().size(), after = sharing.op().size();
    EXPECT_EQ(before.nonzeros, after.nonzeros);
    if (shares)
      EXPECT_LT(after.memory, 0.8 * before.memory);
    else
      EXPECT_EQ(after.memory, before.memory);
    EXPECT_NEAR(sharing.op().spectrum().safe / plain.op().spectrum().safe, 1., 1e-12);
    // The matrix for solvers is there as ever.
    Matrix one, other;
    plain.op().surrogate(one);
    sharing.op().surrogate(other);
    EXPECT_NEAR(one.frobenius_norm() / other.frobenius_norm(), 1., 1e-13);
    const Vector x = plain.values(bumpy_vector<dim>);
    Vector       y(x), z(x);
    one.vmult(y, x);
    other.vmult(z, x);
    EXPECT_LT(relative_difference(z, y), 1e-12);
  }
} // namespace


TEST(AlikeRows, product_of_finite_elements)
{
  check_same<1>(many_cells<1>(), ModelKind::finite_elements, true);
  check_same<2>(many_cells<2>(), ModelKind::finite_elements, true);
  check_same<3>(many_cells<3>(), ModelKind::finite_elements, true);
  // Cells that nothing is left of, two materials, degree 2, and hardly a row like another.
  check_same<2>(many_cells<2>() + Settings{{"Cracks/Segments", "0.101,0.1 ; 0.26,0.21"}},
                ModelKind::finite_elements,
                true);
  check_same<2>(many_cells<2>() + Settings{{"Material/Young modulus", "if(x < 0.2, 3, 1)"}},
                ModelKind::finite_elements,
                true);
  check_same<2>(many_cells<2>() + Settings{{"Finite elements/Degree", "2"}},
                ModelKind::finite_elements,
                true);
  check_same<2>(many_cells<2>() + Settings{{"Material/Young modulus", "1 + x + x*y"}},
                ModelKind::finite_elements,
                false);
}


TEST(AlikeRows, product_beside_bonds)
{
  for (const std::string zone : {"everywhere", "x - 0.2"})
    {
      const Settings in_zone{{"Coupling/Zone", zone}};
      check_same<2>(many_cells<2>() + in_zone + Settings{{"Material/Critical stretch", "0.01"}},
                    ModelKind::coupled,
                    true);
      check_same<3>(many_cells<3>() + in_zone + Settings{{"Material/Critical stretch", "0.01"}},
                    ModelKind::coupled,
                    true);
    }
}


TEST_IN_DIMENSIONS(AlikeRows, rows_that_breaking_bonds_mend, 2, 3)
{
  const Settings settings = many_cells<dim>() + Settings{{"Coupling/Zone", "follow"},
                                                         {"Material/Critical stretch", "0.01"}};
  Body<dim>      plain(settings, ModelKind::coupled), sharing(settings, ModelKind::coupled);
  sharing.op().stepping.follow = true;
  for (const double width : {8000., 600., 200.})
    {
      Vector u = plain.values([&](const Point<dim> &p) {
        Tensor<1, dim> value;
        value[0] = 0.002 * std::exp(-width * (p - 0.2 * Point<dim>::unit_vector(0)).norm_square());
        return value;
      });
      for (const Body<dim> *body : {&plain, &sharing})
        {
          body->product(u);
          body->op().distribute(u, 0.);
          body->op().widen_zone(u);
          body->op().break_bonds(u, 0.1);
        }
      EXPECT_GT(plain.op().n_broken_bonds(), 0U);
      EXPECT_EQ(plain.op().n_broken_bonds(), sharing.op().n_broken_bonds());
      EXPECT_EQ(plain.op().size().bonds, sharing.op().size().bonds);
      EXPECT_LT((difference<dim>(sharing, plain)), 1e-13);
      EXPECT_NEAR(sharing.op().released_energy() / plain.op().released_energy(), 1., 1e-12);
    }
}


TEST(AlikeRows, rows_that_growing_cracks_mend)
{
  const Settings settings =
    many_cells<2>() + Settings{{"Cracks/Segments", "0.055,0.103 ; 0.105,0.123"},
                               {"Cracks/Growth", "2: 0, 0.2,0.11"},
                               {"Time/End time", "1"}};
  Body<2> plain(settings, ModelKind::finite_elements),
    sharing(settings, ModelKind::finite_elements);
  sharing.op().stepping.follow = true;
  const Vector u               = plain.values(bumpy_vector<2>);
  for (const double t : {0., 0.3, 0.7, 1.})
    {
      plain.op().grow_cracks(u, t);
      sharing.op().grow_cracks(u, t);
      EXPECT_LT((difference<2>(sharing, plain)), 1e-13);
    }
  EXPECT_LT(sharing.op().size().memory, 0.8 * plain.op().size().memory);
}


/** A Laplacian on a lattice, numbered along it: next to all rows are one. */
TEST(AlikeRows, differ_at_the_rim_alone)
{
  Body<2> body(many_cells<2>(), ModelKind::finite_elements, MPI_COMM_SELF);
  Matrix  matrix;
  body.elements->assemble_intact(matrix, false);
  std::vector<std::uint64_t> places;
  for (unsigned int i = 0; i < body.elements->node_layout()->locally_owned_size(); ++i)
    places.push_back(static_cast<std::uint64_t>(std::lround(100. * body.position(i)[1])) * 1000 +
                     std::lround(100. * body.position(i)[0]));
  const AlikeRows<2> rows(matrix, body.elements->node_layout(), places);
  // 9 kinds of nodes, some of them with columns that are numbered otherwise.
  EXPECT_LT(rows.n_different(), 40U);
  const Vector x = body.values(bumpy_vector<2>);
  Vector       y(x), z(x);
  rows.multiply(y, x);
  matrix.vmult(z, x);
  EXPECT_LT(relative_difference(y, z), 1e-13);
}
