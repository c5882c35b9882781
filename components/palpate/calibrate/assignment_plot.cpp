// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/calibrate/assignment_plot.hpp"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "components/palpate/calibrate/plot_projection.hpp"
#include "components/view/picture/color.hpp"
#include "libs/core/file.hpp"
#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"
#include "libs/plot/label_layout.hpp"
#include "libs/plot/svg_document.hpp"
#include "libs/rgbd/png.hpp"

namespace palpate::command {

namespace {

using calibration::MarkerSighting;
using plot::SvgDocument;
using plot::SvgPoint;
using plot::SvgText;

constexpr int kMostColumns = 3;
constexpr double kWidth_px = 470.0, kHeight_px = 350.0, kGap_px = 16.0, kTitle_px = 22.0;
constexpr double kHead_px = 58.0, kLegend_px = 96.0;

const view::Color kPoint = view::palette::kMarker;
const view::Color kModel = view::palette::kTruth;
const view::Color kMissing = view::palette::kMutedInk;
const view::Color kFalse = view::palette::kEstimate;

double Residual_m(const AssignmentPanel& panel, const MarkerSighting& point) {
  return (point.position_m - panel.model_m.col(point.marker)).norm();
}

/// The factor by which ellipses and lines are enlarged.
double ChooseEnlargement(const std::vector<AssignmentPanel>& panels, const PlainView& plain) {
  constexpr double kLargest_px = 34.0;
  double largest_px = 0.0;
  for (const AssignmentPanel& panel : panels) {
    const PlotProjection projection(panel, plain, {0.0, 0.0, kWidth_px, kHeight_px});
    for (const MarkerSighting& point : panel.points) {
      if (point.marker < 0) continue;
      const auto derivative = projection.Derivative(point.position_m);
      const Eigen::Vector3d off_m = panel.model_m.col(point.marker) - point.position_m;
      const double sigma_px =
          std::sqrt((derivative * point.covariance_m2 * derivative.transpose()).trace());
      largest_px = std::max({largest_px, (derivative * off_m).norm(), kSigmas95InPlane * sigma_px});
    }
  }
  double enlargement = 1.0;
  for (const double one : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0}) {
    if (one * largest_px <= kLargest_px) enlargement = one;
  }
  return enlargement;
}

std::vector<SvgPoint> Ring(const SvgPoint& center, const Eigen::Matrix2d& half_axes_px) {
  constexpr int kCorners = 40;
  std::vector<SvgPoint> ring;
  for (int k = 0; k <= kCorners; ++k) {
    const double angle = 6.283185307179586 * k / kCorners;
    const Eigen::Vector2d off_px = half_axes_px * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    ring.push_back({center.x_px + off_px.x(), center.y_px + off_px.y()});
  }
  return ring;
}

void Circle(const SvgPoint& center, double radius_px, const plot::SvgStroke& stroke,
            SvgDocument* svg) {
  svg->Polyline(Ring(center, radius_px * Eigen::Matrix2d::Identity()), stroke);
}

void Cross(const SvgPoint& at, double half_px, const view::Color& color, SvgDocument* svg) {
  const plot::SvgStroke stroke{color, 2.0};
  svg->Line({at.x_px - half_px, at.y_px - half_px}, {at.x_px + half_px, at.y_px + half_px}, stroke);
  svg->Line({at.x_px - half_px, at.y_px + half_px}, {at.x_px + half_px, at.y_px - half_px}, stroke);
}

constexpr double kLabel_px = 11.0;

double LengthOf(const std::string& text) {
  return 0.66 * kLabel_px * static_cast<double>(text.size());
}

/// A text that is legible on an image.
void Label(const view::Rect& place, const std::string& text, const view::Color& color,
           SvgDocument* svg) {
  svg->Polygon({{place.x_px - 2.0, place.y_px},
                {place.right_px() + 2.0, place.y_px},
                {place.right_px() + 2.0, place.bottom_px()},
                {place.x_px - 2.0, place.bottom_px()}},
               view::palette::kPaper, 0.72);
  svg->Text({place.x_px, place.bottom_px() - 3.5}, text, {.size_px = kLabel_px, .color = color});
}

view::Rect Around(const SvgPoint& center, double half_px) {
  return {center.x_px - half_px, center.y_px - half_px, 2.0 * half_px, 2.0 * half_px};
}

/// Draws one panel.
class PanelDrawing {
 public:
  PanelDrawing(const AssignmentPanel& panel, const PlainView& plain, const view::Rect& frame,
               double enlargement, SvgDocument* svg)
      : panel_(panel),
        frame_(frame),
        projection_(panel, plain, frame),
        enlargement_(enlargement),
        view_name_(plain.name),
        svg_(svg) {}

