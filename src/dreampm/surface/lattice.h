// Integer lattice coordinates as keys: a hash map whose content does not depend on threads.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dreampm/base/hash.h"
#include "dreampm/math/vec.h"

namespace dreampm::surface {

/// Vec3i -> a number >= 0, by open addressing. Coordinates within +-2^20.
class LatticeMap {
 public:
  static constexpr std::int32_t kAbsent = -1;

  explicit LatticeMap(std::size_t expected = 0) { reserve(expected); }

  /// The number of `at`, or kAbsent.
  std::int32_t find(const Vec3i& at) const { return slots_[slot(key(at))].value; }

  /// Gives `at` the number `value` if it has none; the number it then has.
  std::int32_t insert(const Vec3i& at, std::int32_t value) {
    if (2 * (used_ + 1) > slots_.size()) grow();
    Slot& s = slots_[slot(key(at))];
    if (s.value == kAbsent) s = {key(at), value}, ++used_;
    return s.value;
  }
  void set(const Vec3i& at, std::int32_t value) { slots_[slot(key(at))].value = value; }
  std::size_t size() const { return used_; }

  static std::uint64_t key(const Vec3i& at) {
    const auto part = [](std::int32_t v) { return static_cast<std::uint64_t>(v + (1 << 20)) & 0x1fffff; };
    return part(at.z) << 42 | part(at.y) << 21 | part(at.x);
  }
  static Vec3i place(std::uint64_t key) {
    const auto part = [](std::uint64_t v) { return static_cast<std::int32_t>(v & 0x1fffff) - (1 << 20); };
    return {part(key), part(key >> 21), part(key >> 42)};
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::int32_t value = kAbsent;
  };
  void reserve(std::size_t expected) {
    std::size_t n = 16;
    while (n < 2 * (expected + 1)) n *= 2;
    slots_.assign(n, Slot{});
  }
  void grow() {
    std::vector<Slot> old;
    old.swap(slots_);
    slots_.assign(old.size() * 2, Slot{});
    for (const Slot& s : old)
      if (s.value != kAbsent) slots_[slot(s.key)] = s;
  }
  std::size_t slot(std::uint64_t k) const {
    std::size_t i = mix64(k) & (slots_.size() - 1);
    while (slots_[i].value != kAbsent && slots_[i].key != k) i = (i + 1) & (slots_.size() - 1);
    return i;
  }
  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};

/// The lattice cell of size `size` that holds p.
inline Vec3i lattice_cell(const Vec3f& p, float size) {
  const auto part = [&](float v) { return static_cast<std::int32_t>(std::floor(v / size)); };
  return {part(p.x), part(p.y), part(p.z)};
}

}  // namespace dreampm::surface
