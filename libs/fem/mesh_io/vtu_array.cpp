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
#include "libs/core/large_pages.hpp"
#include "libs/core/text.hpp"
#include "libs/fem/mesh_io/limits.hpp"
#include "libs/fem/mesh_io/scalar_type.hpp"
#include "libs/fem/mesh_io/vtu_bytes.hpp"
#include "libs/fem/mesh_io/vtu_text.hpp"

namespace palpate::fem::mesh_io {

namespace {

using tinyxml2::XMLElement;

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

/// The line of `position` in the text.
int LineAt(const ArrayText& array, size_t position) {
  const size_t first = std::min(array.text.find_first_not_of(kWhiteSpace), position);
  const auto between = array.text.substr(first, position - first);
  return array.line + static_cast<int>(std::count(between.begin(), between.end(), '\n'));
}

bool ParseWord(std::string_view word, double* value) { return ParseFinite(word, value); }

bool ParseWord(std::string_view word, int64_t* value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), *value);
  return error == std::errc() && end == word.data() + word.size();
}

template <typename Value>
LargeVector<Value> ParseText(const XMLElement& array, const VtuStorage& storage, int64_t count) {
  const ArrayText source = TextOfArray(array, storage);
  const std::string_view text = source.text;
  LargeVector<Value> values;
  values.reserve(std::min(static_cast<size_t>(count), text.size() / 2 + 1));
  const auto skip = [text](size_t position, bool white) {
    while (position < text.size() && IsWhiteSpace(text[position]) == white) ++position;
    return position;
  };
  for (size_t start = skip(0, true); start < text.size();) {
    const size_t end = skip(start, false);
    Value value{};
    if (!ParseWord(text.substr(start, end - start), &value)) {
      const SourceLocation where{storage.file, LineAt(source, start), 0};
      throw InputError(
          where, "array '" + ArrayName(array) + "': '" +
                     std::string(text.substr(start, std::min<size_t>(end - start, 40))) +
                     "' is not " + (std::is_integral_v<Value> ? "an integer" : "a finite number"));
    }
    values.push_back(value);
    start = skip(end, true);
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

LargeVector<double> ReadRealArray(const XMLElement& array, const VtuStorage& storage,
                                  int64_t count) {
  const ScalarType type = TypeOf(array, storage);
  if (IsAscii(array)) return ParseText<double>(array, storage, count);
  const size_t size = SizeInBytes(type);
  const ArrayBytes bytes(array, storage, static_cast<uint64_t>(count), size);
  LargeVector<double> values(static_cast<size_t>(count));
  DecodeReals(type, bytes.view(), storage.swap, values);
  const auto bad = std::find_if_not(values.begin(), values.end(),
                                    [](double value) { return std::isfinite(value); });
  if (bad != values.end()) {
    FailAtArray(array, storage,
                "number " + std::to_string(bad - values.begin()) + " is not finite");
  }
  return values;
}

LargeVector<int64_t> ReadIntegerArray(const XMLElement& array, const VtuStorage& storage,
                                      int64_t count) {
  const ScalarType type = TypeOf(array, storage);
  if (!IsInteger(type)) FailAtArray(array, storage, "must hold integers");
  if (IsAscii(array)) return ParseText<int64_t>(array, storage, count);
  const size_t size = SizeInBytes(type);
  const ArrayBytes bytes(array, storage, static_cast<uint64_t>(count), size);
  LargeVector<int64_t> values(static_cast<size_t>(count));
  DecodeIntegers(type, bytes.view(), storage.swap, values);
  if (type != ScalarType::kUInt64) return values;
  const auto bad = std::find_if(values.begin(), values.end(), [](int64_t v) { return v < 0; });
  if (bad != values.end()) {
    FailAtArray(array, storage,
                "number " + std::to_string(bad - values.begin()) + " is above 2^63");
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
