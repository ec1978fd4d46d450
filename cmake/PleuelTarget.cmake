# One library a folder: the include rule of the house is its link rule.
#
#   pleuel_library(NAME [LIGHT] SOURCES a.cpp b.cpp PUBLIC libs... PRIVATE libs...)
#
# LIGHT: what does not compute in every step, compiled with PLEUEL_LIGHT_FLAGS.
# Headers are included from the root of the repository: #include "core/beam/beam_element.hpp".
function(pleuel_library name)
  cmake_parse_arguments(ARG "LIGHT" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  if(ARG_SOURCES)
    add_library(${name} STATIC ${ARG_SOURCES})
    target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} pleuel_warnings)
    if(ARG_LIGHT)
      pleuel_compile_lightly(${name})
    elseif(NOT name STREQUAL "pleuel_base")
      pleuel_precompile(${name} REUSE_FROM pleuel_base)
    endif()
    pleuel_compile_together(${name})
  else()
    add_library(${name} INTERFACE)
    target_include_directories(${name} INTERFACE ${PROJECT_SOURCE_DIR})
    target_link_libraries(${name} INTERFACE ${ARG_PUBLIC})
  endif()
endfunction()

# Most of the compiler's time is optimization, and most of the program never runs in a step: it reads, judges,
# and writes. The flags have precompiled headers of their own, those of the first such target.
set(PLEUEL_LIGHT_FLAGS "" CACHE STRING "Compiler flags of what does not compute in every step, after the others")
function(pleuel_compile_lightly name)
  separate_arguments(flags UNIX_COMMAND "${PLEUEL_LIGHT_FLAGS}")
  target_compile_options(${name} PRIVATE ${flags})
  set_target_properties(${name} PROPERTIES PLEUEL_LIGHT ON)
  if(NOT flags)
    pleuel_precompile(${name} REUSE_FROM pleuel_base)
  elseif(name STREQUAL "pleuel_scene")
    pleuel_precompile(${name})
  else()
    pleuel_precompile(${name} REUSE_FROM pleuel_scene)
  endif()
endfunction()

# Several files of a target at once, in groups of about the same size: from scratch that takes far less
# processor time, since headers are read and templates instantiated once for all of them. After a change of one
# file it takes longer. Names in anonymous namespaces then have to differ within a target. Sources with the operators of
# core/base/eager_matrices.hpp are grouped by themselves: others must not see them.
option(PLEUEL_UNITY "Compile several files at once: faster from scratch, slower after a change" OFF)
set(PLEUEL_UNITY_SIZE 250000 CACHE STRING "Bytes of source in a group of files that are compiled at once")
function(pleuel_compile_together name)
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${PLEUEL_UNITY} UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${name} SOURCES)
  set(group_of_eager 0)
  set(group_of_lazy 0)
  set(size_of_eager 0)
  set(size_of_lazy 0)
  foreach(source IN LISTS sources)
    if(NOT source MATCHES "\\.cpp$")
      continue()
    endif()
    get_filename_component(path ${source} ABSOLUTE)
    file(STRINGS ${path} includes REGEX "#include \"core/base/eager_matrices.hpp\"")
    set(kind lazy)
    if(includes)
      set(kind eager)
    endif()
    file(SIZE ${path} bytes)
    math(EXPR size "${size_of_${kind}} + ${bytes}")
    if(size GREATER PLEUEL_UNITY_SIZE AND size_of_${kind} GREATER 0)
      math(EXPR group_of_${kind} "${group_of_${kind}} + 1")
      set(size ${bytes})
    endif()
    set(size_of_${kind} ${size})
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${kind}_${group_of_${kind}})
  endforeach()
endfunction()

