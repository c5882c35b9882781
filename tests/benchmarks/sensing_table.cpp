// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/benchmarks/sensing_table.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "tests/benchmarks/sensing_sets.hpp"

namespace palpate::benchmarks {

namespace {

constexpr int kQuantityWidth = 42;

struct Column {
  const char* head;
  const char* counter;
  int width;
  int digits;
};

const std::vector<Column> kColumns = {{"forces", "forces", 8, 0},
                                      {"found %", "found_percent", 9, 0},
                                      {"mean %", "error_mean_percent", 8, 1},
                                      {"median %", "error_median_percent", 10, 1},
                                      {"max %", "error_largest_percent", 8, 1},
                                      {"place mm", "location_median_mm", 10, 1},
                                      {"max mm", "location_largest_mm", 8, 1},
                                      {"dir deg", "direction_mean_deg", 9, 1},
                                      {"max deg", "direction_largest_deg", 9, 1},
                                      {"F in ci", "force_coverage_percent", 9, 0},
                                      {"x in ci", "location_coverage_percent", 9, 0},
                                      {"NEES", "nees_per_degree", 7, 2},
                                      {"from", "nees_lowest", 6, 2},
                                      {"to", "nees_highest", 6, 2},
                                      {"in C", "within_ellipsoid_percent", 6, 0},
                                      {"frames", "frames", 8, 0},
                                      {"false", "false_alarms", 7, 0},
                                      {"failed", "failed_frames", 8, 0},
                                      {"from N", "found_from_N", 8, 2}};

std::string Figure(const Result& result, const std::string& counter, int digits) {
  const auto found = result.counters.find(counter);
  if (found == result.counters.end()) return "-";
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << found->second;
  return text.str();
}

bool IsOfFrames(const std::string& name, const Result& result) {
  return result.ok() && name.rfind("sensing/", 0) == 0 && result.counters.contains("frames");
}

void PrintHead(std::ostream& out) {
  out << R"(
Force estimation from depth images against the virtual bench.
Held contacts: |F| and location. Each force counts in each frame; a missed one errs by 100 % and has no
location. Mean direction error of observable estimates. Share of forces and locations inside their 95 %
intervals. NEES over its degrees of freedom, mean over the contacts, the range that true covariances give
(95 %), and the share of forces inside their 95 % ellipsoids.
All frames, moving contacts included: false forces, and frames without an estimate. Smallest rising true
force from which on it was found (median).

)" << std::left
      << std::setw(kQuantityWidth) << "set" << std::right;
  for (const Column& column : kColumns) out << std::setw(column.width) << column.head;
  out << '\n';
}

void PrintAccuracy(std::ostream& out, const Results& results) {
  bool has_head = false;
  for (const auto& [name, result] : results.all()) {
    if (!IsOfFrames(name, result)) continue;
    if (!has_head) PrintHead(out);
    has_head = true;
    out << std::left << std::setw(kQuantityWidth) << name << std::right;
    for (const Column& column : kColumns) {
      out << std::setw(column.width) << Figure(result, column.counter, column.digits);
    }
    out << '\n';
    if (result.counters.contains("smallest_force_N")) {
      out << "Smallest force that would be found at rest, median over the features in view: "
          << Figure(result, "smallest_force_N", 3) << " N\n";
    }
  }
}

void PrintWeight(std::ostream& out, int of_mN, double found_mN) {
  out << std::setw(11) << std::fixed << std::setprecision(0) << found_mN << std::setw(7)
      << std::setprecision(1) << 100.0 * (found_mN - of_mN) / of_mN << " %";
}

void PrintWeights(std::ostream& out, const Results& results) {
  std::vector<const Result*> found;
  for (const char* name : {"whole/weights_searched", "ideal_perception/weights_given",
                           "ideal_perception/weights_searched"}) {
    found.push_back(results.Find(std::string("sensing/") + name));
  }
  if (std::count(found.begin(), found.end(), nullptr) == std::ssize(found)) return;
  out << R"(
Weights hung on the tip, mN. The paper (Table III): a real robot, the contact seen. Ours: the virtual
bench, no tool in sight, so that the force is searched; or its place is given, as a contact seen.

weight           the paper       whole, searched   ideal cloud, given  ideal cloud, searched
)";
  for (std::size_t w = 0; w < kTableWeights_mN.size(); ++w) {
    const int of_mN = kTableWeights_mN[w];
    out << std::setw(6) << of_mN;
    PrintWeight(out, of_mN, kTableComputed_mN[w]);
    for (const Result* result : found) {
      if (result == nullptr) {
        out << std::setw(20) << "-";
      } else {
        PrintWeight(out, of_mN, result->Counter("weight_" + std::to_string(of_mN) + "_mN"));
      }
    }
    out << '\n';
  }
}

void PrintCosts(std::ostream& out, const Results& results) {
  const Result* result = results.Find("sensing/frame_costs");
  if (result == nullptr || !result->ok()) return;
  out << R"(
Processor time of the estimator for a frame, 51 feature points, four contacts in view one after the
other, and to prepare the next one once its forces are out; linearisations (each with a
factorisation) before that.

contact         median ms    mean ms     p99 ms   worst ms   prepare ms   linearisations
)";
  for (const std::string kind : {"held", "moving", "jump"}) {
    out << std::left << std::setw(14) << kind << std::right;
    for (const char* figure : {"_median_ms", "_mean_ms", "_p99_ms", "_worst_ms"}) {
      out << std::setw(11) << Figure(*result, kind + figure, 1);
    }
    out << std::setw(13) << Figure(*result, kind + "_after_mean_ms", 1);
    out << std::setw(17) << Figure(*result, kind + "_linearisations", 2) << '\n';
  }
  out << "Held, with 12 feature points: median " << Figure(*result, "held_few_points_median_ms", 1)
      << " ms; 51 cost " << Figure(*result, "held_ratio", 2) << " times as much\n";
  out << "From nothing to the whole force between two frames: an estimate in frame "
      << Figure(*result, "jump_frames_to_estimate", 0) << " (median), none within ten for "
      << Figure(*result, "jumps_without_estimate", 0) << " of the four\n";
}

void PrintBounds(std::ostream& out, const Results& results) {
  for (const std::string set : {"one_visible", "two_visible", "one_hidden"}) {
    const Result* result = results.Find("sensing/bound/" + set);
    if (result == nullptr || !result->ok()) continue;
    out << "\nBound of |F| (Cramer-Rao, one sigma, % of |F|), " << set << ", "
        << Figure(*result, "contacts", 0) << " contacts: median "
        << Figure(*result, "whole_median_percent", 1) << ", mean "
        << Figure(*result, "whole_mean_percent", 1) << ", largest "
        << Figure(*result, "whole_largest_percent", 1)
        << "; above 10 %: " << Figure(*result, "beyond_10_percent", 0) << "; median by noise alone "
        << Figure(*result, "noise_median_percent", 1) << ", with the place known "
        << Figure(*result, "at_place_median_percent", 1) << '\n';
  }
}

}  // namespace

void PrintSensing(std::ostream& out, const Results& results) {
  PrintCosts(out, results);
  PrintAccuracy(out, results);
  PrintBounds(out, results);
  PrintWeights(out, results);
}

}  // namespace palpate::benchmarks
