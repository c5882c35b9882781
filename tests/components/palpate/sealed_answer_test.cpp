// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/simulate/sealed_answer.hpp"

#include "libs/core/sha256.hpp"
#include "tests/components/palpate/simulate_fixture.hpp"

namespace palpate::command {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using Json = nlohmann::json;
using Vector = Eigen::Vector3d;

TEST_F(SimulateTest, SealsEverythingThatIsTrue) {
  Scenario("effects: [{id: cable_gain, where: cable:top, g: 0.1}]\nclutter: 1\n" + kCamera +
           kMarkers + kRecordings);
  log_.T_before_after.translation() = Vector(0, 0, 0.1);
  options_.seed = 77;
  ASSERT_EQ(Run(), 0);
  const Json answer = AnswerJson();
  EXPECT_EQ(answer["seed"], 77);
  EXPECT_EQ(answer["robot"]["name"], "bar");
  EXPECT_EQ(answer["robot"]["sha256"], Sha256Hex(ReadFile(options_.robot)));
  EXPECT_EQ(answer["scenario"]["name"], "hidden_truth");
  EXPECT_EQ(answer["scenario"]["sha256"], Sha256Hex(ReadFile(options_.scenario)));
  EXPECT_EQ(answer["mesh_hash"], "sha256-of-the-true-mesh");
  EXPECT_THAT(answer["salt"].get<std::string>(), SizeIs(64));
  ASSERT_THAT(answer["effects"], SizeIs(1));
  EXPECT_EQ(answer["effects"][0]["id"], "cable_gain");
  EXPECT_EQ(answer["effects"][0]["where"], Json::array({"cable:top"}));
  EXPECT_EQ(answer["effects"][0]["parameters"]["g"], 0.1);
  EXPECT_GT(answer["clutter"].size(), 5u);
  ASSERT_THAT(answer["recordings"], SizeIs(2));
  const Json& pull = answer["recordings"][1];
  EXPECT_EQ(pull["name"], "b_pull");
  EXPECT_NEAR(pull["T_robot_camera"]["translation_m"][1].get<double>(), -0.9, 1e-12);
  EXPECT_THAT(pull["frames"], SizeIs(12));  // ten of the markers, four images, two at once
  EXPECT_EQ(pull["frames"][0]["forces"][0]["name"], "ball");
  EXPECT_EQ(pull["frames"][0]["forces"][0]["force_N"], Json::array({0.0, 0.0, -1.5}));
  EXPECT_EQ(pull["frames"][0]["forces"][0]["position_m"], Json::array({0.1, 0.2, 0.3}));
  EXPECT_EQ(pull["frames"][0]["forces"][0]["rest_position_m"], Json::array({0.4, 0.5, 0.6}));
  EXPECT_THAT(answer["recordings"][0]["frames"][0]["forces"], IsEmpty());
}

TEST_F(SimulateTest, TheExperimentHoldsTheSealAndNothingElseOfTheAnswer) {
  Scenario("effects: [{id: cable_gain, g: 0.1}]\n" + kMarkers + kRecordings);
  options_.seed = 4711;
  ASSERT_EQ(Run(), 0);
  EXPECT_EQ(Read().answer_sha256, Sha256Hex(AnswerText()));
  for (const std::string& name : FilesOf(options_.out)) {
    const fs::path file = options_.out / name;
    if (!fs::is_regular_file(file) || file.extension() != ".yaml") continue;
    const std::string text = ReadFile(file);
    for (const char* secret : {"cable_gain", "hidden_truth", "4711", "s.yaml"}) {
      EXPECT_EQ(text.find(secret), std::string::npos) << name << " tells " << secret;
    }
  }
}

TEST_F(SimulateTest, TheSealIsSalted) {
  ASSERT_EQ(Run(), 0);
  const std::string first = AnswerText();
  fs::remove_all(options_.out);
  fs::remove(folder_ / "exp.answer.json");
  ASSERT_EQ(Run(), 0);
  EXPECT_NE(AnswerText(), first);
  Json a = Json::parse(first), b = AnswerJson();
  a.erase("salt");
  b.erase("salt");
  EXPECT_EQ(a, b);  // and nothing else depends on the run
}

TEST_F(SimulateTest, FilesAndTimesDoNotDependOnTheEffects) {
  const auto listing = [&](const std::string& effects) {
    Scenario(effects + kCamera + kMarkers + kRecordings);
    EXPECT_EQ(Run(), 0);
    const auto files = FilesOf(options_.out);
    std::vector<double> times_s;
    for (const auto& recording : Read().recordings) {
      for (const auto& frame : recording.markers->frames) times_s.push_back(frame.t_s);
      if (!recording.actuation) continue;
      times_s.insert(times_s.end(), recording.actuation->t_s.begin(),
                     recording.actuation->t_s.end());
    }
    fs::remove_all(options_.out);
    fs::remove(folder_ / "exp.answer.json");
    return std::pair(files, times_s);
  };
  EXPECT_EQ(listing(""), listing("effects: [{id: cable_gain, g: 0.1}, {id: camera_moved, "
                                 "translation_m: 0.02, from_recording: 1}]\nclutter: 1\n"));
}

TEST_F(SimulateTest, ChecksTheSeal) {
  ASSERT_EQ(Run(), 0);
  EXPECT_EQ(Check(), 0);
}

TEST_F(SimulateTest, SeesAnAnswerThatWasChanged) {
  ASSERT_EQ(Run(), 0);
  std::string text = AnswerText();
  text.replace(text.find("\"seed\": 1"), 9, "\"seed\": 2");
  WriteFile(folder_ / "exp.answer.json", text);
  EXPECT_THAT(CheckRefusal<RunError>(), HasSubstr("its hash differs from answer_sha256"));
}

TEST_F(SimulateTest, SeesDataThatWereChanged) {
  ASSERT_EQ(Run(), 0);
  const fs::path markers = options_.out / "recordings/a_rest/markers.csv";
  WriteFile(markers, ReadFile(markers) + "9,tip,0,0,0\n");
  EXPECT_THAT(CheckRefusal<RunError>(), HasSubstr("the recordings have changed"));
}

TEST_F(SimulateTest, SaysWhatIsMissingForACheck) {
  EXPECT_THAT(CheckRefusal<InputError>(), HasSubstr("experiment.yaml"));
  ASSERT_EQ(Run(), 0);
  fs::remove(folder_ / "exp.answer.json");
  EXPECT_THAT(CheckRefusal<InputError>(), HasSubstr("exp.answer.json: cannot be read"));
  WriteFile(options_.out / "experiment.yaml", "frame: robot\n");
  EXPECT_THAT(CheckRefusal<InputError>(), HasSubstr("has no key 'answer_sha256'"));
  const std::string text = "{}";
  WriteFile(folder_ / "exp.answer.json", text);
  WriteFile(options_.out / "experiment.yaml", "answer_sha256: \"" + Sha256Hex(text) + "\"\n");
  EXPECT_THAT(CheckRefusal<RunError>(), HasSubstr("is not a ground truth of palpate simulate"));
  options_.check = options_.out;
  EXPECT_THAT(Refusal(), HasSubstr("--check takes no other option than --answer"));
}

TEST_F(SimulateTest, PutsTheAnswerWhereItIsTold) {
  options_.answer = folder_ / "secret.json";
  ASSERT_EQ(Run(), 0);
  EXPECT_FALSE(fs::exists(folder_ / "exp.answer.json"));
  EXPECT_EQ(Read().answer_sha256, Sha256Hex(ReadFile(folder_ / "secret.json")));
  EXPECT_EQ(AnswerBeside("a/b/"), "a/b.answer.json");
}

}  // namespace
}  // namespace palpate::command
