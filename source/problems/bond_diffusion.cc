// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <perideal/analysis/heat_flux.h>
#include <perideal/base/instantiate.h>
#include <perideal/operators/diffusion/extended_bond_term.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <limits>

#include "diffusion_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    std::string name_of(const InterfaceRule rule)
    {
      static const char *const rules[] = {"minimum", "arithmetic", "harmonic"};
      return rules[static_cast<int>(rule)];
    }


    /** The largest over the smallest conductivity of phases given by numbers; 1 without. */
    double ratio_of_phases(const Material &material)
    {
      const Regions &regions  = material.phases.all();
      double         smallest = std::numeric_limits<double>::max(), largest = 0.;
      const auto     add = [&](const Expression &formula) {
        if (!formula.is_constant())
          return;
        const double value = formula.value(Point<1>());
        smallest           = std::min(smallest, value);
        largest            = std::max(largest, value);
      };
      for (unsigned int k = 0; k < regions.names.size(); ++k)
        add(material.conductivity.formula(k));
      // An image leaves no place to what is in no phase.
      if (!regions.names.empty() && !regions.image)
        add(material.conductivity.formula(-1));
      return largest > 0. && smallest > 0. ? largest / smallest : 1.;
    }


    /** Sides of the box at which the families of bonds alone end. */
    template <int dim>
    std::array<bool, 2 * dim> sides_that_cut(const Scene<dim> &scene)
    {
      const auto               &conditions = scene.boundary_conditions;
      const bool                fictitious = scene.peridynamics.has_fictitious_nodes();
      std::array<bool, 2 * dim> cut;
      for (unsigned int side = 0; side < 2 * dim; ++side)
        {
          const bool given = std::any_of(conditions.dirichlet.begin(),
                                         conditions.dirichlet.end(),
                                         [&](const auto &value) { return value.id == side; });
          cut[side]        = !(fictitious && given) &&
                      std::count(conditions.symmetry.begin(), conditions.symmetry.end(), side) == 0;
        }
      return cut;
    }


    /**
     * How many spacings longer (or shorter) a body seems between two opposite sides with given
     * values, which the outermost rows of nodes have: by a chain of rows.
     */
    template <int dim>
    double extra_length(const std::vector<FamilyMember<dim>> &family,
                        const unsigned int                    axis,
                        const unsigned int                    n_rows,
                        const double                          first_row,
                        const bool                            at_centers)
    {
      int reach = 0; // of a member
      for (const FamilyMember<dim> &member : family)
        reach = std::max(reach, member.offset[axis]);
      const int           n = std::min<int>(n_rows, 12 * reach + 2);
      std::vector<double> along(reach + 1, 0.); // conductance between rows, relative
      double              whole = 0.;
      for (const FamilyMember<dim> &member : family)
        if (const int step = member.offset[axis]; step > 0)
          {
            along[step] += member.weight;
            whole += member.weight * step * step;
          }
      const auto volume = [&](const int row) { return row == 0 || row == n - 1 ? first_row : 1.; };
      FullMatrix<double>     matrix(n - 2, n - 2);
      dealii::Vector<double> right(n - 2), values(n - 2);
      const auto             conductance = [&](const int a, const int b) {
        const int step = std::abs(a - b);
        return step == 0 || step > reach ? 0. : along[step] / whole * volume(a) * volume(b);
      };
      for (int a = 1; a < n - 1; ++a)
        for (int b = 0; b < n; ++b)
          {
            matrix(a - 1, a - 1) += conductance(a, b);
            if (b > 0 && b < n - 1 && a != b)
              matrix(a - 1, b - 1) -= conductance(a, b);
            if (b == n - 1)
              right(a - 1) += conductance(a, b);
          }
      matrix.gauss_jordan();
      matrix.vmult(values, right);
      double flow = conductance(0, n - 1);
      for (int a = 1; a < n - 1; ++a)
        flow += conductance(0, a) * values(a - 1);
      return 1. / flow - (at_centers ? n : n - 1);
    }


    /** Of the two sides across a direction those with a given value. */
    template <int dim>
    unsigned int n_given(const Scene<dim> &scene, const unsigned int axis)
    {
      const auto &given = scene.boundary_conditions.dirichlet;
      return std::count_if(given.begin(), given.end(), [&](const auto &value) {
        return value.id < 2 * dim && value.id / 2 == axis;
      });
    }


    /** What sides that cut families make a body of bonds alone look like. */
    struct CutFamilies
    {
      double       most = 0., width = 0.;     // share of the width that is missing, along an axis
      double       longest = 0., length = 0.; // of what is too long, between given values
      unsigned int axis = 0, along = 0;
    };


    template <int dim>
    CutFamilies find_cut_families(const Scene<dim>                &scene,
                                  const KernelWeights<dim>        &weights,
                                  const std::array<bool, 2 * dim> &cut)
    {
      const Peridynamics &p       = scene.peridynamics;
      const bool          partial = p.sampling.nodal_volume == NodalVolume::partial,
                 at_centers       = scene.domain.has_nodes_at_centers();
      const double first_row      = at_centers || !partial ? 1. : 0.5;
      CutFamilies  result;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double cells = scene.domain.cells[d];
          if (const unsigned int n = cut[2 * d] + cut[2 * d + 1]; dim > 1 && n > 0)
            {
              const double one = missing_width<dim>(weights.members(), d, first_row);
              if (n * one / cells > result.most)
                {
                  result.most  = n * one / cells;
                  result.width = one * scene.domain.spacing()[d];
                  result.axis  = d;
                }
            }
          if (const unsigned int n = n_given(scene, d);
              p.treatment == BoundaryTreatment::none && n > 0 && cells > 3)
            {
              const double extra = 0.5 * n *
                                   extra_length<dim>(weights.members(),
                                                     d,
                                                     scene.domain.cells[d] + (at_centers ? 0 : 1),
                                                     first_row,
                                                     at_centers);
              if (std::abs(extra) / cells > std::abs(result.longest))
                {
                  result.longest = extra / cells;
                  result.length  = extra * scene.domain.spacing()[d];
                  result.along   = d;
                }
            }
        }
      return result;
    }


    /**
     * What a body of bonds alone lacks along sides that cut families, or conducts too much or too
     * little between sides with given values; why it is of bonds alone, and what to do.
     */
    template <int dim>
    std::string note_on_cut_families(const Scene<dim> &scene, const KernelWeights<dim> &weights)
    {
      const Peridynamics &p = scene.peridynamics;
      if (!scene.domain.has_lattice() || weights.members().empty() ||
          p.surface_correction == SurfaceCorrection::energy)
        return {};
      const auto cut       = sides_that_cut(scene);
      const bool of_itself = !p.is_given("Boundary treatment");
      const auto [most, width, longest, length, axis, along] =
        find_cut_families(scene, weights, cut);
      if (!of_itself && most < tolerable_missing_share &&
          std::abs(longest) < tolerable_missing_share)
        return {};
      std::string what;
      if (most > 0.)
        {
          std::vector<std::string> names;
          for (unsigned int side = 2 * axis; side < 2 * axis + 2; ++side)
            if (cut[side])
              names.push_back("'" + name_of_side(side, true) + "'");
          what = "families end at the " + std::string(names.size() == 1 ? "side " : "sides ") +
                 join_names(names) + ": along " + (names.size() == 1 ? "it" : "each of them") +
                 " the body conducts as if it was " + rounded_text(width) + " narrower, " +
                 rounded_text(100. * most) + " % of its width in all. ";
        }
      if (longest != 0.)
        what +=
          std::string(most > 0. ? "Between" : "families end at sides with given values: between") +
          " sides with given values it conducts along " + "xyz"[along] + " as if it was " +
          rounded_text(std::abs(length)) + (length > 0. ? " longer, " : " shorter, ") +
          rounded_text(100. * std::abs(longest)) + " %. ";
      if (what.empty())
        return {};
      const auto        obstacle = scene.obstacle_to_bonds_on_elements();
      const std::string symmetry =
        dim > 1 ?
          ", nor does 'Symmetry' (section 'Boundary conditions') at sides without a given value." :
          ".";
      const std::string exchange = "'Boundary treatment = exchange' in section 'Peridynamics'";
      if (obstacle.first.empty())
        return what + exchange + " lacks nothing there" + symmetry;
      return what +
             (of_itself ?
                "'Boundary treatment = auto' in section 'Peridynamics' is 'none' here and not "
                "'exchange', which lacks nothing there: " :
                exchange + " lacks nothing there, but is not for what this scene has: ") +
             obstacle.first + " " + obstacle.second + ".";
    }


    /** The energy correction in one direction, beside cracks. Collective. */
    template <int dim>
    std::string note_on_one_direction(const Scene<dim> &scene, const DiffusionBonds<dim> &bonds)
    {
      constexpr double    much = 1.1;
      const Peridynamics &p    = scene.peridynamics;
      if (dim == 1 || scene.cracks.cracks.empty() ||
          p.surface_correction != SurfaceCorrection::energy ||
          p.correction_direction == CorrectionDirection::both)
        return {};
      double                                          largest = 0.;
      std::vector<typename DiffusionBonds<dim>::Bond> family;
      for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
        if (bonds.near_crack(i))
          {
            bonds.bonds_of(i, family, false);
            for (const auto &bond : family)
              if (!bond.cut)
                largest = std::max(largest, bond.weight / bond.intact);
          }
      largest = Utilities::MPI::max(largest, bonds.nodes().communicator());
      if (largest < much)
        return {};
      const std::string direction(1, "xyz"[static_cast<unsigned int>(p.correction_direction)]);
      return "'Correction direction = " + direction +
             "' in section 'Peridynamics' makes all bonds of a node stronger for those that it lacks in " +
             direction + ", beside cracks up to " + rounded_text(largest) +
             " times: along the crack the body conducts too much there. With 'both' each direction has its own factor.";
    }


    template <int dim>
    class BondDiffusion : public DiffusionField<dim>
    {
    public:
      using Field<dim>::scene;
      using Field<dim>::node_set;

      BondDiffusion(Model<dim> &on, const Scene<dim> &scene)
        : DiffusionField<dim>(on, scene)
      {
        this->make_bond_nodes();
        Timings::Scope scope(this->timings, "operator");
        diffusion = field_of_bonds(*node_set, scene);
        doubt     = note_on_one_direction(scene, bonds().diffusion_bonds());
      }

      FieldOperator<dim> &op() const override
      {
        return *diffusion;
      }

      void set_initial_value(Vector &u) const override
      {
        for (unsigned int i = 0; i < node_set->n_owned(); ++i)
          u.local_element(i) = scene.initial_and_source.initial_value.value(node_set->position(i));
      }

      std::vector<OutputField> derived_fields(const Vector &u, const double t) const override
      {
        VectorField<dim> two_sided, one_sided;
        for (unsigned int d = 0; d < dim; ++d)
          {
            diffusion->initialize_vector(two_sided[d]);
            diffusion->initialize_vector(one_sided[d]);
          }
        bond_heat_flux<dim>(bonds().diffusion_bonds(),
                            u,
                            bonds().values({u, t}),
                            two_sided,
                            one_sided);
        std::array<Vector, 1> volumes, cuts;
        diffusion->initialize_vector(volumes[0]);
        diffusion->initialize_vector(cuts[0]);
        for (unsigned int i = 0; i < node_set->n_owned(); ++i)
          volumes[0].local_element(i) = node_set->volume(i);
        cut_fraction(bonds().diffusion_bonds(), cuts[0]);
        std::vector<OutputField> fields;
        const std::string        name = names_of(scene.general.physics).flux;
        fields.push_back(vector_field<dim>(name, two_sided));
        fields.push_back(vector_field<dim>(name + "_one_sided", one_sided));
        if (scene.general.physics == Physics::moisture)
          {
            std::array<Vector, 1> concentration{u};
            for (unsigned int i = 0; i < node_set->n_owned(); ++i)
              concentration[0].local_element(i) =
                scene.material.saturated_concentration.value(node_set->position(i)) *
                u.local_element(i);
            fields.push_back(vector_field<1>("concentration", concentration));
          }
        fields.push_back(vector_field<1>("node_volume", volumes));
        fields.push_back(vector_field<1>("cut_fraction", cuts));
        return fields;
      }

      double weight(const Vector &u) const override
      {
        double sum = 0.;
        for (unsigned int i = 0; i < node_set->n_owned(); ++i)
          sum += scene.material.saturated_concentration.value(node_set->position(i)) *
                 node_set->volume(i) * u.local_element(i);
        return Utilities::MPI::sum(sum, this->handler.get_communicator());
      }

      Difference difference_to(
        const Vector                                    &u,
        const std::function<double(const Point<dim> &)> &exact) const override
      {
        Vector expected;
        diffusion->initialize_vector(expected);
        for (unsigned int i = 0; i < node_set->n_owned(); ++i)
          expected.local_element(i) = exact(node_set->position(i));
        return nodal_difference(u, expected, [&](const unsigned int i) {
          return node_set->volume(i);
        });
      }

      ChosenSettings settings() const override
      {
        auto list = this->bond_settings(bonds().diffusion_bonds().families());
        if (!scene.material.uniform_conductivity())
          list.emplace_back("interface rule", name_of(scene.material.interface_rule));
        list.emplace_back("operator form", bonds().form_note());
        return list;
      }

      std::vector<std::string> notes() const override
      {
        const Peridynamics      &p = scene.peridynamics;
        std::vector<std::string> list;
        const double effective = bonds().diffusion_bonds().weights().effective_conductivity();
        if (std::abs(effective - 1.) > tolerable_conductivity_error)
          list.push_back(
            "complete families conduct " + rounded_text(effective, 6) +
            " times 'Conductivity' (section 'Material'), because of '" +
            (p.sampling.self_term == SelfTerm::paper ? "Self term = paper" :
                                                       "Calibration = analytic") +
            "' in section 'Peridynamics'; with " +
            (p.sampling.self_term == SelfTerm::paper ? "'Self term = none' and " : "") +
            "'Calibration = discrete' it is 1.");
        if (p.treatment == BoundaryTreatment::fictitious_constant)
          list.emplace_back(
            "'Boundary treatment = fictitious constant' in section 'Peridynamics' is of first order in the spacing "
            "only; 'fictitious mirror' is of second order.");
        if (const double ratio = ratio_of_phases(scene.material);
            ratio >= much && scene.material.interface_rule != InterfaceRule::harmonic)
          list.push_back(
            "the phases conduct " + rounded_text(ratio, 6) +
            " : 1, and bonds between them have the " + name_of(scene.material.interface_rule) +
            (scene.material.interface_rule == InterfaceRule::arithmetic ? " mean" : "") +
            ", which is right for what flows along the interface; 'Interface rule = harmonic' in section "
            "'Material' is right for what crosses it, as around inclusions.");
        for (const std::string &note :
             {note_on_cut_families(scene, bonds().diffusion_bonds().weights()), doubt})
          if (!note.empty())
            list.push_back(note);
        return list;
      }

    private:
      const ExtendedBondTerm<dim> &bonds() const
      {
        return bonds_of(*diffusion);
      }

      static constexpr double much = 3.;

      std::unique_ptr<FieldOperator<dim>> diffusion;
      std::string                         doubt; // about the surface correction
    };
  } // namespace


  template <int dim>
  double missing_width(const std::vector<FamilyMember<dim>> &family,
                       const unsigned int                    axis,
                       const double                          first_row)
  {
    const unsigned int along = (axis + 1) % dim;
    const auto         part  = [&](const FamilyMember<dim> &member) {
      const double step = member.offset[along];
      return member.weight * step * step;
    };
    double whole   = 0.;
    int    reaches = 0;
    for (const FamilyMember<dim> &member : family)
      {
        whole += part(member);
        reaches = std::max(reaches, member.offset[axis]);
      }
    double     missing = 0.;
    const auto volume  = [&](const int row) { return row == 0 ? first_row : 1.; };
    for (int row = 0; row < reaches; ++row)
      {
        double there = 0.;
        for (const FamilyMember<dim> &member : family)
          if (row + member.offset[axis] >= 0)
            there += volume(row + member.offset[axis]) * part(member);
        missing += volume(row) * (1. - there / whole);
      }
    return missing;
  }


  template <int dim>
  std::unique_ptr<DiffusionField<dim>> make_bond_diffusion(Model<dim>       &model,
                                                           const Scene<dim> &scene)
  {
    return std::make_unique<BondDiffusion<dim>>(model, scene);
  }


  PERIDEAL_INSTANTIATE_FUNCTION(make_bond_diffusion);
  PERIDEAL_INSTANTIATE_FUNCTION(missing_width);
} // namespace PeriDeal
