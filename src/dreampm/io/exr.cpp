#include "dreampm/io/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <set>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

class ExrBytes : public Imf::IStream {
 public:
  ExrBytes(std::string_view bytes, const std::string& name) : IStream(name.c_str()), bytes_(bytes) {}
  bool read(char to[], int count) override {
    const auto n = static_cast<std::size_t>(count);
    if (at_ > bytes_.size() || n > bytes_.size() - at_) throw Iex::InputExc("the file ends too early");
    std::memcpy(to, bytes_.data() + at_, n);
    at_ += n;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t at) override { at_ = at; }

 private:
  std::string_view bytes_;
  std::uint64_t at_ = 0;
};

/// A file in memory: the library would not say that the disk was full when it closes one.
class ExrSink : public Imf::OStream {
 public:
  ExrSink() : OStream("memory") {}
  void write(const char from[], int count) override {
    const auto n = static_cast<std::size_t>(count);
    if (bytes.size() < at_ + n) bytes.resize(at_ + n);
    std::memcpy(bytes.data() + at_, from, n);
    at_ += n;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = at; }
  std::string bytes;

 private:
  std::uint64_t at_ = 0;
};

/// Width and height of a window, which a damaged file may give any numbers.
std::array<long long, 2> exr_size(const Imath::Box2i& box) {
  return {1LL + box.max.x - box.min.x, 1LL + box.max.y - box.min.y};
}

ExrPicture decode(Imf::InputFile& in, const std::string& name) {
  const Imf::Header& header = in.header();
  const Imath::Box2i part = header.dataWindow(), full = header.displayWindow();
  const auto size = exr_size(part), full_size = exr_size(full);
  for (const long long side : {size[0], size[1], full_size[0], full_size[1]})
    if (side < 1 || side > widest_exr)
      fail_input("{}: {} x {} pixels of a frame of {} x {}; 1 to {} a side are read", name, size[0], size[1],
                 full_size[0], full_size[1], widest_exr);
  ExrPicture out;
  out.width = static_cast<int>(size[0]), out.height = static_cast<int>(size[1]);
  out.x = part.min.x - full.min.x, out.y = part.min.y - full.min.y;
  out.full_width = static_cast<int>(full_size[0]), out.full_height = static_cast<int>(full_size[1]);
  for (auto a = header.begin(); a != header.end(); ++a)
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute()))
      out.notes[a.name()] = text->value();
  const Imf::ChannelList& channels = header.channels();
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
      fail_input("{}: channel {} has fewer pixels than the picture; store a value for every pixel", name, c.name());
    out.channels.push_back({c.name(), c.channel().type == Imf::HALF, {}});
  }
  const auto width = static_cast<std::size_t>(out.width), height = static_cast<std::size_t>(out.height);
  Imf::FrameBuffer frame;
  for (ExrChannel& c : out.channels) {
    c.values.resize(width * height);
    frame.insert(c.name, Imf::Slice::Make(Imf::FLOAT, c.values.data(), part, sizeof(float), sizeof(float) * width));
  }
  in.setFrameBuffer(frame);
  in.readPixels(part.min.y, part.max.y);
  return out;
}

void check_picture(const fs::path& file, const ExrPicture& p) {
  const auto side = [](int n) { return n >= 1 && n <= widest_exr; };
  if (!side(p.width) || !side(p.height) || !side(p.full_width) || !side(p.full_height) || p.channels.empty())
    fail_input("{}: cannot be written: {} x {} pixels of {} x {}, {} channels; 1 to {} a side, 1 channel or more",
               file.string(), p.width, p.height, p.full_width, p.full_height, p.channels.size(), widest_exr);
  std::set<std::string_view> names;
  for (const ExrChannel& c : p.channels) {
    if (c.values.size() != static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height))
      fail_input("{}: cannot be written: channel {} has {} values for {} x {} pixels", file.string(), c.name,
                 c.values.size(), p.width, p.height);
    if (c.name.empty() || c.name.size() > 255 || !names.insert(c.name).second)
      fail_input("{}: cannot be written: '{}' is no name for a channel, or that of two; give 1 to 255 letters",
                 file.string(), c.name);
  }
}

