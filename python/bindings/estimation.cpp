// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/pipeline/marker_pipeline.hpp"
#include "components/force_estimation/recording_frames.hpp"
#include "components/force_estimation/shape/known_contacts.hpp"
#include "components/offline/forces/force_replay.hpp"
#include "components/offline/forces/pressure_correction.hpp"
#include "libs/app/settings.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/seconds.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/bind.hpp"
#include "python/bindings/experiment.hpp"
#include "python/bindings/force_estimate.hpp"
#include "python/bindings/keywords.hpp"
#include "python/bindings/robot.hpp"

namespace py = pybind11;

namespace palpate::python {

namespace {

using force_estimation::ForceEstimate;
using force_estimation::MarkerFrame;
using RobotPtr = std::shared_ptr<Robot>;

force_estimation::Config ReadConfig(const py::kwargs& settings) {
  force_estimation::Config config;
  app::LoadSettings(TreeOf(settings, "MarkerEstimator"), app::ListSettings(config));
  return config;
}

force_estimation::ReferenceShape ReadReference(const std::string& word) {
  if (word == "none") return force_estimation::ReferenceShape::kNone;
  if (word == "undeformed") return force_estimation::ReferenceShape::kUndeformed;
  if (word == "equilibrium") return force_estimation::ReferenceShape::kEquilibrium;
  throw InputError("reference is '" + word + "': it is 'none', 'undeformed' or 'equilibrium'");
}

/// The pipeline of `palpate estimate` and of the process, with a model of its own.
class MarkerEstimator {
 public:
  MarkerEstimator(const RobotPtr& robot, const Recording* recording,
                  const force_estimation::Config& config)
      : robot_(robot), model_(robot->Use([&](const robot::RobotModel& model) {
          return robot->CopyOf(model, {.solver = config.solver, .threads = config.threads});
        })) {
    const py::gil_scoped_release released;
    if (recording != nullptr) {
      model_->SetGravity(experiment::BaseRotation(recording->data()).transpose() *
                         model_->gravity_m_s2());
    }
    pipeline_ =
        std::make_unique<force_estimation::MarkerPipeline>(*model_, config, robot->calibration());
  }

  const RobotPtr& robot() const { return robot_; }

  /// What the calibrated pressure sensors read, as the chambers have it.
  std::vector<std::optional<double>> CorrectedForces(
      std::vector<std::optional<double>> forces) const {
    for (std::size_t c = 0; c < forces.size(); ++c) {
      for (const auto& sensor : robot_->calibration().pressure_sensors) {
        if (forces[c] && sensor.chamber == robot_->cable_names()[c]) {
          forces[c] = sensor.Pressure_Pa(*forces[c]);
        }
      }
    }
    return forces;
  }

  MarkerFrame FrameOf(double t_s, const DoubleArray& markers_m, const CableValues& displacement_m,
                      const CableValues& tension_N, double sigma_m, const std::string& reference,
                      const std::string& cable_input) const {
    MarkerFrame frame;
    frame.t_s = RequireFinite(t_s, "t_s");
    frame.reference = ReadReference(reference);
    ReadMarkers(markers_m, sigma_m, &frame);
    const auto displacements = robot_->ReadCables(displacement_m, "displacement_m");
    const auto tensions = CorrectedForces(robot_->ReadCables(tension_N, "tension_N"));
    const robot::CableInput preferred = ReadCableInput(cable_input);
    for (std::size_t c = 0; c < displacements.size(); ++c) {
      if (!robot_->traits(c).IsChamber() && tensions[c] && *tensions[c] < 0.0) {
        throw InputError("tension_N of cable " + robot_->cable_names()[c] +
                         " is negative: a cable cannot push");
      }
      frame.cables.push_back(
          model_->CommandFor(static_cast<int>(c), displacements[c], tensions[c], preferred));
    }
    return frame;
  }

