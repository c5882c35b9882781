// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/independent/touched_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <iterator>
#include <optional>
#include <random>
#include <stdexcept>
#include <utility>

#include "libs/rgbd/png.hpp"

namespace palpate::test_support {

namespace {

namespace fs = std::filesystem;
using Positions = CalculixBody::Positions;
using SurfacePoint = CalculixBody::SurfacePoint;

constexpr double kMm = 1e-3;
constexpr double kPressRadius_mm = 6.0;
const Eigen::Vector3d kRobotColor(0.86, 0.80, 0.68);

struct Cable {
  std::string name;
  Eigen::Vector3d anchor_mm;
  Eigen::Vector3d eyelet_mm;
};

/// What is needed of a robot of config/robots.
struct Robot {
  CalculixBody body;
  std::vector<Cable> cables;
  std::vector<ColoredMesh> furniture;
  Eigen::Vector3d eye_m, target_m;
  double lowest_touch_mm;        ///< contacts on what is that far from the clamp
  Eigen::Vector3d clamp_normal;  ///< of the plane from which that counts, through the clamp
  double clamp_at_mm;
  SurfacePoint tip;  ///< where weights lie
  /// Largest cosine of a contact's normal with clamp_normal. A push along a bar shortens it by less
  /// than the depth noise: EA / L of the rod is 2 250 N/m, so that 1 N shows as 0.4 mm.
  double most_along = 1.0;
};

SurfacePoint Highest(const CalculixBody& body, const Eigen::Vector2d& at_mm) {
  SurfacePoint best;
  double nearest = 1e9;
  for (std::size_t face = 0; face < body.faces().size(); ++face) {
    for (const std::array<double, 3>& l :
         {std::array{1.0, 0.0, 0.0}, std::array{0.0, 1.0, 0.0}, std::array{0.0, 0.0, 1.0},
          std::array{1.0 / 3, 1.0 / 3, 1.0 / 3}}) {
      const SurfacePoint point{face, l};
      const Eigen::Vector3d x = body.At(point, body.nodes_mm());
      if (body.NormalAt(point, body.nodes_mm()).z() < 0.7) continue;
      const double off = (x.head<2>() - at_mm).norm() - 1e-3 * x.z();
      if (off >= nearest) continue;
      nearest = off;
      best = point;
    }
  }
  return best;
}

Robot FourLeg() {
  // The mesh is coarser than the robot file's; with this modulus its compliance is that of the
  // converged body of 100 kPa (config/scenarios/README.md).
  CalculixBody body = CalculixBody::FromGmsh(
      PALPATE_SOURCE_DIR "/config/scenarios/four_leg_coarse.msh", {.youngs_modulus_MPa = 0.0967});
  body.Fix([](const Eigen::Vector3d& x) { return x.z() < 1.0; });
  const SurfacePoint tip = Highest(body, {0.0, 0.0});
  return {.body = std::move(body),
          .cables = {{"north", {0, 62, 0}, {0, 31, 90}},
                     {"west", {-62, 0, 0}, {-31, 0, 90}},
                     {"south", {0, -62, 0}, {0, -31, 90}},
                     {"east", {62, 0, 0}, {31, 0, 90}}},
          .furniture = {Block({-0.7, -0.7, -0.02}, {0.7, 0.7, -0.0005}, {0.42, 0.47, 0.55}),
                        Block({-0.72, -0.9, -0.1}, {-0.70, 0.9, 0.9}, {0.72, 0.72, 0.76})},
          .eye_m = {0.343, -0.198, 0.275},
          .target_m = {0.0, 0.0, 0.065},
          .lowest_touch_mm = 45.0,
          .clamp_normal = Eigen::Vector3d::UnitZ(),
          .clamp_at_mm = 0.0,
          .tip = tip};
}

Robot Rod() {
  CalculixBody body =
      CalculixBody::Bar({-100, 0, 0}, {0, 30, 30}, {14, 4, 4}, {.youngs_modulus_MPa = 0.25});
  body.Fix([](const Eigen::Vector3d& x) { return x.x() < -99.5; });
  const SurfacePoint tip = Highest(body, {-12.0, 15.0});
  return {.body = std::move(body),
          .cables = {},
          .furniture = {Block({-0.6, -0.6, -0.20}, {0.6, 0.6, -0.15}, {0.42, 0.47, 0.55}),
                        Block({-0.14, -0.02, -0.15}, {-0.1002, 0.05, 0.05}, {0.25, 0.25, 0.28})},
          .eye_m = {0.16, -0.28, 0.24},
          .target_m = {-0.045, 0.015, 0.005},
          .lowest_touch_mm = 40.0,
          .clamp_normal = Eigen::Vector3d::UnitX(),
          .clamp_at_mm = -100.0,
          .tip = tip,
          .most_along = 0.5};
}

ColoredMesh SkinOf(const CalculixBody& body, const Positions& positions_mm) {
  ColoredMesh mesh{.vertices_m = {}, .triangles = body.Triangles(), .color_rgb = kRobotColor};
  for (const Eigen::Vector3d& x : positions_mm) mesh.vertices_m.push_back(kMm * x);
  return mesh;
}

class Maker {
 public:
  Maker(const TouchedScenesPlan& plan, fs::path folder)
      : plan_(plan),
        folder_(std::move(folder)),
        robot_(plan.robot == "rod" ? Rod() : FourLeg()),
        camera_(plan.camera),
        random_(plan.seed),
        rest_({SkinOf(robot_.body, robot_.body.nodes_mm())}) {
    camera_.T_robot_camera = LookAt(robot_.eye_m, robot_.target_m);
  }

