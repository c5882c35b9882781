// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

#include "components/diagnosis/causes/seen_move.hpp"

namespace palpate::diagnosis {

namespace {

/// Where recordings were measured from, as far as it is not known: no fault of the robot's.
class Extrinsics final : public Cause {
 public:
  Extrinsics(std::vector<int> recordings, const Eigen::Vector3d& middle_m, double sigma_m,
             double sigma_rad)
      : Cause({"extrinsics", {"camera"}}, "pose of the camera",
              {Known("translation_m", sigma_m), Known("translation_m", sigma_m),
               Known("translation_m", sigma_m), Known("rotation_rad", sigma_rad),
               Known("rotation_rad", sigma_rad), Known("rotation_rad", sigma_rad)}),
        recordings_(std::move(recordings)),
        middle_m_(middle_m) {}

  void Apply(const Eigen::VectorXd& z, ModelDraft* draft) const override {
    const Eigen::Isometry3d move = SeenMove(z, middle_m_);
    for (const int k : recordings_) {
      Eigen::Isometry3d& T_seen = draft->T_seen[static_cast<std::size_t>(k)];
      T_seen = move * T_seen;
    }
  }

  void OnView(int parameter, const Eigen::VectorXd& z, const CauseMoment& at,
              Eigen::Matrix3Xd* motion_m) const override {
    const int pose_of = at.recording().pose_of;
    const int from = pose_of >= 0 ? pose_of : at.seen().recording;
    const bool here = std::find(recordings_.begin(), recordings_.end(), from) != recordings_.end();
    if (here) AddSeenMove(parameter, z, middle_m_, Eigen::Isometry3d::Identity(), at, motion_m);
  }

 private:
  static CauseParameter Known(const std::string& name, double sigma) {
    return {.name = name, .tolerance = sigma, .fault = sigma};
  }

  std::vector<int> recordings_;
  Eigen::Vector3d middle_m_;
};

/// What is known of a pose that is given, and one that was fitted to these data.
constexpr double kGiven_m = 5e-4;
constexpr double kGiven_rad = 2e-3;
constexpr double kFitted_m = 0.02;
constexpr double kFitted_rad = 0.05;

bool SamePose(const ObservedRecording& a, const ObservedRecording& b) {
  return a.knows_pose == b.knows_pose &&
         a.T_measurement_robot.isApprox(b.T_measurement_robot, 1e-12);
}

}  // namespace

void MakeExtrinsics(const CauseWorld& world, std::vector<CausePtr>* causes) {
  const std::vector<ObservedRecording>& recordings = world.observed.recordings;
  const Eigen::Vector3d middle_m = world.body.mesh.nodes_m.rowwise().mean();
  std::vector<bool> taken(recordings.size(), false);
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    if (taken[k] || !(recordings[k].camera_frame || world.extrinsics_m > 0.0)) continue;
    std::vector<int> alike;
    for (std::size_t l = k; l < recordings.size(); ++l) {
      if (!SamePose(recordings[k], recordings[l])) continue;
      taken[l] = true;
      alike.push_back(static_cast<int>(l));
    }
    const bool given = recordings[k].knows_pose;
    const double sigma_m = world.extrinsics_m > 0.0 ? world.extrinsics_m : kGiven_m;
    const double sigma_rad = world.extrinsics_rad > 0.0 ? world.extrinsics_rad : kGiven_rad;
    causes->push_back(std::make_unique<Extrinsics>(
        std::move(alike), middle_m, given ? sigma_m : kFitted_m, given ? sigma_rad : kFitted_rad));
  }
}

}  // namespace palpate::diagnosis
