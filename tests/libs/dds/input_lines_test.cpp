// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/input_lines.hpp"

#include <gmock/gmock.h>

#include <utility>

namespace palpate::dds {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Inputs whose states and time the test sets.
class Inputs {
 public:
  explicit Inputs(const std::vector<InputName>& names) {
    for (const InputName& name : names) lines_.Add(name);
    states.resize(names.size());
  }

  /// The texts of the lines at `now_s` after the start.
  std::vector<std::string> At(double now_s) {
    std::vector<std::string> texts;
    for (const InputLines::Line& line : lines_.Advance(100.0 + now_s, states)) {
      texts.push_back(line.text);
    }
    return texts;
  }
  std::string Waiting() const { return lines_.Waiting(); }

  std::vector<InputState> states;

 private:
  InputLines lines_{7, 100.0};
};

const InputName kCloud{"/perception/robot_cloud", "palpate-perception", InputKind::kStream};
const InputName kReport{"/perception/report", "palpate-perception", InputKind::kStream};
const InputName kSetup{"/camera/setup", "palpate-capture", InputKind::kLatched};
constexpr char kNoCloud[] =
    "waiting for /perception/robot_cloud: no publisher in domain 7; palpate-perception publishes "
    "it";

TEST(InputLines, AnInputWithoutPublisherIsSaidAfterTwoSecondsAndThenAtGrowingIntervals) {
  Inputs inputs({kCloud});
  std::vector<double> said_s;
  for (double t_s = 0.0; t_s <= 60.0; t_s += 0.5) {
    for (const std::string& text : inputs.At(t_s)) {
      EXPECT_EQ(text, kNoCloud);
      said_s.push_back(t_s);
    }
  }
  EXPECT_THAT(said_s, ElementsAre(2.0, 10.0, 26.0, 58.0));
  EXPECT_EQ(inputs.Waiting(), kNoCloud);
}

TEST(InputLines, WhatElseMayBeTheReasonIsSaidUntilMessagesCome) {
  InputName cloud = kCloud;
  cloud.hint = "--camera-pose is missing";
  Inputs inputs({cloud});
  EXPECT_THAT(inputs.At(2.0), ElementsAre(kNoCloud + std::string("; --camera-pose is missing")));
  inputs.states[0].publishers = 1;
  EXPECT_THAT(inputs.At(2.5), ElementsAre("waiting for /perception/robot_cloud: no message within "
                                          "2.5 s; publisher present; --camera-pose is missing"));
}

TEST(InputLines, TheFirstMessageIsSaidWhereItWasWaitedFor) {
  Inputs inputs({kCloud});
  EXPECT_THAT(inputs.At(1.5), IsEmpty());
  ASSERT_THAT(inputs.At(2.0), ElementsAre(kNoCloud));
  inputs.states[0] = {.taken = 1, .publishers = 1, .publishers_ever = 1};
  EXPECT_THAT(inputs.At(2.5), ElementsAre("/perception/robot_cloud: first message"));
  EXPECT_EQ(inputs.Waiting(), "");
  inputs.states[0].taken = 20;
  EXPECT_THAT(inputs.At(3.0), IsEmpty());
}

TEST(InputLines, NothingIsSaidOfAnInputThatComesInTime) {
  Inputs inputs({kCloud});
  for (double t_s = 0.5; t_s < 100.0; t_s += 0.5) {
    inputs.states[0] = {
        .taken = inputs.states[0].taken + 15, .publishers = 1, .publishers_ever = 1};
    EXPECT_THAT(inputs.At(t_s), IsEmpty());
  }
}

TEST(InputLines, APublisherThatSendsNothingIsToldFromOneThatIsMissing) {
  Inputs inputs({kCloud});
  inputs.states[0] = {.taken = 0, .publishers = 1, .publishers_ever = 1};
  EXPECT_THAT(inputs.At(2.0), ElementsAre("waiting for /perception/robot_cloud: no message within "
                                          "2 s; publisher present"));
  inputs.states[0].taken = 5;
  EXPECT_THAT(inputs.At(3.0), ElementsAre("/perception/robot_cloud: first message"));
  EXPECT_THAT(inputs.At(4.5), IsEmpty());
  EXPECT_THAT(inputs.At(6.2), ElementsAre("waiting for /perception/robot_cloud: no message for "
                                          "3.2 s; publisher present"));
  inputs.states[0].publishers = 0;
  EXPECT_THAT(inputs.At(6.5), ElementsAre(kNoCloud));
  inputs.states[0] = {.taken = 6, .publishers = 1, .publishers_ever = 2};
  EXPECT_THAT(inputs.At(7.0), ElementsAre("/perception/robot_cloud: messages again"));
}

TEST(InputLines, APublisherOfAnotherQosIsNamedAsSuch) {
  Inputs inputs({kCloud});
  inputs.states[0].incompatible_qos = 1;
  inputs.states[0].incompatible_policy = "reliability";
  EXPECT_THAT(inputs.At(2.0),
              ElementsAre("waiting for /perception/robot_cloud: the publisher's QoS does not "
                          "match: it is best_effort, reliable is asked for (topics_file)"));
}

TEST(InputLines, EveryPolicyThatDoesNotMatchHasItsWord) {
  const std::pair<const char*, const char*> words[] = {
      {"durability", "it is volatile, transient_local is asked for (camera.qos)"},
      {"deadline", "deadline is weaker than asked for (camera.qos)"}};
  for (const auto& [policy, word] : words) {
    InputName camera = kCloud;
    camera.qos_setting = "camera.qos";
    Inputs inputs({camera});
    inputs.states[0].incompatible_qos = 1;
    inputs.states[0].incompatible_policy = policy;
    EXPECT_THAT(inputs.At(2.0), ElementsAre(testing::HasSubstr(word)));
  }
}

TEST(InputLines, InputsOfOnePublisherShareALine) {
  Inputs inputs({kCloud, kSetup, kReport});
  EXPECT_THAT(
      inputs.At(2.0),
      ElementsAre("waiting for /camera/setup: no publisher in domain 7; palpate-capture publishes "
                  "it",
                  "waiting for /perception/robot_cloud, /perception/report: no publisher in domain "
                  "7; palpate-perception publishes them"));
  inputs.states[0] = inputs.states[2] = {.taken = 1, .publishers = 1, .publishers_ever = 1};
  EXPECT_THAT(inputs.At(2.5),
              ElementsAre("/perception/robot_cloud, /perception/report: first message"));
}

TEST(InputLines, ALatchedInputIsThereOnceItHasCome) {
  Inputs inputs({kSetup});
  inputs.states[0] = {.taken = 1, .publishers = 1, .publishers_ever = 1};
  EXPECT_THAT(inputs.At(0.5), IsEmpty());
  EXPECT_THAT(inputs.At(500.0), IsEmpty());
  inputs.states[0].publishers = 0;
  EXPECT_THAT(inputs.At(600.0), IsEmpty());
}

TEST(InputLines, ARestartOfThePublisherIsSaid) {
  Inputs inputs({kCloud});
  inputs.states[0] = {.taken = 1, .publishers = 1, .publishers_ever = 1};
  EXPECT_THAT(inputs.At(0.5), IsEmpty());
  inputs.states[0] = {.taken = 2, .publishers = 2, .publishers_ever = 2};
  EXPECT_THAT(inputs.At(1.0), ElementsAre("/perception/robot_cloud: another publisher appeared: "
                                          "palpate-perception was restarted, or runs twice"));
  EXPECT_THAT(inputs.At(1.5), IsEmpty());
}

TEST(InputLines, AnInputIsWaitedForFromWhenItIsNeeded) {
  Inputs inputs({kCloud});
  inputs.states[0].needed = false;
  EXPECT_THAT(inputs.At(50.0), IsEmpty());
  inputs.states[0].needed = true;
  EXPECT_THAT(inputs.At(50.5), IsEmpty());
  EXPECT_THAT(inputs.At(52.0), IsEmpty());
  EXPECT_THAT(inputs.At(52.5), ElementsAre(kNoCloud));
  inputs.states[0].needed = false;
  EXPECT_THAT(inputs.At(53.0), IsEmpty());
  EXPECT_EQ(inputs.Waiting(), "");
}

}  // namespace
}  // namespace palpate::dds
