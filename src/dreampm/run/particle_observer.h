// Writes a file of particles a frame while an engine steps.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "dreampm/io/ply.h"
#include "dreampm/run/engine.h"
#include "dreampm/setup/assemble.h"

namespace dreampm {

/// The content of files of particles.
struct ParticleContent {
  std::vector<std::string> attributes;  ///< of model::particle_attributes
  Vec3d shift{};                        ///< m, where places count from
};

template <class R>
class ParticleObserver final : public Observer {
 public:
  /// particles_NNNNNN.ply in `folder`, which is there. `bodies` are read in each frame.
  ParticleObserver(Engine<R>& engine, const std::vector<BodyRange>& bodies, ParticleContent content,
                   std::filesystem::path folder)
      : engine_(engine), bodies_(bodies), content_(std::move(content)), folder_(std::move(folder)) {}
  const ParticleContent& content() const { return content_; }
  /// Calls `use` with each frame that was written.
  void use_frames(std::function<void(const ParticleFrame&)> use) { uses_.push_back(std::move(use)); }

  void on_frame() override;

 private:
  Engine<R>& engine_;
  const std::vector<BodyRange>& bodies_;
  ParticleContent content_;
  std::filesystem::path folder_;
  std::vector<std::function<void(const ParticleFrame&)>> uses_;
};

}  // namespace dreampm
