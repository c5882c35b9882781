// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/offline/forces/force_replay.hpp"
#include "components/offline/forces/pressure_correction.hpp"
#include "libs/app/settings.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"
#include "python/bindings/bind.hpp"
#include "python/bindings/callback.hpp"
#include "python/bindings/experiment.hpp"
#include "python/bindings/force_estimate.hpp"
#include "python/bindings/interrupts.hpp"
#include "python/bindings/keywords.hpp"
#include "python/bindings/replay.hpp"
#include "python/bindings/robot.hpp"

namespace py = pybind11;

namespace palpate::python {

namespace {

using RobotPtr = std::shared_ptr<Robot>;
using RecordingPtr = std::shared_ptr<Recording>;

/// The forces of a recording.
struct RecordingForces {
  RecordingPtr recording;
  std::string measurement;
  std::vector<EstimatePtr> frames;
  std::optional<std::string> failure;
};

/// The arguments of `estimate` that are not settings.
struct Request {
  std::string measurement;  ///< "shape", "markers", or empty
  offline::BiasFrom bias = offline::BiasFrom::kRecordings;
  double rate_Hz = 0.0;
  robot::CableInput cable_input = robot::CableInput::kDisplacement;
};

/// The places of the recordings in their experiment, which must be one.
std::vector<std::size_t> IndicesOf(const std::vector<RecordingPtr>& recordings) {
  if (recordings.empty()) throw InputError("no recording is given");
  std::vector<std::size_t> indices;
  for (const RecordingPtr& recording : recordings) {
    if (&recording->experiment() != &recordings.front()->experiment()) {
      throw InputError("the recordings are of several experiments");
    }
    indices.push_back(recording->index());
  }
  return indices;
}

/// What one call of `estimate` works with. Without the GIL, but for the callbacks.
class Replay {
 public:
  Replay(const RobotPtr& robot, const std::vector<RecordingPtr>& recordings,
         const offline::ForceSettings& settings, const Request& request, Callback& progress,
         Callback& note)
      : robot_(*robot),
        recordings_(recordings),
        experiment_(recordings.front()->experiment()),
        progress_(progress),
        note_(note),
        model_(robot->Use([&](const robot::RobotModel& model) {
          return Robot::CopyOf(
              model, {.solver = settings.forces.solver, .threads = settings.forces.threads});
        })) {
    offline::TakePoses(robot_.calibration(), &experiment_);
    offline::CorrectPressures(robot_.calibration(), &experiment_);
    std::vector<const experiment::Recording*> wanted;
    for (const std::size_t index : IndicesOf(recordings)) {
      wanted.push_back(&experiment_.recordings[index]);
    }
    plan_ = offline::PlanEstimates(experiment_, wanted, request.measurement);
    replay_ = std::make_unique<offline::ForceReplay>(
        offline::ForceReplay::Inputs{
            .experiment = experiment_,
            .model = model_.get(),
            .calibration = robot_.calibration(),
            .calibration_name = robot_.calibration_name(),
            .cable_input = request.cable_input,
            .bias = request.bias,
            .limits = {.rate_Hz = request.rate_Hz,
                       .stop_requested = [this] { return Stopped(); },
                       .progress = [this](int done, int total) { progress_(name_, done, total); }},
            .open =
                [this](const experiment::Recording& recording) {
                  auto images = experiment::OpenRecordingImages(recording, app::LoadYaml);
                  for (const std::string& said : images.notes) note_(said);
                  return images;
                },
            .note = [this](const std::string& text) { note_(text); }},
        settings);
  }

  std::vector<RecordingForces> Run() {
    std::vector<RecordingForces> all;
    replay_->Prepare(plan_);
    for (std::size_t k = 0; k < plan_.size() && !Stopped(); ++k) {
      name_ = plan_[k].recording->name;
      RecordingForces& forces = all.emplace_back();
      forces.recording = recordings_[k];
      forces.measurement = offline::ToString(plan_[k].from);
      std::int64_t before_ns = MonotonicNow_ns();
      const auto take = [&](const force_estimation::ForceEstimate& estimate) {
        const std::int64_t now_ns = MonotonicNow_ns();
        forces.frames.push_back(KeepEstimate(estimate, robot_, NsToSeconds(now_ns - before_ns)));
        before_ns = now_ns;
      };
      forces.failure = replay_->Estimate(plan_[k], take).failure;
      if (forces.failure) note_(*forces.failure);
    }
    return all;
  }

