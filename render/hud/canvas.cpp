#include "render/hud/canvas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <stdexcept>

#include <cairo-ft.h>
#include <cairo.h>
#include <fontconfig/fontconfig.h>

namespace qsmpc::render {
namespace {

constexpr const char* kFontFamily = "DejaVu Sans";
constexpr const char* kBuiltInFamily = "@cairo:";  // cairo's own strokes
constexpr std::uint32_t kReplacement = 0xFFFD;
constexpr std::uint32_t kLastCodePoint = 0x10FFFF;
constexpr double kFarAway = 1e5;  // pixels; cairo's coordinates end at 2^23

struct CairoDeleter {
  void operator()(cairo_font_face_t* face) const { cairo_font_face_destroy(face); }
  void operator()(cairo_font_options_t* options) const { cairo_font_options_destroy(options); }
  void operator()(cairo_scaled_font_t* font) const { cairo_scaled_font_destroy(font); }
  void operator()(cairo_glyph_t* glyphs) const { cairo_glyph_free(glyphs); }
  void operator()(FcPattern* pattern) const { FcPatternDestroy(pattern); }
};

template <typename T>
using CairoPointer = std::unique_ptr<T, CairoDeleter>;

void check_drawn(cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  throw std::runtime_error(std::string("head-up display: ") + cairo_status_to_string(status));
}

// fontconfig chooses the file, but not the rendering of its letters, which is a user's screen
// setting: the pattern given to cairo contains only the file.
CairoPointer<cairo_font_face_t> installed_face() {
  const CairoPointer<FcPattern> wanted(FcPatternCreate());
  FcPatternAddString(wanted.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>(kFontFamily));
  FcConfigSubstitute(nullptr, wanted.get(), FcMatchPattern);
  FcDefaultSubstitute(wanted.get());
  FcResult result{};
  const CairoPointer<FcPattern> match(FcFontMatch(nullptr, wanted.get(), &result));
  FcChar8* file = nullptr;
  int index = 0;
  if (!match || FcPatternGetString(match.get(), FC_FILE, 0, &file) != FcResultMatch) return nullptr;
  FcPatternGetInteger(match.get(), FC_INDEX, 0, &index);
  const CairoPointer<FcPattern> font(FcPatternCreate());
  FcPatternAddString(font.get(), FC_FILE, file);
  FcPatternAddInteger(font.get(), FC_INDEX, index);
  return CairoPointer<cairo_font_face_t>(cairo_ft_font_face_create_for_pattern(font.get()));
}

CairoPointer<cairo_font_face_t> found_face() {
  CairoPointer<cairo_font_face_t> face = installed_face();
  if (face && cairo_font_face_status(face.get()) == CAIRO_STATUS_SUCCESS) return face;
  return CairoPointer<cairo_font_face_t>(cairo_toy_font_face_create(
      kBuiltInFamily, CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL));
}

// cairo caches fonts and their glyphs: creating one again is a lookup.
CairoPointer<cairo_scaled_font_t> scaled_font(double size) {
  static const CairoPointer<cairo_font_face_t> face = found_face();
  cairo_matrix_t scale;
  cairo_matrix_t identity;
  cairo_matrix_init_scale(&scale, size, size);
  cairo_matrix_init_identity(&identity);
  const CairoPointer<cairo_font_options_t> options(cairo_font_options_create());
  cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  CairoPointer<cairo_scaled_font_t> font(
      cairo_scaled_font_create(face.get(), &scale, &identity, options.get()));
  check_drawn(cairo_scaled_font_status(font.get()));
  return font;
}

// Neither a surrogate nor one of the 66 noncharacters; cairo accepts neither.
bool is_character(std::uint32_t code) {
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  const bool reserved = (code >= 0xFDD0 && code <= 0xFDEF) || (code & 0xFFFEU) == 0xFFFEU;
  return code <= kLastCodePoint && !surrogate && !reserved;
}

bool is_control(std::uint32_t code) { return code < 0x20 || (code >= 0x7F && code < 0xA0); }

// Calls `action` with one character after the other, as UTF-8.
template <typename Action>
void for_each_character(std::string_view text, const Action& action) {
  while (!text.empty()) {
    std::uint32_t code = 0;
    std::array<FcChar8, FC_UTF8_MAX_LEN> bytes{};
    const int taken = FcUtf8ToUcs4(reinterpret_cast<const FcChar8*>(text.data()), &code,
                                   static_cast<int>(std::min<std::size_t>(text.size(), 4)));
    // Overlong sequences are not valid UTF-8, although fontconfig accepts them.
    const bool valid = taken > 0 && is_character(code) && FcUcs4ToUtf8(code, bytes.data()) == taken;
    const std::uint32_t shown = !valid ? kReplacement : is_control(code) ? ' ' : code;
    const int length = FcUcs4ToUtf8(shown, bytes.data());
    text.remove_prefix(valid ? static_cast<std::size_t>(taken) : 1);
    if (!action(std::string_view(reinterpret_cast<const char*>(bytes.data()), length))) return;
  }
}

std::string valid_text(std::string_view text) {
  std::string valid;
  for_each_character(text, [&](std::string_view character) {
    valid += character;
    return true;
  });
  return valid;
}

PixelRectangle whole_of(const Image& image) {
  return {0.0, 0.0, static_cast<double>(image.width), static_cast<double>(image.height)};
}

}  // namespace

// A copy of the part in cairo's pixel format: 32 bits each, of which the lower 24 are the colour.
struct Canvas::Surface {
  Image& image;
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
  cairo_surface_t* pixels = nullptr;
  cairo_t* context = nullptr;

