// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <dds/dds.h>

#include <chrono>
#include <string>
#include <vector>

#include "libs/core/parameter.hpp"

namespace palpate::dds {

/// Asks a node about its parameters by the services of ROS 2. Each call throws RunError where the
/// node does not answer in time, or DDS refuses.
class ParameterClient {
 public:
  /// `node`: with its namespace, "/left/palpate_view". `patience`: of each call.
  ParameterClient(dds_entity_t participant, std::string node, std::chrono::nanoseconds patience)
      : participant_(participant), node_(std::move(node)), patience_(patience) {}

  std::vector<std::string> List() const;
  /// "Not set" for a name that the node does not have.
  std::vector<ParameterValue> Get(const std::vector<std::string>& names) const;
  /// With descriptions and constraints; of values only their type, of reasons that there is one.
  std::vector<Parameter> Describe(const std::vector<std::string>& names) const;
  /// The reason of a refusal, or "".
  std::string Set(const std::string& name, const ParameterValue& value) const;

 private:
  template <typename Service, typename Fill, typename Take>
  void Ask(const char* service, const Fill& fill, const Take& take) const;

  dds_entity_t participant_;
  std::string node_;
  std::chrono::nanoseconds patience_;
};

}  // namespace palpate::dds
