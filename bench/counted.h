// A lane type that counts: the formulas of physics/ run over it show how many operations they take,
// so that no count is kept beside them by hand. Numbers that are the same for all particles belong
// to no tally: what is computed from them alone, and what they leave out by being exactly zero, a
// traversal does once or not at all, and is not counted.
#pragma once
#include <cstdint>

#include "dreampm/math/scalar.h"

namespace dreampm {

/// Floating-point operations of one lane.
struct OperationCount {
  std::uint64_t multiply_adds = 0, multiplications = 0, additions = 0, divisions = 0, roots = 0;
  std::uint64_t comparisons = 0;  ///< also minima, maxima, choices and conversions

  /// Instructions that the units for multiply-adds have to take, each at least one slot. A division
  /// or root takes several, so this is a floor. `fused`: a multiply-add is one instruction, else
  /// two.
  std::uint64_t slots(bool fused) const {
    return (fused ? 1 : 2) * multiply_adds + multiplications + additions + divisions + roots;
  }
};

struct Counted {
  float v = 0;
  OperationCount* tally = nullptr;  ///< null: the same for all particles

  Counted() = default;
  explicit Counted(float value, OperationCount* counts = nullptr) : v(value), tally(counts) {}
  explicit Counted(int value) : v(static_cast<float>(value)) {}
  explicit Counted(double value) : v(static_cast<float>(value)) {}

  bool absent() const { return !tally && v == 0; }
  static OperationCount* tally_of(const Counted& a, const Counted& b) { return a.tally ? a.tally : b.tally; }
  static Counted counted(float value, OperationCount* tally, std::uint64_t OperationCount::* kind) {
    if (tally) ++(tally->*kind);
    return Counted(value, tally);
  }

  friend Counted operator+(const Counted& a, const Counted& b) {
    if (a.absent() || b.absent()) return a.absent() ? b : a;
    return counted(a.v + b.v, tally_of(a, b), &OperationCount::additions);
  }
  friend Counted operator-(const Counted& a, const Counted& b) {
    if (b.absent()) return a;
    return a.absent() ? -b : counted(a.v - b.v, tally_of(a, b), &OperationCount::additions);
  }
  friend Counted operator*(const Counted& a, const Counted& b) {
    if (a.absent() || b.absent()) return Counted();
    return counted(a.v * b.v, tally_of(a, b), &OperationCount::multiplications);
  }
  friend Counted operator/(const Counted& a, const Counted& b) {
    if (a.absent()) return Counted();
    // Division by what is the same for all is a multiplication by its inverse.
    return counted(a.v / b.v, tally_of(a, b), b.tally ? &OperationCount::divisions : &OperationCount::multiplications);
  }
  friend Counted operator-(const Counted& a) { return Counted(-a.v, a.tally); }
  Counted& operator+=(const Counted& b) { return *this = *this + b; }
  Counted& operator-=(const Counted& b) { return *this = *this - b; }
  Counted& operator*=(const Counted& b) { return *this = *this * b; }

  static bool compared(const Counted& a, const Counted& b, bool result) {
    if (OperationCount* t = tally_of(a, b)) ++t->comparisons;
    return result;
  }
  friend bool operator<(const Counted& a, const Counted& b) { return compared(a, b, a.v < b.v); }
  friend bool operator>(const Counted& a, const Counted& b) { return compared(a, b, a.v > b.v); }
  friend bool operator<=(const Counted& a, const Counted& b) { return compared(a, b, a.v <= b.v); }
  friend bool operator>=(const Counted& a, const Counted& b) { return compared(a, b, a.v >= b.v); }
};

inline Counted select(bool m, const Counted& a, const Counted& b) {
  OperationCount* const tally = Counted::tally_of(a, b);
  if (tally) ++tally->comparisons;
  return Counted(m ? a.v : b.v, tally);
}
inline Counted mul_add(const Counted& a, const Counted& b, const Counted& c) {
  if (c.absent()) return a * b;
  if (a.absent() || b.absent()) return c;
  OperationCount* const tally = Counted::tally_of(a, b);
  // A product of what is the same for all is such a number itself.
  if (!tally) return Counted(a.v * b.v) + c;
  return Counted::counted(a.v * b.v + c.v, tally, &OperationCount::multiply_adds);
}
inline Counted mul_sub(const Counted& a, const Counted& b, const Counted& c) { return mul_add(a, b, -c); }
inline Counted min(const Counted& a, const Counted& b) {
  return Counted::counted(a.v < b.v ? a.v : b.v, Counted::tally_of(a, b), &OperationCount::comparisons);
}
inline Counted max(const Counted& a, const Counted& b) {
  return Counted::counted(a.v > b.v ? a.v : b.v, Counted::tally_of(a, b), &OperationCount::comparisons);
}
inline Counted abs(const Counted& a) { return Counted::counted(abs(a.v), a.tally, &OperationCount::comparisons); }
inline Counted sqrt(const Counted& a) { return Counted::counted(sqrt(a.v), a.tally, &OperationCount::roots); }
inline Counted round_int(const Counted& a) {
  return Counted::counted(round_int(a.v), a.tally, &OperationCount::comparisons);
}
inline Counted exp2_int(const Counted& a) {
  return Counted::counted(exp2_int(a.v), a.tally, &OperationCount::comparisons);
}
inline Counted exponent_of(const Counted& a) {
  return Counted::counted(exponent_of(a.v), a.tally, &OperationCount::comparisons);
}

template <>
struct LaneTraits<Counted> {
  using Scalar = float;
  using Mask = bool;
  static constexpr int lanes = 1;
};

}  // namespace dreampm
