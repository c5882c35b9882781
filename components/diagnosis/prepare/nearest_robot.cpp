// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/prepare/nearest_robot.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "components/diagnosis/faults/makers.hpp"
#include "components/diagnosis/forward/simulator.hpp"
#include "components/diagnosis/surface/surface_matcher.hpp"
#include "libs/core/seconds.hpp"
#include "libs/geometry/closest_point.hpp"

namespace palpate::diagnosis {

namespace {

/// Points that lie farther off the surface are of something else, or on a leg that is elsewhere.
constexpr double kFarthestMarker_m = 0.03;
/// Points of a depth frame that are evaluated, about as many.
constexpr Eigen::Index kPoints = 500;
/// Another robot is taken for it where the mean square of what points are off by is so much less.
constexpr double kClearlyLess = 0.5;
/// Exchanged actuators move the body from one of its driven shapes to another. A robot file's robot
/// that is nearer in all of them than this share of the way, as mean squares, has none exchanged.
constexpr double kNear = 0.1;

/// How much more of its way than all actuators in the mean one is driven; NaN: it is not then.
double DrivenApart(const Timeline& timeline, const Eigen::VectorXd& most, const Sample& sample,
                   Eigen::Index actuator) {
  const double t_s = 0.5 * (sample.frame_t_s.front() + sample.frame_t_s.back());
  const Eigen::VectorXd share = timeline.CommandAt(t_s).cwiseQuotient(most);
  return share[actuator] - share.array().isNaN().select(0.0, share.array()).mean();
}

bool SeesTheRobot(const Sample& sample, bool in_frames) {
  return in_frames ? !sample.depth_frames.empty() : (sample.count.array() > 0).any();
}

/// The sample that sees the robot in which an actuator is driven apart from the others the most, of
/// one recording or, without it, of all. None where it is not driven.
std::optional<std::size_t> MostDriven(const ObservedExperiment& observed,
                                      const Eigen::VectorXd& most, Eigen::Index actuator,
                                      bool in_frames, std::optional<int> recording = {}) {
  std::optional<std::size_t> best;
  double farthest = 0.0;
  for (std::size_t s = 0; s < observed.samples.size(); ++s) {
    const Sample& sample = observed.samples[s];
    if (!SeesTheRobot(sample, in_frames)) continue;
    if (recording && sample.recording != *recording) continue;
    const double apart = DrivenApart(observed.timeline, most, sample, actuator);
    if (!(apart > farthest)) continue;
    farthest = apart;
    best = s;
  }
  return best;
}

/// Those samples of each actuator; of chambers those of each recording, which tell from when on a
/// valve is blocked.
ObservedExperiment OfMostDriven(ObservedExperiment observed, const robot::RobotBody& body,
                                bool in_frames) {
  const Timeline& timeline = observed.timeline;
  Eigen::VectorXd most = Eigen::VectorXd::Zero(std::ssize(timeline.actuators));
  for (const Eigen::VectorXd& command : timeline.command) {
    most = command.array().isNaN().select(most, command.cwiseMax(most));
  }
  std::set<std::size_t> telling;
  for (Eigen::Index c = 0; c < most.size(); ++c) {
    if (const auto best = MostDriven(observed, most, c, in_frames)) telling.insert(*best);
    if (c < std::ssize(body.cables)) continue;
    for (int r = 0; r < std::ssize(observed.recordings); ++r) {
      if (const auto best = MostDriven(observed, most, c, in_frames, r)) telling.insert(*best);
    }
  }
  std::vector<Sample> samples;
  for (const std::size_t s : telling) samples.push_back(std::move(observed.samples[s]));
  observed.samples = std::move(samples);
  return observed;
}

/// What a robot's simulation is off by from where it was seen: mean squares, m2.
class Distance {
 public:
  /// `body` and `source` must outlive it. Reads the depth frames about the shapes of `as_in_file`.
  Distance(const robot::RobotBody& body, const ObservedExperiment& telling, int threads,
           SurfaceSource* source, const ModelHypothesis& as_in_file)
      : telling_(telling), surface_({body.mesh.nodes_m, body.boundary.DrawnTriangles()}) {
    for (const Sample& sample : telling.samples) {
      ObservedExperiment& one = alone_.emplace_back(telling);
      one.samples = {sample};
      simulators_.emplace_back(one, threads);
    }
    shapes_m_.resize(alone_.size());
    if (source == nullptr) return;
    const Simulator simulator(telling, threads);
    SurfaceMatcher matcher(body);
    matcher.Read(telling, simulator.Shapes(as_in_file, simulator.Run(as_in_file)), source);
    clouds_ = matcher.clouds();
  }

