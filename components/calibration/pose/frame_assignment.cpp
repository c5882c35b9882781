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

struct Picture {
  std::size_t frame = 0;
  Eigen::Matrix3Xd points_m;
  double spread_m = 0.0;  ///< RMS distance from their middle
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

Picture Look(const MarkerShapes& shapes, const UnlabelledFrame& frame, double model_sigma_m) {
  Picture picture;
  picture.points_m = PositionsOf(frame.points);
  picture.assignment = AssignMarkers(shapes, picture.points_m, SettingsFor(frame, model_sigma_m));
  if (picture.points_m.cols() > 0) {
    const Eigen::Vector3d middle_m = picture.points_m.rowwise().mean();
    const auto off_m = picture.points_m.colwise() - middle_m;
    picture.spread_m = std::sqrt(off_m.colwise().squaredNorm().mean());
  }
  return picture;
}

/// Where no picture can be the robot's: whether the one with most points is that of a larger or a
/// smaller one.
std::optional<SizeComparison> SizeOfFullest(const MarkerShapes& shapes,
                                            const std::vector<UnlabelledFrame>& frames,
                                            double model_sigma_m) {
  const auto fullest = std::max_element(frames.begin(), frames.end(), [](auto& a, auto& b) {
    return a.points.size() < b.points.size();
  });
  if (fullest == frames.end()) return std::nullopt;
  return FindOtherSize(shapes, PositionsOf(fullest->points), SettingsFor(*fullest, model_sigma_m));
}

/// RMS distance between where two poses take a picture's points.
double Distance_m(const Picture& picture, const RigidTransform& one, const RigidTransform& other) {
  const Eigen::Matrix3Xd off_m = one.Apply(picture.points_m) - other.Apply(picture.points_m);
  return std::sqrt(off_m.colwise().squaredNorm().mean());
}

const AssignmentChoice* NearestTo(const RigidTransform& pose, const Picture& picture) {
  const AssignmentChoice* nearest = nullptr;
  double least_m = kSamePoseShare * picture.spread_m;
  for (const AssignmentChoice& choice : picture.assignment.choices) {
    const double distance_m = Distance_m(picture, pose, choice.T_robot_camera);
    if (distance_m > least_m) continue;
    least_m = distance_m;
    nearest = &choice;
  }
  return nearest;
}

FrameLabels Follow(const RigidTransform& pose, const std::vector<Picture>& pictures) {
  FrameLabels labels{.T_robot_camera = pose, .frames = {}, .marker_of_point = {}, .tension_N = {}};
  for (const Picture& picture : pictures) {
    const AssignmentChoice* choice = NearestTo(pose, picture);
    if (choice == nullptr) continue;
    labels.frames.push_back(picture.frame);
    labels.marker_of_point.push_back(choice->marker_of_point);
    labels.tension_N.push_back(choice->tension_N);
  }
  return labels;
}

/// One for each camera pose that any picture suggests.
std::vector<FrameLabels> LabelChoices(const std::vector<Picture>& pictures) {
  std::vector<FrameLabels> choices;
  for (const Picture& picture : pictures) {
    for (const AssignmentChoice& choice : picture.assignment.choices) {
      const bool known = std::any_of(choices.begin(), choices.end(), [&](const auto& other) {
        return Distance_m(picture, choice.T_robot_camera, other.T_robot_camera) <=
               kSamePoseShare * picture.spread_m;
      });
      if (!known) choices.push_back(Follow(choice.T_robot_camera, pictures));
    }
  }
  return choices;
}

/// Leaves those that most pictures agree with, and of them the one nearest to the rough pose.
void Narrow(const std::vector<Picture>& pictures, const RigidTransform* T_rough,
            std::vector<FrameLabels>* choices) {
  std::size_t most = 0;
  for (const FrameLabels& choice : *choices) most = std::max(most, choice.frames.size());
  std::erase_if(*choices, [&](const auto& choice) { return choice.frames.size() < most; });
  if (T_rough == nullptr || choices->empty()) return;
  const auto off = [&](const FrameLabels& choice) {
    return Distance_m(pictures.front(), choice.T_robot_camera, *T_rough);
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
  result.status = Status(StatusCode::kUnobservable, "no picture");
  std::vector<Picture> pictures;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    Picture picture = Look(shapes, frames[f], model_sigma_m);
    picture.frame = f;
    if (picture.assignment.status.ok() || picture.assignment.ambiguous) {
      pictures.push_back(std::move(picture));
      continue;
    }
    result.status = picture.assignment.status;
    result.left_out.push_back(frames[f].frame.name + ": " + picture.assignment.status.message());
  }
  if (pictures.empty()) {
    if (const auto sizes = SizeOfFullest(shapes, frames, model_sigma_m)) {
      result.status = Status(StatusCode::kInvalidInput, sizes->Text());
    }
    return result;
  }
  result.choices = LabelChoices(pictures);
  Narrow(pictures, T_rough, &result.choices);
  const std::vector<std::size_t>& kept = result.choices.front().frames;
  for (const Picture& picture : pictures) {
    if (std::binary_search(kept.begin(), kept.end(), picture.frame)) continue;
    result.left_out.push_back(frames[picture.frame].frame.name +
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
