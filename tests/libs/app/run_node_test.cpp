// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/run_node.hpp"

#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "libs/app/node_options.hpp"
#include "libs/core/parameter.hpp"

namespace palpate::app {
namespace {

/// What stands for the DDS side of a process.
struct FakeSide {
  std::vector<Parameter> parameters;

  template <typename Visitor>
  void Visit(Visitor&&) {}
};

struct FakeConfig {
  FakeSide dds;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("dds", dds, "DDS side");
  }
};

using FakeCommand = NodeCommand<FakeConfig>;

/// Runs until it is stopped.
class FakeNode {
 public:
  explicit FakeNode(bool* ran) : ran_(ran) {}
  void Run() {
    *ran_ = true;
    raise(SIGINT);
    stopped_.get_future().wait();
  }
  void Stop() { stopped_.set_value(); }

 private:
  bool* ran_;
  std::promise<void> stopped_;
};

constexpr std::array<const char*, 1> kFakeArguments{"palpate-fake"};

int RunFake(const std::function<std::unique_ptr<FakeNode>(const FakeCommand&)>& make) {
  const auto read = [](int, const char* const*) {
    return std::optional<FakeCommand>(FakeCommand());
  };
  return RunNode("palpate-fake", read, make, 1, kFakeArguments.data());
}

TEST(RunNode, ASignalEndsTheRunCleanly) {
  bool ran = false;
  EXPECT_EQ(RunFake([&](const FakeCommand&) { return std::make_unique<FakeNode>(&ran); }),
            kExitDone);
  EXPECT_TRUE(ran);
}

TEST(RunNode, ASignalWhileTheNodeIsMadeIsACleanEnd) {
  bool ran = false;
  const int exit_code = RunFake([&](const FakeCommand&) {
    auto node = std::make_unique<FakeNode>(&ran);
    raise(SIGINT);  // others see the node's ports before it is made
    return node;
  });
  EXPECT_EQ(exit_code, kExitDone);
  EXPECT_FALSE(ran);
}

}  // namespace
}  // namespace palpate::app
