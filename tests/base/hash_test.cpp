// The hash names states and scenes across versions and machines: its values are frozen here.
#include "dreampm/base/hash.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

using dreampm::Hash64;

namespace {

std::uint64_t hash_of(const std::string& text) {
  Hash64 h;
  h.bytes(text.data(), text.size());
  return h.value();
}

TEST(Hash, FrozenValues) {
  EXPECT_EQ(Hash64().hex(), "e220a8397b1dcdaf");
  EXPECT_EQ(hash_of("dreampm"), 0x1db11a381670b525ull);
  EXPECT_EQ(hash_of("a text that is longer than one word"), 0x55d303d9106d0286ull);
  Hash64 h;
  h.add(1.5f);
  h.add(std::uint64_t{42});
  h.add(std::string_view("water"));
  const std::vector<double> values{0.0, -0.0, 1e300};
  h.add(std::span<const double>(values));
  EXPECT_EQ(h.hex(), "170face195543425");
}

TEST(Hash, LengthAndOrderCount) {
  std::set<std::uint64_t> seen;
  std::string zeros;
  for (int n = 0; n < 64; ++n, zeros += '\0') seen.insert(hash_of(zeros));
  EXPECT_EQ(seen.size(), 64u) << "runs of zero bytes of different length must differ";

  Hash64 ab, ba;
  ab.add(1), ab.add(2);
  ba.add(2), ba.add(1);
  EXPECT_NE(ab.value(), ba.value());

  // A boundary between two texts is part of the identity.
  Hash64 left, right;
  left.add(std::string_view("ab")), left.add(std::string_view("c"));
  right.add(std::string_view("a")), right.add(std::string_view("bc"));
  EXPECT_NE(left.value(), right.value());
}

TEST(Hash, SignOfZeroCounts) {
  Hash64 plus, minus;
  plus.add(0.0f);
  minus.add(-0.0f);
  EXPECT_NE(plus.value(), minus.value()) << "equal hashes promise equal bits";
}

// One flipped input bit flips each output bit with probability 1/2. Over 4096 trials the share of a
// fair bit lies within 0.5 +- 0.05 (6.4 sigma), so that a weak bit shows and chance does not.
TEST(Hash, Avalanche) {
  constexpr int texts = 256, flips = 16;
  std::vector<int> flipped(64, 0);
  for (int t = 0; t < texts; ++t) {
    std::string text(20, '\0');
    for (std::size_t i = 0; i < text.size(); ++i)
      text[i] = static_cast<char>(dreampm::mix64(static_cast<std::uint64_t>(t) * 20 + i) & 0xff);
    const std::uint64_t before = hash_of(text);
    for (int f = 0; f < flips; ++f) {
      std::string other = text;
      const std::size_t bit = dreampm::mix64(static_cast<std::uint64_t>(t * flips + f)) % (text.size() * 8);
      other[bit / 8] = static_cast<char>(other[bit / 8] ^ (1 << (bit % 8)));
      const std::uint64_t change = before ^ hash_of(other);
      for (std::size_t b = 0; b < 64; ++b) flipped[b] += static_cast<int>(change >> b & 1);
    }
  }
  for (std::size_t b = 0; b < 64; ++b) EXPECT_NEAR(flipped[b] / double(texts * flips), 0.5, 0.05) << "output bit " << b;
}

}  // namespace
