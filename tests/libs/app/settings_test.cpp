// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/settings.hpp"

#include <gmock/gmock.h>

#include <functional>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"

namespace palpate::app {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct ContactSettings {
  double radius_m = 0.005;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("radius_m", radius_m, {.min = 0.0}, "Patch over which a contact force is spread");
  }
};

struct SettingsConfig {
  bool loop = false;
  int count = 51;
  double youngs_modulus_Pa = 65.0e3;
  std::string reliability = "reliable";
  std::string frame_id = "robot";
  std::filesystem::path robot_file = "robot.yaml";
  std::optional<double> rate_hz;
  Eigen::Vector3d gravity_m_s2{0.0, 0.0, -9.81};
  std::vector<double> weights{0.1, 1e-17};
  std::vector<std::string> names;
  ContactSettings contact;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("loop", loop, "Begin again at the end");
    v("count", count, {.min = 0.0, .max = 100.0, .min_open = true}, "Feature points");
    v("youngs_modulus_Pa", youngs_modulus_Pa, {.min = 1.0}, "Stiffness of the material at rest");
    v("reliability", reliability, {"reliable", "best_effort"}, "What a reader asks for");
    v("frame_id", frame_id, "Frame of all points");
    v("robot_file", robot_file, "Robot description");
    v("rate_hz", rate_hz, kPositive, "Frames per second; null: as recorded");
    v("gravity_m_s2", gravity_m_s2, "Gravity | robot frame");
    v("weights", weights, kNonNegative, "Weights");
    v("names", names, "Markers that count");
    v("contact", contact, "How contacts are spread");
  }
};

