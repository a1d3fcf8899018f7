// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/section.h>

#include <mpi.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** Numbers over ascending places, linear in between. */
  struct FormulaTable
  {
    /**
     * Beyond the ends the number there, if the table holds it or HeldTableEnds is alive; else NaN,
     * and TableFault knows of it.
     */
    double value(const double place) const;

    std::string         name, file; // as the scene calls it; as it was found
    bool                holds = false;
    std::vector<double> places, numbers;
  };


  /** What formulas of a scene know by name besides variables and functions (section `Formulas`). */
  struct FormulaNames
  {
    std::vector<std::pair<std::string, double>> constants;
    std::vector<FormulaTable>                   tables;
  };


  /**
   * The names of the scene that was parsed last, for formulas that are compiled from now on. The
   * same object for the same names and numbers. Not thread safe.
   */
  const std::shared_ptr<const FormulaNames> &names_of_formulas();

  /** What a table was asked for last beyond its ends. */
  struct TableFault
  {
    /** For messages, a blank before it; empty: nothing. */
    std::string text() const;

    const FormulaTable *table = nullptr;
    double              place = 0.;
  };

  TableFault &table_fault();


  /**
   * While this is alive tables hold the numbers of their ends, as for integrals whose lower end
   * does not matter.
   */
  class HeldTableEnds
  {
  public:
    HeldTableEnds();
    ~HeldTableEnds();
    HeldTableEnds(const HeldTableEnds &)            = delete;
    HeldTableEnds &operator=(const HeldTableEnds &) = delete;
  };


  /** Section `Formulas`. */
  class Formulas : public SceneSection
  {
  public:
    Formulas();

    /**
     * Read the names, and make them those of formulas (names_of_formulas()).
     * @param folder that of the scene file, in which files are looked for, too
     * Throws UserError: a name that is taken or no name; a file that is missing or no table.
     * Collective.
     */
    void parse(const std::string &folder, const MPI_Comm communicator);

    std::shared_ptr<const FormulaNames> names;
  };
} // namespace PeriDeal
