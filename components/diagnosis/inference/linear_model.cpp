// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/linear_model.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"
#include "libs/linalg/gram.hpp"
#include "libs/linalg/svd.hpp"

namespace palpate::diagnosis {

namespace {

/// Rows of one recording and coordinate: what they have in common beside the noise.
struct Series {
  std::vector<int> samples;
  Eigen::VectorXd sigma_m;   ///< [samples] noise of the means
  Eigen::MatrixXd common_m;  ///< [samples x 2] of the mesh's error, of the reference's
};

/// Multiplies by (D + V V')^(-1/2).
class Whitening {
 public:
  explicit Whitening(const Series& series) : scale_(series.sigma_m.cwiseInverse()) {
    const linalg::ThinSvd svd = linalg::DecomposeSvd(scale_.asDiagonal() * series.common_m);
    along_ = svd.U;
    shrink_ = 1.0 - (1.0 + svd.values.array().square()).rsqrt();
  }

  Eigen::MatrixXd operator()(const Eigen::MatrixXd& rows) const {
    const Eigen::MatrixXd scaled = scale_.asDiagonal() * rows;
    return scaled - along_ * (shrink_.asDiagonal() * (along_.transpose() * scaled));
  }

 private:
  Eigen::VectorXd scale_;
  Eigen::MatrixXd along_;
  Eigen::VectorXd shrink_;
};

bool IsSeen(const ObservedExperiment& observed, const Simulation& simulation, std::size_t sample,
            Eigen::Index coordinate) {
  const SimulatedSample& simulated = simulation.samples[sample];
  return simulated.status.ok() && IsMeasured(observed.samples[sample], coordinate) &&
         simulated.jacobian_m.row(coordinate).allFinite();
}

/// How far a place of the surface is from where it is in the undeformed body, m.
double SurfaceDisplacement_m(const SurfaceMeasurement& surface, const SimulatedSample& simulated) {
  return (surface.point.Position(simulated.middle.state.x_m) - surface.rest_m).norm();
}

/// From where another recording was seen, other parts of the surface about a feature are in view,
/// and what its drawing is off by is not what it is there.
double SkinError_m(const ObservedExperiment& observed, int recording, const NoiseModel& noise) {
  constexpr double kFromElsewhere_m = 3e-4;
  const auto first =
      std::find_if(observed.recordings.begin(), observed.recordings.end(),
                   [](const ObservedRecording& one) { return one.T_camera_robot.has_value(); });
  const ObservedRecording& here = observed.recordings[At(recording)];
  const bool same = here.T_camera_robot->isApprox(*first->T_camera_robot, 1e-6);
  return same ? noise.skin_error_m : std::hypot(noise.skin_error_m, kFromElsewhere_m);
}

Series SeriesOf(const ObservedExperiment& observed, const Simulation& simulation, int recording,
                Eigen::Index coordinate, const Eigen::Matrix3Xd& rest_m, const NoiseModel& noise) {
  Series series;
  std::vector<double> sigma_m;
  std::vector<double> of_mesh_m;
  const Eigen::Index marker = coordinate / 3;
  const bool of_skin = marker >= rest_m.cols();
  const Eigen::Isometry3d& T_measurement_robot =
      observed.recordings[At(recording)].T_measurement_robot;
  const auto displacement_m = [&](std::size_t s) {
    const SimulatedSample& simulated = simulation.samples[s];
    if (!of_skin) {
      return (simulated.markers_m().col(marker) - T_measurement_robot * rest_m.col(marker)).norm();
    }
    const auto feature = static_cast<std::size_t>(coordinate - 3 * rest_m.cols());
    return SurfaceDisplacement_m(observed.samples[s].surface[feature], simulated);
  };
  for (std::size_t s = 0; s < observed.samples.size(); ++s) {
    const Sample& sample = observed.samples[s];
    if (sample.recording != recording || !IsSeen(observed, simulation, s, coordinate)) continue;
    series.samples.push_back(static_cast<int>(s));
    sigma_m.push_back(Sigma_m(observed, sample, coordinate));
    of_mesh_m.push_back(noise.relative_error * displacement_m(s));
  }
  series.sigma_m = Eigen::Map<Eigen::VectorXd>(sigma_m.data(), std::ssize(sigma_m));
  const bool held = observed.recordings[At(recording)].held_until_s.has_value();
  series.common_m.resize(std::ssize(sigma_m), 2);
  series.common_m.col(0) = Eigen::Map<Eigen::VectorXd>(of_mesh_m.data(), std::ssize(of_mesh_m));
  series.common_m.col(1).setConstant(of_skin ? SkinError_m(observed, recording, noise)
                                     : held  ? observed.reference_sigma_m
                                             : 0.0);
  return series;
}

}  // namespace

Information::Information(Eigen::Index parameters)
    : H(Eigen::MatrixXd::Zero(parameters, parameters)),
      b(Eigen::VectorXd::Zero(parameters)),
      about(Eigen::VectorXd::Zero(parameters)) {}

void Information::Add(const Information& other) {
  H += other.H;
  b += other.b;
  c += other.c;
  rows += other.rows;
  about = other.about;
}

Information LinearModel::All() const {
  Information all(J.cols());
  for (const Information& one : of_recording) all.Add(one);
  return all;
}

Information LinearModel::AllBut(std::size_t recording) const {
  Information some(J.cols());
  for (std::size_t k = 0; k < of_recording.size(); ++k) {
    if (k != recording) some.Add(of_recording[k]);
  }
  return some;
}

LinearModel Linearise(const ObservedExperiment& observed, const Simulation& simulation,
                      const Eigen::VectorXd& z, const Eigen::Matrix3Xd& rest_m,
                      const NoiseModel& noise) {
  const Eigen::Index coordinates = 3 * rest_m.cols() + observed.feature_rest_m.cols();
  const Eigen::Index most = std::ssize(observed.samples) * coordinates;
  LinearModel model;
  model.J.resize(most, z.size());
  model.y.resize(most);
  Eigen::Index row = 0;
  for (std::size_t r = 0; r < observed.recordings.size(); ++r) {
    const Eigen::Index first = row;
    for (Eigen::Index coordinate = 0; coordinate < coordinates; ++coordinate) {
      const Series series =
          SeriesOf(observed, simulation, static_cast<int>(r), coordinate, rest_m, noise);
      const auto count = std::ssize(series.samples);
      if (count == 0) continue;
      Eigen::MatrixXd both(count, z.size() + 1);
      for (Eigen::Index k = 0; k < count; ++k) {
        const auto s = static_cast<std::size_t>(series.samples[At(k)]);
        const SimulatedSample& simulated = simulation.samples[s];
        both.row(k).head(z.size()) = simulated.jacobian_m.row(coordinate);
        both(k, z.size()) = Measured_m(observed.samples[s], coordinate) -
                            simulated.seen_m[coordinate] +
                            simulated.jacobian_m.row(coordinate).dot(z);
        model.sample_of_row.push_back(static_cast<int>(s));
        model.coordinate_of_row.push_back(static_cast<int>(coordinate));
      }
      const Eigen::MatrixXd white = Whitening(series)(both);
      model.J.middleRows(row, count) = white.leftCols(z.size());
      model.y.segment(row, count) = white.col(z.size());
      row += count;
    }
    Information& information = model.of_recording.emplace_back(z.size());
    const auto J = model.J.middleRows(first, row - first);
    const auto y = model.y.segment(first, row - first);
    information.H = linalg::Gram(J);
    information.b.noalias() = J.transpose() * y;
    information.c = y.squaredNorm();
    information.rows = static_cast<int>(row - first);
    information.about = z;
  }
  model.J.conservativeResize(row, Eigen::NoChange);
  model.y.conservativeResize(row);
  return model;
}

}  // namespace palpate::diagnosis
