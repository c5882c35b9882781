// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/make_experiment.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "components/offline/messages/collected_topics.hpp"
#include "components/offline/messages/experiment_clock.hpp"
#include "components/offline/messages/experiment_tables.hpp"
#include "components/offline/messages/further_cameras.hpp"
#include "components/offline/messages/image_files.hpp"
#include "components/offline/messages/phase_plan.hpp"
#include "components/offline/messages/recorded_camera.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/folders.hpp"
#include "libs/geometry/frames.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::offline {

namespace {

namespace fs = std::filesystem;

/// A part of a path that every file system takes.
std::string FolderName(std::string name) {
  for (char& c : name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
    if (!plain) c = '_';
  }
  return name;
}

std::string Numbered(std::size_t number, const std::string& name) {
  return (number < 10 ? "r0" : "r") + std::to_string(number) + "_" + FolderName(name);
}

/// Whether a normal path names a file below the folder that it is put in.
bool IsBelow(const fs::path& path) {
  return path.is_relative() && path.has_filename() && *path.begin() != ".." && path != ".";
}

/// Phases of /experiment/phase.
std::vector<Phase> PhasesOfTopic(const CollectedTopics& topics) {
  std::vector<Phase> phases;
  bool open = false;
  for (const CollectedPhase& word : topics.phases) {
    if (open && word.time.segment == phases.back().segment) {
      phases.back().end_ns = word.time.t_ns - 1;
    }
    auto recording = ParsePhase(word.text);
    open = recording.has_value();
    if (!open) continue;
    const std::string name = recording->name.empty() ? ToString(recording->kind) : recording->name;
    recording->name = Numbered(phases.size() + 1, name);
    phases.push_back({.recording = std::move(*recording),
                      .begin_ns = word.time.t_ns,
                      .segment = word.time.segment});
  }
  return phases;
}

/// Recordings that were played, one after the other.
std::vector<Phase> PhasesOfSegments(const CollectedTopics& topics) {
  std::vector<Phase> phases;
  bool sorted = true;
  for (const Segment& segment : topics.segments) {
    Phase phase;
    phase.recording.name = FolderName(segment.name);
    phase.segment = static_cast<int>(phases.size());
    sorted = sorted && !segment.name.empty() &&
             (phases.empty() || phases.back().recording.name < phase.recording.name);
    phases.push_back(std::move(phase));
  }
  if (sorted) return phases;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    std::string& name = phases[i].recording.name;
    name = Numbered(i + 1, name.empty() ? "free" : name);
  }
  return phases;
}

class ExperimentMaker {
 public:
  ExperimentMaker(const fs::path& target, const std::vector<std::string>& remap, fs::path robot,
                  fs::path out, const ConfigLoader& load)
      : target_(target),
        robot_(std::move(robot)),
        out_(std::move(out)),
        load_(load),
        remap_(remap),
        recorded_(recording::MessageFilesOf(target)),
        roles_(FindTopics(recorded_, remap)),
        topics_(CollectTopics(recorded_, roles_)) {
    if (auto file = ReadPhaseFile(target, load)) file_ = std::move(*file);
  }

  std::vector<std::string> Run() {
    RequireData();
    const std::int64_t origin_ns = ChooseClock(&topics_, &notes_);
    camera_ = FindCamera(recorded_, roles_, topics_, file_.robot_frame, &notes_);
    further_ = FindFurtherCameras(recorded_, remap_, file_.robot_frame, ClockOf(topics_, origin_ns),
                                  &notes_);
    std::vector<Phase> phases = FindPhases();
    experiment_ = file_.experiment;
    FillExperiment();
    if (origin_ns != 0) {
      notes_.push_back("t_s counts from " + FormatNumber(1e-9 * static_cast<double>(origin_ns)) +
                       " s since the epoch");
    }
    WriteAttachments();
    actuation_.emplace(topics_, file_.cables, FindChambers(), roles_);
    for (Phase& phase : phases) Add(std::move(phase));
    if (experiment_.recordings.empty()) Refuse("no phase holds images or markers");
    experiment::WriteExperiment(experiment_, out_);
    WriteCameras();
    const std::size_t notes_before = notes_.size();
    WriteImages(recorded_, roles_, topics_, camera_, Stretches(), &notes_);
    for (const FurtherRecordedCamera& camera : further_) {
      WriteFurtherCamera(recorded_, camera, Stretches(), &notes_);
    }
    RequireWrittenData({notes_.begin() + static_cast<std::ptrdiff_t>(notes_before), notes_.end()});
    for (const auto& [what, count] : topics_.left_out) {
      notes_.push_back("left out: " + std::to_string(count) + " message(s) of " + what);
    }
    return std::move(notes_);
  }

