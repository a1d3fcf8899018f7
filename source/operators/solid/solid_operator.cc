// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/interleaved.h>
#include <perideal/base/matrix_rows.h>
#include <perideal/base/node_loops.h>
#include <perideal/base/place_text.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/bounds/spectrum.h>
#include <perideal/operators/solid/solid_operator.h>
#include <perideal/operators/solid/thermal_strains.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    bool loads_depend_on_time(const BodyParameters<dim> &body)
    {
      const auto &force = body.initial_and_source.body_force;
      bool        any   = std::any_of(force.begin(), force.end(), [](const Expression &e) {
        return e.depends_on_time();
      });
      for (const VectorCondition &condition : body.boundary_conditions.traction)
        for (const auto &value : condition.values)
          any = any || (value && value->depends_on_time());
      return any;
    }
  } // namespace


  template <int dim>
  void SolidOperator<dim>::require(const BodyParameters<dim> &body)
  {
    const Domain<dim>       &domain    = body.domain;
    const MaterialProperty  &expansion = body.material.thermal_expansion;
    const ElasticityControl &control   = body.elasticity;
    control.refuse(
      (control.computes_temperature || !is_zero(control.temperature_change)) &&
        expansion.is_constant() && expansion.value(Point<dim>()) == 0. &&
        !(body.material.breaks() && limit_of_bonds(body.material).depends_on_temperature()) &&
        !body.material.law.yield_depends_on_temperature() &&
        !body.material.given.depend_on_temperature() &&
        body.material.law.kind != SolidLaw::user, // which is told the temperature
      "Temperature change",
      "has no effect: 'Thermal expansion' in section 'Material' is 0.");
    domain.refuse(
      domain.has_extra_layers() && control.computes_temperature,
      "Extra layers",
      "cannot be used with 'Temperature change = computed' in section 'Elasticity', whose heat would flow through them. Use 0, or a formula there.");
    for (const CrackPiece<dim> &piece : body.cracks.pieces(body.cracks.end_time))
      for (const Point<dim> &p : piece.corners)
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double slack = 1e-9 * (domain.extra.body_upper[d] - domain.extra.body_lower[d]);
            domain.refuse(
              (domain.extra.layers[2 * d] > 0 && p[d] < domain.extra.body_lower[d] + slack) ||
                (domain.extra.layers[2 * d + 1] > 0 && p[d] > domain.extra.body_upper[d] - slack),
              "Extra layers",
              "a crack ends at a side of the body that has some, and would be closed by them. Leave them out at that side.");
          }
    DisplacementConditions<dim>::require(body);
  }


  template <int dim>
  SolidOperator<dim>::SolidOperator(const BodyParameters<dim> &body, const Layout &of_nodes)
    : body(body)
    , history(body.crack_history())
    , cracks_of(history.representative(0.))
    , loads_vary(loads_depend_on_time(body))
    , contact(std::make_unique<SolidContact>())
  {
    constexpr unsigned int soon = 5; // steps within which soft bodies may deform much
    const SolidLaw         kind = body.material.law.kind;
    if (kind == SolidLaw::hyperelastic ||
        (kind == SolidLaw::user && body.elasticity.has_full_kinematics()))
      this->stepping.between_looks = soon;
    if (of_nodes)
      set_layout(of_nodes);
  }


  template <int dim>
  void SolidOperator<dim>::set_layout(const Layout &of_nodes)
  {
    nodes = this->nodal.layout = of_nodes;
    unknowns                   = interleaved(*nodes, dim);
    for (Vector *v : {&mass, &stiffness_diagonal, &thermal_loads, &constant_loads, &scratch})
      initialize_vector(*v);
  }


  template <int dim>
  void SolidOperator<dim>::surrogate(TrilinosWrappers::SparseMatrix &matrix) const
  {
    if (latest.matrix)
      {
        matrix.copy_from(*latest.matrix);
        latest.matrix.reset();
        return;
      }
    latest.diagonal.reinit(0);
    latest.is_made   = true;
    latest.cracks_of = cracks_of;
    surrogate_made();
    assemble_surrogate(matrix);
    // Rows of contact change as bonds break and cracks grow: a run that goes on could not make the
    // same ones.
    if (!this->may_release_energy())
      add_contact(matrix);
  }


  template <int dim>
  void SolidOperator<dim>::add_contact(TrilinosWrappers::SparseMatrix &matrix) const
  {
    std::map<types::global_dof_index, std::map<types::global_dof_index, double>> added;
    const Vector held = held_unknowns();
    contact->add_to_surrogate(
      [&](const unsigned int row, const unsigned int column, const double value) {
        if (held.local_element(row) == 0. && held.local_element(column) == 0.)
          added[unknowns->local_to_global(row)][unknowns->local_to_global(column)] += value;
      },
      !latest.contact_is_loaded);
    latest.contact_is_loaded = false;
    const MPI_Comm all       = unknowns->get_mpi_communicator();
    if (Utilities::MPI::max(added.empty() ? 0 : 1, all) == 0)
      return;
    const IndexSet owned = unknowns->locally_owned_range();
    IndexSet       written(owned);
    written.add_indices(unknowns->ghost_indices());
    TrilinosWrappers::SparsityPattern pattern(owned, owned, written, all);
    for_each_entry(matrix, [&](const unsigned int i, const auto column, const double) {
      pattern.add(unknowns->local_to_global(i), column);
    });
    for (const auto &[row, entries] : added)
      for (const auto &entry : entries)
        pattern.add(row, entry.first);
    pattern.compress();
    TrilinosWrappers::SparseMatrix sum;
    sum.reinit(pattern);
    for_each_entry(matrix, [&](const unsigned int i, const auto column, const double value) {
      sum.add(unknowns->local_to_global(i), column, value);
    });
    for (const auto &[row, entries] : added)
      for (const auto &[column, value] : entries)
        sum.add(row, column, value);
    sum.compress(VectorOperation::add);
    matrix.copy_from(sum);
  }


  template <int dim>
  void SolidOperator<dim>::take_loaded(const double time)
  {
    if (const auto change = history.change(cracks_of, time))
      take(*change, nullptr);
  }


  template <int dim>
  void SolidOperator<dim>::exchange(Archive &archive, const NodeKeys &keys)
  {
    double time = cracks_of;
    archive.exchange("has surrogate", latest.is_made);
    if (history.changes_ever())
      {
        double first = history.representative(0.);
        archive.exchange("cracks of the start", first);
        AssertThrow(first == history.representative(0.),
                    UserError("The cracks grow in other steps than those of the checkpoint. Go on "
                              "with the same 'End time' in section 'Time'."));
        archive.exchange("cracks of", time);
        archive.exchange("cracks of the surrogate", latest.cracks_of);
        archive.exchange("released by growth", this->released_beside.by_growth);
      }
    if (history.changes_ever() || this->brittle()) // a zone follows cracks, or stretches
      archive.exchange("released by joining", this->released_beside.by_joining);
    const auto keep_surrogate = [&]() {
      if (!latest.is_made)
        return;
      take_loaded(latest.cracks_of);
      latest.matrix = std::make_shared<TrilinosWrappers::SparseMatrix>();
      assemble_surrogate(*latest.matrix);
      latest.diagonal = stiffness_diagonal;
    };
    exchange_bonds(archive, keys, keep_surrogate);
    if (archive.loads() && history.changes_ever())
      {
        if (latest.cracks_of != time && !latest.matrix)
          keep_surrogate();
        take_loaded(time);
      }
    ElasticOperator::exchange(archive, keys); // contact is that of its temperature
    if (archive.loads())
      contact->renew();
    contact->exchange(archive, keys);
    if (archive.loads())
      latest.contact_is_loaded = latest.is_made;
    conditions->exchange(archive, keys);
  }


  template <int dim>
  void SolidOperator<dim>::take(const ChangeSet<dim> &change, const Vector *u)
  {
    try
      {
        double before = u ? this->energy(*u) : 0.;
        if (join_zone(change) && u)
          {
            const double joined = this->energy(*u);
            this->released_beside.by_joining += before - joined;
            before = joined;
          }
        apply_change(change, u == nullptr);
        contact->renew();
        if (u)
          update_contact(*u);
        this->released_beside.by_growth += u ? before - this->energy(*u) : 0.;
      }
    catch (const UserError &fault)
      {
        std::ostringstream message;
        message << "With the cracks as they are from t = " << change.since
                << " on: " << fault.message();
        throw UserError(message.str());
      }
    cracks_of = change.to;
  }


  template <int dim>
  bool SolidOperator<dim>::grow_cracks(const Vector &u, const double t)
  {
    const auto change = history.change(cracks_of, t);
    if (!change || change->to < cracks_of) // what has been cut stays cut
      return false;
    take(*change, &u);
    return true;
  }


  template <int dim>
  void SolidOperator<dim>::set_contact(std::unique_ptr<SolidContact> new_contact)
  {
    contact           = std::move(new_contact);
    this->has_contact = true;
    set_contact_strains();
    contact->renew();
  }


  template <int dim>
  void SolidOperator<dim>::set_contact_strains()
  {
    contact->set_strains(is_warm() ?
                           [this](const unsigned int node) { return thermal_strain_at(node); } :
                           std::function<double(const unsigned int)>());
  }


  template <int dim>
  bool SolidOperator<dim>::update_contact(const Vector &u)
  {
    double     gained  = 0.;
    const bool changes = contact->update(u, gained);
    take_released(-gained);
    return changes;
  }


  template <int dim>
  void SolidOperator<dim>::apply(Vector &y, const Vector &x) const
  {
    ++this->applications;
    this->multiply(y, x);
    contact->add_tangent(y, x);
    conditions->mask(y);
  }


  template <int dim>
  void SolidOperator<dim>::residual(Vector &r, const Vector &u, const double t) const
  {
    unbalanced(r, u, t);
    conditions->mask(r);
  }


  template <int dim>
  void SolidOperator<dim>::unbalanced(Vector &r, const Vector &u, const double t) const
  {
    ++this->applications;
    find_forces(r, u, t);
    contact->add_forces(r, u, 1.);
    const bool vary = loads_vary || this->stepping.scales_loads;
    if (vary)
      find_loads(scratch, t);
    NodeLoops::subtract_from(r.begin(),
                             (vary ? scratch : constant_loads).begin(),
                             r.locally_owned_size());
  }


  template <int dim>
  void SolidOperator<dim>::mechanical_loads(Vector &loads, const double t) const
  {
    find_loads(loads, t);
    loads -= thermal_loads;
  }


  template <int dim>
  Vector SolidOperator<dim>::held_unknowns() const
  {
    Vector held(unknowns);
    conditions->mask(held, 1.);
    held.update_ghost_values();
    return held;
  }

  template <int dim>
  std::string SolidOperator<dim>::place_of(const unsigned int local_index) const
  {
    return place_text(position(local_index / dim));
  }

  template <int dim>
  void SolidOperator<dim>::fill_noise(Vector &vector) const
  {
    for (unsigned int i = 0; i < vector.locally_owned_size(); ++i)
      vector.local_element(i) = position_noise(position(i / dim)) * (1. + i % dim);
  }


  template <int dim>
  double SolidOperator<dim>::thermal_strain_at(const unsigned int node) const
  {
    const Point<dim> &p = position(node);
    return thermal_strain(body,
                          p,
                          temperature_change_of(body, p, this->temperature_change(), node));
  }


  template <int dim>
  bool SolidOperator<dim>::is_warm() const
  {
    return this->temperature_change().size() > 0 || !is_zero(body.elasticity.temperature_change);
  }


  template <int dim>
  std::vector<Vector> SolidOperator<dim>::near_null_space() const
  {
    // Rotations about the middle of the body's nodes, of a size near one.
    const unsigned int n_nodes = mass.locally_owned_size() / dim;
    Point<dim>         sum;
    double             n = n_nodes;
    for (unsigned int i = 0; i < n_nodes; ++i)
      sum += position(i);
    const MPI_Comm communicator = mass.get_mpi_communicator();
    const auto total = Utilities::MPI::sum(static_cast<const Tensor<1, dim> &>(sum), communicator);
    const Point<dim> middle(total / Utilities::MPI::sum(n, communicator));
    double           farthest = 0.;
    for (unsigned int i = 0; i < n_nodes; ++i)
      farthest = std::max(farthest, position(i).distance(middle));
    farthest = Utilities::MPI::max(farthest, communicator);
    std::vector<Vector> motions;
    for (unsigned int d = 0; d < dim; ++d)
      {
        motions.emplace_back(unknowns);
        for (unsigned int i = 0; i < n_nodes; ++i)
          motions.back().local_element(dim * i + d) = 1.;
      }
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a + 1; b < dim; ++b)
        {
          motions.emplace_back(unknowns);
          for (unsigned int i = 0; i < n_nodes; ++i)
            {
              const Tensor<1, dim> x                    = (position(i) - middle) / farthest;
              motions.back().local_element(dim * i + a) = -x[b];
              motions.back().local_element(dim * i + b) = x[a];
            }
        }
    return motions;
  }


  PERIDEAL_INSTANTIATE_CLASS(class SolidOperator);
} // namespace PeriDeal
