// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/scene/rules.h>

#include <array>
#include <cmath>

namespace PeriDeal
{
  namespace
  {
    template <int dim>
    void refuse_softening_bonds(const BodyParameters<dim> &body,
                                const bool                 by_elements,
                                const bool                 coupled)
    {
      if (!body.material.law.softens())
        return;
      body.material.refuse(
        by_elements && !coupled,
        "Law",
        "'softening' is one of bonds, and is for 'Models = peridynamics' and 'coupled'.");
      body.coupling.refuse(
        coupled && body.coupling.scheme != CouplingScheme::blending,
        "Scheme",
        "found '" + body.coupling.text("Scheme") +
          "', whose elements go on to hold what bonds that soften let go ('Law = softening' in section 'Material'). Use 'blending'.");
      body.material.refuse(
        !body.cracks.tips.empty(),
        "Law",
        "'softening' is not for cracks that grow by 'Growth' or 'Paths' (section 'Cracks'): bonds soften and break where they are stretched. Leave these out.");
      body.elasticity.refuse(
        body.elasticity.is_given("Breaking") && !body.elasticity.controls_loads(),
        "Breaking",
        "found '" + body.elasticity.text("Breaking") +
          "', which is for bonds that break at once; with 'Law = softening' (section 'Material') they soften from equilibrium to equilibrium. Leave it out, or use 'controlled'.");
      body.elasticity.refuse(
        body.elasticity.text("Crack direction") == "mean tension",
        "Crack direction",
        "'mean tension' is for bonds that break at once, not for 'Law = softening' (section 'Material'). Leave it out.");
    }


    template <int dim>
    bool is_warm_body(const BodyParameters<dim> &body)
    {
      return body.elasticity.computes_temperature || !is_zero(body.elasticity.temperature_change);
    }


    /** What laws of stresses are not for, by refuse(is so, why). */
    template <int dim, typename Refuse>
    void refuse_cracks(const BodyParameters<dim> &body, const Refuse &refuse)
    {
      refuse(body.material.breaks(),
             "whose bonds do not break: leave 'Fracture energy' and 'Critical stretch' out.");
      refuse(!body.cracks.tips.empty(),
             "which is not for cracks that grow by 'Growth' or 'Paths' (section 'Cracks').");
    }


    /** The same of those of small displacements. */
    template <int dim, typename Refuse>
    void refuse_large_changes(const BodyParameters<dim> &body, const Refuse &refuse)
    {
      refuse(body.elasticity.has_full_kinematics(),
             "which is for small displacements: use 'Kinematics = linear' (section 'Elasticity').");
      refuse_cracks(body, refuse);
    }


    template <int dim>
    void refuse_plastic_body(const BodyParameters<dim> &body,
                             const bool                 by_elements,
                             const bool                 coupled)
    {
      if (!body.material.law.yields())
        return;
      const auto refuse = [&](const bool is_so, const std::string &why) {
        body.material.refuse(is_so, "Law", "found 'plastic', " + why);
      };
      refuse(
        coupled && !body.elasticity.is_correspondence(),
        "which 'coupled' in 'Models' knows with 'Model = correspondence' (section 'Elasticity') alone. Use that, or leave 'coupled' out.");
      refuse(dim == 1, "which is for 'Dimension' 2 and 3.");
      refuse(
        body.elasticity.is_bond_based(),
        "a yield stress for shear alone, which 'Model = bond-based' (section 'Elasticity') cannot have. Use 'state-based'.");
      refuse_large_changes(body, refuse);
      body.peridynamics.refuse(
        !by_elements && body.peridynamics.corrects_elastic_bonds(),
        "Surface correction",
        "found '" + body.peridynamics.text("Surface correction") +
          "', whose factors of bonds are those of linear forces; with 'Law = plastic' in section 'Material' use 'auto', 'fictitious nodes' or 'none'.");
      const bool is_warm = is_warm_body(body);
      refuse(
        coupled && is_warm,
        "which knows no 'Temperature change' (section 'Elasticity') in 'coupled'; use 'Models = finite elements' or 'peridynamics'.");
      for (const auto &[entry, formula] :
           {std::make_pair("Yield stress", *body.material.law.yield_stress),
            std::make_pair("Hardening modulus", body.material.law.hardening)})
        body.material.refuse(
          !is_warm && formula.depends_on_temperature(),
          entry,
          "depends on T, but the temperature does not change: 'Temperature change' in section 'Elasticity' is 0.");
      body.elasticity.refuse(
        body.elasticity.solver == ElasticSolver::linear,
        "Solver",
        "is 'linear', but 'Law = plastic' in section 'Material' is not. Use 'newton', 'conjugate gradients', or 'dynamics'.");
    }


