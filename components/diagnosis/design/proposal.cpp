// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/design/proposal.hpp"

#include <algorithm>
#include <cmath>

#include "components/diagnosis/design/places_to_hang.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"

namespace palpate::diagnosis {

namespace {

using experiment::RecordingKind;

constexpr double kFarther = 1.25;  ///< than the largest command that was used
constexpr double kRamp_s = 4.0;
constexpr double kFastRamp_s = 0.8;
constexpr double kDwell_s = 1.0;
constexpr double kHold_s = 60.0;
constexpr double kHang_s = 4.0;
constexpr double kTilt_deg = 15.0;
constexpr int kMostPairs = 6;

/// The commands that a robot's actuators accept.
struct Drives {
  std::vector<std::string> cables;
  std::vector<bool> by_tension;
  std::vector<int> driven;
  Eigen::VectorXd used;  ///< [cables] the largest command, m or N

  Drives(const robot::RobotBody& body, const Timeline& timeline)
      : cables(timeline.cables),
        by_tension(timeline.by_tension),
        used(Eigen::VectorXd::Zero(std::ssize(timeline.cables))) {
    double largest_m = 0.0;
    double largest_N = 0.0;
    std::vector<bool> commanded(cables.size(), false);
    for (const Eigen::VectorXd& command : timeline.command) {
      for (std::size_t c = 0; c < cables.size(); ++c) {
        const double value = std::abs(command[ToIndex(c)]);
        if (std::isnan(value)) continue;
        commanded[c] = true;
        double& largest = by_tension[c] ? largest_N : largest_m;
        largest = std::max(largest, value);
      }
    }
    const bool none = std::find(commanded.begin(), commanded.end(), true) == commanded.end();
    for (std::size_t c = 0; c < cables.size(); ++c) {
      if (none || commanded[c]) driven.push_back(static_cast<int>(c));
      const double largest = by_tension[c] ? largest_N : largest_m;
      used[ToIndex(c)] = largest > 0.0 ? largest : Default(body, c);
    }
  }

  double Default(const robot::RobotBody& body, std::size_t cable) const {
    constexpr double kOfSize = 0.05;
    constexpr double kOfLimit = 0.25;
    if (by_tension[cable]) return kOfLimit * body.cables[cable].max_tension_N;
    const Eigen::Matrix3Xd& nodes_m = body.mesh.nodes_m;
    return kOfSize * (nodes_m.rowwise().maxCoeff() - nodes_m.rowwise().minCoeff()).maxCoeff();
  }

  /// In whole tenths of a millimetre, or hundredths of a newton, not beyond.
  double Rounded(int cable, double command) const {
    constexpr double kRounding = 1e-9;
    const double step = by_tension[palpate::At(cable)] ? 1e-2 : 1e-4;
    return std::copysign(step * std::floor(std::abs(command) / step + kRounding), command);
  }
  double At(int cable, double share) const { return Rounded(cable, share * used[cable]); }
  std::string Text(int cable, double share) const {
    const bool tension = by_tension[palpate::At(cable)];
    const double shown = std::abs(At(cable, share)) * (tension ? 1e2 : 1e4);
    return FormatNumber(std::round(shown) / (tension ? 1e2 : 10.0)) + (tension ? " N" : " mm");
  }
};

/// Commands of a recording, knot by knot.
class Script {
 public:
  explicit Script(const Drives& drives)
      : actuators_(drives), now_(Eigen::VectorXd::Zero(std::ssize(drives.cables))) {
    for (const int c : drives.driven) {
      const auto i = static_cast<std::size_t>(c);
      actuation_.columns.push_back({.cable = drives.cables[i],
                                    .quantity = drives.by_tension[i]
                                                    ? experiment::ActuatorQuantity::kTension
                                                    : experiment::ActuatorQuantity::kDisplacement,
                                    .samples = {},
                                    .where = {}});
    }
    Add();
  }

  /// Goes there in so long.
  Script& To(const std::vector<int>& cables, double share, double in_s) {
    for (const int c : cables) now_[c] = actuators_.At(c, share);
    return Stay(in_s);
  }
  Script& Stay(double for_s) {
    t_s_ += for_s;
    Add();
    return *this;
  }

