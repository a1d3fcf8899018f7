// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/surface_transfer.h>
#include <perideal/scene/vector_conditions.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <sstream>

namespace PeriDeal
{
  using dealii::Point;

  namespace
  {
    /** The end of a sentence on a temperature. */
    std::string below_zero(const double absolute_zero)
    {
      return " is below 'Absolute zero' in section 'Units', " + number_text(absolute_zero) +
             ". Give -273.15 there where temperatures are in degrees Celsius.";
    }


    TransferKind flux()
    {
      return {"Flux",
              "power/area",
              "Given heat fluxes, positive into the body: `side: formula of x, y, z, t` and the "
              "temperature T of the side, several separated by `;`. A side named nowhere is "
              "insulated.",
              {"flux"},
              "flux",
              false,
              [](SurfaceTransfer &transfer, const std::string &) {
                transfer.flux = transfer.formulas[0];
              }};
    }


    TransferKind convection()
    {
      return {
        "Convection",
        "power/(area temperature), temperature",
        "`side: coefficient, ambient temperature`, several separated by `;`: the flux "
        "coefficient x (ambient - T) enters. The coefficient may depend on x, y, z and the temperature T of the side, the ambient temperature on t, too. "
        "Adds to a Flux on the same side.",
        {"coefficient", "ambient value"},
        "convection",
        true,
        [](SurfaceTransfer &transfer, const std::string &) {
          transfer.coefficient = transfer.formulas[0];
          transfer.ambient     = transfer.formulas[1];
        }};
    }


    /** Refuse a number that a formula is known to be. */
    void refuse_number(const Expression  &formula,
                       const double       least,
                       const double       most,
                       const std::string &where,
                       const std::string &what)
    {
      if (!formula.is_constant())
        return;
      const double value = formula.value(dealii::Point<1>());
      if (value < least || value > most)
        entry_error(where, what);
    }


    TransferKind radiation()
    {
      return {
        "Radiation",
        "1, temperature",
        "Heat: `side: emissivity, temperature of the surroundings`, several separated by `;`: the flux "
        "emissivity x sigma x (Ta^4 - T^4) enters, with absolute temperatures (`Absolute zero` in section `Units`) and sigma = 5.670374419e-8 W/(m2 K4), "
        "so that the scene has to be in metres, seconds, watts and kelvins or degrees Celsius. The emissivity, from 0 to 1, may depend on x, y, z, t and the temperature T of the side, "
        "the surroundings on x, y, z, t. Adds to a Flux and a Convection on the same side.",
        {"emissivity", "temperature of the surroundings"},
        "radiation",
        true,
        [](SurfaceTransfer &transfer, const std::string &where) {
          transfer.radiates     = true;
          transfer.emissivity   = transfer.formulas[0];
          transfer.surroundings = transfer.formulas[1];
          if (transfer.surroundings.depends_on_temperature())
            entry_error(where,
                        "the temperature of the surroundings " + transfer.surroundings.text() +
                          " depends on T; known variables here: x, y, z, t.");
          refuse_number(transfer.emissivity,
                        0.,
                        1.,
                        where,
                        "the emissivity " + transfer.emissivity.text() +
                          " is not from 0 to 1, the part of what a black body radiates.");
          refuse_number(transfer.surroundings,
                        transfer.absolute_zero,
                        std::numeric_limits<double>::max(),
                        where,
                        "the temperature of the surroundings " + transfer.surroundings.text() +
                          below_zero(transfer.absolute_zero));
        },
        true};
    }
  } // namespace


  std::deque<TransferKind> &transfer_kinds()
  {
    static std::deque<TransferKind> kinds = {flux(), convection(), radiation()};
    return kinds;
  }


  const TransferKind &transfer_kind(const std::string &entry)
  {
    for (const TransferKind &kind : transfer_kinds())
      if (kind.entry == entry)
        return kind;
    AssertThrow(false, dealii::ExcMessage("There is no kind of transfer '" + entry + "'."));
  }


