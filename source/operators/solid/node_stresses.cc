// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/place_text.h>
#include <perideal/base/user_error.h>
#include <perideal/base/worst_trip.h>
#include <perideal/laws/linear_stress.h>
#include <perideal/laws/nodal_stiffness.h>
#include <perideal/operators/solid/node_stresses.h>
#include <perideal/operators/solid/stress_laws.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "large_deformation.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  NodeStresses<dim>::NodeStresses(const Nodes<dim>          &nodes,
                                  const ThermalStrains      &thermal,
                                  const BodyParameters<dim> &body)
    : nodes(nodes)
    , thermal(thermal)
    , steps(StressSteps::of_scene(body))
  {
    PlacedStressLaw<dim> placed = stress_law_of(body);
    if (!placed.law)
      placed = linear_stress_law(body);
    law            = std::move(placed.law);
    kind.j2        = dynamic_cast<const J2Plasticity *>(law.get());
    kind.is_linear = dynamic_cast<const LinearStress *>(law.get()) != nullptr;
    kind.is_full   = body.elasticity.has_full_kinematics();
    std::string message;
    const auto  n = static_cast<std::ptrdiff_t>(law->n_parameters());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const Point<dim> &p = nodes.position(i);
        if (flows() && message.empty() && !(body.material.law.yield_stress->value(p) > 0.))
          message =
            body.material.where("Yield stress") + " is out of range at " + place_text(p) + ".";
        const std::vector<double> here = placed.parameters(p);
        if (i == 0 || !std::equal(here.begin(), here.end(), parameters.end() - n))
          parameters.insert(parameters.end(), here.begin(), here.end());
        number_of.push_back(
          n == 0 ? 0 : static_cast<std::uint32_t>(parameters.size() / law->n_parameters() - 1));
      }
    throw_on_all_if_any(nodes.communicator(), message);
    states.resize(nodes.n_owned() * law->n_state(), 0.);
    next = states;
    responses.resize(nodes.n_owned());
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
    SymmetricTensor<2, dim> of_gradient = strain(slopes);
    for (unsigned int d = 0; thermal.any() && d < dim; ++d)
      of_gradient[d][d] -= thermal[i];
    StressLaw::Tangent  full;
    StressLaw::Tangent *wanted = tangent == nullptr ? nullptr : &full;
    StressLaw::Trial    at{in_space<dim>(of_gradient),
                        parameters.data() + number_of[i] * law->n_parameters(),
                        states.data() + i * law->n_state()};
    double *const       to = next.data() + i * law->n_state();
    if (flows())
      responses[i] = kind.j2->update_with(flow, at, to, wanted);
    else
      {
        at.length  = std::pow(nodes.volume(i), 1. / dim);
        at.element = nodes.partitioner()->local_to_global(i);
        if (kind.is_full)
          at.displacement_gradient = in_space(slopes);
        responses[i] = steps.update(*law, at, to, wanted);
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
    steps.throw_faults(*law, nodes.communicator());
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
    steps.accept(t, changes);
  }


  template <int dim>
  std::vector<std::pair<std::string, std::vector<double>>> NodeStresses<dim>::shown() const
  {
    std::vector<std::pair<std::string, std::vector<double>>> list;
    for (const auto &[name, number] : law->shown())
      {
        list.emplace_back(name, std::vector<double>());
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          list.back().second.push_back(states[i * law->n_state() + number]);
      }
    return list;
  }


  template <int dim>
  void NodeStresses<dim>::exchange(Archive &archive, const NodeKeys &keys)
  {
    const unsigned int n = law->n_state();
    Vector             number(nodes.partitioner());
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
    return (parameters.capacity() + states.capacity() + next.capacity()) * sizeof(double) +
           number_of.capacity() * sizeof(std::uint32_t) +
           responses.capacity() * sizeof(StressLaw::Response);
  }


  PERIDEAL_INSTANTIATE_CLASS(class NodeStresses);
} // namespace PeriDeal
