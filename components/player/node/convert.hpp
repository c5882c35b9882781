// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/player/experiment_player.hpp"
#include "libs/dds/message.hpp"
#include "palpate_msgs/msg/MarkerArray3.hpp"
#include "sensor_msgs/msg/JointState.hpp"

namespace palpate::player {

/// Stamp of an event: t_s on top of a start time, to the nearest ns.
int64_t StampOf(const Event& event, double start_time_s);

/// `event.markers` must be there.
dds::Message<idl::palpate_msgs::MarkerArray3> ToMarkerArray(const Event& event, int64_t stamp_ns);

/// name = cable, position = displacement in m, effort = tension in N. Position is empty where no
/// cable has a displacement, effort where none has a tension; where some have, the others are NaN.
/// No names at all say that no cable was driven.
dds::Message<idl::sensor_msgs::JointState> ToJointState(const Event& event, int64_t stamp_ns);

}  // namespace palpate::player
