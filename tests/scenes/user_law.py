# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Laws of users (UMAT) in finite elements, in Fortran and C: against the built-in laws, on several processes, and ten and more broken ones.

    user_law.py elastic     the linear law in fixed-form Fortran and in C: patches and consoles at rest, in motion; what a call is told
    user_law.py plastic     prm/elasticity/user_law.f90 against `plastic` and a closed form, its tangent against differences
    user_law.py swelling    stress at no strain: a body that nothing else loads, one that is brought back
    user_law.py nodes       at nodes of correspondence peridynamics: against the built-in laws, on 2 processes, broken (resumed: resume.py)
    user_law.py large       large deformations: a neo-Hookean law against `hyperelastic`, a hypoelastic one that turns with the body, in elements and at nodes
    user_law.py unsymmetric a flow that is not associated: stresses against an integration of its own, on several processes
    user_law.py ranks       2 and 4 processes
    user_law.py mistakes    broken libraries: one message each, on 2 processes, too (entries: tests/unit/scene_mistakes_test.cc)
"""

import math
import os
import subprocess

import hyperelastic

from scene_test import FE, PD, SOURCE_DIR, Comparison, check, check_close, check_less, check_one_message, run_parts, run_perideal, run_scene, scene_text, temporary_folder, write_file

PLASTIC = os.path.join(SOURCE_DIR, "prm", "elasticity", "user_law.f90")
BAR = "prm/elasticity/user_law.prm"

# As in Abaqus' documentation, for stresses in space, in plane strain and in plane stress.
ELASTIC = """
      SUBROUTINE UMAT(STRESS,STATEV,DDSDDE,SSE,SPD,SCD,
     1 RPL,DDSDDT,DRPLDE,DRPLDT,
     2 STRAN,DSTRAN,TIME,DTIME,TEMP,DTEMP,PREDEF,DPRED,CMNAME,
     3 NDI,NSHR,NTENS,NSTATV,PROPS,NPROPS,COORDS,DROT,PNEWDT,
     4 CELENT,DFGRD0,DFGRD1,NOEL,NPT,LAYER,KSPT,KSTEP,KINC)
      INCLUDE 'ABA_PARAM.INC'
      CHARACTER*80 CMNAME
      DIMENSION STRESS(NTENS),STATEV(NSTATV),
     1 DDSDDE(NTENS,NTENS),DDSDDT(NTENS),DRPLDE(NTENS),
     2 STRAN(NTENS),DSTRAN(NTENS),TIME(2),PREDEF(1),DPRED(1),
     3 PROPS(NPROPS),COORDS(3),DROT(3,3),DFGRD0(3,3),DFGRD1(3,3)
      DIMENSION KSTEP(4)
      EMOD=PROPS(1)
      ENU=PROPS(2)
      EG=EMOD/(2.0D0*(1.0D0+ENU))
      ELAM=EMOD*ENU/((1.0D0+ENU)*(1.0D0-2.0D0*ENU))
      IF (NDI.EQ.2) ELAM=EMOD*ENU/(1.0D0-ENU**2)
      DO K1=1,NTENS
        DO K2=1,NTENS
          DDSDDE(K2,K1)=0.0D0
        END DO
      END DO
      DO K1=1,NDI
        DO K2=1,NDI
          DDSDDE(K2,K1)=ELAM
        END DO
        DDSDDE(K1,K1)=ELAM+2.0D0*EG
      END DO
      DO K1=NDI+1,NTENS
        DDSDDE(K1,K1)=EG
      END DO
      DO K1=1,NTENS
        DO K2=1,NTENS
          STRESS(K2)=STRESS(K2)+DDSDDE(K2,K1)*DSTRAN(K1)
        END DO
      END DO
      RETURN
      END
