// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/watch/snapshot_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "libs/core/utc_text.hpp"

namespace palpate::command {

namespace {

// A line that is older than this says so.
constexpr double kOld_s = 2.0;

/// " (reason)"; empty where there is none.
std::string InBrackets(const std::string& reason) {
  return reason.empty() ? std::string() : " (" + reason + ")";
}

std::string Ms(double seconds) { return fmt::format("{:.0f} ms", 1e3 * seconds); }

std::string FlowText(const monitor::TopicFlow& flow) {
  if (flow.silence_s > kOld_s) return fmt::format("no message for {:.1f} s", flow.silence_s);
  std::string text = fmt::format("{:.1f}/s", flow.rate_hz);
  if (flow.lost > 0) text += fmt::format(", {} of {} lost", flow.lost, flow.received + flow.lost);
  return text;
}

std::string ForceLine(const monitor::ForceState& force) {
  const Eigen::Vector3d at_mm = 1e3 * force.position_m;
  std::string size = force.force_N.allFinite()
                         ? fmt::format("{:8.3f} +- {:.3f} N", force.force_N.norm(), force.ci95_N)
                         : "       ? N";
  std::string place =
      fmt::format("at ({:.0f}, {:.0f}, {:.0f}) mm", at_mm.x(), at_mm.y(), at_mm.z());
  if (force.location_ci95_m > 0.0) {
    place += fmt::format(" +- {:.0f} mm", 1e3 * force.location_ci95_m);
  }
  return fmt::format("  {:<16} {:<20} {:<34} {}{}\n", force.name, size, place, force.status,
                     InBrackets(force.reason));
}

std::string ForcesText(const monitor::SystemSnapshot& snapshot) {
  if (!snapshot.forces) return "FORCES       no message on /forces\n";
  const monitor::ForcesState& state = *snapshot.forces;
  std::string text = fmt::format("FORCES       {}{}; {}", state.status, InBrackets(state.reason),
                                 FlowText(state.flow));
  text += fmt::format("; age {}, of it estimation {}\n", Ms(state.age_s), Ms(state.latency_s));
  for (const monitor::ForceState& force : state.forces) text += ForceLine(force);
  if (state.forces.empty()) text += "  none\n";
  return text;
}

std::string ModelErrorText(const monitor::SystemSnapshot& snapshot) {
  if (!snapshot.model_error) return {};
  const monitor::ModelErrorState& state = *snapshot.model_error;
  return fmt::format("MODEL ERROR  {}residual {:.2f} mm, noise {:.2f} mm, {} samples; {}\n",
                     state.judgement.empty() ? "" : state.judgement + "; ",
                     1e3 * state.residual_rms_m, 1e3 * state.noise_rms_m, state.samples,
                     FlowText(state.flow));
}

std::string PerceptionText(const monitor::SystemSnapshot& snapshot) {
  if (!snapshot.perception) return {};
  const monitor::PerceptionState& state = *snapshot.perception;
  std::string text =
      fmt::format("PERCEPTION   {}{}; {} robot points, {} object points, {} contacts; {}; {}\n",
                  state.status, InBrackets(state.reason), state.robot_points, state.object_points,
                  state.contacts, FlowText(state.flow), Ms(state.latency_s));
  for (const std::string& note : state.notes) text += "  note: " + note + "\n";
  return text;
}

std::string CameraText(const monitor::SystemSnapshot& snapshot) {
  if (!snapshot.camera) return {};
  const monitor::CameraState& state = *snapshot.camera;
  return fmt::format(
      "CAMERA       {} (epoch {}); {}; {:.0f} % of the pixels have depth; {} frames failed, {} "
      "dropped; {} packets lost\n",
      state.device, state.epoch, FlowText(state.flow), 1e2 * state.valid_ratio, state.frames_failed,
      state.frames_dropped, state.packets_lost);
}

std::string CablesText(const monitor::SystemSnapshot& snapshot) {
  if (!snapshot.cables) return {};
  const std::vector<monitor::CableValue>& all = snapshot.cables->cables;
  const auto chambers =
      std::count_if(all.begin(), all.end(), [](const auto& value) { return value.is_chamber; });
  const bool mixed = chambers > 0 && chambers < std::ssize(all);
  std::string text = mixed ? "ACTUATORS    " : chambers > 0 ? "CHAMBERS     " : "CABLES       ";
  text += FlowText(snapshot.cables->flow);
  for (const monitor::CableValue& cable : all) {
    text += "; " + cable.name;
    if (cable.is_chamber) {
      if (std::isfinite(cable.displacement_m)) {
        text += fmt::format(" {:+.2f} cm3", 1e6 * cable.displacement_m);
      }
      if (std::isfinite(cable.tension_N))
        text += fmt::format(" {:.2f} kPa", 1e-3 * cable.tension_N);
      continue;
    }
    if (std::isfinite(cable.displacement_m)) {
      text += fmt::format(" {:.1f} mm", 1e3 * cable.displacement_m);
    }
    if (std::isfinite(cable.tension_N)) text += fmt::format(" {:.2f} N", cable.tension_N);
  }
  return text + "\n";
}

std::string MeshText(const monitor::SystemSnapshot& snapshot) {
  if (!snapshot.mesh) return {};
  return fmt::format("MESH STATE   {}; {}\n", snapshot.mesh->status, FlowText(snapshot.mesh->flow));
}

std::string CalibrationText(const monitor::SystemSnapshot& snapshot) {
  if (!snapshot.calibration) return {};
  const monitor::CalibrationState& state = *snapshot.calibration;
  std::string text = "CALIBRATION  " + state.state;
  if (state.frames_wanted > 0) {
    text += fmt::format(", {} of {} frames", state.frames_taken, state.frames_wanted);
  }
  return text + InBrackets(state.reason) + "\n";
}

std::string ProcessLine(const monitor::ProcessState& process) {
  const std::string status =
      process.IsSilent() ? fmt::format("silent {:.0f} s", process.silence_s) : process.status;
  std::string line = fmt::format(
      "  {:<17} {:<16} {:>7.1f} {:>7.1f} {:>7.1f} {:>8.1f} {:>9} {:>9} {:>8} {:>8} {:>8.0f}\n",
      process.name, status, process.input_rate_hz, process.output_rate_hz,
      1e3 * process.latency_mean_s, 1e3 * process.latency_max_s, process.received,
      process.published, process.dropped, process.refused, process.uptime_s);
  if (process.restarts > 0) line += fmt::format("    restarts seen: {}\n", process.restarts);
  if (!process.reason.empty()) line += "    " + process.reason + "\n";
  if (!process.waiting_for.empty()) line += "    " + process.waiting_for + "\n";
  return line;
}

std::string ProcessesText(const monitor::SystemSnapshot& snapshot) {
  std::string text = fmt::format(
      "PROCESSES\n  {:<17} {:<16} {:>7} {:>7} {:>7} {:>8} {:>9} {:>9} {:>8} {:>8} {:>8}\n", "",
      "status", "in/s", "out/s", "mean ms", "max ms", "received", "published", "dropped", "refused",
      "uptime s");
  for (const monitor::ProcessState& process : snapshot.processes) text += ProcessLine(process);
  return text;
}

std::string ClocksText(const monitor::SystemSnapshot& snapshot) {
  std::string text;
  for (const monitor::ClockState& clock : snapshot.clocks) {
    text +=
        fmt::format("{}{} is {:.1f} ms {} {}, +- {:.1f} ms", text.empty() ? "CLOCKS       " : "; ",
                    clock.other_host, 1e3 * std::abs(clock.offset_s),
                    clock.offset_s < 0.0 ? "behind" : "ahead of", clock.host, 1e3 * clock.bound_s);
  }
  return text.empty() ? text : text + "\n";
}

std::string OthersText(const monitor::SystemSnapshot& snapshot) {
  if (snapshot.others.empty()) return {};
  std::string text = "OTHER DIAGNOSTICS\n";
  for (const monitor::OtherDiagnosis& other : snapshot.others) {
    text += fmt::format("  {:<34} {:<8} {} ({:.0f} s ago)\n", other.name, other.level,
                        other.message, other.silence_s);
  }
  return text;
}

}  // namespace

std::string SnapshotText(const monitor::SystemSnapshot& snapshot) {
  std::string text = fmt::format("palpate watch, domain {}, {}\n", snapshot.domain_id,
                                 UtcTextOfNs(snapshot.time_ns));
  if (snapshot.processes.empty()) {
    text += fmt::format(
        "no palpate process in domain {}: start one there, or give its domain with --domain\n",
        snapshot.domain_id);
    if (!snapshot.forces) return text + OthersText(snapshot);
  }
  text += ForcesText(snapshot) + ModelErrorText(snapshot) + MeshText(snapshot) +
          PerceptionText(snapshot) + CameraText(snapshot) + CablesText(snapshot) +
          CalibrationText(snapshot) + ClocksText(snapshot);
  if (!snapshot.processes.empty()) text += ProcessesText(snapshot);
  return text + OthersText(snapshot);
}

}  // namespace palpate::command
