# dreampm::dreampm, what programs link: the public headers of include/dreampm and one library of all that they need, static
# and shared from the same objects. The command is linked from the modules instead: it uses more than the public headers.
if(PROJECT_IS_TOP_LEVEL)
  set(kinds static shared)
elseif(BUILD_SHARED_LIBS)
  set(kinds shared)
else()
  set(kinds static)
endif()
set(DM_LIBRARIES "${kinds}" CACHE STRING "which libraries to build, a list: static, shared")

set(objects "")
foreach(module base physics geometry import import_models level_set state contact io scene backend rigid_motion solver rigid surface foam render setup pictures run simulation)
  list(APPEND objects $<TARGET_OBJECTS:dm_${module}>)
endforeach()
foreach(isa ${DM_ISAS})
  list(APPEND objects $<TARGET_OBJECTS:dm_kernels_${isa}> $<TARGET_OBJECTS:dm_projection_kernels_${isa}>)
endforeach()
# What has code of its own; headers alone (Eigen, Boost, nlohmann_json) are not asked for again where the library is installed.
set(DM_LIBRARY_LINKS fmt::fmt spdlog::spdlog TBB::tbb Threads::Threads ZLIB::ZLIB pugixml::pugixml PNG::PNG OpenEXR::OpenEXR yaml-cpp hdf5::hdf5
                     OpenVDB::openvdb OpenSSL::Crypto embree PkgConfig::DM_BULLET)

foreach(kind ${DM_LIBRARIES})
  string(TOUPPER ${kind} type)
  add_library(dm_${kind} ${type} ${objects})
  target_compile_features(dm_${kind} PUBLIC cxx_std_20)
  target_include_directories(dm_${kind} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                               $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>)
  target_link_libraries(dm_${kind} PRIVATE ${DM_LIBRARY_LINKS})
  # Before 1.0 a minor version may change interfaces.
  set_target_properties(dm_${kind} PROPERTIES LINKER_LANGUAGE CXX OUTPUT_NAME dreampm EXPORT_NAME dreampm
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
endforeach()
if(TARGET dm_shared)
  # Only the project's own names can be seen; those of the libraries within stay inside.
  set(map ${PROJECT_SOURCE_DIR}/cmake/dreampm.map)
  target_link_options(dm_shared PRIVATE -Wl,--version-script=${map} $<$<BOOL:${DM_MOLD}>:-fuse-ld=mold>)
  set_target_properties(dm_shared PROPERTIES LINK_DEPENDS ${map})
endif()
if(TARGET dm_shared AND (BUILD_SHARED_LIBS OR NOT TARGET dm_static))
  add_library(dreampm::dreampm ALIAS dm_shared)
else()
  add_library(dreampm::dreampm ALIAS dm_static)
endif()
