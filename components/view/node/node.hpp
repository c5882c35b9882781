// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "components/view/node/experiment_source.hpp"
#include "components/view/node/foxglove_hub.hpp"
#include "components/view/node/foxglove_recording.hpp"
#include "components/view/node/foxglove_topics.hpp"
#include "components/view/node/live_source.hpp"
#include "components/view/node/node_config.hpp"
#include "components/view/node/page_feed.hpp"
#include "components/view/node/page_hub.hpp"
#include "components/view/node/recorder_control.hpp"
#include "components/view/node/recording_source.hpp"
#include "components/view/node/robot_source.hpp"
#include "components/view/serve/web_server.hpp"
#include "libs/dds/health.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::view {

/// What the node is given besides its settings.
struct ViewPlan {
  std::string token;                             ///< that clients must give; empty: none
  std::string version;                           ///< of palpate
  std::vector<std::filesystem::path> recording;  ///< files to be shown instead of the domain
  std::string source_name;                       ///< of the recording, experiment or robot file
  std::unique_ptr<KnownRobot> robot;             ///< null: not known
  std::unique_ptr<ShownExperiment> experiment;   ///< shown instead of the domain; needs `robot`
  bool robot_alone = false;  ///< `robot` is shown undeformed instead of the domain
  RecorderControl::Settings recorder;
};

/// Shows a running system, a recording or a robot file to browsers and to Foxglove.
class ViewNode {
 public:
  /// Throws InputError for bad settings and recordings, RunError where DDS or the network refuses.
  ViewNode(const NodeConfig& config, ViewPlan plan, int domain_id, dds::TopicTable table,
           dds::NodeLog::ProcessLog process_log);

  /// Returns after Stop().
  void Run() { loop_.Run(); }
  /// From any thread.
  void Stop() { loop_.Stop(); }

  int page_port() const { return page_port_; }
  /// "http://127.0.0.1:8750/"; without the token, if one is asked for.
  std::string page_url() const;
  /// 0: it is not served.
  int foxglove_port() const { return foxglove_port_; }

 private:
  struct PageWish {
    ClientId client;
    PageRequest request;
  };
  struct ChannelWish {
    foxglove::ChannelId channel;
    bool wanted;
  };
  using Wish = std::variant<PageWish, ChannelWish>;

  FeedOutputs Outputs();
  void Listen(const ViewPlan& plan);
  void ChooseSource(const ViewPlan& plan);
  /// From the first client on: before it nobody would see the beginning.
  void PlayOn();
  void PlayRecording(const ViewPlan& plan);
  void Ask(Wish wish);
  void Serve();
  void Answer(const PageWish& wish);
  void Report();

  NodeConfig config_;
  dds::Participant participant_;
  dds::WaitSet loop_;
  dds::NodeLog log_;
  dds::HealthReporter health_;
  std::mutex mutex_;
  std::vector<Wish> wishes_;  ///< of the server's thread, for the loop's
  std::unique_ptr<PageHub> page_;
  std::unique_ptr<FoxgloveHub> foxglove_;
  WebServer server_;  // goes before the hubs, which its thread uses
  int page_port_ = 0;
  int foxglove_port_ = 0;
  std::unique_ptr<KnownRobot> robot_;
  std::unique_ptr<ShownExperiment> experiment_;
  PageFeed feed_;
  RecorderControl recorder_;
  std::unique_ptr<LiveSource> live_;
  std::unique_ptr<PlayedSource> played_;
  std::unique_ptr<RobotSource> robot_source_;
  bool watched_ = false;
  std::unique_ptr<FoxgloveRecording> foxglove_recording_;
  std::unique_ptr<FoxgloveTopics> foxglove_topics_;
  std::uint64_t published_ = 0;
};

}  // namespace palpate::view
