// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/support/scenarios.hpp"
#include "tests/system/process.hpp"
#include "tests/system/sample_data.hpp"

/// palpate-player, palpate-perception and palpate-force-estimation on recorded images against
/// `palpate estimate`.
namespace palpate::system_test::recorded_images {
namespace {

using std::chrono::seconds;

constexpr auto kUntouched = "shape.untouched_frames=4";

/// Of places in m and forces in N, after fits that end at a tolerance of their own.
constexpr double kRounding = 1e-3;

const std::string kBody = R"(name: pressed
body: {mesh_file: four_leg_coarse.msh, refine: 0, element: tet10}
)" + test_support::kBallBeforeASmallCamera;

/// Opposite the small camera, 12 ms behind it.
const std::string kBackCamera = R"(cameras:
  - name: back
    delay_s: 0.012
    depth: {width_px: 424, height_px: 240, fx_px: 212, fy_px: 212, cx_px: 211.5, cy_px: 119.5,
            unit_m: 0.0001, baseline_m: 0.05}
    color: {width_px: 424, height_px: 240, fx_px: 212, fy_px: 212, cx_px: 211.5, cy_px: 119.5,
            registered_to_depth: true}
    eye_m: [-0.343, 0.198, 0.275]
    target_m: [0, 0, 0.065]
    rate_hz: 10
    noise: {sensor: stereo}
)";

/// A ball that presses on the hub, in two recordings.
const std::string kRecordings = R"(recordings:
  - name: a_press
    kind: free
    duration_s: 1
    tools:
      - tool: ball
        path:
          - {t_s: 0.45, position_m: [0.0290, -0.0290, 0.103]}
          - {t_s: 0.8, position_m: [0.0220, -0.0220, 0.103]}
          - {t_s: 1, position_m: [0.0220, -0.0220, 0.103]}
  - name: b_pull
    kind: free
    duration_s: 0.4
    commands: [{t_s: 0, east.displacement_m: 0}, {t_s: 0.37, east.displacement_m: 0.002}]
    tools: [{tool: ball, path: [{t_s: 0, position_m: [0.0230, -0.0230, 0.103]}]}]
)";

/// What is said of one frame: its status where there are no forces, else name, place, force and
/// interval of each.
struct Outcome {
  std::int64_t stamp_ns = 0;
  std::string status;
  std::vector<std::pair<std::string, std::vector<double>>> forces;

  bool operator==(const Outcome&) const = default;
};

std::ostream& operator<<(std::ostream& stream, const Outcome& outcome) {
  stream << outcome.stamp_ns << " ns, " << outcome.status;
  for (const auto& [name, numbers] : outcome.forces) {
    stream << ", " << name;
    for (const double number : numbers) stream << " " << FormatNumber(number);
  }
  return stream;
}

/// forces.csv of `palpate estimate`, frame by frame.
std::vector<Outcome> ReadForcesCsv(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  std::vector<Outcome> outcomes;
  while (std::getline(stream, line)) {
    std::vector<std::string> fields;
    std::istringstream row(line);
    for (std::string field; std::getline(row, field, ',');) fields.push_back(field);
    EXPECT_EQ(std::ranges::count(line, ','), 23) << line;
    const std::int64_t stamp_ns = std::llround(std::stod(fields[1]) * 1e9);
    if (outcomes.empty() || outcomes.back().stamp_ns != stamp_ns) {
      outcomes.push_back({stamp_ns, fields[2].empty() ? fields[11] : "ok", {}});
    }
    if (fields[2].empty()) continue;
    std::vector<double> numbers;
    for (std::size_t i = 3; i < 11; ++i) numbers.push_back(std::stod(fields[i]));
    outcomes.back().forces.emplace_back(fields[2], std::move(numbers));
  }
  return outcomes;
}

