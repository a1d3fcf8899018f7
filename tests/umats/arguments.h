/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Copyright (C) 2026 the PeriDeal authors */

#pragma once

/* What a UMAT in C begins with. */

#include <math.h>
#include <stddef.h>

#define UMAT                 \
  void umat_(double *stress, \
             double *statev, \
             double *ddsdde, \
             double *sse,    \
             double *spd,    \
             double *scd,    \
             double *rpl,    \
             double *ddsddt, \
             double *drplde, \
             double *drpldt, \
             double *stran,  \
             double *dstran, \
             double *time,   \
             double *dtime,  \
             double *temp,   \
             double *dtemp,  \
             double *predef, \
             double *dpred,  \
             char   *cmname, \
             int    *ndi,    \
             int    *nshr,   \
             int    *ntens,  \
             int    *nstatv, \
             double *props,  \
             int    *nprops, \
             double *coords, \
             double *drot,   \
             double *pnewdt, \
             double *celent, \
             double *dfgrd0, \
             double *dfgrd1, \
             int    *noel,   \
             int    *npt,    \
             int    *layer,  \
             int    *kspt,   \
             int    *kstep,  \
             int    *kinc,   \
             size_t  cmname_length)
