# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors

# PeriDeal::deal_ii: headers (as system headers), definitions and libraries of deal.II and nothing else.
#
# The macros of deal.II would also hand its own optimisation, debug and warning flags to every user of the library,
# after their own flags. The debug and the release library of deal.II differ in the layout of classes, so the
# choice is made once, when PeriDeal is built, and PeriDealConfig.cmake repeats it: PeriDeal_DEAL_II_BUILD is RELEASE or DEBUG.

# A deal.II of one's own: the variable, or that of the environment. It is this one or none.
set(perideal_deal_ii "${DEAL_II_DIR}")
if(NOT perideal_deal_ii)
  set(perideal_deal_ii "$ENV{DEAL_II_DIR}")
endif()
if(perideal_deal_ii)
  get_filename_component(perideal_deal_ii "${perideal_deal_ii}" ABSOLUTE)
  string(FIND "${deal.II_DIR}/" "${perideal_deal_ii}/" perideal_place)
  if(NOT perideal_place EQUAL 0)
    unset(deal.II_DIR CACHE) # those of an earlier configuration
    unset(PERIDEAL_MPIRUN CACHE)
  endif()
  find_package(deal.II 9.4 QUIET CONFIG PATHS ${perideal_deal_ii} NO_DEFAULT_PATH)
  if(NOT deal.II_FOUND)
    message(FATAL_ERROR "DEAL_II_DIR is ${perideal_deal_ii}, where no deal.II 9.4 or newer is (deal.IIConfig.cmake). "
                        "Correct it, or unset it to take the deal.II of the system.")
  endif()
else()
  find_package(deal.II 9.4 QUIET REQUIRED CONFIG)
endif()
message(STATUS "deal.II ${DEAL_II_PACKAGE_VERSION}: ${DEAL_II_PATH}")
foreach(feature MPI P4EST TRILINOS HDF5 MUPARSER)
  if(NOT DEAL_II_WITH_${feature})
    message(FATAL_ERROR "The deal.II in ${DEAL_II_PATH} was built without ${feature}, which PeriDeal needs.")
  endif()
endforeach()

if(NOT PeriDeal_DEAL_II_BUILD)
  set(PeriDeal_DEAL_II_BUILD RELEASE)
  if(CMAKE_BUILD_TYPE STREQUAL "Debug")
    if("DEBUG" IN_LIST DEAL_II_BUILD_TYPES)
      set(PeriDeal_DEAL_II_BUILD DEBUG)
    else()
      message(WARNING "The deal.II in ${DEAL_II_PATH} has no debug library: Assert is not active.")
    endif()
  endif()
endif()

if(NOT TARGET PeriDeal::deal_ii)
  # The target of the library itself, or the plain list where it was not read.
  if(DEAL_II_TARGET_CONFIG AND NOT TARGET ${DEAL_II_TARGET_${PeriDeal_DEAL_II_BUILD}})
    include(${DEAL_II_TARGET_CONFIG})
  endif()
  set(perideal_deal_ii_includes "")
  foreach(folder ${DEAL_II_INCLUDE_DIRS})
    get_filename_component(folder ${folder} REALPATH)
    if(EXISTS ${folder} AND NOT folder IN_LIST CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES)
      list(APPEND perideal_deal_ii_includes ${folder})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES perideal_deal_ii_includes)

  add_library(PeriDeal::deal_ii INTERFACE IMPORTED GLOBAL)
  set_target_properties(PeriDeal::deal_ii PROPERTIES
    INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${perideal_deal_ii_includes}"
    INTERFACE_INCLUDE_DIRECTORIES "${perideal_deal_ii_includes}"
    INTERFACE_COMPILE_FEATURES cxx_std_17
    INTERFACE_COMPILE_DEFINITIONS
      "${DEAL_II_USER_DEFINITIONS};${DEAL_II_USER_DEFINITIONS_${PeriDeal_DEAL_II_BUILD}}"
    INTERFACE_LINK_LIBRARIES "${DEAL_II_TARGET_${PeriDeal_DEAL_II_BUILD}}")
endif()