    /** The entry of the two moduli in whose formula T is, if it is in some. */
    std::string warm_modulus(const Material &material)
    {
      constexpr std::array<const char *, 4> names{
        {"Bulk modulus", "Shear modulus", "Young modulus", "Poisson ratio"}}; // as Modulus
      const bool is_first = material.given.properties[0].depends_on_temperature();
      return names[static_cast<unsigned int>(material.given.which[is_first ? 0 : 1])];
    }


    /** Moduli and thermal expansion with T. */
    template <int dim>
    void refuse_warm_material(const BodyParameters<dim> &body, const bool coupled)
    {
      const Material &material    = body.material;
      const bool      warm_moduli = material.given.depend_on_temperature(),
                 warm_expansion   = material.thermal_expansion.depends_on_temperature();
      const std::string modulus   = warm_modulus(material);
      for (const auto &[is_so, entry] :
           {std::make_pair(warm_moduli, modulus),
            std::make_pair(warm_expansion, std::string("Thermal expansion"))})
        {
          const auto refuse = [&, &entry = entry, &is_so = is_so](const bool         also,
                                                                  const std::string &why) {
            material.refuse(is_so && also, entry, "depends on T, " + why);
          };
          refuse(
            !is_warm_body(body),
            "but the temperature does not change: 'Temperature change' in section 'Elasticity' is 0.");
          refuse(
            body.elasticity.absolute_reference.has_value(),
            "which 'Heat of deformation' (section 'Elasticity') does not know. Leave one of them out.");
        }
      const auto refuse = [&](const bool also, const std::string &why) {
        material.refuse(warm_moduli && also, modulus, "depends on T, " + why);
      };
      refuse(material.law.kind != SolidLaw::linear && !material.law.yields(),
             "which 'Law = " + material.text("Law") +
               "' does not know; 'linear' and 'plastic' do. Use one of these, or leave T out.");
      refuse(
        coupled && body.moduli_change(),
        "and 'Temperature change' (section 'Elasticity') is 'computed', but in 'Models = coupled' moduli are those of a temperature that is given. Use 'finite elements' or 'peridynamics', or a formula as 'Temperature change'.");
      refuse(
        body.moduli_change() &&
          (material.fracture_energy.has_value() || !material.law.interfaces.empty()),
        "and 'Temperature change' (section 'Elasticity') is 'computed', but the stretch that follows from 'Fracture energy' or 'Interfaces' is that of moduli that stay. Give 'Critical stretch', which may depend on T, too.");
    }