"""

HEAD = """
#include <math.h>
#include <string.h>
void xit_(void);
void sinv_(const double *, double *, double *, const int *, const int *);
void sprinc_(const double *, double *, const int *, const int *, const int *);
void sprind_(const double *, double *, double *, const int *, const int *, const int *);
void rotsig_(const double *, const double *, double *, const int *, const int *, const int *);
void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl, double *ddsddt, double *drplde,
           double *drpldt, double *stran, double *dstran, double *time, double *dtime, double *temp, double *dtemp, double *predef, double *dpred,
           char *cmname, int *ndi, int *nshr, int *ntens, int *nstatv, double *props, int *nprops, double *coords, double *drot, double *pnewdt,
           double *celent, double *dfgrd0, double *dfgrd1, int *noel, int *npt, int *layer, int *kspt, int *kstep, int *kinc, size_t length)
{
  const double E = 1000, nu = 0.3, G = E / 2 / (1 + nu), lambda = *ndi == 2 ? E * nu / (1 - nu * nu) : E * nu / (1 + nu) / (1 - 2 * nu);
  const int n = *ntens;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
      ddsdde[a + n * b] = (a < *ndi && b < *ndi ? lambda : 0) + (a != b ? 0 : a < *ndi ? 2 * G : G);
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
      stress[a] += ddsdde[a + n * b] * dstran[b];
"""
IN_C = HEAD + "}\n"

CONSOLE = """
Dimension = {dimension}
Physics = elasticity
Models = finite elements
Domain/Lower corner = 0, 0{zero}
Domain/Upper corner = 2, 1{one}
Domain/Cells = 8, 4{two}
Elasticity/Solver = {solver}
Boundary conditions/Displacement = left: 0, 0{zero}
Boundary conditions/Traction = right: 0, -1{zero}
Material/Density = 1.0
Solver/Tolerance = 1e-13
Output/Probes = 2, 1{one} ; 1, 0.75{half}
Output/Fields = none
Output/Line =
"""
KINDS = {"space": (3, {}), "plane strain": (2, {"Elasticity/Plane": "strain"}), "plane stress": (2, {"Elasticity/Plane": "stress"})}
LINEAR = {"Material/Young modulus": "1000", "Material/Poisson ratio": "0.3"}
FIRM = {**LINEAR, "Material/Law": "plastic", "Material/Yield stress": "1e30"}
STEADY = {"Time/Steady": "true"}
MOVES = {"Time/End time": "0.05", "Time/Time step": "0.002", "Output/Write at": "0.05"}


def scene_of(text, dimension, **more):
    words = {"zero": ", 0", "one": ", 1", "two": ", 2", "half": ", 0.5"} if dimension == 3 else {"zero": "", "one": "", "two": "", "half": ""}
    return scene_text(text.format(dimension=dimension, **words, **more))


def user(path, properties="1000, 0.3", states=0):
    return {"Material/Law": "user", "Material/User law": path, "Material/User properties": properties, "Material/User states": str(states)}


def compare(table, what, run, other, bound, columns=("ux", "uy", "sxx", "sxy", "von_mises"), model=FE):
    for k, (found, expected) in enumerate(zip(run.rows(model), other.rows(model))):
        for column in columns:
            size = max(abs(row[column]) for row in other.rows(model))
            table.add(f"{what}, row {k + 1}, {column}", found[column] / size, expected[column] / size, absolute=bound)


PATCH = """
Dimension = {dimension}
Physics = elasticity
Models = finite elements
Domain/Lower corner = 0, 0{zero}
Domain/Upper corner = 2, 1{one}
Domain/Cells = 4, 2{two}
Elasticity/Solver = newton
Solver/Tolerance = 1e-13
Boundary conditions/Displacement = {sides}
Output/Probes = 0.3, 0.4{half}
Output/Fields = none
Output/Line =
"""


def elastic():
    folder = temporary_folder()
    fortran, in_c = write_file("elastic.for", ELASTIC, folder), write_file("elastic.c", IN_C, folder)
    library = os.path.join(folder, "a law's.so")
    subprocess.run(["cc", "-shared", "-fPIC", "-O2", "-o", library, in_c], check=True)
    table = Comparison("an elastic UMAT and the built-in laws")
    for kind, (dimension, plane) in KINDS.items():
        # A uniform strain, which the projected dilatation leaves as it is.
        field = ("0.001*x - 0.002*y", "0.003*y + 0.0005*x", "-0.001*z + 0.002*x")[:dimension]
        sides = " ; ".join(f"{side}: {', '.join(field)}" for side in ("left", "right", "bottom", "top", "back", "front")[: 2 * dimension])
        patch = scene_of(PATCH, dimension, sides=sides)
        found, expected = run_scene(patch, {**plane, **user(fortran), **STEADY}), run_scene(patch, {**plane, **LINEAR})
        compare(table, f"{kind}, patch, 'linear'", found, expected, 1e-12)
        energy = "strain energy"
        table.add(f"{kind}, patch, {energy}", found.total(energy, FE), expected.total(energy, FE), relative=1e-12)
        # The console bends, and the body of `plastic` that does not yield has the same elements; in plane stress nothing is projected.
        other, name = FIRM, "'plastic'"
        rests, moves = scene_of(CONSOLE, dimension, solver="newton"), scene_of(CONSOLE, dimension, solver="dynamics")
        expected = run_scene(rests, {**plane, **other, **STEADY})
        for path in (fortran, in_c, library):
            found = run_scene(rests, {**plane, **user(path), **STEADY})
            compare(table, f"{kind}, at rest, {os.path.basename(path)}, {name}", found, expected, 1e-12)
        if kind == "plane stress":
            compare(table, f"{kind}, at rest, 'linear'", found, run_scene(rests, {**plane, **LINEAR}), 1e-12, ("ux", "uy"))
        expected = run_scene(moves, {**plane, **other, **MOVES})
        found = run_scene(moves, {**plane, **user(fortran), **MOVES})
        compare(table, f"{kind}, in motion, {name}", found, expected, 1e-12)
        implicit = {**MOVES, "Time/Stepper": "newmark"}
        compare(table, f"{kind}, newmark, {name}", run_scene(moves, {**plane, **user(fortran), **implicit}), run_scene(moves, {**plane, **other, **implicit}), 1e-10)
        balance = found.model(FE)["energy balance"]
        if kind == "plane stress":
            compare(table, f"{kind}, in motion, 'linear'", found, run_scene(moves, {**plane, **LINEAR, **MOVES}), 1e-12, ("ux", "uy"))
        table.add(f"{kind}, in motion, drift", balance["drift"] / balance["work"], expected.model(FE)["energy balance"]["drift"] / balance["work"], absolute=1e-10)
    table.show()
    asked()


# What a call has to be told; XIT where it is not.
ASKED = HEAD + """
  double mean, mises, principal[3], axes[9], turned[6], rotation[9] = {0, 1, 0, -1, 0, 0, 0, 0, 1}; /* x to y */
  const int one = 1, three = 3;
  const double list[6] = {3, 1, -1, 2, 0, 0};
  sinv_(list, &mean, &mises, &three, &three);
  sprinc_(list, principal, &one, &three, &three);
  sprind_(list, principal, axes, &one, &three, &three);
  rotsig_(list, rotation, turned, &one, &three, &three);
  const double first = 2 + sqrt(5.);
  const int utilities = fabs(mean - 1) < 1e-14 && fabs(mises - sqrt(24.)) < 1e-14 && fabs(principal[0] - first) < 1e-14 && fabs(principal[2] + 1) < 1e-14 &&
    fabs(3 * axes[0] + 2 * axes[3] - first * axes[0]) < 1e-14 && fabs(turned[0] - 1) < 1e-14 && fabs(turned[1] - 3) < 1e-14 && fabs(turned[3] + 2) < 1e-14;
  const double before = (*kinc - 1) * 0.25;
  const int numbers = *ndi == 3 && *nshr == 1 && n == 4 && *nstatv == 2 && *nprops == (coords[0] > 1 ? 4 : 3) && props[0] == (coords[0] > 1 ? 5 : 1) && props[2] == -7.5 && length == 80 && *npt >= 1 && *npt <= 4 &&
    *noel >= 1 && *noel <= 8 && kstep[0] == 1 && strncmp(cmname, coords[0] > 1 ? "STIFF END  " : "MATERIAL   ", 11) == 0 && cmname[79] == ' ' &&
    fabs(*celent - 0.5) < 1e-14 && *temp == 0 && *dtemp == 0 && drot[0] == 1 && drot[1] == 0 && *pnewdt == 1;
  const int moment = fabs(time[0] - before) < 1e-14 && time[1] == time[0] && (*dtime == 0.25 || *dtime == 1e-9);
  const int strain = fabs(dfgrd0[0] - 1 - stran[0]) < 1e-14 && fabs(dfgrd1[0] - 1 - stran[0] - dstran[0]) < 1e-14 && fabs(stran[0] - 0.01 * before) < 1e-9 &&
    coords[2] == 0 && coords[0] > 0 && coords[0] < 2;
  if (!utilities || !numbers || !moment || !strain)
    statev[utilities ? numbers ? moment ? 5 : 4 : 3 : 2] = 1, xit_();
  statev[0] = statev[0] + 1;
  statev[1] = statev[1] + *dtime;
}
"""


def asked():
    """What a call is told, and that states are those of steps that were accepted."""
    patch = scene_of(PATCH, 2, sides="left: 0, 0 ; right: 0.02*t, 0 ; bottom: 0.01*t*x, 0 ; top: 0.01*t*x, 0")
    run = run_scene(patch, {**user(write_file("asked.c", ASKED), "1, 2, -7.5", 2), "Elasticity/Plane": "strain", "Time/End time": "1", "Time/Time step": "0.25",
                            "Material/Phases/Regions": "stiff end: rectangle(1, 0, 2, 1)", "Material/Phases/User properties": "stiff end: 5, 6, -7.5, 9", "Output/Fields": "vtu", "Output/Write at": "1"})
    check(run.returncode == 0, "a call is told what it has to be")
    check_close(run.rows(FE)[-1]["sxx"], 1000 * 0.7 / 1.3 / 0.4 * 0.01, relative=1e-12, what="uniaxial strain")


# J2 with isotropic hardening in plane stress: the return in space for the strain out of the plane that leaves no stress there.
PLANE = """
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, &
                time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, &
                coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc)
   implicit none
   character(len=80) :: cmname
   integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc, n
   real(8) :: stress(3), statev(5), ddsdde(3, 3), sse, spd, scd, rpl, ddsddt(3), drplde(3), drpldt, stran(3), &
      dstran(3), time(2), dtime, temp, dtemp, predef(1), dpred(1), props(nprops), coords(3), drot(3, 3), pnewdt, celent, &
      dfgrd0(3, 3), dfgrd1(3, 3), e(4), s(4), flow(4), D(4, 4), grown
   integer, parameter :: of_plane(3) = (/1, 2, 4/)
   if (ndi /= 2 .or. nprops /= 4 .or. nstatv /= 5) call xit
   e(of_plane) = stran + dstran - statev((/1, 2, 4/))
   e(3) = -props(2)/(1 - props(2))*(e(1) + e(2))
   do n = 1, 50
      call return_to_surface(e, statev(5), props, s, flow, grown, D)
      if (abs(s(3)) < 1d-15*props(3)) exit
      e(3) = e(3) - s(3)/D(3, 3)
   end do
   stress = s(of_plane)
   ddsdde = D(of_plane, of_plane) - &
            matmul(reshape(D(of_plane, 3), (/3, 1/)), reshape(D(3, of_plane), (/1, 3/)))/D(3, 3)
   statev(1:4) = statev(1:4) + flow
   statev(5) = statev(5) + grown
   spd = spd + props(3)*grown
   e = e - flow
   sse = 0.5d0*dot_product(s, e) + 0.5d0*props(4)*statev(5)**2
