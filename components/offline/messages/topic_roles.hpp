// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "libs/recording/recorded_messages.hpp"

namespace palpate::offline {

/// The topics of an experiment (docs/experiment.md), by the names that they have in this system.
inline constexpr char kDepthTopic[] = "/camera/depth/image_raw";
inline constexpr char kDepthInfoTopic[] = "/camera/depth/camera_info";
inline constexpr char kColorTopic[] = "/camera/color/image_raw";
inline constexpr char kColorInfoTopic[] = "/camera/color/camera_info";
inline constexpr char kCameraSetupTopic[] = "/camera/setup";
inline constexpr char kFrameInfoTopic[] = "/camera/frame_info";
inline constexpr char kPointsTopic[] = "/camera/points";
inline constexpr char kMarkersTopic[] = "/perception/markers";
inline constexpr char kJointStatesTopic[] = "/robot/joint_states";
inline constexpr char kLoadTopic[] = "/experiment/load";
inline constexpr char kPhaseTopic[] = "/experiment/phase";
inline constexpr char kCalibrationTopic[] = "/calibration";

using ChannelSet = std::set<std::uint16_t>;

/// Which topic of a recording stands for which of these. Empty sets: none does.
struct TopicRoles {
  std::map<std::string, ChannelSet> channels;  ///< by the names above
  ChannelSet transforms;                       ///< /tf, /tf_static
  std::map<std::string, std::string> names;    ///< by the names above: as it is called here
  /// Names in the recording -> those above, of --remap.
  std::map<std::string, std::string> remapped;
  std::vector<std::string> listed;  ///< all topics with their types, for messages

  bool Has(const std::string& role) const { return channels.contains(role); }
  bool Is(const std::string& role, std::uint16_t channel) const {
    const auto found = channels.find(role);
    return found != channels.end() && found->second.contains(channel);
  }
};

/// `remap`: rules FROM:=TO. A topic is found by its name, else by a name that ends so, else by its
/// type. Throws InputError for a rule that fits nothing, and where two topics could be meant.
TopicRoles FindTopics(const recording::RecordedMessages& recorded,
                      const std::vector<std::string>& remap);

}  // namespace palpate::offline
