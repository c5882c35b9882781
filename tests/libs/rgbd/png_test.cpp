// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/png.hpp"

#include <png.h>

#include <random>
#include <string_view>

#include "tests/support/test_folder.hpp"

namespace palpate::rgbd {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

namespace fs = std::filesystem;

template <typename Picture>
Picture Noise(int width, int height) {
  std::mt19937 random(3);
  Picture image(width, height);
  for (auto& value : image.values) {
    value = static_cast<std::decay_t<decltype(value)>>(random());
  }
  return image;
}

/// What a PNG of another program is made of.
struct ForeignPicture {
  int width = 2;
  int height = 1;
  int bit_depth = 8;
  int color_type = PNG_COLOR_TYPE_GRAY;
  int interlace = PNG_INTERLACE_NONE;
  std::string bytes;  ///< of all rows, as they stand in the file
  bool transparent_black = false;
};

/// Writes a PNG as libpng does when left alone; what fails in it ends the test program.
fs::path Save(const TestFolder& folder, ForeignPicture picture) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &bytes,
      [](png_structp p, png_bytep data, png_size_t size) {
        static_cast<std::string*>(png_get_io_ptr(p))->append(data, data + size);
      },
      [](png_structp) {});
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width),
               static_cast<png_uint_32>(picture.height), picture.bit_depth, picture.color_type,
               picture.interlace, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  const png_color palette[2] = {{10, 20, 30}, {200, 150, 100}};
  if (picture.color_type == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette, 2);
  const png_color_16 black{};
  if (picture.transparent_black) png_set_tRNS(png, info, nullptr, 0, &black);
  png_write_info(png, info);
  const std::size_t stride = picture.bytes.size() / static_cast<std::size_t>(picture.height);
  std::vector<png_bytep> rows;
  for (std::size_t row = 0; row < static_cast<std::size_t>(picture.height); ++row) {
    rows.push_back(reinterpret_cast<png_bytep>(picture.bytes.data()) + row * stride);
  }
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return folder.Write("foreign.png", bytes);
}

TEST(Png, ReadsBackEveryDepthValueAtEveryLevel) {
  const TestFolder folder;
  const DepthImage image = Noise<DepthImage>(37, 23);
  for (const int level : {0, 1, 6, 9}) {
    WriteDepthPng(folder.path() / "d.png", image, level);
    EXPECT_EQ(ReadDepthPng(folder.path() / "d.png"), image) << level;
  }
}

TEST(Png, ReadsBackEveryColourAtEveryLevel) {
  const TestFolder folder;
  const ColorImage image = Noise<ColorImage>(31, 17);
  for (const int level : {0, 1, 6, 9}) {
    WriteColorPng(folder.path() / "c.png", image, level);
    EXPECT_EQ(ReadColorPng(folder.path() / "c.png"), image) << level;
  }
}

TEST(Png, WritesThePixelsOfDepthWithTheHighByteFirst) {
  const TestFolder folder;
  DepthImage image(1, 1);
  image.values = {0x1234};
  WriteDepthPng(folder.path() / "d.png", image, 0);  // stored: the row stands in the file
  const std::string bytes = ReadFile(folder.path() / "d.png");
  EXPECT_NE(bytes.find("\x12\x34"), std::string::npos);
  EXPECT_EQ(bytes.find("\x34\x12"), std::string::npos);
}

TEST(Png, ReadsThePixelsOfDepthWithTheHighByteFirst) {
  const TestFolder folder;
  const DepthImage image =
      ReadDepthPng(Save(folder, {.bit_depth = 16, .bytes = std::string("\x12\x34\xff\x00", 4)}));
  EXPECT_THAT(image.values, ElementsAre(0x1234, 0xff00));
}

