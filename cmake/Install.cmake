# What `cmake --install` puts where: the library with its headers for CMake and pkg-config, the command with its man page,
# completions and scenes. All paths are relative, so that what is installed may be moved.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
# Below /usr the rules of distributions hold.
set(DM_DISTRIBUTION FALSE)
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(DM_DISTRIBUTION TRUE)
endif()
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/dreampm)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/dreampm DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
        FILES_MATCHING PATTERN "*.h")
install(FILES ${PROJECT_BINARY_DIR}/generated/dreampm/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/dreampm
        COMPONENT development)
foreach(kind ${DM_LIBRARIES})
  set(component development)
  if(kind STREQUAL static)
    set(component static)
    install(FILES ${PROJECT_SOURCE_DIR}/cmake/Dependencies.cmake DESTINATION ${package_folder} COMPONENT static)
  endif()
  install(TARGETS dm_${kind} EXPORT dreampm_${kind}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT static
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT development
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT dreampm_${kind} FILE ${kind}.cmake NAMESPACE dreampm:: DESTINATION ${package_folder} COMPONENT ${component})
endforeach()

set(config ${PROJECT_BINARY_DIR}/generated/dreampmConfig.cmake)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/dreampmConfig.cmake.in ${config} INSTALL_DESTINATION ${package_folder}
                              NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/dreampmConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${config} ${PROJECT_BINARY_DIR}/generated/dreampmConfigVersion.cmake DESTINATION ${package_folder}
        COMPONENT development)

# For pkg-config --static, and for --libs alone where there is no shared library.
set(static_libs "-lfmt -lspdlog -ltbb -lz -lpugixml -lpng -lyaml-cpp -lopenvdb -lcrypto -lembree${embree_VERSION_MAJOR}")
pkg_check_modules(DM_IMATH QUIET Imath)  # which OpenVDB's headers call
pkg_check_modules(DM_OPENEXR QUIET OpenEXR)
foreach(libraries HDF5_C_LIBRARIES DM_OPENEXR_LINK_LIBRARIES DM_BULLET_LINK_LIBRARIES DM_IMATH_LINK_LIBRARIES)
  list(JOIN ${libraries} " " paths)
  string(APPEND static_libs " ${paths}")
endforeach()
string(APPEND static_libs " -lpthread -ldl -lstdc++ -lm")
set(DM_PC_LIBS "-L\${libdir} -ldreampm")
set(DM_PC_PRIVATE "${static_libs}")
if(NOT TARGET dm_shared)
  set(DM_PC_LIBS "${DM_PC_LIBS} ${static_libs}")
  set(DM_PC_PRIVATE "")
endif()
file(RELATIVE_PATH DM_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" DM_PC_PREFIX ${DM_PC_PREFIX})
configure_file(${PROJECT_SOURCE_DIR}/cmake/dreampm.pc.in ${PROJECT_BINARY_DIR}/generated/dreampm.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/generated/dreampm.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

if(NOT DM_DISTRIBUTION)
  install(FILES LICENSE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
endif()
if(DM_COMMAND)
  if(NOT DM_DISTRIBUTION)
    # Libraries that an archive brings along. The old tag is meant: it holds for the libraries of libraries, too.
    file(RELATIVE_PATH brought /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR}/dreampm)
    set_target_properties(dreampm PROPERTIES INSTALL_RPATH "\$ORIGIN/${brought}")
    target_link_options(dreampm PRIVATE -Wl,--disable-new-dtags)
  endif()
  install(TARGETS dreampm RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
  install(FILES ${PROJECT_BINARY_DIR}/share/dreampm.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime)
  install(FILES ${PROJECT_BINARY_DIR}/share/dreampm.bash RENAME dreampm
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT runtime)
  install(FILES ${PROJECT_BINARY_DIR}/share/dreampm.zsh RENAME _dreampm COMPONENT runtime
          DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/$<IF:$<BOOL:${DM_DISTRIBUTION}>,vendor-completions,site-functions>)
  install(FILES ${PROJECT_BINARY_DIR}/share/dreampm.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
          COMPONENT runtime)
  install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/dreampm COMPONENT runtime FILES_MATCHING PATTERN "*.yaml"
          PATTERN "validation" EXCLUDE PATTERN "pictures" EXCLUDE)
  # Models that scenes name are fetched by it.
  install(PROGRAMS tools/fetch_dragon DESTINATION ${CMAKE_INSTALL_DATADIR}/dreampm COMPONENT runtime)
endif()
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development FILES_MATCHING PATTERN "*.cpp" PATTERN "*.py"
        PATTERN "CMakeLists.txt")
# Pages beside them: their links to examples hold.
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime FILES_MATCHING PATTERN "*.md" PATTERN "*.py"
        PATTERN "*.jpg" PATTERN "*.png" PATTERN "*.svg" PATTERN "notes" EXCLUDE)
