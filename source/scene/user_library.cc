// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/external_program.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/user_library.h>

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <csetjmp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <utility>
#include <vector>

#include "bond_law_header.h"

namespace PeriDeal
{
  namespace fs = std::filesystem;

  namespace
  {
    const std::string user_law_file = "Entry 'User law' in section 'Material': '";


    /** The compiler of such a source, empty of other files. */
    std::string compiler_of(const fs::path &file)
    {
      std::string ending = file.extension().string();
      std::transform(ending.begin(), ending.end(), ending.begin(), [](const unsigned char c) {
        return std::tolower(c);
      });
      const std::vector<std::string> fortran =
        {".f", ".for", ".ftn", ".f90", ".f95", ".f03", ".f08"};
      const auto chosen = [](const char *const variable, const char *const otherwise) {
        const char *const value = std::getenv(variable);
        return std::string(value != nullptr && *value != 0 ? value : otherwise);
      };
      if (std::find(fortran.begin(), fortran.end(), ending) != fortran.end())
        return chosen("FC", "gfortran");
      return ending == ".c" ? chosen("CC", "cc") : "";
    }


    /** What a compiler says, as far as one needs it: the first place and the first error. */
    std::string first_error(const fs::path &log)
    {
      std::ifstream in(log);
      std::string   first, line, error;
      while (std::getline(in, line))
        {
          if (first.empty())
            first = line;
          if (error.empty() &&
              (line.find("rror:") != std::string::npos || line.find("undefined") < line.size()))
            error = line;
        }
      return error.empty() || error == first ? first : first + " " + error;
    }


    /** Compile a source into a folder. Returns what is wrong, as it goes on after its name. */
    std::string compile_law(const fs::path    &source,
                            const std::string &compiler,
                            const fs::path    &folder,
                            const fs::path    &library)
    {
      // What Abaqus brings for the head of a UMAT in fixed form.
      for (const char *const name : {"ABA_PARAM.INC", "aba_param.inc"})
        std::ofstream(folder / name) << "      implicit real*8(a-h,o-z)\n"
                                        "      parameter (nprecd=2)\n";
      std::ofstream(folder / "perideal_bond_law.h") << text_of_bond_law_header;
      const fs::path log    = folder / "log";
      const int      status = std::system(("cd " + shell_word(folder.string()) + " && " + compiler +
                                      " -shared -fPIC -O2 -I. -o " + shell_word(library.string()) +
                                      " " + shell_word(fs::absolute(source).string()) + " -lm > " +
                                      shell_word(log.string()) + " 2>&1")
                                       .c_str());
      constexpr int  unknown = 127 << 8;
      if (status == unknown)
        return "is a source, and '" + compiler +
               "' to compile it was not found. Install it (Debian: gfortran for Fortran, gcc for "
               "C), or compile the law elsewhere and give the shared library.";
      if (status != 0 || !fs::exists(library))
        return "cannot be compiled by '" + compiler + " -shared -fPIC -O2': " + first_error(log);
      return "";
    }


    /** Null with a fault, as it goes on after the file's name. */
    std::shared_ptr<const UserLibrary> load_library(const fs::path    &library,
                                                    const std::string &file_name,
                                                    std::string       &fault)
    {
      // A name without a slash would be looked for among the libraries of the system.
      void *const handle = dlopen(fs::absolute(library).c_str(), RTLD_NOW | RTLD_LOCAL);
      if (handle == nullptr)
        {
          const char *const why = dlerror();
          fault = std::string("cannot be loaded: ") + (why == nullptr ? "unknown reason" : why) +
                  ". Compile it as a shared library on this machine, 'gfortran -shared -fPIC -O2 "
                  "-o law.so law.f90', or give the source itself.";
          return nullptr;
        }
      // A pointer to data may be turned into one to a function on systems that have dlopen().
      const auto umat     = reinterpret_cast<Umat>(dlsym(handle, "umat_"));
      const auto bond_law = reinterpret_cast<BondLawOfUser>(dlsym(handle, "perideal_bond_law"));
      const auto version  = reinterpret_cast<int (*)()>(dlsym(handle, "perideal_bond_law_version"));
      return std::make_shared<const UserLibrary>(handle,
                                                 umat,
                                                 bond_law,
                                                 version == nullptr ? 0 : version(),
                                                 file_name);
    }


