// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <vector>

namespace PeriDeal
{
  /** A solution that was compared with the one before, on a coarser mesh. */
  struct ComparedSolution
  {
    double fineness   = 0.; // in proportion to 1/h
    double difference = 0.; // of what is measured; none for the first
  };


  /** What a sequence of solutions says of the last one. */
  struct ObservedError
  {
    double error = -1.; // estimated; negative: too little is known
    double order = 0.;  // with which it goes on getting smaller
  };


  /**
   * The error e = C/fineness^p of the last of some solutions on ever finer meshes, from the
   * differences d_k = |u_k - u_(k-1)| of each to the one before, where the error of the finer one
   * is d_k/(q^p - 1), q the ratio of their finenesses.
   *
   * The order p is that which the last two differences show, between @p lowest and @p best. As
   * long as there is one difference only, 2.25 is taken, or 1 if @p best is not higher: the first
   * of all solutions is worse than an order would have it. A difference that is small by accident
   * shows no small error: what the one before it said, with the order that is left, counts for
   * half, and wholly where @p lowest is @p best, and no higher than 1.
   */
  ObservedError observed_error(const std::vector<ComparedSolution> &steps,
                               const double                         lowest,
                               const double                         best);

  /**
   * The error that the last one of two or more solutions has if errors get smaller slowly, with
   * the order 1.25: of two solutions 2.7 times what observed_error() says where cells are halved.
   */
  double largest_error(const std::vector<ComparedSolution> &steps);

  /**
   * The fineness with which an error gets as small as this one. The order may have been
   * overestimated: steps of more than a factor of @p farthest are not taken.
   */
  double fineness_for(const ObservedError &now,
                      const double         fineness,
                      const double         wanted,
                      const double         farthest);
} // namespace PeriDeal
