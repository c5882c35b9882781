// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/virtual_robot_bench.hpp"

#include <cmath>
#include <memory>
#include <numbers>

#include "components/virtual_robot/virtual_robot.hpp"
#include "tests/benchmarks/lazy.hpp"
#include "tests/support/robots.hpp"

namespace palpate::benchmarks {

namespace {

constexpr double kFrame_s = 1.0 / 30.0;
constexpr int kFramesPerPress = 60;  // down for a second, up for a second

struct BodyKind {
  const char* name;
  const char* element;
  int refine;
};

scenario::Scenario MakeScenario(const BodyKind& kind, scenario::MotionMode mode) {
  scenario::Scenario scenario;
  scenario.body.element = kind.element;
  scenario.body.refine = kind.refine;
  scenario.motion.mode = mode;
  scenario.motion.time_step_s = kFrame_s;
  scenario::Tool& ball = scenario.tools.emplace_back();
  ball.name = "ball";
  ball.radius_m = 0.008;
  ball.friction_coefficient = 0.5;
  scenario.recordings.resize(1);
  return scenario;
}

/// The bench, and where in its motion it is.
class PressedRobot {
 public:
  PressedRobot(const BodyKind& kind, scenario::MotionMode mode)
      : robot_(test_support::FourLegRobot(), MakeScenario(kind, mode), {}, 1),
        status_(robot_.Start(0.0, InputsOf(0))) {}

  /// The next frame; false: it failed.
  bool Advance() {
    ++frame_;
    status_ = robot_.Advance(frame_ * kFrame_s, InputsOf(frame_));
    return status_.ok();
  }
  const Status& status() const { return status_; }

 private:
  /// The hub's top is at z = 125 mm; the ball goes from 1 mm above it to 8 mm into it.
  static virtual_robot::Inputs InputsOf(int frame) {
    const double turn = 2.0 * std::numbers::pi * frame / kFramesPerPress;
    const double share = 0.5 * (1.0 - std::cos(turn));
    virtual_robot::Inputs inputs;
    inputs.displacement_m = Eigen::Vector4d(0.004 * share, 0.0, 0.0, 0.003 * share);
    inputs.tools.resize(1);
    inputs.tools[0].tool = "ball";
    inputs.tools[0].T_robot_tool.translation() = Eigen::Vector3d(0.0, 0.0, 0.134 - 0.009 * share);
    return inputs;
  }

  virtual_robot::VirtualRobot robot_;
  Status status_;
  int frame_ = 0;
};

Benchmark MakeBenchmark(const BodyKind& kind, scenario::MotionMode mode) {
  const auto robot =
      MakeLazy<PressedRobot>([kind, mode] { return std::make_unique<PressedRobot>(kind, mode); });
  const bool dynamic = mode == scenario::MotionMode::kDynamic;
  return {.name = std::string("virtual_robot/") + kind.name + (dynamic ? "_dynamic" : "_static"),
          .measure =
              [robot](benchmark::State& state) {
                for ([[maybe_unused]] auto iteration : state) {
                  if (!robot->Get().Advance()) {
                    state.SkipWithError(robot->Get().status().message().c_str());
                  }
                }
              },
          .max_repetitions = 2 * kFramesPerPress};
}

}  // namespace

Block VirtualRobotBlock() {
  Block block{.heading = "virtual robot, a frame of 1/30 s of four_leg, pressed by a ball",
              .benchmarks = {}};
  for (const BodyKind& kind : {BodyKind{"tet4", "tet4", 0}, BodyKind{"tet4_refined", "tet4", 1},
                               BodyKind{"tet10", "tet10", 0}}) {
    block.benchmarks.push_back(MakeBenchmark(kind, scenario::MotionMode::kQuasiStatic));
    block.benchmarks.push_back(MakeBenchmark(kind, scenario::MotionMode::kDynamic));
  }
  return block;
}

}  // namespace palpate::benchmarks
