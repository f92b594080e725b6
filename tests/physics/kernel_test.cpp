// The quadratic kernel: partition of unity, its moments, transfers that give back what they took,
// and the open part of it beside a wall.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "dreampm/math/rng.h"
#include "dreampm/physics/particle.h"

namespace dreampm {
namespace {

double spline(double d) {
  d = std::abs(d);
  if (d >= 1.5) return 0;
  return d < 0.5 ? 0.75 - d * d : 0.5 * (1.5 - d) * (1.5 - d);
}

TEST(Bspline, PartitionOfUnityAndMoments) {
  for (int i = 0; i < 1000; ++i) {
    const double t = -0.5 + i / 1000.0;
    const auto w = bspline2(t);
    EXPECT_NEAR(w.w[0] + w.w[1] + w.w[2], 1, 1e-15);
    EXPECT_NEAR(-w.w[0] + w.w[2], t, 1e-15);
    // sum w d^2 = 1/4 at every place: the inertia of APIC.
    EXPECT_NEAR(w.w[0] * (1 + t) * (1 + t) + w.w[1] * t * t + w.w[2] * (1 - t) * (1 - t), 1 / apic_inertia, 1e-15);
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(w.w[k], 0);
      EXPECT_NEAR(w.w[k], spline(k - 1 - t), 1e-15);
    }
  }
}

struct N {
  double x = 0, y = 0, z = 0, m = 0;
  friend N operator+(const N& a, const N& b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.m + b.m}; }
  friend N operator-(const N& a, const N& b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.m - b.m}; }
  friend N operator*(const N& a, double s) { return {a.x * s, a.y * s, a.z * s, a.m * s}; }
  friend N mul_add(const N& a, double s, const N& b) { return a * s + b; }
  friend N mul_sub(const N& a, double s, const N& b) { return a * s - b; }
};

TEST(Transfer, GatherOfALinearFieldIsExact) {
  const Vec3d value{1, -2, 3};
  const Mat3d slope{{0.1, 0.2, -0.3, 0.4, -0.5, 0.6, 0.7, 0.8, -0.9}};
  for (const Vec3d u : {Vec3d{0.2, 1.7, 3.9}, Vec3d{-0.9, 0, 4.99}, Vec3d{2.5, 1.0 - 1e-12, -1e-12}}) {
    const auto st = make_stencil(u);
    const Vec3d p = u + Vec3d{0.5, 0.5, 0.5};
    const auto row_at = [&](int i, int j) {
      NodeRow<N> row;
      for (int k = 0; k < 3; ++k) {
        const Vec3d v = value + slope * Vec3d{st.base[0] + i, st.base[1] + j, st.base[2] + k};
        row.n[k] = {v.x, v.y, v.z, 1};
      }
      return row;
    };
    const Moments<N> m = gather<N, no_bends>(st, row_at);
    EXPECT_NEAR(gather_value<N>(st, row_at).y, m.value.y, 1e-14);
    const Vec3d want = value + slope * p;
    EXPECT_NEAR(m.value.x, want.x, 1e-14);
    EXPECT_NEAR(m.value.y, want.y, 1e-14);
    EXPECT_NEAR(m.value.z, want.z, 1e-14);
    EXPECT_NEAR(m.value.m, 1, 1e-15);
    Vec3d along[3];
    for (int a = 0; a < 3; ++a) along[a] = {m.first_moment[a].x, m.first_moment[a].y, m.first_moment[a].z};
    EXPECT_LT(std::sqrt(norm2(affine_velocity(along, 1.0) - slope)), 1e-14);
  }
}