  /// With the GIL.
  void Raise() const {
    interrupts_.Raise();
    progress_.Raise();
    note_.Raise();
  }

 private:
  bool Stopped() { return progress_.failed() || note_.failed() || interrupts_.Requested(); }

  const Robot& robot_;
  const std::vector<RecordingPtr>& recordings_;
  experiment::Experiment experiment_;
  Callback& progress_;
  Callback& note_;
  Interrupts interrupts_;
  std::unique_ptr<robot::RobotModel> model_;
  std::vector<offline::PlannedRecording> plan_;
  std::unique_ptr<offline::ForceReplay> replay_;
  std::string name_ = "depth bias";  ///< of what is worked at
};

std::vector<RecordingForces> EstimateRecordings(const RobotPtr& robot,
                                                const std::vector<RecordingPtr>& recordings,
                                                const Request& request, const py::object& progress,
                                                const py::object& note,
                                                const py::kwargs& keywords) {
  if (!(request.rate_Hz >= 0.0)) throw InputError("rate_Hz must be 0 or more");
  IndicesOf(recordings);
  offline::ForceSettings settings = offline::DefaultForceSettings(
      recordings.front()->experiment(), request.bias == offline::BiasFrom::kFirst);
  app::LoadSettings(TreeOf(keywords, "estimate"), app::ListSettings(settings));
  Callback on_progress(progress), on_note(note);
  std::vector<RecordingForces> forces;
  Replay replay(robot, recordings, settings, request, on_progress, on_note);
  {
    const py::gil_scoped_release released;
    forces = replay.Run();
  }
  replay.Raise();
  return forces;
}

std::string ReadMeasurement(const std::optional<std::string>& word) {
  if (!word) return "";
  if (*word == "shape" || *word == "markers") return *word;
  throw InputError("measurement is '" + *word + "': it is 'shape' or 'markers'");
}

}  // namespace

offline::BiasFrom ReadBiasFrames(const std::string& word) {
  if (word == "recordings") return offline::BiasFrom::kRecordings;
  if (word == "first") return offline::BiasFrom::kFirst;
  if (word == "none") return offline::BiasFrom::kNone;
  throw InputError("bias_frames is '" + word + "': it is 'recordings', 'first' or 'none'");
}

void BindReplay(py::module_& module) {
  py::class_<RecordingForces>(module, "RecordingForces", "The forces of a recording.")
      .def_readonly("recording", &RecordingForces::recording)
      .def_readonly("measurement", &RecordingForces::measurement)
      .def_readonly("frames", &RecordingForces::frames)
      .def_readonly("failure", &RecordingForces::failure);
  module.def(
      "estimate",
      [](const RobotPtr& robot, const std::vector<RecordingPtr>& recordings,
         const std::optional<std::string>& measurement, const std::string& bias_frames,
         double rate_Hz, const std::string& cable_input, const py::object& progress,
         const py::object& note, const py::kwargs& settings) {
        return EstimateRecordings(robot, recordings,
                                  {.measurement = ReadMeasurement(measurement),
                                   .bias = ReadBiasFrames(bias_frames),
                                   .rate_Hz = rate_Hz,
                                   .cable_input = ReadCableInput(cable_input)},
                                  progress, note, settings);
      },
      py::arg("robot"), py::arg("recordings"), py::kw_only(), py::arg("measurement") = py::none(),
      py::arg("bias_frames") = "recordings", py::arg("rate_Hz") = 0.0,
      py::arg("cable_input") = "displacement", py::arg("progress") = py::none(),
      py::arg("note") = py::none());
}

}  // namespace palpate::python