 private:
  [[noreturn]] void Refuse(const std::string& why) const {
    throw InputError({target_.string()}, why + "; its topics are: " + Listed(roles_.listed));
  }

  void RequireData() const {
    if (!topics_.depth.empty() || !topics_.points.empty() || !topics_.markers.empty()) return;
    std::string why =
        "holds no depth images (sensor_msgs/Image 16UC1 or 32FC1), point clouds or markers "
        "(palpate_msgs/MarkerArray3)";
    for (const auto& [what, count] : topics_.left_out) {
      why += "; " + std::to_string(count) + " message(s) of " + what;
    }
    Refuse(why);
  }

  /// Packed images show only when they are unpacked whether they can be read.
  void RequireWrittenData(const std::vector<std::string>& notes_of_images) const {
    for (const experiment::Recording& recording : experiment_.recordings) {
      const fs::path images = recording.folder / (topics_.depth.empty() ? "clouds" : "depth");
      std::error_code missing;
      const bool written = fs::exists(images) && !fs::is_empty(images, missing);
      if (written || recording.markers) return;
    }
    std::string why = "none of its images or clouds can be read";
    for (const std::string& note : notes_of_images) why += "; " + note;
    Refuse(why);
  }

  std::vector<Phase> FindPhases() {
    if (!file_.phases.empty()) {
      notes_.push_back(std::to_string(file_.phases.size()) + " recording(s) as " +
                       file_.file.string() + " says");
      std::vector<Phase> named = file_.phases;
      for (Phase& phase : named) phase.segment = SegmentOf(phase.recording.name);
      return named;
    }
    std::vector<Phase> phases = PhasesOfTopic(topics_);
    if (!phases.empty()) {
      notes_.push_back(std::to_string(phases.size()) + " recording(s) as " + kPhaseTopic + " says");
      return phases;
    }
    phases = PhasesOfSegments(topics_);
    if (phases.empty()) phases = {Phase{}};
    if (phases.front().recording.name.empty()) {
      phases.front().recording.name = FolderName(target_.stem().string());
    }
    notes_.push_back(std::to_string(phases.size()) + " recording(s) of kind free: neither " +
                     kPhaseTopic + " nor " + PhaseFileOf(target_).string() + " names another");
    return phases;
  }

  /// The segment of the played recording of that name, if there is one.
  int SegmentOf(const std::string& name) const {
    for (std::size_t i = 0; i < topics_.segments.size(); ++i) {
      if (topics_.segments[i].name == name) return static_cast<int>(i);
    }
    return Phase::kAnySegment;
  }

  void FillExperiment() {
    if (!experiment_.T_robot_camera && camera_.T_robot_camera) {
      experiment_.T_robot_camera = camera_.T_robot_camera;
      experiment_.T_robot_camera_error = camera_.T_robot_camera_error;
    }
    for (const FurtherRecordedCamera& camera : further_) {
      const auto known = std::find_if(experiment_.cameras.begin(), experiment_.cameras.end(),
                                      [&](const auto& one) { return one.name == camera.name; });
      if (known != experiment_.cameras.end() || !camera.camera.T_robot_camera) continue;
      auto& settings = experiment_.cameras.emplace_back();
      settings.name = camera.name;
      settings.T_robot_camera = camera.camera.T_robot_camera;
    }
    if (!experiment_.markers_sigma_m) experiment_.markers_sigma_m = MarkerSigma(topics_.markers);
    if (!experiment_.depth_noise && !topics_.setups.empty() &&
        topics_.setups.back().subpixel_px > 0.0) {
      experiment_.depth_noise = {topics_.setups.back().subpixel_px,
                                 topics_.setups.back().depth_unit_m};
    }
    if (experiment_.notes.empty()) experiment_.notes = "made from " + target_.string();
  }

