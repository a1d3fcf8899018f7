// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/laws/kernel.h>
#include <perideal/laws/lattice_family.h>
#include <perideal/laws/volume_fraction.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    bool is_cubic(const Tensor<1, dim> &spacing)
    {
      for (unsigned int d = 1; d < dim; ++d)
        if (std::abs(spacing[d] - spacing[0]) > 1e-12 * spacing[0])
          return false;
      return true;
    }


    template <int dim>
    double cell_volume(const Tensor<1, dim> &spacing)
    {
      double volume = 1.;
      for (unsigned int d = 0; d < dim; ++d)
        volume *= spacing[d];
      return volume;
    }


    /**
     * Squared bond components from absolute values alone, so that mirrored offsets give the same
     * bits.
     */
    template <int dim>
    std::array<double, dim> squares(const std::array<int, dim> &offset,
                                    const Tensor<1, dim>       &spacing)
    {
      std::array<double, dim> xi2;
      for (unsigned int d = 0; d < dim; ++d)
        xi2[d] = (offset[d] * spacing[d]) * (offset[d] * spacing[d]);
      return xi2;
    }


    /**
     * Distance; the squares are added in order of size so that permuted offsets give the same bits
     * on a cubic lattice.
     */
    template <int dim>
    double length(std::array<double, dim> xi2)
    {
      std::sort(xi2.begin(), xi2.end());
      double sum = 0.;
      for (const double x : xi2)
        sum += x;
      return std::sqrt(sum);
    }


    /**
     * All offsets within @p reach, the first coordinate fastest, zero left out; their weights are
     * not set.
     */
    template <int dim>
    std::vector<FamilyMember<dim>> offsets(const std::array<int, dim> &reach,
                                           const Tensor<1, dim>       &h)
    {
      std::vector<FamilyMember<dim>> box;
      std::array<int, dim>           offset;
      for (unsigned int d = 0; d < dim; ++d)
        offset[d] = -reach[d];
      for (unsigned int d = 0; d < dim;)
        {
          const double r = length<dim>(squares<dim>(offset, h));
          if (r > 0.)
            box.push_back({offset, r, 0.});
          for (d = 0; d < dim && ++offset[d] > reach[d]; ++d)
            offset[d] = -reach[d];
        }
      return box;
    }


    /**
     * The offset with absolute values, on a cubic lattice also sorted: one representative of all
     * that are equal by symmetry.
     */
    template <int dim>
    std::array<int, dim> representative(std::array<int, dim> offset, const bool cubic)
    {
      for (int &o : offset)
        o = std::abs(o);
      if (cubic)
        std::sort(offset.begin(), offset.end());
      return offset;
    }


    template <int dim>
    std::vector<FamilyMember<dim>> analytic_family(const Tensor<1, dim> &spacing,
                                                   const double          delta,
                                                   const KernelShape     shape,
                                                   const unsigned int    n,
                                                   const VolumeFraction  fraction)
    {
      std::array<int, dim>    reach;
      std::array<double, dim> edges;
      for (unsigned int d = 0; d < dim; ++d)
        {
          edges[d] = spacing[d];
          reach[d] = static_cast<int>(std::floor(delta / spacing[d] + 0.5 + 1e-6));
        }
      const double                   k0    = micro_conductivity(dim, shape, n, delta);
      const bool                     cubic = is_cubic<dim>(spacing);
      std::vector<FamilyMember<dim>> family;
      const double                   least = std::pow(delta, -static_cast<double>(n));
      // The exact fraction in 3D costs a quadrature: mirrored and permuted offsets look theirs up.
      std::map<std::array<int, dim>, double> known;
      double                                 largest = 0.;
      for (FamilyMember<dim> &member : offsets<dim>(reach, spacing))
        {
          const std::array<int, dim> one   = representative<dim>(member.offset, cubic);
          auto                       found = known.find(one);
          if (found == known.end())
            {
              std::array<double, dim> center;
              for (unsigned int d = 0; d < dim; ++d)
                center[d] = one[d] * spacing[d];
              const double weight = k0 *
                                    weighted_shape<dim>(shape, fraction, center, edges, delta) /
                                    std::pow(member.r, static_cast<double>(n));
              found = known.emplace(one, weight).first;
            }
          member.weight = found->second;
          largest       = std::max(largest, member.weight);
          family.push_back(member);
        }
      // What is left of the conical kernel at r = delta by rounding is not a neighbour.
      family.erase(std::remove_if(family.begin(),
                                  family.end(),
                                  [&](const auto &member) {
                                    return member.weight <= 1e-13 * std::max(largest, k0 * least);
                                  }),
                   family.end());
      return family;
    }


    [[noreturn]] void too_small(const double delta, const double largest_spacing)
    {
      std::ostringstream message;
      message
        << "'Horizon ratio' in section 'Peridynamics': with a horizon of " << delta
        << " and nodes up to " << largest_spacing
        << " apart, a node has no neighbours to conduct to in every direction. The horizon must be "
           "larger than "
           "the spacing in each direction; a ratio of 3 is usual.";
      throw UserError(message.str());
    }


    /** Solve a small system in place with row pivoting; false if it is singular. */
    template <std::size_t dim>
    bool solve(std::array<std::array<double, dim>, dim> A, std::array<double, dim> &s)
    {
      double scale = 0.;
      for (const auto &row : A)
        for (const double a : row)
          scale = std::max(scale, std::abs(a));
      for (std::size_t c = 0; c < dim; ++c)
        {
          std::size_t pivot = c;
          for (std::size_t i = c + 1; i < dim; ++i)
            if (std::abs(A[i][c]) > std::abs(A[pivot][c]))
              pivot = i;
          if (std::abs(A[pivot][c]) <= 1e-12 * scale)
            return false;
          std::swap(A[c], A[pivot]);
          std::swap(s[c], s[pivot]);
          for (std::size_t i = c + 1; i < dim; ++i)
            {
              const double factor = A[i][c] / A[c][c];
              for (std::size_t k = c; k < dim; ++k)
                A[i][k] -= factor * A[c][k];
              s[i] -= factor * s[c];
            }
        }
      for (std::size_t i = dim; i-- > 0;)
        {
          for (std::size_t k = i + 1; k < dim; ++k)
            s[i] -= A[i][k] * s[k];
          s[i] /= A[i][i];
        }
      return true;
    }


    /**
     * The numbers s_a of the discrete calibration; all the same on a cubic lattice, one for the
     * analytic one.
     */
    template <int dim>
    std::array<double, dim> calibration_factors(const std::vector<FamilyMember<dim>> &family,
                                                const Tensor<1, dim>                 &spacing,
                                                const double                          delta,
                                                const Calibration                     calibration)
    {
      const std::array<double, dim> effective = effective_conductivity<dim>(family, spacing);
      double                        largest   = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        largest = std::max(largest, spacing[d]);
      if (*std::min_element(effective.begin(), effective.end()) <= 0.)
        too_small(delta, largest);

      std::array<double, dim> s;
      s.fill(1.);
      if (calibration == Calibration::analytic)
        return s;
      if (is_cubic<dim>(spacing))
        {
          double mean = 0.;
          for (const double e : effective)
            mean += e / dim;
          s.fill(1. / mean);
          return s;
        }
      std::array<std::array<double, dim>, dim> A{};
      const double                             volume = cell_volume<dim>(spacing);
      for (const FamilyMember<dim> &member : family)
        {
          const auto xi2 = squares<dim>(member.offset, spacing);
          for (unsigned int a = 0; a < dim; ++a)
            for (unsigned int b = 0; b < dim; ++b)
              A[a][b] += member.weight * volume * xi2[a] * xi2[b] / (member.r * member.r);
        }
      s.fill(2.);
      if (!solve(A, s) || *std::min_element(s.begin(), s.end()) <= 0.)
        too_small(delta, largest);
      return s;
    }


    template <int dim>
    void scale(const std::array<double, dim>  &s,
               const Tensor<1, dim>           &spacing,
               std::vector<FamilyMember<dim>> &family)
    {
      const bool one_factor = *std::min_element(s.begin(), s.end()) ==
                              *std::max_element(s.begin(), s.end());
      for (FamilyMember<dim> &member : family)
        {
          const auto xi2    = squares<dim>(member.offset, spacing);
          double     factor = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            factor += s[d] * xi2[d] / (member.r * member.r);
          member.weight *= one_factor ? s[0] : factor;
        }
    }


    /** Functions of the direction whose sums shall be those of all directions alike. */
    template <int dim>
    constexpr std::size_t n_even = dim *(dim + 1) / 2;


    /**
     * n_a^2 n_b^2, a <= b; on a cubic lattice 1 and sum_a n_a^4, added in order of size, the others
     * being zero.
     */
    template <int dim>
    std::array<double, n_even<dim>> even_products(const FamilyMember<dim> &member,
                                                  const Tensor<1, dim>    &spacing,
                                                  const bool               cubic)
    {
      auto n2 = squares<dim>(member.offset, spacing);
      for (double &n : n2)
        n /= member.r * member.r;
      std::array<double, n_even<dim>> products{};
      if (cubic)
        {
          std::sort(n2.begin(), n2.end());
          products[0] = 1.;
          for (const double n : n2)
            products[1] += n * n;
          return products;
        }
      std::size_t k = 0;
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = a; b < dim; ++b)
          products[k++] = n2[a] * n2[b];
      return products;
    }


    /** Their means over all directions. */
    template <int dim>
    std::array<double, n_even<dim>> means_of_products(const bool cubic)
    {
      std::array<double, n_even<dim>> means{};
      if (cubic)
        {
          means[0] = 1.;
          means[1] = 3. / (dim + 2.);
          return means;
        }
      std::size_t k = 0;
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = a; b < dim; ++b)
          means[k++] = (a == b ? 3. : 1.) / (dim * (dim + 2.));
      return means;
    }


    template <int dim>
    void make_isotropic(const Tensor<1, dim>           &spacing,
                        const double                    delta,
                        std::vector<FamilyMember<dim>> &family)
    {
      constexpr std::size_t                n       = n_even<dim>;
      const bool                           cubic   = dim > 1 && is_cubic<dim>(spacing);
      const double                         volume  = cell_volume<dim>(spacing);
      double                               largest = 0.;
      std::array<std::array<double, n>, n> A{};
      for (unsigned int d = 0; d < dim; ++d)
        largest = std::max(largest, spacing[d]);
      for (const FamilyMember<dim> &member : family)
        {
          const auto   p = even_products<dim>(member, spacing, cubic);
          const double g = member.weight * volume * member.r * member.r;
          for (std::size_t a = 0; a < n; ++a)
            for (std::size_t b = 0; b < n; ++b)
              A[a][b] += g * p[a] * p[b];
        }
      for (std::size_t k = cubic ? 2 : n; k < n; ++k)
        A[k][k] = A[0][0];
      auto s = means_of_products<dim>(cubic);
      for (double &mean : s)
        mean *= 2. * dim;
      bool works = solve(A, s);
      for (FamilyMember<dim> &member : family)
        {
          const auto p      = even_products<dim>(member, spacing, cubic);
          double     factor = 0.;
          for (std::size_t k = 0; k < n; ++k)
            factor += s[k] * p[k];
          works = works && factor > 0.;
          member.weight *= factor;
        }
      if (!works)
        too_small(delta, largest);
    }
  } // namespace


  template <int dim>
  std::array<double, dim> effective_conductivity(const std::vector<FamilyMember<dim>> &family,
                                                 const Tensor<1, dim>                 &spacing)
  {
    std::array<double, dim> sum{};
    for (const FamilyMember<dim> &member : family)
      {
        const auto xi2 = squares<dim>(member.offset, spacing);
        for (unsigned int d = 0; d < dim; ++d)
          sum[d] += 0.5 * member.weight * cell_volume<dim>(spacing) * xi2[d];
      }
    return sum;
  }


  template <int dim>
  std::vector<FamilyMember<dim>> lattice_family(const Tensor<1, dim> &spacing,
                                                const double          delta,
                                                const KernelShape     shape,
                                                const unsigned int    n,
                                                const VolumeFraction  fraction,
                                                const Calibration     calibration)
  {
    std::vector<FamilyMember<dim>> family =
      analytic_family<dim>(spacing, delta, shape, n, fraction);
    const auto s = calibration_factors<dim>(family, spacing, delta, calibration);
    if (calibration == Calibration::isotropic)
      make_isotropic<dim>(spacing, delta, family);
    else
      scale<dim>(s, spacing, family);
    return family;
  }


  template <int dim>
  std::vector<FamilyMember<dim>> self_term_family(const Tensor<1, dim> &spacing,
                                                  const double          delta,
                                                  const KernelShape     shape,
                                                  const unsigned int    n,
                                                  const VolumeFraction  fraction,
                                                  const Calibration     calibration)
  {
    AssertThrow(
      dim < 3,
      UserError(
        "'Self term' in section 'Peridynamics': 'paper' is defined in one and two dimensions only "
        "(Bobaru 2010 and 2012); use 'none' in three."));
    const auto s =
      calibration_factors<dim>(analytic_family<dim>(spacing, delta, shape, n, fraction),
                               spacing,
                               delta,
                               calibration);
    std::array<int, dim> reach;
    reach.fill(1);
    std::vector<FamilyMember<dim>> touching = offsets<dim>(reach, spacing);
    const double                   k0       = micro_conductivity(dim, shape, n, delta);
    for (FamilyMember<dim> &member : touching)
      {
        double at = 0.5 * member.r;
        if (dim == 1)
          at = shape == KernelShape::conical ? 0. : member.r;
        member.weight =
          0.5 * k0 * kernel_shape(shape, at, delta) / std::pow(member.r, static_cast<double>(n));
      }
    scale<dim>(s, spacing, touching);
    return touching;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(lattice_family);
  PERIDEAL_INSTANTIATE_FUNCTION(self_term_family);
  PERIDEAL_INSTANTIATE_FUNCTION(effective_conductivity);
} // namespace PeriDeal
