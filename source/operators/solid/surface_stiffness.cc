// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/surface_stiffness.h>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Sums of w x^2 n_a^2 n_b^2 over a family, n = xi/x. */
    template <int dim>
    struct EvenMoments
    {
      void add(const Tensor<1, dim> &xi, const double weight) // w x^2
      {
        const double r2 = xi.norm_square();
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = 0; b < dim; ++b)
            sums[a][b] += weight * xi[a] * xi[a] * xi[b] * xi[b] / r2 / r2;
      }

      double weighted() const
      {
        double q = 0.;
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = 0; b < dim; ++b)
            q += sums[a][b];
        return q;
      }

      /** What strains along the axes store, twice, as a quadratic form; the law divides by q. */
      Tensor<2, dim> energy(const StateLaw &law, const double q) const
      {
        Tensor<1, dim> theta;
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = 0; b < dim; ++b)
            theta[a] += sums[a][b];
        theta *= law.dilatation / q;
        return law.volumetric / law.dilatation * outer_product(theta, theta) +
               law.extension / q * sums;
      }

      Tensor<2, dim> sums;
    };
  } // namespace


  template <int dim>
  Tensor<1, dim> surface_stiffness(const SolidBonds<dim> &bonds)
  {
    const Families<dim> &families = bonds.families;
    const NodeLaws<dim> &laws     = bonds.laws;
    const Nodes<dim>    &nodes    = families.nodes();
    EvenMoments<dim>     complete;
    if (nodes.lattice())
      for (const FamilyMember<dim> &member : families.weights().members())
        {
          Tensor<1, dim> xi;
          for (unsigned int d = 0; d < dim; ++d)
            xi[d] = member.offset[d] * nodes.lattice()->spacing[d];
          complete.add(xi, member.weight * member.r * member.r);
        }
    else
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = 0; b < dim; ++b)
          complete.sums[a][b] = (a == b ? 3. : 1.) / (dim * (dim + 2.));
    Tensor<2, dim> found, expected;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        EvenMoments<dim> own;
        bonds.rows.for_each(i, [&](const auto &bond) {
          const Tensor<1, dim> xi = bonds.ends.vector(i, bond.neighbor);
          own.add(xi, bond.moment * xi);
        });
        StateLaw law = laws[i];
        if (!laws.volumetric)
          law.volumetric = 0.;
        found +=
          nodes.volume(i) * own.energy(law, nodes.volume(i) * laws.weighted.local_element(i));
        expected += nodes.volume(i) * complete.energy(law, complete.weighted());
      }
    found    = Utilities::MPI::sum(found, nodes.communicator());
    expected = Utilities::MPI::sum(expected, nodes.communicator());
    Tensor<1, dim>       more;
    const Tensor<2, dim> soft = invert(found), reference = invert(expected);
    for (unsigned int d = 0; d < dim; ++d)
      more[d] = reference[d][d] / soft[d][d] - 1.;
    return more;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(surface_stiffness);
} // namespace PeriDeal
