// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "components/palpate/node/verbs.hpp"
#include "libs/app/yaml.hpp"
#include "libs/dds/node_settings.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/wait_set.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {

/// The domain that this test program has for itself (set by CMake).
inline int TestDomain() { return std::atoi(std::getenv("ROS_DOMAIN_ID")); }

/// A node whose loop runs in a thread of its own until this goes.
class FakeNode {
 public:
  explicit FakeNode(const std::string& name, std::vector<Parameter> parameters = {},
                    std::vector<std::string> remap = {})
      : FakeNode({.domain_id = static_cast<std::uint32_t>(TestDomain()),
                  .node_name = name,
                  .remap = std::move(remap),
                  .parameters = std::move(parameters)}) {}
  explicit FakeNode(const dds::ParticipantSettings& settings)
      : participant(settings, dds::LoadTopicTable({}, app::LoadYaml, app::ParseYaml)),
        loop(participant) {}
  ~FakeNode() { Stop(); }

  void Run() {
    thread_ = std::thread([this] { loop.Run(); });
  }
  /// Ends the loop and its thread; to be called before that goes which its callbacks use.
  void Stop() {
    loop.Stop();
    if (thread_.joinable()) thread_.join();
  }

  dds::Participant participant;
  dds::WaitSet loop;

 private:
  std::thread thread_;
};

/// What one run of the command printed, its exit code, and the message of its refusal.
struct Outcome {
  int exit_code = 0;
  std::string output;
  std::string errors;
};

inline Outcome RunVerb(const std::vector<std::string>& words) {
  Outcome outcome;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  try {
    outcome.exit_code = RunCommand(words);
  } catch (const InputError& error) {
    outcome = {2, "", error.what()};
  } catch (const RunError& error) {
    outcome = {1, "", error.what()};
  }
  outcome.output = testing::internal::GetCapturedStdout();
  outcome.errors += testing::internal::GetCapturedStderr();
  return outcome;
}

}  // namespace palpate::command
