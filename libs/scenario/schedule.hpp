// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "libs/scenario/bench_inputs.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::scenario {

/// A time of the bench as recording and time in it.
struct Moment {
  int recording = 0;
  double t_s = 0.0;  ///< in that recording; negative: rest before it
};

/// The scenario's recordings one after the other on the bench's clock, which starts at 0 with the
/// rest before the first: rest_between_s without tools and weights, then the recording. In the
/// first half of a rest the commands go straight to zero, over all of it the base goes to its next
/// tilt.
class Schedule {
 public:
  /// `cables`: names of the robot's actuators (RobotNames::Actuators). Throws InputError for a
  /// command to none of them.
  Schedule(Scenario scenario, std::vector<std::string> cables);

  const Scenario& scenario() const { return scenario_; }
  double Duration_s() const { return starts_s_.back(); }
  /// When the recording begins, its rest being over.
  double Begin_s(int recording) const;

  /// At the end and beyond: the end of the last recording. Begin_s belongs to the recording.
  Moment At(double bench_s) const;
  BenchInputs InputsAt(double bench_s) const;

 private:
  BenchInputs RestBefore(int recording, double done) const;
  BenchInputs During(const RecordingPlan& plan, double t_s) const;
  Eigen::VectorXd Commands(const RecordingPlan& plan, double t_s) const;

  Scenario scenario_;
  std::vector<std::string> cables_;
  std::vector<double> starts_s_;  ///< [recordings + 1] of the rests; the end
};

}  // namespace palpate::scenario
