// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/palpate/markers/marked_bar.hpp"

#include <algorithm>
#include <numeric>

#include "components/palpate/find_robot.hpp"
#include "libs/app/child_process.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::command {

namespace {

const Eigen::Vector3d kTip_m(0.08, 0.01, 0.02);

}  // namespace

const std::vector<Eigen::Vector3d>& MarkedBar::Twelve() {
  static const std::vector<Eigen::Vector3d> places_m = {
      {0.080, 0.010, 0.020}, {0.080, 0.000, 0.000}, {0.080, 0.020, 0.004}, {0.066, 0.000, 0.014},
      {0.060, 0.020, 0.010}, {0.055, 0.007, 0.020}, {0.047, 0.012, 0.000}, {0.040, 0.000, 0.003},
      {0.036, 0.020, 0.018}, {0.027, 0.014, 0.020}, {0.021, 0.005, 0.000}, {0.014, 0.020, 0.007}};
  return places_m;
}

MarkedBar::MarkedBar() {
  std::filesystem::create_directories(folder_ / "data/recordings");
  folder_.Write("data/experiment.yaml", "frame: camera\nmarkers_sigma_m: 1.0e-4\n");
  robot_ = WriteRobot(Twelve());
  truth_ = LoadRobot(robot_, {});
}

std::filesystem::path MarkedBar::WriteRobot(const std::vector<Eigen::Vector3d>& markers_m,
                                            const std::string& name) const {
  std::string text = ReadFile(WriteBarRobot(folder_));
  const std::string old = "markers: [{name: tip, position_m: [0.08, 0.01, 0.02]}]";
  std::string markers = "markers:\n";
  for (std::size_t m = 0; m < markers_m.size(); ++m) {
    markers += "  - {name: m" + std::to_string(m) + ", position_m: [";
    for (int i = 0; i < 3; ++i) markers += (i > 0 ? ", " : "") + FormatNumber(markers_m[m][i]);
    markers += "]}\n";
  }
  text.replace(text.find(old), old.size(), markers);
  text.replace(text.find("max_tension_N: 1"), 16, "max_tension_N: 9");
  return folder_.Write(name, text);
}

MarkedBar::Points MarkedBar::See(const BarSight& sight) {
  fem::StaticState state = truth_->RestState();
  std::vector<robot::DeadLoad> loads;
  if (sight.load_N > 0.0) {
    loads.push_back({truth_->Patch(kTip_m, 0.0).weights, {0.0, 0.0, -sight.load_N}});
  }
  const auto solved =
      truth_->Solve({{robot::ActuatorCommand::Kind::kDisplacement, sight.commanded_m + kOffset_m}},
                    loads, &state);
  EXPECT_TRUE(solved.status.ok()) << solved.status.message();
  std::normal_distribution<double> noise(0.0, kNoise_m);
  Points points;
  const auto& markers = truth_->body().markers;
  for (std::size_t m = 0; m < markers.size(); ++m) {
    const auto listed = std::find(sight.markers.begin(), sight.markers.end(), static_cast<int>(m));
    if (!sight.markers.empty() && listed == sight.markers.end()) continue;
    Eigen::Vector3d seen_m =
        T_robot_camera_.inverse() * markers[m].point.weights.Position(state.x_m);
    for (int i = 0; i < 3; ++i) seen_m[i] += noise(random_);
    if (sight.spoil) seen_m = sight.spoil(seen_m);
    points.emplace_back(sight.names ? markers[m].name : "", seen_m);
  }
  for (const Eigen::Vector3d& false_m : sight.false_m) points.emplace_back("", false_m);
  if (!sight.names) std::shuffle(points.begin(), points.end(), random_);
  return points;
}

void MarkedBar::WriteInputs(const BarSight& sight) const {
  const std::string folder = "data/recordings/" + sight.name;
  std::filesystem::create_directories(folder_ / folder);
  folder_.Write(folder + "/recording.yaml", "kind: " + sight.kind + "\n");
  if (sight.load_N > 0.0 && sight.tell_load) {
    folder_.Write(folder + "/loads.csv", "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N\n0,0.08,0.01,0.02,0,0," +
                                             FormatNumber(-sight.load_N) + "\n");
  }
  const std::string value = FormatNumber(sight.commanded_m);
  folder_.Write(folder + "/actuation.csv",
                "t_s,top.displacement_m\n0," + value + "\n1," + value + "\n");
}

void MarkedBar::Record(const BarSight& sight) {
  WriteInputs(sight);
  std::string text = "t_s,marker,x_m,y_m,z_m\n";
  for (const auto& [name, at_m] : See(sight)) {
    text += "0.5," + name;
    for (int i = 0; i < 3; ++i) text += "," + FormatNumber(at_m[i]);
    text += "\n";
  }
  folder_.Write("data/recordings/" + sight.name + "/markers.csv", text);
}

void MarkedBar::RecordThree(BarSight sight) {
  for (const int millimetres : {2, 5, 8}) {
    sight.name = "hold_" + std::to_string(millimetres);
    sight.commanded_m = 1e-3 * millimetres;
    Record(sight);
  }
}

void MarkedBar::TellPose(const Eigen::Isometry3d& T_robot_camera, const std::string& error) const {
  std::string pose = geometry::FormatPose(T_robot_camera);
  pose.insert(pose.size() - 1, error);
  folder_.Write("data/experiment.yaml",
                "frame: camera\nmarkers_sigma_m: 1.0e-4\nT_robot_camera: " + pose + "\n");
}

void MarkedBar::ChangeRobot(const std::string& old, const std::string& by, bool truth) {
  std::string text = ReadFile(robot_);
  ASSERT_NE(text.find(old), std::string::npos) << old;
  folder_.Write("bar.yaml", text.replace(text.find(old), old.size(), by));
  if (truth) truth_ = LoadRobot(robot_, {});
}

ProgramRun MarkedBar::Run(std::vector<std::string> words) const {
  const auto log = folder_ / "log";
  app::ChildProcess process(PALPATE_BINARY_DIR "/bin/palpate", std::move(words), {}, log);
  const int code = process.Wait();
  return {code, ReadFile(log)};
}

ProgramRun MarkedBar::Calibrate(std::vector<std::string> more) const {
  std::vector<std::string> words = {"calibrate", robot_.string(),
                                    "--data",    (folder_ / "data").string(),
                                    "--out",     (folder_ / "calibration.yaml").string()};
  words.insert(words.end(), more.begin(), more.end());
  return Run(std::move(words));
}

robot::CalibrationFile MarkedBar::Found() const {
  return robot::ReadCalibrationFile(folder_ / "calibration.yaml", app::LoadYaml);
}

void MarkedBar::ExpectFailure(const ProgramRun& run, const std::string& reason) const {
  EXPECT_EQ(run.exit_code, 1) << run.output;
  EXPECT_THAT(run.output, testing::HasSubstr(reason));
  EXPECT_FALSE(HasFile());
}

void MarkedBar::ExpectPose(double most_m) const {
  const robot::CalibrationFile file = Found();
  ASSERT_TRUE(file.pose);
  const Eigen::Vector3d middle_m(0.04, 0.01, 0.01);
  const Eigen::Vector3d off_m =
      file.pose->T_robot_camera * (T_robot_camera_.inverse() * middle_m) - middle_m;
  EXPECT_LT(off_m.norm(), most_m);
  const Eigen::Matrix3d turn =
      file.pose->T_robot_camera.linear() * T_robot_camera_.linear().transpose();
  EXPECT_LT(Eigen::AngleAxisd(turn).angle(), 4.0 * file.pose->rotation_error_rad.norm());
}

}  // namespace palpate::command
