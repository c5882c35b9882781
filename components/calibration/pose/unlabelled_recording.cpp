// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/pose/unlabelled_recording.hpp"

#include <algorithm>
#include <optional>

#include "components/calibration/pose/assignment_hypotheses.hpp"
#include "components/calibration/recording_phase.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/recording_inputs.hpp"

namespace palpate::calibration {

namespace {

using Eigen::Index;
using experiment::TimeWindow;

/// Rounding of the file bounds the accuracy of a mean.
constexpr double kLeastVariance_m2 = 1e-14;

Eigen::Matrix3Xd PointsOf(const experiment::MarkerFrame& frame) {
  Eigen::Matrix3Xd points_m(3, static_cast<Index>(frame.positions_m.size()));
  Index count = 0;
  for (const std::optional<Eigen::Vector3d>& position_m : frame.positions_m) {
    if (position_m) points_m.col(count++) = *position_m;
  }
  return points_m.leftCols(count);
}

/// Means over time of the points of one time.
struct Means {
  explicit Means(const Eigen::Matrix3Xd& points)
      : first_m(points),
        sum_m(Eigen::Matrix3Xd::Zero(3, points.cols())),
        squares_m2(sum_m),
        count(Eigen::VectorXd::Zero(points.cols())) {}

  void Add(const Eigen::Matrix3Xd& points_m) {
    const std::vector<int> of_point = MatchNearest(points_m, first_m, kStillMarker_m);
    for (Index p = 0; p < points_m.cols(); ++p) {
      const int mean = of_point[palpate::At(p)];
      if (mean < 0) continue;
      const Eigen::Vector3d off_m = points_m.col(p) - first_m.col(mean);
      sum_m.col(mean) += off_m;
      squares_m2.col(mean) += off_m.cwiseAbs2();
      count[mean] += 1.0;
    }
  }

  MarkerSighting At(Index point, const Eigen::Vector3d& sigma_m, double marker_bias_m) const {
    const double n = count[point];
    const Eigen::Vector3d mean_m = sum_m.col(point) / n;
    Eigen::Vector3d noise_m2 = sigma_m.cwiseAbs2();
    if (n > 2.0) {
      const Eigen::Vector3d seen_m2 = (squares_m2.col(point) - n * mean_m.cwiseAbs2()) / (n - 1.0);
      noise_m2 = noise_m2.cwiseMax(seen_m2);
    }
    const Eigen::Vector3d variance_m2 =
        (noise_m2 / n).array() + marker_bias_m * marker_bias_m + kLeastVariance_m2;
    return {.marker = -1,
            .position_m = first_m.col(point) + mean_m,
            .covariance_m2 = variance_m2.asDiagonal()};
  }

  Eigen::Matrix3Xd first_m, sum_m, squares_m2;
  Eigen::VectorXd count;
};

std::vector<MarkerSighting> PointsIn(const experiment::Recording& recording,
                                     const TimeWindow& window, const Eigen::Vector3d& sigma_m,
                                     double marker_bias_m) {
  std::vector<Eigen::Matrix3Xd> times;
  for (const experiment::MarkerFrame& frame : recording.markers->frames) {
    if (window.Contains(frame.t_s)) times.push_back(PointsOf(frame));
  }
  const auto fullest = std::max_element(
      times.begin(), times.end(), [](const auto& a, const auto& b) { return a.cols() < b.cols(); });
  if (fullest == times.end()) return {};
  Means means(*fullest);
  for (const Eigen::Matrix3Xd& points_m : times) means.Add(points_m);
  std::vector<MarkerSighting> points;
  for (Index p = 0; p < means.first_m.cols(); ++p) {
    points.push_back(means.At(p, sigma_m, marker_bias_m));
  }
  return points;
}

}  // namespace

std::vector<UnlabelledFrame> UnlabelledFramesOfRecording(const experiment::Experiment& experiment,
                                                         const experiment::Recording& recording,
                                                         const robot::RobotModel& model,
                                                         robot::CableInput preferred,
                                                         double marker_bias_m, int most_frames) {
  experiment::RequireMarkers(recording);
  experiment::CheckActuators(recording, model.CableNames(), model.ChamberNames());
  const Eigen::Vector3d sigma_m = experiment.markers_sigma_m.value_or(Eigen::Vector3d::Zero());
  const std::vector<TimeWindow> windows = WindowsOf(recording, most_frames);
  std::vector<UnlabelledFrame> frames;
  for (const TimeWindow& window : windows) {
    const double middle_s = 0.5 * (window.begin_s + window.end_s);
    UnlabelledFrame one{.frame = {.name = windows.size() == 1 ? recording.name
                                                              : recording.name + " at " +
                                                                    FormatNumber(middle_s) + " s",
                                  .cables = CablesAt(recording, model, preferred, middle_s),
                                  .loads = LoadsAt(recording, model, middle_s),
                                  .load_places = LoadPlacesAt(recording, middle_s),
                                  .gravity_m_s2 = experiment::BaseRotation(recording).transpose() *
                                                  model.gravity_m_s2()},
                        .points = PointsIn(recording, window, sigma_m, marker_bias_m)};
    if (!one.points.empty()) frames.push_back(std::move(one));
  }
  if (frames.empty()) throw InputError(recording.folder.string() + ": no point was seen");
  return frames;
}

}  // namespace palpate::calibration