  void Draw(const std::vector<std::string>& names) {
    svg_->BeginGroup("panel", {frame_.x_px, frame_.y_px}, frame_.width_px, frame_.height_px);
    svg_->Rectangle({frame_.x_px, frame_.y_px}, frame_.width_px, frame_.height_px,
                    view::palette::kShadow);
    DrawPicture();
    std::vector<char> seen(names.size(), 0);
    for (const MarkerSighting& point : panel_.points) {
      if (point.marker >= 0) seen[At(point.marker)] = 1;
    }
    for (std::size_t m = 0; m < names.size(); ++m) {
      if (seen[m] == 0) DrawMissing(ToIndex(m), names[m]);
    }
    for (const MarkerSighting& point : panel_.points) DrawPoint(point, names);
    DrawScale();
    DrawNotes();
    svg_->EndGroup();
    DrawTitle();
  }

 private:
  /// A mark on the panel, and what is to be written beside it.
  struct Note {
    SvgPoint at;
    std::string text;
    view::Color color;
  };

  void AddNote(const SvgPoint& at, double clear_px, const std::string& text,
               const view::Color& color) {
    notes_.push_back({at, text, color});
    taken_.push_back(Around(at, clear_px));
  }

  /// Beside their marks and clear of all of them; a thin line where that is not near.
  void DrawNotes() {
    constexpr double kNear_px = 28.0;
    std::vector<plot::LabelRequest> requests;
    for (const Note& note : notes_) {
      requests.push_back({{note.at.x_px, note.at.y_px}, LengthOf(note.text), kLabel_px + 3.0});
    }
    const auto places =
        plot::PlaceLabels(requests, frame_, taken_, [](int /*x*/, int /*y*/) { return 0.0; });
    for (std::size_t k = 0; k < notes_.size(); ++k) {
      const view::Rect& place = places[k];
      const SvgPoint at = notes_[k].at;
      const SvgPoint nearest{std::clamp(at.x_px, place.x_px, place.right_px()),
                             std::clamp(at.y_px, place.y_px, place.bottom_px())};
      if (std::hypot(nearest.x_px - at.x_px, nearest.y_px - at.y_px) > kNear_px) {
        svg_->Line(at, nearest, {kMissing, 0.7});
      }
      Label(place, notes_[k].text, notes_[k].color, svg_);
    }
  }

  void DrawPicture() {
    if (panel_.ground.color.empty()) return;
    const Eigen::Vector2i first = projection_.first_px(), last = projection_.last_px();
    rgbd::ColorImage part(last.x() - first.x(), last.y() - first.y());
    for (int v = first.y(); v < last.y(); ++v) {
      const std::uint8_t* row = panel_.ground.color.Pixel(first.x(), v);
      std::copy_n(row, 3 * part.width_px, part.Pixel(0, v - first.y()));
    }
    const view::Rect at = projection_.PictureFrame();
    svg_->Image({at.x_px, at.y_px}, at.width_px, at.height_px, rgbd::EncodeColorPng(part, 6));
  }

  void DrawMissing(Eigen::Index marker, const std::string& name) {
    const SvgPoint at = projection_.At(panel_.model_m.col(marker));
    Circle(at, 6.0, {kMissing, 1.5, true}, svg_);
    AddNote(at, 6.0, name + " not seen", kMissing);
  }

