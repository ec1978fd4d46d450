# cmake --install: the program, the library, what is needed to compile against it, the Python package.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(pleuel_cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/pleuel)

install(TARGETS libpleuel EXPORT pleuel
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
# The same made for newer processors: the loader takes the one that fits (packaging/build-packages).
set(PLEUEL_V3_LIBRARY "" CACHE FILEPATH "libpleuel.so of a build with PLEUEL_MARCH=x86-64-v3, to be installed beside")
if(PLEUEL_V3_LIBRARY)
  install(FILES ${PLEUEL_V3_LIBRARY} RENAME libpleuel.so.${PROJECT_VERSION_MAJOR}
          DESTINATION ${CMAKE_INSTALL_LIBDIR}/glibc-hwcaps/x86-64-v3 COMPONENT library)
endif()

install(TARGETS pleuel RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
if(TARGET pleuel-mpi)
  install(TARGETS pleuel-mpi RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()
install(FILES ${PROJECT_BINARY_DIR}/report/report.html DESTINATION ${CMAKE_INSTALL_DATADIR}/pleuel
        COMPONENT library OPTIONAL)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/problems DESTINATION ${CMAKE_INSTALL_DATADIR}/pleuel
        COMPONENT program PATTERN hard EXCLUDE)

install(FILES ${PROJECT_SOURCE_DIR}/include/pleuel.h ${PROJECT_SOURCE_DIR}/include/pleuel.hpp
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(EXPORT pleuel NAMESPACE pleuel:: FILE pleuel-config.cmake DESTINATION ${pleuel_cmake_folder}
        COMPONENT development)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pleuel-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
file(RELATIVE_PATH pleuel_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(pleuel.pc.in ${PROJECT_BINARY_DIR}/pleuel.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/pleuel-config-version.cmake DESTINATION ${pleuel_cmake_folder}
        COMPONENT development)
install(FILES ${PROJECT_BINARY_DIR}/pleuel.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
        COMPONENT development)

set(PLEUEL_PYTHON_FOLDER lib/python3/dist-packages CACHE PATH "Where the Python package is installed, from the prefix on")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/pleuel DESTINATION ${PLEUEL_PYTHON_FOLDER} COMPONENT python
        PATTERN __pycache__ EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/examples DESTINATION share/doc/python3-pleuel COMPONENT python
        PATTERN __pycache__ EXCLUDE)
