// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "components/view/frames/page_surface.hpp"
#include "components/view/serve/out_message.hpp"
#include "libs/core/status.hpp"
#include "libs/dds/topics.hpp"

namespace palpate::view {

/// A mesh and its last state, as the page is sent them.
class ShownMesh {
 public:
  /// `kind`: of its messages, "mesh" or "truth_mesh"; states are "..._state".
  explicit ShownMesh(std::string kind) : kind_(std::move(kind)) {}

  /// kInvalidInput for a mesh that is none; the last one stays.
  Status Take(const idl::palpate_msgs::Mesh& message);
  /// Takes the positions. kInvalidInput for a state of another mesh, or before there is one.
  Status Take(const idl::palpate_msgs::MeshState& message);

  /// The mesh. `stiffness_Pa` [n]; empty: it is left out.
  OutMessage MeshMessage(const std::vector<float>& stiffness_Pa) const;
  /// The last state. `residual_m` [n]; empty: it is left out.
  OutMessage StateMessage(const std::vector<float>& residual_m) const;

  const PageSurface& surface() const { return surface_; }
  /// [3 n] of the last state; empty before there is one.
  const std::vector<float>& positions_m() const { return positions_m_; }
  /// [3 N] of all nodes of the mesh, as positions_m().
  Eigen::VectorXd nodes_m() const { return nodes_m_.cast<double>().reshaped(); }
  std::int64_t stamp_ns() const { return stamp_ns_; }
  bool usable() const { return status_ == "ok"; }

 private:
  std::string kind_;
  std::string robot_;
  std::int64_t mesh_stamp_ns_ = 0;
  PageSurface surface_;
  std::vector<float> positions_m_;
  Eigen::Matrix3Xf nodes_m_;
  std::int64_t stamp_ns_ = 0;
  std::uint64_t counter_ = 0;
  std::string status_;
};

}  // namespace palpate::view
