// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "libs/core/file.hpp"
#include "libs/core/statistics.hpp"
#include "libs/dds/cloud_messages.hpp"
#include "libs/dds/geometry_messages.hpp"
#include "libs/dds/transforms.hpp"
#include "libs/geometry/frames.hpp"
#include "tests/components/view/client/web_client.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/system/process.hpp"

namespace palpate::system_test {
namespace {

using namespace std::chrono_literals;
using dds::TestNode;
using testing::HasSubstr;
using view::WebClient;
using Json = nlohmann::json;

/// palpate-view in the domain of this test.
class ViewProgram : public testing::Test {
 protected:
  void Start(std::vector<std::string> arguments = {}) {
    arguments.insert(arguments.end(), {"--set", "http.port=0", "--set", "foxglove.port=0"});
    process_ = std::make_unique<Process>("palpate-view", arguments, log_);
  }
  /// The number behind `mark` in the log, once it is there; 0: it does not come.
  int PortBehind(const std::string& mark) {
    const auto end = std::chrono::steady_clock::now() + 20s;
    while (std::chrono::steady_clock::now() < end && !process_->Wait(0s)) {
      const std::string output = process_->Output();
      const std::size_t at = output.find(mark);
      if (at != output.npos) return std::atoi(output.c_str() + at + mark.size());
      node_.loop.DispatchUntil([] { return false; }, std::chrono::steady_clock::now() + 20ms);
    }
    ADD_FAILURE() << process_->Output();
    return 0;
  }
  int PagePort() { return PortBehind("page: http://127.0.0.1:"); }
  int FoxglovePort() { return PortBehind("Foxglove: ws://127.0.0.1:"); }

