// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "components/view/node/recording_source.hpp"
#include "libs/core/error.hpp"
#include "libs/dds/raw_reader.hpp"
#include "libs/dds/ros_names.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/geometry/frames.hpp"
#include "libs/recording/output_file.hpp"
#include "libs/recording/writer.hpp"
#include "tests/components/view/node/running_view.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::view {
namespace {

using dds::TestNode;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Json = nlohmann::json;

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kStart_ns = 1'700'000'000 * kSecond_ns;

/// The bytes of a /forces message on the wire; `counter` is in them.
std::string CdrOfForces(std::uint64_t counter) {
  TestNode writer_node("writer");
  TestNode reader_node("reader");
  std::mutex mutex;
  std::string cdr;
  const dds::RawReader reader(
      reader_node.participant.handle(),
      {.dds_topic = "rt/forces", .dds_type = dds::DdsTypeName("palpate_msgs/msg/ForceArray")},
      [&](const dds::RawMessage& message) {
        const std::lock_guard lock(mutex);
        cdr = message.cdr();
        writer_node.loop.Wake();
      });
  auto writer = writer_node.participant.CreateWriter(dds::kForcesTopic, writer_node.Waker());
  EXPECT_TRUE(writer_node.WaitFor([&] { return writer.matched() > 0; }));
  dds::Message<idl::palpate_msgs::ForceArray> message;
  dds::SetHeader(message->header, static_cast<std::int64_t>(counter), geometry::kRobotFrame);
  message->counter = counter;
  EXPECT_TRUE(writer.Write(message));
  EXPECT_TRUE(writer_node.WaitFor([&] {
    const std::lock_guard lock(mutex);
    return !cdr.empty();
  }));
  return cdr;
}

class Recording : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove(file_); }
  void TearDown() override { std::filesystem::remove(file_); }

  /// A message a second on one topic; its stamp is 1, 2, 3 ... ns.
  void Write(const std::string& topic, int count) {
    recording::Writer writer(std::make_unique<recording::OutputFile>(file_), {});
    recording::Channel channel;
    channel.topic = topic;
    channel.message_encoding = "cdr";
    channel.schema_id = writer.AddSchema("palpate_msgs/msg/ForceArray", "ros2msg", "");
    channel.id = writer.AddChannel(channel);
    for (int i = 1; i <= count; ++i) {
      const std::string cdr = CdrOfForces(static_cast<std::uint64_t>(i));
      recording::Message message;
      message.channel_id = channel.id;
      message.log_time_ns = message.publish_time_ns = kStart_ns + (i - 1) * kSecond_ns;
      message.data = cdr;
      writer.Write(message);
    }
    writer.Close();
  }

  /// Stamps of the forces that the page was sent since the last call.
  std::vector<std::string> Shown() { return std::exchange(stamps_, {}); }
  static Json StateOf(const RecordingSource& source) { return Json::parse(*source.State().head); }

  std::filesystem::path file_ = std::filesystem::path(testing::TempDir()) / "palpate_view.mcap";
  std::vector<std::string> stamps_;
  PageFeed feed_{Config(),
                 0,
                 nullptr,
                 {.publish =
                      [this](const OutMessage& message) {
                        if (message.kind != "forces") return;
                        stamps_.push_back(Json::parse(*message.head).at("stamp_ns"));
                      },
                  .wants_clouds = [] { return true; },
                  .wants_images = [] { return true; },
                  .publish_scene = [](const std::string&, std::int64_t) {},
                  .wants_scene = [] { return false; },
                  .warn = [](const std::string& text) { ADD_FAILURE() << text; }}};
};

