// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/design/proposal.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

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
  std::vector<robot::ActuatorTraits> actuators;
  std::vector<bool> by_tension;
  std::vector<int> driven;
  Eigen::VectorXd used;  ///< [actuators] the largest command, as it is reported

  Drives(const robot::RobotBody& body, const Timeline& timeline)
      : actuators(timeline.actuators),
        by_tension(timeline.by_tension),
        used(Eigen::VectorXd::Zero(std::ssize(timeline.actuators))) {
    std::map<std::string, double> largest_of;  // of all in the same unit
    std::vector<bool> commanded(actuators.size(), false);
    for (const Eigen::VectorXd& command : timeline.command) {
      for (std::size_t c = 0; c < actuators.size(); ++c) {
        const double value = std::abs(Reported(c, command[ToIndex(c)]));
        if (std::isnan(value)) continue;
        commanded[c] = true;
        double& largest = largest_of[UnitOf(c)];
        largest = std::max(largest, value);
      }
    }
    const bool none = std::find(commanded.begin(), commanded.end(), true) == commanded.end();
    for (std::size_t c = 0; c < actuators.size(); ++c) {
      if (none || commanded[c]) driven.push_back(static_cast<int>(c));
      const double largest = largest_of[UnitOf(c)];
      used[ToIndex(c)] = largest > 0.0 ? largest : Default(body, c);
      // Of two chambers one may bear less.
      if (UnitOf(c) == "Pa") used[ToIndex(c)] = std::min(used[ToIndex(c)], MostPressure_Pa(c));
    }
  }

  std::string UnitOf(std::size_t c) const {
    return by_tension[c] ? actuators[c].force_unit() : actuators[c].displacement_unit();
  }
  double Reported(std::size_t c, double command) const {
    return by_tension[c] ? actuators[c].ReportedForce(command)
                         : actuators[c].ReportedDisplacement(command);
  }
  double MostPressure_Pa(std::size_t c) const {
    return actuators[c].ReportedForce(actuators[c].most_force_N);
  }

  double Default(const robot::RobotBody& body, std::size_t cable) const {
    constexpr double kOfSize = 0.05;
    constexpr double kOfLimit = 0.25;
    const robot::ActuatorTraits& actuator = actuators[cable];
    if (by_tension[cable]) return kOfLimit * actuator.ReportedForce(actuator.most_force_N);
    if (actuator.IsChamber()) return kOfLimit * std::pow(actuator.area_m2, 1.5);
    const Eigen::Matrix3Xd& nodes_m = body.mesh.nodes_m;
    return kOfSize * (nodes_m.rowwise().maxCoeff() - nodes_m.rowwise().minCoeff()).maxCoeff();
  }

  /// In whole steps of what is shown, not beyond.
  double Rounded(int cable, double command) const {
    constexpr double kRounding = 1e-9;
    const double step = ShownIn(cable).step;
    return std::copysign(step * std::floor(std::abs(command) / step + kRounding), command);
  }
  /// No pressure beyond what the chamber may have.
  double At(int cable, double share) const {
    const auto c = static_cast<std::size_t>(cable);
    const double command = share * used[cable];
    return Rounded(cable, UnitOf(c) == "Pa" ? std::min(command, MostPressure_Pa(c)) : command);
  }
  std::string Text(int cable, double share) const {
    const Shown shown = ShownIn(cable);
    const double steps = std::round(std::abs(At(cable, share)) / shown.step);
    return FormatNumber(steps / shown.steps_of_unit) + " " + shown.unit;
  }
  std::string Title(int cable) const { return actuators[palpate::At(cable)].Title(); }
  bool HasChambers() const {
    return std::any_of(driven.begin(), driven.end(),
                       [&](int c) { return actuators[palpate::At(c)].IsChamber(); });
  }
  /// "cables", "chambers" or "actuators": what the driven ones are.
  std::string Plural() const { return Singular() + "s"; }
  std::string Singular() const {
    const bool cables = std::any_of(driven.begin(), driven.end(),
                                    [&](int c) { return !actuators[palpate::At(c)].IsChamber(); });
    return !HasChambers() ? "cable" : cables ? "actuator" : "chamber";
  }

 private:
  /// As what a command is shown, and to how much.
  struct Shown {
    double step;           ///< in the unit of the command
    double steps_of_unit;  ///< of the unit that is shown
    std::string unit;
  };

  Shown ShownIn(int cable) const {
    const std::string unit = UnitOf(palpate::At(cable));
    if (unit == "N") return {1e-2, 1e2, "N"};
    if (unit == "Pa") return {1e2, 1e1, "kPa"};
    if (unit == "m3") return {1e-8, 1e2, "ml"};
    return {1e-4, 1e1, "mm"};
  }
};

