// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Geometry>
#include <numbers>

#include "components/diagnosis/faults/makers.hpp"
#include "libs/fem/surface_patch.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

class BaseComplianceFault final : public FaultModel {
 public:
  explicit BaseComplianceFault(const Eigen::Vector3d& middle_m)
      : FaultModel({"base_compliance", {"base"}}, "compliance of the base",
                   {{.name = "compliance_rad_Nm", .fault = 0.15, .least = 0.0}}),
        middle_m_(middle_m) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->base_compliance_rad_Nm += std::max(0.0, z[0]);
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& /*at*/) const override {
    Eigen::Matrix<double, 6, 6> turns = Eigen::Matrix<double, 6, 6>::Zero();
    turns.topLeftCorner<3, 3>().setIdentity();
    return robot::BaseCompliance(turns, middle_m_);
  }

 private:
  Eigen::Vector3d middle_m_;
};

}  // namespace

void MakeBaseCompliance(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  faults->push_back(std::make_unique<BaseComplianceFault>(MiddleOfBase(inputs.body)));
}

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// The base stands askew by R = Ry(theta_y) Rx(theta_x).
Eigen::Matrix3d TiltError(const Eigen::Vector2d& theta_deg) {
  return (Eigen::AngleAxisd(theta_deg.y() * kDegree, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(theta_deg.x() * kDegree, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

class GravityDirection final : public FaultModel {
 public:
  GravityDirection()
      : FaultModel({"gravity_direction", {"base"}}, "direction of gravity",
                   {{.name = "theta_x_deg", .tolerance = 0.3, .fault = 4.0},
                    {.name = "theta_y_deg", .tolerance = 0.3, .fault = 4.0}}) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->R_tilt_error = hypothesis->R_tilt_error * TiltError(z.head<2>());
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              robot::CalibrationFile* /*calibration*/) const override {
    robot->gravity_m_s2 = TiltError(z.head<2>()).transpose() * robot->gravity_m_s2;
    return true;
  }

  /// Weights that hang on the body turn along.
  robot::ParameterPtr OnBody(int parameter, const Eigen::VectorXd& z,
                             const FaultContext& at) const override {
    const Eigen::Matrix3d& R_tilt = at.recording().base_rotation;
    const Eigen::Matrix3d R = R_tilt * at.hypothesis.R_tilt_error;
    // Ry Rx: the turn about y comes before the one about x.
    const Eigen::Vector3d axis =
        TiltError({-z[0], 0.0}) * Eigen::Vector3d(Eigen::Vector3d::Unit(parameter));
    // R' v turns by -axis x R' v with a further turn of R on its right.
    const auto turned = [&](const Eigen::Vector3d& v_world) -> Eigen::Vector3d {
      return -kDegree * axis.cross(R.transpose() * v_world);
    };
    auto sum = std::make_unique<SumOfParameters>();
    sum->Add(1.0, robot::GravityChange(turned(at.hypothesis.body.gravity_m_s2)));
    const Eigen::Vector3d down = at.hypothesis.body.gravity_m_s2.normalized();
    for (const experiment::KnownLoad& load : at.seen().loads) {
      const Eigen::Vector3d world_N = R_tilt * load.force_N;
      if (world_N.normalized().dot(down) < kHangs) continue;
      const fem::SurfacePatch patch =
          fem::MakeSurfacePatch(*at.hypothesis.places, load.position_m, load.patch_radius_m);
      sum->Add(1.0, PointForce(patch.weights, turned(world_N)));
    }
    for (const CarriedMass& mass : at.hypothesis.masses) {
      sum->Add(1.0,
               PointForce(mass.weights, mass.mass_kg * turned(at.hypothesis.body.gravity_m_s2)));
    }
    return sum;
  }
};

}  // namespace

void MakeGravityDirection(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  if (inputs.body.gravity_m_s2.isZero()) return;
  faults->push_back(std::make_unique<GravityDirection>());
}

}  // namespace palpate::diagnosis
