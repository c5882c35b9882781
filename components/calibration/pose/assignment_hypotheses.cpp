// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/pose/assignment_hypotheses.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <set>
#include <tuple>

#include "libs/core/index.hpp"
#include "libs/geometry/rigid_registration.hpp"

namespace palpate::calibration {

namespace {

using Eigen::Index;
using Triplet = std::array<int, 3>;

struct HypothesisTuning {
  /// Twice the area over the longest side squared below which a triangle is too thin for a
  /// rotation: more leaves fewer hypotheses, less makes worse ones.
  double needle = 0.2;
  int uses = 4;  ///< triangles of one point, in shares: less spreads hypotheses over more points
};
constexpr HypothesisTuning kHypothesisTuning;

struct RankedTriplet {
  Triplet points;
  double area_m2 = 0.0;
};

double Area_m2(const Eigen::Matrix3Xd& points_m, const Triplet& t) {
  const Eigen::Vector3d a = points_m.col(t[1]) - points_m.col(t[0]);
  const Eigen::Vector3d b = points_m.col(t[2]) - points_m.col(t[0]);
  const double area_m2 = 0.5 * a.cross(b).norm();
  const double longest_m2 = std::max({a.squaredNorm(), b.squaredNorm(), (a - b).squaredNorm()});
  return area_m2 < 0.5 * kHypothesisTuning.needle * longest_m2 ? 0.0 : area_m2;
}

/// Large triangles first. The number per point is limited, so that false points, which may lie far
/// out, are not in all of them.
std::vector<Triplet> ChooseTriplets(const Eigen::Matrix3Xd& points_m, int most) {
  const int count = static_cast<int>(points_m.cols());
  std::vector<RankedTriplet> ranked;
  for (int a = 0; a < count; ++a) {
    for (int b = a + 1; b < count; ++b) {
      for (int c = b + 1; c < count; ++c) {
        const Triplet triplet = {a, b, c};
        const double area_m2 = Area_m2(points_m, triplet);
        if (area_m2 > 0.0) ranked.push_back({triplet, area_m2});
      }
    }
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& x, const auto& y) { return x.area_m2 > y.area_m2; });
  const int share = 1 + kHypothesisTuning.uses * most / std::max(1, count);
  std::vector<int> uses(static_cast<size_t>(count), 0);
  std::vector<Triplet> chosen;
  for (const RankedTriplet& one : ranked) {
    if (static_cast<int>(chosen.size()) == most) break;
    const auto used_up = [&](int p) { return uses[At(p)] >= share; };
    if (std::any_of(one.points.begin(), one.points.end(), used_up)) continue;
    for (const int p : one.points) ++uses[At(p)];
    chosen.push_back(one.points);
  }
  return chosen;
}

/// Marker triplets with feasible distances.
class TripletFinder {
 public:
  TripletFinder(const MarkerShapes& shapes, double error_m) : shapes_(shapes), error_m_(error_m) {}

  template <typename Visit>
  void ForEach(const Eigen::Matrix3d& points_m, const Visit& visit) const {
    const double ab_m = (points_m.col(0) - points_m.col(1)).norm();
    const double bc_m = (points_m.col(1) - points_m.col(2)).norm();
    const double ca_m = (points_m.col(2) - points_m.col(0)).norm();
    const int count = shapes_.MarkerCount();
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        if (j == i || !Fits(i, j, ab_m)) continue;
        for (int k = 0; k < count; ++k) {
          if (k != i && k != j && Fits(j, k, bc_m) && Fits(k, i, ca_m)) visit(Triplet{i, j, k});
        }
      }
    }
  }

 private:
  bool Fits(int i, int j, double distance_m) const {
    return distance_m >= shapes_.shortest_m()(i, j) - error_m_ &&
           distance_m <= shapes_.longest_m()(i, j) + error_m_;
  }

  const MarkerShapes& shapes_;
  double error_m_;
};

double CappedCost_m2(const Eigen::Matrix3Xd& points_m, const Eigen::Matrix3Xd& markers_m,
                     double cap_m) {
  double cost_m2 = 0.0;
  for (const auto& point_m : points_m.colwise()) {
    const double nearest_m2 = (markers_m.colwise() - point_m).colwise().squaredNorm().minCoeff();
    cost_m2 += std::min(nearest_m2, cap_m * cap_m);
  }
  return cost_m2;
}

}  // namespace

std::vector<int> MatchNearest(const Eigen::Matrix3Xd& points_m, const Eigen::Matrix3Xd& markers_m,
                              double gate_m) {
  std::vector<std::tuple<double, int, int>> pairs;
  for (int p = 0; p < points_m.cols(); ++p) {
    for (int m = 0; m < markers_m.cols(); ++m) {
      const double distance_m = (points_m.col(p) - markers_m.col(m)).norm();
      if (distance_m <= gate_m) pairs.emplace_back(distance_m, p, m);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<int> marker_of_point(static_cast<size_t>(points_m.cols()), -1);
  std::vector<bool> taken(static_cast<size_t>(markers_m.cols()), false);
  for (const auto& [distance_m, p, m] : pairs) {
    if (marker_of_point[At(p)] >= 0 || taken[At(m)]) continue;
    marker_of_point[At(p)] = m;
    taken[At(m)] = true;
  }
  return marker_of_point;
}

std::vector<PoseHypothesis> SuggestPoses(const MarkerShapes& shapes,
                                         const Eigen::Matrix3Xd& points_m, double distance_error_m,
                                         int most_triplets, int most) {
  const Eigen::Matrix3Xd& mean_m = shapes.mean_m();
  const double cap_m = shapes.reach_m() + distance_error_m;
  const TripletFinder finder(shapes, distance_error_m);
  std::vector<PoseHypothesis> all;
  for (const Triplet& triplet : ChooseTriplets(points_m, most_triplets)) {
    const Eigen::Matrix3d three_m = points_m(Eigen::all, triplet);
    finder.ForEach(three_m, [&](const Triplet& markers) {
      const geometry::Registration pose =
          geometry::RegisterRigid(three_m, mean_m(Eigen::all, markers));
      if (!pose.status.ok()) return;
      const Eigen::Matrix3Xd moved_m = pose.T_target_source.Apply(points_m);
      all.push_back({pose.T_target_source, CappedCost_m2(moved_m, mean_m, cap_m)});
    });
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& x, const auto& y) { return x.cost_m2 < y.cost_m2; });
  std::vector<PoseHypothesis> best;
  std::set<std::vector<int>> seen;
  for (const PoseHypothesis& one : all) {
    if (static_cast<int>(best.size()) == most) break;
    const Eigen::Matrix3Xd moved_m = one.T_robot_camera.Apply(points_m);
    if (seen.insert(MatchNearest(moved_m, mean_m, cap_m)).second) best.push_back(one);
  }
  return best;
}

}  // namespace palpate::calibration
