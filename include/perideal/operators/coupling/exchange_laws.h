// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/tensor.h>
#include <deal.II/lac/full_matrix.h>

#include <perideal/bonds/diffusion_bonds.h>
#include <perideal/operators/coupling/lattice_bonds.h>
#include <perideal/operators/lattice/bond_form.h>

#include <array>
#include <vector>

namespace PeriDeal
{
  /*
   * What the bonds of an exchange do to the unknowns of its nodes: heat or force
   *
   *   W v (v . (u_j - u_i)),  v = direction(xi),  W = w V_i V_j k,
   *
   * k the smallest stiffness(p) on the bond's way. LatticeExchange and MeshExchange take one of
   * these laws; both have the same members.
   */

  /** ch_a v_c of the corners a of a cell and the components c, the latter running faster. */
  template <unsigned int n_components, std::size_t n_corners, typename Direction>
  inline std::array<double, n_components * n_corners> corner_values(
    const std::array<double, n_corners> &change,
    const Direction                     &v)
  {
    std::array<double, n_components * n_corners> values;
    for (unsigned int a = 0; a < n_corners; ++a)
      for (unsigned int c = 0; c < n_components; ++c)
        values[n_components * a + c] = change[a] * v[c];
    return values;
  }


  /** What a cell of a lattice gets of whose bonds anything is taken. */
  struct CellSurplus
  {
    dealii::FullMatrix<double> matrix;            // for unit stiffness
    bool                       takes_all = false; // bonds of whole families leave nothing of a cell
  };


  /** Bonds that conduct: v = 1, k the conductivity. */
  template <int dim>
  class ConductingBonds
  {
  public:
    static constexpr unsigned int n_components = 1;

    static std::array<double, 1> direction(const dealii::Tensor<1, dim> &)
    {
      return {{1.}};
    }

    static CellStiffness<dim> stiffness(const BodyParameters<dim> &body);

    /** w over that of the families, off a lattice. */
    static double scale_of(const dealii::Tensor<1, dim> &)
    {
      return 1.;
    }

    /**
     * Linear fields x -> G x whose energy in a cell of volume |c| is k |c|/2 each, the energy
     * between any two of them zero.
     */
    static std::vector<dealii::Tensor<2, dim>> unit_fields();

    /**
     * M - Q[A], with M = sum over the full family of w V^2 share L, A = (1/2) sum w V xi xi^T over
     * the full family, and Q[A] the cell matrix of the conductivity A: M = Q[A] on linear fields.
     */
    static CellSurplus calibrate(LatticeBonds<dim> &bonds);

    ConductingBonds(Families<dim> &families, const BodyParameters<dim> &body);

    /** What the cracks leave of a bond, and whether it crosses any. */
    double kept_fraction(const unsigned int node, const unsigned int neighbor, bool &cut) const
    {
      return bonds.kept_fraction(node, neighbor, cut, true);
    }

    /** Throws UserError for a form that bonds of a lattice cannot have. */
    void check_form(const LatticeBonds<dim> &of_lattice) const;

    /** Bonds that a form may be made of; they conduct. */
    DiffusionBonds<dim> *conducting()
    {
      return &bonds;
    }

    /** As Coupling: what cracks leave of a bond may depend on its conductivity. */
    void take_conductivities_at(const Vector &u)
    {
      bonds.conductivities().take_at(u);
    }

    std::size_t memory_consumption() const
    {
      return bonds.memory_consumption();
    }

  private:
    DiffusionBonds<dim> bonds;
    OperatorForm        form;
  };


  /**
   * Bonds of a solid: v = xi, k = bond_part() of the moduli, so that of each bond only the stretch
   * counts. The sum over half the family of w V xi xi xi xi is dd + dd + dd, d the Kronecker
   * symbols: exactly on a lattice (calibrate()), elsewhere in its mean over all directions.
   */
  template <int dim>
  class ElasticBonds
  {
  public:
    static constexpr unsigned int n_components = dim;

    static dealii::Tensor<1, dim> direction(const dealii::Tensor<1, dim> &xi)
    {
      return xi;
    }

    static CellStiffness<dim> stiffness(const BodyParameters<dim> &body);

    /** The mean of cos^4 over all directions is 3/(dim (dim + 2)), that of cos^2 1/dim. */
    static double scale_of(const dealii::Tensor<1, dim> &xi)
    {
      return (dim + 2.) / xi.norm_square();
    }

    /** As ConductingBonds. The energy is that of the stiffness k (dd + dd + dd). */
    static std::vector<dealii::Tensor<2, dim>> unit_fields();

    /**
     * Calibrates the bonds of a lattice: w is the influence function kernel/r^n times the volume
     * fraction over r^2, times sum_{a <= b} s_ab xi_a^2 xi_b^2/r^4 with the s for which the sum
     * above holds. With M = sum over the full family of w V^2 share L (x) xi xi^T and Q the cell
     * matrix of the stiffness dd + dd + dd, a cell gets M - Q in one and two dimensions, where M =
     * Q on linear fields, and what is left of it is positive semidefinite. In three dimensions the
     * pieces of a bond in one cell also push the corners in the mode x y z, which only the cells
     * around a node together take back: M has a block B between linear fields and the others. Bonds
     * then get the part eta = 0.95 of k, and a cell eta (M - Q) + eta^2/(1 - eta) B^T Q^+ B on the
     * others, which again leaves it positive semidefinite (Schur complement). Throws UserError for
     * families too small and for cells too long to calibrate.
     */
    static CellSurplus calibrate(LatticeBonds<dim> &bonds);

    /**
     * Energy per area of the bonds that a plane of a calibrated lattice cuts, all stretched by s,
     * over s^2, for unit stiffness; the mean over the axes n:
     *   V/2 sum over half the family of w x^4 |xi_n|.
     */
    static double energy_per_square(const LatticeBonds<dim> &bonds);

    ElasticBonds(Families<dim> &families, const BodyParameters<dim> &)
      : families(families)
    {}

    /** 0 or 1: faces of a crack bear nothing. */
    double kept_fraction(const unsigned int node, const unsigned int neighbor, bool &cut) const
    {
      const double kept = families.cracks().kept_part(node, neighbor);
      cut               = kept < 1.;
      return kept;
    }

    void check_form(const LatticeBonds<dim> &) const {}

    DiffusionBonds<dim> *conducting()
    {
      return nullptr;
    }

    void take_conductivities_at(const Vector &) {}

    std::size_t memory_consumption() const
    {
      return 0;
    }

  private:
    const Families<dim> &families;
  };
} // namespace PeriDeal
