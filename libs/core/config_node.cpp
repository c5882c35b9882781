// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/config_node.hpp"

namespace palpate {

const ConfigNode* ConfigNode::Find(const std::string& key) const {
  for (const auto& [name, entry] : entries) {
    if (name == key) return &entry;
  }
  return nullptr;
}

}  // namespace palpate