  /// Of the robot file that is known.
  std::vector<std::string> FindChambers() {
    std::vector<std::string> chambers;
    if (topics_.joints.empty()) return chambers;
    const fs::path& robot = robot_.empty() ? experiment_.robot.value_or(fs::path()) : robot_;
    if (robot.empty()) {
      notes_.push_back(
          "joint states are taken for cables: no robot file is known that says which are "
          "chambers (--robot, or one attached to the recording)");
      return chambers;
    }
    try {
      for (const auto& chamber : robot::ReadRobotFile(robot, load_).chambers) {
        chambers.push_back(chamber.name);
      }
    } catch (const InputError& error) {
      if (!robot_.empty()) throw;
      notes_.push_back(
          "joint states are taken for cables: the attached robot file cannot be read: " +
          std::string(error.what()));
    }
    return chambers;
  }

  void Add(Phase phase) {
    experiment::Recording& recording = phase.recording;
    AddMarkers(topics_, phase, {file_.robot_frame, camera_.frame_ids}, &recording, &notes_);
    actuation_->AddTo(phase, &recording);
    AddLoads(topics_, phase, file_, roles_, &recording, &notes_);
    const auto inside = [&](const CollectedImage& image) {
      return phase.Contains(image.time.t_ns, image.time.segment);
    };
    const bool has_images = std::any_of(topics_.depth.begin(), topics_.depth.end(), inside) ||
                            std::any_of(topics_.points.begin(), topics_.points.end(), inside);
    if (!has_images && !recording.markers) {
      notes_.push_back("recording '" + recording.name +
                       "' is left out: it holds neither images nor markers");
      return;
    }
    recording.folder = out_ / "recordings" / recording.name;
    stretches_.push_back({phase.begin_ns, phase.end_ns, phase.segment, recording.folder});
    with_images_.push_back(has_images);
    experiment_.recordings.push_back(std::move(recording));
  }

  void WriteCameras() {
    for (std::size_t i = 0; i < stretches_.size(); ++i) {
      if (!with_images_[i]) continue;
      WriteFile(stretches_[i].folder / "camera.yaml", rgbd::FormatCameraFile(camera_.camera));
    }
  }

  std::vector<Stretch> Stretches() const { return stretches_; }

  void WriteAttachments() {
    for (const recording::Attachment& attachment : recorded_.Attachments()) {
      const fs::path name = fs::path(attachment.name).lexically_normal();
      if (!IsBelow(name)) {
        notes_.push_back("attachment '" + attachment.name +
                         "' is left out: its name is no path below a folder");
        continue;
      }
      const fs::path file = out_ / "attachments" / name;
      experiment::CreateFolder(file.parent_path());
      WriteFile(file, attachment.data);
      notes_.push_back("attachments/" + name.string() + " was attached to the recording");
      const bool yaml = name.extension() == ".yaml" || name.extension() == ".yml";
      const bool robot = yaml && ("\n" + attachment.data).find("\nmesh:") != std::string::npos;
      if (robot && !experiment_.robot) experiment_.robot = file;
    }
  }

  fs::path target_;
  fs::path robot_;  ///< empty: not given
  fs::path out_;
  const ConfigLoader& load_;
  std::vector<std::string> remap_;
  recording::RecordedMessages recorded_;
  TopicRoles roles_;
  CollectedTopics topics_;
  PhaseFile file_;
  RecordedCamera camera_;
  std::vector<FurtherRecordedCamera> further_;
  std::optional<ActuationRows> actuation_;
  experiment::Experiment experiment_;
  std::vector<Stretch> stretches_;  ///< of the experiment's recordings
  std::vector<bool> with_images_;
  std::vector<std::string> notes_;
};

}  // namespace

std::vector<std::string> MakeExperiment(const fs::path& target,
                                        const std::vector<std::string>& remap,
                                        const fs::path& robot, const fs::path& out,
                                        const ConfigLoader& load) {
  return ExperimentMaker(target, remap, robot, out, load).Run();
}

}  // namespace palpate::offline