    template <int dim>
    void refuse_user_law(const BodyParameters<dim> &body,
                         const bool                 by_elements,
                         const bool                 coupled)
    {
      body.elasticity.refuse(
        body.material.law.kind == SolidLaw::user_bonds &&
          body.elasticity.solver == ElasticSolver::linear,
        "Solver",
        "is 'linear', but 'Law = user' in section 'Material' need not be. Use 'newton', 'conjugate "
        "gradients', or 'dynamics'.");
      if (body.material.law.kind != SolidLaw::user)
        return;
      const auto refuse = [&](const bool is_so, const std::string &why) {
        body.material.refuse(is_so, "Law", "found 'user', " + why);
      };
      refuse(
        (!by_elements || coupled) && !body.elasticity.is_correspondence(),
        "a law of stresses, which is for 'Models = finite elements', and for 'peridynamics' and 'coupled' with 'Model = correspondence' (section 'Elasticity'), or of bonds, for 'Models = peridynamics' alone. Use these.");
      refuse(dim == 1, "which is for 'Dimension' 2 and 3.");
      body.elasticity.refuse(
        body.elasticity.has_full_kinematics() && dim == 2 &&
          body.elasticity.plane == PlaneState::stress,
        "Kinematics",
        "found 'full' with 'Law = user' (section 'Material'), which has large deformations in three dimensions and in plane strain. Use 'Plane = strain', or 'linear' here.");
      refuse_cracks(body, refuse);
      refuse(
        is_warm_body(body) && (coupled || body.elasticity.has_full_kinematics()),
        "which knows no 'Temperature change' (section 'Elasticity') in 'coupled' and with 'Kinematics = full'; use 'Models = finite elements' or 'peridynamics' and 'Kinematics = linear'.");
      body.elasticity.refuse(
        !body.cracks.cracks.empty() && body.elasticity.contact,
        "Contact",
        "is '" + body.elasticity.text("Contact") +
          "', but what the faces of cracks press on each other with is not known of 'Law = user' (section 'Material'). Use 'false', with which they may run into each other.");
      body.elasticity.refuse(
        body.elasticity.solver == ElasticSolver::linear,
        "Solver",
        "is 'linear', but 'Law = user' in section 'Material' need not be. Use 'newton', 'conjugate "
        "gradients', or 'dynamics'.");
    }


    /** Laws of stresses of large deformations: hyperelastic ones, of elements linear ones, too. */
    template <int dim>
    void refuse_large_deformations(const BodyParameters<dim> &body,
                                   const bool                 by_elements,
                                   const bool                 coupled)
    {
      const bool is_hyperelastic = body.material.law.kind == SolidLaw::hyperelastic,
                 is_full         = body.elasticity.has_full_kinematics();
      const auto refuse          = [&](const bool is_so, const std::string &why) {
        if (is_hyperelastic)
          body.material.refuse(is_so, "Law", "found 'hyperelastic', " + why);
        else
          body.elasticity.refuse(is_so,
                                 "Kinematics",
                                 "found 'full' with 'Law = linear' (section 'Material'), " + why);
      };
      if (is_hyperelastic)
        {
          refuse(
            (!by_elements && !body.elasticity.is_correspondence()) || coupled,
            "a law of stresses, which is for 'Models = finite elements', and for 'peridynamics' with 'Model = correspondence' (section 'Elasticity'). Use these.");
          refuse(
            !is_full,
            "which is for large deformations: use 'Kinematics = full' (section 'Elasticity').");
          body.material.refuse(
            dim == 2 && body.elasticity.plane == PlaneState::stress &&
              body.material.uniform_moduli() &&
              !std::isfinite(body.moduli(dealii::Point<dim>()).bulk),
            "Poisson ratio",
            "is 0.5, but 'Law = hyperelastic' has a finite bulk modulus. Use less, such as 0.499.");
        }
      else if (!by_elements || coupled || !is_full || body.material.law.kind != SolidLaw::linear)
        return;
      refuse(dim == 1, "which is for 'Dimension' 2 and 3.");
      refuse_cracks(body, refuse);
      refuse(is_warm_body(body), "which knows no 'Temperature change' (section 'Elasticity').");
      refuse(
        !is_hyperelastic && dim == 2 && body.elasticity.plane == PlaneState::stress,
        "which finite elements have in three dimensions and in plane strain. Use 'Plane = strain', 'Law = hyperelastic', or 'Models = peridynamics'.");
    }


