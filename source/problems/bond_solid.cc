// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/analysis/bond_intensities.h>
#include <perideal/base/instantiate.h>
#include <perideal/laws/elasticity.h>
#include <perideal/laws/entropy_of_deformation.h>
#include <perideal/laws/lattice_family.h>
#include <perideal/operators/solid/state_operator.h>
#include <perideal/operators/solid/surface_stiffness.h>
#include <perideal/scene/beyond_sides.h>
#include <perideal/scene/law_text.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solid_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** The stiffness of a lattice whose families have few bonds, or oblong cells. */
    template <int dim>
    std::string note_on_few_bonds(const Scene<dim>                     &scene,
                                  const std::vector<FamilyMember<dim>> &family)
    {
      constexpr double tolerable = 0.02, tolerable_shear = 0.05;
      if (dim == 1 || family.empty() || !scene.material.uniform_moduli())
        return {};
      const Tensor<1, dim> h = scene.domain.spacing();
      const Moduli         moduli =
        scene.moduli(scene.domain.lower + 0.5 * (scene.domain.upper - scene.domain.lower));
      const StateLaw law = scene.elasticity.is_bond_based() ?
                             bond_law(moduli, dim, scene.elasticity.plane) :
                             state_law(moduli, dim, scene.elasticity.plane);
      // Means of n_a^2 n_b^2 over bonds in all directions, and over the family.
      double         all = 0.;
      Tensor<2, dim> even, found;
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = 0; b < dim; ++b)
          even[a][b] = (a == b ? 3. : 1.) / (dim * (dim + 2.));
      for (const FamilyMember<dim> &member : family)
        {
          Tensor<1, dim> squares; // of the direction, times the length
          for (unsigned int d = 0; d < dim; ++d)
            squares[d] = std::pow(member.offset[d] * h[d], 2) / member.r;
          found += member.weight * outer_product(squares, squares);
          all += member.weight * member.r * member.r;
        }
      found /= all;
      const auto compliance = [&](const Tensor<2, dim> &means) {
        Tensor<2, dim> stiffness = law.extension * means;
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = 0; b < dim; ++b)
            stiffness[a][b] += law.volumetric / dim;
        return invert(stiffness);
      };
      const Tensor<2, dim> of_family = compliance(found), of_body = compliance(even);
      double               g = 1., young = 1.;
      unsigned int         first = 0, second = 1, axis = 0;
      for (unsigned int a = 0; a < dim; ++a)
        {
          if (const double E = of_body[a][a] / of_family[a][a];
              std::abs(E - 1.) > std::abs(young - 1.) + 1e-9)
            {
              young = E;
              axis  = a;
            }
          for (unsigned int b = a + 1; b < dim; ++b)
            if (const double G = found[a][b] / even[a][b];
                std::abs(G - 1.) > std::abs(g - 1.) + 1e-9)
              {
                g      = G;
                first  = a;
                second = b;
              }
        }
      if (std::abs(g - 1.) < tolerable_shear && std::abs(young - 1.) < tolerable)
        return {};
      const double shortest = *std::min_element(h.begin_raw(), h.end_raw()),
                   longest  = *std::max_element(h.begin_raw(), h.end_raw());
      const bool oblong     = longest > (1. + 1e-6) * shortest;
      return "families of m = " + rounded_text(scene.horizon() / shortest) +
             (oblong ? ", but " + rounded_text(scene.horizon() / longest) +
                         " along the long edges of cells," :
                       "") +
             " with this kernel have a shear modulus of " + rounded_text(g) +
             " times that of 'Material' in the plane of " + "xyz"[first] + " and " + "xyz"[second] +
             ", and a body pulled along " + "xyz"[axis] + " is " + rounded_text(young) +
             " times as stiff as it should be. " +
             (oblong ? "Cells as long as wide ('Cells' in section 'Domain'), or" :
                       "'Calibration = isotropic' in section 'Peridynamics' and") +
             " a larger 'Horizon ratio' bring both near 1.";
    }


    /**
     * By how much families that go on beyond the sides of a thin body make it too stiff where it is
     * bent, or twisted: for `Models = peridynamics`.
     */
    template <int dim>
    std::string note_on_bending(const Scene<dim> &scene)
    {
      constexpr double tolerable = 0.05, slender = 3.;
      if (dim == 1 || !scene.domain.has_lattice())
        return {};
      const auto           beyond = beyond_sides(scene);
      const Tensor<1, dim> h = scene.domain.spacing(), size = whole_extent(scene);
      const double         longest = *std::max_element(size.begin_raw(), size.end_raw());
      double               bent = 0., twisted = 0.;
      unsigned int         thin = 0;
      for (unsigned int d = 0; d < dim; ++d)
        {
          // Of sides of which one is loaded as where both are in part; with the mirror image.
          const auto has = [&](const BeyondSide what) {
            return beyond[2 * d] == what || beyond[2 * d + 1] == what;
          };
          const bool whole = !has(BeyondSide::in_part);
          if (has(BeyondSide::nothing) || (whole && !has(BeyondSide::continued)) ||
              longest < slender * size[d])
            continue;
          // Measured (doc/elasticity.md).
          const double m = scene.horizon() / h[d], n = size[d] / h[d],
                       more = (dim == 2 ? 1. : 1.25) * (2.45 + 0.25 * m * m) / (n * n),
                       less = (dim == 2 ? 1. : 0.7) * std::pow((0.4 + 0.475 * m) / n, m);
          if ((whole ? more : less) > bent || (dim == 3 && more > twisted))
            thin = d;
          bent    = std::max(bent, whole ? more : less);
          twisted = std::max(twisted, dim == 3 ? more : 0.);
        }
      if (std::max(bent, twisted) < tolerable)
        return {};
      const std::string in_bending =
        bent < tolerable ? "" :
                           rounded_text(1. + bent) + " times as stiff as it should be in bending";
      const std::string in_torsion =
        twisted < tolerable ? "" :
                              rounded_text(1. + twisted) +
                                (in_bending.empty() ? " times as stiff as it should be in torsion" :
                                                      " times in torsion");
      return "with m = " + rounded_text(scene.horizon() / h[thin]) + " and " +
             std::to_string(scene.domain.cells[thin]) + " cells along " + "xyz"[thin] +
             " this body is about " + in_bending +
             (in_bending.empty() || in_torsion.empty() ? "" : " and ") + in_torsion +
             " (not where it is pulled). Twice as many cells there make that a quarter or less, 'Models = finite elements' has none of it.";
    }


    /**
     * The same of a mesh from a file, as measured (doc/elasticity.md).
     * @param n_cells what of it is thinnest, in cells of mean size
     * @param m       of these
     * @param ends    families end at free sides, since bonds may break or in motion
     */
    std::string note_on_thin_parts(const double n_cells, const double m, const bool ends)
    {
      constexpr double tolerable = 0.05;
      const double     more      = ends ? 0.3 * std::pow(2. / n_cells, 8.) :
                                          0.045 * std::pow(m / 3., 1.4) * std::pow(4. / n_cells, 3.8),
                   less          = ends ? std::min(0.15, 0.24 * (m - 2.4) / n_cells) :
                                          0.5 * (m / 3. - 1.) / n_cells;
      if (more < tolerable && less < tolerable)
        return {};
      const std::string size = n_cells < 2. || more > 1. ?
                                 "much too stiff" :
                                 "about " + rounded_text(more < tolerable ? 1. - less : 1. + more) +
                                   " times as stiff as they should be";
      return "behind free sides this mesh is " + rounded_text(n_cells) +
             " cells of mean size thick where it is thinnest. With m = " + rounded_text(m) +
             " strips of that thickness with two free long sides are " + size +
             " in bending (not where they are pulled). Smaller cells, with a smaller 'Horizon' in section 'Peridynamics', make that less; 'Models = finite elements' has none of it.";
    }


    /** Cracks that are held back between two rows of nodes. */
    template <int dim>
    std::string note_on_trapping(const Scene<dim>                     &scene,
                                 const std::vector<FamilyMember<dim>> &family)
    {
      constexpr double few = 3.5;
      if (dim == 1 || family.empty() || !scene.material.fracture_energy)
        return {};
      const Tensor<1, dim> h = scene.domain.spacing();
      const double         m = scene.horizon() / *std::min_element(h.begin_raw(), h.end_raw());
      if (m >= few)
        return {};
      int    n_bonds   = 0;
      double strongest = 0., all = 0.;
      for (const FamilyMember<dim> &member : family)
        if (member.offset[0] > 0)
          {
            const double energy = member.offset[0] * member.weight * member.r * member.r;
            n_bonds += member.offset[0];
            all += energy;
            strongest = std::max(strongest, energy / member.offset[0]);
          }
      return "with m = " + rounded_text(m) +
             " a crack along the rows gets on a column at a time, by " + std::to_string(n_bonds) +
             " bonds that hold it back until the last breaks (one of them has " +
             rounded_text(100. * strongest / all) +
             " % of the energy): loads at which it runs come out 10 to 20 % too large however fine the lattice is. "
             "'Horizon ratio' of 4 or 5 (section 'Peridynamics') takes that away.";
    }


    /**
     * A critical stretch where a fracture energy is meant.
     * @param energy  per area of new crack, of the bonds that cross a plane of the lattice
     * @param of_ball the same of the integral over a ball
     */
    template <int dim>
    std::string note_on_stretch(const Scene<dim> &scene, const double energy, const double of_ball)
    {
      constexpr double tolerable = 0.05;
      if (std::abs(energy / of_ball - 1.) < tolerable)
        return {};
      const Tensor<1, dim> h = scene.domain.spacing();
      return "'Critical stretch' in section 'Material' is a fracture energy of " +
             rounded_text(energy) + " on this lattice of m = " +
             rounded_text(scene.horizon() / *std::min_element(h.begin_raw(), h.end_raw())) + ", " +
             rounded_text(energy / of_ball) +
             " times that of a ball, from which textbooks have their formulas. 'Fracture energy' in its place is the same on every lattice.";
    }


    template <int dim>
    class BondSolid : public SolidField<dim>
    {
    public:
      using Field<dim>::scene;
      using Field<dim>::handler;
      using Field<dim>::node_set;
      using Field<dim>::solution;

      BondSolid(Model<dim> &on, const Scene<dim> &scene)
        : SolidField<dim>(on, scene)
      {
        this->make_bond_nodes();
        Timings::Scope scope(this->timings, "operator");
        states                       = std::make_unique<StateOperator<dim>>(*node_set, scene);
        const SolidBonds<dim> &bonds = states->bonds();
        if (families_end(scene) && !scene.elasticity.is_correspondence())
          stiffer = surface_stiffness(bonds);
        if (bonds.corrections.thinnest < std::numeric_limits<double>::infinity())
          {
            double volume = 0.;
            for (unsigned int i = 0; i < node_set->n_owned(); ++i)
              volume += node_set->volume(i);
            spacing = std::pow(Utilities::MPI::sum(volume, handler.get_communicator()) /
                                 handler.get_triangulation().n_global_active_cells(),
                               1. / dim);
          }
      }

      StateOperator<dim> &op() const override
      {
        return *states;
      }

      const Families<dim> *families() const override
      {
        return states->brittle() ? &states->bonds().families : nullptr;
      }

      std::vector<BondBreak> breaks() const override
      {
        const auto            &layout = *node_set->partitioner();
        const BondRows<dim>   &rows   = states->bonds().rows.body;
        std::vector<BondBreak> list;
        std::size_t            n_known = 0;
        for (const auto &[number, time] : rows.state.marked_since(n_known))
          {
            const unsigned int i = rows.node_of(number), j = rows.neighbors[number];
            if (rows.state.is_broken(number) &&
                layout.local_to_global(i) < layout.local_to_global(j))
              list.push_back({i, j, time});
          }
        return list;
      }

      std::vector<double> damage() const override
      {
        return states->breaking().damage();
      }

      std::vector<double> at_points(const PointEvaluator<dim>              &reader,
                                    const std::vector<std::vector<double>> &points) const override
      {
        constexpr unsigned int n_stresses = SymmetricTensor<2, 3>::n_independent_components;
        const auto             stress     = nodal_stress(states->tensors(solution));
        std::vector<std::vector<double>> columns;
        for (unsigned int d = 0; d < dim; ++d)
          columns.push_back(reader.evaluate(solution, dim, d));
        // Von Mises' stress of interpolated components would be smaller than that of the nodes: it
        // is interpolated itself.
        for (unsigned int k = 0; k <= n_stresses; ++k)
          {
            Vector values(node_set->partitioner());
            for (unsigned int i = 0; i < node_set->n_owned(); ++i)
              values.local_element(i) = k < n_stresses ? stress[i].access_raw_entry(k) :
                                                         von_mises(stress[i]);
            columns.push_back(reader.evaluate(values));
          }
        const std::vector<double> change     = changes_at_points(reader);
        const auto                velocities = velocities_at_points(scene, reader, this->velocity);
        std::vector<double>       rows;
        for (std::size_t k = 0; k < points.size(); ++k)
          {
            double                values[dim];
            SymmetricTensor<2, 3> at_point;
            for (unsigned int d = 0; d < dim; ++d)
              values[d] = columns[d][k];
            for (unsigned int c = 0; c < n_stresses; ++c)
              at_point.access_raw_entry(c) = columns[dim + c][k];
            append_row(values, at_point, dim, rows);
            rows.back() = columns.back()[k];
            if (!change.empty())
              rows.push_back(change[k] + scene.elasticity.reference_temperature);
            for (const std::vector<double> &component : velocities)
              rows.push_back(component[k]);
          }
        return rows;
      }

      std::vector<OutputField> fields() const override
      {
        const NodalTensors<dim>   tensors = states->tensors(solution);
        const std::vector<double> theta   = nodal_dilatations(states->bonds(), solution);
        NodalFields<dim>          list(node_set->partitioner());
        list.add_vector("displacement", solution);
        if (this->velocity.size() > 0)
          list.add_vector("velocity", this->velocity);
        list.add_stress(nodal_stress(tensors));
        list.add_strain(tensors.strain);
        list.add_temperature(states->temperature_change(), scene);
        list.add("dilatation", [&](const unsigned int i) { return theta[i]; });
        if (states->brittle() || !scene.cracks.cracks.empty())
          {
            const std::vector<double> lost = damage();
            list.add("damage", [&](const unsigned int i) { return lost[i]; });
            if (scene.material.scatter &&
                scene.material.law.breaking.criterion == BreakCriterion::stretch)
              list.add("critical_stretch", [&](const unsigned int i) {
                return states->breaking().critical_stretches()[i];
              });
          }
        if (const auto *const yielding = states->bonds().yielding())
          list.add("plastic_strain",
                   [&](const unsigned int i) { return yielding->plastic_strain(i); });
        if (const auto *const nodal = states->bonds().correspondence())
          for (const auto &[name, values] : nodal->stresses.shown())
            list.add(name, [&of = values](const unsigned int i) { return of[i]; });
        list.add("node_volume", [&](const unsigned int i) { return node_set->volume(i); });
        return list.take();
      }

      SymmetricTensor<2, 3> mean_stress() const override
      {
        const auto            stress = nodal_stress(states->tensors(solution));
        SymmetricTensor<2, 3> sum;
        double                volume = 0.;
        for (unsigned int i = 0; i < stress.size(); ++i)
          {
            sum += volume_in_body(i) * stress[i];
            volume += volume_in_body(i);
          }
        return Utilities::MPI::sum(sum, handler.get_communicator()) /
               Utilities::MPI::sum(volume, handler.get_communicator());
      }

      std::vector<double> entropies_of_deformation(const Vector &change) const override
      {
        // Of the displacement alone: the dilatations have thermal extensions taken off.
        Vector at_rest(solution);
        at_rest                           = 0.;
        const std::vector<double> taken   = nodal_dilatations(states->bonds(), at_rest);
        std::vector<double>       entropy = nodal_dilatations(states->bonds(), solution);
        for (unsigned int i = 0; i < entropy.size(); ++i)
          {
            const Point<dim> &p = node_set->position(i);
            entropy[i]          = node_set->volume(i) *
                         entropy_of_deformation(scene.moduli(p),
                                                scene.material.thermal_expansion.value(p),
                                                dim,
                                                scene.elasticity.plane,
                                                entropy[i] - taken[i],
                                                change.local_element(i));
          }
        return entropy;
      }

      std::vector<StressIntensity> stress_intensities(const double time) const override
      {
        std::vector<StressIntensity> list;
        if constexpr (dim > 1)
          {
            const ThermalStrains &thermal = states->bonds().thermal;
            solution.update_ghost_values();
            list = bond_intensities<dim>(
              scene,
              states->bonds().families,
              [&](const unsigned int i, const unsigned int k) {
                return k < dim ? solution.local_element(dim * i + k) : thermal[i];
              },
              thermal.any(),
              time,
              states->crack_time());
            solution.set_ghost_state(false);
          }
        return list;
      }

      std::vector<StressSample> stress_samples() const override
      {
        const auto                stress = nodal_stress(states->tensors(solution));
        std::vector<StressSample> samples;
        for (unsigned int i = 0; i < stress.size(); ++i)
          if (const double volume = volume_in_body(i); volume > 0.)
            samples.push_back(
              {scene.material.phases.all().at(node_set->position(i)), volume, stress[i]});
        return samples;
      }

      ChosenSettings settings() const override
      {
        auto list = this->bond_settings(states->bonds().families);
        if (const std::string law = law_text(scene, ModelKind::peridynamics); !law.empty())
          list.emplace_back("law", law);
        if (!states->brittle())
          return list;
        double lowest = 1e300, highest = 0.;
        for (const double s : states->breaking().critical_stretches())
          {
            lowest  = std::min(lowest, s);
            highest = std::max(highest, s);
          }
        lowest  = Utilities::MPI::min(lowest, handler.get_communicator());
        highest = Utilities::MPI::max(highest, handler.get_communicator());
        list.emplace_back(states->breaking().name_of_limit(),
                          number_text(lowest) +
                            (highest > lowest ? " to " + number_text(highest) : ""));
        return list;
      }

      std::vector<std::string> notes() const override
      {
        constexpr double  tolerable = 1e-8;
        const std::string entry     = "'Surface correction = moments' in section 'Peridynamics' ";
        const unsigned long long n  = states->bonds().corrections.n_left;
        std::vector<std::string> list;
        for (const std::string &note :
             {note_on_cut_sides(scene), note_on_stiff_surfaces(), note_on_held_rows(scene)})
          if (!note.empty())
            list.push_back(note);
        if (dim > 1 && scene.elasticity.model == ElasticModel::bond_based &&
            scene.elasticity.micromodulus == Micromodulus::family)
          list.push_back(
            "'Model = bond-based' in section 'Elasticity' divides the stiffness of a bond by sums over the families of its ends, which are smaller at surfaces: these are "
            "stiffer than those of the prototype microelastic material, which has the same constant everywhere. 'Micromodulus = constant' is that one.");
        if (n > 0)
          list.push_back(
            entry + "leaves " + std::to_string(n) + " of " + std::to_string(node_set->n_global()) +
            " nodes as they are, whose bonds would get negative factors, as in convex corners and beside the ends of cracks.");
        if (states->bonds().corrections.gap > tolerable)
          list.push_back(
            entry +
            "has not found all factors: moments of families differ from those of a complete one by up to " +
            number_text(states->bonds().corrections.gap) + " of them.");
        const auto  &family            = states->bonds().families.weights().members();
        const double thinnest          = states->bonds().corrections.thinnest;
        const bool   is_correspondence = scene.elasticity.is_correspondence(); // has its moduli
        for (const std::string &note :
             {is_correspondence ? "" : note_on_few_bonds(scene, family),
              is_correspondence ? "" : note_on_bending(scene),
              spacing > 0. && !is_correspondence ?
                note_on_thin_parts(thinnest / spacing,
                                   scene.horizon() / spacing,
                                   completes_at_surfaces<dim>(scene)) :
                "",
              states->brittle() && is_correspondence &&
                  scene.material.law.breaking.criterion == BreakCriterion::stretch ?
                note_on_nodal_cracks() :
                "",
              states->brittle() && !scene.material.law.softens() ? note_on_trapping(scene, family) :
                                                                   "",
              note_on_softening(),
              note_on_critical_stretch()})
          if (!note.empty())
            list.push_back(note);
        if (dim == 2 && has_forces_of_its_own() && scene.elasticity.plane == PlaneState::strain)
          list.push_back(
            "the stress out of the plane is that of the linear law; '" +
            std::string(scene.material.law.kind == SolidLaw::formula ? "Bond force" : "User law") +
            "' in section 'Material' says nothing of it.");
        return list;
      }

    private:
      /** What bonds bear is not that of the linear law, nor what they store. */
      bool has_forces_of_its_own() const
      {
        const SolidLaw kind = scene.material.law.kind;
        return kind == SolidLaw::formula || kind == SolidLaw::user_bonds;
      }

      std::string note_on_critical_stretch() const
      {
        if (!states->brittle() || !scene.material.critical_stretch || scene.material.scatter ||
            has_forces_of_its_own() || !scene.domain.has_lattice() ||
            states->bonds().families.nodes().n_owned() == 0)
          return {};
        const auto [energy, of_ball] = states->breaking().energies_of_first();
        return note_on_stretch(scene, energy, of_ball);
      }

      /** Bonds that have stored much when they begin to soften. */
      std::string note_on_softening() const
      {
        constexpr double much  = 1. / 40.; // a tenth of the length E G/f_t^2
        const double     share = states->breaking().stored_at_onset();
        if (share < much)
          return {};
        const std::string horizon = number_text(scene.horizon()),
                          longest = number_text(scene.horizon() / share);
        return share >= 1. ?
                 "bonds break at once, and do not soften, where their horizon, " + horizon +
                   ", is longer than " + longest +
                   ", at which they have stored 'Fracture energy' (section 'Material') when they "
                   "come to 'Tensile strength'. Use a shorter horizon." :
                 "the horizon, " + horizon + ", is long for bonds that soften: they have stored " +
                   number_text(std::round(1000. * share) / 10.) +
                   " % of 'Fracture energy' (section 'Material') when they begin to; at " +
                   longest + " it would be all, and they would break at once.";
      }

      /** Without what lies in extra layers: half of a vertex on a side of the body. */
      double volume_in_body(const unsigned int i) const
      {
        const Domain<dim> &domain = scene.domain;
        const Point<dim>  &p      = node_set->position(i);
        double             volume = node_set->volume(i);
        if (!domain.has_extra_layers())
          return volume;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double slack = 1e-9 * (domain.upper[d] - domain.lower[d]);
            if ((domain.extra.layers[2 * d] > 0 && p[d] < domain.extra.body_lower[d] + slack) ||
                (domain.extra.layers[2 * d + 1] > 0 && p[d] > domain.extra.body_upper[d] - slack))
              volume *= 0.5;
          }
        return domain.shows(p) ? volume : 0.;
      }

      std::vector<SymmetricTensor<2, 3>> nodal_stress(const NodalTensors<dim> &tensors) const
      {
        return nodal_stresses(states->bonds(), scene, tensors);
      }

      /** Of the temperature where it is computed, else none. */
      std::vector<double> changes_at_points(const PointEvaluator<dim> &reader) const
      {
        if (states->temperature_change().size() == 0)
          return {};
        const Vector change(states->temperature_change());
        return reader.evaluate(change);
      }

      /** In figures what families that end at surfaces do to the stiffness. */
      std::string note_on_stiff_surfaces() const
      {
        constexpr double tolerable = 0.01;
        std::string      axes;
        for (unsigned int d = 0; d < dim; ++d)
          if (std::abs(stiffer[d]) > tolerable)
            axes += std::string(axes.empty() ? "" : ", ") +
                    (stiffer[d] > 0. ? "stiffer" : "softer") + " by about " +
                    number_text(std::round(1000. * std::abs(stiffer[d])) / 10.) + " % along " +
                    std::string(1, "xyz"[d]);
        if (axes.empty())
          return {};
        return "Families of peridynamics that end at surfaces make this body, if it is stretched as a whole, " +
               axes +
               " than its Young's modulus (mean over its nodes); the speed of waves changes by half of that.";
      }

      std::unique_ptr<StateOperator<dim>> states;
      Tensor<1, dim>                      stiffer;      // by families that end, along the axes
      double                              spacing = 0.; // of a mesh with thin parts
    };
  } // namespace


  template <int dim>
  std::unique_ptr<SolidField<dim>> make_bond_solid(Model<dim> &model, const Scene<dim> &scene)
  {
    return std::make_unique<BondSolid<dim>>(model, scene);
  }

  PERIDEAL_INSTANTIATE_FUNCTION(make_bond_solid);
} // namespace PeriDeal
