// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/frame_estimator.hpp"

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/monitor/marker_motion.hpp"
#include "components/force_estimation/node/convert.hpp"
#include "components/force_estimation/shape/known_contacts.hpp"
#include "components/force_estimation/shape/shape_force_estimator.hpp"

namespace palpate::force_estimation {

namespace {

/// What drifts does so slowly; each look at the skin costs as much as a chord step of the model.
constexpr double kBetweenWatches_s = 0.1;

class FromMarkers : public FrameEstimator {
 public:
  FromMarkers(robot::RobotModel& model, const NodeConfig& config,
              const robot::CalibrationFile& calibration)
      : estimator_(model, config, robot::RelativeModulusError(calibration)),
        gap_(model.body(), config.marker_sigma_m, config.marker_bias_m) {
    for (const robot::BodyMarker& marker : model.body().markers) points_.push_back(marker.point);
    middle_m_ = MarkersOf(model.RestState().x_m).rowwise().mean();
  }

  FrameResult Update(FrameInput& input) override {
    const MarkerFrame& frame = std::get<MarkerFrame>(input.frame);
    const ForceEstimate& estimate = estimator_.Update(frame);
    const bool usable = IsUsable(estimate.status);
    x_m_ = estimate.x_m;
    last_gap_ = gap_.Measure(frame, estimate);
    return {input.head,
            estimate,
            last_gap_,
            usable,
            usable ? Status::Ok() : estimate.status,
            drift_.report(),
            gap_watch_.report()};
  }

  /// Each frame: markers are few, and what they say of a motion is their noise over the root of
  /// the frames.
  void AfterUpdate(const FrameInput& input) override {
    const MarkerFrame& frame = std::get<MarkerFrame>(input.frame);
    if (frame.reference != ReferenceShape::kNone) return;
    gap_watch_.Add(frame.t_s, last_gap_);
    drift_.Add(frame.t_s, SeeMotion(estimator_.Misfit(), MarkersOf(x_m_), middle_m_));
  }

 private:
  Eigen::Matrix3Xd MarkersOf(const Eigen::VectorXd& x_m) const {
    Eigen::Matrix3Xd places_m(3, static_cast<Eigen::Index>(points_.size()));
    for (std::size_t m = 0; m < points_.size(); ++m) {
      places_m.col(static_cast<Eigen::Index>(m)) = points_[m].weights.Position(x_m);
    }
    return places_m;
  }

  MarkerForceEstimator estimator_;
  ModelGapMeter gap_;
  std::vector<fem::BodyPoint> points_;  ///< of the markers
  Eigen::Vector3d middle_m_;            ///< of the markers, at rest
  Eigen::VectorXd x_m_;                 ///< [3n] of the last frame
  ModelGapReport last_gap_;
  ModelResidualMonitor gap_watch_;
  ExtrinsicsDriftMonitor drift_{"what carries the markers"};
};

/// As `palpate estimate` does with recorded images: contacts that are given come before those that
/// perception sees; the first frames of a sequence in which the robot was seen are known to be
/// untouched; where it was not seen, perception knows why.
class FromShape : public FrameEstimator {
 public:
  FromShape(robot::RobotModel& model, const NodeConfig& config,
            const robot::CalibrationFile& calibration)
      : untouched_frames_(config.shape.untouched_frames),
        sites_(ParseContactSites(config.contacts)),
        known_contacts_(model.body()),
        estimator_(model, config, config.shape, robot::RelativeModulusError(calibration)),
        gap_(model.body()),
        held_skin_(model.body()) {
    if (!calibration.depth_bias) return;
    estimator_.TakeDepthBias(calibration.depth_bias->map, calibration.pose->T_robot_camera);
  }

  FrameResult Update(FrameInput& input) override {
    auto& seen = std::get<SeenShape>(input.frame);
    seen.frame.untouched = seen_ < untouched_frames_;
    seen_ += seen.looked.ok() ? 1 : 0;
    seen.frame.contacts =
        KnownBeforeSeen(known_contacts_.At(sites_, nodes_m_), seen.frame.contacts);
    FrameResult result{input.head, estimator_.Update(seen.frame), {}, false, {}};
    Status& status = result.estimate.status;
    result.gap = gap_.Measure(estimator_.features(), status);
    result.state_is_known = PredictsShape(result.estimate);
    // In single precision, as the estimate over recordings and perception have it.
    if (result.state_is_known) nodes_m_ = result.estimate.x_m.cast<float>().cast<double>();
    // While the depth bias is learnt there are no forces, but the model is where the robot is.
    const bool stands = IsUsable(status) || status.code() == StatusCode::kNoCalibration;
    result.state = result.state_is_known && stands ? Status::Ok() : status;
    if (!seen.looked.ok() && status.code() == StatusCode::kNoRobotSeen) status = seen.looked;
    result.drift = drift_.report();
    last_gap_ = result.gap;
    result.gap_so_far = gap_watch_.report();
    return result;
  }

  void AfterUpdate(const FrameInput& input) override {
    estimator_.PrepareNext();
    const ShapeFrame& frame = std::get<SeenShape>(input.frame).frame;
    gap_watch_.Add(frame.t_s, last_gap_);
    const double since_s = frame.t_s - watched_s_;
    if (since_s >= 0.0 && since_s < kBetweenWatches_s) return;
    watched_s_ = frame.t_s;
    drift_.Add(frame.t_s, SeeMotion(held_skin_, frame.cloud, frame.T_robot_camera, nodes_m_));
  }

 private:
  int untouched_frames_;
  int seen_ = 0;
  std::vector<ContactSite> sites_;
  KnownContacts known_contacts_;
  Eigen::VectorXd nodes_m_;  ///< [3n] of the last frame that says where they are; empty before
  ShapeForceEstimator estimator_;
  FeatureGapMeter gap_;
  ModelGapReport last_gap_;
  ModelResidualMonitor gap_watch_;
  FixedSurfaceRegion held_skin_;
  ExtrinsicsDriftMonitor drift_;
  double watched_s_ = -kBetweenWatches_s;
};

}  // namespace

bool IsFromShape(const NodeConfig& config) {
  return config.source == "shape" || (config.source == "auto" && !config.camera_pose.empty());
}

FrameEstimatorMaker EstimatorMakerOf(const NodeConfig& config,
                                     const robot::CalibrationFile& calibration) {
  if (!IsFromShape(config)) {
    return [config, calibration](robot::RobotModel& model) {
      return std::make_unique<FromMarkers>(model, config, calibration);
    };
  }
  return [config, calibration](robot::RobotModel& model) {
    return std::make_unique<FromShape>(model, config, calibration);
  };
}

}  // namespace palpate::force_estimation
