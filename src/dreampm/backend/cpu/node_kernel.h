// The border between the cpu backend and the loops over nodes that each instruction set has (backend/node_loops.h).
#pragma once
#include "dreampm/backend/node_loops.h"

namespace dreampm {

namespace sse4 {
NodeLoops<float> node_loops();
}
namespace avx2 {
NodeLoops<float> node_loops();
}
namespace avx512 {
NodeLoops<float> node_loops();
}
namespace neon {
NodeLoops<float> node_loops();
}

}  // namespace dreampm
