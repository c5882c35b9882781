// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace palpate::recording {

/// Whether `text` fits `pattern`, in which "*" stands for any characters.
bool Matches(std::string_view text, std::string_view pattern);

/// Which topics are recorded or played: those that fit one of `wanted` (empty: all), and none of
/// `excluded`.
struct TopicChoice {
  std::vector<std::string> wanted;  ///< names or patterns: "/camera/*"
  std::vector<std::string> excluded;

  bool Includes(std::string_view topic) const;
};

/// Whether a DDS topic is one of ROS 2's own (services, actions' services, its graph), which are
/// neither recorded nor played.
bool IsRosInternal(std::string_view dds_topic);

}  // namespace palpate::recording
