// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/laws/elasticity.h>
#include <perideal/operators/coupling/exchange_laws.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The matrix of a brick cell with a conductivity tensor that is diagonal. */
    template <int dim>
    FullMatrix<double> brick_matrix(const Tensor<1, dim>          &spacing,
                                    const std::array<double, dim> &conductivities)
    {
      constexpr unsigned int n = GeometryInfo<dim>::vertices_per_cell;
      FullMatrix<double>     matrix(n, n);
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
          for (unsigned int d = 0; d < dim; ++d)
            {
              double term = conductivities[d];
              for (unsigned int e = 0; e < dim; ++e)
                {
                  const bool same = ((a >> e) & 1) == ((b >> e) & 1);
                  term *= e == d ? (same ? 1. : -1.) / spacing[e] :
                                   (same ? 1. / 3. : 1. / 6.) * spacing[e];
                }
              matrix(a, b) += term;
            }
      return matrix;
    }
  } // namespace


  template <int dim>
  ConductingBonds<dim>::ConductingBonds(Families<dim> &families, const BodyParameters<dim> &body)
    : bonds(families, body)
    , form(body.peridynamics.form)
  {}


  template <int dim>
  CellStiffness<dim> ConductingBonds<dim>::stiffness(const BodyParameters<dim> &body)
  {
    const MaterialProperty &kappa = body.material.conductivity;
    return {[&kappa](const Point<dim> &p, const double T) { return kappa.value(p, T); },
            body.material.uniform_conductivity(),
            kappa.depends_on_temperature() ? &body.initial_and_source.initial_value : nullptr,
            body.material.uniform_conductivity() || !body.cracks.cut_pairs() ?
              std::vector<CrackGeometry<dim>>() :
              make_crack_geometries(body.crack_history().pieces(body.cracks.end_time))};
  }


  template <int dim>
  std::vector<Tensor<2, dim>> ConductingBonds<dim>::unit_fields()
  {
    std::vector<Tensor<2, dim>> fields(dim);
    for (unsigned int d = 0; d < dim; ++d)
      fields[d][0][d] = 1.;
    return fields;
  }


  template <int dim>
  CellSurplus ConductingBonds<dim>::calibrate(LatticeBonds<dim> &bonds)
  {
    const Lattice<dim>     &lattice = *bonds.families().nodes().lattice();
    const double            volume  = lattice.cell_volume();
    std::array<double, dim> A{};
    constexpr unsigned int  n = GeometryInfo<dim>::vertices_per_cell;
    CellSurplus             surplus{FullMatrix<double>(n, n)};
    for (const auto &offset : bonds.offsets)
      for (unsigned int d = 0; d < dim; ++d)
        A[d] += offset.weight * volume * std::pow(offset.site[d] * lattice.spacing[d], 2);
    bonds.for_each_full_passage([&](const auto &passage, const double share) {
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
          surplus.matrix(a, b) += share * passage.change[a] * passage.change[b];
    });
    surplus.matrix.add(-1., brick_matrix<dim>(lattice.spacing, A));
    surplus.takes_all =
      std::all_of(A.begin(), A.end(), [](const double a) { return std::abs(a - 1.) < 1e-12; });
    return surplus;
  }


  template <int dim>
  void ConductingBonds<dim>::check_form(const LatticeBonds<dim> &of_lattice) const
  {
    const bool suits = of_lattice.plain || !of_lattice.zone.is_everywhere();
    takes_lattice_form(form, suits ? "" : "the conductivity varies or the body has voids", true);
  }


  namespace
  {
    /**
     * Part of what bonds could carry that they get in three dimensions: the rest keeps the
     * remainder positive.
     */
    constexpr double kept = 0.95;


    /** The integral of d(phi_a)/dx_c d(phi_b)/dx_e over a brick with bilinear shape functions. */
    template <int dim>
    double brick_integral(const Tensor<1, dim> &spacing,
                          const unsigned int    a,
                          const unsigned int    b,
                          const unsigned int    c,
                          const unsigned int    e)
    {
      double product = 1.;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const bool   high_a = (a >> d) & 1, high_b = (b >> d) & 1;
          const double slope_a = high_a ? 1. : -1., slope_b = high_b ? 1. : -1.;
          if (d == c && d == e)
            product *= slope_a * slope_b / spacing[d];
          else if (d == c)
            product *= 0.5 * slope_a;
          else if (d == e)
            product *= 0.5 * slope_b;
          else
            product *= (high_a == high_b ? 1. / 3. : 1. / 6.) * spacing[d];
        }
      return product;
    }
  } // namespace


  template <int dim>
  CellStiffness<dim> ElasticBonds<dim>::stiffness(const BodyParameters<dim> &body)
  {
    return {[&body](const Point<dim> &p, const double) {
              return bond_part(body.moduli(p), dim, body.elasticity.plane);
            },
            body.material.uniform_moduli(),
            nullptr,
            {}};
  }


  template <int dim>
  std::vector<Tensor<2, dim>> ElasticBonds<dim>::unit_fields()
  {
    std::vector<Tensor<2, dim>> strains, fields;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a; b < dim; ++b)
        {
          Tensor<2, dim> strain;
          strain[a][b] = strain[b][a] = 1.;
          strains.push_back(strain);
        }
    const unsigned int n = strains.size();
    Eigen::MatrixXd    energy(n, n); // e : (dd + dd + dd) : e = (tr e)^2 + 2 e : e
    for (unsigned int k = 0; k < n; ++k)
      for (unsigned int l = 0; l < n; ++l)
        energy(k, l) =
          trace(strains[k]) * trace(strains[l]) + 2. * scalar_product(strains[k], strains[l]);
    const Eigen::MatrixXd root =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(energy).operatorInverseSqrt();
    for (unsigned int k = 0; k < n; ++k)
      {
        fields.emplace_back();
        for (unsigned int l = 0; l < n; ++l)
          fields[k] += root(l, k) * strains[l];
      }
    return fields;
  }


  namespace
  {
    /** Set the w for which the sum over half the family of w V xi xi xi xi is dd + dd + dd. */
    template <int dim>
    void set_weights(LatticeBonds<dim> &bonds)
    {
      constexpr unsigned int n = dim * (dim + 1) / 2;
      // xi_a^2 xi_b^2/r^4 for a <= b.
      const auto squares = [](const Tensor<1, dim> &xi) {
        std::array<double, n> list;
        unsigned int          k = 0;
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = a; b < dim; ++b)
            list[k++] = std::pow(xi[a] * xi[b] / xi.norm_square(), 2);
        return list;
      };
      const double                volume = bonds.families().nodes().lattice()->cell_volume();
      Eigen::Matrix<double, n, n> sums   = Eigen::Matrix<double, n, n>::Zero();
      Eigen::Matrix<double, n, 1> wanted;
      unsigned int                row = 0;
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = a; b < dim; ++b)
          wanted[row++] = a == b ? 3. : 1.;
      for (const auto &offset : bonds.offsets)
        {
          const Tensor<1, dim> xi   = bonds.vector_of(offset);
          const auto           list = squares(xi);
          for (unsigned int k = 0; k < n; ++k)
            for (unsigned int l = 0; l < n; ++l)
              sums(k, l) += offset.weight * volume * xi.norm_square() * list[k] * list[l];
        }
      const Eigen::FullPivLU<Eigen::Matrix<double, n, n>> solver(sums);
      AssertThrow(
        solver.isInvertible(),
        UserError(
          "'Horizon ratio' in section 'Peridynamics': the families are too small for elastic bonds. Use 2 or more."));
      const Eigen::Matrix<double, n, 1> factors = solver.solve(wanted);
      for (auto &offset : bonds.offsets)
        {
          const Tensor<1, dim> xi   = bonds.vector_of(offset);
          const auto           list = squares(xi);
          double               sum  = 0.;
          for (unsigned int k = 0; k < n; ++k)
            sum += factors[k] * list[k];
          AssertThrow(
            sum > 0.,
            UserError(
              "'Models = coupled': some elastic bonds of these families would push where they should pull. Use cells with "
              "sides of about the same length and a larger 'Horizon ratio' in section 'Peridynamics'."));
          offset.weight *= sum / xi.norm_square();
        }
    }


    /**
     * Fields on the corners of a brick: the first columns span the linear ones, the others are
     * orthogonal to these. All are orthonormal.
     */
    template <int dim>
    Eigen::MatrixXd cell_modes()
    {
      constexpr unsigned int n      = GeometryInfo<dim>::vertices_per_cell;
      Eigen::MatrixXd        linear = Eigen::MatrixXd::Zero(dim * n, dim * (dim + 1));
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int c = 0; c < dim; ++c)
          {
            linear(dim * a + c, c * (dim + 1)) = 1.;
            for (unsigned int d = 0; d < dim; ++d)
              linear(dim * a + c, c * (dim + 1) + 1 + d) = ((a >> d) & 1) ? 1. : -1.;
          }
      return Eigen::HouseholderQR<Eigen::MatrixXd>(linear).householderQ();
    }


    /**
     * The cell matrix of the stiffness dd + dd + dd: int (dd + dd + dd)_cgeh dphi_a/dx_g
     * dphi_b/dx_h.
     */
    template <int dim>
    Eigen::MatrixXd unit_stiffness(const Tensor<1, dim> &spacing)
    {
      constexpr unsigned int n = GeometryInfo<dim>::vertices_per_cell;
      Eigen::MatrixXd        matrix(dim * n, dim * n);
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int e = 0; e < dim; ++e)
              {
                double value =
                  brick_integral(spacing, a, b, c, e) + brick_integral(spacing, a, b, e, c);
                for (unsigned int g = 0; g < dim && c == e; ++g)
                  value += brick_integral(spacing, a, b, g, g);
                matrix(dim * a + c, dim * b + e) = value;
              }
      return matrix;
    }


    /** The inverse of a positive semidefinite matrix, zero on its null space. */
    Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd &matrix)
    {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
      Eigen::VectorXd                                      values = solver.eigenvalues();
      const double                                         zero   = 1e-10 * values.maxCoeff();
      for (double &value : values)
        value = value > zero ? 1. / value : 0.;
      return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
    }
  } // namespace


  template <int dim>
  double ElasticBonds<dim>::energy_per_square(const LatticeBonds<dim> &bonds)
  {
    double sum = 0.;
    for (const auto &offset : bonds.offsets)
      {
        const Tensor<1, dim> xi = bonds.vector_of(offset);
        for (unsigned int d = 0; d < dim; ++d)
          sum += offset.weight * std::pow(xi.norm_square(), 2) * std::abs(xi[d]) / dim;
      }
    return 0.5 * bonds.families().nodes().lattice()->cell_volume() * sum;
  }


  template <int dim>
  CellSurplus ElasticBonds<dim>::calibrate(LatticeBonds<dim> &bonds)
  {
    set_weights(bonds);
    constexpr unsigned int n        = dim * GeometryInfo<dim>::vertices_per_cell;
    constexpr unsigned int n_linear = dim * (dim + 1), n_others = n - n_linear;
    Eigen::MatrixXd        M = Eigen::MatrixXd::Zero(n, n);
    bonds.for_each_full_passage([&](const auto &passage, const double strength) {
      const auto values =
        corner_values<dim>(passage.change, bonds.vector_of(bonds.offsets[passage.offset]));
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j <= i; ++j)
          M(i, j) += strength * values[i] * values[j];
    });
    M.triangularView<Eigen::StrictlyUpper>() = M.transpose();
    const Eigen::MatrixXd modes = cell_modes<dim>(), linear = modes.leftCols(n_linear),
                          others = modes.rightCols(n_others);
    const Eigen::MatrixXd Q      = unit_stiffness<dim>(bonds.families().nodes().lattice()->spacing);
    // Bonds in cells of three dimensions couple shear to the mode x y z of the corners.
    const Eigen::MatrixXd mixed  = linear.transpose() * M * others;
    Eigen::MatrixXd       excess = others.transpose() * (M - Q) * others;
    if (n_others > 0 && mixed.norm() > 1e-12 * M.norm())
      {
        excess = kept * excess + kept * kept / (1. - kept) * mixed.transpose() *
                                   pseudo_inverse(linear.transpose() * Q * linear) * mixed;
        for (auto &offset : bonds.offsets)
          offset.weight *= kept;
      }
    const Eigen::MatrixXd result = others * excess * others.transpose();
    CellSurplus           surplus{FullMatrix<double>(n, n)};
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        surplus.matrix(i, j) = result(i, j);
    return surplus;
  }


  PERIDEAL_INSTANTIATE_CLASS(class ConductingBonds);
  PERIDEAL_INSTANTIATE_CLASS(class ElasticBonds);
} // namespace PeriDeal
