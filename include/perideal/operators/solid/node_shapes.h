// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/symmetric_tensor.h>

#include <perideal/operators/solid/bond_table.h>

#include <vector>

namespace PeriDeal
{
  /** Numbers of each bond that is stored, in the order of rows. */
  template <int dim, typename Number>
  struct OfBonds
  {
    const std::vector<Number> &of(const bool is_beyond) const
    {
      return is_beyond ? beyond : body;
    }

    std::vector<Number> &of(const bool is_beyond)
    {
      return is_beyond ? beyond : body;
    }

    void resize(const BondTable<dim> &bonds)
    {
      body.resize(bonds.body.size());
      beyond.resize(bonds.beyond.size());
    }

    std::size_t memory_consumption() const
    {
      return (body.capacity() + beyond.capacity()) * sizeof(Number);
    }

    std::vector<Number> body, beyond;
  };


  /**
   * What of the nodes of correspondence (Correspondence) their bonds and moduli tell, and the
   * elastic K that follows from these.
   */
  template <int dim>
  class NodeShapes
  {
  public:
    using Full      = dealii::SymmetricTensor<2, dim>;
    using Stiffness = dealii::SymmetricTensor<4, dim>;

    /** Of an owned node. */
    struct Shape
    {
      Full         inverse;                     // M^-1
      double       shear = 0., stabilizer = 0.; // mu, c
      double       share     = 1.;              // of its energy, that counts
      unsigned int stiffness = 0;               // in a list
    };

    /** Of an owned node, where deformations are large: what its forces change by. */
    struct Deformed
    {
      /** Of P = F S, as G changes. */
      dealii::Tensor<2, dim> change_of_pull(const dealii::Tensor<2, dim> &slopes) const
      {
        const Full strain = symmetrize(transpose(gradient) * slopes);
        return gradient * dealii::Tensor<2, dim>(Full(stiffness * strain)) +
               slopes * dealii::Tensor<2, dim>(stress);
      }

      Stiffness              stiffness;
      dealii::Tensor<2, dim> gradient; // F
      Full                   stress;   // S
    };

    /** All have to outlive this object, which knows no stiffness yet. */
    NodeShapes(const Families<dim>  &families,
               const BondEnds<dim>  &ends,
               const BondTable<dim> &bonds,
               const NodeLaws<dim>  &laws);

    /**
     * Of node i, one after the other from the first on, again where moduli change; then renew() of
     * all is due. @param is_known whether there is a shear modulus in it
     */
    void set_stiffness(const unsigned int i, const Stiffness &stiffness, const bool is_known);

    /** Bonds of these owned nodes bear nothing any more, or q has changed. */
    void renew(const std::vector<unsigned int> &nodes);

    const Shape &operator[](const unsigned int i) const
    {
      return list[i];
    }

    unsigned int size() const
    {
      return static_cast<unsigned int>(list.size());
    }

    const Stiffness &elastic(const unsigned int i) const
    {
      return stiffnesses[list[i].stiffness];
    }

    /** The stress of the shear modulus, in three dimensions and in plane strain. */
    Full of_shear(const unsigned int i, const Full &strain) const
    {
      return 2. * list[i].shear *
             (strain - trace(strain) / 3. * dealii::unit_symmetric_tensor<dim>());
    }

    /** So much of the energy of an owned node counts. */
    void set_share(const unsigned int i, const double share)
    {
      list[i].share = share;
    }

    /** W of the stored bonds. */
    const OfBonds<dim, double> &weights() const
    {
      return of_bonds;
    }

    /** visit(far end, W xi, W, number) of the bonds of an owned node. */
    template <typename Visit>
    void for_each_bond(const unsigned int i, const Visit &visit) const
    {
      bonds.for_each(i, [&](const SolidBond<dim> &bond) {
        const dealii::Tensor<1, dim> xi = ends.vector(i, bond.neighbor);
        visit(bond.neighbor, bond.moment, (bond.moment * xi) / xi.norm_square(), bond.number);
      });
    }

    /** The diagonal of the elastic K without conditions. Collective. */
    void find_diagonal(Vector &diagonal) const;

    /**
     * By node, no less than the sums of the rows of the elastic K, as one of numbers: what G does
     * is no stiffer than bonds that are kappa W stiff in all directions, kappa = max(c, lambda V
     * |M^-1|) with the largest eigenvalue lambda of the stiffness, |F|^2 times that and |S| where
     * nodes are deformed. Collective.
     */
    Vector row_sums() const;

    std::size_t memory_consumption() const;

    std::vector<Deformed> deformed; // as of the last linearize() with full kinematics

  private:
    const Families<dim>   &families;
    const BondEnds<dim>   &ends;
    const BondTable<dim>  &bonds;
    const NodeLaws<dim>   &laws;
    std::vector<Shape>     list;
    std::vector<Stiffness> stiffnesses; // of nodes in a row that are alike
    OfBonds<dim, double>   of_bonds;
  };
} // namespace PeriDeal
