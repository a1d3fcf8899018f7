# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors

# Target doc: the documentation of the classes, where Doxygen is installed.

find_package(Doxygen QUIET OPTIONAL_COMPONENTS dot)
if(DOXYGEN_FOUND)
  set(PERIDEAL_HAVE_DOT NO)
  if(TARGET Doxygen::dot)
    set(PERIDEAL_HAVE_DOT YES)
  endif()
  configure_file(${PROJECT_SOURCE_DIR}/doc/Doxyfile.in ${PROJECT_BINARY_DIR}/doc/Doxyfile @ONLY)
  add_custom_target(doc
    COMMAND Doxygen::doxygen ${PROJECT_BINARY_DIR}/doc/Doxyfile
    COMMAND ${CMAKE_COMMAND} -E echo "Documentation: ${PROJECT_BINARY_DIR}/doc/html/index.html"
    COMMENT "Documentation of the classes"
    VERBATIM)
endif()
