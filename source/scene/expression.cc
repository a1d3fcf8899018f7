// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/diverged.h>
#include <perideal/base/instantiate.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/formula_names.h>
#include <perideal/scene/lists.h>

#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <optional>

namespace PeriDeal
{
  /** The byte code and the variables it reads. */
  struct Expression::Compiled
  {
    mu::Parser parser;
    double     x = 0., y = 0., z = 0., t = 0., T = 0.;
    bool       uses_time = false, uses_position = false, uses_temperature = false;

    std::vector<double>      marks; // marked_temperatures()
    std::vector<std::string> names; // of variables that are no place; else empty

    std::shared_ptr<const FormulaNames> known = names_of_formulas(); // the tables are in use

    std::function<double(const dealii::Point<3> &, const double)> function; // else the parser

    double value() const
    {
      return function ? function({x, y, z}, t) : parser.Eval();
    }
  };


  namespace
  {
    DeferredFormulaErrors *collector = nullptr;


    // What users of deal.II's FunctionParser find beyond muparser's own functions, with the same
    // meaning
    double if_then_else(const double condition, const double a, const double b)
    {
      return std::rint(condition) != 0. ? a : b;
    }

    double bar_or(const double a, const double b)
    {
      return std::rint(a) != 0. || std::rint(b) != 0.;
    }

    double bar_and(const double a, const double b)
    {
      return std::rint(a) != 0. && std::rint(b) != 0.;
    }


    void define_names(mu::Parser &parser)
    {
      parser.ClearConst();
      parser.DefineConst("pi", 3.14159265358979323846);
      parser.DefineConst("Pi", 3.14159265358979323846);
      parser.DefineConst("E", 2.71828182845904523536);
      parser.DefineFun("if", if_then_else);
      parser.DefineOprt("|", bar_or, 1);
      parser.DefineOprt("&", bar_and, 2);
      const std::pair<const char *, mu::fun_type1> functions[] = {
        {"int", [](double v) { return std::trunc(v); }},
        {"ceil", [](double v) { return std::ceil(v); }},
        {"floor", [](double v) { return std::floor(v); }},
        {"sec", [](double v) { return 1. / std::cos(v); }},
        {"csc", [](double v) { return 1. / std::sin(v); }},
        {"cot", [](double v) { return 1. / std::tan(v); }},
        {"erf", [](double v) { return std::erf(v); }},
        {"erfc", [](double v) { return std::erfc(v); }}};
      for (const auto &[name, function] : functions)
        parser.DefineFun(name, function);
      parser.DefineFun("pow", static_cast<mu::fun_type2>([](double a, double b) {
                         return std::pow(a, b);
                       }));
    }


    double value_of_table(void *const table, const double place)
    {
      return static_cast<const FormulaTable *>(table)->value(place);
    }


    /** Names of the scene, of which variables come first. */
    void define_names_of_scene(mu::Parser                     &parser,
                               const FormulaNames             &names,
                               const std::vector<std::string> &variables)
    {
      for (const auto &[name, number] : names.constants)
        if (!has(variables, name))
          parser.DefineConst(name, number);
      for (const FormulaTable &table : names.tables)
        if (!has(variables, table.name))
          parser.DefineFunUserData(table.name,
                                   value_of_table,
                                   const_cast<FormulaTable *>(&table), // it does not change
                                   false); // so that what it lacks is told of numbers, too
    }


    /** Whether a name stands in a formula, not as a part of another. */
    bool mentions(const std::string &formula, const std::string &name)
    {
      const auto is_part = [&](const std::size_t k) {
        return k < formula.size() &&
               (std::isalnum(static_cast<unsigned char>(formula[k])) || formula[k] == '_');
      };
      for (std::size_t k = formula.find(name); k != std::string::npos;
           k             = formula.find(name, k + 1))
        if (!is_part(k - 1) && !is_part(k + name.size()))
          return true;
      return false;
    }


    /**
     * `&&` and `||` as the operators `&` and `|` and a blank, so that columns stay: muparser reads
     * its own as two of ours.
     */
    std::string with_single_signs(std::string formula)
    {
      for (std::size_t i = 0; i + 1 < formula.size(); ++i)
        if ((formula[i] == '&' || formula[i] == '|') && formula[i + 1] == formula[i])
          formula[i + 1] = ' ';
      return formula;
    }


    bool is_name_start(const char c)
    {
      return std::isalpha(static_cast<unsigned char>(c)) || c == '_';
    }


