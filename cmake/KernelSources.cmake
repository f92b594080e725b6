# Writes a header with a hash of all that the kernels of the gpu backends are made of, by which a library of kernels and the
# program that loads it know that they fit.
#   cmake -DROOT=FOLDER -DOUT=FILE -P cmake/KernelSources.cmake
cmake_minimum_required(VERSION 3.20)
file(GLOB_RECURSE sources RELATIVE ${ROOT} ${ROOT}/include/dreampm/*.h ${ROOT}/src/dreampm/math/*.h
     ${ROOT}/src/dreampm/physics/*.h ${ROOT}/src/dreampm/state/*.h ${ROOT}/src/dreampm/backend/*.h
     ${ROOT}/src/dreampm/backend/*.cu)
list(SORT sources)
set(all "")
foreach(source ${sources})
  file(SHA256 ${ROOT}/${source} hash)
  string(APPEND all "${source} ${hash}\n")
endforeach()
string(SHA256 hash "${all}")
string(SUBSTRING ${hash} 0 16 hash)
configure_file(${ROOT}/src/dreampm/backend/gpu/cuda/kernel_sources.h.in ${OUT} @ONLY)