  /// NaN where it is not known; infinite once the samples so far put it above `most_m2`. A robot
  /// whose cables are exchanged is far off in the first sample that pulls one: the others, slow to
  /// find, are not needed.
  double MeanSquareOf_m2(const ModelHypothesis& hypothesis,
                         double most_m2 = std::numeric_limits<double>::infinity()) {
    sum_m2_ = 0.0;
    count_ = 0.0;
    worst_m2_ = 0.0;
    for (std::size_t s = 0; s < alone_.size(); ++s) {
      const Simulation simulation = simulators_[s].Run(hypothesis);
      if (!simulation.status.ok()) return std::numeric_limits<double>::quiet_NaN();
      shapes_m_[s] = simulation.samples.front().middle.state.x_m;
      const double sum_before_m2 = sum_m2_;
      const double count_before = count_;
      if (clouds_.empty()) {
        AddMarkers(simulation.samples.front(), telling_.samples[s]);
      } else {
        AddCloud(simulators_[s].Shapes(hypothesis, simulation).front(), s);
      }
      if (count_ > count_before)
        worst_m2_ = std::max(worst_m2_, (sum_m2_ - sum_before_m2) / (count_ - count_before));
      if (sum_m2_ > most_m2 * count_of_all_) return std::numeric_limits<double>::infinity();
    }
    count_of_all_ = count_;  // the same of all robots
    return sum_m2_ / count_;
  }

  /// The same of the worst sample of the last robot.
  double WorstMeanSquare_m2() const { return worst_m2_; }

  /// Mean square over the nodes between the two samples of the last robot that are most alike, as
  /// far as distances count, m2.
  double BetweenMostAlike_m2() const {
    double least_m2 = std::pow(kFarthestMarker_m, 2);
    for (std::size_t a = 0; a < shapes_m_.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const double nodes = static_cast<double>(shapes_m_[a].size()) / 3.0;
        least_m2 = std::min(least_m2, (shapes_m_[a] - shapes_m_[b]).squaredNorm() / nodes);
      }
    }
    return least_m2;
  }

 private:
  void Add(double distance_m) {
    sum_m2_ += std::pow(std::min(distance_m, kFarthestMarker_m), 2);
    ++count_;
  }

  void AddMarkers(const SimulatedSample& simulated, const Sample& sample) {
    for (Eigen::Index m = 0; m < sample.count.size(); ++m) {
      if (sample.count[m] == 0) continue;
      Add((simulated.markers_m().col(m) - sample.position_m.col(m)).norm());
    }
  }

  void AddCloud(const ShapesInTime& shapes, std::size_t s) {
    const auto r = static_cast<std::size_t>(telling_.samples[s].recording);
    const Eigen::Isometry3d T_robot_camera = telling_.recordings[r].T_camera_robot->inverse();
    for (const SeenCloud& seen : clouds_[s]) {
      surface_.Refit(shapes.At(seen.frame.t_s, shapes.nodes_m).cast<double>());
      const Eigen::Index step = std::max<Eigen::Index>(1, seen.cloud.points_m.cols() / kPoints);
      for (Eigen::Index k = 0; k < seen.cloud.points_m.cols(); k += step) {
        Add(surface_.Closest(T_robot_camera * seen.cloud.points_m.col(k).cast<double>())
                .distance_m);
      }
    }
  }

  const ObservedExperiment& telling_;
  std::deque<ObservedExperiment> alone_;  ///< by sample; referred to by its simulator
  std::deque<Simulator> simulators_;
  geometry::SurfaceIndex surface_;
  SurfaceClouds clouds_;
  std::vector<Eigen::VectorXd> shapes_m_;  ///< [samples] of the robot that was simulated last
  double worst_m2_ = 0.0;
  double sum_m2_ = 0.0;
  double count_ = 0.0;
  double count_of_all_ = std::numeric_limits<double>::infinity();  ///< not known before the first
};

}  // namespace

NearestRobot FindNearestRobot(const robot::RobotBody& body, const ObservedExperiment& observed,
                              int threads, SurfaceSource* source) {
  NearestRobot nearest{.hypothesis = NominalHypothesis(body, observed)};
  const ModelHypothesis as_in_file = nearest.hypothesis;
  const ObservedExperiment telling = OfMostDriven(observed, body, source != nullptr);
  Distance distance(body, telling, threads, source, as_in_file);
  const auto begin = std::chrono::steady_clock::now();
  const double as_in_file_m2 = distance.MeanSquareOf_m2(as_in_file);
  nearest.sample_s =
      SecondsSince(begin) / std::max(1.0, static_cast<double>(telling.samples.size()));
  const double worst_m2 = distance.WorstMeanSquare_m2();
  if (worst_m2 < kNear * distance.BetweenMostAlike_m2()) return nearest;
  double least_m2 = kClearlyLess * as_in_file_m2;
  std::vector<FaultModelPtr> far_off;
  MakeSwappedCables({.body = body, .observed = telling}, &far_off);
  MakeSwappedTubes({.body = body, .observed = telling}, &far_off);
  MakeBlockedValve({.body = body, .observed = telling}, &far_off);
  for (const FaultModelPtr& fault : far_off) {
    ModelHypothesis hypothesis = as_in_file;
    fault->Apply(Eigen::VectorXd::Ones(1), &hypothesis);
    const double mean_m2 = distance.MeanSquareOf_m2(hypothesis, least_m2);
    if (!(mean_m2 < least_m2)) continue;
    least_m2 = mean_m2;
    nearest.hypothesis = std::move(hypothesis);
    nearest.fault = LikelyFault{fault->name(), fault->Start()};
  }
  return nearest;
}

}  // namespace palpate::diagnosis
