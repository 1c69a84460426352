// SPDX-License-Identifier: MIT
// librsvg draws the SVG that would be written onto a surface of cairo; neither needs a display.
// docs/decisions/0011 says why not VTK's own PDF device.
#include "analysis/views/picture.h"

#include <cairo-pdf.h>
#include <cairo.h>
#include <librsvg/rsvg.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "analysis/views/svg.h"

namespace stipple {
namespace {

/// Larger images are refused by cairo.
constexpr double kMostPixels = 32000;

struct Freeing {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
  void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
};
using Surface = std::unique_ptr<cairo_surface_t, Freeing>;

cairo_status_t Append(void* text, const unsigned char* bytes, unsigned count) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

void Check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error(std::string("drawing failed: ") + cairo_status_to_string(status));
}

void Draw(const std::string& svg, cairo_surface_t* surface, double width, double height) {
  GError* error = nullptr;
  const std::unique_ptr<RsvgHandle, Freeing> handle(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
  if (!handle) {
    const std::string problem = error->message;
    g_error_free(error);
    throw std::runtime_error("drawing failed: " + problem);
  }
  const std::unique_ptr<cairo_t, Freeing> context(cairo_create(surface));
  const RsvgRectangle place{0, 0, width, height};
  const bool drawn = rsvg_handle_render_document(handle.get(), context.get(), &place, &error);
  if (!drawn) {
    const std::string problem = error->message;
    g_error_free(error);
    throw std::runtime_error("drawing failed: " + problem);
  }
  Check(cairo_status(context.get()));
}

std::string Png(const Scene& scene, const std::string& svg) {
  const double width = std::ceil(scene.width) * kPngScale;
  const double height = std::ceil(scene.height) * kPngScale;
  if (width > kMostPixels || height > kMostPixels)
    throw std::runtime_error("the picture is too large for PNG; SVG and PDF have no limit");
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width),
                                                   static_cast<int>(height)));
  Draw(svg, surface.get(), width, height);
  std::string bytes;
  Check(cairo_surface_write_to_png_stream(surface.get(), Append, &bytes));
  return bytes;
}

/// A page as large as the scene, its pixels as points; the date is the same for all.
std::string Pdf(const Scene& scene, const std::string& svg) {
  const double width = std::ceil(scene.width), height = std::ceil(scene.height);
  std::string bytes;
  {
    const Surface surface(cairo_pdf_surface_create_for_stream(Append, &bytes, width, height));
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE,
                                   "2000-01-01T00:00:00Z");
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, scene.title.c_str());
    Draw(svg, surface.get(), width, height);
    cairo_surface_finish(surface.get());
    Check(cairo_surface_status(surface.get()));
  }
  return bytes;
}

}  // namespace

bool IsPictureName(const std::string& path) {
  return path.ends_with(".svg") || path.ends_with(".png") || path.ends_with(".pdf");
}

std::string PictureOf(const Scene& scene, const std::string& path, bool mono) {
  const std::string svg = DrawSvg(scene, {.standalone = true, .mono = mono});
  if (path.ends_with(".svg")) return svg;
  if (path.ends_with(".png")) return Png(scene, svg);
  if (path.ends_with(".pdf")) return Pdf(scene, svg);
  throw std::runtime_error(path + ": pictures end in .svg, .png or .pdf");
}

}  // namespace stipple
