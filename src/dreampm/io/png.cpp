#include "dreampm/io/png.h"

#include <png.h>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

constexpr png_uint_32 widest = widest_png;

// libpng's simple interface keeps its state behind png_image; this frees it on every way out.
struct PngState {
  png_image image{};
  PngState() { image.version = PNG_IMAGE_VERSION; }
  ~PngState() { png_image_free(&image); }
  PngState(const PngState&) = delete;
  PngState& operator=(const PngState&) = delete;
};

}  // namespace

RgbImage decode_png(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) fail_input("{}: the file is empty", name);
  PngState state;
  png_image& image = state.image;
  if (!png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()))
    fail_input("{}: not a PNG picture, or a damaged one: {}", name, image.message);
  if (image.width > widest || image.height > widest)
    fail_input("{}: {} x {} pixels; at most {} a side are read", name, image.width, image.height, widest);
  image.format = PNG_FORMAT_RGB;
  image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  RgbImage out(static_cast<int>(image.width), static_cast<int>(image.height));
  const png_color black{0, 0, 0};
  if (!png_image_finish_read(&image, &black, out.pixels.data(), 0, nullptr))
    fail_input("{}: a damaged PNG picture: {}", name, image.message);
  return out;
}

RgbImage read_png(const fs::path& file) { return decode_png(read_file(file), file.string()); }

void write_png(const fs::path& file, const RgbImage& picture) {
  if (picture.width < 1 || picture.height < 1 || picture.width > int(widest) || picture.height > int(widest) ||
      picture.pixels.size() != static_cast<std::size_t>(picture.width) * picture.height * 3)
    fail_input("{}: cannot be written: {} x {} pixels with {} bytes; 1 to {} a side, 3 bytes a pixel", file.string(),
               picture.width, picture.height, picture.pixels.size(), widest);
  PngState state;
  png_image& image = state.image;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> bytes(PNG_IMAGE_PNG_SIZE_MAX(image));
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.pixels.data(), 0, nullptr))
    fail_run("{}: cannot be written: {}", file.string(), image.message);
  replace_file(file, [&](const fs::path& temporary) { write_bytes(temporary, bytes.data(), size); });
}

}  // namespace dreampm
