// What matter sends out between two frames.
#pragma once
#include "dreampm/foam/motion.h"

namespace dreampm::foam {

struct Born {
  std::vector<One> all;  ///< at the later frame
  FoamCounts counts;
};

/// `earlier`: for each particle of `to` its place at the earlier frame, or itself where there was
/// none; `known` says which. `room`: how many may be added.
Born births(const FoamMatter& from, const FoamMatter& to, std::span<const std::int32_t> earlier, const Between& between,
            int frame, std::uint32_t next_id, std::size_t room);

}  // namespace dreampm::foam
