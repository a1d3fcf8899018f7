// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// This file wants -O3 -ffp-contract=off.

#include <perideal/base/instantiate.h>
#include <perideal/operators/lattice/bond_form.h>

#include <algorithm>
#include <cstdint>

#if defined(__linux__)
#  include <sys/mman.h>
#endif

namespace PeriDeal
{
  namespace
  {
    /**
     * sum_b w_b (u - values[column_b]) in four partial sums, so that additions need not wait for
     * each other. The order is a row's own: the same on any number of processes.
     */
    inline double row_sum(const double *__restrict__ weights,
                          const std::uint32_t *__restrict__ columns,
                          const std::size_t n,
                          const double      u,
                          const double *__restrict__ values)
    {
      double      a = 0., b = 0., c = 0., d = 0.;
      std::size_t k = 0;
      for (; k + 4 <= n; k += 4)
        {
          a += weights[k] * (u - values[columns[k]]);
          b += weights[k + 1] * (u - values[columns[k + 1]]);
          c += weights[k + 2] * (u - values[columns[k + 2]]);
          d += weights[k + 3] * (u - values[columns[k + 3]]);
        }
      for (; k < n; ++k)
        a += weights[k] * (u - values[columns[k]]);
      return (a + b) + (c + d);
    }


    /**
     * Ask for large pages: the bonds are streamed through, and the walk through small pages costs a
     * tenth of the speed.
     */
    void prefer_large_pages(void *begin, const std::size_t bytes)
    {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
      constexpr std::uintptr_t page  = 4096;
      const std::uintptr_t     start = reinterpret_cast<std::uintptr_t>(begin),
                           first     = (start + page - 1) / page * page,
                           last      = (start + bytes) / page * page;
      if (last > first + 1024 * page)
        madvise(reinterpret_cast<void *>(first), last - first, MADV_HUGEPAGE);
#else
      (void)begin;
      (void)bytes;
#endif
    }


    template <int dim>
    class StoredForm : public BondForm
    {
    public:
      explicit StoredForm(const DiffusionBonds<dim> &bonds)
        : bonds(bonds)
        , varying(bonds.conductivities().depend_on_temperature())
        , keep_cut(varying || bonds.cracks().history().changes_ever() ||
                   bonds.cracks().broken().are_followed())
        , n_values(bonds.nodes().n_local())
        , extended(
            bonds.neighbors().outside().empty() ? 0 : n_values + bonds.neighbors().outside().size())
      {
        const unsigned int n_rows = bonds.nodes().n_owned();
        row_starts.reserve(n_rows + 1);
        row_starts.push_back(0);
        // On a lattice a little more than enough, in one go: what is not written to takes no
        // memory.
        reserve(bonds.weights().members().size() * n_rows);
        for (unsigned int i = 0; i < n_rows; ++i)
          {
            bonds.bonds_of(i, family);
            if (i == n_rows / 2 && columns.capacity() < family.size() * n_rows)
              reserve(columns.size() + (family.size() + 1) * (n_rows - i));
            for (const auto &bond : family)
              if (keep_cut || bond.weight != 0.)
                {
                  columns.push_back(bond.neighbor);
                  weights.push_back(bond.weight);
                  if (varying)
                    unit_weights.push_back(bond.weight /
                                           bonds.conductivities().of_bond(i, bond.neighbor));
                }
            row_starts.push_back(columns.size());
          }
      }

      void apply(double            *y,
                 const double      *values,
                 const double      *outside,
                 const NodesAction &finish) const override
      {
        if (!extended.empty())
          {
            std::copy(values, values + n_values, extended.begin());
            std::copy(outside, outside + (extended.size() - n_values), extended.begin() + n_values);
            values = extended.data();
          }
        constexpr std::size_t block  = 1024;
        const std::size_t     n_rows = row_starts.size() - 1;
        for (std::size_t begin = 0; begin < n_rows; begin += block)
          {
            const std::size_t end = std::min(begin + block, n_rows);
            for (std::size_t i = begin; i < end; ++i)
              y[i] = row_sum(weights.data() + row_starts[i],
                             columns.data() + row_starts[i],
                             row_starts[i + 1] - row_starts[i],
                             values[i],
                             values);
            if (finish)
              finish(static_cast<unsigned int>(begin), static_cast<unsigned int>(end));
          }
      }

      double row_sums(double *sums) const override
      {
        double n_bonds = 0.;
        for (std::size_t i = 0; i + 1 < row_starts.size(); ++i)
          {
            sums[i] = 0.;
            for (std::size_t b = row_starts[i]; b < row_starts[i + 1]; ++b)
              {
                sums[i] += weights[b];
                if (weights[b] != 0.)
                  n_bonds += columns[b] < n_values ? 0.5 : 1.;
              }
          }
        return n_bonds;
      }

      void update_rows(const std::vector<unsigned int> &rows, double *sums) override
      {
        for (const unsigned int i : rows)
          {
            bonds.bonds_of(i, family);
            AssertDimension(family.size(), row_starts[i + 1] - row_starts[i]);
            sums[i]       = 0.;
            std::size_t b = row_starts[i];
            for (const auto &bond : family)
              {
                if (varying)
                  unit_weights[b] = bond.weight / bonds.conductivities().of_bond(i, bond.neighbor);
                weights[b++] = bond.weight;
                sums[i] += bond.weight;
              }
          }
      }

      void update_conductivities(double *sums) override
      {
        for (std::size_t i = 0; i + 1 < row_starts.size(); ++i)
          {
            sums[i] = 0.;
            for (std::size_t b = row_starts[i]; b < row_starts[i + 1]; ++b)
              {
                weights[b] = unit_weights[b] * bonds.conductivities().of_bond(i, columns[b]);
                sums[i] += weights[b];
              }
          }
      }

      std::size_t memory_consumption() const override
      {
        return row_starts.capacity() * sizeof(std::size_t) +
               columns.size() * sizeof(std::uint32_t) +
               (weights.size() + unit_weights.size()) * sizeof(double) +
               extended.capacity() * sizeof(double);
      }

      unsigned long long n_stored() const override
      {
        return weights.size();
      }

      std::string name() const override
      {
        return "stored";
      }

    private:
      void reserve(const std::size_t n)
      {
        columns.reserve(n);
        weights.reserve(n);
        prefer_large_pages(columns.data(), columns.capacity() * sizeof(std::uint32_t));
        prefer_large_pages(weights.data(), weights.capacity() * sizeof(double));
      }

      const DiffusionBonds<dim> &bonds;
      const bool                 varying;      // conductivities change with the temperature
      const bool                 keep_cut;     // with weight 0, since rows will be found anew
      std::vector<double>        unit_weights; // weights over the bonds' conductivities, if they do
      std::vector<typename DiffusionBonds<dim>::Bond> family;
      std::size_t                                     n_values;
      mutable std::vector<double>                     extended;
      std::vector<std::size_t>                        row_starts;
      std::vector<std::uint32_t>                      columns;
      std::vector<double>                             weights;
    };
  } // namespace


  template <int dim>
  std::unique_ptr<BondForm> make_stored_form(const DiffusionBonds<dim> &bonds)
  {
    return std::make_unique<StoredForm<dim>>(bonds);
  }

  PERIDEAL_INSTANTIATE_FUNCTION(make_stored_form);
} // namespace PeriDeal
