// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

namespace palpate::diagnosis {

namespace {

/// px, of each of the two.
constexpr double kSigma_px = 0.05;

/// Interpolation between whole pixels pulls the disparities of a stereo camera towards some of
/// them, so that depth errs by a wave whose length is one pixel of disparity (M. Shimizu and M.
/// Okutomi, Precise sub-pixel estimation on area-based matching, ICCV 2001): no fault. Half a metre
/// away it is some tenths of a millimetre, and goes up and down as the body moves by some
/// millimetres.
class StereoRipple final : public FaultModel {
 public:
  StereoRipple()
      : FaultModel({"stereo_ripple", {"camera"}}, "sub-pixel error of the depth",
                   {Wave("cosine_px"), Wave("sine_px")}) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->camera.ripple_px += z;
  }

  void OnMeasurement(int parameter, const Eigen::VectorXd& /*z*/, const FaultContext& at,
                     Eigen::Matrix3Xd* motion_m) const override {
    if (at.target != Target::kSkin) return;
    for (Eigen::Index f = 0; f < motion_m->cols(); ++f) {
      const SkinSighting& feature = at.seen().skin[static_cast<std::size_t>(f)];
      if (feature.count == 0) continue;
      motion_m->col(f) +=
          feature.ripple_m_px[parameter] / feature.normal.squaredNorm() * feature.normal;
    }
  }

 private:
  static FaultParameter Wave(const std::string& name) {
    return {.name = name, .tolerance = kSigma_px, .fault = kSigma_px};
  }
};

}  // namespace

void MakeStereoRipple(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  const auto& recordings = world.observed.recordings;
  const bool stereo = std::any_of(recordings.begin(), recordings.end(),
                                  [](const auto& one) { return one.stereo_px_m > 0.0; });
  if (stereo && world.observed.HasSkin()) causes->push_back(std::make_unique<StereoRipple>());
}

}  // namespace palpate::diagnosis
