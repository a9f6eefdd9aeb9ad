#include "pano/canvas.h"

#include <cairo.h>

#include <fmt/format.h>

namespace eye {
namespace {

constexpr const char* kFont = "DejaVu Sans";
constexpr double kHaloShare = 0.22;  // of the text's size

struct SurfaceCloser {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct FontOptionsCloser {
  void operator()(cairo_font_options_t* options) const { cairo_font_options_destroy(options); }
};
struct ContextCloser {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};

void setInk(cairo_t* context, const Ink& ink) {
  cairo_set_source_rgba(context, ink.colour.r, ink.colour.g, ink.colour.b, ink.opacity);
}

void setFont(cairo_t* context, double sizePx, TextWeight weight) {
  cairo_select_font_face(context, kFont, CAIRO_FONT_SLANT_NORMAL,
                         weight == TextWeight::bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, sizePx);
}

// cairo's pixels are 0xXXRRGGBB in the machine's order.
uint32_t toCairo(const uint8_t* rgba) {
  return uint32_t{rgba[0]} << 16 | uint32_t{rgba[1]} << 8 | uint32_t{rgba[2]};
}

}  // namespace

struct Canvas::Impl {
  std::vector<uint8_t>& rgba;
  PanoramaFrame frame;
  std::unique_ptr<cairo_surface_t, SurfaceCloser> surface;
  std::unique_ptr<cairo_t, ContextCloser> context;

  uint32_t* row(int index) const {
    auto* bytes = cairo_image_surface_get_data(surface.get());
    return reinterpret_cast<uint32_t*>(bytes + ptrdiff_t{index} * cairo_image_surface_get_stride(surface.get()));
  }
};

Canvas::Canvas(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Canvas::~Canvas() = default;
Canvas::Canvas(Canvas&&) noexcept = default;
Canvas& Canvas::operator=(Canvas&&) noexcept = default;

Result<Canvas> Canvas::over(std::vector<uint8_t>& rgba, const PanoramaFrame& frame) {
  EYE_CHECK(rgba.size() == frame.pixels() * 4);
  auto impl = std::make_unique<Impl>(Impl{rgba, frame, nullptr, nullptr});
  impl->surface.reset(cairo_image_surface_create(CAIRO_FORMAT_RGB24, frame.widthPx, frame.heightPx));
  const cairo_status_t status = cairo_surface_status(impl->surface.get());
  if (status != CAIRO_STATUS_SUCCESS)
    return fail(ErrorKind::unsupported, fmt::format("cannot draw labels on {}x{} pixels: {}; take a smaller --width",
                                                    frame.widthPx, frame.heightPx, cairo_status_to_string(status)));
  for (int row = 0; row < frame.heightPx; ++row)
    for (int column = 0; column < frame.widthPx; ++column)
      impl->row(row)[column] = toCairo(&rgba[frame.at(column, row) * 4]);
  cairo_surface_mark_dirty(impl->surface.get());
  impl->context.reset(cairo_create(impl->surface.get()));
  // Hinted advances are whole pixels: level text would be measured as wider or narrower than the same text at a slant.
  const std::unique_ptr<cairo_font_options_t, FontOptionsCloser> fontOptions(cairo_font_options_create());
  cairo_font_options_set_hint_metrics(fontOptions.get(), CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_hint_style(fontOptions.get(), CAIRO_HINT_STYLE_NONE);
  cairo_set_font_options(impl->context.get(), fontOptions.get());
  cairo_set_line_join(impl->context.get(), CAIRO_LINE_JOIN_ROUND);
  return Canvas(std::move(impl));
}

double Canvas::textWidthPx(const std::string& text, double sizePx, TextWeight weight) const {
  setFont(impl_->context.get(), sizePx, weight);
  cairo_text_extents_t extents{};
  cairo_text_extents(impl_->context.get(), text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(const std::string& text, glm::dvec2 foot, double sizePx, TextWeight weight, const Ink& ink,
                  double slopeRad) {
  cairo_t* context = impl_->context.get();
  cairo_save(context);
  setFont(context, sizePx, weight);
  cairo_translate(context, foot.x, foot.y);
  cairo_rotate(context, -slopeRad);
  cairo_move_to(context, 0, 0);
  cairo_text_path(context, text.c_str());
  const double light = ink.colour.r + ink.colour.g + ink.colour.b > 1.5 ? 0 : 1;
  setInk(context, {glm::dvec3(light), 0.55 * ink.opacity});
  cairo_set_line_width(context, kHaloShare * sizePx);
  cairo_stroke_preserve(context);
  setInk(context, ink);
  cairo_fill(context);
  cairo_restore(context);
}

void Canvas::line(glm::dvec2 from, glm::dvec2 to, double widthPx, const Ink& ink) {
  cairo_t* context = impl_->context.get();
  setInk(context, ink);
  cairo_set_line_width(context, widthPx);
  cairo_move_to(context, from.x, from.y);
  cairo_line_to(context, to.x, to.y);
  cairo_stroke(context);
}

void Canvas::rectangle(glm::dvec2 corner, glm::dvec2 sizePx, const Ink& ink) {
  setInk(impl_->context.get(), ink);
  cairo_rectangle(impl_->context.get(), corner.x, corner.y, sizePx.x, sizePx.y);
  cairo_fill(impl_->context.get());
}

void Canvas::finish() {
  cairo_surface_flush(impl_->surface.get());
  for (int row = 0; row < impl_->frame.heightPx; ++row) {
    for (int column = 0; column < impl_->frame.widthPx; ++column) {
      const uint32_t pixel = impl_->row(row)[column];
      uint8_t* rgba = &impl_->rgba[impl_->frame.at(column, row) * 4];
      rgba[0] = static_cast<uint8_t>(pixel >> 16);
      rgba[1] = static_cast<uint8_t>(pixel >> 8);
      rgba[2] = static_cast<uint8_t>(pixel);
    }
  }
}

}  // namespace eye
