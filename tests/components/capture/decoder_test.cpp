// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>

#include "components/capture/decode/color_decoder.hpp"
#include "components/capture/decode/depth_decoder.hpp"

namespace palpate::capture {
namespace {

/// Values of one type as a camera would send them, in memory of exactly their size, so that a
/// sanitizer sees any byte that is read beyond.
class Wire {
 public:
  template <typename T>
  Wire(std::initializer_list<T> values) {
    size_ = values.size() * sizeof(T);
    bytes_ = std::make_unique<std::uint8_t[]>(size_);
    std::memcpy(bytes_.get(), values.begin(), size_);
  }
  ImagePart Part(PixelFormat format, int width, int height, int padding = 0) const {
    return {bytes_.get(), size_, format, width, height, padding, 0};
  }

 private:
  std::size_t size_;
  std::unique_ptr<std::uint8_t[]> bytes_;
};

using U16 = std::uint16_t;
using Values = std::vector<U16>;

Values Decode(const DepthDecoder& decoder, const ImagePart& part) {
  rgbd::DepthImage image;
  std::size_t valid = 0;
  const Status status = decoder.Decode(part, &image, &valid);
  EXPECT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(valid, static_cast<std::size_t>(std::count_if(image.values.begin(), image.values.end(),
                                                          [](U16 z) { return z != 0; })));
  return image.values;
}

Scan3dDescription Projected(double scale, double offset = 0.0) {
  Scan3dDescription d;
  d.coordinates[2] = {scale, offset, true, 0.0};
  return d;
}

TEST(DepthDecoder, RawStepsOfTheCamerasOwnUnitComeThroughUnchanged) {
  const Scan3dDescription d = Projected(0.1);
  const DepthDecoder decoder(d, ChooseDepthUnit(d, PixelFormat::kCoord3dC16, {}));
  EXPECT_DOUBLE_EQ(decoder.depth_unit_m(), 1e-4);
  for (int first = 0; first < 65536; first += 4096) {
    std::vector<U16> raw(4096);
    for (std::size_t i = 0; i < raw.size(); ++i)
      raw[i] = static_cast<U16>(first + static_cast<int>(i));
    ImagePart part = {reinterpret_cast<const std::uint8_t*>(raw.data()),
                      2 * raw.size(),
                      PixelFormat::kCoord3dC16,
                      64,
                      64,
                      0,
                      0};
    EXPECT_EQ(Decode(decoder, part), raw);
  }
}

TEST(DepthDecoder, ScaleOffsetAndUnitAreApplied) {
  // value = raw * 0.5 - 100 mm; steps of 0.2 mm.
  const DepthDecoder decoder(Projected(0.5, -100.0), 2e-4);
  const Wire wire = {U16{0}, U16{200}, U16{202}, U16{1200}, U16{26414}, U16{26415}};
  EXPECT_EQ(Decode(decoder, wire.Part(PixelFormat::kCoord3dC16, 3, 2)),
            (Values{0, 0, 5, 2500, 65535, 0}));
}

TEST(DepthDecoder, BeyondSixteenBitsIsNoDepthRatherThanAWrappedOne) {
  const DepthDecoder decoder(Projected(1.0), 1e-4);  // raw mm, steps of 0.1 mm
  const Wire wire = {U16{6553}, U16{6554}};
  EXPECT_EQ(Decode(decoder, wire.Part(PixelFormat::kCoord3dC16, 2, 1)), (Values{65530, 0}));
}

TEST(DepthDecoder, TheFlaggedValueMeansNoDepth) {
  Scan3dDescription d = Projected(1.0);
  d.coordinates[2].invalid_raw = 65535.0;
  const DepthDecoder decoder(d, 1e-3);
  const Wire wire = {U16{65535}, U16{65534}, U16{0}};
  EXPECT_EQ(Decode(decoder, wire.Part(PixelFormat::kCoord3dC16, 3, 1)), (Values{0, 65534, 0}));
}

TEST(DepthDecoder, FloatsThatAreNoNumberNegativeOrFarAreNoDepth) {
  const DepthDecoder decoder(Projected(1.0), 1e-4);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const Wire wire = {500.04f, 500.06f, nan, infinity, -1.0f, 0.0f, 6553.5f, 6553.6f};
  EXPECT_EQ(Decode(decoder, wire.Part(PixelFormat::kCoord3dC32f, 4, 2)),
            (Values{5000, 5001, 0, 0, 0, 0, 65535, 0}));
}

TEST(DepthDecoder, DisparityIsFocalLengthTimesBaselineOverZ) {
  Scan3dDescription d;
  d.mode = OutputMode::kDisparityC;
  d.coordinates[2] = {1.0 / 16.0, 0.0, true, 0.0};
  d.camera.fx_px = 600.0;
  d.baseline_m = 0.05;
  const DepthDecoder decoder(d, 1e-4);
  for (const double z_m : {0.3, 0.45, 0.6, 1.0, 3.0}) {
    const double disparity_px = d.camera.fx_px * d.baseline_m / z_m;
    const auto raw = static_cast<U16>(std::lround(disparity_px * 16.0));
    const Wire wire = {raw};
    const double got_m = 1e-4 * Decode(decoder, wire.Part(PixelFormat::kDisparity16, 1, 1))[0];
    // Half a step of the disparity, and half a step of the depth.
    EXPECT_NEAR(got_m, z_m, z_m * z_m / (600.0 * 0.05) / 32.0 * 1.01 + 0.5e-4);
  }
  const Wire none = {U16{0}};
  EXPECT_EQ(Decode(decoder, none.Part(PixelFormat::kDisparity16, 1, 1)), Values{0});
}

TEST(DepthDecoder, OfThreeCoordinatesTheThirdIsZAndAnyMarkedOneTakesThePointAway) {
  Scan3dDescription d = Projected(1.0);
  d.mode = OutputMode::kCalibratedAbcGrid;
  for (CoordinateRule& rule : d.coordinates) rule = {1.0, 0.0, true, 65535.0};
  const DepthDecoder decoder(d, 1e-3);
  const Wire wire = {U16{1}, U16{2}, U16{300}, U16{65535}, U16{2},     U16{301},
                     U16{0}, U16{0}, U16{302}, U16{1},     U16{65535}, U16{303}};
  EXPECT_EQ(Decode(decoder, wire.Part(PixelFormat::kCoord3dAbc16, 4, 1)), (Values{300, 0, 302, 0}));
}

TEST(DepthDecoder, OneImageWithXyzAndIntensityGivesBoth) {
  const DepthDecoder decoder(Projected(0.25), 2.5e-4);
  const Wire wire = {U16{9}, U16{9}, U16{4000}, U16{0x1234},
                     U16{9}, U16{9}, U16{5000}, U16{0xff00}};
  const ImagePart part = wire.Part(PixelFormat::kCoord3dAbcy16, 2, 1);
  EXPECT_EQ(Decode(decoder, part), (Values{4000, 5000}));
  rgbd::ColorImage color;
  ASSERT_TRUE(DecodeColor(part, &color).ok());
  EXPECT_EQ(color.values, (std::vector<std::uint8_t>{0x12, 0x12, 0x12, 0xff, 0xff, 0xff}));
}

TEST(DepthDecoder, ThirtyTwoBitCoordinatesOfAGrid) {
  Scan3dDescription d = Projected(1.0);
  d.distance_unit_m = 1.0;
  const DepthDecoder decoder(d, 1e-4);
  const Wire wire = {-0.1f, 0.2f, 0.5f, std::numeric_limits<float>::quiet_NaN(), 0.2f, 0.5f};
  EXPECT_EQ(Decode(decoder, wire.Part(PixelFormat::kCoord3dAbc32f, 2, 1)), (Values{5000, 0}));
}

TEST(DepthDecoder, PaddingAtTheEndOfRowsIsLeftOut) {
  const DepthDecoder decoder(Projected(1.0), 1e-3);
  const Wire wire = {U16{1}, U16{2}, U16{99}, U16{3}, U16{4}};
  EXPECT_EQ(Decode(decoder, wire.Part(PixelFormat::kCoord3dC16, 2, 2, 2)), (Values{1, 2, 3, 4}));
}

TEST(Decoders, AShortBufferOrAnAbsurdSizeIsRefusedWithoutReadingOn) {
  const DepthDecoder decoder(Projected(1.0), 1e-3);
  const Wire wire = {U16{1}, U16{2}, U16{3}};
  rgbd::DepthImage depth;
  rgbd::ColorImage color;
  std::size_t valid = 0;
  const int most = std::numeric_limits<int>::max();
  const int least = std::numeric_limits<int>::min();
  const ImagePart bad[] = {wire.Part(PixelFormat::kCoord3dC16, 2, 2),
                           wire.Part(PixelFormat::kCoord3dC16, 4, 1),
                           wire.Part(PixelFormat::kCoord3dC16, most, most),
                           wire.Part(PixelFormat::kCoord3dC16, -1, 1),
                           wire.Part(PixelFormat::kCoord3dC16, 0, 0),
                           wire.Part(PixelFormat::kCoord3dC16, 1, 2, most),
                           wire.Part(PixelFormat::kCoord3dC16, 1, 2, least),
                           wire.Part(PixelFormat::kCoord3dAbcy16, 1, 1),
                           wire.Part(PixelFormat::kRgb8, 1, 1),
                           wire.Part(PixelFormat::kUnknown, 1, 1),
                           {nullptr, 100, PixelFormat::kCoord3dC16, 1, 1, 0, 0}};
  for (const ImagePart& part : bad) EXPECT_FALSE(decoder.Decode(part, &depth, &valid).ok());
  const ImagePart bad_color[] = {
      wire.Part(PixelFormat::kRgb8, 3, 1), wire.Part(PixelFormat::kMono16, 2, 2),
      wire.Part(PixelFormat::kBayerRg8, 7, 1), wire.Part(PixelFormat::kCoord3dC16, 1, 1),
      wire.Part(PixelFormat::kMono8, most, 1)};
  for (const ImagePart& part : bad_color) EXPECT_FALSE(DecodeColor(part, &color).ok());
}

TEST(ColorDecoder, ChannelsEndUpInTheOrderOfRgb) {
  const std::vector<std::uint8_t> rgb = {10, 20, 30};
  const Wire three = {std::uint8_t{10}, std::uint8_t{20}, std::uint8_t{30}};
  const Wire reversed = {std::uint8_t{30}, std::uint8_t{20}, std::uint8_t{10}};
  const Wire four = {std::uint8_t{10}, std::uint8_t{20}, std::uint8_t{30}, std::uint8_t{99}};
  const Wire four_reversed = {std::uint8_t{30}, std::uint8_t{20}, std::uint8_t{10},
                              std::uint8_t{9}};
  rgbd::ColorImage image;
  ASSERT_TRUE(DecodeColor(three.Part(PixelFormat::kRgb8, 1, 1), &image).ok());
  EXPECT_EQ(image.values, rgb);
  ASSERT_TRUE(DecodeColor(reversed.Part(PixelFormat::kBgr8, 1, 1), &image).ok());
  EXPECT_EQ(image.values, rgb);
  ASSERT_TRUE(DecodeColor(four.Part(PixelFormat::kRgba8, 1, 1), &image).ok());
  EXPECT_EQ(image.values, rgb);
  ASSERT_TRUE(DecodeColor(four_reversed.Part(PixelFormat::kBgra8, 1, 1), &image).ok());
  EXPECT_EQ(image.values, rgb);
  const Wire grey = {U16{0xab00}};
  ASSERT_TRUE(DecodeColor(grey.Part(PixelFormat::kMono16, 1, 1), &image).ok());
  EXPECT_EQ(image.values, (std::vector<std::uint8_t>{0xab, 0xab, 0xab}));
}

TEST(ColorDecoder, AMosaicOfOneColourGivesThatColourEverywhere) {
  const struct {
    PixelFormat format;
    int red_u, red_v;
  } mosaics[] = {{PixelFormat::kBayerRg8, 0, 0},
                 {PixelFormat::kBayerGr8, 1, 0},
                 {PixelFormat::kBayerGb8, 0, 1},
                 {PixelFormat::kBayerBg8, 1, 1}};
  for (const auto& mosaic : mosaics) {
    std::vector<std::uint8_t> raw(5 * 6);
    for (int v = 0; v < 5; ++v) {
      for (int u = 0; u < 6; ++u) {
        const bool red_u = (u & 1) == mosaic.red_u;
        const bool red_v = (v & 1) == mosaic.red_v;
        raw[static_cast<std::size_t>(6 * v + u)] = red_u && red_v ? 200 : red_u || red_v ? 100 : 40;
      }
    }
    rgbd::ColorImage image;
    const ImagePart part = {raw.data(), raw.size(), mosaic.format, 6, 5, 0, 0};
    ASSERT_TRUE(DecodeColor(part, &image).ok());
    for (std::size_t i = 0; i < image.values.size(); i += 3) {
      EXPECT_EQ(image.values[i], 200) << NameOf(mosaic.format) << " at " << i / 3;
      EXPECT_EQ(image.values[i + 1], 100);
      EXPECT_EQ(image.values[i + 2], 40);
    }
  }
}

TEST(PixelFormatCodes, ADeviceMayNameItsOwnFormatsButNotRenameTheStandards) {
  PixelFormatCodes codes;
  EXPECT_EQ(codes.FormatOf(0x011000B8), PixelFormat::kCoord3dC16);
  EXPECT_EQ(codes.FormatOf(0x82400001), PixelFormat::kUnknown);
  codes.Learn("Coord3D_ABCY16", 0x82400001);
  codes.Learn("RGB8", 0x011000B8);
  codes.Learn("Mono8", -1);
  codes.Learn("Nonsense", 5);
  EXPECT_EQ(codes.FormatOf(0x82400001), PixelFormat::kCoord3dAbcy16);
  EXPECT_EQ(codes.FormatOf(0x011000B8), PixelFormat::kCoord3dC16);
  EXPECT_EQ(codes.FormatOf(0xffffffff), PixelFormat::kUnknown);
  EXPECT_EQ(codes.FormatOf(5), PixelFormat::kUnknown);
}

}  // namespace
}  // namespace palpate::capture
