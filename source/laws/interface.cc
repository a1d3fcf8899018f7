// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>

#include <perideal/laws/gauss_rule.h>
#include <perideal/laws/interface.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace PeriDeal
{
  double interface_conductivity(const InterfaceRule rule, const double a, const double b)
  {
    switch (rule)
      {
        case InterfaceRule::minimum:
          return std::min(a, b);
        case InterfaceRule::arithmetic:
          return 0.5 * (a + b);
        case InterfaceRule::harmonic:
          return a + b > 0. ? 2. * a * b / (a + b) : 0.;
      }
    Assert(false, dealii::ExcInternalError());
    return 0.;
  }


  namespace
  {
    constexpr unsigned int n_points = 8, n_pieces = 4;

    /** A piece of the bond with the resistivities 1/kappa at its Gauss points. */
    struct Piece
    {
      double                       start, end, integral;
      std::array<double, n_points> values;
    };


    /**
     * Gauss points on [0,1] and the weights that extrapolate values at them to 0 (backwards: to 1).
     */
    struct PieceRule : GaussRule
    {
      PieceRule()
        : GaussRule(n_points)
      {
        for (unsigned int q = 0; q < n_points; ++q)
          {
            to_start[q] = 1.;
            for (unsigned int p = 0; p < n_points; ++p)
              if (p != q)
                to_start[q] *= -points[p] / (points[q] - points[p]);
          }
      }

      std::array<double, n_points> to_start;
    };


    class Resistance
    {
    public:
      explicit Resistance(const std::function<double(const double)> &kappa)
        : kappa(kappa)
      {}


      double of_bond() const
      {
        std::array<Piece, n_pieces> pieces;
        double                      sum = 0., total = 0.;
        for (unsigned int i = 0; i < n_pieces; ++i)
          {
            pieces[i] = look(i / static_cast<double>(n_pieces), (i + 1.) / n_pieces);
            sum += pieces[i].integral;
          }
        if (!std::isfinite(sum))
          return sum;
        for (const Piece &piece : pieces)
          total += refine(piece,
                          resistivity(piece.start + side),
                          resistivity(piece.end - side),
                          1e-14 * sum);
        return total;
      }

    private:
      double resistivity(const double s) const
      {
        return 1. / kappa(s);
      }


      Piece look(const double start, const double end) const
      {
        Piece piece{start, end, 0., {}};
        for (unsigned int q = 0; q < n_points; ++q)
          {
            piece.values[q] = resistivity(start + (end - start) * rule().points[q]);
            piece.integral += (end - start) * rule().weights[q] * piece.values[q];
          }
        return piece;
      }


      /** Where two constant phases meet, if the piece holds just two; else -1. */
      double crossing(const Piece &piece, const double first, const double last) const
      {
        double low = piece.start, high = piece.end;
        for (unsigned int q = 0; q < n_points; ++q)
          {
            const double s = piece.start + (piece.end - piece.start) * rule().points[q];
            if (piece.values[q] == first && high == piece.end)
              low = s;
            else if (piece.values[q] != last)
              return -1.;
            else if (high == piece.end)
              high = s;
          }
        while (high - low > side)
          {
            const double middle = 0.5 * (low + high), value = resistivity(middle);
            if (value != first && value != last)
              return -1.;
            (value == first ? low : high) = middle;
          }
        return 0.5 * (low + high);
      }


      /**
       * Integral over a piece, given the resistivities just inside its ends. Besides the Gauss sums
       * the values extrapolated to the ends must agree, as a jump between an end and the Gauss
       * point next to it would escape the sums.
       */
      double refine(const Piece &piece,
                    const double first,
                    const double last,
                    const double tolerance) const
      {
        const bool uniform = std::all_of(piece.values.begin(),
                                         piece.values.end(),
                                         [first](const double v) { return v == first; });
        if (uniform && first == last)
          return piece.integral;
        if (first != last)
          if (const double at = crossing(piece, first, last); at >= 0.)
            return first * (at - piece.start) + last * (piece.end - at);
        const double middle = 0.5 * (piece.start + piece.end);
        const Piece  left = look(piece.start, middle), right = look(middle, piece.end);
        const double sum = left.integral + right.integral;
        if ((std::abs(sum - piece.integral) <= tolerance && continues(left, first, false) &&
             continues(right, last, true)) ||
            piece.end - piece.start < 4. * side)
          return sum;
        return refine(left, first, resistivity(middle - side), tolerance) +
               refine(right, resistivity(middle + side), last, tolerance);
      }


      /** Whether the value at an end is the smooth continuation of those at the Gauss points. */
      static bool continues(const Piece &piece, const double value, const bool at_end)
      {
        double expected = 0.;
        for (unsigned int q = 0; q < n_points; ++q)
          expected += rule().to_start[q] * piece.values[at_end ? n_points - 1 - q : q];
        return std::abs(expected - value) <= 1e-10 * std::abs(value);
      }


      static const PieceRule &rule()
      {
        static const PieceRule points_and_weights;
        return points_and_weights;
      }


      static constexpr double side = 1e-13; // of the bond: what counts as just inside
      const std::function<double(const double)> &kappa;
    };
  } // namespace


  double harmonic_conductivity(const std::function<double(const double)> &kappa)
  {
    const double resistance = Resistance(kappa).of_bond();
    return std::isfinite(resistance) ? 1. / resistance : 0.;
  }
} // namespace PeriDeal
