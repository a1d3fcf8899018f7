// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/laws/user_bond_law.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <sstream>
#include <utility>

namespace PeriDeal
{
  namespace
  {
    // What nobody writes by chance, behind the states: so many numbers that it is seen where a law
    // has a few more.
    constexpr double       untouched = -6.02214076e23;
    constexpr unsigned int n_behind  = 64;
  } // namespace


  UserBondLaw::UserBondLaw(std::shared_ptr<const UserLibrary> library,
                           std::vector<double>                properties,
                           const unsigned int                 n_states)
    : library(std::move(library))
    , properties(std::move(properties))
    , n_states(n_states)
    , next(n_states + n_behind)
  {
    const std::vector<double> at_first(n_states + 1, 0.); // an address, at least
    BondValues                at_rest{0., 1.};
    at_rest.length                    = 1.;
    const perideal_bond_answer answer = ask(at_rest, at_first.data());
    std::ostringstream         text;
    text << "answers a bond at rest, whose states are 0, with the force " << answer.force
         << ". It has to be 0";
    if (first_fault.text.empty() && answer.force != 0.)
      first_fault.text = text.str();
  }


  std::string UserBondLaw::fault_of(const perideal_bond_answer &answer, const int status) const
  {
    if (std::any_of(next.begin() + n_states, next.end(), [](const double x) {
          return x != untouched;
        }))
      return "writes more states than 'User states' in section 'Material', which is " +
             std::to_string(n_states) + ". Give as many as it has";
    if (status == PERIDEAL_BOND_LAW_SHORTER_STEP)
      return "asks for a shorter step. Give a smaller 'Time step' in section 'Time'";
    if (status != 0)
      return "returns " + std::to_string(status) + " in place of 0";
    for (const auto &[value, name] : {std::make_pair(answer.force, "force"),
                                      std::make_pair(answer.slope, "slope"),
                                      std::make_pair(answer.stored, "stored energy"),
                                      std::make_pair(answer.dissipated, "dissipated energy")})
      if (!std::isfinite(value))
        return std::string("gives a ") + name + " that is no number";
    if (!std::all_of(next.begin(), next.begin() + n_states, [](const double x) {
          return std::isfinite(x);
        }))
      return "gives a state that is no number";
    return "";
  }


  perideal_bond_answer UserBondLaw::ask(const BondValues &values, const double *history) const
  {
    perideal_bond_answer answer{};
    if (!first_fault.text.empty())
      return answer;
    const perideal_bond bond{values.stretch(),
                             values.length,
                             values.damage,
                             step,
                             static_cast<int>(properties.size()),
                             properties.data(),
                             static_cast<int>(n_states),
                             history};
    std::copy_n(history, n_states, next.begin());
    std::fill(next.begin() + n_states, next.end(), untouched);
    std::string thrown;
    int         status = 0;
    try // it may be C++
      {
        status = library->bond_law(&bond, &answer, next.data());
      }
    catch (const std::exception &exception)
      {
        thrown = std::string("throws '") + exception.what() + "'";
      }
    catch (...)
      {
        thrown = "throws an exception";
      }
    const std::string found = thrown.empty() ? fault_of(answer, status) : thrown;
    if (found.empty())
      return answer;
    std::ostringstream text;
    text << found << ". It was asked with the stretch " << bond.stretch << ", the length "
         << bond.length << ", the damage " << bond.damage << " and the time step "
         << bond.time_step;
    first_fault = {text.str(), thrown.empty() && status == PERIDEAL_BOND_LAW_SHORTER_STEP};
    return {};
  }


  double UserBondLaw::effective(const BondValues &bond, const double *history) const
  {
    const double force = ask(bond, history).force, s = bond.stretch();
    return s != 0. ? bond.product * (force / s) : bond.square * force; // F = s to the last bit
  }


  double UserBondLaw::slope(const BondValues &bond, const double *history) const
  {
    return ask(bond, history).slope;
  }


  double UserBondLaw::energy(const BondValues &bond,
                             const double     *history,
                             const bool        dissipated) const
  {
    const perideal_bond_answer answer = ask(bond, history);
    return bond.square * bond.square * (dissipated ? answer.dissipated : answer.stored);
  }


  void UserBondLaw::accept(const BondValues &bond, double *history) const
  {
    ask(bond, history);
    if (first_fault.text.empty())
      std::copy_n(next.begin(), n_states, history);
  }
} // namespace PeriDeal
