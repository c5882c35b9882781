// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/model/model_segmenter.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "components/perception/model/background_planes.hpp"
#include "components/perception/model/cloud_builder.hpp"
#include "components/perception/model/disagreement.hpp"
#include "components/perception/model/pixel_classifier.hpp"
#include "components/perception/model/prediction_view.hpp"
#include "components/perception/noise_law.hpp"
#include "components/perception/registered_frame.hpp"
#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"

namespace palpate::perception {

/// State of one camera.
struct ModelSegmenter::Parts {
  Parts(const Config& settings, const rgbd::RgbdCamera& camera, const NoiseLaw& noise_law,
        const ModelSegmenterTuning& segmenter_tuning);

  void TakeRange();
  void ReadRegion(const rgbd::RgbdFrame& raw);
  void UpdateBackground(bool predicted);
  Status ExplainNothingInRange(const rgbd::RgbdFrame& raw, const PredictedSurface* predicted);
  void FitPrediction(const PredictedSurface& predicted, PredictionView::Fitting fitting);
  Status SegmentByPrediction(const rgbd::RgbdFrame& raw, const PredictedSurface& predicted);
  Status SegmentByColor(const rgbd::RgbdFrame& raw);
  bool ColorKnown(int u, int v) const;
  ColorModel::Histogram ColorsNearPrediction() const;
  bool ColorsHold();
  void SetLabels(float robot_from);
  void DropSpecks(std::int64_t least_robot_px);
  void DropFarObjects();
  void BuildClouds();

