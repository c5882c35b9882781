// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "components/palpate/node/watch/snapshot_text.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/monitor/snapshot_builder.hpp"
#include "libs/monitor/snapshot_json.hpp"

namespace palpate::command {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

dds::Message<idl::palpate_msgs::ComponentStatus> Report(const std::string& name,
                                                        const std::string& status,
                                                        double uptime_s = 5.0) {
  dds::Message<idl::palpate_msgs::ComponentStatus> message;
  dds::SetText(message->component_name, name);
  dds::SetText(message->status, status);
  dds::SetText(message->reason, status == "ok" ? "" : "the reason");
  message->uptime_s = uptime_s;
  message->received = 100;
  message->refused = 3;
  message->input_rate_hz = 29.5;
  message->latency_mean_s = 0.012;
  return message;
}

dds::Message<idl::diagnostic_msgs::DiagnosticArray> Diagnosis(
    const std::string& name, const std::vector<std::pair<std::string, std::string>>& values = {}) {
  dds::Message<idl::diagnostic_msgs::DiagnosticArray> message;
  dds::Resize(message->status, 1);
  auto& entry = message->status._buffer[0];
  entry.level = 2;
  dds::SetText(entry.name, name);
  dds::SetText(entry.message, "hot");
  dds::Resize(entry.values, values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    dds::SetText(entry.values._buffer[i].key, values[i].first);
    dds::SetText(entry.values._buffer[i].value, values[i].second);
  }
  return message;
}

dds::Message<idl::palpate_msgs::ForceArray> Forces(std::uint64_t counter, double force_N) {
  dds::Message<idl::palpate_msgs::ForceArray> message;
  message->counter = counter;
  message->age_s = 0.034;
  message->latency_s = 0.009;
  dds::SetText(message->status, "ok");
  dds::Resize(message->forces, 1);
  auto& force = message->forces._buffer[0];
  dds::SetText(force.name, "ball");
  dds::SetText(force.status, std::isnan(force_N) ? "unobservable" : "ok");
  force.position_m = {0.012, -0.005, 0.080};
  force.force_n = {0.0, 0.0, -force_N};
  force.ci95_n = std::isnan(force_N) ? kNaN : 0.04;
  force.covariance_n2[8] = std::isnan(force_N) ? kNaN : 0.0004;
  force.location_ci95_m = 0.003;
  force.location_covariance_m2[4] = 2e-6;
  return message;
}

/// Thirty messages a second from `begin_s` on, for a second.
void AddForces(monitor::SnapshotBuilder& builder, double begin_s) {
  for (std::uint64_t i = 0; i <= 30; ++i) {
    builder.Add(*Forces(i, 0.521), begin_s + static_cast<double>(i) / 30.0);
  }
}

TEST(Snapshot, WithoutAProcessItSaysSoWithTheDomain) {
  const monitor::SystemSnapshot snapshot = monitor::SnapshotBuilder(61).At(1.0, 0);
  EXPECT_THAT(SnapshotText(snapshot), HasSubstr("no palpate process in domain 61"));
  EXPECT_THAT(SnapshotText(snapshot), Not(HasSubstr("PROCESSES")));
  const Json json = Json::parse(monitor::SnapshotJson(snapshot));
  EXPECT_EQ(json.at("domain"), 61);
  EXPECT_TRUE(json.at("processes").empty());
  EXPECT_TRUE(json.at("forces").is_null());
}

TEST(Snapshot, ForcesHavePlaceSizeIntervalRateAndAge) {
  monitor::SnapshotBuilder builder(0);
  AddForces(builder, 10.0);
  const monitor::SystemSnapshot snapshot = builder.At(11.0, 0);
  ASSERT_TRUE(snapshot.forces);
  EXPECT_NEAR(snapshot.forces->flow.rate_hz, 30.0, 1e-6);
  const std::string text = SnapshotText(snapshot);
  EXPECT_THAT(text, HasSubstr("FORCES       ok; 30.0/s; age 34 ms, of it estimation 9 ms\n"));
  EXPECT_THAT(text, testing::ContainsRegex(
                        "ball +0.521 \\+- 0.040 N +at \\(12, -5, 80\\) mm \\+- 3 mm +ok\n"));
  const Json force = Json::parse(monitor::SnapshotJson(snapshot)).at("forces").at("contacts").at(0);
  EXPECT_EQ(force.at("name"), "ball");
  EXPECT_NEAR(force.at("size_N"), 0.521, 1e-12);
  EXPECT_NEAR(force.at("force_robot_N").at(2), -0.521, 1e-12);
  EXPECT_NEAR(force.at("position_robot_m").at(0), 0.012, 1e-12);
  EXPECT_EQ(force.at("ci95_N"), 0.04);
  EXPECT_EQ(force.at("covariance_robot_N2"), Json({{0, 0, 0}, {0, 0, 0}, {0, 0, 0.0004}}));
  EXPECT_EQ(force.at("location_covariance_robot_m2").at(1).at(1), 2e-6);
}

TEST(Snapshot, AForceThatIsNotKnownIsNoNumber) {
  monitor::SnapshotBuilder builder(0);
  builder.Add(*Forces(0, kNaN), 1.0);
  EXPECT_THAT(SnapshotText(builder.At(1.0, 0)), HasSubstr("? N"));
  const Json json = Json::parse(monitor::SnapshotJson(builder.At(1.0, 0)));
  const Json& force = json.at("forces").at("contacts").at(0);
  EXPECT_TRUE(force.at("size_N").is_null());
  EXPECT_TRUE(force.at("covariance_robot_N2").at(2).at(2).is_null());
}

TEST(Snapshot, LostMessagesAreCountedBySkippedCounters) {
  monitor::SnapshotBuilder builder(0);
  for (const std::uint64_t counter : {5u, 6u, 9u, 10u}) builder.Add(*Forces(counter, 1.0), 1.0);
  EXPECT_EQ(builder.At(1.0, 0).forces->flow.lost, 2u);
  EXPECT_THAT(SnapshotText(builder.At(1.0, 0)), HasSubstr("2 of 6 lost"));
  builder.Add(*Forces(0, 1.0), 1.1);  // restarted
  EXPECT_EQ(builder.At(1.1, 0).forces->flow.lost, 2u);
}

TEST(Snapshot, SilenceIsSaidInsteadOfARate) {
  monitor::SnapshotBuilder builder(0);
  AddForces(builder, 10.0);
  EXPECT_EQ(builder.At(15.0, 0).forces->flow.rate_hz, 0.0);
  EXPECT_THAT(SnapshotText(builder.At(15.0, 0)), HasSubstr("no message for 4.0 s"));
}

TEST(Snapshot, ProcessesAreInTheOrderOfTheDataWithWhatTheyReport) {
  monitor::SnapshotBuilder builder(0);
  for (const char* name : {"force_estimation", "other", "capture"}) {
    builder.Add(*Report(name, "ok"), 1.0);
  }
  builder.Add(*Report("perception", "stale"), 1.0);
  builder.Add(*Diagnosis("palpate_perception: perception", {{"waiting_for", "waiting for /a: none"},
                                                            {"received", "100"},
                                                            {"device", "camera"}}),
              1.0);
  const monitor::SystemSnapshot snapshot = builder.At(1.5, 0);
  std::vector<std::string> names;
  for (const monitor::ProcessState& process : snapshot.processes) names.push_back(process.name);
  EXPECT_THAT(names, testing::ElementsAre("capture", "perception", "force_estimation", "other"));
  const monitor::ProcessState& perception = snapshot.processes[1];
  EXPECT_EQ(perception.waiting_for, "waiting for /a: none");
  EXPECT_THAT(perception.values,
              testing::ElementsAre(std::pair<std::string, std::string>("device", "camera")));
  const std::string text = SnapshotText(snapshot);
  EXPECT_THAT(text, testing::ContainsRegex("perception +stale +29.5 "));
  EXPECT_THAT(text, HasSubstr("\n    the reason\n    waiting for /a: none\n"));
  const Json json = Json::parse(monitor::SnapshotJson(snapshot)).at("processes").at(1);
  EXPECT_EQ(json.at("status"), "stale");
  EXPECT_EQ(json.at("refused"), 3);
  EXPECT_EQ(json.at("diagnostics").at("device"), "camera");
}

TEST(Snapshot, AProcessThatReportsNoMoreIsSilentAndARestartIsCounted) {
  monitor::SnapshotBuilder builder(0);
  builder.Add(*Report("capture", "ok", 50.0), 1.0);
  EXPECT_THAT(SnapshotText(builder.At(3.5, 0)), testing::ContainsRegex("capture +ok"));
  EXPECT_THAT(SnapshotText(builder.At(6.0, 0)), HasSubstr("silent 5 s"));
  EXPECT_EQ(
      Json::parse(monitor::SnapshotJson(builder.At(6.0, 0))).at("processes").at(0).at("status"),
      "silent");
  builder.Add(*Report("capture", "ok", 1.0), 7.0);
  EXPECT_THAT(SnapshotText(builder.At(7.0, 0)), HasSubstr("restarts seen: 1"));
}

TEST(Snapshot, ClocksOfHostsAreThoseOfTheTightestMeasurement) {
  monitor::SnapshotBuilder builder(0);
  builder.Add(*Report("perception", "ok"), 1.0);
  builder.Add(*Report("force_estimation", "ok"), 1.0);
  builder.Add(
      *Diagnosis("palpate_perception: perception", {{"host", "camera"},
                                                    {"clock_offset_s.model", "0.0213"},
                                                    {"clock_offset_bound_s.model", "0.004"}}),
      1.0);
  builder.Add(*Diagnosis("palpate_force_estimation: force_estimation",
                         {{"host", "model"},
                          {"clock_offset_s.camera", "-0.0202"},
                          {"clock_offset_bound_s.camera", "0.0004"}}),
              1.0);
  const monitor::SystemSnapshot snapshot = builder.At(1.1, 0);
  ASSERT_EQ(snapshot.clocks.size(), 1U);
  EXPECT_THAT(SnapshotText(snapshot), HasSubstr("CLOCKS       camera is 20.2 ms behind model, "
                                                "+- 0.4 ms\n"));
  const Json clock = Json::parse(monitor::SnapshotJson(snapshot))["clocks"][0];
  EXPECT_EQ(clock["host"], "model");
  EXPECT_EQ(clock["offset_s"], -0.0202);
}

TEST(Snapshot, DiagnosticsOfOtherProgramsAreListedApart) {
  monitor::SnapshotBuilder builder(0);
  builder.Add(*Diagnosis("motor driver"), 1.0);
  EXPECT_THAT(SnapshotText(builder.At(1.0, 0)),
              testing::ContainsRegex("OTHER DIAGNOSTICS\n  motor driver +error +hot"));
  EXPECT_EQ(builder.At(1.0, 0).processes.size(), 0u);
}

TEST(Snapshot, ModelErrorHasTheMonitorsJudgement) {
  monitor::SnapshotBuilder builder(0);
  dds::Message<idl::palpate_msgs::ModelGap> gap;
  gap->residual_rms_m = 0.00031;
  gap->noise_rms_m = 0.00028;
  gap->sample_count = 250;
  builder.Add(*gap, 1.0);
  builder.Add(*Report("force_estimation", "ok"), 1.0);
  builder.Add(*Diagnosis("palpate_force_estimation: force_estimation", {{"model_gap", "holds"}}),
              1.0);
  EXPECT_THAT(SnapshotText(builder.At(1.0, 0)),
              HasSubstr("MODEL ERROR  holds; residual 0.31 mm, noise 0.28 mm, 250 samples"));
}

TEST(Snapshot, EveryFurtherTopicHasItsLine) {
  monitor::SnapshotBuilder builder(0);
  builder.Add(*Report("capture", "ok"), 1.0);
  dds::Message<idl::palpate_msgs::PerceptionReport> perceived;
  dds::SetText(perceived->status, "ok");
  perceived->robot_points = 4012;
  perceived->contacts = 1;
  builder.Add(*perceived, 1.0);
  dds::Message<idl::palpate_msgs::FrameInfo> frame;
  dds::SetText(frame->device, "V-1");
  frame->valid_ratio = 0.98;
  frame->packets_lost = 2;
  builder.Add(*frame, 1.0);
  frame->counter = 1;
  builder.Add(*frame, 1.0);
  dds::Message<idl::palpate_msgs::MeshState> mesh;
  dds::SetText(mesh->status, "no_contact");
  builder.Add(*mesh, 1.0);
  dds::Message<idl::sensor_msgs::JointState> cables;
  dds::Resize(cables->name, 1);
  dds::SetText(cables->name._buffer[0], "north");
  const double position_m = 0.005;
  dds::SetNumbers(cables->position, &position_m, 1);
  builder.Add(*cables, 1.0);
  dds::Message<idl::palpate_msgs::CalibrationStatus> calibration;
  dds::SetText(calibration->state, "collecting");
  calibration->frames_taken = 2;
  calibration->frames_wanted = 6;
  builder.Add(*calibration);
  const monitor::SystemSnapshot snapshot = builder.At(1.0, 0);
  const std::string text = SnapshotText(snapshot);
  EXPECT_THAT(text, HasSubstr("PERCEPTION   ok; 4012 robot points, 0 object points, 1 contacts"));
  EXPECT_THAT(text, HasSubstr("CAMERA       V-1 (epoch 0)"));
  EXPECT_THAT(text, HasSubstr("98 % of the pixels have depth"));
  EXPECT_THAT(text, HasSubstr("4 packets lost"));
  EXPECT_THAT(text, HasSubstr("MESH STATE   no_contact"));
  EXPECT_THAT(text, HasSubstr("; north 5.0 mm\n"));
  EXPECT_THAT(text, HasSubstr("CALIBRATION  collecting, 2 of 6 frames"));
  const Json json = Json::parse(monitor::SnapshotJson(snapshot));
  EXPECT_EQ(json.at("cables").at("cables").at(0).at("displacement_m"), 0.005);
  EXPECT_TRUE(json.at("cables").at("cables").at(0).at("tension_N").is_null());
  EXPECT_EQ(json.at("calibration").at("frames_wanted"), 6);
  EXPECT_EQ(json.at("perception").at("robot_points"), 4012);
}

TEST(Snapshot, ChambersHaveVolumeAndPressureInTheirUnits) {
  monitor::SnapshotBuilder builder(7);
  builder.SetChambers({"bend"});
  builder.Add(*Report("virtual_robot", "ok"), 1.0);
  dds::Message<idl::sensor_msgs::JointState> joints;
  dds::Resize(joints->name, 1);
  dds::SetText(joints->name._buffer[0], "bend");
  const double volume_m3 = 1.97e-6, pressure_Pa = 20e3;
  dds::SetNumbers(joints->position, &volume_m3, 1);
  dds::SetNumbers(joints->effort, &pressure_Pa, 1);
  builder.Add(*joints, 1.0);
  EXPECT_THAT(SnapshotText(builder.At(1.0, 0)),
              AllOf(HasSubstr("CHAMBERS     "), HasSubstr("; bend +1.97 cm3 20.00 kPa\n"),
                    Not(HasSubstr("CABLES"))));
  const Json state = Json::parse(monitor::SnapshotJson(builder.At(1.0, 0))).at("cables");
  EXPECT_TRUE(state.at("cables").empty());
  EXPECT_EQ(state.at("chambers").at(0).at("volume_m3"), volume_m3);
  EXPECT_EQ(state.at("chambers").at(0).at("pressure_Pa"), pressure_Pa);
  // Beside a cable.
  dds::Message<idl::sensor_msgs::JointState> both;
  dds::Resize(both->name, 2);
  dds::SetText(both->name._buffer[0], "north");
  dds::SetText(both->name._buffer[1], "bend");
  const std::array position{0.005, volume_m3};
  dds::SetNumbers(both->position, position.data(), 2);
  builder.Add(*both, 2.0);
  EXPECT_THAT(SnapshotText(builder.At(2.0, 0)),
              AllOf(HasSubstr("ACTUATORS    "), HasSubstr("; north 5.0 mm; bend +1.97 cm3")));
}

TEST(Snapshot, TextsThatAreNoUtf8StillGiveJson) {
  monitor::SnapshotBuilder builder(0);
  builder.Add(*Report("capture", "\xff\xfe"), 1.0);
  EXPECT_NO_THROW(Json::parse(monitor::SnapshotJson(builder.At(1.0, 0))));
}

}  // namespace
}  // namespace palpate::command
