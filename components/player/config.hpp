// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "libs/core/config_reader.hpp"

namespace palpate::player {

/// Settings of ExperimentPlayer and its node.
struct Config {
  std::string frame = "robot";
  double start_time_s = 0.0;
  bool wait_for_readers = true;
  double reader_deadline_s = 30.0;
  double step_deadline_s = 60.0;
  double resend_s = 2.0;
  bool rewind_for_new_estimator = true;
  bool publish_clock = false;
  double settle_s = 0.3;
  double seek_s = 5.0;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("frame", frame, {"robot", "measured"},
      "Frame of the published markers: the robot's (needs T_robot_camera where a camera measured), "
      "or as measured");
    v("start_time_s", start_time_s, {.min = 0.0, .max = 2e9},
      "Offset of the stamps: stamp = start_time_s + t_s");
    v("wait_for_readers", wait_for_readers,
      "Start only when every published topic has a reader; of a message file any topic");
    v("reader_deadline_s", reader_deadline_s, {.min = 0.0, .min_open = true},
      "Time without a reader after which the player fails, s");
    v("step_deadline_s", step_deadline_s, {.min = 0.0, .min_open = true},
      "With --step: time without an answer to a frame after which the player fails, s");
    v("resend_s", resend_s, {.min = 0.0, .min_open = true},
      "With --step: time without an answer after which a frame is sent again, s");
    v("rewind_for_new_estimator", rewind_for_new_estimator,
      "Restart the recording when a force estimator appears, so that it receives the reference "
      "frames");
    v("publish_clock", publish_clock,
      "Publish the time of the recording on /clock, for nodes with dds.use_sim_time");
    v("settle_s", settle_s, {.min = 0.0},
      "Start only when no further reader or writer has appeared for this time, s");
    v("seek_s", seek_s, {.min = 0.0, .min_open = true},
      "Time by which the arrow keys move in a message file, s");
  }
};

}  // namespace palpate::player