  Surface(Image& onto, const PixelRectangle& area) : image(onto) {
    const auto inside = [](double value, int size) {
      return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(size)));
    };
    left = inside(std::floor(area.x), image.width);
    top = inside(std::floor(area.y), image.height);
    width = inside(std::ceil(area.x + area.width), image.width) - left;
    height = inside(std::ceil(area.y + area.height), image.height) - top;
    pixels =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, std::max(width, 0), std::max(height, 0));
    context = cairo_create(pixels);
  }
  ~Surface() {
    cairo_destroy(context);
    cairo_surface_destroy(pixels);
  }
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  // Calls `action` with every row of the image and of the surface.
  template <typename Action>
  void for_each_row(const Action& action) {
    unsigned char* const data = cairo_image_surface_get_data(pixels);
    const int stride = cairo_image_surface_get_stride(pixels);
    for (int y = 0; y < height && width > 0; ++y) {
      const std::size_t place = static_cast<std::size_t>(top + y) * image.width + left;
      action(&image.rgb[3 * place],
             reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * stride));
    }
  }

  void load() {
    check_drawn(cairo_status(context));
    for_each_row([this](const unsigned char* rgb, std::uint32_t* row) {
      for (int x = 0; x < width; ++x, rgb += 3) {
        row[x] = static_cast<std::uint32_t>(rgb[0]) << 16U |
                 static_cast<std::uint32_t>(rgb[1]) << 8U | rgb[2];
      }
    });
    cairo_surface_mark_dirty(pixels);
    cairo_translate(context, -left, -top);
    // Takes a third of the default's time; at these sizes the letters look the same.
    cairo_set_antialias(context, CAIRO_ANTIALIAS_FAST);
  }

  void store() {
    cairo_surface_flush(pixels);
    for_each_row([this](unsigned char* rgb, const std::uint32_t* row) {
      for (int x = 0; x < width; ++x, rgb += 3) {
        rgb[0] = static_cast<unsigned char>(row[x] >> 16U);
        rgb[1] = static_cast<unsigned char>(row[x] >> 8U);
        rgb[2] = static_cast<unsigned char>(row[x]);
      }
    });
  }

  void set_colour(const Colour& colour) const {
    cairo_set_source_rgba(context, static_cast<double>(colour.red),
                          static_cast<double>(colour.green), static_cast<double>(colour.blue),
                          static_cast<double>(colour.alpha));
  }

  void fill(const Colour& colour) const {
    set_colour(colour);
    cairo_fill(context);
    check_drawn(cairo_status(context));
  }
};

