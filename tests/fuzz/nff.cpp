// SPDX-License-Identifier: MIT
// fuzz_nff ROUNDS: reads good scene files after random damage. Whatever the text: a message with
// file and line, or a scene that survives writing and reading, can be built, and whose rays meet
// nothing at a distance that is no number.
#include "raytracer/scene/nff.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "raytracer/errors.h"
#include "raytracer/geometry/kernel.h"
#include "raytracer/geometry/model.h"
#include "raytracer/scene/generate.h"

namespace stipple::raytracer {
namespace {

using Random = std::mt19937_64;

void Require(bool condition, const char* what, int round) {
  if (condition) return;
  std::fprintf(stderr, "fuzz_nff: round %d: %s\n", round, what);
  std::exit(1);
}

std::vector<std::string> Corpus() {
  std::ifstream file(std::string(STIPPLE_TEST_DATA) + "/every_entity.nff");
  std::vector<std::string> texts{{std::istreambuf_iterator<char>(file), {}}};
  for (const Scene& scene : {Balls(1), Rings(1), Teapot(2), Tree(2)})
    texts.push_back(FormatNff(scene));
  return texts;
}

/// Words that mean much where a number or an entity is due.
constexpr const char* kWords[] = {"nan",   "-inf", "1e300", "1e-320", "-0",     "0",  "1e30",
                                  "-1e30", "1e15", "1e-30", "3",      "4.5",    "-1", "268435456",
                                  "1e99",  "+",    "0x10",  "#",      "\r",     "s",  "c",
                                  "p",     "pp",   "f",     "l",      "bezier", "v",  "1e-12"};

/// Begin and end of a random word.
std::pair<std::size_t, std::size_t> WordIn(const std::string& text, Random& random) {
  std::size_t begin = text.find_first_not_of(" \n", random() % text.size());
  if (begin == std::string::npos) begin = 0;
  return {begin, std::min(text.find_first_of(" \n", begin), text.size())};
}

void Damage(std::string& text, Random& random) {
  const std::size_t changes = 1 + random() % 4;
  for (std::size_t i = 0; i < changes && !text.empty(); ++i) {
    const auto [begin, end] = WordIn(text, random);
    switch (random() % 6) {
      case 0:
        text[random() % text.size()] ^= static_cast<char>(1 << random() % 8);
        break;
      case 1:
        text.resize(random() % text.size());
        break;
      case 2:
        text.erase(begin, end - begin);
        break;
      case 3: {  // the same number twice: points that coincide, lines instead of areas
        const auto [other, other_end] = WordIn(text, random);
        text.replace(begin, end - begin, text.substr(other, other_end - other));
        break;
      }
      default:
        text.replace(begin, end - begin, kWords[random() % std::size(kWords)]);
    }
  }
}

void TraceSome(Scene scene, Random& random, int round) {
  const View view = scene.view;
  const Model<double> model = BuildModel<double>(std::move(scene.shapes));
  const auto kernel = MakeKernel("scalar", model);
  const Camera<double> camera(view, {16, 16});
  TestCounts tests;
  for (int i = 0; i < 16; ++i) {
    const Ray<double> ray = camera.RayThrough(static_cast<double>(random() % 16), i);
    Require(std::abs(Length(ray.direction) - 1) < 1e-9, "a direction not of length 1", round);
    const Hit<double> hit = kernel->Intersect(ray, tests);
    Require(hit.object == kNoObject || (hit.t > 0 && std::isfinite(hit.t)), "an absurd hit", round);
    Require(hit.object == kNoObject || hit.object < model.objects.size(), "no such object", round);
  }
}

/// False if the text was refused.
bool ReadOnce(const std::string& text, Random& random, int round) {
  Scene scene;
  try {
    scene = ParseNff(text, "x.nff");
  } catch (const InputError& error) {
    Require(std::string(error.what()).starts_with("x.nff:"), "a message without its line", round);
    return false;
  }
  const std::string written = FormatNff(scene);
  Require(FormatNff(ParseNff(written, "written")) == written, "not the same when written", round);
  TraceSome(std::move(scene), random, round);
  return true;
}

int Main(int rounds) {
  const std::vector<std::string> corpus = Corpus();
  int refused = 0;
  for (int round = 0; round < rounds; ++round) {
    Random random(static_cast<std::uint64_t>(round));
    std::string text = corpus[static_cast<std::size_t>(round) % corpus.size()];
    const bool sound = static_cast<std::size_t>(round) < corpus.size();
    if (!sound) Damage(text, random);
    const bool read = ReadOnce(text, random, round);
    Require(read || !sound, "a good file is refused", round);
    refused += read ? 0 : 1;
  }
  Require(rounds < 100 || (refused > rounds / 10 && refused < rounds), "too few of either", 0);
  std::printf("%d scene files read, %d of them refused\n", rounds, refused);
  return 0;
}

}  // namespace
}  // namespace stipple::raytracer

int main(int argc, char** argv) {
  return stipple::raytracer::Main(argc > 1 ? std::atoi(argv[1]) : 1000);
}
