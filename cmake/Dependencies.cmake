# What the library links, found in one place. The project reads this file, and so does the installed package where the
# library is static: dm_find is find_package there, find_dependency here.
if(NOT COMMAND dm_find)
  macro(dm_find)
    find_package(${ARGV})
    if(NOT ${ARGV0}_FOUND)
      message(FATAL_ERROR "${ARGV0} was not found. On Debian and Ubuntu, tools/setup installs what DreaMPM builds with: "
                          "tools/setup tools/packages.txt (as root). Elsewhere: docs/guide/install.md")
    endif()
  endmacro()
endif()
dm_find(Threads)
dm_find(TBB)
dm_find(fmt)
dm_find(spdlog)
dm_find(ZLIB)
dm_find(pugixml)
dm_find(PNG)
dm_find(yaml-cpp)
dm_find(HDF5 COMPONENTS C)
if(NOT DM_CORE_ONLY)
  # OpenVDB's Find module lies beside its library and is on no path of CMake's own.
  list(APPEND CMAKE_MODULE_PATH /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB)
  dm_find(OpenVDB)
  dm_find(OpenSSL COMPONENTS Crypto)
  # Embree 4, or 3 where that is what there is (render/embree.h).
  find_package(embree 4 QUIET)
  if(NOT embree_FOUND)
    dm_find(embree 3)
  endif()
  # The build of Bullet in doubles: positions of bodies are the solver's.
  dm_find(PkgConfig)
  pkg_check_modules(DM_BULLET REQUIRED IMPORTED_TARGET bullet-float64)
endif()
