// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_gmres.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/analysis/coupling_certificate.h>
#include <perideal/base/matrix_rows.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr double       tolerance       = 1e-4; // of solutions that are errors
    constexpr unsigned int most_iterations = 500;
    constexpr unsigned int n_inverse_steps = 4;


    /** K of the intact body with its whole surface held, and how to invert it. */
    template <int dim>
    class HeldSystem
    {
    public:
      HeldSystem(const FEMOperator<dim> &op, const bool symmetric)
        : op(op)
        , symmetric(symmetric)
      {
        op.assemble_intact(matrix, true);
        op.assemble_intact(elements, false);
        op.initialize_vector(held);
        for (const BoundaryShare &share : op.bonds().families().nodes().boundary_shares())
          held.local_element(share.node) = 1.;
        op.set_hanging(held, 1.);
        inner.copy_from(matrix);
        const Vector known = with_columns_as_ghosts(held, matrix);
        for_each_entry(inner, [&](const unsigned int i, const auto column, double &value) {
          const bool row_held = held.local_element(i) > 0.;
          if (column == held.get_partitioner()->local_to_global(i))
            value = row_held ? 1. : value;
          else if (row_held || known(column) > 0.)
            value = 0.;
        });
        TrilinosWrappers::PreconditionAMG::AdditionalData options;
        options.elliptic              = symmetric;
        options.aggregation_threshold = 0.02;
        preconditioner.initialize(inner, options);
      }

      Vector vector() const
      {
        Vector v;
        op.initialize_vector(v);
        return v;
      }

      void clear_held(Vector &v) const
      {
        for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
          if (held.local_element(i) > 0.)
            v.local_element(i) = 0.;
      }

      /** x = K^{-1} b to a few digits. */
      void solve(Vector &x, const Vector &b) const
      {
        x                 = 0.;
        const double size = b.l2_norm();
        if (size == 0.)
          return;
        SolverControl control(most_iterations, tolerance * size);
        try
          {
            if (symmetric)
              SolverCG<Vector>(control).solve(inner, x, b, preconditioner);
            else
              SolverGMRES<Vector>(control).solve(inner, x, b, preconditioner);
          }
        catch (const SolverControl::NoConvergence &)
          {} // as good as it gets: what is indefinite shows in the eigenvalue
      }

      double patch_error(const std::function<double(const Point<dim> &)> &field) const
      {
        const Nodes<dim> &nodes = op.bonds().families().nodes();
        Vector            u = vector(), defect = vector(), error = vector();
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          u.local_element(i) = field(nodes.position(i));
        matrix.vmult(defect, u);
        elements.vmult(error, u);
        defect -= error;
        clear_held(defect);
        solve(error, defect);
        return error.linfty_norm() / u.linfty_norm();
      }

      double asymmetry() const
      {
        Vector x = vector(), ahead = vector(), back = vector();
        double largest = 0.;
        for (unsigned int trial = 1; trial <= 3; ++trial)
          {
            x = op.noise();
            for (double &value : x)
              value = std::sin(trial * 10. * value);
            matrix.vmult(ahead, x);
            matrix.Tvmult(back, x);
            const double size = std::max(ahead.linfty_norm(), back.linfty_norm());
            back -= ahead;
            largest = std::max(largest, back.linfty_norm() / size);
          }
        return largest;
      }

      /** Inverse iterations, with the Rayleigh quotient at the end. */
      double lowest_eigenvalue() const
      {
        const Vector &capacity = op.lumped_capacity();
        Vector        x = vector(), y = vector();
        x = op.noise();
        clear_held(x);
        for (unsigned int k = 0; k < n_inverse_steps; ++k)
          {
            y = x;
            y.scale(capacity);
            solve(x, y);
            x /= x.l2_norm();
          }
        inner.vmult(y, x);
        const double energy = x * y;
        y                   = x;
        y.scale(capacity);
        return energy / (x * y);
      }

    private:
      const FEMOperator<dim>           &op;
      const bool                        symmetric;
      TrilinosWrappers::SparseMatrix    matrix, elements, inner;
      TrilinosWrappers::PreconditionAMG preconditioner;
      Vector                            held;
    };


    /** Nodes and bonds that the body would have with peridynamics everywhere; a graded mesh would have to be uniform. */
    template <int dim>
    std::pair<unsigned long long, unsigned long long> count_all_bonds(const Families<dim> &families)
    {
      const Nodes<dim>                         &nodes = families.nodes();
      std::vector<typename Families<dim>::Bond> bonds;
      unsigned long long                        n_ends = 0;
      unsigned long long n_sites = nodes.lattice() && families.has_unique_sites() ? 1 : 0;
      for (unsigned int d = 0; d < dim && n_sites > 0; ++d)
        n_sites *= nodes.lattice()->n_sites[d];
      if (nodes.n_global() == n_sites || nodes.is_graded()) // no void
        {
          for (const FamilyMember<dim> &member : families.lattice_members())
            {
              unsigned long long n_pairs = 1;
              for (unsigned int d = 0; d < dim; ++d)
                n_pairs *= std::max(0, nodes.lattice()->n_sites[d] - std::abs(member.offset[d]));
              n_ends += n_pairs;
            }
          return {n_sites, n_ends / 2};
        }
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        {
          families.bonds_of(i, bonds);
          n_ends += bonds.size();
        }
      return {nodes.n_global(), Utilities::MPI::sum(n_ends, nodes.communicator()) / 2};
    }
  } // namespace


  std::string CouplingCertificate::fault() const
  {
    std::ostringstream text;
    if (!(linear <= 1e-10))
      text << "a linear field comes out wrong by " << linear << " of its size";
    else if (lowest_eigenvalue < 0.)
      text << "the lowest eigenvalue is " << lowest_eigenvalue << ", below 0";
    else if (lowest_remainder < -1e-12)
      text << "what is left of a cell has the eigenvalue " << lowest_remainder
           << " times its conductivity, below 0";
    return text.str();
  }


  template <int dim>
  CouplingCertificate examine_coupling(const FEMOperator<dim> &op, const bool symmetric)
  {
    CouplingCertificate  result;
    const Families<dim> &families = op.bonds().families();
    const Nodes<dim>    &nodes    = families.nodes();
    Point<dim>           low, high;
    for (unsigned int d = 0; d < dim; ++d)
      {
        low[d]  = std::numeric_limits<double>::max();
        high[d] = -std::numeric_limits<double>::max();
      }
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      for (unsigned int d = 0; d < dim; ++d)
        {
          low[d]  = std::min(low[d], nodes.position(i)[d]);
          high[d] = std::max(high[d], nodes.position(i)[d]);
        }
    for (unsigned int d = 0; d < dim; ++d)
      {
        low[d]  = Utilities::MPI::min(low[d], nodes.communicator());
        high[d] = Utilities::MPI::max(high[d], nodes.communicator());
      }
    const double size = low.distance(high);
    // Coordinates from -1/2 to 1/2 along the body, in a direction that is not that of any side.
    const auto along = [&](const Point<dim> &p, const std::array<double, 3> &direction) {
      double sum = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        sum += direction[d] * (p[d] - 0.5 * (low[d] + high[d])) / size;
      return sum;
    };
    const std::array<double, 3> first{{0.8, 0.5, -0.33}}, second{{-0.4, 0.7, 0.59}};
    const HeldSystem<dim>       system(op, symmetric);
    result.linear    = system.patch_error([&](const Point<dim> &p) { return along(p, first); });
    result.quadratic = system.patch_error([&](const Point<dim> &p) {
      return along(p, first) * along(p, second) + std::pow(along(p, first), 2);
    });
    result.cubic     = system.patch_error([&](const Point<dim> &p) {
      return std::pow(along(p, first), 2) * along(p, second) + std::pow(along(p, second), 3);
    });
    result.asymmetry = system.asymmetry();
    result.lowest_eigenvalue      = system.lowest_eigenvalue();
    result.lowest_remainder       = op.lowest_remainder();
    result.zone_share             = op.bonds().zone_share();
    const auto [n_nodes, n_bonds] = count_all_bonds(families);
    result.n_bonds_of_full        = n_bonds;
    result.n_nonzeros_of_full     = 2 * n_bonds + n_nodes;
    return result;
  }


#define PERIDEAL_INSTANTIATE(dim) \
  template CouplingCertificate examine_coupling(const FEMOperator<dim> &, const bool);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
