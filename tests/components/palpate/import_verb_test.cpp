// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/import_verb.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <sstream>

#include "components/force_estimation/rest_markers.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/experiment.hpp"
#include "tests/support/measured_data.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {
namespace {

namespace fs = std::filesystem;
using experiment::MeasurementFrame;
using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::Gt;
using testing::HasSubstr;
using testing::Lt;

// Without gravity the equilibrium is the undeformed shape.
constexpr const char* kRobot =
    "name: box\nmesh: {file: " PALPATE_SOURCE_DIR
    "/config/robots/rod.msh, unit: m}\nelement: tet4\n"
    "material: {model: corotational, youngs_modulus_Pa: 1.0e5, poissons_ratio: 0.3}\n"
    "mass: {density_kg_m3: 1000}\ngravity_m_s2: [0, 0, 0]\n"
    "fixed: [{box_m: [[-0.1005, -0.001, -0.001], [-0.0995, 0.031, 0.031]]}]\n"
    "markers:\n  - {name: a, position_m: [0.1, 0, 0]}\n  - {name: b, position_m: [0, 0.1, 0]}\n"
    "  - {name: c, position_m: [0, 0, 0.1]}\n";

// The robot's markers seen from a camera that looks along the robot's x axis from (0, 0, 0.5):
// camera (x, y, z) = robot (y, z, x) less the offset. "d" is no marker of the robot.
constexpr const char* kCapture =
    "time_s,marker,x_m,y_m,z_m,residual_m\n"
    "0.0,a,0,-0.5,0.1,0.0001\n0.0,b,0.1,-0.5,0,0.0002\n0.0,c,0,-0.4,0,0.0003\n0.0,d,1,1,1,\n"
    "0.1,a,0,-0.5,0.1,0.0001\n0.1,b,0.1,-0.5,0,0.0002\n0.1,c,0,-0.4,0,0.0003\n0.1,d,,,,\n"
    "0.2,a,0,-0.6,0.1,0.0001\n0.2,b,0.1,-0.6,0,0.0002\n0.2,c,0,-0.5,0,0.0003\n0.2,d,1,1,1,\n"
    "0.3,a,0,-0.6,0.1,0.0001\n0.3,b,0.1,-0.6,0,0.0002\n0.3,c,0,-0.5,0,0.0003\n0.3,d,1,1,1,\n";

class ImportVerbTest : public testing::Test {
 protected:
  ImportVerbTest() {
    WriteFile(folder_ / "robot.yaml", kRobot);
    WriteFile(folder_ / "capture.csv", kCapture);
    options_.file = folder_ / "capture.csv";
    options_.out = folder_ / "exp";
    options_.recording = "r1";
  }

  experiment::Experiment Import() {
    EXPECT_EQ(RunImport(options_, report_), 0);
    return experiment::ReadExperiment(options_.out, app::LoadYaml);
  }

  // The message, after making sure that nothing was written.
  std::string Refusal() {
    const bool was_there = fs::exists(options_.out);
    std::string message;
    try {
      RunImport(options_, report_);
      ADD_FAILURE() << "nothing was refused";
    } catch (const InputError& error) {
      message = error.what();
    }
    EXPECT_EQ(fs::exists(options_.out), was_there);
    return message;
  }

