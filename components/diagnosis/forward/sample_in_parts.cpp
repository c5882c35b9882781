// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/sample_in_parts.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace palpate::diagnosis {

namespace {

/// Which cables pull, and whether the body is at an obstacle.
std::vector<bool> WhatHolds(const HeldShape& shape, int cables) {
  std::vector<bool> holds{shape.AtObstacle()};
  for (const double tension_N : shape.state.multipliers_N.head(cables)) {
    holds.push_back(tension_N > HeldShape::kNothing_N);
  }
  return holds;
}

/// Whether cables begin or cease to slide in the course of a sample: then no part stands for
/// another. `friction` [eyelets that rub].
bool TurnsRound(const std::vector<SamplePart>& parts, const Eigen::VectorXd& friction) {
  constexpr double kLittle = 0.01;  // of CableFriction::Signed
  return std::any_of(parts.begin(), parts.end(), [&](const SamplePart& part) {
    const Eigen::VectorXd& first = parts.front().sliding;
    return part.sliding.size() > 0 &&
           (part.sliding - first).cwiseProduct(friction).cwiseAbs().maxCoeff() > kLittle;
  });
}

/// One sample of a motion.
class SampleInParts {
 public:
  SampleInParts(const Sample& sample, const std::vector<SamplePart>& parts,
                const HistoryVariables& history_variables, SampleSolver* solver)
      : sample_(sample), parts_(parts), past_(history_variables), solver_(*solver) {}

  /// All parts, one from another.
  void SolveAll(SimulatedSample* simulated) {
    const std::size_t middle = parts_.size() / 2;
    SimulatedSample solved;
    solved.middle = simulated->middle;
    Eigen::VectorXd mean_m;
    std::vector<robot::EyeletSlides> slides;
    std::map<std::vector<bool>, std::vector<HeldShape>> by_what_holds;
    std::map<std::size_t, HistoryInput> of_part;
    const bool turns_round = TurnsRound(parts_, solver_.FrictionOfEyelets());
    const bool chosen_anew = !simulated->turns_round || !turns_round;
    const int choices = simulated->choices + (chosen_anew ? 1 : 0);
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      Solve(k, &solved);
      if (k == middle || !solved.status.ok()) {
        *simulated = solved;
        simulated->in_the_middle = solver_.HistoryInputAt(past_, solved);
      }
      if (!solved.status.ok()) return;
      if (k == middle || turns_round) AddSlides(k, solved.middle, &slides);
      if (TellsAnEnd(k)) of_part[k] = solver_.HistoryInputAt(past_, solved);
      if (k == 0) mean_m = Eigen::VectorXd::Zero(solved.seen_m.size());
      mean_m += parts_[k].share * solved.seen_m;
      by_what_holds[WhatHolds(solved.middle, Cables())].emplace_back(solved.middle).share =
          parts_[k].share;
    }
    simulated->bend_m = mean_m - simulated->seen_m;
    simulated->seen_m = std::move(mean_m);
    simulated->parts = parts_.size();
    simulated->choices = choices;
    simulated->turns_round = turns_round;
    simulated->slides = std::move(slides);
    KeepOthers(by_what_holds, simulated);
    FindEnds(of_part, simulated);
  }

  /// The middle and the shapes beside it. False: what holds them is another than it was.
  bool SolveShapes(SimulatedSample* simulated) {
    SimulatedSample middle = Resolved(simulated->middle);
    if (!IsHeldAs(simulated->middle, middle)) return false;
    // Without friction only which way eyelets slide matters, and that stays.
    if (!simulated->slides.empty() && solver_.FrictionOfEyelets().isZero(0.0)) {
      middle.slides = simulated->slides;
    } else {
      AddSlides(middle.middle.part, middle.middle, &middle.slides);
    }
    Eigen::VectorXd mean_m = simulated->seen_m;
    const auto move = [&](const HeldShape& from, const HeldShape& to) {
      mean_m += from.share * (to.seen_m - from.seen_m);
    };
    move(simulated->middle, middle.middle);
    for (const HeldShape& was : simulated->beside) {
      SimulatedSample beside = Resolved(was);
      if (!IsHeldAs(was, beside)) return false;
      move(was, beside.middle);
      middle.beside.push_back(std::move(beside.middle));
    }
    Memorise(*simulated, &middle);
    middle.bend_m = mean_m - middle.seen_m;
    middle.seen_m = std::move(mean_m);
    middle.parts = simulated->parts;
    middle.choices = simulated->choices;
    *simulated = std::move(middle);
    return true;
  }

  /// The middle, about which the markers' mean lies as it did.
  void SolveMiddle(SimulatedSample* simulated) {
    SimulatedSample middle = Resolved(simulated->middle);
    middle.slides = std::move(simulated->slides);
    Memorise(*simulated, &middle);
    middle.middle.share = 1.0;
    middle.bend_m = std::move(simulated->bend_m);
    middle.bend_is_own = false;
    middle.parts = simulated->parts;
    middle.choices = simulated->choices;
    if (middle.status.ok()) middle.seen_m += middle.bend_m;
    *simulated = std::move(middle);
  }

 private:
  int Cables() const { return solver_.model().CableCount(); }
  void Solve(std::size_t part, SimulatedSample* solved) {
    solver_.SetSliding(parts_[part].sliding);
    solver_.Solve(sample_, parts_[part].taken_in, past_, solved);
    solved->middle.part = part;
    solved->middle.seen_m = solved->seen_m;
  }

