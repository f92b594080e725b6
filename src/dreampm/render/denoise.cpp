#include "dreampm/render/denoise.h"

#include <dlfcn.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"

namespace dreampm {
namespace {

// The part of the library's C interface that is called here (Open Image Denoise 2, oidn.h).
struct OidnDevice;
struct OidnFilter;
constexpr int oidn_cpu = 1, oidn_float3 = 3, oidn_no_error = 0;

struct Oidn {
  OidnDevice* (*new_device)(int type);
  void (*set_device_int)(OidnDevice*, const char* name, int value);
  void (*set_device_bool)(OidnDevice*, const char* name, bool value);
  int (*get_device_int)(OidnDevice*, const char* name);
  void (*commit_device)(OidnDevice*);
  int (*get_error)(OidnDevice*, const char** message);
  void (*release_device)(OidnDevice*);
  OidnFilter* (*new_filter)(OidnDevice*, const char* type);
  void (*set_image)(OidnFilter*, const char* name, void* data, int format, std::size_t width, std::size_t height,
                    std::size_t offset, std::size_t pixel_stride, std::size_t row_stride);
  void (*set_filter_bool)(OidnFilter*, const char* name, bool value);
  void (*commit_filter)(OidnFilter*);
  void (*execute)(OidnFilter*);
  void (*release_filter)(OidnFilter*);
};

/// The library, loaded; it stays so, as its threads may outlive a call.
struct Loaded {
  Oidn call{};
  std::string file, why;  ///< why there is none
};

/// `named`: by DREAMPM_OIDN; empty: it is not.
Loaded load(const std::string& named) {
  Loaded out;
  const bool is_named = !named.empty();
  out.file = is_named ? named : "libOpenImageDenoise.so.2";
  void* const library = dlopen(out.file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* const reason = dlerror();
    out.why = fmt::format("{}{}", is_named ? "DREAMPM_OIDN: " : "", reason != nullptr ? reason : "it cannot be loaded");
    return out;
  }
  const auto find = [&](auto& function, const char* name) {
    void* const symbol = dlsym(library, name);
    if (symbol == nullptr && out.why.empty())
      out.why = fmt::format("{} has no {}: version 2 or newer is wanted", out.file, name);
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(symbol);
  };
  Oidn& c = out.call;
  find(c.new_device, "oidnNewDevice"), find(c.set_device_int, "oidnSetDeviceInt");
  find(c.set_device_bool, "oidnSetDeviceBool"), find(c.get_device_int, "oidnGetDeviceInt");
  find(c.commit_device, "oidnCommitDevice"), find(c.get_error, "oidnGetDeviceError");
  find(c.release_device, "oidnReleaseDevice"), find(c.new_filter, "oidnNewFilter");
  find(c.set_image, "oidnSetSharedFilterImage"), find(c.set_filter_bool, "oidnSetFilterBool");
  find(c.commit_filter, "oidnCommitFilter"), find(c.execute, "oidnExecuteFilter");
  find(c.release_filter, "oidnReleaseFilter");
  return out;
}

/// Each name is tried once.
const Loaded& loaded() {
  static std::mutex mutex;
  static std::map<std::string, Loaded> by_name;
  const char* const named = std::getenv("DREAMPM_OIDN");
  const std::string name = named != nullptr ? named : "";
  const std::lock_guard lock(mutex);
  const auto known = by_name.find(name);
  return known != by_name.end() ? known->second : by_name.emplace(name, load(name)).first->second;
}

void check(const Oidn& call, OidnDevice* device, const char* doing) {
  const char* message = nullptr;
  if (call.get_error(device, &message) != oidn_no_error)
    fail_run("the denoiser failed while {}: {}", doing, message != nullptr ? message : "it gives no reason");
}

using Device = std::unique_ptr<OidnDevice, void (*)(OidnDevice*)>;

Device open_device(const Oidn& call) {
  Device device(call.new_device(oidn_cpu), call.release_device);
  if (!device) check(call, nullptr, "starting");
  call.set_device_int(device.get(), "numThreads", thread_count());
  call.set_device_bool(device.get(), "setAffinity", false);
  call.commit_device(device.get());
  check(call, device.get(), "starting");
  return device;
}

}  // namespace

DenoiserState find_denoiser() {
  const Loaded& library = loaded();
  if (!library.why.empty())
    return {false, fmt::format(
                       "Open Image Denoise was not found ({}). Install version 2, as by `pip install pyoidn`, and name "
                       "its libOpenImageDenoise.so.2 by DREAMPM_OIDN",
                       library.why)};
  const Device device = open_device(library.call);
  const int version = library.call.get_device_int(device.get(), "version");
  return {true, fmt::format("Open Image Denoise {}.{}.{} ({})", version / 10000, version / 100 % 100, version % 100,
                            library.file)};
}

void check_denoiser() {
  if (const DenoiserState state = find_denoiser(); !state.found)
    fail_input("render.denoise: {}; or leave out render.denoise and --denoise", state.text);
}

namespace {

/// Filters of one device and one size.
class Filters {
 public:
  Filters(int width, int height) : width_(static_cast<std::size_t>(width)), height_(static_cast<std::size_t>(height)) {}

  struct Input {
    const char* name;
    const std::vector<Vec3f>& pixels;
  };
  /// Returns the first of the inputs without noise; the others, if any, are clean.
  std::vector<Vec3f> run(std::initializer_list<Input> inputs, bool is_light) const {
    const std::unique_ptr<OidnFilter, void (*)(OidnFilter*)> filter(call_.new_filter(device_.get(), "RT"),
                                                                    call_.release_filter);
    check(call_, device_.get(), "making its filter");
    std::vector<Vec3f> out(width_ * height_);
    const auto set = [&](const char* name, Vec3f* pixels) {
      call_.set_image(filter.get(), name, pixels, oidn_float3, width_, height_, 0, sizeof(Vec3f), 0);
    };
    // It writes to `output` alone.
    for (const Input& in : inputs) set(in.name, const_cast<Vec3f*>(in.pixels.data()));
    set("output", out.data());
    if (is_light) call_.set_filter_bool(filter.get(), "hdr", true);
    if (inputs.size() > 1) call_.set_filter_bool(filter.get(), "cleanAux", true);
    call_.commit_filter(filter.get());
    call_.execute(filter.get());
    check(call_, device_.get(), "working");
    return out;
  }

 private:
  const Oidn& call_ = loaded().call;
  Device device_ = open_device(call_);
  std::size_t width_, height_;
};

}  // namespace

// Reflectance and normals first: where they are as noisy as the picture, it keeps that noise.
void denoise(std::vector<Vec3f>& linear, const std::vector<Vec3f>& albedo, const std::vector<Vec3f>& normal, int width,
             int height) {
  check_denoiser();
  const Filters filters(width, height);
  const std::vector<Vec3f> clean_albedo = filters.run({{"albedo", albedo}}, false),
                           clean_normal = filters.run({{"normal", normal}}, false);
  linear = filters.run({{"color", linear}, {"albedo", clean_albedo}, {"normal", clean_normal}}, true);
}

}  // namespace dreampm
