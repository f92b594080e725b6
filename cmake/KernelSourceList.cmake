# All that the kernels of the gpu backends are made of, below ROOT, into `kernel_sources`.
file(GLOB_RECURSE kernel_sources ${list_options} ${ROOT}/include/dreampm/*.h ${ROOT}/src/dreampm/math/*.h
     ${ROOT}/src/dreampm/physics/*.h ${ROOT}/src/dreampm/state/*.h ${ROOT}/src/dreampm/backend/gpu/*.h
     ${ROOT}/src/dreampm/backend/gpu/*.cu)
file(GLOB shared ${list_options} ${ROOT}/src/dreampm/backend/*.h)
list(APPEND kernel_sources ${shared})
list(SORT kernel_sources)
