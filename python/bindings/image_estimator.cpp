// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "components/calibration/recording_phase.hpp"
#include "components/force_estimation/recording_frames.hpp"
#include "components/force_estimation/shape/known_contacts.hpp"
#include "components/offline/forces/force_replay.hpp"
#include "components/offline/forces/pressure_correction.hpp"
#include "components/offline/forces/shape_stream.hpp"
#include "libs/app/settings.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/seconds.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/bind.hpp"
#include "python/bindings/errors.hpp"
#include "python/bindings/experiment.hpp"
#include "python/bindings/force_estimate.hpp"
#include "python/bindings/keywords.hpp"
#include "python/bindings/replay.hpp"
#include "python/bindings/robot.hpp"

namespace py = pybind11;

namespace palpate::python {

namespace {

using RobotPtr = std::shared_ptr<Robot>;
using RecordingPtr = std::shared_ptr<Recording>;

/// Copies an array of exactly this type, whatever its strides are. Throws InputError for another
/// type or size: values are never converted, as metres would become steps.
template <typename T, int kChannels>
void CopyImage(const py::array& array, const rgbd::CameraModel& camera, const std::string& name,
               rgbd::Image<T, kChannels>* image) {
  const py::ssize_t dimensions = kChannels > 1 ? 3 : 2;
  const bool fits = array.dtype().is(py::dtype::of<T>()) && array.ndim() == dimensions &&
                    array.shape(0) == camera.height_px && array.shape(1) == camera.width_px &&
                    (kChannels == 1 || array.shape(2) == kChannels);
  if (!fits) {
    const std::string channels = kChannels > 1 ? ", " + std::to_string(kChannels) : "";
    throw InputError(name + " must be an array of uint" + std::to_string(8 * sizeof(T)) +
                     " of the shape (" + std::to_string(camera.height_px) + ", " +
                     std::to_string(camera.width_px) + channels + "), as its camera says");
  }
  const auto rows = py::array_t<T, py::array::c_style>(array);  // a view where it has no gaps
  image->width_px = camera.width_px;
  image->height_px = camera.height_px;
  image->values.assign(rows.data(), rows.data() + rows.size());
}

/// The experiment whose poses and errors hold: that of the recording, or one of the given pose.
experiment::Experiment ExperimentOf(const Robot& robot, const Recording* recording,
                                    const std::optional<DoubleArray>& T_robot_camera) {
  experiment::Experiment experiment;
  if (recording != nullptr) experiment = recording->experiment();
  offline::TakePoses(robot.calibration(), &experiment);
  if (T_robot_camera) {
    experiment.T_robot_camera = ReadPose(*T_robot_camera, "T_robot_camera");
    experiment.T_robot_camera_error.reset();
  }
  return experiment;
}

Eigen::Isometry3d PoseIn(const experiment::Experiment& experiment, const Recording* recording,
                         bool is_given) {
  if (recording != nullptr && !is_given) {
    const auto pose =
        experiment::RobotFromCamera(experiment, experiment.recordings[recording->index()]);
    if (std::holds_alternative<Eigen::Isometry3d>(pose)) return std::get<Eigen::Isometry3d>(pose);
    throw InputError(std::get<experiment::NeedsCalibration>(pose).reason);
  }
  if (experiment.T_robot_camera) return *experiment.T_robot_camera;
  throw InputError(
      "the camera pose is not known; give T_robot_camera, or a Robot with a calibration that has "
      "it");
}

/// What palpate-perception and palpate-force-estimation do, with a model of its own.
class ImageEstimator {
 public:
  ImageEstimator(const RobotPtr& robot, const rgbd::RgbdCamera& camera,
                 const std::optional<DoubleArray>& T_robot_camera, const RecordingPtr& recording,
                 offline::BiasFrom bias, const py::kwargs& keywords)
      : robot_(robot), camera_(camera), recording_(recording) {
    if (recording) corrected_ = recording->data();
    offline::CorrectPressures(robot->calibration(), &corrected_);
    const experiment::Experiment experiment = ExperimentOf(*robot, recording.get(), T_robot_camera);
    const Eigen::Isometry3d pose = PoseIn(experiment, recording.get(), T_robot_camera.has_value());
    offline::ForceSettings settings = offline::DefaultForceSettings(experiment, true);
    app::LoadSettings(TreeOf(keywords, "ImageEstimator"), app::ListSettings(settings));
    offline::WidenPosePriors(experiment, &settings.shape);
    model_ = robot->Use([&](const robot::RobotModel& model) {
      return Robot::CopyOf(model,
                           {.solver = settings.forces.solver, .threads = settings.forces.threads});
    });
    const py::gil_scoped_release released;
    MakeStream(settings, bias, pose);
  }

  const RobotPtr& robot() const { return robot_; }

