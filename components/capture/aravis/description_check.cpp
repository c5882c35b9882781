// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/aravis/description_check.hpp"

#include <map>
#include <string>
#include <vector>

#include "components/capture/aravis/dom_text.hpp"

namespace palpate::capture {

namespace {

constexpr int kDeepest = 16;  ///< GenICam needs three

/// Elements whose text names the node that a node's own value is computed from.
bool IsValueLink(const std::string& element) {
  static const char* const kLinks[] = {"pValue",  "pVariable", "pAddress",      "pIndex",
                                       "pLength", "pPort",     "pValueIndexed", "pValueDefault"};
  for (const char* link : kLinks) {
    if (element == link) return true;
  }
  return false;
}

/// Elements whose text names the node that says whether a node is there.
bool IsConditionLink(const std::string& element) {
  return element == "pIsAvailable" || element == "pIsImplemented" || element == "pIsLocked";
}

using Links = std::map<std::string, std::vector<std::string>>;

/// Adds the links of `node` to those of `name`: "name" stands for its value, "name?" for whether it
/// is there, which also asks those that its value comes from. A node inside a node, such as the
/// formula of an address, counts as part of it.
void GatherOne(ArvDomNode* node, const std::string& name, Links* links, int depth) {
  if (depth > kDeepest) return;
  for (ArvDomNode* item = arv_dom_node_get_first_child(node); item != nullptr;
       item = arv_dom_node_get_next_sibling(item)) {
    const char* element = arv_dom_node_get_node_name(item);
    if (element == nullptr || !ARV_IS_DOM_ELEMENT(item)) continue;
    if (ARV_IS_GC_FEATURE_NODE(item)) {
      if (!ARV_IS_GC_ENUM_ENTRY(item)) GatherOne(item, name, links, depth + 1);
    } else if (IsValueLink(element)) {
      const std::string target = TextOf(item);
      (*links)[name].push_back(target);
      (*links)[name + "?"].push_back(target + "?");
    } else if (IsConditionLink(element)) {
      (*links)[name + "?"].push_back(TextOf(item));
    }
  }
}

/// Adds the links of all nodes below `parent`.
void Gather(ArvDomNode* parent, Links* links, int depth) {
  if (depth > kDeepest) return;
  for (ArvDomNode* child = arv_dom_node_get_first_child(parent); child != nullptr;
       child = arv_dom_node_get_next_sibling(child)) {
    if (!ARV_IS_DOM_ELEMENT(child)) continue;
    if (ARV_IS_GC_FEATURE_NODE(child)) {
      const char* name = arv_gc_feature_node_get_name(ARV_GC_FEATURE_NODE(child));
      if (name != nullptr) GatherOne(child, name, links, 0);
    }
    Gather(child, links, depth + 1);
  }
}

enum class Mark { kNew, kOpen, kDone };

struct Visit {
  const std::string* node;
  std::size_t next_link;
};

/// The first node that is reached from itself; empty: none. Without recursion: chains may be long.
std::string FindCircle(const Links& links) {
  std::map<std::string, Mark> marks;
  static const std::vector<std::string> kNone;
  for (const auto& [start, unused] : links) {
    std::vector<Visit> path;
    if (marks[start] == Mark::kNew) path.push_back({&start, 0});
    while (!path.empty()) {
      Visit& visit = path.back();
      marks[*visit.node] = Mark::kOpen;
      const auto found = links.find(*visit.node);
      const auto& targets = found == links.end() ? kNone : found->second;
      if (visit.next_link == targets.size()) {
        marks[*visit.node] = Mark::kDone;
        path.pop_back();
        continue;
      }
      const std::string& target = targets[visit.next_link++];
      const Mark mark = marks[target];
      if (mark == Mark::kOpen) return target;
      if (mark == Mark::kNew) path.push_back({&target, 0});
    }
  }
  return "";
}

}  // namespace

Status CheckDescription(ArvDevice* device) {
  ArvGc* description = arv_device_get_genicam(device);
  if (description == nullptr || !ARV_IS_DOM_NODE(description)) {
    return {StatusCode::kInvalidInput, "the camera has no GenICam description"};
  }
  Links links;
  Gather(ARV_DOM_NODE(description), &links, 0);
  const std::string circle = FindCircle(links);
  if (circle.empty()) return Status::Ok();
  return {StatusCode::kInvalidInput,
          "the camera's GenICam description computes " + circle + " from itself"};
}

}  // namespace palpate::capture
