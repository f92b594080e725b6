// The structs that a scene is built of: dreampm.model. What they mean comes from the tables of
// scene files, so that it is said once.
#include <string>

#include "bindings.h"
#include "dreampm/model/scene.h"
#include "dreampm/scene.h"
#include "model_members.h"

namespace dreampm::python {
namespace {

using namespace model;

/// Binds members whose meaning a scene file's table has, under `path`.
template <class T>
class Section {
 public:
  Section(nb::module_& m, const char* name, const std::string& doc, std::string path)
      : bound_(m, name, doc), path_(std::move(path)) {}
  /// `key`: what scene files call it, if not as the member.
  template <class M>
  Section& key(const char* name, M T::* at, const char* key = nullptr) {
    const std::string path = path_ + (key ? key : name), about = about_key(path);
    if (about.empty()) throw std::logic_error("no key of scene files is called " + path);
    bound_.member(name, at, about);
    return *this;
  }
  /// One that files say otherwise.
  template <class M>
  Section& own(const char* name, M T::* at, const char* about) {
    bound_.member(name, at, about);
    return *this;
  }
  void done() { bound_.done(); }

 private:
  Struct<T> bound_;
  std::string path_;
};

constexpr const char* name_of_it = "By which the scene calls it.";

template <class V>
void key_struct(nb::module_& m, const char* name) {
  Struct<Key<V>>(m, name, "A value at a time; between keys it changes linearly.")
      .member("t", &Key<V>::t, "[s]")
      .member("value", &Key<V>::value, "At that time.")
      .done();
}

void space_structs(nb::module_& m) {
  Struct<dreampm::Wall>(m, "Wall", "A wall of the box.")
      .member("type", &dreampm::Wall::type, about_key("space.walls.all.type"))
      .member("friction", &dreampm::Wall::friction, about_key("space.walls.all.friction"))
      .member("skin_friction", &dreampm::Wall::skin_friction, about_key("space.walls.all.skin_friction"))
      .done();
  Section<Space>(m, "Space", "The box that matter moves in, and its resolution.", "space.")
      .key("min", &Space::min)
      .key("max", &Space::max)
      .key("spacing", &Space::spacing)
      .key("particles_per_cell", &Space::particles_per_cell)
      .own("walls", &Space::walls, "x_min, x_max, y_min (the floor), y_max, z_min, z_max.")
      .own("periodic", &Space::periodic, "Whether the ends of x, y and z meet.")
      .done();
  Section<Time>(m, "Time", "How long the film is, and how long a step.", "time.")
      .key("fps", &Time::fps)
      .key("frames", &Time::frames)
      .key("solver", &Time::solver)
      .key("cfl", &Time::cfl)
      .key("dt", &Time::dt)
      .key("dt_max", &Time::dt_max)
      .key("damping", &Time::damping)
      .key("surface_contact", &Time::surface_contact)
      .done();
}

void motion_structs(nb::module_& m) {
  key_struct<double>(m, "NumberKey");
  key_struct<Vec3d>(m, "VectorKey");
  Struct<PoseKey>(m, "PoseKey", "Where a shape stands at a time, from where the scene gives it.")
      .member("t", &PoseKey::t, "[s]")
      .member("position", &PoseKey::position, "How far it is moved [m].")
      .member("rotate_axis", &PoseKey::rotate_axis, "Of any length above 0.")
      .member("rotate_angle", &PoseKey::rotate_angle, "[degrees], by the right hand about the axis.")
      .done();
  Section<Motion>(m, "Motion", "How a shape moves: by keys, or at a constant velocity and spin.", "colliders.motion.")
      .key("keys", &Motion::keys)
      .own("smooth", &Motion::smooth, "With keys: it slows down at each; else it goes straight from key to key.")
      .key("velocity", &Motion::velocity)
      .key("spin", &Motion::spin)
      .key("about", &Motion::about)
      .done();
}

void bodies_structs(nb::module_& m) {
  Section<model::Material>(
      m, "Material",
      "What matter is made of. `values` holds parameters by the keys of `dreampm materials TYPE`;\n"
      "those that are left out have their defaults. `dreampm.preset` gives sets of values.",
      "materials.")
      .own("name", &model::Material::name, name_of_it)
      .own("type", &model::Material::type, "newtonian, elastic, snow, ...: of `dreampm materials`.")
      .own("values", &model::Material::values, "By key.")
      .key("transfer", &model::Material::transfer)
      .own("transfer_values", &model::Material::transfer_values, "By key: flip_blend, flip_memory, ...")
      .done();
  Section<Body>(m, "Body", "Matter that is there at the start.", "bodies.")
      .own("name", &Body::name, name_of_it)
      .key("material", &Body::material)
      .key("shape", &Body::shape)
      .key("velocity", &Body::velocity)
      .key("spin", &Body::spin)
      .key("color", &Body::color)
      .key("pattern", &Body::pattern, "sample.pattern")
      .key("cut", &Body::cut)
      .done();
}

void colliders_structs(nb::module_& m) {
  Section<Spring>(m, "Spring", "Pulls the center of mass of a rigid body to a point.", "rigid.spring.")
      .key("to", &Spring::to)
      .key("stiffness", &Spring::stiffness)
      .key("damping", &Spring::damping)
      .done();
  Section<Rigid>(m, "Rigid", "What makes a collider a rigid body.", "rigid.")
      .key("density", &Rigid::density)
      .key("mass", &Rigid::mass)
      .key("velocity", &Rigid::velocity)
      .key("spin", &Rigid::spin)
      .key("restitution", &Rigid::restitution)
      .own("locked", &Rigid::locked, "x, y, z, rx, ry, rz: axes along which it does not move, or turn about.")
      .key("spring", &Rigid::spring)
      .done();
  Section<MeshSequence>(m, "MeshSequence", "A collider as a mesh that deforms: a file a frame.", "colliders.shape.")
      .own("files", &MeshSequence::files, "At least two, by time.")
      .key("fps", &MeshSequence::fps)
      .own("scale", &MeshSequence::scale, "The length of the files' unit [m].")
      .done();
  Section<model::Collider>(m, "Collider", "A solid that matter meets: at rest, in a given motion, or a rigid body.",
                           "colliders.")
      .own("name", &model::Collider::name, name_of_it)
      .key("shape", &model::Collider::shape)
      .own("sequence", &model::Collider::sequence, "In place of a shape: a mesh that deforms.")
      .key("type", &model::Collider::type)
      .key("friction", &model::Collider::friction)
      .key("sticky", &model::Collider::sticky)
      .key("voxel", &model::Collider::voxel)
      .own("deletes", &model::Collider::deletes, "Whether matter that touches it is taken out.")
      .key("thickness", &model::Collider::thickness)
      .key("holds", &model::Collider::holds)
      .key("motion", &model::Collider::motion)
      .own("rigid", &model::Collider::rigid, "Matter and impacts move it.")
      .own("pin", &model::Collider::pin, "It only holds matter, and is not drawn.")
      .done();
}

void inflow_structs(nb::module_& m) {
  Section<Emitter>(m, "Emitter", "Where matter comes in: the shape stays filled with what moves through it.",
                   "emitters.")
      .own("name", &Emitter::name, name_of_it)
      .key("material", &Emitter::material)
      .key("shape", &Emitter::shape)
      .key("velocity", &Emitter::velocity)
      .key("flow", &Emitter::flow)
      .key("direction", &Emitter::direction)
      .key("swirl", &Emitter::swirl)
      .key("jitter", &Emitter::jitter)
      .key("start", &Emitter::start)
      .key("stop", &Emitter::stop)
      .key("color", &Emitter::color)
      .key("pool", &Emitter::pool)
      .key("recycle", &Emitter::recycle)
      .key("motion", &Emitter::motion)
      .done();
  Section<Sink>(m, "Sink", "Where matter is taken out.", "sinks.")
      .own("name", &Sink::name, name_of_it)
      .key("shape", &Sink::shape)
      .key("motion", &Sink::motion)
      .done();
  Section<model::ForceField>(m, "ForceField", "A force that acts on matter from afar: drag, wind, attractor or brush.",
                             "fields.")
      .own("name", &model::ForceField::name, name_of_it)
      .own("type", &model::ForceField::type, "drag, wind, attractor or brush.")
      .own("numbers", &model::ForceField::numbers, "By key of the type: rate, radius, ...")
      .own("vectors", &model::ForceField::vectors, "By key of the type: velocity, point, ...")
      .key("box", &model::ForceField::box)
      .done();
}

void probes_structs(nb::module_& m) {
  Section<HeightProbe>(m, "HeightProbe", "The height of the free surface above a point.", "probes.")
      .own("x", &HeightProbe::x, "[m]")
      .own("z", &HeightProbe::z, "[m]")
      .done();
  Section<PressureProbe>(m, "PressureProbe", "The pressure of the matter at a point of a wall.", "probes.")
      .key("at", &PressureProbe::at)
      .key("normal", &PressureProbe::normal)
      .key("radius", &PressureProbe::radius)
      .done();
  Section<VelocityProbe>(m, "VelocityProbe", "The mean velocity of the matter around a point.", "probes.")
      .key("at", &VelocityProbe::at)
      .key("radius", &VelocityProbe::radius)
      .done();
  Section<FluxProbe>(m, "FluxProbe", "The volume that passes a plane along its normal.", "probes.plane.")
      .key("point", &FluxProbe::point)
      .key("normal", &FluxProbe::normal)
      .done();
  Section<RegionProbe>(m, "RegionProbe", "What lies within a shape.", "probes.")
      .key("shape", &RegionProbe::shape)
      .done();
  Section<ForceProbe>(m, "ForceProbe", "The force of the matter on a wall, collider or rigid body.", "probes.")
      .key("on", &ForceProbe::on)
      .done();
  Section<ExtentProbe>(m, "ExtentProbe", "From where to where matter reaches along an axis.", "probes.")
      .own("axis", &ExtentProbe::axis, "0, 1, 2: x, y, z.")
      .key("material", &ExtentProbe::material)
      .done();
  Section<PointProbe>(m, "PointProbe", "A material point of a body: the one that starts at `at`.", "probes.")
      .key("body", &PointProbe::body)
      .key("at", &PointProbe::at)
      .done();
  Section<PoseProbe>(m, "PoseProbe", "Where a collider or rigid body stands, and how it moves.", "probes.")
      .key("on", &PoseProbe::on)
      .done();
  Section<InflowProbe>(m, "InflowProbe", "What comes in by an emitter, or goes out by a sink.", "probes.")
      .key("on", &InflowProbe::on)
      .done();
  Section<Probe>(m, "Probe", "What is measured while the scene runs.", "probes.")
      .own("name", &Probe::name, name_of_it)
      .key("rate", &Probe::rate)
      .own("form", &Probe::form, "A HeightProbe, PressureProbe, ...")
      .done();
}

void render_structs(nb::module_& m) {
  Section<Output>(m, "Output", "What `dreampm run` writes.", "output.")
      .key("folder", &Output::folder)
      .key("attributes", &Output::attributes, "particles.attributes")
      .key("checkpoint_every", &Output::checkpoint_every, "checkpoint.every")
      .done();
  Struct<FoamLimits>(m, "FoamLimits", "Between which values a cause goes from nothing to all; absent: found.")
      .member("from_", &FoamLimits::from, about_key("foam.speed.from"))
      .member("to", &FoamLimits::to, about_key("foam.speed.to"))
      .done();
  Struct<FoamSource>(m, "FoamSource", "A cause of foam.")
      .member("share", &FoamSource::share, about_key("foam.crest.share"))
      .member("limits", &FoamSource::limits, "Where it begins, and where it gives all.")
      .done();
  Section<Foam>(m, "Foam", "Spray, foam, bubbles and dust.", "foam.")
      .key("amount", &Foam::amount)
      .key("of", &Foam::of)
      .key("rate", &Foam::rate)
      .key("scale", &Foam::scale)
      .key("radius", &Foam::radius)
      .key("speed", &Foam::speed)
      .key("trapped_air", &Foam::trapped_air)
      .key("crest", &Foam::crest)
      .key("vorticity", &Foam::vorticity)
      .key("most", &Foam::most)
      .key("life_min", &Foam::life_min, "life")
      .key("life_max", &Foam::life_max, "life")
      .key("grow", &Foam::grow)
      .key("fade", &Foam::fade)
      .key("rise", &Foam::rise)
      .key("drag", &Foam::drag)
      .key("color", &Foam::color)
      .done();
  Section<Surface>(m, "Surface", "How a surface is wrapped around particles.", "surface.")
      .key("voxel", &Surface::voxel)
      .key("smooth", &Surface::smooth)
      .key("overlap", &Surface::overlap)
      .key("drop_life", &Surface::drop_life)
      .key("attributes", &Surface::attributes)
      .key("type", &Surface::type)
      .key("format", &Surface::format)
      .done();
  Section<Look>(m, "Look", "How a material, collider or rigid body looks.", "render.looks.")
      .key("type", &Look::type)
      .key("ior", &Look::ior)
      .key("absorption", &Look::absorption)
      .key("scattering", &Look::scattering)
      .key("anisotropy", &Look::anisotropy)
      .key("color", &Look::color)
      .key("roughness", &Look::roughness)
      .key("ring", &Look::ring)
      .key("grain", &Look::grain)
      .key("radius", &Look::radius)
      .done();
  Section<Camera>(m, "Camera", "Where the camera stands and looks.", "render.camera.")
      .own("fit_basin", &Camera::fit_basin, "It stands so that the box of the scene fills the picture; else from, to.")
      .key("azimuth", &Camera::azimuth)
      .key("elevation", &Camera::elevation)
      .key("fill", &Camera::fill)
      .key("fov", &Camera::fov)
      .key("from_", &Camera::from, "from")
      .key("to", &Camera::to)
      .key("shutter", &Camera::shutter)
      .key("aperture", &Camera::aperture)
      .key("fstop", &Camera::fstop)
      .key("focus", &Camera::focus)
      .own("focus_point", &Camera::focus_point, "A point [m] of the plane that is sharp, in place of its distance.")
      .done();
  Section<Sun>(m, "Sun", "The sun.", "render.light.sun.")
      .key("elevation", &Sun::elevation)
      .key("azimuth", &Sun::azimuth)
      .key("angle", &Sun::angle)
      .key("strength", &Sun::strength)
      .done();
  Section<Light>(m, "Light", "Sky and sun.", "render.light.")
      .key("sky", &Light::sky)
      .key("environment", &Light::environment)
      .key("turn", &Light::turn)
      .key("strength", &Light::strength)
      .key("sun", &Light::sun)
      .done();
  Section<SceneProps>(m, "SceneProps", "What stands around the matter.", "render.stage.")
      .key("place", &SceneProps::place)
      .key("floor", &SceneProps::floor)
      .key("basin", &SceneProps::basin)
      .done();
  Section<Cut>(m, "Cut", "A plane before which some things are left out of the picture, to look inside.", "render.cut.")
      .key("point", &Cut::point)
      .key("normal", &Cut::normal)
      .key("of", &Cut::of)
      .done();
  Section<Render>(m, "Render", "How pictures are drawn.", "render.")
      .own("width", &Render::width, "[pixels], even.")
      .own("height", &Render::height, "[pixels], even.")
      .key("samples", &Render::samples)
      .key("noise", &Render::noise)
      .key("caustics", &Render::caustics)
      .key("physical", &Render::physical)
      .key("denoise", &Render::denoise)
      .key("format", &Render::format)
      .key("camera", &Render::camera)
      .key("light", &Render::light)
      .key("stage", &Render::stage)
      .key("cut", &Render::cut)
      .key("looks", &Render::looks)
      .done();
  Section<Video>(m, "Video", "How the video is encoded.", "video.").key("quality", &Video::quality).done();
}

}  // namespace

void bind_model(nb::module_& package) {
  nb::module_ m = package.def_submodule(
      "model", "The structs that a scene is built of, without a scene file: dreampm.Scene(model.Scene(...)).");
  bind_values_by_key(m);
  space_structs(m), motion_structs(m), bodies_structs(m), colliders_structs(m), inflow_structs(m), probes_structs(m),
      render_structs(m);
  Section<model::Scene>(m, "Scene", "A whole scene. dreampm.Scene(scene) checks and completes it.", "")
      .key("name", &model::Scene::name)
      .key("about", &model::Scene::about)
      .key("seed", &model::Scene::seed)
      .key("space", &model::Scene::space)
      .key("time", &model::Scene::time)
      .key("gravity", &model::Scene::gravity)
      .own("gravity_keys", &model::Scene::gravity_keys, "Gravity by time; empty: constant.")
      .key("materials", &model::Scene::materials)
      .key("start", &model::Scene::start)
      .key("bodies", &model::Scene::bodies)
      .key("colliders", &model::Scene::colliders)
      .key("emitters", &model::Scene::emitters)
      .key("sinks", &model::Scene::sinks)
      .key("fields", &model::Scene::fields)
      .key("probes", &model::Scene::probes)
      .key("output", &model::Scene::output)
      .key("foam", &model::Scene::foam)
      .key("surface", &model::Scene::surface)
      .key("render", &model::Scene::render)
      .key("video", &model::Scene::video)
      .done();
}

}  // namespace dreampm::python
