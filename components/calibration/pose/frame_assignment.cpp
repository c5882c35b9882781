// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/pose/frame_assignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "components/calibration/pose/other_size.hpp"

namespace palpate::calibration {

namespace {

using geometry::RigidTransform;

struct FramePoints {
  std::size_t frame = 0;
  Eigen::Matrix3Xd points_m;
  double spread_m = 0.0;  ///< RMS distance from their centroid
  MarkerAssignment assignment;
};

double SigmaOf(const UnlabelledFrame& frame, double model_sigma_m) {
  double variance_m2 = 0.0;
  for (const MarkerSighting& point : frame.points) variance_m2 += point.covariance_m2.trace() / 3.0;
  variance_m2 /= std::max<double>(1.0, static_cast<double>(frame.points.size()));
  return std::sqrt(variance_m2 + model_sigma_m * model_sigma_m);
}

AssignmentSettings SettingsFor(const UnlabelledFrame& frame, double model_sigma_m) {
  AssignmentSettings settings;
  if (const double sigma_m = SigmaOf(frame, model_sigma_m); std::isfinite(sigma_m)) {
    settings.sigma_m = sigma_m;
  }
  return settings;
}

FramePoints AssignFrame(const MarkerShapes& shapes, const UnlabelledFrame& frame,
                        double model_sigma_m) {
  FramePoints seen;
  seen.points_m = PositionsOf(frame.points);
  seen.assignment = AssignMarkers(shapes, seen.points_m, SettingsFor(frame, model_sigma_m));
  if (seen.points_m.cols() > 0) {
    const Eigen::Vector3d middle_m = seen.points_m.rowwise().mean();
    const auto off_m = seen.points_m.colwise() - middle_m;
    seen.spread_m = std::sqrt(off_m.colwise().squaredNorm().mean());
  }
  return seen;
}

/// Where no frame has an assignment: the size of the robot in the frame with most points.
std::optional<SizeComparison> SizeOfFullest(const MarkerShapes& shapes,
                                            const std::vector<UnlabelledFrame>& frames,
                                            double model_sigma_m) {
  const auto fullest = std::max_element(frames.begin(), frames.end(), [](auto& a, auto& b) {
    return a.points.size() < b.points.size();
  });
  if (fullest == frames.end()) return std::nullopt;
  return FindOtherSize(shapes, PositionsOf(fullest->points), SettingsFor(*fullest, model_sigma_m));
}

/// RMS distance between the points of a frame under two poses.
double Distance_m(const FramePoints& seen, const RigidTransform& one, const RigidTransform& other) {
  const Eigen::Matrix3Xd off_m = one.Apply(seen.points_m) - other.Apply(seen.points_m);
  return std::sqrt(off_m.colwise().squaredNorm().mean());
}

const AssignmentChoice* NearestTo(const RigidTransform& pose, const FramePoints& seen) {
  const AssignmentChoice* nearest = nullptr;
  double least_m = kSamePoseShare * seen.spread_m;
  for (const AssignmentChoice& choice : seen.assignment.choices) {
    const double distance_m = Distance_m(seen, pose, choice.T_robot_camera);
    if (distance_m > least_m) continue;
    least_m = distance_m;
    nearest = &choice;
  }
  return nearest;
}

FrameLabels Follow(const RigidTransform& pose, const std::vector<FramePoints>& all_seen) {
  FrameLabels labels{.T_robot_camera = pose, .frames = {}, .marker_of_point = {}, .tension_N = {}};
  for (const FramePoints& seen : all_seen) {
    const AssignmentChoice* choice = NearestTo(pose, seen);
    if (choice == nullptr) continue;
    labels.frames.push_back(seen.frame);
    labels.marker_of_point.push_back(choice->marker_of_point);
    labels.tension_N.push_back(choice->tension_N);
  }
  return labels;
}

/// One for each camera pose of any frame.
std::vector<FrameLabels> LabelChoices(const std::vector<FramePoints>& all_seen) {
  std::vector<FrameLabels> choices;
  for (const FramePoints& seen : all_seen) {
    for (const AssignmentChoice& choice : seen.assignment.choices) {
      const bool known = std::any_of(choices.begin(), choices.end(), [&](const auto& other) {
        return Distance_m(seen, choice.T_robot_camera, other.T_robot_camera) <=
               kSamePoseShare * seen.spread_m;
      });
      if (!known) choices.push_back(Follow(choice.T_robot_camera, all_seen));
    }
  }
  return choices;
}

/// Keeps the choices that most frames agree with, or the one of them nearest to the rough pose.
void Narrow(const std::vector<FramePoints>& all_seen, const RigidTransform* T_rough,
            std::vector<FrameLabels>* choices) {
  std::size_t most = 0;
  for (const FrameLabels& choice : *choices) most = std::max(most, choice.frames.size());
  std::erase_if(*choices, [&](const auto& choice) { return choice.frames.size() < most; });
  if (T_rough == nullptr || choices->empty()) return;
  const auto off = [&](const FrameLabels& choice) {
    return Distance_m(all_seen.front(), choice.T_robot_camera, *T_rough);
  };
  const auto nearest =
      std::min_element(choices->begin(), choices->end(),
                       [&](const auto& a, const auto& b) { return off(a) < off(b); });
  *choices = std::vector<FrameLabels>{*nearest};
}

}  // namespace

FrameAssignment AssignFrames(const MarkerShapes& shapes, const std::vector<UnlabelledFrame>& frames,
                             const RigidTransform* T_rough, double model_sigma_m) {
  FrameAssignment result;
  result.status = Status(StatusCode::kUnobservable, "no frame");
  std::vector<FramePoints> all_seen;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    FramePoints seen = AssignFrame(shapes, frames[f], model_sigma_m);
    seen.frame = f;
    if (seen.assignment.status.ok() || seen.assignment.ambiguous) {
      all_seen.push_back(std::move(seen));
      continue;
    }
    result.status = seen.assignment.status;
    result.left_out.push_back(frames[f].frame.name + ": " + seen.assignment.status.message());
  }
  if (all_seen.empty()) {
    if (const auto sizes = SizeOfFullest(shapes, frames, model_sigma_m)) {
      result.status = Status(StatusCode::kInvalidInput, sizes->Text());
    }
    return result;
  }
  result.choices = LabelChoices(all_seen);
  Narrow(all_seen, T_rough, &result.choices);
  const std::vector<std::size_t>& kept = result.choices.front().frames;
  for (const FramePoints& seen : all_seen) {
    if (std::binary_search(kept.begin(), kept.end(), seen.frame)) continue;
    result.left_out.push_back(frames[seen.frame].frame.name +
                              ": its points need another camera pose than the others'");
  }
  result.status = Status::Ok();
  return result;
}

std::vector<CalibrationFrame> LabelledFrames(const std::vector<UnlabelledFrame>& frames,
                                             const FrameLabels& labels) {
  std::vector<CalibrationFrame> labelled;
  for (std::size_t k = 0; k < labels.frames.size(); ++k) {
    const UnlabelledFrame& source = frames[labels.frames[k]];
    CalibrationFrame& frame = labelled.emplace_back(source.frame);
    for (std::size_t p = 0; p < source.points.size(); ++p) {
      if (labels.marker_of_point[k][p] < 0) continue;
      frame.markers.push_back(source.points[p]);
      frame.markers.back().marker = labels.marker_of_point[k][p];
    }
  }
  return labelled;
}

}  // namespace palpate::calibration