    template <int dim>
    void refuse_orthotropic_body(const BodyParameters<dim> &body,
                                 const bool                 by_elements,
                                 const bool                 coupled)
    {
      if (body.material.law.orthotropy.young.empty())
        return;
      const auto refuse = [&](const bool is_so, const std::string &why) {
        body.material.refuse(is_so, "Young moduli", why);
      };
      refuse(
        (!by_elements || coupled) && !body.elasticity.is_correspondence(),
        "makes the body orthotropic, which is for 'Models = finite elements': bonds have two moduli. Use that, or 'Model = correspondence' (section 'Elasticity'), or give "
        "'Young modulus' and 'Poisson ratio'.");
      refuse(
        (!by_elements || coupled) && body.material.breaks(),
        "makes the body orthotropic, whose bonds do not break: leave 'Fracture energy' and 'Critical stretch' out.");
      refuse(
        body.elasticity.computes_temperature || !is_zero(body.elasticity.temperature_change),
        "makes the body orthotropic, which knows no 'Temperature change' (section 'Elasticity'). Leave one of them out.");
      refuse(
        body.elasticity.absolute_reference.has_value(),
        "makes the body orthotropic, which knows no 'Heat of deformation' (section 'Elasticity'). Leave one of them out.");
    }


    template <int dim>
    void refuse_correspondence(const BodyParameters<dim> &body,
                               const bool                 by_elements,
                               const bool                 coupled)
    {
      if (!body.elasticity.is_correspondence() || (by_elements && !coupled))
        return;
      const auto refuse = [&](const bool is_so, const std::string &why) {
        body.elasticity.refuse(is_so, "Model", "found 'correspondence', " + why);
      };
      const SolidLaw kind = body.material.law.kind;
      body.coupling.refuse(
        coupled && body.coupling.scheme == CouplingScheme::exchange,
        "Scheme",
        "found 'exchange', whose bonds are pairs, but 'Model = correspondence' (section 'Elasticity') has families. Use 'blending'.");
      const bool is_nonlinear = kind != SolidLaw::linear;
      body.coupling.refuse(coupled && body.coupling.splices() && is_nonlinear,
                           "Scheme",
                           "'splice' is for 'Law = linear' (section 'Material'); use 'blending'.");
      refuse(
        coupled && is_nonlinear && kind != SolidLaw::viscoelastic && kind != SolidLaw::plastic &&
          kind != SolidLaw::user,
        "which 'Models = coupled' knows with 'Law' = linear, viscoelastic, plastic and user (section 'Material'), found '" +
          body.material.text("Law") +
          "'. Use one of these, or 'Models = peridynamics' or 'finite elements'.");
      body.peridynamics.refuse(
        coupled && body.peridynamics.completes_families(),
        "Surface correction",
        "found 'fictitious nodes', but families of 'Model = correspondence' (section 'Elasticity') end at the surface beside elements. Use 'auto' or 'none'.");
      body.material.refuse(
        coupled && kind == SolidLaw::viscoelastic && body.material.breaks(),
        "Law",
        "found 'viscoelastic' with 'Model = correspondence' (section 'Elasticity'), whose bonds do not break in 'Models = coupled': use 'state-based', or leave 'Fracture energy' and 'Critical stretch' out.");
      refuse(dim == 1, "which is for 'Dimension' 2 and 3. Use 'state-based'.");
      refuse(
        kind == SolidLaw::viscoelastic && is_warm_body(body),
        "whose viscoelastic bodies know no 'Temperature change'. Use 'state-based', with 'Dimension = 3'.");
      refuse(
        body.elasticity.has_full_kinematics() && kind != SolidLaw::hyperelastic &&
          kind != SolidLaw::user,
        "which is for small displacements, but with 'Law = hyperelastic' and 'user' (section 'Material'). Use one of these or 'Kinematics = linear', or 'state-based'.");
      refuse(kind == SolidLaw::softening || kind == SolidLaw::formula ||
               kind == SolidLaw::user_bonds,
             "whose nodes have a law of stresses; 'Law = " + body.material.text("Law") +
               "' (section 'Material') is one of bonds. Use 'state-based'.");
      refuse(
        !body.material.law.interfaces.empty(),
        "whose bonds know no 'Interfaces' (section 'Material'). Leave these out, or use 'state-based'.");
      refuse(
        body.elasticity.text("Crack direction") == "mean tension",
        "whose bonds do not tell the tension that 'Crack direction = mean tension' goes by. Use 'bonds' there, or 'state-based'.");
      body.peridynamics.refuse(
        body.peridynamics.corrects_elastic_bonds(),
        "Surface correction",
        "found '" + body.peridynamics.text("Surface correction") +
          "', whose factors are those of the bonds of 'Model = state-based'; nodes of 'correspondence' have their strain at surfaces, too. Use 'auto', 'fictitious nodes' or 'none'.");
    }
  } // namespace


