// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
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
    /** @param user_block bytes at the beginning that are not HDF5's: 0, or 512, 1024, ... */
    explicit Hdf5File(const std::string &name, const std::size_t user_block = 0);
    ~Hdf5File();

    Hdf5File(const Hdf5File &)            = delete;
    Hdf5File &operator=(const Hdf5File &) = delete;

    /**
     * Begin a table of so many rows and columns; the type is that of append(). Slashes in the name
     * make groups.
     */
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


  /** An HDF5 file to read from, on one process. */
  class Hdf5Input
  {
  public:
    explicit Hdf5Input(const std::string &name);
    ~Hdf5Input();

    Hdf5Input(const Hdf5Input &)            = delete;
    Hdf5Input &operator=(const Hdf5Input &) = delete;

    /** Rows of a table; false if it has no such rows or they cannot be read. */
    template <typename number>
    bool read(const std::string &table,
              const std::size_t  first_row,
              const std::size_t  n_rows,
              const std::size_t  n_columns,
              number            *values) const;

    /** All of a table of one column; false if it cannot be read. */
    template <typename Container>
    bool read_all(const std::string &table, Container &values) const;

  private:
    std::size_t n_rows_of(const std::string &table) const;

    hid_t file = -1;
  };


  template <typename Container>
  bool Hdf5Input::read_all(const std::string &table, Container &values) const
  {
    values.resize(n_rows_of(table));
    return read(table, 0, values.size(), 1, values.data());
  }
} // namespace PeriDeal