// The rule that J of a liquid follows: 4 sum w v (x_i - x_p)_a less the excess is sum v dw/dx_a,
// whatever the nodes hold, and also where particles of two cells share four nodes.
TEST(Transfer, AffineLessItsExcessIsTheGradientOfTheSplines) {
  double nodes[4][4][3];
  std::uint64_t draws = 0;
  for (auto& plane : nodes)
    for (auto& row : plane)
      for (double& n : row) n = uniform(3, draws++) - 0.5;
  const double h = 1e-6;
  for (const bool second : {false, true})
    for (const Vec3d t : {Vec3d{0.29, -0.31, 0.12}, Vec3d{-0.49, 0.49, -0.3}, Vec3d{0, 0.1, 0.45}}) {
      const auto value_at = [&](const Vec3d& at) {
        double sum = 0;
        for (int i = 0; i < 4; ++i)
          for (int j = 0; j < 4; ++j)
            for (int k = 0; k < 3; ++k)
              sum +=
                  nodes[i][j][k] * spline(i - 1 - second - at.x) * spline(j - 1 - second - at.y) * spline(k - 1 - at.z);
        return sum;
      };
      const auto row_at = [&](int i, int j) {
        return line_spline<double>(nodes[i][j][0], nodes[i][j][1], nodes[i][j][2]);
      };
      const LinePlace<double> z(t.z);
      const double w[2][3] = {{bspline2(t.x).w[0], bspline2(t.x).w[1], bspline2(t.x).w[2]},
                              {bspline2(t.y).w[0], bspline2(t.y).w[1], bspline2(t.y).w[2]}};
      const Moments<double> m = gather<double, all_bends>(Shared<double, 4>(w[0], t.x, second),
                                                          Shared<double, 4>(w[1], t.y, second), z, row_at);
      EXPECT_NEAR(m.value, value_at(t), 1e-14);
      for (int a = 0; a < 3; ++a) {
        Vec3d ahead = t, behind = t;
        ahead[a] += h, behind[a] -= h;
        EXPECT_NEAR(apic_inertia * m.first_moment[a] - affine_excess(t[a]) * m.bend[a],
                    (value_at(ahead) - value_at(behind)) / (2 * h), 1e-8);
      }
      if (second) continue;
      const Moments<double> three =
          gather<double, all_bends>(Shared<double, 3>(w[0], t.x), Shared<double, 3>(w[1], t.y), z, row_at);
      for (int a = 0; a < 3; ++a) EXPECT_NEAR(three.bend[a], m.bend[a], 1e-14);
    }
}

TEST(Transfer, ALineSplineIsTheSplineOfItsNodes) {
  const double nodes[3] = {0.7, -1.1, 2.3};
  const LineSpline<double> line = line_spline<double>(nodes[0], nodes[1], nodes[2]);
  for (const double t : {-0.5, -0.2, 0.0, 0.37, 0.5}) {
    const Weights1<double> weights = bspline2(t);
    double value = 0, moment = 0;
    for (int k = 0; k < 3; ++k) value += weights.w[k] * nodes[k], moment += weights.w[k] * nodes[k] * (k - 1 - t);
    const LinePlace<double> place(t);
    EXPECT_NEAR(place.value(line), value, 1e-14);
    EXPECT_NEAR(place.moment(line.slope, line.bend), 4 * moment, 1e-14);
  }
  const NodeRow<double> back = nodes_of(line);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(back.n[k], nodes[k], 1e-14);
}

TEST(Transfer, ScatterKeepsMomentaAndItsSlopes) {
  const Vec3d u{1.3, 2.85, 0.49};
  const auto st = make_stencil(u);
  const Vec3d p = u + Vec3d{0.5, 0.5, 0.5};
  N nodes[3][3][3];
  const N q{1, 2, 3, 4};
  const N slope[3] = {{0.5, 0, 0, 0}, {0, -0.7, 0.1, 0}, {0.2, 0, 0.3, 0}};
  scatter(st, q, slope, [&](int i, int j, int k) -> N& { return nodes[i][j][k]; });
  N sum, moment[3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) {
        const N& n = nodes[i][j][k];
        const Vec3d r = Vec3d{st.base[0] + i * 1.0, st.base[1] + j * 1.0, st.base[2] + k * 1.0} - p;
        sum = sum + n;
        for (int a = 0; a < 3; ++a) moment[a] = moment[a] + n * r[a];
      }
  EXPECT_NEAR(sum.x, q.x, 1e-14);
  EXPECT_NEAR(sum.m, q.m, 1e-14);
  for (int a = 0; a < 3; ++a) {
    EXPECT_NEAR(moment[a].x, slope[a].x / 4, 1e-14);
    EXPECT_NEAR(moment[a].y, slope[a].y / 4, 1e-14);
    EXPECT_NEAR(moment[a].z, slope[a].z / 4, 1e-14);
  }
}