TEST(Png, SamePictureSameBytes) {
  const TestFolder folder;
  const ColorImage image = Noise<ColorImage>(40, 30);
  WriteColorPng(folder.path() / "a.png", image);
  WriteColorPng(folder.path() / "b.png", image);
  EXPECT_EQ(ReadFile(folder.path() / "a.png"), ReadFile(folder.path() / "b.png"));
  EXPECT_EQ(ReadFile(folder.path() / "a.png"), EncodeColorPng(image, 1));
}

TEST(Png, PressesAHigherLevelHarder) {
  ColorImage image(64, 64);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    image.values[i] = static_cast<std::uint8_t>((i * i) % 251);
  }
  EXPECT_GT(EncodeColorPng(image, 0).size(), EncodeColorPng(image, 1).size());
  EXPECT_GT(EncodeColorPng(image, 1).size(), EncodeColorPng(image, 9).size());
}

TEST(Png, MakesRgbOfGreyAndOfAPalette) {
  const TestFolder folder;
  EXPECT_THAT(ReadColorPng(Save(folder, {.bytes = std::string("\x07\xc8", 2)})).values,
              ElementsAre(7, 7, 7, 200, 200, 200));
  EXPECT_THAT(ReadColorPng(Save(folder, {.bit_depth = 1, .bytes = "\x40"})).values,
              ElementsAre(0, 0, 0, 255, 255, 255));
  EXPECT_THAT(ReadColorPng(Save(folder, {.color_type = PNG_COLOR_TYPE_PALETTE,
                                         .bytes = std::string("\x01\x00", 2)}))
                  .values,
              ElementsAre(200, 150, 100, 10, 20, 30));
}

TEST(Png, ReadsInterlacedPictures) {
  const TestFolder folder;
  const DepthImage image = Noise<DepthImage>(11, 9);
  ForeignPicture foreign{
      .width = 11, .height = 9, .bit_depth = 16, .interlace = PNG_INTERLACE_ADAM7, .bytes = {}};
  for (const std::uint16_t value : image.values) {
    foreign.bytes += static_cast<char>(value >> 8);
    foreign.bytes += static_cast<char>(value & 0xff);
  }
  EXPECT_EQ(ReadDepthPng(Save(folder, foreign)), image);
}

TEST(Png, RefusesDepthOfAnotherKind) {
  const TestFolder folder;
  const auto refusal = [&](const ForeignPicture& picture) {
    return MessageOf([&] { ReadDepthPng(Save(folder, picture)); });
  };
  EXPECT_THAT(refusal({.bytes = "ab"}), AllOf(HasSubstr("foreign.png: a depth image is 16-bit"),
                                              HasSubstr("8 bits of grey")));
  EXPECT_THAT(
      refusal({.width = 1, .bit_depth = 16, .color_type = PNG_COLOR_TYPE_RGB, .bytes = "abcdef"}),
      HasSubstr("16 bits of colour"));
  EXPECT_THAT(
      refusal(
          {.width = 1, .bit_depth = 16, .color_type = PNG_COLOR_TYPE_GRAY_ALPHA, .bytes = "abcd"}),
      HasSubstr("16 bits of colour"));
}

TEST(Png, DropsAnAlphaChannelThatIsOpaqueThroughout) {
  const TestFolder folder;
  const ColorImage image = ReadColorPng(Save(folder, {.color_type = PNG_COLOR_TYPE_RGB_ALPHA,
                                                      .bytes = "abc\xff"
                                                               "def\xff"}));
  EXPECT_EQ(std::string(image.values.begin(), image.values.end()), "abcdef");
  const ColorImage grey = ReadColorPng(
      Save(folder, {.width = 1, .color_type = PNG_COLOR_TYPE_GRAY_ALPHA, .bytes = "a\xff"}));
  EXPECT_EQ(std::string(grey.values.begin(), grey.values.end()), "aaa");
}

