// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <memory>

#include "components/diagnosis/faults/makers.hpp"
#include "components/diagnosis/forward/mesh_error.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

/// The mesh is too coarse: the body moves farther than it lets it, by z times what elements of ten
/// nodes in the place of its four would add. What that does to the cables' tensions is left out.
class Discretisation final : public FaultModel {
 public:
  explicit Discretisation(std::shared_ptr<const MeshError> error)
      : FaultModel({"discretisation", {"body"}}, "a mesh that is too coarse",
                   {{.name = "refinement_share",
                     .fault = 0.3,
                     .fault_at = 1.0,
                     .least = 0.0,
                     .plausible = 2.0}}),  // elements of ten nodes come far nearer than that
        error_(std::move(error)) {}

  /// By how much the mesh errs is computed, and not fitted.
  std::vector<FittedParameter> Report(const Eigen::VectorXd& /*z*/,
                                      const Eigen::MatrixXd& /*covariance*/,
                                      const Eigen::VectorXd& /*undeformed_m*/) const override {
    return {{"relative_error", error_->relative, error_->relative, error_->relative}};
  }
  bool RestartsSearch() const override { return true; }

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->mesh_error = error_;
    hypothesis->mesh_error_share += z[0];
  }

  void OnView(int /*parameter*/, const Eigen::VectorXd& /*z*/, const FaultContext& at,
              Eigen::Matrix3Xd* motion_m) const override {
    const bool of_skin = at.target == Target::kSurface;
    const Eigen::VectorXd farther_m =
        (of_skin ? error_->of_nodes : error_->of_markers) *
        error_->BendIn(at.shape.state.x_m - at.hypothesis.body.mesh.nodes_m.reshaped());
    const auto recording = static_cast<std::size_t>(at.seen().recording);
    const Eigen::Matrix3d R_seen =
        (of_skin ? at.hypothesis.T_surface_seen : at.hypothesis.T_seen)[recording].linear();
    for (Eigen::Index k = 0; k < motion_m->cols(); ++k) {
      motion_m->col(k) += R_seen * (of_skin ? at.seen().surface[At(k)].point.Position(farther_m)
                                            : farther_m.segment<3>(3 * k));
    }
  }

  bool Extend(const Eigen::VectorXd& /*z*/, robot::RobotDescription* robot,
              robot::CalibrationFile* /*calibration*/) const override {
    *robot = OnFinerMesh(std::move(*robot));
    return true;
  }

 private:
  std::shared_ptr<const MeshError> error_;
};

}  // namespace

void MakeDiscretisation(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  if (inputs.mesh_error) faults->push_back(std::make_unique<Discretisation>(inputs.mesh_error));
}

}  // namespace palpate::diagnosis