  std::vector<TrueContact> Make() {
    fs::create_directories(folder_ / "recordings");
    WriteExperiment();
    for (int k = 0; k < plan_.postures; ++k) {
      Make(k == 0 ? "rest" : "hold", k == 0 ? "rest" : "hold", 0, k > 0);
    }
    for (int k = 0; k < plan_.weights; ++k) Make("weight", "free", 0, false);
    for (int k = 0; k < plan_.single; ++k) Make("single", "free", 1, k % 2 == 1);
    for (int k = 0; k < plan_.pairs; ++k) Make("pair", "free", 2, k % 2 == 1);
    for (int k = 0; k < plan_.hidden; ++k) Make("hidden", "free", 1, false);
    for (int k = 0; k < plan_.alone; ++k) Make("alone", "free", 0, k > 0);
    return std::move(truth_);
  }

 private:
  double Uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1.0p-53;
  }

  Eigen::Vector3d DrawColor() {
    static const std::vector<Eigen::Vector3d> kColors = {{0.15, 0.30, 0.80}, {0.15, 0.65, 0.30},
                                                         {0.80, 0.25, 0.20}, {0.20, 0.20, 0.22},
                                                         {0.85, 0.70, 0.15}, {0.60, 0.60, 0.62}};
    return kColors[static_cast<std::size_t>(Uniform(0.0, 5.999))];
  }

  bool IsSeen(const Eigen::Vector3d& position_m) const {
    const Eigen::Vector3d eye_m = camera_.T_robot_camera.translation();
    const RayCaster::Hit hit = rest_.Cast(eye_m, position_m - eye_m);
    return hit.distance > 0.99;
  }

  std::optional<SurfacePoint> DrawPoint(bool seen, const std::vector<Eigen::Vector3d>& taken_mm) {
    const CalculixBody& body = robot_.body;
    for (int trial = 0; trial < 10000; ++trial) {
      const auto face =
          static_cast<std::size_t>(Uniform(0.0, static_cast<double>(body.faces().size()) - 1e-6));
      if (Uniform(0.0, 120.0) > body.AreaOf(face)) continue;
      const double b = Uniform(0.15, 0.5), c = Uniform(0.15, 0.5);
      const SurfacePoint point{face, {1.0 - b - c, b, c}};
      const Eigen::Vector3d x = body.At(point, body.nodes_mm());
      const Eigen::Vector3d normal = body.NormalAt(point, body.nodes_mm());
      if (robot_.clamp_normal.dot(x) - robot_.clamp_at_mm < robot_.lowest_touch_mm) continue;
      const Eigen::Vector3d to_eye = (camera_.T_robot_camera.translation() - kMm * x).normalized();
      const double facing = normal.dot(to_eye);
      if (seen ? facing < 0.35 || !IsSeen(kMm * x) : facing > -0.3) continue;
      if (!seen && normal.z() < -0.5) continue;
      if (std::abs(normal.dot(robot_.clamp_normal)) > robot_.most_along) continue;
      const bool apart = std::all_of(taken_mm.begin(), taken_mm.end(),
                                     [&](const auto& t) { return (t - x).norm() > 40.0; });
      // A ball comes there: nothing of the body is nearer than its radius.
      const Eigen::Vector3d centre = x + 10.0 * normal;
      const bool is_free =
          std::all_of(body.nodes_mm().begin(), body.nodes_mm().end(),
                      [&](const Eigen::Vector3d& node) { return (node - centre).norm() > 9.3; });
      if (apart && is_free) return point;
    }
    return std::nullopt;
  }