contains
   subroutine return_to_surface(e, kappa, props, s, flow, grown, D)
      real(8) :: e(4), kappa, props(4), s(4), flow(4), grown, D(4, 4), K, G, mean, size, over
      integer :: a, b
      K = props(1)/(3*(1 - 2*props(2)))
      G = props(1)/(2*(1 + props(2)))
      mean = sum(e(1:3))/3
      s(1:3) = 2*G*(e(1:3) - mean)
      s(4) = G*e(4)
      size = sqrt(1.5d0*(sum(s(1:3)**2) + 2*s(4)**2))
      over = size - props(3) - props(4)*kappa
      D = 0
      D(1:3, 1:3) = K - 2*G/3
      do a = 1, 3
         D(a, a) = K + 4*G/3
      end do
      D(4, 4) = G
      grown = 0
      flow = 0
      if (over > 0) then
         grown = over/(3*G + props(4))
         flow = 1.5d0*grown/size*s
         flow(4) = 2*flow(4)
         D(1:3, 1:3) = D(1:3, 1:3) + 2*G*G*grown/size
         do a = 1, 3
            D(a, a) = D(a, a) - 6*G*G*grown/size
         end do
         D(4, 4) = D(4, 4) - 3*G*G*grown/size
         do b = 1, 4
            do a = 1, 4
               D(a, b) = D(a, b) - 3*G/size**2*(3*G/(3*G + props(4)) - 3*G*grown/size)*s(a)*s(b)
            end do
         end do
         s = s*(1 - 3*G*grown/size)
      end if
      s(1:3) = s(1:3) + 3*K*mean
   end subroutine
