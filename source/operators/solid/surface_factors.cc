// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/interleaved.h>
#include <perideal/laws/family_moments.h>
#include <perideal/laws/stretch_energy.h>
#include <perideal/operators/solid/surface_factors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** A vector of some numbers for each node. */
    Vector node_vector(const Utilities::MPI::Partitioner &nodes, const unsigned int n_components)
    {
      Vector v;
      v.reinit(interleaved(nodes, n_components));
      return v;
    }


    /**
     * What a complete family sums, visit(xi, w V), over w V of unit conductivity; on a lattice. Off
     * it sums are those of a ball: sum w V xi_a^2 = 2, as the calibration has it.
     */
    template <int dim, typename Visit>
    void for_each_member(const Families<dim> &bonds, const Visit &visit)
    {
      const Lattice<dim> &lattice = *bonds.nodes().lattice();
      for (const FamilyMember<dim> &member : bonds.weights().members())
        {
          Tensor<1, dim> xi;
          for (unsigned int d = 0; d < dim; ++d)
            xi[d] = member.offset[d] * lattice.spacing[d];
          visit(xi, member.weight * lattice.cell_volume());
        }
    }


    /** Common to all corrections: q of complete families. */
    template <int dim>
    double complete_q(const Families<dim> &bonds)
    {
      if (!bonds.nodes().lattice())
        return 2. * dim;
      double q = 0.;
      for_each_member(bonds,
                      [&](const Tensor<1, dim> &xi, const double w) { q += w * xi.norm_square(); });
      return q;
    }


    template <int dim>
    void correct_by_energy(const Families<dim> &bonds,
                           const StoredBonds   &stored,
                           SurfaceFactors      &result)
    {
      const Nodes<dim> &nodes = bonds.nodes();
      StretchSums<dim>  complete;
      if (nodes.lattice())
        for_each_member(bonds,
                        [&](const Tensor<1, dim> &xi, const double w) { complete.add(xi, w); });
      else
        for (unsigned int d = 0; d < dim; ++d)
          {
            complete.dilatation[d] = 2.;
            complete.energy[d]     = 6. / (dim + 2.);
          }
      Vector factors = node_vector(*nodes.partitioner(), 2 * dim);
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        {
          StretchSums<dim> own;
          for (std::size_t k = stored.starts[i]; k < stored.starts[i + 1]; ++k)
            {
              const Tensor<1, dim> xi = bonds.neighbors().bond_vector(i, stored.neighbors[k]);
              own.add(xi, stored.weights[k] / (xi.norm_square() * nodes.volume(i)));
            }
          const Tensor<1, dim> a = axis_factors(complete.dilatation, own.dilatation),
                               s = axis_factors(complete.energy, own.energy);
          for (unsigned int d = 0; d < dim; ++d)
            {
              factors.local_element(2 * dim * i + d)       = a[d];
              factors.local_element(2 * dim * i + dim + d) = s[d];
            }
        }
      factors.update_ghost_values();
      const auto read = [&](const unsigned int node, const unsigned int first) {
        Tensor<1, dim> axes;
        for (unsigned int d = 0; d < dim; ++d)
          axes[d] = factors.local_element(2 * dim * node + first + d);
        return axes;
      };
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        for (std::size_t k = stored.starts[i]; k < stored.starts[i + 1]; ++k)
          {
            const unsigned int   j  = stored.neighbors[k];
            const Tensor<1, dim> xi = bonds.neighbors().bond_vector(i, j);
            result.dilatation[k]    = ellipsoid_factor(read(i, 0), read(j, 0), xi);
            result.extension[k]     = ellipsoid_factor(read(i, dim), read(j, dim), xi);
          }
    }


    /** Correction by moments: the multipliers c of all nodes, and who takes part. */
    template <int dim>
    class Multipliers
    {
    public:
      Multipliers(const Families<dim> &bonds, const StoredBonds &stored)
        : bonds(bonds)
        , nodes(bonds.nodes())
        , stored(stored)
        , c(node_vector(*nodes.partitioner(), n))
        , left(node_vector(*nodes.partitioner(), 1))
        , matrices(nodes.n_owned())
      {
        if (nodes.lattice())
          for_each_member(bonds, [&](const Tensor<1, dim> &xi, const double w) {
            add(complete, fourth_moments(xi), w * xi.norm_square());
          });
        else
          add(complete, isotropic_fourth_moments<dim>(), 2. * dim);
        find_directions();
        find_matrices();
      }

      /** Until all factors are positive. */
      void solve()
      {
        do
          {
            // Three digits tell whose factors are negative.
            do
              iterate(1e-3);
            while (leave_negative());
            remaining = iterate(1e-13);
          }
        while (leave_negative());
      }

      double factor(const unsigned int i, const std::size_t k) const
      {
        const FourthMoments<dim> &m     = table[direction[k]];
        const double *const       one   = c.begin() + n * i;
        const double *const       other = c.begin() + n * stored.neighbors[k];
        double                    sum   = 1.;
        for (unsigned int a = 0; a < n; ++a)
          sum += (one[a] + other[a]) * m[a];
        return sum;
      }

      bool is_left(const unsigned int node) const
      {
        return left.local_element(node) > 0.;
      }

      double gap_left() const
      {
        return remaining;
      }

    private:
      static constexpr unsigned int n = n_fourth_moments<dim>;

      static void add(FourthMoments<dim> &sum, const FourthMoments<dim> &m, const double w)
      {
        for (unsigned int a = 0; a < n; ++a)
          sum[a] += w * m[a];
      }

      /** Moments of the directions of all bonds; those of a lattice are few. */
      void find_directions()
      {
        std::map<std::array<int, dim>, unsigned int> known;
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          for (std::size_t k = stored.starts[i]; k < stored.starts[i + 1]; ++k)
            {
              const Tensor<1, dim> xi = bonds.neighbors().bond_vector(i, stored.neighbors[k]);
              if (nodes.lattice())
                {
                  std::array<int, dim> offset;
                  Tensor<1, dim>       exact;
                  for (unsigned int d = 0; d < dim; ++d)
                    {
                      const double h = nodes.lattice()->spacing[d];
                      offset[d]      = static_cast<int>(std::lround(xi[d] / h));
                      exact[d]       = offset[d] * h;
                    }
                  const auto found = known.emplace(offset, table.size());
                  if (found.second)
                    table.push_back(fourth_moments(exact));
                  direction.push_back(found.first->second);
                }
              else
                {
                  direction.push_back(table.size());
                  table.push_back(fourth_moments(xi));
                }
            }
      }

      void find_matrices()
      {
        std::vector<FourthMoments<dim>> directions;
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          {
            FourthMoments<dim> missing = complete;
            directions.clear();
            for (std::size_t k = stored.starts[i]; k < stored.starts[i + 1]; ++k)
              {
                directions.push_back(table[direction[k]]);
                const double w = stored.weights[k] / nodes.volume(i);
                add(missing, directions.back(), -w);
                matrices[i].add(directions.back(), w);
              }
            if (!matrices[i].factorize() ||
                !positive_factors_exist(directions, matrices[i], missing))
              left.local_element(i) = 1.;
          }
        left.update_ghost_values();
      }

      /** What the moments of an owned node lack, with the factors as they are. */
      FourthMoments<dim> gap(const unsigned int i) const
      {
        FourthMoments<dim> result = complete;
        for (std::size_t k = stored.starts[i]; k < stored.starts[i + 1]; ++k)
          add(result, table[direction[k]], -stored.weights[k] / nodes.volume(i) * factor(i, k));
        return result;
      }

      /**
       * The c of all nodes by Chebyshev's iteration with the nodes' own matrices, which needs no
       * sums over all nodes, so that numbers do not depend on the processes. Eigenvalues lie
       * between 0 and 2, the lowest near 0.04 for m = 2; modes below 0.02 would take longer. Stops
       * when the largest gap is below the tolerance times a complete family's moments, and returns
       * 0, or what is left of it after as many steps as are allowed. Collective.
       */
      double iterate(const double tolerance)
      {
        constexpr double       lowest = 0.02, highest = 2.02;
        constexpr unsigned int most = 500;
        constexpr double       mean = 0.5 * (highest + lowest), half = 0.5 * (highest - lowest);
        const double           size = std::sqrt(scalar_product<dim>(complete, complete));
        std::vector<FourthMoments<dim>> steps(nodes.n_owned());
        double                          rho = half / mean, keep = 0., take = 1. / mean;
        double                          left_over = 0.;
        c                                         = 0.;
        for (unsigned int n_steps = 0; n_steps < most; ++n_steps)
          {
            double worst = 0.;
            c.update_ghost_values();
            for (unsigned int i = 0; i < nodes.n_owned(); ++i)
              {
                if (is_left(i))
                  continue;
                const FourthMoments<dim> missing = gap(i);
                const FourthMoments<dim> step    = matrices[i].solve(missing);
                worst = std::max(worst, scalar_product<dim>(missing, missing));
                for (unsigned int a = 0; a < n; ++a)
                  steps[i][a] = keep * steps[i][a] + take * step[a];
              }
            c.zero_out_ghost_values();
            left_over = std::sqrt(Utilities::MPI::max(worst, nodes.communicator())) / size;
            if (left_over < tolerance)
              {
                left_over = 0.;
                break;
              }
            for (unsigned int i = 0; i < nodes.n_owned(); ++i)
              for (unsigned int a = 0; a < n; ++a)
                c.local_element(n * i + a) += steps[i][a];
            const double next = 1. / (2. * mean / half - rho);
            keep              = next * rho;
            take              = 2. * next / half;
            rho               = next;
          }
        c.update_ghost_values();
        return left_over;
      }

      /**
       * Leave the nodes to whom the bonds with the most negative factors owe them, those within a
       * half of the lowest: without these others may become positive. Returns whether there are
       * any. Collective.
       */
      bool leave_negative()
      {
        double lowest = 1.;
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          for (std::size_t k = stored.starts[i]; k < stored.starts[i + 1]; ++k)
            lowest = std::min(lowest, factor(i, k));
        lowest = Utilities::MPI::min(lowest, nodes.communicator());
        if (lowest > 0.)
          return false;
        std::vector<unsigned int> found;
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          for (std::size_t k = stored.starts[i]; k < stored.starts[i + 1] && !is_left(i); ++k)
            if (factor(i, k) <= 0.5 * lowest && part_of(i, k) <= part_of(stored.neighbors[k], k))
              {
                found.push_back(i);
                break;
              }
        left.zero_out_ghost_values();
        for (const unsigned int i : found)
          left.local_element(i) = 1.;
        left.update_ghost_values();
        return true;
      }

      /** What one end of a bond adds to its factor. */
      double part_of(const unsigned int node, const std::size_t k) const
      {
        double sum = 0.;
        for (unsigned int a = 0; a < n; ++a)
          sum += c.local_element(n * node + a) * table[direction[k]][a];
        return sum;
      }

      const Families<dim>            &bonds;
      const Nodes<dim>               &nodes;
      const StoredBonds              &stored;
      Vector                          c, left;
      std::vector<MomentMatrix<dim>>  matrices;
      std::vector<FourthMoments<dim>> table;
      std::vector<unsigned int>       direction; // of the stored bonds, in the table
      FourthMoments<dim>              complete{};
      double                          remaining = 0.;
    };


    template <int dim>
    void correct_by_moments(const Families<dim> &bonds,
                            const StoredBonds   &stored,
                            SurfaceFactors      &result)
    {
      const Nodes<dim> &nodes = bonds.nodes();
      Multipliers<dim>  multipliers(bonds, stored);
      multipliers.solve();
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        {
          double own = 0.;
          for (std::size_t k = stored.starts[i]; k < stored.starts[i + 1]; ++k)
            {
              result.dilatation[k] = multipliers.factor(i, k);
              own += result.dilatation[k] * stored.weights[k] / nodes.volume(i);
            }
          if (!multipliers.is_left(i))
            continue;
          result.q.local_element(i) = own;
          ++result.n_left;
        }
      result.n_left    = Utilities::MPI::sum(result.n_left, nodes.communicator());
      result.gap       = multipliers.gap_left();
      result.extension = result.dilatation;
    }
  } // namespace


  template <int dim>
  void require_surface_factors(const BodyParameters<dim> &body)
  {
    body.peridynamics.refuse(
      body.material.fracture_energy.has_value(),
      "Surface correction",
      "with 'Fracture energy' in section 'Material' bonds at surfaces would break at another energy "
      "with 'Physics = elasticity'; use 'none', or give 'Critical stretch'.");
    body.peridynamics.refuse(
      !body.cracks.tips.empty(),
      "Surface correction",
      "does not follow cracks that grow ('Growth', 'Paths' in section 'Cracks') in a "
      "solid. Use 'none' or 'fictitious nodes'.");
  }


  template <int dim>
  SurfaceFactors surface_factors(const Families<dim> &bonds,
                                 const Peridynamics  &parameters,
                                 const StoredBonds   &stored)
  {
    const Nodes<dim> &nodes = bonds.nodes();
    SurfaceFactors    result;
    result.dilatation.assign(stored.neighbors.size(), 1.);
    result.extension = result.dilatation;
    result.q         = node_vector(*nodes.partitioner(), 1);
    result.q         = complete_q(bonds);
    if (parameters.surface_correction == SurfaceCorrection::energy)
      correct_by_energy(bonds, stored, result);
    else
      correct_by_moments(bonds, stored, result);
    result.q.update_ghost_values();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        double sum = 0.;
        for (std::size_t k = stored.starts[i]; k < stored.starts[i + 1]; ++k)
          sum +=
            result.dilatation[k] * result.dilatation[k] / result.extension[k] * stored.weights[k];
        result.ratio.push_back(sum / (nodes.volume(i) * result.q.local_element(i)));
      }
    return result;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(require_surface_factors);
  PERIDEAL_INSTANTIATE_FUNCTION(surface_factors);
} // namespace PeriDeal
