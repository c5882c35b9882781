// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

#include "components/diagnosis/causes/seen_move.hpp"

namespace palpate::diagnosis {

namespace {

/// What measures something in a recording.
struct Eye {
  int recording = 0;
  Target target = Target::kMarkers;

  bool operator==(const Eye&) const = default;
};

/// Where recordings were measured from, as far as it is not known: no fault of the robot's.
class Extrinsics final : public FaultModel {
 public:
  /// `of`: the eyes that stand where one camera, or tracker, does.
  Extrinsics(std::vector<Eye> of, const Eigen::Vector3d& middle_m, double sigma_m, double sigma_rad)
      : FaultModel({"extrinsics", {"camera"}}, "pose of the camera",
                   {Known("translation_m", sigma_m), Known("translation_m", sigma_m),
                    Known("translation_m", sigma_m), Known("rotation_rad", sigma_rad),
                    Known("rotation_rad", sigma_rad), Known("rotation_rad", sigma_rad)}),
        eyes_(std::move(of)),
        middle_m_(middle_m) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    const Eigen::Isometry3d move = SeenMove(z, middle_m_);
    for (const Eye& eye : eyes_) {
      auto& of_target = eye.target == Target::kSkin ? hypothesis->T_skin_seen : hypothesis->T_seen;
      Eigen::Isometry3d& T_seen = of_target[static_cast<std::size_t>(eye.recording)];
      T_seen = move * T_seen;
    }
  }

  void OnView(int parameter, const Eigen::VectorXd& z, const FaultContext& at,
              Eigen::Matrix3Xd* motion_m) const override {
    const int pose_of = at.recording().pose_of;
    const int from = pose_of >= 0 ? pose_of : at.seen().recording;
    const bool here = std::find(eyes_.begin(), eyes_.end(), Eye{from, at.target}) != eyes_.end();
    if (here) AddSeenMove(parameter, z, middle_m_, Eigen::Isometry3d::Identity(), at, motion_m);
  }

 private:
  static FaultParameter Known(const std::string& name, double sigma) {
    return {.name = name, .tolerance = sigma, .fault = sigma};
  }

  std::vector<Eye> eyes_;
  Eigen::Vector3d middle_m_;
};

/// What is known of a pose that is given, and one that was fitted to these data.
constexpr double kGiven_m = 5e-4;
constexpr double kGiven_rad = 2e-3;
constexpr double kFitted_m = 0.02;
constexpr double kFitted_rad = 0.05;

/// Where an eye stands.
struct View {
  Eye eye;
  Eigen::Isometry3d T_measurement_robot;
  bool known;
};

bool SamePose(const View& a, const View& b) {
  return a.known == b.known && a.T_measurement_robot.isApprox(b.T_measurement_robot, 1e-12);
}

/// Those whose pose may be off. Pictures and markers that are in the camera's frame have one pose.
std::vector<View> Views(const CauseWorld& world) {
  std::vector<View> views;
  const std::vector<ObservedRecording>& recordings = world.observed.recordings;
  for (int k = 0; k < std::ssize(recordings); ++k) {
    const ObservedRecording& one = recordings[static_cast<std::size_t>(k)];
    if (one.camera_frame || world.extrinsics_m > 0.0)
      views.push_back({{k, Target::kMarkers}, one.T_measurement_robot, one.knows_pose});
    if (one.T_camera_robot) views.push_back({{k, Target::kSkin}, *one.T_camera_robot, true});
  }
  return views;
}

}  // namespace

void MakeExtrinsics(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  const Eigen::Vector3d middle_m = world.body.mesh.nodes_m.rowwise().mean();
  const std::vector<View> views = Views(world);
  std::vector<bool> taken(views.size(), false);
  for (std::size_t k = 0; k < views.size(); ++k) {
    if (taken[k]) continue;
    std::vector<Eye> alike;
    for (std::size_t l = k; l < views.size(); ++l) {
      if (!SamePose(views[k], views[l])) continue;
      taken[l] = true;
      alike.push_back(views[l].eye);
    }
    const bool given = views[k].known;
    const double sigma_m = world.extrinsics_m > 0.0 ? world.extrinsics_m : kGiven_m;
    const double sigma_rad = world.extrinsics_rad > 0.0 ? world.extrinsics_rad : kGiven_rad;
    causes->push_back(std::make_unique<Extrinsics>(
        std::move(alike), middle_m, given ? sigma_m : kFitted_m, given ? sigma_rad : kFitted_rad));
  }
}

}  // namespace palpate::diagnosis
