// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/lists.h>
#include <perideal/scene/surface_transfer.h>
#include <perideal/scene/vector_conditions.h>

namespace PeriDeal
{
  namespace
  {
    TransferKind flux()
    {
      return {"Flux",
              "power/area",
              "Given heat fluxes, positive into the body: `side: formula of x, y, z, t`, several "
              "separated by `;`. A side named nowhere is insulated.",
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
        "coefficient x (ambient - T) enters. The coefficient may depend on x, y, z, the ambient temperature on t, too. "
        "Adds to a Flux on the same side.",
        {"coefficient", "ambient value"},
        "convection",
        true,
        [](SurfaceTransfer &transfer, const std::string &) {
          transfer.coefficient = transfer.formulas[0];
          transfer.ambient     = transfer.formulas[1];
        }};
    }
  } // namespace


  std::deque<TransferKind> &transfer_kinds()
  {
    static std::deque<TransferKind> kinds = {flux(), convection()};
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
    return flux.depends_on_time() || ambient.depends_on_time();
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


  std::string entries_that_fix_level()
  {
    std::string entries = "'Dirichlet'";
    for (const TransferKind &kind : transfer_kinds())
      entries += kind.fixes_level ? " or '" + kind.entry + "'" : "";
    return entries;
  }
} // namespace PeriDeal
