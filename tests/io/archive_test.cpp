#include "dreampm/io/archive.h"

#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "files.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;
using test::message_of;
using testing::AllOf;
using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;

const ArchiveIdentity identity{"dreampm-checkpoint", 3, "00ff00ff00ff00ff"};

ArchiveReader open(const fs::path& file) { return ArchiveReader(file, identity.format, identity.version); }
void try_open(const fs::path& file) { ArchiveReader reader(file, identity.format, identity.version); }

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void write_sample(const fs::path& file) {
  std::vector<float> x(1000);
  std::iota(x.begin(), x.end(), 0.5f);
  write_archive(file, identity, [&](ArchiveWriter& out) {
    out.add("water/x", x);
    out.add("dt_next", 0.1);
    out.add("scene", "name: jelly\n");
  });
}

TEST(Archive, EveryBitComesBack) {
  const fs::path file = test::fresh_folder() / "a.h5";
  const std::vector<float> f = {0.0f,
                                -0.0f,
                                1e-45f,
                                std::numeric_limits<float>::infinity(),
                                std::bit_cast<float>(0x7fc12345u),
                                std::bit_cast<float>(0x7f812345u),
                                std::bit_cast<float>(0xffffffffu),
                                0.1f};
  const std::vector<double> d = {-0.0, 5e-324, std::bit_cast<double>(0x7ff0dead0000beefull), 1.0 / 3};
  const std::vector<std::int32_t> i = {INT32_MIN, -1, 0, INT32_MAX};
  const std::vector<std::uint32_t> u = {0, UINT32_MAX};
  const std::vector<std::uint64_t> l = {0, UINT64_MAX, 1ull << 53 | 1};
  const std::vector<std::int64_t> s = {INT64_MIN, INT64_MAX};
  const std::vector<std::uint8_t> b = {0, 1, 255};
  write_archive(file, identity, [&](ArchiveWriter& out) {
    out.add("f", f);
    out.add("d", d);
    out.add("deep/er/i", i);
    out.add("deep/u", u);
    out.add("l", l);
    out.add("s", s);
    out.add("b", b);
    out.add("empty", std::vector<float>{});
    out.add("one", std::uint64_t(7));
    out.add("text", "materials:\n  - w\xc3\xa4sser\n");
    out.add("no text", "");
  });
  const ArchiveReader in = open(file);
  EXPECT_TRUE(same_bits(in.read<float>("f"), f));
  EXPECT_TRUE(same_bits(in.read<double>("d"), d));
  EXPECT_EQ(in.read<std::int32_t>("deep/er/i"), i);
  EXPECT_EQ(in.read<std::uint32_t>("deep/u"), u);
  EXPECT_EQ(in.read<std::uint64_t>("l"), l);
  EXPECT_EQ(in.read<std::int64_t>("s"), s);
  EXPECT_EQ(in.read<std::uint8_t>("b", 3), b);
  EXPECT_TRUE(in.read<float>("empty").empty());
  EXPECT_EQ(in.value<std::uint64_t>("one"), 7u);
  EXPECT_EQ(in.text("text"), "materials:\n  - w\xc3\xa4sser\n");
  EXPECT_EQ(in.text("no text"), "");
  EXPECT_EQ(in.scene_hash(), identity.scene_hash);
  EXPECT_NO_THROW(in.expect_scene("00ff00ff00ff00ff"));
  EXPECT_THAT(in.keys(),
              ElementsAre("b", "d", "deep/er/i", "deep/u", "empty", "f", "l", "no text", "one", "s", "text"));
  EXPECT_TRUE(in.has("deep/u"));
  EXPECT_FALSE(in.has("deep/x"));
  EXPECT_FALSE(in.has("none/at/all"));
}

TEST(Archive, EqualContentsGiveEqualFiles) {
  const fs::path folder = test::fresh_folder();
  write_sample(folder / "a.h5");
  write_sample(folder / "b.h5");
  EXPECT_EQ(read_file(folder / "a.h5"), read_file(folder / "b.h5"));
}

