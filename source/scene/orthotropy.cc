// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/numbers.h>

#include <perideal/base/instantiate.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/orthotropy.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Numbers of an orthotropic body at a point, in its own axes; pairs are 12, 13, 23. */
    struct Constants
    {
      std::array<double, 3> young, shear, poisson;
    };

    constexpr unsigned int pairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};

    std::string pair_name(const std::string &letter, const unsigned int k)
    {
      return letter + std::to_string(pairs[k][0] + 1) + std::to_string(pairs[k][1] + 1);
    }


    /** What no body can have: the entry, and what is wrong; empty: nothing. */
    std::pair<std::string, std::string> fault_of(const Constants &c)
    {
      for (unsigned int a = 0; a < 3; ++a)
        if (!(c.young[a] > 0.))
          return {"Young moduli",
                  "E" + std::to_string(a + 1) + " is " + number_text(c.young[a]) +
                    ", needs a value greater than 0."};
      double rest = 1.;
      for (unsigned int k = 0; k < 3; ++k)
        {
          if (!(c.shear[k] > 0.))
            return {"Shear moduli",
                    pair_name("G", k) + " is " + number_text(c.shear[k]) +
                      ", needs a value greater than 0."};
          const unsigned int a = pairs[k][0], b = pairs[k][1];
          const double       most = std::sqrt(c.young[a] / c.young[b]);
          if (!(std::abs(c.poisson[k]) < most))
            return {"Poisson ratios",
                    pair_name("nu", k) + " is " + number_text(c.poisson[k]) +
                      "; its size has to be less than sqrt(E" + std::to_string(a + 1) + "/E" +
                      std::to_string(b + 1) + ") = " + rounded_text(most, 6) +
                      ", or the body would have energy to give away."};
          rest -= c.poisson[k] * c.poisson[k] / (most * most);
        }
      rest -= 2. * c.poisson[0] * c.poisson[1] * c.poisson[2] * c.young[2] / c.young[0];
      if (!(rest > 0.))
        return {"Poisson ratios",
                "1 - nu12^2 E2/E1 - nu13^2 E3/E1 - nu23^2 E3/E2 - 2 nu12 nu13 nu23 E3/E1 is " +
                  rounded_text(rest, 6) +
                  ", needs a value greater than 0, or the body would have energy to give away. "
                  "Make one of them smaller."};
      return {};
    }


    /** In the axes of the body. */
    SymmetricTensor<4, 3> own_stiffness(const Constants &c)
    {
      SymmetricTensor<2, 3> compliance; // of the three stretches, as a matrix
      for (unsigned int a = 0; a < 3; ++a)
        compliance[a][a] = 1. / c.young[a];
      for (unsigned int k = 0; k < 3; ++k)
        compliance[pairs[k][0]][pairs[k][1]] = -c.poisson[k] / c.young[pairs[k][0]];
      const SymmetricTensor<2, 3> inverse = invert(compliance);
      SymmetricTensor<4, 3>       C;
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = 0; b < 3; ++b)
          C[a][a][b][b] = inverse[a][b];
      for (unsigned int k = 0; k < 3; ++k)
        C[pairs[k][0]][pairs[k][1]][pairs[k][0]][pairs[k][1]] = c.shear[k];
      return C;
    }


    /** About the axis z or x. */
    Tensor<2, 3> turn(const double degrees, const bool about_x)
    {
      const double       angle = degrees * numbers::PI / 180.;
      const unsigned int a = about_x ? 1 : 0, b = about_x ? 2 : 1;
      Tensor<2, 3>       R = unit_symmetric_tensor<3>();
      R[a][a] = R[b][b] = std::cos(angle);
      R[a][b]           = -std::sin(angle);
      R[b][a]           = std::sin(angle);
      return R;
    }


    SymmetricTensor<4, 3> turned(const SymmetricTensor<4, 3> &C, const Tensor<2, 3> &R)
    {
      using Strain = SymmetricTensor<2, 3>;
      SymmetricTensor<4, 3> result;
      for (unsigned int n = 0; n < Strain::n_independent_components; ++n)
        {
          const auto   kl = Strain::unrolled_to_component_indices(n);
          Tensor<2, 3> strain; // half of both entries of a shear: a column of C
          strain[kl[0]][kl[1]] += 0.5;
          strain[kl[1]][kl[0]] += 0.5;
          const Strain stress =
            symmetrize(R * Tensor<2, 3>(C * symmetrize(transpose(R) * strain * R)) * transpose(R));
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int j = i; j < 3; ++j)
              result[i][j][kl[0]][kl[1]] = stress[i][j];
        }
      return result;
    }


    template <int dim>
    Constants constants_at(const Material::Law::Orthotropy &body, const Point<dim> &p)
    {
      Constants c;
      for (unsigned int k = 0; k < 3; ++k)
        {
          c.young[k]   = body.young[k].value(p);
          c.shear[k]   = body.shear[k].value(p);
          c.poisson[k] = body.poisson[k].value(p);
        }
      return c;
    }


    /** The numbers of an entry, of the whole body and of phases. */
    std::vector<MaterialProperty> read_list(const Material    &material,
                                            const std::string &entry,
                                            const unsigned int least,
                                            const unsigned int most,
                                            const std::string &names)
    {
      const auto formulas = [&](const std::string &text, const std::string &where) {
        const std::vector<std::string> pieces = split_list(text, ',');
        if (pieces.size() < least || pieces.size() > most)
          entry_error(where, "found '" + trimmed(text) + "', needs " + names + ".");
        std::vector<Expression> list;
        for (const std::string &piece : pieces)
          {
            list.emplace_back(piece, where, "x, y, z");
            if (list.back().depends_on_time())
              entry_error(where, "'" + piece + "' depends on t; known variables here: x, y, z.");
          }
        return list;
      };
      const auto                   &regions = material.phases.all();
      const std::vector<Expression> elsewhere =
        formulas(material.text(entry), material.where(entry));
      std::vector<std::vector<std::optional<Expression>>> of_regions(
        elsewhere.size(),
        std::vector<std::optional<Expression>>(regions.names.size()));
      for (const std::string &piece : split_list(material.phases.text(entry), ';'))
        {
          const std::string where    = material.phases.where(entry);
          const auto [name, numbers] = name_and_value(piece, where);
          const auto found           = std::find(regions.names.begin(), regions.names.end(), name);
          if (found == regions.names.end())
            entry_error(where,
                        "there is no phase '" + name + "' in 'Regions'." +
                          did_you_mean(name, regions.names));
          if (of_regions[0][found - regions.names.begin()])
            entry_error(where, "the phase '" + name + "' is named twice.");
          const auto list = formulas(numbers, where + ", phase '" + name + "'");
          if (list.size() != elsewhere.size())
            entry_error(where + ", phase '" + name + "'",
                        "has " + std::to_string(list.size()) + " values, section 'Material' " +
                          std::to_string(elsewhere.size()) + ": give as many.");
          for (unsigned int k = 0; k < list.size(); ++k)
            of_regions[k][found - regions.names.begin()] = list[k];
        }
      const auto                    shared = std::make_shared<const Regions>(regions);
      std::vector<MaterialProperty> properties;
      for (unsigned int k = 0; k < elsewhere.size(); ++k)
        properties.emplace_back(elsewhere[k], shared, of_regions[k]);
      return properties;
    }


    /** Lists are of one or three numbers, but for the moduli of Young. */
    void refuse_two(const Material &material, const Material::Law::Orthotropy &body)
    {
      material.refuse(body.angles.size() == 2, "Material angle", "found two, needs three angles.");
      material.refuse(body.shear.size() == 2,
                      "Shear moduli",
                      "found two, needs G12 or G12, G13, G23.");
      material.refuse(body.poisson.size() == 2,
                      "Poisson ratios",
                      "found two, needs nu12 or nu12, nu13, nu23.");
    }


    /** Numbers of the body and of its phases, as far as they are numbers. */
    void check_constants(const Material &material, const Material::Law::Orthotropy &body)
    {
      const auto &names = material.phases.all().names;
      for (int region = -1; region < static_cast<int>(names.size()); ++region)
        {
          Constants  c;
          bool       known = true;
          const auto take  = [&](const auto &list, std::array<double, 3> &values) {
            for (unsigned int k = 0; k < 3; ++k)
              if (list[k].formula(region).is_constant())
                values[k] = list[k].formula(region).value(Point<1>());
              else
                known = false;
          };
          take(body.young, c.young);
          take(body.shear, c.shear);
          take(body.poisson, c.poisson);
          if (!known)
            continue;
          const auto [entry, what] = fault_of(c);
          if (what.empty())
            continue;
          if (region < 0)
            material.refuse(true, entry, what);
          const bool own = !material.phases.text(entry).empty();
          entry_error((own ? material.phases.where(entry) : material.where(entry)) + ", phase '" +
                        names[region] + "'",
                      what);
        }
    }
  } // namespace


  const std::vector<OrthotropicEntry> &orthotropic_entries()
  {
    static const std::vector<OrthotropicEntry> list = {
      {"Young moduli",
       "force/length^2",
       "E1, E2, E3 along the three axes of an orthotropic body, in place of the two moduli; in plane stress E1, E2 will do."},
      {"Shear moduli",
       "force/length^2",
       "Orthotropic body: G12, G13, G23, shear stress per change of the angle between two axes; in plane stress G12 will do."},
      {"Poisson ratios",
       "1",
       "Orthotropic body: nu12, nu13, nu23; nu12 is the contraction along axis 2 per extension along axis 1, nu21 = nu12 E2/E1. In plane stress nu12 will do."},
      {"Material angle",
       "degrees",
       "Orthotropic body: by how much its axes are turned, counterclockwise from x; in 3D three angles, about z, then about its x, then about its z (Euler angles z, x', z'')."}};
    return list;
  }


  Material::Law::Orthotropy parse_orthotropy(const Material    &material,
                                             const Physics      physics,
                                             const unsigned int dim,
                                             const PlaneState   plane)
  {
    Material::Law::Orthotropy body;
    const std::string         first  = orthotropic_entries().front().name;
    const auto               &phases = material.phases;
    for (const OrthotropicEntry &entry : orthotropic_entries())
      material.refuse(physics != Physics::elasticity && material.is_given(entry.name),
                      entry.name,
                      "is for 'Physics = elasticity'; 'Physics' is '" + names_of(physics).physics +
                        "'.");
    if (physics != Physics::elasticity)
      return body;
    for (const OrthotropicEntry &entry : orthotropic_entries())
      material.refuse((material.is_given(entry.name) || !phases.text(entry.name).empty()) &&
                        material.text(first).empty(),
                      entry.name,
                      "is for orthotropic bodies, but '" + first +
                        "' is empty. Give that, too, or leave the entry out.");
    if (material.text(first).empty())
      return body;
    material.refuse(dim == 1, first, "is for 'Dimension' 2 and 3; a bar has 'Young modulus'.");
    material.refuse(material.law.kind != SolidLaw::linear,
                    first,
                    "is for 'Law = linear'; 'Law' is '" + material.text("Law") +
                      "'. Leave one of them out.");
    for (const std::string modulus :
         {"Bulk modulus", "Shear modulus", "Young modulus", "Poisson ratio"})
      material.refuse(!material.text(modulus).empty() || phases.gives(modulus),
                      modulus,
                      "is that of an isotropic body, but '" + first +
                        "' is given, too. Leave one of them out.");
    const bool         flat  = dim == 2 && plane == PlaneState::stress;
    const unsigned int least = flat ? 1 : 3;
    body.young =
      read_list(material, first, flat ? 2 : 3, 3, flat ? "E1, E2 or E1, E2, E3" : "E1, E2, E3");
    body.shear   = read_list(material,
                           "Shear moduli",
                           least,
                           3,
                           flat ? "G12 or G12, G13, G23" : "G12, G13, G23");
    body.poisson = read_list(material,
                             "Poisson ratios",
                             least,
                             3,
                             flat ? "nu12 or nu12, nu13, nu23" : "nu12, nu13, nu23");
    body.angles  = read_list(material,
                            "Material angle",
                            1,
                            dim == 3 ? 3 : 1,
                            dim == 3 ? "three angles, or one about z" : "one angle");
    refuse_two(material, body);
    // Without effect in the plane.
    body.young.resize(3, body.young.back());
    body.shear.resize(3, body.shear.front());
    body.poisson.resize(3, MaterialProperty(0.));
    body.angles.resize(3, MaterialProperty(0.));
    check_constants(material, body);
    return body;
  }


  template <int dim>
  SymmetricTensor<4, 3> orthotropic_stiffness(const Material::Law::Orthotropy &body,
                                              const Point<dim>                &p)
  {
    const Constants c        = constants_at(body, p);
    const auto [entry, what] = fault_of(c);
    if (!what.empty())
      report_formula_error("Entry '" + entry + "' in section 'Material', at " + point_text(p) +
                           ": " + what);
    const Tensor<2, 3> R = turn(body.angles[0].value(p), false) *
                           turn(body.angles[1].value(p), true) *
                           turn(body.angles[2].value(p), false);
    return turned(own_stiffness(c), R);
  }


  template <int dim>
  Moduli mean_moduli(const Material::Law::Orthotropy &body, const Point<dim> &p)
  {
    const SymmetricTensor<4, 3> C          = own_stiffness(constants_at(body, p));
    double                      dilatation = 0., whole = 0.;
    for (unsigned int a = 0; a < 3; ++a)
      for (unsigned int b = 0; b < 3; ++b)
        {
          dilatation += C[a][a][b][b];
          whole += C[a][b][a][b];
        }
    return moduli_from(Modulus::bulk,
                       dilatation / 9.,
                       Modulus::shear,
                       (3. * whole - dilatation) / 30.);
  }


#define PERIDEAL_TEMPLATES(dim)                                                                \
  template SymmetricTensor<4, 3> orthotropic_stiffness<dim>(const Material::Law::Orthotropy &, \
                                                            const Point<dim> &);               \
  template Moduli mean_moduli<dim>(const Material::Law::Orthotropy &, const Point<dim> &);
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
