// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/sensing_frames.hpp"

#include <algorithm>
#include <ctime>
#include <numeric>
#include <string>
#include <utility>

#include "components/force_estimation/shape/shape_force_estimator.hpp"
#include "libs/core/error.hpp"
#include "libs/core/statistics.hpp"
#include "libs/robot/robot_body.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/sensing/accuracy.hpp"

namespace palpate::benchmarks {

namespace {

using force_estimation::ForceEstimate;
using force_estimation::ShapeForceEstimator;
using force_estimation::ShapeFrame;

constexpr int kUntouchedFrames = 20;
constexpr double kPeriod_s = 1.0 / 30.0;
/// In which a contact that jumped must be found, and after which it is forgotten.
constexpr int kSettleFrames = 10;
/// Six must be matched, and the camera sees some 60 % of them.
constexpr int kFewestFeaturePoints = 12;
constexpr int kContactsOfCosts = 4;
constexpr int kRestBeforeJump = 5;

double ThreadTime_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

robot::RobotBody BodyWith(int feature_points) {
  robot::RobotDescription robot = test_support::FourLegRobot();
  robot.feature_point_count = feature_points;
  return robot::BuildRobotBody(robot);
}

/// The estimator of palpate-force-estimation with its defaults; frames get stamps that follow one
/// another, in whatever order they are shown.
class Watcher {
 public:
  explicit Watcher(int feature_points)
      : model_(BodyWith(feature_points)),
        estimator_(model_, force_estimation::Config(), force_estimation::ShapeConfig()) {}

  const ForceEstimate& See(const ShapeFrame& frame) {
    seen_ = frame;
    seen_.t_s = kPeriod_s * static_cast<double>(frames_++);
    const double begin_ms = ThreadTime_ms();
    const ForceEstimate& estimate = estimator_.Update(seen_);
    last_ms_ = ThreadTime_ms() - begin_ms;
    estimator_.PrepareNext();
    last_after_ms_ = ThreadTime_ms() - begin_ms - last_ms_;
    return estimate;
  }
  double last_ms() const { return last_ms_; }              ///< of processor time, for the estimate
  double last_after_ms() const { return last_after_ms_; }  ///< to prepare the next one

 private:
  robot::RobotModel model_;
  ShapeForceEstimator estimator_;
  ShapeFrame seen_;
  long frames_ = 0;
  double last_ms_ = 0.0;
  double last_after_ms_ = 0.0;
};

bool IsEstimate(const ForceEstimate& estimate) {
  return estimate.status.ok() || estimate.status.code() == StatusCode::kNoContact;
}

/// Frames that come again and again once all were seen.
class Replay {
 public:
  /// `again`: where it begins again.
  Replay(std::vector<PhaseFrame> frames, std::size_t again, int feature_points)
      : frames_(std::move(frames)), again_(again), watcher_(feature_points) {
    while (next_ < again_) watcher_.See(frames_[next_++].frame);
    TakeFrame();
  }

  void TakeFrame() {
    const ForceEstimate& estimate = watcher_.See(frames_[next_].frame);
    if (!IsEstimate(estimate)) {
      throw RunError("the frame was not used: " + estimate.status.message());
    }
    if (++next_ == frames_.size()) next_ = again_;
  }

 private:
  std::vector<PhaseFrame> frames_;
  std::size_t again_;
  Watcher watcher_;
  std::size_t next_ = 0;
};

Benchmark OfReplay(const std::string& name, const std::function<std::unique_ptr<Replay>()>& make) {
  const auto replay = MakeLazy<Replay>(make);
  return {.name = "sensing/" + name,
          .measure =
              [replay](benchmark::State& state) {
                Replay& frames = replay->Get();
                for ([[maybe_unused]] auto iteration : state) frames.TakeFrame();
              },
          .max_repetitions = 300};
}

Benchmark OfFrames(const SharedSets& sets, int feature_points) {
  return OfReplay("estimate_" + std::to_string(feature_points) + "_points", [=] {
    return std::make_unique<Replay>(sets->Get().Frames(kUntouchedFrames, 1), kUntouchedFrames,
                                    feature_points);
  });
}

/// Of frames of one kind.
struct Costs {
  std::vector<double> time_ms;
  std::vector<double> after_ms;  ///< to prepare the next frame, once the estimate is out
  double linearisations = 0.0;