  Proposal Finish(RecordingKind kind, const std::string& title) const {
    Proposal proposal;
    proposal.title = title;
    proposal.recording.kind = kind;
    proposal.duration_s = t_s_;
    if (!actuation_.columns.empty()) proposal.recording.actuation = actuation_;
    return proposal;
  }

 private:
  void Add() {
    actuation_.t_s.push_back(t_s_);
    for (std::size_t k = 0; k < actuators_.driven.size(); ++k) {
      actuation_.columns[k].samples.emplace_back(now_[actuators_.driven[k]]);
    }
  }

  const Drives& actuators_;
  double t_s_ = 0.0;
  Eigen::VectorXd now_;
  experiment::Actuation actuation_;
};

void AddPulls(const Drives& drives, std::vector<Proposal>* proposals) {
  for (const int c : drives.driven) {
    const std::string& name = drives.cables[At(c)];
    proposals->push_back(Script(drives)
                             .To({c}, kFarther, kRamp_s)
                             .Stay(kDwell_s)
                             .To({c}, 0.0, kRamp_s)
                             .Finish(RecordingKind::kRamp,
                                     "ramp of cable " + name + " to " + drives.Text(c, kFarther)));
    proposals->push_back(
        Script(drives)
            .To({c}, 1.0, kDwell_s)
            .Stay(kHold_s)
            .To({c}, 0.0, kDwell_s)
            .Finish(RecordingKind::kHold,
                    "cable " + name + " held at " + drives.Text(c, 1.0) + " for a minute"));
  }
  if (drives.driven.empty()) return;
  Script fast(drives);
  for (const int c : drives.driven) fast.To({c}, 1.0, kFastRamp_s).To({c}, 0.0, kFastRamp_s);
  proposals->push_back(fast.Finish(RecordingKind::kSecondSpeed,
                                   "each cable to " + drives.Text(drives.driven.front(), 1.0) +
                                       " and back within " + FormatNumber(2.0 * kFastRamp_s) +
                                       " s, one after the other"));
}

void AddCoContractions(const Drives& drives, std::vector<Proposal>* proposals) {
  const std::vector<int>& driven = drives.driven;
  const auto together = [&](const std::vector<int>& cables, const std::string& words) {
    proposals->push_back(Script(drives)
                             .To(cables, 1.0, kRamp_s)
                             .Stay(kDwell_s)
                             .To(cables, 0.0, kRamp_s)
                             .Finish(RecordingKind::kCoContraction,
                                     words + " together to " + drives.Text(cables.front(), 1.0)));
  };
  int pairs = 0;
  for (std::size_t a = 0; a < driven.size() && driven.size() > 2; ++a) {
    for (std::size_t b = a + 1; b < driven.size() && pairs < kMostPairs; ++b, ++pairs) {
      together({driven[a], driven[b]},
               "cables " + drives.cables[At(driven[a])] + " and " + drives.cables[At(driven[b])]);
    }
  }
  if (driven.size() > 1) together(driven, "all cables");
}

/// Cables commanded by tension cannot be released below zero.
void AddSlackening(const Drives& drives, std::vector<Proposal>* proposals) {
  std::vector<int> by_length;
  for (const int c : drives.driven) {
    if (!drives.by_tension[At(c)]) by_length.push_back(c);
  }
  if (by_length.empty()) return;
  proposals->push_back(Script(drives)
                           .To(by_length, -1.0, kRamp_s)
                           .Stay(kHang_s)
                           .To(by_length, 0.0, kRamp_s)
                           .Finish(RecordingKind::kRamp,
                                   "all cables let out by " + drives.Text(by_length.front(), 1.0)));
}

/// As a title, and as an instruction to a person.
struct ByHand {
  std::string title;
  std::string words;
};

ByHand Hang(const robot::RobotBody& body, const Eigen::Vector3d& place_m, Proposal* proposal) {
  const double mass_kg = MassToHang_kg(body);
  const PlannedWeight weight{
      .position_m = place_m, .mass_kg = mass_kg, .patch_radius_m = PatchToHang_m(body)};
  proposal->weight = weight;
  experiment::KnownLoad load;
  load.position_m = place_m;
  load.force_N =
      experiment::BaseRotation(proposal->recording).transpose() * (mass_kg * body.gravity_m_s2);
  load.patch_radius_m = weight.patch_radius_m;
  proposal->recording.loads = {load};
  const std::string grams = FormatNumber(std::round(1e4 * mass_kg) / 10.0) + " g";
  const std::string where = WordsForPlace(body, place_m);
  return {.title = grams + " hung " + where, .words = "hang " + grams + " " + where};
}

ByHand Tilt(int axis, Proposal* proposal) {
  const std::string angle = FormatNumber(kTilt_deg);
  const std::string about = axis == 0 ? "x" : "y";
  proposal->recording.base_tilt_deg = kTilt_deg * Eigen::Vector2d::Unit(axis);
  return {.title = "base tilted by " + angle + " degrees about " + about,
          .words = "tilt the base by " + angle + " degrees about its " + about +
                   " axis, the camera with it,"};
}

constexpr const char* kBefore = " before the recording begins";

void AddWeights(const robot::RobotBody& body, const Drives& drives,
                std::vector<Proposal>* proposals) {
  if (MassToHang_kg(body) <= 0.0) return;
  for (const Eigen::Vector3d& place_m : PlacesToHang(body)) {
    Proposal proposal = Script(drives).Stay(kHang_s).Finish(RecordingKind::kKnownLoad, "");
    const ByHand hung = Hang(body, place_m, &proposal);
    proposal.title = hung.title;
    proposal.by_hand = hung.words + kBefore;
    proposals->push_back(std::move(proposal));
  }
}

void AddTilts(const Drives& drives, std::vector<Proposal>* proposals) {
  for (const int axis : {0, 1}) {
    Script script(drives);
    script.Stay(0.5 * kHang_s);
    if (!drives.driven.empty()) {
      const int c = drives.driven[static_cast<std::size_t>(axis) % drives.driven.size()];
      script.To({c}, 1.0, kRamp_s).To({c}, 0.0, kRamp_s);
    }
    Proposal proposal = script.Finish(RecordingKind::kBaseTilted, "");
    const ByHand tilted = Tilt(axis, &proposal);
    proposal.title =
        tilted.title + (drives.driven.empty() ? "" : ", at rest and with a cable pulled");
    proposal.by_hand = tilted.words + kBefore;
    proposals->push_back(std::move(proposal));
  }
}

/// What pulls at a body turns with the tilt, and what bends it for good does not; where gravity
/// points to, the weight tells.
void AddTiltedWeights(const robot::RobotBody& body, const Drives& drives,
                      std::vector<Proposal>* proposals) {
  const std::vector<Eigen::Vector3d> places_m = PlacesToHang(body);
  if (MassToHang_kg(body) <= 0.0 || places_m.empty()) return;
  for (const int axis : {0, 1}) {
    Proposal proposal = Script(drives).Stay(kHang_s).Finish(RecordingKind::kBaseTilted, "");
    const ByHand tilted = Tilt(axis, &proposal);
    const ByHand hung = Hang(body, places_m.front(), &proposal);
    proposal.title = tilted.title + ", " + hung.title;
    proposal.by_hand = tilted.words + " and " + hung.words + kBefore;
    proposals->push_back(std::move(proposal));
  }
}

}  // namespace

std::vector<Proposal> BenchProposals(const robot::RobotBody& body,
                                     const ObservedExperiment& observed) {
  const Drives drives(body, observed.timeline);
  std::vector<Proposal> proposals;
  AddPulls(drives, &proposals);
  AddCoContractions(drives, &proposals);
  AddSlackening(drives, &proposals);
  AddWeights(body, drives, &proposals);
  if (!body.gravity_m_s2.isZero()) AddTilts(drives, &proposals);
  AddTiltedWeights(body, drives, &proposals);
  return proposals;
}

}  // namespace palpate::diagnosis
