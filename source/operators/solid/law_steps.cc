// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/laws/bond_force_formula.h>
#include <perideal/laws/viscoelastic_solid.h>
#include <perideal/operators/solid/law_steps.h>
#include <perideal/scene/expression.h>

#include <algorithm>
#include <functional>
#include <map>
#include <unordered_map>

namespace PeriDeal
{
  namespace
  {
    using Maker = std::function<std::unique_ptr<BondLaw>(const Material::Law &)>;

    /** The one list of laws, but for the linear one, which is LinearPeridynamicSolid. */
    const std::map<SolidLaw, Maker> &makers()
    {
      static const std::map<SolidLaw, Maker> list = {
        {SolidLaw::viscoelastic,
         [](const Material::Law &law) {
           return std::make_unique<ViscoelasticSolid>(law.relaxation);
         }},
        {SolidLaw::formula, [](const Material::Law &law) {
           return std::make_unique<BondForceFormula>(
             [force = law.bond_force](const double s, const double damage) {
               return force.value(dealii::Point<2>(s, damage));
             });
         }}};
      return list;
    }
  } // namespace


  LawSteps::LawSteps(const Material::Law &of_scene)
  {
    const auto found = makers().find(of_scene.kind);
    if (found != makers().end())
      law = found->second(of_scene);
    set_time(0.);
  }


  void LawSteps::set_time(const double t) const
  {
    if (any())
      law->set_step(begun ? std::max(0., t - accepted) : 0.);
  }


  void LawSteps::accept(const double t)
  {
    begun    = true;
    accepted = t;
    set_time(t);
  }


  void LawSteps::exchange(Archive &archive)
  {
    archive.exchange("begun", begun);
    archive.exchange("accepted", accepted);
    if (archive.loads())
      set_time(accepted);
  }


  template <int dim>
  void require_law(const BodyParameters<dim> &body, const bool by_elements, const bool coupled)
  {
    const Material   &material = body.material;
    const SolidLaw    kind     = material.law.kind;
    const std::string with_elements =
      ", beside or instead of finite elements; use 'Models = peridynamics'.";
    if (kind == SolidLaw::linear)
      return;
    body.coupling.refuse(
      kind == SolidLaw::viscoelastic && coupled && body.coupling.scheme != CouplingScheme::blending,
      "Scheme",
      "found '" + body.coupling.text("Scheme") +
        "', whose bonds take over bulk stiffness, too; with 'Law = viscoelastic' in section 'Material' use 'blending'.");
    material.refuse(
      kind == SolidLaw::formula && by_elements && !coupled,
      "Law",
      "'formula' is one of bonds, and 'Models' has 'finite elements'. Leave them out.");
    const bool is_warm = body.elasticity.computes_temperature ||
                         !is_zero(body.elasticity.temperature_change);
    material.refuse(by_elements && is_warm,
                    "Law",
                    "found '" + material.text("Law") +
                      "', which knows no 'Temperature change' (section 'Elasticity')" +
                      with_elements);
    material.refuse(
      kind == SolidLaw::viscoelastic && dim == 2 && is_warm,
      "Law",
      "'viscoelastic' knows no 'Temperature change' (section 'Elasticity') in plane strain, where what the temperature strains the body by out of the plane would relax, too; use 'Dimension = 3'.");
    body.coupling.refuse(
      kind == SolidLaw::formula && coupled && body.coupling.splices(),
      "Scheme",
      "'splice' is for 'Law = linear' (section 'Material'); use 'exchange' or 'blending'.");
    material.refuse(
      kind == SolidLaw::viscoelastic && (dim == 1 || body.elasticity.is_bond_based()),
      "Law",
      "'viscoelastic' is a shear modulus that relaxes while the bulk modulus stays: it "
      "is for 'Dimension' 2 and 3 with 'Model = state-based'.");
    material.refuse(
      kind == SolidLaw::viscoelastic && dim == 2 && body.elasticity.plane == PlaneState::stress,
      "Law",
      "'viscoelastic' is for 'Plane = strain' in section 'Elasticity': in plane stress "
      "the strain out of the plane would relax, too.");
    body.elasticity.refuse(
      kind == SolidLaw::formula && body.elasticity.solver == ElasticSolver::linear,
      "Solver",
      "is 'linear', but 'Law = formula' in section 'Material' is not. Use 'conjugate gradients', or 'dynamics'.");
    body.elasticity.refuse(body.elasticity.absolute_reference.has_value(),
                           "Heat of deformation",
                           "is that of the linear law; 'Law' in section 'Material' is '" +
                             material.text("Law") + "'.");
  }


  void exchange_history(Archive                    &archive,
                        const BondState::Numbering &numbering,
                        const NodeKeys             &keys,
                        const unsigned int          n,
                        std::vector<double>        &history)
  {
    KeyedPairs pairs; // a node, and the number of its bond among its own
    if (!archive.loads())
      {
        for (std::size_t number = 0; number < numbering.n_bonds(); ++number)
          {
            const std::size_t node = numbering.node_of(number);
            pairs.keys.push_back({keys[node], number - numbering.first_of(node)});
          }
        pairs.values = history;
      }
    archive.exchange("history", pairs, keys);
    if (!archive.loads())
      return;
    std::unordered_map<std::uint64_t, std::size_t> node_of;
    for (std::size_t node = 0; node < keys.size(); ++node)
      node_of[keys[node]] = node;
    for (std::size_t k = 0; k < pairs.keys.size(); ++k)
      {
        const std::size_t first = numbering.first_of(node_of.at(pairs.keys[k][0]));
        std::copy_n(pairs.values.begin() + n * k,
                    n,
                    history.begin() + n * (first + pairs.keys[k][1]));
      }
  }


  PERIDEAL_INSTANTIATE_FUNCTION(require_law);
} // namespace PeriDeal
