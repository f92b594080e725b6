// Spray, foam and bubbles of liquids, and dust of snow and sand: particles that the frames of a
// simulation send out and carry. After Ihmsen, Akinci, Akinci and Teschner, "Unified spray, foam
// and air bubbles for particle-based fluids" (2012), with sums at nodes in place of sums over
// neighbors, and with rates per volume and time, so that neither spacing nor frame rate matters.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "dreampm/foam/lattice_field.h"
#include "dreampm/foam/obstacle.h"

namespace dreampm {

enum class FoamType : std::uint8_t { spray, foam, bubble, dust };
/// As files and pages have them, in the order of FoamType.
inline constexpr std::array<std::string_view, 4> foam_type_names{"spray", "foam", "bubbles", "dust"};

/// The share of its disc that one hides, in the order of FoamType: they let light through, the more
/// the less they differ from what is around them.
inline constexpr std::array<float, 4> foam_opacity{0.7f, 0.9f, 0.2f, 1.0f};

/// A column each; all have size() rows. It is the whole state: the next one follows from it and
/// from the matter of two frames.
struct FoamParticles {
  std::vector<Vec3f> position;  ///< m
  std::vector<Vec3f> velocity;  ///< m/s
  std::vector<FoamType> type;
  std::vector<float> age;        ///< s since birth
  std::vector<float> life;       ///< s that are left; only what ages loses them
  std::vector<float> radius;     ///< m, grown and faded
  std::vector<std::int32_t> id;  ///< rising; stays with a particle
  std::uint32_t next_id = 0;     ///< of the next one that is born

  std::size_t size() const { return position.size(); }
};

/// Foaming matter at a frame. Places count from the shift of the files.
struct FoamMatter {
  std::span<const Vec3f> position{};      ///< m
  std::span<const Vec3f> velocity{};      ///< m/s
  std::span<const std::int32_t> id{};     ///< by which particles of two frames are the same
  std::span<const float> volume_ratio{};  ///< J, or empty: 1
};

/// What a cause needs to begin (`from`) and to give all (`to`).
struct FoamCause {
  float share = 1, from = 0, to = 1;
  /// 0 up to `from`, 1 from `to` on.
  float part(float value) const { return std::clamp((value - from) / (to - from), 0.0f, 1.0f); }
};

/// All that the stage goes by, each number found or given.
struct FoamRules {
  foam::Room room;
  Vec3f gravity{0, -9.81f, 0};  ///< m/s^2
  float spacing = 0.01f;        ///< m, of the matter: a particle has spacing^3 at rest
  float cell = 0.02f;           ///< m, of the grid that holds where matter is and carries foam
  float scale = 0.02f;          ///< m, over which motion is compared; at least a cell
  float rate = 0;               ///< 1/(m^3 s), with the amount in it
  FoamCause speed, trapped_air, crest, vorticity;
  float radius = 1e-3f;                                        ///< m, the mean
  float life_min = 2, life_max = 5, grow = 0.1f, fade = 0.5f;  ///< s
  float rise = -1;                                             ///< m/s of bubbles; below 0: by radius
  float drag = 1;
  std::size_t most = 2000000;
  std::uint64_t seed = 1;
  bool dust = false;  ///< the matter gives dust, not foam
  Vec3d shift{};      ///< m, from which places count
};

/// The slowest wave on water [m/s], with gravity and surface tension: (4 g sigma/rho)^(1/4) (Lamb,
/// Hydrodynamics, 266). Slower motion leaves a surface whole. `gravity` in m/s^2.
float slowest_wave(float gravity);
/// The slowest grain that splashes others out of a bed where it lands [m/s]: 40 sqrt(g d), for the
/// d = 0.25 mm of common sand (Beladjine, Ammi, Oger and Valance, "Collision process between an
/// incident bead and a three-dimensional granular packing", 2007). Slower grains slide and settle.
/// `gravity` in m/s^2.
float slowest_splash(float gravity);

/// What of a frame decides limits: of the matter that moves, the values that one in a hundred is
/// above.
struct FoamMaxima {
  std::uint64_t moving = 0;                         ///< particles fast enough to emit
  float speed = 0;                                  ///< m/s
  float trapped_air = 0, crest = 0, vorticity = 0;  ///< m/s, 1/m, m/s
};
FoamMaxima foam_maxima(const FoamMatter& matter, std::span<const foam::Obstacle> obstacles, const FoamRules& rules);

/// The limits for frames of these maxima: means over the frames in which something moves.
struct FoamFound {
  FoamCause speed, trapped_air, crest, vorticity;
};
FoamFound found_limits(std::span<const FoamMaxima> frames, const FoamRules& rules);

/// What became of foam from one frame to the next.
struct FoamCounts {
  std::uint64_t crest = 0, trapped_air = 0, vorticity = 0;  ///< born, by cause
  std::uint64_t beside_walls = 0;                           ///< of them
  Vec3d place{};                                            ///< m, the sum of where they were born
  std::uint64_t aged = 0, at_walls = 0, outside = 0;        ///< that began to fade, by the reason
  std::uint64_t thinned = 0;
  std::uint64_t born() const { return crest + trapped_air + vorticity; }
};

struct FoamStep {
  FoamParticles particles;
  FoamCounts counts;
};

/// Foam at `to`, from the foam and the matter at `from`, `dt` [s] before. Obstacles stand as at
/// `to`. `frame` numbers it: rounding is by a hash of seed, particle and frame. The same bits for
/// any number of threads.
FoamStep advance_foam(const FoamParticles& foam, const FoamMatter& from, const FoamMatter& to,
                      std::span<const foam::Obstacle> obstacles, float dt, int frame, const FoamRules& rules);

}  // namespace dreampm
