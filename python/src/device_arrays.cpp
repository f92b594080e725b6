// Particles as arrays on a device, for other programs of Python: DLPack, and the CUDA array
// interface.
#include "dreampm/device_arrays.h"

#include <nanobind/stl/pair.h>

#include <cstddef>

#include "bindings.h"
#include "convert.h"
#include "dlpack.h"
#include "parts.h"

namespace dreampm::python {
namespace {

/// An array whose last reader frees it without the GIL: that may wait for work of the device, which
/// may wait for the GIL.
std::shared_ptr<const DeviceArray> freed_without_gil(std::shared_ptr<const DeviceArray> array) {
  const DeviceArray* const it = array.get();
  return {it, [array = std::move(array)](const DeviceArray*) mutable {
            if (Py_IsInitialized() == 0 || PyGILState_Check() == 0) return array.reset();
            const nb::gil_scoped_release free;
            array.reset();
          }};
}

/// An array of DeviceParticles with its shape.
struct Numbers {
  std::shared_ptr<const DeviceArray> array;
  std::vector<std::int64_t> shape;
  nb::dlpack::dtype type;
  const char* type_name;  ///< of numpy

  Numbers(std::shared_ptr<const DeviceArray> of, std::size_t rows, bool vectors)
      : array(freed_without_gil(std::move(of))),
        shape{static_cast<std::int64_t>(rows)},
        type(vectors ? nb::dtype<float>() : nb::dtype<std::uint32_t>()),
        type_name(vectors ? "float32" : "uint32") {
    if (vectors) shape.push_back(3);
  }
  bool on_host() const { return array->device().kind == DeviceKind::host; }
};

using DevicePlace = std::pair<int, int>;  // as __dlpack_device__ has it
using DlpackVersion = std::pair<int, int>;

DevicePlace place_of(const Numbers& numbers) {
  const DeviceId id = numbers.array->device();
  return {static_cast<int>(id.kind), id.number};
}
constexpr DevicePlace host_place{static_cast<int>(DeviceKind::host), 0};

std::string device_name(const DevicePlace& place) {
  const std::string number = std::to_string(place.second);
  if (place == host_place) return "cpu";
  if (place.first == static_cast<int>(DeviceKind::cuda)) return "cuda:" + number;
  return "(" + std::to_string(place.first) + ", " + number + ")";
}
nb::tuple shape_tuple(const Numbers& numbers) { return nb::tuple(nb::cast(numbers.shape)); }

/// Makes the stream wait that a consumer names as the array API standard has it.
void make_wait(const Numbers& numbers, std::optional<std::int64_t> stream) {
  constexpr std::int64_t legacy = 1, no_wait = -1;
  if (stream == 0)
    throw nb::value_error(
        "stream: 0 may be the default stream or that of the thread: pass 1 for the one, 2 for the other");
  if (stream && *stream < no_wait)
    throw nb::value_error("stream: must be None, -1 (no waiting), 1, 2, or the address of a stream");
  if (stream == no_wait) return;
  if (!numbers.on_host()) return numbers.array->make_wait(static_cast<std::uintptr_t>(stream.value_or(legacy)));
  if (stream) throw nb::value_error("stream: memory of the host has no streams: must be None");
}

dlpack::Array shared_array(const Numbers& numbers, const std::shared_ptr<const DeviceArray>& array,
                           std::uint64_t flags) {
  const auto [kind, number] = place_of(numbers);
  return {array->data(), {kind, number}, numbers.type, numbers.shape, flags, array};
}
/// A copy on the device.
std::shared_ptr<const DeviceArray> device_copy(const Numbers& numbers) {
  const nb::gil_scoped_release free;
  return freed_without_gil(numbers.array->copy());
}
/// A copy in the memory of the host.
dlpack::Array host_copy(const Numbers& numbers) {
  const auto bytes = std::make_shared<std::vector<std::byte>>(numbers.array->bytes());
  {
    const nb::gil_scoped_release free;
    numbers.array->download(bytes->data());
  }
  return {bytes->data(), {host_place.first, host_place.second}, numbers.type, numbers.shape, dlpack::is_copied, bytes};
}

nb::object to_dlpack(const Numbers& numbers, std::optional<std::int64_t> stream,
                     std::optional<DlpackVersion> max_version, std::optional<DevicePlace> to,
                     std::optional<bool> copy) {
  const bool versioned = max_version && max_version->first >= static_cast<int>(dlpack::version_major);
  const DevicePlace from = place_of(numbers), wanted = to.value_or(from);
  if (wanted == from) {
    const std::shared_ptr<const DeviceArray> array = copy.value_or(false) ? device_copy(numbers) : numbers.array;
    make_wait(numbers, stream);
    return dlpack::capsule(shared_array(numbers, array, copy.value_or(false) ? dlpack::is_copied : dlpack::read_only),
                           versioned);
  }
  if (wanted != host_place)
    throw nb::buffer_error(
        ("dl_device: the array is on " + device_name(from) + ", and goes to cpu, not to " + device_name(wanted))
            .c_str());
  if (copy == false)
    throw nb::buffer_error(("copy: the array is on " + device_name(from) + ", and on cpu only as a copy").c_str());
  return dlpack::capsule(host_copy(numbers), versioned);
}

nb::dict cuda_array_interface(const Numbers& numbers) {
  if (numbers.on_host()) throw nb::attribute_error("__cuda_array_interface__: the array is in the host's memory");
  constexpr std::int64_t legacy = 1;
  make_wait(numbers, legacy);
  nb::dict all;
  all["shape"] = shape_tuple(numbers);
  all["typestr"] = numbers.shape.size() > 1 ? "<f4" : "<u4";
  all["data"] = nb::make_tuple(reinterpret_cast<std::uintptr_t>(numbers.array->data()), true);
  all["strides"] = nb::none();
  all["stream"] = legacy;  // readers wait for it, and it for the array
  all["version"] = 3;
  return all;
}

constexpr const char* about_device_array =
    "An array in the memory of the device that simulates. It never changes, and may outlive the simulation.\n\n"
    "    x = torch.from_dlpack(array)            # on the device, without a copy\n"
    "    y = cupy.asarray(array)                 # the same\n"
    "    z = numpy.from_dlpack(array, device='cpu')   # a copy in the host's memory\n\n"
    "Libraries learn that it is read-only where the protocol says so; others must not write into it.\n"
    "from_dlpack(array, copy=True) gives a copy that may be written.";

constexpr const char* about_dlpack =
    "A capsule of DLPack, as the array API standard says. stream: waits until the array is filled; None and 1:\n"
    "the legacy default stream, 2: that of the thread, else its address; -1: none waits. max_version: (1, 0) or\n"
    "above gives a versioned capsule, which says that the array is read-only. dl_device: (1, 0) gives a copy\n"
    "in the host's memory. Raises ValueError for stream 0, BufferError where what is asked for is not possible.";

void bind_device_array(nb::module_& m) {
  nb::class_<Numbers>(m, "DeviceArray", about_device_array)
      .def("__dlpack__", to_dlpack, nb::kw_only(), nb::arg("stream") = nb::none(), nb::arg("max_version") = nb::none(),
           nb::arg("dl_device") = nb::none(), nb::arg("copy") = nb::none(),
           nb::sig("def __dlpack__(self, *, stream: int | None = None, max_version: tuple[int, int] | None = None, "
                   "dl_device: tuple[int, int] | None = None, copy: bool | None = None) -> "
                   "typing_extensions.CapsuleType"),
           about_dlpack)
      .def("__dlpack_device__", place_of, "Kind and number of the device, by DLPack: (2, 0) is the first of CUDA.")
      .def_prop_ro("__cuda_array_interface__", cuda_array_interface,
                   nb::sig("def __cuda_array_interface__(self) -> dict[str, object]"),
                   "Version 3, of an array in CUDA's memory; read-only.")
      .def(
          "__array__",
          [](const Numbers&, nb::args, nb::kwargs) -> nb::object {
            throw nb::type_error("the array is on a device: numpy.from_dlpack(array, device='cpu') copies it");
          },
          nb::sig("def __array__(self, *args, **kwargs) -> typing.NoReturn"), "Raises TypeError.")
      .def_prop_ro("shape", shape_tuple, nb::sig("def shape(self) -> tuple[int, ...]"))
      .def_prop_ro(
          "dtype",
          [](const Numbers& numbers) { return nb::module_::import_("numpy").attr("dtype")(numbers.type_name); },
          nb::sig("def dtype(self) -> numpy.dtype"))
      .def_prop_ro(
          "device", [](const Numbers& numbers) { return device_name(place_of(numbers)); }, "'cuda:0', ...")
      .def("__len__", [](const Numbers& numbers) { return numbers.shape[0]; })
      .def("__repr__", [](const Numbers& numbers) {
        return "<DeviceArray " + std::string(numbers.type_name) + " " +
               nb::cast<std::string>(nb::repr(shape_tuple(numbers))) + " on " + device_name(place_of(numbers)) + ">";
      });
}

constexpr const char* about_device_particles =
    "The particles of one material as they were when they were asked for, as arrays on the GPU that simulates.\n\n"
    "    water = sim.particles.on_device('water')\n"
    "    x = torch.from_dlpack(water.position)\n\n"
    "Arrays are in the order of the library's memory, which may change with each step, with the ids beside:\n"
    "torch.from_dlpack(water.id).long().argsort() sorts them. They never change, and may outlive the simulation.";

void bind_device_particles(nb::module_& m) {
  using P = DeviceParticles;
  nb::class_<P>(m, "DeviceParticles", about_device_particles)
      .def_prop_ro(
          "position", [](const P& p) { return Numbers(p.position, p.count, true); }, "float32 (n, 3) [m].")
      .def_prop_ro(
          "velocity", [](const P& p) { return Numbers(p.velocity, p.count, true); },
          "float32 (n, 3) [m/s]: of the last step; at the start as the scene says.")
      .def_prop_ro(
          "id", [](const P& p) { return Numbers(p.id, p.count, false); },
          "uint32 (n,): unique in the simulation; never used again.")
      .def("__len__", &P::size)
      .def("__repr__", [](const P& p) {
        return "<" + std::to_string(p.size()) + " particles on " +
               device_name(place_of(Numbers(p.position, p.count, true))) + ">";
      });
}

}  // namespace

void bind_device_arrays(nb::module_& m) {
  bind_device_array(m);
  bind_device_particles(m);
}

}  // namespace dreampm::python
