// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/capture/genicam/features.hpp"

namespace palpate::capture {

/// A device of a table. A feature may hang on a selector: its name is then "Feature[entry]".
class MapFeatures : public Features {
 public:
  std::map<std::string, FeatureValue> values;
  std::map<std::string, std::vector<std::pair<std::string, std::int64_t>>> choices;
  std::map<std::string, std::pair<std::int64_t, std::int64_t>> ranges;
  std::vector<std::string> refused;   ///< Set() fails
  std::vector<std::string> executed;  ///< commands, in order
  std::vector<std::string> selectors = {"ComponentSelector", "Scan3dCoordinateSelector"};

  bool Has(const std::string& name) override {
    return Find(name) != nullptr || choices.count(name);
  }

  std::optional<double> Number(const std::string& name) override {
    const FeatureValue* value = Find(name);
    if (value == nullptr) return std::nullopt;
    if (const auto* whole = std::get_if<std::int64_t>(value)) return static_cast<double>(*whole);
    return As<double>(value);
  }
  std::optional<std::int64_t> Integer(const std::string& name) override {
    return As<std::int64_t>(Find(name));
  }
  std::optional<bool> Bool(const std::string& name) override { return As<bool>(Find(name)); }
  std::optional<std::string> Text(const std::string& name) override {
    return As<std::string>(Find(name));
  }
  std::vector<std::pair<std::string, std::int64_t>> Choices(const std::string& name) override {
    const auto found = choices.find(name);
    if (found == choices.end()) return {};
    return found->second;
  }
  std::optional<std::pair<std::int64_t, std::int64_t>> Range(const std::string& name) override {
    const auto found = ranges.find(name);
    if (found == ranges.end()) return std::nullopt;
    return found->second;
  }
  Status Set(const std::string& name, const FeatureValue& value) override {
    for (const std::string& each : refused) {
      if (each == name) return {StatusCode::kInvalidInput, "refused"};
    }
    if (const auto found = choices.find(name); found != choices.end()) {
      const auto* entry = std::get_if<std::string>(&value);
      bool known = false;
      for (const auto& choice : found->second) known = known || (entry && choice.first == *entry);
      if (!known) return {StatusCode::kInvalidInput, "no such entry"};
    }
    FeatureValue* target = Find(name);
    if (target == nullptr && !choices.count(name)) return {StatusCode::kInvalidInput, "missing"};
    (target != nullptr ? *target : values[name]) = value;
    return Status::Ok();
  }
  Status Execute(const std::string& command) override {
    executed.push_back(command);
    return Status::Ok();
  }

 private:
  FeatureValue* Find(const std::string& name) {
    for (const std::string& selector : selectors) {
      const auto chosen = values.find(selector);
      if (chosen == values.end()) continue;
      const auto* entry = std::get_if<std::string>(&chosen->second);
      const auto found = entry ? values.find(name + "[" + *entry + "]") : values.end();
      if (found != values.end()) return &found->second;
    }
    const auto found = values.find(name);
    return found == values.end() ? nullptr : &found->second;
  }
  template <typename T>
  static std::optional<T> As(const FeatureValue* value) {
    const T* held = value != nullptr ? std::get_if<T>(value) : nullptr;
    return held != nullptr ? std::optional<T>(*held) : std::nullopt;
  }
};

/// A camera with the parts Range, Intensity and Confidence, as real ones describe themselves.
inline MapFeatures ThreePartCamera() {
  using Text = std::string;
  MapFeatures f;
  f.choices["ComponentSelector"] = {{"Range", 4}, {"Intensity", 1}, {"Confidence", 6}};
  f.choices["Scan3dCoordinateSelector"] = {
      {"CoordinateA", 0}, {"CoordinateB", 1}, {"CoordinateC", 2}};
  f.choices["PixelFormat"] = {{"Coord3D_C16", 0x011000B8}, {"RGB8", 0x02180014}};
  f.values = {
      {"ComponentSelector", Text("Range")},
      {"ComponentEnable[Range]", false},
      {"ComponentEnable[Intensity]", false},
      {"ComponentEnable[Confidence]", true},
      {"ComponentIDValue[Range]", std::int64_t{4}},
      {"ComponentIDValue[Intensity]", std::int64_t{1}},
      {"ComponentIDValue[Confidence]", std::int64_t{6}},
      {"PixelFormat[Range]", Text("Coord3D_C16")},
      {"PixelFormat[Intensity]", Text("RGB8")},
      {"PixelFormat[Confidence]", Text("Confidence8")},
      {"Width", std::int64_t{640}},
      {"Height", std::int64_t{480}},
      {"Scan3dOutputMode", Text("ProjectedC")},
      {"Scan3dDistanceUnit", Text("Millimeter")},
      {"Scan3dCoordinateSelector", Text("CoordinateA")},
      {"Scan3dCoordinateScale[CoordinateA]", 1.0},
      {"Scan3dCoordinateScale[CoordinateB]", 1.0},
      {"Scan3dCoordinateScale[CoordinateC]", 0.25},
      {"Scan3dCoordinateOffset", 0.0},
      {"Scan3dInvalidDataFlag[CoordinateC]", true},
      {"Scan3dInvalidDataValue", 0.0},
      {"Scan3dFocalLength", 600.0},
      {"Scan3dAspectRatio", 1.0},
      {"Scan3dPrincipalPointU", 320.5},
      {"Scan3dPrincipalPointV", 239.5},
      {"Scan3dBaseline", 55.0},
      {"AcquisitionFrameRate", 30.0},
      {"ExposureTime", 5000.0},
      {"Gain", 3.0},
  };
  return f;
}

}  // namespace palpate::capture
