// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/diverged.h>
#include <perideal/laws/finite_strain.h>
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

    // Of a state, the last two where deformations are large.
    constexpr unsigned int stress_at = 6, energies_at = 12, work_at = 15, gradient_at = 16,
                           lost_at = 25;


    dealii::Tensor<2, 3> kept_gradient(const double *const state)
    {
      dealii::Tensor<2, 3> gradient;
      for (unsigned int k = 0; k < 9; ++k)
        gradient[k / 3][k % 3] = state[gradient_at + k];
      return gradient;
    }


    /** @param of_shear 2: of strains */
    StressLaw::Tensor kept_tensor(const double *const list, const double of_shear)
    {
      StressLaw::Tensor tensor;
      for (unsigned int k = 0; k < 6; ++k)
        tensor[rows_of_list[k][0]][rows_of_list[k][1]] = list[k] / (k < 3 ? 1. : of_shear);
      return tensor;
    }


    /** As Fortran has it. @param one added on the diagonal */
    void write_columns(std::array<double, 9> &list, const dealii::Tensor<2, 3> &a, const double one)
    {
      for (unsigned int k = 0; k < 9; ++k)
        list[k] = a[k % 3][k / 3] + (k % 4 == 0 ? one : 0.);
    }
  } // namespace


  /** The arguments of one call, with numbers behind lists that have to stay what they are. */
  struct UserStress::Call
  {
    // Of lists that a wrong number of rows or of states makes too short.
    static constexpr unsigned int n_guards = 8, n_guards_of_states = 64;

    Call(const UserStress &law, const Trial &trial);

    /** From the accepted strain to the new one, by which displacement gradients. */
    void take_small(const Trial &trial);

    /** The same of large deformations: what is kept is turned. */
    void take_full(const Trial &trial);

    /** By how much entries of DDSDDE differ from those across the diagonal, over the largest. */
    double asymmetry() const;

    static void make(void *const call);
    /** Returns how it has ended, other than by coming back; empty: it has. */
    std::string ask();

    const Umat                        umat;
    std::array<unsigned int, 6>       row{};
    std::array<double, 6 + n_guards>  stress{};
    std::array<double, 36 + n_guards> tangent{};
    std::vector<double>               statev, properties;
    std::array<double, 3>             energies{};

    struct Strains
    {
      std::array<double, 6> before{}, change{};
      std::array<double, 9> rotation{{1., 0., 0., 0., 1., 0., 0., 0., 1.}},
        gradient_before{rotation}, gradient{rotation};
      bool stays = true; // it is the accepted one; of large deformations F
    } strains;

    struct Place
    {
      std::array<double, 3> x{};
      double                length;
      char                  material[80];
      int                   element, point, layer = 1, section = 1;
    } place;

    struct Moment
    {
      double begin[2], step, ratio = 1.;
      int    step_number[4]{1, 0, 0, 0}, increment;
    } moment;

    struct Counts
    {
      int normal, shear, all, states, properties;
    } counts;

    struct Heat
    {
      std::array<double, 6> by_strain{}, by_temperature{};
      double                made = 0., slope = 0., temperature = 0., change = 0., fields = 0.;
    } heat;

    /** Neither strain nor time nor temperature goes on. */
    bool rests(const Trial &trial) const
    {
      return !(trial.step > 0.) && strains.stays && trial.warming == 0.;
    }
  };


  UserStress::Call::Call(const UserStress &law, const Trial &trial)
    : umat(law.library->umat)
    , statev(law.numbers.n_states + n_guards_of_states, guard)
    , properties(law.material_of(trial).properties)
  {
    if (properties.empty())
      properties.push_back(0.); // an address, at least
    counts = {static_cast<int>(law.n_normal),
              static_cast<int>(law.n_shear),
              static_cast<int>(law.n_normal + law.n_shear),
              static_cast<int>(law.numbers.n_states),
              static_cast<int>(law.material_of(trial).properties.size())};
    for (int k = 0; k < counts.all; ++k)
      row[k] = k < counts.normal ? k : 3 + k - counts.normal;
    const int n = counts.all;
    std::fill(stress.begin() + n, stress.end(), guard);
    std::fill(tangent.begin() + n * n, tangent.end(), guard);
    if (law.is_full)
      take_full(trial);
    else
      take_small(trial);
    std::copy_n(trial.state + energies_at, 3, energies.begin());
    std::copy_n(trial.state + law.first_of_user(), counts.states, statev.begin());
    // A first load that is put on at once has taken its instant.
    const double begun = trial.increment > 1 ? trial.instant : 0.;
    moment.begin[0] = moment.begin[1] = std::max(trial.time - trial.step, begun);
    moment.step                       = trial.step > 0. ? trial.step : trial.instant;
    moment.increment                  = trial.increment;
    std::copy_n(trial.parameters, 3, place.x.begin());
    heat.temperature            = trial.temperature - trial.warming;
    heat.change                 = trial.warming;
    place.length                = trial.length;
    place.element               = trial.element + 1;
    place.point                 = trial.point + 1;
    const std::string &material = law.material_of(trial).name;
    std::memset(place.material, ' ', sizeof(place.material));
    std::transform(material.begin(),
                   material.begin() + std::min(material.size(), sizeof(place.material)),
                   place.material,
                   [](const unsigned char c) { return std::toupper(c); });
  }


  void UserStress::Call::take_small(const Trial &trial)
  {
    for (int k = 0; k < counts.all; ++k)
      {
        const auto  &at   = rows_of_list[row[k]];
        const double size = row[k] < 3 ? 1. : 2.;
        strains.before[k] = trial.state[row[k]];
        strains.change[k] = size * trial.strain[at[0]][at[1]] - strains.before[k];
        stress[k]         = trial.state[stress_at + row[k]];
        strains.stays     = strains.stays && strains.change[k] == 0.;
        const auto add    = [&](const unsigned int entry) {
          strains.gradient_before[entry] += strains.before[k] / size;
          strains.gradient[entry] += (strains.before[k] + strains.change[k]) / size;
        };
        add(at[0] + 3 * at[1]);
        if (at[0] != at[1])
          add(at[1] + 3 * at[0]);
      }
  }


  void UserStress::Call::take_full(const Trial &trial)
  {
    const dealii::Tensor<2, 3> before = kept_gradient(trial.state),
                               &now   = trial.displacement_gradient;
    const FiniteStep step(before, now);
    const Tensor     strain = step.rotated(kept_tensor(trial.state, 2.)),
                 cauchy     = step.rotated(kept_tensor(trial.state + stress_at, 1.));
    for (int k = 0; k < counts.all; ++k)
      {
        const auto  &at   = rows_of_list[row[k]];
        const double size = row[k] < 3 ? 1. : 2.;
        strains.before[k] = size * strain[at[0]][at[1]];
        strains.change[k] = size * step.stretch[at[0]][at[1]];
        stress[k]         = cauchy[at[0]][at[1]];
      }
    write_columns(strains.rotation, step.rotation, 0.);
    write_columns(strains.gradient_before, before, 1.);
    write_columns(strains.gradient, now, 1.);
    strains.stays = before == now;
  }


  double UserStress::Call::asymmetry() const
  {
    const int n       = counts.all;
    double    largest = 0., gap = 0.;
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        {
          largest = std::max(largest, std::abs(tangent[a + n * b]));
          gap     = std::max(gap, std::abs(tangent[a + n * b] - tangent[b + n * a]));
        }
    return largest > 0. ? gap / largest : 0.;
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
            &of.heat.made,
            of.heat.by_strain.data(),
            of.heat.by_temperature.data(),
            &of.heat.slope,
            of.strains.before.data(),
            of.strains.change.data(),
            of.moment.begin,
            &of.moment.step,
            &of.heat.temperature,
            &of.heat.change,
            &of.heat.fields,
            &of.heat.fields,
            of.place.material,
            &of.counts.normal,
            &of.counts.shear,
            &of.counts.all,
            &of.counts.states,
            of.properties.data(),
            &of.counts.properties,
            of.place.x.data(),
            of.strains.rotation.data(),
            &of.moment.ratio,
            &of.place.length,
            of.strains.gradient_before.data(),
            of.strains.gradient.data(),
            &of.place.element,
            &of.place.point,
            &of.place.layer,
            &of.place.section,
            of.moment.step_number,
            &of.moment.increment,
            sizeof(of.place.material));
  }


  std::string UserStress::Call::ask()
  {
    try
      {
        return comes_back(make, this) ? "" : "has ended the run (XIT)";
      }
    catch (const std::exception &thrown) // of laws in C++
      {
        return std::string("has thrown an exception: ") + thrown.what();
      }
    catch (...)
      {
        return "has thrown an exception";
      }
  }


  UserStress::UserStress(const std::shared_ptr<const UserLibrary> &library,
                         const unsigned int                        dim,
                         const StressState                         kind,
                         const Numbers                            &numbers,
                         const bool                                is_full)
    : library(library)
    , n_normal(kind == StressState::plane_stress ? 2 : 3)
    , n_shear(dim == 3 ? 3 : 1)
    , numbers(numbers)
    , is_full(is_full)
  {
    Assert(!is_full || kind != StressState::plane_stress, ExcNotImplemented());
  }


  std::vector<std::pair<std::string, unsigned int>> UserStress::shown() const
  {
    std::vector<std::pair<std::string, unsigned int>> list;
    for (unsigned int k = 0; k < numbers.n_states; ++k)
      list.emplace_back("state_" + std::to_string(k + 1), first_of_user() + k);
    return list;
  }


  std::string UserStress::fault_of(const Call &call, const bool with_tangent) const
  {
    const int  n       = call.counts.all;
    const auto spoiled = [](const auto begin, const auto end) {
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
    if (call.moment.ratio < 1.)
      {
        std::ostringstream text;
        text << "asks for a step of " << call.moment.ratio
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
    if (std::all_of(call.tangent.begin(), call.tangent.begin() + n * n, [](const double entry) {
          return entry == 0.;
        }))
      return "leaves the tangent (DDSDDE) zero. Let it be the change of STRESS by DSTRAN";
    return "";
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
    list(call.place.x, n_shear == 3 ? 3 : 2);
    text << "), element " << call.place.element << ", point " << call.place.point
         << ", at t = " << trial.time << ", increment " << call.moment.increment
         << ", from the strain ";
    list(call.strains.before, call.counts.all);
    text << " on by ";
    list(call.strains.change, call.counts.all);
    text << '.';
    if (call.moment.ratio < 1.)
      throw Diverged(text.str(), "law", call.moment.ratio, 1., trial.time);
    throw UserError(text.str());
  }


  void UserStress::keep(const Call &call, const Trial &trial, double *const next) const
  {
    const double *const before = trial.state;
    if (is_full)
      std::fill_n(next, energies_at, 0.);
    for (int k = 0; k < call.counts.all; ++k)
      {
        const unsigned int r  = call.row[k];
        const auto        &at = rows_of_list[r];
        // Not the sum of both, which need not be this to the last digit.
        next[r]             = is_full ? call.strains.before[k] + call.strains.change[k] :
                                        (r < 3 ? 1. : 2.) * trial.strain[at[0]][at[1]];
        next[stress_at + r] = call.stress[k];
        if (!is_full)
          next[work_at] += 0.5 * (before[stress_at + r] + call.stress[k]) * (next[r] - before[r]);
      }
    std::copy_n(call.energies.begin(), 3, next + energies_at);
    std::copy_n(call.statev.begin(), numbers.n_states, next + first_of_user());
    if (!is_full)
      return;
    const dealii::Tensor<2, 3> G_0 = kept_gradient(before), &G = trial.displacement_gradient;
    for (unsigned int k = 0; k < 9; ++k)
      next[gradient_at + k] = G[k / 3][k % 3];
    next[work_at] += 0.5 *
                     (second_stress(G_0, kept_tensor(before + stress_at, 1.)) +
                      second_stress(G, kept_tensor(next + stress_at, 1.))) *
                     (green_strain(G) - green_strain(G_0));
    for (unsigned int k = energies_at + 1; k < energies_at + 3; ++k)
      next[lost_at] += volume_ratio(G) * (next[k] - before[k]);
  }


  void UserStress::find_energies(Response           &response,
                                 const Trial        &trial,
                                 const double *const next) const
  {
    const double *const before = trial.state;
    const auto          given  = [this](const double *const state) {
      return state[energies_at] * (is_full ? volume_ratio(kept_gradient(state)) : 1.);
    };
    const auto lost = [&](const double *const state) {
      const double of_law = is_full ? state[lost_at] :
                                      state[energies_at + 1] + state[energies_at + 2];
      const bool is_rest = of_law == 0. && state[energies_at] != 0. && !is_full;
      return is_rest ? state[work_at] - given(state) : of_law;
    };
    const bool gives_stored = next[energies_at] != 0. || before[energies_at] != 0.;
    response.stored         = gives_stored ? given(next) : next[work_at] - lost(next);
    response.dissipated     = lost(next) - lost(before);
  }


  StressLaw::Tangent UserStress::tangent_of(const Call &call, const bool symmetric) const
  {
    Tangent   tangent;
    const int n = call.counts.all;
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        {
          const auto  &i = rows_of_list[call.row[a]], &j = rows_of_list[call.row[b]];
          const double own                = call.tangent[a + n * b]; // as Fortran has it
          tangent[i[0]][i[1]][j[0]][j[1]] = symmetric ? 0.5 * (own + call.tangent[b + n * a]) : own;
        }
    return tangent;
  }


  StressLaw::Response UserStress::update(const Trial &trial, double *next, Tangent *tangent) const
  {
    constexpr double alike = 1e-6;
    Call             call(*this, trial);
    const bool       rests = call.rests(trial);
    std::copy_n(trial.state, n_state(), next);
    if (!rests || tangent != nullptr)
      {
#ifdef DEBUG
        std::fenv_t exceptions; // deal.II stops at operations that the law may do
        feholdexcept(&exceptions);
#endif
        const std::string ended = call.ask();
#ifdef DEBUG
        fesetenv(&exceptions);
#endif
        const std::string fault = ended.empty() ? fault_of(call, tangent != nullptr) : ended;
        if (!fault.empty())
          throw_fault(fault, call, trial);
      }
    if (!rests)
      keep(call, trial, next);
    const Tensor stress = kept_tensor(next + stress_at, 1.);
    Response     result;
    result.stress = is_full ? second_stress(trial.displacement_gradient, stress) : stress;
    find_energies(result, trial, next);
    if (tangent == nullptr)
      return result;
    result.has_symmetric_tangent = call.asymmetry() <= alike;
    *tangent                     = tangent_of(call, result.has_symmetric_tangent);
    if (is_full)
      *tangent = second_tangent(trial.displacement_gradient, stress, *tangent);
    return result;
  }
} // namespace PeriDeal