  void DrawPoint(const MarkerSighting& point, const std::vector<std::string>& names) {
    const SvgPoint at = projection_.At(point.position_m);
    if (point.marker < 0) {
      Cross(at, 5.0, kFalse, svg_);
      AddNote(at, 5.0, "no marker", kFalse);
      return;
    }
    const auto derivative = projection_.Derivative(point.position_m);
    const Eigen::Matrix2d covariance_px2 =
        derivative * point.covariance_m2 * derivative.transpose();
    const Eigen::Matrix2d root = Eigen::LLT<Eigen::Matrix2d>(covariance_px2).matrixL();
    svg_->Polyline(Ring(at, enlargement_ * kSigmas95InPlane * root), {kPoint, 1.5});
    svg_->Dot(at, 2.5, kPoint);
    const Eigen::Vector3d off_m = panel_.model_m.col(point.marker) - point.position_m;
    const Eigen::Vector2d off_px = enlargement_ * (derivative * off_m);
    const SvgPoint model{at.x_px + off_px.x(), at.y_px + off_px.y()};
    svg_->Line(at, model, {kModel, 2.0});
    Circle(model, 3.5, {kModel, 2.0}, svg_);
    taken_.push_back(Around(model, 3.5));
    const double ring_px =
        enlargement_ * kSigmas95InPlane * std::sqrt(0.5 * covariance_px2.trace());
    AddNote(at, std::clamp(ring_px - 4.0, 4.0, 14.0),
            fmt::format("{} {:.2f} mm", names[At(point.marker)], 1e3 * Residual_m(panel_, point)),
            view::palette::kInk);
  }

  void DrawScale() {
    const double per_m = projection_.Pixels_per_m();
    double length_m = 1e-3;
    for (const double one : {2e-3, 5e-3, 1e-2, 2e-2, 5e-2, 0.1, 0.2, 0.5, 1.0}) {
      if (one * per_m <= 0.3 * frame_.width_px) length_m = one;
    }
    const SvgPoint from{frame_.x_px + 12.0, frame_.y_px + frame_.height_px - 12.0};
    const SvgPoint to{from.x_px + length_m * per_m, from.y_px};
    const std::string text = fmt::format("{:g} mm", 1e3 * length_m);
    const view::Rect place{from.x_px + 2.0, from.y_px - 21.0, LengthOf(text), kLabel_px + 3.0};
    Label(place, text, view::palette::kInk, svg_);
    taken_.push_back(place);
    taken_.push_back({from.x_px, from.y_px - 2.0, to.x_px - from.x_px, 4.0});
    svg_->Line(from, to, {view::palette::kPaper, 5.0});
    svg_->Line(from, to, {view::palette::kInk, 2.5});
  }

  void DrawTitle() {
    int matched = 0;
    double squares_m2 = 0.0;
    for (const MarkerSighting& point : panel_.points) {
      if (point.marker < 0) continue;
      ++matched;
      squares_m2 += std::pow(Residual_m(panel_, point), 2);
    }
    const double rms_mm = 1e3 * std::sqrt(squares_m2 / std::max(1, matched));
    const SvgPoint at{frame_.x_px, frame_.y_px - 7.0};
    svg_->Text(at, panel_.name, {.size_px = 13.0, .bold = true});
    svg_->Text(
        {frame_.x_px + frame_.width_px, at.y_px},
        fmt::format("{} of {} markers, residual {:.2f} mm RMS{}", matched, panel_.model_m.cols(),
                    rms_mm, panel_.ground.color.empty() ? "; seen " + view_name_ : std::string()),
        {.anchor = SvgText::Anchor::kEnd, .size_px = 12.0, .color = view::palette::kMutedInk});
  }

