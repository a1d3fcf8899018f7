// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>

#include <perideal/base/own_archive.h>

#include <algorithm>

namespace PeriDeal
{
  void OwnArchive::take(const std::string &name, std::vector<double> &values)
  {
    if (is_loading)
      values = numbers.at(name);
    else
      numbers[name] = values;
  }


  void OwnArchive::take(const std::string &name, std::string &value)
  {
    if (is_loading)
      value = texts.at(name);
    else
      texts[name] = value;
  }


  void OwnArchive::take_share(const std::string &name, double &value)
  {
    std::vector<double> one{value};
    take(name, one);
    value = one.at(0);
  }


  void OwnArchive::take(const std::string &name,
                        double            *values,
                        const std::size_t  n_per_node,
                        const NodeKeys    &keys)
  {
    const std::size_t    n    = n_per_node * keys.size();
    std::vector<double> &kept = numbers[name];
    if (!is_loading)
      kept.assign(values, values + n);
    AssertDimension(kept.size(), n);
    std::copy(kept.begin(), kept.end(), values);
  }


  void OwnArchive::take(const std::string &name, KeyedPairs &pairs, const NodeKeys &)
  {
    if (is_loading)
      pairs = all_pairs.at(name);
    else
      all_pairs[name] = pairs;
  }
} // namespace PeriDeal
