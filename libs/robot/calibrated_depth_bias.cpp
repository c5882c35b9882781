// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/calibrated_depth_bias.hpp"

#include <vector>

#include "libs/core/config_reader.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/linalg/symmetric_eigen.hpp"

namespace palpate::robot {

namespace {

using geometry::DepthPicture;

constexpr int kPoseRows = 6;
constexpr int kMostPixels = 1 << 16;
constexpr int kHighestOrder = 4;

const KeyTable& PictureKeys() {
  static const KeyTable keys{
      .title = "image of the depth bias",
      .about = "The depth images that the bias belongs to.",
      .keys = {{"width_px", value::WholeNumber(1, kMostPixels), kRequired, "Width."},
               {"height_px", value::WholeNumber(1, kMostPixels), kRequired, "Height."},
               {"fx_px", value::Real(kPositive), kRequired, "Focal length along u."},
               {"fy_px", value::Real(kPositive), kRequired, "Focal length along v."},
               {"cx_px", value::Real(), kRequired, "Principal point, u."},
               {"cy_px", value::Real(), kRequired, "Principal point, v."}}};
  return keys;
}

DepthPicture ReadPicture(const ConfigNode& node) {
  MapReader map(node, PictureKeys());
  DepthPicture picture;
  map.Read("width_px", &picture.width_px);
  map.Read("height_px", &picture.height_px);
  map.Read("fx_px", &picture.fx_px);
  map.Read("fy_px", &picture.fy_px);
  map.Read("cx_px", &picture.cx_px);
  map.Read("cy_px", &picture.cy_px);
  map.Finish();
  return picture;
}

std::string Format(const DepthPicture& picture) {
  return "{width_px: " + std::to_string(picture.width_px) +
         ", height_px: " + std::to_string(picture.height_px) +
         ", fx_px: " + FormatNumber(picture.fx_px) + ", fy_px: " + FormatNumber(picture.fy_px) +
         ", cx_px: " + FormatNumber(picture.cx_px) + ", cy_px: " + FormatNumber(picture.cy_px) +
         "}";
}

/// Rounding of the file may leave eigenvalues just below 0.
bool IsCovariance(const Eigen::MatrixXd& matrix) {
  constexpr double kRounding = 1e-9;
  const Eigen::VectorXd variance = matrix.diagonal();
  if ((variance.array() < 0.0).any()) return false;
  const Eigen::VectorXd over_sigma =
      (variance.array() > 0.0).select(variance.cwiseSqrt().cwiseInverse(), 1.0);
  const Eigen::MatrixXd scaled = over_sigma.asDiagonal() * matrix * over_sigma.asDiagonal();
  return linalg::SymmetricEigenvalues(scaled).minCoeff() >= -kRounding;
}

Eigen::MatrixXd ReadCovariance(const ConfigNode& node, int rows) {
  const std::string rule = "must be the lower triangle of a covariance of " + std::to_string(rows) +
                           " numbers: pose (6), then the coefficients";
  if (node.kind != ConfigNode::Kind::kList || static_cast<int>(node.items.size()) != rows) {
    Refuse(node, rule);
  }
  Eigen::MatrixXd covariance(rows, rows);
  for (int i = 0; i < rows; ++i) {
    const ConfigNode& row_node = node.items[At(i)];
    const std::vector<double> row = ReadNumbers(row_node);
    if (static_cast<int>(row.size()) != i + 1) Refuse(row_node, rule);
    for (int j = 0; j <= i; ++j) {
      covariance(i, j) = covariance(j, i) = row[At(j)];
    }
  }
  if (!IsCovariance(covariance)) Refuse(node, rule + "; it has a variance below 0");
  return covariance;
}

}  // namespace

const KeyTable& DepthBiasKeys() {
  static const KeyTable keys{
      .title = "depth bias",
      .about =
          "A point measured at p is at (1 + b) p, camera frame. The relative error b is a "
          "polynomial in x / (z span) and y / (z span).",
      .keys = {
          {"image", value::Map(PictureKeys()), kRequired, "The images that it belongs to."},
          {"order", value::WholeNumber(0, kHighestOrder), kRequired, "Order of the polynomial."},
          {"span", value::Real(kPositive), kRequired,
           "Tangent of the angle to the optical axis at which a monomial is 1."},
          {"coefficients", value::Numbers(), kRequired,
           "Coefficients of the monomials: (order + 1)(order + 2) / 2 numbers."},
          {"covariance", value::List(value::Numbers()), kRequired,
           "Lower triangle, one row each: rotation (rad) and translation (m) of "
           "`T_robot_camera`, then the coefficients."}}};
  return keys;
}

CalibratedDepthBias ReadDepthBias(const ConfigNode& node) {
  MapReader reader(node, DepthBiasKeys());
  CalibratedDepthBias bias;
  bias.picture = ReadPicture(reader.Require("image"));
  geometry::DepthBiasMap& map = bias.map;
  reader.Read("order", &map.basis.order);
  reader.Read("span", &map.basis.span);
  const ConfigNode& coefficients = reader.Require("coefficients");
  const std::vector<double> numbers = ReadNumbers(coefficients);
  const int count = geometry::CountOf(map.basis);
  if (static_cast<int>(numbers.size()) != count) {
    Refuse(coefficients, "must hold the " + std::to_string(count) + " of this order");
  }
  map.coefficients = Eigen::Map<const Eigen::VectorXd>(numbers.data(), count);
  map.covariance = ReadCovariance(reader.Require("covariance"), kPoseRows + count);
  reader.Finish();
  return bias;
}

std::string FormatDepthBias(const CalibratedDepthBias& bias) {
  const geometry::DepthBiasMap& map = bias.map;
  std::string text = "# A point that is measured at p is at (1 + b) p: b = c . monomials of\n";
  text += "# x / (z span), y / (z span). Covariance: rotation (rad) and shift (m) of\n";
  text += "# T_robot_camera, then the coefficients.\n";
  text += "depth_bias:\n  image: " + Format(bias.picture) + "\n";
  text += "  order: " + std::to_string(map.basis.order) + "\n";
  text += "  span: " + FormatNumber(map.basis.span) + "\n";
  text += "  coefficients: " + geometry::FormatVector(map.coefficients) + "\n";
  text += "  covariance:\n";
  for (Eigen::Index i = 0; i < map.covariance.rows(); ++i) {
    text += "    - " + geometry::FormatVector(map.covariance.row(i).head(i + 1)) + "\n";
  }
  return text;
}

Status CheckDepthBias(const CalibratedDepthBias& bias) {
  const auto invalid = [](const std::string& what) {
    return Status(StatusCode::kInvalidInput, "the depth bias has " + what);
  };
  const DepthPicture& picture = bias.picture;
  const bool has_size = picture.width_px > 0 && picture.height_px > 0;
  if (!has_size || !(picture.fx_px > 0.0) || !(picture.fy_px > 0.0)) {
    return invalid("no image: " + Format(picture));
  }
  const geometry::DepthBiasMap& map = bias.map;
  if (map.basis.order < 0 || map.basis.order > kHighestOrder || !(map.basis.span > 0.0)) {
    return invalid("order " + std::to_string(map.basis.order) + ", span " +
                   FormatNumber(map.basis.span));
  }
  const int count = geometry::CountOf(map.basis), rows = kPoseRows + count;
  if (map.coefficients.size() != count || !map.coefficients.allFinite()) {
    return invalid("no " + std::to_string(count) + " coefficients");
  }
  if (map.covariance.rows() != rows || map.covariance.cols() != rows ||
      !map.covariance.allFinite() || !IsCovariance(map.covariance)) {
    return invalid("no covariance of " + std::to_string(rows) + " numbers");
  }
  return Status::Ok();
}

Status CheckDepthPicture(const CalibratedDepthBias& bias, const DepthPicture& present) {
  if (bias.picture == present) return Status::Ok();
  return {StatusCode::kInvalidInput, "the calibration's depth bias is for images " +
                                         Format(bias.picture) + ", these are " + Format(present) +
                                         ": calibrate again with this camera"};
}

}  // namespace palpate::robot
