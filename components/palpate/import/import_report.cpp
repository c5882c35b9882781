// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/import/import_report.hpp"

#include <fmt/core.h>

#include <cmath>
#include <vector>

#include "libs/core/statistics.hpp"
#include "libs/experiment/capture_edit.hpp"

namespace palpate::command {

using experiment::CapturedMarkers;
using experiment::MeasurementFrame;
using experiment::TimeWindow;

namespace {

/// More digits would say more than a second of noise does.
double TwoDigits(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::round(value / unit) * unit;
}

std::optional<Eigen::Vector3d> NoiseOf(const experiment::CaptureQuality& quality) {
  Eigen::Vector3d noise_m;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> known_m;
    for (const auto& marker : quality.markers) {
      if (marker.noise_m) known_m.push_back((*marker.noise_m)[axis]);
    }
    if (known_m.empty() || !(Median(known_m) > 0.0)) return std::nullopt;
    noise_m[axis] = TwoDigits(Median(known_m));
  }
  return noise_m;
}

}  // namespace

std::optional<Eigen::Vector3d> PrintQuality(const CapturedMarkers& captured,
                                            const experiment::Recording& recording,
                                            std::ostream& report) {
  std::optional<TimeWindow> window = recording.steady_window_s;
  if (!window && recording.reference) window = recording.reference->window_s;
  const auto quality = experiment::AssessCapture(captured, window);
  const auto& frames = captured.tracks.frames;
  report << fmt::format(
      "{} markers, {} frames at {:g} Hz, {:.2f} s to {:.2f} s, {} frames missing\n",
      quality.markers.size(), frames.size(), captured.rate_Hz, frames.front().t_s,
      frames.back().t_s, quality.missing_frames);
  report << fmt::format("static noise from {:.2f} s to {:.2f} s{}\n",
                        quality.noise_window_s.begin_s, quality.noise_window_s.end_s,
                        window ? "" : " (the quietest)");
  for (const auto& marker : quality.markers) {
    report << fmt::format("  {:<16} seen {}, gaps {}", marker.name, marker.seen, marker.gaps);
    if (marker.residual_m) {
      report << fmt::format(", residual {:.3f} mm", 1e3 * *marker.residual_m);
    }
    if (marker.noise_m) {
      const Eigen::Vector3d noise_um = 1e6 * *marker.noise_m;
      report << fmt::format(", noise {:.1f} {:.1f} {:.1f} um", noise_um.x(), noise_um.y(),
                            noise_um.z());
    }
    report << '\n';
  }
  return NoiseOf(quality);
}

void PrintNoise(const experiment::Experiment& settings, std::ostream& report) {
  if (settings.markers_sigma_m) {
    const Eigen::Vector3d sigma_um = 1e6 * *settings.markers_sigma_m;
    report << fmt::format("markers_sigma_m of experiment.yaml: {:.3g} {:.3g} {:.3g} um\n",
                          sigma_um.x(), sigma_um.y(), sigma_um.z());
  } else {
    report << "noise is not known: write markers_sigma_m to experiment.yaml\n";
  }
}

void PrintFrame(const ImportOptions& options, const experiment::Recording& recording,
                std::ostream& report) {
  if (recording.frame == MeasurementFrame::kCamera) {
    report << (recording.T_robot_camera
                   ? "measurement frame: the capture's own, with its pose in the robot's frame\n"
                   : "measurement frame: the capture's own; its pose in the "
                     "robot's frame is not known: give --axes, --register "
                     "or --pose\n");
  } else if (!options.axes.empty()) {
    report << "measurement frame: the robot's axes only; the origin is the file's, so only "
              "displacements from a "
              "rest window are meaningful\n";
  }
}

}  // namespace palpate::command
