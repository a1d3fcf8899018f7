// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/point.h>

#include <perideal/analysis/exact_solid.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/expression.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <type_traits>

#include "solution_text.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using Complex = std::complex<double>;

    constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();


    /** In plane elasticity G and kappa say all: (3 - nu)/(1 + nu) in stress, 3 - 4 nu in strain. */
    struct PlaneModuli
    {
      explicit PlaneModuli(const ExactSolidContext &context)
        : shear(context.moduli.shear)
        , kappa(context.plane == PlaneState::stress ?
                  (3. - context.moduli.poisson()) / (1. + context.moduli.poisson()) :
                  3. - 4. * context.moduli.poisson())
      {}

      double young() const
      {
        return 8. * shear / (1. + kappa);
      }

      double poisson() const
      {
        return (3. - kappa) / (1. + kappa);
      }

      double shear, kappa;
    };


    /**
     * A displacement in the plane that a formula gives, for numbers and for complex numbers, by a
     * small imaginary part of which its gradient follows without loss of digits.
     */
    template <typename Formula>
    class PlaneSolution : public ExactSolution
    {
    public:
      explicit PlaneSolution(const Formula &formula)
        : formula(formula)
      {}

      double value(const double *x, const double, const unsigned int component) const override
      {
        return formula(x[0], x[1])[component];
      }

      bool gradient(const double *x,
                    const double,
                    const unsigned int component,
                    double            *g) const override
      {
        constexpr double step = 1e-60;
        for (unsigned int d = 0; d < 2; ++d)
          {
            const Complex found = formula(Complex(x[0], d == 0 ? step : 0.),
                                          Complex(x[1], d == 1 ? step : 0.))[component];
            g[d]                = std::isnan(found.real()) ? nowhere : found.imag() / step;
          }
        return true;
      }

    private:
      const Formula formula;
    };


    /** In polar coordinates about the centre of the hole; with kappa for both plane states. */
    struct Kirsch
    {
      template <typename Number>
      std::array<Number, 2> operator()(const Number &x, const Number &y) const
      {
        using std::sqrt;
        const Number dx = x - center[0], dy = y - center[1], r = sqrt(dx * dx + dy * dy);
        const Number c = dx / r, s = dy / r;
        const Number c_3 = 4. * c * c * c - 3. * c, s_3 = 3. * s - 4. * s * s * s;
        const Number q = radius / r, cubic = 2. * q * q * q;
        const double scale = tension * radius / (8. * moduli.shear), kappa = moduli.kappa;
        return {{scale * ((kappa + 1.) * c / q + 2. * q * ((1. + kappa) * c + c_3) - cubic * c_3),
                 scale * ((kappa - 3.) * s / q + 2. * q * ((1. - kappa) * s + s_3) - cubic * s_3)}};
      }

      PlaneModuli           moduli;
      std::array<double, 2> center;
      double                radius, tension;
    };


    /** Timoshenko and Goodier, section 21, with an end force -P. */
    struct Cantilever
    {
      template <typename Number>
      std::array<Number, 2> operator()(const Number &at_x, const Number &at_y) const
      {
        const Number x = at_x - begin, y = at_y - middle;
        const double nu = moduli.poisson(), square = height * height;
        const double scale = force / (6. * moduli.young() * square * height / 12.);
        return {{scale * y * ((6. * length - 3. * x) * x + (2. + nu) * (y * y - 0.25 * square)),
                 -scale * (3. * nu * y * y * (length - x) + 0.25 * (4. + 5. * nu) * square * x +
                           (3. * length - x) * x * x)}};
      }

      PlaneModuli moduli;
      double      begin, middle, length, height, force;
    };


    /** Coordinates along and across a crack, and displacements from these back. */
    struct CrackFrame
    {
      /** Points so near to the crack, for its length, are on it: coordinates are rounded. */
      bool is_small(const double distance) const
      {
        return std::abs(distance) < 1e-9 * length;
      }

      template <typename Number>
      std::array<Number, 2> to(const Number &x, const Number &y) const
      {
        const Number dx = x - origin[0], dy = y - origin[1];
        return {{dx * along[0] + dy * along[1], dy * along[0] - dx * along[1]}};
      }

      template <typename Number>
      std::array<Number, 2> from(const std::array<Number, 2> &u) const
      {
        return {{u[0] * along[0] - u[1] * along[1], u[0] * along[1] + u[1] * along[0]}};
      }

      std::array<double, 2> origin, along;
      double                length;
    };


    /** The terms of Williams' series with sqrt(r); the crack is behind its tip. */
    struct TipField
    {
      template <typename Number>
      std::array<Number, 2> operator()(const Number &x, const Number &y) const
      {
        using std::real;
        using std::sqrt;
        const auto   p = frame.to(x, y);
        const Number r = sqrt(p[0] * p[0] + p[1] * p[1]);
        if (frame.is_small(real(r))) // where there is no gradient
          {
            const double none = std::is_same<Number, double>::value ? 0. : nowhere;
            return {{none, none}};
          }
        if (frame.is_small(real(p[1])) && real(p[0]) < 0.)
          return {{nowhere, nowhere}};
        // Half of the angle, from sums that lose no digits.
        const bool   ahead = real(p[0]) > 0.;
        const double side  = real(p[1]) < 0. ? -1. : 1.;
        const Number large = sqrt(0.5 * (ahead ? r + p[0] : r - p[0]) / r);
        const Number c     = ahead ? large : side * p[1] / (2. * r * large);
        const Number s     = ahead ? p[1] / (2. * r * large) : side * large;
        const Number scale = sqrt(r / (2. * numbers::PI)) / (2. * moduli.shear);
        const double kappa = moduli.kappa;
        return frame.from(std::array<Number, 2>{
          {scale * (k_1 * c * (kappa - 1. + 2. * s * s) + k_2 * s * (kappa + 1. + 2. * c * c)),
           scale * (k_1 * s * (kappa + 1. - 2. * c * c) - k_2 * c * (kappa - 1. - 2. * s * s))}});
      }

      PlaneModuli moduli;
      CrackFrame  frame;
      double      k_1, k_2;
    };


    /**
     * Z = S z/sqrt(z^2 - a^2) with z = x + i y from the middle of the crack, half as long as a: 2 G
     * u_x = (kappa - 1)/2 Re int Z - y Im Z, 2 G u_y = (kappa + 1)/2 Im int Z - y Re Z, and uniform
     * T - S along the crack.
     */
    class Westergaard : public ExactSolution
    {
    public:
      Westergaard(const PlaneModuli &moduli,
                  const CrackFrame  &frame,
                  const double       half_length,
                  const double       across,
                  const double       along)
        : moduli(moduli)
        , frame(frame)
        , a(half_length)
        , across(across)
        , more_along(along - across)
      {}

      double value(const double *x, const double, const unsigned int component) const override
      {
        const auto    p = frame.to(x[0], x[1]);
        const Complex root(root_at(p));
        const Complex integral = across * root, z = across * Complex(p[0], p[1]) / root;
        const double  kappa = moduli.kappa, k = 1. / (2. * moduli.shear);
        return frame.from(
          std::array<double, 2>{{k * (0.5 * (kappa - 1.) * integral.real() - p[1] * z.imag() +
                                      0.25 * (1. + kappa) * more_along * p[0]),
                                 k * (0.5 * (kappa + 1.) * integral.imag() - p[1] * z.real() -
                                      0.25 * (3. - kappa) * more_along * p[1])}})[component];
      }

      bool gradient(const double *x,
                    const double,
                    const unsigned int component,
                    double            *g) const override
      {
        const auto    p    = frame.to(x[0], x[1]);
        const Complex root = root_at(p), z = across * Complex(p[0], p[1]) / root,
                      slope = -across * a * a / (root * root * root);
        const double kappa = moduli.kappa, k = 1. / (2. * moduli.shear);
        // Along and across the crack, of the component along and of that across.
        const std::array<double, 2> by_x{
          {k * (0.5 * (kappa - 1.) * z.real() - p[1] * slope.imag() +
                0.25 * (1. + kappa) * more_along),
           k * (0.5 * (kappa + 1.) * z.imag() - p[1] * slope.real())}};
        const std::array<double, 2> by_y{
          {-k * (0.5 * (kappa + 1.) * z.imag() + p[1] * slope.real()),
           k * (0.5 * (kappa - 1.) * z.real() + p[1] * slope.imag() -
                0.25 * (3. - kappa) * more_along)}};
        const double along = frame.from(by_x)[component], across_it = frame.from(by_y)[component];
        g[0] = along * frame.along[0] - across_it * frame.along[1];
        g[1] = along * frame.along[1] + across_it * frame.along[0];
        return true;
      }

    private:
      Complex root_at(const std::array<double, 2> &p) const
      {
        if (frame.is_small(p[1]) && std::abs(p[0]) < a * (1. + 1e-9))
          return frame.is_small(std::abs(p[0]) - a) ? Complex(1e-300) : Complex(nowhere);
        return std::sqrt(Complex(p[0] - a, p[1])) * std::sqrt(Complex(p[0] + a, p[1]));
      }

      const PlaneModuli moduli;
      const CrackFrame  frame;
      const double      a, across, more_along;
    };


    class StandingWave : public ExactSolution
    {
    public:
      StandingWave(const ExactSolidContext &context, const double n, const double amplitude)
        : begin(context.lower[0])
        , k(n * numbers::PI / (context.upper[0] - context.lower[0]))
        , omega(k * std::sqrt(modulus(context) / context.density))
        , amplitude(amplitude)
        , dim(context.dim)
      {}

      double value(const double *x, const double t, const unsigned int component) const override
      {
        return component > 0 ? 0. : amplitude * std::sin(k * (x[0] - begin)) * std::cos(omega * t);
      }

      bool gradient(const double      *x,
                    const double       t,
                    const unsigned int component,
                    double            *g) const override
      {
        std::fill(g, g + dim, 0.);
        if (component == 0)
          g[0] = amplitude * k * std::cos(k * (x[0] - begin)) * std::cos(omega * t);
        return true;
      }

    private:
      /** Against strains along x alone; of a bar, which may contract, Young's. */
      static double modulus(const ExactSolidContext &context)
      {
        if (context.dim == 1)
          return context.moduli.young();
        return lambda_of(context.moduli, context.dim, context.plane) + 2. * context.moduli.shear;
      }

      const double       begin, k, omega, amplitude;
      const unsigned int dim;
    };


    class FormulaSolid : public ExactSolution
    {
    public:
      FormulaSolid(const std::vector<std::string> &texts)
      {
        for (const std::string &text : texts)
          components.emplace_back(text, solution_entry);
        dim = texts.size();
      }

      double value(const double *x, const double t, const unsigned int component) const override
      {
        Point<3> p;
        for (unsigned int d = 0; d < dim; ++d)
          p[d] = x[d];
        return components[component].template value<3>(p, t);
      }

      bool gradient(const double *, const double, const unsigned int, double *) const override
      {
        return false;
      }

    private:
      std::vector<Expression> components;
      unsigned int            dim;
    };


    /** The numbers in the parentheses, at least @p least and at most @p most. */
    std::vector<double> numbers_in(const SolutionCall &call,
                                   const std::size_t   least,
                                   const std::size_t   most,
                                   const std::string  &example)
    {
      std::vector<double> found;
      if (call.has_arguments)
        for (const std::string &part : split_at_commas(call.arguments))
          {
            const Expression number(part, solution_entry);
            AssertThrow(number.is_constant(),
                        UserError(solution_entry + ": '" + call.name +
                                  "' needs constant numbers, but found '" + tidy(part) + "'."));
            found.push_back(number.value<1>(Point<1>()));
          }
      AssertThrow(found.size() >= least && found.size() <= most,
                  UserError(solution_entry + ": '" + call.name + "' needs " +
                            std::to_string(least) +
                            (most > least ? " or " + std::to_string(most) : "") +
                            (most == 1 ? " number" : " numbers") + ", for example '" + example +
                            "', but found '" + call.arguments + "'."));
      return found;
    }


    void require(const bool ok, const SolutionCall &call, const std::string &what)
    {
      AssertThrow(ok, UserError(solution_entry + ": '" + call.name + "' " + what));
    }


    std::unique_ptr<ExactSolution> make_tip_field(const SolutionCall      &call,
                                                  const ExactSolidContext &context)
    {
      const std::vector<double> k = numbers_in(call, 1, 2, "crack tip(1, 0)");
      require(!context.crack.empty() && context.begins_inside != context.ends_inside,
              call,
              "needs one straight crack with one end in the body (section 'Cracks').");
      const unsigned int tip = context.begins_inside ? 0 : 2, other = 2 - tip;
      CrackFrame         frame{{{context.crack[tip], context.crack[tip + 1]}}, {}, 0.};
      const double       x = frame.origin[0] - context.crack[other],
                   y       = frame.origin[1] - context.crack[other + 1];
      frame.length         = std::hypot(x, y);
      frame.along          = {{x / frame.length, y / frame.length}};
      const TipField field{PlaneModuli(context), frame, k[0], k.size() > 1 ? k[1] : 0.};
      return std::make_unique<PlaneSolution<TipField>>(field);
    }


    std::unique_ptr<ExactSolution> make_westergaard(const SolutionCall      &call,
                                                    const ExactSolidContext &context)
    {
      const std::vector<double> s = numbers_in(call, 1, 2, "westergaard(1)");
      require(!context.crack.empty() && context.begins_inside && context.ends_inside,
              call,
              "needs one straight crack with both ends in the body (section 'Cracks').");
      const auto  &c = context.crack;
      const double x = c[2] - c[0], y = c[3] - c[1], length = std::hypot(x, y);
      CrackFrame   frame{{{0.5 * (c[0] + c[2]), 0.5 * (c[1] + c[3])}},
                       {{x / length, y / length}},
                       length};
      return std::make_unique<Westergaard>(PlaneModuli(context),
                                           frame,
                                           0.5 * length,
                                           s[0],
                                           s.back());
    }


    std::unique_ptr<ExactSolution> make_named(const SolutionCall      &call,
                                              const ExactSolidContext &context)
    {
      const auto lacks = [&](const bool has, const std::string &what) {
        require(!has, call, "holds without " + what + ", which the scene has.");
      };
      lacks(context.has_cracks && call.name != "crack tip" && call.name != "westergaard", "cracks");
      lacks(context.has_holes && call.name != "kirsch", "holes");
      if (call.name == "standing wave")
        {
          const std::vector<double> n = numbers_in(call, 1, 2, "standing wave(1, 1e-3)");
          require(n[0] >= 1. && n[0] == std::floor(n[0]),
                  call,
                  "needs a whole number of half waves, at least 1.");
          return std::make_unique<StandingWave>(context, n[0], n.size() > 1 ? n[1] : 1.);
        }
      require(context.dim == 2,
              call,
              "is two-dimensional, but 'Dimension' is " + std::to_string(context.dim) + ".");
      if (call.name == "crack tip")
        return make_tip_field(call, context);
      if (call.name == "westergaard")
        return make_westergaard(call, context);
      if (call.name == "cantilever")
        {
          const double     force  = numbers_in(call, 1, 1, "cantilever(1)")[0];
          const double     height = context.upper[1] - context.lower[1];
          const Cantilever beam{PlaneModuli(context),
                                context.lower[0],
                                0.5 * (context.lower[1] + context.upper[1]),
                                context.upper[0] - context.lower[0],
                                height,
                                force};
          return std::make_unique<PlaneSolution<Cantilever>>(beam);
        }
      const double tension = numbers_in(call, 1, 1, "kirsch(1)")[0];
      require(!context.hole.empty(),
              call,
              "needs one circular hole ('Shape = plate with hole' in section 'Domain').");
      const Kirsch plate{PlaneModuli(context),
                         {{context.hole[0], context.hole[1]}},
                         context.hole[2],
                         tension};
      return std::make_unique<PlaneSolution<Kirsch>>(plate);
    }
  } // namespace


  const std::vector<std::string> &exact_solid_names()
  {
    static const std::vector<std::string> names = {"kirsch",
                                                   "crack tip",
                                                   "westergaard",
                                                   "cantilever",
                                                   "standing wave"};
    return names;
  }


  std::unique_ptr<ExactSolution> make_exact_solid(const std::string       &text,
                                                  const ExactSolidContext &context)
  {
    const auto                    &names = exact_solid_names();
    const SolutionCall             call  = take_apart(tidy(text));
    const std::vector<std::string> parts = split_at_commas(text);
    if (std::find(names.begin(), names.end(), call.name) != names.end())
      {
        require(context.no_named.empty(), call, context.no_named);
        return make_named(call, context);
      }
    refuse_name_of_others(call, exact_solution_names(), "diffusion", names);
    if (parts.size() != context.dim)
      {
        refuse_unknown_name(call, names, "an expression of x, y, z and t for each component");
        AssertThrow(false,
                    UserError(solution_entry + " needs " + std::to_string(context.dim) +
                              " components of the displacement, separated by commas, but '" + text +
                              "' has " + std::to_string(parts.size()) + "."));
      }
    try
      {
        return std::make_unique<FormulaSolid>(parts);
      }
    catch (const UserError &)
      {
        refuse_unknown_name(call, names, "an expression of x, y, z and t for each component");
        throw;
      }
  }
} // namespace PeriDeal
