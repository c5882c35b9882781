// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/faults/makers.hpp"

#include <Eigen/Geometry>

#include "components/diagnosis/faults/view_motion.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

/// From one recording on the camera stands elsewhere than where it was put, by the same motion in
/// its own frame: what it measures turns about where the middle of the body is, and moves.
class CameraMoved final : public FaultModel {
 public:
  CameraMoved(int from_recording, const std::vector<ObservedRecording>& recordings,
              const Eigen::Vector3d& middle_m)
      : FaultModel({"camera_moved", {"camera"}},
                   "camera moved before recording " + NameOf(recordings, from_recording),
                   {Move(), Move(), Move(), Turn(), Turn(), Turn()}),
        from_recording_(from_recording),
        middle_m_(recordings[At(from_recording)].T_view_robot() * middle_m) {
    for (const ObservedRecording& one : recordings) {
      T_view_robot_.push_back(one.T_view_robot());
      moves_markers_.push_back(one.camera_frame || !one.T_camera_robot);
    }
  }

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    const Eigen::Isometry3d moved = ViewMotion(z, middle_m_);
    for (auto k = static_cast<std::size_t>(from_recording_); k < T_view_robot_.size(); ++k) {
      const Eigen::Isometry3d& T = T_view_robot_[k];
      const Eigen::Isometry3d in_robot_frame = T.inverse() * moved * T;
      if (moves_markers_[k]) hypothesis->T_seen[k] = in_robot_frame * hypothesis->T_seen[k];
      hypothesis->T_surface_seen[k] = in_robot_frame * hypothesis->T_surface_seen[k];
    }
  }

  void OnView(int parameter, const Eigen::VectorXd& z, const FaultContext& at,
              Eigen::Matrix3Xd* motion_m) const override {
    const ObservedRecording& recording = at.recording();
    const int from = recording.pose_of >= 0 ? recording.pose_of : at.seen().recording;
    const auto source = static_cast<std::size_t>(from);
    const bool moves = at.target == Target::kSurface || moves_markers_[source];
    if (from < from_recording_ || !moves) return;
    const Eigen::Isometry3d& T_seen = at.target == Target::kSurface
                                          ? at.hypothesis.T_surface_seen[source]
                                          : at.hypothesis.T_seen[source];
    const Eigen::Isometry3d T_after =
        T_seen * at.T_measurement_robot().inverse() * ViewMotion(z, middle_m_).inverse();
    AddViewMotion(parameter, z, middle_m_, T_after, at, motion_m);
  }

  /// How far the camera itself is from where it was, and by how much it turned.
  std::vector<FittedParameter> Report(const Eigen::VectorXd& z, const Eigen::MatrixXd& covariance,
                                      const Eigen::VectorXd& /*undeformed_m*/) const override {
    const Eigen::Isometry3d moved = ViewMotion(z, middle_m_);
    const Eigen::Vector3d turned_m = moved.linear() * middle_m_;
    Eigen::Matrix<double, 3, 6> slope;
    slope << Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      slope.col(3 + axis) = turned_m.cross(Eigen::Vector3d::Unit(axis));
    }
    const auto from = static_cast<double>(from_recording_);
    return {SizeOf("translation_m", moved.translation(), slope * covariance * slope.transpose()),
            SizeOf("rotation_rad", z.tail<3>(), covariance.bottomRightCorner<3, 3>()),
            {"from_recording", from, from, from}};
  }

 private:
  static const std::string& NameOf(const std::vector<ObservedRecording>& recordings, int k) {
    return recordings[At(k)].name;
  }
  static FaultParameter Move() { return {.name = "translation_m", .fault = 0.01}; }
  static FaultParameter Turn() { return {.name = "rotation_rad", .fault = 0.04}; }

  int from_recording_;
  Eigen::Vector3d middle_m_;  ///< of the body, measurement frame of that recording
  std::vector<Eigen::Isometry3d> T_view_robot_;  ///< [recordings] that were made
  std::vector<bool> moves_markers_;  ///< [recordings] and not what depth frames show alone
};

}  // namespace

void MakeCameraMoved(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  const Eigen::Vector3d middle_m = inputs.body.mesh.nodes_m.rowwise().mean();
  const std::vector<ObservedRecording>& recordings = inputs.observed.recordings;
  for (std::size_t k = 1; k < recordings.size(); ++k) {
    if (!recordings[k].camera_frame && !recordings[k].T_camera_robot) continue;
    faults->push_back(std::make_unique<CameraMoved>(static_cast<int>(k), recordings, middle_m));
  }
}

}  // namespace palpate::diagnosis
