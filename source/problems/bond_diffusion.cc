// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_q.h>

#include <perideal/analysis/heat_flux.h>
#include <perideal/operators/diffusion/bond_operator.h>
#include <perideal/problems/diffusion_bounds.h>
#include <perideal/scene/beyond_sides.h>

#include <algorithm>
#include <limits>

#include "diffusion_notes.h"
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


    template <int dim>
    class BondDiffusion : public DiffusionProblem<dim>
    {
    public:
      using DiffusionProblem<dim>::scene;

      BondDiffusion(Model<dim> &model, const Scene<dim> &scene)
        : DiffusionProblem<dim>(scene)
        , handler(model.dofs())
      {
        {
          Timings::Scope scope(this->timings, "unknowns");
          node_set = &make_bond_nodes(model, scene);
        }
        Timings::Scope scope(this->timings, "operator");
        bonds = std::make_unique<BondOperator<dim>>(*node_set, scene);
        doubt = note_on_one_direction(scene, bonds->diffusion_bonds());
      }

      std::string name() const override
      {
        return scene.general.name_of(ModelKind::peridynamics);
      }

      const DoFHandler<dim> &dofs() const override
      {
        return handler;
      }

      const Nodes<dim> *nodes() const override
      {
        return node_set;
      }

      Point<dim> position(const unsigned int node) const override
      {
        return node_set->position(node);
      }

      double volume(const unsigned int node) const override
      {
        return node_set->volume(node);
      }

      DiffusionOperator &op() const override
      {
        return *bonds;
      }

      bool update(const double t) override
      {
        const bool changed = bonds->update(t);
        if (changed)
          cut.reinit(0);
        return changed;
      }

      bool follow(const ChangeSet<dim> &damage) override
      {
        cut.reinit(0);
        return bonds->follow(damage);
      }

      void set_initial_value(Vector &u) const override
      {
        for (unsigned int i = 0; i < node_set->n_owned(); ++i)
          u.local_element(i) = scene.initial_and_source.initial_value.value(node_set->position(i));
      }

      std::string field_name() const override
      {
        return names_of(scene.general.physics).field;
      }

      std::vector<OutputField> derived_fields(const Vector &u, const double t) const override
      {
        VectorField<dim>    two_sided, one_sided;
        std::vector<double> outside;
        for (unsigned int d = 0; d < dim; ++d)
          {
            bonds->initialize_vector(two_sided[d]);
            bonds->initialize_vector(one_sided[d]);
          }
        bonds->fictitious_values(u, t, outside);
        bond_heat_flux<dim>(bonds->diffusion_bonds(), u, outside, two_sided, one_sided);
        if (node_volumes.size() == 0)
          {
            bonds->initialize_vector(node_volumes);
            for (unsigned int i = 0; i < node_set->n_owned(); ++i)
              node_volumes.local_element(i) = node_set->volume(i);
          }
        if (cut.size() == 0)
          {
            bonds->initialize_vector(cut);
            cut_fraction(bonds->diffusion_bonds(), cut);
          }
        std::array<Vector, 1>    volumes{node_volumes}, cuts{cut};
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
        return Utilities::MPI::sum(sum, handler.get_communicator());
      }

      Difference difference_to(
        const Vector                                    &u,
        const std::function<double(const Point<dim> &)> &exact) const override
      {
        Vector expected;
        bonds->initialize_vector(expected);
        for (unsigned int i = 0; i < node_set->n_owned(); ++i)
          expected.local_element(i) = exact(node_set->position(i));
        return nodal_difference(u, expected, [&](const unsigned int i) {
          return node_set->volume(i);
        });
      }

      std::vector<std::pair<std::string, std::string>> settings() const override
      {
        auto list = bond_settings(scene, bonds->diffusion_bonds().families());
        if (!scene.material.uniform_conductivity())
          list.emplace_back("interface rule", name_of(scene.material.interface_rule));
        list.emplace_back("operator form", bonds->form_note());
        return list;
      }

      std::vector<std::string> own_notes() const override
      {
        const Peridynamics      &p = scene.peridynamics;
        std::vector<std::string> list;
        const double effective = bonds->diffusion_bonds().weights().effective_conductivity();
        if (std::abs(effective - 1.) > tolerable_conductivity_error)
          list.push_back(
            "complete families conduct " + to_text(effective) +
            " times 'Conductivity' (section 'Material'), because of '" +
            (p.self_term == SelfTerm::paper ? "Self term = paper" : "Calibration = analytic") +
            "' in section 'Peridynamics'; with " +
            (p.self_term == SelfTerm::paper ? "'Self term = none' and " : "") +
            "'Calibration = discrete' it is 1.");
        if (p.treatment == BoundaryTreatment::fictitious_constant)
          list.emplace_back(
            "'Boundary treatment = fictitious constant' in section 'Peridynamics' is of first order in the spacing "
            "only; 'fictitious mirror' is of second order.");
        if (const double ratio = ratio_of_phases(scene.material);
            ratio >= much && scene.material.interface_rule != InterfaceRule::harmonic)
          list.push_back(
            "the phases conduct " + to_text(ratio) + " : 1, and bonds between them have the " +
            name_of(scene.material.interface_rule) +
            (scene.material.interface_rule == InterfaceRule::arithmetic ? " mean" : "") +
            ", which is right for what flows along the interface; 'Interface rule = harmonic' in section "
            "'Material' is right for what crosses it, as around inclusions.");
        for (const std::string &note :
             {note_on_cut_families(scene, bonds->diffusion_bonds().weights()), doubt})
          if (!note.empty())
            list.push_back(note);
        return list;
      }

    private:
      static constexpr double much = 3.;

      const DoFHandler<dim>             &handler;
      Nodes<dim>                        *node_set = nullptr; // of the model
      std::unique_ptr<BondOperator<dim>> bonds;
      std::string                        doubt; // about the surface correction
      mutable Vector                     node_volumes,
        cut; // for output; empty until needed, and when the cracks have changed
    };
  } // namespace


  template <int dim>
  std::vector<std::pair<std::string, std::string>> bond_settings(const Scene<dim>    &scene,
                                                                 const Families<dim> &families)
  {
    static const char *const kernels[]   = {"constant", "conical", "gaussian"};
    static const char *const fractions[] = {"none", "linear", "exact"};
    static const char *const treatments[] =
      {"auto", "exchange", "none", "layer", "fictitious mirror", "fictitious constant"};
    static const char *const fluxes[] = {"natural", "extrapolation", "layer extrapolation"};
    const Peridynamics      &p        = scene.peridynamics;
    std::vector<std::pair<std::string, std::string>> list{
      {"nodes", scene.domain.nodes == NodePlacement::vertices ? "vertices" : "cell centers"},
      {"horizon", to_text(scene.horizon())},
      {"m", to_text(scene.horizon() / families.nodes().smallest_spacing())},
      {"kernel",
       std::string(kernels[static_cast<int>(p.kernel)]) + ", exponent " +
         std::to_string(p.kernel_exponent)},
      {"volume fraction", fractions[static_cast<int>(p.volume_fraction)]},
      {"calibration",
       p.calibration == Calibration::analytic     ? "analytic" :
       families.weights().has_complete_families() ? "discrete" :
                                                    "analytic, because no family is complete"},
      {"self term", p.self_term == SelfTerm::none ? "none" : "paper"},
      {"boundary treatment", treatments[static_cast<int>(p.treatment)]},
      {"flux treatment", fluxes[static_cast<int>(p.flux_treatment)]},
      {"surface correction",
       p.surface_correction == SurfaceCorrection::automatic ?
         "auto: " + automatic_correction(scene) :
       p.surface_correction == SurfaceCorrection::none          ? "none" :
       p.surface_correction == SurfaceCorrection::crack_scaling ? "crack scaling" :
       p.surface_correction == SurfaceCorrection::moments       ? "moments" :
       p.completes_families()                                   ? "fictitious nodes" :
       scene.general.physics == Physics::elasticity ?
                                "energy" :
       p.correction_direction == CorrectionDirection::both ?
                                "energy, each direction" :
                                std::string("energy, direction ") +
                                  "xyz"[static_cast<int>(p.correction_direction)]}};
    return list;
  }


  template <int dim>
  Nodes<dim> &make_bond_nodes(Model<dim> &model, const Scene<dim> &scene)
  {
    if (scene.domain.nodes == NodePlacement::vertices)
      model.number(FE_Q<dim>(1), scene.domain, true);
    else
      model.number(FE_DGQ<dim>(0), scene.domain, true);
    return model.nodes(scene, scene.peridynamics.nodal_volume);
  }


  template <int dim>
  std::unique_ptr<DiffusionProblem<dim>> make_bond_diffusion(Model<dim>       &model,
                                                             const Scene<dim> &scene)
  {
    return std::make_unique<BondDiffusion<dim>>(model, scene);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                    \
  template Nodes<dim>                            &make_bond_nodes(Model<dim> &, const Scene<dim> &); \
  template std::unique_ptr<DiffusionProblem<dim>> make_bond_diffusion(Model<dim> &,                  \
                                                                      const Scene<dim> &);           \
  template std::vector<std::pair<std::string, std::string>> bond_settings(const Scene<dim> &,        \
                                                                          const Families<dim> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
