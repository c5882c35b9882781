// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/vocabulary/number_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "libs/plot/axis_ticks.hpp"

namespace palpate::diagnosis {

namespace {

using plot::FixedText;

constexpr const char* kUnknownText = "not known";
constexpr const char* kComputed = "computed";

/// Decimals that show `digits` significant digits of a value.
int DecimalsFor(double value, int digits) {
  if (!std::isfinite(value) || value == 0.0) return digits - 1;
  return std::clamp(digits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value)))), 0, 12);
}

/// How the end of a parameter's name is shown. The first that fits counts.
struct Unit {
  const char* ending;
  const char* shown;
  double factor;
};
constexpr std::array<Unit, 11> kUnits = {{{"_rad_Nm", "rad/(N m)", 1.0},
                                          {"_rad_m", "rad/m", 1.0},
                                          {"_N_m", "N/m", 1.0},
                                          {"_m_N", "mm/N", 1e3},
                                          {"_kg", "g", 1e3},
                                          {"_deg", "deg", 1.0},
                                          {"_rad", "rad", 1.0},
                                          {"_px", "px", 1.0},
                                          {"_m", "mm", 1e3},
                                          {"_N", "N", 1.0},
                                          {"_s", "s", 1.0}}};

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string WithUnit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

}  // namespace

std::string NumberText(double value, int digits) {
  return std::isfinite(value) ? FixedText(value, DecimalsFor(value, digits)) : kUnknownText;
}

std::string MillimetreText(double value_m) { return NumberText(1e3 * value_m, 2); }

std::string LengthText(double value_m) {
  return std::isfinite(value_m) ? MillimetreText(value_m) + " mm" : kUnknownText;
}

std::string ProbabilityText(double probability) {
  if (!std::isfinite(probability)) return kUnknownText;
  if (probability < 0.001) return "< 0.001";
  return FixedText(probability, probability < 0.01 ? 3 : 2);
}

std::string PercentText(double share) {
  return std::isfinite(share) ? FixedText(100.0 * share, 0) + " %" : kUnknownText;
}

ParameterText DescribeParameter(const FittedParameter& parameter) {
  ParameterText text{.name = parameter.name, .unit = {}, .value = {}, .interval = {}, .whole = {}};
  double factor = 1.0;
  const auto unit = std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& one) {
    return parameter.name.ends_with(one.ending) && parameter.name != one.ending;
  });
  if (unit != kUnits.end()) {
    text.name.resize(text.name.size() - std::string(unit->ending).size());
    text.unit = unit->shown;
    factor = unit->factor;
  }
  text.name = Replaced(Replaced(text.name, "_over_", "/"), "_", " ");

  const double value = factor * parameter.value;
  const double low = factor * parameter.ci95_low, high = factor * parameter.ci95_high;
  const double half = 0.5 * (high - low);
  if (!std::isfinite(value) || !std::isfinite(half) || !(half > 0.0)) {
    text.value = NumberText(value, 3);
    text.interval = half == 0.0 ? kComputed : kUnknownText;
    text.whole = text.name + " = " + WithUnit(text.value, text.unit);
    return text;
  }
  // A half-width that begins with 1 is too coarse with one digit.
  const double leading = half / std::pow(10.0, std::floor(std::log10(half)));
  const int decimals = DecimalsFor(half, leading < 1.95 ? 2 : 1);
  text.value = FixedText(value, decimals);
  text.interval = FixedText(low, decimals) + " to " + FixedText(high, decimals);
  const bool lopsided = std::abs(0.5 * (low + high) - value) > 0.15 * half;
  text.whole =
      text.name + " = " +
      (lopsided ? WithUnit(text.value, text.unit) + ", " + text.interval
                : WithUnit(text.value + " \u00B1 " + FixedText(half, decimals), text.unit));
  return text;
}

}  // namespace palpate::diagnosis
