// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/interleaved.h>
#include <perideal/base/place_text.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/solid/stress_laws.h>
#include <perideal/operators/solid/thermal_strains.h>
#include <perideal/operators/solid/yielding_families.h>

#include <algorithm>
#include <limits>

#include "change_along.h"
#include "family_sums.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  YieldingFamilies<dim>::YieldingFamilies(const Families<dim>       &families,
                                          const BondEnds<dim>       &ends,
                                          BondTable<dim>            &bonds,
                                          const NodeLaws<dim>       &laws,
                                          const BodyParameters<dim> &body)
    : families(families)
    , ends(ends)
    , bonds(bonds)
    , laws(laws)
    , of_scene(body)
  {
    const Nodes<dim> &nodes = families.nodes();
    find_materials({});
    states.resize(nodes.n_owned());
    trial.answers.resize(nodes.n_owned());
    for (BondRows<dim> *rows : {&bonds.body, &bonds.beyond})
      {
        Assert(!rows->is_packed(), ExcInternalError());
        rows->squares.resize(rows->size());
        for (std::size_t row = 0; row < rows->nodes.size(); ++row)
          for (std::size_t k = rows->starts[row]; k < rows->starts[row + 1]; ++k)
            {
              const double square =
                rows->moments[k] * ends.vector(rows->nodes[row], rows->neighbors[k]);
              // One that is gone moves nobody: its stretch is 0, of no weight.
              rows->squares[k] = square > 0. ? square : std::numeric_limits<double>::min();
            }
      }
    trial.stretches.body.resize(bonds.body.size());
    trial.stretches.beyond.resize(bonds.beyond.size());
    trial.numbers.reinit(interleaved(*nodes.partitioner(), n_numbers));
    const auto unknowns = interleaved(*nodes.partitioner(), dim);
    for (Vector *v : {&trial.displacement, &trial.forces, &accepted.displacement, &accepted.forces})
      v->reinit(unknowns);
  }


  template <int dim>
  void YieldingFamilies<dim>::find_materials(const std::vector<double> &temperatures)
  {
    const Nodes<dim> &nodes    = families.nodes();
    const Material   &material = of_scene.material;
    std::string       message;
    materials.clear();
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const Point<dim> &p = nodes.position(i);
        const double T = temperatures.empty() ? temperature_at_start(of_scene, p) : temperatures[i];
        const bool   is_known = !of_scene.elasticity.computes_temperature || !temperatures.empty();
        if (message.empty() && is_known)
          message = yield_stress_fault(material, p, T);
        materials.emplace_back(laws.moduli(i),
                               dim,
                               of_scene.elasticity.plane,
                               yield_stress_of(material, p, T),
                               material.law.hardening.value(p, T));
      }
    throw_on_all_if_any(nodes.communicator(), message);
  }


  template <int dim>
  void YieldingFamilies<dim>::take_temperatures(const Vector &changes)
  {
    const Nodes<dim> &nodes = families.nodes();
    trial.known             = false;
    accepted.take_warming(changes.size() > 0);
    expansions.clear();
    if (changes.size() == 0 && is_zero(of_scene.elasticity.temperature_change))
      return;
    std::vector<double> temperatures;
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        const Point<dim> &p      = nodes.position(i);
        const double      change = temperature_change_of(of_scene, p, changes, i);
        expansions.push_back(of_scene.free_expansion(p, change));
        temperatures.push_back(temperature_of(of_scene, change));
      }
    if (of_scene.material.law.yield_depends_on_temperature() ||
        of_scene.material.given.depend_on_temperature())
      find_materials(temperatures);
  }


  namespace
  {
    /**
     * Take off stretches of a node's bonds what the temperature makes of them. Returns the sum of S
     * times that. @param origin of a node on the other side
     */
    template <int dim, typename Origin>
    double take_off(const BondRows<dim>       &rows,
                    const Span                &span,
                    const std::vector<double> &expansions,
                    const unsigned int         i,
                    const Origin              &origin,
                    double                    *stretches)
    {
      double sum = 0.;
      for (std::size_t k = span.begin; k < span.end; ++k)
        {
          const double thermal = 0.5 * (expansions[i] + expansions[origin(rows.neighbors[k])]);
          stretches[k] -= thermal;
          sum += rows.squares[k] * thermal;
        }
      return sum;
    }


    /** Stretches of bonds of a node; returns the sum of S s. */
    template <int dim, typename Value>
    double find_stretches(const BondRows<dim> &rows,
                          const std::size_t    begin,
                          const std::size_t    end,
                          const double        *own,
                          const Value         &value,
                          double              *stretches)
    {
      double sum = 0.;
      for (std::size_t k = begin; k < end; ++k)
        {
          const double product = change_along(rows.moments[k], own, value(rows.neighbors[k]));
          stretches[k]         = product / rows.squares[k];
          sum += product;
        }
      return sum;
    }


    /** The sum of S s_e^2 of the row's node. */
    template <int dim>
    double sum_squares(const BondRows<dim> &rows,
                       const std::size_t    begin,
                       const std::size_t    end,
                       const double         dilatation,
                       const double        *stretches)
    {
      const double *const plastic = rows.nonlinear.history.data();
      double              sum     = 0.;
      for (std::size_t k = begin; k < end; ++k)
        {
          const double elastic = stretches[k] - dilatation - plastic[2 * k];
          sum += rows.squares[k] * elastic * elastic;
        }
      return sum;
    }
  } // namespace


  template <int dim>
  void YieldingFamilies<dim>::find(const Vector &u) const
  {
    const Nodes<dim>            &nodes  = families.nodes();
    const FictitiousImages<dim> *images = ends.images.get();
    u.update_ghost_values();
    const double *const values = u.begin();
    ends.find(values);
    double *const body = trial.stretches.body.data(), *const beyond = trial.stretches.beyond.data();
    for_each_family(bonds, [&](const unsigned int i, const Span &inside, const Span &outside) {
      const double *const own = values + dim * i;
      double              sum = find_stretches(
        bonds.body,
        inside.begin,
        inside.end,
        own,
        [values](const unsigned int j) { return values + dim * j; },
        body);
      sum += find_stretches(
        bonds.beyond,
        outside.begin,
        outside.end,
        own,
        [&](const unsigned int j) { return images->value(ends.image(j)); },
        beyond);
      double thermal = 0.;
      if (!expansions.empty())
        {
          const auto origin = [&](const unsigned int j) { return ends.origin(j); };
          thermal           = take_off(bonds.body, inside, expansions, i, origin, body) +
                    take_off(bonds.beyond, outside, expansions, i, origin, beyond);
          sum -= thermal;
        }
      const double q = laws.weighted.local_element(i), volume = nodes.volume(i),
                   alpha = laws.stiffness(i), mean_stretch = sum / (volume * q),
                   squares =
                     sum_squares(bonds.body, inside.begin, inside.end, mean_stretch, body) +
                     sum_squares(bonds.beyond, outside.begin, outside.end, mean_stretch, beyond);
      const double own_sum = 0.5 * alpha / volume * squares, out_of_plane = thermal / (volume * q);
      OrdinaryPlasticity::Answer &answer = trial.answers[i];
      answer = materials[i].answer(dim * mean_stretch, own_sum, states[i], out_of_plane);
      double *const numbers = trial.numbers.begin() + n_numbers * i;
      numbers[stiffness]    = alpha * answer.ratio;
      numbers[tension]      = dim * answer.mean / q - numbers[stiffness] * mean_stretch;
      numbers[dilatation]   = mean_stretch;
      numbers[lost]         = answer.yields() ? 1. - answer.ratio : 0.;
    });
    u.set_ghost_state(false);
    trial.numbers.update_ghost_values();
    std::copy(values, values + u.locally_owned_size(), trial.displacement.begin());
    trial.known      = true;
    trial.has_forces = false;
  }


  template <int dim>
  bool YieldingFamilies<dim>::knows(const Vector &u) const
  {
    const bool same =
      trial.known &&
      std::equal(u.begin(), u.begin() + u.locally_owned_size(), trial.displacement.begin());
    return Utilities::MPI::min(same ? 1 : 0, families.nodes().communicator()) > 0;
  }


  template <int dim>
  void YieldingFamilies<dim>::find_forces(Vector &y, const Vector &u, const double) const
  {
    find(u);
    const double *const numbers = trial.numbers.begin();
    sum_forces_of_families(
      y,
      bonds,
      ends,
      [&](const unsigned int   i,
          const BondRows<dim> &rows,
          const std::size_t    k,
          const unsigned int   j,
          const auto           has_family) -> Tensor<1, dim> {
        const double *const own     = numbers + n_numbers * i;
        const double *const plastic = rows.nonlinear.history.data() + n_history * k;
        if constexpr (!decltype(has_family)::value)
          return (own[tension] + own[stiffness] * (trial.stretches.beyond[k] - plastic[0])) *
                 rows.moments[k];
        else
          {
            const double *const far = numbers + n_numbers * j;
            const double        s   = trial.stretches.body[k];
            return (own[tension] + far[tension] + own[stiffness] * (s - plastic[0]) +
                    far[stiffness] * (s - plastic[1])) *
                   rows.moments[k];
          }
      });
    std::copy(y.begin(), y.begin() + y.locally_owned_size(), trial.forces.begin());
    trial.has_forces = true;
  }


  template <int dim>
  double YieldingFamilies<dim>::force(const unsigned int    i,
                                      const SolidBond<dim> &bond,
                                      const bool            half_of_both) const
  {
    const BondRows<dim> &rows      = bonds.rows_of(bond.number);
    const std::size_t    k         = bonds.place(bond.number);
    const bool           is_beyond = ends.is_fictitious(bond.neighbor);
    const double         s      = is_beyond ? trial.stretches.beyond[k] : trial.stretches.body[k];
    const auto           of_end = [&](const unsigned int node, const unsigned int end) {
      const double *const numbers = trial.numbers.begin() + n_numbers * node;
      return numbers[tension] +
             numbers[stiffness] * (s - rows.nonlinear.history[n_history * k + end]);
    };
    const double own = of_end(i, 0);
    return half_of_both && !is_beyond ? 0.5 * (own + of_end(bond.neighbor, 1)) : own;
  }


  namespace
  {
    /** Over the volume of the body, of a number of each owned node. Collective. */
    template <int dim>
    double sum_of(const Nodes<dim>                              &nodes,
                  const std::vector<OrdinaryPlasticity::Answer> &answers,
                  double OrdinaryPlasticity::Answer::*const what)
    {
      double sum = 0.;
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        sum += nodes.volume(i) * answers[i].*what;
      return Utilities::MPI::sum(sum, nodes.communicator());
    }
  } // namespace


  template <int dim>
  double YieldingFamilies<dim>::energy(const Vector &u) const
  {
    if (!knows(u))
      find(u);
    return sum_of(families.nodes(), trial.answers, &OrdinaryPlasticity::Answer::stored);
  }


  template <int dim>
  double YieldingFamilies<dim>::plastic_work(const Vector &u) const
  {
    if (!knows(u))
      find(u);
    return sum_of(families.nodes(), trial.answers, &OrdinaryPlasticity::Answer::dissipated);
  }


  template <int dim>
  void YieldingFamilies<dim>::remember()
  {
    const double *const numbers = trial.numbers.begin();
    const auto          keep    = [&](const unsigned int node, const double s, double &plastic) {
      const double *const of_node = numbers + n_numbers * node;
      if (of_node[lost] > 0.)
        plastic += of_node[lost] * (s - of_node[dilatation] - plastic);
    };
    std::vector<double> &body   = bonds.body.nonlinear.history,
                        &beyond = bonds.beyond.nonlinear.history;
    for_each_family(bonds, [&](const unsigned int i, const Span &inside, const Span &outside) {
      for (std::size_t k = inside.begin; k < inside.end; ++k)
        {
          const double s = trial.stretches.body[k];
          keep(i, s, body[n_history * k]);
          keep(bonds.body.neighbors[k], s, body[n_history * k + 1]);
        }
      for (std::size_t k = outside.begin; k < outside.end; ++k)
        keep(i, trial.stretches.beyond[k], beyond[n_history * k]);
      states[i].strain += trial.answers[i].change.strain;
      states[i].plane += trial.answers[i].change.plane;
    });
    trial.known = false;
  }


  template <int dim>
  double YieldingFamilies<dim>::accept(const Vector &u, const double)
  {
    if (!knows(u) || !trial.has_forces)
      {
        Vector y(trial.forces);
        find_forces(y, u);
      }
    double stored = 0., n_yield = 0.;
    for (unsigned int i = 0; i < states.size(); ++i)
      {
        stored += families.nodes().volume(i) * trial.answers[i].stored;
        n_yield += trial.answers[i].yields() ? 1. : 0.;
      }
    bool         yields     = false;
    const double dissipated = accepted.take(u,
                                            trial.forces,
                                            stored,
                                            n_yield,
                                            accepted.warms ? plastic_work(u) : 0.,
                                            families.nodes().communicator(),
                                            yields);
    if (yields)
      remember();
    return dissipated;
  }


  template <int dim>
  void YieldingFamilies<dim>::exchange(Archive &archive, const NodeKeys &keys)
  {
    Vector strain(families.nodes().partitioner()), plane(strain);
    for (unsigned int i = 0; i < states.size(); ++i)
      {
        strain.local_element(i) = states[i].strain;
        plane.local_element(i)  = states[i].plane;
      }
    archive.exchange("plastic strain", strain, keys);
    archive.exchange("of the plane", plane, keys);
    for (unsigned int i = 0; i < states.size(); ++i)
      states[i] = {strain.local_element(i), plane.local_element(i)};
    accepted.exchange(archive, keys);
    exchange_histories(bonds, archive, keys, n_history);
    if (archive.loads())
      trial.known = false;
  }


  template <int dim>
  void YieldingFamilies<dim>::linearize(const Vector &u)
  {
    if (!knows(u))
      find(u);
    double n_yield = 0.;
    for (const auto &answer : trial.answers)
      n_yield += answer.yields() ? 1. : 0.;
    tangent.any = Utilities::MPI::max(n_yield, families.nodes().communicator()) > 0.;
    if (!tangent.any)
      return;
    tangent.answers = trial.answers;
    if (tangent.changes.size() == 0)
      tangent.changes.reinit(interleaved(*families.nodes().partitioner(), n_changes));
    tangent.elastic.body.resize(n_history * bonds.body.size());
    tangent.elastic.beyond.resize(bonds.beyond.size());
    const double *const numbers    = trial.numbers.begin();
    const auto          elastic_of = [&](const unsigned int node, const double s) {
      return s - numbers[n_numbers * node + dilatation];
    };
    const std::vector<double> &body   = bonds.body.nonlinear.history,
                              &beyond = bonds.beyond.nonlinear.history;
    for_each_family(bonds, [&](const unsigned int i, const Span &inside, const Span &outside) {
      tangent.changes.local_element(n_changes * i + kept) = numbers[n_numbers * i + stiffness];
      for (std::size_t k = inside.begin; k < inside.end; ++k)
        {
          const double      s          = trial.stretches.body[k];
          const std::size_t at         = n_history * k;
          tangent.elastic.body[at]     = elastic_of(i, s) - body[at];
          tangent.elastic.body[at + 1] = elastic_of(bonds.body.neighbors[k], s) - body[at + 1];
        }
      for (std::size_t k = outside.begin; k < outside.end; ++k)
        tangent.elastic.beyond[k] =
          elastic_of(i, trial.stretches.beyond[k]) - beyond[n_history * k];
    });
  }


  template <int dim>
  void YieldingFamilies<dim>::multiply(Vector &y, const Vector &x) const
  {
    const FictitiousImages<dim> *images = ends.images.get();
    x.update_ghost_values();
    const double *const values = x.begin();
    ends.find(values);
    const auto product = [&](const BondRows<dim> &rows, const unsigned int i, const std::size_t k) {
      const unsigned int j = rows.neighbors[k];
      return change_along(rows.moments[k],
                          values + dim * i,
                          ends.is_fictitious(j) ? images->value(ends.image(j)) : values + dim * j);
    };
    for_each_family(bonds, [&](const unsigned int i, const Span &inside, const Span &outside) {
      double sum = 0., of_sum = 0.;
      for (std::size_t k = inside.begin; k < inside.end; ++k)
        {
          const double of_bond = product(bonds.body, i, k);
          sum += of_bond;
          of_sum += tangent.elastic.body[n_history * k] * of_bond;
        }
      for (std::size_t k = outside.begin; k < outside.end; ++k)
        {
          const double of_bond = product(bonds.beyond, i, k);
          sum += of_bond;
          of_sum += tangent.elastic.beyond[k] * of_bond;
        }
      const OrdinaryPlasticity::Answer &at = tangent.answers[i];
      const double q = laws.weighted.local_element(i), volume = families.nodes().volume(i),
                   alpha = laws.stiffness(i), mean_stretch = sum / (volume * q),
                   of_theta = dim * mean_stretch;
      double *const changes = tangent.changes.begin() + n_changes * i;
      of_sum *= alpha / volume;
      changes[of_stiffness] = alpha * (at.mixed * of_theta + at.by_sum * of_sum);
      changes[of_tension] =
        dim * (at.by_theta * of_theta + at.mixed * of_sum) / q - changes[kept] * mean_stretch;
    });
    tangent.changes.update_ghost_values();
    const double *const changes = tangent.changes.begin();
    sum_forces_of_families(
      y,
      bonds,
      ends,
      [&](const unsigned int   i,
          const BondRows<dim> &rows,
          const std::size_t    k,
          const unsigned int   j,
          const auto           has_family) -> Tensor<1, dim> {
        const double *const own = changes + n_changes * i;
        const double        s   = product(rows, i, k) / rows.squares[k];
        if constexpr (!decltype(has_family)::value)
          return (own[of_tension] + own[kept] * s + own[of_stiffness] * tangent.elastic.beyond[k]) *
                 rows.moments[k];
        else
          {
            const double *const far     = changes + n_changes * j;
            const double *const elastic = &tangent.elastic.body[n_history * k];
            return (own[of_tension] + far[of_tension] + (own[kept] + far[kept]) * s +
                    own[of_stiffness] * elastic[0] + far[of_stiffness] * elastic[1]) *
                   rows.moments[k];
          }
      });
    x.set_ghost_state(false);
  }


  template <int dim>
  std::size_t YieldingFamilies<dim>::memory_consumption() const
  {
    return materials.capacity() * sizeof(materials[0]) + states.capacity() * sizeof(states[0]) +
           (trial.answers.capacity() + tangent.answers.capacity()) * sizeof(trial.answers[0]) +
           size_of(trial.stretches) + size_of(tangent.elastic) +
           trial.numbers.memory_consumption() + tangent.changes.memory_consumption() +
           4 * trial.forces.memory_consumption();
  }


  PERIDEAL_INSTANTIATE_CLASS(class YieldingFamilies);
} // namespace PeriDeal