  template <int dim>
  void refuse_law(const BodyParameters<dim> &body, const bool by_elements, const bool coupled)
  {
    const Material &material = body.material;
    const SolidLaw  kind     = material.law.kind;
    refuse_correspondence(body, by_elements, coupled);
    refuse_orthotropic_body(body, by_elements, coupled);
    refuse_large_deformations(body, by_elements, coupled);
    refuse_warm_material(body, coupled);
    if (kind == SolidLaw::linear)
      return;
    body.coupling.refuse(
      kind == SolidLaw::viscoelastic && coupled && body.coupling.scheme != CouplingScheme::blending,
      "Scheme",
      "found '" + body.coupling.text("Scheme") +
        "', whose bonds take over bulk stiffness, too; with 'Law = viscoelastic' in section 'Material' use 'blending'.");
    body.elasticity.refuse(
      kind == SolidLaw::viscoelastic && by_elements && !coupled &&
        body.elasticity.has_full_kinematics(),
      "Kinematics",
      "'full' is for finite elements with 'Law = hyperelastic', 'user' and 'linear' (section 'Material'). Use 'linear'.");
    material.refuse(
      kind == SolidLaw::formula && by_elements && !coupled,
      "Law",
      "'formula' is one of bonds, and 'Models' has 'finite elements'. Leave them out.");
    refuse_softening_bonds(body, by_elements, coupled);
    refuse_plastic_body(body, by_elements, coupled);
    refuse_user_law(body, by_elements, coupled);
    const bool is_warm = is_warm_body(body);
    material.refuse(by_elements && is_warm && !material.law.yields() && kind != SolidLaw::user,
                    "Law",
                    "found '" + material.text("Law") +
                      "', which knows no 'Temperature change' (section 'Elasticity'), beside or "
                      "instead of finite elements; use 'Models = peridynamics'.");
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
      "is for 'Dimension' 2 and 3 with 'Model = state-based' and 'correspondence'.");
    material.refuse(
      kind == SolidLaw::viscoelastic && dim == 2 && body.elasticity.plane == PlaneState::stress,
      "Law",
      "'viscoelastic' is for 'Plane = strain' in section 'Elasticity': in plane stress "
      "the strain out of the plane would relax, too.");
    body.elasticity.refuse(
      kind == SolidLaw::formula && body.elasticity.solver == ElasticSolver::linear,
      "Solver",
      "is 'linear', but 'Law = formula' in section 'Material' is not. Use 'newton', 'conjugate gradients', or 'dynamics'.");
    body.elasticity.refuse(body.elasticity.absolute_reference.has_value(),
                           "Heat of deformation",
                           "is that of the linear law; 'Law' in section 'Material' is '" +
                             material.text("Law") + "'.");
  }


  template <int dim>
  bool relaxes_at_nodes(const BodyParameters<dim> &body)
  {
    return body.material.law.kind == SolidLaw::viscoelastic &&
           (body.elasticity.is_correspondence() ||
            (!body.elasticity.has_full_kinematics() && !is_warm_body(body) &&
             body.peridynamics.form != OperatorForm::stored));
  }


  PERIDEAL_INSTANTIATE_FUNCTION(refuse_law);
  PERIDEAL_INSTANTIATE_FUNCTION(relaxes_at_nodes);
} // namespace PeriDeal
