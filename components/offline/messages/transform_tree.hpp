// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace palpate::offline {

/// Frames of a recording and where they were (/tf, /tf_static).
class TransformTree {
 public:
  /// p_parent = T_parent_child * p_child, from `t_ns` on. Later ones replace it.
  void Add(const std::string& parent, const std::string& child, std::int64_t t_ns,
           const Eigen::Isometry3d& T_parent_child);

  /// T_target_source at a time: the last transforms not after it, else the first. nullopt: nothing
  /// joins the two frames.
  std::optional<Eigen::Isometry3d> Find(const std::string& target, const std::string& source,
                                        std::int64_t t_ns) const;

  bool Knows(const std::string& frame) const;
  std::vector<std::string> Frames() const;

 private:
  struct Link {
    std::string parent;
    Eigen::Isometry3d T_parent_child;
  };

  std::map<std::string, std::map<std::int64_t, Link>> links_;  ///< by child, then time
};

/// Without the slash that old publishers put in front.
std::string FrameName(std::string frame_id);

}  // namespace palpate::offline
