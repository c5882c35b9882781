// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "libs/dds/input_lines.hpp"
#include "libs/dds/node_log.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::dds {

/// Logs which inputs of a node do not come, and when they do (InputLines). Looks at its readers
/// twice a second, from the node's loop.
class InputMonitor {
 public:
  using IsNeeded = std::function<bool()>;

  /// All must outlive this.
  InputMonitor(const Participant& participant, WaitSet& loop, NodeLog& log);
  InputMonitor(const InputMonitor&) = delete;
  InputMonitor& operator=(const InputMonitor&) = delete;

  /// `publisher`: the program that publishes the topic of `reader`, which must outlive this.
  /// `is_needed`: whether the node needs the input now; empty: always.
  void Expect(const Endpoint& reader, const std::string& publisher,
              InputKind kind = InputKind::kStream, IsNeeded is_needed = {});
  /// `input.topic` is not used: the reader knows it.
  void Expect(const Endpoint& reader, InputName input, IsNeeded is_needed = {});

  /// What is waited for, for /diagnostics; empty: nothing.
  std::string Waiting() const { return lines_.Waiting(); }

 private:
  struct Watched {
    const Endpoint* reader;
    IsNeeded is_needed;
  };

  void Look();

  NodeLog& log_;
  InputLines lines_;
  std::vector<Watched> watched_;
};

}  // namespace palpate::dds