std::string SettingsRefusal(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void Load(const std::string& yaml, SettingsConfig* config) {
  LoadSettings(ParseYaml(yaml, "conf/a.yaml"), ListSettings(*config));
}

TEST(Settings, AnEmptyFileKeepsTheDefaults) {
  SettingsConfig config;
  Load("", &config);
  EXPECT_EQ(config.youngs_modulus_Pa, 65.0e3);
  EXPECT_EQ(config.count, 51);
}

TEST(Settings, TheFileSetsWhatItNamesAndNothingElse) {
  SettingsConfig config;
  Load(
      "loop: true\ncount: 7\nreliability: best_effort\nrate_hz: 30\nnames: [m1, m2]\n"
      "gravity_m_s2: [1, 2, 3]\nweights: []\ncontact:\n  radius_m: 0.01\n",
      &config);
  EXPECT_TRUE(config.loop);
  EXPECT_EQ(config.count, 7);
  EXPECT_EQ(config.reliability, "best_effort");
  EXPECT_EQ(config.rate_hz, 30.0);
  EXPECT_THAT(config.names, ElementsAre("m1", "m2"));
  EXPECT_EQ(config.gravity_m_s2, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_TRUE(config.weights.empty());
  EXPECT_EQ(config.contact.radius_m, 0.01);
  EXPECT_EQ(config.youngs_modulus_Pa, 65.0e3);
}

TEST(Settings, PathsOfAFileAreRelativeToItAndThoseOfTheCommandLineAreNot) {
  SettingsConfig config;
  Load("robot_file: ../robots/beam.yaml\n", &config);
  EXPECT_EQ(config.robot_file, "conf/../robots/beam.yaml");
  ApplyOverride("robot_file=beam.yaml", ListSettings(config));
  EXPECT_EQ(config.robot_file, "beam.yaml");
}

TEST(Settings, NullUnsetsAnOptionalOnly) {
  SettingsConfig config;
  config.rate_hz = 5.0;
  Load("rate_hz: null\n", &config);
  EXPECT_FALSE(config.rate_hz.has_value());
  EXPECT_THAT(SettingsRefusal([&] { Load("count:\n", &config); }), HasSubstr("must have a value"));
}

TEST(Settings, RefusalsNameFilePlaceKeyValueAndRule) {
  SettingsConfig config;
  EXPECT_EQ(SettingsRefusal([&] { Load("youngs_modulus_Pa: 0.5\n", &config); }),
            "conf/a.yaml:1:20: key 'youngs_modulus_Pa': must be >= 1, not 0.5");
  EXPECT_EQ(SettingsRefusal([&] { Load("contact: {radius_m: -1}\n", &config); }),
            "conf/a.yaml:1:21: key 'contact.radius_m': must be >= 0, not -1");
  EXPECT_THAT(SettingsRefusal([&] { Load("count: 101\n", &config); }),
              HasSubstr("1 to 100, not 101"));
  EXPECT_THAT(SettingsRefusal([&] { Load("count: 0\n", &config); }), HasSubstr("1 to 100, not 0"));
  EXPECT_THAT(SettingsRefusal([&] { Load("weights: [1, .nan]\n", &config); }),
              HasSubstr("weights[1]"));
  EXPECT_THAT(SettingsRefusal([&] { Load("loop: yes\n", &config); }), HasSubstr("true or false"));
  EXPECT_THAT(SettingsRefusal([&] { Load("names: m1\n", &config); }), HasSubstr("a list of texts"));
  EXPECT_THAT(SettingsRefusal([&] { Load("- 1\n", &config); }),
              HasSubstr("must be a map of settings"));
  EXPECT_THAT(SettingsRefusal([&] { Load("contact: 5\n", &config); }),
              HasSubstr("map of settings"));
  EXPECT_THAT(SettingsRefusal([&] { Load("reliability: relyable\n", &config); }),
              HasSubstr("did you mean 'reliable'?"));
}

TEST(Settings, UnknownKeysAreRefusedWithDidYouMean) {
  SettingsConfig config;
  EXPECT_THAT(SettingsRefusal([&] { Load("loop: true\nyoung_modulus_Pa: 5\n", &config); }),
              StartsWith("conf/a.yaml:2:1: unknown key 'young_modulus_Pa' (did you mean "
                         "'youngs_modulus_Pa'?); allowed: "));
  EXPECT_EQ(SettingsRefusal([&] { Load("contact: {radius: 5}\n", &config); }),
            "conf/a.yaml:1:11: unknown key 'contact.radius' (did you mean 'radius_m'?); allowed: "
            "radius_m");
  EXPECT_THAT(SettingsRefusal([&] { Load("contcat: {radius_m: 5}\n", &config); }),
              StartsWith("conf/a.yaml:1:1: unknown key 'contcat' (did you mean 'contact'?)"));
}

TEST(Settings, OverridesAreReadAsInAFile) {
  SettingsConfig config;
  const auto settings = ListSettings(config);
  ApplyOverride("contact.radius_m=0.02", settings);
  ApplyOverride("frame_id=\"a=b\"", settings);
  ApplyOverride("gravity_m_s2=[0, 0, 1]", settings);
  ApplyOverride("rate_hz=null", settings);
  EXPECT_EQ(config.contact.radius_m, 0.02);
  EXPECT_EQ(config.frame_id, "a=b");
  EXPECT_EQ(config.gravity_m_s2.z(), 1.0);
  EXPECT_EQ(SettingsRefusal([&] { ApplyOverride("contact.radius_m=-1", settings); }),
            "--set contact.radius_m=-1: key 'contact.radius_m': must be >= 0, not -1");
  EXPECT_THAT(SettingsRefusal([&] { ApplyOverride("radius_m=1", settings); }),
              AllOf(HasSubstr("unknown key 'radius_m'"), HasSubstr("--set")));
  EXPECT_THAT(SettingsRefusal([&] { ApplyOverride("cuont=1", settings); }),
              HasSubstr("mean 'count'"));
  EXPECT_THAT(SettingsRefusal([&] { ApplyOverride("count", settings); }), HasSubstr("KEY=VALUE"));
  EXPECT_THAT(SettingsRefusal([&] { ApplyOverride("=1", settings); }), HasSubstr("KEY=VALUE"));
  EXPECT_THAT(SettingsRefusal([&] { ApplyOverride("count=", settings); }),
              HasSubstr("must have a value"));
}

TEST(Settings, PrintedYamlReadsBackAsTheSameValues) {
  SettingsConfig config;
  config.frame_id = "a \"b\" \\ c: #d";
  config.robot_file = "/robots/no";
  config.names = {"yes", "12"};
  config.contact.radius_m = 1.0 / 3.0;
  SettingsConfig back;
  Load(PrintYaml(ListSettings(config)), &back);
  EXPECT_EQ(PrintYaml(ListSettings(back)), PrintYaml(ListSettings(config)));
  EXPECT_EQ(back.frame_id, config.frame_id);
  EXPECT_EQ(back.contact.radius_m, config.contact.radius_m);
  EXPECT_EQ(back.names, config.names);
}

TEST(Settings, PrintedYamlShowsHelpAndRange) {
  SettingsConfig config;
  const std::string yaml = PrintYaml(ListSettings(config));
  EXPECT_THAT(yaml, HasSubstr("# Stiffness of the material at rest (>= 1)\n"
                              "youngs_modulus_Pa: 65000\n"));
  EXPECT_THAT(yaml, HasSubstr("contact:\n  # Patch over which a contact force is spread (>= 0)\n"
                              "  radius_m: 0.005\n"));
}

TEST(Settings, MarkdownHasOneRowForEachParameter) {
  SettingsConfig config;
  const std::string table = PrintMarkdown(ListSettings(config));
  EXPECT_THAT(table, HasSubstr("| parameter | default | range | meaning |\n|---|---|---|---|\n"));
  EXPECT_THAT(table, HasSubstr("| `count` | `51` | > 0 and <= 100 | Feature points |\n"));
  EXPECT_THAT(table, HasSubstr("| `reliability` | `\"reliable\"` | reliable, best_effort | "));
  EXPECT_THAT(table, HasSubstr("Gravity \\| robot frame"));
}

}  // namespace
}  // namespace palpate::app
