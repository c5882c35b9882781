// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/prepare/nearest_robot.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>
#include <vector>

#include "components/diagnosis/faults/makers.hpp"
#include "components/diagnosis/forward/simulator.hpp"
#include "components/diagnosis/prepare/telling_samples.hpp"
#include "components/diagnosis/surface/surface_matcher.hpp"
#include "libs/core/parallel_for.hpp"
#include "libs/core/seconds.hpp"
#include "libs/geometry/closest_point.hpp"

namespace palpate::diagnosis {

namespace {

/// Points that lie farther off the surface are of something else, or on a leg that is elsewhere.
constexpr double kFarthestMarker_m = 0.03;
/// Points of a depth frame that are evaluated, about as many.
constexpr Eigen::Index kPoints = 500;
/// Another robot is taken for it where the mean square of what points are off by is so much less,
/// in the samples in which the two differ.
constexpr double kClearlyLess = 0.5;
/// Exchanged actuators move the body from one of its driven shapes to another. A robot file's robot
/// that is nearer in all of them than this share of the way, as mean squares, has none exchanged.
constexpr double kNear = 0.1;

/// A robot's simulation, against where the robot was seen.
struct Simulated {
  std::vector<Eigen::VectorXd> shapes_m;  ///< [samples]
  std::vector<double> squares_m2;         ///< [samples] sums over points of squared distances
  std::vector<double> points;             ///< [samples]
  double sum_m2 = 0.0;                    ///< of all samples

  double WorstMeanSquare_m2() const {
    double worst_m2 = 0.0;
    for (std::size_t s = 0; s < squares_m2.size(); ++s)
      if (points[s] > 0.0) worst_m2 = std::max(worst_m2, squares_m2[s] / points[s]);
    return worst_m2;
  }
};

double MeanSquare_m2(const Eigen::VectorXd& a_m, const Eigen::VectorXd& b_m) {
  return (a_m - b_m).squaredNorm() / (static_cast<double>(a_m.size()) / 3.0);
}

/// A robot that is bent far off.
struct FarOff {
  ModelHypothesis hypothesis;
  std::optional<Simulated> simulated;
};

/// Mean square over the nodes between the two samples that are most alike and driven by different
/// actuators, as far as distances count, m2.
double BetweenMostAlike_m2(const Telling& telling, const Simulated& robot) {
  double least_m2 = std::pow(kFarthestMarker_m, 2);
  for (std::size_t a = 0; a < telling.driven.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (telling.driven[a] == telling.driven[b]) continue;
      least_m2 = std::min(least_m2, MeanSquare_m2(robot.shapes_m[a], robot.shapes_m[b]));
    }
  }
  return least_m2;
}

/// A valve that is blocked from some recording on changes nothing before it.
bool IsClearlyNearer(const Simulated& other, const Simulated& as_in_file) {
  constexpr double kSame_m2 = 1e-12;
  double other_m2 = 0.0;
  double as_in_file_m2 = 0.0;
  for (std::size_t s = 0; s < other.shapes_m.size(); ++s) {
    if (MeanSquare_m2(other.shapes_m[s], as_in_file.shapes_m[s]) < kSame_m2) continue;
    other_m2 += other.squares_m2[s];
    as_in_file_m2 += as_in_file.squares_m2[s];
  }
  return other_m2 < kClearlyLess * as_in_file_m2;
}

/// Simulates robots and tells how far they are off from where the robot was seen.
class Distance {
 public:
  /// `body`, `telling` and `source` must outlive it. Reads the depth frames about the shapes of
  /// `as_in_file`.
  Distance(const robot::RobotBody& body, const Telling& telling, int threads, SurfaceSource* source,
           const ModelHypothesis& as_in_file)
      : telling_(telling.observed),
        all_(telling_, threads),
        undeformed_({body.mesh.nodes_m, body.boundary.DrawnTriangles()}) {
    for (const Sample& sample : telling_.samples) {
      ObservedExperiment& one = alone_.emplace_back(telling_);
      one.samples = {sample};
      simulators_.emplace_back(one, 1);
    }
    if (source == nullptr) return;
    SurfaceMatcher matcher(body);
    matcher.Read(telling_, all_.Shapes(as_in_file, all_.Run(as_in_file)), source);
    clouds_ = matcher.clouds();
  }

  /// Of all samples, shared by threads. Nothing where it cannot be simulated.
  std::optional<Simulated> Of(const ModelHypothesis& hypothesis) const {
    const Simulation simulation = all_.Run(hypothesis);
    if (!simulation.status.ok()) return std::nullopt;
    std::vector<ShapesInTime> shapes;
    if (!clouds_.empty()) shapes = all_.Shapes(hypothesis, simulation);
    Simulated robot;
    for (std::size_t s = 0; s < telling_.samples.size(); ++s)
      Add(simulation.samples[s], shapes.empty() ? nullptr : &shapes[s], s, &robot);
    return robot;
  }