TEST_F(Recording, IsPlayedPausedAndSought) {
  Write("/forces", 5);
  RecordingSource source({file_}, &feed_);
  EXPECT_THAT(Shown(), ElementsAre("1"));  // what there is at the start
  EXPECT_DOUBLE_EQ(source.duration_s(), 4.0);
  source.Advance(0);
  source.Advance(1'500'000'000);
  EXPECT_THAT(Shown(), ElementsAre("2"));
  source.Play({.paused = true, .rate = 1.0});
  source.Advance(3 * kSecond_ns);
  EXPECT_THAT(Shown(), IsEmpty());
  EXPECT_DOUBLE_EQ(StateOf(source).at("position_s").get<double>(), 1.5);
  source.Play({.paused = false, .rate = 2.0});
  source.Advance(4 * kSecond_ns);
  EXPECT_THAT(Shown(), ElementsAre("3", "4"));
  // The newest message before the place is shown at once.
  source.Seek({.position_s = 1.2});
  EXPECT_THAT(Shown(), ElementsAre("2"));
  source.Advance(4 * kSecond_ns + kSecond_ns / 2);
  EXPECT_THAT(Shown(), ElementsAre("3"));
}

TEST_F(Recording, PausesAtItsEndAndBeginsAgain) {
  Write("/forces", 2);
  RecordingSource source({file_}, &feed_);
  source.Advance(0);
  source.Advance(60 * kSecond_ns);
  EXPECT_THAT(Shown(), ElementsAre("1", "2"));
  EXPECT_TRUE(StateOf(source).at("paused").get<bool>());
  EXPECT_EQ(StateOf(source).at("position_s"), 1.0);
  source.Play({.paused = false, .rate = 1.0});
  EXPECT_THAT(Shown(), ElementsAre("1"));
  source.Seek({.position_s = 1e9});
  EXPECT_EQ(StateOf(source).at("position_s"), 1.0);
}

/// A client of Foxglove.
class RecordingInFoxglove : public Recording {};

TEST_F(RecordingInFoxglove, IsPassedOnAsItWasRecorded) {
  Write("/forces", 3);
  ViewPlan plan;
  plan.recording = {file_};
  const RunningView view(NodeConfig(), std::move(plan));
  WebClient client(view.foxglove_port());
  client.Upgrade("/", "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n");
  const Json channel = FoxgloveTest::Channel(&client, "/forces");
  ASSERT_FALSE(channel.is_null());
  EXPECT_EQ(channel.at("encoding"), "cdr");
  EXPECT_EQ(channel.at("schemaName"), "palpate_msgs/msg/ForceArray");
  FoxgloveTest::Subscribe(&client, 7, channel);
  const auto data = FoxgloveTest::NextData(&client);
  ASSERT_TRUE(data);
  EXPECT_EQ(data->substr(0, 5), std::string("\x01\x07\x00\x00\x00", 5));
  // The newest message at that place, byte by byte.
  constexpr std::size_t kHeadBytes = 13;
  EXPECT_THAT(std::vector<std::string>({CdrOfForces(1), CdrOfForces(2), CdrOfForces(3)}),
              testing::Contains(data->substr(kHeadBytes)));
}

/// Who opens the page late sees the beginning all the same.
TEST_F(Recording, BeginsWithTheFirstClient) {
  Write("/forces", 4);
  ViewPlan plan;
  plan.recording = {file_};
  const RunningView view(NodeConfig(), std::move(plan));
  const auto late = std::chrono::steady_clock::now() + std::chrono::milliseconds(1500);
  while (std::chrono::steady_clock::now() < late) Fetch(view.page_port(), "/");
  WebClient client(view.page_port());
  client.Upgrade("/live");
  client.SendText(R"({"kind":"play","paused":true,"rate":1})");
  Json player;
  while (const auto frame = client.ReadFrame()) {
    if (frame->opcode != 1) continue;
    player = Json::parse(frame->payload);
    if (player.value("kind", "") == "player" && player.value("paused", false)) break;
  }
  ASSERT_TRUE(player.value("paused", false));
  EXPECT_LT(player.value("position_s", 1.5), 1.0);
}

TEST_F(Recording, IsRefusedWithoutATopicThatIsShown) {
  Write("/something_else", 1);
  try {
    const RecordingSource source({file_}, &feed_);
    FAIL() << "was taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no topic that the page shows"));
  }
}

TEST_F(Recording, PassesOverMessagesThatAreDamaged) {
  {
    recording::Writer writer(std::make_unique<recording::OutputFile>(file_), {});
    recording::Channel channel;
    channel.topic = "/forces";
    channel.message_encoding = "cdr";
    channel.id = writer.AddChannel(channel);
    recording::Message message;
    message.channel_id = channel.id;
    message.log_time_ns = kStart_ns;
    message.data = "no CDR at all";
    writer.Write(message);
    writer.Close();
  }
  const RecordingSource source({file_}, &feed_);
  EXPECT_THAT(Shown(), IsEmpty());
  EXPECT_EQ(StateOf(source).at("unread"), 1);
}

}  // namespace
}  // namespace palpate::view
