// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

#include <Eigen/Geometry>

#include "components/diagnosis/causes/seen_move.hpp"

namespace palpate::diagnosis {

namespace {

/// From one recording on the camera stands elsewhere: what is seen turns about the middle of the
/// body, and moves.
class CameraMoved final : public Cause {
 public:
  CameraMoved(int from_recording, const std::string& recording, const Eigen::Vector3d& middle_m)
      : Cause({"camera_moved", {"camera"}}, "camera moved before recording " + recording,
              {Move(), Move(), Move(), Turn(), Turn(), Turn()}),
        from_recording_(from_recording),
        middle_m_(middle_m) {}

  void Apply(const Eigen::VectorXd& z, ModelDraft* draft) const override {
    const Eigen::Isometry3d moved = SeenMove(z, middle_m_);
    for (auto k = static_cast<std::size_t>(from_recording_); k < draft->T_seen.size(); ++k) {
      draft->T_seen[k] = moved * draft->T_seen[k];
    }
  }

  void OnView(int parameter, const Eigen::VectorXd& z, const CauseMoment& at,
              Eigen::Matrix3Xd* motion_m) const override {
    if (at.seen().recording < from_recording_) return;
    const Eigen::Isometry3d& T_seen =
        at.draft.T_seen[static_cast<std::size_t>(at.seen().recording)];
    AddSeenMove(parameter, z, middle_m_, T_seen * SeenMove(z, middle_m_).inverse(), at, motion_m);
  }

  std::vector<FittedParameter> Report(const Eigen::VectorXd& z,
                                      const Eigen::MatrixXd& covariance) const override {
    const auto from = static_cast<double>(from_recording_);
    return {SizeOf("translation_m", z.head<3>(), covariance.topLeftCorner<3, 3>()),
            SizeOf("rotation_rad", z.tail<3>(), covariance.bottomRightCorner<3, 3>()),
            {"from_recording", from, from, from}};
  }

 private:
  static CauseParameter Move() { return {.name = "translation_m", .fault = 0.01}; }
  static CauseParameter Turn() { return {.name = "rotation_rad", .fault = 0.04}; }

  int from_recording_;
  Eigen::Vector3d middle_m_;
};

}  // namespace

void MakeCameraMoved(const CauseWorld& world, std::vector<CausePtr>* causes) {
  const Eigen::Vector3d middle_m = world.body.mesh.nodes_m.rowwise().mean();
  const std::vector<ObservedRecording>& recordings = world.observed.recordings;
  for (std::size_t k = 1; k < recordings.size(); ++k) {
    if (!recordings[k].camera_frame) continue;
    causes->push_back(
        std::make_unique<CameraMoved>(static_cast<int>(k), recordings[k].name, middle_m));
  }
}

}  // namespace palpate::diagnosis
