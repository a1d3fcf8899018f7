// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "hdf5_file.h"

#include <perideal/output/field_writer.h>

#include <cerrno>
#include <type_traits>

namespace PeriDeal
{
  namespace
  {
    template <typename number>
    hid_t type_of()
    {
      return std::is_same<number, double>::value        ? H5T_NATIVE_DOUBLE :
             std::is_same<number, std::uint64_t>::value ? H5T_NATIVE_UINT64 :
             std::is_same<number, std::uint32_t>::value ? H5T_NATIVE_UINT32 :
                                                          H5T_NATIVE_CHAR;
    }
  } // namespace


  Hdf5File::Hdf5File(const std::string &name, const std::size_t user_block)
  {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_userblock(creation, user_block);
    errno = 0;
    file  = H5Fcreate(name.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT);
    note(file >= 0);
    H5Pclose(creation);
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
    const hid_t   groups  = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(groups, 1);
    note(space >= 0);
    table =
      H5Dcreate2(file, name.c_str(), type_of<number>(), space, groups, H5P_DEFAULT, H5P_DEFAULT);
    note(table >= 0);
    H5Pclose(groups);
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


  Hdf5Input::Hdf5Input(const std::string &name)
  {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    file = H5Fopen(name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  }


  Hdf5Input::~Hdf5Input()
  {
    if (file >= 0)
      H5Fclose(file);
  }


  std::size_t Hdf5Input::n_rows_of(const std::string &table) const
  {
    const hid_t data    = H5Dopen2(file, table.c_str(), H5P_DEFAULT);
    const hid_t space   = H5Dget_space(data);
    hsize_t     sizes[] = {0, 0};
    if (H5Sget_simple_extent_ndims(space) == 2)
      H5Sget_simple_extent_dims(space, sizes, nullptr);
    H5Sclose(space);
    H5Dclose(data);
    return sizes[0];
  }


  template <typename number>
  bool Hdf5Input::read(const std::string &table,
                       const std::size_t  first_row,
                       const std::size_t  n_rows,
                       const std::size_t  n_columns,
                       number            *values) const
  {
    if (n_rows == 0)
      return true;
    const hsize_t sizes[] = {n_rows, n_columns}, begin[] = {first_row, 0};
    const hid_t   data     = H5Dopen2(file, table.c_str(), H5P_DEFAULT);
    const hid_t   in_table = H5Dget_space(data);
    const hid_t   in_core  = H5Screate_simple(2, sizes, nullptr);
    const bool    good =
      data >= 0 && in_table >= 0 &&
      H5Sselect_hyperslab(in_table, H5S_SELECT_SET, begin, nullptr, sizes, nullptr) >= 0 &&
      H5Dread(data, type_of<number>(), in_core, in_table, H5P_DEFAULT, values) >= 0;
    H5Sclose(in_core);
    H5Sclose(in_table);
    H5Dclose(data);
    return good;
  }


#define PERIDEAL_HDF5_NUMBER(number)                                         \
  template void Hdf5File::begin_table<number>(const std::string &,           \
                                              const std::size_t,             \
                                              const std::size_t);            \
  template void Hdf5File::append<number>(const number *, const std::size_t); \
  template bool Hdf5Input::read<number>(const std::string &,                 \
                                        const std::size_t,                   \
                                        const std::size_t,                   \
                                        const std::size_t,                   \
                                        number *) const;

  PERIDEAL_HDF5_NUMBER(double)
  PERIDEAL_HDF5_NUMBER(char)
  PERIDEAL_HDF5_NUMBER(std::uint32_t)
  PERIDEAL_HDF5_NUMBER(std::uint64_t)
} // namespace PeriDeal