  Config config;
  ModelSegmenterTuning tuning;
  NoiseLaw noise;
  Registration registration;
  RegisteredFrame frame;
  PredictionView prediction;
  BackgroundPlanes background;
  BackgroundPlanes::Tolerance tolerance;
  PixelClassifier classifier;
  PixelRegion region;
  EvidenceFilter filter;
  Patches patches;
  CloudBuilder builder;
  std::vector<Eigen::Vector3f> sparse_m;
  std::vector<Eigen::Vector3f> robot_m;
  SampleGrid color_sites;
  SegmentedFrame result;
  bool begins = true;  ///< a sequence, with the next frame
  std::optional<PredictedSurface> first_predicted;
  std::optional<PredictedSurface> fitted;  ///< the prediction, to this frame
};

ModelSegmenter::Parts::Parts(const Config& settings, const rgbd::RgbdCamera& camera,
                             const NoiseLaw& noise_law,
                             const ModelSegmenterTuning& segmenter_tuning)
    : config{settings},
      tuning{segmenter_tuning},
      noise{noise_law},
      registration{camera},
      prediction{camera, settings.model},
      tolerance{.noise = noise_law, .bias = static_cast<float>(settings.model.background_bias)},
      classifier{settings, noise_law},
      builder{NoiseOf(settings), settings.max_cloud_points} {}

/// The paper's PassThrough: 0 for invalid pixels and those out of range.
void ModelSegmenter::Parts::TakeRange() {
  std::int64_t measured = 0;
  std::int64_t kept = 0;
  const auto nearest_m = static_cast<float>(config.min_z_m);
  const auto farthest_m = static_cast<float>(config.max_z_m);
  for (float& z_m : frame.z_m.values) {
    const bool in_range = z_m >= nearest_m && z_m <= farthest_m;
    measured += z_m > 0.0f ? 1 : 0;
    kept += in_range ? 1 : 0;
    z_m = in_range ? z_m : 0.0f;
  }
  result.rejected.invalid_depth = static_cast<std::int64_t>(frame.z_m.values.size()) - measured;
  result.rejected.out_of_range = measured - kept;
}

void ModelSegmenter::Parts::ReadRegion(const rgbd::RgbdFrame& raw) {
  registration.RegisterColor(raw,
                             {.u_begin = region.u_begin,
                              .v_begin = region.v_begin,
                              .u_end = region.u_begin + region.width,
                              .v_end = region.v_begin + region.height},
                             &frame);
  const rgbd::CameraModel& camera = registration.camera().depth;
  const float slope =
      tuning.steepest_slope / static_cast<float>(std::min(camera.fx_px, camera.fy_px));
  for (int row = 0; row < region.height; ++row) {
    const float* z_m = frame.z_m.Pixel(region.u_begin, region.v_begin + row);
    const std::size_t first = region.At(0, row);
    for (std::size_t u = 0; u < static_cast<std::size_t>(region.width); ++u) {
      region.z_m[first + u] = z_m[u];
      region.step_m[first + u] = tuning.step_sigmas * noise.At(z_m[u]) + slope * z_m[u];
    }
  }
}

void ModelSegmenter::Parts::UpdateBackground(bool predicted) {
  sparse_m.clear();
  robot_m.clear();
  for (int v = tuning.background_step_px / 2; v < frame.z_m.height_px;
       v += tuning.background_step_px) {
    for (int u = tuning.background_step_px / 2; u < frame.z_m.width_px;
         u += tuning.background_step_px) {
      const float z_m = *frame.z_m.Pixel(u, v);
      if (z_m <= 0.0f || (predicted && prediction.Covers(u, v))) continue;
      sparse_m.push_back(z_m * registration.Ray(u, v));
    }
  }
  if (predicted) {
    const Eigen::Matrix3Xd& vertices_m = prediction.surface().vertices_m;
    const Eigen::Index step = std::max<Eigen::Index>(1, vertices_m.cols() / tuning.robot_points);
    for (Eigen::Index i = 0; i < vertices_m.cols(); i += step) {
      robot_m.push_back(vertices_m.col(i).cast<float>());
    }
  }
  background.Update(sparse_m, robot_m, tolerance);
}

Status ModelSegmenter::Parts::SegmentByPrediction(const rgbd::RgbdFrame& raw,
                                                  const PredictedSurface& predicted) {
  Status status = prediction.Render(predicted);
  if (!status.ok()) return status;
  prediction.Place(&region);
  ReadRegion(raw);
  UpdateBackground(true);
  const bool has_color = registration.camera().color.width_px > 0;
  const auto mean_z_m = static_cast<float>(prediction.surface().vertices_m.row(2).mean());
  const bool use_colors = has_color && ColorsHold();
  const auto is_foreign = [&](int u, int v, const Eigen::Vector3f& point_m) {
    return background.Holds(point_m, tolerance) ||
           (use_colors && ColorKnown(u, v) &&
            classifier.IsForeign(classifier.BinOf(frame.color.Pixel(u, v))));
  };
  FitPrediction(predicted,
                {is_foreign, classifier.Sigma_m(mean_z_m), config.model.largest_error_m});
  fitted = prediction.WholeSurface();
  prediction.Measure(registration, &region);
  classifier.ClassifyByDistance(registration, background, &region);
  if (const auto pixels = classifier.FindDisagreement(prediction, region)) {
    return Status(StatusCode::kNoRobotSeen,
                  Disagreement(*pixels, MedianDepthRatio(raw, registration, prediction), config));
  }
  const bool classify_colors = has_color && classifier.PrepareColors(frame, region, &result.notes);
  if (classify_colors) classifier.ClassifyByColor(frame, &region);
  filter.Smooth(&region);
  SetLabels(0.0f);
  DropSpecks(tuning.least_patch_px);
  if (classify_colors) classifier.UpdateColors(frame, region);
  return status;
}

Status ModelSegmenter::Parts::ExplainNothingInRange(const rgbd::RgbdFrame& raw,
                                                    const PredictedSurface* predicted) {
  const bool rendered = predicted != nullptr && prediction.Render(*predicted).ok();
  const double ratio = rendered ? MedianDepthRatio(raw, registration, prediction) : std::nan("");
  return Status(StatusCode::kNoRobotSeen, NothingInRange(result.rejected, ratio, config));
}

/// At the start of a sequence, or where points behind the predicted surface contradict it, the
/// robot is searched farther away as well, and from the first prediction: a contact that bent it in
/// the frame before may have ended.
void ModelSegmenter::Parts::FitPrediction(const PredictedSurface& predicted,
                                          PredictionView::Fitting fitting) {
  prediction.FitTo(registration, region, fitting);
  if (!first_predicted) first_predicted = predicted;
  PredictionView::Agreement best = prediction.Agree(registration, region, fitting);
  const double enough = std::exchange(begins, false) ? tuning.first_agreement : tuning.agreement;
  if (best.Share() > enough || best.Share() < tuning.least_agreement) return;
  PredictedSurface found = prediction.WholeSurface();
  const double usual_m = fitting.largest_error_m;
  for (const PredictedSurface& start : {predicted, *first_predicted}) {
    fitting.largest_error_m = tuning.farther * usual_m;
    if (!prediction.Render(start).ok()) continue;
    prediction.FitTo(registration, region, fitting);
    fitting.largest_error_m = usual_m;
    prediction.FitTo(registration, region, fitting);
    const PredictionView::Agreement agreement = prediction.Agree(registration, region, fitting);
    if (agreement.Score() <= best.Score()) continue;
    best = agreement;
    found = prediction.WholeSurface();
  }
  if (prediction.Render(found).ok()) prediction.FitTo(registration, region, fitting);
}

bool ModelSegmenter::Parts::ColorKnown(int u, int v) const {
  return frame.color_known[static_cast<std::size_t>(v) *
                               static_cast<std::size_t>(frame.z_m.width_px) +
                           static_cast<std::size_t>(u)] != 0;
}

/// Pixels of each colour whose point is near the predicted surface.
ColorModel::Histogram ModelSegmenter::Parts::ColorsNearPrediction() const {
  ColorModel::Histogram counts(ColorModel::kBins, 0.0f);
  const auto near_m = static_cast<float>(config.model.largest_error_m);
  for (int row = 0; row < region.height; row += tuning.color_step_px) {
    for (int column = 0; column < region.width; column += tuning.color_step_px) {
      const int u = region.u_begin + column, v = region.v_begin + row;
      const float z_m = region.z_m[region.At(column, row)];
      const bool is_near = prediction.Covers(u, v) && std::abs(z_m - prediction.Z_m(u, v)) < near_m;
      if (is_near && ColorKnown(u, v)) counts[classifier.BinOf(frame.color.Pixel(u, v))] += 1.0f;
    }
  }
  return counts;
}

/// Whether most points near the predicted surface still have colours of the robot: not when the
/// light has just changed. Where none are known yet, they are guessed.
bool ModelSegmenter::Parts::ColorsHold() {
  const ColorModel::Histogram counts = ColorsNearPrediction();
  if (!classifier.knows_colors()) classifier.GuessForeign(counts);
  float near = 0.0f;
  float foreign = 0.0f;
  for (std::size_t bin = 0; bin < counts.size(); ++bin) {
    near += counts[bin];
    if (classifier.IsForeign(static_cast<std::uint16_t>(bin))) foreign += counts[bin];
  }
  return 2.0f * foreign < near;
}

Status ModelSegmenter::Parts::SegmentByColor(const rgbd::RgbdFrame& raw) {
  if (!classifier.knows_colors() || registration.camera().color.width_px == 0) {
    return Status(StatusCode::kNoRobotSeen,
                  "neither a predicted surface nor the robot's colour is known");
  }
  region.Place(0, 0, frame.z_m.width_px, frame.z_m.height_px);
  ReadRegion(raw);
  UpdateBackground(false);
  classifier.ClassifyBackground(registration, background, &region);
  classifier.ClassifyByColor(frame, &region);
  filter.Smooth(&region);
  SetLabels(tuning.color_evidence);
  patches.Find(region);
  const std::int64_t largest = patches.Largest(Label::kRobot);
  if (largest < config.model.min_robot_pixels) {
    return Status(StatusCode::kNoRobotSeen, "no surface of the robot's colour is seen");
  }
  DropSpecks(static_cast<std::int64_t>(tuning.patch_share * static_cast<double>(largest)));
  DropFarObjects();
  result.notes.emplace_back("no predicted surface: the robot is segmented by its colour alone");
  return Status::Ok();
}

void ModelSegmenter::Parts::SetLabels(float robot_from) {
  Rejections& rejected = result.rejected;
  const auto near_m = static_cast<float>(config.model.object_distance_m);
  for (std::size_t at = 0; at < region.size(); ++at) {
    if (region.z_m[at] <= 0.0f) continue;
    const float evidence = region.evidence[at];
    Label& label = region.label[at];
    if (filter.Support(at) < tuning.least_support_px) {
      label = Label::kMixed;
      ++rejected.at_depth_edge;
    } else if (evidence > robot_from) {
      label = Label::kRobot;
    } else if (region.on_background[at] != 0 || std::abs(region.distance_m[at]) > near_m) {
      label = Label::kBackground;
    } else if (evidence > robot_from + tuning.ambiguous_evidence) {
      label = Label::kAmbiguous;
      ++rejected.ambiguous;
    } else {
      label = Label::kObject;
    }
  }
}

void ModelSegmenter::Parts::DropSpecks(std::int64_t least_robot_px) {
  patches.Find(region);
  result.rejected.isolated +=
      patches.DropSmall(Label::kRobot, std::max(tuning.least_patch_px, least_robot_px), &region) +
      patches.DropSmall(Label::kObject, tuning.least_patch_px, &region);
}

/// Without a predicted surface: objects that are not near a pixel of the robot are background.
void ModelSegmenter::Parts::DropFarObjects() {
  SampleGrid& grid = color_sites;
  const int step = tuning.site_step_px;
  grid.Lay(region.width, region.height, step);
  const auto point_at = [this](int column, int row) -> Eigen::Vector3f {
    return region.z_m[region.At(column, row)] *
           registration.Ray(region.u_begin + column, region.v_begin + row);
  };
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t pixel = region.At(column * step, row * step);
      if (region.z_m[pixel] <= 0.0f) continue;
      const std::size_t at = grid.At(column, row);
      grid.measured_m[at] = point_at(column * step, row * step);
      if (region.label[pixel] == Label::kRobot) grid.site_m[at] = grid.measured_m[at];
    }
  }
  FindNearestSites(&grid);
  const auto near_m = static_cast<float>(config.model.object_distance_m);
  for (int row = 0; row < region.height; ++row) {
    for (int column = 0; column < region.width; ++column) {
      Label& label = region.label[region.At(column, row)];
      if (label != Label::kObject) continue;
      const int site = grid.nearest[grid.At(column / step, row / step)];
      const bool near = site != SampleGrid::kNone &&
                        (point_at(column, row) - grid.site_m[At(site)]).norm() < near_m;
      if (!near) label = Label::kBackground;
    }
  }
}

