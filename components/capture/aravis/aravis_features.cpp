// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/aravis/aravis_features.hpp"

#include <cmath>

#include "components/capture/aravis/gobject.hpp"

namespace palpate::capture {

ArvGcNode* AravisFeatures::Node(const std::string& name) {
  ArvGcNode* node = arv_device_get_feature(device_, name.c_str());
  return node != nullptr && ARV_IS_GC_FEATURE_NODE(node) ? node : nullptr;
}

bool AravisFeatures::Has(const std::string& name) {
  if (Node(name) == nullptr) return false;
  return IsUsable(Node(name));
}

/// Aravis' "available" does not ask whether the feature is implemented.
bool AravisFeatures::IsUsable(ArvGcNode* node) {
  GErrorHolder implemented_error;
  GErrorHolder available_error;
  auto* feature = ARV_GC_FEATURE_NODE(node);
  return arv_gc_feature_node_is_implemented(feature, implemented_error.Take()) != 0 &&
         implemented_error.ok() &&
         arv_gc_feature_node_is_available(feature, available_error.Take()) != 0 &&
         available_error.ok();
}

std::optional<double> AravisFeatures::Number(const std::string& name) {
  ArvGcNode* node = Node(name);
  if (node == nullptr || !Has(name)) return std::nullopt;
  if (formulas_.Fails(node)) return formulas_.Value(node);
  GErrorHolder error;
  double value = 0.0;
  if (ARV_IS_GC_FLOAT(node)) {
    value = arv_gc_float_get_value(ARV_GC_FLOAT(node), error.Take());
  } else if (ARV_IS_GC_INTEGER(node) && !ARV_IS_GC_ENUMERATION(node)) {
    value = static_cast<double>(arv_gc_integer_get_value(ARV_GC_INTEGER(node), error.Take()));
  } else {
    return std::nullopt;
  }
  return error.ok() ? std::optional(value) : std::nullopt;
}

std::optional<std::int64_t> AravisFeatures::Integer(const std::string& name) {
  ArvGcNode* node = Node(name);
  if (node == nullptr || !ARV_IS_GC_INTEGER(node) || !Has(name)) return std::nullopt;
  if (formulas_.Fails(node)) {
    constexpr double kGreatest = 9e15;  // doubles hold whole numbers up to there
    const std::optional<double> value = formulas_.Value(node);
    return value && std::abs(*value) < kGreatest ? std::optional<std::int64_t>(std::llround(*value))
                                                 : std::nullopt;
  }
  GErrorHolder error;
  const std::int64_t value = arv_gc_integer_get_value(ARV_GC_INTEGER(node), error.Take());
  return error.ok() ? std::optional(value) : std::nullopt;
}

std::optional<bool> AravisFeatures::Bool(const std::string& name) {
  ArvGcNode* node = Node(name);
  if (node == nullptr || !ARV_IS_GC_BOOLEAN(node) || !Has(name)) return std::nullopt;
  GErrorHolder error;
  const bool value = arv_gc_boolean_get_value(ARV_GC_BOOLEAN(node), error.Take()) != 0;
  return error.ok() ? std::optional(value) : std::nullopt;
}

std::optional<std::string> AravisFeatures::Text(const std::string& name) {
  ArvGcNode* node = Node(name);
  if (node == nullptr || !Has(name)) return std::nullopt;
  GErrorHolder error;
  const char* value = nullptr;
  if (ARV_IS_GC_ENUMERATION(node)) {
    value = arv_gc_enumeration_get_string_value(ARV_GC_ENUMERATION(node), error.Take());
  } else if (ARV_IS_GC_STRING(node)) {
    value = arv_gc_string_get_value(ARV_GC_STRING(node), error.Take());
  }
  return error.ok() && value != nullptr ? std::optional<std::string>(value) : std::nullopt;
}

std::vector<std::pair<std::string, std::int64_t>> AravisFeatures::Choices(const std::string& name) {
  std::vector<std::pair<std::string, std::int64_t>> choices;
  ArvGcNode* node = Node(name);
  if (node == nullptr || !ARV_IS_GC_ENUMERATION(node) || !Has(name)) return choices;
  const GSList* entries = arv_gc_enumeration_get_entries(ARV_GC_ENUMERATION(node));
  for (const GSList* item = entries; item != nullptr; item = item->next) {
    if (!ARV_IS_GC_ENUM_ENTRY(item->data)) continue;
    GErrorHolder error;
    auto* entry = ARV_GC_FEATURE_NODE(item->data);
    const char* entry_name = arv_gc_feature_node_get_name(entry);
    if (!IsUsable(ARV_GC_NODE(entry)) || entry_name == nullptr) continue;
    const auto value = arv_gc_enum_entry_get_value(ARV_GC_ENUM_ENTRY(item->data), error.Take());
    if (error.ok()) choices.emplace_back(entry_name, value);
  }
  return choices;
}

std::optional<std::pair<std::int64_t, std::int64_t>> AravisFeatures::Range(
    const std::string& name) {
  ArvGcNode* node = Node(name);
  if (node == nullptr || !ARV_IS_GC_INTEGER(node) || !Has(name)) return std::nullopt;
  GErrorHolder least_error;
  GErrorHolder greatest_error;
  const auto least = arv_gc_integer_get_min(ARV_GC_INTEGER(node), least_error.Take());
  const auto greatest = arv_gc_integer_get_max(ARV_GC_INTEGER(node), greatest_error.Take());
  if (!least_error.ok() || !greatest_error.ok() || least > greatest) return std::nullopt;
  return std::pair<std::int64_t, std::int64_t>(least, greatest);
}

Status AravisFeatures::Set(const std::string& name, const FeatureValue& value) {
  ArvGcNode* node = Node(name);
  if (node == nullptr) return {StatusCode::kInvalidInput, "no feature " + name};
  GErrorHolder error;
  if (const bool* flag = std::get_if<bool>(&value); flag && ARV_IS_GC_BOOLEAN(node)) {
    arv_gc_boolean_set_value(ARV_GC_BOOLEAN(node), *flag ? 1 : 0, error.Take());
  } else if (const auto* whole = std::get_if<std::int64_t>(&value);
             whole && ARV_IS_GC_INTEGER(node)) {
    arv_gc_integer_set_value(ARV_GC_INTEGER(node), *whole, error.Take());
  } else if (const double* number = std::get_if<double>(&value); number && ARV_IS_GC_FLOAT(node)) {
    return SetFloat(ARV_GC_FLOAT(node), *number);
  } else if (const double* other = std::get_if<double>(&value);
             other && ARV_IS_GC_INTEGER(node) && !ARV_IS_GC_ENUMERATION(node)) {
    arv_gc_integer_set_value(ARV_GC_INTEGER(node), std::llround(*other), error.Take());
  } else if (const auto* text = std::get_if<std::string>(&value);
             text && ARV_IS_GC_ENUMERATION(node)) {
    arv_gc_enumeration_set_string_value(ARV_GC_ENUMERATION(node), text->c_str(), error.Take());
  } else {
    return {StatusCode::kInvalidInput, name + " is of another type"};
  }
  return error.ok() ? Status::Ok() : Status(StatusCode::kInvalidInput, error.text());
}

/// A real number that an integer stands behind is cut by Aravis: 15699.999999999998 to 15699. Where
/// the device shows that, the nearest integer is set.
Status AravisFeatures::SetFloat(ArvGcFloat* node, double number) {
  GErrorHolder error;
  arv_gc_float_set_value(node, number, error.Take());
  if (!error.ok()) return {StatusCode::kInvalidInput, error.text()};
  const double nearest = std::round(number);
  const double shown = arv_gc_float_get_value(node, error.Take());
  const bool is_cut = error.ok() && shown == std::trunc(number) && shown != nearest;
  if (is_cut) arv_gc_float_set_value(node, nearest, error.Take());
  return is_cut && !error.ok() ? Status(StatusCode::kInvalidInput, error.text()) : Status::Ok();
}

Status AravisFeatures::Execute(const std::string& command) {
  ArvGcNode* node = Node(command);
  if (node == nullptr || !ARV_IS_GC_COMMAND(node)) {
    return {StatusCode::kInvalidInput, "no command " + command};
  }
  GErrorHolder error;
  arv_gc_command_execute(ARV_GC_COMMAND(node), error.Take());
  return error.ok() ? Status::Ok() : Status(StatusCode::kInvalidInput, error.text());
}

}  // namespace palpate::capture
