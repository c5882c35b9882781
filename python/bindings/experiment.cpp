// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "python/bindings/experiment.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <unistd.h>

#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>
#include <utility>
#include <variant>

#include "components/offline/messages/temporary_experiment.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/bind.hpp"

namespace py = pybind11;

namespace palpate::python {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using ExperimentPtr = std::shared_ptr<const experiment::Experiment>;
using RecordingPtr = std::shared_ptr<Recording>;
/// An experiment with its recordings, each made once.
struct OpenExperiment {
  ExperimentPtr data;
  std::vector<std::string> messages;  ///< what was made of recorded messages
  std::vector<RecordingPtr> recordings;
};

ExperimentPtr ReadFolder(const std::string& folder, const std::vector<std::string>& remap) {
  if (!remap.empty()) {
    throw InputError({folder}, "holds no recorded messages, so that remap means nothing");
  }
  return std::make_shared<const experiment::Experiment>(
      experiment::ReadExperiment(folder, app::LoadYaml));
}

/// Temporary folders that are still there: the end of the process that made them removes them, not
/// that of a forked one.
class TemporaryFolders {
 public:
  ~TemporaryFolders() {
    if (getpid() != process_) return;
    std::error_code ignored;
    for (const auto& folder : folders_) std::filesystem::remove_all(folder, ignored);
  }
  void Add(const std::filesystem::path& folder) {
    const std::lock_guard alone(mutex_);
    folders_.insert(folder);
  }
  void Remove(const std::filesystem::path& folder) {
    const std::lock_guard alone(mutex_);
    folders_.erase(folder);
  }

 private:
  const pid_t process_ = getpid();
  std::mutex mutex_;
  std::set<std::filesystem::path> folders_;
};

TemporaryFolders& Folders() {
  static TemporaryFolders folders;
  return folders;
}

/// The experiment and the temporary folder that it is in end together.
struct HeldExperiment {
  HeldExperiment(const std::string& data, const std::vector<std::string>& remap,
                 const std::string& robot)
      : folder(data, remap, robot, app::LoadYaml, [this](const std::filesystem::path& made) {
          if (made.empty()) {
            Folders().Remove(temporary);
          } else {
            Folders().Add(temporary = made);
          }
        }) {}

  std::filesystem::path temporary;
  offline::TemporaryExperiment folder;
  experiment::Experiment read;
};

ExperimentPtr ReadMessages(const std::string& data, const std::vector<std::string>& remap,
                           const std::string& robot, std::vector<std::string>* notes) {
  const auto held = std::make_shared<HeldExperiment>(data, remap, robot);
  *notes = held->folder.notes();
  try {
    held->read = experiment::ReadExperiment(held->folder.path(), app::LoadYaml);
  } catch (const InputError& error) {
    throw InputError(held->folder.Named(error.what()));
  }
  return {held, &held->read};
}

OpenExperiment Open(const std::string& data, const std::vector<std::string>& remap,
                    const std::string& robot) {
  const py::gil_scoped_release released;
  OpenExperiment open;
  open.data = offline::HoldsMessages(data) ? ReadMessages(data, remap, robot, &open.messages)
                                           : ReadFolder(data, remap);
  for (std::size_t k = 0; k < open.data->recordings.size(); ++k) {
    open.recordings.push_back(std::make_shared<Recording>(open.data, k));
  }
  return open;
}

RecordingPtr FindRecording(const OpenExperiment& open, const std::string& name) {
  std::vector<std::string> names;
  for (const RecordingPtr& recording : open.recordings) {
    if (recording->data().name == name) return recording;
    names.push_back(recording->data().name);
  }
  throw InputError(open.data->folder.string() + ": there is no recording '" + name + "'" +
                   DidYouMean(name, names));
}

std::vector<std::string> MarkerNames(const Recording& recording) {
  return recording.data().markers ? recording.data().markers->names : std::vector<std::string>();
}

/// [frames x markers x 3], a view.
py::array Markers(const py::object& self) {
  const auto& recording = self.cast<const Recording&>();
  const Eigen::MatrixXd& markers_m = recording.markers_m();
  return ViewOfColumns(markers_m, self).attr("reshape")(markers_m.cols(), markers_m.rows() / 3, 3);
}

/// Columns of actuation.csv by cable, views.
std::map<std::string, py::object> Columns(const py::object& self,
                                          experiment::ActuatorQuantity quantity) {
  const auto& recording = self.cast<const Recording&>();
  std::map<std::string, py::object> columns;
  if (!recording.data().actuation) return columns;
  const py::object table = ViewOfMatrix(recording.actuation(), self);
  const auto& described = recording.data().actuation->columns;
  for (std::size_t k = 0; k < described.size(); ++k) {
    if (described[k].quantity != quantity) continue;
    columns[described[k].cable] = table.attr("T")[py::int_(k)];
  }
  return columns;
}

std::optional<std::pair<double, double>> SteadyWindow(const Recording& recording) {
  if (!recording.data().steady_window_s) return std::nullopt;
  return std::pair(recording.data().steady_window_s->begin_s,
                   recording.data().steady_window_s->end_s);
}

std::vector<std::pair<double, std::string>> Files(
    const std::vector<experiment::StampedFile>& files) {
  std::vector<std::pair<double, std::string>> listed;
  for (const auto& file : files) listed.emplace_back(file.t_s(), file.file.string());
  return listed;
}

/// [4 x 4] of the first camera, or None where it is not known.
py::object CameraPose(const Recording& recording) {
  const auto pose = experiment::RobotFromCamera(recording.experiment(), recording.data());
  if (!std::holds_alternative<Eigen::Isometry3d>(pose)) return py::none();
  return CopyOfMatrix(std::get<Eigen::Isometry3d>(pose).matrix());
}

void BindLoads(py::module_& module) {
  using experiment::KnownLoad;
  py::class_<KnownLoad>(module, "KnownLoad", "A known external load of a recording.")
      .def_readonly("t_s", &KnownLoad::t_s)
      .def_property_readonly("position_m",
                             [](const KnownLoad& load) { return CopyOfVector(load.position_m); })
      .def_property_readonly("force_N",
                             [](const KnownLoad& load) { return CopyOfVector(load.force_N); })
      .def_readonly("patch_radius_m", &KnownLoad::patch_radius_m);
}

void BindRecording(py::module_& module) {
  py::class_<Recording, RecordingPtr> recording(
      module, "Recording", "A recording; NaN where a marker was not seen or a field is empty.");
  recording.def_property_readonly("name", [](const Recording& one) { return one.data().name; })
      .def_property_readonly("folder",
                             [](const Recording& one) { return one.data().folder.string(); })
      .def_property_readonly("kind", [](const Recording& one) { return ToString(one.data().kind); })
      .def_property_readonly("frame",
                             [](const Recording& one) {
                               return ToString(experiment::FrameOf(one.experiment(), one.data()));
                             })
      .def_property_readonly("T_robot_camera", &CameraPose)
      .def_property_readonly("notes", [](const Recording& one) { return one.data().notes; })
      .def_property_readonly("steady_window_s", &SteadyWindow)
      .def_property_readonly("marker_names", &MarkerNames)
      .def_property_readonly("marker_t_s",
                             [](const py::object& self) {
                               return ViewOfVector(self.cast<const Recording&>().marker_t_s(),
                                                   self);
                             })
      .def_property_readonly("markers_m", &Markers)
      .def_property_readonly("actuation_t_s",
                             [](const py::object& self) {
                               return ViewOfVector(self.cast<const Recording&>().actuation_t_s(),
                                                   self);
                             })
      .def_property_readonly("displacement_m",
                             [](const py::object& self) {
                               return Columns(self, experiment::ActuatorQuantity::kDisplacement);
                             })
      .def_property_readonly("tension_N",
                             [](const py::object& self) {
                               return Columns(self, experiment::ActuatorQuantity::kTension);
                             })
      .def_property_readonly("loads", [](const Recording& one) { return one.data().loads; })
      .def_property_readonly("depth_images",
                             [](const Recording& one) { return Files(one.data().depth_images); })
      .def_property_readonly("color_images",
                             [](const Recording& one) { return Files(one.data().color_images); })
      .def_property_readonly("clouds",
                             [](const Recording& one) { return Files(one.data().clouds); });
  BindImages(module, recording);
}

}  // namespace

