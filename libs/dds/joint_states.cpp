// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/joint_states.hpp"

#include <cmath>
#include <optional>
#include <string>

#include "libs/core/names.hpp"
#include "libs/dds/invalid_message.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/stamp.hpp"

namespace palpate::dds {

namespace {

Status InvalidState(const std::string& reason) { return Invalid("/robot/joint_states: " + reason); }

/// The number for entry `index`; NaN, and a sequence that is empty, mean that it is not known.
template <typename Sequence>
std::optional<double> NumberAt(const Sequence& sequence, std::size_t index) {
  if (sequence._length == 0 || std::isnan(sequence._buffer[index])) return std::nullopt;
  return sequence._buffer[index];
}

template <typename Sequence>
bool IsInfinite(const Sequence& sequence, std::size_t index) {
  return sequence._length != 0 && std::isinf(sequence._buffer[index]);
}

template <typename Sequence>
bool FitsNames(const Sequence& sequence, const idl::sensor_msgs::JointState& message) {
  return sequence._length == 0 || sequence._length == message.name._length;
}

}  // namespace

Status FromJointState(const idl::sensor_msgs::JointState& message,
                      const std::vector<std::string>& names, CableReading* reading) {
  if (!FitsNames(message.position, message) || !FitsNames(message.effort, message)) {
    return InvalidState(std::to_string(message.name._length) + " names, " +
                        std::to_string(message.position._length) + " positions, " +
                        std::to_string(message.effort._length) + " efforts");
  }
  reading->stamp_ns = StampNs(message.header.stamp);
  reading->cables.assign(names.size(), {});
  for (std::size_t i = 0; i < message.name._length; ++i) {
    const std::string_view name = Text(message.name._buffer[i]);
    const auto index = IndexOf(name, names);
    if (!index) return InvalidState(Unknown("cable", name, names));
    if (IsInfinite(message.position, i) || IsInfinite(message.effort, i)) {
      return InvalidState("the input of cable '" + std::string(name) + "' is infinite");
    }
    reading->cables[*index] = {NumberAt(message.position, i), NumberAt(message.effort, i)};
  }
  return Status::Ok();
}

}  // namespace palpate::dds
