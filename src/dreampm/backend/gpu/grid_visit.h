// The visit of the nodes of a World in a device's memory, in place of GridUpdate.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "dreampm/backend/backend.h"
#include "dreampm/backend/common.h"
#include "dreampm/backend/gpu/device_fields.h"
#include "dreampm/backend/gpu/gap_measure.h"
#include "dreampm/backend/gpu/launch.h"
#include "dreampm/backend/gpu/set_memory.h"
#include "dreampm/backend/gpu/surface_solver.h"

namespace dreampm::gpu {

class GridVisit {
 public:
  explicit GridVisit(Device& device);
  /// Must be called after every change of the grid's block list or of the particles' order.
  /// `reached`: by block of particles.
  void prepare(const World<float>& world, const Obstacles& obstacles, GridUpdate<float>& host,
               const std::vector<StencilBlocks>& reached);
  /// Must be called after colliders have moved, if nothing else changed.
  void colliders_moved(const World<float>& world, const Obstacles& obstacles, GridUpdate<float>& host);
  /// True if any matter has gaps before walls or colliders.
  bool gapped() const { return gaps_.any(); }
  /// As Backend::grid_update. `thin`: whether SetMemory::distance is to be read.
  GridStats operator()(const World<float>& world, Memory& memory, double dt, bool thin);
  /// As MirrorWalls::add_image_mass.
  void add_image_mass(const World<float>& world, Memory& memory, double dt);

  // Parts of a visit, for the stages of viscosity.

  /// `part`: as node_constants.
  VisitInput input(const World<float>& world, Memory& memory, double dt, double part);
  /// All between the first kernel of a visit, or of a stage if that is not null, and its sums. In a
  /// visit rigid bodies are unknowns.
  void contact(const VisitInput& in, const StageInput* stage, const World<float>& world, double dt);
  /// Adds the sums. Returns the work of gravity and stress in a stage [J].
  double add_results(const VisitInput& in, const StageInput* stage, GridStats& total);
  /// The work of force fields [J], as the nodes move now.
  double field_work(const VisitInput& in) { return fields_.work(in, block_ranges_); }
  /// As VisitInput::given, of boundary layers in a stage.
  SourceTerms* dragged() { return dragged_.data(); }
  /// The blocks of the grid that matter of both fields reaches.
  SharedNodes shared_nodes(const VisitInput& in) const { return {in, shared_.data(), around_.data(), images_}; }
  std::size_t shared_count() const { return shared_.size(); }

 private:
  void find_shared(const World<float>& world, const std::vector<StencilBlocks>& reached);
  void find_entries(const World<float>& world, const Obstacles& obstacles, const GridUpdate<float>& host);
  std::vector<ImageLayer> find_layers(const BlockList& list, const MirrorWalls<float>& images);
  void find_deep(const World<float>& world, const Obstacles& obstacles);
  LayersInput layers(int axis) const;
  /// Sums that come home together, in their order.
  enum Part : std::size_t {
    of_grid,
    of_walls,
    of_layers,
    of_damping,
    of_fields,
    of_forces,
    of_surfaces,
    of_deep,
    parts
  };
  void lay_parts(const VisitInput& in, const StageInput* stage);
  std::size_t size_of(Part part) const { return parts_at_[part + 1] - parts_at_[part]; }
  template <class T>
  T* there(Part part) {
    return reinterpret_cast<T*>(parts_.data()) + parts_at_[part];
  }
  template <class T>
  T at_home(std::size_t number) const;

  Device* device_;
  bool folds_ = false, all_wait_ = false;
  // Blocks that matter of both fields reaches.
  std::vector<std::uint8_t> is_shared_;  ///< by block of the grid
  Buffer<std::uint32_t> shared_;
  Buffer<std::int32_t> around_;
  SolidImages images_{};
  Buffer<VisitBlock> blocks_;
  Buffer<std::int32_t> entries_;
  Buffer<std::uint32_t> waiting_;
  Buffer<ImageLayer> layers_;
  std::array<std::uint32_t, 4> axes_{};  ///< where the layers of an axis begin
  Buffer<std::uint8_t> folded_;
  // Sums, the ranges of them that are added up, and what comes of these.
  Buffer<GridTerms> sums_;
  Buffer<SourceTerms> given_, dragged_, damped_;
  Buffer<Range> block_ranges_, wall_ranges_;
  std::vector<int> side_of_range_;
  std::array<std::size_t, parts + 1> parts_at_{};  ///< where each begins
  Buffer<std::byte> parts_;
  std::vector<std::byte> home_;
  DeviceFields fields_;
  // Nodes deep inside colliders, and blocks at their surfaces.
  Buffer<DeepBlock> deep_blocks_;
  Buffer<DeepNodes> deep_groups_;
  Buffer<DeepNode> deep_nodes_;
  Buffer<ColliderSurface> deep_surfaces_;
  std::vector<std::int32_t> collider_of_group_;
  GapMeasure gaps_;
  SurfaceSolver surfaces_;
};

}  // namespace dreampm::gpu
