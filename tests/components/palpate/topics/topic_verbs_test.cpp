// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>

#include "libs/app/child_process.hpp"
#include "libs/core/file.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/components/palpate/recordings/cdr_writer.hpp"
#include "tests/components/palpate/topics/fake_node.hpp"

namespace palpate::command {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Sends forces, each stamped `age` before it is sent.
class ForceSender : public FakeNode {
 public:
  explicit ForceSender(std::vector<std::string> remap = {},
                       std::chrono::milliseconds age = std::chrono::milliseconds(0))
      : FakeNode("palpate_force_estimation", {}, std::move(remap)), age_(age) {
    loop.Every(std::chrono::milliseconds(20), [this] { Send(); });
    Run();
  }
  ~ForceSender() { Stop(); }

 private:
  void Send() {
    dds::Message<idl::palpate_msgs::ForceArray> message;
    dds::SetHeader(message->header, dds::WallClockNs() - std::chrono::nanoseconds(age_).count(),
                   "robot");
    message->counter = counter_++;
    dds::SetText(message->status, "ok");
    EXPECT_TRUE(forces_.Write(message));
  }

  std::chrono::milliseconds age_;
  std::uint64_t counter_ = 0;
  dds::Writer<idl::palpate_msgs::ForceArray> forces_ = participant.CreateWriter(dds::kForcesTopic);
};

TEST(TopicList, NamesTopicsWithTypesAndCounts) {
  const ForceSender sender;
  const Outcome plain = RunVerb({"topic", "list"});
  EXPECT_EQ(plain.exit_code, 0);
  EXPECT_EQ(plain.output, "/forces\n");
  EXPECT_EQ(RunVerb({"topic", "list", "-t"}).output, "/forces [palpate_msgs/msg/ForceArray]\n");
  EXPECT_EQ(RunVerb({"topic", "list", "-c"}).output, "1\n");
  EXPECT_EQ(RunVerb({"topic", "list", "-v"}).output,
            "Published topics:\n * /forces [palpate_msgs/msg/ForceArray] 1 publisher\n\n"
            "Subscribed topics:\n\n");
  const auto json = nlohmann::json::parse(RunVerb({"topic", "list", "--json"}).output);
  EXPECT_EQ(json.at("domain"), TestDomain());
  EXPECT_EQ(json.at("topics").at(0).at("name"), "/forces");
  EXPECT_EQ(json.at("topics").at(0).at("publisher_count"), 1);
  EXPECT_THAT(RunVerb({"topic", "list", "--include-hidden-topics"}).output,
              HasSubstr("ros_discovery_info\n"));
}

TEST(TopicList, ShowsOneNamespaceOfTwo) {
  const ForceSender left({"__ns:=/left"});
  const ForceSender right({"__ns:=/right"});
  EXPECT_EQ(RunVerb({"topic", "list"}).output, "/left/forces\n/right/forces\n");
  EXPECT_EQ(RunVerb({"topic", "list", "--remap", "__ns:=/left"}).output, "/left/forces\n");
  EXPECT_THAT(RunVerb({"topic", "info", "/forces", "--remap", "__ns:=/right"}).output,
              HasSubstr("Publisher count: 1\n"));
  EXPECT_EQ(RunVerb({"topic", "echo", "forces", "--once", "--field", "header.frame_id", "--remap",
                     "__ns:=/left"})
                .output,
            "robot\n---\n");
}

TEST(TopicInfo, NamesTypeNodesAndQos) {
  ForceSender sender;
  EXPECT_EQ(RunVerb({"topic", "info", "/forces"}).output,
            "Type: palpate_msgs/msg/ForceArray\nPublisher count: 1\nSubscription count: 0\n");
  const Outcome verbose = RunVerb({"topic", "info", "/forces", "-v"});
  EXPECT_THAT(verbose.output,
              AllOf(HasSubstr("Node name: palpate_force_estimation\nNode namespace: /\n"),
                    HasSubstr("Endpoint type: PUBLISHER\nGID: "),
                    HasSubstr("Reliability: RELIABLE\n  History (Depth): KEEP_LAST (100)\n"),
                    HasSubstr("Durability: VOLATILE\n  Lifespan: Infinite\n")));
  const auto json = nlohmann::json::parse(RunVerb({"topic", "info", "/forces", "--json"}).output);
  EXPECT_EQ(json.at("publishers").at(0).at("node"), "/palpate_force_estimation");
  EXPECT_EQ(json.at("publishers").at(0).at("qos").at("reliability"), "RELIABLE");
}

TEST(TopicEcho, PrintsMessagesAsYamlCsvAndJson) {
  const ForceSender sender;
  const Outcome yaml = RunVerb({"topic", "echo", "/forces", "--count", "2"});
  EXPECT_EQ(yaml.exit_code, 0);
  EXPECT_THAT(yaml.output, AllOf(HasSubstr("header:\n  stamp:\n    sec: "),
                                 HasSubstr("  frame_id: robot\ncounter: "),
                                 HasSubstr("status: ok\n"), HasSubstr("forces: []\n")));
  const std::regex dashes("(^|\n)---\n");
  EXPECT_EQ(std::distance(std::sregex_iterator(yaml.output.begin(), yaml.output.end(), dashes), {}),
            2);
  EXPECT_THAT(RunVerb({"topic", "echo", "/forces", "--once", "--csv"}).output,
              testing::MatchesRegex("[0-9]+,[0-9]+,robot,[0-9]+,.*,ok,[^\n]*\n"));
  const Outcome json = RunVerb({"topic", "echo", "/forces", "--once", "--json"});
  EXPECT_EQ(nlohmann::json::parse(json.output).at("status"), "ok");
}

TEST(TopicEcho, RefusesWhatIsNotThere) {
  const ForceSender sender;
  const Outcome unknown = RunVerb({"topic", "echo", "/forcse", "--spin-time", "0.5"});
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.errors,
              AllOf(HasSubstr("no topic '/forcse' in domain " + std::to_string(TestDomain())),
                    HasSubstr("did you mean '/forces'?")));
  const Outcome field = RunVerb({"topic", "echo", "/forces", "--once", "--field", "conter"});
  EXPECT_EQ(field.exit_code, 2);
  EXPECT_THAT(field.errors, HasSubstr("did you mean 'counter'?"));
  EXPECT_THAT(RunVerb({"topic", "ecoh", "/forces"}).errors, HasSubstr("did you mean 'echo'?"));
  EXPECT_THAT(RunVerb({"topic", "echo", "/forces", "--csv", "--json"}).errors,
              HasSubstr("not both"));
  EXPECT_THAT(RunVerb({"topic", "list", "--spin-time", "0"}).errors,
              HasSubstr("--spin-time must be above 0 s"));
}

