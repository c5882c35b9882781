// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

namespace palpate::diagnosis {

namespace {

/// Of each coefficient, as a share of the distance: stereo cameras err by 0.2 to 0.5 % of it. The
/// constant is beside what DepthScale allows.
constexpr double kSigma = 0.003;
constexpr double kSigmaOfConstant = 0.002;
/// Over what a camera sees from several places, a finer one than over a robot that stays in the
/// middle of its picture.
constexpr geometry::DepthBiasBasis kBasis{.order = 4, .span = 0.4};

/// Depth that is off by a smooth share over the picture, as every depth camera's is: no fault.
class DepthBias final : public FaultModel {
 public:
  explicit DepthBias(const geometry::DepthBiasBasis& basis)
      : FaultModel({"depth_bias", {"camera"}}, "smooth error of the depth", Coefficients(basis)),
        basis_(basis) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->camera.bias_basis = basis_;
    hypothesis->camera.bias = z;
  }

  void OnMeasurement(int parameter, const Eigen::VectorXd& /*z*/, const FaultContext& at,
                     Eigen::Matrix3Xd* motion_m) const override {
    for (Eigen::Index k = 0; k < motion_m->cols(); ++k) {
      motion_m->col(k) += at.sight.camera->ByBias(at.sight.point(k), basis_, parameter);
    }
  }

 private:
  static std::vector<FaultParameter> Coefficients(const geometry::DepthBiasBasis& basis) {
    std::vector<FaultParameter> coefficients;
    for (const std::string& name : NamesOf(basis)) {
      const double sigma = coefficients.empty() ? kSigmaOfConstant : kSigma;
      coefficients.push_back({.name = name, .tolerance = sigma, .fault = sigma});
    }
    return coefficients;
  }

  geometry::DepthBiasBasis basis_;
};

}  // namespace

void MakeDepthBias(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  if (!world.observed.HasSkin()) return;
  causes->push_back(std::make_unique<DepthBias>(kBasis));
}

}  // namespace palpate::diagnosis
