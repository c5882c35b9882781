// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <dds/dds.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "libs/app/log.hpp"
#include "libs/app/node_options.hpp"
#include "libs/app/parameters.hpp"
#include "tests/components/palpate/topics/fake_node.hpp"

namespace palpate::command {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Settings of a process, as components have them.
struct Config {
  double silence_s = 2.5;
  int depth = 3;
  std::string source = "auto";
  std::vector<double> gains = {0.5, 2.0};
  std::optional<double> limit_m;
  dds::NodeSettings dds;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("silence_s", silence_s, {.min = 0.0, .min_open = true}, "Time without frames");
    v("depth", depth, {.min = 1, .max = 9}, "Messages kept");
    v("source", source, {"auto", "markers"}, "Data for the estimation");
    v("gains", gains, "Gains");
    v("limit_m", limit_m, "Largest distance");
    v("dds", dds, "DDS side");
  }
};

/// A process with parameters, as RunNode() makes them.
class FakeProcess : public FakeNode {
 public:
  explicit FakeProcess(std::vector<std::string> remap = {})
      : FakeNode("palpate_fake", Parameters(), std::move(remap)) {
    Run();
  }

 private:
  static std::vector<Parameter> Parameters() {
    app::NodeCommand<Config> command;
    command.options.config_file = "fake.yaml";
    app::AddParameters("palpate-fake", &command);
    return command.config.dds.parameters;
  }
};

TEST(NodeList, NamesNodesAndProcessesWithoutOne) {
  const FakeProcess process;
  const dds::Entity plain(
      dds_create_participant(static_cast<dds_domainid_t>(TestDomain()), nullptr, nullptr),
      "participant");
  EXPECT_EQ(RunVerb({"node", "list"}).output, "/palpate_fake\n");
  EXPECT_EQ(RunVerb({"node", "list", "-c"}).output, "1\n");
  EXPECT_THAT(RunVerb({"node", "list", "-a"}).output,
              AllOf(HasSubstr("/palpate_fake\n"), HasSubstr("(DDS participant) ")));
  const auto json = nlohmann::json::parse(RunVerb({"node", "list", "--json"}).output);
  EXPECT_EQ(json.at("nodes"), nlohmann::json({"/palpate_fake"}));
  EXPECT_EQ(json.at("other_participants").size(), 1u);
}

TEST(NodeList, SaysWhereTwoHaveOneName) {
  const FakeProcess first;
  const FakeProcess second;
  const Outcome outcome = RunVerb({"node", "list"});
  EXPECT_EQ(outcome.output, "/palpate_fake\n/palpate_fake\n");
  EXPECT_THAT(outcome.errors, HasSubstr("2 nodes have the name /palpate_fake"));
}

TEST(NodeInfo, GroupsTopicsAndServices) {
  FakeProcess process({"__ns:=/left"});
  const auto writer = process.participant.CreateWriter(dds::kForcesTopic);
  const Outcome outcome = RunVerb({"node", "info", "/left/palpate_fake"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("/left/palpate_fake\n  Subscribers:\n  Publishers:\n"
                                              "    /left/forces: palpate_msgs/msg/ForceArray\n"
                                              "  Service Servers:\n"),
                                    HasSubstr("    /left/palpate_fake/get_parameters: "
                                              "rcl_interfaces/srv/GetParameters\n"),
                                    HasSubstr("  Action Clients:\n")));
  const auto json = nlohmann::json::parse(
      RunVerb({"node", "info", "palpate_fake", "--json", "--remap", "__ns:=/left"}).output);
  EXPECT_EQ(json.at("publishers").at(0).at("name"), "/left/forces");
  EXPECT_EQ(json.at("service_servers").size(), 6u);
}

