// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/bonds/bond_pieces.h>

#include <cstdlib>
#include <numeric>
#include <set>

namespace PeriDeal
{
  namespace
  {
    /** A number between 0 and 1 as a fraction, so that crossings at one place are found equal. */
    struct Fraction
    {
      int over, under;

      Fraction(const int over, const int under)
        : over(over / std::gcd(over, under))
        , under(under / std::gcd(over, under))
      {}

      double value() const
      {
        return static_cast<double>(over) / under;
      }

      bool operator<(const Fraction &other) const
      {
        return over * other.under < other.over * under;
      }
    };


    template <int dim>
    typename BondPiece<dim>::Corners shape_functions(const std::array<double, dim> &x)
    {
      typename BondPiece<dim>::Corners values;
      for (unsigned int a = 0; a < values.size(); ++a)
        {
          values[a] = 1.;
          for (unsigned int d = 0; d < dim; ++d)
            values[a] *= ((a >> d) & 1) ? x[d] : 1. - x[d];
        }
      return values;
    }
  } // namespace


  template <int dim>
  std::vector<BondPiece<dim>> bond_pieces(const typename BondPiece<dim>::Site &offset)
  {
    std::set<Fraction> crossings{Fraction(0, 1), Fraction(1, 1)};
    for (const int steps : offset)
      for (int k = 1; k < std::abs(steps); ++k)
        crossings.insert(Fraction(k, std::abs(steps)));
    std::vector<BondPiece<dim>> pieces;
    for (auto from = crossings.begin(), to = std::next(from); to != crossings.end(); ++from, ++to)
      {
        BondPiece<dim> piece;
        piece.length = to->value() - from->value();
        // The middle lies inside the cells' range of each coordinate; where the bond has no extent,
        // the cells on both sides share it.
        typename BondPiece<dim>::Site lowest;
        unsigned int                  n_around = 1;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const Fraction middle(from->over * to->under + to->over * from->under,
                                  2 * from->under * to->under);
            const int      at = offset[d] * middle.over;
            lowest[d] = at >= 0 ? at / middle.under : -((-at + middle.under - 1) / middle.under);
            if (offset[d] == 0)
              {
                lowest[d] = -1;
                n_around *= 2;
              }
          }
        for (unsigned int k = 0; k < n_around; ++k)
          {
            typename BondPiece<dim>::Site cell  = lowest;
            unsigned int                  upper = k;
            for (unsigned int d = 0; d < dim; ++d)
              if (offset[d] == 0)
                {
                  cell[d] += upper % 2;
                  upper /= 2;
                }
            std::array<double, dim> start, end;
            for (unsigned int d = 0; d < dim; ++d)
              {
                start[d] = from->value() * offset[d] - cell[d];
                end[d]   = to->value() * offset[d] - cell[d];
              }
            auto       change = shape_functions<dim>(end);
            const auto before = shape_functions<dim>(start);
            for (unsigned int a = 0; a < change.size(); ++a)
              change[a] -= before[a];
            piece.cells.push_back(cell);
            piece.change.push_back(change);
          }
        pieces.push_back(std::move(piece));
      }
    return pieces;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(bond_pieces);
} // namespace PeriDeal
