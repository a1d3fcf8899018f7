// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/lists.h>
#include <perideal/scene/warmed_by_deformation.h>

#include <algorithm>

namespace PeriDeal
{
  namespace
  {
    const std::string heat_of_deformation = "Heat of deformation", absolute_zero = "Absolute zero";

    const std::string &text_of_entry(const ElasticityControl &control, const std::string &name)
    {
      return std::find_if(control.entries().begin(),
                          control.entries().end(),
                          [&](const Entry &entry) { return entry.name == name; })
        ->text;
    }
  } // namespace


  std::optional<double> absolute_reference(const ElasticityControl &control)
  {
    if (text_of_entry(control, heat_of_deformation) != "true")
      return {};
    return control.reference_temperature -
           parse_number(text_of_entry(control, absolute_zero), control.where(absolute_zero));
  }


  void check_heat_of_deformation(const ElasticityControl &control)
  {
    const bool         wanted = text_of_entry(control, heat_of_deformation) == "true";
    const std::string &zero   = text_of_entry(control, absolute_zero);
    control.refuse(!wanted && !zero.empty(),
                   absolute_zero,
                   "has no effect without 'Heat of deformation = true'. Leave one of them out.");
    if (!wanted)
      return;
    control.refuse(
      !control.computes_temperature,
      heat_of_deformation,
      "found 'true', but 'Temperature change' is '" + text_of_entry(control, "Temperature change") +
        "', which nothing warms. Use 'Temperature change = computed', or leave the entry out.");
    control.refuse(
      zero.empty(),
      heat_of_deformation,
      "found 'true', which needs 'Absolute zero' in the same section: 0 where the temperatures of the scene are in kelvins, -273.15 in degrees Celsius.");
    control.refuse(
      !(*absolute_reference(control) > 0.),
      absolute_zero,
      "found " + zero + ", but 'Reference temperature' is " +
        text_of_entry(control, "Reference temperature") +
        ", not above it: their difference is the absolute temperature of the unstressed body, which 'Heat of deformation' multiplies.");
  }
} // namespace PeriDeal
