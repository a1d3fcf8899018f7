// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/interleaved.h>
#include <perideal/base/place_text.h>
#include <perideal/base/smallest_eigenvalue.h>
#include <perideal/base/user_error.h>
#include <perideal/base/worst_trip.h>
#include <perideal/laws/linear_stress.h>
#include <perideal/operators/solid/correspondence.h>
#include <perideal/operators/solid/stress_laws.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "family_sums.h"
#include "large_deformation.h"

// A node knows its gradient and its law, a bond what both of its nodes make of them.

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    SymmetricTensor<2, dim> in_body(const StressLaw::Tensor &full)
    {
      SymmetricTensor<2, dim> part;
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = a; b < dim; ++b)
          part[a][b] = full[a][b];
      return part;
    }


    template <int dim>
    SymmetricTensor<4, dim> in_body(const StressLaw::Tangent &full)
    {
      SymmetricTensor<4, dim> part;
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = a; b < dim; ++b)
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int d = c; d < dim; ++d)
              part[a][b][c][d] = full[a][b][c][d];
      return part;
    }


    /** Of a stiffness, or a compliance: the shear modulus of its mean over all directions. */
    template <int dim>
    double mean_shear(const SymmetricTensor<4, dim> &C)
    {
      if (dim == 1)
        return 0.5 * C[0][0][0][0];
      double trace = 0., of_volume = 0.;
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = 0; b < dim; ++b)
          {
            trace += C[a][b][a][b];
            of_volume += C[a][a][b][b];
          }
      return (trace - of_volume / dim) / (dim * (dim + 1.) - 2.);
    }


    /** A shear modulus by which no shear is much stiffer than in the body: Reuss's mean. */
    template <int dim>
    double soft_shear(const SymmetricTensor<4, dim> &C)
    {
      return 0.25 / mean_shear(invert(C));
    }


    /** The largest eigenvalue of a stiffness as a map of strains. */
    template <int dim>
    double largest_modulus(const SymmetricTensor<4, dim> &C)
    {
      constexpr unsigned int      n = SymmetricTensor<2, dim>::n_independent_components;
      Eigen::Matrix<double, n, n> matrix;
      for (unsigned int k = 0; k < n; ++k)
        for (unsigned int l = 0; l < n; ++l)
          {
            const auto a = SymmetricTensor<2, dim>::unrolled_to_component_indices(k),
                       b = SymmetricTensor<2, dim>::unrolled_to_component_indices(l);
            matrix(k, l) = (k < dim ? 1. : std::sqrt(2.)) * (l < dim ? 1. : std::sqrt(2.)) *
                           C[a[0]][a[1]][b[0]][b[1]];
          }
      return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, n, n>>(matrix,
                                                                        Eigen::EigenvaluesOnly)
        .eigenvalues()[n - 1];
    }


    template <int dim>
    void write(double *numbers, const Tensor<2, dim> &tensor)
    {
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = 0; b < dim; ++b)
          numbers[dim * a + b] = tensor[a][b];
    }


    template <int dim>
    Tensor<1, dim> times(const double *numbers, const Tensor<1, dim> &vector)
    {
      Tensor<1, dim> product;
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = 0; b < dim; ++b)
          product[a] += numbers[dim * a + b] * vector[b];
      return product;
    }


    template <int dim>
    Tensor<1, dim> vector_at(const double *numbers)
    {
      Tensor<1, dim> vector;
      for (unsigned int a = 0; a < dim; ++a)
        vector[a] = numbers[a];
      return vector;
    }


    /** The sum of du (W xi)^T over the family of a node. */
    template <int dim>
    Tensor<2, dim> sum_of_changes(const BondTable<dim> &bonds,
                                  const BondEnds<dim>  &ends,
                                  const double         *u,
                                  const unsigned int    i,
                                  const Span           &inside,
                                  const Span           &outside)
    {
      Tensor<2, dim> sum;
      const auto     add = [&](const BondRows<dim> &rows, const std::size_t k) {
        const double *const   far    = ends.value(u, rows.neighbors[k]);
        const Tensor<1, dim> &moment = rows.moments[k];
        for (unsigned int a = 0; a < dim; ++a)
          {
            const double change = far[a] - u[dim * i + a];
            for (unsigned int b = 0; b < dim; ++b)
              sum[a][b] += change * moment[b];
          }
      };
      for (std::size_t k = inside.begin; k < inside.end; ++k)
        add(bonds.body, k);
      for (std::size_t k = outside.begin; k < outside.end; ++k)
        add(bonds.beyond, k);
      return sum;
    }


    /** visit(rows, k) of a family. */
    template <int dim, typename Visit>
    void for_each_bond(const BondTable<dim> &bonds,
                       const Span           &inside,
                       const Span           &outside,
                       const Visit          &visit)
    {
      for (std::size_t k = inside.begin; k < inside.end; ++k)
        visit(bonds.body, k);
      for (std::size_t k = outside.begin; k < outside.end; ++k)
        visit(bonds.beyond, k);
    }
  } // namespace


  template <int dim>
  Correspondence<dim>::Correspondence(const Families<dim>       &families,
                                      const BondEnds<dim>       &ends,
                                      BondTable<dim>            &bonds,
                                      const NodeLaws<dim>       &laws,
                                      const ThermalStrains      &thermal,
                                      const BodyParameters<dim> &body)
    : families(families)
    , ends(ends)
    , bonds(bonds)
    , laws(laws)
    , thermal(thermal)
    , steps(StressSteps::of_scene(body))
  {
    Assert(!bonds.body.is_packed() && !bonds.beyond.is_packed(), ExcInternalError());
    const Nodes<dim>    &nodes  = families.nodes();
    PlacedStressLaw<dim> placed = stress_law_of(body);
    if (!placed.law)
      placed = linear_stress_law(body);
    law.law       = std::move(placed.law);
    law.j2        = dynamic_cast<const J2Plasticity *>(law.law.get());
    law.is_linear = dynamic_cast<const LinearStress *>(law.law.get()) != nullptr;
    law.is_full   = body.elasticity.has_full_kinematics();
    std::string message;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const Point<dim> &p = nodes.position(i);
        if (law.j2 != nullptr && message.empty() &&
            !(body.material.law.yield_stress->value(p) > 0.))
          message =
            body.material.where("Yield stress") + " is out of range at " + place_text(p) + ".";
        const std::vector<double> here = placed.parameters(p);
        law.parameters.insert(law.parameters.end(), here.begin(), here.end());
      }
    throw_on_all_if_any(nodes.communicator(), message);
    law.states.resize(nodes.n_owned() * law.law->n_state(), 0.);
    trial.states = law.states;
    trial.responses.resize(nodes.n_owned());
    trial.slopes.resize(nodes.n_owned());
    trial.squares.resize(nodes.n_owned(), 0.);
    trial.ratios.resize(nodes.n_owned(), 1.);
    shapes.resize(nodes.n_owned());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        typename J2Plasticity::Beside none;
        ask(i, 0., &shapes[i].elastic, none);
        if (steps.fault.empty()) // else it is zero
          shapes[i].shear = soft_shear(shapes[i].elastic);
      }
    steps.throw_faults(*law.law, nodes.communicator());
    weights.resize(bonds);
    std::vector<unsigned int> all(nodes.n_owned());
    std::iota(all.begin(), all.end(), 0U);
    renew(all);
    const auto with = [&](const unsigned int n) { return interleaved(*nodes.partitioner(), n); };
    trial.numbers.reinit(with(law.j2 != nullptr ? n_of_flow : n_numbers));
    tangent.changes.reinit(with(law.j2 != nullptr ? n_numbers + 1 : n_numbers));
    const auto unknowns = with(dim);
    trial.displacement.reinit(unknowns);
    if (law.is_linear)
      return;
    for (Vector *v : {&trial.forces, &accepted.displacement, &accepted.forces})
      v->reinit(unknowns);
    trial.changes.resize(bonds);
  }


  template <int dim>
  void Correspondence<dim>::renew(const std::vector<unsigned int> &nodes)
  {
    // Of bonds that have broken too few may be left for a gradient, and those that are would make
    // the node so stiff that steps are no longer stable. At a face of a crack half of M is left.
    constexpr double few = 0.35;
    trial.known          = false;
    for (const unsigned int i : nodes)
      {
        Full M;
        bool lost = false;
        bonds.for_each(i, [&](const auto &bond) {
          const Tensor<1, dim> xi        = ends.vector(i, bond.neighbor);
          const bool           is_beyond = &bonds.rows_of(bond.number) == &bonds.beyond;
          (is_beyond ? weights.beyond : weights.body)[bonds.place(bond.number)] =
            (bond.moment * xi) / xi.norm_square();
          M += symmetrize(outer_product(bond.moment, xi));
          lost = lost || !bonds.is_whole(bond.number);
        });
        Shape       &shape = shapes[i];
        const double q     = laws.weighted.local_element(i);
        const bool   holds = !lost ||
                           dim * smallest_eigenvalue(M) > few * q * families.nodes().volume(i);
        shape.inverse    = holds ? invert(M) : Full();
        shape.stabilizer = holds ? dim * (dim + 2.) * shape.shear / q : 0.;
      }
  }


  template <int dim>
  void Correspondence<dim>::ask(const unsigned int             i,
                                const double                   beside,
                                SymmetricTensor<4, dim>       *of_tangent,
                                typename J2Plasticity::Beside &flow) const
  {
    Full strain = law.is_full ? strain_of(trial.slopes[i]) : symmetrize(trial.slopes[i]);
    for (unsigned int d = 0; thermal.any() && d < dim; ++d)
      strain[d][d] -= thermal[i];
    StressLaw::Tangent  full;
    StressLaw::Tangent *wanted = of_tangent == nullptr ? nullptr : &full;
    StressLaw::Trial    at{in_space<dim>(strain),
                        law.parameters.data() + i * law.law->n_parameters(),
                        law.states.data() + i * law.law->n_state()};
    at.length          = std::pow(families.nodes().volume(i), 1. / dim);
    at.element         = families.nodes().partitioner()->local_to_global(i);
    const double ratio = law.is_full ? determinant(deformation_of(trial.slopes[i])) : 1.;
    if (!(ratio > 0.))
      {
        trial.responses[i] = StressLaw::Response();
        return keep_lower(trial.inverted,
                          turned_inside_out(families.nodes().position(i), ratio, steps.now));
      }
    double *const next = trial.states.data() + i * law.law->n_state();
    flow.square        = beside;
    trial.responses[i] = law.j2 != nullptr ? law.j2->update_with(flow, at, next, wanted) :
                                             steps.update(*law.law, at, next, wanted);
    if (of_tangent != nullptr)
      *of_tangent = in_body<dim>(full);
  }


  template <int dim>
  void Correspondence<dim>::find_at(const double      *u,
                                    const unsigned int i,
                                    const Span        &inside,
                                    const Span        &outside) const
  {
    const bool            flows = law.j2 != nullptr;
    const Shape          &shape = shapes[i];
    const Tensor<2, dim>  inverse(shape.inverse);
    const Tensor<2, dim> &slopes = trial.slopes[i] =
      sum_of_changes(bonds, ends, u, i, inside, outside) * inverse;
    double squares = 0.;
    for_each_bond(bonds, inside, outside, [&](const BondRows<dim> &rows, const std::size_t k) {
      const bool   is_beyond = &rows == &bonds.beyond;
      const double w         = weights.of(is_beyond)[k];
      if (w == 0.)
        return;
      const Tensor<1, dim> change = ends.change(u, i, rows.neighbors[k]);
      Tensor<1, dim>       beside = change - slopes * rows.moments[k] / w;
      if (flows)
        {
          (is_beyond ? trial.changes.beyond : trial.changes.body)[k] = change;
          beside -= vector_at<dim>(&rows.nonlinear.history[n_history * k]);
        }
      squares += w * beside.norm_square();
    });
    typename J2Plasticity::Beside flow;
    const double                  volume = families.nodes().volume(i);
    ask(i, 3. * shape.shear * shape.stabilizer / volume * squares, nullptr, flow);
    trial.squares[i]       = squares;
    trial.ratios[i]        = flow.ratio;
    double *const  numbers = trial.numbers.begin() + (flows ? n_of_flow : n_numbers) * i;
    const double   c       = shape.stabilizer * flow.ratio;
    Tensor<2, dim> stress(in_body<dim>(trial.responses[i].stress));
    if (law.is_full)
      stress = deformation_of(slopes) * stress;
    write(numbers + at_force, Tensor<2, dim>(volume * (stress * inverse) - c * slopes));
    numbers[at_stiffness] = c;
    if (!flows)
      return;
    write(numbers + at_slopes, slopes);
    numbers[at_lost] = 1. - flow.ratio;
  }


  template <int dim>
  void Correspondence<dim>::find(const Vector &u) const
  {
    u.update_ghost_values();
    const double *const values = u.begin();
    ends.find(values);
    trial.inverted = Trip();
    for_each_family(bonds, [&](const unsigned int i, const Span &inside, const Span &outside) {
      find_at(values, i, inside, outside);
    });
    u.set_ghost_state(false);
    steps.throw_faults(*law.law, families.nodes().communicator());
    if (law.is_full)
      throw_lowest_if_any(families.nodes().communicator(), trial.inverted);
    trial.numbers.update_ghost_values();
    std::copy(values, values + u.locally_owned_size(), trial.displacement.begin());
    trial.known      = true;
    trial.has_forces = false;
  }


  template <int dim>
  bool Correspondence<dim>::knows(const Vector &u) const
  {
    const bool same =
      !law.is_linear && trial.known && // else thermal strains may be other ones
      std::equal(u.begin(), u.begin() + u.locally_owned_size(), trial.displacement.begin());
    return Utilities::MPI::min(same ? 1 : 0, families.nodes().communicator()) > 0;
  }


  template <int dim>
  void Correspondence<dim>::find_forces(Vector &y, const Vector &u, const double t) const
  {
    steps.now   = t;
    trial.known = false;
    find(u);
    u.update_ghost_values();
    const double *const values  = u.begin();
    const double *const numbers = trial.numbers.begin();
    const unsigned      n       = law.j2 != nullptr ? n_of_flow : n_numbers;
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
        const double          w      = weights.of(&rows == &bonds.beyond)[k];
        const Tensor<1, dim>  change = ends.change(values, i, j);
        Tensor<1, dim> force = times<dim>(own + at_force, moment) + w * own[at_stiffness] * change;
        const double *const plastic = law.j2 != nullptr ? &rows.nonlinear.history[n_history * k] :
                                                          nullptr;
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
    if (law.is_linear)
      return;
    std::copy(y.begin(), y.begin() + y.locally_owned_size(), trial.forces.begin());
    trial.has_forces = true;
  }


  template <int dim>
  double Correspondence<dim>::energy_of(const std::vector<unsigned int> &list,
                                        const Vector                    &u) const
  {
    if (law.is_linear)
      {
        u.update_ghost_values();
        ends.find(u.begin());
        for (const unsigned int i : list)
          find_at(u.begin(), i, span_of(bonds.body, i), span_of(bonds.beyond, i));
        u.set_ghost_state(false);
      }
    else if (!knows(u))
      find(u);
    double sum = 0.;
    for (const unsigned int i : list)
      {
        sum += families.nodes().volume(i) * trial.responses[i].stored;
        if (law.j2 == nullptr) // which stores it itself
          sum += 0.5 * shapes[i].stabilizer * trial.squares[i];
      }
    return Utilities::MPI::sum(sum, families.nodes().communicator());
  }


  template <int dim>
  double Correspondence<dim>::energy(const Vector &u) const
  {
    return energy_of(bonds.body.nodes, u);
  }


  template <int dim>
  double Correspondence<dim>::plastic_work(const Vector &u) const
  {
    if (!knows(u))
      find(u);
    double sum = 0.;
    for (unsigned int i = 0; i < shapes.size(); ++i)
      sum += families.nodes().volume(i) * trial.responses[i].dissipated;
    return Utilities::MPI::sum(sum, families.nodes().communicator());
  }


  template <int dim>
  double Correspondence<dim>::accept(const Vector &u, const double t)
  {
    if (law.is_linear)
      return 0.;
    if (law.is_full) // which remembers and dissipates nothing
      {
        steps.accept(t, false);
        return 0.;
      }
    if (!knows(u) || !trial.has_forces || steps.now != t)
      {
        Vector y(trial.forces);
        find_forces(y, u, t);
      }
    double stored = 0., n_flow = 0.;
    for (unsigned int i = 0; i < shapes.size(); ++i)
      {
        stored += families.nodes().volume(i) * trial.responses[i].stored;
        if (law.j2 == nullptr)
          stored += 0.5 * shapes[i].stabilizer * trial.squares[i];
        n_flow += law.j2 == nullptr || trial.ratios[i] < 1. ? 1. : 0.;
      }
    bool         flows = false;
    const double dissipated =
      accepted.take(u, trial.forces, stored, n_flow, families.nodes().communicator(), flows);
    const double changes = trial.known && law.states != trial.states ? 1. : 0.;
    if (flows && trial.known)
      remember();
    steps.accept(t, Utilities::MPI::max(changes, families.nodes().communicator()) > 0.);
    return dissipated;
  }


  template <int dim>
  void Correspondence<dim>::remember()
  {
    law.states  = trial.states;
    trial.known = false;
    if (law.j2 == nullptr)
      return;
    const double *const numbers = trial.numbers.begin();
    const auto          keep    = [&](const unsigned int    node,
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
    for_each_family(bonds, [&](const unsigned int i, const Span &inside, const Span &outside) {
      for (std::size_t k = inside.begin; k < inside.end; ++k)
        {
          const Tensor<1, dim> xi      = bonds.body.moments[k] / weights.body[k];
          double *const        plastic = &bonds.body.nonlinear.history[n_history * k];
          keep(i, trial.changes.body[k], xi, plastic);
          keep(bonds.body.neighbors[k], trial.changes.body[k], xi, plastic + dim);
        }
      for (std::size_t k = outside.begin; k < outside.end; ++k)
        if (weights.beyond[k] > 0.)
          keep(i,
               trial.changes.beyond[k],
               bonds.beyond.moments[k] / weights.beyond[k],
               &bonds.beyond.nonlinear.history[n_history * k]);
    });
  }


  template <int dim>
  void Correspondence<dim>::exchange(Archive &archive, const NodeKeys &keys)
  {
    if (law.is_linear)
      return;
    const unsigned int n_state = law.law->n_state();
    Vector             number(families.nodes().partitioner());
    for (unsigned int s = 0; s < n_state; ++s)
      {
        for (unsigned int i = 0; i < shapes.size(); ++i)
          number.local_element(i) = law.states[n_state * i + s];
        archive.exchange("state " + std::to_string(s), number, keys);
        for (unsigned int i = 0; i < shapes.size(); ++i)
          law.states[n_state * i + s] = number.local_element(i);
      }
    accepted.exchange(archive, keys);
    steps.exchange(archive);
    if (law.j2 != nullptr)
      exchange_histories(bonds, archive, keys, n_history);
    if (archive.loads())
      trial.known = false;
  }


  template <int dim>
  void Correspondence<dim>::linearize(const Vector &u)
  {
    if (law.is_linear)
      return;
    if (!knows(u))
      find(u);
    double n_flow = 0.;
    tangent.flows.resize(shapes.size());
    for (unsigned int i = 0; i < shapes.size(); ++i)
      {
        Flow                         &at = tangent.flows[i];
        typename J2Plasticity::Beside flow;
        ask(i,
            3. * shapes[i].shear * shapes[i].stabilizer / families.nodes().volume(i) *
              trial.squares[i],
            &at.stiffness,
            flow);
        at.stress_slope = in_body<dim>(flow.stress_slope);
        at.ratio        = flow.ratio;
        at.ratio_slope  = flow.ratio_slope;
        at.deformation  = deformation_of(trial.slopes[i]);
        at.stress       = in_body<dim>(trial.responses[i].stress);
        n_flow += law.j2 == nullptr || flow.ratio < 1. ? 1. : 0.;
      }
    steps.throw_faults(*law.law, families.nodes().communicator());
    tangent.any = Utilities::MPI::max(n_flow, families.nodes().communicator()) > 0.;
    if (!tangent.any || law.j2 == nullptr)
      return;
    const double *const numbers = trial.numbers.begin();
    tangent.own.resize(bonds);
    tangent.far.resize(bonds);
    for_each_family(bonds, [&](const unsigned int i, const Span &inside, const Span &outside) {
      for_each_bond(bonds, inside, outside, [&](const BondRows<dim> &rows, const std::size_t k) {
        const bool is_beyond = &rows == &bonds.beyond;
        if (weights.of(&rows == &bonds.beyond)[k] == 0.)
          return;
        const Tensor<1, dim> xi     = rows.moments[k] / weights.of(&rows == &bonds.beyond)[k],
                             change = is_beyond ? trial.changes.beyond[k] : trial.changes.body[k];
        const double *const plastic = &rows.nonlinear.history[n_history * k];
        const auto          elastic = [&](const unsigned int node, const double *of_end) {
          return change - times<dim>(numbers + n_of_flow * node + at_slopes, xi) -
                 vector_at<dim>(of_end);
        };
        (is_beyond ? tangent.own.beyond : tangent.own.body)[k] = elastic(i, plastic);
        if (!is_beyond)
          tangent.far.body[k] = elastic(rows.neighbors[k], plastic + dim);
      });
    });
  }


  template <int dim>
  void Correspondence<dim>::find_changes(const Vector &x) const
  {
    const bool          flows  = tangent.any && law.j2 != nullptr;
    const unsigned      n      = law.j2 != nullptr ? n_numbers + 1 : n_numbers;
    const double *const values = x.begin();
    ends.find(values);
    for_each_family(bonds, [&](const unsigned int i, const Span &inside, const Span &outside) {
      const Shape         &shape = shapes[i];
      const Tensor<2, dim> inverse(shape.inverse),
        slopes           = sum_of_changes(bonds, ends, values, i, inside, outside) * inverse;
      const bool is_full = tangent.any && law.is_full;
      const Full strain =
        symmetrize(is_full ? transpose(tangent.flows[i].deformation) * slopes : slopes);
      Full         stress = (tangent.any ? tangent.flows[i].stiffness : shape.elastic) * strain;
      double       c = shape.stabilizer, of_ratio = 0.;
      const double volume = families.nodes().volume(i);
      if (const Flow *const at = flows ? &tangent.flows[i] : nullptr;
          at != nullptr && at->ratio < 1.)
        {
          double sum = 0.; // of W z_e . du
          for_each_bond(bonds,
                        inside,
                        outside,
                        [&](const BondRows<dim> &rows, const std::size_t k) {
                          sum += weights.of(&rows == &bonds.beyond)[k] *
                                 (tangent.own.of(&rows == &bonds.beyond)[k] *
                                  ends.change(values, i, rows.neighbors[k]));
                        });
          const double of_square = 6. * shape.shear * shape.stabilizer / volume * sum;
          stress += of_square * at->stress_slope;
          of_ratio = shape.stabilizer *
                     (6. * shape.shear * (at->stress_slope * strain) + at->ratio_slope * of_square);
          c *= at->ratio;
        }
      Tensor<2, dim> pull(stress);
      if (is_full)
        pull =
          tangent.flows[i].deformation * pull + slopes * Tensor<2, dim>(tangent.flows[i].stress);
      double *const numbers = tangent.changes.begin() + n * i;
      write(numbers + at_force, Tensor<2, dim>(volume * (pull * inverse) - c * slopes));
      numbers[at_stiffness] = c;
      if (law.j2 != nullptr)
        numbers[at_slopes] = of_ratio;
    });
    tangent.changes.update_ghost_values();
  }


  template <int dim>
  void Correspondence<dim>::multiply(Vector &y, const Vector &x) const
  {
    const bool     flows = tangent.any && law.j2 != nullptr;
    const unsigned n     = law.j2 != nullptr ? n_numbers + 1 : n_numbers;
    x.update_ghost_values();
    find_changes(x);
    const double *const values = x.begin(), *const numbers = tangent.changes.begin();
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
                             return force + weights.of(&rows == &bonds.beyond)[k] *
                                              (c * ends.change(values, i, j) + beside);
                           });
    x.set_ghost_state(false);
  }


  template <int dim>
  NodalTensors<dim> Correspondence<dim>::tensors(const Vector &u) const
  {
    if (!knows(u))
      find(u);
    NodalTensors<dim> result;
    for (unsigned int i = 0; i < shapes.size(); ++i)
      {
        const Tensor<2, dim>      &slopes   = trial.slopes[i];
        const StressLaw::Response &response = trial.responses[i];
        result.stress.push_back(
          in_body<dim>(law.is_full ? cauchy_stress(slopes, response) : response.stress));
        result.strain.push_back(law.is_full ? strain_of(slopes) : symmetrize(slopes));
      }
    return result;
  }


  template <int dim>
  double Correspondence<dim>::out_of_plane(const unsigned int i) const
  {
    const StressLaw::Response &response = trial.responses[i];
    return (law.is_full ? cauchy_stress(trial.slopes[i], response) : response.stress)[2][2];
  }


  template <int dim>
  std::vector<std::pair<std::string, std::vector<double>>> Correspondence<dim>::shown() const
  {
    std::vector<std::pair<std::string, std::vector<double>>> list;
    for (const auto &[name, number] : law.law->shown())
      {
        list.emplace_back(name, std::vector<double>());
        for (unsigned int i = 0; i < shapes.size(); ++i)
          list.back().second.push_back(law.states[i * law.law->n_state() + number]);
      }
    return list;
  }


  template <int dim>
  void Correspondence<dim>::find_diagonal(Vector &diagonal) const
  {
    Vector sum(diagonal.get_partitioner());
    for_each_family(bonds, [&](const unsigned int i, const Span &inside, const Span &outside) {
      const Shape &shape = shapes[i];
      // A displacement along d of one node, which the gradient e_d b^T follows.
      const auto stiffness = [&](const unsigned int d, const Tensor<1, dim> &b) {
        double product = 0.;
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int c = 0; c < dim; ++c)
            product += b[a] * b[c] * shape.elastic[d][a][d][c];
        return families.nodes().volume(i) * product;
      };
      Tensor<1, dim> of_node;
      double         all = 0.;
      for_each_bond(bonds, inside, outside, [&](const BondRows<dim> &rows, const std::size_t k) {
        const Tensor<1, dim> &moment = rows.moments[k], b = shape.inverse * moment;
        const double          aside =
          shape.stabilizer * (weights.of(&rows == &bonds.beyond)[k] - b * moment);
        const unsigned int j = rows.neighbors[k];
        of_node += moment;
        all += weights.of(&rows == &bonds.beyond)[k];
        const auto add = [&](const unsigned int node, const unsigned int d, const double square) {
          sum.local_element(dim * node + d) += square * (stiffness(d, b) + aside);
        };
        if (!ends.is_fictitious(j))
          for (unsigned int d = 0; d < dim; ++d)
            add(j, d, 1.);
        else // as if these nodes had no other part in the family
          ends.images->for_each_term(ends.image(j), [&](const auto &term) {
            for (unsigned int d = 0; d < dim; ++d)
              add(term.node, d, term.of_component(d) * term.of_component(d));
          });
      });
      const Tensor<1, dim> b = shape.inverse * of_node;
      for (unsigned int d = 0; d < dim; ++d)
        sum.local_element(dim * i + d) += stiffness(d, b) + shape.stabilizer * (all - b * of_node);
    });
    sum.compress(VectorOperation::add);
    std::copy(sum.begin(), sum.begin() + sum.locally_owned_size(), diagonal.begin());
  }


  template <int dim>
  Vector Correspondence<dim>::row_sums() const
  {
    const Nodes<dim> &nodes = families.nodes();
    Vector            rows(nodes.partitioner());
    for_each_family(bonds, [&](const unsigned int i, const Span &inside, const Span &outside) {
      const Shape &shape   = shapes[i];
      double       modulus = largest_modulus(shape.elastic);
      if (tangent.any && law.is_full)
        modulus =
          largest_modulus(tangent.flows[i].stiffness) * tangent.flows[i].deformation.norm_square() +
          tangent.flows[i].stress.norm();
      const double kappa =
        std::max(shape.stabilizer,
                 modulus * nodes.volume(i) * -smallest_eigenvalue(-shape.inverse));
      for (std::size_t k = inside.begin; k < inside.end; ++k)
        {
          rows.local_element(i) += 2. * kappa * weights.body[k];
          rows.local_element(bonds.body.neighbors[k]) += 2. * kappa * weights.body[k];
        }
      for (std::size_t k = outside.begin; k < outside.end; ++k)
        {
          const FictitiousImages<dim> &images = *ends.images;
          const unsigned int           image  = ends.image(bonds.beyond.neighbors[k]);
          const double size = kappa * weights.beyond[k] * (1. + images.sum_of_factors(image));
          rows.local_element(i) += size;
          images.for_each_term(image, [&](const auto &term) {
            double largest = 0.;
            for (unsigned int d = 0; d < dim; ++d)
              largest = std::max(largest, std::abs(term.of_component(d)));
            rows.local_element(term.node) += size * largest;
          });
        }
    });
    rows.compress(VectorOperation::add);
    return rows;
  }


  template <int dim>
  std::size_t Correspondence<dim>::memory_consumption() const
  {
    const auto of = [](const Changes &list) {
      return (list.body.capacity() + list.beyond.capacity()) * sizeof(Tensor<1, dim>);
    };
    return (law.parameters.capacity() + law.states.capacity() + weights.body.capacity() +
            weights.beyond.capacity() + trial.squares.capacity() + trial.ratios.capacity() +
            trial.states.capacity()) *
             sizeof(double) +
           shapes.capacity() * sizeof(Shape) + tangent.flows.capacity() * sizeof(Flow) +
           trial.responses.capacity() * sizeof(trial.responses[0]) +
           trial.slopes.capacity() * sizeof(trial.slopes[0]) + of(trial.changes) + of(tangent.own) +
           of(tangent.far) + trial.numbers.memory_consumption() +
           tangent.changes.memory_consumption() + trial.displacement.memory_consumption() +
           trial.forces.memory_consumption() + accepted.displacement.memory_consumption() +
           accepted.forces.memory_consumption();
  }


  PERIDEAL_INSTANTIATE_CLASS(class Correspondence);
} // namespace PeriDeal