/// Commands of a recording, knot by knot.
class Script {
 public:
  explicit Script(const Drives& drives)
      : actuators_(drives), now_(Eigen::VectorXd::Zero(std::ssize(drives.actuators))) {
    for (const int c : drives.driven) {
      const auto i = static_cast<std::size_t>(c);
      actuation_.columns.push_back({.cable = drives.actuators[i].name,
                                    .quantity = drives.by_tension[i]
                                                    ? experiment::ActuatorQuantity::kTension
                                                    : experiment::ActuatorQuantity::kDisplacement,
                                    .samples = {},
                                    .where = {},
                                    .of_chamber = drives.actuators[i].IsChamber()});
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
    const std::string name = drives.Title(c);
    proposals->push_back(
        Script(drives)
            .To({c}, kFarther, kRamp_s)
            .Stay(kDwell_s)
            .To({c}, 0.0, kRamp_s)
            .Finish(RecordingKind::kRamp, "ramp of " + name + " to " + drives.Text(c, kFarther)));
    proposals->push_back(Script(drives)
                             .To({c}, 1.0, kDwell_s)
                             .Stay(kHold_s)
                             .To({c}, 0.0, kDwell_s)
                             .Finish(RecordingKind::kHold,
                                     name + " held at " + drives.Text(c, 1.0) + " for a minute"));
  }
  if (drives.driven.empty()) return;
  Script fast(drives);
  for (const int c : drives.driven) fast.To({c}, 1.0, kFastRamp_s).To({c}, 0.0, kFastRamp_s);
  proposals->push_back(fast.Finish(
      RecordingKind::kSecondSpeed,
      "each " + drives.Singular() + " to " + drives.Text(drives.driven.front(), 1.0) +
          " and back within " + FormatNumber(2.0 * kFastRamp_s) + " s, one after the other"));
}

/// "cables north and south".
std::string PairTitle(const Drives& drives, int a, int b) {
  const robot::ActuatorTraits& one = drives.actuators[At(a)];
  const robot::ActuatorTraits& other = drives.actuators[At(b)];
  if (one.kind != other.kind) return one.Title() + " and " + other.Title();
  return (one.IsChamber() ? "chambers " : "cables ") + one.name + " and " + other.name;
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
      together({driven[a], driven[b]}, PairTitle(drives, driven[a], driven[b]));
    }
  }
  if (driven.size() > 1) together(driven, "all " + drives.Plural());
}

/// Cables commanded by tension cannot be released below zero.
void AddSlackening(const Drives& drives, std::vector<Proposal>* proposals) {
  std::vector<int> by_length;
  for (const int c : drives.driven) {
    if (!drives.by_tension[At(c)] && !drives.actuators[At(c)].IsChamber()) by_length.push_back(c);
  }
  if (by_length.empty()) return;
  proposals->push_back(Script(drives)
                           .To(by_length, -1.0, kRamp_s)
                           .Stay(kHang_s)
                           .To(by_length, 0.0, kRamp_s)
                           .Finish(RecordingKind::kRamp,
                                   "all cables let out by " + drives.Text(by_length.front(), 1.0)));
}

/// What the sensors of chambers read as zero shows where these are open.
void AddVenting(const Drives& drives, std::vector<Proposal>* proposals) {
  if (!drives.HasChambers()) return;
  Proposal open = Script(drives).Stay(kHang_s).Finish(RecordingKind::kRest,
                                                      "chambers open to the air, at rest");
  std::optional<experiment::Actuation>& actuation = open.recording.actuation;
  std::erase_if(actuation->columns, [](const auto& column) { return column.of_chamber; });
  if (actuation->columns.empty()) actuation.reset();
  open.by_hand = "take the tubes off the chambers before the recording begins";
  proposals->push_back(std::move(open));
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
    const std::string moved =
        drives.HasChambers() ? "one " + drives.Singular() + " actuated" : "a cable pulled";
    proposal.title = tilted.title + (drives.driven.empty() ? "" : ", at rest and with " + moved);
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
  AddVenting(drives, &proposals);
  AddWeights(body, drives, &proposals);
  if (!body.gravity_m_s2.isZero()) AddTilts(drives, &proposals);
  AddTiltedWeights(body, drives, &proposals);
  return proposals;
}

}  // namespace palpate::diagnosis
