// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/unit_guess.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "libs/core/error.hpp"
#include "libs/geometry/box.hpp"

namespace palpate::command {

namespace {

constexpr std::array<const char*, 3> kUnits = {"mm", "m", "cm"};
/// Soft robots in the literature are 20 mm (fingers) to 1 m (trunks) long; few are outside.
constexpr double kTypical_m = 0.15;
constexpr double kShortest_m = 0.02;
constexpr double kLongest_m = 1.0;

/// Cost of a length: 0 for a typical one, 1 at the ends of the range, in the logarithm.
double Strangeness(double length_m) {
  const double half_range = 0.5 * std::log(kLongest_m / kShortest_m);
  return std::abs(std::log(length_m / kTypical_m)) / half_range;
}

}  // namespace

double MetresPerUnit(const std::string& unit) {
  if (unit == "m") return 1.0;
  if (unit == "cm") return 1e-2;
  if (unit == "mm") return 1e-3;
  throw InputError("'" + unit + "' is no unit of a mesh: m, cm or mm");
}

std::string LengthText(double length_m) {
  return std::abs(length_m) < 1.0 ? fmt::format("{:.3g} mm", 1e3 * length_m)
                                  : fmt::format("{:.3g} m", length_m);
}

Decision DecideUnit(const SourceMesh& source, const std::string& given) {
  const auto& mesh = source.mesh;
  const geometry::Box box = geometry::BoundingBox(mesh.nodes_m(Eigen::all, mesh.cells.reshaped()));
  const double length = (box.upper_m - box.lower_m).maxCoeff();
  const auto in_unit = [&](const std::string& unit) {
    return LengthText(length * MetresPerUnit(unit));
  };
  Decision decision{.what = "unit", .value = {}, .why = {}, .option = "--unit"};
  if (!given.empty()) {
    decision.value = given;
    decision.trust = Trust::kGiven;
    decision.why = "the body is " + in_unit(given) + " long";
    return decision;
  }
  if (!source.unit.empty()) {
    decision.value = source.unit;
    decision.trust = Trust::kNamed;
    decision.why = "the file says '" + source.unit_comment + "'; the body is then " +
                   in_unit(source.unit) + " long";
    return decision;
  }
  // Drawings in cm are rare: they must fit clearly better.
  constexpr double kRare = 0.5;
  constexpr double kClearly = 0.5;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  double least = kNone, second = kNone;
  for (const std::string unit : kUnits) {
    const double cost = Strangeness(length * MetresPerUnit(unit)) + (unit == "cm" ? kRare : 0.0);
    second = std::min(second, std::max(cost, least));
    if (cost >= least) continue;
    least = cost;
    decision.value = unit;
  }
  decision.trust = least <= 1.0 && second - least >= kClearly && decision.value != "cm"
                       ? Trust::kLikely
                       : Trust::kUnsure;
  decision.why = fmt::format("the body is {:.4g} long in the file: {} as mm, {} as cm, {} as m",
                             length, in_unit("mm"), in_unit("cm"), in_unit("m"));
  return decision;
}

}  // namespace palpate::command
