// The visit of the nodes of a World in a device's memory, in place of GridUpdate.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "dreampm/backend/backend.h"
#include "dreampm/backend/common.h"
#include "dreampm/backend/gpu/launch.h"
#include "dreampm/backend/gpu/set_memory.h"

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
  bool gapped() const { return gapped_[0] || gapped_[1]; }
  /// As Backend::grid_update. `thin`: whether SetMemory::distance is to be read. Contact with
  /// surfaces of colliders is the host's: the blocks of nodes that it looks at go there and come
  /// back, and are overwritten in the World.
  GridStats operator()(World<float>& world, Memory& memory, const Obstacles& obstacles, GridUpdate<float>& host,
                       double dt, bool thin);
  /// As MirrorWalls::add_image_mass.
  void add_image_mass(const World<float>& world, Memory& memory, double dt);

  // Parts of a visit, for the stages of viscosity.

  /// `part`: as node_constants.
  VisitInput input(const World<float>& world, Memory& memory, double dt, double part);
  /// All between the first kernel of a visit and its sums. `bodies`: as GridUpdate::meet_surfaces.
  void contact(const VisitInput& in, World<float>& world, Memory& memory, const Obstacles& obstacles,
               GridUpdate<float>& host, double dt, bool bodies, GridStats& found);
  /// Adds the sums; `dragged`: those of boundary layers too.
  void add_results(const VisitInput& in, bool dragged, GridStats& total);
  /// The work of force fields [J], as the nodes move now.
  double field_work(const VisitInput& in);
  /// As VisitInput::given, of boundary layers in a stage.
  SourceTerms* dragged() { return dragged_.data(); }
  /// The blocks of the grid that matter of both fields reaches.
  SharedNodes shared_nodes(const VisitInput& in) const { return {in, shared_.data(), around_.data(), images_}; }
  std::size_t shared_count() const { return shared_.size(); }
  /// The sum of one number a block of the grid.
  SourceTerms sum_of_blocks(const Buffer<SourceTerms>& numbers);

 private:
  void find_shared(const World<float>& world, const std::vector<StencilBlocks>& reached);
  void find_entries(const World<float>& world, const Obstacles& obstacles, const GridUpdate<float>& host);
  void find_deep(const World<float>& world, const Obstacles& obstacles);
  void find_gaps(const World<float>& world, const Obstacles& obstacles, GridUpdate<float>& host);
  void meet_surfaces(World<float>& world, Memory& memory, const Obstacles& obstacles, GridUpdate<float>& host,
                     double dt, bool bodies, GridStats& found);
  void measure_gaps(const World<float>& world, Memory& memory, ContactGaps& gaps, bool thin);
  LayersInput layers(int axis) const;
  void apply_fields(const VisitInput& in, const World<float>& world, double dt);
  FieldInput fields() const;

  Device* device_;
  bool folds_ = false, gapped_[2] = {};
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
  Buffer<SourceTerms> given_, dragged_, damped_, fielded_;
  Buffer<Range> block_ranges_, wall_ranges_;
  std::vector<int> side_of_range_;
  Buffer<std::byte> parts_;
  std::vector<std::byte> home_;
  Buffer<SourceTerms> block_parts_;
  std::vector<SourceTerms> block_parts_home_;
  // Force fields and what they gave.
  Buffer<FieldStep> fields_;
  std::array<Buffer<Vec3<float>>, 2> field_impulses_;
  // Nodes deep inside colliders, and blocks at their surfaces.
  Buffer<DeepBlock> deep_blocks_;
  Buffer<DeepNodes> deep_groups_;
  Buffer<DeepNode> deep_nodes_;
  Buffer<ColliderSurface> surfaces_;
  std::vector<std::int32_t> collider_of_group_;
  Buffer<SourceTerms> deep_given_;
  std::vector<SourceTerms> deep_home_;
  Buffer<std::uint32_t> surface_blocks_;
  Buffer<Node<float>> copies_;
  std::vector<Node<float>> copies_home_;
  // Gaps before walls and colliders, and those that the contact with surfaces asks for.
  Buffer<NearWalls> near_;
  Buffer<std::uint32_t> near_colliders_;
  Buffer<WallPlane> planes_;
  Buffer<std::int32_t> gaps_of_, walls_of_, gaps_;
  Buffer<float> gap_;
  std::vector<std::int32_t> asked_home_;
  Buffer<std::int32_t> asked_, asked_gaps_;
  std::vector<float> asked_gaps_home_;
};

}  // namespace dreampm::gpu