  /// Equilibrium under tensions that follow the eyelets: a fixed point of their places, by Aitken's
  /// relaxation. Throws std::runtime_error where there is none, or where they do not come to rest.
  Positions Solve(const CalculixBody::Loads& loads, const Eigen::VectorXd& tension_N) const {
    constexpr double kAtRest_mm = 0.03;
    constexpr int kMostRounds = 12;
    const bool pulled = tension_N.size() > 0 && tension_N.maxCoeff() > 0.0;
    Eigen::VectorXd at_mm = Eyelets_mm(robot_.body.nodes_mm());
    Eigen::VectorXd last_step_mm = Eigen::VectorXd::Zero(at_mm.size());
    double relaxation = 1.0;
    for (int round = 0; round < kMostRounds; ++round) {
      CalculixBody::Loads all = loads;
      AddPulls(at_mm, tension_N, &all);
      Positions positions = robot_.body.Solve(all);
      const Eigen::VectorXd step_mm = Eyelets_mm(positions) - at_mm;
      if (!pulled || step_mm.lpNorm<Eigen::Infinity>() < kAtRest_mm) return positions;
      const Eigen::VectorXd change_mm = step_mm - last_step_mm;
      if (round > 0) relaxation *= -last_step_mm.dot(change_mm) / change_mm.squaredNorm();
      at_mm += relaxation * step_mm;
      last_step_mm = step_mm;
    }
    throw std::runtime_error("the cables' eyelets do not come to rest");
  }

  void AddPulls(const Eigen::VectorXd& eyelets_mm, const Eigen::VectorXd& tension_N,
                CalculixBody::Loads* loads) const {
    for (std::size_t c = 0; c < robot_.cables.size(); ++c) {
      const auto index = static_cast<Eigen::Index>(c);
      const Eigen::Vector3d along_mm =
          robot_.cables[c].anchor_mm - eyelets_mm.segment<3>(3 * index);
      for (const auto& [node, w] : robot_.body.WeightsInside(robot_.cables[c].eyelet_mm)) {
        loads->try_emplace(node, Eigen::Vector3d::Zero()).first->second +=
            w * tension_N[index] * along_mm.normalized();
      }
    }
  }

  /// [3 cables]
  Eigen::VectorXd Eyelets_mm(const Positions& positions_mm) const {
    Eigen::VectorXd eyelets_mm = Eigen::VectorXd::Zero(3 * std::ssize(robot_.cables));
    for (std::size_t c = 0; c < robot_.cables.size(); ++c) {
      for (const auto& [node, w] : robot_.body.WeightsInside(robot_.cables[c].eyelet_mm)) {
        eyelets_mm.segment<3>(3 * static_cast<Eigen::Index>(c)) +=
            w * positions_mm[static_cast<std::size_t>(node)];
      }
    }
    return eyelets_mm;
  }

  struct Touch {
    std::vector<SurfacePoint> points;
    std::vector<Eigen::Vector3d> forces_N;
    Eigen::VectorXd tension_N;
    Positions shape;
  };

  Touch Draw(const std::string& group, int balls) {
    Touch touch;
    std::vector<Eigen::Vector3d> taken_mm;
    for (int b = 0; b < balls; ++b) {
      const auto point = DrawPoint(group != "hidden", taken_mm);
      if (!point) throw std::runtime_error("no place for a ball");
      touch.points.push_back(*point);
      taken_mm.push_back(robot_.body.At(*point, robot_.body.nodes_mm()));
      touch.forces_N.push_back(-Uniform(0.3, 1.2) *
                               robot_.body.NormalAt(*point, robot_.body.nodes_mm()));
    }
    if (group == "weight") {
      touch.points.push_back(robot_.tip);
      touch.forces_N.push_back(-Uniform(0.3, 1.2) * Eigen::Vector3d::UnitZ());
    }
    return touch;
  }

  Eigen::VectorXd DrawTensions(bool pulled) {
    Eigen::VectorXd tension_N =
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(robot_.cables.size()));
    for (double& tension : tension_N) {
      if (pulled) tension = Uniform(0.0, plan_.largest_tension_N);
    }
    return tension_N;
  }

  /// Forces and tensions under which CalculiX finds no equilibrium are drawn again.
  Touch DrawBalanced(const std::string& group, int balls, bool pulled) {
    constexpr int kDraws = 20;
    for (int draw = 1;; ++draw) {
      Touch touch = Draw(group, balls);
      touch.tension_N = DrawTensions(pulled);
      CalculixBody::Loads loads;
      for (std::size_t p = 0; p < touch.points.size(); ++p) {
        robot_.body.Press(touch.points[p], kPressRadius_mm, touch.forces_N[p], &loads);
      }
      try {
        touch.shape = Solve(loads, touch.tension_N);
        return touch;
      } catch (const std::runtime_error&) {
        if (draw == kDraws) throw;
      }
    }
  }

