// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/node/skin_probe.hpp"

#include <cmath>
#include <limits>

#include "components/view/frames/binary_frame.hpp"
#include "libs/core/index.hpp"
#include "libs/core/names.hpp"
#include "libs/core/seconds.hpp"
#include "libs/dds/message.hpp"
#include "libs/geometry/triangle_surface.hpp"

namespace palpate::view {

namespace {

using Json = nlohmann::json;
using Vectors = Eigen::Map<const Eigen::Matrix3Xf>;

Vectors VectorsOf(const std::vector<float>& numbers) {
  return {numbers.data(), 3, ToIndex(numbers.size() / 3)};
}

Json VectorJson(const Eigen::Vector3f& v) { return Json::array({v.x(), v.y(), v.z()}); }

/// [3 x nodes] outward normals of the surface as it is now.
Eigen::Matrix3Xd NormalsOf(const ShownMesh& mesh) {
  geometry::TriangleSurface surface;
  surface.vertices_m = VectorsOf(mesh.positions_m()).cast<double>();
  const auto& triangles = mesh.surface().triangles;
  surface.triangles = Eigen::Map<const Eigen::Matrix<std::uint32_t, 3, Eigen::Dynamic>>(
                          triangles.data(), 3, ToIndex(triangles.size() / 3))
                          .cast<int>();
  return geometry::VertexNormals(surface);
}

}  // namespace

void SkinProbe::Take(const idl::sensor_msgs::JointState& message) {
  for (std::size_t i = 0; i < message.name._length; ++i) {
    if (i >= message.effort._length) break;
    tension_N_[std::string(dds::Text(message.name._buffer[i]))] = message.effort._buffer[i];
  }
}

void SkinProbe::Take(const idl::palpate_msgs::ModelGap& message) {
  noise_rms_m_ = message.noise_rms_m;
  sample_count_ = message.sample_count;
}

void SkinProbe::Forget() {
  tension_N_.clear();
  markers_.reset();
  residual_m_.clear();
  noise_rms_m_ = 0.0;
  sample_count_ = 0;
}

Eigen::VectorXd SkinProbe::Tensions_N() const {
  const std::vector<robot::ActuatorTraits>& actuators = robot_->model().traits();
  Eigen::VectorXd tension_N(ToIndex(actuators.size()));
  for (std::size_t a = 0; a < actuators.size(); ++a) {
    const auto found = tension_N_.find(actuators[a].name);
    tension_N[ToIndex(a)] = found == tension_N_.end() ? std::numeric_limits<double>::quiet_NaN()
                                                      : actuators[a].Force_N(found->second);
  }
  return tension_N;
}

Status SkinProbe::MeasuredByMarkers(MeasuredRows* measured) const {
  const std::vector<std::string> names = robot_->model().MarkerNames();
  for (std::size_t k = 0; k < markers_->names.size(); ++k) {
    const auto marker = IndexOf(markers_->names[k], names);
    const Eigen::Vector3d sigma_m = markers_->sigma_m.col(ToIndex(k));
    if (!marker || !markers_->measured_m.col(ToIndex(k)).allFinite()) continue;
    if (!(sigma_m.minCoeff() > 0.0)) {
      return {StatusCode::kUnobservable, "the markers' noise is not stated (markers_sigma_m)"};
    }
    for (auto& row : robot::RowsOfPoints({robot_->body().markers[*marker].point.weights})) {
      measured->rows.push_back(std::move(row));
    }
    measured->sigma_m.insert(measured->sigma_m.end(), sigma_m.begin(), sigma_m.end());
  }
  return Status::Ok();
}

/// The estimator fits `sample_count_` points of that noise along the normal. The view knows where
/// there are measured points, not which of them were taken: all seen nodes of the surface share
/// the samples evenly.
Status SkinProbe::MeasuredByCloud(const ShownMesh& mesh, MeasuredRows* measured) const {
  if (!(noise_rms_m_ > 0.0) || sample_count_ == 0) {
    return {StatusCode::kNoCalibration, "the estimator has not said how large the noise is"};
  }
  if (residual_m_.size() != mesh.surface().nodes.size()) {
    return {StatusCode::kNoRobotSeen, "which part of the skin is measured is not known yet"};
  }
  const Eigen::Matrix3Xd normals = NormalsOf(mesh);
  for (std::size_t k = 0; k < residual_m_.size(); ++k) {
    if (!std::isfinite(residual_m_[k])) continue;
    robot::ObservationRow row;
    row.nodes = {static_cast<int>(mesh.surface().nodes[k])};
    row.coefficients = {normals.col(ToIndex(k))};
    measured->rows.push_back(std::move(row));
  }
  const double nodes_per_sample = static_cast<double>(measured->rows.size()) / sample_count_;
  measured->sigma_m.assign(measured->rows.size(), noise_rms_m_ * std::sqrt(nodes_per_sample));
  return Status::Ok();
}

Status SkinProbe::Measured(const ShownMesh& mesh, MeasuredRows* measured) const {
  constexpr double kMostApart_s = 1.0;
  const bool has_markers =
      markers_ && std::abs(NsToSeconds(markers_->stamp_ns - mesh.stamp_ns())) < kMostApart_s;
  return has_markers ? MeasuredByMarkers(measured) : MeasuredByCloud(mesh, measured);
}

Status SkinProbe::SmallestForce(std::size_t vertex, const ShownMesh& mesh, double* force_N) {
  if (robot_ == nullptr) {
    return {StatusCode::kNotRun,
            "palpate-view was not told the robot file, so it does not know the stiffness: start it "
            "with ROBOT"};
  }
  if (mesh.surface().hash != robot_->body().mesh_hash ||
      mesh.surface().node_count != robot_->NodeCount()) {
    return {StatusCode::kInvalidInput, "the running system has another mesh than the robot file"};
  }
  if (!mesh.usable()) return {StatusCode::kStale, "the shape of the robot is not known now"};
  MeasuredRows measured;
  if (Status status = Measured(mesh, &measured); !status.ok()) return status;
  const Eigen::Vector3f rest_m = VectorsOf(mesh.surface().rest_m).col(ToIndex(vertex));
  return robot_->SmallestForce({rest_m.cast<double>(), config_.radius_m}, mesh.nodes_m(),
                               Tensions_N(), measured, config_.significance, force_N);
}

OutMessage SkinProbe::Answer(const ProbeRequest& request, const ShownMesh& mesh) {
  Json fields = {{"kind", "probe"},
                 {"vertex", request.vertex},
                 {"position_m", nullptr},
                 {"displacement_m", nullptr},
                 {"smallest_force_N", nullptr},
                 {"significance", config_.significance},
                 {"reason", ""}};
  if (request.vertex >= mesh.positions_m().size() / 3) {
    fields["reason"] = "there is no such node, or no state of the mesh yet";
    return TextMessage("probe", JsonText(fields));
  }
  const Eigen::Vector3f position_m = VectorsOf(mesh.positions_m()).col(request.vertex);
  fields["position_m"] = VectorJson(position_m);
  fields["displacement_m"] =
      VectorJson(position_m - VectorsOf(mesh.surface().rest_m).col(request.vertex));
  double force_N = 0.0;
  const Status known = SmallestForce(request.vertex, mesh, &force_N);
  if (known.ok()) fields["smallest_force_N"] = force_N;
  fields["reason"] = known.message();
  return TextMessage("probe", JsonText(fields));
}

}  // namespace palpate::view
