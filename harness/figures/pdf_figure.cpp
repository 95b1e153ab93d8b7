#include "harness/figures/pdf_figure.hpp"

#include <memory>
#include <stdexcept>

#include <cairo-pdf.h>
#include <cairo.h>
#include <librsvg/rsvg.h>

namespace qsmpc::harness {
namespace {

constexpr double kUnitsPerInch = 96.0;
constexpr double kPointsPerInch = 72.0;
constexpr const char* kDate = "2000-01-01T00:00:00Z";  // cairo would write the current date

struct HandleDeleter {
  void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
};
struct SurfaceDeleter {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct ContextDeleter {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
struct ErrorDeleter {
  void operator()(GError* error) const { g_error_free(error); }
};
using Handle = std::unique_ptr<RsvgHandle, HandleDeleter>;
using Surface = std::unique_ptr<cairo_surface_t, SurfaceDeleter>;
using Context = std::unique_ptr<cairo_t, ContextDeleter>;
using Error = std::unique_ptr<GError, ErrorDeleter>;

std::string words_of(const GError* error) {
  return error == nullptr ? "no reason given" : error->message;
}

Handle parsed(const std::string& svg) {
  GError* error = nullptr;
  Handle handle(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
  const Error owned(error);
  if (!handle) throw std::invalid_argument("SVG figure: " + words_of(error));
  rsvg_handle_set_dpi(handle.get(), kUnitsPerInch);
  return handle;
}

void check(cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  throw std::runtime_error(std::string("PDF figure: ") + cairo_status_to_string(status));
}

extern "C" cairo_status_t append_bytes(void* text, const unsigned char* bytes,
                                       unsigned int count) noexcept {
  try {
    static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
  } catch (...) {
    return CAIRO_STATUS_NO_MEMORY;
  }
}

}  // namespace

std::string pdf_figure(const std::string& svg, const std::string& title) {
  const Handle handle = parsed(svg);
  double width = 0.0;
  double height = 0.0;
  if (rsvg_handle_get_intrinsic_size_in_pixels(handle.get(), &width, &height) == 0) {
    throw std::invalid_argument("SVG figure: no intrinsic size in pixels");
  }
  constexpr double kScale = kPointsPerInch / kUnitsPerInch;
  const RsvgRectangle page{0.0, 0.0, width * kScale, height * kScale};
  std::string pdf;
  {
    const Surface surface(
        cairo_pdf_surface_create_for_stream(append_bytes, &pdf, page.width, page.height));
    check(cairo_surface_status(surface.get()));
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, title.c_str());
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, kDate);
    const Context context(cairo_create(surface.get()));
    GError* error = nullptr;
    const bool is_drawn =
        rsvg_handle_render_document(handle.get(), context.get(), &page, &error) != 0;
    const Error owned(error);
    if (!is_drawn) throw std::runtime_error("PDF figure: " + words_of(error));
    check(cairo_status(context.get()));
    cairo_surface_finish(surface.get());
    check(cairo_surface_status(surface.get()));
  }
  return pdf;
}

}  // namespace qsmpc::harness
