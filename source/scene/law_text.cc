// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/scene/law_text.h>
#include <perideal/scene/rules.h>

namespace PeriDeal
{
  namespace
  {
    std::string kind_text(const Material &material, const bool is_full, const bool by_elements)
    {
      const Material::Law &law = material.law;
      switch (law.kind)
        {
          case SolidLaw::linear:
            return !law.orthotropy.young.empty()          ? "linear, orthotropic" :
                   is_full && by_elements                 ? "linear (Saint Venant and Kirchhoff)" :
                   material.given.depend_on_temperature() ? "linear" :
                                                            "";
          case SolidLaw::viscoelastic:
            return "viscoelastic (Prony), terms: " + std::to_string(law.relaxation.size());
          case SolidLaw::plastic:
            return "plastic (J2)";
          case SolidLaw::softening:
            return "softening, " + material.text("Softening");
          case SolidLaw::formula:
            return "formula, " + material.text("Bond force");
          case SolidLaw::hyperelastic:
            return "hyperelastic (neo-Hooke)";
          default:
            return law.user.library +
                   ", properties: " + std::to_string(law.user.properties.size()) +
                   ", states: " + std::to_string(law.user.n_states);
        }
    }
  } // namespace


  template <int dim>
  std::string law_text(const BodyParameters<dim> &body, const ModelKind model)
  {
    const bool  by_elements = model != ModelKind::peridynamics;
    std::string text = kind_text(body.material, body.elasticity.has_full_kinematics(), by_elements);
    if (text.empty())
      return text;
    if (body.material.given.depend_on_temperature())
      text += ", moduli of the temperature";
    const SolidLaw    kind      = body.material.law.kind;
    const bool        of_bonds  = kind == SolidLaw::softening || kind == SolidLaw::formula;
    const std::string in_points = "at the quadrature points of elements",
                      points    = of_bonds ? "elements are linear" : in_points,
                      remembers = relaxes_at_nodes(body) ? ", remembered at nodes" : "";
    const std::string bonds =
      body.elasticity.is_correspondence() ? "at nodes (correspondence)" :
      body.material.law.yields()          ? "of families (state-based)" :
                                   "of bonds (" + body.elasticity.text("Model") + ")" + remembers;
    return text + "; " +
           (model == ModelKind::finite_elements ? points :
            model == ModelKind::coupled         ? bonds + " and " + points :
                                                  bonds);
  }


  PERIDEAL_INSTANTIATE_FUNCTION(law_text);
} // namespace PeriDeal