double Font::width(std::string_view text) const {
  cairo_text_extents_t extents;
  cairo_scaled_font_text_extents(scaled_font(size_).get(), valid_text(text).c_str(), &extents);
  return extents.x_advance;
}

std::string fitting(const Font& font, std::string_view text, double width) {
  constexpr const char* kCut = "…";
  std::string valid = valid_text(text);
  if (font.width(valid) <= width) return valid;
  double room = width - font.width(kCut);
  std::size_t kept = 0;
  for_each_character(valid, [&](std::string_view character) {
    room -= font.width(character);
    kept += room >= 0.0 ? character.size() : 0;
    return room >= 0.0;
  });
  valid.resize(kept);
  return valid + kCut;
}

Canvas::Canvas(Image& image, const PixelRectangle& area)
    : surface_(std::make_unique<Surface>(image, area)) {
  surface_->load();
}

Canvas::Canvas(Image& image) : Canvas(image, whole_of(image)) {}

Canvas::~Canvas() { surface_->store(); }

void Canvas::fill_rectangle(const PixelRectangle& area, const Colour& colour, double radius) {
  cairo_t* const context = surface_->context;
  const double r = std::min({radius, 0.5 * area.width, 0.5 * area.height});
  if (r > 0.0) {
    constexpr double kQuarter = 0.5 * std::numbers::pi;
    const double right = area.x + area.width;
    const double bottom = area.y + area.height;
    cairo_new_sub_path(context);
    cairo_arc(context, right - r, area.y + r, r, -kQuarter, 0.0);
    cairo_arc(context, right - r, bottom - r, r, 0.0, kQuarter);
    cairo_arc(context, area.x + r, bottom - r, r, kQuarter, 2.0 * kQuarter);
    cairo_arc(context, area.x + r, area.y + r, r, 2.0 * kQuarter, 3.0 * kQuarter);
    cairo_close_path(context);
  } else {
    cairo_rectangle(context, area.x, area.y, area.width, area.height);
  }
  surface_->fill(colour);
}

void Canvas::fill_circle(const PixelPoint& centre, double radius, const Colour& colour) {
  cairo_arc(surface_->context, centre.x, centre.y, radius, 0.0, 2.0 * std::numbers::pi);
  surface_->fill(colour);
}

void Canvas::draw_graph(const std::vector<PixelPoint>& points, double width, const Colour& colour) {
  cairo_t* const context = surface_->context;
  cairo_new_path(context);
  for (const PixelPoint& point : points) {
    if (std::isfinite(point.x) && std::isfinite(point.y)) {
      cairo_line_to(context, std::clamp(point.x, -kFarAway, kFarAway),
                    std::clamp(point.y, -kFarAway, kFarAway));
    } else {
      cairo_new_sub_path(context);
    }
  }
  surface_->set_colour(colour);
  cairo_set_line_width(context, width);
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke(context);
  check_drawn(cairo_status(context));
}

void Canvas::draw_text(const Font& font, std::string_view text, const PixelPoint& pen,
                       const Colour& colour) {
  const std::string valid = valid_text(text);
  const CairoPointer<cairo_scaled_font_t> scaled = scaled_font(font.size());
  cairo_glyph_t* found = nullptr;
  int count = 0;
  const cairo_status_t status = cairo_scaled_font_text_to_glyphs(
      scaled.get(), pen.x, std::round(pen.y), valid.data(), static_cast<int>(valid.size()), &found,
      &count, nullptr, nullptr, nullptr);
  const CairoPointer<cairo_glyph_t> glyphs(found);
  check_drawn(status);
  // Drawn as outlines: cairo 1.16 places glyphs at whole pixels, which spaces them unevenly.
  cairo_set_scaled_font(surface_->context, scaled.get());
  cairo_glyph_path(surface_->context, glyphs.get(), count);
  surface_->fill(colour);
}

}  // namespace qsmpc::render
