// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/accuracy.h>
#include <perideal/scene/lists.h>

namespace PeriDeal
{
  namespace
  {
    constexpr const char *measures = "field, probes, flow: SIDE or stress intensity";
  }


  double bytes_of(const std::string &text)
  {
    const double size =
      number_with_unit(text, {{"kB", 1e3}, {"MB", 1e6}, {"GB", 1e9}, {"TB", 1e12}});
    return size > 0. ? size : -1.;
  }


  AccuracyControl::AccuracyControl()
    : SceneSection("Accuracy")
  {
    declare(
      "Tolerance",
      EntryType::number,
      "1e-2",
      "1",
      "With `Models = auto`: the error that the result may have, estimated. Of values relative to their range over the body (largest minus smallest; "
      "of a vector the component with the largest range), of a flow or a stress intensity relative to itself.");
    declare(
      "Measure",
      EntryType::text,
      "field",
      "",
      "In what the error is measured: `field`, the root mean square over the body; `probes`, the largest at the points of `Probes`; `flow: SIDE`, what "
      "enters through a side; `stress intensity`, the largest at the ends of cracks (elasticity in 2D).");
    declare(
      "Budget",
      EntryType::text,
      "",
      "s",
      "Wall time in seconds within which a result has to be there, the best until then. Empty: "
      "no limit.");
    declare("Memory",
            EntryType::text,
            "",
            "",
            "Memory that may be taken, with its unit (4 GB). Empty: what the machine has free.");
    parse();
  }


  void AccuracyControl::parse()
  {
    tolerance = positive_number("Tolerance");
    refuse(tolerance > 0.5,
           "Tolerance",
           "found " + text("Tolerance") + ", needs a number between 1e-8 and 0.5.");
    refuse(
      tolerance < 1e-8,
      "Tolerance",
      "found " + text("Tolerance") +
        ", which rounding and the linear solver do not allow; needs a number between 1e-8 and 0.5.");
    const std::string given = trimmed(text("Measure")), flow = "flow:";
    side.clear();
    if (given == "field")
      measure = AccuracyMeasure::field;
    else if (given == "probes")
      measure = AccuracyMeasure::probes;
    else if (given == "stress intensity")
      measure = AccuracyMeasure::stress_intensity;
    else if (given.compare(0, flow.size(), flow) == 0)
      {
        measure = AccuracyMeasure::flow;
        side    = trimmed(given.substr(flow.size()));
        refuse(side.empty(), "Measure", "found '" + given + "', needs a side behind 'flow:'.");
      }
    else
      error("Measure",
            "found '" + given + "', needs " + measures + "." +
              did_you_mean(given, {"field", "probes", "flow: SIDE", "stress intensity"}));
    budget = -1.;
    if (!text("Budget").empty())
      {
        budget = parse_number(text("Budget"), where("Budget"));
        refuse(!(budget > 0.),
               "Budget",
               "found " + text("Budget") + ", needs seconds, more than 0.");
      }
    memory = -1.;
    if (!text("Memory").empty())
      {
        memory = bytes_of(text("Memory"));
        refuse(memory < 0.,
               "Memory",
               "found '" + text("Memory") +
                 "', needs a size with its unit: kB, MB, GB or TB, as in '4 GB'.");
      }
  }
} // namespace PeriDeal