  void SurfaceTransfer::set(const TransferKind            &of_kind,
                            const std::vector<Expression> &given,
                            const std::string             &where)
  {
    AssertThrow(given.size() == of_kind.formulas.size(),
                dealii::ExcMessage("'" + of_kind.entry + "' has other formulas."));
    kind     = &of_kind;
    formulas = given;
    kind->set(*this, where);
    is_curved = radiates || std::any_of(formulas.begin(),
                                        formulas.end(),
                                        std::mem_fn(&Expression::depends_on_temperature));
    if (coefficient.depends_on_time())
      entry_error(
        where,
        "the coefficient " + coefficient.text() +
          " depends on t; it may vary in space only. The ambient temperature may depend on t.");
    if (coefficient.is_constant() && coefficient.value(dealii::Point<1>()) < 0.)
      entry_error(where, "the coefficient " + coefficient.text() + " is negative.");
  }


  bool SurfaceTransfer::depends_on_time() const
  {
    return flux.depends_on_time() || ambient.depends_on_time() || emissivity.depends_on_time() ||
           surroundings.depends_on_time();
  }


  bool SurfaceTransfer::insulates() const
  {
    return !fixes_level() && is_zero(flux);
  }


  std::string SurfaceTransfer::text() const
  {
    std::string text = kind->word;
    for (const Expression &formula : formulas)
      text += (&formula == formulas.data() ? " " : ", ") + formula.text();
    return text;
  }


  template <int dim>
  double SurfaceTransfer::slope(const Point<dim> &p,
                                const double      t,
                                const double      u,
                                const bool        is_guess) const
  {
    if (!is_curved)
      return coefficient.value(p);
    double growth = flux.slope(p, t, u);
    if (kind->fixes_level)
      growth += coefficient.slope(p, t, u) * (ambient.value(p, t, u) - u) +
                coefficient.value(p, t, u) * (ambient.slope(p, t, u) - 1.);
    if (radiates)
      {
        const double outside = surroundings.value(p, t) - absolute_zero, here = u - absolute_zero,
                     warm      = std::abs(here);
        const double steepness = is_guess && here < outside ?
                                   black_flux(p, t, u) / (outside - here) :
                                 is_guess && warm < 1. ? 4. * radiation(1.) :
                                 warm > 0.             ? 4. * radiation(warm) / warm :
                                                         0.;
        growth +=
          emissivity.slope(p, t, u) * black_flux(p, t, u) - emissivity.value(p, t, u) * steepness;
      }
    return std::max(0., -growth);
  }


  template <int dim>
  std::string SurfaceTransfer::fault(const Point<dim> &p,
                                     const double      t,
                                     const double      u,
                                     const double      undershoot) const
  {
    const double h = coefficient.value(p, t, u), e = emissivity.value(p, t, u);
    std::string  what;
    if (h < 0.)
      what = "the coefficient '" + coefficient.text() + "' is negative";
    else if (e < 0. || e > 1.)
      what = "the emissivity '" + emissivity.text() + "' is " + number_text(e);
    else if (radiates && surroundings.value(p, t) < absolute_zero)
      what = "the temperature of the surroundings '" + surroundings.text() + "'";
    else if (radiates && u < absolute_zero - undershoot)
      what = "the temperature " + number_text(u) + " of the body";
    if (what.empty())
      return "";
    std::ostringstream message;
    message << "'" << kind->entry << "' in section 'Boundary conditions', side '" << name
            << "': " << what << " at (" << p << ")"
            << (depends_on_time() ? ", t = " + number_text(t) : "")
            << (is_curved ? ", T = " + number_text(u) : "")
            << (h < 0. ? ". It has to be 0 or more on the whole side." :
                e < 0. || e > 1. ?
                         ". It has to be from 0 to 1, the part of what a black body radiates." :
                         "," + below_zero(absolute_zero));
    return message.str();
  }


  bool depend_on_temperature(const std::vector<SurfaceTransfer> &transfers)
  {
    return std::any_of(transfers.begin(),
                       transfers.end(),
                       std::mem_fn(&SurfaceTransfer::depends_on_temperature));
  }


  std::string entries_that_fix_level()
  {
    std::string entries = "'Dirichlet'";
    for (const TransferKind &kind : transfer_kinds())
      entries += kind.fixes_level ? " or '" + kind.entry + "'" : "";
    return entries;
  }


#define PERIDEAL_TRANSFER(dim)                                         \
  template double      SurfaceTransfer::slope<dim>(const Point<dim> &, \
                                              const double,       \
                                              const double,       \
                                              const bool) const;  \
  template std::string SurfaceTransfer::fault<dim>(const Point<dim> &, \
                                                   const double,       \
                                                   const double,       \
                                                   const double) const;
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TRANSFER)
#undef PERIDEAL_TRANSFER
} // namespace PeriDeal
