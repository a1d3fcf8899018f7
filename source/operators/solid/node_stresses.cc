// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/place_text.h>
#include <perideal/base/user_error.h>
#include <perideal/base/worst_trip.h>
#include <perideal/laws/linear_stress.h>
#include <perideal/laws/nodal_stiffness.h>
#include <perideal/operators/coupling/nodal_family.h>
#include <perideal/operators/solid/node_stresses.h>
#include <perideal/operators/solid/thermal_strains.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "large_deformation.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  NodeStresses<dim>::NodeStresses(const Nodes<dim> &nodes, const BodyParameters<dim> &body)
    : nodes(nodes)
    , body(body)
    , law(stress_law_of(body))
    , steps(StressSteps::of_scene(body))
  {
    if (!law.law)
      law = linear_stress_law(body);
    kind.j2        = dynamic_cast<const J2Plasticity *>(law.law.get());
    kind.is_linear = dynamic_cast<const LinearStress *>(law.law.get()) != nullptr;
    kind.is_full   = body.elasticity.has_full_kinematics();
    find_parameters();
    for (unsigned int i = 0; i < nodes.n_owned() && is_warm(body); ++i)
      warm.temperatures.push_back(temperature_at_start(body, nodes.position(i)));
    warm.accepted.assign(warm.temperatures.size(), temperature_of(body, 0.));
    states.resize(nodes.n_owned() * law.law->n_state(), 0.);
    next = states;
    responses.resize(nodes.n_owned());
  }


  template <int dim>
  void NodeStresses<dim>::find_parameters()
  {
    std::string message;
    const auto  n = static_cast<std::ptrdiff_t>(law.law->n_parameters());
    parameters.clear();
    number_of.clear();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const Point<dim> &p        = nodes.position(i);
        const double      T        = warm.temperatures.empty() ? temperature_at_start(body, p) :
                                                                 warm.temperatures[i];
        const bool        is_known = !body.elasticity.computes_temperature || !warm.strains.empty();
        if (message.empty() && is_known)
          message = yield_stress_fault(body.material, p, T);
        const std::vector<double> here = law.parameters(p, T);
        if (i == 0 || !std::equal(here.begin(), here.end(), parameters.end() - n))
          parameters.insert(parameters.end(), here.begin(), here.end());
        number_of.push_back(
          n == 0 ? 0 : static_cast<std::uint32_t>(parameters.size() / law.law->n_parameters() - 1));
      }
    throw_on_all_if_any(nodes.communicator(), message);
  }


  template <int dim>
  void NodeStresses<dim>::take_temperatures(const Vector &changes)
  {
    if (changes.size() == 0 && is_zero(body.elasticity.temperature_change))
      return; // it is computed, and not known yet, or there is none
    warm.strains.clear();
    warm.temperatures.clear();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const Point<dim> &p      = nodes.position(i);
        const double      change = temperature_change_of(body, p, changes, i);
        // The linear law has what is strained out of the plane within it, as all its sums do.
        warm.strains.push_back(kind.is_linear ? thermal_strain(body, p, change) :
                                                body.free_expansion(p, change));
        warm.temperatures.push_back(temperature_of(body, change));
      }
    if (law.depends_on_temperature)
      find_parameters();
  }


  template <int dim>
  SymmetricTensor<4, dim> NodeStresses<dim>::elastic(const unsigned int i) const
  {
    const Point<dim> &p = nodes.position(i);
    const double      T = warm.temperatures.empty() ? temperature_at_start(body, p) :
                                                      warm.temperatures[i];
    return in_body<dim>(linear_stiffness(body, p, T));
  }


  template <int dim>
  void NodeStresses<dim>::ask(const unsigned int       i,
                              const Tensor<2, dim>    &slopes,
                              J2Plasticity::Beside    &flow,
                              SymmetricTensor<4, dim> *tangent) const
  {
    if (tangent != nullptr)
      *tangent = 0.;
    const double ratio = kind.is_full ? determinant(deformation_of(slopes)) : 1.;
    if (!(ratio > 0.))
      {
        responses[i] = StressLaw::Response();
        return keep_lower(inverted, turned_inside_out(nodes.position(i), ratio, steps.now));
      }
    StressLaw::Tangent  full;
    StressLaw::Tangent *wanted = tangent == nullptr ? nullptr : &full;
    StressLaw::Trial    at{in_space<dim>(strain(slopes)),
                        parameters.data() + number_of[i] * law.law->n_parameters(),
                        states.data() + i * law.law->n_state()};
    double *const       to = next.data() + i * law.law->n_state();
    if (!warm.temperatures.empty())
      {
        if (!warm.strains.empty()) // at the start the body is at rest
          for (unsigned int d = 0; d < (kind.is_linear ? dim : 3U); ++d)
            at.strain[d][d] -= warm.strains[i];
        at.temperature = warm.temperatures[i];
        at.warming     = warm.temperatures[i] - warm.accepted[i];
      }
    if (flows())
      responses[i] = kind.j2->update_with(flow, at, to, wanted);
    else
      {
        at.length  = std::pow(nodes.volume(i), 1. / dim);
        at.element = nodes.partitioner()->local_to_global(i);
        if (kind.is_full)
          at.displacement_gradient = in_space(slopes);
        responses[i] = steps.update(*law.law, at, to, wanted);
      }
    if (tangent != nullptr)
      *tangent = in_body<dim>(full);
  }


  template <int dim>
  SymmetricTensor<2, dim> NodeStresses<dim>::stress(const unsigned int i) const
  {
    return in_body<dim>(responses[i].stress);
  }


  template <int dim>
  SymmetricTensor<2, dim> NodeStresses<dim>::strain(const Tensor<2, dim> &slopes) const
  {
    return kind.is_full ? strain_of(slopes) : symmetrize(slopes);
  }


  template <int dim>
  Tensor<2, dim> NodeStresses<dim>::pull(const unsigned int i, const Tensor<2, dim> &slopes) const
  {
    const Tensor<2, dim> of_law(stress(i));
    return kind.is_full ? deformation_of(slopes) * of_law : of_law;
  }


  template <int dim>
  StressLaw::Tensor NodeStresses<dim>::cauchy(const unsigned int    i,
                                              const Tensor<2, dim> &slopes) const
  {
    return kind.is_full ? cauchy_stress(slopes, responses[i]) : responses[i].stress;
  }


  template <int dim>
  void NodeStresses<dim>::throw_faults() const
  {
    const Trip worst = kind.is_full ? std::exchange(inverted, Trip()) : Trip();
    steps.throw_faults(*law.law, nodes.communicator());
    if (kind.is_full)
      throw_lowest_if_any(nodes.communicator(), worst);
  }


  template <int dim>
  bool NodeStresses<dim>::have_symmetric_tangents() const
  {
    const bool all = std::all_of(responses.begin(), responses.end(), [](const auto &response) {
      return response.has_symmetric_tangent;
    });
    return Utilities::MPI::min(all ? 1 : 0, nodes.communicator()) > 0;
  }


  template <int dim>
  bool NodeStresses<dim>::same_states() const
  {
    return Utilities::MPI::max(states != next ? 1 : 0, nodes.communicator()) == 0;
  }


  template <int dim>
  void NodeStresses<dim>::accept(const double t, const bool flows, const bool changes)
  {
    if (flows)
      states = next;
    warm.accepted = warm.temperatures;
    steps.accept(t, changes);
  }


  template <int dim>
  std::vector<std::pair<std::string, std::vector<double>>> NodeStresses<dim>::shown() const
  {
    std::vector<std::pair<std::string, std::vector<double>>> list;
    for (const auto &[name, number] : law.law->shown())
      {
        list.emplace_back(name, std::vector<double>());
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          list.back().second.push_back(states[i * law.law->n_state() + number]);
      }
    return list;
  }


  template <int dim>
  void NodeStresses<dim>::exchange(Archive &archive, const NodeKeys &keys)
  {
    const unsigned int n = law.law->n_state();
    Vector             number(nodes.partitioner());
    if (is_warm(body))
      {
        std::copy(warm.accepted.begin(), warm.accepted.end(), number.begin());
        archive.exchange("accepted temperature", number, keys);
        std::copy_n(number.begin(), warm.accepted.size(), warm.accepted.begin());
      }
    for (unsigned int s = 0; s < n; ++s)
      {
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          number.local_element(i) = states[n * i + s];
        archive.exchange("state " + std::to_string(s), number, keys);
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          states[n * i + s] = number.local_element(i);
      }
    steps.exchange(archive);
  }


  template <int dim>
  std::size_t NodeStresses<dim>::memory_consumption() const
  {
    return (parameters.capacity() + warm.strains.capacity() + warm.temperatures.capacity() +
            warm.accepted.capacity() + states.capacity() + next.capacity()) *
             sizeof(double) +
           number_of.capacity() * sizeof(std::uint32_t) +
           responses.capacity() * sizeof(StressLaw::Response);
  }


  PERIDEAL_INSTANTIATE_CLASS(class NodeStresses);
} // namespace PeriDeal
