// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/solvers/step_tools.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace PeriDeal
{
  void compute_rate(const Operator &op, Vector &u, const double t, Vector &rate)
  {
    op.distribute(u, t);
    op.residual(rate, u, t);
    const Vector      &capacity = op.lumped_capacity();
    const unsigned int n        = rate.locally_owned_size();
    for (unsigned int i = 0; i < n; ++i)
      rate.local_element(i) /= capacity.local_element(i);
  }


  std::vector<double> inverse_capacity(const Operator &op)
  {
    const Vector       &capacity = op.lumped_capacity();
    std::vector<double> inverse(capacity.locally_owned_size());
    std::transform(capacity.begin(), capacity.end(), inverse.begin(), [](const double c) {
      return 1. / c;
    });
    return inverse;
  }


  std::vector<bool> held_unknowns(const Operator &op)
  {
    Vector mark;
    op.initialize_vector(mark);
    mark = 1.;
    op.clear_constrained(mark);
    std::vector<bool> held(mark.locally_owned_size());
    std::transform(mark.begin(), mark.end(), held.begin(), [](const double m) { return m == 0.; });
    return held;
  }


  std::size_t memory_of(const std::initializer_list<const Vector *> vectors)
  {
    std::size_t sum = 0;
    for (const Vector *vector : vectors)
      sum += vector->memory_consumption();
    return sum;
  }


  double capacity_norm(const Operator &op, const Vector &v)
  {
    const double      *capacity = op.lumped_capacity().begin(), *values = v.begin();
    double             sums[2] = {0., 0.};
    const unsigned int n       = v.locally_owned_size();
    for (unsigned int i = 0; i < n; ++i)
      {
        sums[0] += capacity[i] * values[i] * values[i];
        sums[1] += capacity[i];
      }
    for (double &sum : sums)
      sum = dealii::Utilities::MPI::sum(sum, v.get_mpi_communicator());
    return std::sqrt(sums[0] / sums[1]);
  }


  double local_tolerance(const double tolerance)
  {
    return std::min(tolerance, 10. * tolerance * std::sqrt(tolerance));
  }


  Diverged not_finite(const std::string &message, const double t)
  {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    return Diverged(message, "finite values", none, none, t);
  }


  void check_finite(const Vector &u, const std::string &stepper, const double t)
  {
    if (std::isfinite(u.l1_norm()))
      return;
    std::ostringstream message;
    message << "The run became unstable: stepper '" << stepper
            << "' produced values that are not finite before t = " << t
            << ". Choose a smaller 'Time step', or 'Stepper = auto', in section 'Time'.";
    throw not_finite(message.str(), t);
  }


  void require_mass(const ElasticOperator &op)
  {
    const Vector      &mass = op.lumped_capacity();
    std::ostringstream message;
    for (unsigned int i = 0; i < mass.locally_owned_size() && message.str().empty(); ++i)
      if (!(mass.local_element(i) > 0.))
        message << "'Density' in section 'Material' is "
                << (mass.local_element(i) < 0. ? "negative" : "zero") << " at " << op.place_of(i)
                << ": motion needs a positive density everywhere. Bodies at rest need none: "
                   "'Solver = linear' or 'conjugate gradients' in section 'Elasticity'.";
    throw_on_all_if_any(mass.get_mpi_communicator(), message.str());
  }


  std::string inverted_text(const Inversion &found)
  {
    return "the body is inside out at " + std::to_string(found.n_nodes) +
           (found.n_nodes == 1 ? " node" : " nodes, worst at ") + (found.n_nodes == 1 ? ", " : "") +
           found.place +
           ": neighbours that bonds hold together have passed through each other, which bonds do not prevent. "
           "Such a state means nothing: make the load smaller, or let it grow more slowly with t. Where a traction acts on a single row of nodes "
           "spread it by 'Traction layer' in section 'Boundary conditions', or use larger cells.";
  }


  unsigned long long n_equal_steps(const double span, const double dt)
  {
    return std::max(1ULL, static_cast<unsigned long long>(std::ceil(span / dt * (1. - 1e-10))));
  }
} // namespace PeriDeal
