// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/wrench_slots.hpp"

#include <algorithm>
#include <utility>

#include "libs/dds/ros_names.hpp"

namespace palpate::force_estimation {

WrenchSlots::WrenchSlots(std::vector<std::string> given, std::int64_t hold_ns)
    : given_(std::move(given)), hold_ns_(hold_ns) {}

std::string WrenchSlots::NameOf(const std::string& contact, std::int64_t stamp_ns) {
  if (std::find(given_.begin(), given_.end(), contact) != given_.end()) {
    return dds::RosNamePart(contact);
  }
  FreeUnseen(stamp_ns);
  const auto holder = [&](const std::string& name) {
    return std::find_if(slots_.begin(), slots_.end(),
                        [&](const Slot& slot) { return slot.contact == name; });
  };
  auto slot = holder(contact);
  if (slot == slots_.end()) slot = holder("");
  if (slot == slots_.end()) {
    if (slots_.size() == kMostSlots) return {};
    slot = slots_.insert(slots_.end(), Slot{});
  }
  *slot = {contact, stamp_ns};
  return "slot_" + std::to_string(slot - slots_.begin() + 1);
}

void WrenchSlots::FreeUnseen(std::int64_t stamp_ns) {
  const bool restarted = stamp_ns < newest_ns_;
  newest_ns_ = stamp_ns;
  for (Slot& slot : slots_) {
    if (restarted || stamp_ns - slot.last_ns > hold_ns_) slot.contact.clear();
  }
}

}  // namespace palpate::force_estimation
