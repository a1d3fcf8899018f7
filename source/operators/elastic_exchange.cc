// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/laws/elasticity.h>
#include <perideal/operators/elastic_exchange.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

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


    /** Add W ch_a ch_b xi_c xi_d to the lower triangle of a cell's matrix. */
    template <int dim, std::size_t n>
    void add_bond_to(const double                 strength,
                     const std::array<double, n> &change,
                     const Tensor<1, dim>        &xi,
                     std::array<double, dim * n> &scratch,
                     FullMatrix<double>          &matrix)
    {
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int c = 0; c < dim; ++c)
          scratch[dim * a + c] = change[a] * xi[c];
      for (unsigned int i = 0; i < dim * n; ++i)
        for (unsigned int j = 0; j <= i; ++j)
          matrix(i, j) += strength * scratch[i] * scratch[j];
    }
  } // namespace


  template <int dim>
  ElasticExchange<dim>::ElasticExchange(Nodes<dim>       &nodes,
                                        const Scene<dim> &scene,
                                        const Zone<dim>  &zone)
    : bonds(
        nodes,
        scene,
        zone,
        [&](const Point<dim> &p) {
          return bond_part(scene.material.moduli(p), dim, scene.elasticity.plane);
        },
        true)
  {
    calibrate();
    find_surplus();
  }


  template <int dim>
  Tensor<1, dim> ElasticExchange<dim>::vector_of(
    const typename LatticeBonds<dim>::Offset &offset) const
  {
    Tensor<1, dim> xi = bonds.families.nodes().lattice()->spacing;
    for (unsigned int d = 0; d < dim; ++d)
      xi[d] *= offset.site[d];
    return xi;
  }


  template <int dim>
  void ElasticExchange<dim>::calibrate()
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
    const double                volume = bonds.families.nodes().lattice()->cell_volume();
    Eigen::Matrix<double, n, n> sums   = Eigen::Matrix<double, n, n>::Zero();
    Eigen::Matrix<double, n, 1> wanted;
    unsigned int                row = 0;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a; b < dim; ++b)
        wanted[row++] = a == b ? 3. : 1.;
    for (const auto &offset : bonds.offsets)
      {
        const Tensor<1, dim> xi   = vector_of(offset);
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
        const Tensor<1, dim> xi   = vector_of(offset);
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


  namespace
  {
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
  void ElasticExchange<dim>::find_surplus()
  {
    constexpr unsigned int n        = dim * GeometryInfo<dim>::vertices_per_cell;
    constexpr unsigned int n_linear = dim * (dim + 1), n_others = n - n_linear;
    std::array<double, n>  scratch;
    FullMatrix<double>     full(n, n);
    bonds.for_each_full_passage([&](const auto &passage, const double strength) {
      add_bond_to(strength,
                  passage.change,
                  vector_of(bonds.offsets[passage.offset]),
                  scratch,
                  full);
    });
    Eigen::MatrixXd M(n, n);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        M(i, j) = full(std::max(i, j), std::min(i, j));
    const Eigen::MatrixXd modes = cell_modes<dim>(), linear = modes.leftCols(n_linear),
                          others = modes.rightCols(n_others);
    const Eigen::MatrixXd Q      = unit_stiffness<dim>(bonds.families.nodes().lattice()->spacing);
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
    surplus.reinit(n, n);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        surplus(i, j) = result(i, j);
  }


  template <int dim>
  void ElasticExchange<dim>::bonds_of(const unsigned int node, std::vector<Bond> &list) const
  {
    list.clear();
    bonds.for_each_bond(
      node,
      [&](const unsigned int neighbor, const auto &offset, const double strength) {
        const Tensor<1, dim> xi = vector_of(offset); // its sign does not matter
        Bond                 bond;
        bond.neighbor = neighbor;
        bond.block    = strength * outer_product(xi, xi);
        bond.cut      = bonds.families.cracks().cuts(node, neighbor);
        list.push_back(bond);
      });
  }


  template <int dim>
  bool ElasticExchange<dim>::change_cell(const Cell &cell, FullMatrix<double> &stiffness) const
  {
    if (!bonds.is_of_lattice(cell))
      return false;
    constexpr unsigned int      n    = GeometryInfo<dim>::vertices_per_cell;
    const auto                  site = bonds.families.nodes().lattice()->index(cell->vertex(0));
    FullMatrix<double>          taken(dim * n, dim * n);
    std::array<double, dim * n> scratch;
    bool                        any = false;
    bonds.for_each_passage(site, [&](const auto &passage, const double strength) {
      any = true;
      add_bond_to(strength,
                  passage.change,
                  vector_of(bonds.offsets[passage.offset]),
                  scratch,
                  taken);
    });
    if (!any)
      return false;
    stiffness.add(bonds.stiffness_of(site), surplus);
    for (unsigned int i = 0; i < dim * n; ++i)
      for (unsigned int j = 0; j < dim * n; ++j)
        stiffness(i, j) -= taken(std::max(i, j), std::min(i, j));
    return true;
  }


  template <int dim>
  bool ElasticExchange<dim>::symmetric() const
  {
    return true;
  }

  template <int dim>
  bool ElasticExchange<dim>::in_zone(const unsigned int node) const
  {
    return bonds.in_zone(node);
  }

  template <int dim>
  const Families<dim> &ElasticExchange<dim>::families() const
  {
    return bonds.families;
  }

  template <int dim>
  void ElasticExchange<dim>::set_cracks_of(const double time)
  {
    bonds.families.cracks().set_time(time);
  }

  template <int dim>
  std::size_t ElasticExchange<dim>::memory_consumption() const
  {
    return bonds.memory_consumption();
  }


  template class ElasticExchange<1>;
  template class ElasticExchange<2>;
  template class ElasticExchange<3>;
} // namespace PeriDeal