  std::filesystem::path log_ = std::filesystem::path(testing::TempDir()) /
                               (std::string("palpate_view_program_") +
                                testing::UnitTest::GetInstance()->current_test_info()->name());
  TestNode node_{"force_estimation"};
  std::unique_ptr<Process> process_;
};

TEST_F(ViewProgram, RefusesTheNetworkWithoutAToken) {
  EXPECT_EQ(RunProgram("palpate-view", {"--set", "http.address=0.0.0.0"}, log_), 2);
  EXPECT_THAT(ReadFile(log_), HasSubstr("http.token_file"));
  EXPECT_EQ(RunProgram("palpate-view", {"--recording", "/no/such.mcap"}, log_), 2);
  EXPECT_THAT(ReadFile(log_), HasSubstr("/no/such.mcap"));
}

TEST_F(ViewProgram, EndsCleanlyWithClients) {
  Start();
  WebClient page(PagePort());
  page.Upgrade("/live");
  WebClient foxglove(FoxglovePort());
  foxglove.Upgrade("/", "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n");
  process_->Signal(SIGINT);
  EXPECT_EQ(process_->Wait(10s), 0);
  EXPECT_TRUE(page.AwaitEnd() && foxglove.AwaitEnd());
}

TEST_F(ViewProgram, RecordsForThePageWhereItMay) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "palpate_view_records";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  Start({"--set", "allow_control=true", "--set", "record_folder=" + folder.string()});
  WebClient page(PagePort());
  page.Upgrade("/live");
  const auto await = [&](const auto& holds) {
    while (const auto frame = page.ReadFrame()) {
      if (frame->opcode != 1) continue;
      const Json message = Json::parse(frame->payload);
      if (message.at("kind") == "recorder" && holds(message)) return message;
    }
    return Json();
  };
  page.SendText(R"({"kind":"record","on":true})");
  const Json running = await([](const Json& state) { return state.at("bytes") > 0; });
  ASSERT_FALSE(running.is_null());
  EXPECT_TRUE(running.at("recording").get<bool>());
  page.SendText(R"({"kind":"record","on":false})");
  const Json ended = await([](const Json& state) { return !state.at("recording").get<bool>(); });
  ASSERT_FALSE(ended.is_null());
  EXPECT_EQ(ended.at("reason"), "");
  EXPECT_TRUE(std::filesystem::exists(running.at("file").get<std::string>()));
  std::filesystem::remove_all(folder);
}

TEST_F(ViewProgram, IsUnderstoodByFoxglovesOwnClient) {
  const std::string folder = testing::TempDir() + "palpate_foxglove_client";
  const std::string install =
      "mkdir -p " + folder + " && cp " PALPATE_SOURCE_DIR "/tests/system/view/client/* " + folder +
      " && cd " + folder + " && npm ci --silent --no-audit --no-fund > npm.log 2>&1";
  if (std::system("command -v npm > /dev/null 2>&1") != 0) GTEST_SKIP() << "no npm";
  if (std::system(install.c_str()) != 0) {
    GTEST_SKIP() << "npm cannot install @foxglove/ws-protocol: " << ReadFile(folder + "/npm.log");
  }
  Start();
  auto forces = node_.participant.CreateWriter(dds::kForcesTopic, node_.Waker());
  const std::string run = "cd " + folder + " && node read_forces.mjs " +
                          std::to_string(FoxglovePort()) + " > out.json 2> err.log";
  std::atomic<bool> ended = false;
  int status = -1;
  std::thread client([&] {
    status = std::system(run.c_str());
    ended = true;
    node_.loop.Wake();
  });
  dds::Message<idl::palpate_msgs::ForceArray> message;
  dds::SetText(message->status, "told by the test");
  node_.loop.Every(50ms, [&] {
    ++message->counter;
    EXPECT_TRUE(forces.Write(message));
  });
  EXPECT_TRUE(node_.loop.DispatchUntil([&] { return ended.load(); },
                                       std::chrono::steady_clock::now() + 60s));
  client.join();
  ASSERT_EQ(status, 0) << ReadFile(folder + "/err.log");
  const Json told = Json::parse(ReadFile(folder + "/out.json"));
  EXPECT_EQ(told.at("serverInfo").at("name"), "palpate");
  EXPECT_EQ(told.at("channel").at("schemaName"), "palpate_msgs/msg/ForceArray");
  EXPECT_EQ(told.at("status"), "told by the test");
  EXPECT_TRUE(told.at("hasScene").get<bool>());
}

/// What a camera at 30 Hz makes: a body of 1628 nodes, 30 000 points, forces.
class Load {
 public:
  explicit Load(TestNode* node)
      : node_(node),
        meshes_(node->participant.CreateWriter(dds::kMeshTopic)),
        states_(node->participant.CreateWriter(dds::kMeshStateTopic, node->Waker())),
        clouds_(node->participant.CreateWriter(dds::kRobotCloudTopic, node->Waker())),
        forces_(node->participant.CreateWriter(dds::kForcesTopic)),
        transforms_(node->participant) {
    constexpr int kAround = 44;
    constexpr int kAlong = 37;
    nodes_m_.resize(3, kAround * kAlong);
    Eigen::Matrix3Xi triangles(3, 2 * kAround * (kAlong - 1));
    int t = 0;
    for (int i = 0; i < kAlong; ++i) {
      for (int j = 0; j < kAround; ++j) {
        const double angle = 2.0 * std::numbers::pi * j / kAround;
        nodes_m_.col(i * kAround + j) << 0.02 * std::cos(angle), 0.02 * std::sin(angle), 0.005 * i;
        if (i + 1 == kAlong) continue;
        const int right = i * kAround + (j + 1) % kAround;
        triangles.col(t++) << i * kAround + j, right, right + kAround;
        triangles.col(t++) << i * kAround + j, right + kAround, (i + 1) * kAround + j;
      }
    }
    constexpr int kPoints = 30000;
    cloud_.points_m.resize(3, kPoints);
    cloud_.sigma_m = Eigen::VectorXf::Constant(kPoints, 1e-3F);
    cloud_.colors_rgb.assign(3 * kPoints, 200);
    for (int i = 0; i < kPoints; ++i) {
      cloud_.points_m.col(i) = nodes_m_.col(i % nodes_m_.cols()).cast<float>() +
                               Eigen::Vector3f::Constant(1e-7F * static_cast<float>(i));
    }
    const Eigen::MatrixXi cells = Eigen::Vector4i(0, 1, 2, 3);
    EXPECT_TRUE(meshes_.Write(dds::ToMesh({"load", "hash", nodes_m_, cells, triangles}, 1)));
    EXPECT_TRUE(transforms_.Set(geometry::kRobotFrame, geometry::kCameraDepthOpticalFrame,
                                Eigen::Isometry3d::Identity(), 1));
    node->loop.Every(std::chrono::microseconds(33333), [this] { Publish(); });
  }

