// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

namespace palpate::diagnosis {

namespace {

/// Facets of the mesh lie off the skin, and where the camera errs less smoothly than DepthBias.
constexpr double kSigma_m = 3e-4;

/// Every feature of the skin is off along its normal by a constant of its own, in all recordings:
/// no fault.
class SkinOffset final : public FaultModel {
 public:
  explicit SkinOffset(Eigen::Index features)
      : FaultModel({"skin_offset", {"body"}}, "where the skin is drawn",
                   std::vector<FaultParameter>(
                       static_cast<std::size_t>(features),
                       {.name = "offset_m", .tolerance = kSigma_m, .fault = kSigma_m})) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->skin_offset_m += z;
  }

  void OnMeasurement(int parameter, const Eigen::VectorXd& /*z*/, const FaultContext& at,
                     Eigen::Matrix3Xd* motion_m) const override {
    if (at.target == Target::kSkin) motion_m->col(parameter) += at.sight.point(parameter).normal;
  }
};

}  // namespace

void MakeSkinOffset(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  if (!world.observed.HasSkin()) return;
  causes->push_back(std::make_unique<SkinOffset>(world.observed.feature_rest_m.cols()));
}

}  // namespace palpate::diagnosis
