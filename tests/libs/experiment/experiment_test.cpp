// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/experiment.hpp"

#include <fstream>
#include <numbers>

#include "libs/app/yaml.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::experiment {
namespace {

namespace fs = std::filesystem;
using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kExperiment =
    "robot: ../robots/beam.yaml\nframe: camera\n"
    "T_robot_camera: {translation_m: [0.1, 0.2, 0.3], rotation_xyzw: {x: 0, y: 0, z: 0.7071068, "
    "w: 0.7071068}}\n"
    "markers_sigma_m: [1.0e-5, 2.0e-5, 3.0e-5]\ndepth_noise: {subpixel_px: 0.1, unit_m: 1.0e-4}\n"
    "tolerances: {youngs_modulus: 0.03, marker_bias_m: 1.0e-4}\nrest_between_s: 30\n"
    "notes: \"a: 'b' \\\"c\\\"\\nd\"\n"
    "answer_sha256: e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855\n";
constexpr const char* kRecording =
    "kind: known_load\nbase_tilt_deg: [10, -20]\ncamera_on_base: false\n"
    "reference: {window_s: [0, 0.5], shape: equilibrium}\nsteady_window_s: [0.9, 2]\n";
constexpr const char* kMarkers = "t_s,marker,x_m,y_m,z_m\n0,a,1,2,3\n1,a,1,2,4\n";
constexpr const char* kActuation = "t_s,north.displacement_m\n0,0\n1,0.01\n";
constexpr const char* kLoads = "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N\n0,0,0,0,0,0,-1\n";

void WriteWhole(const TestFolder& folder) {
  folder.Write("exp/experiment.yaml", kExperiment);
  const std::string b = "exp/recordings/b/";
  folder.Write(b + "recording.yaml", kRecording);
  folder.Write(b + "markers.csv", kMarkers);
  folder.Write(b + "actuation.csv", kActuation);
  folder.Write(b + "loads.csv", kLoads);
  folder.Write(b + "depth/2000000.png", "later");
  folder.Write(b + "depth/1000000.png", "first");
  folder.Write(b + "color/1000000.png", "colour");
  folder.Write(b + "clouds/5000000.ply", "cloud");
  folder.Write(b + "camera.yaml", "depth: {}\n");
  folder.Write("exp/recordings/a/recording.yaml", "kind: rest\n");
}

void ExpectWhole(const Experiment& experiment) {
  EXPECT_EQ(experiment.frame, MeasurementFrame::kCamera);
  ASSERT_TRUE(experiment.T_robot_camera.has_value());
  EXPECT_EQ(experiment.T_robot_camera->translation(), Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_NEAR(experiment.T_robot_camera->linear()(1, 0), 1.0, 1e-12);
  EXPECT_EQ(experiment.markers_sigma_m, Eigen::Vector3d(1e-5, 2e-5, 3e-5));
  EXPECT_EQ(experiment.depth_noise->subpixel_px, 0.1);
  EXPECT_EQ(experiment.depth_noise->unit_m, 1e-4);
  EXPECT_EQ(experiment.tolerances.at("youngs_modulus"), 0.03);
  EXPECT_EQ(experiment.tolerances.at("marker_bias_m"), 1e-4);
  EXPECT_EQ(experiment.rest_between_s, 30.0);
  EXPECT_EQ(experiment.notes, "a: 'b' \"c\"\nd");
  EXPECT_EQ(experiment.answer_sha256,
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  ASSERT_EQ(experiment.recordings.size(), 2u);
  EXPECT_EQ(experiment.recordings[0].name, "a");
  EXPECT_EQ(experiment.recordings[0].kind, RecordingKind::kRest);
  const Recording& b = experiment.recordings[1];
  EXPECT_EQ(b.name, "b");
  EXPECT_EQ(b.kind, RecordingKind::kKnownLoad);
  EXPECT_EQ(b.base_tilt_deg, Eigen::Vector2d(10, -20));
  EXPECT_FALSE(b.camera_on_base);
  EXPECT_EQ(b.reference->shape, ReferenceShape::kEquilibrium);
  EXPECT_EQ(b.reference->window_s.end_s, 0.5);
  EXPECT_EQ(b.steady_window_s->begin_s, 0.9);
  EXPECT_EQ(b.actuation->columns[0].cable, "north");
  EXPECT_EQ(b.markers->frames.size(), 2u);
  EXPECT_EQ(b.loads.size(), 1u);
  ASSERT_EQ(b.depth_images.size(), 2u);
  EXPECT_EQ(b.depth_images[0].t_ns, 1000000);
  EXPECT_EQ(b.depth_images[1].t_ns, 2000000);
  EXPECT_EQ(b.color_images.size(), 1u);
  EXPECT_EQ(b.clouds[0].file.filename(), "5000000.ply");
  EXPECT_TRUE(b.camera_file.has_value());
}

// Message when one file of a whole experiment is replaced.
std::string RefusalWith(const std::string& name, const std::string& content) {
  const TestFolder folder;
  WriteWhole(folder);
  folder.Write("exp/" + name, content);
  return MessageOf([&] { ReadExperiment(folder.path() / "exp", app::LoadYaml); });
}

TEST(Experiment, HoldsEverythingThatStandsInItsFolder) {
  const TestFolder folder;
  WriteWhole(folder);
  const Experiment experiment = ReadExperiment(folder.path() / "exp", app::LoadYaml);
  ExpectWhole(experiment);
  EXPECT_EQ(experiment.robot, folder.path() / "robots/beam.yaml");
}

constexpr const char* kPose =
    "T_robot_camera: {translation_m: [0.1, 0.2, 0.3], rotation_xyzw: [0, 0, 0, 1]";

TEST(Experiment, APoseHasAStandardError) {
  const TestFolder folder;
  folder.Write("exp/experiment.yaml",
               kPose + std::string(", standard_error: {translation_m: 2.0e-3, rotation_rad: "
                                   "3.0e-3}}\n"));
  folder.Write("exp/recordings/a/recording.yaml", "kind: rest\n");
  folder.Write("exp/recordings/b/recording.yaml",
               "kind: rest\n" + std::string(kPose) +
                   ", standard_error: {translation_m: 4.0e-3, rotation_rad: 5.0e-3}}\n");
  folder.Write("exp/recordings/c/recording.yaml", "kind: rest\n" + std::string(kPose) + "}\n");
  const Experiment first = ReadExperiment(folder.path() / "exp", app::LoadYaml);
  WriteExperiment(first, folder.path() / "copy");
  for (const char* name : {"exp", "copy"}) {
    const Experiment read = ReadExperiment(folder.path() / name, app::LoadYaml);
    const auto& recordings = read.recordings;
    EXPECT_EQ(PoseErrorOf(read, recordings[0]).translation_m, 2e-3) << name;
    EXPECT_EQ(PoseErrorOf(read, recordings[0]).rotation_rad, 3e-3) << name;
    EXPECT_EQ(PoseErrorOf(read, recordings[1]).translation_m, 4e-3) << name;
    EXPECT_EQ(PoseErrorOf(read, recordings[1]).rotation_rad, 5e-3) << name;
    // Nobody said how well it is known: not exact.
    EXPECT_FALSE(recordings[2].T_robot_camera_error) << name;
    EXPECT_EQ(PoseErrorOf(read, recordings[2]).translation_m, 0.005) << name;
    EXPECT_EQ(PoseErrorOf(read, recordings[2]).rotation_rad, 0.01) << name;
  }
}

TEST(Experiment, RefusesAStandardErrorThatIsNone) {
  const auto with = [](const std::string& error) {
    return RefusalWith("experiment.yaml",
                       kPose + std::string(", standard_error: ") + error + "}\n");
  };
  EXPECT_THAT(with("{translation_m: 0, rotation_rad: 0.01}"),
              AllOf(HasSubstr("experiment.yaml:1:"), HasSubstr("translation_m"), HasSubstr("> 0")));
  EXPECT_THAT(with("{translation_m: 0.005, rotation_rad: -0.01}"), HasSubstr("rotation_rad"));
  EXPECT_THAT(with("{translation_m: 0.005}"), HasSubstr("rotation_rad"));
  EXPECT_THAT(with("{translation_mm: 5, rotation_rad: 0.01}"), HasSubstr("translation_m"));
  EXPECT_THAT(with("0.005"), HasSubstr("standard_error"));
}

TEST(Experiment, ReadsBackWhatItWrote) {
  const TestFolder folder;
  WriteWhole(folder);
  const Experiment first = ReadExperiment(folder.path() / "exp", app::LoadYaml);
  WriteExperiment(first, folder.path() / "deep/copy");
  const Experiment second = ReadExperiment(folder.path() / "deep/copy", app::LoadYaml);
  ExpectWhole(second);
  EXPECT_EQ(second.robot, first.robot);
  EXPECT_THAT(MessageOf([&] { WriteExperiment(first, folder.path() / "deep/copy"); }),
              HasSubstr("never overwritten"));
}

TEST(Experiment, ASingleRecordingTakesTheSettingsOfItsExperiment) {
  const TestFolder folder;
  WriteWhole(folder);
  const fs::path recording = folder.path() / "exp/recordings/b";
  const Experiment experiment = ReadExperiment(recording, app::LoadYaml);
  ASSERT_EQ(experiment.recordings.size(), 1u);
  EXPECT_EQ(experiment.recordings[0].name, "b");
  EXPECT_EQ(experiment.frame, MeasurementFrame::kCamera);
  EXPECT_EQ(experiment.robot, folder.path() / "robots/beam.yaml");

  fs::copy(recording, folder.path() / "alone", fs::copy_options::recursive);
  const Experiment alone = ReadExperiment(folder.path() / "alone/", app::LoadYaml);
  EXPECT_EQ(alone.recordings.at(0).name, "alone");
  EXPECT_EQ(alone.frame, MeasurementFrame::kRobot);
}

TEST(Experiment, RefusesAnUnknownKeyWithTheNearestOne) {
  EXPECT_THAT(RefusalWith("experiment.yaml", "frame: robot\nmarker_sigma_m: 1e-5\n"),
              AllOf(HasSubstr("experiment.yaml:2"), HasSubstr("did you mean 'markers_sigma_m'")));
  EXPECT_THAT(RefusalWith("experiment.yaml", "tolerances: {young_modulus: 1}\n"),
              HasSubstr("did you mean 'youngs_modulus'"));
  EXPECT_THAT(RefusalWith("recordings/b/recording.yaml", "kind: rest\nsteady_window: [0, 1]\n"),
              AllOf(HasSubstr("recording.yaml:2"), HasSubstr("did you mean 'steady_window_s'")));
}

TEST(Experiment, RefusesWrongValuesWithFileAndLine) {
  EXPECT_THAT(RefusalWith("experiment.yaml", "frame: camra\n"),
              AllOf(HasSubstr("experiment.yaml:1"), HasSubstr("did you mean 'camera'")));
  EXPECT_THAT(RefusalWith("experiment.yaml", "markers_sigma_m: .nan\n"), HasSubstr(":1"));
  EXPECT_THAT(RefusalWith("experiment.yaml", "markers_sigma_m: 0\n"), HasSubstr("> 0"));
  EXPECT_THAT(RefusalWith("experiment.yaml", "markers_sigma_m: [1, 2]\n"), HasSubstr(":1"));
  EXPECT_THAT(RefusalWith("experiment.yaml", "rest_between_s: -1\n"), HasSubstr(">= 0"));
  EXPECT_THAT(RefusalWith("experiment.yaml", "depth_noise: {unit_m: 1}\n"),
              HasSubstr("subpixel_px"));
  for (const std::string& seal : {std::string(63, '0'), std::string(64, 'E'), std::string("[1]")}) {
    EXPECT_THAT(RefusalWith("experiment.yaml", "answer_sha256: " + seal + "\n"),
                AllOf(HasSubstr("experiment.yaml:1:16"), HasSubstr("64 digits of 0-9 and a-f")));
  }
  EXPECT_THAT(RefusalWith("recordings/b/recording.yaml", "kind: resting\n"),
              HasSubstr("kind 'resting' is not known"));
  EXPECT_THAT(RefusalWith("recordings/b/recording.yaml", "frame: robot\n"), HasSubstr("'kind'"));
  EXPECT_THAT(RefusalWith("recordings/b/recording.yaml", "kind: rest\nbase_tilt_deg: 5\n"),
              HasSubstr(":2"));
  EXPECT_THAT(RefusalWith("recordings/b/recording.yaml", "kind: rest\nsteady_window_s: [1, 1]\n"),
              HasSubstr("must end after it begins"));
  EXPECT_THAT(RefusalWith("recordings/b/recording.yaml", "kind: rest\nsteady_window_s: [8, 9]\n"),
              AllOf(HasSubstr("steady_window_s"), HasSubstr("no frame of markers.csv")));
}

TEST(Experiment, RefusesARotationThatIsNone) {
  EXPECT_THAT(RefusalWith("experiment.yaml",
                          "T_robot_camera: {translation_m: [0, 0, 0], rotation_xyzw: {x: 0, y: 0, "
                          "z: 0, w: 0.9}}\n"),
              AllOf(HasSubstr("experiment.yaml:1"), HasSubstr("norm 1")));
  EXPECT_THAT(RefusalWith("experiment.yaml",
                          "T_robot_camera: {translation_m: [0, 0, 0], rotation_xyzw: {x: 0, y: 0, "
                          "z: 0}}\n"),
              HasSubstr("'w' is missing"));
}

TEST(Experiment, RefusesTheWholeForOneBadTable) {
  EXPECT_THAT(RefusalWith("recordings/b/markers.csv", "t_s,marker,x_m,y_m,z_m\n0,a,1,2,nan\n"),
              HasSubstr("markers.csv:2:3"));
  EXPECT_THAT(RefusalWith("recordings/b/actuation.csv", "t_s,north.displacement_mm\n0,1\n"),
              HasSubstr("actuation.csv:1:5"));
  EXPECT_THAT(RefusalWith("recordings/b/depth/frame7.png", ""), HasSubstr("nanoseconds"));
  EXPECT_THAT(RefusalWith("recordings/b/clouds/7.obj", ""), HasSubstr("must end in .pcd, .ply"));
  EXPECT_THAT(RefusalWith("recordings/b/marker.csv", ""), HasSubstr("did you mean 'markers.csv'"));
  EXPECT_THAT(RefusalWith("recordings/c/markers.csv", kMarkers), HasSubstr("recording.yaml"));
}

TEST(Experiment, RefusesFoldersThatAreNone) {
  const TestFolder folder;
  const auto refusal = [&](const std::string& name) {
    return MessageOf([&] { ReadExperiment(folder.path() / name, app::LoadYaml); });
  };
  EXPECT_THAT(refusal("absent"), HasSubstr("no folder"));
  EXPECT_THAT(refusal("."), HasSubstr("neither experiment.yaml nor recording.yaml"));
  folder.Write("e/experiment.yaml", "frame: robot\n");
  EXPECT_THAT(refusal("e"), HasSubstr("recordings"));
  fs::create_directories(folder.path() / "e/recordings");
  EXPECT_THAT(refusal("e"), HasSubstr("no recording"));
}

TEST(Experiment, ChecksMarkerAndCableNamesAgainstTheRobot) {
  const TestFolder folder;
  WriteWhole(folder);
  const Recording b = ReadRecording(folder.path() / "exp/recordings/b", app::LoadYaml);
  EXPECT_NO_THROW(CheckMarkers(b, {"z", "a"}));
  EXPECT_NO_THROW(CheckActuators(b, {"north"}, {}));
  EXPECT_THAT(MessageOf([&] {
                CheckMarkers(b, {"tip_1", "tip_2"});
              }),
              AllOf(HasSubstr("markers.csv:2:3"), HasSubstr("no marker 'a'"), HasSubstr("tip_2")));
  EXPECT_THAT(MessageOf([&] {
                CheckActuators(b, {"noth", "east"}, {});
              }),
              AllOf(HasSubstr("actuation.csv:1:5"), HasSubstr("did you mean 'noth'")));
}

class RobotFromMarkersTest : public testing::Test {
 protected:
  RobotFromMarkersTest() {
    recording_.name = "r";
    experiment_.frame = MeasurementFrame::kCamera;
  }

  Eigen::Isometry3d Pose() const {
    const auto result = RobotFromMarkers(experiment_, recording_);
    EXPECT_TRUE(std::holds_alternative<Eigen::Isometry3d>(result));
    return std::get<Eigen::Isometry3d>(result);
  }

  bool Unknown() const {
    return std::holds_alternative<NeedsCalibration>(RobotFromMarkers(experiment_, recording_));
  }

  Experiment experiment_;
  Recording recording_;
  Eigen::Isometry3d one_ = Eigen::Isometry3d(Eigen::Translation3d(1, 0, 0));
  Eigen::Isometry3d two_ = Eigen::Isometry3d(Eigen::Translation3d(0, 2, 0));
};

TEST_F(RobotFromMarkersTest, IsUnknownAndNeverIdentityWithoutAPose) {
  EXPECT_TRUE(Unknown());
  experiment_.T_robot_camera = one_;
  EXPECT_TRUE(Pose().isApprox(one_));
  recording_.kind = RecordingKind::kCameraMoved;
  EXPECT_TRUE(Unknown());
}

TEST_F(RobotFromMarkersTest, TheRecordingWinsOverTheExperiment) {
  experiment_.T_robot_camera = one_;
  recording_.T_robot_camera = two_;
  EXPECT_TRUE(Pose().isApprox(two_));
  recording_.frame = MeasurementFrame::kRobot;
  EXPECT_TRUE(Pose().isApprox(Eigen::Isometry3d::Identity()));
}

TEST_F(RobotFromMarkersTest, ACameraOffTheBaseTurnsAgainstTheTilt) {
  experiment_.T_robot_camera = one_;
  recording_.base_tilt_deg = Eigen::Vector2d(0.0, 90.0);
  EXPECT_TRUE(Pose().isApprox(one_));
  recording_.camera_on_base = false;
  // Ry(90 deg) turns z to x; seen from the turned base, what lay along x lies along z.
  EXPECT_TRUE((Pose() * Eigen::Vector3d::Zero()).isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
}

TEST(Recording, BaseRotationTurnsAboutXFirst) {
  Recording recording;
  EXPECT_TRUE(BaseRotation(recording).isIdentity());
  recording.base_tilt_deg = Eigen::Vector2d(90.0, 90.0);
  // Rx(90): y -> z; Ry(90): z -> x.
  EXPECT_TRUE((BaseRotation(recording) * Eigen::Vector3d::UnitY())
                  .isApprox(Eigen::Vector3d::UnitX(), 1e-12));
}

}  // namespace
}  // namespace palpate::experiment