  int frames() const { return frames_; }

 private:
  void Publish() {
    const std::int64_t stamp_ns = ++frames_ * 33'333'333LL;
    const Eigen::VectorXd x_m = nodes_m_.reshaped();
    auto state = dds::ToMeshState(x_m, "hash", stamp_ns);
    state->counter = static_cast<std::uint64_t>(frames_);
    EXPECT_TRUE(states_.Write(state));
    EXPECT_TRUE(
        clouds_.Write(dds::ToPointCloud2(cloud_, stamp_ns, geometry::kCameraDepthOpticalFrame)));
    dds::Message<idl::palpate_msgs::ForceArray> forces;
    forces->counter = static_cast<std::uint64_t>(frames_);
    dds::Resize(forces->forces, 3);
    EXPECT_TRUE(forces_.Write(forces));
  }

  TestNode* node_;
  dds::Writer<idl::palpate_msgs::Mesh> meshes_;
  dds::Writer<idl::palpate_msgs::MeshState> states_;
  dds::Writer<idl::sensor_msgs::PointCloud2> clouds_;
  dds::Writer<idl::palpate_msgs::ForceArray> forces_;
  dds::TransformBroadcaster transforms_;
  Eigen::Matrix3Xd nodes_m_;
  rgbd::SensedCloud cloud_;
  int frames_ = 0;
};

TEST_F(ViewProgram, CostsAClientLessThanATwelfthOfACore) {
  Start();
  const int port = PagePort();
  std::atomic<bool> ended = false;
  std::atomic<int> states = 0;
  std::thread client([&] {
    WebClient page(port);
    page.Upgrade("/live");
    while (!ended) {
      const auto frame = page.ReadFrame(200ms);
      const bool is_state = frame && frame->opcode == 2 &&
                            frame->payload.find("\"mesh_state\"") < frame->payload.find('}', 400);
      if (is_state) ++states;
    }
  });
  const Load load(&node_);
  const auto run = [&](std::chrono::seconds duration) {
    node_.loop.DispatchUntil([] { return false; }, std::chrono::steady_clock::now() + duration);
  };
  run(3s);
  const double before_s = process_->CpuTime_s();
  const int frames_before = load.frames();
  const int states_before = states;
  constexpr std::chrono::seconds kMeasured = 20s;
  run(kMeasured);
  const double used = (process_->CpuTime_s() - before_s) / static_cast<double>(kMeasured.count());
  const int frames = load.frames() - frames_before;
  std::printf("palpate-view: %.1f %% of a core, %d frames sent, %d states received\n", 100.0 * used,
              frames, states - states_before);
  ended = true;
  client.join();
  EXPECT_LE(used, 0.08);
  EXPECT_GT(frames, 500);
}

/// PALPATE_VIEW_MINUTES: how long; 30 without it.
int MinutesOfMemory() {
  const char* minutes = std::getenv("PALPATE_VIEW_MINUTES");
  return minutes == nullptr ? 30 : std::max(1, std::atoi(minutes));
}

/// Opens the page again and again: looks at it for a while, goes without a word, or reads nothing.
void ComeAndGo(int port, const std::atomic<bool>& ended, std::atomic<int>* visits) {
  for (int visit = 0; !ended; ++visit) {
    WebClient page(port);
    page.Upgrade("/live");
    page.SendText(R"({"kind":"probe","vertex":1})");
    const auto end = std::chrono::steady_clock::now() + (visit % 3 == 0 ? 4s : 1s);
    while (!ended && std::chrono::steady_clock::now() < end) {
      if (visit % 4 == 3) {
        std::this_thread::sleep_for(50ms);  // its messages wait, and are dropped
      } else {
        page.ReadFrame(200ms);
      }
    }
    ++*visits;
  }
}

TEST_F(ViewProgram, KeepsItsMemoryLevelWithClientsThatComeAndGo) {
  Start();
  const int port = PagePort();
  std::atomic<bool> ended = false;
  std::atomic<int> visits = 0;
  std::vector<std::thread> clients;
  for (int i = 0; i < 3; ++i) clients.emplace_back([&] { ComeAndGo(port, ended, &visits); });
  const Load load(&node_);
  const auto run = [&](std::chrono::seconds duration) {
    node_.loop.DispatchUntil([] { return false; }, std::chrono::steady_clock::now() + duration);
    return process_->Holds();
  };
  // A sixth of the time to grow to its size; of the rest the medians of both halves are compared.
  constexpr int kSamples = 24;
  const auto step = std::chrono::seconds(60 * MinutesOfMemory() / kSamples);
  std::vector<double> memory_MiB;
  Holdings last;
  for (int i = 0; i < kSamples; ++i) {
    last = run(step);
    if (i >= kSamples / 6) memory_MiB.push_back(last.memory_MiB);
  }
  ended = true;
  for (std::thread& client : clients) client.join();
  const Holdings alone = run(5s);
  const auto half = memory_MiB.begin() + static_cast<std::ptrdiff_t>(memory_MiB.size() / 2);
  const double before_MiB = Median({memory_MiB.begin(), half});
  const double after_MiB = Median({half, memory_MiB.end()});
  std::printf(
      "palpate-view: %d visits in %d min, %.1f MiB in the first half, %.1f MiB in the "
      "second, %zu open files with clients, %zu without\n",
      visits.load(), MinutesOfMemory(), before_MiB, after_MiB, last.files, alone.files);
  EXPECT_GT(visits, 10);
  EXPECT_LE(after_MiB, before_MiB + 2.0);
  EXPECT_LE(alone.files, last.files);
  EXPECT_FALSE(process_->Wait(0s));
}

/// A rod that is pulled, as `palpate simulate` makes it.
TEST_F(ViewProgram, ShowsAnExperimentFolder) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "palpate_view_experiment";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder / "recordings/r1_hold");
  WriteFile(folder / "experiment.yaml",
            "robot: " PALPATE_SOURCE_DIR "/config/robots/beam.yaml\nmarkers_sigma_m: 0.0002\n");
  WriteFile(folder / "recordings/r1_hold/recording.yaml", "kind: hold\n");
  WriteFile(folder / "recordings/r1_hold/markers.csv",
            "t_s,marker,x_m,y_m,z_m\n"
            "0,Tip-1,0,0.015,0.036\n0,Tip-2,0,-0.006,0.024\n0,Tip-3,0,0.036,0.006\n"
            "2,Tip-1,0,0.015,0.036\n2,Tip-2,0,-0.006,0.024\n2,Tip-3,0,0.036,0.006\n");
  Start({"--recording", folder.string()});
  WebClient page(PagePort());
  page.Upgrade("/live");
  std::map<std::string, Json> seen;
  while (seen.size() < 4) {
    const auto frame = page.ReadFrame(20s);
    ASSERT_TRUE(frame) << "of 4 kinds came " << seen.size();
    std::string_view text = frame->payload;
    if (frame->opcode == 2) text = text.substr(4, text.find("]}", 4));
    for (const char* kind : {"hello", "mesh_state", "markers", "model_error"}) {
      if (text.find("\"kind\":\"" + std::string(kind) + "\"") == text.npos) continue;
      seen[kind] = frame->opcode == 1 ? Json::parse(text) : Json();
    }
  }
  EXPECT_EQ(seen.at("hello").at("source"), "experiment");
  EXPECT_EQ(seen.at("hello").at("source_name"), "palpate_view_experiment");
  // The beam sags under its own weight, which these markers do not show.
  EXPECT_GT(seen.at("model_error").at("residual_rms_m").get<double>(), 1e-4);
  EXPECT_EQ(RunProgram("palpate-view", {"--recording", folder.string(), "--results", "/no/such"},
                       log_.string() + "_refused"),
            2);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace palpate::system_test
