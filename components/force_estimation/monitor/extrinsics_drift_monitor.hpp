// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "components/force_estimation/monitor/held_motion.hpp"

namespace palpate::force_estimation {

/// Result of the test for a sequence so far.
struct DriftReport {
  enum class State {
    kLearning,  ///< the reference from the start of the sequence is not complete
    kHolds,
    kMoved,    ///< against the reference, or the reference against the calibration
    kNotSeen,  ///< too few frames show the fixed surface lately
  };
  State state = State::kLearning;
  int camera = 0;                          ///< number of the camera
  Motion motion = Motion::Zero();          ///< of the last second
  Motion standard_error = Motion::Zero();  ///< of that
  /// For the user, where the state is kMoved: how far, and what to do.
  std::string advice;
};

/// "learning", "holds", "moved", "not_seen".
std::string ToString(DriftReport::State state);

/// As key-value pairs of /diagnostics: the state, then shift and turn with their standard errors.
void AppendDrift(const DriftReport& report,
                 std::vector<std::pair<std::string, std::string>>* values);

struct ExtrinsicsDriftMonitorTuning {
  double window_s = 1.0;  ///< whose frames are averaged; longer: less noise, later alarms
  int least_frames = 3;   ///< of a window that is evaluated; fewer: noisier windows
  /// Windows of the reference. More: a more exact reference, a later start.
  std::size_t reference_windows = 5;
  std::size_t windows_together = 3;  ///< tested together, too; more: smaller motions, later
  int windows_in_a_row = 2;          ///< until the state changes; more: later alarms, fewer false
  double far_sigmas = 5.0;           ///< of a motion; smaller: more sensitive, more false alarms
  /// Apparent motion at rest, one sigma: a force on the fixed surface itself, moving cables.
  /// Larger: small camera motions pass; smaller: cables cause alarms.
  double rest_turn_rad = 7e-4;
  double rest_shift_m = 2.5e-4;
  /// Error of a valid calibration, one sigma: the smooth error of the depth image. Larger: a worse
  /// calibration passes.
  double calibration_turn_rad = 8e-3;
  double calibration_shift_m = 8e-4;
};

/// Tests whether the camera pose is still that of the calibration: the surface near the fixed
/// region must not move, nor all markers together. Frames of a window give a mean with a covariance
/// from their scatter; the first windows are the reference. The state becomes moved after some
/// windows in a row that, alone or with those before, differ from the reference by more than
/// far_sigmas of both and of the motion at rest, and holds again after as many that do not. It is
/// moved, too, where the reference differs as much from the calibration.
class ExtrinsicsDriftMonitor {
 public:
  /// `what`: subject of the advice.
  explicit ExtrinsicsDriftMonitor(std::string what = "what is held of the body",
                                  const ExtrinsicsDriftMonitorTuning& tuning = {})
      : what_(std::move(what)), tuning_(tuning) {}

  /// `t_s` of the camera's clock; a time before the last one resets the
  /// monitor.
  void Add(double t_s, const MotionSighting& seen);
  const DriftReport& report() const { return report_; }

 private:
  using Matrix = Eigen::Matrix<double, 6, 6>;
  /// Of the frames of one window.
  struct Window {
    double begin_s = 0.0;
    int frames = 0;
    int seen = 0;
    Matrix information = Matrix::Zero();
    Motion pull = Motion::Zero();
    double squares = 0.0;  ///< sum of m' information m
  };
  struct Mean {
    Motion motion = Motion::Zero();
    Matrix covariance = Matrix::Zero();
  };

  static Mean MeanOf(const Window& window);
  static Mean Together(const std::deque<Mean>& means);
  void Close();
  void SetReference();
  void Judge(const Mean& mean);
  bool IsOff(const Mean& mean) const;
  void Say(const Motion& motion, const std::string& since);

  std::string what_;
  ExtrinsicsDriftMonitorTuning tuning_;
  Window window_;
  double last_s_ = 0.0;
  std::deque<Mean> windows_;  ///< the last ones; at first those of the reference
  bool has_reference_ = false;
  Mean reference_;
  bool reference_is_off_ = false;
  int in_a_row_ = 0;  ///< windows that contradict the state
  DriftReport report_;
};

}  // namespace palpate::force_estimation
