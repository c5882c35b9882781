// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/virtual_robot.hpp"

#include "components/virtual_robot/bench.hpp"
#include "components/virtual_robot/bench_inputs.hpp"
#include "components/virtual_robot/truth.hpp"

namespace palpate::virtual_robot {

struct VirtualRobot::Parts {
  Parts(const robot::RobotDescription& robot, const scenario::Scenario& scenario,
        const std::vector<scenario::ActiveEffect>& effects, std::uint64_t seed, int threads)
      : bench(robot, scenario, effects, threads), truth(bench, effects, seed) {}

  Bench bench;
  Truth truth;
};

VirtualRobot::VirtualRobot(const robot::RobotDescription& robot, const scenario::Scenario& scenario,
                           const std::vector<scenario::ActiveEffect>& effects, std::uint64_t seed,
                           int threads)
    : parts_(std::make_unique<Parts>(robot, scenario, effects, seed, threads)) {}

VirtualRobot::~VirtualRobot() = default;

Status VirtualRobot::Start(double t_s, const Inputs& inputs) {
  const Status status = parts_->bench.Start(t_s, inputs);
  parts_->truth.Update();
  return status;
}

Status VirtualRobot::Advance(double t_s, const Inputs& inputs) {
  const Status status = parts_->bench.Advance(t_s, inputs);
  parts_->truth.Update();
  return status;
}

double VirtualRobot::time_s() const { return parts_->bench.time_s(); }
const fem::TetMesh& VirtualRobot::mesh() const { return parts_->bench.body().mesh; }
const fem::BoundarySurface& VirtualRobot::boundary() const { return parts_->bench.body().boundary; }
const std::string& VirtualRobot::mesh_hash() const { return parts_->bench.body().mesh_hash; }
const Eigen::VectorXd& VirtualRobot::positions_m() const { return parts_->bench.state().x_m; }
const std::vector<CableReading>& VirtualRobot::cables() const { return parts_->truth.cables(); }
std::vector<TrueForce> VirtualRobot::forces() const { return parts_->truth.Forces(); }
Eigen::Matrix3Xd VirtualRobot::MarkerPositions_m() const {
  return parts_->truth.MarkerPositions_m();
}
double VirtualRobot::KineticEnergy_J() const { return parts_->bench.KineticEnergy_J(); }
double VirtualRobot::TotalEnergy_J() const { return parts_->bench.TotalEnergy_J(); }
Eigen::Vector3d VirtualRobot::SupportForce_N() const { return parts_->bench.SupportForce_N(); }
const StepCost& VirtualRobot::cost() const { return parts_->bench.cost(); }

}  // namespace palpate::virtual_robot
