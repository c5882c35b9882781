// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/skin/where_pictures_show_it.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "components/diagnosis/causes/makers.hpp"
#include "components/diagnosis/model/simulator.hpp"
#include "components/diagnosis/skin/skin_matcher.hpp"
#include "libs/geometry/closest_point.hpp"

namespace palpate::diagnosis {

namespace {

/// Points that lie farther off the skin are of something else, or on a leg that is elsewhere.
constexpr double kFarthest_m = 0.03;
/// Points of a picture that are looked at, about as many.
constexpr Eigen::Index kPoints = 500;
/// Another robot is taken for it where the mean square of what points are off by is so much less.
constexpr double kClearlyLess = 0.5;

/// How much more of its way than all cables in the mean one is pulled; NaN: it is not driven then.
double PulledApart(const Timeline& timeline, const Eigen::VectorXd& most, const Sample& sample,
                   Eigen::Index cable) {
  const double t_s = 0.5 * (sample.frame_t_s.front() + sample.frame_t_s.back());
  const Eigen::VectorXd share = timeline.CommandAt(t_s).cwiseQuotient(most);
  return share[cable] - share.array().isNaN().select(0.0, share.array()).mean();
}

/// The samples with pictures in which each of the cables is pulled apart from the others the most.
ObservedExperiment OfMostPulled(ObservedExperiment observed) {
  const Timeline& timeline = observed.timeline;
  Eigen::VectorXd most = Eigen::VectorXd::Zero(std::ssize(timeline.cables));
  for (const Eigen::VectorXd& command : timeline.command) {
    most = command.array().isNaN().select(most, command.cwiseMax(most));
  }
  std::set<std::size_t> telling;
  for (Eigen::Index c = 0; c < most.size(); ++c) {
    double farthest = 0.0;
    std::size_t best = observed.samples.size();
    for (std::size_t s = 0; s < observed.samples.size(); ++s) {
      if (observed.samples[s].pictures.empty()) continue;
      const double apart = PulledApart(timeline, most, observed.samples[s], c);
      if (!(apart > farthest)) continue;
      farthest = apart;
      best = s;
    }
    if (best < observed.samples.size()) telling.insert(best);
  }
  std::vector<Sample> samples;
  for (const std::size_t s : telling) samples.push_back(std::move(observed.samples[s]));
  observed.samples = std::move(samples);
  return observed;
}

/// Mean square of the distances of what pictures show from the skin of a robot of these shapes, m2;
/// NaN where one is missing or nothing was seen.
double MeanSquare_m2(const ObservedExperiment& observed, const SkinClouds& clouds,
                     const std::vector<ShapesInTime>& shapes, geometry::SurfaceIndex* surface) {
  double sum_m2 = 0.0;
  double count = 0.0;
  for (std::size_t s = 0; s < clouds.size(); ++s) {
    if (shapes[s].empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto r = static_cast<std::size_t>(observed.samples[s].recording);
    const Eigen::Isometry3d T_robot_camera = observed.recordings[r].T_camera_robot->inverse();
    for (const SeenCloud& seen : clouds[s]) {
      surface->Refit(shapes[s].At(seen.picture.t_s, shapes[s].nodes_m).cast<double>());
      const Eigen::Index step = std::max<Eigen::Index>(1, seen.cloud.points_m.cols() / kPoints);
      for (Eigen::Index k = 0; k < seen.cloud.points_m.cols(); k += step) {
        const Eigen::Vector3d point_m = T_robot_camera * seen.cloud.points_m.col(k).cast<double>();
        sum_m2 += std::pow(std::min(surface->Closest(point_m).distance_m, kFarthest_m), 2);
        ++count;
      }
    }
  }
  return sum_m2 / count;
}

}  // namespace

ShownRobot WherePicturesShowIt(const robot::RobotBody& body, const ObservedExperiment& observed,
                               int threads, SkinSource* pictures) {
  const ObservedExperiment telling = OfMostPulled(observed);
  const Simulator simulator(telling, threads);
  const auto shapes_of = [&](const ModelDraft& draft) {
    return simulator.Shapes(draft, simulator.Run(draft));
  };
  ShownRobot nearest{.draft = DraftOf(body, observed)};
  const ModelDraft as_in_file = nearest.draft;
  const std::vector<ShapesInTime> shapes = shapes_of(as_in_file);
  SkinMatcher matcher(body);
  matcher.Look(telling, shapes, pictures);
  geometry::SurfaceIndex surface({body.mesh.nodes_m, body.boundary.DrawnTriangles()});
  double least_m2 = kClearlyLess * MeanSquare_m2(telling, matcher.clouds(), shapes, &surface);
  std::vector<CausePtr> exchanges;
  MakeSwappedCables({.body = body, .observed = telling}, &exchanges);
  for (const CausePtr& exchange : exchanges) {
    ModelDraft draft = as_in_file;
    exchange->Apply(Eigen::VectorXd::Ones(1), &draft);
    const double mean_m2 = MeanSquare_m2(telling, matcher.clouds(), shapes_of(draft), &surface);
    if (!(mean_m2 < least_m2)) continue;
    least_m2 = mean_m2;
    nearest = {std::move(draft), exchange->name()};
  }
  return nearest;
}

}  // namespace palpate::diagnosis
