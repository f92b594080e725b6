#include "dreampm/import/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/import/text_lines.h"

namespace dreampm {

bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

std::filesystem::path unpacked_name(std::filesystem::path path) {
  if (lower(path.extension().string()) == ".gz") path.replace_extension();
  return path;
}

std::string unpack_gzip(std::string_view bytes, const std::string& name) {
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) fail_run("{}: zlib does not start", name);
  const std::unique_ptr<z_stream, int (*)(z_stream*)> closer(&stream, inflateEnd);
  constexpr std::size_t most = std::size_t(8) << 30, chunk = std::numeric_limits<uInt>::max() / 2;
  std::string out;
  std::size_t taken = 0, made = 0;
  for (;;) {
    if (made == out.size()) out.resize(std::max<std::size_t>(std::max(bytes.size() * 3, out.size() * 2), 4096));
    if (out.size() > 2 * most) fail_input("{}: holds more than 8 GiB unpacked", name);
    const std::size_t in = std::min(bytes.size() - taken, chunk), room = std::min(out.size() - made, chunk);
    // zlib only reads what next_in points to; its type lacks the const
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + taken));
    stream.avail_in = static_cast<uInt>(in);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + made);
    stream.avail_out = static_cast<uInt>(room);
    const int rc = inflate(&stream, Z_NO_FLUSH);
    taken += in - stream.avail_in, made += room - stream.avail_out;
    if (rc == Z_STREAM_END) {
      if (!is_gzip(bytes.substr(taken))) break;
      inflateReset(&stream);  // another member follows
    } else if (rc == Z_BUF_ERROR || (rc == Z_OK && taken == bytes.size() && stream.avail_out > 0)) {
      fail_input("{}: is cut short: the gzip data ends too early", name);
    } else if (rc != Z_OK) {
      fail_input("{}: its gzip data is damaged ({})", name, stream.msg ? stream.msg : "zlib gives no reason");
    }
  }
  out.resize(made);
  return out;
}

std::string read_unpacked(const std::filesystem::path& path) {
  std::string bytes = read_file(path);
  return is_gzip(bytes) ? unpack_gzip(bytes, path.string()) : bytes;
}

}  // namespace dreampm
