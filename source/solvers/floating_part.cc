// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/base/connected_sets.h>
#include <perideal/base/matrix_rows.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/surface_transfer.h>
#include <perideal/solvers/floating_part.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <vector>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** 1 on unknowns that are free, 0 elsewhere. */
    Vector free_unknowns(const Operator &op)
    {
      Vector is_free;
      op.initialize_vector(is_free);
      is_free = 1.;
      op.clear_constrained(is_free);
      return is_free;
    }


    /** All free unknowns of a node move together. */
    void join_components(const unsigned int n_components,
                         const Vector      &is_free,
                         ConnectedSets     &sets)
    {
      for (unsigned int i = 0; i < is_free.locally_owned_size(); ++i)
        for (unsigned int j = i - i % n_components; j < i; ++j)
          if (is_free.local_element(i) > 0. && is_free.local_element(j) > 0.)
            sets.join(i, j);
    }


    /**
     * For each owned free unknown the number of its connected part, the lowest global index in it;
     * 0 on others. Each sweep joins the parts within the processes, so that few are needed: about
     * as many as a part visits processes.
     */
    Vector number_parts(const Operator &op, const TrilinosWrappers::SparseMatrix &surrogate)
    {
      Vector      is_free     = free_unknowns(op);
      const auto &partitioner = *is_free.get_partitioner();
      is_free.update_ghost_values();
      const unsigned int n_owned = partitioner.locally_owned_size();
      ConnectedSets      sets(n_owned + partitioner.n_ghost_indices());
      for_each_entry(surrogate, [&](const unsigned int i, const auto column, const double value) {
        if (value == 0. || is_free.local_element(i) == 0. ||
            !(partitioner.in_local_range(column) || partitioner.is_ghost_entry(column)))
          return;
        const unsigned int j = partitioner.global_to_local(column);
        if (is_free.local_element(j) > 0.)
          sets.join(i, j);
      });
      join_components(op.n_components(), is_free, sets);
      Vector part;
      op.initialize_vector(part);
      for (unsigned int i = 0; i < n_owned; ++i)
        part.local_element(i) = is_free.local_element(i) > 0. ?
                                  static_cast<double>(partitioner.local_to_global(i)) + 1. :
                                  0.;
      std::vector<double> lowest(n_owned + partitioner.n_ghost_indices());
      for (bool changed = true; changed;)
        {
          changed = false;
          part.update_ghost_values();
          std::fill(lowest.begin(), lowest.end(), std::numeric_limits<double>::max());
          for (unsigned int i = 0; i < lowest.size(); ++i)
            if (part.local_element(i) > 0.)
              lowest[sets.root(i)] = std::min(lowest[sets.root(i)], part.local_element(i));
          for (unsigned int i = 0; i < n_owned; ++i)
            if (part.local_element(i) > lowest[sets.root(i)])
              {
                part.local_element(i) = lowest[sets.root(i)];
                changed               = true;
              }
          part.zero_out_ghost_values();
          changed = Utilities::MPI::max(changed ? 1 : 0, is_free.get_mpi_communicator()) > 0;
        }
      return part;
    }


    /**
     * Numbers of the parts on which K applied to one vanishes: nothing from outside acts on them.
     */
    std::set<double> numbers_of_loose_parts(const Operator &op, const Vector &part)
    {
      Vector ones = free_unknowns(op), image;
      op.initialize_vector(image);
      op.apply(image, ones);
      std::set<double> all, held;
      for (unsigned int i = 0; i < part.locally_owned_size(); ++i)
        if (part.local_element(i) > 0.)
          {
            all.insert(part.local_element(i));
            if (std::abs(image.local_element(i)) > 1e-12 * op.diagonal().local_element(i))
              held.insert(part.local_element(i));
          }
      for (std::set<double> *list : {&all, &held})
        for (const auto &others :
             Utilities::MPI::all_gather(part.get_mpi_communicator(),
                                        std::vector<double>(list->begin(), list->end())))
          list->insert(others.begin(), others.end());
      for (const double number : held)
        all.erase(number);
      return all;
    }
  } // namespace


  void check_no_floating_part(const Operator                       &op,
                              const TrilinosWrappers::SparseMatrix &surrogate,
                              const bool                            is_guess)
  {
    const Vector part         = number_parts(op, surrogate);
    const auto   communicator = part.get_mpi_communicator();
    for (const double number : numbers_of_loose_parts(op, part))
      {
        Vector indicator, image;
        op.initialize_vector(indicator);
        op.initialize_vector(image);
        double n = 0.;
        for (unsigned int i = 0; i < part.locally_owned_size(); ++i)
          if (part.local_element(i) == number)
            {
              indicator.local_element(i) = 1.;
              n += 1.;
            }
        op.apply(image, indicator);
        double largest = 0.;
        for (unsigned int i = 0; i < part.locally_owned_size(); ++i)
          largest =
            std::max(largest, std::abs(image.local_element(i)) / op.diagonal().local_element(i));
        n       = Utilities::MPI::sum(n, communicator);
        largest = Utilities::MPI::max(largest, communicator);
        if (largest > 1e-12)
          continue; // longer bonds hold it
        const auto  index = static_cast<types::global_dof_index>(number) - 1;
        std::string message;
        if (part.in_local_range(index))
          message =
            "The steady state is not determined in a part of the body with " +
            std::to_string(static_cast<unsigned long long>(n)) + " unknowns, one of them at " +
            op.place_of(part.get_partitioner()->global_to_local(index)) +
            ": cracks (section 'Cracks') have cut it off from all sides in " +
            entries_that_fix_level() +
            " (section 'Boundary conditions'). "
            "Give one of its sides such a condition, shorten the cracks, or give them a 'Transmission'." +
            (is_guess ?
               " Where what enters depends on the temperature, as T, it has to fall with T at the first guess: give another 'Initial value' (section 'Initial and source')." :
               "");
        throw_on_all_if_any(communicator, message);
      }
  }

  namespace
  {
    /** Numbers of each part, first of this process, then of all. */
    using PartSums = std::map<double, Eigen::MatrixXd>;


    Eigen::MatrixXd &sum_of(PartSums          &sums,
                            const double       part,
                            const Eigen::Index n_rows,
                            const Eigen::Index n_columns)
    {
      auto entry = sums.find(part);
      if (entry == sums.end())
        entry = sums.emplace(part, Eigen::MatrixXd::Zero(n_rows, n_columns)).first;
      return entry->second;
    }


    void sum_over_processes(PartSums &sums, const MPI_Comm communicator)
    {
      std::map<double, std::vector<double>> own;
      Eigen::Index                          n_rows = 0;
      for (const auto &[part, values] : sums)
        {
          own[part].assign(values.data(), values.data() + values.size());
          n_rows = values.rows();
        }
      n_rows = Utilities::MPI::max(static_cast<unsigned int>(n_rows), communicator);
      sums.clear();
      for (const auto &others : Utilities::MPI::all_gather(communicator, own))
        for (const auto &[part, numbers] : others)
          {
            const Eigen::Map<const Eigen::MatrixXd> values(
              numbers.data(),
              n_rows,
              static_cast<Eigen::Index>(numbers.size()) / n_rows);
            const auto [entry, is_new] = sums.try_emplace(part, values);
            if (!is_new)
              entry->second += values;
          }
    }


    /** Rigid motions, at most 1: translations, then rotations of each part about its middle. */
    std::vector<Vector> motions_of_parts(const ElasticOperator &op, const Vector &part)
    {
      std::vector<Vector> motions = op.near_null_space();
      const unsigned int  n = motions.size(), n_components = op.n_components();
      for (Vector &motion : motions)
        op.clear_constrained(motion);
      // In the last row how many unknowns there are of each component.
      PartSums sums;
      for (unsigned int i = 0; i < part.locally_owned_size(); ++i)
        if (const double number = part.local_element(i); number > 0.)
          {
            Eigen::MatrixXd &sum = sum_of(sums, number, n + 1, n_components);
            for (unsigned int a = 0; a < n; ++a)
              sum(a, i % n_components) += motions[a].local_element(i);
            sum(n, i % n_components) += 1.;
          }
      sum_over_processes(sums, part.get_mpi_communicator());
      for (unsigned int i = 0; i < part.locally_owned_size(); ++i)
        if (part.local_element(i) > 0.)
          {
            const auto mean = sums.at(part.local_element(i)).col(i % n_components);
            for (unsigned int a = n_components; a < n; ++a)
              motions[a].local_element(i) -= mean(a) / mean(n);
          }
      for (unsigned int a = n_components; a < n; ++a)
        if (const double largest = motions[a].linfty_norm(); largest > 0.)
          motions[a] /= largest; // whatever the unit of length
      return motions;
    }


    /**
     * Of each part, for rigid motions a and b: the energies a.K b, the sizes a.D b with the
     * diagonal D of K, the work of the residual r, and in the first row r.r/D.
     */
    PartSums energies_of_parts(const ElasticOperator     &op,
                               const Vector              &part,
                               const std::vector<Vector> &motions,
                               const Vector              &residual)
    {
      const unsigned int n        = motions.size();
      const Vector      &diagonal = op.diagonal();
      Vector             image;
      op.initialize_vector(image);
      PartSums sums;
      for (unsigned int b = 0; b < n; ++b)
        {
          op.apply(image, motions[b]);
          for (unsigned int i = 0; i < part.locally_owned_size(); ++i)
            if (const double number = part.local_element(i); number > 0.)
              {
                Eigen::MatrixXd &sum = sum_of(sums, number, n, 2 * n + 2);
                const double     d = diagonal.local_element(i), r = residual.local_element(i);
                for (unsigned int a = 0; a < n; ++a)
                  {
                    sum(a, b) += motions[a].local_element(i) * image.local_element(i);
                    sum(a, n + b) += motions[a].local_element(i) * d * motions[b].local_element(i);
                  }
                sum(b, 2 * n) += motions[b].local_element(i) * r;
                if (b == 0 && d > 0.) // not of a node without bonds
                  sum(0, 2 * n + 1) += r * r / d;
              }
        }
      sum_over_processes(sums, part.get_mpi_communicator());
      return sums;
    }


    /** The coefficients of the rigid motions without energy, each of size 1. */
    std::vector<Eigen::VectorXd> free_motions(const Eigen::MatrixXd &sum)
    {
      constexpr double negligible    = 1e-10;
      using Solver                   = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;
      const Eigen::Index           n = sum.rows();
      const Solver                 sizes(Eigen::MatrixXd(sum.middleCols(n, n)));
      std::vector<Eigen::VectorXd> found;
      Eigen::Index                 first = 0; // those of lower size move nothing
      while (first < n && sizes.eigenvalues()(first) <= negligible * sizes.eigenvalues()(n - 1))
        ++first;
      if (first == n)
        return found;
      const Eigen::MatrixXd basis =
        sizes.eigenvectors().rightCols(n - first) *
        sizes.eigenvalues().tail(n - first).cwiseSqrt().cwiseInverse().asDiagonal();
      const Eigen::MatrixXd reduced = basis.transpose() * sum.leftCols(n) * basis;
      const Solver          energies(Eigen::MatrixXd(0.5 * (reduced + reduced.transpose())));
      for (Eigen::Index k = 0; k < n - first; ++k)
        if (energies.eigenvalues()(k) <= negligible)
          found.emplace_back(basis * energies.eigenvectors().col(k));
      return found;
    }


    /** The operator resists the motion of the part alone nowhere. */
    bool is_free_motion(const ElasticOperator     &op,
                        const Vector              &part,
                        const double               number,
                        const std::vector<Vector> &motions,
                        const Eigen::VectorXd     &coefficients)
    {
      constexpr double negligible = 1e-9;
      Vector           motion, image;
      op.initialize_vector(motion);
      op.initialize_vector(image);
      for (unsigned int i = 0; i < part.locally_owned_size(); ++i)
        if (part.local_element(i) == number)
          for (unsigned int a = 0; a < motions.size(); ++a)
            motion.local_element(i) += coefficients(a) * motions[a].local_element(i);
      op.apply(image, motion);
      double largest = 0.;
      for (unsigned int i = 0; i < part.locally_owned_size(); ++i)
        if (const double d = op.diagonal().local_element(i); d > 0.)
          largest = std::max(largest, std::abs(image.local_element(i)) / d);
      largest = Utilities::MPI::max(largest, part.get_mpi_communicator());
      return largest <= negligible * motion.linfty_norm();
    }


    std::string loose_part_text(const ElasticOperator &op,
                                const Vector          &part,
                                const double           number,
                                const Eigen::VectorXd &work)
    {
      const auto   index = static_cast<types::global_dof_index>(number) - 1;
      unsigned int n     = 0;
      for (unsigned int i = 0; i < part.locally_owned_size(); ++i)
        n += part.local_element(i) == number ? 1 : 0;
      n = Utilities::MPI::sum(n, part.get_mpi_communicator());
      if (!part.in_local_range(index))
        return "";
      std::ostringstream message;
      message << "Nothing holds a part of the body with " << n / op.n_components()
              << " nodes, one of them at "
              << op.place_of(part.get_partitioner()->global_to_local(index))
              << ", against the loads on it, a force of (";
      for (unsigned int c = 0; c < op.n_components(); ++c)
        message << (c > 0 ? ", " : "") << work(c);
      message
        << ") or its moment: it has no equilibrium. Cracks (section 'Cracks') or voids cut it off from its supports. Hold it by 'Displacement' on one of its sides or "
           "'Parts', shorten the cracks, let its loads balance, or follow its motion ('Solver = dynamics' in section 'Elasticity').";
      return message.str();
    }
  } // namespace


  void check_no_loose_part(const ElasticOperator                &op,
                           const TrilinosWrappers::SparseMatrix &surrogate,
                           const Vector                         &residual)
  {
    // Of what the forces are on the part and on the body.
    constexpr double balanced = 1e-8, round_off = 1e-12;
    const Vector     part    = number_parts(op, surrogate);
    const auto       motions = motions_of_parts(op, part);
    if (motions.empty())
      return;
    const Eigen::Index n     = static_cast<Eigen::Index>(motions.size());
    const PartSums     sums  = energies_of_parts(op, part, motions, residual);
    double             total = 0.;
    for (const auto &[number, sum] : sums)
      total += sum(0, 2 * n + 1);
    for (const auto &[number, sum] : sums)
      for (const Eigen::VectorXd &motion : free_motions(sum))
        {
          const double work = std::abs(motion.dot(sum.col(2 * n)));
          if (work > balanced * std::sqrt(sum(0, 2 * n + 1)) &&
              work > round_off * std::sqrt(total) &&
              is_free_motion(op, part, number, motions, motion))
            throw_on_all_if_any(part.get_mpi_communicator(),
                                loose_part_text(op, part, number, sum.col(2 * n)));
        }
  }
} // namespace PeriDeal
