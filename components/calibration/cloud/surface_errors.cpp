// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/cloud/surface_errors.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "libs/geometry/surface_sampling.hpp"

namespace palpate::calibration {

namespace {

/// Wider bells make errors smoother, and each point has shares in more regions.
struct SurfaceErrorTuning {
  double bell = 0.5;        ///< standard deviation of a region's Gaussian weight, in region lengths
  double reach = 3.0;       ///< standard deviations beyond which a region has no share
  int most_centres = 1000;  ///< of patches or regions; bounds the cost of large robots
};
constexpr SurfaceErrorTuning kSurfaceErrorTuning;
constexpr int kFaces = 6;  // of a cube

/// Nodes of the surface, each once.
Eigen::Matrix3Xd SurfaceNodes(const robot::RobotBody& body) {
  const Eigen::MatrixXi& faces = body.boundary.faces;
  std::vector<int> nodes(faces.data(), faces.data() + faces.size());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return body.mesh.nodes_m(Eigen::all, nodes);
}

/// Subset with a spacing of at least `spacing_m` that leaves no point farther away than that.
Eigen::Matrix3Xd Spread(const Eigen::Matrix3Xd& points_m, double spacing_m) {
  const int most = std::min(kSurfaceErrorTuning.most_centres, static_cast<int>(points_m.cols()));
  const std::vector<int> order = geometry::FarthestPoints(points_m, most);
  Eigen::Matrix3Xd middles_m = points_m(Eigen::all, order);
  Eigen::Index count = 1;
  while (count < middles_m.cols() &&
         (middles_m.leftCols(count).colwise() - middles_m.col(count)).colwise().norm().minCoeff() >=
             spacing_m) {
    ++count;
  }
  return middles_m.leftCols(count);
}

/// The face of a cube whose normal is nearest.
int FaceTowards(const Eigen::Vector3d& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return 2 * static_cast<int>(axis) + (normal[axis] > 0.0 ? 1 : 0);
}

int PatchAt(const Eigen::Matrix3Xd& patches_m, const Eigen::Vector3d& place_m,
            const Eigen::Vector3d& normal) {
  Eigen::Index patch = 0;
  (patches_m.colwise() - place_m).colwise().squaredNorm().minCoeff(&patch);
  return kFaces * static_cast<int>(patch) + FaceTowards(normal);
}

/// Weight of a region in the error of a point.
struct Part {
  int region = 0;
  double weight = 0.0;
};

/// The squares add up to 1, so that the error has the same variance everywhere.
std::vector<Part> PartsAt(const Eigen::Matrix3Xd& regions_m, double region_m,
                          const Eigen::Vector3d& place_m) {
  const Eigen::VectorXd away =
      (regions_m.colwise() - place_m).colwise().norm() / (kSurfaceErrorTuning.bell * region_m);
  const double nearest = away.minCoeff();
  std::vector<Part> parts;
  double squares = 0.0;
  for (Eigen::Index r = 0; r < away.size(); ++r) {
    if (away[r] > std::max(kSurfaceErrorTuning.reach, nearest)) continue;
    const double weight = std::exp(0.5 * (nearest * nearest - away[r] * away[r]));
    parts.push_back({static_cast<int>(r), weight});
    squares += weight * weight;
  }
  for (Part& part : parts) part.weight /= std::sqrt(squares);
  return parts;
}

enum class Kind { kWhole, kPatch, kRegion, kMotion, kRegionMotion };

/// Numbers the parameters of the errors in the order of their first use.
class Numbers {
 public:
  void Add(SurfaceSighting* sighting, Kind kind, int place, int which, double per_unit_m) {
    if (per_unit_m == 0.0) return;
    const int next = static_cast<int>(are_models_own_.size());
    const auto [at, is_new] = numbers_.try_emplace({kind, place, which}, next);
    if (is_new) are_models_own_.push_back(kind != Kind::kMotion && kind != Kind::kRegionMotion);
    sighting->shared.push_back({at->second, per_unit_m});
  }
  const std::vector<bool>& are_models_own() const { return are_models_own_; }

 private:
  std::map<std::tuple<Kind, int, int>, int> numbers_;
  std::vector<bool> are_models_own_;
};

}  // namespace

SurfaceErrors::SurfaceErrors(const robot::RobotBody& body, Eigen::VectorXd rest_m,
                             const SurfaceErrorSettings& settings)
    : settings_(settings), undeformed_m_(body.mesh.nodes_m.reshaped()), rest_m_(std::move(rest_m)) {
  const Eigen::Matrix3Xd surface_m = SurfaceNodes(body);
  patches_m_ = Spread(surface_m, settings.patch_m);
  regions_m_ = Spread(surface_m, settings.region_m);
}

std::vector<bool> SurfaceErrors::Share(const std::vector<Eigen::VectorXd>& shapes_m,
                                       std::vector<CalibrationFrame>* frames) const {
  Numbers numbers;
  for (std::size_t f = 0; f < frames->size(); ++f) {
    for (SurfaceSighting& sighting : (*frames)[f].surface) {
      const Eigen::Vector3d& normal = sighting.normal;
      const Eigen::Vector3d place_m = sighting.point.Position(undeformed_m_);
      const double moved_m =
          normal.dot(sighting.point.Position(shapes_m[f]) - sighting.point.Position(rest_m_));
      sighting.shared.clear();
      numbers.Add(&sighting, Kind::kWhole, 0, 0, settings_.whole_sigma_m);
      numbers.Add(&sighting, Kind::kPatch, PatchAt(patches_m_, place_m, normal), 0,
                  settings_.patch_sigma_m);
      numbers.Add(&sighting, Kind::kMotion, 0, 0, settings_.motion_sigma * moved_m);
      for (const Part& part : PartsAt(regions_m_, settings_.region_m, place_m)) {
        for (int axis = 0; axis < 3; ++axis) {
          numbers.Add(&sighting, Kind::kRegion, part.region, axis,
                      settings_.region_sigma_m * part.weight * normal[axis]);
        }
        numbers.Add(&sighting, Kind::kRegionMotion, part.region, static_cast<int>(f),
                    settings_.region_motion_sigma * part.weight * moved_m);
      }
    }
  }
  return numbers.are_models_own();
}

}  // namespace palpate::calibration