  test_support::TestFolder folder_;
  ImportOptions options_;
  std::ostringstream report_;
};

TEST_F(ImportVerbTest, WritesAnExperimentThatReadsBack) {
  options_.kind = "known_load";
  options_.rest_window = "0:0.15";
  options_.rest_shape = "equilibrium";
  options_.steady_window = "0.2:0.3";
  options_.markers_sigma_m = 1e-5;
  options_.robot = folder_ / "robot.yaml";
  options_.markers = "a,b,c";
  const auto experiment = Import();
  EXPECT_EQ(experiment.robot, fs::path(folder_ / "robot.yaml").lexically_normal());
  EXPECT_EQ(experiment.markers_sigma_m, Eigen::Vector3d::Constant(1e-5));
  ASSERT_EQ(experiment.recordings.size(), 1u);
  const auto& recording = experiment.recordings[0];
  EXPECT_EQ(recording.name, "r1");
  EXPECT_EQ(recording.kind, experiment::RecordingKind::kKnownLoad);
  EXPECT_EQ(recording.reference->shape, experiment::ReferenceShape::kEquilibrium);
  EXPECT_EQ(recording.steady_window_s->end_s, 0.3);
  EXPECT_EQ(recording.markers->frames.size(), 4u);
  EXPECT_THAT(recording.markers->names, ElementsAre("a", "b", "c"));
  EXPECT_EQ(recording.markers->frames[2].positions_m[1], Eigen::Vector3d(0.1, -0.6, 0));
}

TEST_F(ImportVerbTest, WritesKnownLoads) {
  options_.kind = "known_load";
  options_.loads = {"0.01, 0.02, 0.03: 0, 0, -0.5", "0.01,0.02,0.01,0.004: 0.1,0,0"};
  const auto loads = Import().recordings[0].loads;
  EXPECT_THAT(report_.str(), testing::Not(HasSubstr("warning")));
  ASSERT_EQ(loads.size(), 2U);
  EXPECT_EQ(loads[0].position_m, Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_EQ(loads[0].force_N, Eigen::Vector3d(0.0, 0.0, -0.5));
  EXPECT_EQ(loads[1].patch_radius_m, 0.004);
  EXPECT_EQ(loads[0].t_s, loads[1].t_s);  // all the time
}

TEST_F(ImportVerbTest, WarnsOfAKnownLoadThatIsMissing) {
  options_.kind = "known_load";
  Import();
  EXPECT_THAT(report_.str(), HasSubstr("kind known_load needs its load"));
}

TEST_F(ImportVerbTest, RefusesALoadInAnotherForm) {
  for (const char* load :
       {"0,0,0", "0,0: 1,0,0", "0,0,0: 1,0", "a,0,0: 1,0,0", "0,0,0,-1: 1,0,0"}) {
    options_.loads = {load};
    EXPECT_THAT(Refusal(), HasSubstr("--load '" + std::string(load) + "'"));
  }
  options_.loads = {"120,0,0: 1,0,0"};
  EXPECT_THAT(Refusal(), HasSubstr("millimetres?"));
}

TEST_F(ImportVerbTest, DoesNotClaimTheRobotFrameWithoutBeingTold) {
  const auto experiment = Import();
  EXPECT_EQ(experiment.frame, MeasurementFrame::kCamera);
  EXPECT_TRUE(std::holds_alternative<experiment::NeedsCalibration>(
      RobotFromMarkers(experiment, experiment.recordings[0])));
  EXPECT_THAT(report_.str(), HasSubstr("is not known"));
}

TEST_F(ImportVerbTest, FindsTheCameraFromTheRestWindow) {
  options_.robot = folder_ / "robot.yaml";
  options_.markers = "a,b,c";
  options_.rest_window = "0:0.15";
  options_.register_to_robot = true;
  const auto experiment = Import();
  const auto& recording = experiment.recordings[0];
  EXPECT_EQ(recording.frame, MeasurementFrame::kCamera);
  const auto pose = RobotFromMarkers(experiment, recording);
  ASSERT_TRUE(std::holds_alternative<Eigen::Isometry3d>(pose));
  const auto mapped = Transformed(*recording.markers, std::get<Eigen::Isometry3d>(pose));
  EXPECT_LT((*mapped.frames[0].positions_m[0] - Eigen::Vector3d(0.1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((*mapped.frames[2].positions_m[2] - Eigen::Vector3d(0, 0, 0)).norm(), 1e-12);
  EXPECT_THAT(report_.str(), HasSubstr("registered 3 markers"));
}

// The markers of kCapture in columns x, y, z of another frame, at rest for eleven frames.
class ImportAtRestTest : public ImportVerbTest {
 protected:
  ImportAtRestTest() {
    options_.robot = folder_ / "robot.yaml";
    options_.kind = "rest";
    options_.rest_window = "0:0.95";
    options_.register_to_robot = true;
  }

  using Place = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

  void WriteCapture(const std::vector<std::string>& names, double noise_m, const Place& place) {
    const Eigen::Matrix3d robot_m = 0.1 * Eigen::Matrix3d::Identity();
    std::mt19937 random(5);
    std::normal_distribution<double> normal(0.0, noise_m);
    std::string text = "time_s,marker,x_m,y_m,z_m\n";
    for (int frame = 0; frame <= 10; ++frame) {
      for (Eigen::Index k = 0; k < 3; ++k) {
        const Eigen::Vector3d at_m = place(robot_m.col(k));
        text += FormatNumber(0.1 * frame) + "," + names[At(k)];
        for (const double value : at_m) text += "," + FormatNumber(value + normal(random));
        text += "\n";
      }
    }
    WriteFile(options_.file, text);
  }

  static Eigen::Vector3d YUp(const Eigen::Vector3d& at_m) {
    return {at_m.x() + 0.3, at_m.z(), -at_m.y()};
  }
};

TEST_F(ImportAtRestTest, TakesTheWindowForAnEquilibriumAndSaysSo) {
  WriteCapture({"a", "b", "c"}, 0.0, YUp);
  const auto experiment = Import();
  const auto& recording = experiment.recordings.at(0);
  EXPECT_EQ(recording.reference->shape, experiment::ReferenceShape::kEquilibrium);
  EXPECT_THAT(report_.str(), AllOf(HasSubstr("rest shape: equilibrium under gravity"),
                                   HasSubstr("--rest-shape undeformed where")));
  options_.recording = "r2";
  options_.rest_shape = "undeformed";
  EXPECT_EQ(Import().recordings.at(1).reference->shape, experiment::ReferenceShape::kUndeformed);
  EXPECT_THAT(report_.str(), HasSubstr("rest shape: undeformed"));
}

TEST_F(ImportAtRestTest, RegistersAgainstTheComputedEquilibrium) {
  // A soft body in gravity: its markers sink by millimetres.
  std::string robot(kRobot);
  robot.replace(robot.find("[0, 0, 0]"), 9, "[0, 0, -9.81]");
  WriteFile(folder_ / "robot.yaml", robot);
  const auto model = LoadRobot(folder_ / "robot.yaml");
  Eigen::VectorXd sunk_m;
  ASSERT_TRUE(force_estimation::ReferenceMarkers(
                  *model, force_estimation::ReferenceShape::kEquilibrium, {}, &sunk_m)
                  .ok());
  ASSERT_GT((sunk_m.head<3>() - Eigen::Vector3d(0.1, 0.0, 0.0)).norm(), 1e-3);
  WriteCapture({"a", "b", "c"}, 0.0, [&](const Eigen::Vector3d& at_m) {
    Eigen::Index marker = 0;
    at_m.maxCoeff(&marker);
    return YUp(sunk_m.segment<3>(3 * marker));
  });
  const auto experiment = Import();
  const auto pose = RobotFromMarkers(experiment, experiment.recordings.at(0));
  const Eigen::Vector3d origin_m = std::get<Eigen::Isometry3d>(pose) * YUp(Eigen::Vector3d::Zero());
  EXPECT_LT(origin_m.norm(), 1e-6);
}

/// Of three markers 0.1 m from the origin; the capture's own origin is 0.3 m off.
TEST_F(ImportAtRestTest, StatesHowWellThePoseIsKnown) {
  WriteCapture({"a", "b", "c"}, 0.0, [](const Eigen::Vector3d& at_m) {
    return YUp(1.01 * at_m);  // 1 mm each
  });
  const auto found = Import();
  const auto error = PoseErrorOf(found, found.recordings.at(0));
  EXPECT_THAT(report_.str(), HasSubstr("standard error of the pose"));
  EXPECT_THAT(error.rotation_rad, AllOf(Gt(1e-3), Lt(2e-2)));
  EXPECT_THAT(error.translation_m, AllOf(Gt(0.3 * error.rotation_rad), Lt(5e-3)));
}

TEST_F(ImportAtRestTest, StoresTheNoiseThatItMeasures) {
  WriteCapture({"a", "b", "c"}, 2e-4, YUp);
  const auto sigma_m = Import().markers_sigma_m;
  ASSERT_TRUE(sigma_m);
  EXPECT_THAT(std::vector<double>(sigma_m->begin(), sigma_m->end()),
              Each(AllOf(Gt(1e-4), Lt(4e-4))));
  EXPECT_THAT(report_.str(), HasSubstr("markers_sigma_m of experiment.yaml"));
}

TEST_F(ImportAtRestTest, KeepsTheNoiseThatIsGiven) {
  WriteCapture({"a", "b", "c"}, 2e-4, YUp);
  options_.markers_sigma_m = 3e-5;
  EXPECT_EQ(Import().markers_sigma_m, Eigen::Vector3d::Constant(3e-5));
  options_.markers_sigma_m = 0.0;
  options_.recording = "r2";
  EXPECT_EQ(Import().markers_sigma_m, Eigen::Vector3d::Constant(3e-5));
}

TEST_F(ImportAtRestTest, RefusesMarkersThatAreNotTheRobots) {
  WriteCapture({"a", "b", "c"}, 0.0, YUp);
  options_.register_to_robot = false;
  options_.frame = "robot";
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("turned by 90 degrees"), HasSubstr("--register")));
  options_.frame = "camera";
  WriteCapture({"a", "b", "c"}, 0.0, [](const auto& at_m) { return YUp(10.0 * at_m); });
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("10 times as far apart"), HasSubstr("unit")));
}

TEST_F(ImportVerbTest, RefusesARegistrationThatTheMarkersDoNotDetermine) {
  options_.robot = folder_ / "robot.yaml";
  options_.markers = "a,b,c";
  options_.register_to_robot = true;
  EXPECT_THAT(Refusal(), HasSubstr("--rest-window"));
  options_.rest_window = "0:0.15";
  options_.register_markers = "a,b";
  EXPECT_THAT(Refusal(), HasSubstr("cannot be registered"));
  options_.register_markers = "a,b,e";
  EXPECT_THAT(Refusal(), HasSubstr("'e' cannot be registered: it is not in the data"));
  options_.register_markers.clear();
  options_.frame = "robot";
  EXPECT_THAT(Refusal(), HasSubstr("--frame robot"));
  options_.frame.clear();
  options_.pose = "0,0,0,0,0,0,1";
  EXPECT_THAT(Refusal(), HasSubstr("exclude each other"));
  options_.pose.clear();
  options_.robot.clear();
  EXPECT_THAT(Refusal(), HasSubstr("--register needs --robot"));
}

TEST_F(ImportVerbTest, RenamesTurnsCropsThinsAndShifts) {
  options_.rename = {"a=tip", "d=extra"};
  options_.markers = "tip,b";
  options_.axes = "z,x,y";
  options_.from_s = 0.1;
  options_.rate_Hz = 5.0;
  options_.time_offset_s = 10.0;
  options_.steady_window = "0.25:0.35";
  const auto experiment = Import();
  EXPECT_EQ(experiment.frame, MeasurementFrame::kRobot);
  const auto& recording = experiment.recordings[0];
  EXPECT_THAT(recording.markers->names, ElementsAre("tip", "b"));
  ASSERT_EQ(recording.markers->frames.size(), 2u);
  EXPECT_NEAR(recording.markers->frames[0].t_s, 10.1, 1e-12);
  EXPECT_NEAR(recording.markers->frames[1].t_s, 10.3, 1e-12);
  EXPECT_EQ(*recording.markers->frames[0].positions_m[0], Eigen::Vector3d(0.1, 0, -0.5));
  EXPECT_NEAR(recording.steady_window_s->begin_s, 10.25, 1e-12);
}

TEST_F(ImportVerbTest, ExtendsAnExperimentAndNeverOverwrites) {
  Import();
  EXPECT_THAT(Refusal(), HasSubstr("not overwritten"));
  options_.recording = "r2";
  options_.markers_sigma_m = 1e-5;
  EXPECT_THAT(Refusal(), HasSubstr("--markers-sigma"));
  options_.markers_sigma_m = 0.0;
  const auto experiment = Import();
  EXPECT_EQ(experiment.recordings.size(), 2u);
  options_.recording = "";
  EXPECT_THAT(Refusal(), HasSubstr("--recording"));
  options_.out = options_.out / "recordings/r1";
  EXPECT_THAT(Refusal(), HasSubstr("not overwritten"));
}

TEST_F(ImportVerbTest, WritesARecordingOnItsOwn) {
  options_.recording = "";
  const auto experiment = Import();
  EXPECT_EQ(experiment.recordings.at(0).name, "exp");
  EXPECT_FALSE(fs::exists(options_.out / "experiment.yaml"));
}

TEST_F(ImportVerbTest, ReportsGapsResidualsAndNoise) {
  options_.steady_window = "0:0.3";
  Import();
  EXPECT_THAT(
      report_.str(),
      AllOf(HasSubstr("4 markers, 4 frames at 10 Hz, 0.00 s to 0.30 s, 0 frames missing"),
            HasSubstr("residual 0.200 mm"), HasSubstr("seen 3, gaps 1"), HasSubstr("noise")));
}

TEST_F(ImportVerbTest, RefusesOptionsThatDoNotFitTheData) {
  const auto refusal = [&](auto change) {
    const ImportOptions before = options_;
    change(options_);
    const std::string message = Refusal();
    options_ = before;
    return message;
  };
  using O = ImportOptions;
  EXPECT_THAT(refusal([](O& o) { o.markers = "a,x"; }), HasSubstr("no marker 'x'"));
  EXPECT_THAT(refusal([](O& o) { o.markers = "a,a"; }), HasSubstr("listed twice"));
  EXPECT_THAT(refusal([](O& o) { o.rename = {"a=b"}; }), HasSubstr("two markers"));
  EXPECT_THAT(refusal([](O& o) { o.rename = {"a"}; }), HasSubstr("NAME=NEW_NAME"));
  EXPECT_THAT(refusal([](O& o) { o.axes = "y,x,z"; }), HasSubstr("mirror"));
  EXPECT_THAT(refusal([](O& o) { o.axes = "x,x,z"; }), HasSubstr("once each"));
  EXPECT_THAT(refusal([](O& o) { o.axes = "x,y"; }), HasSubstr("once each"));
  EXPECT_THAT(refusal([](O& o) { o.rest_window = "1"; }), HasSubstr("--rest-window '1'"));
  EXPECT_THAT(refusal([](O& o) { o.rest_window = "2:1"; }), HasSubstr("end after it begins"));
  EXPECT_THAT(refusal([](O& o) { o.steady_window = "7:8"; }), HasSubstr("--steady-window"));
  EXPECT_THAT(refusal([](O& o) { o.from_s = 5.0; }), HasSubstr("no frame lies between"));
  EXPECT_THAT(refusal([](O& o) { o.rate_Hz = 7.0; }), HasSubstr("whole multiple"));
  EXPECT_THAT(refusal([](O& o) { o.pose = "1,2,3,0,0,0,2"; }), HasSubstr("norm must be 1"));
  EXPECT_THAT(refusal([](O& o) { o.pose = "1,2,3"; }), HasSubstr("x,y,z,qx,qy,qz,qw"));
  EXPECT_THAT(refusal([](O& o) { o.kind = "rset"; }), HasSubstr("did you mean 'rest'"));
  EXPECT_THAT(refusal([](O& o) { o.recording = "a/b"; }), HasSubstr("plain name"));
  EXPECT_THAT(refusal([](O& o) { o.file = "capture.txt"; }), HasSubstr("capture.txt"));
  EXPECT_THAT(refusal([&](O& o) { o.robot = folder_ / "robot.yaml"; }),
              AllOf(HasSubstr("capture.csv:5:5"), HasSubstr("no marker 'd'")));
}

TEST_F(ImportVerbTest, TurnsTheMeasuredBeamIntoAnExperiment) {
  const fs::path beam = test_support::MeasuredDataFolder() / "silicone_beam";
  if (!fs::exists(beam)) GTEST_SKIP() << beam << " is not there";
  options_.file = beam / "beam_gravity_V2_a.c3d";
  options_.robot = fs::path(PALPATE_SOURCE_DIR) / "config/robots/beam.yaml";
  options_.markers = "Tip-1,Tip-2,Tip-3";
  options_.axes = "z,-y,x";
  options_.rest_window = "0.25:0.7";
  options_.steady_window = "4:5";
  const auto experiment = Import();
  const auto& recording = experiment.recordings.at(0);
  ASSERT_EQ(recording.markers->frames.size(), 500u);
  const auto rest = MeanOver(*recording.markers, recording.reference->window_s);
  const auto steady = MeanOver(*recording.markers, *recording.steady_window_s);
  // The beam hangs down by 6.8 mm under its own weight (COMSOL: 24 to 17.248 mm), and the noise is
  // 2 to 10 um.
  EXPECT_NEAR(steady[1].mean_m.z() - rest[1].mean_m.z(), -0.0068, 0.0015);
  EXPECT_LT(steady[1].deviation_m.maxCoeff(), 12e-6);
}

}  // namespace
}  // namespace palpate::command