  EstimatePtr Update(double t_s, const py::array& depth_steps,
                     const std::optional<py::array>& color, const CableValues& displacement_m,
                     const CableValues& tension_N, bool contact_free,
                     const std::string& cable_input) {
    const std::int64_t t_ns = std::llround(1e9 * RequireFinite(t_s, "t_s"));
    offline::FrameInputs inputs = InputsAt(t_ns, displacement_m, tension_N, cable_input);
    inputs.contact_free = contact_free;
    rgbd::RgbdFrame frame = TakeFrame();
    frame.stamp_ns = t_ns;
    CopyImage(depth_steps, camera_.depth, "depth_steps", &frame.depth);
    frame.color = {};
    if (color) {
      if (camera_.color.width_px == 0) throw InputError("color is given, and the camera has none");
      CopyImage(*color, camera_.color, "color", &frame.color);
    }
    const py::gil_scoped_release released;
    const std::lock_guard alone(mutex_);
    frame_ = std::move(frame);
    const std::int64_t start_ns = MonotonicNow_ns();
    stream_->Perceive(t_ns, {&frame_});
    const force_estimation::ForceEstimate& forces = stream_->Estimate(std::move(inputs));
    return KeepEstimate(forces, *robot_, NsToSeconds(MonotonicNow_ns() - start_ns));
  }

  void Expect(double t_s, const CableValues& displacement_m, const CableValues& tension_N,
              const std::string& cable_input) {
    const std::int64_t t_ns = std::llround(1e9 * RequireFinite(t_s, "t_s"));
    const auto cables = InputsAt(t_ns, displacement_m, tension_N, cable_input).cables;
    const py::gil_scoped_release released;
    const std::lock_guard alone(mutex_);
    fem::StaticState state = model_->RestState();
    std::vector<robot::DeadLoad> loads;
    if (recording_) {
      loads = calibration::LoadsAt(recording_->data(), *model_, offline::FrameTime_s(t_ns));
    }
    const Status status = model_->Solve(cables, loads, &state).status;
    if (!status.ok()) throw SolveFailure(status);
    stream_->Expect(state.x_m);
  }

 private:
  void MakeStream(const offline::ForceSettings& settings, offline::BiasFrom bias,
                  const Eigen::Isometry3d& pose) {
    if (recording_) {
      model_->SetGravity(experiment::BaseRotation(recording_->data()).transpose() *
                         model_->gravity_m_s2());
    }
    stream_.emplace(offline::MakeShapeStream(*model_, settings, robot_->calibration(), {}, bias));
    stream_->Open({camera_}, {pose});
  }

  /// Given inputs; where none are, those of the recording.
  offline::FrameInputs InputsAt(std::int64_t t_ns, const CableValues& displacement_m,
                                const CableValues& tension_N,
                                const std::string& cable_input) const {
    const double t_s = offline::FrameTime_s(t_ns);
    const robot::CableInput preferred = ReadCableInput(cable_input);
    const bool is_given = !std::holds_alternative<std::monostate>(displacement_m) ||
                          !std::holds_alternative<std::monostate>(tension_N);
    offline::FrameInputs inputs;
    if (is_given || !recording_) {
      inputs.cables = CommandsOf(*robot_, displacement_m, tension_N, preferred);
    } else {
      inputs.cables = force_estimation::CablesAt(corrected_, *model_, preferred, t_s);
    }
    if (recording_) inputs.loads = force_estimation::SitesOfLoads(recording_->data().loads, t_s);
    return inputs;
  }

  /// Its buffers are used again.
  rgbd::RgbdFrame TakeFrame() {
    const std::unique_lock free(mutex_, std::try_to_lock);
    return free ? std::move(frame_) : rgbd::RgbdFrame();
  }

  RobotPtr robot_;
  rgbd::RgbdCamera camera_;
  RecordingPtr recording_;
  experiment::Recording corrected_;  ///< with the pressures of the chambers; empty: none is given
  std::unique_ptr<robot::RobotModel> model_;
  std::optional<offline::ShapeStream> stream_;
  rgbd::RgbdFrame frame_;
  std::mutex mutex_;
};

}  // namespace

void BindImageEstimator(py::module_& module) {
  py::class_<ImageEstimator>(module, "ImageEstimator",
                             "Forces from the images of one camera, frame by frame.")
      .def(py::init([](const RobotPtr& robot, const rgbd::RgbdCamera& camera,
                       const std::optional<DoubleArray>& T_robot_camera,
                       const RecordingPtr& recording, const std::string& bias_frames,
                       const py::kwargs& settings) {
             return std::make_unique<ImageEstimator>(robot, camera, T_robot_camera, recording,
                                                     ReadBiasFrames(bias_frames), settings);
           }),
           py::arg("robot"), py::arg("camera"), py::arg("T_robot_camera") = py::none(),
           py::arg("recording") = py::none(), py::kw_only(), py::arg("bias_frames") = "first")
      .def_property_readonly("robot", &ImageEstimator::robot)
      .def("expect_posture", &ImageEstimator::Expect, py::arg("t_s") = 0.0,
           py::arg("displacement_m") = py::none(), py::arg("tension_N") = py::none(), py::kw_only(),
           py::arg("cable_input") = "displacement")
      .def("update", &ImageEstimator::Update, py::arg("t_s"), py::arg("depth_steps"),
           py::arg("color") = py::none(), py::arg("displacement_m") = py::none(),
           py::arg("tension_N") = py::none(), py::kw_only(), py::arg("contact_free") = false,
           py::arg("cable_input") = "displacement");
}

}  // namespace palpate::python
