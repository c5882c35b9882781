// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/posture.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/linalg/symmetric_eigen.hpp"

namespace palpate::diagnosis {

namespace {

/// Least values of sums that anything is divided by.
constexpr double kNoMotion_m = 1e-9;

/// Leading eigenvectors of a Gram matrix, the largest first, scaled to RMS 1 over its samples:
/// [samples x count], and so many as are at least `least` of the largest.
struct Leading {
  Eigen::MatrixXd vectors;
  Eigen::VectorXd rms;
};

Leading LeadingOf(const Eigen::MatrixXd& gram, Eigen::Index most, double least) {
  const auto samples = static_cast<double>(gram.rows());
  const linalg::SymmetricEigen eigen = linalg::DecomposeSymmetric(gram);
  Leading leading;
  if (!eigen.ok) return leading;
  const Eigen::VectorXd rms = (eigen.values.reverse().cwiseMax(0.0) / samples).cwiseSqrt();
  const Eigen::Index count = std::min(
      most, (rms.array() > std::max(least * rms[0], kNoMotion_m)).cast<Eigen::Index>().sum());
  leading.vectors = std::sqrt(samples) * eigen.vectors.rowwise().reverse().leftCols(count);
  leading.rms = rms.head(count);
  return leading;
}

}  // namespace

Eigen::VectorXd PostureFunctions::Monomials(const Eigen::VectorXd& x_m) const {
  const Eigen::VectorXd q = shapes_.transpose() * (x_m - mean_m_);
  const Eigen::Index n = q.size();
  Eigen::VectorXd monomials(n + n * (n + 1) / 2);
  monomials.head(n) = q;
  for (Eigen::Index a = 0, k = n; a < n; ++a) {
    for (Eigen::Index b = a; b < n; ++b) monomials[k++] = q[a] * q[b];
  }
  return monomials;
}

Eigen::VectorXd PostureFunctions::At(const Eigen::VectorXd& x_m) const {
  return weights_.transpose() * (Monomials(x_m) - centre_);
}

std::optional<PostureFunctions> FunctionsOfPosture(const robot::RobotBody& body,
                                                   const Simulation& simulated,
                                                   const PostureTuning& tuning) {
  std::vector<const Eigen::VectorXd*> shapes_m;
  for (const SimulatedSample& sample : simulated.samples) {
    if (sample.status.ok()) shapes_m.push_back(&sample.middle.state.x_m);
  }
  if (shapes_m.size() < 2) return std::nullopt;
  const auto samples = std::ssize(shapes_m);
  Eigen::MatrixXd bend_m(body.mesh.nodes_m.size(), samples);
  for (Eigen::Index s = 0; s < samples; ++s) bend_m.col(s) = *shapes_m[At(s)];
  PostureFunctions functions;
  functions.mean_m_ = bend_m.rowwise().mean();
  bend_m.colwise() -= functions.mean_m_;
  const Leading of_shape =
      LeadingOf(bend_m.transpose() * bend_m, tuning.most_shapes, tuning.least_shape);
  if (of_shape.rms.size() == 0) return std::nullopt;
  // q = RMS 1 of the largest shape; smaller ones keep their share of it.
  functions.shapes_ = bend_m * of_shape.vectors / (static_cast<double>(samples) * of_shape.rms[0]);
  for (Eigen::Index k = 0; k < of_shape.rms.size(); ++k) {
    functions.shapes_.col(k) /= of_shape.rms[k];
  }
  Eigen::MatrixXd monomials;
  for (Eigen::Index s = 0; s < samples; ++s) {
    const Eigen::VectorXd column = functions.Monomials(*shapes_m[At(s)]);
    if (s == 0) monomials.resize(column.size(), samples);
    monomials.col(s) = column;
  }
  functions.centre_ = monomials.rowwise().mean();
  monomials.colwise() -= functions.centre_;
  const Leading of_function =
      LeadingOf(monomials.transpose() * monomials, tuning.most_functions, tuning.least_function);
  // Each has its share of a sum whose RMS is 1: as the prior of Karhunen and Loeve has it.
  functions.weights_ =
      monomials * of_function.vectors / (static_cast<double>(samples) * of_function.rms.norm());
  for (Eigen::Index k = 0; k < of_function.rms.size(); ++k) {
    functions.weights_.col(k) /= of_function.rms[k];
  }
  if (functions.count() == 0) return std::nullopt;
  return functions;
}

}  // namespace palpate::diagnosis