    /** Whether it has what is wanted; else what is wrong, as it goes on after the file's name. */
    std::string lack_of(const UserLibrary &library, const UserLibrary::Wanted wanted)
    {
      constexpr int known    = PERIDEAL_BOND_LAW_VERSION;
      const bool    has_umat = library.umat != nullptr, has_bonds = library.bond_law != nullptr;
      if (wanted == UserLibrary::Wanted::stresses)
        return has_umat  ? "" :
               has_bonds ? "has a 'perideal_bond_law', a law of bonds, which is for 'Models = "
                           "peridynamics' with 'Model = state-based' or 'bond-based' (section "
                           "'Elasticity'); here it needs a 'umat_'." :
                           "has no 'umat_', which a subroutine UMAT in Fortran makes, or 'void "
                           "umat_(...)' in C ('extern \"C\"' in C++).";
      if (!has_bonds)
        return has_umat ? "has a 'umat_', a law of stresses, which is for 'Models = finite "
                          "elements', and for 'peridynamics' with 'Model = correspondence' "
                          "(section 'Elasticity'). Use these, or a 'perideal_bond_law'." :
                          "has no 'perideal_bond_law', the law of bonds that perideal_bond_law.h "
                          "tells of ('extern \"C\"' in C++).";
      if (library.bond_law_version == 0)
        return "has no 'perideal_bond_law_version', which returns PERIDEAL_BOND_LAW_VERSION of "
               "perideal_bond_law.h.";
      return library.bond_law_version == known ?
               "" :
               "was made with version " + std::to_string(library.bond_law_version) +
                 " of perideal_bond_law.h; this program has version " + std::to_string(known) +
                 ". Compile it with that.";
    }


    fs::path library_near(const std::string &file_name, const std::string &folder)
    {
      const fs::path beside = fs::path(folder) / file_name;
      return !fs::exists(file_name) && fs::exists(beside) ? beside : fs::path(file_name);
    }


    /** What is loaded, by the file and when that was written. */
    using Loaded = std::map<std::pair<std::string, long long>, std::weak_ptr<const UserLibrary>>;

    Loaded loaded_libraries;

    std::jmp_buf *way_out = nullptr;
  } // namespace


  std::shared_ptr<const UserLibrary> UserLibrary::of_file(const std::string &file_name,
                                                          const std::string &folder,
                                                          const MPI_Comm     communicator,
                                                          const Wanted       wanted)
  {
    const fs::path  file = library_near(file_name, folder);
    std::error_code ignored;
    std::string     fault;
    if (!fs::exists(file, ignored))
      fault = "is not there, neither at this path nor beside the scene.";
    else if (fs::is_directory(file, ignored))
      fault = "is a folder, needs a shared library or its source.";
    throw_on_all_if_any(communicator,
                        fault.empty() ? "" : user_law_file + file_name + "' " + fault);

    const auto time = fs::last_write_time(file, ignored).time_since_epoch().count();
    auto      &kept = loaded_libraries[{fs::absolute(file).string(), static_cast<long long>(time)}];
    const auto last = kept.lock();
    int        rank = 0, is_known = last ? 1 : 0, all_know = 0;
    MPI_Comm_rank(communicator, &rank);
    MPI_Allreduce(&is_known, &all_know, 1, MPI_INT, MPI_MIN, communicator);
    const auto with_what_is_wanted = [&](const std::shared_ptr<const UserLibrary> &library) {
      const std::string lack = lack_of(*library, wanted);
      throw_on_all_if_any(communicator,
                          lack.empty() ? "" : user_law_file + file_name + "' " + lack);
      return library;
    };
    if (all_know == 1)
      return with_what_is_wanted(last);

    const std::string                compiler = compiler_of(file);
    std::unique_ptr<TemporaryFolder> compiled;
    std::string                      library = file.string();
    if (!compiler.empty())
      {
        if (rank == 0)
          {
            compiled = std::make_unique<TemporaryFolder>("perideal_law");
            library  = (compiled->path / "law.so").string();
            fault =
              compiled->path.empty() ?
                "is a source, and there can be no temporary folder to compile it in (TMPDIR)." :
                compile_law(file, compiler, compiled->path, library);
          }
        throw_on_all_if_any(communicator,
                            fault.empty() ? "" : user_law_file + file_name + "' " + fault);
        std::vector<char> name(library.begin(), library.end());
        auto              size = static_cast<unsigned long>(name.size());
        MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG, 0, communicator);
        name.resize(size);
        MPI_Bcast(name.data(), static_cast<int>(size), MPI_CHAR, 0, communicator);
        library.assign(name.begin(), name.end());
      }
    const auto now = load_library(library, file_name, fault);
    // All have it before process 0 removes the folder.
    throw_on_all_if_any(communicator,
                        fault.empty() ? "" : user_law_file + file_name + "' " + fault);
    kept = now;
    return with_what_is_wanted(now);
  }


  UserLibrary::~UserLibrary()
  {
    dlclose(handle);
  }


  bool comes_back(void (*const call)(void *), void *const data)
  {
    std::jmp_buf        here;
    std::jmp_buf *const before = way_out;
    way_out                    = &here;
    // Not by an exception: Fortran need not be compiled so that these find their way through it.
    if (setjmp(here) != 0)
      {
        way_out = before;
        return false;
      }
    try
      {
        call(data);
      }
    catch (...)
      {
        way_out = before;
        throw;
      }
    way_out = before;
    return true;
  }


  void leave_user_library()
  {
    if (way_out == nullptr)
      std::exit(1);
    std::longjmp(*way_out, 1);
  }
} // namespace PeriDeal