  void AddSlides(std::size_t part, const HeldShape& shape,
                 std::vector<robot::EyeletSlides>* slides) {
    robot::EyeletSlides of_part = solver_.SlidesAboutShape(shape);
    of_part.t_s = parts_[part].t_s;
    if (of_part.IsKnown()) slides->push_back(std::move(of_part));
  }

  /// A shape of a robot that was a little different.
  SimulatedSample Resolved(const HeldShape& was) {
    SimulatedSample solved;
    solved.middle = was;
    Solve(was.part, &solved);
    return solved;
  }

  /// Of a motion's first and last sample the two parts at its beginning and at its end.
  bool TellsAnEnd(std::size_t part) const {
    const bool at_begin = sample_.begins_piece && part < 2;
    return parts_.size() > 1 && (at_begin || (sample_.ends_piece && part + 3 > parts_.size()));
  }

  /// Carried on from the last two parts to where the piece begins or ends.
  void FindEnds(const std::map<std::size_t, HistoryInput>& of_part,
                SimulatedSample* simulated) const {
    if (parts_.size() < 2) return;
    const std::size_t last = parts_.size() - 1;
    if (sample_.begins_piece) {
      simulated->at_ends[0] = CarriedOn(of_part, 1, 0, sample_.piece_begin_s);
    }
    if (sample_.ends_piece) {
      simulated->at_ends[1] = CarriedOn(of_part, last - 1, last, sample_.piece_end_s);
    }
  }

  HistoryInput CarriedOn(const std::map<std::size_t, HistoryInput>& of_part, std::size_t from,
                         std::size_t over, double to_s) const {
    constexpr double kFarthest = 2.0;
    const double step_s = parts_[over].t_s - parts_[from].t_s;
    const auto beyond = static_cast<float>(std::min(kFarthest, (to_s - parts_[over].t_s) / step_s));
    const HistoryInput& a = of_part.at(from);
    const HistoryInput& b = of_part.at(over);
    return {b.elastic_Pa + beyond * (b.elastic_Pa - a.elastic_Pa),
            (b.energy_J_m3 + beyond * (b.energy_J_m3 - a.energy_J_m3)).cwiseMax(0.0F)};
  }

  /// What is memorable in the middle; where the piece begins and ends it has grown alike since
  /// `was`, and what it changed by beside that is the same.
  void Memorise(const SimulatedSample& was, SimulatedSample* now) {
    now->in_the_middle = solver_.HistoryInputAt(past_, *now);
    const HistoryInput& before = was.in_the_middle;
    const HistoryInput& after = now->in_the_middle;
    const float held = before.elastic_Pa.squaredNorm();
    const float grown =
        held > 0.0F ? before.elastic_Pa.cwiseProduct(after.elastic_Pa).sum() / held : 1.0F;
    for (std::size_t k = 0; k < was.at_ends.size(); ++k) {
      const HistoryInput& end = was.at_ends[k];
      if (end.elastic_Pa.size() == 0) continue;
      now->at_ends[k].elastic_Pa =
          grown * end.elastic_Pa + after.elastic_Pa - grown * before.elastic_Pa;
      now->at_ends[k].energy_J_m3 = end.energy_J_m3.cwiseProduct(
          after.energy_J_m3.binaryExpr(before.energy_J_m3, [](float a, float b) {
            constexpr float kMost = 4.0F;  // of elements that held next to nothing
            return b > 0.0F ? std::min(kMost, a / b) : 1.0F;
          }));
    }
  }

  bool IsHeldAs(const HeldShape& was, const SimulatedSample& solved) const {
    const int cables = Cables();
    return solved.status.ok() && WhatHolds(solved.middle, cables) == WhatHolds(was, cables);
  }

  /// Beside the middle: shapes that are held by something else.
  void KeepOthers(const std::map<std::vector<bool>, std::vector<HeldShape>>& by_what_holds,
                  SimulatedSample* simulated) const {
    const std::vector<bool> in_the_middle = WhatHolds(simulated->middle, Cables());
    simulated->middle.share = 1.0;
    for (const auto& [what, shapes] : by_what_holds) {
      if (what == in_the_middle) continue;
      HeldShape& one = simulated->beside.emplace_back(shapes[shapes.size() / 2]);
      one.share = 0.0;
      for (const HeldShape& shape : shapes) one.share += shape.share;
      simulated->middle.share -= one.share;
    }
  }

  const Sample& sample_;
  const std::vector<SamplePart>& parts_;
  const HistoryVariables& past_;
  SampleSolver& solver_;
};

/// Whether no shape is so near an obstacle that the body may touch it elsewhere in the sample.
bool IsClearOfObstacles(const SampleSolver& solver, const SimulatedSample& simulated) {
  return !solver.IsNearObstacle(simulated.middle.state) &&
         std::none_of(simulated.beside.begin(), simulated.beside.end(),
                      [&](const HeldShape& one) { return solver.IsNearObstacle(one.state); });
}

}  // namespace

void SolveInParts(const Sample& sample, const std::vector<SamplePart>& parts,
                  const HistoryVariables& history_variables, Detail detail, SampleSolver* solver,
                  SimulatedSample* simulated) {
  SampleInParts motion(sample, parts, history_variables, solver);
  const bool is_known = simulated->status.ok() && simulated->parts == parts.size();
  if (is_known && detail == Detail::kMiddles) {
    motion.SolveMiddle(simulated);
    return;
  }
  const bool may_keep =
      is_known && detail == Detail::kParts && simulated->bend_is_own && !simulated->turns_round &&
      !TurnsRound(parts, solver->FrictionOfEyelets()) && IsClearOfObstacles(*solver, *simulated);
  if (!may_keep || !motion.SolveShapes(simulated)) motion.SolveAll(simulated);
}

}  // namespace palpate::diagnosis