end subroutine
"""


def plastic():
    """Isotropic hardening is that of `plastic`; kinematic hardening of a bar has a closed form."""
    table = Comparison("J2 as a UMAT: against 'plastic', kinematic hardening in a bar")
    in_plane_stress = write_file("plane.f90", PLANE)
    for kind, (dimension, plane) in KINDS.items():
        text = scene_of(CONSOLE, dimension, solver="newton")
        loads = {"Boundary conditions/Traction": "right: 0.2*min(t, 6 - t), -0.3*min(t, 6 - t)" + (", 0.1*t" if dimension == 3 else ""), "Time/End time": "5", "Time/Time step": "0.25",
                 "Output/Write at": "1, 2, 3, 4, 5", **plane}
        law = user(in_plane_stress, "1000, 0.3, 1, 200", 5) if kind == "plane stress" else user(PLASTIC, "1000, 0.3, 1, 200, 0", 7 if dimension == 3 else 5)
        found = run_scene(text, {**loads, **law})
        expected = run_scene(text, {**loads, **LINEAR, "Material/Law": "plastic", "Material/Yield stress": "1", "Material/Hardening modulus": "200"})
        compare(table, kind, found, expected, 1e-10)
        for quantity in ("strain energy", "energy dissipated by the law", "work of loads and supports"):
            table.add(f"{kind}, {quantity}", found.total(quantity, FE), expected.total(quantity, FE), relative=1e-10)
        check(expected.total("energy dissipated by the law", FE) > 0.1 * expected.total("work of loads and supports", FE), f"{kind}: yields")
        # Not the same: residuals are measured by the loads alone, those of 'plastic' by what holds it undeformed, too.
        counts = [run.model(FE)["iterations"] for run in (found, expected)]
        check_less(counts[0], 1.25 * counts[1], f"{kind}: iterations, 'plastic' has {counts[1]}")
    run = run_scene(BAR, {"Domain/Cells": "4, 2, 2"})
    slope = 1000 * 100 / 1100
    for time, force in ((1, 1), (5, 1 + 0.004 * slope), (7, 0.004 * slope - 1), (10, 0.004 * slope - 1 - 0.003 * slope)):
        table.add(f"bar, t = {time}", run.total("force on right in x", FE, time), force, relative=1e-8)
    # A law that asks for shorter steps gets them.
    impatient = write_file("impatient.c", HEAD + "  if (fabs(dstran[0]) > 0.0006) *pnewdt = 0.5;\n}\n")
    run = run_scene(BAR, {"Domain/Cells": "4, 2, 2", **user(impatient), "Time/Time step": "2", "Time/End time": "4"})
    table.add("shorter steps", run.total("force on right in x", FE, 4), 4, relative=1e-8)
    check("load steps were halved" in run.stdout, f"told: {run.stdout[-500:]}")
    by_time = write_file("by_time.c", HEAD + "  if (*dtime > 0.6) *pnewdt = 0.5;\n}\n")
    for n in (1, 2):
        run = run_scene(BAR, {"Domain/Cells": "4, 2, 2", **user(by_time), "Time/Time step": "2", "Time/End time": "4"}, ranks=n)
        table.add(f"steps that are short in time, {n} process(es)", run.total("force on right in x", FE, 4), 4, relative=1e-8)
        check_less(abs(run.total("energy imbalance", FE, 4)), 1e-8 * run.total("strain energy", FE, 4), "balance of energy")
    run = run_scene(BAR, {"Domain/Cells": "4, 2, 2", "Material/User properties": "1000, 0.3, 1, 100, 0"})
    table.add("bar, isotropic, t = 7", run.total("force on right in x", FE, 7), 1 + 0.004 * slope - 2, relative=1e-8)
    table.add("bar, isotropic, t = 8", run.total("force on right in x", FE, 8), -(1 + 0.004 * slope) - (0.003 - 2 * (1 + 0.004 * slope) / 1000) * slope, relative=1e-8)
    table.show()
    tangent()


def tangent():
    """The tangent of the law after it has flowed, against differences of its stresses; alone, without a body."""
    import ctypes
    import numpy as np
    path = os.path.join(temporary_folder(), "law.so")
    xit = write_file("xit.c", "void xit_(void) {}\n", os.path.dirname(path))
    subprocess.run(["gfortran", "-shared", "-fPIC", "-O2", "-o", path, PLASTIC, xit], check=True)
    law = ctypes.CDLL(path)

    def number(value):
        return ctypes.byref(ctypes.c_double(value))

    def whole(value):
        return ctypes.byref(ctypes.c_int(value))

    def doubles(array):
        return array.ctypes.data_as(ctypes.c_void_p)

    def update(stress, states, step, n):
        stress, states, ddsdde = stress.copy(), states.copy(), np.zeros((n, n), order="F")
        props, zeros = np.array([1000, 0.3, 1, 50, 100.0]), np.zeros(9)
        law.umat_(doubles(stress), doubles(states), doubles(ddsdde), number(0), number(0), number(0), number(0), doubles(zeros), doubles(zeros), number(0),
                  doubles(zeros), doubles(step), doubles(zeros), number(1), number(0), number(0), doubles(zeros), doubles(zeros), ctypes.c_char_p(b" " * 80),
                  whole(3), whole(n - 3), whole(n), whole(n + 1), doubles(props), whole(5), doubles(zeros), doubles(zeros), number(1), number(1),
                  doubles(zeros), doubles(zeros), whole(1), whole(1), whole(1), whole(1), whole(1), whole(1), ctypes.c_size_t(80))
        return stress, states, ddsdde

    for n in (4, 6):
        generator = np.random.default_rng(n)
        stress, states = np.zeros(n), np.zeros(n + 1)
        worst, flowed = 0.0, 0
        for _ in range(20):
            step = 2e-3 * generator.standard_normal(n)
            after, new_states, D = update(stress, states, step, n)
            h = 1e-7
            by_differences = np.column_stack([(update(stress, states, step + h * e, n)[0] - update(stress, states, step - h * e, n)[0]) / (2 * h) for e in np.eye(n)])
            worst = max(worst, np.abs(D - by_differences).max() / np.abs(D).max())
            flowed += new_states[0] > states[0]
            stress, states = after, new_states
        check(flowed > 10, f"flows in {flowed} of 20 steps")
        check(worst < 1e-6, f"tangent of {n} rows against differences: {worst}")
        print(f"tangent of {n} rows against differences: {worst:.1e}")


NOTCHED = {"Domain/Cells": "8, 4, 4", "Elasticity/Contact": "false", "Cracks/Polygons": "1,0.5,-1 ; 1,2,-1 ; 1,2,2 ; 1,0.5,2", "Time/End time": "7", "Output/Probes": "0.5,0.2,0.3 ; 1.5,0.9,0.9", "Solver/Tolerance": "1e-13"}


# Swells by 0.01 of each length in a unit of time, without a load.
SWELLS = HEAD + """  const double swells = 0.01 * (time[0] + *dtime);
  for (int a = 0; a < n; ++a)
    stress[a] = 0;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
      stress[a] += ddsdde[a + n * b] * (stran[b] + dstran[b] - (b < *ndi ? swells : 0));
}
"""


# Its modulus falls with the temperature, which has to be what the last step left.
WARMS = HEAD + """  const double T = *temp + *dtemp;
  for (int a = 0; a < n; ++a)
    stress[a] = *kinc > 1 && fabs(statev[0] - *temp) > 1e-9 ? 1e9 : 0;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
      {
        ddsdde[a + n * b] *= 1. - T / 1000.;
        stress[a] += ddsdde[a + n * b] * (stran[b] + dstran[b]);
      }
  statev[0] = T;
}
"""
HEATED = scene_text("""
Dimension = 2
Physics = elasticity
Models = finite elements
Domain/Lower corner = 0, 0
Domain/Upper corner = 2, 1
Domain/Cells = 8, 4
Material/Thermal expansion = 1e-5
Boundary conditions/Displacement = left: 0, 0; right: 0, 0; bottom: 0, 0; top: 0, 0
Elasticity/Solver = newton
Elasticity/Temperature change = computed
Elasticity/Reference temperature = 20
Initial and source/Initial value = 20
Initial and source/Source = if(t < 2, 300, 0)
Time/End time = 1
Time/Time step = 0.1
Output/Write at = 0.5
Output/Probes = 1,0.5
Output/Fields = none
Solver/Tolerance = 1e-12
""")


def swelling():
    """Bodies that are loaded by nothing but what their law does at no strain."""
    folder = temporary_folder()
    law = user(write_file("swells.c", SWELLS, folder), "1", 0)
    free = {"Boundary conditions/Displacement": "", "Boundary conditions/Traction": "", "Boundary conditions/Symmetry": "left, bottom", "Elasticity/Plane": "stress",
            "Time/End time": "1", "Time/Time step": "0.5", "Output/Write at": "1"}
    nodal = {"Models": "peridynamics", "Elasticity/Model": "correspondence"}
    table = Comparison("bodies that swell")
    for name, model, settings in (("elements", FE, {}), ("nodes", PD, nodal)):
        run = run_scene(scene_of(CONSOLE, 2, solver="newton"), {**free, **law, **settings})
        table.add(f"{name}: ux", run.rows(model, time=1)[0]["ux"], 0.02, relative=1e-8)
        table.add(f"{name}: sxx", run.rows(model, time=1)[1]["sxx"], 0, absolute=1e-7)
    # held all around, there and back: what it bears at no displacement is told
    back = {"Boundary conditions/Displacement": " ; ".join(f"{side}: 0.02*min(t, 10 - t)*x, 0, 0" for side in ("left", "right", "bottom", "top", "back", "front")),
            "Boundary conditions/Symmetry": "", "Domain/Cells": "1, 1, 1", "Output/Line": "", "Output/Probes": "1, 0.5, 0.5"}
    run = run_scene(BAR, back)
    at = run.rows(FE, time=10)[0]
    check(at["ux"] == 0 and abs(at["sxx"]) > 0.1, f"a stress is left: {at}")
    table.add("force at no displacement", run.total("force on right in x", FE, time=10), at["sxx"], relative=1e-9)
    # Heated as a whole and held on all sides, by a modulus that falls with the temperature: what it is told of that, and strains less those of the temperature.
    warms = user(write_file("warms.c", WARMS, folder), "1000, 0.3", 1)
    for name, model, settings in (("elements", FE, {}), ("nodes", PD, nodal)):
        run = run_scene(HEATED, {**warms, **settings}, ranks=2 if model == PD else 1)
        for time in (0.5, 1):
            T = 20 + 300 * time
            table.add(f"{name}, heated to {T}: sxx", run.rows(model, time=time)[0]["sxx"], -1000 * (1 - T / 1000) / 0.7 * 1e-5 * (T - 20), relative=1e-9)
    table.show()


def nodes():
    folder = temporary_folder()
    fortran, nan = write_file("elastic.for", ELASTIC, folder), write_file("nan.c", HEAD + "  if (coords[0] > 1.5) stress[0] = NAN;\n}\n", folder)
    table = Comparison("a UMAT at the nodes of correspondence and the built-in laws")
    nodal = {"Models": "peridynamics", "Elasticity/Model": "correspondence"}
    for kind, (dimension, plane) in KINDS.items():
        console = scene_of(CONSOLE, dimension, solver="newton")
        settings = {**nodal, **plane, **STEADY, "Domain/Cells": "8, 4, 4" if dimension == 3 else "16, 8"}
        linear = run_scene(console, {**settings, **LINEAR})
        compare(table, f"elastic, {kind}", run_scene(console, {**settings, **user(fortran)}), linear, 1e-11, model=PD)
        if kind == "plane strain":
            two = run_scene(console, {**settings, **user(fortran)}, ranks=2)
            compare(table, "2 processes", two, linear, 1e-11, model=PD)
            moves = {**nodal, **plane, **MOVES, "Domain/Cells": "16, 8", "Elasticity/Solver": "dynamics"}
            compare(table, "in motion", run_scene(console, {**moves, **user(fortran)}), run_scene(console, {**moves, **LINEAR}), 1e-11, model=PD)
            for n in (1, 2):
                run = run_scene(console, {**settings, **user(nan)}, ranks=n, expect_error=True)
                check_one_message(run.stdout, run.stderr, ("User law", "nan.c", "stress that is no number"), f"no number, {n} process(es)")
    # Where a strain is uniform nothing is stored beside it, which `plastic` has in its yield stress and a law of the user has not.
    bar = {**nodal, "Domain/Cells": "6, 3, 3", "Boundary conditions/Symmetry": "", "Peridynamics/Surface correction": "none", "Solver/Tolerance": "1e-12",
           "Boundary conditions/Displacement": " ; ".join(f"{side}: 0.002*min(t, 10 - t)*x, 0, 0" for side in ("left", "right", "bottom", "top", "back", "front")),
           "Boundary conditions/Displacement layer": "1", "Output/Probes": "0.9, 0.4, 0.4"}
    own = run_scene(BAR, {**bar, "Material/User properties": "1000, 0.3, 1, 100, 0"})
    plastic_bar = {"Material/Law": "plastic", "Material/User law": "", "Material/User properties": "", "Material/User states": "0", **LINEAR,
                   "Material/Yield stress": "1", "Material/Hardening modulus": "100"}
    built_in = run_scene(BAR, {**bar, **plastic_bar})
    compare(table, "beyond yield", own, built_in, 1e-10, ("sxx", "syy", "von_mises"), model=PD)
    for quantity in ("strain energy", "energy dissipated by the law"):
        table.add(quantity, own.total(quantity, PD), built_in.total(quantity, PD), relative=1e-9)
    table.show()


def turned_and_stretched():
    """u of a body that turns by 90 degrees while it is stretched along its own axes: formulas, and Cauchy's stress of sigma = C : ln V, sxx, syy, sxy."""
    a, b, turn = math.log(1.5), math.log(0.8), math.pi / 2
    x, y = f"exp({a}*t)*x", f"exp({b}*t)*y"
    along, across = f"cos({turn}*t)", f"sin({turn}*t)"
    G, bulk = 1000 / 2.6, 1000 / 3 / 0.4
    pressure = (bulk - 2 * G / 3) * (a + b)
    return (f"{along}*{x} - {across}*{y} - x", f"{across}*{x} + {along}*{y} - y"), (pressure + 2 * G * b, pressure + 2 * G * a, 0)


