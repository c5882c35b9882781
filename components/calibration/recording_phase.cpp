// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/recording_phase.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "libs/core/index.hpp"
#include "libs/experiment/recording_inputs.hpp"

namespace palpate::calibration {

namespace {

/// Larger values take slow motions for static phases.
struct RecordingPhaseTuning {
  double still_m = 1e-5;   ///< range of a displacement without motion
  double still_N = 1e-3;   ///< range of a tension without motion
  double still_m3 = 1e-9;  ///< the same of a chamber's volume
  double still_Pa = 20.0;  ///< and of its pressure
};
constexpr RecordingPhaseTuning kPhaseTuning;

robot::DeadLoad ToDeadLoad(const experiment::KnownLoad& load, const robot::RobotModel& model) {
  const fem::SurfacePatch patch = model.Patch(load.position_m, load.patch_radius_m);
  experiment::RequireOnBody(load, patch.distance_m);
  return {patch.weights, load.force_N};
}

/// In the unit of the column.
double StillBelow(const experiment::ActuatorColumn& column) {
  const bool by_force = column.quantity == experiment::ActuatorQuantity::kTension;
  if (column.of_chamber) return by_force ? kPhaseTuning.still_Pa : kPhaseTuning.still_m3;
  return by_force ? kPhaseTuning.still_N : kPhaseTuning.still_m;
}

}  // namespace

bool CablesAreStill(const experiment::Recording& recording) {
  if (!recording.actuation) return true;
  for (const experiment::ActuatorColumn& column : recording.actuation->columns) {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (const std::optional<double>& sample : column.samples) {
      if (!sample) continue;
      least = std::min(least, *sample);
      most = std::max(most, *sample);
    }
    if (most - least > StillBelow(column)) return false;
  }
  return true;
}

std::vector<experiment::TimeWindow> WindowsOf(const experiment::Recording& recording,
                                              int most_frames) {
  if (recording.steady_window_s) return {*recording.steady_window_s};
  const auto& frames = recording.markers->frames;
  const bool loads_change =
      !recording.loads.empty() && recording.loads.front().t_s != recording.loads.back().t_s;
  if (CablesAreStill(recording) && !loads_change) return {{frames.front().t_s, frames.back().t_s}};
  std::vector<experiment::TimeWindow> times;
  const auto count = std::min(frames.size(), static_cast<std::size_t>(most_frames));
  for (std::size_t k = 0; k < count; ++k) {
    const double t_s = frames[count == 1 ? 0 : k * (frames.size() - 1) / (count - 1)].t_s;
    times.push_back({t_s, t_s});
  }
  return times;
}

std::vector<robot::ActuatorCommand> CablesAt(const experiment::Recording& recording,
                                             const robot::RobotModel& model,
                                             robot::CableInput preferred, double t_s) {
  using Quantity = experiment::ActuatorQuantity;
  std::vector<robot::ActuatorCommand> commands;
  for (int c = 0; c < model.ActuatorCount(); ++c) {
    const std::string& name = model.traits(c).name;
    commands.push_back(model.CommandFor(
        c, experiment::ActuatorInputAt(recording, name, Quantity::kDisplacement, t_s),
        experiment::ActuatorInputAt(recording, name, Quantity::kTension, t_s), preferred));
  }
  return commands;
}

std::vector<robot::DeadLoad> LoadsAt(const experiment::Recording& recording,
                                     const robot::RobotModel& model, double t_s) {
  std::vector<robot::DeadLoad> loads;
  for (const experiment::KnownLoad& load : experiment::LoadsAt(recording.loads, t_s)) {
    loads.push_back(ToDeadLoad(load, model));
  }
  return loads;
}

std::vector<LoadPlace> LoadPlacesAt(const experiment::Recording& recording, double t_s) {
  std::vector<LoadPlace> places;
  for (const experiment::KnownLoad& load : experiment::LoadsAt(recording.loads, t_s)) {
    places.push_back({load.position_m, load.patch_radius_m});
  }
  return places;
}

}  // namespace palpate::calibration
