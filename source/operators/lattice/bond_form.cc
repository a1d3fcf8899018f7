// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/operators/lattice/bond_form.h>

namespace PeriDeal
{
  using namespace dealii;

  bool takes_lattice_form(const OperatorForm wanted, const std::string &reason, const bool pays)
  {
    const bool must = wanted == OperatorForm::lattice;
    AssertThrow(
      !must || reason.empty(),
      UserError("'Operator form = lattice' in section 'Peridynamics' is not possible here: " +
                reason + ". Use 'auto' or 'stored'."));
    return must || (wanted == OperatorForm::automatic && pays && reason.empty());
  }
} // namespace PeriDeal