def large():
    """Kinematics = full."""
    folder = temporary_folder()
    neo_hooke = os.path.join(SOURCE_DIR, "tests", "umats", "neo_hooke.c")
    moduli = {"Material/Young modulus": "", "Material/Poisson ratio": ""}
    law = {**moduli, **user(neo_hooke, "5, 1.0714285714285714")}  # those of the block
    table = Comparison("a neo-Hookean UMAT and 'hyperelastic'")
    nodal = {**hyperelastic.NODAL, "Domain/Cells": "8, 4", "Time/Time step": "0.25"}
    for model, dimension, settings in ((FE, 2, {}), (FE, 3, {"Domain/Cells": "4, 2, 2", "Time/Time step": "0.25"}), (PD, 2, nodal), (PD, 3, {**nodal, "Domain/Cells": "8, 4, 4", "Time/Time step": "0.5"})):
        plane = {"Elasticity/Plane": "strain"} if dimension == 2 else {}
        zero = ", 0" if dimension == 3 else ""
        bent = {"Boundary conditions/Displacement": "left: 0, 0 ; right: free, 0.8*t"}
        for what, load, columns in (("stretch 1.5", hyperelastic.pulled(dimension, 1.5), ("ux", "uy", "sxx", "von_mises")), ("shear 1.5", hyperelastic.sides(dimension, f"1.5*t*y, 0{zero}"), ("ux", "sxx", "sxy", "von_mises")),
                                    ("bent", bent, ("ux", "uy", "sxx", "sxy", "von_mises"))):
            if dimension == 3 and what == "bent" or (dimension, model, what) == (3, PD, "shear 1.5"):
                continue
            every = {**plane, **load, **settings}
            found, expected = hyperelastic.block(dimension, {**every, **law}), hyperelastic.block(dimension, every)
            compare(table, f"{model}, {dimension}D, {what}", found, expected, 1e-10, columns, model)
            table.add(f"{model}, {dimension}D, {what}, strain energy", found.total("strain energy", model), expected.total("strain energy", model), relative=1e-10)
            if what == "bent":
                for n in (2, 4):
                    compare(table, f"{model}, {dimension}D, {n} processes", hyperelastic.block(dimension, {**every, **law}, ranks=n), found, 1e-11, model=model)
    table.show()
    fortran = user(write_file("elastic.for", ELASTIC, folder))
    table = Comparison("a hypoelastic UMAT that is turned by 90 degrees and stretched: sigma = C : ln V")
    formulas, (sxx, syy, sxy) = turned_and_stretched()
    for model, settings in ((FE, {"Domain/Cells": "2, 1"}), (PD, {**nodal, "Domain/Cells": "6, 3"})):
        for steps in (10, 40):
            row = hyperelastic.block(2, {"Elasticity/Plane": "strain", **moduli, **fortran, **settings, **hyperelastic.sides(2, ", ".join(formulas)), "Time/Time step": str(1 / steps)}).rows(model)[0]
            for column, value in (("sxx", sxx), ("syy", syy), ("sxy", sxy)):
                table.add(f"{model}, {steps} steps, {column}", row[column] / abs(syy), value / abs(syy), absolute=1e-10)
    table.show()


