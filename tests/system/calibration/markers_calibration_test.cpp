// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/scenario/scenario.hpp"
#include "tests/support/scenarios.hpp"
#include "tests/system/calibration/calibration_listener.hpp"
#include "tests/system/process.hpp"
#include "tests/system/sample_data.hpp"

/// palpate-calibration beside a motion capture: what the virtual bench measured is played.
namespace palpate::system_test {
namespace {

using std::chrono::seconds;
using ::testing::HasSubstr;

/// Three settings of the cables, one after the other, of a body of another mesh than the model's,
/// which is the coarse one here: shapes of many settings are solved to tell markers apart.
const std::string kMarkerScenario =
    "name: settings\n" + test_support::BodyOfAnotherModulus("four_leg.msh") +
    test_support::kOffsetOfNorth + "markers: {sigma_m: 3.0e-4, rate_hz: 20}\n" +
    test_support::kBallBeforeASmallCamera + R"(recordings:
  - name: settings
    kind: ramp
    duration_s: 4.4
    commands: [
      )" +
    test_support::CommandAt(0.0, {0.009, 0.002, 0.003, 0.004}) + ",\n      " +
    test_support::CommandAt(1.2, {0.009, 0.002, 0.003, 0.004}) + ",\n      " +
    test_support::CommandAt(1.6, {0.002, 0.009, 0.002, 0.006}) + ",\n      " +
    test_support::CommandAt(2.8, {0.002, 0.009, 0.002, 0.006}) + ",\n      " +
    test_support::CommandAt(3.2, {0.004, 0.003, 0.008, 0.002}) + ",\n      " +
    test_support::CommandAt(4.4, {0.004, 0.003, 0.008, 0.002}) + "]\n";

/// Rows of markers.csv of one time.
using Rows = std::vector<std::string>;

std::string RestOf(const std::string& row, std::size_t fields) {
  std::size_t at = 0;
  for (; fields > 0; --fields) at = row.find(',', at) + 1;
  return row.substr(at);
}
std::string TimeOf(const std::string& row) { return row.substr(0, row.find(',')); }
/// "t,,x,y,z"
std::string WithoutName(const std::string& row) { return TimeOf(row) + ",," + RestOf(row, 2); }

class LiveCalibrationFromMarkers : public testing::Test {
 protected:
  using Change = std::function<Rows(int picture, Rows rows)>;

  LiveCalibrationFromMarkers() {
    const std::filesystem::path config = std::filesystem::path(PALPATE_SOURCE_DIR) / "config";
    std::filesystem::copy_file(config / "scenarios/four_leg_coarse.msh",
                               folder_ / "four_leg_coarse.msh");
    std::filesystem::copy_file(config / "robots/four_leg.msh", folder_ / "four_leg.msh");
    WriteFile(folder_ / "settings.yaml", kMarkerScenario);
    std::string description = ReadFile(config / "robots/four_leg.yaml");
    const std::string fine = "four_leg.msh";
    description.replace(description.find(fine), fine.size(), "four_leg_coarse.msh");
    WriteFile(folder_ / "four_leg.yaml", description);
    truth_ =
        scenario::ReadScenario(folder_ / "settings.yaml", app::LoadYaml).camera->T_robot_camera;
    robot_ = (folder_ / "four_leg.yaml").string();
    const auto done =
        RunProgram("palpate",
                   {"simulate", robot_, "--scenario", (folder_ / "settings.yaml").string(),
                    "--seed", "11", "--out", (folder_ / "exp").string()},
                   folder_ / "simulate.log");
    EXPECT_EQ(done, 0) << ReadFile(folder_ / "simulate.log");
  }

  /// Of the pictures that were measured.
  void ChangeMarkers(const Change& change) {
    const std::filesystem::path file = folder_ / "exp/recordings/settings/markers.csv";
    std::istringstream lines(ReadFile(file));
    std::string text, line;
    std::getline(lines, line);
    text = line + "\n";
    Rows rows;
    int picture = 0;
    const auto take = [&] {
      if (rows.empty()) return;
      for (const std::string& row : change(picture++, std::move(rows))) text += row + "\n";
      rows.clear();
    };
    while (std::getline(lines, line)) {
      if (!rows.empty() && TimeOf(rows.front()) != TimeOf(line)) take();
      rows.push_back(line);
    }
    take();
    WriteFile(file, text);
  }

