// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/numbers.h>

#include <perideal/laws/crack_kink.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace PeriDeal
{
  namespace
  {

    /** The sum of c_k m^(2 k). */
    template <std::size_t n>
    double in_squares(const std::array<double, n> &c, const double m)
    {
      double sum = 0.;
      for (std::size_t k = n; k-- > 0;)
        sum = sum * m * m + c[k];
      return sum;
    }


    constexpr double steepest = 1.4; // radians: to about 80 degrees the series hold
  }                                  // namespace


  CrackKink kink_at(const double angle, const double mode_1, const double mode_2)
  {
    const double p2 = dealii::numbers::PI * dealii::numbers::PI, p3 = p2 * dealii::numbers::PI,
                 p4 = p2 * p2, p5 = p4 * dealii::numbers::PI, p6 = p4 * p2;
    const double                 m          = angle / dealii::numbers::PI;
    const std::array<double, 11> one_of_one = {{1.,
                                                -3. * p2 / 8.,
                                                p2 - 5. * p4 / 128.,
                                                p2 / 9. - 11. * p4 / 72. + 119. * p6 / 15360.,
                                                5.07790,
                                                -2.88312,
                                                -0.0925,
                                                2.996,
                                                -4.059,
                                                1.63,
                                                4.1}};
    const std::array<double, 10> one_of_two = {
      {-3. * dealii::numbers::PI / 2.,
       10. * dealii::numbers::PI / 3. + p3 / 16.,
       -2. * dealii::numbers::PI - 133. * p3 / 180. + 59. * p5 / 1280.,
       12.313906,
       -7.32433,
       1.5793,
       4.0216,
       -6.915,
       4.21,
       4.56}};
    const std::array<double, 10> two_of_one = {
      {dealii::numbers::PI / 2.,
       -4. * dealii::numbers::PI / 3. - p3 / 48.,
       -2. * dealii::numbers::PI / 3. + 13. * p3 / 30. - 59. * p5 / 3840.,
       -6.176023,
       4.44112,
       -1.5340,
       -2.0700,
       4.684,
       -3.95,
       -1.32}};
    const std::array<double, 11> two_of_two = {
      {1.,
       -4. - 3. * p2 / 8.,
       8. / 3. + 29. * p2 / 18. - 5. * p4 / 128.,
       -32. / 15. - 4. * p2 / 9. - 1159. * p4 / 7200. + 119. * p6 / 15360.,
       10.58254,
       -4.78511,
       -1.8804,
       7.280,
       -7.591,
       0.25,
       12.5}};
    return {angle,
            in_squares(one_of_one, m) * mode_1 + m * in_squares(one_of_two, m) * mode_2,
            m * in_squares(two_of_one, m) * mode_1 + in_squares(two_of_two, m) * mode_2};
  }


  CrackKink kink_of_most_release(const double mode_1, const double mode_2)
  {
    constexpr unsigned int n = 140, n_halvings = 40;
    const double           opening = std::max(0., mode_1);
    const auto             release = [&](const double angle) {
      const CrackKink kink = kink_at(angle, opening, mode_2);
      return kink.mode_1 > 0. ? kink.release() : 0.;
    };
    if (mode_2 == 0.)
      return kink_at(0., opening, 0.);
    double best = 0.;
    for (unsigned int k = 0; k <= n; ++k)
      if (const double angle = steepest * (2. * k / n - 1.); release(angle) > release(best))
        best = angle;
    double low  = std::max(-steepest, best - 2. * steepest / n),
           high = std::min(steepest, best + 2. * steepest / n);
    for (unsigned int k = 0; k < n_halvings; ++k) // by thirds
      {
        const double third = (high - low) / 3.;
        if (release(low + third) > release(high - third))
          high -= third;
        else
          low += third;
      }
    return kink_at(0.5 * (low + high), opening, mode_2);
  }


  CrackKink kink_of_hoop_stress(const double mode_1, const double mode_2)
  {
    const double opening = std::max(0., mode_1), root = std::hypot(opening, std::sqrt(8.) * mode_2);
    const double angle = mode_2 == 0. ? 0. : 2. * std::atan2(-2. * mode_2, opening + root);
    const double half  = std::cos(0.5 * angle);
    return {angle, half * (opening * half * half - 1.5 * mode_2 * std::sin(angle)), 0.};
  }
} // namespace PeriDeal