TEST(TopicEcho, SaysWhereNobodyPublishes) {
  FakeNode node("listener");
  const auto reader = node.participant.CreateReader(dds::kForcesTopic);
  const Outcome outcome = RunVerb({"topic", "echo", "/forces", "--spin-time", "0.5"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("'/forces' has no publisher"));
}

/// Sends what is given on a topic of any type, as fast as `period` says.
class RawSender : public FakeNode {
 public:
  RawSender(const dds::RawWriterTopic& topic, std::string cdr, std::chrono::microseconds period)
      : FakeNode("raw_sender"), cdr_(std::move(cdr)) {
    writer_ = participant.CreateRawWriter(topic);
    loop.Every(period, [this] { sent_ += writer_->Write(cdr_) ? 1 : 0; });
    Run();
  }
  ~RawSender() { Stop(); }

  std::uint64_t sent() const { return sent_; }

 private:
  std::string cdr_;
  std::atomic<std::uint64_t> sent_{0};
  std::unique_ptr<dds::RawWriter> writer_;
};

dds::RawWriterTopic Text(dds::Reliability reliability = dds::Reliability::kReliable) {
  return {.dds_topic = "rt/words",
          .dds_type = "std_msgs::msg::dds_::String_",
          .reliability = reliability,
          .depth = 100};
}

TEST(TopicEcho, ReadsBestEffortPublishersAndSaysWhereQosDoesNotMatch) {
  const RawSender sender(Text(dds::Reliability::kBestEffort), Cdr().Text("hello").bytes(),
                         std::chrono::milliseconds(20));
  EXPECT_EQ(RunVerb({"topic", "echo", "/words", "--once"}).output, "data: hello\n---\n");
  const Outcome mismatch = RunVerb(
      {"topic", "echo", "/words", "--once", "--qos-reliability", "reliable", "--timeout", "0.5"});
  EXPECT_EQ(mismatch.exit_code, 1);
  EXPECT_THAT(mismatch.errors, AllOf(HasSubstr("offers incompatible QoS (reliability)"),
                                     HasSubstr("no message on '/words' for 0.5 s")));
}

TEST(TopicEcho, DoesNotGuessATypeThatNobodyKnows) {
  dds::RawWriterTopic topic = Text();
  topic.dds_type = "strange_msgs::msg::dds_::Thing_";
  const RawSender sender(topic, Cdr().Text("hello").bytes(), std::chrono::milliseconds(20));
  const Outcome echo = RunVerb({"topic", "echo", "/words", "--once"});
  EXPECT_EQ(echo.exit_code, 1);
  EXPECT_THAT(echo.errors,
              AllOf(HasSubstr("the type strange_msgs/msg/Thing of '/words' is unknown"),
                    HasSubstr("hz and bw need no type")));
  EXPECT_EQ(RunVerb({"topic", "echo", "/words", "std_msgs/msg/String", "--once"}).output,
            "data: hello\n---\n");
  EXPECT_EQ(RunVerb({"topic", "hz", "/words", "--once", "--json"}).exit_code, 0);
}

TEST(TopicEcho, SaysWhereAMessageDoesNotFitItsType) {
  const RawSender sender(Text(), std::string("\0\1\0\0\xFF\xFF\xFF\x7F", 8),
                         std::chrono::milliseconds(20));
  const Outcome outcome = RunVerb({"topic", "echo", "/words", "--once"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("a message of 8 bytes does not fit the type"));
}

TEST(TopicDelay, IsTheAgeOfTheStamp) {
  const ForceSender sender({}, std::chrono::milliseconds(250));
  const auto json =
      nlohmann::json::parse(RunVerb({"topic", "delay", "/forces", "--once", "--json"}).output);
  // By how much it is later depends on the load; earlier it cannot be.
  EXPECT_GE(json.at("min_s"), 0.249);
  EXPECT_LT(json.at("min_s"), 5.0);
  // How many messages come before the first line depends on the load, too.
  const Outcome lines = RunVerb({"topic", "delay", "/forces", "--once", "--window", "10"});
  std::smatch numbers;
  ASSERT_TRUE(std::regex_search(lines.output, numbers,
                                std::regex(R"(average delay: ([0-9.]+)\n.* window: ([0-9]+)\n)")))
      << lines.output;
  EXPECT_GE(std::stod(numbers[1]), 0.249);
  EXPECT_LE(std::stoi(numbers[2]), 10);
}

TEST(TopicDelay, RefusesTypesWithoutHeader) {
  const RawSender sender(Text(), Cdr().Text("hello").bytes(), std::chrono::milliseconds(20));
  const Outcome outcome = RunVerb({"topic", "delay", "/words", "--once"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("std_msgs/msg/String of '/words' has no header"));
}

TEST(TopicRates, SayWhereNothingComes) {
  FakeNode node("silent");
  const auto writer = node.participant.CreateRawWriter(Text());
  const Outcome outcome = RunVerb({"topic", "hz", "/words", "--timeout", "1"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.output, HasSubstr("no new messages\n"));
  EXPECT_THAT(outcome.errors, HasSubstr("nothing to measure on '/words' for 1 s"));
}

/// 5000 small messages a second: what is measured is what was sent in that time.
TEST(TopicRates, FollowAFastTopic) {
  const std::string cdr = Cdr().Text("seven77").bytes();
  const RawSender sender(Text(), cdr, std::chrono::microseconds(200));
  const auto begin = std::chrono::steady_clock::now();
  const std::uint64_t sent_before = sender.sent();
  const Outcome hz = RunVerb({"topic", "hz", "/words", "--count", "2", "--json"});
  const double duration_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const double sent_hz = static_cast<double>(sender.sent() - sent_before) / duration_s;
  const auto json = nlohmann::json::parse(hz.output.substr(0, hz.output.find('\n')));
  EXPECT_GT(sent_hz, 100.0);
  EXPECT_NEAR(json.at("rate_hz").get<double>() / sent_hz, 1.0, 0.3);
  const auto bw = nlohmann::json::parse(
      RunVerb({"topic", "bw", "/words", "--once", "--window", "100000", "--json"}).output);
  EXPECT_EQ(bw.at("mean_bytes"), static_cast<double>(cdr.size()));
  EXPECT_NEAR(bw.at("bytes_per_s").get<double>() / (sent_hz * static_cast<double>(cdr.size())), 1.0,
              0.4);
}

/// The program learns the structure of a type from a publisher in another process.
TEST(TopicEcho, ReadsATypeThatOnlyThePublisherKnows) {
  FakeNode node("plain");
  const dds::Entity topic(
      dds_create_topic(node.participant.handle(),
                       &idl::MessageTraits<idl::palpate_msgs::ForceArray>::Descriptor(),
                       "PlainTopic", nullptr, nullptr),
      "topic");
  const dds::Entity writer(
      dds_create_writer(node.participant.handle(), topic.handle(), nullptr, nullptr), "writer");
  dds::Message<idl::palpate_msgs::ForceArray> message;
  dds::SetText(message->status, "ok");
  node.loop.Every(std::chrono::milliseconds(20),
                  [&] { EXPECT_EQ(dds_write(writer.handle(), &*message), DDS_RETCODE_OK); });
  node.Run();
  const test_support::TestFolder folder;
  app::ChildProcess echo(
      std::filesystem::path(PALPATE_BINARY_DIR) / "bin/palpate",
      {"topic", "echo", "PlainTopic", "--once", "--field", "status", "--spin-time", "10"}, {},
      folder / "log");
  EXPECT_EQ(echo.Wait(), 0);
  EXPECT_EQ(ReadFile(folder / "log"), "ok\n---\n");
  node.Stop();
}

}  // namespace
}  // namespace palpate::command
