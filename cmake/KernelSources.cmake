# Writes a header with a hash of all that the kernels of the gpu backends are made of, by which a library of kernels and the
# program that loads it know that they fit.
#   cmake -DROOT=FOLDER -DOUT=FILE -P cmake/KernelSources.cmake
cmake_minimum_required(VERSION 3.20)
set(list_options RELATIVE ${ROOT})
include(${CMAKE_CURRENT_LIST_DIR}/KernelSourceList.cmake)
set(all "")
foreach(source ${kernel_sources})
  file(SHA256 ${ROOT}/${source} hash)
  string(APPEND all "${source} ${hash}\n")
endforeach()
string(SHA256 hash "${all}")
string(SUBSTRING ${hash} 0 16 hash)
configure_file(${ROOT}/src/dreampm/backend/gpu/cuda/kernel_sources.h.in ${OUT} @ONLY)
