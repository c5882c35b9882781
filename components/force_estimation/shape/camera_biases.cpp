// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/camera_biases.hpp"

#include <algorithm>
#include <map>
#include <span>

#include "libs/core/check.hpp"

namespace palpate::force_estimation {

namespace {

/// Of two cameras that see the sequence.
BiasSequence Joined(const BiasSequence& one, const BiasSequence& other) {
  BiasSequence joined = other.misfit > one.misfit ? other : one;
  joined.frames = std::max(one.frames, other.frames);
  joined.contact_free = one.contact_free && other.contact_free;
  return joined;
}

}  // namespace

void CameraBiases::HaveCameras(std::size_t count) {
  while (cameras_.size() < count) {
    cameras_.push_back({DepthBias(feature_count_, config_), BiasFrameCheck(config_)});
  }
}

void CameraBiases::StartFrom(int camera, const geometry::DepthBiasMap& map,
                             const Eigen::Isometry3d& T_robot_camera) {
  HaveCameras(At(camera) + 1);
  cameras_[At(camera)].bias.StartFrom(map, T_robot_camera);
}

void CameraBiases::Learn(const std::vector<correspondence::FeatureMatch>& matches,
                         const Eigen::VectorXd& x_m, const CameraPoses& poses,
                         std::uint32_t sequence) {
  const auto count = static_cast<std::size_t>(feature_count_);
  PALPATE_CHECK(matches.size() == poses.size() * count && poses.size() <= cameras_.size(),
                matches.size(), poses.size(), cameras_.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const std::span of_camera = std::span(matches).subspan(k * count, count);
    cameras_[k].check.Add(cameras_[k].bias, sequence, of_camera, x_m, poses[k]);
    cameras_[k].bias.Learn(of_camera, x_m, poses[k], sequence);
  }
}

Status CameraBiases::Finish() {
  Status first;
  bool is_known = false;
  for (std::size_t k = 0; k < cameras_.size(); ++k) {
    const Status status = cameras_[k].bias.Finish();
    is_known = is_known || status.ok();
    if (k == 0) first = status;
  }
  return is_known ? Status::Ok() : first;
}

std::vector<BiasSequence> CameraBiases::Judge() const {
  std::map<std::uint32_t, BiasSequence> joined;
  for (const Camera& camera : cameras_) {
    for (const BiasSequence& verdict : camera.check.Judge()) {
      BiasSequence& so_far = joined.emplace(verdict.epoch, verdict).first->second;
      if (verdict.frames > 0) so_far = so_far.frames > 0 ? Joined(so_far, verdict) : verdict;
    }
  }
  std::vector<BiasSequence> sequences;
  for (const auto& [epoch, verdict] : joined) sequences.push_back(verdict);
  return sequences;
}

int CameraBiases::frames() const {
  int frames = 0;
  for (const Camera& camera : cameras_) frames = std::max(frames, camera.bias.frames());
  return frames;
}

bool CameraBiases::known() const {
  return std::any_of(cameras_.begin(), cameras_.end(),
                     [](const Camera& camera) { return camera.bias.known(); });
}

bool CameraBiases::IsKnown(std::size_t camera) const {
  return camera < cameras_.size() && cameras_[camera].bias.known();
}

double CameraBiases::Correction_m(const correspondence::FeatureMatch& match,
                                  const CameraPoses& poses) const {
  return BiasOf(match).Correction_m(match.feature, match, poses[At(match.camera)]);
}

double CameraBiases::CorrectionSigma_m(const correspondence::FeatureMatch& match,
                                       const CameraPoses& poses) const {
  return BiasOf(match).CorrectionSigma_m(match.feature, match, poses[At(match.camera)]);
}

Eigen::VectorXd CameraBiases::Shared() const {
  Eigen::VectorXd all;
  for (const Camera& camera : cameras_) {
    const Eigen::VectorXd shared = camera.bias.Shared();
    all.conservativeResize(all.size() + shared.size());
    all.tail(shared.size()) = shared;
  }
  return all;
}

void CameraBiases::SetShared(const Eigen::VectorXd& shared) {
  Eigen::Index begin = 0;
  for (Camera& camera : cameras_) {
    const Eigen::Index size = camera.bias.Shared().size();
    camera.bias.SetShared(shared.segment(begin, size));
    begin += size;
  }
}

Eigen::VectorXd CameraBiases::ScaledBasis(const correspondence::FeatureMatch& match,
                                          const CameraPoses& poses) const {
  Eigen::Index begin = 0;
  Eigen::Index size = 0;
  for (std::size_t k = 0; k < cameras_.size(); ++k) {
    if (k == At(match.camera)) begin = size;
    size += cameras_[k].bias.Shared().size();
  }
  const Eigen::VectorXd own = BiasOf(match).ScaledBasis(match, poses[At(match.camera)]);
  Eigen::VectorXd basis = Eigen::VectorXd::Zero(size);
  basis.segment(begin, own.size()) = own;
  return basis;
}

}  // namespace palpate::force_estimation
