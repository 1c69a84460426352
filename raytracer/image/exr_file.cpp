// SPDX-License-Identifier: MIT
#include "raytracer/image/exr_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <fmt/format.h>

#include <exception>

#include "raytracer/errors.h"
#include "raytracer/whole_file.h"

namespace stipple::raytracer {
namespace {

constexpr const char* kChannels[] = {"R", "G", "B"};
constexpr int kLargestSide = 1 << 15;  // of a picture that we read

/// Where OpenEXR finds or puts the components of the pixel at (x, y): rows from the top, as ours.
Imf::FrameBuffer BufferOf(float* rgb, std::size_t width) {
  Imf::FrameBuffer buffer;
  for (int i = 0; i < 3; ++i)
    buffer.insert(kChannels[i], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(rgb + i),
                                           3 * sizeof(float), 3 * sizeof(float) * width));
  return buffer;
}

}  // namespace

void NeedExr(const std::string&) {}

void WriteExr(const LinearImage& image, const std::string& path) {
  try {
    Imf::Header header(image.size.width, image.size.height);
    for (const char* const channel : kChannels)
      header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    LinearImage copy = image;  // OpenEXR's buffers are not const
    WriteWhole(path, [&](const std::string& name) {
      Imf::OutputFile file(name.c_str(), header);
      file.setFrameBuffer(BufferOf(copy.rgb.data(), static_cast<std::size_t>(image.size.width)));
      file.writePixels(image.size.height);
    });
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(path, 0, fmt::format("cannot be written: {}", error.what()));
  }
}

LinearImage ReadExr(const std::string& path) {
  try {
    Imf::InputFile file(path.c_str());
    const auto window = file.header().dataWindow();
    const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    if (window.min.x != 0 || window.min.y != 0 || width > kLargestSide || height > kLargestSide)
      throw InputError(path, 0, fmt::format("picture of {}x{} cannot be used", width, height));
    const auto columns = static_cast<std::size_t>(width);
    LinearImage image{{width, height}, {}};
    image.rgb.resize(3 * columns * static_cast<std::size_t>(height));
    file.setFrameBuffer(BufferOf(image.rgb.data(), columns));
    file.readPixels(0, height - 1);
    return image;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(path, 0, fmt::format("cannot be read: {}", error.what()));
  }
}

}  // namespace stipple::raytracer
