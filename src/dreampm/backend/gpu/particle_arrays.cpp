#include "dreampm/backend/gpu/particle_arrays.h"

#include <stdexcept>
#include <utility>

#include "dreampm/backend/gpu/launch.h"

namespace dreampm::gpu {
namespace {

/// An array that outlives what it was copied from.
class CopiedArray final : public DeviceArray {
 public:
  CopiedArray(std::shared_ptr<Device> device, std::size_t bytes)
      : device_(std::move(device)), data_(bytes > 0 ? device_->allocate(bytes) : nullptr), bytes_(bytes) {}
  CopiedArray(const CopiedArray&) = delete;
  CopiedArray& operator=(const CopiedArray&) = delete;
  ~CopiedArray() override {
    if (data_ != nullptr) device_->release(data_);
  }

  DeviceId device() const override { return device_->id(); }
  const void* data() const override { return data_; }
  std::size_t bytes() const override { return bytes_; }
  void make_wait(std::uintptr_t stream) const override { device_->make_wait(stream); }
  void download(void* to) const override {
    if (bytes_ > 0) device_->download(to, data_, bytes_);
  }
  std::shared_ptr<const DeviceArray> copy() const override {
    auto made = std::make_shared<CopiedArray>(device_, bytes_);
    if (bytes_ > 0) device_->copy(made->data_, data_, bytes_);
    return made;
  }

  template <class T>
  T* as() {
    return static_cast<T*>(data_);
  }

 private:
  std::shared_ptr<Device> device_;
  void* data_;
  std::size_t bytes_;
};

}  // namespace

DeviceParticles ParticleArrays::operator()(const World<float>& world, std::size_t s, const SetMemory& memory,
                                           const Motion<float>* motion, const ParticleFields& fields) {
  const ParticleSet<float>& set = world.sets[s];
  const std::size_t n = set.size();
  if (fields.velocity && n != (motion ? motion->sets.at(s).velocity.size() : memory.velocity().size()))
    throw std::logic_error("there are not as many velocities as particles");
  DeviceParticles made{n, nullptr, nullptr, nullptr};
  CopyParticles kernel{world.scene_position(),
                       nullptr,
                       memory.block_start.data(),
                       {memory.now.u[0].data(), memory.now.u[1].data(), memory.now.u[2].data()},
                       nullptr,
                       memory.id.data(),
                       nullptr,
                       nullptr,
                       nullptr};
  constexpr std::size_t vector = sizeof(Vec3f);
  if (fields.position) {
    const auto array = std::make_shared<CopiedArray>(device_, n * vector);
    made.position = array, kernel.to_position = array->as<float>();
  }
  if (fields.velocity) {
    const auto array = std::make_shared<CopiedArray>(device_, n * vector);
    made.velocity = array;
    if (!motion)
      kernel.velocity = n > 0 ? &memory.velocity().data()->x : nullptr, kernel.to_velocity = array->as<float>();
    else if (n > 0)
      device_->upload(array->as<float>(), motion->sets[s].velocity.data(), n * vector);
  }
  if (fields.id) {
    const auto array = std::make_shared<CopiedArray>(device_, n * sizeof(std::uint32_t));
    made.id = array, kernel.to_id = array->as<std::uint32_t>();
  }
  if (n == 0) return made;
  blocks_.upload(world.particle_blocks);
  kernel.blocks = blocks_.data();
  launch(*device_, kernel, world.particle_blocks.size());
  return made;
}

}  // namespace dreampm::gpu
