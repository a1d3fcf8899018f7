// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/bounds/spectrum.h>
#include <perideal/operators/solid/elastic_operator.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  namespace
  {
    double length(const std::vector<double> &vector)
    {
      double square = 0.;
      for (const double x : vector)
        square += x * x;
      return std::sqrt(square);
    }
  } // namespace


  double ForceBalance::imbalance() const
  {
    std::vector<double> sum = body;
    for (const auto &[name, force] : sides)
      for (unsigned int d = 0; d < sum.size(); ++d)
        sum[d] += force[d];
    return length(sum);
  }


  double ForceBalance::throughput() const
  {
    double sum = length(body);
    for (const auto &[name, force] : sides)
      sum += length(force);
    return 0.5 * sum;
  }


  void ElasticOperator::keep_temperature_change(const Vector &change)
  {
    initialize_nodal_vector(nodal.temperature_change);
    nodal.temperature_change.copy_locally_owned_data_from(change);
    nodal.temperature_change.update_ghost_values();
  }


  void BreakPlaces::exchange(Archive &archive)
  {
    archive.exchange("first break", first);
    archive.exchange("breaks elsewhere", elsewhere);
    unsigned int n_sides = beside_loads.size();
    archive.exchange("loaded sides with breaks", n_sides);
    auto side = beside_loads.begin();
    for (unsigned int k = 0; k < n_sides; ++k)
      {
        const Archive::Part part(archive, "loaded side " + std::to_string(k));
        std::string         name  = archive.loads() ? "" : side->first;
        unsigned long long  count = archive.loads() ? 0 : (side++)->second;
        archive.exchange("name", name);
        archive.exchange("breaks", count);
        beside_loads[name] = count;
      }
  }


  void BreakHistory::exchange(Archive &archive)
  {
    archive.exchange("released energy", released);
    archive.exchange("broken bonds", n_broken);
    places.exchange(archive);
  }


  void ElasticOperator::exchange(Archive &archive, const NodeKeys &keys)
  {
    Operator::exchange(archive, keys);
    bool is_warmed = nodal.temperature_change.size() > 0;
    archive.exchange("is warmed", is_warmed);
    if (!is_warmed)
      return;
    Vector change;
    initialize_nodal_vector(change);
    change.copy_locally_owned_data_from(nodal.temperature_change);
    archive.exchange("temperature change", change, keys);
    if (archive.loads())
      set_temperature_change(change);
  }


  double ElasticOperator::released_energy() const
  {
    return released_beside.by_growth + released_beside.by_joining + released_beside.by_law +
           (brittle() ? break_history()->released : 0.);
  }


  unsigned long long ElasticOperator::n_broken_bonds() const
  {
    return brittle() ? break_history()->n_broken : 0;
  }


  const BreakPlaces &ElasticOperator::break_places() const
  {
    static const BreakPlaces none;
    return brittle() ? break_history()->places : none;
  }


  double ElasticOperator::scaled_bound() const
  {
    return sharp_bound(
      *this,
      std::numeric_limits<double>::max(),
      [&](Vector &vector) { fill_noise(vector); },
      0.,
      &diagonal());
  }
} // namespace PeriDeal
