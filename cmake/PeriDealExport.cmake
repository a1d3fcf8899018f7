# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors

# find_package(PeriDeal): the same package file serves the build tree and an installation.

include(CMakePackageConfigHelpers)
set(perideal_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/PeriDeal)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/PeriDealConfig.cmake.in
  ${PROJECT_BINARY_DIR}/PeriDealConfig.cmake
  INSTALL_DESTINATION ${perideal_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/PeriDealConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
configure_file(${PROJECT_SOURCE_DIR}/cmake/PeriDealDealII.cmake ${PROJECT_BINARY_DIR}/PeriDealDealII.cmake COPYONLY)

install(TARGETS perideal_library EXPORT PeriDealTargets)
install(TARGETS perideal)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/perideal DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT PeriDealTargets NAMESPACE PeriDeal:: DESTINATION ${perideal_package_dir})
install(FILES ${PROJECT_BINARY_DIR}/PeriDealConfig.cmake ${PROJECT_BINARY_DIR}/PeriDealConfigVersion.cmake
  ${PROJECT_BINARY_DIR}/PeriDealDealII.cmake DESTINATION ${perideal_package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The Python package, for PYTHONPATH; it finds the program that is installed with it.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/python DESTINATION ${CMAKE_INSTALL_DATADIR}/perideal
  FILES_MATCHING PATTERN "*.py" PATTERN "__pycache__" EXCLUDE)

# The scripts that draw reports, and the scenes to start from with their meshes and pictures.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/applications/report DESTINATION ${CMAKE_INSTALL_DATADIR}/perideal
  FILES_MATCHING PATTERN "*.py" PATTERN "*.css" PATTERN "__pycache__" EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/prm DESTINATION ${CMAKE_INSTALL_DATADIR}/perideal)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/doc/ DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg"
  PATTERN "reproduce" EXCLUDE)

export(EXPORT PeriDealTargets NAMESPACE PeriDeal:: FILE ${PROJECT_BINARY_DIR}/PeriDealTargets.cmake)
