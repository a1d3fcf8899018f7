// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/analysis/phase_statistics.h>
#include <perideal/laws/elasticity.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * Von Mises' stress and volume of all samples of a phase, on every process, in ascending order.
     * Collective.
     */
    std::vector<std::pair<double, double>> sorted_von_mises(
      const std::vector<StressSample> &samples,
      const int                        phase,
      const MPI_Comm                   communicator)
    {
      std::vector<std::pair<double, double>> own, all;
      for (const StressSample &sample : samples)
        if (sample.phase == phase)
          own.emplace_back(von_mises(sample.stress), sample.volume);
      for (const auto &list : Utilities::MPI::all_gather(communicator, own))
        all.insert(all.end(), list.begin(), list.end());
      std::sort(all.begin(), all.end());
      return all;
    }


    PhaseStatistics statistics_of(const std::vector<StressSample> &samples,
                                  const int                        phase,
                                  const double                     volume_of_body,
                                  const MPI_Comm                   communicator)
    {
      PhaseStatistics result{};
      double          volume = 0.;
      for (const StressSample &sample : samples)
        if (sample.phase == phase)
          {
            volume += sample.volume;
            result.mean_stress += sample.volume * sample.stress;
          }
      volume = Utilities::MPI::sum(volume, communicator);
      if (volume == 0.)
        return result;
      result.volume_fraction = volume / volume_of_body;
      result.mean_stress     = Utilities::MPI::sum(result.mean_stress, communicator) / volume;

      const auto sorted    = sorted_von_mises(samples, phase, communicator);
      double     remaining = 0.01 * volume * (1. - 1e-12);
      for (const auto &[value, share] : sorted)
        result.mean_von_mises += value * share / volume;
      for (auto sample = sorted.rbegin(); sample != sorted.rend(); ++sample)
        {
          result.highest_percentile = sample->first;
          remaining -= sample->second;
          if (remaining < 0.)
            break;
        }
      result.largest_von_mises = sorted.back().first;
      return result;
    }
  } // namespace


  std::vector<PhaseStatistics> phase_statistics(const std::vector<StressSample> &samples,
                                                const std::vector<std::string>  &names,
                                                const MPI_Comm                   communicator)
  {
    std::vector<PhaseStatistics> list;
    if (names.empty())
      return list;
    double volume = 0.;
    for (const StressSample &sample : samples)
      volume += sample.volume;
    volume = Utilities::MPI::sum(volume, communicator);
    for (std::size_t k = 0; k <= names.size(); ++k)
      {
        const bool named = k < names.size();
        list.push_back(
          statistics_of(samples, named ? static_cast<int>(k) : -1, volume, communicator));
        list.back().name = named ? names[k] : "elsewhere";
        if (list.back().volume_fraction == 0.)
          list.pop_back();
      }
    return list;
  }
} // namespace PeriDeal