def drucker_prager(steps, properties):
    """Stresses 11, 22, 33, 12 of a path of strains in plane strain: Python's own integration, the size of each return by bisection."""
    E, nu, c, H, a, b = properties
    G, K = E / 2 / (1 + nu), E / 3 / (1 - 2 * nu)
    stress, kappa = [0.0] * 4, 0.0
    for step in steps:
        change = sum(step[:3])
        p = sum(stress[:3]) / 3 + K * change
        s = [stress[k] - sum(stress[:3]) / 3 + 2 * G * (step[k] - change / 3) for k in range(3)] + [stress[3] + G * step[3]]
        q = math.sqrt(1.5 * (sum(x * x for x in s[:3]) + 2 * s[3] ** 2))

        def above(grown):
            return q - 3 * G * grown + a * (p - K * b * grown) - c - H * (kappa + grown)

        low, high = 0.0, q / (3 * G)
        for _ in range(100):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if above(middle) > 0 else (low, middle)
        grown = low
        stress = [(1 - 3 * G * grown / q) * x + (p - K * b * grown if k < 3 else 0) for k, x in enumerate(s)]
        kappa += grown
    return stress, kappa


def unsymmetric():
    """Drucker and Prager's law with a dilation that is not its friction."""
    properties = (1000, 0.3, 1, 50, 0.4, 0.1)
    law = user(os.path.join(SOURCE_DIR, "tests", "umats", "drucker_prager.c"), ", ".join(map(str, properties)), 1)
    table = Comparison("a flow that is not associated")
    # Sheared after it has been pressed together, without and with a strain that is uniform.
    nodal = {"Models": "peridynamics", "Elasticity/Model": "correspondence", "Peridynamics/Horizon ratio": "2", "Domain/Cells": "8, 4"}
    path = "-0.002*min(t, 1)*x + 0.004*max(t - 1, 0)*y, -0.001*min(t, 1)*y + 0.001*max(t - 1, 0)*x"
    patch = scene_of(PATCH, 2, sides=" ; ".join(f"{side}: {path}" for side in ("left", "right", "bottom", "top")))
    times = {"Elasticity/Plane": "strain", "Time/End time": "2", "Time/Time step": "0.25", "Output/Write at": "2"}
    expected, kappa = drucker_prager([(-0.0005, -0.00025, 0, 0)] * 4 + [(0, 0, 0, 0.00125)] * 4, properties)
    check(kappa > 1e-3, f"it flows: {kappa}")
    for model, settings in ((FE, {}), (PD, nodal)):
        row = run_scene(patch, {**law, **times, **settings}).rows(model)[0]
        for column, value in zip(("sxx", "syy", "sxy"), (expected[0], expected[1], expected[3])):
            table.add(f"{model}, {column}", row[column], value, absolute=1e-10)
        console = {**law, **times, **settings, "Boundary conditions/Traction": "right: -0.2*t, -0.2*t", "Time/End time": "1"}
        once = run_scene(scene_of(CONSOLE, 2, solver="newton"), {**console, "Output/Write at": "1"})
        check(once.total("energy dissipated by the law", model) > 0, f"{model}: the console flows")
        for n in (2, 4):
            compare(table, f"{model}, console, {n} processes", run_scene(scene_of(CONSOLE, 2, solver="newton"), {**console, "Output/Write at": "1"}, ranks=n), once, 1e-9, model=model)
    table.show()


