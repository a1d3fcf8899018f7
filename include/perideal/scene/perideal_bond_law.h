/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the PeriDeal authors
 */
#pragma once

/**
 * A law of bonds of one's own for PeriDeal (`Law = user` in section `Material`, with
 * `Models = peridynamics`), in C or any language that can be called from it. Include this file,
 * define the two functions below, and give the source, or a shared library made of it, as
 * `User law`:
 *
 *   cc -shared -fPIC -O2 -I FOLDER -o law.so law.c      (FOLDER: where this file is)
 *
 * A bond of length x whose ends move apart by e has the stretch s = e/x. The linear peridynamic
 * solid pulls at its ends by c s (and what dilatations add, which stays as it is); c follows from
 * the moduli of the scene and the family. With a law of one's own it pulls by c F, F the force
 * that the law answers with: F = s is the linear solid. Energies are those over c: s^2/2 of the
 * linear solid.
 *
 * s, F and the energies over c have no unit; lengths and times are those of the scene. F is
 * positive where the bond pulls. The solid is that of Silling et al. 2007; class UserBondLaw asks.
 * Calls are not collective: each process asks for its own bonds, in any order, and both ends of a
 * bond ask, each from states of its own.
 */

#ifdef __cplusplus
extern "C" {
#endif

#define PERIDEAL_BOND_LAW_VERSION 1

/** What a law may return. */
#define PERIDEAL_BOND_LAW_FINE 0
#define PERIDEAL_BOND_LAW_SHORTER_STEP (-1) /* at rest: from the same states, by less */

/** What a law is asked with. */
struct perideal_bond
{
  double        stretch;      /* s, what the temperature stretches by taken off */
  double        length;       /* x; with `Kinematics = full`, too, that of the undeformed bond */
  double        damage;       /* of the ends, their mean, from 0 to 1 */
  double        time_step;    /* since the last accepted state, 0 or more */
  int           n_properties; /* `User properties` */
  const double *properties;
  int           n_states; /* `User states` */
  const double *states;   /* of the bond in the last accepted state, at first 0 */
};

/** What a law answers with; all of it is 0 before. */
struct perideal_bond_answer
{
  double force;      /* F, 0 at s = 0 in a bond with states 0 */
  double slope;      /* dF/ds at these states */
  double stored;     /* energy that comes back, over c */
  double dissipated; /* energy lost since the last accepted state, over c */
};

/** Returns PERIDEAL_BOND_LAW_VERSION. */
int perideal_bond_law_version(void);

/**
 * Returns PERIDEAL_BOND_LAW_FINE or PERIDEAL_BOND_LAW_SHORTER_STEP; anything else ends the run with
 * a message. A law keeps nothing by itself: a step may be asked for again, from the same states.
 * next_states are those of this stretch.
 */
int perideal_bond_law(const struct perideal_bond  *bond,
                      struct perideal_bond_answer *answer,
                      double                      *next_states);

#ifdef __cplusplus
}
#endif
