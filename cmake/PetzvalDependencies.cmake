# SPDX-License-Identifier: BSD-3-Clause
# Every library that Petzval uses, as an imported target. All come from Debian 12 packages.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB CONFIG REQUIRED COMPONENTS tbb)
find_package(Boost 1.74 REQUIRED)
find_package(OpenEXR 3 CONFIG REQUIRED)
find_package(PNG REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)

# Libraries without a CMake file of their own.
function(petzval_import name header library)
  cmake_parse_arguments(ARG "" "" "PATHS" ${ARGN})
  string(REPLACE "::" "_" id ${name})
  find_path(${id}_INCLUDE ${header} PATHS ${ARG_PATHS} REQUIRED)
  find_library(${id}_LIBRARY ${library} REQUIRED)
  mark_as_advanced(${id}_INCLUDE ${id}_LIBRARY)
  add_library(${name} UNKNOWN IMPORTED GLOBAL)
  set_target_properties(${name} PROPERTIES IMPORTED_LOCATION ${${id}_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${${id}_INCLUDE})
endfunction()

petzval_import(petzval_fftw::double fftw3.h fftw3)
petzval_import(petzval_fftw::float fftw3.h fftw3f)
petzval_import(petzval_matio::matio matio.h matio)
petzval_import(petzval_hdf5::hdf5 hdf5.h hdf5_serial PATHS /usr/include/hdf5/serial)
