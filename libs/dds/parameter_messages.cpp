// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/parameter_messages.hpp"

#include <cmath>
#include <cstdint>

namespace palpate::dds {

namespace {

using ValueMessage = idl::rcl_interfaces::ParameterValue;

/// Sets the member of the message that its type names.
struct ValueSetter {
  ValueMessage* message;

  void operator()(std::monostate) const {}
  void operator()(bool value) const { message->bool_value = value; }
  void operator()(std::int64_t value) const { message->integer_value = value; }
  void operator()(double value) const { message->double_value = value; }
  void operator()(const std::string& value) const { SetText(message->string_value, value); }
  void operator()(const std::vector<std::uint8_t>& values) const {
    SetNumbers(message->byte_array_value, values.data(), values.size());
  }
  void operator()(const std::vector<bool>& values) const {
    Resize(message->bool_array_value, values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      message->bool_array_value._buffer[i] = values[i];
    }
  }
  void operator()(const std::vector<std::int64_t>& values) const {
    SetNumbers(message->integer_array_value, values.data(), values.size());
  }
  void operator()(const std::vector<double>& values) const {
    SetNumbers(message->double_array_value, values.data(), values.size());
  }
  void operator()(const std::vector<std::string>& values) const {
    SetTexts(message->string_array_value, values);
  }
};

template <typename Value, typename Sequence>
std::vector<Value> ListOf(const Sequence& sequence) {
  const auto elements = Elements(sequence);
  return std::vector<Value>(elements.begin(), elements.end());
}

}  // namespace

void SetParameterValue(const ParameterValue& value, ValueMessage* message) {
  message->type = static_cast<std::uint8_t>(value.index());
  SetText(message->string_value, "");
  std::visit(ValueSetter{message}, value);
}

ParameterValue ParameterValueOf(const ValueMessage& message) {
  switch (message.type) {
    case 1: return message.bool_value;
    case 2: return std::int64_t{message.integer_value};
    case 3: return message.double_value;
    case 4: return std::string(Text(message.string_value));
    case 5: return ListOf<std::uint8_t>(message.byte_array_value);
    case 6: return ListOf<bool>(message.bool_array_value);
    case 7: return ListOf<std::int64_t>(message.integer_array_value);
    case 8: return ListOf<double>(message.double_array_value);
    case 9: return TextsOf(message.string_array_value);
    default: return std::monostate{};
  }
}

void SetParameterDescriptor(const Parameter& parameter,
                            idl::rcl_interfaces::ParameterDescriptor* message) {
  SetText(message->name, parameter.name);
  message->type = static_cast<std::uint8_t>(parameter.value.index());
  SetText(message->description, parameter.description);
  SetText(message->additional_constraints, parameter.range ? "" : parameter.constraints);
  message->read_only = !parameter.fixed_because.empty();
  // One that may be unset has another type then.
  message->dynamic_typing = std::holds_alternative<std::monostate>(parameter.value);
  if (!parameter.range) return;
  const auto [from, to] = *parameter.range;
  if (std::holds_alternative<std::int64_t>(parameter.value)) {
    Resize(message->integer_range, 1);
    message->integer_range._buffer[0] = {static_cast<std::int64_t>(std::ceil(from)),
                                         static_cast<std::int64_t>(std::floor(to)), 0};
  } else {
    Resize(message->floating_point_range, 1);
    message->floating_point_range._buffer[0] = {from, to, 0.0};
  }
}

}  // namespace palpate::dds
