# One library a folder: the include rule of the house is its link rule.
#
#   pleuel_library(NAME SOURCES a.cpp b.cpp PUBLIC libs... PRIVATE libs...)
#
# Headers are included from the root of the repository: #include "core/beam/beam_element.hpp".
function(pleuel_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  if(ARG_SOURCES)
    add_library(${name} STATIC ${ARG_SOURCES})
    target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} pleuel_warnings)
  else()
    add_library(${name} INTERFACE)
    target_include_directories(${name} INTERFACE ${PROJECT_SOURCE_DIR})
    target_link_libraries(${name} INTERFACE ${ARG_PUBLIC})
  endif()
endfunction()

add_library(pleuel_warnings INTERFACE)
target_compile_options(pleuel_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                       -Wno-sign-conversion)
# GCC 12 sees overlapping copies in "text" + std::string(…) (its bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(pleuel_warnings INTERFACE -Wno-restrict)
endif()
if(PLEUEL_WERROR)
  target_compile_options(pleuel_warnings INTERFACE -Werror)
endif()