  void Add(const Watcher& watcher, const ForceEstimate& estimate) {
    time_ms.push_back(watcher.last_ms());
    after_ms.push_back(watcher.last_after_ms());
    linearisations += estimate.iterations;
  }
  void Tell(benchmark::State& state, const std::string& kind) const {
    const auto count = static_cast<double>(std::max<std::size_t>(1, time_ms.size()));
    const auto mean = [&](const std::vector<double>& values) {
      return std::accumulate(values.begin(), values.end(), 0.0) / count;
    };
    state.counters[kind + "_median_ms"] = Median(time_ms);
    state.counters[kind + "_mean_ms"] = mean(time_ms);
    state.counters[kind + "_p99_ms"] = Quantile(time_ms, 0.99);
    state.counters[kind + "_after_mean_ms"] = mean(after_ms);
    state.counters[kind + "_worst_ms"] = *std::max_element(time_ms.begin(), time_ms.end());
    state.counters[kind + "_linearisations"] = linearisations / count;
  }
};

/// Of the frames with a contact that is held.
Costs HeldCosts(const std::vector<PhaseFrame>& frames, int feature_points) {
  Watcher watcher(feature_points);
  Costs held;
  for (const PhaseFrame& frame : frames) {
    const ForceEstimate& estimate = watcher.See(frame.frame);
    if (frame.phase == Phase::kHeld) held.Add(watcher, estimate);
  }
  return held;
}

/// All frames in their order; then each contact once more, all at once.
void MeasureCosts(benchmark::State& state, const std::vector<PhaseFrame>& frames) {
  Watcher watcher(51);
  Costs held, moving, jump;
  std::vector<double> frames_to_estimate;
  for (const PhaseFrame& frame : frames) {
    const ForceEstimate& estimate = watcher.See(frame.frame);
    if (frame.phase == Phase::kHeld) held.Add(watcher, estimate);
    if (frame.phase == Phase::kMoving) moving.Add(watcher, estimate);
  }
  ShapeFrame rest = frames.front().frame;
  rest.untouched = false;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (frames[k].phase != Phase::kHeld || frames[k - 1].phase == Phase::kHeld) continue;
    for (int r = 0; r < kRestBeforeJump; ++r) watcher.See(rest);
    bool found = false;
    for (std::size_t f = k; f < k + kSettleFrames && !found; ++f) {
      const ForceEstimate& estimate = watcher.See(frames[f].frame);
      jump.Add(watcher, estimate);
      found = estimate.status.ok();
      if (found) frames_to_estimate.push_back(static_cast<double>(f - k + 1));
    }
    for (int r = 0; r < kSettleFrames; ++r) watcher.See(rest);
  }
  held.Tell(state, "held");
  HeldCosts(frames, kFewestFeaturePoints).Tell(state, "held_few_points");
  state.counters["held_ratio"] =
      state.counters["held_median_ms"] / state.counters["held_few_points_median_ms"];
  moving.Tell(state, "moving");
  jump.Tell(state, "jump");
  state.counters["jump_frames_to_estimate"] = Median(frames_to_estimate);
  state.counters["jumps_without_estimate"] =
      kContactsOfCosts - static_cast<double>(frames_to_estimate.size());
}

Benchmark OfCosts(const SharedSets& sets) {
  return {.name = "sensing/frame_costs",
          .measure =
              [sets](benchmark::State& state) {
                const std::vector<PhaseFrame> frames =
                    sets->Get().Frames(kUntouchedFrames, kContactsOfCosts);
                for ([[maybe_unused]] auto iteration : state) MeasureCosts(state, frames);
              },
          .max_repetitions = 1};
}

}  // namespace

std::vector<Block> FrameBlocks(const SharedSets& sets) {
  const std::string robot = "force estimation from depth images, four_leg_tet10: ";
  return {{.heading = robot + "one frame of the estimator",
           .benchmarks = {OfFrames(sets, 51), OfFrames(sets, 15)}},
          {.heading = robot + "all frames of four contacts (what they cost: below)",
           .benchmarks = {OfCosts(sets)}}};
}

}  // namespace palpate::benchmarks
