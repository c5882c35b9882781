// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/fixed_boxes.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"

namespace palpate::command {

namespace {

/// Room around the nodes, so that rounding leaves none out.
constexpr double kMarginOfElement = 0.05;

class BoxCover {
 public:
  BoxCover(const BodyShape& shape, const std::vector<int>& inside)
      : shape_(shape), is_inside_(shape.used.size(), false) {
    for (const int node : inside) is_inside_[At(node)] = true;
  }

  void Cover(std::vector<int> nodes) {
    const geometry::Box box = Around(nodes);
    if (nodes.size() == 1 || !HoldsOthers(box)) {
      boxes.push_back(box);
      return;
    }
    Eigen::Index axis = 0;
    (box.upper_m - box.lower_m).maxCoeff(&axis);
    const auto& nodes_m = shape_.mesh.nodes_m;
    const auto middle = nodes.begin() + ToIndex(nodes.size() / 2);
    std::nth_element(nodes.begin(), middle, nodes.end(),
                     [&](int a, int b) { return nodes_m(axis, a) < nodes_m(axis, b); });
    Cover({nodes.begin(), middle});
    Cover({middle, nodes.end()});
  }

  std::vector<geometry::Box> boxes;

 private:
  /// Bounds are rounded outward to a tenth of the margin: the file then has few digits.
  geometry::Box Around(const std::vector<int>& nodes) const {
    geometry::Box box = geometry::BoundingBox(shape_.mesh.nodes_m(Eigen::all, nodes));
    const double margin_m = kMarginOfElement * shape_.element_m;
    const double step_m = std::pow(10.0, std::floor(std::log10(margin_m)) - 1.0);
    box.lower_m = ((box.lower_m.array() - margin_m) / step_m).floor() * step_m;
    box.upper_m = ((box.upper_m.array() + margin_m) / step_m).ceil() * step_m;
    return box;
  }

  bool HoldsOthers(const geometry::Box& box) const {
    for (int node = 0; node < shape_.mesh.NodeCount(); ++node) {
      const bool other = shape_.used[At(node)] && !is_inside_[At(node)];
      if (other && box.Contains(shape_.mesh.nodes_m.col(node))) return true;
    }
    return false;
  }

  const BodyShape& shape_;
  std::vector<bool> is_inside_;
};

}  // namespace

std::vector<geometry::Box> BoxesAround(const BodyShape& shape, const std::vector<int>& inside) {
  BoxCover cover(shape, inside);
  cover.Cover(inside);
  return cover.boxes;
}

}  // namespace palpate::command
