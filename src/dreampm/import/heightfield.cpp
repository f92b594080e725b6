#include "dreampm/import/heightfield.h"

#include <png.h>

#include <csetjmp>
#include <cstring>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

/// 16 bits a pixel, row after row.
struct GrayPicture {
  std::size_t width = 0, height = 0;
  std::vector<std::uint16_t> pixels;
};

/// The input of libpng, and its message.
struct Decoding {
  const std::string& bytes;
  std::size_t at = 0;
  std::string message{};
  std::vector<std::uint8_t> row{};
};

void read_bytes(png_structp png, png_bytep to, png_size_t count) {
  auto& from = *static_cast<Decoding*>(png_get_io_ptr(png));
  if (from.bytes.size() - from.at < count) png_error(png, "it is cut short");
  std::memcpy(to, from.bytes.data() + from.at, count);
  from.at += count;
}

[[noreturn]] void keep_message(png_structp png, png_const_charp message) {
  static_cast<Decoding*>(png_get_error_ptr(png))->message = message;
  png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

/// True if it could be read; else the fault is in `from`. libpng reports errors by longjmp: no
/// object with a destructor is made here.
bool decode(Decoding& from, GrayPicture& out) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &from, keep_message, ignore);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info) {
    png_destroy_read_struct(&png, nullptr, nullptr);
    from.message = "no memory";
    return false;
  }
  if (setjmp(png_jmpbuf(png))) {
    png_destroy_read_struct(&png, &info, nullptr);
    return false;
  }
  png_set_read_fn(png, &from, read_bytes);
  png_read_info(png, info);
  out.width = png_get_image_width(png, info), out.height = png_get_image_height(png, info);
  if (out.width < 2 || out.height < 2 || out.width > widest_heightfield || out.height > widest_heightfield)
    png_error(png, "its size");
  png_set_expand_16(png);
  png_set_strip_alpha(png);
  if (png_get_interlace_type(png, info) != PNG_INTERLACE_NONE) png_error(png, "it is interlaced, save it without");
  png_read_update_info(png, info);
  const std::size_t channels = png_get_channels(png, info);
  from.row.resize(png_get_rowbytes(png, info));
  out.pixels.resize(out.width * out.height);
  for (std::size_t y = 0; y < out.height; ++y) {
    png_read_row(png, from.row.data(), nullptr);
    for (std::size_t x = 0; x < out.width; ++x) {
      unsigned sum = 0;
      for (std::size_t c = 0; c < channels; ++c) {
        const std::uint8_t* const high = from.row.data() + 2 * (x * channels + c);
        sum += 256u * high[0] + high[1];
      }
      out.pixels[y * out.width + x] = static_cast<std::uint16_t>(sum / channels);
    }
  }
  png_destroy_read_struct(&png, &info, nullptr);
  return true;
}

GrayPicture read_gray(const fs::path& file) {
  const std::string bytes = read_file(file);
  if (bytes.empty()) fail_input("{}: the file is empty", file.string());
  if (bytes.size() < 8 || png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, 8) != 0)
    fail_input("{}: a height field must be a PNG picture", file.string());
  Decoding decoding{bytes};
  GrayPicture picture;
  if (decode(decoding, picture)) return picture;
  if (decoding.message == "its size")
    fail_input("{}: {} x {} pixels; a height field has 2 to {} a side", file.string(), picture.width, picture.height,
               widest_heightfield);
  fail_input("{}: a damaged PNG picture: {}", file.string(), decoding.message);
}

}  // namespace

Model heightfield_model(const fs::path& file, const Box3d& box) {
  const GrayPicture picture = read_gray(file);
  const std::size_t width = picture.width, height = picture.height;
  const Vec3d size = box.size();
  const double bottom = box.min.y - size.y;
  Model model;
  model.parts = 1;
  const auto at = [&](std::size_t i, std::size_t j, double y) {
    return Vec3d{box.min.x + size.x * static_cast<double>(i) / static_cast<double>(width - 1), y,
                 box.min.z + size.z * static_cast<double>(j) / static_cast<double>(height - 1)};
  };
  for (std::size_t j = 0; j < height; ++j)
    for (std::size_t i = 0; i < width; ++i)
      model.vertices.push_back(at(i, j, box.min.y + size.y * picture.pixels[j * width + i] / 65535.0));
  const auto vertex = [&](std::size_t i, std::size_t j) { return static_cast<std::uint32_t>(j * width + i); };
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    model.triangles.push_back({a, b, c});
    model.triangles.push_back({a, c, d});
  };
  for (std::size_t j = 0; j + 1 < height; ++j)
    for (std::size_t i = 0; i + 1 < width; ++i)
      quad(vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1), vertex(i + 1, j));

  // Around the rim, so that matter inside is on the left seen from above: the vertices of the rim,
  // and those below them.
  std::vector<std::uint32_t> rim;
  for (std::size_t j = 0; j + 1 < height; ++j) rim.push_back(vertex(0, j));
  for (std::size_t i = 0; i + 1 < width; ++i) rim.push_back(vertex(i, height - 1));
  for (std::size_t j = height - 1; j > 0; --j) rim.push_back(vertex(width - 1, j));
  for (std::size_t i = width - 1; i > 0; --i) rim.push_back(vertex(i, 0));
  const auto low = static_cast<std::uint32_t>(model.vertices.size());
  for (const std::uint32_t v : rim) model.vertices.push_back({model.vertices[v].x, bottom, model.vertices[v].z});
  const auto count = static_cast<std::uint32_t>(rim.size());
  const auto middle = static_cast<std::uint32_t>(model.vertices.size());
  model.vertices.push_back({box.center().x, bottom, box.center().z});
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t next = (k + 1) % count;
    quad(rim[k], low + k, low + next, rim[next]);
    model.triangles.push_back({middle, low + next, low + k});
  }
  return model;
}

}  // namespace dreampm
