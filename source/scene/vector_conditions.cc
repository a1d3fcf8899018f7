// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Displacements and tractions of section `Boundary conditions`.

#include <perideal/base/instantiate.h>
#include <perideal/scene/boundary_conditions.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>

namespace PeriDeal
{
  namespace
  {
    const std::string free_word = "free";


    /** Whether the word `free` is in a text, not as a part of a longer word. */
    bool has_free(const std::string &text)
    {
      static const std::regex word("\\bfree\\b");
      return std::regex_search(text, word);
    }


    /** The two formulas that `if(y < 1, 0, free)` stands for. */
    struct FreeBranch
    {
      std::string value; // `free` is 0 in it
      std::string held;  // 1 where there is a value, 0 where `free`; empty: no `free` in the text
    };


    /** `free` alone or as a whole branch of `if(condition, a, b)`; UserError elsewhere. */
    FreeBranch split_free(const std::string &text, const std::string &where)
    {
      if (!has_free(text))
        return {text, ""};
      if (trimmed(text) == free_word)
        return {"0", "0"};
      const std::string inner     = trimmed(text);
      const std::size_t open      = inner.find('(');
      const bool        is_branch = open != std::string::npos && inner.back() == ')' &&
                             trimmed(inner.substr(0, open)) == "if";
      const std::vector<std::string> pieces =
        is_branch ? split_list(inner.substr(open + 1, inner.size() - open - 2), ',') :
                    std::vector<std::string>();
      if (pieces.size() != 3 || has_free(pieces[0]))
        entry_error(
          where,
          "found '" + inner +
            "'; 'free' stands alone or as a branch of its own: if(condition, formula, free).");
      const FreeBranch a = split_free(pieces[1], where), b = split_free(pieces[2], where);
      const auto       joined = [&](const std::string &first, const std::string &second) {
        return "if(" + pieces[0] + ", " + first + ", " + second + ")";
      };
      return {joined(a.value, b.value),
              joined(a.held.empty() ? "1" : a.held, b.held.empty() ? "1" : b.held)};
    }
  } // namespace


  VectorCondition::VectorCondition(const std::string                            &name,
                                   const dealii::types::boundary_id              id,
                                   const std::vector<std::optional<Expression>> &values)
    : name(name)
    , id(id)
    , values(values)
    , held(values.size())
  {
    for (const auto &value : values)
      texts.push_back(value ? value->text() : free_word);
  }


  bool VectorCondition::depends_on_time() const
  {
    return rate || std::any_of(values.begin(), values.end(), [](const auto &value) {
             return value && value->depends_on_time();
           });
  }


  template <int dim>
  bool VectorCondition::holds(const unsigned int component, const dealii::Point<dim> &p) const
  {
    return values[component] && (!held[component] || held[component]->value(p) > 0.);
  }


  bool is_zero(const Expression &formula)
  {
    return formula.is_constant() && formula.value(dealii::Point<1>()) == 0.;
  }


  void parse_components(const std::string &text,
                        const unsigned int dim,
                        const bool         may_be_free,
                        const std::string &where,
                        VectorCondition   &condition,
                        const std::string &known)
  {
    const std::vector<std::string> pieces = split_list(text, ',');
    if (pieces.size() != dim)
      entry_error(where,
                  "found '" + text + "', needs " + std::to_string(dim) +
                    (dim == 1 ? " component" : " components separated by commas") +
                    (may_be_free ? ", a formula or 'free' each." :
                                   ", a formula" + std::string(dim == 1 ? "." : " each.")));
    condition.values.assign(dim, {});
    condition.held.assign(dim, {});
    condition.texts = pieces;
    for (unsigned int c = 0; c < dim; ++c)
      {
        const std::string at = where + ", component in " + "xyz"[c];
        if (has_free(pieces[c]) && !may_be_free)
          entry_error(
            where,
            "'free' stands for displacements that nothing holds; give 0 for the component in " +
              std::string(1, "xyz"[c]) + ".");
        const FreeBranch branch = split_free(pieces[c], at);
        if (pieces[c] == free_word)
          continue;
        if (!branch.held.empty())
          condition.held[c] = Expression(branch.held, at, "x, y, z");
        condition.values[c] = Expression(branch.value, at, known);
        if (branch.held.empty())
          continue;
        if (condition.held[c]->depends_on_time())
          entry_error(
            at,
            "found '" + pieces[c] +
              "', where a component is free at some times only; the condition may depend on x, y, z.");
        if (condition.held[c]->is_constant() && condition.held[c]->value(dealii::Point<1>()) == 0.)
          entry_error(at, "'" + pieces[c] + "' is free everywhere; write 'free'.");
      }
    if (std::none_of(condition.values.begin(), condition.values.end(), [](const auto &value) {
          return value.has_value();
        }))
      entry_error(
        where,
        dim == 1 ?
          "is free, which is an empty grip: leave the side out, or give its displacement." :
          "all components are free, which is an empty grip: leave the side out, or give a component its displacement.");
  }