  /// Nothing, either, once the samples so far are off by `most_m2` in the sum. A robot whose cables
  /// are exchanged is far off in the first sample that pulls one: the others, slow to find, are not
  /// needed.
  std::optional<Simulated> IfNearer(const ModelHypothesis& hypothesis, double most_m2) const {
    Simulated robot;
    for (std::size_t s = 0; s < alone_.size(); ++s) {
      const Simulation simulation = simulators_[s].Run(hypothesis);
      if (!simulation.status.ok()) return std::nullopt;
      std::vector<ShapesInTime> shapes;
      if (!clouds_.empty()) shapes = simulators_[s].Shapes(hypothesis, simulation);
      Add(simulation.samples.front(), shapes.empty() ? nullptr : &shapes.front(), s, &robot);
      if (robot.sum_m2 > most_m2) return std::nullopt;
    }
    return robot;
  }

 private:
  /// `shapes`: of the sample, or null, where no depth frames were read.
  void Add(const SimulatedSample& simulated, const ShapesInTime* shapes, std::size_t s,
           Simulated* robot) const {
    robot->shapes_m.push_back(simulated.middle.state.x_m);
    const std::vector<double> distances_m =
        shapes == nullptr ? OfMarkers(simulated, telling_.samples[s]) : OfCloud(*shapes, s);
    double squares_m2 = 0.0;
    for (const double distance_m : distances_m)
      squares_m2 += std::pow(std::min(distance_m, kFarthestMarker_m), 2);
    robot->squares_m2.push_back(squares_m2);
    robot->points.push_back(static_cast<double>(distances_m.size()));
    robot->sum_m2 += squares_m2;
  }

  static std::vector<double> OfMarkers(const SimulatedSample& simulated, const Sample& sample) {
    std::vector<double> distances_m;
    for (Eigen::Index m = 0; m < sample.count.size(); ++m) {
      if (sample.count[m] == 0) continue;
      distances_m.push_back((simulated.markers_m().col(m) - sample.position_m.col(m)).norm());
    }
    return distances_m;
  }

  std::vector<double> OfCloud(const ShapesInTime& shapes, std::size_t s) const {
    const auto r = static_cast<std::size_t>(telling_.samples[s].recording);
    const Eigen::Isometry3d T_robot_camera = telling_.recordings[r].T_camera_robot->inverse();
    std::vector<double> distances_m;
    geometry::SurfaceIndex surface = undeformed_;
    for (const SeenCloud& seen : clouds_[s]) {
      surface.Refit(shapes.At(seen.frame.t_s, shapes.nodes_m).cast<double>());
      const Eigen::Index step = std::max<Eigen::Index>(1, seen.cloud.points_m.cols() / kPoints);
      for (Eigen::Index k = 0; k < seen.cloud.points_m.cols(); k += step) {
        distances_m.push_back(
            surface.Closest(T_robot_camera * seen.cloud.points_m.col(k).cast<double>()).distance_m);
      }
    }
    return distances_m;
  }

  const ObservedExperiment& telling_;
  Simulator all_;
  std::deque<ObservedExperiment> alone_;  ///< by sample; referred to by its simulator
  std::deque<Simulator> simulators_;
  geometry::SurfaceIndex undeformed_;
  SurfaceClouds clouds_;
};

}  // namespace

NearestRobot FindNearestRobot(const robot::RobotBody& body, const ObservedExperiment& observed,
                              int threads, SurfaceSource* source) {
  NearestRobot nearest{.hypothesis = NominalHypothesis(body, observed)};
  const Telling telling = OfMostDriven(observed, body, source != nullptr);
  if (telling.driven.empty()) return nearest;
  const Distance distance(body, telling, threads, source, nearest.hypothesis);
  const auto begin = std::chrono::steady_clock::now();
  const std::optional<Simulated> as_in_file = distance.Of(nearest.hypothesis);
  const auto samples = static_cast<double>(telling.driven.size());
  nearest.sample_s = SecondsSince(begin) / samples * std::min<double>(threads, samples);
  if (!as_in_file) return nearest;
  if (as_in_file->WorstMeanSquare_m2() < kNear * BetweenMostAlike_m2(telling, *as_in_file))
    return nearest;
  std::vector<FaultModelPtr> far_off;
  MakeSwappedCables({.body = body, .observed = telling.observed}, &far_off);
  MakeSwappedTubes({.body = body, .observed = telling.observed}, &far_off);
  MakeBlockedValve({.body = body, .observed = telling.observed}, &far_off);
  double least_m2 = as_in_file->sum_m2;
  const ModelHypothesis of_file = nearest.hypothesis;
  const auto at_once = static_cast<std::size_t>(threads);
  for (std::size_t first = 0; first < far_off.size(); first += at_once) {
    std::vector<FarOff> tried(std::min(at_once, far_off.size() - first), {of_file, {}});
    ParallelFor(tried.size(), threads, [&](std::size_t k) {
      far_off[first + k]->Apply(Eigen::VectorXd::Ones(1), &tried[k].hypothesis);
      tried[k].simulated = distance.IfNearer(tried[k].hypothesis, least_m2);
    });
    for (std::size_t k = 0; k < tried.size(); ++k) {
      const std::optional<Simulated>& other = tried[k].simulated;
      if (!other || !(other->sum_m2 < least_m2) || !IsClearlyNearer(*other, *as_in_file)) continue;
      least_m2 = other->sum_m2;
      nearest.hypothesis = std::move(tried[k].hypothesis);
      nearest.fault = LikelyFault{far_off[first + k]->name(), far_off[first + k]->Start()};
    }
  }
  return nearest;
}

}  // namespace palpate::diagnosis
