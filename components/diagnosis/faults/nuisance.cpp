// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "components/diagnosis/faults/makers.hpp"
#include "components/diagnosis/faults/view_motion.hpp"
#include "libs/core/index.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

/// A point force yields by some 0.2 / (E h) in elements of size h, without end as these get
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
Eigen::VectorXd AnchorCompliance_m_N(const robot::RobotBody& body) {
  Eigen::VectorXd compliance_m_N(std::ssize(body.cables));
  for (Eigen::Index c = 0; c < compliance_m_N.size(); ++c) {
    const int cell = body.cables[At(c)].eyelets.back().cell;
    const auto material = static_cast<std::size_t>(body.material_of_cell[At(cell)]);
    compliance_m_N[c] =
        kShare / (body.materials[material].youngs_modulus_Pa * SizeOfCell_m(body.mesh, cell));
  }
  return compliance_m_N;
}

/// By how much more, or less, than the mesh has it the body yields where its cables end: at all of
/// them alike, which is no fault. Here z is of one sigma.
class AnchorCompliance final : public FaultModel {
 public:
  explicit AnchorCompliance(Eigen::VectorXd compliance_m_N)
      : FaultModel({"cable_ends", {"body"}},
                   "mesh-dependent local compliance at cable anchor points",
                   {{.name = "sigmas", .tolerance = 1.0, .fault = 1.0}}),
        compliance_m_N_(std::move(compliance_m_N)) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->cable_compliance_m_N += z[0] * compliance_m_N_;
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& /*at*/) const override {
    auto all = std::make_unique<SumOfParameters>();
    for (Eigen::Index c = 0; c < compliance_m_N_.size(); ++c) {
      all->Add(compliance_m_N_[c], robot::CableCompliance(static_cast<int>(c)));
    }
    return all;
  }

 private:
  Eigen::VectorXd compliance_m_N_;
};

}  // namespace

void MakeAnchorCompliance(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  if (inputs.body.cables.empty()) return;
  faults->push_back(std::make_unique<AnchorCompliance>(AnchorCompliance_m_N(inputs.body)));
}

namespace {

/// What measures something in a recording.
struct Viewpoint {
  int recording = 0;
  Target target = Target::kMarkers;

  bool operator==(const Viewpoint&) const = default;
};

/// Where recordings were measured from, as far as it is not known: no fault of the robot's.
class Extrinsics final : public FaultModel {
 public:
  /// `of`: the eyes that stand where one camera, or tracker, does.
  Extrinsics(std::vector<Viewpoint> of, const Eigen::Vector3d& middle_m, double sigma_m,
             double sigma_rad)
      : FaultModel({"extrinsics", {"camera"}}, "pose of the camera",
                   {Known("translation_m", sigma_m), Known("translation_m", sigma_m),
                    Known("translation_m", sigma_m), Known("rotation_rad", sigma_rad),
                    Known("rotation_rad", sigma_rad), Known("rotation_rad", sigma_rad)}),
        eyes_(std::move(of)),
        middle_m_(middle_m) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    const Eigen::Isometry3d move = ViewMotion(z, middle_m_);
    for (const Viewpoint& eye : eyes_) {
      auto& of_target =
          eye.target == Target::kSurface ? hypothesis->T_surface_seen : hypothesis->T_seen;
      Eigen::Isometry3d& T_seen = of_target[At(eye.recording)];
      T_seen = move * T_seen;
    }
  }

  void OnView(int parameter, const Eigen::VectorXd& z, const FaultContext& at,
              Eigen::Matrix3Xd* motion_m) const override {
    const int pose_of = at.recording().pose_of;
    const int from = pose_of >= 0 ? pose_of : at.seen().recording;
    const bool here =
        std::find(eyes_.begin(), eyes_.end(), Viewpoint{from, at.target}) != eyes_.end();
    if (here) AddViewMotion(parameter, z, middle_m_, Eigen::Isometry3d::Identity(), at, motion_m);
  }

 private:
  static FaultParameter Known(const std::string& name, double sigma) {
    return {.name = name, .tolerance = sigma, .fault = sigma};
  }

  std::vector<Viewpoint> eyes_;
  Eigen::Vector3d middle_m_;
};

