// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "components/force_estimation/shape/shape_config.hpp"
#include "components/force_estimation/shape/surface_matching.hpp"
#include "components/force_estimation/shape/temporal_correlation.hpp"
#include "libs/core/status.hpp"
#include "libs/geometry/depth_bias_map.hpp"

namespace palpate::force_estimation {

struct DepthBiasTuning {
  /// Surface points seen in the contact-free frames. Fewer: a bias that is mostly prior.
  int fewest_features = 3;
  /// Prior of the correlation of successive frames.
  double prior_correlation = kFrameCorrelation;
  /// Weight of the prior of noise and correlation, in residuals. Larger: the noise model is trusted
  /// for longer; smaller: few frames give a random noise scale.
  double prior_residuals = 10.0;
  /// Prior sigma (half-normal) of the error of a surface point's offset in a single posture, over
  /// that of the offset, and the values of it that are compared, up to four prior sigmas. Larger:
  /// few postures that agree say less; smaller: few that disagree are trusted.
  double posture_share = 0.3;
  int posture_errors = 20;
};

/// Constant difference of one camera's cloud and the model without contact: a depth bias of low
/// order over the image (a share of z), a small error of the camera pose, and an offset of each
/// surface point (facets of the mesh, texture). One linear least-squares problem with priors: what
/// the frames do not determine stays at zero with the prior's uncertainty. A shift of the camera
/// resembles a depth bias: their sum is known better than either.
///
/// Where a calibration has estimated the map together with the camera pose, both and their joint
/// covariance are the prior. It may come from the very frames that are learnt: prior and frames are
/// joined by covariance intersection with equal shares, which holds whatever they have in common.
///
/// Frames come in sequences, one posture each. The bias belongs to the shape of the first frame. Of
/// other shapes the model errs by a share of the motion since then. What the sequences disagree by
/// beyond that and noise is an error of each posture, of those to come as well. Its variance is the
/// posterior mean, by the marginal likelihood.
///
/// Scatter and correlation over time of a sequence's frames about each surface point's own mean
/// give the information of a frame. Correlation is that of a first-order process.
class DepthBias {
 public:
  DepthBias(int feature_count, const ShapeConfig& config, const DepthBiasTuning& tuning = {});

  /// From a calibration, for frames whose T_robot_camera is its. Before the first frame. The map is
  /// known then, with its covariance.
  void StartFrom(const geometry::DepthBiasMap& map, const Eigen::Isometry3d& T_robot_camera);

  /// Matches of one contact-free frame, found about an equilibrium `x_m` [3n] of the model. Frames
  /// in the order of time; those without a match do not count. Another `sequence` than that of the
  /// frame before begins a sequence.
  void Learn(std::span<const correspondence::FeatureMatch> matches, const Eigen::VectorXd& x_m,
             const Eigen::Isometry3d& T_robot_camera, std::uint32_t sequence = 0);
  /// Solves for the parameters; more frames and another call improve them. kNoCalibration where too
  /// few surface points were seen and no calibration gave the map.
  Status Finish();

  /// Where neither frames nor a calibration gave the map: the parameters that the points share,
  /// over their prior sigmas, from a fit together with forces; the map stays unknown.
  /// CorrectionSigma_m is from now on that of the points' own offsets: the shared uncertainty
  /// (ScaledBasis) is the caller's.
  void SetShared(const Eigen::VectorXd& shared);
  Eigen::VectorXd Shared() const { return solution_.head(shared_count_); }

  int frames() const { return frames_; }
  bool known() const { return known_; }

  /// To be subtracted from target_m of a match, m. Of a point that is not matched, only its own
  /// offset.
  double Correction_m(int feature, const correspondence::FeatureMatch& match,
                      const Eigen::Isometry3d& T_robot_camera) const;
  /// Sigma of that correction, m; before Finish that of the priors.
  double CorrectionSigma_m(int feature, const correspondence::FeatureMatch& match,
                           const Eigen::Isometry3d& T_robot_camera) const;
  /// Derivative of a match's residual to each independent parameter that the points share, which
  /// the prior gives a sigma of 1, m.
  Eigen::VectorXd ScaledBasis(const correspondence::FeatureMatch& match,
                              const Eigen::Isometry3d& T_robot_camera) const;
  /// Residual of a match about `x_m` [3n], less the mean of the prior, m.
  double PriorResidual_m(const correspondence::FeatureMatch& match, const Eigen::VectorXd& x_m,
                         const Eigen::Isometry3d& T_robot_camera) const;
  /// Scatter of single frames about the correction, over their sigma_m: 1 where the noise model is
  /// right, and before Finish.
  double NoiseScale() const { return noise_scale_; }

 private:
  /// One feature over the frames of a sequence. Sums of residuals, each over its sigma_m; sums over
  /// the frames' variances, for means that weigh by them.
  struct Series {
    int count = 0;
    double sum = 0.0;
    double sum_squares = 0.0;
    int neighbours = 0;  ///< pairs of frames that follow each other
    double sum_products = 0.0;
    int last_frame = 0;
    double last = 0.0;
    double weight = 0.0;
    double weighted_residual = 0.0;
    double weighted_motion = 0.0;    ///< since the first frame
    Eigen::VectorXd weighted_basis;  ///< [shared] of the scaled parameters
  };
  using Sequence = std::vector<Series>;  ///< [features]
  /// Normal equations of the parameters, with what the likelihood takes of the rows alone.
  struct Equations {
    Eigen::MatrixXd information;  ///< [p x p]
    Eigen::VectorXd right_side;   ///< [p]
    double rows = 0.0;
  };

  /// Derivative of a match's residual to each parameter that the points share: camera
  /// shift (3, m) and turn (3, rad), camera frame, about its centre; then the coefficients of the
  /// map.
  Eigen::VectorXd SharedBasis(const correspondence::FeatureMatch& match,
                              const Eigen::Isometry3d& T_robot_camera) const;
  void SetPrior();
  void Reset();
  static void AddToSeries(double residual_over_sigma, int frame, Series* series);
  void LearnNoise();
  double VarianceOf_m2(const Series& series, double posture_m) const;
  double PostureError_m() const;
  Equations EquationsOf(double posture_m) const;
  static double LogLikelihood(const Equations& equations);

  int feature_count_;
  ShapeConfig config_;
  DepthBiasTuning tuning_;
  geometry::DepthBiasBasis basis_;
  int shared_count_;
  Eigen::VectorXd prior_mean_;  ///< [shared]
  Eigen::MatrixXd prior_root_;  ///< [shared square] L of the prior's covariance L L'
  int frames_ = 0;
  bool known_ = false;
  bool is_calibrated_ = false;  ///< the prior is a calibration's
  bool shared_is_given_ = false;
  double noise_scale_ = 1.0;
  double posture_m_ = 0.0;  ///< error of an offset in a single posture, one sigma
  double correlation_;      ///< of a frame with the next
  std::vector<Sequence> sequences_;
  std::uint32_t last_sequence_ = 0;
  Eigen::VectorXd first_x_m_;   ///< [3n] of the first frame
  Eigen::VectorXd solution_;    ///< [p]; p = shared + features
  Eigen::MatrixXd covariance_;  ///< [p x p]
};

}  // namespace palpate::force_estimation
