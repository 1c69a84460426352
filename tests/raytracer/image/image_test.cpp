// SPDX-License-Identifier: MIT
// Pictures survive the way to disk and back, and differences are told and shown.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <limits>

#include "raytracer/errors.h"
#include "raytracer/image/compare.h"
#include "raytracer/image/exr_file.h"
#include "raytracer/image/png_file.h"
#include "raytracer/image/ramp.h"
#include "raytracer/render/progress.h"

namespace stipple::raytracer {
namespace {

LinearImage Grey(float value) { return {{4, 2}, std::vector<float>(24, value)}; }

std::string TemporaryPath(const std::string& name) {
  return (std::filesystem::path(testing::TempDir()) / name).string();
}

TEST(Compare, SaysHowFarAndWhere) {
  const LinearImage a = Grey(0.5F);
  EXPECT_TRUE(Compare(a, a).Identical());
  EXPECT_EQ(DifferenceText(Compare(a, a)), "identical: 4x2 pixels\n");
  LinearImage b = a;
  b.rgb[3 * 6 + 1] = 0.75F;  // column 2, row 1
  const ImageDifference difference = Compare(a, b);
  EXPECT_EQ(difference.pixels, 1U);
  EXPECT_EQ(difference.largest, 0.25);
  EXPECT_NEAR(difference.rmse, 0.25 / std::sqrt(24.0), 1e-12);
  EXPECT_EQ(DifferenceText(difference),
            "different: 1 of 4x2 pixels (12.5 %), RMSE 13.01 of 255, PSNR 25.8 dB, largest "
            "difference 63.75 of 255 at column 2, row 1\n");
  EXPECT_FALSE(Compare(a, {{1, 1}, {0, 0, 0}}).Identical());
}

TEST(Compare, NumbersThatAreNoneDiffer) {
  LinearImage a = Grey(1);
  a.rgb[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(Compare(a, Grey(1)).pixels, 1U);
}

TEST(Compare, DifferingPixelsGlowOnGrey) {
  const LinearImage a = Grey(0.5F);
  LinearImage b = a;
  b.rgb[0] = 0.5F + 1.0F / 255;
  b.rgb[3] = 1.5F;
  const Image picture = DifferencePicture(a, b);
  const auto pixel = [&](std::size_t i) {
    return Rgb{picture.rgb[3 * i], picture.rgb[3 * i + 1], picture.rgb[3 * i + 2]};
  };
  EXPECT_EQ(pixel(0), std::begin(kGlow)[0]);
  EXPECT_EQ(pixel(1), std::end(kGlow)[-1]);
  EXPECT_EQ(pixel(2), (Rgb{65, 65, 65}));
}

TEST(ImageFiles, BytesComeBackFromPng) {
  const std::string path = TemporaryPath("stipple_image_test.png");
  Image image{{2, 1}, {0, 1, 2, 253, 254, 255}};
  WritePng(image, path);
  EXPECT_EQ(ReadPng(path).rgb, image.rgb);
  EXPECT_EQ(ReadPicture(path).rgb[5], 1.0F);
  std::filesystem::remove(path);
}

TEST(ImageFiles, NumbersComeBackFromExrOrTheBuildSaysWhatItNeeds) {
  const std::string path = TemporaryPath("stipple_image_test.exr");
  const LinearImage image{{2, 2}, {0, 1e-6F, 7, 0.1F, 0.2F, 0.3F, 1, 1, 1, 0.5F, 1e6F, 0}};
  try {
    NeedExr(path);
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("libopenexr-dev"), std::string::npos);
    return;
  }
  WriteExr(image, path);
  const LinearImage back = ReadPicture(path);
  EXPECT_EQ(back.size, image.size);
  EXPECT_EQ(back.rgb, image.rgb);
  std::filesystem::remove(path);
  EXPECT_THROW(ReadExr(path), InputError);
}

TEST(Ramp, GetsBrighterAllTheWay) {
  for (const std::span<const Rgb> ramp :
       {std::span<const Rgb>(kViridis), std::span<const Rgb>(kGlow)}) {
    double last = -1;
    for (int i = 0; i <= 100; ++i) {
      const Rgb color = ColorAt(ramp, i / 100.0);
      const double luma = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
      EXPECT_GT(luma, last - 0.6) << i;
      last = luma;
    }
  }
}

TEST(Progress, TellsShareAndTimeLeft) {
  EXPECT_EQ(ProgressText(1, 4, 2), "tracing: 25 %, about 6 s left");
  EXPECT_EQ(ProgressText(1, 100, 1), "tracing: 1 %, about 1 min 39 s left");
  EXPECT_EQ(ProgressText(1, 1000, 10), "tracing: 0 %, about 2 h 46 min left");
}

}  // namespace
}  // namespace stipple::raytracer
