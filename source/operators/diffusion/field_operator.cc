// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/matrix_rows.h>
#include <perideal/base/node_loops.h>
#include <perideal/operators/diffusion/field_operator.h>

#include <algorithm>
#include <numeric>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void FieldOperator<dim>::set_parts(const PrescribedValues<dim>        &values,
                                     const DiffusionLoads<dim>          &of_sides,
                                     const std::initializer_list<Term *> list)
  {
    prescribed = &values;
    loads      = &of_sides;
    terms      = list;
    if (prescribed->any_slave())
      this->initialize_vector(scratch);
  }


  template <int dim>
  void FieldOperator<dim>::add_up(Vector           &y,
                                  const Term::At   &at,
                                  double           &entered,
                                  const RowsAction &finish) const
  {
    for (const Term *term : terms)
      term->begin(at, entered);
    terms[0]->set_then(y, at, [&](const unsigned int begin, const unsigned int end) {
      for (std::size_t k = 1; k < terms.size(); ++k)
        terms[k]->add(y, at, begin, end);
      entered += prescribed->sum(y, begin, end);
      finish(begin, end);
    });
  }


  template <int dim>
  void FieldOperator<dim>::multiply(Vector &y, const Vector &u, const double t) const
  {
    double entered = 0.;
    add_up(y, {u, t}, entered, [](const unsigned int, const unsigned int) {});
  }


  template <int dim>
  void FieldOperator<dim>::apply_then(Vector &y, const Vector &x, const RowsAction &finish) const
  {
    ++this->applications;
    const Vector *input = &x;
    if (prescribed->any_slave())
      {
        scratch = x;
        prescribed->distribute_homogeneous(scratch);
        input = &scratch;
      }
    double &entered = this->entering_now;
    entered         = loads->through_transfer(*input);
    add_up(y, {*input, 0., true}, entered, [&](const unsigned int begin, const unsigned int end) {
      prescribed->mask(y, 0., begin, end);
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
    const Vector &now     = loads->at(t);
    double       *values  = r.begin();
    double       &entered = this->entering_now;
    entered               = loads->through_transfer(u);
    add_up(r, {u, t}, entered, [&](const unsigned int begin, const unsigned int end) {
      if (loads->any())
        NodeLoops::subtract_from(values + begin, now.begin() + begin, end - begin);
      else
        NodeLoops::negate(values + begin, end - begin);
      prescribed->mask(r, 0., begin, end);
      finish(begin, end);
    });
    entered +=
      loads->sum() - prescribed->sum(now, 0, r.locally_owned_size()) + loads->through_slaves(t);
  }


  template <int dim>
  bool FieldOperator<dim>::symmetric() const
  {
    return !prescribed->any_slave() &&
           std::all_of(terms.begin(), terms.end(), [](const Term *term) {
             return term->symmetric();
           });
  }


  template <int dim>
  bool FieldOperator<dim>::has_steady_state() const
  {
    const auto &conditions = this->body.boundary_conditions;
    return prescribed->any() || conditions.transfers_fix_level() || !conditions.dirichlet.empty();
  }


  template <int dim>
  void FieldOperator<dim>::surrogate(TrilinosWrappers::SparseMatrix &matrix) const
  {
    make_surrogate(matrix);
    Vector held(this->layout);
    prescribed->mask(held, 1.);
    hold_unknowns(matrix, held);
  }


  template <int dim>
  OperatorSize FieldOperator<dim>::size() const
  {
    OperatorSize size = DiffusionOperatorBase<dim>::size();
    size.memory += loads->memory_consumption() + scratch.memory_consumption();
    for (auto term = terms.rbegin(); term != terms.rend(); ++term)
      (*term)->add_to(size);
    return size;
  }


  template <int dim>
  void FieldOperator<dim>::find_flows(Balance      &balance,
                                      Vector       &heat,
                                      const Vector &u,
                                      const double  t) const
  {
    multiply(heat, u, t);
    heat -= loads->at(t);
    // In a prescribed node it has come in through the node's side.
    prescribed->add_to(balance.sides, heat);
    for (const Term *term : terms)
      term->add_flows(balance, {u, t});
    loads->add_to(balance, u, t);
    if (this->body.cracks.conduct())
      add_crack_heat(balance, u);
    balance.content = content(u);
  }


  template <int dim>
  typename FieldOperator<dim>::Rows FieldOperator<dim>::all_rows() const
  {
    Rows rows(this->layout->locally_owned_size());
    std::iota(rows.begin(), rows.end(), 0);
    return rows;
  }


  template <int dim>
  std::vector<double> FieldOperator<dim>::take_rows(const Rows &rows)
  {
    std::vector<double> sums(rows.size(), 0.);
    for (const unsigned int i : rows)
      this->stiffness_diagonal.local_element(i) = 0.;
    for (const Term *term : terms)
      {
        term->add_diagonal(this->stiffness_diagonal, rows);
        term->add_row_sums(sums, rows);
      }
    return sums;
  }


  template <int dim>
  double FieldOperator<dim>::largest_rate(const Rows &rows, const std::vector<double> &sums) const
  {
    double rate = 0.;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (counts(rows[k]))
        rate = std::max(rate, sums[k] / this->capacity.local_element(rows[k]));
    return Utilities::MPI::max(rate, this->layout->get_mpi_communicator());
  }


  PERIDEAL_INSTANTIATE_CLASS(class FieldOperator);
} // namespace PeriDeal
