// The numbers of the liquid correction: how J follows the measured density
// (physics/materials/newtonian.h), how much of a reading is believed (physics/law.h:Swelling), and
// how particles are shifted (physics/shift.h). None is from a paper. Where no reason is given here
// or in docs/theory/liquid.md, the value is a choice that no ablation backs yet.
#pragma once

namespace dreampm {

/// Constants of the volume correction of liquids. They are compile-time constants, so that kernels
/// fold them.
struct VolumeCorrection {
  // When and how fast J follows the measured density.

  /// Cells that sound crosses in tau = 300 dx/c, the time in which a liquid's J follows the
  /// measured density.
  static constexpr double relaxation_cells = 300;
  /// Cells that sound (or the pace of the volume relaxation, where that is faster) crosses from one
  /// relaxation to the next: 8 steps at cfl 0.5. Steps between measure no density, and are cheaper.
  static constexpr double relaxation_stride = 4;

  // Bounds beyond which readings are not believed.

  /// Share of a full kernel's open part below which a measured density says nothing; it divides.
  static constexpr double least_open_fraction = 0.1;
  /// Nodes with less of a full one [1], beside what others take of them, lie at a surface.
  static constexpr double full_enough = 0.9;
  /// Strain |D| tau [1] from which a surface is believed to have become looser. At rest that strain
  /// is noise of about 0.005.
  static constexpr double loosening_strain = 1.0 / 3;
  /// Volume strain [1] of a surface reading up to which it is noise of a surface at rest.
  static constexpr double swelling_noise = 0.02;
  /// Volume strain [1] of a surface reading from which all of it is believed.
  static constexpr double swelling_believed = 0.06;
  /// Pace at which swollen liquid loses strain, over that of the volume relaxation: it sinks by its
  /// excess of volume in tau / swelling_pace.
  static constexpr double swelling_pace = 4;
  /// Content of the nodes over that of full ones [1] below which P2GTerms::swollen is 0: drops of
  /// spray are no swollen liquid.
  static constexpr double least_content = 0.3;

  // Bounds of the state e = J - 1; above 0 it is the strain of gaps.

  /// Strain [1] of the widest gap that a volume relaxation opens; less than `parted_strain`, so
  /// that no such gap counts as wholly torn.
  static constexpr double widest_gap = 0.04;
  /// Strain [1] of gaps from which the liquid has come apart (ASFLIP moves it by itself). Under a
  /// surface at rest e is no more than noise about 0.
  static constexpr double parted_strain = 0.05;
  /// Least e [1]; J stays above 0.
  static constexpr double least_strain = -0.6;
  /// Largest e [1]: no gap is wider.
  static constexpr double largest_strain = 4;

  // Shifting of particles.

  /// Cells that a particle is shifted at most along an axis in a step that relaxes volume. The
  /// bound on how far matter moves until the next sort counts it.
  static constexpr double shift_limit = 0.02;
  /// Second differences of the nodes' content up to this share of a full node [1] are noise of how
  /// particles lie, not a wave. Shifted by noise, sheared liquid gathers: between two overfull
  /// nodes it is driven together, and stays.
  static constexpr double shift_noise = 0.2;
  /// Times the part of its kernel that solids and colliders take, of a particle: from 1 on it is
  /// not shifted. The slopes of mass there are those of their shape.
  static constexpr double shift_keeps_off = 30;
};

}  // namespace dreampm
