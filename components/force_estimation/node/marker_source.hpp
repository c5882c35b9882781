// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/force_estimation/node/frame_gate.hpp"
#include "components/force_estimation/node/frame_source.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::force_estimation {

/// Frames of /perception/markers.
class MarkerSource : public FrameSource {
 public:
  /// `names`: of the robot's markers. `hint`: why none may come (dds::InputName).
  MarkerSource(dds::Participant& participant, dds::WaitSet& loop, std::vector<std::string> names,
               std::string hint, TakeArrival take);

  void ExpectInputs(dds::InputMonitor& inputs) const override {
    inputs.Expect(markers_,
                  {.publisher = "palpate-motion-capture or palpate-player", .hint = hint_});
  }

  std::string name() const override { return "markers"; }
  uint64_t dropped() const override { return gate_.lost(); }
  uint32_t writers() const override { return markers_.matched(); }
  uint32_t incompatible_qos() const override { return markers_.counters().incompatible_qos; }

 private:
  FrameArrival ArrivalOf(const idl::palpate_msgs::MarkerArray3& message);

  std::vector<std::string> names_;
  std::string hint_;
  dds::Reader<idl::palpate_msgs::MarkerArray3> markers_;
  FrameGate gate_;
};

}  // namespace palpate::force_estimation
