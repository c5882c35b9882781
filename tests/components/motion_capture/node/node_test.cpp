// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/motion_capture/node/node.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "libs/core/error.hpp"
#include "libs/dds/stamp.hpp"
#include "tests/components/motion_capture/natnet_writer.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::motion_capture {
namespace {

using testing::ElementsAre;

/// A UDP socket on loopback that plays the server.
class Server {
 public:
  Server() : socket_(socket(AF_INET, SOCK_DGRAM, 0)) {}
  ~Server() { close(socket_); }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// A port that nobody uses now.
  static int FreePort() {
    const int probe = socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in address = Loopback(0);
    EXPECT_EQ(bind(probe, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    socklen_t size = sizeof(address);
    getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size);
    close(probe);
    return ntohs(address.sin_port);
  }
  void Send(const Bytes& bytes, int port) {
    const sockaddr_in address = Loopback(port);
    EXPECT_EQ(sendto(socket_, bytes.data(), bytes.size(), 0,
                     reinterpret_cast<const sockaddr*>(&address), sizeof(address)),
              static_cast<ssize_t>(bytes.size()));
  }

 private:
  static sockaddr_in Loopback(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
  }

  int socket_;
};

/// The node in a thread of its own, a server, and a reader of markers.
class MotionCaptureNodeTest : public testing::Test {
 protected:
  struct Received {
    std::uint64_t counter = 0;
    std::int64_t stamp_ns = 0;
    std::string frame_id;
    std::vector<std::string> names;
    std::vector<bool> valid;
    double first_x_m = 0.0, sigma_m = 0.0;
    double pose_about_x_m = 0.0, pose_sigma_m = 0.0, pose_sigma_rad = 0.0;
  };

  MotionCaptureNodeTest()
      : port_(Server::FreePort()),
        node_(Config(port_), Eigen::Isometry3d(Eigen::Translation3d(1.0, 0.0, 0.0)), {0.001, 0.002},
              static_cast<int>(dds::TestDomain()), dds::BuiltInTable(), {}),
        test_("test"),
        markers_(test_.participant.CreateReader(dds::kMarkersTopic, test_.Waker())),
        statuses_(test_.participant.CreateReader(dds::kComponentStatusTopic)),
        thread_([this] { node_.Run(); }) {
    test_.loop.Attach(markers_, [this] {
      for (const auto& message : markers_.Take()) Take(message);
    });
    test_.loop.Attach(statuses_, [this] {
      for (const auto& message : statuses_.Take()) {
        refused_ = message.refused;
        status_ = dds::Text(message.status);
      }
    });
    EXPECT_TRUE(test_.WaitFor([this] { return markers_.matched() == 1; }));
  }
  ~MotionCaptureNodeTest() override {
    node_.Stop();
    thread_.join();
  }

  static NodeConfig Config(int port) {
    NodeConfig config;
    config.multicast_group = "";
    config.interface_address = "127.0.0.1";
    config.port = port;
    config.sigma_m = 2e-4;
    config.silence_s = 0.2;
    return config;
  }
  void Take(const idl::palpate_msgs::MarkerArray3& message) {
    Received received{message.counter,
                      dds::StampNs(message.header.stamp),
                      std::string(dds::Text(message.header.frame_id)),
                      {},
                      {}};
    received.pose_about_x_m = message.pose_about_m.x;
    received.pose_sigma_m = message.pose_translation_sigma_m;
    received.pose_sigma_rad = message.pose_rotation_sigma_rad;
    for (const auto& marker : dds::Elements(message.markers)) {
      received.names.emplace_back(dds::Text(marker.name));
      received.valid.push_back(marker.valid);
      received.sigma_m = marker.sigma_m.x;
    }
    if (message.markers._length > 0) received.first_x_m = message.markers._buffer[0].position_m.x;
    received_.push_back(received);
  }

  int port_;
  MotionCaptureNode node_;
  dds::TestNode test_;
  dds::Reader<idl::palpate_msgs::MarkerArray3> markers_;
  dds::Reader<idl::palpate_msgs::ComponentStatus> statuses_;
  Server server_;
  NatNetWriter writer_{NatNetVersion{4, 1}};
  std::vector<Received> received_;
  std::uint64_t refused_ = 0;
  std::string status_;
  std::thread thread_;
};

TEST_F(MotionCaptureNodeTest, EachFrameOfTheServerIsPublishedInTheRobotsFrame) {
  const std::int64_t before_ns = dds::WallClockNs();
  for (std::int32_t number = 0; number < 20; ++number) {
    server_.Send(writer_.Frame(SampleFrame(number)), port_);
    if (number % 5 == 0) server_.Send(writer_.Message(5), port_);
  }
  ASSERT_TRUE(test_.WaitFor([this] { return received_.size() == 20; }));
  for (std::size_t i = 0; i < received_.size(); ++i) {
    EXPECT_EQ(received_[i].counter, i);
    EXPECT_EQ(received_[i].frame_id, "robot");
    EXPECT_THAT(received_[i].names, ElementsAre("Tip-1", "Tip-2", "Base-1"));
    EXPECT_THAT(received_[i].valid, ElementsAre(true, false, true));
    EXPECT_NEAR(received_[i].first_x_m, 1.1, 1e-6);
    EXPECT_EQ(received_[i].sigma_m, 2e-4);
    EXPECT_EQ(received_[i].pose_about_x_m, 1.0);
    EXPECT_EQ(received_[i].pose_sigma_m, 0.001);
    EXPECT_EQ(received_[i].pose_sigma_rad, 0.002);
    EXPECT_GE(received_[i].stamp_ns, before_ns);
    EXPECT_LE(received_[i].stamp_ns, dds::WallClockNs());
  }
}

TEST_F(MotionCaptureNodeTest, AFrameThatEndsTooEarlyIsRefusedAndTheNextOnePublished) {
  Bytes cut = writer_.Frame(SampleFrame(1));
  cut.resize(cut.size() / 2);
  server_.Send(cut, port_);
  server_.Send(writer_.Frame(SampleFrame(2)), port_);
  ASSERT_TRUE(test_.WaitFor([this] { return received_.size() == 1; }));
  EXPECT_TRUE(test_.WaitFor([this] { return refused_ == 1; }));
}

TEST_F(MotionCaptureNodeTest, WithoutFramesTheStatusIsStale) {
  server_.Send(writer_.Frame(SampleFrame(1)), port_);
  EXPECT_TRUE(test_.WaitFor([this] { return status_ == "stale"; }));
}

TEST(MotionCaptureSettings, WhatCannotBeUsedIsRefused) {
  const auto start = [](const NodeConfig& config) {
    MotionCaptureNode(config, Eigen::Isometry3d::Identity(), {},
                      static_cast<int>(dds::TestDomain()), dds::BuiltInTable(), {});
  };
  NodeConfig config;
  config.interface_address = "localhost";
  EXPECT_THROW(start(config), InputError);
  config = {};
  config.natnet_version = "5";
  EXPECT_THROW(start(config), InputError);
  config = {};
  config.multicast_group = "10.1.2.3";  // no multicast address
  config.interface_address = "127.0.0.1";
  EXPECT_THROW(start(config), RunError);
}

}  // namespace
}  // namespace palpate::motion_capture
