/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the PeriDeal authors
 *
 * A law of bonds: they yield, and harden kinematically.
 *
 *   F = s - p,   |F - b| <= y,   b = c p,   c = h/(1 - h)
 *
 * p is what has been left of the stretch, b the back force. Beyond y the force grows by h of what
 * the elastic bond's does. Properties: y (a stretch) and h, from 0 to less than 1. States: p.
 */
#include <math.h>
#include <perideal_bond_law.h>

int perideal_bond_law_version(void)
{
  return PERIDEAL_BOND_LAW_VERSION;
}

int perideal_bond_law(const struct perideal_bond  *bond,
                      struct perideal_bond_answer *answer,
                      double                      *next_states)
{
  double y, h, c, p, over;
  if (bond->n_properties != 2 || bond->n_states != 1)
    return 1;
  y    = bond->properties[0];
  h    = bond->properties[1];
  c    = h / (1 - h);
  p    = bond->states[0];
  over = fabs(bond->stretch - p - c * p) - y;

  answer->slope = 1;
  if (over > 0)
    {
      const double flow  = over / (1 + c);
      p                  = p + copysign(flow, bond->stretch - p - c * p);
      answer->slope      = h;
      answer->dissipated = y * flow;
    }
  answer->force  = bond->stretch - p;
  answer->stored = 0.5 * answer->force * answer->force + 0.5 * c * p * p;
  next_states[0] = p;
  return 0;
}
