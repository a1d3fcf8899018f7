// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/diffusion_bonds.h>
#include <perideal/scene/choices.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * How the sum over the bonds of each node, y_i = sum_j W_ij (u_i - u_j), is stored and evaluated.
   * All forms give the same numbers to round-off. Evaluation allocates nothing and is not
   * collective.
   */
  class BondForm
  {
  public:
    /** Called with the first and past the last of some owned nodes. */
    using NodesAction = std::function<void(const unsigned int begin, const unsigned int end)>;

    virtual ~BondForm() = default;

    /**
     * @param values  owned and ghost values
     * @param outside values of the fictitious nodes (may be null if there are none)
     * @param y       n_owned sums, overwritten
     * @param finish  if not empty, called once for each node when its sum is known and still in
     *                cache, many nodes at a time; it may change y of these nodes, but no values
     */
    virtual void apply(double            *y,
                       const double      *values,
                       const double      *outside,
                       const NodesAction &finish) const = 0;

    void apply(double *y, const double *values, const double *outside) const
    {
      apply(y, values, outside, NodesAction());
    }

    /**
     * The sum of W_ij over each owned node's family. Returns the number of this process's unbroken
     * bonds; one between two real nodes counts half at each.
     */
    virtual double row_sums(double *sums) const = 0;

    /**
     * The conductances of these owned nodes' bonds have changed (CrackSet::apply_change(),
     * NodeFactors::set()): take them anew, and write the rows' sums of W_ij to sums[node]. Costs in
     * proportion to the rows, apart from a copy of the stored corrections.
     *
     * @param rows in ascending order
     */
    virtual void update_rows(const std::vector<unsigned int> &rows, double *sums) = 0;

    /**
     * The conductivities of all nodes have changed (BondConductivities::take_at()): scale each
     * bond, and write the sums of all rows.
     */
    virtual void update_conductivities(double *sums) = 0;

    /** Bytes held. */
    virtual std::size_t memory_consumption() const = 0;

    /** Numbers stored for bonds of this process. */
    virtual unsigned long long n_stored() const = 0;

    /** `lattice` or `stored`. */
    virtual std::string name() const = 0;
  };


  /** Every bond stored, in compressed rows with 32-bit columns: any nodes, any bonds. */
  template <int dim>
  std::unique_ptr<BondForm> make_stored_form(const DiffusionBonds<dim> &bonds);

  /**
   * No bond stored: the family of a lattice is the same everywhere, so the sum is a convolution on
   * a grid padded with zeros, minus a diagonal that knows the body's edge. Bonds that differ from
   * the template (cut by a crack, other conductivity, self term at edges) are kept as a list of
   * corrections. Only for nodes with unique lattice sites.
   */
  template <int dim>
  std::unique_ptr<BondForm> make_lattice_form(const DiffusionBonds<dim> &bonds);

  /**
   * Whether the lattice form is possible and pays: unique sites and one conductivity. Says why not
   * in @p reason.
   */
  template <int dim>
  bool lattice_form_suits(const DiffusionBonds<dim> &bonds, std::string &reason);

  /**
   * Whether bonds take the lattice form under the entry `Operator form`. @param reason why they
   * cannot, or empty; @param pays with `auto`. Throws UserError where they have to, but cannot.
   */
  bool takes_lattice_form(const OperatorForm wanted, const std::string &reason, const bool pays);
} // namespace PeriDeal
