// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/picture/rasteriser.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/core/check.hpp"

namespace palpate::view {

namespace {

constexpr float kEmpty = -std::numeric_limits<float>::infinity();

// How much of its own colour a surface shows: light from all around, two lamps, a faint gloss.
Color Shade(const Color& color, const Eigen::Vector3d& direction, const Lighting& lighting) {
  const double length = direction.norm();
  if (length == 0.0) {
    return color;
  }
  Eigen::Vector3d normal = direction / length;
  if (normal.dot(lighting.toward_viewer) < 0.0) {
    normal = -normal;
  }
  const double key = std::max(0.0, normal.dot(lighting.key));
  const double fill = std::max(0.0, normal.dot(lighting.fill));
  const double diffuse = 0.60 + 0.38 * key + 0.16 * fill;
  const Eigen::Vector3d halfway = (lighting.key + lighting.toward_viewer).normalized();
  const double gloss = 0.10 * std::pow(std::max(0.0, normal.dot(halfway)), 24.0);
  return {color.r * diffuse + gloss, color.g * diffuse + gloss, color.b * diffuse + gloss};
}

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// First and last sample whose centre lies in [from, to], cut to [0, count).
std::array<int, 2> SampleRange(double from, double to, int count) {
  const double first = std::ceil(std::clamp(from, -1.0, count + 1.0) - 0.5);
  const double last = std::floor(std::clamp(to, -1.0, count + 1.0) - 0.5);
  return {std::max(0, static_cast<int>(first)), std::min(count - 1, static_cast<int>(last))};
}

}  // namespace

Rasteriser::Rasteriser(int width_px, int height_px, int samples_per_px, const Color& background)
    : samples_per_px_(samples_per_px),
      columns_(width_px * samples_per_px),
      rows_(height_px * samples_per_px),
      samples_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
               {kEmpty, {ToByte(background.r), ToByte(background.g), ToByte(background.b)}}) {
  PALPATE_CHECK(width_px > 0 && height_px > 0 && samples_per_px > 0, width_px, height_px);
}

void Rasteriser::DrawTriangle(const std::array<Vertex, 3>& vertices, const Lighting& lighting) {
  std::array<Eigen::Vector2d, 3> p;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = samples_per_px_ * vertices[i].seen.head<2>();
  }
  const double twice_area = Cross(p[1] - p[0], p[2] - p[0]);
  if (twice_area == 0.0) {
    return;
  }
  const auto [low_x, high_x] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
  const auto [low_y, high_y] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
  const auto [first_x, last_x] = SampleRange(low_x, high_x, columns_);
  const auto [first_y, last_y] = SampleRange(low_y, high_y, rows_);
  for (int y = first_y; y <= last_y; ++y) {
    for (int x = first_x; x <= last_x; ++x) {
      const Eigen::Vector2d center(x + 0.5, y + 0.5);
      const double w0 = Cross(p[1] - center, p[2] - center) / twice_area;
      const double w1 = Cross(p[2] - center, p[0] - center) / twice_area;
      const double w2 = 1.0 - w0 - w1;
      if (w0 < 0.0 || w1 < 0.0 || w2 < 0.0) {
        continue;
      }
      const auto& [a, b, c] = vertices;
      const auto nearness = static_cast<float>(w0 * a.seen.z() + w1 * b.seen.z() + w2 * c.seen.z());
      Sample& sample = samples_[Index(x, y)];
      if (nearness <= sample.nearness) {
        continue;
      }
      const Color own{w0 * a.color.r + w1 * b.color.r + w2 * c.color.r,
                      w0 * a.color.g + w1 * b.color.g + w2 * c.color.g,
                      w0 * a.color.b + w1 * b.color.b + w2 * c.color.b};
      const Color lit = Shade(own, w0 * a.normal + w1 * b.normal + w2 * c.normal, lighting);
      sample = {nearness, {ToByte(lit.r), ToByte(lit.g), ToByte(lit.b)}};
    }
  }
}

