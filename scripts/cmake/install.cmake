# `cmake --install`: the library with its headers and its packages for CMake and pkg-config, the program with its man page
# and completions, the kernels.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# One library of all layers; the program and the tests take the layers themselves, of which they see more.
add_library(pointgi_library $<TARGET_OBJECTS:pointgi_octree> $<TARGET_OBJECTS:pointgi_fmm>
                            $<TARGET_OBJECTS:pointgi_host>)
# FLANN is headers to us, which call LZ4; its own package names HDF5 and MPI besides.
pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4)
target_link_libraries(pointgi_library PRIVATE OpenCL::OpenCL OpenEXR::OpenEXR PNG::PNG ZLIB::ZLIB fmt::fmt
                      tomlplusplus::tomlplusplus assimp::assimp PkgConfig::LZ4 OpenMP::OpenMP_CXX Threads::Threads ${CMAKE_DL_LIBS})
set_target_properties(pointgi_library PROPERTIES OUTPUT_NAME pointgi EXPORT_NAME pointgi LINKER_LANGUAGE CXX
                      VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
target_compile_features(pointgi_library INTERFACE cxx_std_17)
target_include_directories(pointgi_library INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)

# The public headers, which include each other by their places in the sources, by those that they are installed at.
set(public_headers host/error.h host/run_control.h host/api/context.h host/api/scene.h host/api/prepared.h
    host/api/film.h host/api/pointgi.h)
foreach(header IN LISTS public_headers)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${header})
  file(READ ${CMAKE_SOURCE_DIR}/${header} text)
  string(REGEX REPLACE "#include \"host/(api/)?" "#include \"pointgi/" text "${text}")
  get_filename_component(name ${header} NAME)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/include/pointgi/${name} CONTENT "${text}" @ONLY)
endforeach()

# Texts that repeat the program's options are written by asking it.
set(texts ${CMAKE_BINARY_DIR}/generated/texts)
if(NOT CMAKE_CROSSCOMPILING)
  add_custom_command(
    OUTPUT ${texts}/pointgi.1 ${texts}/pointgi ${texts}/_pointgi
    COMMAND ${CMAKE_SOURCE_DIR}/scripts/install/write_texts $<TARGET_FILE:pointgi> ${PROJECT_VERSION} ${texts}
    DEPENDS pointgi ${CMAKE_SOURCE_DIR}/scripts/install/write_texts
    COMMENT "Writing the man page and the completions"
    VERBATIM)
  add_custom_target(pointgi_texts ALL DEPENDS ${texts}/pointgi.1 ${texts}/pointgi ${texts}/_pointgi)
  install(FILES ${texts}/pointgi.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${texts}/pointgi DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  install(FILES ${texts}/_pointgi DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
endif()

configure_package_config_file(${CMAKE_SOURCE_DIR}/scripts/install/pointgiConfig.cmake.in
                              ${CMAKE_BINARY_DIR}/generated/pointgiConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pointgi)
# Until 1.0 a second number may change what programs rely on.
write_basic_package_version_file(${CMAKE_BINARY_DIR}/generated/pointgiConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
file(RELATIVE_PATH headers_from_package ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_FULL_INCLUDEDIR})
configure_file(${CMAKE_SOURCE_DIR}/scripts/install/pointgi.pc.in ${CMAKE_BINARY_DIR}/generated/pointgi.pc @ONLY)

install(TARGETS pointgi)
install(TARGETS pointgi_library EXPORT pointgiTargets)
install(EXPORT pointgiTargets NAMESPACE pointgi:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pointgi)
install(FILES ${CMAKE_BINARY_DIR}/generated/pointgiConfig.cmake ${CMAKE_BINARY_DIR}/generated/pointgiConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pointgi)
install(FILES ${CMAKE_BINARY_DIR}/generated/pointgi.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(DIRECTORY ${CMAKE_BINARY_DIR}/include/pointgi DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
# For POINTGI_KERNEL_DIR: kernels to be read and edited. The program and the library need none of them.
install(DIRECTORY kernels DESTINATION ${CMAKE_INSTALL_DATADIR}/pointgi FILES_MATCHING PATTERN *.cl PATTERN *.h
        PATTERN *.toml)