# Of files that are compiled together, a name of one may be that of a local variable of another, and GCC
# takes their anonymous namespaces for those of headers.
set(pleuel_shadow -Wshadow)
if(PLEUEL_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(pleuel_shadow -Wshadow=local -Wno-subobject-linkage)
elseif(PLEUEL_UNITY)
  set(pleuel_shadow "")
endif()
add_library(pleuel_warnings INTERFACE)
target_compile_options(pleuel_warnings INTERFACE -Wall -Wextra -Wpedantic ${pleuel_shadow}
                       -Wconversion -Wno-sign-conversion)
# GCC 12 sees overlapping copies in "text" + std::string(…) (its bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(pleuel_warnings INTERFACE -Wno-restrict)
endif()
# Clang asks for the braces of a base class, which C++17 leaves out.
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  target_compile_options(pleuel_warnings INTERFACE -Wno-missing-braces)
endif()
if(PLEUEL_WERROR)
  target_compile_options(pleuel_warnings INTERFACE -Werror)
endif()

# Headers of Eigen, fmt and the standard library are parsed once for all targets that see pleuel_base
# (they share its flags): most of the time of a small file. Sources include what they use all the
# same; the preset dev compiles without.
#
#   pleuel_precompile(NAME HEADERS <a> <b>)    precompiles them on top of the usual ones
#   pleuel_precompile(NAME REUSE_FROM OTHER)   takes those of another target
option(PLEUEL_PCH "Precompile the headers of Eigen, fmt and the standard library" ON)
function(pleuel_precompile name)
  cmake_parse_arguments(ARG "" "REUSE_FROM" "HEADERS" ${ARGN})
  if(NOT PLEUEL_PCH)
    return()
  elseif(ARG_REUSE_FROM)
    target_precompile_headers(${name} REUSE_FROM ${ARG_REUSE_FROM})
  else()
    target_precompile_headers(${name} PRIVATE
      <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory> <optional> <string>
      <variant> <vector> <Eigen/Core> <Eigen/Geometry> <Eigen/SparseCore> <fmt/format.h>
      ${ARG_HEADERS})
  endif()
endfunction()

# GCC takes what it includes that way for the project's own: its guesses about overruns in inlined code
# of the libraries would be told, too. The preset dev still hears those of our files.
if(PLEUEL_PCH AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(pleuel_warnings INTERFACE
    -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread -Wno-free-nonheap-object
    -Wno-maybe-uninitialized)
endif()

# GCC looks for memory that it does not need any more, again and again: a tenth of its time for a tenth of its memory.
add_compile_options("$<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-expand=200;--param=ggc-min-heapsize=1000000>")

# Where ccache is the launcher: single files that one checkout has compiled serve all others, wherever they
# stand (files that are compiled together do not: CMake names them by absolute paths); and files with
# precompiled headers are taken, since no macro reaches into them.
if(CMAKE_CXX_COMPILER_LAUNCHER MATCHES "ccache$")
  set(pleuel_ccache CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1)
  if(PLEUEL_PCH)
    list(APPEND pleuel_ccache CCACHE_SLOPPINESS=pch_defines,time_macros)
    add_compile_options($<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
    add_compile_options("$<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>")
  endif()
  set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env ${pleuel_ccache} ${CMAKE_CXX_COMPILER_LAUNCHER})
endif()

# The static libraries behind a target, without those of the tests and those inside a shared library behind it.
function(pleuel_libraries_behind target result)
  get_target_property(type ${target} TYPE)
  get_target_property(folder ${target} SOURCE_DIR)
  get_target_property(is_imported ${target} IMPORTED)
  if(is_imported OR target IN_LIST ${result})
    return()
  endif()
  set(libraries ${${result}})
  if(type STREQUAL "INTERFACE_LIBRARY")
    get_target_property(links ${target} INTERFACE_LINK_LIBRARIES)
  else()
    get_target_property(links ${target} LINK_LIBRARIES)
  endif()
  foreach(link IN LISTS links)
    set(link_type "")
    if(TARGET "${link}")
      get_target_property(link_type ${link} TYPE)
    endif()
    if(link_type MATCHES "^(STATIC|INTERFACE)_LIBRARY$")
      pleuel_libraries_behind(${link} libraries)
    endif()
  endforeach()
  string(FIND "${folder}" "${PROJECT_SOURCE_DIR}/tests" in_tests)
  if(type STREQUAL "STATIC_LIBRARY" AND NOT in_tests EQUAL 0)
    list(APPEND libraries ${target})
  endif()
  set(${result} ${libraries} PARENT_SCOPE)
endfunction()

# Of a function that several libraries and a program contain, as a template of Eigen, the linker takes the first.
# So libraries that are compiled with all optimization stand before those with less, and before what the program itself
# consists of. They are linked as a whole for this, since nothing has asked for a part of them yet.
#
#   pleuel_link_optimized_first(NAME FLAGS)    FLAGS: those of NAME itself; none: there is nothing to do
function(pleuel_link_optimized_first name flags)
  set(libraries "")
  pleuel_libraries_behind(${name} libraries)
  if(NOT flags OR NOT libraries)
    return()
  endif()
  set(optimized "")
  set(light "")
  foreach(library IN LISTS libraries)
    get_target_property(is_light ${library} PLEUEL_LIGHT)
    if(is_light)
      list(APPEND light $<TARGET_FILE:${library}>)
    else()
      list(APPEND optimized $<TARGET_FILE:${library}>)
    endif()
  endforeach()
  target_link_options(${name} PRIVATE
                      LINKER:--whole-archive ${optimized} ${light} LINKER:--no-whole-archive)
endfunction()
