// SPDX-License-Identifier: MIT
// Pictures and what they take: CPU seconds, and how far they are from a truth.
#ifndef STIPPLE_RAYTRACER_CHARTS_MEASURE_H
#define STIPPLE_RAYTRACER_CHARTS_MEASURE_H

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "raytracer/charts/session.h"
#include "raytracer/render/sampling.h"

namespace stipple::raytracer {

/// A picture before it is rounded to bytes: red, green, blue of each pixel, from 0 to 1.
struct Pixels {
  ImageSize size;
  std::vector<double> rgb;
  double eye_rays = 0;  // that it took
};

/// CPU time that this thread has used.
double CpuSeconds();

/// Traces a whole picture. Advances the session's progress by one unit a ray.
Pixels Draw(Session& session, Sampler& sampler, ImageSize image, Samples samples);

/// The same with a new sampler over a scene that is ready.
template <class Real>
Pixels Draw(Session& session, const ReadyScene<Real>& ready, ShadingChoice shading,
            Samples samples);

/// Rays from the eye that a picture takes; of adaptive sampling about as many as it may.
double EyeRays(ImageSize image, Samples samples);

/// Root of the mean square of the differences of all components.
double RootMeanSquare(const Pixels& a, const Pixels& b);
/// 20 log10 of 1 / error; none for no error.
double Decibels(double error);
/// The components as a PNG has them, rounded to whole 255ths: pictures equal to the byte differ by
/// nothing.
Pixels AsWritten(Pixels pixels);
/// Share of the pixels that are not equal as written.
double ShareThatDiffers(const Pixels& a, const Pixels& b);

/// A setting that is tried, and what came of it.
struct Candidate {
  std::string series;
  std::string label;
  double rays = 0;  // units of progress for one picture
  std::function<Pixels()> draw;
  bool recommended = false;

  double cpu_s = 0;
  Pixels pixels{};
};

/// Draws with each candidate in turn, round after round, so that whatever disturbs the machine
/// disturbs all of them; the least CPU time of the session's rounds counts.
void Measure(const Session& session, std::span<Candidate> candidates);

/// Rays of all rounds, for the progress.
double RaysOf(const Session& session, std::span<const Candidate> candidates);

}  // namespace stipple::raytracer

#endif