TEST(Archive, WrongQuestionsAreRefused) {
  const fs::path file = test::fresh_folder() / "a.h5";
  write_sample(file);
  const ArchiveReader in = open(file);
  EXPECT_THAT(message_of<InputError>([&] { (void)in.read<float>("water/y"); }), HasSubstr("water/y is missing"));
  EXPECT_THAT(message_of<InputError>([&] { (void)in.read<float>("wine/x"); }), HasSubstr("wine/x is missing"));
  EXPECT_THAT(message_of<InputError>([&] { (void)in.read<double>("water/x"); }), HasSubstr("not an array of double"));
  EXPECT_THAT(message_of<InputError>([&] { (void)in.read<float>("scene"); }), HasSubstr("not an array of float"));
  EXPECT_THAT(message_of<InputError>([&] { (void)in.text("dt_next"); }), HasSubstr("dt_next is not a text"));
  EXPECT_THAT(message_of<InputError>([&] { (void)in.read<float>("water/x", 999); }),
              HasSubstr("1000 values, 999 are wanted"));
  EXPECT_THAT(message_of<InputError>([&] { in.expect_scene("1234"); }),
              AllOf(HasSubstr("a.h5"), HasSubstr("another scene"), HasSubstr("1234")));
}

TEST(Archive, ForeignFilesAreNamed) {
  const fs::path folder = test::fresh_folder();
  EXPECT_THAT(message_of<InputError>([&] { try_open(folder / "none.h5"); }), HasSubstr("none.h5: no such file"));
  EXPECT_THAT(message_of<InputError>([&] { try_open(folder); }), HasSubstr("is a folder"));
  replace_file_text(folder / "empty.h5", "");
  EXPECT_THAT(message_of<InputError>([&] { try_open(folder / "empty.h5"); }), HasSubstr("empty"));
  replace_file_text(folder / "garbage.h5", std::string(5000, 'x'));
  EXPECT_THAT(message_of<InputError>([&] { try_open(folder / "garbage.h5"); }), HasSubstr("not a dreampm archive"));
  write_archive(folder / "other.h5", {"someone-else", 3, ""}, [](ArchiveWriter&) {});
  EXPECT_THAT(message_of<InputError>([&] { try_open(folder / "other.h5"); }),
              HasSubstr("holds \"someone-else\", \"dreampm-checkpoint\" is wanted"));
  write_archive(folder / "new.h5", {identity.format, 4, ""}, [](ArchiveWriter&) {});
  EXPECT_THAT(message_of<InputError>([&] { try_open(folder / "new.h5"); }),
              HasSubstr("version 4; this dreampm reads version 3"));
}

// True if opening fails with an InputError that names the file.
bool fails_clearly(const fs::path& file) {
  try {
    const ArchiveReader in = open(file);
    return false;
  } catch (const InputError& e) {
    return std::string(e.what()).find(file.string()) != std::string::npos;
  }
}

TEST(Archive, EveryTruncationIsFound) {
  const fs::path folder = test::fresh_folder();
  write_sample(folder / "a.h5");
  const std::string whole = read_file(folder / "a.h5");
  for (std::size_t size = 0; size < whole.size(); size += 1 + size / 16) {
    replace_file_text(folder / "cut.h5", whole.substr(0, size));
    EXPECT_TRUE(fails_clearly(folder / "cut.h5")) << size << " of " << whole.size();
  }
  replace_file_text(folder / "cut.h5", whole.substr(0, whole.size() - 1));
  EXPECT_TRUE(fails_clearly(folder / "cut.h5"));
}

