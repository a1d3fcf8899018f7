// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>

#include <chrono>
#include <map>
#include <string>

namespace PeriDeal
{
  /** Wall times of named phases, in seconds. */
  class Timings
  {
  public:
    /** Adds the time of its own life to a phase. */
    class Scope
    {
    public:
      Scope(Timings &timings, const std::string &phase)
        : seconds(timings.phases[phase])
        , start(std::chrono::steady_clock::now())
      {}

      ~Scope()
      {
        seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      }

      Scope(const Scope &) = delete;

    private:
      double                                     &seconds;
      const std::chrono::steady_clock::time_point start;
    };

    const std::map<std::string, double> &all() const
    {
      return phases;
    }

    double total() const
    {
      double sum = 0.;
      for (const auto &[name, seconds] : phases)
        sum += seconds;
      return sum;
    }

    /** Those of the first process. Collective. */
    void exchange(Archive &archive)
    {
      unsigned int n = phases.size();
      archive.exchange("phases", n);
      auto phase = phases.begin();
      for (unsigned int k = 0; k < n; ++k)
        {
          const Archive::Part part(archive, "phase " + std::to_string(k));
          std::string         name    = archive.loads() ? "" : phase->first;
          double              seconds = archive.loads() ? 0. : (phase++)->second;
          archive.exchange("name", name);
          archive.exchange("seconds", seconds);
          phases[name] = seconds;
        }
    }

  private:
    std::map<std::string, double> phases;
  };
} // namespace PeriDeal
