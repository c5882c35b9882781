// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/simulate/simulation.hpp"

#include <unistd.h>

#include <system_error>
#include <utility>

#include "components/palpate/simulate/recording_writer.hpp"
#include "components/palpate/simulate/sample_times.hpp"
#include "components/palpate/simulate/sealed_answer.hpp"
#include "libs/app/version.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/index.hpp"
#include "libs/core/sha256.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/experiment/folders.hpp"
#include "libs/scenario/robot_names.hpp"

namespace palpate::command {

namespace {

namespace fs = std::filesystem;

/// A temporary folder beside the wanted one; it is renamed when all is done.
class UnfinishedFolder {
 public:
  explicit UnfinishedFolder(fs::path wanted) : wanted_(std::move(wanted)), path_(wanted_) {
    path_ += ".part" + std::to_string(getpid());
    experiment::CreateFolder(path_);
  }
  ~UnfinishedFolder() {
    std::error_code ignored;
    if (!finished_) fs::remove_all(path_, ignored);
  }
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;

  const fs::path& path() const { return path_; }

  void Finish() {
    std::error_code error;
    fs::rename(path_, wanted_, error);
    if (error) throw RunError(wanted_.string() + ": cannot be written: " + error.message());
    finished_ = true;
  }

 private:
  fs::path wanted_;
  fs::path path_;
  bool finished_ = false;
};

fs::path WithoutTrailingSlash(const fs::path& path) {
  const fs::path normal = path.lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

void RefuseWhatIsThere(const SimulationJob& job) {
  for (const fs::path& path : {job.out, job.answer}) {
    if (fs::exists(path)) {
      throw InputError(SourceLocation{path.string()},
                       "exists already and is not overwritten; give another path");
    }
  }
}

class Run {
 public:
  Run(const SimulationJob& job, const MakeBench& make_bench, const ReportProgress& report,
      fs::path folder)
      : job_{job},
        scenario_{job.scenario},
        report_{report},
        folder_{std::move(folder)},
        schedule_{job.scenario, scenario::NamesOf(job.robot).Actuators()},
        marker_noise_{job.seed, "marker noise"} {
    answer_.effects = DrawEffects(scenario_, scenario::NamesOf(job.robot), job.seed);
    bench_ = make_bench(job.robot, scenario_, answer_.effects, job.seed);
    for (int i = 0; i < RecordingCount(); ++i) {
      total_ += static_cast<int>(SampleTimes(schedule_, i).size());
    }
  }

  void MakeRecordings() {
    Expect(bench_->Start(0.0, schedule_.InputsAt(0.0)), "at the start");
    for (int i = 0; i < RecordingCount(); ++i) MakeRecording(i);
  }

  /// Writes experiment.yaml and returns the bytes of the answer, whose hash is in it.
  std::string Seal() {
    answer_.salt = NewSalt();
    answer_.seed = job_.seed;
    answer_.version = app::Version();
    answer_.robot = job_.robot.name;
    answer_.robot_sha256 = Sha256Hex(ReadFile(job_.robot.file));
    answer_.scenario = scenario_.name;
    answer_.scenario_sha256 = Sha256Hex(ReadFile(scenario_.file));
    answer_.mesh_hash = bench_->MeshHash();
    answer_.camera = scenario_.camera.has_value();
    answer_.data_sha256 = HashOfData(folder_);
    std::string bytes = FormatAnswer(answer_);
    WriteSettings(Sha256Hex(bytes));
    return bytes;
  }

  const SimulationCounts& counts() const { return counts_; }

 private:
  int RecordingCount() const { return static_cast<int>(scenario_.recordings.size()); }

  static void Expect(const Status& status, const std::string& when) {
    if (status.ok()) return;
    throw RunError("the simulation did not converge " + when + ": " +
                   std::string(ToString(status.code())) + ": " + status.message());
  }

  void MakeRecording(int index) {
    const auto& plan = scenario_.recordings[At(index)];
    const fs::path folder = folder_ / "recordings" / plan.name;
    RecordingWriter writer(job_.robot, scenario_, plan, folder);
    RecordingTruth truth;
    truth.name = plan.name;
    for (const Instant& instant : RestTimes(schedule_, index)) {
      AdvanceTo(instant.t_s(), schedule_.InputsAt(instant.t_s()), "before '" + plan.name + "'");
    }
    for (const Instant& instant : SampleTimes(schedule_, index)) {
      const scenario::BenchInputs inputs = InputsAt(schedule_, index, instant);
      AdvanceTo(instant.t_s(), inputs, "in '" + plan.name + "'");
      Measure(index, instant, inputs, &writer, &truth);
      report_(++done_, total_);
    }
    writer.Finish(schedule_.Begin_s(index));
    answer_.recordings.push_back(std::move(truth));
    ++counts_.recordings;
  }

  void AdvanceTo(double t_s, const scenario::BenchInputs& inputs, const std::string& where) {
    if (t_s <= time_s_) return;
    Expect(bench_->Advance(t_s, inputs), where + " at " + FormatNumber(t_s) + " s");
    time_s_ = t_s;
  }

  CameraInput CameraInputAt(int index, double t_s, std::size_t camera = 0) const {
    CameraInput input{.camera = camera, .t_s = t_s, .recording = index};
    if (camera > 0) {
      input.T_robot_camera = scenario_.further_cameras[camera - 1].T_robot_camera;
    } else if (scenario_.camera) {
      const auto& plan = scenario_.recordings[At(index)];
      input.T_robot_camera = plan.T_robot_camera.value_or(scenario_.camera->T_robot_camera);
    }
    return input;
  }

  void Measure(int index, const Instant& instant, const scenario::BenchInputs& inputs,
               RecordingWriter* writer, RecordingTruth* truth) {
    const double t_s = instant.t_s();
    const CameraInput input = CameraInputAt(index, t_s);
    if (scenario_.camera) truth->T_robot_camera = bench_->TrueCameraPose(input);
    writer->AddCables(t_s, bench_->Cables());
    if (instant.markers) {
      const Eigen::Isometry3d T_measurement_robot = truth->T_robot_camera.inverse();
      const Eigen::Matrix3Xd measured_m = scenario_.markers->by_depth_camera
                                              ? bench_->MarkersByCamera_m(input)
                                              : T_measurement_robot * bench_->Markers_m();
      writer->AddMarkers(t_s, measured_m, &marker_noise_);
      ++counts_.marker_frames;
    }
    for (const std::size_t camera : instant.cameras) {
      bench_->TakeFrame(inputs, CameraInputAt(index, t_s, camera), &frame_);
      frame_.stamp_ns = instant.t_ns;
      writer->AddImage(camera, frame_);
      ++counts_.images;
    }
    if (instant.markers || !instant.cameras.empty())
      truth->frames.push_back({t_s, bench_->Forces()});
  }

  void WriteSettings(const std::string& answer_sha256) const {
    experiment::Experiment experiment;
    experiment.robot = job_.robot.file;
    if (scenario_.camera) {
      experiment.frame = experiment::MeasurementFrame::kCamera;
      const bool tells_pose = job_.tell_camera_pose || !scenario_.TakesPictures();
      if (tells_pose) experiment.T_robot_camera = scenario_.camera->T_robot_camera;
      for (const scenario::FurtherCamera& camera : scenario_.further_cameras) {
        experiment::CameraSettings& settings = experiment.cameras.emplace_back();
        settings.name = camera.name;
        if (tells_pose) settings.T_robot_camera = camera.T_robot_camera;
        if (camera.clock_offset_s != 0.0) settings.clock_offset_s = camera.clock_offset_s;
      }
    }
    if (scenario_.TakesPictures()) {
      const scenario::DepthNoise& noise = scenario_.camera->noise;
      const bool stereo = noise.sensor == scenario::DepthSensor::kStereo;
      experiment.depth_noise = {.subpixel_px = stereo ? noise.subpixel_px : 0.0,
                                .unit_m = scenario_.camera->camera.depth_unit_m};
    }
    if (scenario_.markers) experiment.markers_sigma_m = scenario_.markers->sigma_m;
    experiment.rest_between_s = scenario_.rest_between_s;
    experiment.notes = std::string("made by palpate simulate ") + app::Version();
    experiment.answer_sha256 = answer_sha256;
    experiment::WriteExperimentSettings(experiment, folder_ / "experiment.yaml");
  }

  const SimulationJob& job_;
  const scenario::Scenario& scenario_;
  const ReportProgress& report_;
  fs::path folder_;
  scenario::Schedule schedule_;
  scenario::Random marker_noise_;
  std::unique_ptr<SimulatedBench> bench_;
  rgbd::RgbdFrame frame_;
  Answer answer_;
  SimulationCounts counts_;
  double time_s_ = 0.0;
  int done_ = 0;
  int total_ = 0;
};

}  // namespace

SimulationCounts Simulate(const SimulationJob& job, const MakeBench& make_bench,
                          const ReportProgress& report) {
  RefuseWhatIsThere(job);
  if (!job.scenario.camera && !job.scenario.markers) {
    throw InputError(SourceLocation{job.scenario.file.string()},
                     "measures nothing: add the key 'camera' or 'markers'");
  }
  if (job.scenario.markers && job.robot.markers.empty()) {
    throw InputError(SourceLocation{job.robot.file.string()},
                     "has no key 'markers', which the scenario measures");
  }
  UnfinishedFolder folder(WithoutTrailingSlash(job.out));
  Run run(job, make_bench, report, folder.path());
  run.MakeRecordings();
  WriteFile(job.answer, run.Seal());
  try {
    folder.Finish();
  } catch (const RunError&) {
    std::error_code ignored;
    fs::remove(job.answer, ignored);
    throw;
  }
  return run.counts();
}

}  // namespace palpate::command
