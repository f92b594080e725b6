#include "dreampm/gl/particle_store.h"

#include <cmath>
#include <limits>

#include "dreampm/base/error.h"
#include "dreampm/gl/color_scale.h"

namespace dreampm::gl {

namespace {

constexpr std::size_t most_in_shadow_map = 20000;  // a software driver takes 10 ms for 65,000

void check(const ParticleBatch& b, std::size_t index) {
  const std::size_t n = b.position.size();
  if (n > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    fail_input("picture: batch {} has {} particles, more than one batch can hold", index, n);
  if (!b.value.empty() && b.value.size() != n)
    fail_input("picture: batch {} has {} particles but {} values: give one each, or none", index, n, b.value.size());
  if (!b.color.empty() && b.color.size() != n)
    fail_input("picture: batch {} has {} particles but {} colors: give one each, or none", index, n, b.color.size());
  if (!(b.radius > 0) || !std::isfinite(b.radius))
    fail_input("picture: batch {} has particles of radius {} m; it has to be above 0", index, b.radius);
  if (!(b.opacity >= 0 && b.opacity <= 1))
    fail_input("picture: batch {} has opacity {}; it has to be from 0 to 1", index, b.opacity);
  if (!(b.spacing >= 0) || !std::isfinite(b.spacing))
    fail_input("picture: batch {} has particles {} m apart; it has to be 0 or more", index, b.spacing);
}

Box3f bounds_of(std::span<const Vec3f> points) {
  Box3f box;
  for (const Vec3f& p : points)
    if (is_finite(p)) box.add(p);
  return box;
}

}  // namespace

std::span<BatchOnDevice> ParticleStore::upload(std::span<const ParticleBatch> batches) {
  if (slots_.size() < batches.size()) slots_.resize(batches.size());
  batches_.clear();
  for (std::size_t k = 0; k < batches.size(); ++k) {
    const ParticleBatch& b = batches[k];
    check(b, k);
    Slot& slot = slots_[k];
    const std::size_t every = 1 + b.position.size() / most_in_shadow_map;
    if (!b.position.empty()) {
      slot.position.fill(b.position.data(), b.position.size_bytes());
      slot.vertices.floats(0, slot.position, 3);
      slot.thinned.floats(0, slot.position, 3, static_cast<int>(every));
      if (!b.color.empty()) {
        slot.color.fill(b.color.data(), b.color.size_bytes());
        slot.vertices.bytes(2, slot.color);
      } else {
        slot.vertices.none(2);
      }
      if (!b.value.empty()) {
        slot.value.fill(b.value.data(), b.value.size_bytes());
        slot.vertices.floats(1, slot.value, 1);
      } else {
        slot.vertices.none(1);
      }
    }
    batches_.push_back({&b, &slot.vertices, static_cast<int>(b.position.size()), 0, bounds_of(b.position),
                        &slot.thinned, static_cast<int>(b.position.size() / every),
                        std::cbrt(static_cast<float>(every)), Stage::solid});
  }
  return batches_;
}

void ParticleStore::order(const Camera& camera, std::size_t batch) {
  BatchOnDevice& b = batches_[batch];
  const std::span<const std::uint32_t> indices = order_.front_to_back(b.batch->position, camera);
  b.ordered_count = static_cast<int>(indices.size());
  if (indices.empty()) return;
  Slot& slot = slots_[batch];
  slot.order.fill(indices.data(), indices.size_bytes());
  slot.vertices.indices(slot.order);
}

void set_particle_uniforms(const Program& program, const ParticleBatch& batch, float radius_scale) {
  program.set("radius", batch.radius * radius_scale);
  program.set("base_color", batch.base_color);
  program.set("opacity", batch.opacity);
  const bool color = !batch.color.empty(), value = !batch.value.empty() && !color;
  program.set("color_source", Vec3f{!color && !value ? 1.0f : 0.0f, value ? 1.0f : 0.0f, color ? 1.0f : 0.0f});
  const float range = batch.value_max - batch.value_min;
  program.set("value_range", batch.value_min, range != 0 ? 1 / range : 0.0f);
  program.set_array("scale_terms", color_scale_coefficients.data(), static_cast<int>(color_scale_coefficients.size()));
}

}  // namespace dreampm::gl