    /**
     * Numbers of a formula, a and b one after the other: 0, +-a, +-a+-b, and all middles; and of
     * its tables.
     */
    std::vector<double> marks_of(const std::string &formula, const FormulaNames &names)
    {
      std::vector<double> places{0.}, marks;
      for (const FormulaTable &table : names.tables)
        if (mentions(formula, table.name))
          places.insert(places.end(), table.places.begin(), table.places.end());
      double last = 0.;
      for (const char *c = formula.c_str(); *(c += std::strcspn(c, "0123456789.")) != '\0';)
        {
          char        *end    = nullptr;
          const double number = std::min(std::strtod(c, &end), 1e300); // finite
          for (const double a : {-number, number})
            places.insert(places.end(), {a - last, a, a + last});
          last = number;
          c    = std::max<const char *>(end, c + 1); // past a dot alone
        }
      std::sort(places.begin(), places.end());
      for (const double place : places)
        if (marks.empty() || place > marks.back())
          marks.insert(marks.end(),
                       {0.5 * ((marks.empty() ? place : marks.back()) + place), place});
      return marks;
    }


    /** Why muparser could not make sense of the text that starts with @p token. */
    std::string unknown_token(const mu::Parser  &parser,
                              const std::string &token,
                              const std::string &variables)
    {
      if (token.empty())
        return "the formula ends too early";
      if (std::isdigit(static_cast<unsigned char>(token[0])) || token[0] == '.')
        return "'" + token + "' is not a number";
      if (!is_name_start(token[0]))
        return "unexpected character '" + token.substr(0, 1) + "'";
      if (parser.GetFunDef().count(token) > 0)
        return "the function '" + token + "' needs its arguments in parentheses";
      if (token == "T")
        return "'T': the temperature is available in formulas of the material only; known variables: " +
               variables;
      if (token == "rand" || token == "rand_seed")
        return "'" + token + "': random numbers are not available, since a run must be repeatable";
      if (token == "and" || token == "or")
        return "unknown name '" + token + "'; write " + (token == "and" ? "&&" : "||");
      std::vector<std::string> known = split_list(variables, ',');
      for (const auto &constant : parser.GetConst())
        known.push_back(constant.first);
      for (const auto &function : parser.GetFunDef())
        known.push_back(function.first);
      const std::string nearest = token.size() > 1 ? nearest_name(token, known) : "";
      return "unknown name '" + token + "'" +
             (nearest.empty() ? "; known variables: " + variables :
                                "; did you mean '" + nearest + "'?");
    }


    /** muparser's error in plain words. */
    std::string reason(const mu::Parser      &parser,
                       const mu::ParserError &error,
                       const std::string     &variables)
    {
      const std::string token = trimmed(error.GetToken());
      switch (error.GetCode())
        {
          case mu::ecUNASSIGNABLE_TOKEN:
            return unknown_token(parser, token, variables);
          case mu::ecUNEXPECTED_EOF:
            return "the formula ends too early";
          case mu::ecUNEXPECTED_OPERATOR:
            return "unexpected operator '" + token + "'" +
                   (token == "*" ? " (powers are written x^2)" : "");
          case mu::ecUNEXPECTED_VAL:
          case mu::ecUNEXPECTED_VAR:
          case mu::ecUNEXPECTED_FUN:
            return "an operator is missing before '" + token + "'";
          case mu::ecUNEXPECTED_ARG_SEP:
            return "unexpected comma";
          case mu::ecUNEXPECTED_PARENS:
            return "unexpected parenthesis '" + token + "'";
          case mu::ecMISSING_PARENS:
            return "a closing parenthesis is missing";
          case mu::ecTOO_MANY_PARAMS:
            return "the function '" + token + "' has too many arguments";
          case mu::ecTOO_FEW_PARAMS:
            return "the function '" + token + "' has too few arguments";
          case mu::ecMISSING_ELSE_CLAUSE:
            return "'?' without ':'";
          case mu::ecMISPLACED_COLON:
            return "unexpected ':'";
          case mu::ecEXPRESSION_TOO_LONG:
            return "the formula is longer than muparser allows";
          default:
            return error.GetMsg();
        }
    }


    /** Of a long formula only what surrounds the column. */
    std::string excerpt(const std::string &formula, const long column)
    {
      const std::size_t width = 60, at = static_cast<std::size_t>(column);
      const std::size_t begin = at > width ? at - width : 0;
      return (begin > 0 ? "..." : "") + formula.substr(begin, 2 * width) +
             (begin + 2 * width < formula.size() ? "..." : "");
    }


    [[noreturn]] void formula_error(const std::string &where,
                                    const std::string &formula,
                                    const long         position,
                                    const std::string &why)
    {
      const long  last   = static_cast<long>(formula.size());
      const long  column = std::max(1L, std::min(position + 1, last));
      const char *end    = why.back() == '?' ? "" : ".";
      entry_error(where,
                  "in the formula '" + excerpt(formula, column) + "' at column " +
                    std::to_string(column) + ": " + why + end);
    }


