// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/system/system_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "components/palpate/find_robot.hpp"
#include "components/palpate/launch/launch_plan.hpp"
#include "components/palpate/launch/transport.hpp"
#include "components/palpate/system/system_file_keys.hpp"
#include "libs/app/yaml.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/scenario/scenario.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {
namespace {

using test_support::MessageOf;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class SystemFiles : public testing::Test {
 protected:
  SystemFile Read(const std::string& text, const SystemVariables& variables = {}) {
    return ReadSystemFile(folder_.Write("system.yaml", text), app::LoadYaml, variables);
  }
  std::string Refusal(const std::string& text, const SystemVariables& variables = {}) {
    return MessageOf([&] { Read(text, variables); });
  }
  /// Of a file with this process.
  std::string ProcessRefusal(const std::string& process) {
    return Refusal("name: s\nhosts:\n  - name: h\n    processes:\n      - " + process + "\n");
  }

  test_support::TestFolder folder_;
};

TEST_F(SystemFiles, AreReadWithAllTheirKeys) {
  const SystemFile system = Read(R"(
name: bench
domain: 7
namespace: /left
transport: lan
security: keys
stop: {interrupt_s: 2, terminate_s: 3}
variables: {robot: beam}
hosts:
  - name: one
    address: 192.168.1.10
    interface: eth0
    processes:
      - name: forces
        component: force_estimation
        settings: forces.yaml
        arguments: [$(robot), --contact, "tip: 0, 0, 0"]
        set: {silence_s: 5, source: "markers", contacts: [a, "b: c"], dds.use_sim_time: true}
        remap: ["/forces:=/touch"]
        environment: {OMP_NUM_THREADS: 1}
        after: [other]
        required: true
        respawn: {when: always, limit: 2, backoff_s: 0.5, longest_backoff_s: 4, reset_after_s: 9}
        ready_timeout_s: 20
        nice: 3
      - {name: other, program: /bin/true}
)");
  EXPECT_EQ(system.domain_id, 7);
  EXPECT_EQ(system.node_namespace, "/left");
  EXPECT_EQ(system.security, folder_ / "keys");
  EXPECT_EQ(system.stop.terminate_s, 3.0);
  ASSERT_EQ(system.hosts.size(), 1U);
  EXPECT_EQ(system.hosts[0].network_interface, "eth0");
  const ProcessPlan& forces = system.hosts[0].processes[0];
  EXPECT_EQ(forces.settings, folder_ / "forces.yaml");
  EXPECT_THAT(forces.arguments, ElementsAre("beam", "--contact", "tip: 0, 0, 0"));
  EXPECT_THAT(forces.set, ElementsAre("silence_s=5", "source=\"markers\"", "contacts=[a, \"b: c\"]",
                                      "dds.use_sim_time=true"));
  EXPECT_EQ(forces.environment.at("OMP_NUM_THREADS"), "1");
  ASSERT_TRUE(forces.respawn.has_value());
  EXPECT_TRUE(forces.respawn->always);
  EXPECT_EQ(forces.respawn->longest_backoff_s, 4.0);
  EXPECT_TRUE(forces.notifies);
  EXPECT_FALSE(system.hosts[0].processes[1].notifies);
}

TEST_F(SystemFiles, NameFileLineAndColumnOfWhatIsWrong) {
  EXPECT_THAT(Refusal("name: s\nhots: []\n"),
              AllOf(HasSubstr("system.yaml"), HasSubstr("'hosts' is missing"), HasSubstr("hots")));
  EXPECT_THAT(ProcessRefusal("{name: a, component: captur}"),
              AllOf(HasSubstr("system.yaml:5:"), HasSubstr("did you mean 'capture'?")));
  EXPECT_THAT(ProcessRefusal("{name: a, component: capture, requird: true}"),
              AllOf(HasSubstr("system.yaml:5:"), HasSubstr("did you mean 'required'?")));
  EXPECT_THAT(ProcessRefusal("{name: a, component: capture, program: /bin/true}"),
              HasSubstr("exactly one of"));
  EXPECT_THAT(ProcessRefusal("{name: a}"), HasSubstr("exactly one of"));
  EXPECT_THAT(ProcessRefusal("{name: a, program: /bin/true, set: {a: 1}}"),
              HasSubstr("is of components alone"));
  EXPECT_THAT(ProcessRefusal("{name: a b, component: capture}"), HasSubstr("letters, digits"));
  EXPECT_THAT(ProcessRefusal("{name: a, component: capture, respawn: {limit: 0}}"),
              HasSubstr("must be 1 to 1000"));
  EXPECT_THAT(ProcessRefusal("{name: a, component: capture, respawn: {backoff_s: 60}}"),
              HasSubstr("must not be below backoff_s"));
  EXPECT_THAT(ProcessRefusal("{name: a, component: capture, ready_timeout_s: 0}"),
              HasSubstr("must be > 0"));
  EXPECT_THAT(ProcessRefusal("{name: a, component: capture, environment: {NOTIFY_SOCKET: x}}"),
              HasSubstr("is set by palpate launch"));
}

TEST_F(SystemFiles, RefuseAnOrderThatCannotBe) {
  EXPECT_THAT(ProcessRefusal("{name: a, component: capture, after: [b]}"),
              HasSubstr("unknown process 'b'"));
  EXPECT_THAT(ProcessRefusal("{name: a, component: capture, after: [a]}"), HasSubstr("circle"));
  EXPECT_THAT(ProcessRefusal("{name: a, component: capture, after: [b]}\n"
                             "      - {name: b, component: capture, after: [a]}"),
              HasSubstr("circle"));
  EXPECT_THAT(ProcessRefusal("{name: a, component: capture}\n"
                             "      - {name: a, component: capture}"),
              HasSubstr("two processes"));
}

TEST_F(SystemFiles, RefuseATransportThatDoesNotFitTheHosts) {
  const std::string process = "processes: [{name: a, component: capture}]";
  const std::string other = "processes: [{name: b, component: perception}]";
  EXPECT_THAT(Refusal("name: s\ntransport: one_host\nhosts:\n  - {name: left, " + process +
                      "}\n  - {name: right, " + other + "}\n"),
              AllOf(HasSubstr("system.yaml:2:"), HasSubstr("stays on loopback")));
  EXPECT_THAT(
      Refusal("name: s\ntransport: lossy_link\nhosts:\n  - {name: left, " + process + "}\n"),
      HasSubstr("'address' is missing"));
  EXPECT_THAT(Refusal("name: s\nhosts:\n  - {name: left, address: there, " + process + "}\n"),
              HasSubstr("must be an IPv4 address"));
  EXPECT_THAT(Refusal("name: s\ntransport: wlan\nhosts:\n  - {name: left, " + process + "}\n"),
              HasSubstr("did you mean 'lan'?"));
}

TEST_F(SystemFiles, ReplaceVariables) {
  const std::string text =
      "name: s\nvariables: {robot: beam, n: 3}\nhosts:\n  - name: h\n    processes:\n"
      "      - {name: a, component: capture, nice: $(n), arguments: [$(dirname)/x, "
      "$(robot)_$(n)]}\n";
  const ProcessPlan plan = Read(text, {{"robot", "rod"}}).hosts[0].processes[0];
  EXPECT_EQ(plan.nice, 3);
  EXPECT_THAT(plan.arguments, ElementsAre((folder_ / "x").string(), "rod_3"));
  const std::string nested =
      "name: s\nvariables: {a: x, b: $(a)/y}\nhosts:\n  - name: h\n    processes:\n"
      "      - {name: a, component: capture, arguments: [$(b)]}\n";
  EXPECT_THAT(Read(nested, {{"a", "z"}}).hosts[0].processes[0].arguments, ElementsAre("z/y"));
  EXPECT_THAT(Refusal(text, {{"robt", "rod"}}), HasSubstr("did you mean 'robot'?"));
  EXPECT_THAT(ProcessRefusal("{name: a, component: capture, arguments: [$(x)]}"),
              AllOf(HasSubstr("system.yaml:5:"), HasSubstr("unknown variable 'x'")));
}

TEST_F(SystemFiles, TheShippedOnesAreReadAndTheirHostsPlanned) {
  EXPECT_THAT(KnownSystems(), testing::IsSupersetOf(
                                  {"demo", "recorder_host", "replay", "ros2_camera", "two_hosts"}));
  for (const std::string& name : KnownSystems()) {
    const SystemFile system = ReadSystemFile(FindSystemFile(name), app::LoadYaml);
    EXPECT_EQ(system.name, name);
    for (HostPlan host : system.hosts) {
      for (const ProcessPlan& plan : host.processes) EXPECT_EQ(plan.where.file, system.file);
    }
  }
  EXPECT_THAT(MessageOf([] { FindSystemFile("dmo"); }), HasSubstr("did you mean 'demo'?"));
}

TEST_F(SystemFiles, TheCameraPoseOfTheDemonstrationIsThatOfItsScenario) {
  const SystemFile system = ReadSystemFile(FindSystemFile("demo"), app::LoadYaml);
  const auto scenario =
      scenario::ReadScenario(FindProjectFile("config/scenarios/sensing.yaml"), app::LoadYaml);
  HostPlan host = system.hosts[0];
  const ConfigNode set = app::ParseYaml(
      FindProcess(host, "perception").set.at(0).substr(std::string("camera_pose=").size()), "set");
  const Eigen::Isometry3d pose = geometry::ReadPose(app::ParseYaml(set.text, "pose"));
  EXPECT_TRUE(pose.isApprox(scenario.camera->T_robot_camera, 1e-8));
}

TEST_F(SystemFiles, NameEveryComponentOfTheBuild) {
  std::vector<std::string> built;
  std::istringstream programs(PALPATE_PROGRAMS);
  for (std::string program; programs >> program;) {
    std::string name = program.substr(std::string("palpate-").size());
    std::replace(name.begin(), name.end(), '-', '_');
    built.push_back(name);
  }
  EXPECT_THAT(ComponentNames(), testing::UnorderedElementsAreArray(built));
}

TEST_F(SystemFiles, BecomeCommandLines) {
  SystemFile system = Read(
      "name: s\ndomain: 5\nhosts:\n  - name: h\n    processes:\n"
      "      - {name: cam, component: capture, set: {queue: 3}}\n"
      "      - {name: shell, program: sh, arguments: [-c, \"echo 'a'\"], nice: 4}\n");
  ApplySet("cam.queue=4", &system.hosts[0]);
  EXPECT_THAT(system.hosts[0].processes[0].set, ElementsAre("queue=3", "queue=4"));
  EXPECT_THAT(MessageOf([&] { ApplySet("cm.queue=4", &system.hosts[0]); }),
              HasSubstr("did you mean 'cam'?"));
  EXPECT_THAT(MessageOf([&] { ApplySet("queue=4", &system.hosts[0]); }),
              HasSubstr("PROCESS.KEY=VALUE"));
  EXPECT_THAT(MessageOf([&] { ApplySet("shell.a=4", &system.hosts[0]); }),
              HasSubstr("is no component"));
  system.hosts[0].processes.erase(system.hosts[0].processes.begin());
  const LaunchedProcess shell = MakeLaunchPlan(system, system.hosts[0]).at(0);
  EXPECT_EQ(shell.command.environment.at("ROS_DOMAIN_ID"), "5");
  EXPECT_EQ(shell.command.nice, 4);
  EXPECT_THAT(ShellLine(shell.command), testing::EndsWith("/sh -c 'echo '\\''a'\\'''"));
}

TEST_F(SystemFiles, RefuseAProgramThatIsNotThere) {
  const SystemFile system = Read(
      "name: s\nhosts:\n  - name: h\n    processes:\n"
      "      - {name: a, program: no_such_program}\n");
  EXPECT_THAT(MessageOf([&] { MakeLaunchPlan(system, system.hosts[0]); }),
              AllOf(HasSubstr("system.yaml:5:"), HasSubstr("no program 'no_such_program'")));
}

TEST_F(SystemFiles, TellTheProcessesWhereTheOtherHostsAre) {
  const SystemFile system = Read(
      "name: s\ntransport: lossy_link\npeers: [10.0.0.9]\nsecurity: keys\nhosts:\n"
      "  - {name: left, address: 10.0.0.1, processes: [{name: a, component: capture}]}\n"
      "  - {name: right, address: 10.0.0.2, interface: eth1, "
      "processes: [{name: b, component: perception}]}\n");
  const auto x = MiddlewareEnvironment(system, system.hosts[0]);
  EXPECT_THAT(x.at("CYCLONEDDS_URI"), testing::EndsWith("config/cyclonedds/lossy_link.xml"));
  EXPECT_EQ(x.at("PALPATE_PEERS"), "10.0.0.2,10.0.0.9");
  EXPECT_EQ(x.at("PALPATE_INTERFACE"), "10.0.0.1");
  EXPECT_EQ(x.at("PALPATE_SECURITY_DIR"), (folder_ / "keys").string());
  EXPECT_EQ(MiddlewareEnvironment(system, system.hosts[1]).at("PALPATE_INTERFACE"), "eth1");
}

TEST_F(SystemFiles, OneOfSeveralHostsIsChosenByNameOrAddress) {
  const auto text = [](const std::string& address) {
    return "name: s\nhosts:\n  - {name: left, processes: [{name: a, component: capture}]}\n"
           "  - {name: right, address: " +
           address + ", processes: [{name: b, component: perception}]}\n";
  };
  SystemFile system = Read(text("192.0.2.77"));
  EXPECT_EQ(ChooseHost(system, "left").name, "left");
  EXPECT_THAT(MessageOf([&] { ChooseHost(system, "z"); }),
              AllOf(HasSubstr("unknown host 'z'"), HasSubstr("left, right")));
  EXPECT_THAT(MessageOf([&] { ChooseHost(system, ""); }), HasSubstr("--host is required"));
  SystemFile here = Read(text("127.0.0.1"));
  EXPECT_EQ(ChooseHost(here, "").name, "right");
}

}  // namespace
}  // namespace palpate::command
