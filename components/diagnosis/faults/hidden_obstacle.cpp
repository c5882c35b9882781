// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "components/diagnosis/faults/candidate_obstacles.hpp"
#include "components/diagnosis/faults/makers.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

constexpr double kTiltSigma_rad = 0.2;
constexpr double kMostTilt_rad = 0.6;
/// By which the model's surface of nodes may lie off the body's, one sigma.
constexpr double kSurface_m = 3e-4;

/// z: whether the obstacle is there (1; 0: not; nothing between is possible), how much farther from
/// the body than where it is searched, and two turns about the middle of where it is met there.
class HiddenObstacle final : public FaultModel {
 public:
  HiddenObstacle(const CandidateObstacle& at, std::shared_ptr<const ObstacleSurface> surface)
      : FaultModel({"hidden_obstacle", {"body"}}, "an obstacle in the body's way",
                   {{.name = "there", .fault = 1e-3, .fault_at = 1.0, .least = 0.0, .most = 1.0},
                    {.name = "farther_m",
                     .fault = at.shift_sigma_m,
                     .least = -at.gap_m,
                     .most = at.most_shift_m,
                     .qualifies = true},
                    {.name = "tilt_1_rad",
                     .fault = kTiltSigma_rad,
                     .least = -kMostTilt_rad,
                     .most = kMostTilt_rad,
                     .qualifies = true},
                    {.name = "tilt_2_rad",
                     .fault = kTiltSigma_rad,
                     .least = -kMostTilt_rad,
                     .most = kMostTilt_rad,
                     .qualifies = true}}),
        at_(at),
        surface_(std::move(surface)) {
    const Eigen::Vector3d n = at_.normal;
    tangents_.col(0) = n.unitOrthogonal();
    tangents_.col(1) = n.cross(tangents_.col(0));
  }

