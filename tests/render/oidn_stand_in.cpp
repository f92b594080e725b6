// A library with the functions of Open Image Denoise 2 that the renderer calls, for tests of what
// it hands over. Its "filter" keeps half of an auxiliary image, and adds both to light: 4 times the
// reflectance, 16 times the normal. tests/python/test_denoise.py has the real one.
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

namespace {

struct Image {
  float* data = nullptr;
  std::size_t width = 0, height = 0;
};

/// What went wrong: the words of OIDN_STAND_IN_FAILS, or what was not as the interface wants it.
const char* failure = nullptr;

}  // namespace

extern "C" {

struct Device {
  int threads = 0;
};
struct Filter {
  std::map<std::string, Image> images;
  std::map<std::string, bool> flags;
  bool committed = false;
};

Device* oidnNewDevice(int type) { return type == 1 ? new Device : nullptr; }
void oidnSetDeviceInt(Device* d, const char* name, int value) {
  if (std::strcmp(name, "numThreads") == 0) d->threads = value;
}
void oidnSetDeviceBool(Device*, const char*, bool) {}
int oidnGetDeviceInt(Device*, const char* name) { return std::strcmp(name, "version") == 0 ? 20301 : 0; }
void oidnCommitDevice(Device* d) {
  if (d->threads < 1) failure = "no threads";
}
int oidnGetDeviceError(Device*, const char** message) {
  if (const char* asked = std::getenv("OIDN_STAND_IN_FAILS"); asked != nullptr && failure == nullptr) failure = asked;
  *message = failure;
  failure = nullptr;
  return *message != nullptr ? 1 : 0;
}
void oidnReleaseDevice(Device* d) { delete d; }
Filter* oidnNewFilter(Device*, const char* type) { return std::strcmp(type, "RT") == 0 ? new Filter : nullptr; }
void oidnSetSharedFilterImage(Filter* f, const char* name, void* data, int format, std::size_t width,
                              std::size_t height, std::size_t offset, std::size_t pixel_stride,
                              std::size_t row_stride) {
  if (format != 3 || offset != 0 || pixel_stride != 12 || row_stride != 0) failure = "not three floats a pixel";
  f->images[name] = {static_cast<float*>(data), width, height};
}
void oidnSetFilterBool(Filter* f, const char* name, bool value) { f->flags[name] = value; }
void oidnCommitFilter(Filter* f) { f->committed = true; }
void oidnExecuteFilter(Filter* f) {
  const Image out = f->images["output"];
  const bool light = f->images.contains("color");
  if (!f->committed || out.data == nullptr) failure = "not committed, or no output";
  if (light != f->flags["hdr"] || light != f->flags["cleanAux"]) failure = "light is hdr, and its images are clean";
  for (std::size_t i = 0; i < 3 * out.width * out.height; ++i)
    out.data[i] = light
                      ? f->images["color"].data[i] + 4 * f->images["albedo"].data[i] + 16 * f->images["normal"].data[i]
                      : 0.5f * f->images[f->images.contains("albedo") ? "albedo" : "normal"].data[i];
}
void oidnReleaseFilter(Filter* f) { delete f; }
}
