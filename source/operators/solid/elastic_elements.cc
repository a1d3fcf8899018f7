// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/matrix_rows.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/bounds/spectrum.h>
#include <perideal/operators/coupling/nodal_family.h>
#include <perideal/operators/parts/element_layout.h>
#include <perideal/operators/parts/event_work.h>
#include <perideal/operators/parts/lumped_mass.h>
#include <perideal/operators/solid/elastic_elements.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/rules.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "inversion.h"
#include "loose_nodes.h"
#include "nodes_on_sides.h"
#include "with_ghosts.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    void set_all(ZoneBonds<dim> &bonds, const unsigned int n_owned, const CrackSideFactors &factors)
    {
      std::vector<unsigned int> owned(n_owned);
      std::iota(owned.begin(), owned.end(), 0);
      bonds.set_rows(owned, factors);
    }


    /** What shear of the cells stores by the law, or dissipates in the step. Collective. */
    template <typename Law>
    double shear_energy(const Law &law, const Vector &u, const bool dissipated)
    {
      double sum = 0.;
      for (unsigned int k = 0; k < law.nodal.steps->n_parts(dissipated); ++k)
        {
          law.nodal.find_part(law.change, u, k, dissipated);
          law.shear.multiply(law.forces, law.change);
          law.change.set_ghost_state(false);
          sum += 0.5 * (law.change * law.forces);
        }
      return sum;
    }


    /** Null, or families that stand beside the matrix. */
    template <int dim>
    NodalZone<dim> *nodal(const std::unique_ptr<SolidBondsBesideElements<dim>> &bonds)
    {
      return bonds ? bonds->nodal() : nullptr;
    }


    /** Of the tangents of cells, and of families. Collective. */
    template <int dim>
    bool has_symmetric_law(const ElasticCells<dim> &cells, const NodalZone<dim> *const families)
    {
      return (!cells.stresses || cells.stresses->has_symmetric_tangents()) &&
             (families == nullptr || families->have_symmetric_tangents());
    }


    /** Laws that know it. Collective. */
    template <int dim>
    void tell_damage(const ZoneBreaking<dim> &breaking, NodalLaw &law)
    {
      if (law.steps->knows_damage())
        law.damage = breaking.damage_with_ghosts();
    }
  } // namespace


  template <int dim>
  void ElasticElements<dim>::require(const BodyParameters<dim> &body, const bool coupled)
  {
    SolidOperator<dim>::require(body);
    refuse_law(body, true, coupled);
    if (coupled)
      SolidBondsBesideElements<dim>::require(body);
  }


  template <int dim>
  ElasticElements<dim>::ElasticElements(const DoFHandler<dim>         &dof_handler,
                                        const BodyParameters<dim>     &body,
                                        std::unique_ptr<Coupling<dim>> coupling)
    : SolidOperator<dim>(body, element_layout(dof_handler, coupling.get()))
    , zone_bonds(coupling ?
                   std::make_unique<SolidBondsBesideElements<dim>>(std::move(coupling), body) :
                   nullptr)
    , cells(dof_handler, body, zone_bonds.get(), this->temperature_change())
    , hanging(dof_handler, *nodes, dim)
    , mechanical(dof_handler, body, nodes, [this](const auto unknown) {
      return hanging.is_hanging(unknown);
    })
  {
    if (LawSteps(body.material.law, {"", MPI_COMM_SELF}).any())
      {
        Vector layout(unknowns);
        law = std::make_unique<Law>(Law{NodalLaw(body.material.law, layout), {}, layout, layout});
        cells.with_shear = law->nodal.relaxes();
      }
    if (zone_bonds && lists_bonds(body) && !has_nodal_law(body))
      {
        Coupling<dim> &zone = zone_bonds->coupling();
        breaking            = std::make_unique<ZoneBreaking<dim>>(
          zone,
          make_zone_bonds(zone, body, law ? &law->nodal : nullptr),
          dof_handler,
          body);
        this->initialize_vector(changes.forces);
      }
    positions.resize(nodes->locally_owned_size() + nodes->n_ghost_indices());
    if (zone_bonds)
      for (unsigned int i = 0; i < positions.size(); ++i)
        positions[i] = zone_bonds->nodes().position(i);
    else
      for_each_support_point(dof_handler, [&](const auto dof, const Point<dim> &p) {
        positions[nodes->global_to_local(dof)] = p;
      });
    // Where tips cut in part, ends on sides are none.
    cells.by_cracks.set(this->history.pieces(this->cracks_of, !body.cuts_in_part_at_tips()), 0.);
    find_conditions();
    if (cells.stresses)
      cells.stresses->take_temperatures(body, this->temperature_change());
    assemble(false);
    if (breaking && law)
      tell_damage(*breaking, law->nodal);
    this->keep_constant_loads();
    if (zone_bonds && body.coupling.exchanges() && !body.cracks.on_faces() &&
        body.elasticity.contact && this->may_part())
      this->set_contact(zone_bonds->make_contact(nodes));
  }


  template <int dim>
  void ElasticElements<dim>::find_conditions()
  {
    const DoFHandler<dim>       &dofs = cells.dof_handler();
    std::vector<NodeOnSide<dim>> on_sides =
      nodes_on_sides(dofs, *nodes, hanging, positions, body.boundary_conditions.parts);
    for (const PartUnknown<dim> &unknown : mechanical.part_unknowns())
      on_sides.push_back({unknown.node, unknown.id, unknown.position});
    const std::vector<Point<dim>> own(positions.begin(),
                                      positions.begin() + nodes->locally_owned_size());
    conditions = std::make_unique<DisplacementConditions<dim>>(on_sides,
                                                               own,
                                                               body,
                                                               false,
                                                               dofs.get_communicator());
    conditions->pin(own, body, false);
    if (!zone_bonds && !body.cracks.cracks.empty() && dofs.get_fe().degree == 1)
      {
        Vector free(unknowns);
        free = 1.;
        conditions->mask(free);
        hanging.let_follow(find_followers(dofs, cells.by_cracks, hanging, free, Vector(nodes)),
                           dofs.get_communicator());
      }
    conditions->let_follow(hanging.owned());
  }


  template <int dim>
  TrilinosWrappers::SparsityPattern ElasticElements<dim>::pattern(const bool with_bonds,
                                                                  const bool ever) const
  {
    const IndexSet owned    = unknowns->locally_owned_range();
    IndexSet       relevant = unknowns->ghost_indices();
    relevant.add_indices(owned);
    TrilinosWrappers::SparsityPattern pattern(owned,
                                              owned,
                                              relevant,
                                              nodes->get_mpi_communicator());
    for (const auto &cell : cells.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned())
        hanging.add_to(pattern, cells.unknowns_of(cell));
    if (with_bonds && zone_bonds)
      zone_bonds->add_pattern(pattern, ever);
    pattern.compress();
    return pattern;
  }


  template <int dim>
  void ElasticElements<dim>::assemble(const bool thermal_alone)
  {
    const MPI_Comm all = nodes->get_mpi_communicator();
    if (!thermal_alone)
      {
        stiffness.reinit(pattern(!breaking, true));
        if (cells.with_shear)
          law->shear.reinit(pattern(false, false));
        if (cells.scales_beside_cracks())
          cells.find_factors(Vector(nodes));
        mass = 0.;
        volumes.reinit(nodes);
      }
    thermal_loads = 0.;
    double energy = 0.;
    cells.for_each([&](const auto &, auto &cell) {
      energy += cell.thermal_energy;
      for (unsigned int i = 0; i < cell.unknowns.size(); ++i)
        thermal_loads(cell.unknowns[i]) += cell.thermal(i);
      if (thermal_alone)
        return;
      stiffness.add(hanging, cell.stiffness, cell.unknowns);
      if (cells.with_shear)
        law->shear.add(hanging, cell.shear, cell.unknowns);
      make_positive(cell.diagonal, cell.mass);
      for (unsigned int i = 0; i < cell.unknowns.size(); ++i)
        mass(cell.unknowns[i]) += cell.mass(i / dim);
      for (unsigned int i = 0; i < cell.indices.size(); ++i)
        volumes(cell.indices[i]) += cell.volume(i);
    });
    thermal_energy = Utilities::MPI::sum(energy, all);
    if (!thermal_alone && breaking)
      set_all(breaking->bonds, nodes->locally_owned_size(), cells.factors);
    else if (!thermal_alone && zone_bonds)
      n_bonds = zone_bonds->add_to(stiffness.sparse(), &cells.factors);
    if (zone_bonds && this->is_warm())
      {
        const auto strain = [this](const unsigned int node) {
          return this->thermal_strain_at(node);
        };
        if (breaking)
          {
            std::vector<double> strains(positions.size());
            for (unsigned int i = 0; i < strains.size(); ++i)
              strains[i] = strain(i);
            breaking->set_thermal(std::move(strains), this->temperature_change());
            energy = breaking->bonds.add_thermal(thermal_loads,
                                                 breaking->bonds.nodes(),
                                                 breaking->thermal_strains(),
                                                 1.);
          }
        else
          energy = zone_bonds->add_thermal(thermal_loads, cells.factors, strain);
        thermal_energy += Utilities::MPI::sum(energy, all);
      }
    thermal_loads.compress(VectorOperation::add);
    hanging.condense(thermal_loads);
    if (thermal_alone)
      return;
    stiffness.compress();
    if (cells.with_shear)
      law->shear.compress();
    mass.compress(VectorOperation::add);
    hanging.condense(mass);
    // Their masters have it; as good as nothing, but a mass.
    hanging.set(mass, std::numeric_limits<double>::epsilon() * mass.l1_norm() / mass.size());
    volumes.compress(VectorOperation::add);
    find_diagonal();
  }


  template <int dim>
  void ElasticElements<dim>::find_diagonal()
  {
    cells.throw_faults();
    this->stepping.symmetric_law = has_symmetric_law(cells, nodal(zone_bonds));
    stiffness.for_each_entry([&](const unsigned int i, const auto column, const double value) {
      if (column == unknowns->local_to_global(i))
        stiffness_diagonal.local_element(i) = value;
    });
    if (breaking)
      for (const unsigned int i : breaking->bonds.nodes())
        {
          const Tensor<1, dim> own = breaking->bonds.diagonal_of(i);
          for (unsigned int d = 0; d < dim; ++d)
            stiffness_diagonal.local_element(dim * i + d) += own[d];
        }
    if (nodal(zone_bonds))
      nodal(zone_bonds)->add_diagonal(stiffness_diagonal);
    conditions->mask(stiffness_diagonal, 1.);
    if (breaking && breaking->any_broken())
      return hold_loose(stiffness_diagonal);
    const double                   largest = stiffness_diagonal.linfty_norm();
    const Vector                   held = this->held_unknowns(); // 1 on the diagonal, in any units
    std::string                    message;
    const NodeFamilies<dim> *const families = zone_bonds ? zone_bonds->coupling().node_families() :
                                                           nullptr;
    for (unsigned int i = 0; i < stiffness_diagonal.locally_owned_size() && message.empty(); ++i)
      {
        const std::string fault =
          families != nullptr && i % dim == 0 ? families->fault_of(i / dim) : "";
        const double own = stiffness_diagonal.local_element(i);
        if (!fault.empty() || (held.local_element(i) == 0. && !(own > 1e-13 * largest)))
          message =
            fault.empty() ?
              looseness_text(this->place_of(i),
                             own / largest,
                             body.cracks.cracks.empty(),
                             zone_bonds != nullptr) :
              "The node at " + this->place_of(i) + fault +
                " Check 'Horizon' in section 'Peridynamics' and the cracks in section 'Cracks'.";
      }
    throw_on_all_if_any(nodes->get_mpi_communicator(), message);
  }


  template <int dim>
  double ElasticElements<dim>::add_parts(const std::vector<Cell>         &of_cells,
                                         const std::vector<unsigned int> &rows,
                                         const double                     multiple,
                                         const Vector                    *u)
  {
    const bool warms  = u && this->is_warm();
    double     energy = 0., held = 0.;
    cells.for_each(of_cells, [&](const Cell &, auto &cell) {
      const auto &list = cell.unknowns;
      energy += u ? cell.energy(*u) : 0.;
      held += cell.thermal_energy;
      for (unsigned int i = 0; u && i < list.size(); ++i)
        changes.forces(list[i]) += multiple * cell.force(i, *u);
      for (unsigned int i = 0; warms && i < list.size(); ++i)
        thermal_loads(list[i]) += multiple * cell.thermal(i);
      cell.stiffness *= multiple;
      stiffness.add(hanging, cell.stiffness, list);
      if (!cells.with_shear)
        return;
      cell.shear *= multiple;
      law->shear.add(hanging, cell.shear, list);
    });
    if (zone_bonds && !breaking)
      n_bonds += zone_bonds->add_to(stiffness.sparse(), cells.factors, rows, multiple);
    if (!u)
      return 0.;
    const std::vector<double> &strains = breaking->thermal_strains();
    energy += breaking->bonds.energy(*u, rows, strains);
    breaking->bonds.add_forces_of(rows, multiple, changes.forces, *u);
    if (warms)
      held += breaking->bonds.add_thermal(thermal_loads, rows, strains, multiple) / multiple;
    thermal_energy += Utilities::MPI::sum(multiple * held, nodes->get_mpi_communicator());
    return multiple * energy;
  }


  template <int dim>
  template <typename MakeChange>
  void ElasticElements<dim>::mend(const Boxes      &boxes,
                                  const double      of_cells,
                                  const MakeChange &make_change)
  {
    if (cells.scales_beside_cracks()) // factors of cells and bonds change farther away
      {
        make_change(nullptr);
        assemble(false);
        return;
      }
    const std::vector<Cell>         near = cells.near(boxes, of_cells);
    const std::vector<unsigned int> rows = zone_bonds ? zone_bonds->nodes_near(boxes) :
                                                        std::vector<unsigned int>();
    add_parts(near, rows, -1.);
    make_change(&near);
    add_parts(near, rows, 1.);
    if (breaking)
      breaking->bonds.set_rows(rows, cells.factors);
    stiffness.compress();
    if (cells.with_shear)
      law->shear.compress();
    if (this->is_warm())
      assemble(true);
  }


  template <int dim>
  bool ElasticElements<dim>::join_zone(const ChangeSet<dim> &change)
  {
    if (!zone_bonds || change.cuts.empty())
      return false;
    const Boxes joins = boxes_beside(change.cuts,
                                     zone_bonds->coupling().joining_by(change.to),
                                     nodes->get_mpi_communicator());
    if (joins.empty())
      return false;
    mend(joins, zone_bonds->reach(), [&](const std::vector<Cell> *) {
      zone_bonds->coupling().join(change.to);
    });
    return true;
  }


  template <int dim>
  void ElasticElements<dim>::apply_change(const ChangeSet<dim> &change, const bool)
  {
    const auto pieces = this->history.pieces(change.to);
    mend(change.cuts, 0., [&](const std::vector<Cell> *near) {
      if (near)
        cells.by_cracks.set(*near, pieces, 0.);
      else
        cells.by_cracks.set(pieces, 0.);
      if (zone_bonds)
        zone_bonds->coupling().apply_change(change);
    });
    if (breaking && breaking->any_broken())
      cells.note_parted();
    if (breaking && law)
      tell_damage(*breaking, law->nodal);
    find_diagonal();
    this->keep_constant_loads();
  }


  template <int dim>
  void ElasticElements<dim>::exchange_bonds(Archive                     &archive,
                                            const NodeKeys              &keys,
                                            const std::function<void()> &at_surrogate)
  {
    if (nonlinear() || law)
      {
        const Archive::Part part(archive, "law");
        archive.exchange("dissipated", this->released_beside.by_law);
        if (nodal(zone_bonds))
          {
            const Archive::Part of_families(archive, "families");
            nodal(zone_bonds)->exchange(archive, keys);
          }
        if (law)
          law->nodal.exchange(archive, keys);
        else
          cells.stresses->exchange(archive);
      }
    if (!breaking)
      return;
    breaking->exchange(archive, keys, [&] {
      set_all(breaking->bonds, nodes->locally_owned_size(), cells.factors);
      at_surrogate();
    });
    if (!archive.loads())
      return;
    assemble(false);
    if (law)
      tell_damage(*breaking, law->nodal);
    this->keep_constant_loads();
    if (breaking->any_broken())
      cells.note_parted();
  }


  template <int dim>
  void ElasticElements<dim>::set_temperature_change(const Vector &nodal)
  {
    this->keep_temperature_change(nodal);
    this->set_contact_strains();
    if (cells.stresses)
      cells.stresses->take_temperatures(body, this->temperature_change());
    assemble(!body.moduli_change());
    this->keep_constant_loads();
  }


  template <int dim>
  void ElasticElements<dim>::find_loads(Vector &loads, const double t) const
  {
    loads = thermal_loads;
    loads.zero_out_ghost_values();
    mechanical.for_each(t, [&](const auto, const auto unknown, const auto, const double value) {
      loads(unknown) += this->stepping.load_factor * value;
    });
    loads.compress(VectorOperation::add);
    hanging.condense(loads);
  }


  template <int dim>
  ForceBalance ElasticElements<dim>::forces(const Vector &u, const double t) const
  {
    Vector loads, reactions;
    this->initialize_vector(loads);
    this->initialize_vector(reactions);
    find_loads(loads, t);
    find_forces(reactions, u, t);
    contact->add_forces(reactions, u, 1.);
    std::map<types::boundary_id, Tensor<1, dim>> sums;
    for (const types::boundary_id side : mirrors())
      for (unsigned int i = side / 2; i < reactions.locally_owned_size(); i += dim)
        sums[side][side / 2] -= reactions.local_element(i) - thermal_loads.local_element(i);
    reactions -= loads;
    conditions->add_reactions(reactions, sums);
    mechanical.for_each(t, [&](const auto side, const auto, const auto d, const double value) {
      sums[side][d] += this->stepping.load_factor * value;
    });
    return gather_forces(sums, body, nodes->get_mpi_communicator());
  }


  template <int dim>
  void ElasticElements<dim>::multiply(Vector &y, const Vector &x) const
  {
    // Where explicit steps follow, but for growing cracks, which change the matrix itself.
    if (this->stepping.follow && !cells.is_full() && !stiffness.was_asked_to_share() &&
        !hanging.any() && body.domain.has_lattice() &&
        (!zone_bonds || breaking || !this->has_growing_cracks()))
      stiffness.share_rows(nodes, places_on_lattice(positions, body.domain));
    const bool is_known = x.has_ghost_elements();
    if (breaking || stiffness.shares_rows())
      x.update_ghost_values();
    stiffness.multiply(y, x);
    if (cells.with_shear)
      {
        law->shear.multiply(law->forces, x);
        y.add(law->nodal.steps->slope({}, nullptr) - 1., law->forces);
      }
    if (breaking)
      breaking->bonds.add_forces(y, x, true);
    if (nodal(zone_bonds))
      nodal(zone_bonds)->add_product(y, x);
    x.set_ghost_state(is_known);
    hanging.set(y, 0.); // the nodes they follow from have all of it
  }


  template <int dim>
  void ElasticElements<dim>::find_forces(Vector &y, const Vector &u, const double t) const
  {
    if (cells.stresses && nonlinear())
      {
        const WithGhosts ghosts(u);
        cells.stresses->find_forces(y, hanging, u, t);
        if (nodal(zone_bonds))
          nodal(zone_bonds)->add_forces(y, u, t);
        return;
      }
    if (!law)
      return multiply(y, u);
    law->nodal.steps.set_time(t);
    const WithGhosts ghosts(u);
    stiffness.multiply(y, u);
    if (cells.with_shear)
      {
        law->nodal.find_change(law->change, u);
        law->shear.multiply(law->forces, law->change);
        law->change.set_ghost_state(false);
        y += law->forces;
      }
    if (breaking)
      breaking->bonds.add_forces(y, u);
    if (nodal(zone_bonds))
      nodal(zone_bonds)->add_forces(y, u, t);
    hanging.set(y, 0.);
  }


  template <int dim>
  void ElasticElements<dim>::linearize(const Vector &u)
  {
    if (!nonlinear())
      return;
    const WithGhosts ghosts(u);
    if (breaking)
      breaking->bonds.linearize(u);
    // Explicit steps, and the start of a motion, have the body in view that does not flow.
    const bool starts = !body.elasticity.is_static() && cells.stresses &&
                        !cells.stresses->has_begun();
    if (!cells.stresses || (!cells.is_full() && (this->stepping.follow || starts)))
      return;
    stiffness.sparse() = 0.;
    cells.stresses->add_tangent(stiffness, hanging, u);
    stiffness.compress();
    if (nodal(zone_bonds))
      nodal(zone_bonds)->linearize(u);
    this->stepping.symmetric_law = has_symmetric_law(cells, nodal(zone_bonds));
  }


  template <int dim>
  double ElasticElements<dim>::largest_stretch(const Vector &u) const
  {
    if (!nonlinear() || (!breaking && !cells.is_full()))
      return 0.;
    const WithGhosts ghosts(u);
    return cells.is_full() ?
             cells.stresses->largest_stiffening(u) :
             Utilities::MPI::max(breaking->bonds.linearize(u) - 1., nodes->get_mpi_communicator());
  }


  template <int dim>
  void ElasticElements<dim>::accept(const Vector &u, const double t)
  {
    if (!nonlinear() && !law)
      return;
    const WithGhosts ghosts(u);
    if (cells.stresses)
      {
        double dissipated = cells.stresses->accept(u, t);
        if (nodal(zone_bonds))
          dissipated += nodal(zone_bonds)->accept(u, t);
        this->released_beside.by_law += dissipated;
        if ((dissipated > 0. || cells.stresses->law().may_fail()) && body.elasticity.is_static())
          linearize(u); // as for a run that goes on from here
      }
    if (!law)
      return;
    law->nodal.steps.set_time(t);
    if (cells.with_shear) // else there is no history
      {
        const double of_bonds =
          breaking ? breaking->bonds.energy(u, breaking->bonds.nodes(), {}, true) : 0.;
        this->released_beside.by_law +=
          shear_energy(*law, u, true) +
          Utilities::MPI::sum(of_bonds, nodes->get_mpi_communicator());
        if (nodal(zone_bonds))
          this->released_beside.by_law += nodal(zone_bonds)->accept(u, t);
      }
    law->nodal.accept(u, t);
  }


  template <int dim>
  double ElasticElements<dim>::energy(const Vector &u) const
  {
    if (cells.stresses && nonlinear())
      {
        const WithGhosts ghosts(u);
        const double     of_families = nodal(zone_bonds) ? nodal(zone_bonds)->energy(u) : 0.;
        return cells.stresses->energy(u) + of_families + contact->energy(u);
      }
    Vector image;
    this->initialize_vector(image);
    if (!law)
      {
        multiply(image, u);
        return 0.5 * (u * image) - u * thermal_loads + thermal_energy + contact->energy(u);
      }
    const WithGhosts ghosts(u);
    stiffness.multiply(image, u);
    double sum = 0.5 * (u * image);
    if (cells.with_shear)
      {
        law->shear.multiply(image, u);
        sum += shear_energy(*law, u, false) - 0.5 * (u * image);
      }
    if (nodal(zone_bonds))
      sum += nodal(zone_bonds)->energy(u);
    const double of_bonds = breaking ? breaking->bonds.energy(u, breaking->bonds.nodes(), {}) : 0.;
    return sum + Utilities::MPI::sum(of_bonds, nodes->get_mpi_communicator()) + contact->energy(u);
  }


  template <int dim>
  Inversion ElasticElements<dim>::inverted(const Vector &u) const
  {
    if (nonlinear() && !cells.is_full()) // small displacements all the same, of any size
      return {};
    const WithGhosts ghosts(u);
    return find_inverted<dim>(
      cell_corners_of<dim>(cells.dof_handler(), *nodes),
      u,
      [&](const unsigned int node) { return positions[node]; },
      [](const CellCorner<dim> &) { return true; },
      nodes->get_mpi_communicator());
  }


  template <int dim>
  Spectrum ElasticElements<dim>::spectrum() const
  {
    std::vector<double> row_sums(mass.locally_owned_size(), 0.);
    stiffness.for_each_entry([&](const unsigned int row, const auto, const double value) {
      row_sums[row] += std::abs(value);
    });
    if (breaking)
      breaking->bonds.add_row_sums(row_sums);
    if (nodal(zone_bonds))
      nodal(zone_bonds)->add_row_sums(row_sums);
    for (const unsigned int i : hanging.owned())
      row_sums[i] = 0.;
    double bound = 0.;
    for (unsigned int i = 0; i < row_sums.size(); ++i)
      bound = std::max(bound, row_sums[i] / mass.local_element(i));
    bound = Utilities::MPI::max(bound, nodes->get_mpi_communicator());
    return {bound, sharp_bound(*this, bound, [&](Vector &vector) { this->fill_noise(vector); })};
  }


  template <int dim>
  void ElasticElements<dim>::assemble_surrogate(TrilinosWrappers::SparseMatrix &matrix) const
  {
    if (!breaking && !(zone_bonds && body.elasticity.is_correspondence()))
      {
        if (cells.stresses && !cells.is_full()) // else that may have turned far
          {
            matrix.reinit(pattern(true, true));
            cells.for_each([&](const Cell &, const auto &data) {
              hanging.add_to(matrix, data.stiffness, data.unknowns);
            });
            matrix.compress(VectorOperation::add);
          }
        else
          stiffness.copy_to(matrix, pattern(true, true));
        hold_unknowns(matrix, this->held_unknowns());
        return;
      }
    matrix.reinit(pattern(!breaking, true));
    cells.for_each_whole([&](const Cell &cell, const auto &data) {
      if (!cells.by_cracks.is_cut(cell) && !zone_bonds->coupling().parts_cell(cell))
        hanging.add_to(matrix, data.stiffness, data.unknowns);
    });
    if (breaking)
      breaking->bonds.add_between_vertices(matrix);
    matrix.compress(VectorOperation::add);
    Vector loose = this->held_unknowns();
    mark_loose(matrix, stiffness_diagonal, loose);
    hold_unknowns(matrix, loose);
  }


  template <int dim>
  void ElasticElements<dim>::assemble_intact(TrilinosWrappers::SparseMatrix &matrix,
                                             const bool                      with_bonds) const
  {
    if (with_bonds && !breaking && !stiffness.shares_rows())
      matrix.reinit(stiffness.sparse());
    else
      matrix.reinit(pattern(with_bonds, false));
    cells.for_each_whole([&](const Cell &cell, auto &data) {
      if (with_bonds && zone_bonds)
        zone_bonds->leave_remainder(cell, data.stiffness);
      hanging.add_to(matrix, data.stiffness, data.unknowns);
    });
    if (with_bonds && zone_bonds)
      zone_bonds->add_to(matrix, nullptr);
    matrix.compress(VectorOperation::add);
  }


  template <int dim>
  OperatorSize ElasticElements<dim>::size() const
  {
    OperatorSize size;
    size.unknowns = unknowns->size();
    size.nonzeros = stiffness.n_entries();
    size.bonds    = std::llround(Utilities::MPI::sum(breaking          ? breaking->bonds.n_whole() :
                                                  nodal(zone_bonds) ? nodal(zone_bonds)->n_bonds() :
                                                                      n_bonds,
                                                  nodes->get_mpi_communicator()));
    size.memory   = stiffness.memory_consumption() + positions.capacity() * sizeof(Point<dim>);
    if (cells.stresses)
      size.memory += cells.stresses->memory_consumption();
    if (zone_bonds)
      size.memory += zone_bonds->coupling().memory_consumption();
    if (breaking)
      size.memory += breaking->memory_consumption();
    if (nodal(zone_bonds))
      size.memory += nodal(zone_bonds)->memory_consumption();
    size.form = "matrix";
    return size;
  }


  PERIDEAL_INSTANTIATE_CLASS(class ElasticElements);
} // namespace PeriDeal