// Masses of nodes 0 .. 3 on each axis, full but for what `mass` says of them; the particle's
// stencil begins at node 0.
DensityState<double> packing_among(const std::function<double(const Vec3i&)>& mass, const Vec3d& t) {
  const auto row_at = [&](int i, int j) {
    return line_spline<double>(mass({i, j, 0}), mass({i, j, 1}), mass({i, j, 2}));
  };
  double w[2][3];
  for (int a = 0; a < 2; ++a)
    for (int k = 0; k < 3; ++k) w[a][k] = bspline2(t[a]).w[k];
  const double at[3] = {t.x, t.y, t.z};
  return density_state(Shared<double, 3>(w[0], t.x), Shared<double, 3>(w[1], t.y), LinePlace<double>(t.z), at, 2.0,
                       row_at);
}

Vec3d shift_among(const std::function<double(const Vec3i&)>& mass, const Vec3d& t) {
  return packing_among(mass, t).shift;
}

TEST(Shift, ParticlesLeaveTheCrestsOfAWaveOfTwoCells) {
  const double amplitude = 0.08, full = 2;
  for (const bool crest : {false, true}) {
    const auto wave = [&](const Vec3i& n) { return full * (1 + amplitude * ((n.y % 2 == 1) == crest ? 1 : -1)); };
    // Displacement (4A - noise) t/2 about a crest. Without noise 2A t: its divergence takes 2A from
    // crests, of which nodes see a third.
    const double from_crest = crest ? 1 : -1, slope = 0.5 * (4 * amplitude - VolumeCorrection::shift_noise);
    for (const double t : {-0.4, 0.1, 0.3}) {
      const Vec3d s = shift_among(wave, {0.2, t, -0.1});
      EXPECT_NEAR(s.y, from_crest * slope * t, 1e-12);
      EXPECT_NEAR(s.x, 0, 1e-12);
      EXPECT_NEAR(s.z, 0, 1e-12);
      EXPECT_EQ(packing_among(wave, {0.2, t, -0.1}).inside, 1);
    }
  }
}

TEST(Shift, WhatChanceMakesOfNodesShiftsNothing) {
  // Two overfull nodes side by side: what lies between them would be driven together.
  const auto chance = [](const Vec3i& n) { return n.y == 1 || n.y == 2 ? 2.05 : 1.96; };
  for (const double t : {-0.45, 0.2, 0.45}) EXPECT_EQ(length(shift_among(chance, {0.2, t, -0.1})), 0);
}

// The rows of a liquid at rest, a quarter of a cell from the nodes, up to a surface amid a cell.
TEST(Shift, UnderASurfaceItReadsAsInsideIfThatIsCovered) {
  constexpr double full = 2, top = 6.25;
  const auto mass = [](int node) {
    double sum = 0;
    for (double row = -2.25; row <= top; row += 0.5) sum += 0.5 * full * spline(row - node);
    return sum;
  };
  const auto reading = [&](double row, bool covered) {
    const int middle = static_cast<int>(std::lround(row));
    const auto masses = [&](const Vec3i& n) { return mass(middle - 1 + n.y); };
    const double t = row - middle, missing = packing_among(masses, {0.1, t, 0.2}).missing;
    double content = 0;
    for (int k = 0; k < 3; ++k) content += bspline2(t).w[static_cast<std::size_t>(k)] * mass(middle - 1 + k);
    return (content + (covered ? missing : 0)) / full;
  };
  EXPECT_LT(reading(5.25, false), 0.96);
  for (const double row : {4.75, 5.25, 5.75, 6.25}) EXPECT_NEAR(reading(row, true), 1, 1e-12) << row;
}

