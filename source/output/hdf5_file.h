// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <hdf5.h>

#include <cstddef>
#include <string>

namespace PeriDeal
{
  /**
   * A new HDF5 file with tables at its root, written by one process, a table after the other, rows
   * in order. After the first failure nothing more is tried, and close() tells why. (The wrappers
   * of deal.II throw then, and say nothing of a failure to close, which is when a full disk may
   * show.)
   */
  class Hdf5File
  {
  public:
    explicit Hdf5File(const std::string &name);
    ~Hdf5File();

    Hdf5File(const Hdf5File &)            = delete;
    Hdf5File &operator=(const Hdf5File &) = delete;

    /** Begin a table of so many rows and columns; the type is that of append(). */
    template <typename number>
    void begin_table(const std::string &name,
                     const std::size_t  n_rows,
                     const std::size_t  n_columns);

    /** The next rows of the table. */
    template <typename number>
    void append(const number *values, const std::size_t n_rows);

    /**
     * Close everything. Returns 0, or the error number of the first failure (-1 if the system gave
     * none).
     */
    int close();

  private:
    void note(const bool good);
    void close_table();

    hid_t       file = -1, table = -1;
    std::size_t n_columns = 0, n_written = 0;
    int         problem = 0;
  };
} // namespace PeriDeal
