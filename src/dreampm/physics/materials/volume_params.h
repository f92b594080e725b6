// Parameters that all laws with a relaxed volume share.
#pragma once
#include "dreampm/physics/param.h"

namespace dreampm {

inline constexpr Param bulk_modulus_param{"bulk_modulus",
                                          "Pa",
                                          derived,
                                          1,
                                          1e11,
                                          true,
                                          "stiffness against compression; derived from max_compression if absent",
                                          {},
                                          false,
                                          "max_compression"};
inline constexpr Param max_compression_param = Param{"max_compression",
                                                     "1",
                                                     0.01,
                                                     1e-4,
                                                     0.2,
                                                     true,
                                                     "largest wanted relative change of volume; gives the bulk modulus"}
                                                   .shown({.basic = true});
inline constexpr Param relaxation_param{
    "relaxation", "1", 1, 0, 10, false, "strength of relaxing J to the measured density; 0 turns it off"};

}  // namespace dreampm