void ModelSegmenter::Parts::BuildClouds() {
  result.rejected.thinned =
      builder.Build(registration, frame, region, Label::kRobot, &result.robot) +
      builder.Build(registration, frame, region, Label::kObject, &result.object);
  if (result.robot.Count() > 0) return;
  result.status = Status(StatusCode::kNoRobotSeen, "no pixel is the robot's");
  result.object = {};
}

ModelSegmenter::ModelSegmenter(const Config& config, const ModelSegmenterTuning& tuning)
    : config_(config), tuning_(tuning) {
  RobotColor(config);  // throws for an invalid colour
}

ModelSegmenter::~ModelSegmenter() = default;

void ModelSegmenter::SetCamera(const rgbd::RgbdCamera& camera) {
  if (parts_ && parts_->registration.camera() == camera) {
    parts_->begins = true;
    return;
  }
  parts_ = std::make_unique<Parts>(config_, camera, NoiseLaw(camera, NoiseOf(config_)), tuning_);
}

const PixelRegion& ModelSegmenter::region() const {
  PALPATE_CHECK(parts_ != nullptr);
  return parts_->region;
}

const PredictedSurface* ModelSegmenter::FittedSurface() const {
  PALPATE_CHECK(parts_ != nullptr);
  return parts_->fitted ? &*parts_->fitted : nullptr;
}

const SegmentedFrame& ModelSegmenter::Segment(const rgbd::RgbdFrame& frame,
                                              const PredictedSurface* predicted) {
  PALPATE_CHECK(parts_ != nullptr);
  Parts& parts = *parts_;
  SegmentedFrame& result = parts.result;
  result = {};
  parts.fitted.reset();
  parts.region.Place(0, 0, 0, 0);
  result.status = parts.registration.RegisterDepth(frame, &parts.frame);
  if (!result.status.ok()) return result;
  parts.TakeRange();
  const auto pixels = static_cast<std::int64_t>(parts.frame.z_m.values.size());
  if (result.rejected.invalid_depth + result.rejected.out_of_range == pixels) {
    result.status = parts.ExplainNothingInRange(frame, predicted);
    return result;
  }
  result.status = predicted != nullptr ? parts.SegmentByPrediction(frame, *predicted)
                                       : parts.SegmentByColor(frame);
  if (result.status.ok()) parts.BuildClouds();
  return result;
}

}  // namespace palpate::perception
