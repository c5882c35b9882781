// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "components/force_estimation/fit/force_newton.hpp"
#include "components/force_estimation/shape/camera_biases.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "components/force_estimation/shape/shape_site.hpp"
#include "components/force_estimation/shape/surface_matching.hpp"
#include "components/force_estimation/shape/texture_motion.hpp"

namespace palpate::force_estimation {

struct ShapeTargetsTuning {
  /// Radius of a surface point's share of the surface: a contact closer than this dents it. Larger:
  /// fewer points have their full weight; smaller: dents bias the force.
  double feature_reach_m = 6e-3;
  /// Change of a robust weight, as a share of the full one, that asks for another fit. Smaller:
  /// more fits in a frame.
  double changed_weight = 0.2;
  /// Mean square of residual over sigma up to which outliers are recognised. Larger: where the
  /// shape is still far away, points on the robot lose weight.
  double near_chi_squared = 4.0;
};

/// The matched surface points, a row for each camera that sees one, as rows of the fit: targets
/// without the constant bias; weights from the depth noise, the uncertainty of the bias and the
/// model error (a share of the displacement since the bias was estimated); lower near contacts, and
/// for outliers. After them two rows for each match of texture, weighted likewise.
class ShapeTargets {
 public:
  ShapeTargets(const ShapeConfig& config, double contact_weight,
               const ShapeTargetsTuning& tuning = {});

  /// `x_m` [3n] the model's present shape, `bias_x_m` the shape in which the bias was
  /// estimated.
  void Build(const std::vector<correspondence::FeatureMatch>& matches,
             const std::vector<TextureMatch>& texture, const CameraBiases& bias,
             const CameraPoses& poses, const Eigen::VectorXd& x_m, const Eigen::VectorXd& bias_x_m,
             const std::vector<ShapeSite>& sites);
  /// Huber's weights for the residuals at a shape, where that is near enough to recognise outliers.
  void WeighAt(const Eigen::VectorXd& x_m);
  /// Huber's weights for these residuals of the rows; true where one has changed much.
  bool Reweight(const Eigen::VectorXd& residual_m);

  int Count() const { return targets_.rows; }
  /// The first rows: those along normals, which the depth bias shifts. The others are texture's.
  int AlongNormals() const { return along_normals_; }
  const std::vector<robot::ObservationRow>& rows() const { return rows_; }
  const RowTargets& targets() const { return targets_; }
  const std::vector<int>& features() const { return features_; }  ///< [rows] feature of each
  /// [rows] a number below MostRows() for what each measures: the same in all frames for a feature
  /// and a camera. Of a row along a normal it is the index in the matches.
  const std::vector<std::size_t>& matched() const { return matched_; }
  std::size_t MostRows() const { return most_rows_; }
  const Eigen::VectorXd& sigma_m() const { return sigma_m_; }  ///< [rows] before robust weights
  /// [rows] the part of it that differs from frame to frame: the depth noise.
  const Eigen::VectorXd& noise_m() const { return noise_m_; }

 private:
  void AddMatches(const std::vector<correspondence::FeatureMatch>& matches);
  void AddTexture(const std::vector<TextureMatch>& texture, std::size_t match_count);
  void Weigh(Eigen::Index row, double constant_m, bool is_near);

  ShapeConfig config_;
  ShapeTargetsTuning tuning_;
  double contact_weight_;
  std::vector<robot::ObservationRow> rows_;
  std::vector<int> features_;
  std::vector<std::size_t> matched_;
  int along_normals_ = 0;
  std::size_t most_rows_ = 0;
  RowTargets targets_;
  Eigen::VectorXd sigma_m_;
  Eigen::VectorXd noise_m_;
  Eigen::VectorXd full_weight_;  ///< [rows] without Huber's
};

}  // namespace palpate::force_estimation
