// SPDX-License-Identifier: MIT
// Every option is a row; what the rows promise, the parser keeps.
#include "raytracer/options.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "raytracer/errors.h"

namespace stipple::raytracer {
namespace {

Options Parse(std::vector<const char*> words) {
  words.insert(words.begin(), "raytracer");
  return ParseOptions(static_cast<int>(words.size()), words.data());
}

std::string ProblemOf(const std::vector<const char*>& words) {
  try {
    Parse(words);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Options, HelpNamesEveryRow) {
  const std::string help = HelpText();
  for (const OptionSpec& spec : kOptions)
    EXPECT_NE(help.find("--" + std::string(spec.name)), std::string::npos) << spec.name;
}

TEST(Options, AnUnknownOptionIsNamedWithAllKnownOnes) {
  const std::string problem = ProblemOf({"--fast", "1"});
  EXPECT_EQ(problem.find("--fast: unknown option"), 0U) << problem;
  for (const OptionSpec& spec : kOptions)
    EXPECT_NE(problem.find("--" + std::string(spec.name)), std::string::npos) << spec.name;
}

TEST(Options, ValuesArriveWhereTheyBelong) {
  const Options options =
      Parse({"--scene", "teapot", "--resolution", "64x48", "--samples", "4", "--bundle=7",
             "--min-contribution", "0.25", "--seed", "12345678901"});
  EXPECT_EQ(options.scene, "teapot");
  EXPECT_EQ(options.resolution, (ImageSize{64, 48}));
  EXPECT_EQ(options.samples.per_pixel, 4);
  EXPECT_EQ(options.bundle, 7);
  EXPECT_EQ(options.min_contribution, 0.25);
  EXPECT_EQ(options.seed, 12345678901);
  EXPECT_TRUE(Parse({}).samples.corners());
  EXPECT_FALSE(Parse({}).explain);
  EXPECT_TRUE(Parse({"--explain", "--seed", "2"}).explain);
  EXPECT_EQ(Parse({"--patches", "16"}).patches, "16");
  EXPECT_EQ(Parse({"--patches", "direct"}).patches, "direct");
  EXPECT_EQ(Parse({"--compare", "a.png", "b.png"}).compare.second, "b.png");
}

TEST(Options, WrongValuesAreNamed) {
  for (const auto& [option, value] :
       std::vector<std::pair<const char*, const char*>>{{"--scene", "bals"},
                                                        {"--tile", "circles"},
                                                        {"--resolution", "64"},
                                                        {"--resolution", "0x4"},
                                                        {"--resolution", "4x"},
                                                        {"--samples", "edges"},
                                                        {"--samples", "0"},
                                                        {"--bundle", "-1"},
                                                        {"--bundle", "1.5"},
                                                        {"--max-depth", "nan"},
                                                        {"--output", "picture"},
                                                        {"--output", ".png"},
                                                        {"--cost-map", "map.gif"},
                                                        {"--patches", "some"},
                                                        {"--patches", "0"},
                                                        {"--camera", "behind"},
                                                        {"--seed", "99999999999999999999"},
                                                        {"--partition", ""}}) {
    const std::string problem = ProblemOf({option, value});
    EXPECT_EQ(problem.find(std::string(option) + " " + value), 0U) << problem;
  }
}

}  // namespace
}  // namespace stipple::raytracer
