// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "libs/fem/sparse/solver_settings.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_model.hpp"
#include "python/bindings/arrays.hpp"

namespace palpate::python {

/// What Python gives for the cables: nothing, a value for each name, or a value for each cable in
/// the robot's order, NaN where nothing is known.
using CableValues = std::variant<std::monostate, pybind11::dict, DoubleArray>;

/// A robot file with its model, as Python has it. One thread at a time uses the model; whoever
/// waits for it does not hold the GIL.
class Robot {
 public:
  /// `robot`: a file, or the name of a robot that comes with palpate. `calibration`: a file, or
  /// empty. Throws InputError.
  Robot(const std::string& robot, const std::string& calibration,
        const fem::SolverSettings& solver);

  const robot::RobotBody& body() const { return model_->body(); }
  const std::string& file() const { return file_; }
  const robot::CalibrationFile& calibration() const { return calibration_; }
  /// Of its file; empty: none was given.
  const std::string& calibration_name() const { return calibration_name_; }
  /// Of cables, then of chambers.
  const std::vector<std::string>& cable_names() const { return cable_names_; }
  const robot::ActuatorTraits& traits(std::size_t actuator) const {
    return model_->traits()[actuator];
  }
  const std::vector<std::string>& marker_names() const { return marker_names_; }
  /// "body", then the regions: the order of RobotBody::materials.
  const std::vector<std::string>& part_names() const { return part_names_; }
  /// Index of a part's material. Throws InputError for one that no element has: a change of it
  /// would do nothing.
  int MaterialWithElements(const std::string& part) const;

  /// Calls work(model) without the GIL and alone.
  template <typename Work>
  auto Use(Work&& work) {
    const pybind11::gil_scoped_release released;
    const std::lock_guard alone(mutex_);
    return std::forward<Work>(work)(*model_);
  }

  /// A model of its own as this one is now, for who keeps a state in it. Inside of Use.
  static std::unique_ptr<robot::RobotModel> CopyOf(const robot::RobotModel& model,
                                                   const fem::SolverSettings& solver);
  const fem::SolverSettings& solver() const { return solver_; }

  /// Values in the robot's order, nullopt where nothing is known. Throws InputError for an unknown
  /// cable, another number of values, infinity; `name` is the argument's.
  std::vector<std::optional<double>> ReadCables(const CableValues& values,
                                                const std::string& name) const;

 private:
  std::string file_;
  std::string calibration_name_;
  robot::CalibrationFile calibration_;
  fem::SolverSettings solver_;
  std::unique_ptr<robot::RobotModel> model_;
  std::vector<std::string> cable_names_, marker_names_, part_names_;
  std::mutex mutex_;
};

/// Boundary conditions of the cables for measured or wanted inputs, as `palpate solve` takes them.
/// Throws InputError also for a negative tension.
std::vector<robot::ActuatorCommand> CommandsOf(const Robot& robot,
                                               const CableValues& displacement_m,
                                               const CableValues& tension_N,
                                               robot::CableInput preferred);

/// "displacement" or "tension". Throws InputError.
robot::CableInput ReadCableInput(const std::string& word);

void BindRobot(pybind11::module_& module);

}  // namespace palpate::python
