// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/monitor/extrinsics_drift_monitor.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "libs/core/text.hpp"

namespace palpate::force_estimation {

namespace {

using State = DriftReport::State;

Eigen::Matrix<double, 6, 6> Allowance(double turn_rad, double shift_m) {
  Motion sigma;
  sigma << Eigen::Vector3d::Constant(turn_rad), Eigen::Vector3d::Constant(shift_m);
  return sigma.cwiseAbs2().asDiagonal();
}

bool IsFar(const Motion& motion, const Eigen::Matrix<double, 6, 6>& covariance, double sigmas) {
  return motion.dot(Eigen::LDLT<Eigen::Matrix<double, 6, 6>>(covariance).solve(motion)) >
         sigmas * sigmas;
}

}  // namespace

std::string ToString(State state) {
  switch (state) {
    case State::kLearning: return "learning";
    case State::kHolds: return "holds";
    case State::kMoved: return "moved";
    case State::kNotSeen: return "not_seen";
  }
  return {};
}

void AppendDrift(const DriftReport& report,
                 std::vector<std::pair<std::string, std::string>>* values) {
  const auto text = [](const Eigen::Vector3d& vector) {
    return FormatNumber(vector.x()) + " " + FormatNumber(vector.y()) + " " +
           FormatNumber(vector.z());
  };
  values->emplace_back("drift", ToString(report.state));
  values->emplace_back("drift_shift_m", text(report.motion.tail<3>()));
  values->emplace_back("drift_shift_error_m", text(report.standard_error.tail<3>()));
  values->emplace_back("drift_turn_rad", text(report.motion.head<3>()));
  values->emplace_back("drift_turn_error_rad", text(report.standard_error.head<3>()));
}

void ExtrinsicsDriftMonitor::Add(double t_s, const MotionSighting& seen) {
  if (t_s < last_s_) *this = ExtrinsicsDriftMonitor(what_, tuning_);
  last_s_ = t_s;
  if (window_.frames == 0) window_.begin_s = t_s;
  if (t_s - window_.begin_s >= tuning_.window_s) {
    Close();
    window_ = {.begin_s = t_s};
  }
  ++window_.frames;
  if (seen.information.isZero()) return;
  ++window_.seen;
  const Motion pull = seen.information * seen.motion;
  window_.information += seen.information;
  window_.pull += pull;
  window_.squares += seen.motion.dot(pull);
}

/// The weighted mean; its covariance grows where frames scatter by more than their information.
ExtrinsicsDriftMonitor::Mean ExtrinsicsDriftMonitor::MeanOf(const Window& window) {
  Mean mean;
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factor(window.information);
  mean.motion = factor.solve(window.pull);
  const double scatter = window.squares - mean.motion.dot(window.pull);
  const double excess = std::max(1.0, scatter / (6.0 * (window.seen - 1)));
  mean.covariance = excess * factor.solve(Matrix::Identity());
  return mean;
}

ExtrinsicsDriftMonitor::Mean ExtrinsicsDriftMonitor::Together(const std::deque<Mean>& means) {
  Matrix information = Matrix::Zero();
  Motion pull = Motion::Zero();
  for (const Mean& mean : means) {
    const Matrix of_one =
        Eigen::LDLT<Eigen::Matrix<double, 6, 6>>(mean.covariance).solve(Matrix::Identity());
    information += of_one;
    pull += of_one * mean.motion;
  }
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factor(information);
  return {factor.solve(pull), factor.solve(Matrix::Identity())};
}

void ExtrinsicsDriftMonitor::Close() {
  if (window_.seen < tuning_.least_frames) {
    if (report_.state == State::kHolds) report_.state = State::kNotSeen;
    return;
  }
  const Mean mean = MeanOf(window_);
  report_.motion = mean.motion;
  report_.standard_error = mean.covariance.diagonal().cwiseSqrt();
  windows_.push_back(mean);
  if (has_reference_) {
    Judge(mean);
  } else if (windows_.size() == tuning_.reference_windows) {
    SetReference();
  }
}

void ExtrinsicsDriftMonitor::SetReference() {
  has_reference_ = true;
  reference_ = Together(windows_);
  windows_.clear();
  reference_is_off_ = IsFar(
      reference_.motion,
      reference_.covariance + Allowance(tuning_.calibration_turn_rad, tuning_.calibration_shift_m),
      tuning_.far_sigmas);
  report_.state = reference_is_off_ ? State::kMoved : State::kHolds;
  if (reference_is_off_) Say(reference_.motion, "from where the calibration has it");
}

bool ExtrinsicsDriftMonitor::IsOff(const Mean& mean) const {
  return IsFar(mean.motion - reference_.motion,
               mean.covariance + reference_.covariance +
                   Allowance(tuning_.rest_turn_rad, tuning_.rest_shift_m),
               tuning_.far_sigmas);
}

void ExtrinsicsDriftMonitor::Judge(const Mean& mean) {
  if (windows_.size() > tuning_.windows_together) windows_.pop_front();
  const bool far =
      IsOff(mean) || (windows_.size() == tuning_.windows_together && IsOff(Together(windows_)));
  if (report_.state == State::kNotSeen) report_.state = State::kHolds;
  if (reference_is_off_ && !far) return;
  const bool is_moved = report_.state == State::kMoved;
  in_a_row_ = far != is_moved ? in_a_row_ + 1 : 0;
  if (in_a_row_ == tuning_.windows_in_a_row) {
    in_a_row_ = 0;
    report_.state = far ? State::kMoved : State::kHolds;
    report_.advice.clear();
  }
  if (far && report_.state == State::kMoved)
    Say(mean.motion - reference_.motion, "since the start");
}

void ExtrinsicsDriftMonitor::Say(const Motion& motion, const std::string& since) {
  const double turn_deg = motion.head<3>().norm() * 180.0 / std::numbers::pi;
  const double shift_mm = 1e3 * motion.tail<3>().norm();
  report_.advice = what_ + " seems shifted by " +
                   FormatNumber(std::round(100.0 * shift_mm) / 100.0) + " mm and turned by " +
                   FormatNumber(std::round(100.0 * turn_deg) / 100.0) + " degrees " + since +
                   ": camera or base moved, calibrate again";
}

}  // namespace palpate::force_estimation
