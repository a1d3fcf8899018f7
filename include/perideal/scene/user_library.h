// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/perideal_bond_law.h>

#include <mpi.h>

#include <cstddef>
#include <memory>
#include <string>

namespace PeriDeal
{
  /** What a `umat_` is, as compilers of Fortran call it: Abaqus' arguments, and a hidden length. */
  using Umat = void (*)(double     *stress,
                        double     *statev,
                        double     *ddsdde,
                        double     *sse,
                        double     *spd,
                        double     *scd,
                        double     *rpl,
                        double     *ddsddt,
                        double     *drplde,
                        double     *drpldt,
                        double     *stran,
                        double     *dstran,
                        double     *time,
                        double     *dtime,
                        double     *temp,
                        double     *dtemp,
                        double     *predef,
                        double     *dpred,
                        char       *cmname,
                        int        *ndi,
                        int        *nshr,
                        int        *ntens,
                        int        *nstatv,
                        double     *props,
                        int        *nprops,
                        double     *coords,
                        double     *drot,
                        double     *pnewdt,
                        double     *celent,
                        double     *dfgrd0,
                        double     *dfgrd1,
                        int        *noel,
                        int        *npt,
                        int        *layer,
                        int        *kspt,
                        int        *kstep,
                        int        *kinc,
                        std::size_t cmname_length);


  /** perideal_bond_law() of perideal_bond_law.h. */
  using BondLawOfUser = decltype(&perideal_bond_law);


  /** A shared library with a law of stresses or of bonds, loaded while this lives. */
  class UserLibrary
  {
  public:
    enum class Wanted
    {
      stresses, // a `umat_`
      bonds     // a perideal_bond_law()
    };

    /**
     * The file, a library or a source in Fortran or C, which process 0 compiles into a temporary
     * folder. What is loaded already is not loaded again. Collective. Throws UserError.
     *
     * @param folder where the file is looked for if there is nothing at its path
     * @param wanted what it has to have
     */
    static std::shared_ptr<const UserLibrary> of_file(const std::string &file_name,
                                                      const std::string &folder,
                                                      const MPI_Comm     communicator,
                                                      const Wanted       wanted);

    /** @param bond_law_version 0: it has no law of bonds */
    UserLibrary(void *const         handle,
                const Umat          umat,
                const BondLawOfUser bond_law,
                const int           bond_law_version,
                const std::string  &file_name)
      : umat(umat)
      , bond_law(bond_law)
      , bond_law_version(bond_law_version)
      , file_name(file_name)
      , handle(handle)
    {}

    UserLibrary(const UserLibrary &)            = delete;
    UserLibrary &operator=(const UserLibrary &) = delete;

    ~UserLibrary();

    const Umat          umat;     // null: it has none
    const BondLawOfUser bond_law; // likewise
    const int           bond_law_version;
    const std::string   file_name; // as users know it

  private:
    void *const handle;
  };


  /**
   * Make a call of a `umat_`, as @p call(@p data). Returns whether it has come back: false where
   * it has called XIT. What it throws goes on.
   */
  bool comes_back(void (*const call)(void *), void *const data);

  /** XIT: leave the call that is being made. */
  [[noreturn]] void leave_user_library();
} // namespace PeriDeal
