// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/patch_responses.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "libs/core/check.hpp"

namespace palpate::force_estimation {

namespace {

/// Patches whose columns are solved at once.
constexpr Eigen::Index kBlockPatches = 16;
/// Coefficients of a row below this part of its largest are rounding.
constexpr double kNegligible = 1e-9;

/// The taut cables: their gradients, what they do to the body, and how to hold their length.
struct TautCables {
  Eigen::MatrixXd pull;    ///< [reduced x taut] rows of H_a
  Eigen::MatrixXd motion;  ///< K^-1 pull
  Eigen::LLT<Eigen::MatrixXd> compliance;

  Status Solve(robot::RobotModel& model, const Eigen::VectorXd& x_m,
               const std::vector<robot::CableCommand>& commands,
               const Eigen::VectorXd& lambda_a_N) {
    std::vector<int> taut;
    for (int c = 0; c < model.CableCount(); ++c) {
      const bool driven =
          commands[static_cast<size_t>(c)].kind == robot::CableCommand::Kind::kDisplacement;
      if (driven && lambda_a_N[c] > 0.0) taut.push_back(c);
    }
    fem::Linearisation& linearisation = model.linearisation();
    pull.setZero(linearisation.Size(), static_cast<Eigen::Index>(taut.size()));
    if (taut.empty()) return Status::Ok();
    Eigen::VectorXd nodal(x_m.size());
    for (size_t t = 0; t < taut.size(); ++t) {
      nodal.setZero();
      model.cable(taut[t]).AddGradient(x_m, -1.0, nodal);
      linearisation.matrix().Reduce(nodal, pull.col(static_cast<Eigen::Index>(t)));
    }
    motion = pull;
    linearisation.Solve(motion);
    compliance.compute(pull.transpose() * motion);
    if (compliance.info() != Eigen::Success) {
      return {StatusCode::kUnobservable, "two taut cables act alike"};
    }
    return Status::Ok();
  }

  /// Adds to each column the motion by which the cables keep their length.
  void Hold(Eigen::Ref<Eigen::MatrixXd> columns) const {
    if (pull.cols() == 0) return;
    const Eigen::MatrixXd tension = compliance.solve(pull.transpose() * columns);
    columns.noalias() -= motion * tension;
  }
};

}  // namespace

Status PatchResponses::Solve(robot::RobotModel& model,
                             const std::vector<fem::SurfacePatch>& patches,
                             const Eigen::VectorXd& x_m,
                             const std::vector<robot::CableCommand>& commands,
                             const Eigen::VectorXd& lambda_a_N) {
  PALPATE_CHECK(static_cast<int>(commands.size()) == model.CableCount(), commands.size());
  PALPATE_CHECK(lambda_a_N.size() == model.CableCount(), lambda_a_N.size());
  fem::Linearisation& linearisation = model.linearisation();
  TautCables cables;
  Status status = cables.Solve(model, x_m, commands, lambda_a_N);
  if (!status.ok()) return status;
  const fem::StiffnessMatrix& matrix = linearisation.matrix();
  free_index_.resize(static_cast<size_t>(matrix.NodeCount()));
  for (int node = 0; node < matrix.NodeCount(); ++node) {
    free_index_[static_cast<size_t>(node)] = matrix.FreeIndex(node);
  }
  const auto count = static_cast<Eigen::Index>(patches.size());
  columns_.resize(linearisation.Size(), 3 * count);
  Eigen::MatrixXd block(linearisation.Size(), 3 * kBlockPatches);
  for (Eigen::Index first = 0; first < count; first += kBlockPatches) {
    const Eigen::Index patch_count = std::min(kBlockPatches, count - first);
    block.setZero();
    for (Eigen::Index p = 0; p < patch_count; ++p) {
      const fem::NodeWeights& weights = patches[static_cast<size_t>(first + p)].weights;
      for (size_t k = 0; k < weights.nodes.size(); ++k) {
        const int free = matrix.FreeIndex(weights.nodes[k]);
        if (free < 0) continue;
        block.block<3, 3>(3 * free, 3 * p).diagonal().setConstant(weights.weights[k]);
      }
    }
    auto solved = block.leftCols(3 * patch_count);
    linearisation.Solve(solved);
    cables.Hold(solved);
    columns_.middleCols(3 * first, 3 * patch_count) = solved.cast<float>();
  }
  if (!columns_.allFinite()) return {StatusCode::kInvalidInput, "a response is not finite"};
  return Status::Ok();
}

Eigen::MatrixXd PatchResponses::Observe(const std::vector<robot::EffectorRow>& rows,
                                        const Eigen::VectorXd& scale) const {
  const auto count = static_cast<Eigen::Index>(rows.size());
  RowMajor observed = RowMajor::Zero(count, columns_.cols());
  for (Eigen::Index i = 0; i < count; ++i) {
    const robot::EffectorRow& row = rows[static_cast<size_t>(i)];
    double largest = 0.0;
    for (const Eigen::Vector3d& coefficient : row.coefficients) {
      largest = std::max(largest, coefficient.cwiseAbs().maxCoeff());
    }
    for (size_t k = 0; k < row.nodes.size(); ++k) {
      const int free = free_index_[static_cast<size_t>(row.nodes[k])];
      if (free < 0) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const double coefficient = row.coefficients[k][axis];
        if (std::abs(coefficient) <= kNegligible * largest) continue;
        observed.row(i) +=
            static_cast<float>(scale[i] * coefficient) * columns_.row(3 * free + axis);
      }
    }
  }
  return observed.cast<double>();
}

Status ObserveAbout(robot::RobotModel& model, const std::vector<fem::SurfacePatch>& patches,
                    const std::vector<robot::EffectorRow>& rows, const Eigen::VectorXd& x_m,
                    const std::vector<robot::CableCommand>& commands,
                    const Eigen::VectorXd& lambda_a_N, Eigen::MatrixXd* observed) {
  fem::Linearisation& linearisation = model.linearisation();
  const fem::StiffnessMatrix& matrix = linearisation.matrix();
  TautCables cables;
  Status status = cables.Solve(model, x_m, commands, lambda_a_N);
  if (!status.ok()) return status;
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd columns(linearisation.Size(), count);
  Eigen::VectorXd nodal(x_m.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const robot::EffectorRow& row = rows[static_cast<size_t>(i)];
    nodal.setZero();
    for (size_t k = 0; k < row.nodes.size(); ++k) {
      nodal.segment<3>(3 * row.nodes[k]) += row.coefficients[k];
    }
    matrix.Reduce(nodal, columns.col(i));
  }
  linearisation.Solve(columns);
  cables.Hold(columns);
  observed->setZero(count, static_cast<Eigen::Index>(3 * patches.size()));
  for (Eigen::Index i = 0; i < count; ++i) {
    for (size_t p = 0; p < patches.size(); ++p) {
      const fem::NodeWeights& weights = patches[p].weights;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (size_t k = 0; k < weights.nodes.size(); ++k) {
        const int free = matrix.FreeIndex(weights.nodes[k]);
        if (free >= 0) sum += weights.weights[k] * columns.col(i).segment<3>(3 * free);
      }
      observed->row(i).segment<3>(static_cast<Eigen::Index>(3 * p)) = sum.transpose();
    }
  }
  if (!observed->allFinite()) return {StatusCode::kInvalidInput, "a response is not finite"};
  return Status::Ok();
}

}  // namespace palpate::force_estimation
