// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/interleaved.h>
#include <perideal/operators/solid/correspondence.h>

#include <algorithm>
#include <numeric>

#include "correspondence_sums.h"
#include "gradient_lattice.h"
#include "large_deformation.h"
#include "lattice_histories.h"
#include "with_ghosts.h"

// A node knows its gradient and its law, a bond what both of its nodes make of them.

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Whether a trial is of u, on all processes; of linear bodies never. Collective. */
    template <typename Trial>
    bool is_of(const Trial &trial, const Vector &u, const bool is_linear)
    {
      const bool same =
        !is_linear && trial.known && // else thermal strains may be other ones
        std::equal(u.begin(), u.begin() + u.locally_owned_size(), trial.displacement.begin());
      return Utilities::MPI::min(same ? 1 : 0, u.get_mpi_communicator()) > 0;
    }
  } // namespace


  template <int dim>
  Correspondence<dim>::Correspondence(const Families<dim>       &families,
                                      const BondEnds<dim>       &ends,
                                      BondTable<dim>            &bonds,
                                      const NodeLaws<dim>       &laws,
                                      const BodyParameters<dim> &body)
    : shapes(families, ends, bonds, laws)
    , stresses(families.nodes(), body)
    , families(families)
    , ends(ends)
    , bonds(bonds)
  {
    Assert(!bonds.body.is_packed() && !bonds.beyond.is_packed(), ExcInternalError());
    Assert(!stresses.is_full() || !bonds.body.leaves_out(), ExcInternalError());
    const Nodes<dim>  &nodes = families.nodes();
    const unsigned int n     = nodes.n_owned();
    trial.slopes.resize(n);
    trial.squares.resize(n, 0.);
    trial.products.resize(n, 0.);
    trial.ratios.resize(n, 1.);
    for (unsigned int i = 0; i < n; ++i)
      {
        SymmetricTensor<4, dim> stiffness;
        J2Plasticity::Beside    none;
        stresses.ask(i, trial.slopes[i], none, &stiffness);
        shapes.set_stiffness(i, stiffness, stiffness.norm() > 0.); // zero after a fault
      }
    stresses.throw_faults();
    std::vector<unsigned int> all(n);
    std::iota(all.begin(), all.end(), 0U);
    renew(all);
    if (bonds.body.leaves_out())
      {
        std::vector<bool> computed;
        for (unsigned int i = 0; i < n; ++i)
          computed.push_back(bonds.is_on_lattice(i));
        lattice.sums = std::make_unique<GradientLattice<dim>>(families, computed);
        if (stresses.flows())
          lattice.histories =
            std::make_unique<LatticeHistories<dim>>(families, lattice.sums->layout);
      }
    const auto with = [&](const unsigned int n) { return interleaved(*nodes.partitioner(), n); };
    trial.numbers.reinit(with(stresses.flows() ? n_of_flow : n_numbers));
    tangent.changes.reinit(with(stresses.flows() ? n_numbers + 1 : n_numbers));
    const auto unknowns = with(dim);
    for (Vector *v : {&trial.displacement, &trial.forces})
      v->reinit(unknowns);
    if (!is_linear())
      for (Vector *v : {&accepted.displacement, &accepted.forces})
        v->reinit(unknowns);
  }


  template <int dim>
  Correspondence<dim>::~Correspondence() = default;


  template <int dim>
  void Correspondence<dim>::renew(const std::vector<unsigned int> &nodes)
  {
    if (nodes.empty() && shapes.weights().body.size() == bonds.body.size())
      return;
    trial.known = false;
    shapes.renew(nodes);
  }


  template <int dim>
  void Correspondence<dim>::settle(const unsigned int i,
                                   const double       squares,
                                   const double       products) const
  {
    const auto          &shape  = shapes[i];
    const double         volume = families.nodes().volume(i);
    J2Plasticity::Beside flow;
    flow.square = 3. * shape.shear * shape.stabilizer / volume * squares;
    stresses.ask(i, trial.slopes[i], flow, nullptr);
    trial.squares[i]             = squares;
    trial.products[i]            = products;
    trial.ratios[i]              = flow.ratio;
    const bool           flows   = stresses.flows();
    double *const        numbers = trial.numbers.begin() + (flows ? n_of_flow : n_numbers) * i;
    const double         c       = shape.share * shape.stabilizer * flow.ratio;
    const Tensor<2, dim> inverse(shape.inverse), pull = stresses.pull(i, trial.slopes[i]);
    write(numbers + at_force,
          Tensor<2, dim>(shape.share * volume * (pull * inverse) - c * trial.slopes[i]));
    numbers[at_stiffness] = c;
    if (!flows)
      return;
    write(numbers + at_slopes, trial.slopes[i]);
    numbers[at_lost] = 1. - flow.ratio;
  }


  template <int dim>
  void Correspondence<dim>::find_on_lattice(const double *u) const
  {
    const bool flows = stresses.flows();
    const auto take  = [&](const unsigned int i, const auto &sums) {
      if (!bonds.is_on_lattice(i))
        return;
      const double   volume  = families.nodes().volume(i);
      Tensor<2, dim> changes = volume * sums.changes;
      double         squares = volume * (sums.square + sums.off);
      const Span     outside = span_of(bonds.beyond, i);
      for (std::size_t k = outside.begin; k < outside.end; ++k)
        {
          const Tensor<1, dim> change = ends.change(u, i, bonds.beyond.neighbors[k]);
          add_change(changes, change, bonds.beyond.moments[k]);
          squares += shapes.weights().beyond[k] * change.norm_square();
        }
      trial.slopes[i] = changes * Tensor<2, dim>(shapes[i].inverse);
      if (!flows)
        {
          settle(i, 0., 0.);
          return;
        }
      if (stresses.has_flowed(i))
        {
          lattice.histories->want(i);
          return;
        }
      squares -= scalar_product(changes, trial.slopes[i]);
      settle(i, std::max(0., squares), 0.);
      trial.squares[i] = 0.;
      if (trial.ratios[i] < 1.)
        lattice.histories->want(i);
    };
    lattice.sums->find_sums(u, flows, take);
    if (!flows || !lattice.histories->wants_any())
      return;
    lattice.histories->take(u);
    lattice.histories->sum_elastic(
      [&](const unsigned int node) {
        return node < shapes.size() ? &trial.slopes[node][0][0] : nullptr;
      },
      [&](const unsigned int i, const unsigned int at, const auto &sums) {
        const double   volume = families.nodes().volume(i);
        ElasticSums    all{volume * sums.squares[at], volume * sums.products[at]};
        Tensor<1, dim> pull;
        for (unsigned int d = 0; d < dim; ++d)
          pull[d] = volume * sums.pulls[d][at];
        const Span beyond = span_of(bonds.beyond, i);
        add_elastic(all, shapes, bonds, ends, u, i, trial.slopes[i], true, {}, beyond);
        settle(i, all.squares, all.products);
        if (stresses.has_flowed(i))
          trial.pulls.emplace_back(i, pull);
      });
  }


  template <int dim>
  void Correspondence<dim>::find(const Vector &u) const
  {
    u.update_ghost_values();
    const double *const values = u.begin();
    ends.find(values);
    trial.known = false; // also of what throws below
    trial.pulls.clear();
    if (lattice.sums)
      find_on_lattice(values);
    const auto find_at = [&](const unsigned int i, const Span &inside, const Span &outside) {
      if (bonds.is_on_lattice(i) || shapes[i].share == 0.)
        return;
      const Tensor<2, dim> &slopes = trial.slopes[i] =
        sum_of_changes(bonds, ends, values, i, inside, outside) * Tensor<2, dim>(shapes[i].inverse);
      ElasticSums sums;
      add_elastic(sums, shapes, bonds, ends, values, i, slopes, stresses.flows(), inside, outside);
      settle(i, sums.squares, sums.products);
    };
    for_each_family(bonds, shapes.size(), find_at);
    u.set_ghost_state(false);
    stresses.throw_faults();
    trial.numbers.update_ghost_values();
    std::copy(values, values + u.locally_owned_size(), trial.displacement.begin());
    trial.known      = true;
    trial.has_forces = false;
  }


  template <int dim>
  void Correspondence<dim>::find_forces(Vector &y, const Vector &u, const double t) const
  {
    const bool flows = stresses.flows();
    stresses.set_time(t);
    trial.known = false;
    find(u);
    u.update_ghost_values();
    const double *const values  = u.begin();
    const double *const numbers = trial.numbers.begin();
    const unsigned      n       = flows ? n_of_flow : n_numbers;
    if (lattice.sums)
      lattice.sums->find_forces(y.begin(), values, numbers, n);
    if (lattice.histories)
      {
        for (const auto &[i, pull] : trial.pulls)
          for (unsigned int d = 0; d < dim; ++d)
            y.local_element(dim * i + d) += numbers[n * i + at_stiffness] * pull[d];
        lattice.histories->subtract_far(
          y.begin(),
          LatticeHistories<dim>::Of::plastic,
          [=](const unsigned int node) { return numbers[n * node + at_stiffness]; });
      }
    sum_forces_of_families(
      y,
      bonds,
      ends,
      [&](const unsigned int   i,
          const BondRows<dim> &rows,
          const std::size_t    k,
          const unsigned int   j,
          const auto           has_family) {
        const double *const   own    = numbers + n * i;
        const Tensor<1, dim> &moment = rows.moments[k];
        const double          w      = shapes.weights().of(&rows == &bonds.beyond)[k];
        const Tensor<1, dim>  change = ends.change(values, i, j);
        Tensor<1, dim> force = times<dim>(own + at_force, moment) + w * own[at_stiffness] * change;
        const double *const plastic = flows ? &rows.nonlinear.history[n_history * k] : nullptr;
        if (plastic != nullptr)
          force -= w * own[at_stiffness] * vector_at<dim>(plastic);
        if constexpr (decltype(has_family)::value)
          {
            const double *const far = numbers + n * j;
            force += times<dim>(far + at_force, moment) + w * far[at_stiffness] * change;
            if (plastic != nullptr)
              force -= w * far[at_stiffness] * vector_at<dim>(plastic + dim);
          }
        return force;
      });
    u.set_ghost_state(false);
    std::copy(y.begin(), y.begin() + y.locally_owned_size(), trial.forces.begin());
    trial.has_forces = true;
  }


  template <int dim>
  void Correspondence<dim>::take_temperatures(const Vector &changes)
  {
    stresses.take_temperatures(changes);
    if (changes.size() > 0 && stresses.moduli_change())
      {
        for (unsigned int i = 0; i < shapes.size(); ++i)
          shapes.set_stiffness(i, stresses.elastic(i), true);
        std::vector<unsigned int> all(shapes.size());
        std::iota(all.begin(), all.end(), 0U);
        shapes.renew(all);
      }
    trial.known = false;
    accepted.take_warming(changes.size() > 0);
  }


  template <int dim>
  double Correspondence<dim>::energy_of(const std::vector<unsigned int> &list,
                                        const Vector                    &u,
                                        const bool                       of_shear) const
  {
    u.update_ghost_values();
    ends.find(u.begin());
    trial.known = false;
    double sum  = 0.;
    for (const unsigned int i : list)
      {
        Tensor<2, dim> changes;
        const auto change_at = [&](const unsigned int j) { return ends.change(u.begin(), i, j); };
        shapes.for_each_bond(
          i,
          [&](const unsigned int j, const Tensor<1, dim> &moment, const double, std::size_t) {
            add_change(changes, change_at(j), moment);
          });
        trial.slopes[i] = changes * Tensor<2, dim>(shapes[i].inverse);
        double squares  = 0.;
        shapes.for_each_bond(
          i,
          [&](const unsigned int j, const Tensor<1, dim> &moment, const double w, std::size_t) {
            if (w > 0.)
              squares += w * (change_at(j) - trial.slopes[i] * moment / w).norm_square();
          });
        const auto strain = symmetrize(trial.slopes[i]);
        double     stored = 0.5 * (shapes.of_shear(i, strain) * strain);
        if (!of_shear)
          {
            settle(i, squares, squares);
            stored = stresses[i].stored;
          }
        sum += shapes[i].share *
               (families.nodes().volume(i) * stored + 0.5 * shapes[i].stabilizer * squares);
      }
    u.set_ghost_state(false);
    stresses.throw_faults();
    return Utilities::MPI::sum(sum, families.nodes().communicator());
  }


  template <int dim>
  double Correspondence<dim>::stored(const Vector &u, const Vector &minus_F) const
  {
    double sum = 0.;
    for (unsigned int i = 0; i < shapes.size(); ++i)
      {
        const double share = shapes[i].share, c = share * shapes[i].stabilizer, r = trial.ratios[i];
        double       of_point = stresses[i].stored;
        if (lattice.sums)
          {
            of_point -= 0.5 * (stresses.stress(i) * symmetrize(trial.slopes[i]));
            sum += 0.5 * c * r * (r * trial.squares[i] - trial.products[i]);
          }
        else
          sum += 0.5 * c * r * r * trial.squares[i];
        sum += share * families.nodes().volume(i) * of_point;
      }
    for (unsigned int k = 0; lattice.sums && k < u.locally_owned_size(); ++k)
      sum += 0.5 * minus_F.local_element(k) * u.local_element(k);
    return sum;
  }


  template <int dim>
  double Correspondence<dim>::energy(const Vector &u) const
  {
    if (!is_of(trial, u, is_linear()) || (lattice.sums && !trial.has_forces))
      {
        Vector y(trial.forces);
        if (lattice.sums)
          find_forces(y, u, stresses.now());
        else
          find(u);
      }
    return Utilities::MPI::sum(stored(u, trial.forces), families.nodes().communicator());
  }


  template <int dim>
  double Correspondence<dim>::accept(const Vector &u, const double t)
  {
    if (!stresses.remembers()) // nor dissipates
      {
        stresses.accept(t, false, false);
        return 0.;
      }
    if (!is_of(trial, u, is_linear()) || !trial.has_forces || stresses.now() != t)
      {
        Vector y(trial.forces);
        find_forces(y, u, t);
      }
    double n_flow = 0., here = 0.;
    for (unsigned int i = 0; i < shapes.size(); ++i)
      {
        n_flow += !stresses.flows() || trial.ratios[i] < 1. ? 1. : 0.;
        here += shapes[i].share * families.nodes().volume(i) * stresses[i].dissipated;
      }
    bool           flows  = false;
    const MPI_Comm all    = families.nodes().communicator();
    const double   by_law = Utilities::MPI::sum(here, all);
    const double   by_forces =
      accepted.take(u, trial.forces, stored(u, trial.forces), n_flow, by_law, all, flows);
    const double dissipated = stresses.is_full() ? by_law : by_forces; // of large steps
    stresses.accept(t, flows, !stresses.same_states());
    if (flows && stresses.flows())
      remember(u);
    trial.known = trial.known && !flows;
    return dissipated;
  }


  template <int dim>
  void Correspondence<dim>::remember(const Vector &u)
  {
    const double *const numbers = trial.numbers.begin();
    u.update_ghost_values();
    const double *const values = u.begin();
    ends.find(values);
    if (lattice.histories)
      {
        for (unsigned int i = 0; i < families.nodes().n_local(); ++i)
          if (numbers[n_of_flow * i + at_lost] > 0.)
            lattice.histories->want(i);
        lattice.histories->take(values);
        lattice.histories->let_flow(
          [=](const unsigned int i) { return numbers + n_of_flow * i + at_slopes; },
          [=](const unsigned int i) { return numbers[n_of_flow * i + at_lost]; });
      }
    const auto keep = [&](const unsigned int    node,
                          const Tensor<1, dim> &change,
                          const Tensor<1, dim> &xi,
                          double               *plastic) {
      const double *const of_node = numbers + n_of_flow * node;
      if (of_node[at_lost] == 0.)
        return;
      const Tensor<1, dim> beside = change - times<dim>(of_node + at_slopes, xi);
      for (unsigned int d = 0; d < dim; ++d)
        plastic[d] += of_node[at_lost] * (beside[d] - plastic[d]);
    };
    for_each_family(
      bonds,
      shapes.size(),
      [&](const unsigned int i, const Span &inside, const Span &outside) {
        for_each_bond(bonds, inside, outside, [&](const BondRows<dim> &rows, const std::size_t k) {
          const bool         is_beyond = &rows == &bonds.beyond;
          const double       w         = shapes.weights().of(is_beyond)[k];
          const unsigned int j         = rows.neighbors[k];
          if (w == 0. || (numbers[n_of_flow * i + at_lost] == 0. &&
                          (is_beyond || numbers[n_of_flow * j + at_lost] == 0.)))
            return;
          const Tensor<1, dim> xi = rows.moments[k] / w, change = ends.change(values, i, j);
          double *const        plastic =
            &(is_beyond ? bonds.beyond : bonds.body).nonlinear.history[n_history * k];
          keep(i, change, xi, plastic);
          if (!is_beyond)
            keep(j, change, xi, plastic + dim);
        });
      });
    u.set_ghost_state(false);
  }


  template <int dim>
  void Correspondence<dim>::exchange(Archive &archive, const NodeKeys &keys)
  {
    if (is_linear())
      return;
    stresses.exchange(archive, keys);
    accepted.exchange(archive, keys);
    if (stresses.flows())
      exchange_histories(bonds, archive, keys, n_history);
    if (lattice.histories)
      lattice.histories->exchange(archive, keys);
    if (archive.loads())
      trial.known = false;
  }


  template <int dim>
  void Correspondence<dim>::linearize(const Vector &u)
  {
    if (is_linear())
      return;
    if (!is_of(trial, u, is_linear()))
      find(u);
    if (stresses.is_full())
      {
        shapes.deformed.resize(shapes.size());
        for (unsigned int i = 0; i < shapes.size(); ++i)
          {
            auto                &at = shapes.deformed[i];
            J2Plasticity::Beside none;
            stresses.ask(i, trial.slopes[i], none, &at.stiffness);
            at.gradient = deformation_of(trial.slopes[i]);
            at.stress   = stresses.stress(i);
          }
        stresses.throw_faults();
        return;
      }
    double n_flow = 0.;
    tangent.flows.resize(shapes.size());
    for (unsigned int i = 0; i < shapes.size(); ++i)
      {
        if (shapes[i].share == 0.)
          continue;
        Flow                &at = tangent.flows[i];
        J2Plasticity::Beside flow;
        flow.square = 3. * shapes[i].shear * shapes[i].stabilizer / families.nodes().volume(i) *
                      trial.squares[i];
        stresses.ask(i, trial.slopes[i], flow, &at.stiffness);
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = a; b < dim; ++b)
            at.stress_slope[a][b] = flow.stress_slope[a][b];
        at.ratio       = flow.ratio;
        at.ratio_slope = flow.ratio_slope;
        n_flow += !stresses.flows() || flow.ratio < 1. ? 1. : 0.;
      }
    stresses.throw_faults();
    tangent.any = Utilities::MPI::max(n_flow, families.nodes().communicator()) > 0.;
    if (tangent.any && stresses.flows())
      keep_elastic(u);
  }


  template <int dim>
  void Correspondence<dim>::keep_elastic(const Vector &u)
  {
    const double *const numbers = trial.numbers.begin();
    u.update_ghost_values();
    const double *const values = u.begin();
    ends.find(values);
    if (lattice.histories)
      {
        tangent.pulls.clear();
        for (unsigned int i = 0; i < families.nodes().n_local(); ++i)
          if (numbers[n_of_flow * i + at_lost] > 0.)
            lattice.histories->want(i);
        lattice.histories->take(values);
        lattice.histories->keep_elastic(
          [=](const unsigned int i) { return numbers + n_of_flow * i + at_slopes; },
          [&](const unsigned int i, const unsigned int at, const auto &sums) {
            Tensor<1, dim> pull;
            for (unsigned int d = 0; d < dim; ++d)
              pull[d] = families.nodes().volume(i) * sums.pulls[d][at];
            if (bonds.is_on_lattice(i))
              tangent.pulls.emplace_back(i, pull);
          });
      }
    tangent.own.resize(bonds);
    tangent.far.resize(bonds);
    for_each_family(
      bonds,
      shapes.size(),
      [&](const unsigned int i, const Span &inside, const Span &outside) {
        for_each_bond(bonds, inside, outside, [&](const BondRows<dim> &rows, const std::size_t k) {
          const bool   is_beyond = &rows == &bonds.beyond;
          const double w         = shapes.weights().of(is_beyond)[k];
          if (w == 0.)
            return;
          const unsigned int   j  = rows.neighbors[k];
          const Tensor<1, dim> xi = rows.moments[k] / w, change = ends.change(values, i, j);
          const double *const  plastic = &rows.nonlinear.history[n_history * k];
          const auto           elastic = [&](const unsigned int node, const double *of_end) {
            return change - times<dim>(numbers + n_of_flow * node + at_slopes, xi) -
                   vector_at<dim>(of_end);
          };
          tangent.own.of(is_beyond)[k] = elastic(i, plastic);
          if (!is_beyond)
            tangent.far.body[k] = elastic(j, plastic + dim);
        });
      });
    u.set_ghost_state(false);
  }


  template <int dim>
  void Correspondence<dim>::settle_change(const unsigned int    i,
                                          const Tensor<2, dim> &slopes,
                                          const double          products) const
  {
    const auto          &shape  = shapes[i];
    const double         volume = families.nodes().volume(i);
    const Flow *const    at     = tangent.any ? &tangent.flows[i] : nullptr;
    const Tensor<2, dim> inverse(shape.inverse);
    const auto           strain = symmetrize(slopes);
    auto                 stress = (at != nullptr ? at->stiffness : shapes.elastic(i)) * strain;
    double               c = shape.share * shape.stabilizer, of_ratio = 0.;
    if (at != nullptr && stresses.flows() && at->ratio < 1.)
      {
        const double of_square = 6. * shape.shear * shape.stabilizer / volume * products;
        stress += of_square * at->stress_slope;
        of_ratio =
          c * (6. * shape.shear * (at->stress_slope * strain) + at->ratio_slope * of_square);
        c *= at->ratio;
      }
    if (counted.shear != 1. || counted.bulk != 1.)
      {
        const auto of_shear = shapes.of_shear(i, strain);
        stress              = counted.bulk * (stress - of_shear) + counted.shear * of_shear;
        c *= counted.shear;
      }
    const Tensor<2, dim> pull = shapes.deformed.empty() ? Tensor<2, dim>(stress) :
                                                          shapes.deformed[i].change_of_pull(slopes);
    double *const        numbers =
      tangent.changes.begin() + (stresses.flows() ? n_numbers + 1 : n_numbers) * i;
    write(numbers + at_force, Tensor<2, dim>(shape.share * volume * (pull * inverse) - c * slopes));
    numbers[at_stiffness] = c;
    if (stresses.flows())
      numbers[at_slopes] = of_ratio;
  }


  template <int dim>
  void Correspondence<dim>::find_changes(const Vector &x) const
  {
    const bool          flows  = tangent.any && stresses.flows();
    const double *const values = x.begin();
    ends.find(values);
    const auto settle_all = [&](const unsigned int    i,
                                const Tensor<2, dim> &changes,
                                double                products,
                                const Span           &inside,
                                const Span           &outside) {
      if (flows && tangent.flows[i].ratio < 1.)
        for_each_bond(bonds, inside, outside, [&](const BondRows<dim> &rows, const std::size_t k) {
          const bool is_beyond = &rows == &bonds.beyond;
          products += shapes.weights().of(is_beyond)[k] *
                      (tangent.own.of(is_beyond)[k] * ends.change(values, i, rows.neighbors[k]));
        });
      const Tensor<2, dim> slopes = changes * Tensor<2, dim>(shapes[i].inverse);
      if (is_linear()) // multiply_apart() has them twice
        trial.slopes[i] = slopes;
      settle_change(i, slopes, products);
    };
    if (lattice.sums)
      {
        if (flows)
          {
            tangent.products.assign(shapes.size(), 0.);
            for (const auto &[i, pull] : tangent.pulls)
              lattice.histories->want(i);
            lattice.histories->take(values);
            lattice.histories->sum_products([&](const unsigned int i, const double sum) {
              tangent.products[i] = families.nodes().volume(i) * sum;
            });
          }
        lattice.sums->find_sums(values, false, [&](const unsigned int i, const auto &sums) {
          if (!bonds.is_on_lattice(i))
            return;
          Tensor<2, dim> changes = families.nodes().volume(i) * sums.changes;
          const Span     outside = span_of(bonds.beyond, i);
          changes += sum_of_changes(bonds, ends, values, i, {}, outside);
          settle_all(i, changes, flows ? tangent.products[i] : 0., {}, outside);
        });
      }
    for_each_family(bonds,
                    shapes.size(),
                    [&](const unsigned int i, const Span &inside, const Span &outside) {
                      if (!bonds.is_on_lattice(i))
                        settle_all(i,
                                   sum_of_changes(bonds, ends, values, i, inside, outside),
                                   0.,
                                   inside,
                                   outside);
                    });
    tangent.changes.update_ghost_values();
  }


  template <int dim>
  void Correspondence<dim>::multiply(Vector &y, const Vector &x) const
  {
    x.update_ghost_values();
    find_changes(x);
    sum_changes(y, x);
    x.set_ghost_state(false);
  }


  template <int dim>
  void Correspondence<dim>::multiply_apart(Vector &of_shear, Vector &of_bulk, const Vector &x) const
  {
    Assert(is_linear(), ExcInternalError());
    const WithGhosts ghosts(x);
    counted = {1., 0.};
    find_changes(x);
    sum_changes(of_shear, x);
    counted = {0., 1.};
    for (unsigned int i = 0; i < shapes.size(); ++i)
      settle_change(i, trial.slopes[i], 0.);
    tangent.changes.update_ghost_values();
    sum_changes(of_bulk, x);
    counted = {};
  }


  template <int dim>
  void Correspondence<dim>::sum_changes(Vector &y, const Vector &x) const
  {
    const bool          flows  = tangent.any && stresses.flows();
    const unsigned      n      = stresses.flows() ? n_numbers + 1 : n_numbers;
    const double *const values = x.begin(), *const numbers = tangent.changes.begin();
    if (lattice.sums)
      lattice.sums->find_forces(y.begin(), values, numbers, n);
    if (lattice.histories && flows)
      {
        for (const auto &[i, pull] : tangent.pulls)
          for (unsigned int d = 0; d < dim; ++d)
            y.local_element(dim * i + d) -= numbers[n * i + at_slopes] * pull[d];
        lattice.histories->subtract_far(
          y.begin(),
          LatticeHistories<dim>::Of::elastic,
          [=](const unsigned int node) { return -numbers[n * node + at_slopes]; });
      }
    sum_forces_of_families(y,
                           bonds,
                           ends,
                           [&](const unsigned int   i,
                               const BondRows<dim> &rows,
                               const std::size_t    k,
                               const unsigned int   j,
                               const auto           has_family) {
                             constexpr bool        both   = decltype(has_family)::value;
                             const double *const   own    = numbers + n * i;
                             const Tensor<1, dim> &moment = rows.moments[k];
                             double                c      = own[at_stiffness];
                             Tensor<1, dim> force = times<dim>(own + at_force, moment), beside;
                             if (flows)
                               beside =
                                 own[at_slopes] * (both ? tangent.own.body : tangent.own.beyond)[k];
                             if constexpr (both)
                               {
                                 const double *const far = numbers + n * j;
                                 c += far[at_stiffness];
                                 force += times<dim>(far + at_force, moment);
                                 if (flows)
                                   beside += far[at_slopes] * tangent.far.body[k];
                               }
                             return force + shapes.weights().of(&rows == &bonds.beyond)[k] *
                                              (c * ends.change(values, i, j) + beside);
                           });
  }


  template <int dim>
  NodalTensors<dim> Correspondence<dim>::tensors(const Vector &u) const
  {
    if (!is_of(trial, u, is_linear()))
      find(u);
    NodalTensors<dim> result;
    for (unsigned int i = 0; i < shapes.size(); ++i)
      {
        const StressLaw::Tensor stress = stresses.cauchy(i, trial.slopes[i]);
        result.stress.push_back(in_body<dim>(stress));
        result.strain.push_back(stresses.strain(trial.slopes[i]));
        if (dim == 2)
          result.out_of_plane.push_back(stress[2][2]);
      }
    return result;
  }


  template <int dim>
  std::size_t Correspondence<dim>::memory_consumption() const
  {
    return stresses.memory_consumption() + shapes.memory_consumption() +
           (lattice.sums ? lattice.sums->memory_consumption() : 0) +
           (lattice.histories ? lattice.histories->memory_consumption() : 0) +
           (trial.squares.capacity() + trial.ratios.capacity() + trial.products.capacity() +
            tangent.products.capacity()) *
             sizeof(double) +
           trial.slopes.capacity() * sizeof(trial.slopes[0]) +
           trial.pulls.capacity() * sizeof(trial.pulls[0]) +
           tangent.pulls.capacity() * sizeof(tangent.pulls[0]) +
           tangent.flows.capacity() * sizeof(Flow) + tangent.own.memory_consumption() +
           tangent.far.memory_consumption() + trial.numbers.memory_consumption() +
           tangent.changes.memory_consumption() + trial.displacement.memory_consumption() +
           trial.forces.memory_consumption() + accepted.displacement.memory_consumption() +
           accepted.forces.memory_consumption();
  }


  PERIDEAL_INSTANTIATE_CLASS(class Correspondence);
} // namespace PeriDeal
