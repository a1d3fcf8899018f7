// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/matrix_rows.h>
#include <perideal/base/node_loops.h>
#include <perideal/base/place_text.h>
#include <perideal/operators/diffusion/field_operator.h>

#include <algorithm>
#include <numeric>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    std::vector<unsigned int> all_rows(const Vector &layout)
    {
      std::vector<unsigned int> rows(layout.locally_owned_size());
      std::iota(rows.begin(), rows.end(), 0);
      return rows;
    }


    /** y = K u and finish; adds what flows in through terms and prescribed unknowns. */
    template <int dim>
    void add_up(const FieldParts<dim>               &parts,
                Vector                              &y,
                const typename Term<dim>::At        &at,
                double                              &entered,
                const DiffusionOperator::RowsAction &finish)
    {
      const auto &terms = parts.terms;
      for (const auto &term : terms)
        term->begin(at, entered);
      terms[0]->set_then(y, at, [&](const unsigned int begin, const unsigned int end) {
        for (std::size_t k = 1; k < terms.size(); ++k)
          terms[k]->add(y, at, begin, end);
        entered += parts.values->sum(y, begin, end);
        finish(begin, end);
      });
    }


    /**
     * Take the diagonal of some rows from the terms, also where they are not free. Returns the sums
     * of the absolute values of their entries. Not collective.
     */
    template <int dim>
    std::vector<double> take_rows(const FieldParts<dim>           &parts,
                                  const std::vector<unsigned int> &rows,
                                  Vector                          &diagonal)
    {
      std::vector<double> sums(rows.size(), 0.);
      for (const unsigned int i : rows)
        diagonal.local_element(i) = 0.;
      for (const auto &term : parts.terms)
        term->add_rows(diagonal, sums, rows);
      return sums;
    }


    /** Gershgorin's bound of these rows on all processes, with take_rows()'s sums. Collective. */
    template <int dim>
    double largest_rate(const FieldParts<dim>           &parts,
                        const std::vector<unsigned int> &rows,
                        const std::vector<double>       &sums)
    {
      double rate = 0.;
      for (std::size_t k = 0; k < rows.size(); ++k)
        if (parts.values->counts_in_bounds(rows[k]))
          rate = std::max(rate, sums[k] / parts.capacity->lumped().local_element(rows[k]));
      return Utilities::MPI::max(rate, parts.layout->get_mpi_communicator());
    }


    /** The same of the rows that are none of DiffusionLoads::curved_rows(). Collective. */
    template <int dim>
    double largest_rate_elsewhere(const FieldParts<dim>           &parts,
                                  const std::vector<unsigned int> &rows,
                                  const std::vector<double>       &sums)
    {
      if (!parts.loads->depends_on_solution())
        return 0.;
      const auto               &curved = parts.loads->curved_rows();
      std::vector<unsigned int> others;
      std::vector<double>       sums_there;
      for (std::size_t k = 0; k < rows.size(); ++k)
        if (!std::binary_search(curved.begin(), curved.end(), rows[k]))
          {
            others.push_back(rows[k]);
            sums_there.push_back(sums[k]);
          }
      return largest_rate(parts, others, sums_there);
    }
  } // namespace


  template <int dim>
  FieldOperator<dim>::FieldOperator(const BodyParameters<dim> &body, const FieldParts<dim> &parts)
    : DiffusionOperator(parts.layout, parts.capacity)
    , body(body)
    , parts(parts)
    , bounds(*this, [this](Vector &vector) {
      this->parts.for_each_place([&](const unsigned int i, const Point<dim> &p) {
        vector.local_element(i) = position_noise(p);
      });
    })
  {
    if (parts.values->any_slave())
      this->initialize_vector(scratch);
    take_all_rows(RowsOfK::After::start);
  }


  template <int dim>
  void FieldOperator<dim>::take_all_rows(const RowsOfK::After after)
  {
    const auto all  = all_rows(stiffness_diagonal);
    const auto sums = take_rows(parts, all, stiffness_diagonal);
    for (const auto &term : parts.terms)
      term->require_held({after, all, sums, stiffness_diagonal, bounds.safe()});
    bounds.set(largest_rate(parts, all, sums));
    rate_elsewhere = largest_rate_elsewhere(parts, all, sums);
    parts.values->mask(stiffness_diagonal, 1.);
  }


  template <int dim>
  void FieldOperator<dim>::multiply(Vector &y, const Vector &u, const double t) const
  {
    double entered = 0.;
    add_up(parts, y, {u, t}, entered, [](const unsigned int, const unsigned int) {});
  }


  template <int dim>
  void FieldOperator<dim>::apply_then(Vector &y, const Vector &x, const RowsAction &finish) const
  {
    ++this->applications;
    const Vector *input = &x;
    if (parts.values->any_slave())
      {
        scratch = x;
        parts.values->distribute_homogeneous(scratch);
        input = &scratch;
      }
    double &entered = this->entering_now;
    entered         = parts.loads->through_transfer(*input);
    add_up(parts,
           y,
           {*input, 0., true},
           entered,
           [&](const unsigned int begin, const unsigned int end) {
             parts.values->mask(y, 0., begin, end);
             finish(begin, end);
           });
  }


  template <int dim>
  void FieldOperator<dim>::residual_then(Vector           &r,
                                         const Vector     &u,
                                         const double      t,
                                         const RowsAction &finish) const
  {
    ++this->applications;
    const auto   &loads   = *parts.loads;
    const Vector &now     = loads.at(t);
    double       *values  = r.begin();
    double       &entered = this->entering_now;
    entered               = loads.through_transfer(u);
    add_up(parts, r, {u, t}, entered, [&](const unsigned int begin, const unsigned int end) {
      if (loads.any())
        NodeLoops::subtract_from(values + begin, now.begin() + begin, end - begin);
      else
        NodeLoops::negate(values + begin, end - begin);
      parts.values->mask(r, 0., begin, end);
      finish(begin, end);
    });
    entered +=
      loads.sum() - parts.values->sum(now, 0, r.locally_owned_size()) + loads.through_slaves(t);
  }


  template <int dim>
  Spectrum FieldOperator<dim>::spectrum() const
  {
    if (depends_on_solution()) // changes with each step, and the safe bound costs nothing
      return {bounds.safe(), bounds.safe()};
    return bounds.get();
  }


  template <int dim>
  bool FieldOperator<dim>::symmetric() const
  {
    return !parts.values->any_slave() &&
           std::all_of(parts.terms.begin(), parts.terms.end(), [](const auto &term) {
             return term->symmetric();
           });
  }


  template <int dim>
  bool FieldOperator<dim>::has_steady_state() const
  {
    const auto &conditions = body.boundary_conditions;
    return parts.values->any() || conditions.transfers_fix_level() ||
           !conditions.dirichlet.empty() || body.initial_and_source.source.depends_on_temperature();
  }


  template <int dim>
  void FieldOperator<dim>::surrogate(TrilinosWrappers::SparseMatrix &matrix) const
  {
    Vector              others(layout);
    const auto          all = all_rows(others);
    std::vector<double> sums(all.size());
    for (std::size_t k = 1; k < parts.terms.size(); ++k)
      parts.terms[k]->add_rows(others, sums, all);
    first_term().make_surrogate(matrix, others);
    Vector held(layout);
    parts.values->mask(held, 1.);
    hold_unknowns(matrix, held);
  }


  template <int dim>
  bool FieldOperator<dim>::update(const double t)
  {
    const auto change = parts.history.change(parts.cracks_of, t);
    if (!change)
      return false;
    parts.cracks_of = change->to;
    return apply_change(*change);
  }


  template <int dim>
  bool FieldOperator<dim>::follow(ChangeSet<dim> change)
  {
    change.from = change.to = parts.cracks_of;
    return apply_change(change);
  }


  template <int dim>
  bool FieldOperator<dim>::apply_change(const ChangeSet<dim> &change)
  {
    Mended mended;
    for (const auto &term : parts.terms)
      mended.add(term->apply_change(change));
    if (change.cuts.empty())
      return false;
    const auto  &rows = mended.rows;
    const auto   sums = take_rows(parts, rows, stiffness_diagonal);
    const double safe = bounds.safe();
    for (const auto &term : parts.terms)
      term->require_held({RowsOfK::After::change, rows, sums, stiffness_diagonal, safe});
    if (mended.stiffer || parts.history.may_close())
      {
        const double rate = largest_rate(parts, rows, sums);
        if (mended.local_bound)
          bounds.raise(rate, rows, [&](const double enough) {
            return this->symmetric() ? mended.local_bound(rows, noise(), enough) : -1.;
          });
        else
          bounds.set(std::max(safe, rate));
        rate_elsewhere = std::max(rate_elsewhere, largest_rate_elsewhere(parts, rows, sums));
      }
    parts.values->mask(stiffness_diagonal, 1.);
    return true;
  }


  template <int dim>
  void FieldOperator<dim>::take_material_at(const Vector &u, const double t)
  {
    if (!depends_on_solution())
      return;
    if (parts.loads->depends_on_solution())
      parts.loads->take_at(u, t, body.run.steady);
    parts.capacity->take_at(u);
    for (const auto &term : parts.terms)
      term->take_material_at(u);
    if (body.material.depends_on_temperature())
      {
        take_all_rows(RowsOfK::After::new_temperatures);
        return;
      }
    const auto &rows = parts.loads->curved_rows();
    const auto  sums = take_rows(parts, rows, stiffness_diagonal);
    bounds.set(std::max(rate_elsewhere, largest_rate(parts, rows, sums)));
    parts.values->mask(stiffness_diagonal, 1.);
  }


  template <int dim>
  Balance FieldOperator<dim>::balance(const Vector &u, const double t, const bool steady) const
  {
    const MPI_Comm communicator = layout->get_mpi_communicator();
    Balance        balance;
    body.boundary_conditions.for_each(
      [&](const auto &, const auto &condition) { balance.sides[condition.name]; });
    balance.cracks.assign(body.cracks.cracks.size(), 0.);
    Vector heat(layout); // K u - f(t): where unknowns are free it is not stored
    multiply(heat, u, t);
    heat -= parts.loads->at(t);
    // In a prescribed node it has come in through the node's side.
    parts.values->add_to(balance.sides, heat);
    for (const auto &term : parts.terms)
      term->add_flows(balance, {u, t});
    parts.loads->add_to(balance, u, t);
    balance.content = parts.capacity->content(u);
    this->clear_constrained(heat);
    if (!steady)
      for (unsigned int i = 0; i < heat.locally_owned_size(); ++i)
        balance.stored -= heat.local_element(i);
    for (auto &[name, value] : balance.sides)
      value = Utilities::MPI::sum(value, communicator);
    for (double *value : {&balance.sources, &balance.stored, &balance.content})
      *value = Utilities::MPI::sum(*value, communicator);
    for (double &value : balance.cracks)
      value = Utilities::MPI::sum(value, communicator);
    return balance;
  }


  template <int dim>
  std::string FieldOperator<dim>::place_of(const unsigned int local_index) const
  {
    Point<dim> found;
    parts.for_each_place([&](const unsigned int i, const Point<dim> &p) {
      if (i == local_index)
        found = p;
    });
    return place_text(found);
  }


  template <int dim>
  OperatorSize FieldOperator<dim>::size() const
  {
    OperatorSize size;
    size.unknowns = layout->size();
    size.memory   = capacity->memory_consumption() + stiffness_diagonal.memory_consumption() +
                  parts.loads->memory_consumption() + scratch.memory_consumption();
    for (auto term = parts.terms.rbegin(); term != parts.terms.rend(); ++term)
      (*term)->add_to(size);
    return size;
  }


  PERIDEAL_INSTANTIATE_CLASS(class FieldOperator);
} // namespace PeriDeal