// Nodes 0 .. 2 about the particle at `t` from node 1, filled to `density` where `there` says so
// [cells from the particle].
DensityState<double> packing_of(const std::function<bool(const Vec3d&)>& there, const Vec3d& t, double density = 1) {
  constexpr int samples = 6;  // a cell along an axis
  std::array<double, 27> masses{};
  const int wide = 5 * samples;
  for (int i = 0; i < wide; ++i)
    for (int j = 0; j < wide; ++j)
      for (int k = 0; k < wide; ++k) {
        const Vec3d at = Vec3d{i + 0.5, j + 0.5, k + 0.5} * (1.0 / samples) - Vec3d{1.5, 1.5, 1.5};
        if (!there(at - Vec3d{1, 1, 1} - t)) continue;
        for (std::size_t n = 0; n < 27; ++n)
          masses[n] += 2 * density * spline(at.x - static_cast<double>(n / 9)) *
                       spline(at.y - static_cast<double>(n / 3 % 3)) * spline(at.z - static_cast<double>(n % 3)) /
                       (samples * samples * samples);
      }
  return packing_among([&](const Vec3i& n) { return masses[static_cast<std::size_t>(n.x * 9 + n.y * 3 + n.z)]; }, t);
}

// Half-spaces of rest density, of any tilt and at any depth: the reading over that expected is 1.
TEST(Shift, UnderAnyFlatSurfaceTheReadingIsThatAtRestDensity) {
  std::uint64_t draw = 0;
  const auto offset = [&] { return uniform(5, draw++) - 0.5; };
  for (const Vec3d& way : {Vec3d{0, 1, 0}, Vec3d{1, 1, 0}, Vec3d{1, 2, 3}})
    for (const double depth : {0.3, 0.6, 1.0, 1.5, 2.5}) {
      const Vec3d up = normalized(way);
      double sum = 0;
      constexpr int draws = 16;
      for (int k = 0; k < draws; ++k) {
        const Vec3d t{offset(), offset(), offset()};
        const DensityState<double> p = packing_of([&](const Vec3d& x) { return dot(x, up) < depth; }, t);
        sum += p.node_content / 2 / p.at_rest;
      }
      EXPECT_NEAR(sum / draws, 1, 0.03) << depth << " " << up.x << " " << up.y << " " << up.z;
    }
  // Inside nothing is corrected. A sheet of a third of a cell and a drop of half of one say
  // nothing.
  EXPECT_NEAR(packing_of([](const Vec3d&) { return true; }, {0.3, 0.1, 0.2}).at_rest, 1, 1e-9);
  EXPECT_LT(packing_of([](const Vec3d& x) { return std::abs(x.y) < 1.0 / 6; }, {0.1, 0.1, 0.2}).at_rest, 0.2);
  EXPECT_LT(packing_of([](const Vec3d& x) { return length(x) < 0.25; }, {0.1, 0.1, 0.2}).at_rest, 0.05);
}

// A layer of three cells on a floor at half of its rest density is no surface: it reads far less
// than at rest.
TEST(Shift, ASwollenLayerIsNotTakenForASurface) {
  for (const double height : {0.4, 1.2, 2.0, 2.6}) {
    // The floor mirrors it.
    const auto layer = [&](const Vec3d& x) { return std::abs(x.y + height) < 3; };
    const DensityState<double> p = packing_of(layer, {0.1, 0.2, 0.3}, 0.5);
    EXPECT_NEAR(p.node_content / 2 / p.at_rest, 0.5, 0.05) << height;
  }
}

