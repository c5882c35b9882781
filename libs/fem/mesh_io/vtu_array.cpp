// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/vtu_array.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/fem/mesh_io/limits.hpp"
#include "libs/fem/mesh_io/scalar_type.hpp"
#include "libs/fem/mesh_io/vtu_bytes.hpp"

namespace palpate::fem::mesh_io {

namespace {

using tinyxml2::XMLElement;
using tinyxml2::XMLText;

std::optional<ScalarType> FindType(const XMLElement& array) {
  static constexpr auto kTypes = std::to_array<std::pair<std::string_view, ScalarType>>({
      {"Int8", ScalarType::kInt8},
      {"UInt8", ScalarType::kUInt8},
      {"Int16", ScalarType::kInt16},
      {"UInt16", ScalarType::kUInt16},
      {"Int32", ScalarType::kInt32},
      {"UInt32", ScalarType::kUInt32},
      {"Int64", ScalarType::kInt64},
      {"UInt64", ScalarType::kUInt64},
      {"Float32", ScalarType::kFloat32},
      {"Float64", ScalarType::kFloat64},
  });
  const char* name = array.Attribute("type");
  for (const auto& [known, type] : kTypes) {
    if (name != nullptr && known == name) return type;
  }
  return std::nullopt;
}

ScalarType TypeOf(const XMLElement& array, const VtuStorage& storage) {
  if (const auto type = FindType(array)) return *type;
  const char* name = array.Attribute("type");
  FailAtArray(array, storage,
              name == nullptr ? "has no attribute 'type'" : "unknown type '" + Excerpt(name) + "'");
}

/// The line of `position` in a text whose first word stands on the line of the node.
int LineAt(const XMLText& node, std::string_view text, size_t position) {
  const size_t first = std::min(text.find_first_not_of(kWhiteSpace), position);
  const auto between = text.substr(first, position - first);
  return node.GetLineNum() + static_cast<int>(std::count(between.begin(), between.end(), '\n'));
}

bool ParseWord(std::string_view word, double* value) { return ParseFinite(word, value); }

bool ParseWord(std::string_view word, int64_t* value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), *value);
  return error == std::errc() && end == word.data() + word.size();
}

template <typename Value>
std::vector<Value> ParseText(const XMLElement& array, const VtuStorage& storage, int64_t count) {
  const XMLText* node = ArrayText(array);
  const std::string_view text = node == nullptr ? std::string_view() : node->Value();
  std::vector<Value> values;
  values.reserve(std::min(static_cast<size_t>(count), text.size() / 2 + 1));
  for (size_t start = text.find_first_not_of(kWhiteSpace); start != std::string_view::npos;) {
    const size_t end = std::min(text.find_first_of(kWhiteSpace, start), text.size());
    Value value{};
    if (!ParseWord(text.substr(start, end - start), &value)) {
      const SourceLocation where{storage.file, LineAt(*node, text, start), 0};
      throw InputError(
          where, "array '" + ArrayName(array) + "': '" +
                     std::string(text.substr(start, std::min<size_t>(end - start, 40))) +
                     "' is not " + (std::is_integral_v<Value> ? "an integer" : "a finite number"));
    }
    values.push_back(value);
    start = text.find_first_not_of(kWhiteSpace, end);
  }
  if (values.size() != static_cast<size_t>(count)) {
    FailAtArray(
        array, storage,
        "holds " + std::to_string(values.size()) + " numbers instead of " + std::to_string(count));
  }
  return values;
}

bool IsAscii(const XMLElement& array) {
  const char* format = array.Attribute("format");
  return format == nullptr || std::string_view(format) == "ascii";
}

}  // namespace

std::vector<double> ReadRealArray(const XMLElement& array, const VtuStorage& storage,
                                  int64_t count) {
  const ScalarType type = TypeOf(array, storage);
  if (IsAscii(array)) return ParseText<double>(array, storage, count);
  const size_t size = SizeInBytes(type);
  const std::string bytes = ReadBinaryArray(array, storage, static_cast<uint64_t>(count), size);
  std::vector<double> values(static_cast<size_t>(count));
  for (size_t k = 0; k < values.size(); ++k) {
    values[k] = DecodeReal(type, std::string_view(bytes).substr(k * size, size), storage.swap);
    if (!std::isfinite(values[k])) {
      FailAtArray(array, storage, "number " + std::to_string(k) + " is not finite");
    }
  }
  return values;
}

std::vector<int64_t> ReadIntegerArray(const XMLElement& array, const VtuStorage& storage,
                                      int64_t count) {
  const ScalarType type = TypeOf(array, storage);
  if (!IsInteger(type)) FailAtArray(array, storage, "must hold integers");
  if (IsAscii(array)) return ParseText<int64_t>(array, storage, count);
  const size_t size = SizeInBytes(type);
  const std::string bytes = ReadBinaryArray(array, storage, static_cast<uint64_t>(count), size);
  std::vector<int64_t> values(static_cast<size_t>(count));
  for (size_t k = 0; k < values.size(); ++k) {
    const auto value =
        DecodeInteger(type, std::string_view(bytes).substr(k * size, size), storage.swap);
    if (!value) FailAtArray(array, storage, "number " + std::to_string(k) + " is above 2^63");
    values[k] = *value;
  }
  return values;
}

bool IsIntegerArray(const XMLElement& array) {
  const std::optional<ScalarType> type = FindType(array);
  return type && IsInteger(*type);
}

void FailAtArray(const XMLElement& array, const VtuStorage& storage, const std::string& message) {
  throw InputError(SourceLocation{storage.file, array.GetLineNum(), 0},
                   "array '" + ArrayName(array) + "': " + message);
}

}  // namespace palpate::fem::mesh_io
