// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <future>
#include <memory>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "components/calibration/joint/fit_refusal.hpp"
#include "components/calibration/joint/found_calibration.hpp"
#include "components/calibration/joint/joint_request.hpp"
#include "components/calibration/joint/misfit_reasons.hpp"
#include "components/calibration/joint/recording_frames.hpp"
#include "components/force_estimation/check_labels.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/robot/calibration_file.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/bind.hpp"
#include "python/bindings/callback.hpp"
#include "python/bindings/errors.hpp"
#include "python/bindings/experiment.hpp"
#include "python/bindings/interrupts.hpp"
#include "python/bindings/robot.hpp"

namespace py = pybind11;

namespace palpate::python {

namespace {

using calibration::CalibrationFrame;
using calibration::FittedValue;
using calibration::JointCalibration;
using calibration::JointRequest;
using RobotPtr = std::shared_ptr<Robot>;
using RecordingPtr = std::shared_ptr<Recording>;

/// A calibration, and the file that it makes.
struct Calibration {
  JointCalibration fit;
  robot::CalibrationFile file;
};

/// Which parameters are estimated; the priors are those of `palpate calibrate`.
struct Wanted {
  std::vector<std::string> parts;  ///< empty: the body, or all regions where they have its elements
  bool actuator_offsets = true;
  bool actuator_gains = false;
  double marker_bias_m = 0.0;
  robot::CableInput preferred = robot::CableInput::kDisplacement;
  int threads = 2;
};

/// The data of all recordings, which must be of one experiment.
std::vector<const experiment::Recording*> DataOf(const std::vector<RecordingPtr>& recordings) {
  if (recordings.empty()) throw InputError("no recording is given");
  std::vector<const experiment::Recording*> data;
  for (const RecordingPtr& recording : recordings) {
    if (&recording->experiment() != &recordings.front()->experiment()) {
      throw InputError("the recordings are of several experiments");
    }
    data.push_back(&recording->data());
  }
  return data;
}

/// With marker offsets where displacements count from a reference window, which tells them.
JointRequest RequestFor(const Robot& robot, const robot::RobotModel& model, const Wanted& wanted,
                        const calibration::RecordedFrames& recorded) {
  JointRequest request;
  request.pose = recorded.has_camera();
  request.own_poses = recorded.own_poses();
  request.actuator_offsets = wanted.actuator_offsets;
  request.actuator_gains = wanted.actuator_gains;
  request.threads = wanted.threads;
  const std::vector<std::string> parts =
      wanted.parts.empty() ? calibration::PartsToFit(robot.body()) : wanted.parts;
  for (const std::string& part : parts) {
    request.moduli.push_back(robot.MaterialWithElements(part));
  }
  if (recorded.has_reference()) {
    request.marker_offset_sigma_m = calibration::OffsetOfMarkers_m(model);
  }
  return request;
}

/// Runs work(stop token, count of iterations) on a thread of its own, tells progress(count), and
/// ends it for Ctrl-C and where progress has failed. Without the GIL.
template <typename Work>
auto RunInterruptibly(const Work& work, Interrupts* interrupts, Callback* progress) {
  std::stop_source stop;
  std::atomic<int> iterations = 0;
  int told = -1;
  auto running =
      std::async(std::launch::async, [&] { return work(stop.get_token(), &iterations); });
  do {
    if (interrupts->Requested() || progress->failed()) stop.request_stop();
    const int done = iterations;
    if (done != told) (*progress)(told = done);
  } while (running.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready);
  return running.get();
}

void RequirePossible(robot::RobotModel& model, const std::vector<CalibrationFrame>& frames,
                     const JointRequest& request, const JointCalibration& fit) {
  const std::string why = calibration::WhyRefused(model, frames, fit, request);
  if (why.empty()) return;
  const std::string reasons = calibration::FindMisfitReasons(model, frames, request).Text();
  throw RunError(why + ". Likely reasons, the best first:\n" + reasons);
}

robot::CalibrationFile FileOf(const JointCalibration& fit, const robot::RobotModel& model,
                              const std::vector<const experiment::Recording*>& recordings,
                              const std::filesystem::path& data) {
  robot::CalibrationFile file = calibration::MakeCalibration(model, recordings, data);
  calibration::TakeFit(fit, model, &file);
  std::erase_if(file.undetermined, [](const robot::Undetermined& number) {
    return number.name.starts_with("marker_offset:");
  });
  return file;
}

std::shared_ptr<Calibration> Calibrate(const RobotPtr& robot,
                                       const std::vector<RecordingPtr>& recordings,
                                       const Wanted& wanted, Callback* progress) {
  const auto data = DataOf(recordings);
  const experiment::Experiment& experiment = recordings.front()->experiment();
  force_estimation::CheckMarkerLabels(experiment,
                                      robot::ReadRobotFile(robot->file(), app::LoadYaml));
  auto model = robot->Use(
      [&](const robot::RobotModel& as_it_is) { return Robot::CopyOf(as_it_is, robot->solver()); });
  calibration::RecordedFrames recorded(experiment, *model, wanted.preferred, wanted.marker_bias_m);
  for (const experiment::Recording* recording : data) {
    recorded.Add(*recording, calibration::IsOfTheCamera(experiment, *recording));
  }
  JointRequest request = RequestFor(*robot, *model, wanted, recorded);
  const std::vector<CalibrationFrame> frames = recorded.frames();
  auto found = std::make_shared<Calibration>();
  Interrupts interrupts;
  {
    const py::gil_scoped_release released;
    found->fit = RunInterruptibly(
        [&](const std::stop_token& stop, std::atomic<int>* iterations) {
          request.stop = stop;
          request.iterations = iterations;
          return calibration::CalibrateFrames(*model, frames, nullptr, request);
        },
        &interrupts, progress);
  }
  interrupts.Raise();
  progress->Raise();
  const py::gil_scoped_release released;
  request.stop = {};
  request.iterations = nullptr;
  RequirePossible(*model, frames, request, found->fit);
  found->file = FileOf(found->fit, *model, data, experiment.folder);
  return found;
}

void BindFittedValue(py::module_& module) {
  py::class_<FittedValue>(module, "FittedValue", "An estimated parameter.")
      .def_readonly("name", &FittedValue::name)
      .def_readonly("unit", &FittedValue::unit)
      .def_readonly("value", &FittedValue::value)
      .def_readonly("prior_mean", &FittedValue::prior_mean)
      .def_readonly("standard_error", &FittedValue::standard_error)
      .def_readonly("determined", &FittedValue::determined)
      .def_readonly("what_would_tell", &FittedValue::what_would_tell);
}

/// [4 x 4], or None where no camera pose was estimated.
py::object PoseOf(const Calibration& found) {
  if (!found.file.pose) return py::none();
  return CopyOfMatrix(found.file.pose->T_robot_camera.matrix());
}

void BindResult(py::module_& module) {
  py::class_<Calibration, std::shared_ptr<Calibration>>(module, "Calibration",
                                                        "Parameters estimated from markers.")
      .def_property_readonly("values", [](const Calibration& found) { return found.fit.values; })
      .def_property_readonly("T_robot_camera", &PoseOf)
      .def_property_readonly("residual_rms_m",
                             [](const Calibration& found) { return found.fit.residual_rms_m; })
      .def_property_readonly("chi_squared",
                             [](const Calibration& found) { return found.fit.chi_squared; })
      .def_property_readonly("degrees_of_freedom",
                             [](const Calibration& found) { return found.fit.degrees_of_freedom; })
      .def_property_readonly("iterations",
                             [](const Calibration& found) { return found.fit.iterations; })
      .def(
          "write",
          [](const Calibration& found, const std::string& file) {
            robot::WriteCalibrationFile(found.file, file);
          },
          py::arg("file"));
}

}  // namespace

void BindCalibration(py::module_& module) {
  BindFittedValue(module);
  BindResult(module);
  module.def(
      "calibrate",
      [](const RobotPtr& robot, const std::vector<RecordingPtr>& recordings,
         std::vector<std::string> parts, bool actuator_offsets, bool actuator_gains,
         double marker_bias_m, const std::string& cable_input, int threads,
         const py::object& progress) {
        if (!(marker_bias_m >= 0.0)) throw InputError("marker_bias_m must be at least 0");
        if (threads < 1 || threads > 64) throw InputError("threads: 1 to 64 are allowed");
        Callback on_progress(progress);
        return Calibrate(robot, recordings,
                         {.parts = std::move(parts),
                          .actuator_offsets = actuator_offsets,
                          .actuator_gains = actuator_gains,
                          .marker_bias_m = marker_bias_m,
                          .preferred = ReadCableInput(cable_input),
                          .threads = threads},
                         &on_progress);
      },
      py::arg("robot"), py::arg("recordings"), py::kw_only(),
      py::arg("parts") = std::vector<std::string>(), py::arg("actuator_offsets") = true,
      py::arg("actuator_gains") = false, py::arg("marker_bias_m") = 0.0,
      py::arg("cable_input") = "displacement", py::arg("threads") = 2,
      py::arg("progress") = py::none());
}

}  // namespace palpate::python