TEST(Archive, AFlippedBitAnywhereIsFound) {
  const fs::path folder = test::fresh_folder();
  write_sample(folder / "a.h5");
  const std::string whole = read_file(folder / "a.h5");
  std::uint32_t seed = 7;
  for (int k = 0; k < 300; ++k) {
    seed = seed * 1664525u + 1013904223u;
    std::string bad = whole;
    const std::size_t at = (seed >> 8) % bad.size();
    bad[at] = static_cast<char>(bad[at] ^ (1 << (seed & 7)));
    replace_file_text(folder / "bad.h5", bad);
    EXPECT_TRUE(fails_clearly(folder / "bad.h5")) << "byte " << at;
  }
  const float needle[] = {500.5f, 501.5f};
  const std::size_t at = whole.find(std::string(reinterpret_cast<const char*>(needle), sizeof needle));
  ASSERT_NE(at, std::string::npos);
  std::string bad = whole;
  bad[at + 2] = static_cast<char>(bad[at + 2] ^ 4);
  replace_file_text(folder / "bad.h5", bad);
  EXPECT_THAT(message_of<InputError>([&] { try_open(folder / "bad.h5"); }),
              AllOf(HasSubstr("bad.h5: damaged"), HasSubstr("checksum")));
  // A file as another program may have written it: HDF5 without the seal.
  replace_file_text(folder / "bare.h5", whole.substr(0, whole.size() - 24));
  EXPECT_THAT(message_of<InputError>([&] { try_open(folder / "bare.h5"); }), HasSubstr("no dreampm archive"));
}

TEST(Archive, AFullDiskIsAnErrorWithItsReasonAndLeavesNothing) {
  const fs::path folder = test::fresh_folder();
  const std::vector<float> big(1 << 18, 1.0f);
  const std::size_t before = test::open_descriptors();
  for (const rlim_t limit : {0, 100, 1500, 4096, 100000, 1000000, 1048576, 1049000}) {
    const test::FileSizeLimit small(limit);
    EXPECT_THAT(message_of<RunError>([&] {
                  write_archive(folder / "a.h5", identity, [&](ArchiveWriter& out) {
                    out.add("first", std::vector<double>(10, 2.0));
                    out.add("big", big);
                  });
                }),
                AllOf(HasSubstr("a.h5"), HasSubstr("cannot be written: File too large")))
        << limit;
    EXPECT_EQ(test::files_in(folder), 0u) << limit;
  }
  EXPECT_EQ(test::open_descriptors(), before);
  // The library still works.
  write_sample(folder / "a.h5");
  EXPECT_EQ(open(folder / "a.h5").value<double>("dt_next"), 0.1);
}

TEST(Archive, AFailedWriteLeavesTheOldFile) {
  const fs::path folder = test::fresh_folder();
  write_sample(folder / "a.h5");
  const std::string before = read_file(folder / "a.h5");
  EXPECT_THAT(message_of<InputError>([&] {
                write_archive(folder / "a.h5", identity, [&](ArchiveWriter& out) {
                  out.add("x", 1.0f);
                  out.add("x", 2.0f);
                });
              }),
              HasSubstr("x is added twice"));
  EXPECT_EQ(read_file(folder / "a.h5"), before);
  EXPECT_EQ(test::files_in(folder), 1u);
  EXPECT_THAT(message_of<RunError>([&] { write_sample(folder / "none" / "a.h5"); }),
              AllOf(HasSubstr("cannot be written"), HasSubstr("No such file")));
}

TEST(Archive, AHundredMegabytesAreQuick) {
  const fs::path file = test::fresh_folder() / "a.h5";
  const std::vector<float> column(5'000'000, 0.25f);
  const auto start = std::chrono::steady_clock::now();
  write_archive(file, identity, [&](ArchiveWriter& out) {
    for (int i = 0; i < 5; ++i) out.add(fmt::format("c{}", i), column);
  });
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  RecordProperty("seconds", fmt::format("{:.3f}", seconds));
  EXPECT_LT(seconds, 10);  // 0.2 s on a quiet disk; a shared machine may be slow
  EXPECT_EQ(open(file).read<float>("c4").size(), column.size());
  fs::remove(file);
}

}  // namespace
}  // namespace dreampm
