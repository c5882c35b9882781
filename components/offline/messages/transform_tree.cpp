// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/transform_tree.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace palpate::offline {

std::string FrameName(std::string frame_id) {
  return frame_id.starts_with('/') ? frame_id.substr(1) : frame_id;
}

void TransformTree::Add(const std::string& parent, const std::string& child, std::int64_t t_ns,
                        const Eigen::Isometry3d& T_parent_child) {
  links_[FrameName(child)][t_ns] = {FrameName(parent), T_parent_child};
}

std::optional<Eigen::Isometry3d> TransformTree::Find(const std::string& target,
                                                     const std::string& source,
                                                     std::int64_t t_ns) const {
  if (FrameName(target) == FrameName(source)) return Eigen::Isometry3d::Identity();
  // T_ancestor_frame of a frame and of all that it hangs from.
  const auto ancestors = [&](const std::string& frame) {
    std::map<std::string, Eigen::Isometry3d> found{{frame, Eigen::Isometry3d::Identity()}};
    std::string at = frame;
    for (;;) {
      const auto links = links_.find(at);
      if (links == links_.end()) return found;
      auto link = links->second.upper_bound(t_ns);
      if (link != links->second.begin()) --link;
      const Eigen::Isometry3d T_parent_frame = link->second.T_parent_child * found.at(at);
      if (!found.emplace(link->second.parent, T_parent_frame).second) return found;  // a circle
      at = link->second.parent;
    }
  };
  const auto above_target = ancestors(FrameName(target));
  const auto above_source = ancestors(FrameName(source));
  for (const auto& [frame, T_frame_source] : above_source) {
    const auto common = above_target.find(frame);
    if (common != above_target.end()) return common->second.inverse() * T_frame_source;
  }
  return std::nullopt;
}

bool TransformTree::Knows(const std::string& frame) const {
  const std::vector<std::string> frames = Frames();
  return std::find(frames.begin(), frames.end(), FrameName(frame)) != frames.end();
}

std::vector<std::string> TransformTree::Frames() const {
  std::set<std::string> frames;
  for (const auto& [child, links] : links_) {
    frames.insert(child);
    for (const auto& [t_ns, link] : links) frames.insert(link.parent);
  }
  return {frames.begin(), frames.end()};
}

}  // namespace palpate::offline
