#include "dreampm/io/archive_seal.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/base/hash.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

struct Seal {
  char mark[8] = {'d', 'm', 's', 'e', 'a', 'l', '0', '1'};
  std::uint64_t bytes = 0;
  std::uint64_t hash = 0;
};
static_assert(sizeof(Seal) == 24);

// The hash of the first `bytes` of a stream; false if there are fewer.
bool hash_of(std::ifstream& in, std::uint64_t bytes, std::uint64_t& hash) {
  Hash64 sum;
  std::vector<char> piece(static_cast<std::size_t>(std::min<std::uint64_t>(bytes, 4u << 20)));
  for (std::uint64_t left = bytes; left > 0;) {
    const std::uint64_t n = std::min<std::uint64_t>(left, piece.size());
    if (!in.read(piece.data(), static_cast<std::streamsize>(n))) return false;
    sum.bytes(piece.data(), static_cast<std::size_t>(n));
    left -= n;
  }
  hash = sum.value();
  return true;
}

}  // namespace

void seal_archive(const fs::path& path, const std::string& target) {
  Seal seal;
  std::error_code ec;
  seal.bytes = fs::file_size(path, ec);
  std::ifstream in(path, std::ios::binary);
  if (ec || !in || !hash_of(in, seal.bytes, seal.hash)) fail_run("{}: cannot be written: not readable again", target);
  const int out = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (out < 0) fail_run("{}: cannot be written: {}", target, system_reason());
  const ssize_t n = ::write(out, &seal, sizeof seal);
  std::string reason = n < 0 ? system_reason() : n < ssize_t(sizeof seal) ? "File too large, or no space left" : "";
  if (::close(out) != 0 && reason.empty()) reason = system_reason();
  if (!reason.empty()) fail_run("{}: cannot be written: {}", target, reason);
}

void check_archive_seal(const fs::path& path) {
  const std::string name = path.string();
  std::error_code ec;
  if (!fs::exists(path, ec)) fail_input("{}: no such file", name);
  if (fs::is_directory(path, ec)) fail_input("{}: is a folder, a file is wanted", name);
  const std::uint64_t bytes = fs::file_size(path, ec);
  if (ec) fail_input("{}: cannot be read: {}", name, ec.message());
  if (bytes == 0) fail_input("{}: the file is empty", name);
  std::ifstream in(path, std::ios::binary);
  if (!in) fail_input("{}: cannot be read: {}", name, system_reason());

  constexpr char hdf5[8] = {'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  char first[8] = {};
  if (bytes < sizeof first || !in.read(first, sizeof first) || std::memcmp(first, hdf5, sizeof first) != 0)
    fail_input("{}: not a dreampm archive (no HDF5 file)", name);
  const Seal wanted;
  Seal seal;
  if (bytes > sizeof seal) {
    in.seekg(static_cast<std::streamoff>(bytes - sizeof seal));
    in.read(reinterpret_cast<char*>(&seal), sizeof seal);
  }
  if (bytes <= sizeof seal || !in || std::memcmp(seal.mark, wanted.mark, sizeof seal.mark) != 0 ||
      seal.bytes != bytes - sizeof seal)
    fail_input("{}: truncated, or an HDF5 file that is no dreampm archive: its last bytes are not the seal", name);
  in.seekg(0);
  std::uint64_t hash = 0;
  if (!hash_of(in, seal.bytes, hash)) fail_input("{}: cannot be read to its end", name);
  if (hash != seal.hash) fail_input("{}: damaged: its bytes do not match their checksum", name);
}

}  // namespace dreampm