    /** muparser would let `x = 3` change the variable: refuse all `=` that are no comparison. */
    void refuse_assignment(const std::string &formula, const std::string &where)
    {
      for (std::size_t i = 0; i < formula.size(); ++i)
        {
          if (formula[i] != '=')
            continue;
          if (i + 1 < formula.size() && formula[i + 1] == '=')
            ++i;
          else if (i == 0 || std::string("<>!").find(formula[i - 1]) == std::string::npos)
            formula_error(where, formula, static_cast<long>(i), "'=' is no comparison, write '=='");
        }
    }
  } // namespace


  Expression::Expression()
    : Expression(0.)
  {}


  Expression::Expression(const double constant)
    : formula(number_text(constant))
    , constant(constant)
  {}


  namespace
  {
    bool is_of_places(const std::string &variables)
    {
      return variables.front() == 'x' || variables.front() == 't';
    }
  } // namespace


  Expression::Expression(
    const std::function<double(const dealii::Point<3> &, const double)> &function,
    const bool                                                           depends_on_time)
    : compiled(std::make_shared<Compiled>())
    , formula("a function of the program")
    , constant(0.)
  {
    compiled->function      = function;
    compiled->uses_time     = depends_on_time;
    compiled->uses_position = true;
  }


  Expression::Expression(const std::string &text,
                         const std::string &where,
                         const std::string &variables,
                         const bool         with_temperature)
    : formula(trimmed(text))
    , where(where)
    , constant(0.)
  {
    if (formula.empty())
      entry_error(where, "is empty, needs a number or a formula of " + variables + ".");
    // Compiling a formula takes a hundred times as long.
    if (const std::optional<double> number = plain_number(formula);
        number && std::isfinite(*number))
      {
        constant = *number;
        return;
      }
    // The variants of a scene have most of their formulas in common.
    const bool of_places = is_of_places(variables);
    static std::map<std::pair<std::string, std::string>, std::weak_ptr<Compiled>> known;
    std::weak_ptr<Compiled>                                                      &one =
      known[{formula,
             (of_places ? (with_temperature ? "x, T" : "x") : variables) + '\n' +
               std::to_string(reinterpret_cast<std::uintptr_t>(names_of_formulas().get()))}];
    compiled = one.lock();
    if (compiled != nullptr)
      return;
    compiled = std::make_shared<Compiled>();
    compile(variables, with_temperature);
    one = compiled;
  }


  void Expression::compile(const std::string &variables, const bool with_temperature)
  {
    refuse_assignment(formula, where);
    mu::Parser &parser = compiled->parser;
    define_names(parser);
    std::vector<std::string> names{"x", "y", "z", "t"};
    if (!is_of_places(variables))
      compiled->names = names = split_list(variables, ',');
    double *const places[] = {&compiled->x, &compiled->y, &compiled->z, &compiled->t};
    for (unsigned int k = 0; k < names.size(); ++k)
      parser.DefineVar(names[k], places[k]);
    if (with_temperature)
      {
        parser.DefineVar("T", &compiled->T);
        names.emplace_back("T");
      }
    define_names_of_scene(parser, *compiled->known, names);
    table_fault() = {};
    int n_results = 0;
    try
      {
        parser.SetExpr(with_single_signs(formula));
        // before GetUsedVar(), which takes unknown names for variables
        constant  = parser.Eval();
        n_results = parser.GetNumResults();
        for (const auto &variable : parser.GetUsedVar())
          {
            const std::string &name                 = variable.first;
            (name == "t" ? compiled->uses_time :
             name == "T" ? compiled->uses_temperature :
                           compiled->uses_position) = true;
          }
      }
    catch (const mu::ParserError &error)
      {
        formula_error(where, formula, error.GetPos(), reason(parser, error, variables));
      }
    if (n_results != 1)
      entry_error(where,
                  "the formula '" + formula + "' gives " + std::to_string(n_results) +
                    " values, needs one (is a comma outside parentheses?).");
    if (compiled->uses_temperature)
      compiled->marks = marks_of(formula, *compiled->known);
    if (!compiled->uses_time && !compiled->uses_position && !compiled->uses_temperature)
      {
        compiled.reset();
        if (!std::isfinite(constant))
          entry_error(where,
                      "the value of '" + formula + "' is not finite." + table_fault().text());
      }
  }