  EstimatePtr Update(MarkerFrame frame) {
    const py::gil_scoped_release released;
    const std::lock_guard alone(mutex_);
    const std::int64_t start_ns = MonotonicNow_ns();
    const ForceEstimate& forces = pipeline_->Update(std::move(frame)).estimate;
    return KeepEstimate(forces, *robot_, NsToSeconds(MonotonicNow_ns() - start_ns));
  }

 private:
  void ReadMarkers(const DoubleArray& markers_m, double sigma_m, MarkerFrame* frame) const {
    const auto count = ToIndex(robot_->marker_names().size());
    if (markers_m.ndim() != 2 || markers_m.shape(0) != count || markers_m.shape(1) != 3) {
      throw InputError("markers_m must have the shape (" + std::to_string(count) +
                       ", 3), NaN where a marker was not seen");
    }
    if (!(sigma_m >= 0.0) || std::isinf(sigma_m)) {
      throw InputError("sigma_m is " + std::to_string(sigma_m) + ": at least 0 is allowed");
    }
    const double* coordinates_m = markers_m.data();
    frame->markers.resize(At(count));
    for (auto& marker : frame->markers) {
      marker.position_m = {coordinates_m[0], coordinates_m[1], coordinates_m[2]};
      marker.valid = marker.position_m.allFinite();
      marker.sigma_m.setConstant(sigma_m);
      coordinates_m += 3;
    }
  }

  RobotPtr robot_;
  std::unique_ptr<robot::RobotModel> model_;
  std::unique_ptr<force_estimation::MarkerPipeline> pipeline_;
  std::mutex mutex_;
};

/// The frames of a recording as `palpate estimate` makes them, in the calibrated camera pose.
std::vector<MarkerFrame> FramesOf(const Recording& recording, const RobotPtr& robot,
                                  const std::string& cable_input) {
  experiment::Experiment experiment = recording.experiment();
  offline::TakePoses(robot->calibration(), &experiment);
  experiment::Recording corrected = recording.data();
  offline::CorrectPressures(robot->calibration(), &corrected);
  const robot::CableInput preferred = ReadCableInput(cable_input);
  return robot->Use([&](const robot::RobotModel& model) {
    auto frames = force_estimation::FramesOfRecording(experiment, corrected, model, preferred);
    for (MarkerFrame& frame : frames) {
      frame.loads = force_estimation::SitesOfLoads(recording.data().loads, frame.t_s);
    }
    return frames;
  });
}

}  // namespace

void BindEstimation(py::module_& module) {
  py::class_<MarkerFrame>(module, "MarkerFrame", "What was measured at one time.")
      .def_readonly("t_s", &MarkerFrame::t_s)
      .def_property_readonly("is_reference", [](const MarkerFrame& frame) {
        return frame.reference != force_estimation::ReferenceShape::kNone;
      });
  module.def("marker_frames", &FramesOf, py::arg("recording"), py::arg("robot"), py::kw_only(),
             py::arg("cable_input") = "displacement");
  py::class_<MarkerEstimator>(module, "MarkerEstimator", "Forces from markers, frame by frame.")
      .def(py::init(
               [](const RobotPtr& robot, const Recording* recording, const py::kwargs& settings) {
                 return std::make_unique<MarkerEstimator>(robot, recording, ReadConfig(settings));
               }),
           py::arg("robot"), py::arg("recording") = py::none())
      .def_property_readonly("robot", &MarkerEstimator::robot)
      .def("frame", &MarkerEstimator::FrameOf, py::arg("t_s"), py::arg("markers_m"),
           py::arg("displacement_m") = py::none(), py::arg("tension_N") = py::none(), py::kw_only(),
           py::arg("sigma_m") = 0.0, py::arg("reference") = "none",
           py::arg("cable_input") = "displacement")
      .def("update", &MarkerEstimator::Update, py::arg("frame"));
}

}  // namespace palpate::python
