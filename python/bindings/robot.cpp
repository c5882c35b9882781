// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "python/bindings/robot.hpp"

#include <algorithm>
#include <cmath>

#include "components/calibration/joint/found_calibration.hpp"
#include "libs/app/project_files.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/robot/robot_description.hpp"

namespace py = pybind11;

namespace palpate::python {

namespace {

double ReadValue(py::handle value, const std::string& name) {
  const double number = value.cast<double>();
  if (std::isinf(number)) throw InputError(name + " is not finite");
  return number;
}

}  // namespace

Robot::Robot(const std::string& robot, const std::string& calibration,
             const fem::SolverSettings& solver)
    : file_(app::FindRobotFile(robot).string()), calibration_name_(calibration), solver_(solver) {
  robot::RobotBody body = robot::BuildRobotBody(robot::ReadRobotFile(file_, app::LoadYaml));
  if (!calibration.empty()) {
    calibration_ = robot::ReadCalibrationFile(calibration, app::LoadYaml);
    robot::ApplyGeometry(calibration_, &body);
  }
  model_ = std::make_unique<robot::RobotModel>(std::move(body), fem::StaticSettings{}, solver_);
  if (!calibration.empty()) robot::ApplyCalibration(calibration_, model_.get());
  cable_names_ = model_->ActuatorNames();
  marker_names_ = model_->MarkerNames();
  part_names_ = calibration::PartNames(model_->body());
}

int Robot::MaterialWithElements(const std::string& part) const {
  const int material = IndexOfWord(part, part_names_, "part");
  const std::vector<std::string> parts = calibration::PartsWithElements(body());
  if (std::find(parts.begin(), parts.end(), part) == parts.end()) {
    throw InputError("part '" + part + "' of robot " + body().name +
                     " has no element; give one of " + Listed(parts));
  }
  return material;
}

std::unique_ptr<robot::RobotModel> Robot::CopyOf(const robot::RobotModel& model,
                                                 const fem::SolverSettings& solver) {
  auto copy = std::make_unique<robot::RobotModel>(model.body(), fem::StaticSettings{}, solver);
  for (int c = 0; c < model.CableCount(); ++c) {
    copy->SetCableFriction(c, model.cable(c).friction());
    copy->SetCableCompliance(c, model.cable(c).compliance_m_N());
    copy->SetPullPoint(c, model.cable(c).pull_point_m());
    copy->SetDrive(c, model.drives()[At(c)]);
  }
  copy->SetGravity(model.gravity_m_s2());
  return copy;
}

std::vector<std::optional<double>> Robot::ReadCables(const CableValues& values,
                                                     const std::string& name) const {
  std::vector<std::optional<double>> read(cable_names_.size());
  if (const auto* by_name = std::get_if<py::dict>(&values)) {
    for (const auto& [cable, value] : *by_name) {
      const auto word = cable.cast<std::string>();
      const double number = ReadValue(value, name + " of cable " + word);
      read[At(IndexOfWord(word, cable_names_, "cable"))] = number;
    }
  } else if (const auto* array = std::get_if<DoubleArray>(&values)) {
    if (array->ndim() != 1 || array->shape(0) != ToIndex(read.size())) {
      throw InputError(name + " must have one number for each of the " +
                       std::to_string(read.size()) + " cables: " + Listed(cable_names_));
    }
    for (std::size_t c = 0; c < read.size(); ++c) read[c] = array->data()[c];
  }
  for (std::size_t c = 0; c < read.size(); ++c) {
    if (read[c] && std::isinf(*read[c])) {
      throw InputError(name + " of cable " + cable_names_[c] + " is not finite");
    }
    if (read[c] && std::isnan(*read[c])) read[c].reset();
  }
  return read;
}

std::vector<robot::ActuatorCommand> CommandsOf(const Robot& robot,
                                               const CableValues& displacement_m,
                                               const CableValues& tension_N,
                                               robot::CableInput preferred) {
  const auto displacements = robot.ReadCables(displacement_m, "displacement_m");
  const auto tensions = robot.ReadCables(tension_N, "tension_N");
  std::vector<robot::ActuatorCommand> commands;
  for (std::size_t c = 0; c < displacements.size(); ++c) {
    if (!robot.traits(c).IsChamber() && tensions[c] && *tensions[c] < 0.0) {
      throw InputError("tension_N of cable " + robot.cable_names()[c] + " is " +
                       FormatNumber(*tensions[c]) + ": a cable cannot push");
    }
    commands.push_back(
        robot::ChooseCommand(robot.traits(c), displacements[c], tensions[c], preferred));
  }
  return commands;
}

robot::CableInput ReadCableInput(const std::string& word) {
  if (word == "displacement") return robot::CableInput::kDisplacement;
  if (word == "tension") return robot::CableInput::kTension;
  throw InputError("cable_input is '" + word + "': it is 'displacement' or 'tension'");
}

}  // namespace palpate::python
