// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/dds/node_settings.hpp"

namespace palpate::virtual_robot {

/// Settings of the process.
struct NodeConfig {
  double rate_hz = 30.0;
  std::string commands = "script";
  double command_timeout_s = 1.0;
  bool repeat = true;
  double max_step_s = 0.1;
  int most_ahead = 0;
  int threads = 2;
  bool publish_clock = false;
  dds::NodeSettings dds;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("rate_hz", rate_hz, {.min = 0.0, .max = 1000.0, .min_open = true},
      "States per second; the virtual camera takes one frame of each");
    v("commands", commands, {"script", "topic"},
      "Source of the cable commands: script (the scenario) or topic (/robot/command)");
    v("command_timeout_s", command_timeout_s, {.min = 0.0, .min_open = true},
      "With commands topic: time without a command after which the status is stale, s");
    v("repeat", repeat, "Restart the scenario at its end, with the history kept");
    v("max_step_s", max_step_s, {.min = 0.0, .min_open = true},
      "Largest step of bench time between two states, s; what a slow computer misses beyond it is "
      "counted as dropped");
    v("most_ahead", most_ahead, {.min = 0, .max = 1000},
      "Largest number of states that /forces has not answered yet: the bench waits for it, up to 5 "
      "s, so that a slow computer loses no frames; 0: it does not wait");
    v("threads", threads, {.min = 1, .max = 64}, "Threads of the solver");
    v("publish_clock", publish_clock,
      "Publish the stamp of each state on /clock, for nodes with dds.use_sim_time");
    v("dds", dds, "DDS side");
  }
};

}  // namespace palpate::virtual_robot
