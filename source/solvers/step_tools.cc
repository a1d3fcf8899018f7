// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>

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


  namespace
  {
    /** T_s(x) of any x. */
    double chebyshev_polynomial(const unsigned int s, const double x)
    {
      if (std::abs(x) <= 1.)
        return std::cos(s * std::acos(x));
      const double size = std::cosh(s * std::acosh(std::abs(x)));
      return x < 0. && s % 2 == 1 ? -size : size;
    }


    /** Where |a + b T_s(w0 - w1 z)| = 1 beyond the interval in which T_s oscillates. */
    double rkc2_limit(const unsigned int s)
    {
      const RkcCoefficients k(s);
      if (s % 2 == 0) // T_s is even: it comes back to its value at z = 0, where all is left
        return 2. * k.w0 / k.w1;
      const double size = (1. + k.a[s]) / k.b[s];
      return (k.w0 + std::cosh(std::acosh(size) / s)) / k.w1;
    }
  } // namespace


  double amplification(const std::string &method, const double z, const unsigned int n_stages)
  {
    if (method == "euler")
      return std::abs(1. - z);
    if (method == "rk4")
      return std::abs(1. - z * (1. - z / 2. * (1. - z / 3. * (1. - z / 4.))));
    if (method == "verlet")
      {
        const double half_trace = 0.5 * z * z - 1.;
        return z <= 2. ? 1. : half_trace + std::sqrt(half_trace * half_trace - 1.);
      }
    Assert(method == "rkc2" && n_stages >= 2, dealii::ExcMessage("No method with this factor."));
    const RkcCoefficients k(n_stages);
    return std::abs(k.a[n_stages] +
                    k.b[n_stages] * chebyshev_polynomial(n_stages, k.w0 - k.w1 * z));
  }


  double stability_limit(const std::string &method, const unsigned int n_stages)
  {
    if (method == "euler" || method == "verlet")
      return 2.;
    if (method == "rk4")
      return 2.785293563405282; // where |1 - z + z^2/2 - z^3/6 + z^4/24| = 1
    if (method == "rkc2" && n_stages >= 2)
      return rkc2_limit(n_stages);
    return std::numeric_limits<double>::infinity();
  }


  unsigned int rkc2_stages(const double z)
  {
    // Beyond the interval in which T_s oscillates nothing is damped: z <= (1 + w0)/w1, which is at
    // least (s^2 - 1)/1.54.
    return std::max(2u, 1u + static_cast<unsigned int>(std::sqrt(1.54 * z + 1.)));
  }


  Diverged inversion_error(const std::string &message, const Inversion &found, const double t)
  {
    Diverged           error(message, "inversion", found.n_nodes, 0., t);
    std::istringstream place(found.place); // `(x, y)`
    char               mark = 0;
    for (double x = 0.; place >> mark >> x;)
      error.trip.place.push_back(x);
    return error;
  }
} // namespace PeriDeal
