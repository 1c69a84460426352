// SPDX-License-Identifier: MIT
// Input that no method survives is refused where it is read, with the line it stands in: a NaN that
// reaches a bounding box makes whole subtrees vanish, and a cone without height divides by zero.
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "raytracer/errors.h"
#include "raytracer/scene/nff.h"

namespace stipple::raytracer {
namespace {

const std::string kView = "v from 0 0 9 at 0 0 0 up 0 1 0 angle 45 hither 0 resolution 8 8\n";

/// The message, or "accepted".
std::string ProblemOf(const std::string& text) {
  try {
    ParseNff(text, "x.nff");
    return "accepted";
  } catch (const InputError& error) {
    return error.what();
  }
}

struct BadText {
  const char* text;     // follows the view, so that its first line is line 2
  const char* problem;  // how the message begins, after "x.nff:"
};
constexpr BadText kBadTexts[] = {
    // No surface.
    {"s 1 2 3 0\n", "2: sphere of radius 0"},
    {"s 1 2 3 -0\n", "2: sphere of radius 0"},
    {"c 1 2 3 1  1 2 3 1\n", "2: the cone's base and apex coincide"},
    {"c 0 0 0 0  0 0 1 0\n", "2: cone of radius 0 at both ends"},
    {"c 0 0 0 1  0 0 1 -1\n", "2: the cone's radii have different signs"},
    {"p 3 1 1 1  1 1 1  1 1 1\n", "2: polygon of zero area"},
    {"p 3 0 0 0  1 1 1  2 2 2\n", "2: polygon of zero area"},
    {"p 4 0 0 0  1 0 0  0 0 0  1 0 0\n", "2: polygon of zero area"},
    {"s 0 0 0 1\np 3 0 0 0  0.1 0.3 0.7  0.2 0.6 1.4\n", "3: polygon of zero area"},
    {"pp 3 0 0 0 0 0 1  1 0 0 0 0 1  2 0 0 0 0 1\n", "2: polygon of zero area"},
    {"pp 3 0 0 0 0 0 1  1 0 0 0 0 0  0 1 0 0 0 1\n", "2: normal of length 0"},
    // Too few, too many, or no number of vertices.
    {"p 2 0 0 0  1 0 0\n", "2: the polygon's number of vertices is 2"},
    {"p 0\n", "2: the polygon's number of vertices is 0"},
    {"p -3 0 0 0  1 0 0  0 1 0\n", "2: the polygon's number of vertices is -3"},
    {"p 3.5 0 0 0  1 0 0  0 1 0\n", "2: the polygon's number of vertices should be a whole number"},
    {"p 200000000 0 0 0\n", "2: polygon of 200000000 vertices"},
    {"p 1e20 0 0 0\n", "2: the polygon's number of vertices is 1e+20"},
    // Absurd sizes: their squares are no numbers.
    {"s 0 0 0 1e200\n", "2: the sphere's radius is too large"},
    {"s -1e31 0 0 1\n", "2: the sphere's centre is too large"},
    {"l 1e300 0 0\n", "2: the light's position is too large"},
    // Light that goes nowhere.
    {"f 1 1 1 1 0 0 0.5 0\n", "2: a fill that lets light through needs an index"},
    // What is no entity.
    {"s 0 0 0 1\n\nq 1 2 3\n", "4: unknown entity 'q'"},
    {"1 2 3\n", "2: unknown entity '1'"},
};

TEST(BadInput, IsRefusedWithItsLine) {
  for (const BadText& bad : kBadTexts) {
    const std::string problem = ProblemOf(kView + bad.text);
    EXPECT_EQ(problem.find(std::string("x.nff:") + bad.problem), 0U) << bad.text << problem;
  }
}

/// Every entity, each in one line.
const std::vector<std::string> kEntities = {
    "v from 0 0 9 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 8 8",
    "b 0.1 0.2 0.3",
    "l 1 2 3",
    "l 4 5 6 1 1 1",
    "f 1 1 1 0.5 0.5 3 0.1 1.5",
    "s 0 0 0 1",
    "c 0 0 0 1 0 0 1 0.5",
    "p 4 0 0 0 1 0 0 1 1 0 0 1 0",
    "pp 3 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1"};

std::vector<std::string> WordsOf(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// All entities, with one word of one of them replaced.
std::string TextWith(std::size_t entity, std::size_t word, const std::string& replacement) {
  std::string text;
  for (std::size_t line = 0; line < kEntities.size(); ++line) {
    std::vector<std::string> words = WordsOf(kEntities[line]);
    if (line == entity) words[word] = replacement;
    for (const std::string& each : words) text += each + " ";
    text += "\n";
  }
  return text;
}

// Each number of each entity in turn is replaced by something that is none.
TEST(BadInput, NoNumberOfAnyEntityMayBeAnythingElse) {
  int replaced = 0;
  for (std::size_t entity = 0; entity < kEntities.size(); ++entity) {
    const std::vector<std::string> words = WordsOf(kEntities[entity]);
    const std::string here = "x.nff:" + std::to_string(entity + 1) + ": ";
    for (std::size_t word = 1; word < words.size(); ++word) {
      if (std::isalpha(static_cast<unsigned char>(words[word][0])) != 0) continue;
      for (const char* const wrong :
           {"nan", "-nan", "NaN", "inf", "-inf", "1e999", "1e31", "0x10", "1,5", "--1", "1e"}) {
        const std::string text = TextWith(entity, word, wrong);
        const std::string problem = ProblemOf(text);
        EXPECT_EQ(problem.find(here), 0U) << text << problem;
        ++replaced;
      }
      // Left out, the next word stands where a number should be: that of this line or the next.
      EXPECT_NE(ProblemOf(TextWith(entity, word, "")), "accepted") << here << word;
    }
  }
  EXPECT_GT(replaced, 500);
}

}  // namespace
}  // namespace stipple::raytracer
