// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "tests/system/bench/streaming.hpp"

/// The camera on one host, capture on another: network namespaces with a cable between them.
namespace palpate::system_test {
namespace {

/// A network namespace of its own, tied to ours by a veth pair. Removed at the end.
class OtherHost {
 public:
  OtherHost() : name_("palpate-" + std::to_string(getpid())), link_("pv" + Suffix()) {
    ready_ = Do("ip netns add " + name_) &&
             Do("ip link add " + link_ + " mtu 9000 type veth peer name camera mtu 9000 netns " +
                name_) &&
             Do("ip addr add " + Subnet() + ".1/30 dev " + link_) &&
             Do("ip link set " + link_ + " up") &&
             Do("ip -n " + name_ + " addr add " + Subnet() + ".2/30 dev camera") &&
             Do("ip -n " + name_ + " link set camera up") &&
             Do("ip -n " + name_ + " link set lo up");
  }
  ~OtherHost() { Do("ip netns del " + name_); }
  OtherHost(const OtherHost&) = delete;
  OtherHost& operator=(const OtherHost&) = delete;

  bool ready() const { return ready_; }
  std::string address() const { return Subnet() + ".2"; }
  std::vector<std::string> wrapper() const { return {"ip", "netns", "exec", name_}; }

 private:
  static bool Do(const std::string& command) {
    return std::system((command + " 2>/dev/null").c_str()) == 0;
  }
  std::string Suffix() const { return std::to_string(getpid() % 100000); }
  std::string Subnet() const { return "10.213." + std::to_string(getpid() % 250); }

  std::string name_;
  std::string link_;
  bool ready_ = false;
};

TEST(TwoHosts, FramesArriveOverACable) {
  const OtherHost other;
  if (!other.ready()) GTEST_SKIP() << "needs root and network namespaces (ip netns)";
  const TestFolder folder;
  FrameListener listener;
  VirtualBench bench(
      folder,
      {.camera_address = other.address(), .noise = "stereo", .bench_wrapper = other.wrapper()});
  const Streamed streamed = Stream(bench, listener, "two hosts");
  ASSERT_GT(streamed.frames, 0u);
  if (const std::string trouble = KernelTrouble(); !trouble.empty()) GTEST_SKIP() << trouble;
  EXPECT_EQ(streamed.incomplete, 0u);
  EXPECT_GE(static_cast<double>(streamed.frames), 0.98 * static_cast<double>(streamed.sent));
}

}  // namespace
}  // namespace palpate::system_test
