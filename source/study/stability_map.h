// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <nlohmann/json.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  class StabilityScene;

  /** One point of a map. */
  struct StabilityPoint
  {
    using Value = nlohmann::ordered_json; // a number or a text

    std::vector<std::pair<std::string, Value>> parameters;
    double                                     predicted = 0., observed = 0.; // infinite: no limit
    /**
     * `safe`, `fails`; `warned` or `refused` where the program says so itself before it computes.
     */
    std::string verdict;

    bool healthy() const
    {
      return verdict == "safe";
    }
  };


  /** One question, asked at many points. All functions are collective unless they say otherwise. */
  class StabilityMap
  {
  public:
    virtual ~StabilityMap() = default;

    /** What the two numbers of a point are, for readers. Not collective. */
    virtual std::string meaning_of_predicted() const = 0;
    virtual std::string meaning_of_observed() const  = 0;

    /** Where points are safe, in a sentence. Not collective. */
    virtual std::string bound() const = 0;

    /** Why the scene has no such map; empty if it has. Not collective. */
    virtual std::string obstacle() const = 0;

    /** @param quick few of them */
    virtual std::vector<StabilityPoint> points(const bool quick) = 0;

    /**
     * A point anywhere inside or outside of the safe region, with what it is there; none if there
     * is no such place.
     */
    virtual std::optional<StabilityPoint> random_point(const bool inside, std::mt19937 &random) = 0;

    /** What points() could not compute, and why. Not collective. */
    std::vector<std::string> left_out;
  };


  /** A name of --maps, and how that map is made. */
  struct StabilityMapKind
  {
    std::string                                                          name;
    std::function<std::unique_ptr<StabilityMap>(const StabilityScene &)> make;
  };

  /** All maps, in the order in which they are computed. Not collective. */
  const std::vector<StabilityMapKind> &stability_maps();

  // One maker per map; the scene has to live on.
  std::unique_ptr<StabilityMap> make_step_limit_map(const StabilityScene &scene);
  std::unique_ptr<StabilityMap> make_growth_map(const StabilityScene &scene);
  std::unique_ptr<StabilityMap> make_conduction_map(const StabilityScene &scene);
  std::unique_ptr<StabilityMap> make_surface_map(const StabilityScene &scene);
  std::unique_ptr<StabilityMap> make_eigenvalue_map(const StabilityScene &scene);
  std::unique_ptr<StabilityMap> make_iterations_map(const StabilityScene &scene);
  std::unique_ptr<StabilityMap> make_heat_map(const StabilityScene &scene);

  /** The same on all processes, and with any standard library. Not collective. */
  inline double uniform(std::mt19937 &random, const double from, const double to)
  {
    return from + (to - from) * (random() / 4294967296.);
  }

  template <typename T>
  const T &any_of_list(std::mt19937 &random, const std::vector<T> &list)
  {
    return list[random() % list.size()];
  }
} // namespace PeriDeal
