#include <cmath>
#include <limits>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/base/log.h"
#include "dreampm/base/progress.h"
#include "dreampm/foam/from_scene.h"
#include "dreampm/geometry/whole.h"
#include "dreampm/import/point_cloud.h"
#include "dreampm/io/ply.h"
#include "dreampm/pictures/frames.h"
#include "dreampm/pipeline/foam_files.h"
#include "dreampm/pipeline/foam_limits.h"
#include "dreampm/pipeline/loose_clouds.h"
#include "dreampm/pipeline/loose_files.h"
#include "dreampm/pipeline/loose_names.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

constexpr double earth = 9.81;  // m/s^2

/// What all frames have in common.
struct Film {
  Box3d bounds;          ///< m, of all particles
  std::size_t most = 0;  ///< particles in a frame
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  bool ids = true;  ///< true if every file has ids
};

MovingCloud read_foaming_cloud(const std::string& file) {
  MovingCloud cloud = read_moving_cloud(file);
  const Vec3d shift = read_ply_shift(file);
  for (Vec3d& p : cloud.points) p += shift;
  if (cloud.velocities.empty()) fail_input("{}: has no velocities, of which foam is made", file);
  return cloud;
}

void check_interrupt(const std::string& file) {
  if (interrupted()) throw Interrupted(fmt::format("foam: interrupted before {}", file));
}

Film look_at_film(const LooseFoam& request) {
  Film film;
  Progress progress("foam: reads file", request.files.size());
  for (std::size_t i = 0; i < request.files.size(); ++i) {
    check_interrupt(request.files[i]);
    progress.update(i);
    const MovingCloud cloud = read_foaming_cloud(request.files[i]);
    check_extent(cloud.points, *request.spacing, request.files[i]);
    if (i == 0)
      for (const std::string& w : cloud_warnings(cloud.points, *request.spacing, request.files[i])) warn("{}", w);
    for (const Vec3d& p : cloud.points) film.bounds.add(p);
    film.most = std::max(film.most, cloud.points.size()), film.fewest = std::min(film.fewest, cloud.points.size());
    film.ids &= !cloud.ids.empty();
    if (!film.ids && film.fewest != film.most)
      fail_input(
          "{}: has no ids, and not as many particles as others: which are the same in two frames is unknown. "
          "Write files with ids",
          request.files[i]);
  }
  progress.update(request.files.size());
  return film;
}

FoamingMatter matter_of(const std::string& file, const Film& film, const Vec3d& shift) {
  const MovingCloud cloud = read_foaming_cloud(file);
  FoamingMatter out;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    out.position.push_back(static_cast<Vec3f>(cloud.points[i] - shift));
    out.velocity.push_back(static_cast<Vec3f>(cloud.velocities[i]));
    const std::int64_t id = film.ids ? cloud.ids[i] : static_cast<std::int64_t>(i);
    if (id < 0 || id > std::numeric_limits<std::int32_t>::max())
      fail_input("{}: id of particle {} is {}: 0 to {} are read", file, i, id,
                 std::numeric_limits<std::int32_t>::max());
    out.id.push_back(static_cast<std::int32_t>(id));
  }
  return out;
}

/// The room is what particles reach in any frame and as much again on each side: no walls are
/// known.
FoamRules rules_of(const LooseFoam& request, const Film& film, const Vec3d& shift) {
  const Vec3d size = film.bounds.size();
  const double around = std::max({size.x, size.y, size.z, *request.spacing});
  const Vec3d margin{around, around, around};
  FoamRules rules;
  rules.room.box = {static_cast<Vec3f>(film.bounds.min - margin - shift),
                    static_cast<Vec3f>(film.bounds.max + margin - shift)};
  const auto g = static_cast<float>(earth);
  rules.gravity = request.up == exchange::Up::z ? Vec3f{0, 0, -g} : Vec3f{0, -g, 0};
  rules.spacing = static_cast<float>(*request.spacing);
  rules.cell = 2 * rules.spacing;
  rules.shift = shift;
  return foam_rules(request.foam, rules, static_cast<double>(film.most) * std::pow(*request.spacing, 3));
}

FoamFound limits_of(const LooseFoam& request, const Film& film, const FoamRules& rules) {
  std::vector<FoamMaxima> maxima;
  Progress progress("foam: looks at file", request.files.size());
  for (std::size_t i = 0; i < request.files.size(); ++i) {
    check_interrupt(request.files[i]);
    progress.update(i);
    maxima.push_back(foam_maxima(matter_of(request.files[i], film, rules.shift).view(), {}, rules));
  }
  progress.update(request.files.size());
  return found_limits(maxima, rules);
}

}  // namespace

std::vector<fs::path> foam_of_files(const LooseFoam& request) {
  const std::vector<fs::path> names = loose_names(request.files, request.out, ".ply");
  if (!request.spacing || !(*request.spacing > 0))
    check_spacing(request.spacing, read_foaming_cloud(request.files[0]).points, request.files[0]);
  if (!(request.fps > 0) || !std::isfinite(request.fps)) fail_input("--fps is {}: must be above 0", request.fps);
  const Film film = look_at_film(request);
  const Vec3d shift = file_shift(film.bounds.min, film.bounds.max, *request.spacing);
  FoamRules rules = rules_of(request, film, shift);
  set_limits(rules, request.foam, limits_of(request, film, rules));
  make_folder(request.out);
  Progress progress("foam: file", names.size());
  FoamStep step;
  FoamCounts all;
  FoamingMatter before;
  for (std::size_t i = 0; i < names.size(); ++i) {
    check_interrupt(request.files[i]);
    progress.update(i);
    FoamingMatter now = matter_of(request.files[i], film, shift);
    if (i > 0)
      step = advance_foam(step.particles, before.view(), now.view(), {}, static_cast<float>(1 / request.fps),
                          static_cast<int>(i) + 1, rules);
    if (step.counts.thinned > 0)
      warn("foam: {}: {} were not emitted: --most is {}", request.files[i], step.counts.thinned, request.foam.most);
    write_foam(names[i], step.particles, shift);
    all.crest += step.counts.crest, all.trapped_air += step.counts.trapped_air;
    all.vorticity += step.counts.vorticity;
    before = std::move(now);
  }
  progress.update(names.size());
  if (all.born() == 0)
    info("foam: nothing was emitted: nowhere was matter fast enough");
  else
    info("foam: emitted {}: {} crest, {} trapped air, {} vorticity", all.born(), all.crest, all.trapped_air,
         all.vorticity);
  return names;
}

}  // namespace dreampm
