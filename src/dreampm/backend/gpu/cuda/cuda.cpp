#include "dreampm/backend/gpu/cuda/cuda.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <vector>

#include "dreampm/backend/gpu/cuda/cuda_library.h"
#include "dreampm/backend/gpu/cuda/kernel_sources.h"
#include "dreampm/backend/gpu/kernels.h"
#include "dreampm/base/error.h"
#include "dreampm/version.h"

namespace dreampm::gpu {
namespace {

constexpr const char* file_name = "libdreampm_cuda.so";

/// The places where the library may lie: what DREAMPM_CUDA names; else beside the program or the
/// library that this is part of, where it is installed, and where the system looks.
std::vector<std::string> places() {
  if (const char* const named = std::getenv("DREAMPM_CUDA")) return {named};
  std::vector<std::string> all;
  Dl_info own;
  if (dladdr(reinterpret_cast<const void*>(&places), &own) != 0 && own.dli_fname != nullptr) {
    const std::filesystem::path folder = std::filesystem::absolute(own.dli_fname).parent_path();
    for (const auto& place :
         {folder / file_name, folder / "dreampm" / file_name, folder / "../lib/dreampm" / file_name})
      if (std::filesystem::exists(place)) all.push_back(place.string());
  }
  all.emplace_back(file_name);
  return all;
}

struct Loaded {
  const CudaLibrary* library = nullptr;
  std::string why;  ///< there is none
};

/// Loads the library, which stays.
Loaded load(const std::string& file) {
  void* const handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) {
    const char* const reason = dlerror();
    return {nullptr, reason != nullptr ? reason : "it cannot be loaded"};
  }
  const auto entry = reinterpret_cast<CudaLibraryEntry>(dlsym(handle, cuda_library_entry));
  if (entry == nullptr) return {nullptr, fmt::format("{} is no library of DreaMPM", file)};
  const CudaLibrary* const library = entry();
  if (std::string(library->version) != version || library->kernels != Kernels::fingerprint() ||
      library->sources != kernel_sources)
    return {nullptr, fmt::format("{} belongs to another DreaMPM, of version {}: `make cuda` makes the one that fits",
                                 file, library->version)};
  return {library, {}};
}

/// The first that can be loaded; each list of places is tried once.
const Loaded& loaded() {
  static std::mutex mutex;
  static std::map<std::vector<std::string>, Loaded> known;
  const std::lock_guard lock(mutex);
  const std::vector<std::string> at = places();
  const auto there = known.find(at);
  if (there != known.end()) return there->second;
  // Of failures the first is reported: a file that was found comes before what the system looks
  // for.
  Loaded found = load(at.front());
  for (std::size_t i = 1; !found.library && i < at.size(); ++i)
    if (const Loaded other = load(at[i]); other.library) found = other;
  return known.emplace(at, found).first->second;
}

class CudaDevice final : public Device {
 public:
  CudaDevice(const CudaLibrary& library, void* device) : call_(library), device_(device) {
    const char* name = "";
    int major = 0, minor = 0;
    std::size_t bytes = 0;
    if (const char* const error = call_.about(device_, &name, &major, &minor, &bytes)) {
      call_.close(device_);
      fail_run("CUDA: asking what the device is failed: {}", error);
    }
    isa_ = fmt::format("sm_{}{}", major, minor);
    about_ = fmt::format("{}, {:.1f} GiB, {}", name, static_cast<double>(bytes) / (1u << 30), isa_);
    int kind = 0;
    call_.id(device_, &kind, &id_.number);
    id_.kind = static_cast<DeviceKind>(kind);
  }
  ~CudaDevice() override { call_.close(device_); }
  std::string about() const override { return about_; }
  std::string isa() const override { return isa_; }
  DeviceId id() const override { return id_; }
  Memory memory() const override {
    Memory m{};
    check(call_.memory(device_, &m.free, &m.all), "asking for its memory");
    return m;
  }
  void* allocate(std::size_t bytes) override {
    void* memory = nullptr;
    if (const char* const error = call_.allocate(device_, bytes, &memory)) {
      const Memory m = this->memory();
      fail_run("{}: no room for {:.1f} MB more ({}); {:.1f} of {:.1f} MB are free", about_, megabytes(bytes), error,
               megabytes(m.free), megabytes(m.all));
    }
    return memory;
  }
  void release(void* memory) noexcept override {
    if (memory) call_.release(device_, memory);
  }
  void upload(void* to, const void* from, std::size_t bytes) override {
    check(call_.upload(device_, to, from, bytes), "copying to it");
  }
  void download(void* to, const void* from, std::size_t bytes) override {
    check(call_.download(device_, to, from, bytes), "copying from it");
  }
  void copy(void* to, const void* from, std::size_t bytes) override {
    check(call_.copy(device_, to, from, bytes), "copying within it");
  }
  void make_wait(std::uintptr_t stream) override {
    check(call_.make_wait(device_, stream), "making a stream wait for it");
  }
  void launch(int number, const void* arguments, int blocks) override {
    check(call_.launch(device_, number, arguments, blocks), "launching a kernel");
  }

 private:
  static double megabytes(std::size_t bytes) { return static_cast<double>(bytes) / (1u << 20); }
  void check(const char* error, const char* what) const {
    if (error) fail_run("{}: {} failed: {}", about_, what, error);
  }

  const CudaLibrary& call_;
  void* device_;
  std::string about_, isa_;
  DeviceId id_;
};

}  // namespace

std::unique_ptr<Device> make_cuda_device(int number) {
  const Loaded& cuda = loaded();
  if (!cuda.library) fail_input("no CUDA: {} (docs/guide/gpu.md says how to get it)", cuda.why);
  void* device = nullptr;
  if (const char* const error = cuda.library->open(number, &device))
    fail_input("CUDA device {}: {} (docs/guide/gpu.md says what it needs)", number, error);
  return std::make_unique<CudaDevice>(*cuda.library, device);
}

CudaState find_cuda() {
  try {
    const std::unique_ptr<Device> device = make_cuda_device();
    const Device::Memory memory = device->memory();
    return {true, fmt::format("{}, {:.1f} GiB free", device->about(), static_cast<double>(memory.free) / (1u << 30))};
  } catch (const InputError& e) {
    return {false, e.what()};
  } catch (const RunError& e) {
    return {false, e.what()};
  }
}

}  // namespace dreampm::gpu