TEST(NodeInfo, RefusesAnUnknownNode) {
  const FakeProcess process;
  const Outcome outcome = RunVerb({"node", "info", "/palpate_fkae", "--spin-time", "0.5"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("did you mean '/palpate_fake'?"));
}

TEST(ParamList, NamesTheSettingsOfANode) {
  const FakeProcess process;
  const Outcome all = RunVerb({"param", "list"});
  EXPECT_EQ(all.exit_code, 0) << all.errors;
  EXPECT_THAT(all.output, AllOf(HasSubstr("/palpate_fake:\n"), HasSubstr("  silence_s\n"),
                                HasSubstr("  use_sim_time\n"), HasSubstr("  log_level\n")));
  EXPECT_THAT(RunVerb({"param", "list", "/palpate_fake", "--param-type"}).output,
              AllOf(HasSubstr("  gains (type: double array)\n"),
                    HasSubstr("  limit_m (type: not set)\n"), Not(HasSubstr("/palpate_fake"))));
  EXPECT_THAT(RunVerb({"param", "list", "palpate_fake", "--param-prefixes", "dds"}).output,
              AllOf(HasSubstr("  dds.remap\n"), Not(HasSubstr("silence_s"))));
}

TEST(ParamGet, PrintsValuesOfEveryType) {
  const FakeProcess process;
  const auto line = [](const std::string& name) {
    return RunVerb({"param", "get", "/palpate_fake", name}).output;
  };
  EXPECT_EQ(line("silence_s"), "Double value is: 2.5\n");
  EXPECT_EQ(line("depth"), "Integer value is: 3\n");
  EXPECT_EQ(line("source"), "String value is: auto\n");
  EXPECT_EQ(line("gains"), "Double values are: [0.5, 2.0]\n");
  EXPECT_EQ(line("use_sim_time"), "Boolean value is: False\n");
  EXPECT_EQ(line("limit_m"), "Parameter not set.\n");
  EXPECT_EQ(RunVerb({"param", "get", "/palpate_fake", "depth", "--hide-type"}).output, "3\n");
  const auto json =
      nlohmann::json::parse(RunVerb({"param", "get", "/palpate_fake", "gains", "--json"}).output);
  EXPECT_EQ(json.at("value"), nlohmann::json({0.5, 2.0}));
  const Outcome unknown = RunVerb({"param", "get", "/palpate_fake", "silense_s"});
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.errors, HasSubstr("did you mean 'silence_s'?"));
}

TEST(ParamDescribe, GivesMeaningAndRange) {
  const FakeProcess process;
  EXPECT_EQ(RunVerb({"param", "describe", "/palpate_fake", "depth", "source"}).output,
            "Parameter name: depth\n  Type: integer\n  Description: Messages kept\n"
            "  Constraints:\n    Read only: true\n    Min value: 1\n    Max value: 9\n"
            "Parameter name: source\n  Type: string\n  Description: Data for the estimation\n"
            "  Constraints:\n    Read only: true\n    Additional constraints: auto, markers\n");
  const auto json = nlohmann::json::parse(
      RunVerb({"param", "describe", "/palpate_fake", "silence_s", "log_level", "--json"}).output);
  EXPECT_EQ(json.at(0).at("constraints"), "> 0");
  EXPECT_EQ(json.at(0).at("read_only"), true);
  EXPECT_EQ(json.at(1).at("read_only"), false);
}

TEST(ParamSet, ChangesTheLogLevelAndRefusesTheRestWithTheRemedy) {
  const FakeProcess process;
  const Outcome set = RunVerb({"param", "set", "/palpate_fake", "log_level", "error"});
  EXPECT_EQ(set.exit_code, 0) << set.errors;
  EXPECT_EQ(set.output, "Set parameter successful\n");
  EXPECT_EQ(RunVerb({"param", "get", "/palpate_fake", "log_level"}).output,
            "String value is: error\n");
  const Outcome wrong = RunVerb({"param", "set", "/palpate_fake", "log_level", "errro"});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.errors, HasSubstr("did you mean 'error'?"));
  ASSERT_TRUE(app::SetLogLevel("warning"));

  const Outcome fixed = RunVerb({"param", "set", "/palpate_fake", "silence_s", "3"});
  EXPECT_EQ(fixed.exit_code, 1);
  EXPECT_EQ(fixed.errors,
            "Setting parameter failed: read at start; change silence_s in fake.yaml and restart "
            "palpate-fake\n");
  EXPECT_EQ(RunVerb({"param", "set", "/palpate_fake", "depth", "many"}).exit_code, 2);
}

TEST(Param, SaysWhereANodeHasNone) {
  const FakeNode node("bare");
  const Outcome outcome = RunVerb({"param", "list", "/bare"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("node '/bare' has no services for parameters"));
}

}  // namespace
}  // namespace palpate::command
