// The numbers of contact with colliders: points of surfaces (contact/surface_points.h), impulses at
// them (backend/surface_contact.h), gaps (backend/contact_gap.h), exact distances
// (contact/obstacles.h), and particles that are put back (physics/particle.h:put_back). Where no
// reason is given here or in docs/theory/contact.md ("Colliders"), the value is a choice
// that no ablation backs yet.
#pragma once

namespace dreampm {

/// Constants of collider contact. They are compile-time constants, so that kernels fold them.
struct ColliderContact {
  // Points of surfaces.

  /// Lines along each axis and across it that look for surfaces in a cell: what a surface has
  /// within less than a quarter of a cell may be missed.
  static constexpr int lines_a_cell = 4;
  /// Cosine of normals from which two crossings in a cell belong to one face, and from which a
  /// point may limit another: an edge of a right angle has two faces.
  static constexpr double same_face = 0.7;
  /// Cells inside a collider beyond which nodes hardly respond to its surface, and are stopped by
  /// themselves: their weight there is less than 0.05.
  static constexpr double deep_nodes = 1.2;
  /// Cells below the surface at which edges are looked for: a surface bends less than that within a
  /// cell unless there is an edge.
  static constexpr double edge_depth = 0.25;

  // Impulses at points.

  /// Iterations of the accelerated projected gradient (Mazhar et al. 2015) in each contact solve.
  static constexpr int iterations = 8;
  /// Iterations about rigid bodies, which are unknowns beside the impulses.
  static constexpr int body_iterations = 20;
  /// Least mass of a node over that of a kernel filled as at the point [1], of the part outside the
  /// colliders. Nodes with almost no mass would be thrown off.
  static constexpr double least_fill = 0.25;
  /// Least mass of a node far inside, over its weight times the mass at the point [1], for the same
  /// reason.
  static constexpr double least_share = 0.375;
  /// Sum of a point's weights at nodes with matter [1] from which the point acts at all.
  static constexpr double held_from = 0.5;
  /// Sum of a point's weights at nodes with matter [1] from which the point acts in full.
  static constexpr double held_whole = 0.75;
  /// Squared cells within which a point limits the impulse at an edge a cell away: less than to the
  /// edge's own point.
  static constexpr double limiter_reach2 = 0.9;

  // Contact of particles with walls and colliders.

  /// Distance between particles and a wall at which contact begins [spacings]. A particle takes
  /// half a spacing of the room before it; the rest keeps strain from opening the contact again.
  static constexpr double contact_gap = 0.6;
  /// Cells that a particle is kept from a wall or a collider.
  static constexpr double inside_margin = 1e-3;
  /// Spacings before a wall or a collider at which particles of solids and grains stop. Grains that
  /// flow apart beside a wall would end on it.
  static constexpr double solid_margin = 0.25;
  /// Cells a step by which colliders put back what is inside them. The bound on how far matter
  /// moves until the next sort counts it.
  static constexpr double put_back_limit = 0.02;

  // Distances from colliders.

  /// Cells beyond which the distance from a collider does not matter to particles.
  static constexpr double clearance_reach = 3;
  /// Cells of thickness below which splines between the nodes do not see a collider well: particles
  /// near it are given their exact distance.
  static constexpr double thin_wall = 0.95;
  /// Cells of thickness below which that holds at edges and narrow round faces too.
  static constexpr double thin_edge = 1.6;
  /// Cells along a surface at which it is looked at whether it bends.
  static constexpr double bend_reach = 0.75;
  /// Cells off the plane from which a surface bends: what a round face of 2.3 cells does.
  static constexpr double bend = 0.12;
};

}  // namespace dreampm
