// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "libs/core/parameter.hpp"
#include "libs/dds/message.hpp"
#include "rcl_interfaces/msg/ParameterDescriptor.hpp"
#include "rcl_interfaces/msg/ParameterValue.hpp"

namespace palpate::dds {

/// Fills an empty message.
void SetParameterValue(const ParameterValue& value, idl::rcl_interfaces::ParameterValue* message);
/// A type that is none gives "not set".
ParameterValue ParameterValueOf(const idl::rcl_interfaces::ParameterValue& message);

/// Fills an empty message.
void SetParameterDescriptor(const Parameter& parameter,
                            idl::rcl_interfaces::ParameterDescriptor* message);

/// Fills an empty sequence of texts.
template <typename Sequence>
void SetTexts(Sequence& sequence, const std::vector<std::string>& texts) {
  Resize(sequence, texts.size());
  for (std::size_t i = 0; i < texts.size(); ++i) SetText(sequence._buffer[i], texts[i]);
}

template <typename Sequence>
std::vector<std::string> TextsOf(const Sequence& sequence) {
  std::vector<std::string> texts;
  for (const char* text : Elements(sequence)) texts.emplace_back(Text(text));
  return texts;
}

}  // namespace palpate::dds