  std::optional<int> Start() const override { return at_.way; }

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    if (IsThere(z)) hypothesis->obstacle = ObstacleAt(z);
  }

  robot::ParameterPtr OnBody(int parameter, const Eigen::VectorXd& z,
                             const FaultContext& at) const override {
    if (parameter == 0 || !IsThere(z) || !at.shape.AtObstacle()) return nullptr;
    const Obstacle obstacle = ObstacleAt(z);
    const Eigen::Vector3d turn = NormalChange(parameter, z);
    return ObstacleMotion(obstacle, at.shape.obstacle_force_N, turn, OffsetChange(parameter, turn));
  }

  /// Where it is there: what it presses with. Where it is not: what pushes the nodes back that are
  /// beyond it, the deeper the more, until on average they are not.
  std::optional<Push> PushOf(const Eigen::VectorXd& z, const FaultContext& at) const override {
    const Eigen::VectorXd& x_m = at.shape.state.x_m;
    const Obstacle obstacle = ObstacleAt(z);
    Push push{.force_N = {},
              .times = Eigen::VectorXd::Zero(z.size()),
              .displacement_m = Eigen::VectorXd::Zero(z.size())};
    if (IsThere(z)) {
      if (!at.shape.AtObstacle()) return std::nullopt;
      push.force_N = NodalForces_N(obstacle, at.shape.obstacle_force_N, x_m.size());
      push.times[0] = 1.0;
      return push;
    }
    const Beyond beyond = BeyondObstacle(obstacle, x_m);
    if (beyond.share.empty()) return std::nullopt;
    push.force_N = Eigen::VectorXd::Zero(x_m.size());
    for (const auto& [node, share] : beyond.share) {
      push.force_N.segment<3>(3 * node) = share * obstacle.normal;
    }
    push.displacement_m[0] = beyond.depth_m;
    for (int p = 1; p < std::ssize(parameters()); ++p) {
      const Eigen::Vector3d turn = NormalChange(p, z);
      push.displacement_m[p] = OffsetChange(p, turn) - turn.dot(beyond.middle_m);
    }
    return push;
  }

  /// The gap is to the robot as it stands there: of one that is larger than its file says, the
  /// obstacle stands that much farther from the file's body.
  std::vector<FittedParameter> Report(const Eigen::VectorXd& z, const Eigen::MatrixXd& covariance,
                                      const Eigen::VectorXd& undeformed_m) const override {
    constexpr double k95 = 1.959964;
    constexpr double kStep = 1e-4;  // of the fault sigma
    const char* const names[] = {"gap_m", "nx", "ny", "nz"};
    const Eigen::Vector4d value = GapAndNormal(z, undeformed_m);
    Eigen::MatrixXd slope(4, z.size());
    for (Eigen::Index p = 0; p < z.size(); ++p) {
      const double step = kStep * parameters()[At(p)].fault;
      const Eigen::VectorXd beside = step * Eigen::VectorXd::Unit(z.size(), p);
      slope.col(p) =
          (GapAndNormal(z + beside, undeformed_m) - GapAndNormal(z - beside, undeformed_m)) /
          (2.0 * step);
    }
    std::vector<FittedParameter> report;
    for (int k = 0; k < 4; ++k) {
      const double of_skin_m2 = k == 0 ? kSurface_m * kSurface_m : 0.0;
      const double half = k95 * std::sqrt(slope.row(k).dot(slope.row(k) * covariance) + of_skin_m2);
      // An obstacle that stands in the model's surface touches it.
      const double least = k == 0 ? 0.0 : -1.0;
      const double most = k == 0 ? std::numeric_limits<double>::infinity() : 1.0;
      const double can_be = std::clamp(value[k], least, most);
      report.push_back(
          {names[k], can_be, std::max(least, can_be - half), std::min(most, can_be + half)});
    }
    return report;
  }

 private:
  static bool IsThere(const Eigen::VectorXd& z) { return z[0] > 0.5; }

  Eigen::Vector3d Along(const Eigen::VectorXd& z) const {
    return at_.normal + tangents_ * z.tail<2>();
  }

  Obstacle ObstacleAt(const Eigen::VectorXd& z) const {
    const Eigen::Vector3d normal = Along(z).normalized();
    return {surface_, normal, normal.dot(at_.middle_m) - z[1]};
  }

  /// Of the normal with one of the turns; none with the others.
  Eigen::Vector3d NormalChange(int parameter, const Eigen::VectorXd& z) const {
    if (parameter < 2) return Eigen::Vector3d::Zero();
    const Eigen::Vector3d along = Along(z);
    const Eigen::Vector3d n = along.normalized();
    const Eigen::Vector3d t = tangents_.col(parameter - 2);
    return (t - n * n.dot(t)) / along.norm();
  }

  double OffsetChange(int parameter, const Eigen::Vector3d& normal_change) const {
    return parameter == 1 ? -1.0 : normal_change.dot(at_.middle_m);
  }

  Eigen::Vector4d GapAndNormal(const Eigen::VectorXd& z,
                               const Eigen::VectorXd& undeformed_m) const {
    const Obstacle obstacle = ObstacleAt(z);
    Eigen::Vector4d value;
    value << ObstacleClearance_m(obstacle, undeformed_m), obstacle.normal;
    return value;
  }

  CandidateObstacle at_;
  std::shared_ptr<const ObstacleSurface> surface_;
  Eigen::Matrix<double, 3, 2> tangents_;
};

}  // namespace

void MakeHiddenObstacle(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  if (inputs.as_built == nullptr) return;
  const auto surface = std::make_shared<const ObstacleSurface>(SurfaceForObstacles(inputs.body));
  const Eigen::VectorXd undeformed_m = inputs.body.mesh.nodes_m.reshaped();
  for (const CandidateObstacle& at : CandidateObstacles(surface, undeformed_m, *inputs.as_built)) {
    faults->push_back(std::make_unique<HiddenObstacle>(at, surface));
  }
}

}  // namespace palpate::diagnosis
