# `make package` calls cpack twice: with the prefix /usr for a .deb, as Debian's rules want files to lie; with another one for
# a .tar.gz that brings the libraries it needs and runs where it is unpacked.
set(CPACK_PACKAGE_NAME dreampm)
set(CPACK_PACKAGE_VENDOR "The DreaMPM maintainers")
set(DM_CONTACT "The DreaMPM maintainers <maintainers@dreampm.invalid>" CACHE STRING "whom a .deb names as its maintainer")
set(CPACK_PACKAGE_CONTACT ${DM_CONTACT})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "liquids and solids by the material point method")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "A simulator of water, jelly, sand, snow and other soft matter by the
material point method. One text file describes a scene, and one command
turns it into a film: it simulates, wraps a surface around the liquid,
renders the frames and encodes them. A playground lets one pour, push
and cut matter in a window.
.
The package holds the command, and the library for programs in C++.")
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_COMPONENTS_ALL runtime development)

if(DM_DISTRIBUTION)
  # Without them cpack would write a package that asks for nothing.
  find_program(DM_SHLIBDEPS dpkg-shlibdeps)
  find_program(DM_FILE file)
  if(NOT DM_SHLIBDEPS OR NOT DM_FILE)
    message(STATUS "no .deb can be made: dpkg-shlibdeps or file is missing (Debian: dpkg-dev file)")
    return()
  endif()
  include(DebianFiles)
  set(CPACK_GENERATOR DEB)
  set(CPACK_DEB_COMPONENT_INSTALL ON)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
  set(CPACK_DEBIAN_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
  # Which letters the playground shows, and what its window is drawn with, shlibdeps cannot see.
  set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "fonts-dejavu-core, libegl1, libgl1")
  file(WRITE ${debian}/triggers "activate-noawait ldconfig\n")
  set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${debian}/triggers)
  set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
else()
  set(CPACK_GENERATOR TGZ)
  set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)
  set(CPACK_COMPONENT_INCLUDE_TOPLEVEL_DIRECTORY ON)
  set(CPACK_PACKAGE_FILE_NAME dreampm-${PROJECT_VERSION}-linux-${CMAKE_SYSTEM_PROCESSOR})
  list(APPEND CPACK_COMPONENTS_ALL bundle)
  configure_file(cmake/bundle.cmake.in generated/bundle.cmake @ONLY)
  install(SCRIPT ${PROJECT_BINARY_DIR}/generated/bundle.cmake COMPONENT bundle EXCLUDE_FROM_ALL)
endif()
include(CPack)
