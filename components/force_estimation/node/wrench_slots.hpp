// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace palpate::force_estimation {

/// Which topic /forces/<name>/wrench a contact is published on. A given contact has one of its own
/// name. A contact that was found takes the first free slot (slot_1, slot_2, ...) and keeps it
/// until it has been missing for `hold_ns`. Contacts are numbered without end; topics are not.
class WrenchSlots {
 public:
  static constexpr std::size_t kMostSlots = 64;

  /// `given`: names of the contacts that the settings give. `hold_ns`: >= 0, of the frames' stamps.
  explicit WrenchSlots(std::vector<std::string> given, std::int64_t hold_ns = 1'000'000'000);

  /// The <name> for `contact` in the frame of `stamp_ns`, a part of a ROS topic name. Stamps that
  /// fall free all slots. With kMostSlots contacts at once it is empty.
  std::string NameOf(const std::string& contact, std::int64_t stamp_ns);

 private:
  struct Slot {
    std::string contact;  ///< empty: free
    std::int64_t last_ns = 0;
  };

  void FreeUnseen(std::int64_t stamp_ns);

  std::vector<std::string> given_;
  std::int64_t hold_ns_;
  std::int64_t newest_ns_ = 0;
  std::vector<Slot> slots_;
};

}  // namespace palpate::force_estimation
