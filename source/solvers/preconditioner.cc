// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/base/matrix_rows.h>
#include <perideal/solvers/preconditioner.h>

#include <Epetra_MultiVector.h>
#include <Teuchos_ParameterList.hpp>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * The inverse diagonal overlaps with multigrid on wavelengths near the horizon, where with a
     * factor of one the sum of both would be nearly twice the inverse of K. Half of it needs 17 to
     * 18 iterations where one needs 22 (residual 1e-10, m = 6.5), 0.3 and 0.8 need 19 and 20.
     */
    constexpr double share_of_diagonal = 0.5;

    /**
     * Entries below this share of sqrt(K_ii K_jj) do not join an aggregate. Bonds that are longer
     * than a cell are such entries beside a crack; taken for strong ones they make aggregates too
     * large there: 11 to 14 iterations of the coupled model (m = 3, 21^2 to 321^2 cells) where
     * these need 10 to 12, and finite elements 10 to 11 with either. All entries of square and
     * cubic elements are above it.
     */
    constexpr double weakest_link = 0.02;

    /**
     * Of the diagonal, added to it: fragments that nothing holds any more make the surrogate
     * singular, and its factorization without it would be that of round-off. (The lowest modes of
     * a slender body are above 1e-8.)
     */
    constexpr double hold_of_fragments = 1e-10;
  } // namespace


  struct MultigridPreconditioner::Data
  {
    TrilinosWrappers::SparseMatrix    surrogate, shifted;
    TrilinosWrappers::PreconditionAMG multigrid;
    Vector                            inverse_diagonal;
    mutable Vector                    scratch;
  };


  MultigridPreconditioner::MultigridPreconditioner(const Operator    &op,
                                                   const unsigned int direct_up_to)
    : op(op)
    , direct_up_to(direct_up_to)
    , data(std::make_unique<Data>())
  {
    op.surrogate(data->surrogate);
    op.initialize_vector(data->inverse_diagonal);
    op.initialize_vector(data->scratch);
  }


  MultigridPreconditioner::~MultigridPreconditioner() = default;


  void MultigridPreconditioner::initialize(const double a, const double b)
  {
    const Vector &capacity = op.lumped_capacity();
    const Vector &diagonal = op.surrogate_diagonal();
    Vector        is_free;
    op.initialize_vector(is_free);
    is_free = 1.;
    op.clear_constrained(is_free);

    data->shifted.copy_from(data->surrogate);
    data->shifted *= b;
    const double held = 1. + (a == 0. && !op.surrogate_is_exact() ? hold_of_fragments : 0.);
    for_each_entry(data->shifted, [&](const unsigned int i, const auto column, double &value) {
      if (column == capacity.get_partitioner()->local_to_global(i))
        value = is_free.local_element(i) == 0. ? 1. : held * value + a * capacity.local_element(i);
    });
    for (unsigned int i = 0; i < capacity.locally_owned_size(); ++i)
      data->inverse_diagonal.local_element(i) =
        is_free.local_element(i) == 0. ?
          0. :
          share_of_diagonal / (a * capacity.local_element(i) + b * diagonal.local_element(i));

    TrilinosWrappers::PreconditionAMG::AdditionalData options;
    options.elliptic              = true;
    options.higher_order_elements = false;
    // Smoothing is for what varies fast: there the inverse diagonal does the work unless the
    // surrogate is the operator itself.
    options.smoother_sweeps       = op.surrogate_is_exact() ? 2 : 1;
    options.aggregation_threshold = weakest_link;
    Teuchos::ParameterList              list;
    std::unique_ptr<Epetra_MultiVector> constant_modes; // of a scalar operator none of their own
    options.set_parameters(list, constant_modes, data->shifted);
    list.set("coarse: max size", static_cast<int>(direct_up_to));
    // ML reads the modes while it sets up.
    const std::vector<Vector> modes  = op.near_null_space();
    const unsigned int        n_rows = capacity.locally_owned_size();
    std::vector<double>       values;
    for (const Vector &mode : modes)
      values.insert(values.end(), mode.begin(), mode.begin() + n_rows);
    if (!modes.empty())
      {
        list.set("PDE equations", static_cast<int>(op.n_components()));
        list.set("null space: type", "pre-computed");
        list.set("null space: dimension", static_cast<int>(modes.size()));
        list.set("null space: vectors", values.data());
        list.set("null space: add default vectors", false);
      }
    data->multigrid.initialize(data->shifted, list);
  }


  const TrilinosWrappers::SparseMatrix &MultigridPreconditioner::surrogate() const
  {
    return data->surrogate;
  }


  void MultigridPreconditioner::vmult(Vector &y, const Vector &x) const
  {
    data->multigrid.vmult(y, x);
    if (!op.surrogate_is_exact())
      {
        data->scratch = x;
        data->scratch.scale(data->inverse_diagonal);
        y += data->scratch;
      }
    op.clear_constrained(y);
  }
} // namespace PeriDeal
