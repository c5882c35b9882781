// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/rest_markers.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/geometry/rigid_registration.hpp"

namespace palpate::force_estimation {

namespace {

constexpr double kDegreesPerRad = 180.0 / std::numbers::pi;

std::string Short(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2g", value);
  return text.data();
}

std::string Millimetres(double length_m) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f mm", 1e3 * length_m);
  return text.data();
}

double Spread_m(const Eigen::Matrix3Xd& points_m) {
  const Eigen::Vector3d mean_m = points_m.rowwise().mean();
  return std::sqrt((points_m.colwise() - mean_m).colwise().squaredNorm().mean());
}

struct ExchangedPair {
  Eigen::Index first = 0;
  Eigen::Index second = 0;
  double rms_m = 0.0;  ///< of the rigid fit with the two labels exchanged
};

/// The pair of labels whose exchange fits best.
ExchangedPair BestExchange(const Eigen::Matrix3Xd& measured_m, Eigen::Matrix3Xd model_m,
                           double rms_m) {
  ExchangedPair best{.rms_m = rms_m};
  for (Eigen::Index a = 0; a < model_m.cols(); ++a) {
    for (Eigen::Index b = a + 1; b < model_m.cols(); ++b) {
      model_m.col(a).swap(model_m.col(b));
      const auto fit = geometry::RegisterRigid(measured_m, model_m);
      if (fit.status.ok() && fit.rms_m < best.rms_m) best = {a, b, fit.rms_m};
      model_m.col(a).swap(model_m.col(b));
    }
  }
  return best;
}

Status Differ(const std::string& what) { return {StatusCode::kInvalidInput, what}; }

Status CheckShape(const RestMarkers& markers, const geometry::Registration& fit,
                  const RestMarkersTuning& tuning) {
  const double spread_m = Spread_m(markers.model_m);
  if (const auto exchange = FindExchangedLabels(markers, tuning)) return Differ(ToText(*exchange));
  if (fit.mirrored) {
    return Differ(
        "the markers at rest are the mirror image of the robot file's: an axis is reversed, or "
        "labels are exchanged");
  }
  if (fit.rms_m <= tuning.largest_residual * spread_m) return Status::Ok();
  return Differ("the markers' shape at rest differs from the robot file's by " +
                Millimetres(fit.rms_m) + " RMS after the best rigid motion, and they lie " +
                Short(Spread_m(markers.measured_m) / spread_m) +
                " times as far apart: exchanged labels, another unit, or another robot");
}

}  // namespace

Status ReferenceMarkers(robot::RobotModel& model, ReferenceShape shape,
                        const std::vector<robot::ActuatorCommand>& cables,
                        Eigen::VectorXd* positions_m) {
  PALPATE_CHECK(shape != ReferenceShape::kNone);
  fem::StaticState state = model.RestState();
  if (shape == ReferenceShape::kEquilibrium) {
    const fem::StaticResult result = model.Solve(cables, {}, &state);
    if (!result.status.ok()) return result.status;
  }
  const auto& markers = model.body().markers;
  positions_m->resize(ToIndex(3 * markers.size()));
  for (size_t m = 0; m < markers.size(); ++m) {
    positions_m->segment<3>(ToIndex(3 * m)) = markers[m].point.weights.Position(state.x_m);
  }
  return Status::Ok();
}

std::optional<ExchangedLabels> FindExchangedLabels(const RestMarkers& markers,
                                                   const RestMarkersTuning& tuning) {
  PALPATE_CHECK(markers.measured_m.cols() == markers.model_m.cols());
  const Eigen::Index count = markers.model_m.cols();
  if (!geometry::RegisterRigid(markers.model_m, markers.model_m).status.ok()) return std::nullopt;
  const auto fit = geometry::RegisterRigid(markers.measured_m, markers.model_m);
  if (fit.rms_m <= tuning.suspicious_residual * Spread_m(markers.model_m)) return std::nullopt;
  // Any order of labels is reached by exchanging pairs, each of which fits better.
  Eigen::Matrix3Xd model_m = markers.model_m;
  std::vector<Eigen::Index> place(At(count));
  std::iota(place.begin(), place.end(), Eigen::Index{0});
  double rms_m = fit.rms_m;
  for (Eigen::Index k = 0; k < count; ++k) {
    const ExchangedPair pair = BestExchange(markers.measured_m, model_m, rms_m);
    if (!(pair.rms_m < tuning.least_gain * rms_m)) break;
    model_m.col(pair.first).swap(model_m.col(pair.second));
    std::swap(place[At(pair.first)], place[At(pair.second)]);
    rms_m = pair.rms_m;
  }
  if (!(rms_m < tuning.exchanged_residual * fit.rms_m)) return std::nullopt;
  ExchangedLabels exchange{.pairs = {}, .rms_m = fit.rms_m, .rms_exchanged_m = rms_m};
  for (Eigen::Index k = 0; k < count; ++k) {
    if (place[At(k)] == k) continue;
    exchange.pairs.emplace_back(markers.names[At(k)], markers.names[At(place[At(k)])]);
  }
  return exchange;
}

std::string ToText(const ExchangedLabels& exchange) {
  std::string names, renames;
  for (std::size_t k = 0; k < exchange.pairs.size(); ++k) {
    const auto& [label, marker] = exchange.pairs[k];
    const bool last = k + 1 == exchange.pairs.size();
    names += (k == 0 ? "'" : last ? " and '" : ", '") + label + "'";
    renames += " --rename " + label + "=" + marker;
  }
  return "the labels of markers " + names +
         " look exchanged: at rest the markers' shape differs from the robot file's by " +
         Millimetres(exchange.rms_m) + " RMS, with " +
         (exchange.pairs.size() == 2 ? "the two exchanged by " : "the right labels by ") +
         Millimetres(exchange.rms_exchanged_m) + "; exchange them (palpate import" + renames + ")";
}

Status CheckRestMarkers(const RestMarkers& markers, RestAgreement agreement,
                        const RestMarkersTuning& tuning) {
  PALPATE_CHECK(markers.measured_m.cols() == markers.model_m.cols());
  if (markers.model_m.cols() == 0) return Status::Ok();
  const Eigen::Vector3d shift_m =
      markers.measured_m.rowwise().mean() - markers.model_m.rowwise().mean();
  // Points that determine no rigid motion even without errors have no shape to compare.
  if (!geometry::RegisterRigid(markers.model_m, markers.model_m).status.ok()) return Status::Ok();
  const auto fit = geometry::RegisterRigid(markers.measured_m, markers.model_m);
  if (Status status = CheckShape(markers, fit, tuning); !status.ok()) return status;
  if (agreement == RestAgreement::kShape || !fit.status.ok()) return Status::Ok();
  const double turn_rad = Eigen::AngleAxisd(fit.T_target_source.rotation()).angle();
  const double turn_sigma_rad = std::sqrt(fit.covariance.topLeftCorner<3, 3>().trace());
  const bool turned =
      turn_rad > tuning.largest_turn_rad && turn_rad > tuning.turn_sigmas * turn_sigma_rad;
  const bool away = agreement == RestAgreement::kShapeTurnAndPlace &&
                    shift_m.norm() > tuning.largest_shift * Spread_m(markers.model_m);
  if (!turned && !away) return Status::Ok();
  return Differ("the markers at rest are off the robot file's by " + Short(shift_m.norm()) +
                " m and turned by " + std::to_string(std::lround(kDegreesPerRad * turn_rad)) +
                " degrees: they are not in the robot frame; import them with --register");
}

}  // namespace palpate::force_estimation
