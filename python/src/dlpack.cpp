#include "dlpack.h"

namespace dreampm::python::dlpack {
namespace {

template <class Kind>
struct Exported {
  Kind managed{};
  std::int64_t shape[2] = {}, strides[2] = {};
  std::shared_ptr<const void> keep;
};

/// Destroys a capsule. A consumer renames the capsule, and calls the deleter itself.
template <class Kind>
void drop_unused(PyObject* holder) {
  if (!PyCapsule_IsValid(holder, Kind::unused)) return;
  auto* const managed = static_cast<Kind*>(PyCapsule_GetPointer(holder, Kind::unused));
  managed->deleter(managed);
}

template <class Kind>
nb::object capsule_of(const Array& array) {
  auto made = std::make_unique<Exported<Kind>>();
  const std::size_t axes = array.shape.size();
  std::int64_t stride = 1;
  for (std::size_t a = axes; a-- > 0;) {
    made->shape[a] = array.shape[a], made->strides[a] = stride;
    stride *= array.shape[a];
  }
  made->keep = array.keep;
  Kind& managed = made->managed;
  managed.tensor = {const_cast<void*>(array.data),
                    array.device,
                    static_cast<std::int32_t>(axes),
                    array.type,
                    made->shape,
                    made->strides,
                    0};
  managed.manager_ctx = made.get();
  // Any thread may call it, without the GIL.
  managed.deleter = [](Kind* self) { delete static_cast<Exported<Kind>*>(self->manager_ctx); };
  if constexpr (requires { managed.flags; }) {
    managed.major = version_major, managed.minor = version_minor;
    managed.flags = array.flags;
  }
  nb::object holder = nb::steal(PyCapsule_New(&managed, Kind::unused, drop_unused<Kind>));
  if (!holder.is_valid()) nb::raise_python_error();
  made.release();
  return holder;
}

}  // namespace

nb::object capsule(const Array& array, bool versioned) {
  return versioned ? capsule_of<ManagedVersioned>(array) : capsule_of<Managed>(array);
}

}  // namespace dreampm::python::dlpack