TEST(Shift, SurfacesAndSlopesOfDensityShiftNothing) {
  // A surface at node 2 along y: what the kernel shows of it is no wave.
  const auto surface = [](const Vec3i& n) { return n.y == 0 ? 2.0 : n.y == 1 ? 1.96 : 1.0; };
  EXPECT_LT(length(shift_among(surface, {0.3, 0.4, 0.2})), 0.01);
  const auto open = [](const Vec3i& n) { return n.y == 0 ? 1.96 : n.y == 1 ? 1.0 : 0.04; };
  EXPECT_EQ(length(shift_among(open, {0.3, 0.4, 0.2})), 0);
  EXPECT_EQ(packing_among(open, {0.3, 0.4, 0.2}).inside, 0);
  EXPECT_EQ(length(shift_among([](const Vec3i&) { return 0.0; }, {0.3, 0.4, 0.2})), 0);
  const auto slope = [](const Vec3i& n) { return 2.0 + 0.01 * n.y - 0.02 * n.x; };
  EXPECT_NEAR(length(shift_among(slope, {0.3, 0.4, 0.2})), 0, 1e-14);
}

// Beside a solid, liquid's nodes are full with less; what is missing besides is missed.
TEST(Shift, WhatOthersTakeIsNotLacking) {
  const auto beside = [](double lack) {
    const double t[3] = {0.3, 0.4, 0.2}, full = 2, taken[3] = {0, 0.3, 0.6};
    const Weights1<double> x = bspline2(t[0]), y = bspline2(t[1]);
    const auto masses = [&](int, int j) {
      const double m = full * (1 - taken[j] - lack);
      return line_spline<double>(m, m, m);
    };
    const auto others = [&](int, int j) { return line_spline<double>(taken[j], taken[j], taken[j]); };
    return density_state(Shared<double, 3>(x.w, t[0]), Shared<double, 3>(y.w, t[1]), LinePlace<double>(t[2]), t, full,
                         masses, others);
  };
  EXPECT_NEAR(beside(0).at_rest, 1, 1e-12);
  EXPECT_NEAR(beside(0).inside, 1, 1e-14);
  EXPECT_NEAR(beside(0.1).inside, 1, 1e-14);
  EXPECT_NEAR(beside(0.15).inside, 0.5, 1e-14);
  EXPECT_NEAR(beside(0.3).inside, 0, 1e-14);
}

// The open side's integral of sum_i w_i(x_p) N(x - x_i) over nodes i inside and on the wall's open
// side too: what a full half-space of unit density would leave at the particle.
double open_by_integration(double d) {
  const int n = 20000;
  double sum = 0;
  for (int i = -2; i <= 5; ++i) {
    const double w = spline(d - i);
    if (w == 0) continue;
    // The part of node i's kernel at x > 0.
    const double low = std::max(0.0, i - 1.5), high = i + 1.5, h = (high - low) / n;
    double open = 0;
    for (int k = 0; k < n && high > low; ++k) open += spline(low + (k + 0.5) * h - i) * h;
    sum += w * open;
  }
  return sum;
}

TEST(OpenFraction, IsTheIntegral) {
  for (int i = 0; i <= 60; ++i) {
    const double d = i * 0.05;
    EXPECT_NEAR(open_fraction(d), open_by_integration(d), 1e-8) << "at " << d << " cells";
  }
  EXPECT_EQ(open_fraction(3.0), 1);
}

TEST(OpenFraction, OfACornerIsTheProduct) {
  const BlockWalls<double> walls{{0, 0, -1e6}, {1e6, 1e6, 1e6}, {true, true, true}, true, false};
  const Vec3d u{-0.25, 0.5, 1};  // 1/4 and 1 cell from two walls
  EXPECT_NEAR(open_fraction_at(u, walls), open_fraction(0.25) * open_fraction(1.0), 1e-15);
}

}  // namespace
}  // namespace dreampm
