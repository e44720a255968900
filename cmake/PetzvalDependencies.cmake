# SPDX-License-Identifier: BSD-3-Clause
# Every library that Petzval uses, as an imported target. All come from Debian 12 packages.
# Read twice: by the project itself, which requires them all, and by the installed petzvalConfig.cmake, because a
# static library hands its own libraries on to whoever links it. Both have set CMAKE_FIND_PACKAGE_NAME to petzval.
include(CMakeFindDependencyMacro)

# petzval_import(NAME HEADER LIBRARY [PATHS ...]): a library without a CMake file of its own.
macro(petzval_import name header library)
  cmake_parse_arguments(petzval_import "" "" "PATHS" ${ARGN})
  string(REPLACE "::" "_" petzval_id ${name})
  find_path(${petzval_id}_INCLUDE ${header} PATHS ${petzval_import_PATHS})
  find_library(${petzval_id}_LIBRARY ${library})
  mark_as_advanced(${petzval_id}_INCLUDE ${petzval_id}_LIBRARY)
  if(NOT ${petzval_id}_INCLUDE OR NOT ${petzval_id}_LIBRARY)
    set(petzval_FOUND FALSE)
    set(petzval_NOT_FOUND_MESSAGE "${header} or the library ${library} is missing")
    if(petzval_FIND_REQUIRED)
      message(FATAL_ERROR "${petzval_NOT_FOUND_MESSAGE}; tools/install_packages.sh installs what Petzval needs")
    endif()
    return()
  endif()
  if(NOT TARGET ${name})
    add_library(${name} UNKNOWN IMPORTED GLOBAL)
    set_target_properties(${name} PROPERTIES IMPORTED_LOCATION ${${petzval_id}_LIBRARY}
      INTERFACE_INCLUDE_DIRECTORIES ${${petzval_id}_INCLUDE})
  endif()
endmacro()

find_dependency(Threads)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(TBB CONFIG COMPONENTS tbb)
find_dependency(Boost 1.74)
# Debian's Imath names at length a Python library that it does not need here: that is no news.
set(petzval_log_level ${CMAKE_MESSAGE_LOG_LEVEL})
set(CMAKE_MESSAGE_LOG_LEVEL NOTICE)
find_dependency(OpenEXR 3 CONFIG)
set(CMAKE_MESSAGE_LOG_LEVEL ${petzval_log_level})
find_dependency(PNG)
find_dependency(TIFF)
find_dependency(ZLIB)
find_dependency(nlohmann_json)
find_dependency(fmt)
find_dependency(hwy CONFIG)
find_dependency(embree 3 CONFIG)
petzval_import(petzval_fftw::double fftw3.h fftw3)
petzval_import(petzval_fftw::float fftw3.h fftw3f)
petzval_import(petzval_matio::matio matio.h matio)
petzval_import(petzval_yaml::yaml yaml.h yaml)
petzval_import(petzval_hdf5::hdf5 hdf5.h hdf5_serial PATHS /usr/include/hdf5/serial)
