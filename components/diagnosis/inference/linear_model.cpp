// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/linear_model.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "libs/core/index.hpp"
#include "libs/core/parallel_for.hpp"
#include "libs/linalg/product.hpp"
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

/// Whitened rows of one recording, and what each is of.
struct RecordingRows {
  Eigen::MatrixXd J_y;  ///< [rows x (parameters + 1)]
  std::vector<int> samples;
  std::vector<int> coordinates;
};

RecordingRows RowsOf(const ObservedExperiment& observed, const Simulation& simulation,
                     const Eigen::VectorXd& z, const std::vector<Series>& series) {
  RecordingRows rows;
  for (std::size_t c = 0; c < series.size(); ++c) {
    rows.samples.insert(rows.samples.end(), series[c].samples.begin(), series[c].samples.end());
    rows.coordinates.insert(rows.coordinates.end(), series[c].samples.size(), static_cast<int>(c));
  }
  rows.J_y.resize(std::ssize(rows.samples), z.size() + 1);
  Eigen::Index first = 0;
  for (std::size_t c = 0; c < series.size(); ++c) {
    const auto count = std::ssize(series[c].samples);
    if (count == 0) continue;
    Eigen::MatrixXd own(count, z.size() + 1);
    const auto coordinate = ToIndex(c);
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto s = static_cast<std::size_t>(series[c].samples[At(k)]);
      const SimulatedSample& simulated = simulation.samples[s];
      own.row(k).head(z.size()) = simulated.jacobian_m.row(coordinate);
      own(k, z.size()) = Measured_m(observed.samples[s], coordinate) -
                         simulated.seen_m[coordinate] + own.row(k).head(z.size()).dot(z);
    }
    rows.J_y.middleRows(first, count) = Whitening(series[c])(own);
    first += count;
  }
  return rows;
}

Information InformationOf(const linalg::MatrixRef& J, const Eigen::Ref<const Eigen::VectorXd>& y,
                          const Eigen::VectorXd& about) {
  Information information(0);
  information.H = linalg::Gram(J);
  information.b.noalias() = J.transpose() * y;
  information.c = y.squaredNorm();
  information.rows = static_cast<int>(y.size());
  information.about = about;
  return information;
}

}  // namespace

Information::Information(Eigen::Index parameters)
    : H(Eigen::MatrixXd::Zero(parameters, parameters)),
      b(Eigen::VectorXd::Zero(parameters)),
      about(Eigen::VectorXd::Zero(parameters)) {}

void Information::Remove(const Information& part) {
  H -= part.H;
  b -= part.b;
  c -= part.c;
  rows -= part.rows;
}

void LinearModel::Sum(const Eigen::VectorXd& about) { all_ = InformationOf(J, y, about); }

Eigen::Index LinearModel::FirstRowOf(std::size_t recording) const {
  const auto end = rows_of_recording.begin() + ToIndex(recording);
  return std::accumulate(rows_of_recording.begin(), end, Eigen::Index{0});
}

Eigen::MatrixXd LinearModel::RowsOf(std::size_t recording) const {
  return J.middleRows(FirstRowOf(recording), rows_of_recording[recording]);
}

Information LinearModel::OfRecording(std::size_t recording) const {
  const Eigen::Index first = FirstRowOf(recording);
  const Eigen::Index rows = rows_of_recording[recording];
  return InformationOf(J.middleRows(first, rows), y.segment(first, rows), all_.about);
}

Information LinearModel::AllBut(std::size_t recording) const {
  Information some = all_;
  some.Remove(OfRecording(recording));
  return some;
}

LinearModel Linearise(const ObservedExperiment& observed, const Simulation& simulation,
                      const Eigen::VectorXd& z, const Eigen::Matrix3Xd& rest_m,
                      const NoiseModel& noise, int threads) {
  const Eigen::Index coordinates = 3 * rest_m.cols() + observed.feature_rest_m.cols();
  std::vector<std::vector<Series>> series(observed.recordings.size());
  LinearModel model;
  Eigen::Index all = 0;
  for (std::size_t r = 0; r < series.size(); ++r) {
    Eigen::Index rows = 0;
    for (Eigen::Index coordinate = 0; coordinate < coordinates; ++coordinate) {
      series[r].push_back(
          SeriesOf(observed, simulation, static_cast<int>(r), coordinate, rest_m, noise));
      rows += std::ssize(series[r].back().samples);
    }
    model.rows_of_recording.push_back(rows);
    all += rows;
  }
  model.J.resize(all, z.size());
  model.y.resize(all);
  model.sample_of_row.resize(static_cast<std::size_t>(all));
  model.coordinate_of_row.resize(static_cast<std::size_t>(all));
  std::vector<Eigen::Index> first_of;
  std::exclusive_scan(model.rows_of_recording.begin(), model.rows_of_recording.end(),
                      std::back_inserter(first_of), Eigen::Index{0});
  ParallelFor(series.size(), threads, [&](std::size_t r) {
    const RecordingRows rows = RowsOf(observed, simulation, z, series[r]);
    const Eigen::Index count = rows.J_y.rows();
    model.J.middleRows(first_of[r], count) = rows.J_y.leftCols(z.size());
    model.y.segment(first_of[r], count) = rows.J_y.col(z.size());
    std::copy(rows.samples.begin(), rows.samples.end(), model.sample_of_row.begin() + first_of[r]);
    std::copy(rows.coordinates.begin(), rows.coordinates.end(),
              model.coordinate_of_row.begin() + first_of[r]);
  });
  model.Sum(z);
  return model;
}

}  // namespace palpate::diagnosis
