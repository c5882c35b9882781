// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/picture/scene.hpp"

#include "components/view/picture/check_scene.hpp"
#include "components/view/picture/furniture.hpp"
#include "components/view/picture/png.hpp"
#include "components/view/picture/rasteriser.hpp"
#include "components/view/picture/stage.hpp"

namespace palpate::view {

Image RenderScene(const Scene& scene) {
  CheckScene(scene);
  const PageLayout page = LayOutPage(scene);
  const double margin_px = 22.0 * page.px;  // for the thickness of lines and arrow heads
  const Rect area{page.stage.x_px + margin_px, page.stage.y_px + margin_px,
                  page.stage.width_px - 2.0 * margin_px, page.stage.height_px - 2.0 * margin_px};
  const Camera camera = Camera::Fit(scene.view, ExtentsOf(scene), area);
  Rasteriser stage(scene.width_px, scene.height_px, scene.samples_per_px, palette::kPaper);
  DrawStage(scene, camera, page.px, &stage);
  Image image = stage.Resolve();
  DrawAnnotations(scene, page, camera, stage, &image);
  DrawFurniture(scene, page, camera, &image);
  return image;
}

void SaveScene(const std::filesystem::path& path, const Scene& scene) {
  WritePng(path, RenderScene(scene));
}

}  // namespace palpate::view