def ranks():
    table = Comparison("a notched bar on several processes")
    once = run_scene(BAR, NOTCHED)
    for n in (2, 4):
        several = run_scene(BAR, NOTCHED, ranks=n)
        compare(table, f"{n} processes", several, once, 1e-9)
        table.add(f"{n} processes, dissipated", several.total("energy dissipated by the law", FE), once.total("energy dissipated by the law", FE), relative=1e-9)
    moves = scene_of(CONSOLE, 2, solver="dynamics")
    struck = {**MOVES, **user(PLASTIC, "1000, 0.3, 0.1, 0, 100", 5), "Elasticity/Plane": "strain"}
    once = run_scene(moves, struck)
    check(once.total("energy dissipated by the law", FE) > 0, "flows in motion")
    for n in (2, 4):
        compare(table, f"motion, {n} processes", run_scene(moves, struck, ranks=n), once, 1e-12)
    table.show()


def broken(body):
    return HEAD + body + "}\n"


FAR = "if (coords[0] > 1.8 && dstran[0] != 0) "  # in the first step, on one of 2 processes
BROKEN = {
    "stress": (broken(FAR + "stress[0] = 0. / 0. * stress[1];"), 0, ["a stress that is no number", "at (1.", "element", "increment 1"]),
    "tangent": (broken(FAR + "ddsdde[0] = sqrt(-1.);"), 0, ["tangent (DDSDDE) that is no number"]),
    "energy": (broken(FAR + "*sse = log(-1.);"), 0, ["an energy or a state that is no number"]),
    "states": (broken("statev[2] = 1;"), 2, ["writes more states than 'User states'", "which is 2"]),
    "no states": (broken("statev[0] = 1;"), 0, ["writes more states than 'User states'", "which is 0"]),
    "rows": (broken("stress[4] = stress[5] = 0;"), 0, ["behind the end of STRESS or DDSDDE", "NTENS = 4", "NDI = 3, NSHR = 1"]),
    "columns": (broken("ddsdde[16] = 1;"), 0, ["behind the end of STRESS or DDSDDE"]),
    "short steps": (broken("if (dstran[0] != 0) *pnewdt = 0.25;"), 0, ["0.25 times this one (PNEWDT)", "'Time step'"]),
    "no tangent": (broken("for (int k = 0; k < n * n; ++k) ddsdde[k] = 0;"), 0, ["leaves the tangent (DDSDDE) zero"]),
    "xit": (broken(FAR + "xit_();"), 0, ["has ended the run (XIT)"]),
}


