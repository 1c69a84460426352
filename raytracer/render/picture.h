// SPDX-License-Identifier: MIT
// From what the rays found to pictures: the picture itself, and a map of what each pixel cost.
#ifndef STIPPLE_RAYTRACER_RENDER_PICTURE_H
#define STIPPLE_RAYTRACER_RENDER_PICTURE_H

#include <string>

#include "raytracer/image/image.h"
#include "raytracer/render/render.h"

namespace stipple::raytracer {

/// How much brighter a component of a pixel could be, of 1, if every ray had been followed to depth
/// kDeepest and none been cut.
struct LossBound {
  double mean = 0;   // over the pixels
  double worst = 0;  // of any pixel
};

/// A picture and, of the same pass over the raster, what it lacks at most.
template <class Pixels>
struct Bounded {
  Pixels picture;
  LossBound loss;
};

/// The mean of the rays of each pixel, in integers throughout.
Bounded<Image> PictureOf(RasterView raster, ImageSize image, Samples samples);

/// The same means, not limited to what a byte can hold.
Bounded<LinearImage> LinearPictureOf(RasterView raster, ImageSize image, Samples samples);

/// Without a picture.
LossBound LossOf(RasterView raster, ImageSize image, Samples samples);

/// From dark violet to yellow (viridis) by the root of a pixel's work, yellow for the dearest: in
/// proportion to the work itself most pixels of most scenes would be alike. With corner rays a
/// corner's work goes to the pixel below and to the right of it, or the last one in the row or
/// column.
Image CostImageOf(RasterView raster, ImageSize image, Samples samples);

/// CSV with the columns x,y,work,object,in_shadow,depth, one row per pixel. Object is the object's
/// number in the scene, -1 for background; object and in_shadow are those of the pixel's first ray.
/// Work and depth over the rays of the pixel.
std::string CostTableOf(RasterView raster, ImageSize image, Samples samples);

}  // namespace stipple::raytracer

#endif