  const AssignmentPanel& panel_;
  view::Rect frame_;
  PlotProjection projection_;
  double enlargement_;
  std::string view_name_;
  SvgDocument* svg_;
  std::vector<Note> notes_;
  std::vector<view::Rect> taken_;
};

void DrawLegend(double top_px, double enlargement, SvgDocument* svg) {
  const std::string times = fmt::format("{:g}", enlargement);
  const double left_px = kGap_px + 14.0;
  const auto text = [&](int line, const std::string& words) {
    svg->Text({left_px + 28.0, top_px + 20.0 * line + 4.0}, words, {.size_px = 12.0});
  };
  svg->Polyline(Ring({left_px, top_px}, Eigen::Vector2d(11.0, 7.0).asDiagonal()), {kPoint, 1.5});
  svg->Dot({left_px, top_px}, 2.5, kPoint);
  text(0, "measured point; the ellipse holds it with 95 %, enlarged " + times + " times");
  svg->Line({left_px - 8.0, top_px + 20.0}, {left_px + 8.0, top_px + 20.0}, {kModel, 2.0});
  Circle({left_px + 8.0, top_px + 20.0}, 3.5, {kModel, 2.0}, svg);
  text(1, "marker of the calibrated model, enlarged " + times +
              " times; the number is the distance in space");
  Circle({left_px, top_px + 40.0}, 6.0, {kMissing, 1.5, true}, svg);
  text(2, "marker of the model that was not seen");
  Cross({left_px, top_px + 60.0}, 5.0, kFalse, svg);
  text(3, "point that is no marker of the robot");
}

}  // namespace

Eigen::Matrix3Xd MarkersInCamera(const robot::RobotModel& model, const Eigen::VectorXd& x_m,
                                 const geometry::RigidTransform& T_robot_camera) {
  const auto& markers = model.body().markers;
  Eigen::Matrix3Xd markers_m(3, ToIndex(markers.size()));
  for (std::size_t m = 0; m < markers.size(); ++m) {
    markers_m.col(ToIndex(m)) = markers[m].point.weights.Position(x_m);
  }
  return T_robot_camera.Inverse().Apply(markers_m);
}

void DrawAssignment(const std::filesystem::path& file, const std::vector<std::string>& marker_names,
                    const std::vector<AssignmentPanel>& panels) {
  const int count = static_cast<int>(panels.size());
  const int columns = std::clamp(count, 1, kMostColumns);
  const int rows = (count + columns - 1) / columns;
  const double row_px = kHeight_px + kTitle_px + kGap_px;
  const double width_px = kGap_px + columns * (kWidth_px + kGap_px);
  const double legend_px = kHead_px + rows * row_px + kGap_px;
  SvgDocument svg(static_cast<int>(std::max(width_px, 640.0)),
                  static_cast<int>(legend_px + kLegend_px - kGap_px));
  svg.Rectangle({0.0, 0.0}, std::max(width_px, 640.0), legend_px + kLegend_px,
                view::palette::kPaper);
  svg.Text({kGap_px, 24.0}, "Assignment of points to markers", {.size_px = 17.0, .bold = true});
  const PlainView plain = ChooseView(panels);
  const double enlargement = ChooseEnlargement(panels, plain);
  for (int k = 0; k < count; ++k) {
    const view::Rect frame{kGap_px + k % columns * (kWidth_px + kGap_px),
                           kHead_px + k / columns * row_px, kWidth_px, kHeight_px};
    PanelDrawing(panels[At(k)], plain, frame, enlargement, &svg).Draw(marker_names);
  }
  DrawLegend(legend_px, enlargement, &svg);
  WriteFile(file, svg.Finish());
}

void DrawFrames(const std::filesystem::path& file,
                const std::vector<calibration::CalibrationFrame>& frames,
                const calibration::JointCalibration& fit, const robot::RobotModel& model) {
  std::vector<AssignmentPanel> panels;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    if (frames[f].own_pose >= 0) continue;
    panels.push_back({.name = frames[f].name,
                      .points = frames[f].markers,
                      .model_m = MarkersInCamera(model, fit.x_m[f], fit.T_robot_camera),
                      .ground = {}});
  }
  DrawAssignment(file, model.MarkerNames(), panels);
}

}  // namespace palpate::command