  std::vector<Expression> parse_vector(const std::string &text,
                                       const unsigned int dim,
                                       const std::string &where,
                                       const std::string &known)
  {
    VectorCondition condition;
    parse_components(text, dim, false, where, condition, known);
    std::vector<Expression> list;
    for (const auto &value : condition.values)
      list.push_back(*value);
    return list;
  }


  namespace
  {
    /**
     * Simpson's rule, halved until two halves agree with the whole to 1e-11 of the largest value
     * given; values that are round-off of larger ones, as 1 - cos(t) near 0, never do: so many at
     * most.
     */
    template <typename Function>
    class Simpson
    {
    public:
      Simpson(const Function &f, const double largest, const double length)
        : f(f)
        , largest(largest)
        , enough(length / most_values)
      {}

      double operator()(const double       a,
                        const double       b,
                        const double       at_a,
                        const double       at_middle,
                        const double       at_b,
                        const unsigned int left)
      {
        const double middle = 0.5 * (a + b), whole = (b - a) / 6. * (at_a + 4. * at_middle + at_b);
        const double of_left = f(0.5 * (a + middle)), of_right = f(0.5 * (middle + b));
        const double halves =
          (b - a) / 12. * (at_a + 4. * of_left + 2. * at_middle + 4. * of_right + at_b);
        largest = std::max({largest, std::abs(of_left), std::abs(of_right)});
        n_values += 2;
        if (left == 0 || (n_values > most_values && b - a < enough) ||
            std::abs(halves - whole) <= 1e-11 * (b - a) * largest)
          return halves + (halves - whole) / 15.;
        return (*this)(a, middle, at_a, of_left, at_middle, left - 1) +
               (*this)(middle, b, at_middle, of_right, at_b, left - 1);
      }

    private:
      static constexpr unsigned int most_values = 1000;
      const Function               &f;
      double                        largest;
      const double                  enough; // pieces as long as this are halved in any case
      unsigned int                  n_values = 0;
    };
  } // namespace


  template <int dim>
  double integral_over_time(const Expression         &rate,
                            const dealii::Point<dim> &p,
                            const double              from,
                            const double              to)
  {
    if (!rate.depends_on_time())
      return rate.value(p) * (to - from);
    if (from == to)
      return 0.;
    const auto             f    = [&](const double t) { return rate.value(p, t); };
    constexpr unsigned int most = 40, // halvings: enough for a jump
      n_pieces                  = 4;  // so that what lasts shortly is seen
    std::array<double, 2 * n_pieces + 1> values;
    double                               sum = 0., largest = 0.;
    const auto at = [&](const unsigned int k) { return from + (to - from) * k / (2 * n_pieces); };
    for (unsigned int k = 0; k < values.size(); ++k)
      {
        values[k] = f(at(k));
        largest   = std::max(largest, std::abs(values[k]));
      }
    for (unsigned int k = 0; k < values.size() - 1; k += 2)
      {
        Simpson simpson(f, largest, at(k + 2) - at(k));
        sum += simpson(at(k), at(k + 2), values[k], values[k + 1], values[k + 2], most);
      }
    return sum;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(integral_over_time);

#define PERIDEAL_TEMPLATES(dim) \
  template bool VectorCondition::holds(const unsigned int, const dealii::Point<dim> &) const;
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