  void Make(const std::string& group, const std::string& kind, int balls, bool pulled) {
    char number[8];
    std::snprintf(number, sizeof(number), "%03d", count_++);
    const std::string name = std::string(number) + "_" + group;
    const Touch touch = DrawBalanced(group, balls, pulled);
    const auto& [points, forces_N, tension_N, shape] = touch;
    std::vector<ColoredMesh> meshes = robot_.furniture;
    meshes.push_back(SkinOf(robot_.body, shape));
    for (std::size_t p = 0; p < points.size(); ++p) {
      const Eigen::Vector3d at_m = kMm * robot_.body.At(points[p], shape);
      const Eigen::Vector3d normal = robot_.body.NormalAt(points[p], shape);
      truth_.push_back({name, group, at_m, forces_N[p]});
      if (group == "weight") {
        meshes.push_back(WeightOn(at_m));
      } else {
        const double radius_m = kMm * Uniform(8.0, 12.0);
        meshes.push_back(Ball(at_m + radius_m * normal, radius_m, DrawColor()));
      }
    }
    WriteRecording(name, kind, tension_N, RayCaster(meshes));
  }

  /// By turns a disc, a block and a ball.
  ColoredMesh WeightOn(const Eigen::Vector3d& at_m) {
    const double half_m = kMm * Uniform(10.0, 18.0);
    const double height_m = kMm * Uniform(12.0, 30.0);
    const Eigen::Vector3d rgb = DrawColor();
    switch (weights_++ % 3) {
      case 0: return Cylinder(at_m, half_m, height_m, rgb);
      case 1:
        return Block(at_m - Eigen::Vector3d(half_m, half_m, 0.0),
                     at_m + Eigen::Vector3d(half_m, half_m, height_m), rgb);
      default: return Ball(at_m + half_m * Eigen::Vector3d::UnitZ(), half_m, rgb);
    }
  }

  void WriteExperiment() const {
    Eigen::Isometry3d told = camera_.T_robot_camera;
    const Eigen::Vector3d& turn = plan_.pose_error_rad;
    if (turn.norm() > 0.0) told.rotate(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
    told.pretranslate(plan_.pose_error_m);
    const Eigen::Quaterniond q(told.linear());
    std::ofstream file(folder_ / "experiment.yaml");
    file << std::setprecision(12) << "frame: camera\nT_robot_camera: {translation_m: ["
         << told.translation().x() << ", " << told.translation().y() << ", "
         << told.translation().z() << "], rotation_xyzw: [" << q.x() << ", " << q.y() << ", "
         << q.z() << ", " << q.w() << "]}\n";
  }

  void WriteRecording(const std::string& name, const std::string& kind,
                      const Eigen::VectorXd& tension_N, const RayCaster& caster) {
    const fs::path folder = folder_ / "recordings" / name;
    fs::create_directories(folder / "depth");
    fs::create_directories(folder / "color");
    std::ofstream(folder / "recording.yaml") << "kind: " << kind << "\n";
    std::ofstream camera(folder / "camera.yaml");
    for (const char* which : {"depth", "color"}) {
      camera << which << ": {width_px: " << camera_.width_px << ", height_px: " << camera_.height_px
             << ", fx_px: " << camera_.f_px << ", fy_px: " << camera_.f_px
             << ", cx_px: " << camera_.cx_px << ", cy_px: " << camera_.cy_px;
      if (which == std::string("depth")) {
        camera << ", unit_m: " << camera_.unit_m << ", baseline_m: " << camera_.baseline_m << "}\n";
      } else {
        camera << ", registered_to_depth: true}\n";
      }
    }
    if (tension_N.size() > 0) {
      std::ofstream actuation(folder / "actuation.csv");
      actuation << "t_s";
      for (const Cable& cable : robot_.cables) actuation << "," << cable.name << ".tension_N";
      actuation << "\n" << 10 * count_;
      for (const double tension : tension_N) actuation << "," << tension;
      actuation << "\n";
    }
    for (int k = 0; k < plan_.frames; ++k) {
      const CastImage cast = caster.Take(camera_, plan_.errors, &random_);
      rgbd::DepthImage depth(camera_.width_px, camera_.height_px);
      rgbd::ColorImage color(camera_.width_px, camera_.height_px);
      std::copy(cast.depth.begin(), cast.depth.end(), depth.values.begin());
      std::copy(cast.rgb.begin(), cast.rgb.end(), color.values.begin());
      const std::string file =
          std::to_string(10'000'000'000LL * count_ + 100'000'000LL * k) + ".png";
      rgbd::WriteDepthPng(folder / "depth" / file, depth);
      rgbd::WriteColorPng(folder / "color" / file, color);
    }
  }

  TouchedScenesPlan plan_;
  fs::path folder_;
  Robot robot_;
  PinholeCamera camera_;
  std::mt19937_64 random_;
  RayCaster rest_;
  int count_ = 0;
  int weights_ = 0;
  std::vector<TrueContact> truth_;
};

}  // namespace

std::vector<TrueContact> WriteTouchedScenes(const TouchedScenesPlan& plan, const fs::path& folder) {
  return Maker(plan, folder).Make();
}

}  // namespace palpate::test_support
