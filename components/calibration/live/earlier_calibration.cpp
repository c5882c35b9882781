// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/live/earlier_calibration.hpp"

#include <algorithm>

#include "libs/core/index.hpp"

namespace palpate::calibration {

namespace {

using Kind = robot::ActuatorCommand::Kind;

/// Thrusts that were read, as the chambers have them.
void CorrectThrusts(const std::vector<robot::CalibratedPressureSensor>& sensors,
                    const robot::RobotModel& model, std::vector<robot::ActuatorCommand>* commands) {
  for (int a = model.CableCount(); a < model.ActuatorCount(); ++a) {
    const robot::ActuatorTraits& chamber = model.traits(a);
    robot::ActuatorCommand& command = commands->at(At(a));
    for (const robot::CalibratedPressureSensor& sensor : sensors) {
      if (sensor.chamber != chamber.name || command.kind != Kind::kTension) continue;
      command.value = chamber.Force_N(sensor.Pressure_Pa(chamber.ReportedForce(command.value)));
    }
  }
}

template <typename Frame>
void ReadFrame(const robot::CalibrationFile& before, const robot::RobotModel& model, Frame* frame) {
  const std::vector<std::string> cable_names = model.ActuatorNames();
  if (before.gravity) frame->gravity_m_s2 = before.gravity->gravity_m_s2;
  CorrectThrusts(before.pressure_sensors, model, &frame->cables);
  for (const robot::CalibratedDrive& actuator : before.drives) {
    const auto name = std::find(cable_names.begin(), cable_names.end(), actuator.cable);
    if (name == cable_names.end()) continue;
    robot::ActuatorCommand& cable = frame->cables.at(At(name - cable_names.begin()));
    if (cable.kind == Kind::kDisplacement) cable.value = actuator.drive.TakenIn_m(cable.value);
  }
}

/// Keeps the parts that were not estimated again.
template <typename Number, typename IsSamePart>
void KeepParts(const std::vector<Number>& before, const IsSamePart& is_same_part,
               std::vector<Number>* found) {
  for (const Number& number : before) {
    const bool again = std::any_of(found->begin(), found->end(), [&](const Number& other) {
      return is_same_part(number, other);
    });
    if (!again) found->push_back(number);
  }
}

/// The correction `before` followed by `found`. A standard error of 0 means not estimated.
robot::CalibratedDrive Compose(const robot::CalibratedDrive& before,
                               const robot::CalibratedDrive& found) {
  robot::CalibratedDrive both = found;
  both.drive.offset_m = found.drive.TakenIn_m(before.drive.offset_m);
  both.drive.gain = (1.0 + before.drive.gain) * (1.0 + found.drive.gain) - 1.0;
  if (found.standard_error.offset_m == 0.0) {
    both.standard_error.offset_m = before.standard_error.offset_m;
  }
  if (found.standard_error.gain == 0.0) both.standard_error.gain = before.standard_error.gain;
  return both;
}

}  // namespace

void ReadAsBefore(const robot::CalibrationFile& before, const robot::RobotModel& model,
                  std::vector<CloudFrame>* frames) {
  for (auto& frame : *frames) ReadFrame(before, model, &frame);
}

void ReadAsBefore(const robot::CalibrationFile& before, const robot::RobotModel& model,
                  std::vector<CalibrationFrame>* frames) {
  for (auto& frame : *frames) ReadFrame(before, model, &frame);
}

void ReadAsBefore(const robot::CalibrationFile& before, const robot::RobotModel& model,
                  std::vector<UnlabelledFrame>* frames) {
  for (UnlabelledFrame& frame : *frames) ReadFrame(before, model, &frame.frame);
}

void KeepFromBefore(const robot::CalibrationFile& before, robot::CalibrationFile* file) {
  const auto of_one_part = [](const auto& one, const auto& other) {
    return one.part == other.part;
  };
  KeepParts(before.moduli, of_one_part, &file->moduli);
  KeepParts(before.poissons_ratios, of_one_part, &file->poissons_ratios);
  KeepParts(
      before.cable_routes,
      [](const robot::CalibratedRoute& one, const robot::CalibratedRoute& other) {
        return one.cable == other.cable && one.point == other.point;
      },
      &file->cable_routes);
  if (!file->geometry_scale) file->geometry_scale = before.geometry_scale;
  if (!file->gravity) file->gravity = before.gravity;
  if (!file->pose) {
    file->pose = before.pose;
    file->depth_bias = before.depth_bias;  // belongs to that pose
  }
  for (const robot::CalibratedDrive& actuator : before.drives) {
    const auto found = std::find_if(
        file->drives.begin(), file->drives.end(),
        [&](const robot::CalibratedDrive& other) { return other.cable == actuator.cable; });
    if (found == file->drives.end()) {
      file->drives.push_back(actuator);
    } else {
      *found = Compose(actuator, *found);
    }
  }
  for (const robot::CalibratedPressureSensor& sensor : before.pressure_sensors) {
    const auto found =
        std::find_if(file->pressure_sensors.begin(), file->pressure_sensors.end(),
                     [&](const auto& other) { return other.chamber == sensor.chamber; });
    if (found == file->pressure_sensors.end()) {
      file->pressure_sensors.push_back(sensor);
    } else {
      *found = robot::Compose(sensor, *found);
    }
  }
}

void KeepCamerasFromBefore(const robot::CalibrationFile& before, robot::CalibrationFile* file) {
  const auto of_one_name = [](const auto& one, const auto& other) {
    return one.name == other.name;
  };
  KeepParts(before.cameras, of_one_name, &file->cameras);
}

}  // namespace palpate::calibration