void Rasteriser::DrawLine(const Eigen::Vector3d& from_seen, const Eigen::Vector3d& to_seen,
                          double width_px, const Color& color, double opacity) {
  const Eigen::Vector2d from = samples_per_px_ * from_seen.head<2>();
  const Eigen::Vector2d to = samples_per_px_ * to_seen.head<2>();
  const double radius = 0.5 * width_px * samples_per_px_;
  const Eigen::Vector2d along = to - from;
  const double length_squared = std::max(along.squaredNorm(), 1e-12);
  const auto [first_x, last_x] = SampleRange(std::min(from.x(), to.x()) - radius,
                                             std::max(from.x(), to.x()) + radius, columns_);
  const auto [first_y, last_y] =
      SampleRange(std::min(from.y(), to.y()) - radius, std::max(from.y(), to.y()) + radius, rows_);
  const std::array<double, 3> channels = {255.0 * color.r, 255.0 * color.g, 255.0 * color.b};
  for (int y = first_y; y <= last_y; ++y) {
    for (int x = first_x; x <= last_x; ++x) {
      const Eigen::Vector2d offset = Eigen::Vector2d(x + 0.5, y + 0.5) - from;
      const double t = std::clamp(offset.dot(along) / length_squared, 0.0, 1.0);
      if ((offset - t * along).squaredNorm() > radius * radius) {
        continue;
      }
      const auto nearness = static_cast<float>(from_seen.z() + t * (to_seen.z() - from_seen.z()));
      Sample& sample = samples_[Index(x, y)];
      if (nearness <= sample.nearness) {
        continue;
      }
      for (std::size_t c = 0; c < 3; ++c) {
        const double mixed = sample.rgb[c] + (channels[c] - sample.rgb[c]) * opacity;
        sample.rgb[c] = static_cast<std::uint8_t>(std::lround(mixed));
      }
      // A veil of colour hides nothing: what is drawn later may still show through it.
      if (opacity >= 1.0) {
        sample.nearness = nearness;
      }
    }
  }
}

void Rasteriser::Overlay(const Rasteriser& veil, double opacity, double margin) {
  const auto ahead = static_cast<float>(margin);
  PALPATE_CHECK(veil.samples_.size() == samples_.size() && veil.columns_ == columns_);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const Sample& over = veil.samples_[i];
    if (over.nearness == kEmpty || over.nearness <= samples_[i].nearness + ahead) {
      continue;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const double old = samples_[i].rgb[c];
      samples_[i].rgb[c] =
          static_cast<std::uint8_t>(std::lround(old + (over.rgb[c] - old) * opacity));
    }
  }
}

double Rasteriser::Coverage(int x, int y) const {
  int covered = 0;
  for (int row = y * samples_per_px_; row < (y + 1) * samples_per_px_; ++row) {
    for (int column = x * samples_per_px_; column < (x + 1) * samples_per_px_; ++column) {
      covered += samples_[Index(column, row)].nearness == kEmpty ? 0 : 1;
    }
  }
  return static_cast<double>(covered) / (samples_per_px_ * samples_per_px_);
}

double Rasteriser::NearnessAt(int x, int y) const {
  const int middle = samples_per_px_ / 2;
  return static_cast<double>(
      samples_[Index(x * samples_per_px_ + middle, y * samples_per_px_ + middle)].nearness);
}

Image Rasteriser::Resolve() const {
  Image image = Image::Filled(columns_ / samples_per_px_, rows_ / samples_per_px_, Color{});
  const int count = samples_per_px_ * samples_per_px_;
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      std::array<int, 3> sum = {0, 0, 0};
      for (int row = y * samples_per_px_; row < (y + 1) * samples_per_px_; ++row) {
        for (int column = x * samples_per_px_; column < (x + 1) * samples_per_px_; ++column) {
          const Sample& sample = samples_[Index(column, row)];
          for (std::size_t c = 0; c < 3; ++c) {
            sum[c] += sample.rgb[c];
          }
        }
      }
      std::uint8_t* pixel = image.Pixel(x, y);
      for (std::size_t c = 0; c < 3; ++c) {
        pixel[c] = static_cast<std::uint8_t>((sum[c] + count / 2) / count);
      }
    }
  }
  return image;
}

}  // namespace palpate::view
