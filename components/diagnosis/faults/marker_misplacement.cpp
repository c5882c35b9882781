// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>

#include "components/diagnosis/faults/makers.hpp"

#include "libs/core/index.hpp"
#include "libs/fem/embedding.hpp"
#include "libs/robot/sensitivity/eyelet_gradient.hpp"

namespace palpate::diagnosis {

namespace {

/// A marker sits elsewhere on the body than its file says; it moves along with what it sits on.
class MarkerMisplacement final : public FaultModel {
 public:
  MarkerMisplacement(const robot::BodyMarker& marker, int index, const fem::PointLocator& locator)
      : FaultModel({"marker_misplacement", {"marker:" + marker.name}},
                   "place of marker " + marker.name, {Component(), Component(), Component()}),
        index_(index) {
    for (int axis = 0; axis < 3; ++axis) {
      along_.push_back(robot::EyeletWeightsAlong(locator, marker.point.rest_m, 0.0,
                                                 Eigen::Vector3d::Unit(axis)));
    }
  }

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->marker_offset_m.col(index_) += z;
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              robot::CalibrationFile* /*calibration*/) const override {
    robot->markers[At(index_)].position_m += z;
    return true;
  }

  void OnView(int parameter, const Eigen::VectorXd& /*z*/, const FaultContext& at,
              Eigen::Matrix3Xd* motion_m) const override {
    if (at.target != Target::kMarkers) return;
    const auto recording = static_cast<std::size_t>(at.seen().recording);
    motion_m->col(index_) += at.hypothesis.T_seen[recording].linear() *
                             along_[At(parameter)].Position(at.shape.state.x_m);
  }

  std::vector<FittedParameter> Report(const Eigen::VectorXd& z, const Eigen::MatrixXd& covariance,
                                      const Eigen::VectorXd& /*undeformed_m*/) const override {
    return {SizeOf("d_m", z, covariance)};
  }

 private:
  static FaultParameter Component() {
    constexpr double kTolerance_m = 1e-3;  // of its length
    return {.name = "d_m",
            .tolerance = kTolerance_m / std::sqrt(3.0),
            .fault = 5e-3,
            .component = true};
  }

  Eigen::Index index_;
  std::vector<fem::InterpolationWeights> along_;  ///< [axes] derivative of its weights, 1/m
};

}  // namespace

void MakeMarkerMisplacement(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  const bool only_skin =
      inputs.observed.HasSurface() &&
      std::all_of(inputs.observed.samples.begin(), inputs.observed.samples.end(),
                  [](const Sample& sample) { return (sample.count.array() == 0).all(); });
  if (only_skin) return;
  const fem::PointLocator locator(inputs.body.mesh);
  for (std::size_t m = 0; m < inputs.body.markers.size(); ++m) {
    faults->push_back(
        std::make_unique<MarkerMisplacement>(inputs.body.markers[m], static_cast<int>(m), locator));
  }
}

}  // namespace palpate::diagnosis
