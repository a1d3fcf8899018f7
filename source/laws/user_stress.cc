// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/laws/user_stress.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cfenv>
#include <cmath>
#include <cstring>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr double guard = -6.02214076e23; // what nobody writes by chance

    /** Abaqus' order. */
    constexpr unsigned int rows_of_list[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

    // Of a state.
    constexpr unsigned int stress_at = 6, energies_at = 12, work_at = 15;
  } // namespace


  /** The arguments of one call, with numbers behind lists that have to stay what they are. */
  struct UserStress::Call
  {
    static constexpr unsigned int n_guards = 64;

    Call(const UserStress &law, const Trial &trial);

    /** From the accepted strain to the new one, by which displacement gradients. */
    void find_gradients();

    static void make(void *const call);

    const Umat                        umat;
    const int                         n; // of stresses
    std::array<unsigned int, 6>       row{};
    std::array<double, 6 + n_guards>  stress{};
    std::array<double, 36 + n_guards> tangent{};
    std::array<double, 6>             strain{}, increment{}, of_heat{}, by_temperature{};
    std::vector<double>               statev, properties;
    std::array<double, 9> rotation{{1., 0., 0., 0., 1., 0., 0., 0., 1.}}, gradient_before{rotation},
      gradient{rotation};
    std::array<double, 3> energies{}, place{};
    double step_ratio = 1., heat = 0., heat_by_temperature = 0., step, times[2], temperature = 0.,
           no_change = 0., predefined = 0., length;
    char name[80];
    int  n_normal, n_shear, n_all, n_states, n_properties, element, point,
      layer = 1, section = 1, numbers_of_step[4]{1, 0, 0, 0}, number_of_increment;
    bool rests = true; // neither strain nor time goes on
  };


  UserStress::Call::Call(const UserStress &law, const Trial &trial)
    : umat(law.library->umat)
    , n(law.n_normal + law.n_shear)
    , statev(law.numbers.n_states + n_guards, guard)
    , properties(law.numbers.properties)
    , step(trial.step > 0. ? trial.step : trial.instant)
    , length(trial.length)
    , n_normal(law.n_normal)
    , n_shear(law.n_shear)
    , n_all(n)
    , n_states(law.numbers.n_states)
    , n_properties(law.numbers.properties.size())
    , element(trial.element + 1)
    , point(trial.point + 1)
    , number_of_increment(trial.increment)
  {
    if (properties.empty())
      properties.push_back(0.); // an address, at least
    for (int k = 0; k < n; ++k)
      row[k] = k < n_normal ? k : 3 + k - n_normal;
    std::fill(stress.begin() + n, stress.end(), guard);
    std::fill(tangent.begin() + n * n, tangent.end(), guard);
    rests = !(trial.step > 0.);
    for (int k = 0; k < n; ++k)
      {
        const auto  &at   = rows_of_list[row[k]];
        const double size = row[k] < 3 ? 1. : 2.;
        strain[k]         = trial.state[row[k]];
        increment[k]      = size * trial.strain[at[0]][at[1]] - strain[k];
        stress[k]         = trial.state[stress_at + row[k]];
        rests             = rests && increment[k] == 0.;
      }
    std::copy_n(trial.state + energies_at, 3, energies.begin());
    std::copy_n(trial.state + first_of_user, n_states, statev.begin());
    std::copy_n(trial.parameters, 3, place.begin());
    // A first load that is put on at once has taken its instant.
    const double begun = trial.increment > 1 ? trial.instant : 0.;
    times[0] = times[1] = std::max(trial.time - trial.step, begun);
    const auto &material =
      law.numbers.materials[static_cast<unsigned int>(std::lround(trial.parameters[3]))];
    std::memset(name, ' ', sizeof(name));
    std::transform(material.begin(),
                   material.begin() + std::min(material.size(), sizeof(name)),
                   name,
                   [](const unsigned char c) { return std::toupper(c); });
  }


  void UserStress::Call::find_gradients()
  {
    for (int k = 0; k < n; ++k)
      {
        const auto  &at   = rows_of_list[row[k]];
        const double size = row[k] < 3 ? 1. : 0.5;
        const auto   add  = [&](const unsigned int entry) {
          gradient_before[entry] += size * strain[k];
          gradient[entry] += size * (strain[k] + increment[k]);
        };
        add(at[0] + 3 * at[1]);
        if (at[0] != at[1])
          add(at[1] + 3 * at[0]);
      }
  }


  void UserStress::Call::make(void *const call)
  {
    Call &of = *static_cast<Call *>(call);
    of.umat(of.stress.data(),
            of.statev.data(),
            of.tangent.data(),
            &of.energies[0],
            &of.energies[1],
            &of.energies[2],
            &of.heat,
            of.of_heat.data(),
            of.by_temperature.data(),
            &of.heat_by_temperature,
            of.strain.data(),
            of.increment.data(),
            of.times,
            &of.step,
            &of.temperature,
            &of.no_change,
            &of.predefined,
            &of.predefined,
            of.name,
            &of.n_normal,
            &of.n_shear,
            &of.n_all,
            &of.n_states,
            of.properties.data(),
            &of.n_properties,
            of.place.data(),
            of.rotation.data(),
            &of.step_ratio,
            &of.length,
            of.gradient_before.data(),
            of.gradient.data(),
            &of.element,
            &of.point,
            &of.layer,
            &of.section,
            of.numbers_of_step,
            &of.number_of_increment,
            sizeof(of.name));
  }


  UserStress::UserStress(const std::shared_ptr<const UserLibrary> &library,
                         const unsigned int                        dim,
                         const StressState                         kind,
                         const Numbers                            &numbers)
    : library(library)
    , n_normal(kind == StressState::plane_stress ? 2 : 3)
    , n_shear(dim == 3 ? 3 : 1)
    , numbers(numbers)
  {}


  std::vector<std::pair<std::string, unsigned int>> UserStress::shown() const
  {
    std::vector<std::pair<std::string, unsigned int>> list;
    for (unsigned int k = 0; k < numbers.n_states; ++k)
      list.emplace_back("state_" + std::to_string(k + 1), first_of_user + k);
    return list;
  }


  std::string UserStress::fault_of(const Call &call, const bool with_tangent) const
  {
    constexpr double alike   = 1e-6;
    const int        n       = call.n;
    const auto       spoiled = [](const auto begin, const auto end) {
      return std::any_of(begin, end, [](const double value) { return value != guard; });
    };
    const auto finite = [](const auto begin, const auto count) {
      return std::all_of(begin, begin + count, [](const double value) {
        return std::isfinite(value);
      });
    };
    if (spoiled(call.statev.begin() + numbers.n_states, call.statev.end()))
      return "writes more states than 'User states' in section 'Material', which is " +
             std::to_string(numbers.n_states) + ". Give as many as it has";
    if (spoiled(call.stress.begin() + n, call.stress.end()) ||
        spoiled(call.tangent.begin() + n * n, call.tangent.end()))
      return "writes behind the end of STRESS or DDSDDE, which have NTENS = " + std::to_string(n) +
             " rows here (NDI = " + std::to_string(n_normal) +
             ", NSHR = " + std::to_string(n_shear) + "). Let it go by these numbers";
    if (call.step_ratio < 1.)
      {
        std::ostringstream text;
        text << "asks for a step of " << call.step_ratio
             << " times this one (PNEWDT). Give a smaller 'Time step' in section 'Time'";
        return text.str();
      }
    if (!finite(call.stress.begin(), n))
      return "gives a stress that is no number";
    if (!finite(call.energies.begin(), 3) || !finite(call.statev.begin(), numbers.n_states))
      return "gives an energy or a state that is no number";
    if (!with_tangent)
      return "";
    if (!finite(call.tangent.begin(), n * n))
      return "gives a tangent (DDSDDE) that is no number";
    double largest = 0., gap = 0.;
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        {
          largest = std::max(largest, std::abs(call.tangent[a + n * b]));
          gap     = std::max(gap, std::abs(call.tangent[a + n * b] - call.tangent[b + n * a]));
        }
    if (gap <= alike * largest)
      return "";
    std::ostringstream text;
    text << "gives a tangent (DDSDDE) that is not symmetric: entries differ from those across the "
            "diagonal by up to "
         << gap / largest
         << " times the largest. The solvers of bodies at rest need a symmetric one: let the law "
            "give its symmetric part, with which Newton takes more iterations and finds the same, "
            "or use 'Solver = dynamics' in section 'Elasticity', which asks for it at zero strain "
            "alone";
    return text.str();
  }


  void UserStress::throw_fault(const std::string &fault, const Call &call, const Trial &trial) const
  {
    std::ostringstream text;
    const auto         list = [&](const auto &values, const unsigned int count) {
      for (unsigned int k = 0; k < count; ++k)
        text << (k > 0 ? ", " : "") << values[k];
    };
    text << "Entry 'User law' in section 'Material': '" << library->file_name << "' " << fault
         << ". It was asked at (";
    list(call.place, n_shear == 3 ? 3 : 2);
    text << "), element " << call.element << ", point " << call.point << ", at t = " << trial.time
         << ", increment " << call.number_of_increment << ", from the strain ";
    list(call.strain, call.n);
    text << " on by ";
    list(call.increment, call.n);
    text << '.';
    AssertThrow(false, UserError(text.str()));
    std::terminate();
  }


  StressLaw::Response UserStress::update(const Trial &trial, double *next, Tangent *tangent) const
  {
    const double *const before = trial.state;
    Call                call(*this, trial);
    std::copy_n(before, n_state(), next);
    if (!call.rests || tangent != nullptr)
      {
        call.find_gradients();
#ifdef DEBUG
        std::fenv_t exceptions; // deal.II stops at operations that the law may do
        feholdexcept(&exceptions);
#endif
        const bool is_back = comes_back(Call::make, &call);
#ifdef DEBUG
        fesetenv(&exceptions);
#endif
        const std::string fault = is_back ? fault_of(call, tangent != nullptr) :
                                            "has ended the run (XIT)";
        if (!fault.empty())
          throw_fault(fault, call, trial);
      }
    Response result;
    if (!call.rests)
      {
        for (int k = 0; k < call.n; ++k)
          {
            const unsigned int r = call.row[k];
            // Not the sum of both, which need not be this to the last digit.
            next[r] = (r < 3 ? 1. : 2.) * trial.strain[rows_of_list[r][0]][rows_of_list[r][1]];
            next[stress_at + r] = call.stress[k];
            next[work_at] += 0.5 * (before[stress_at + r] + call.stress[k]) * (next[r] - before[r]);
          }
        std::copy_n(call.energies.begin(), 3, next + energies_at);
        std::copy_n(call.statev.begin(), numbers.n_states, next + first_of_user);
      }
    for (int k = 0; k < call.n; ++k)
      result.stress[rows_of_list[call.row[k]][0]][rows_of_list[call.row[k]][1]] =
        next[stress_at + call.row[k]];
    const auto lost = [](const double *const state) {
      const double given = state[energies_at + 1] + state[energies_at + 2];
      return given == 0. && state[energies_at] != 0. ? state[work_at] - state[energies_at] : given;
    };
    const bool gives_stored = next[energies_at] != 0. || before[energies_at] != 0.;
    result.stored           = gives_stored ? next[energies_at] : next[work_at] - lost(next);
    result.dissipated       = lost(next) - lost(before);
    if (tangent == nullptr)
      return result;
    *tangent = Tangent();
    for (int a = 0; a < call.n; ++a)
      for (int b = 0; b < call.n; ++b)
        {
          const auto &i = rows_of_list[call.row[a]], &j = rows_of_list[call.row[b]];
          (*tangent)[i[0]][i[1]][j[0]][j[1]] =
            0.5 * (call.tangent[a + call.n * b] + call.tangent[b + call.n * a]);
        }
    return result;
  }
} // namespace PeriDeal