/// What is known of a pose that is given without a standard error, and one that was fitted to these
/// data.
constexpr double kGiven_m = 5e-4;
constexpr double kGiven_rad = 2e-3;
constexpr double kFitted_m = 0.02;
constexpr double kFitted_rad = 0.05;

/// Where an eye stands.
struct View {
  Viewpoint eye;
  Eigen::Isometry3d T_measurement_robot;
  bool known;
  std::optional<geometry::PoseStandardError> error;
};

bool SamePose(const View& a, const View& b) {
  const bool same_error = a.error.has_value() == b.error.has_value() &&
                          (!a.error || (a.error->translation_m == b.error->translation_m &&
                                        a.error->rotation_rad == b.error->rotation_rad));
  return same_error && a.known == b.known &&
         a.T_measurement_robot.isApprox(b.T_measurement_robot, 1e-12);
}

/// Those whose pose may be off. Depth frames and markers that are in the camera's frame have one
/// pose.
std::vector<View> Views(const CatalogueInputs& inputs) {
  std::vector<View> views;
  const std::vector<ObservedRecording>& recordings = inputs.observed.recordings;
  for (int k = 0; k < std::ssize(recordings); ++k) {
    const ObservedRecording& one = recordings[At(k)];
    if (one.camera_frame || inputs.extrinsics_m > 0.0)
      views.push_back(
          {{k, Target::kMarkers}, one.T_measurement_robot, one.knows_pose, one.pose_error});
    if (one.T_camera_robot)
      views.push_back({{k, Target::kSurface}, *one.T_camera_robot, true, one.pose_error});
  }
  return views;
}

/// Sigmas of the robot's middle and of the turn about it. A standard error is of the camera's own
/// place and of turns about that, which move the middle as well.
geometry::PoseStandardError SigmaOf(const View& view, const Eigen::Vector3d& middle_m,
                                    const CatalogueInputs& inputs) {
  if (!view.known) return {.translation_m = kFitted_m, .rotation_rad = kFitted_rad};
  geometry::PoseStandardError sigma{.translation_m = kGiven_m, .rotation_rad = kGiven_rad};
  if (view.error) {
    const double distance_m = (view.T_measurement_robot * middle_m).norm();
    sigma = {.translation_m =
                 std::hypot(view.error->translation_m, view.error->rotation_rad * distance_m),
             .rotation_rad = view.error->rotation_rad};
  }
  if (inputs.extrinsics_m > 0.0) sigma.translation_m = inputs.extrinsics_m;
  if (inputs.extrinsics_rad > 0.0) sigma.rotation_rad = inputs.extrinsics_rad;
  return sigma;
}

}  // namespace

void MakeExtrinsics(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  const Eigen::Vector3d middle_m = inputs.body.mesh.nodes_m.rowwise().mean();
  const std::vector<View> views = Views(inputs);
  std::vector<bool> taken(views.size(), false);
  for (std::size_t k = 0; k < views.size(); ++k) {
    if (taken[k]) continue;
    std::vector<Viewpoint> same_pose;
    for (std::size_t l = k; l < views.size(); ++l) {
      if (!SamePose(views[k], views[l])) continue;
      taken[l] = true;
      same_pose.push_back(views[l].eye);
    }
    const geometry::PoseStandardError sigma = SigmaOf(views[k], middle_m, inputs);
    faults->push_back(std::make_unique<Extrinsics>(std::move(same_pose), middle_m,
                                                   sigma.translation_m, sigma.rotation_rad));
  }
}

namespace {

/// Of each coefficient, as a share of the distance: stereo cameras err by 0.2 to 0.5 % of it. The
/// constant is beside what DepthScale allows.
constexpr double kSigma = 0.003;
constexpr double kSigmaOfConstant = 0.002;
/// Over what a camera sees from several places, a finer one than over a robot that stays in the
/// middle of its depth frame.
constexpr geometry::DepthBiasBasis kBasis{.order = 4, .span = 0.4};

/// Depth that is off by a smooth share over the depth frame, as every depth camera's is: no fault.
class DepthBias final : public FaultModel {
 public:
  explicit DepthBias(const geometry::DepthBiasBasis& basis)
      : FaultModel({"depth_bias", {"camera"}}, "smooth error of the depth", Coefficients(basis)),
        basis_(basis) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->camera.bias_basis = basis_;
    hypothesis->camera.bias = z;
  }