  void Start() {
    calibration_ = std::make_unique<Process>(
        "palpate-calibration",
        std::vector<std::string>{robot_, "--out", file_.string(), "--set", "source=markers",
                                 "--set", "at_start=true", "--set", "still_s=0.4", "--set",
                                 "marker_pictures=8", "--set", "frames=3"},
        folder_ / "calibration.log");
    player_ = std::make_unique<Process>(
        "palpate-player",
        std::vector<std::string>{"--data", (folder_ / "exp").string(), "--set", "frame=measured"},
        folder_ / "player.log");
  }

  void ExpectCalibration() {
    ASSERT_TRUE(listener_.WaitForState("", "done")) << Story();
    EXPECT_EQ(listener_.Find("", "done")->taken, 3u);
    ASSERT_TRUE(listener_.WaitFor([&] { return !listener_.found.empty(); }));
    ExpectRight(listener_.found[0], truth_);
    const robot::CalibrationFile file = robot::ReadCalibrationFile(file_, app::LoadYaml);
    EXPECT_EQ(file.data_hash, listener_.found[0].hash);
    ASSERT_EQ(file.drives.size(), 4u);
    EXPECT_NEAR(file.drives[0].drive.offset_m, 8e-4, 3.29 * file.drives[0].standard_error.offset_m);
    EXPECT_LT(file.drives[0].standard_error.offset_m, 5e-4);
    calibration_->Signal(SIGINT);
    EXPECT_EQ(calibration_->Wait(seconds(5)), 0) << calibration_->Output();
  }

  void ExpectFailure(const std::string& reason) {
    ASSERT_FALSE(listener_.WaitForState("", "done")) << Story();
    ASSERT_NE(listener_.Find("", "failed"), nullptr) << Story();
    EXPECT_THAT(listener_.Find("", "failed")->reason, HasSubstr(reason));
    EXPECT_TRUE(listener_.found.empty());
    EXPECT_FALSE(std::filesystem::exists(file_));
  }

  std::string Story() { return listener_.Story() + calibration_->Output() + player_->Output(); }

  TestFolder folder_;
  std::filesystem::path file_ = folder_ / "calibration.yaml";
  std::string robot_;
  Eigen::Isometry3d truth_;
  Listener listener_;
  std::unique_ptr<Process> calibration_, player_;
};

TEST_F(LiveCalibrationFromMarkers, FindsTheCameraFromNamedOnes) {
  Start();
  ExpectCalibration();
}

/// In another order in each picture, one of them missing, and a point that is none.
TEST_F(LiveCalibrationFromMarkers, FindsTheCameraFromThoseWithoutNames) {
  ChangeMarkers([](int picture, Rows rows) {
    rows.erase(rows.begin() + 3);
    for (std::string& row : rows) row = WithoutName(row);
    rows.push_back(TimeOf(rows.front()) + ",,0.15,0.02,0.45");
    std::rotate(rows.begin(), rows.begin() + picture % 5, rows.end());
    return rows;
  });
  Start();
  ExpectCalibration();
}

TEST_F(LiveCalibrationFromMarkers, RefusesNamesThatAreExchanged) {
  ChangeMarkers([](int, Rows rows) {
    const std::string first = TimeOf(rows[0]) + ",leg_east," + RestOf(rows[0], 2);
    const std::string last = TimeOf(rows[8]) + ",tip," + RestOf(rows[8], 2);
    rows[0] = first;
    rows[8] = last;
    return rows;
  });
  Start();
  ExpectFailure("another robot, or other markers");
}

TEST_F(LiveCalibrationFromMarkers, RefusesTooFewWithoutNames) {
  ChangeMarkers([](int, Rows rows) {
    rows.resize(4);
    for (std::string& row : rows) row = WithoutName(row);
    return rows;
  });
  Start();
  ExpectFailure("an assignment needs 5 points, there are 4");
}

}  // namespace
}  // namespace palpate::system_test
