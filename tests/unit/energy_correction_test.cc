// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Surface correction by the energy of a unit gradient (Tan 2020).

#include "operator_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;
  using dealii::Tensor;

  namespace
  {
    const Settings energy{{"Peridynamics/Surface correction", "energy"}};


    /**
     * The definition, from the bonds without correction, on one process. Directions from first on;
     * one: it holds for all bonds.
     */
    template <int dim>
    void expect_definition(const std::string &what,
                           const Settings    &settings,
                           const unsigned int first,
                           const bool         one)
    {
      const Problem<dim> plain(settings, ModelKind::peridynamics, MPI_COMM_SELF),
        corrected(settings + energy, ModelKind::peridynamics, MPI_COMM_SELF);
      const DiffusionBonds<dim> &families = bonds_of(plain.op()).diffusion_bonds();
      const unsigned int         n        = families.nodes().n_owned();
      std::vector<typename DiffusionBonds<dim>::Bond> bonds, found;
      std::vector<Tensor<1, dim>>                     g(n);
      for (unsigned int i = 0; i < n; ++i)
        {
          Tensor<1, dim> Z;
          families.bonds_of(i, bonds);
          for (const auto &bond : bonds)
            for (unsigned int d = 0; d < dim; ++d)
              Z[d] += 0.25 * bond.weight / families.nodes().volume(i) *
                      std::pow(families.neighbors().bond_vector(i, bond.neighbor)[d], 2);
          for (unsigned int d = 0; d < dim; ++d)
            g[i][d] = 0.5 * families.conductivities().of_node(i) / Z[d];
        }
      double largest = 0., effect = 0.;
      for (unsigned int i = 0; i < n; ++i)
        {
          families.bonds_of(i, bonds);
          bonds_of(corrected.op()).diffusion_bonds().bonds_of(i, found);
          ASSERT_EQ(bonds.size(), found.size());
          for (unsigned int b = 0; b < bonds.size(); ++b)
            {
              const unsigned int   j      = bonds[b].neighbor;
              const Tensor<1, dim> xi     = families.neighbors().bond_vector(i, j);
              double               factor = 0.;
              for (unsigned int d = 0; d < dim; ++d)
                {
                  const unsigned int a = one ? first : d;
                  factor +=
                    0.5 * (g[i][a] + (j < n ? g[j][a] : 1.)) * xi[d] * xi[d] / xi.norm_square();
                }
              largest = std::max(largest, std::abs(found[b].weight - factor * bonds[b].weight));
              effect  = std::max(effect, std::abs(found[b].weight - bonds[b].weight));
            }
        }
      EXPECT_LE(largest, 1e-13 * plain.op().diagonal().linfty_norm()) << what;
      EXPECT_GT(effect, 1e-3 * plain.op().diagonal().linfty_norm()) << what;
    }
  } // namespace


  TEST(EnergyCorrection, is_as_defined)
  {
    const Settings plate{{"Domain/Cells", "12, 10"},
                         {"Cracks/Segments", "0.2,0.52 ; 0.7,0.52"},
                         {"Cracks/Bonds through tips", "keep"},
                         {"Material/Conductivity", "exp(x + 2*y)"},
                         {"Boundary conditions/Dirichlet", "top: 1; bottom: 0"}};
    for (const std::string placement : {"vertices", "cell centers"})
      for (const std::string treatment :
           {"none", "layer", "fictitious mirror", "fictitious constant"})
        {
          const Settings    base = plate + Settings{{"Domain/Nodes", placement},
                                                 {"Peridynamics/Boundary treatment", treatment}};
          const std::string what = placement + ", " + treatment;
          expect_definition<2>(what, base, 0, false);
          expect_definition<2>(what + ", y",
                               base + Settings{{"Peridynamics/Correction direction", "y"}},
                               1,
                               true);
        }
    const Settings block{
      {"Domain/Lower corner", "0, 0, 0"},
      {"Domain/Upper corner", "1, 1, 1"},
      {"Domain/Cells", "6, 7, 6"},
      {"Cracks/Polygons", "0.2,0.2,0.52 ; 0.7,0.2,0.52 ; 0.7,0.8,0.52 ; 0.2,0.8,0.52"},
      {"Cracks/Bonds through tips", "keep"},
      {"Boundary conditions/Dirichlet", "front: 1; back: 0"}};
    for (const std::string treatment : {"none", "fictitious mirror"})
      {
        const Settings base = block + Settings{{"Peridynamics/Boundary treatment", treatment}};
        expect_definition<3>("3D, " + treatment, base, 0, false);
        expect_definition<3>("3D, z, " + treatment,
                             base + Settings{{"Peridynamics/Correction direction", "z"}},
                             2,
                             true);
      }
  }


  TEST(EnergyCorrection, leaves_complete_families_alone)
  {
    const Settings   all_mirrored{{"Domain/Cells", "12, 10"},
                                {"Peridynamics/Boundary treatment", "fictitious mirror"},
                                {"Boundary conditions/Dirichlet", "top: 1; bottom: 0"},
                                {"Boundary conditions/Symmetry", "left; right"}};
    const Problem<2> plain(all_mirrored), corrected(all_mirrored + energy);
    const Vector     u = plain.values(bumpy<2>);
    EXPECT_LE(largest_difference(plain.residual(u), corrected.residual(u)),
              1e-13 * plain.op().diagonal().linfty_norm());
  }


  TEST(EnergyCorrection, makes_up_for_the_calibration_inside)
  {
    // With analytic calibration complete families conduct 7 % too little; the correction brings
    // that back.
    const Settings   settings = energy + Settings{{"Domain/Cells", "20, 20"},
                                                {"Peridynamics/Calibration", "analytic"},
                                                {"Material/Conductivity", "3"}};
    const Problem<2> problem(settings);
    const Vector     r =
      problem.residual(problem.values([](const Point<2> &p) { return p[0] * p[0]; }));
    unsigned int n_inside = 0;
    for (unsigned int i = 0; i < r.locally_owned_size(); ++i)
      if (problem.positions[i].distance(Point<2>(0.5, 0.5)) < 0.1)
        {
          EXPECT_NEAR(r.local_element(i) * 400., 2. * 3., 1e-10);
          ++n_inside;
        }
    EXPECT_GT(sum_of_all(n_inside), 5u);
  }


  TEST(EnergyCorrection, conserves_heat_and_is_symmetric)
  {
    const Problem<2> problem(energy + Settings{{"Domain/Cells", "7, 6"},
                                               {"Material/Conductivity", "1 + x"},
                                               {"Cracks/Segments", "0.2,0.52 ; 0.7,0.52"}});
    expect_conservation(problem, "energy");
    EXPECT_GE(problem.op().spectrum().sharp, DenseProperties(problem.op()).largest);
  }
} // namespace PeriDeal
