#include "matter.h"

#include <nanobind/stl/filesystem.h>

#include "bindings.h"

namespace dreampm::python {
namespace {

template <class T>
using Column = nb::ndarray<nb::numpy, const T, nb::ndim<1>>;
template <class T>
using Rows = nb::ndarray<nb::numpy, const T, nb::shape<-1, 3>>;

/// The array that `values` shows; `owner` keeps it where it is.
template <class T>
Column<T> column(std::span<const T> values, nb::handle owner) {
  return {values.data(), {values.size()}, owner};
}
Rows<float> rows(std::span<const Vec3f> values, nb::handle owner) {
  static_assert(sizeof(Vec3f) == 3 * sizeof(float));
  return {values.empty() ? nullptr : &values[0].x, {values.size(), 3}, owner};
}

constexpr const char* about_particles =
    "The particles of one material as they were when they were asked for, in the order of their ids.\n\n"
    "Arrays are of numpy, read-only, and show the library's memory without a copy (DLPack too). They\n"
    "never change: steps and edits make new ones. They may outlive the simulation. Ask\n"
    "`sim.particles[material]` again for the particles as they are now.";

void bind_particles(nb::module_& m) {
  using P = ParticleView;
  nb::class_<P>(m, "Particles", about_particles)
      .def_prop_ro(
          "id", [](nb::handle self) { return column(nb::cast<const P&>(self).id, self); },
          "uint32 (n,): unique in the simulation; never used again.")
      .def_prop_ro(
          "position", [](nb::handle self) { return rows(nb::cast<const P&>(self).position, self); },
          "float32 (n, 3) [m].")
      .def_prop_ro(
          "velocity", [](nb::handle self) { return rows(nb::cast<const P&>(self).velocity, self); },
          "float32 (n, 3) [m/s]: of the last step; at the start as the scene says.")
      .def_prop_ro(
          "J", [](nb::handle self) { return column(nb::cast<const P&>(self).J, self); },
          "float32 (n,): volume over volume at rest [1].")
      .def_prop_ro(
          "color", [](nb::handle self) { return rows(nb::cast<const P&>(self).color, self); },
          "float32 (n, 3): linear red, green, blue, 0 to 1, of its body, else of its material's look;\n"
          "of clear matter what 0.1 m lets through.")
      .def("__len__", &P::size)
      .def("__repr__", [](const P& p) { return "<" + std::to_string(p.size()) + " particles>"; });
}

constexpr const char* about_mesh = "A closed triangle mesh. Arrays are of numpy and read-only, and keep the mesh.";

void bind_mesh(nb::module_& m) {
  nb::class_<TriMesh>(m, "Mesh", about_mesh)
      .def_prop_ro(
          "vertices", [](nb::handle self) { return rows(nb::cast<const TriMesh&>(self).vertices, self); },
          "float32 (n, 3) [m].")
      .def_prop_ro(
          "faces",
          [](nb::handle self) {
            const auto& t = nb::cast<const TriMesh&>(self).triangles;
            return Rows<std::uint32_t>(t.empty() ? nullptr : t[0].data(), {t.size(), 3}, self);
          },
          "uint32 (m, 3): indices of vertices, counter-clockwise seen from outside.")
      .def_prop_ro(
          "normals", [](nb::handle self) { return rows(nb::cast<const TriMesh&>(self).normals, self); },
          "float32 (n, 3) of vertices; (0, 3) where the mesh has none.")
      .def_prop_ro(
          "velocities", [](nb::handle self) { return rows(nb::cast<const TriMesh&>(self).velocities, self); },
          "float32 (n, 3) of vertices [m/s]; (0, 3) where the mesh has none.")
      .def("__repr__", [](const TriMesh& mesh) {
        return "<Mesh of " + std::to_string(mesh.vertices.size()) + " vertices, " +
               std::to_string(mesh.triangles.size()) + " faces>";
      });
}

using GivenPicture = nb::ndarray<const std::uint8_t, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;

void write(const std::filesystem::path& file, const nb::object& given) {
  GivenPicture image;
  // Without conversion: of fractions numpy would keep the whole part, which is black.
  if (!nb::try_cast(given, image, false))
    throw nb::type_error(
        "write_png: the image must be a C-contiguous array of uint8 of shape (height, width, 3); "
        "of fractions from 0 to 1 pass (image * 255).round().astype(numpy.uint8)");
  RgbImage picture(static_cast<int>(image.shape(1)), static_cast<int>(image.shape(0)));
  std::copy_n(image.data(), picture.pixels.size(), picture.pixels.begin());
  const nb::gil_scoped_release free;
  write_png(file, picture);
}

}  // namespace

Picture array_of(RgbImage image) {
  auto* kept = new RgbImage(std::move(image));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<RgbImage*>(p); });
  return {
      kept->pixels.data(), {static_cast<std::size_t>(kept->height), static_cast<std::size_t>(kept->width), 3}, owner};
}

void bind_matter(nb::module_& m) {
  bind_particles(m);
  bind_mesh(m);
  m.def("write_png", write, nb::arg("file"), nb::arg("image"),
        nb::sig("def write_png(file: str | os.PathLike[str], image: numpy.typing.NDArray[numpy.uint8]) -> None"),
        "Writes a picture, uint8 (height, width, 3), as a PNG: whole or not at all.");
}

}  // namespace dreampm::python
