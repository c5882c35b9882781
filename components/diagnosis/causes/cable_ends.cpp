// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Geometry>
#include <cmath>

#include "components/diagnosis/causes/makers.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

/// A point force gives way by some 0.2 / (E h) in cells of size h, without end as these get
/// smaller, and a real cable's end by what it is spread out over. Against the mesh of four_leg (4.4
/// mm) one of 6.1 mm has 0.15 mm/N less and one twice as fine some 0.3 mm/N more, or 0.07 and 0.13
/// / (E h).
constexpr double kShare = 0.08;

double SizeOfCell_m(const fem::TetMesh& mesh, int cell) {
  const auto corner = [&](int k) -> Eigen::Vector3d {
    return mesh.nodes_m.col(mesh.cells(k, cell));
  };
  const Eigen::Vector3d a = corner(1) - corner(0);
  const Eigen::Vector3d b = corner(2) - corner(0);
  const Eigen::Vector3d c = corner(3) - corner(0);
  return std::cbrt(a.cross(b).dot(c) / 6.0);
}

/// [cables] m/N, one sigma.
Eigen::VectorXd GiveWay(const robot::RobotBody& body) {
  Eigen::VectorXd give_way_m_N(std::ssize(body.cables));
  for (Eigen::Index c = 0; c < give_way_m_N.size(); ++c) {
    const int cell = body.cables[static_cast<std::size_t>(c)].eyelets.back().cell;
    const auto material =
        static_cast<std::size_t>(body.material_of_cell[static_cast<std::size_t>(cell)]);
    give_way_m_N[c] =
        kShare / (body.materials[material].youngs_modulus_Pa * SizeOfCell_m(body.mesh, cell));
  }
  return give_way_m_N;
}

/// By how much more, or less, than the mesh has it the body gives way where its cables end: at all
/// of them alike, which is no fault. Here z is of one sigma.
class CableEnds final : public FaultModel {
 public:
  explicit CableEnds(Eigen::VectorXd give_way_m_N)
      : FaultModel({"cable_ends", {"body"}}, "what the mesh gives way by where cables end",
                   {{.name = "sigmas", .tolerance = 1.0, .fault = 1.0}}),
        give_way_m_N_(std::move(give_way_m_N)) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->cable_compliance_m_N += z[0] * give_way_m_N_;
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& /*at*/) const override {
    auto all = std::make_unique<SumOfParameters>();
    for (Eigen::Index c = 0; c < give_way_m_N_.size(); ++c) {
      all->Add(give_way_m_N_[c], robot::CableCompliance(static_cast<int>(c)));
    }
    return all;
  }

 private:
  Eigen::VectorXd give_way_m_N_;
};

}  // namespace

void MakeCableEnds(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  if (world.body.cables.empty()) return;
  causes->push_back(std::make_unique<CableEnds>(GiveWay(world.body)));
}

}  // namespace palpate::diagnosis