def mistakes():
    folder = temporary_folder()
    scene = write_file("console.prm", scene_of(CONSOLE, 2, solver="newton"), folder)
    good = write_file("good.c", IN_C, folder)

    def fails(name, overrides, words):
        for n in (1, 2):
            run = run_scene(scene, {"Elasticity/Plane": "strain", "Output directory": os.path.join(folder, "results"), **STEADY, **overrides}, ranks=n, expect_error=True)
            check_one_message(run.stdout, run.stderr, words, f"{name}, {n} process(es)")
            if n == 1:
                print(f"{name}: {run.stderr.strip()}\n")

    for name, (text, states, words) in BROKEN.items():
        fails(name, user(write_file(f"{name}.c", text, folder), "1", states), ["'User law'", *words])
    # one that is broken in motion
    fails("in motion", {**user(os.path.join(folder, "stress.c"), "1", 0), **MOVES, "Time/Steady": "false", "Elasticity/Solver": "dynamics"}, ["'User law'", "a stress that is no number"])

    def library(name, text):
        path = os.path.join(folder, name)
        subprocess.run(["cc", "-shared", "-fPIC", "-o", path, write_file(name + ".c", text, folder)], check=True)
        return path

    for name, path, words in (("missing", "nowhere.so", ["'nowhere.so'", "is not there"]),
                              ("folder", folder, ["is a folder"]),
                              ("no library", write_file("text.so", "no library\n", folder), ["cannot be loaded", "gfortran -shared"]),
                              ("without umat_", library("other.so", "void other_(void) {}\n"), ["has no 'umat_'"]),
                              ("lacks a routine", library("lacks.so", broken("getvrm_();").replace("void xit_", "void getvrm_(void);\nvoid xit_")), ["cannot be loaded", "getvrm_"]),
                              ("source with a mistake", write_file("wrong.f90", "subroutine umat(stress\nend\n", folder), ["cannot be compiled", "gfortran"])):
        fails(name, user(path), ["'User law'", *words])
    # what the law says before it ends the run is said once
    run = run_scene(BAR, {"Material/User states": "3"}, expect_error=True, alone=True)
    check((run.stdout + run.stderr).count("needs 5 properties") == 1, f"words of the law: {(run.stdout + run.stderr)[-500:]}")
    # check tells the law, and finds a missing library without a run
    status, stdout, _ = run_perideal(["check", scene] + [word for entry, value in {**user(good, "1, 2, 3", 4), **STEADY}.items() for word in ("-s", f"{entry}={value}")])
    check(status == 0 and "good.c, properties: 3, states: 4" in stdout, f"check tells the law: {stdout[-1500:]}")
    status, _, stderr = run_perideal(["check", scene] + [word for entry, value in {**user("nowhere.so"), **STEADY}.items() for word in ("-s", f"{entry}={value}")])
    check(status == 1 and "is not there" in stderr, f"check finds that it is missing: {stderr[-500:]}")


if __name__ == "__main__":
    run_parts(elastic, plastic, swelling, nodes, large, unsymmetric, ranks, mistakes)