/// Notes what /forces says, each frame once.
class Listener {
 public:
  Listener()
      : node_("listener"),
        forces_(node_.participant.CreateReader(dds::kForcesTopic, node_.Waker())) {
    node_.loop.Attach(forces_, [this] {
      for (const auto& message : forces_.Take()) Note(message);
    });
  }
  const std::vector<Outcome>& outcomes() const { return outcomes_; }
  const std::vector<std::string>& reasons() const { return reasons_; }

  template <typename Condition>
  bool WaitFor(const Condition& condition) {
    return node_.loop.DispatchUntil(condition, dds::WaitSet::Clock::now() + seconds(120));
  }
  bool WaitForEstimator() {
    return WaitFor([this] { return forces_.matched() > 0; });
  }

 private:
  void Note(const idl::palpate_msgs::ForceArray& message) {
    Outcome outcome{dds::StampNs(message.header.stamp), std::string(dds::Text(message.status)), {}};
    for (const auto& force : dds::Elements(message.forces)) {
      outcome.forces.emplace_back(
          dds::Text(force.name),
          std::vector<double>{force.position_m.x, force.position_m.y, force.position_m.z,
                              force.force_n.x, force.force_n.y, force.force_n.z, force.ci95_n,
                              force.location_ci95_m});
    }
    // A frame that is sent again is answered again.
    if (!outcomes_.empty() && outcomes_.back().stamp_ns == outcome.stamp_ns) return;
    outcomes_.push_back(std::move(outcome));
    reasons_.emplace_back(dds::Text(message.reason));
  }

  dds::TestNode node_;
  dds::Reader<idl::palpate_msgs::ForceArray> forces_;
  std::vector<Outcome> outcomes_;
  std::vector<std::string> reasons_;
};

std::string Robot() {
  return (std::filesystem::path(PALPATE_SOURCE_DIR) / "config/robots/four_leg.yaml").string();
}

/// An experiment folder as `palpate simulate` writes it.
std::filesystem::path SimulateExperiment(const TestFolder& folder,
                                         const std::string& scenario_text) {
  const auto mesh =
      std::filesystem::path(PALPATE_SOURCE_DIR) / "config/scenarios/four_leg_coarse.msh";
  std::filesystem::copy_file(mesh, folder / "four_leg_coarse.msh");
  const auto scenario = folder / "pressed.yaml";
  WriteFile(scenario, scenario_text);
  const auto experiment = folder / "experiment";
  EXPECT_EQ(RunProgram("palpate",
                       {"simulate", Robot(), "--scenario", scenario.string(), "--out",
                        experiment.string(), "--tell-camera-pose"},
                       folder / "simulate.log"),
            0)
      << ReadFile(folder / "simulate.log");
  return experiment;
}

/// Poses as experiment.yaml has them, letter by letter, so that everybody reads the same numbers;
/// of the first camera, then of the others.
std::vector<std::string> CameraPoses(const std::filesystem::path& experiment) {
  const std::string text = ReadFile(experiment / "experiment.yaml");
  const std::string key = "T_robot_camera: ";
  std::vector<std::string> poses;
  for (auto at = text.find(key); at != text.npos; at = text.find(key, at + 1)) {
    const auto begin = at + key.size();
    poses.push_back(text.substr(begin, text.find('\n', begin) - begin));
  }
  EXPECT_FALSE(poses.empty()) << text;
  return poses;
}

class RecordedImages : public testing::Test {
 protected:
  /// Forces of `palpate estimate`.
  std::vector<Outcome> EstimateAtTheDesk(const std::filesystem::path& experiment) {
    EXPECT_EQ(RunProgram("palpate",
                         {"estimate", Robot(), "--data", experiment.string(), "--out",
                          (folder_ / "forces.csv").string(), "--bias-frames", "first", "--set",
                          kUntouched},
                         folder_ / "estimate.log"),
              0)
        << ReadFile(folder_ / "estimate.log");
    return ReadForcesCsv(folder_ / "forces.csv");
  }

