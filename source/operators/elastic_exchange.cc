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
    : bonds(nodes, scene, zone, [&](const Point<dim> &p) {
      return bond_part(scene.material.moduli(p), dim, scene.elasticity.plane);
    })
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


  template <int dim>
  void ElasticExchange<dim>::find_surplus()
  {
    constexpr unsigned int      n = GeometryInfo<dim>::vertices_per_cell;
    std::array<double, dim * n> scratch;
    surplus.reinit(dim * n, dim * n);
    bonds.for_each_full_passage([&](const auto &passage, const double strength) {
      add_bond_to(strength,
                  passage.change,
                  vector_of(bonds.offsets[passage.offset]),
                  scratch,
                  surplus);
    });
    // Q_(ac)(be) = int (dd + dd + dd)_cgeh dphi_a/dx_g dphi_b/dx_h
    const Tensor<1, dim> &spacing = bonds.families.nodes().lattice()->spacing;
    for (unsigned int a = 0; a < n; ++a)
      for (unsigned int b = 0; b < n; ++b)
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int e = 0; e < dim; ++e)
            {
              double value =
                brick_integral(spacing, a, b, c, e) + brick_integral(spacing, a, b, e, c);
              for (unsigned int g = 0; g < dim && c == e; ++g)
                value += brick_integral(spacing, a, b, g, g);
              if (dim * b + e <= dim * a + c)
                surplus(dim * a + c, dim * b + e) -= value;
            }
    for (unsigned int i = 0; i < dim * n; ++i)
      for (unsigned int j = 0; j < i; ++j)
        surplus(j, i) = surplus(i, j);
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
        bonds.families.kept_fraction(node, neighbor, bond.cut);
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
  std::size_t ElasticExchange<dim>::memory_consumption() const
  {
    return bonds.memory_consumption();
  }


  template class ElasticExchange<1>;
  template class ElasticExchange<2>;
  template class ElasticExchange<3>;
} // namespace PeriDeal