  void OnMeasurement(int parameter, const Eigen::VectorXd& /*z*/, const FaultContext& at,
                     Eigen::Matrix3Xd* motion_m) const override {
    for (Eigen::Index k = 0; k < motion_m->cols(); ++k) {
      motion_m->col(k) +=
          at.measured_points.camera->ByBias(at.measured_points.point(k), basis_, parameter);
    }
  }

 private:
  static std::vector<FaultParameter> Coefficients(const geometry::DepthBiasBasis& basis) {
    std::vector<FaultParameter> coefficients;
    for (const std::string& name : NamesOf(basis)) {
      const double sigma = coefficients.empty() ? kSigmaOfConstant : kSigma;
      coefficients.push_back({.name = name, .tolerance = sigma, .fault = sigma});
    }
    return coefficients;
  }

  geometry::DepthBiasBasis basis_;
};

}  // namespace

void MakeDepthBias(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  if (!inputs.observed.HasSurface()) return;
  faults->push_back(std::make_unique<DepthBias>(kBasis));
}

namespace {

/// px, of each of the two.
constexpr double kSigma_px = 0.05;

/// Interpolation between whole pixels pulls the disparities of a stereo camera towards some of
/// them, so that depth errs by a wave whose length is one pixel of disparity (M. Shimizu and M.
/// Okutomi, Precise sub-pixel estimation on area-based matching, ICCV 2001): no fault. Half a metre
/// away it is some tenths of a millimetre, and goes up and down as the body moves by some
/// millimetres.
class StereoRipple final : public FaultModel {
 public:
  StereoRipple()
      : FaultModel({"stereo_ripple", {"camera"}}, "sub-pixel error of the depth",
                   {Wave("cosine_px"), Wave("sine_px")}) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->camera.ripple_px += z;
  }

  void OnMeasurement(int parameter, const Eigen::VectorXd& /*z*/, const FaultContext& at,
                     Eigen::Matrix3Xd* motion_m) const override {
    if (at.target != Target::kSurface) return;
    for (Eigen::Index f = 0; f < motion_m->cols(); ++f) {
      const SurfaceMeasurement& feature = at.seen().surface[At(f)];
      if (feature.count == 0) continue;
      motion_m->col(f) +=
          feature.ripple_m_px[parameter] / feature.normal.squaredNorm() * feature.normal;
    }
  }

 private:
  static FaultParameter Wave(const std::string& name) {
    return {.name = name, .tolerance = kSigma_px, .fault = kSigma_px};
  }
};

}  // namespace

void MakeStereoRipple(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  const auto& recordings = inputs.observed.recordings;
  const bool stereo = std::any_of(recordings.begin(), recordings.end(),
                                  [](const auto& one) { return one.stereo_px_m > 0.0; });
  if (stereo && inputs.observed.HasSurface()) faults->push_back(std::make_unique<StereoRipple>());
}

namespace {

/// Facets of the mesh lie off the surface, and where the camera errs less smoothly than DepthBias.
constexpr double kSigma_m = 3e-4;

/// Every feature of the surface is off along its normal by a constant of its own, in all
/// recordings: no fault.
class SurfaceOffset final : public FaultModel {
 public:
  explicit SurfaceOffset(Eigen::Index features)
      : FaultModel({"skin_offset", {"body"}}, "offset of the drawn surface",
                   std::vector<FaultParameter>(
                       static_cast<std::size_t>(features),
                       {.name = "offset_m", .tolerance = kSigma_m, .fault = kSigma_m})) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->surface_offset_m += z;
  }

  void OnMeasurement(int parameter, const Eigen::VectorXd& /*z*/, const FaultContext& at,
                     Eigen::Matrix3Xd* motion_m) const override {
    if (at.target == Target::kSurface)
      motion_m->col(parameter) += at.measured_points.point(parameter).normal;
  }
};

}  // namespace

void MakeSurfaceOffset(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  if (!inputs.observed.HasSurface()) return;
  faults->push_back(std::make_unique<SurfaceOffset>(inputs.observed.feature_rest_m.cols()));
}

}  // namespace palpate::diagnosis
