// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/section.h>

#include <string>

namespace PeriDeal
{
  /** In what the accuracy that section `Accuracy` asks for is measured. */
  enum class AccuracyMeasure
  {
    field,           // root mean square of the error over the body
    probes,          // largest error at the points of `Probes`
    flow,            // of what enters through a side
    stress_intensity // largest of all ends of cracks
  };


  /** Section `Accuracy`: what `Models = auto` has to reach, and what it may take. */
  class AccuracyControl : public SceneSection
  {
  public:
    AccuracyControl();

    double          tolerance = 1e-2; // relative to the range of the values, or to the value
    AccuracyMeasure measure   = AccuracyMeasure::field;
    std::string     side;         // of a flow
    double          budget = -1.; // seconds of wall time; negative: none
    double          memory = -1.; // bytes; negative: what the machine has free

    /** Throws UserError. */
    void parse();

    /** As the entry has it. */
    std::string measure_text() const
    {
      return text("Measure");
    }
  };


  /**
   * Bytes of a size with its unit, `500 MB` or `4 GB` (powers of 1000); negative if the text is
   * none.
   */
  double bytes_of(const std::string &text);
} // namespace PeriDeal
