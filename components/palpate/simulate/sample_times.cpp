// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/simulate/sample_times.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "libs/core/index.hpp"

namespace palpate::command {

namespace {

using scenario::RecordingPlan;

std::int64_t Nanoseconds(double t_s) { return std::llround(1e9 * t_s); }

const RecordingPlan& PlanOf(const scenario::Schedule& schedule, int recording) {
  return schedule.scenario().recordings.at(At(recording));
}

/// The samples of one recording, each once.
class Instants {
 public:
  Instants(double begin_s, double duration_s)
      : begin_s_(begin_s), duration_s_(duration_s), end_ns_(Nanoseconds(begin_s + duration_s)) {}

  Instant* At(double t_s) {
    const std::int64_t t_ns = Nanoseconds(begin_s_ + t_s);
    if (t_ns >= end_ns_) return nullptr;
    Instant& instant = instants_[t_ns];
    instant.t_ns = t_ns;
    return &instant;
  }

  template <typename Mark>
  void AtRate(double rate_hz, double delay_s, const Mark& mark) {
    for (int k = 0; delay_s + k / rate_hz < duration_s_; ++k) {
      if (Instant* instant = At(delay_s + k / rate_hz)) mark(instant);
    }
  }

  std::vector<Instant> Take() const {
    std::vector<Instant> instants;
    for (const auto& [t_ns, instant] : instants_) instants.push_back(instant);
    return instants;
  }

 private:
  double begin_s_;
  double duration_s_;
  std::int64_t end_ns_;
  std::map<std::int64_t, Instant> instants_;
};

}  // namespace

std::vector<Instant> SampleTimes(const scenario::Schedule& schedule, int recording) {
  const RecordingPlan& plan = PlanOf(schedule, recording);
  const scenario::Scenario& scenario = schedule.scenario();
  Instants instants(schedule.Begin_s(recording), plan.duration_s);
  instants.At(0.0);
  if (scenario.markers) {
    instants.AtRate(scenario.markers->rate_hz, 0.0, [](Instant* at) { at->markers = true; });
  }
  if (scenario.TakesPictures()) {
    instants.AtRate(scenario.camera->rate_hz, 0.0, [](Instant* at) { at->cameras.push_back(0); });
    for (std::size_t k = 0; k < scenario.further_cameras.size(); ++k) {
      const scenario::FurtherCamera& camera = scenario.further_cameras[k];
      instants.AtRate(camera.rate_hz, camera.delay_s,
                      [k](Instant* at) { at->cameras.push_back(k + 1); });
    }
  }
  for (const scenario::CommandRow& row : plan.commands.rows) instants.At(row.t_s);
  for (const scenario::HungWeight& weight : plan.weights) instants.At(weight.t_s);
  for (const scenario::ToolPath& path : plan.tool_paths) {
    for (const scenario::Waypoint& waypoint : path.waypoints) instants.At(waypoint.t_s);
  }
  return instants.Take();
}

std::vector<Instant> RestTimes(const scenario::Schedule& schedule, int recording) {
  const double rest_s = schedule.scenario().rest_between_s;
  const double begin_s = schedule.Begin_s(recording) - rest_s;
  Instants instants(begin_s, rest_s);
  for (const double share : {0.0, 0.5}) instants.At(share * rest_s);
  return instants.Take();
}

scenario::BenchInputs InputsAt(const scenario::Schedule& schedule, int recording,
                               const Instant& instant) {
  return schedule.InputsAt(std::max(instant.t_s(), schedule.Begin_s(recording)));
}

}  // namespace palpate::command
