# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors

# Flags, build type, compiler cache and the number of compilers at once.

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

get_property(perideal_multi_config GLOBAL PROPERTY GENERATOR_IS_MULTI_CONFIG)
if(perideal_multi_config)
  message(FATAL_ERROR "PeriDeal builds one configuration per folder: use the Ninja or Makefile generator.")
endif()
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release or Debug" FORCE)
endif()

# No debug information in Release: it doubles the time to compile and to link. The innermost loops get -O3 file by file.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
set(CMAKE_CXX_FLAGS_DEBUG "-Og -g1")

# Sanitizers for all that is built here, and the checks of the standard library. Of undefined behaviour all but what the address
# sanitizer reports too (null pointers, objects that are not there) and what doubles the time to compile.
set(perideal_memory_per_job 2200) # MB
if(PERIDEAL_SANITIZE)
  string(APPEND CMAKE_CXX_FLAGS_DEBUG " -O1 -fno-omit-frame-pointer -D_GLIBCXX_ASSERTIONS"
    " -fsanitize=address,undefined,float-cast-overflow -fno-sanitize=null,alignment,object-size,vptr,pointer-overflow")
  set(perideal_memory_per_job 2500)
endif()

# What is only for our own sources, never for those who use the library.
add_library(perideal_own_flags INTERFACE)
target_compile_options(perideal_own_flags INTERFACE -Wall -Wextra
  -fPIC # programs too, so that they can use the precompiled header of the library
  $<$<BOOL:${PERIDEAL_WARNINGS_AS_ERRORS}>:-Werror>)

# The gold linker needs 1 second for what the default one does in 11: deal.II brings 180 libraries.
include(CheckLinkerFlag)
check_linker_flag(CXX "-fuse-ld=gold" PERIDEAL_HAS_GOLD)
target_link_options(perideal_own_flags INTERFACE
  $<$<BOOL:${PERIDEAL_HAS_GOLD}>:-fuse-ld=gold> -Wl,--as-needed)

# ccache, told that a precompiled header does not make a file uncacheable, and that folders do not matter without -g.
find_program(PERIDEAL_CCACHE ccache)
mark_as_advanced(PERIDEAL_CCACHE)
if(PERIDEAL_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(perideal_ccache_settings
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
    CCACHE_BASEDIR=${PROJECT_SOURCE_DIR})
  if(CMAKE_BUILD_TYPE STREQUAL "Release")
    list(APPEND perideal_ccache_settings CCACHE_NOHASHDIR=1)
  endif()
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env ${perideal_ccache_settings} ${PERIDEAL_CCACHE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # No folder in messages, either: then what was compiled in one clone serves in others.
    target_compile_options(perideal_own_flags INTERFACE -fpch-preprocess -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
  endif()
endif()

# A batch of files with deal.II in three dimensions takes up to 2.2 GB to compile: as many at once as cores and memory allow.
cmake_host_system_information(RESULT perideal_cores QUERY NUMBER_OF_LOGICAL_CORES)
cmake_host_system_information(RESULT perideal_memory QUERY TOTAL_PHYSICAL_MEMORY) # MiB
if(EXISTS /sys/fs/cgroup/memory.max)
  file(READ /sys/fs/cgroup/memory.max perideal_limit)
  string(STRIP "${perideal_limit}" perideal_limit)
  if(perideal_limit MATCHES "^[0-9]+$")
    math(EXPR perideal_limit "${perideal_limit} / 1048576")
    if(perideal_limit LESS perideal_memory)
      set(perideal_memory ${perideal_limit})
    endif()
  endif()
endif()
math(EXPR perideal_jobs "${perideal_memory} / ${perideal_memory_per_job}")
if(perideal_jobs GREATER perideal_cores)
  set(perideal_jobs ${perideal_cores})
endif()
if(perideal_jobs LESS 1)
  set(perideal_jobs 1)
endif()
set(PERIDEAL_COMPILE_JOBS ${perideal_jobs} CACHE STRING "Number of compilers at once (Ninja)")
set_property(GLOBAL PROPERTY JOB_POOLS compile=${PERIDEAL_COMPILE_JOBS} link=2)
set(CMAKE_JOB_POOL_COMPILE compile)
set(CMAKE_JOB_POOL_PRECOMPILE_HEADER compile)
set(CMAKE_JOB_POOL_LINK link)

# Headers before installation, libraries beside the programs after it.
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")

# A Python with the packages for pictures; the first in PATH may lack them.
if(NOT PERIDEAL_PYTHON)
  foreach(candidate /usr/bin/python3 python3)
    execute_process(COMMAND ${candidate} -c "import numpy, matplotlib, h5py"
      RESULT_VARIABLE result OUTPUT_QUIET ERROR_QUIET)
    if(result EQUAL 0)
      set(PERIDEAL_PYTHON ${candidate} CACHE STRING "Python 3 with numpy, matplotlib and h5py")
      break()
    endif()
  endforeach()
endif()