  /// The same of the processes, each with `settings`.
  void EstimateLive(const std::filesystem::path& experiment, std::vector<std::string> settings,
                    std::size_t frames) {
    std::vector<std::string> of_estimator = settings;
    of_estimator.insert(of_estimator.begin(), Robot());
    of_estimator.insert(of_estimator.end(), {"--set", kUntouched, "--set", "expect_posture=false"});
    Process estimator("palpate-force-estimation", of_estimator, folder_ / "force.log");
    ASSERT_TRUE(listener_.WaitForEstimator());
    settings.insert(settings.end(), {"--set", "await_prediction_s=100", "--set",
                                     "pairing_wait_s=10", "--set", "camera_wait_s=10"});
    Process perception("palpate-perception", settings, folder_ / "perception.log");
    Process player("palpate-player", {"--data", experiment.string(), "--images", "--step"},
                   folder_ / "player.log");
    EXPECT_TRUE(listener_.WaitFor([&] { return listener_.outcomes().size() == frames; }));
    EXPECT_EQ(player.Wait(seconds(30)), 0) << player.Output();
    ASSERT_EQ(listener_.outcomes().size(), frames) << perception.Output() << estimator.Output();
    for (Process* process : {&estimator, &perception}) {
      process->Signal(SIGTERM);
      EXPECT_EQ(process->Wait(seconds(20)), 0) << process->Output();
    }
  }

  TestFolder folder_;
  Listener listener_;
};

TEST_F(RecordedImages, GiveTheForcesOfTheDeskToTheLastBit) {
  const auto experiment = SimulateExperiment(folder_, kBody + kRecordings);
  const std::vector<Outcome> desk = EstimateAtTheDesk(experiment);
  ASSERT_GE(desk.size(), 14u);
  ASSERT_NO_FATAL_FAILURE(
      EstimateLive(experiment, {"--camera-pose", CameraPoses(experiment).at(0)}, desk.size()));
  int with_forces = 0;
  for (std::size_t i = 0; i < desk.size(); ++i) {
    EXPECT_EQ(listener_.outcomes()[i], desk[i]) << listener_.reasons()[i];
    with_forces += desk[i].forces.empty() ? 0 : 1;
  }
  EXPECT_GE(with_forces, 3);
}

/// Points travel in the frame of the first camera, rounded to single precision there.
TEST_F(RecordedImages, OfTwoCamerasGiveTheForcesOfTheDeskWithinRounding) {
  const auto experiment = SimulateExperiment(folder_, kBody + kBackCamera + kRecordings);
  const std::vector<Outcome> desk = EstimateAtTheDesk(experiment);
  ASSERT_GE(desk.size(), 14u);
  const std::vector<std::string> poses = CameraPoses(experiment);
  ASSERT_EQ(poses.size(), 2u);
  ASSERT_NO_FATAL_FAILURE(EstimateLive(
      experiment, {"--camera-pose", poses[0], "--set", "cameras=['back: " + poses[1] + "']"},
      desk.size()));
  int with_forces = 0;
  for (std::size_t i = 0; i < desk.size(); ++i) {
    const Outcome& live = listener_.outcomes()[i];
    EXPECT_EQ(live.stamp_ns, desk[i].stamp_ns);
    EXPECT_EQ(live.status, desk[i].status) << listener_.reasons()[i];
    ASSERT_EQ(live.forces.size(), desk[i].forces.size()) << live << " and " << desk[i];
    for (std::size_t k = 0; k < live.forces.size(); ++k) {
      EXPECT_EQ(live.forces[k].first, desk[i].forces[k].first);
      EXPECT_THAT(live.forces[k].second,
                  testing::Pointwise(testing::DoubleNear(kRounding), desk[i].forces[k].second));
      ++with_forces;
    }
  }
  EXPECT_GE(with_forces, 3);
}

}  // namespace
}  // namespace palpate::system_test::recorded_images