Recording::Recording(ExperimentPtr experiment, std::size_t index)
    : experiment_(std::move(experiment)), index_(index) {
  if (data().markers) {
    const auto& frames = data().markers->frames;
    marker_t_s_.resize(ToIndex(frames.size()));
    markers_m_.setConstant(3 * ToIndex(data().markers->names.size()), marker_t_s_.size(), kNan);
    for (Eigen::Index f = 0; f < marker_t_s_.size(); ++f) {
      marker_t_s_[f] = frames[At(f)].t_s;
      const auto& positions_m = frames[At(f)].positions_m;
      for (std::size_t m = 0; m < positions_m.size(); ++m) {
        if (positions_m[m]) markers_m_.col(f).segment<3>(3 * ToIndex(m)) = *positions_m[m];
      }
    }
  }
  if (data().actuation) {
    const experiment::Actuation& table = *data().actuation;
    actuation_t_s_ = Eigen::Map<const Eigen::VectorXd>(table.t_s.data(), ToIndex(table.t_s.size()));
    actuation_.resize(actuation_t_s_.size(), ToIndex(table.columns.size()));
    for (Eigen::Index c = 0; c < actuation_.cols(); ++c) {
      for (Eigen::Index r = 0; r < actuation_.rows(); ++r) {
        actuation_(r, c) = table.columns[At(c)].samples[At(r)].value_or(kNan);
      }
    }
  }
}

void BindExperiment(py::module_& module) {
  BindLoads(module);
  BindRecording(module);
  py::class_<OpenExperiment>(module, "Experiment", "A folder of measured data.")
      .def(py::init(&Open), py::arg("data"), py::kw_only(),
           py::arg("remap") = std::vector<std::string>(), py::arg("robot") = "")
      .def_property_readonly("folder",
                             [](const OpenExperiment& open) { return open.data->folder.string(); })
      .def_property_readonly("robot",
                             [](const OpenExperiment& open) {
                               std::optional<std::string> file;
                               if (open.data->robot) file = open.data->robot->string();
                               return file;
                             })
      .def_property_readonly("notes", [](const OpenExperiment& open) { return open.data->notes; })
      .def_readonly("messages", &OpenExperiment::messages)
      .def_readonly("recordings", &OpenExperiment::recordings)
      .def("recording", &FindRecording, py::arg("name"));
}

}  // namespace palpate::python