TEST(Png, RefusesColourOfAnotherKind) {
  const TestFolder folder;
  const auto refusal = [&](const ForeignPicture& picture) {
    return MessageOf([&] { ReadColorPng(Save(folder, picture)); });
  };
  EXPECT_THAT(refusal({.width = 1, .color_type = PNG_COLOR_TYPE_RGB_ALPHA, .bytes = "abcd"}),
              HasSubstr("alpha"));
  EXPECT_THAT(refusal({.bytes = std::string("a\0", 2), .transparent_black = true}),
              HasSubstr("transparent"));
  EXPECT_THAT(refusal({.bit_depth = 16, .bytes = "abcd"}),
              HasSubstr("8 bits a channel, this one has 16"));
}

TEST(Png, RefusesAFileThatIsCutShortWhereverItIsCut) {
  const TestFolder folder;
  WriteDepthPng(folder.path() / "d.png", Noise<DepthImage>(9, 7));
  const std::string whole = ReadFile(folder.path() / "d.png");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const fs::path file = folder.Write("cut.png", whole.substr(0, size));
    const std::string message = MessageOf([&] { ReadDepthPng(file); });
    ASSERT_THAT(message, AllOf(StartsWith(file.string()), HasSubstr("PNG"))) << size;
  }
}

TEST(Png, RefusesAFileWithAFlippedByteWhereItMatters) {
  const TestFolder folder;
  WriteDepthPng(folder.path() / "d.png", Noise<DepthImage>(9, 7));
  const std::string whole = ReadFile(folder.path() / "d.png");
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ 0x10);
    const fs::path file = folder.Write("flipped.png", bytes);
    ASSERT_THAT(MessageOf([&] { ReadDepthPng(file); }), HasSubstr("PNG")) << i;
  }
}

TEST(Png, RefusesAnAbsurdSizeBeforeItTakesMemory) {
  const TestFolder folder;
  ForeignPicture row{.width = 1'000'000, .height = 1, .bytes = std::string(1'000'000, 'x')};
  Save(folder, row);
  EXPECT_EQ(ReadColorPng(folder.path() / "foreign.png").width_px, 1'000'000);
  row.height = 65;
  row.bytes = std::string(65'000'000, 'x');
  EXPECT_THAT(MessageOf([&] { ReadColorPng(Save(folder, row)); }),
              HasSubstr("1000000 x 65 pixels; at most 64 million"));
}

TEST(Png, SaysThatAFileIsNoPictureOrIsNotThere) {
  const TestFolder folder;
  const fs::path text = folder.Write("text.png", "this is no picture at all");
  EXPECT_EQ(MessageOf([&] { ReadColorPng(text); }), text.string() + ": is no PNG image");
  EXPECT_THAT(MessageOf([&] { ReadDepthPng(folder.path() / "none.png"); }),
              HasSubstr("none.png: cannot be read: No such file"));
}

TEST(Png, SaysThatTheDiskIsFullAndLeavesNothingBehind) {
  const TestFolder folder;
  const ColorImage image = Noise<ColorImage>(8, 8);
  EXPECT_THAT(MessageOf<RunError>([&] { WriteColorPng(folder.path() / "none" / "a.png", image); }),
              AllOf(HasSubstr("a.png"), HasSubstr("cannot be written: No such file")));
  EXPECT_TRUE(fs::is_empty(folder.path()));
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THAT(MessageOf<RunError>([&] { WriteDepthPng("/dev/full", Noise<DepthImage>(8, 8)); }),
              StartsWith("/dev/full: cannot be written: No space"));
  EXPECT_THAT(MessageOf<RunError>([&] { WriteColorPng("/dev/full", image); }),
              HasSubstr("No space"));
}

TEST(PngDeathTest, AnEmptyPictureIsOurOwnMistake) {
  EXPECT_DEATH(WriteDepthPng("/dev/null", DepthImage()), "width_px > 0");
  EXPECT_DEATH(EncodeColorPng(ColorImage(1, 1), 10), "level");
}

}  // namespace
}  // namespace palpate::rgbd
