// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <utility>

#include "components/diagnosis/causes/makers.hpp"

namespace palpate::diagnosis {

namespace {

/// z = 1: each of two drives pulls the other's cable; 0: its own. Nothing between is believed in.
class SwappedCables final : public FaultModel {
 public:
  SwappedCables(const CauseWorld& world, int a, int b)
      : FaultModel(
            {"swapped_cables", {"cable:" + NameOf(world, a), "cable:" + NameOf(world, b)}},
            "cables " + NameOf(world, a) + " and " + NameOf(world, b) + " swapped",
            {{.name = "swapped", .fault = 0.02, .fault_at = 1.0, .least = 0.0, .most = 1.0}}),
        a_(a),
        b_(b) {}

  bool OnDrives() const override { return true; }

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    Eigen::MatrixXd& mixing = hypothesis->drives.mixing;
    const Eigen::RowVectorXd row_a = mixing.row(a_);
    const Eigen::RowVectorXd row_b = mixing.row(b_);
    mixing.row(a_) += z[0] * (row_b - row_a);
    mixing.row(b_) += z[0] * (row_a - row_b);
  }

  /// Each drive keeps its name and its limits, and pulls what the other one pulled.
  bool Extend(const Eigen::VectorXd& /*z*/, robot::RobotDescription* robot,
              std::vector<robot::CalibratedDrive>* /*drives*/) const override {
    robot::CableSettings& a = robot->cables[static_cast<std::size_t>(a_)];
    robot::CableSettings& b = robot->cables[static_cast<std::size_t>(b_)];
    std::swap(a.path_m, b.path_m);
    std::swap(a.guide_radius_m, b.guide_radius_m);
    std::swap(a.friction_coefficient, b.friction_coefficient);
    return true;
  }

  std::vector<FittedParameter> Report(const Eigen::VectorXd& /*z*/,
                                      const Eigen::MatrixXd& /*covariance*/,
                                      const Eigen::VectorXd& /*undeformed_m*/) const override {
    return {};
  }

 private:
  static const std::string& NameOf(const CauseWorld& world, int cable) {
    return world.body.cables[static_cast<std::size_t>(cable)].name;
  }

  Eigen::Index a_;
  Eigen::Index b_;
};

}  // namespace

void MakeSwappedCables(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  const auto cables = static_cast<int>(world.body.cables.size());
  for (int a = 0; a < cables; ++a) {
    for (int b = a + 1; b < cables; ++b) {
      causes->push_back(std::make_unique<SwappedCables>(world, a, b));
    }
  }
}

}  // namespace palpate::diagnosis
