// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/bond_form.h>

#include <algorithm>
#include <cstdint>

namespace PeriDeal
{
  namespace
  {
    class StoredForm : public BondForm
    {
    public:
      template <int dim>
      explicit StoredForm(const Families<dim> &families)
        : n_values(families.nodes().n_local())
        , extended(families.fictitious().empty() ? 0 : n_values + families.fictitious().size())
      {
        std::vector<typename Families<dim>::Bond> bonds;
        const unsigned int                        n_rows = families.nodes().n_owned();
        row_starts.reserve(n_rows + 1);
        row_starts.push_back(0);
        for (unsigned int i = 0; i < n_rows; ++i)
          {
            families.bonds_of(i, bonds);
            if (i == 0)
              reserve(bonds.size() * n_rows);
            for (const auto &bond : bonds)
              if (bond.weight != 0.)
                {
                  columns.push_back(bond.neighbor);
                  weights.push_back(bond.weight);
                }
            row_starts.push_back(columns.size());
          }
        columns.shrink_to_fit();
        weights.shrink_to_fit();
      }

      void apply(double *y, const double *values, const double *outside) const override
      {
        if (!extended.empty())
          {
            std::copy(values, values + n_values, extended.begin());
            std::copy(outside, outside + (extended.size() - n_values), extended.begin() + n_values);
            values = extended.data();
          }
        const std::size_t n_rows = row_starts.size() - 1;
        for (std::size_t i = 0; i < n_rows; ++i)
          {
            const double u   = values[i];
            double       sum = 0.;
            for (std::size_t b = row_starts[i]; b < row_starts[i + 1]; ++b)
              sum += weights[b] * (u - values[columns[b]]);
            y[i] = sum;
          }
      }

      std::size_t memory_consumption() const override
      {
        return row_starts.capacity() * sizeof(std::size_t) +
               columns.capacity() * sizeof(std::uint32_t) + weights.capacity() * sizeof(double) +
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
      }

      std::size_t                 n_values;
      mutable std::vector<double> extended;
      std::vector<std::size_t>    row_starts;
      std::vector<std::uint32_t>  columns;
      std::vector<double>         weights;
    };
  } // namespace


  template <int dim>
  std::unique_ptr<BondForm> make_stored_form(const Families<dim> &families)
  {
    return std::make_unique<StoredForm>(families);
  }

  template std::unique_ptr<BondForm> make_stored_form(const Families<1> &);
  template std::unique_ptr<BondForm> make_stored_form(const Families<2> &);
  template std::unique_ptr<BondForm> make_stored_form(const Families<3> &);
} // namespace PeriDeal
