// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>

namespace PeriDeal
{
  /**
   * An archive in memory, of which each process has its own part: loads as often as it is asked to
   * what was saved, for the same nodes of the same processes.
   */
  class OwnArchive : public Archive
  {
  public:
    bool loads() const override
    {
      return is_loading;
    }

    /** From now on. */
    void load()
    {
      is_loading = true;
    }

  private:
    void take(const std::string &name, std::vector<double> &values) override;
    void take(const std::string &name, std::string &value) override;
    void take_share(const std::string &name, double &value) override;
    void take(const std::string &name,
              double            *values,
              const std::size_t  n_per_node,
              const NodeKeys    &keys) override;
    void take(const std::string &name, KeyedPairs &pairs, const NodeKeys &keys) override;

    bool                                       is_loading = false;
    std::map<std::string, std::vector<double>> numbers; // also shares and vectors
    std::map<std::string, std::string>         texts;
    std::map<std::string, KeyedPairs>          all_pairs;
  };
} // namespace PeriDeal
