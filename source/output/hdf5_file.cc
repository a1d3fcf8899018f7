// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "hdf5_file.h"

#include <perideal/output/field_writer.h>

#include <cerrno>
#include <cstdint>
#include <type_traits>

namespace PeriDeal
{
  namespace
  {
    template <typename number>
    hid_t type_of()
    {
      static_assert(std::is_same<number, double>::value ||
                    std::is_same<number, std::uint32_t>::value);
      return std::is_same<number, double>::value ? H5T_NATIVE_DOUBLE : H5T_NATIVE_UINT32;
    }
  } // namespace


  Hdf5File::Hdf5File(const std::string &name)
  {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    errno = 0;
    file  = H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    note(file >= 0);
  }


  Hdf5File::~Hdf5File()
  {
    close();
  }


  void Hdf5File::note(const bool good)
  {
    if (!good && problem == 0)
      problem = errno != 0 ? errno : -1;
  }


  void start_hdf5()
  {
    H5dont_atexit();
    H5open();
  }


  template <typename number>
  void Hdf5File::begin_table(const std::string &name,
                             const std::size_t  n_rows,
                             const std::size_t  columns)
  {
    close_table();
    if (problem != 0)
      return;
    errno                 = 0;
    n_columns             = columns;
    n_written             = 0;
    const hsize_t sizes[] = {n_rows, columns};
    const hid_t   space   = H5Screate_simple(2, sizes, nullptr);
    note(space >= 0);
    table = H5Dcreate2(file,
                       name.c_str(),
                       type_of<number>(),
                       space,
                       H5P_DEFAULT,
                       H5P_DEFAULT,
                       H5P_DEFAULT);
    note(table >= 0);
    H5Sclose(space);
  }


  template <typename number>
  void Hdf5File::append(const number *values, const std::size_t n_rows)
  {
    if (problem != 0 || n_rows == 0)
      return;
    errno                  = 0;
    const hsize_t sizes[]  = {n_rows, n_columns};
    const hsize_t begin[]  = {n_written, 0};
    const hid_t   in_core  = H5Screate_simple(2, sizes, nullptr);
    const hid_t   in_table = H5Dget_space(table);
    note(in_core >= 0 && in_table >= 0 &&
         H5Sselect_hyperslab(in_table, H5S_SELECT_SET, begin, nullptr, sizes, nullptr) >= 0);
    if (problem == 0)
      note(H5Dwrite(table, type_of<number>(), in_core, in_table, H5P_DEFAULT, values) >= 0);
    H5Sclose(in_core);
    H5Sclose(in_table);
    n_written += n_rows;
  }


  void Hdf5File::close_table()
  {
    if (table >= 0)
      note(H5Dclose(table) >= 0);
    table = -1;
  }


  int Hdf5File::close()
  {
    errno = 0;
    close_table();
    if (file >= 0)
      note(H5Fclose(file) >= 0);
    file = -1;
    return problem;
  }


  template void Hdf5File::begin_table<double>(const std::string &,
                                              const std::size_t,
                                              const std::size_t);
  template void Hdf5File::begin_table<std::uint32_t>(const std::string &,
                                                     const std::size_t,
                                                     const std::size_t);
  template void Hdf5File::append<double>(const double *, const std::size_t);
  template void Hdf5File::append<std::uint32_t>(const std::uint32_t *, const std::size_t);
} // namespace PeriDeal
