// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/calibrate/convergence_plot.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "components/calibration/joint/joint_request.hpp"
#include "components/calibration/joint/model_snapshot.hpp"
#include "components/calibration/pose/alternating_pose_calibration.hpp"
#include "components/view/plot/time_plot.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

using calibration::CalibrationFrame;

view::TimeSeries SeriesOf(const std::string& name, const view::Color& color,
                          const std::vector<double>& residual_rms_m) {
  view::TimeSeries series;
  series.name = name;
  series.color = color;
  for (const double rms_m : residual_rms_m) {
    series.t_s.push_back(static_cast<double>(series.t_s.size()));
    series.values.push_back(std::log10(1e3 * rms_m));
  }
  return series;
}

void Print(const char* method, const Status& status, const std::vector<double>& residual_rms_m) {
  if (!status.ok()) {
    fmt::print("{}: {}\n", method, status.message());
    return;
  }
  fmt::print("{}: residual {:.4g} mm RMS after {} iterations\n", method,
             1e3 * residual_rms_m.back(), residual_rms_m.size() - 1);
}

}  // namespace

void PlotConvergence(const std::vector<CalibrationFrame>& frames, robot::RobotModel* model,
                     const std::filesystem::path& file) {
  const auto chosen = std::find_if(frames.begin(), frames.end(), [](const CalibrationFrame& frame) {
    return frame.loads.empty();
  });
  if (chosen == frames.end()) {
    throw InputError(
        "--convergence: every frame has loads, which Algorithm 1 does not model; add a recording "
        "without loads");
  }
  CalibrationFrame frame = *chosen;
  frame.cables.assign(frame.cables.size(), {});
  const calibration::ModelSnapshot kept(*model);
  model->SetGravity(frame.gravity_m_s2);
  const calibration::PoseAndInputs paper = calibration::RunAlgorithm1(*model, frame.markers);
  const calibration::JointCalibration joint = calibration::CalibrateFrames(
      *model, {frame}, nullptr, {.actuator_offsets = false, .moduli = {}});
  kept.Restore();
  if (!paper.status.ok() && !joint.status.ok()) {
    throw RunError("--convergence: neither Algorithm 1 (" + paper.status.message() +
                   ") nor the joint calibration (" + joint.status.message() + ") converged");
  }
  Print("Algorithm 1", paper.status, paper.residual_rms_after_m);
  Print("joint", joint.status, joint.residual_rms_after_m);
  view::TimePlot plot;
  plot.title = "calibration of " + frame.name;
  plot.caption = "camera pose and cable tensions from markers";
  plot.time_title = "iteration";
  view::PlotPanel& panel = plot.panels.emplace_back();
  panel.value_title = "log10 of the residual RMS (mm)";
  panel.from_zero = false;
  panel.series.push_back(
      SeriesOf("the paper's Algorithm 1", view::palette::kTruth, paper.residual_rms_after_m));
  panel.series.push_back(
      SeriesOf("jointly, by Ipopt", view::palette::kEstimate, joint.residual_rms_after_m));
  view::SaveTimePlot(file, plot);
}

}  // namespace palpate::command
