// The cost of a particle-step of the projection.
#pragma once
#include <memory>
#include <string_view>

#include "bench/course.h"
#include "dreampm/backend/cpu/cpu.h"

namespace dreampm {

/// Water that is measured: at rest in a tank, or the column of column_scene in mid-splash.
enum class Waters { calm, splash };

/// A world that the projection has moved far enough.
class LargeSteps {
 public:
  /// Steps with all threads that may be used until the waters are as said. `isa`: as for
  /// make_cpu_backend().
  LargeSteps(Waters waters, const Vec3i& cells, std::string_view isa);

  const World<float>& world() const { return *start_; }
  /// Windows of the same steps, again and again, nanoseconds per particle-step.
  Timing run(const Pace& pace) const;

 private:
  std::unique_ptr<Backend<float>> backend_;
  std::unique_ptr<const World<float>> start_;
};

}  // namespace dreampm
