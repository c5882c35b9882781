// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "libs/core/status.hpp"

namespace palpate::capture {

using FeatureValue = std::variant<bool, std::int64_t, double, std::string>;

/// The GenICam features of one device, each of them optional. Reading gives nullopt where a feature
/// is missing, not accessible, of another type, or where the device did not answer; nothing throws.
/// Not thread-safe.
class Features {
 public:
  virtual ~Features() = default;

  virtual bool Has(const std::string& name) = 0;
  /// A float or integer feature; may be NaN or infinite where the device says so.
  virtual std::optional<double> Number(const std::string& name) = 0;
  virtual std::optional<std::int64_t> Integer(const std::string& name) = 0;
  virtual std::optional<bool> Bool(const std::string& name) = 0;
  /// A text, or the chosen entry of an enumeration.
  virtual std::optional<std::string> Text(const std::string& name) = 0;
  /// The entries of an enumeration with their values, those that are available; empty: none.
  virtual std::vector<std::pair<std::string, std::int64_t>> Choices(const std::string& name) = 0;
  /// Least and greatest value of an integer feature.
  virtual std::optional<std::pair<std::int64_t, std::int64_t>> Range(const std::string& name) = 0;

  /// Not ok, with the device's reason, where it refuses.
  virtual Status Set(const std::string& name, const FeatureValue& value) = 0;
  virtual Status Execute(const std::string& command) = 0;

  /// What was read otherwise than the device describes it, one sentence each.
  virtual std::vector<std::string> Notes() const { return {}; }
};

/// Chooses an entry of a selector; false where there is no such selector or entry.
inline bool Select(Features& features, const std::string& selector, const std::string& entry) {
  return features.Has(selector) && features.Set(selector, entry).ok();
}

}  // namespace palpate::capture