std::string encode(const ExrPicture& p) {
  Imf::Header header({{0, 0}, {p.full_width - 1, p.full_height - 1}},
                     {{p.x, p.y}, {p.x + p.width - 1, p.y + p.height - 1}});
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [name, text] : p.notes) header.insert(name, Imf::StringAttribute(text));
  const auto width = static_cast<std::size_t>(p.width);
  Imf::FrameBuffer frame;
  std::vector<std::vector<Imath::half>> halves;
  halves.reserve(p.channels.size());
  for (const ExrChannel& c : p.channels) {
    header.channels().insert(c.name, Imf::Channel(c.half ? Imf::HALF : Imf::FLOAT));
    if (c.half) {
      auto& h = halves.emplace_back(c.values.size());
      // What is beyond a half becomes its largest number, not infinity, which spreads in filters.
      for (std::size_t i = 0; i < h.size(); ++i) h[i] = Imath::half(std::clamp(c.values[i], -65504.0f, 65504.0f));
      frame.insert(c.name, Imf::Slice::Make(Imf::HALF, h.data(), header.dataWindow(), 2, 2 * width));
    } else {
      frame.insert(c.name, Imf::Slice::Make(Imf::FLOAT, c.values.data(), header.dataWindow(), 4, 4 * width));
    }
  }
  ExrSink sink;
  {
    Imf::OutputFile out(sink, header);
    out.setFrameBuffer(frame);
    out.writePixels(p.height);
  }
  return std::move(sink.bytes);
}

}  // namespace

const ExrChannel* ExrPicture::channel(std::string_view name) const {
  const auto c = std::find_if(channels.begin(), channels.end(), [&](const ExrChannel& k) { return k.name == name; });
  return c == channels.end() ? nullptr : &*c;
}

ExrPicture decode_exr(std::string_view bytes, const std::string& name) {
  constexpr std::string_view magic("\x76\x2f\x31\x01", 4);
  if (bytes.empty()) fail_input("{}: the file is empty", name);
  if (bytes.substr(0, 4) != magic) fail_input("{}: not an OpenEXR picture", name);
  try {
    ExrBytes stream(bytes, name);
    Imf::InputFile in(stream, 0);
    return decode(in, name);
  } catch (const Iex::BaseExc& e) {
    fail_input("{}: a damaged OpenEXR picture, or a kind that is not read: {}", name, e.what());
  }
}

ExrPicture read_exr(const fs::path& file) { return decode_exr(read_file(file), file.string()); }

Image read_exr_colors(const fs::path& file) {
  const ExrPicture p = read_exr(file);
  const ExrChannel *r = p.channel("R"), *g = p.channel("G"), *b = p.channel("B");
  if (!r || !g || !b) {
    std::vector<std::string> names;
    for (const ExrChannel& c : p.channels) names.push_back(c.name);
    fail_input("{}: has the channels {}; R, G and B are wanted", file.string(), fmt::join(names, ", "));
  }
  Image out{p.width, p.height, std::vector<Vec3f>(r->values.size())};
  const auto width = static_cast<std::size_t>(p.width);
  for (std::size_t i = 0; i < out.linear.size(); ++i) {
    out.linear[i] = {r->values[i], g->values[i], b->values[i]};
    if (!is_finite(out.linear[i])) fail_input("{}: pixel ({}, {}) is not finite", file.string(), i % width, i / width);
  }
  return out;
}

void write_exr(const fs::path& file, const ExrPicture& picture) {
  check_picture(file, picture);
  std::string bytes;
  try {
    bytes = encode(picture);
  } catch (const Iex::BaseExc& e) {
    fail_run("{}: cannot be written: {}", file.string(), e.what());
  }
  replace_file(file, [&](const fs::path& temporary) { write_bytes(temporary, bytes.data(), bytes.size()); });
}

}  // namespace dreampm
