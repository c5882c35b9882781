// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/fault_model.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

constexpr double k95 = 1.959964;  ///< of a normal distribution

}  // namespace

std::vector<FittedParameter> FaultModel::Report(const Eigen::VectorXd& z,
                                                const Eigen::MatrixXd& covariance,
                                                const Eigen::VectorXd& /*undeformed_m*/) const {
  std::vector<FittedParameter> report;
  for (std::size_t p = 0; p < parameters_.size(); ++p) {
    const FaultParameter& parameter = parameters_[p];
    const auto i = ToIndex(p);
    const double half = k95 * std::sqrt(covariance(i, i));
    const double a = parameter.ValueOf(std::max(z[i] - half, parameter.least));
    const double b = parameter.ValueOf(std::min(z[i] + half, parameter.most));
    report.push_back({parameter.name, parameter.ValueOf(z[i]), std::min(a, b), std::max(a, b)});
  }
  return report;
}

bool FaultModel::Extend(const Eigen::VectorXd& /*z*/, robot::RobotDescription* /*robot*/,
                        robot::CalibrationFile* /*calibration*/) const {
  return false;
}

robot::CalibratedDrive& DriveOf(const std::string& cable, robot::CalibrationFile* calibration) {
  for (robot::CalibratedDrive& drive : calibration->drives) {
    if (drive.cable == cable) return drive;
  }
  return calibration->drives.emplace_back(
      robot::CalibratedDrive{.cable = cable, .drive = {}, .standard_error = {}});
}

robot::CalibratedPressureSensor& PressureSensorOf(const std::string& chamber,
                                                  robot::CalibrationFile* calibration) {
  for (robot::CalibratedPressureSensor& sensor : calibration->pressure_sensors) {
    if (sensor.chamber == chamber) return sensor;
  }
  return calibration->pressure_sensors.emplace_back(
      robot::CalibratedPressureSensor{.chamber = chamber, .zero_Pa = {}, .gain = {}});
}

FittedParameter SizeOf(const std::string& name, const Eigen::VectorXd& z,
                       const Eigen::MatrixXd& covariance) {
  const double size = z.norm();
  const Eigen::VectorXd along =
      size > 0.0 ? Eigen::VectorXd(z / size) : Eigen::VectorXd::Unit(z.size(), 0);
  const double half = k95 * std::sqrt(along.dot(covariance * along));
  return {name, size, std::max(0.0, size - half), size + half};
}

robot::ParameterPtr FaultModel::OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                                       const FaultContext& /*at*/) const {
  return nullptr;
}

std::optional<Push> FaultModel::PushOf(const Eigen::VectorXd& /*z*/,
                                       const FaultContext& /*at*/) const {
  return std::nullopt;
}

void FaultModel::OnView(int /*parameter*/, const Eigen::VectorXd& /*z*/, const FaultContext& /*at*/,
                        Eigen::Matrix3Xd* /*motion_m*/) const {}

void FaultModel::OnMeasurement(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                               const FaultContext& /*at*/, Eigen::Matrix3Xd* /*motion_m*/) const {}

}  // namespace palpate::diagnosis