  template <int dim>
  double Expression::value(const dealii::Point<dim> &p,
                           const double              t,
                           const double              temperature) const
  {
    if (compiled == nullptr)
      return constant;
    compiled->x        = p[0];
    compiled->y        = dim > 1 ? p[dim > 1 ? 1 : 0] : 0.;
    compiled->z        = dim > 2 ? p[dim > 2 ? 2 : 0] : 0.;
    compiled->t        = t;
    compiled->T        = temperature;
    const double value = compiled->value();
    if (!std::isfinite(value) && (collector == nullptr || collector->message.empty()))
      not_finite(p, t, temperature);
    return std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
  }


  template <int dim>
  void Expression::not_finite(const dealii::Point<dim> &p,
                              const double              t,
                              const double              temperature) const
  {
    std::string values;
    for (unsigned int d = 0; d < std::min<std::size_t>(dim, compiled->names.size()); ++d)
      values += (d > 0 ? ", " : "") + compiled->names[d] + " = " + number_text(p[d]);
    // Properties of a temperature are asked for without a time.
    const bool hides_time = !values.empty() || (compiled->uses_temperature && !compiled->uses_time);
    table_fault()         = {};
    compiled->value(); // for what a table has to say
    const std::string remedy = table_fault().table == nullptr ?
                                 " Change the formula so that it is a number everywhere." :
                                 table_fault().text();
    report_formula_error(
      (where.empty() ? "The" : "Entry " + where + ": the") + " value of '" + formula +
      "' is not finite at " + (values.empty() ? point_text(p) : values) +
      (hides_time ? "" : ", t = " + number_text(t)) +
      (compiled->uses_temperature ? ", T = " + number_text(temperature) : "") + "." + remedy);
  }


  bool Expression::is_constant() const
  {
    return compiled == nullptr;
  }


  bool Expression::depends_on_time() const
  {
    return compiled != nullptr && compiled->uses_time;
  }


  bool Expression::depends_on_position() const
  {
    return compiled != nullptr && compiled->uses_position;
  }


  bool Expression::depends_on_temperature() const
  {
    return compiled != nullptr && compiled->uses_temperature;
  }


  const std::vector<double> &Expression::marked_temperatures() const
  {
    static const std::vector<double> none;
    return compiled == nullptr ? none : compiled->marks;
  }


  const std::string &Expression::text() const
  {
    return formula;
  }


  bool Expression::is_reserved(const std::string &name)
  {
    mu::Parser parser;
    define_names(parser);
    return has(std::vector<std::string>{"x", "y", "z", "t", "T"}, name) ||
           parser.GetFunDef().count(name) > 0 || parser.GetConst().count(name) > 0;
  }


  namespace
  {
    Diverged formula_error(const std::string &message)
    {
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      Diverged         error(message, "formulas", none, none);
      error.trip.cause = message;
      return error;
    }
  } // namespace


  void report_formula_error(const std::string &message)
  {
    if (collector == nullptr)
      throw formula_error(message);
    if (collector->message.empty())
      collector->message = message;
  }


  DeferredFormulaErrors::DeferredFormulaErrors()
  {
    collector = this;
  }


  DeferredFormulaErrors::~DeferredFormulaErrors()
  {
    collector = nullptr;
  }


  void DeferredFormulaErrors::throw_if_any(const MPI_Comm communicator) const
  {
    const std::string found = first(communicator);
    if (!found.empty())
      throw formula_error(found);
  }


  std::string DeferredFormulaErrors::first(const MPI_Comm communicator) const
  {
    const unsigned int rank   = dealii::Utilities::MPI::this_mpi_process(communicator),
                       n_proc = dealii::Utilities::MPI::n_mpi_processes(communicator);
    const unsigned int owner =
      dealii::Utilities::MPI::min(message.empty() ? n_proc : rank, communicator);
    return owner == n_proc ? "" : dealii::Utilities::MPI::broadcast(communicator, message, owner);
  }


  void with_formulas(const MPI_Comm communicator, const std::function<void()> &action)
  {
    const DeferredFormulaErrors errors;
    try
      {
        action();
      }
    catch (Diverged &diverged) // on all processes
      {
        if (diverged.trip.monitor == "formulas") // where what is not positive is no number
          errors.throw_if_any(communicator);
        if (diverged.trip.cause.empty())
          diverged.trip.cause = errors.first(communicator);
        throw;
      }
    catch (const UserError &)
      {
        // The cause, if it is a formula's value; not of this process alone: others wait elsewhere.
        if (all_processes_arrive(communicator))
          errors.throw_if_any(communicator);
        throw;
      }
    errors.throw_if_any(communicator);
  }


#define PERIDEAL_TEMPLATES(dim)                                                                  \
  template double Expression::value<dim>(const dealii::Point<dim> &, const double, const double) \
    const;
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
