// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/calibrated_pressure_sensor.hpp"

#include <cmath>

#include "libs/core/config_reader.hpp"
#include "libs/core/text.hpp"

namespace palpate::robot {

namespace {

/// A gain of -1 would read every pressure as one and the same.
constexpr NumberRule kGainRule{.min = -1.0, .min_open = true};

double ValueOf(const std::optional<CalibratedNumber>& number) {
  return number ? number->value : 0.0;
}

/// `value` and its error, where one of both found it.
std::optional<CalibratedNumber> Joined(double value, const std::optional<CalibratedNumber>& before,
                                       const std::optional<CalibratedNumber>& found) {
  if (!before && !found) return std::nullopt;
  return CalibratedNumber{value, found ? found->standard_error : before->standard_error};
}

std::string Format(const std::string& key, const std::string& error_key,
                   const std::optional<CalibratedNumber>& number) {
  if (!number) return {};
  return ", " + key + ": " + FormatNumber(number->value) + ", " + error_key + ": " +
         FormatNumber(number->standard_error);
}

std::optional<CalibratedNumber> ReadFound(MapReader* map, const char* key, const char* error_key) {
  if (map->Optional(key) == nullptr) return std::nullopt;
  CalibratedNumber number;
  map->Read(key, &number.value);
  map->Read(error_key, &number.standard_error);
  return number;
}

bool IsEstimate(const std::optional<CalibratedNumber>& number) {
  return !number || (std::isfinite(number->value) && std::isfinite(number->standard_error) &&
                     number->standard_error >= 0.0);
}

}  // namespace

double CalibratedPressureSensor::Pressure_Pa(double reading_Pa) const {
  return (1.0 + ValueOf(gain)) * reading_Pa + ValueOf(zero_Pa);
}

CalibratedPressureSensor Compose(const CalibratedPressureSensor& before,
                                 const CalibratedPressureSensor& found) {
  const double zero_Pa = found.Pressure_Pa(ValueOf(before.zero_Pa));
  const double gain = (1.0 + ValueOf(before.gain)) * (1.0 + ValueOf(found.gain)) - 1.0;
  return {.chamber = found.chamber,
          .zero_Pa = Joined(zero_Pa, before.zero_Pa, found.zero_Pa),
          .gain = Joined(gain, before.gain, found.gain)};
}

const KeyTable& PressureSensorKeys() {
  static const KeyTable keys{
      .title = "pressure sensor",
      .about =
          "How the pressure of a chamber is read: pressure = (1 + `gain`) x reading + "
          "`zero_Pa`. At least one of both is there; one that the data do not determine is "
          "absent, and `undetermined` says why.",
      .keys = {{"chamber", value::Text(), kRequired, "Name of the chamber."},
               {"zero_Pa", value::Real(), kOptional, "Pressure where the sensor reads 0."},
               {"zero_standard_error_Pa", value::Real(kNonNegative), RequiredFor("`zero_Pa`"),
                "Its standard error."},
               {"gain", value::Real(kGainRule), kOptional, "Relative error of the gain."},
               {"gain_standard_error", value::Real(kNonNegative), RequiredFor("`gain`"),
                "Its standard error."}}};
  return keys;
}

CalibratedPressureSensor ReadPressureSensor(const ConfigNode& node) {
  MapReader map(node, PressureSensorKeys());
  CalibratedPressureSensor sensor;
  map.Read("chamber", &sensor.chamber);
  sensor.zero_Pa = ReadFound(&map, "zero_Pa", "zero_standard_error_Pa");
  sensor.gain = ReadFound(&map, "gain", "gain_standard_error");
  map.Finish();
  if (!sensor.zero_Pa && !sensor.gain) Refuse(node, "must hold zero_Pa or gain");
  return sensor;
}

std::string FormatPressureSensors(const std::vector<CalibratedPressureSensor>& sensors) {
  if (sensors.empty()) return {};
  std::string text = "pressure_sensors:\n";
  for (const CalibratedPressureSensor& sensor : sensors) {
    text += "  - {chamber: " + Quoted(sensor.chamber) +
            Format("zero_Pa", "zero_standard_error_Pa", sensor.zero_Pa) +
            Format("gain", "gain_standard_error", sensor.gain) + "}\n";
  }
  return text;
}

Status CheckPressureSensor(const CalibratedPressureSensor& sensor) {
  const bool is_one = (sensor.zero_Pa || sensor.gain) && IsEstimate(sensor.zero_Pa) &&
                      IsEstimate(sensor.gain) && ValueOf(sensor.gain) > -1.0;
  if (is_one) return Status::Ok();
  return {StatusCode::kInvalidInput, "the pressure sensor of chamber '" + sensor.chamber +
                                         "' has no zero or gain, or a value that cannot be"};
}

}  // namespace palpate::robot
