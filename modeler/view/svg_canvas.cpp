#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "modeler/view/sheet.hpp"

namespace limn {
namespace {

/// Not even the finest display shows a hundred-thousandth of a page.
constexpr double kVisibleShare = 1e-5;

/// Decimals of exact paths: a nanometre, or a thousandth of what is visible.
constexpr int kLeastExactDecimals = 6;

int decimals_for(double step) {
  return std::clamp(static_cast<int>(std::ceil(-std::log10(step))), 0, 12);
}

class SvgCanvas final : public Canvas {
 public:
  explicit SvgCanvas(const Sheet& page)
      : visible_(decimals_for(kVisibleShare * std::max(page.width, page.height))),
        exact_(std::max(kLeastExactDecimals, visible_ + 3)) {
    const auto attribute = [&](const char* name, double value) {
      out_ += name;
      number(value, exact_);
      out_ += '"';
    };
    out_ +=
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<svg xmlns=\"http://www.w3.org/2000/svg\" "
        "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" version=\"1.1\"";
    attribute(" width=\"", page.width * page.paper_scale);
    out_.insert(out_.size() - 1, "mm");
    attribute(" height=\"", page.height * page.paper_scale);
    out_.insert(out_.size() - 1, "mm");
    out_ += " viewBox=\"";
    point(page.origin, exact_);
    out_ += ' ';
    point({page.width, page.height}, exact_);
    out_ += "\">\n<title>";
    escaped(page.title);
    out_ += "</title>\n<rect id=\"page\"";
    attribute(" x=\"", page.origin.x());
    attribute(" y=\"", page.origin.y());
    attribute(" width=\"", page.width);
    attribute(" height=\"", page.height);
    out_ += " fill=\"#ffffff\"/>\n";
  }

  void begin_layer(std::string_view id, std::string_view label) override {
    out_ += "<g id=\"";
    out_ += id;
    out_ += "\" inkscape:groupmode=\"layer\" inkscape:label=\"";
    out_ += label;
    out_ += "\">\n";
  }

  void end_layer() override { out_ += "</g>\n"; }

  void fill(std::string_view id, std::string_view css_class, const Path& path,
            Color color) override {
    open_path(id, css_class, path, visible_);
    out_ += "\" fill=\"";
    hex(color);
    out_ += "\"/>\n";
  }

  void stroke(std::string_view id, std::string_view css_class, const Path& path,
              const LineStyle& style, Precision precision) override {
    open_path(id, css_class, path, precision == Precision::kExact ? exact_ : visible_);
    out_ += "\" fill=\"none\" stroke=\"";
    hex(style.color);
    out_ += "\" stroke-linecap=\"round\" stroke-linejoin=\"round\" stroke-width=\"";
    number(style.width_mm, visible_ + 2);
    if (style.dash_mm > 0) {
      out_ += "\" stroke-dasharray=\"";
      number(style.dash_mm, visible_ + 2);
    }
    out_ += "\"/>\n";
  }

  void text(const Eigen::Vector2d& at, double size_mm, double /*most_width_mm*/, Color color,
            std::string_view utf8) override {
    out_ += "<text x=\"";
    number(at.x(), visible_);
    out_ += "\" y=\"";
    number(at.y(), visible_);
    out_ += "\" font-family=\"sans-serif\" font-size=\"";
    number(size_mm, visible_ + 2);
    out_ += "\" fill=\"";
    hex(color);
    out_ += "\">";
    escaped(utf8);
    out_ += "</text>\n";
  }

  std::string take() {
    out_ += "</svg>\n";
    return std::move(out_);
  }

 private:
  void escaped(std::string_view utf8) {
    for (const char c : utf8) {
      if (c == '<') {
        out_ += "&lt;";
      } else if (c == '&') {
        out_ += "&amp;";
      } else {
        out_ += c;
      }
    }
  }

  void open_path(std::string_view id, std::string_view css_class, const Path& path, int decimals) {
    out_ += "<path id=\"";
    out_ += id;
    out_ += "\" class=\"";
    out_ += css_class;
    out_ += "\" d=\"";
    data(path, decimals);
  }

  void data(const Path& path, int decimals) {
    const Eigen::Vector2d* p = path.points().data();
    for (const Path::Verb verb : path.verbs()) {
      switch (verb) {
        case Path::Verb::kMove:
          out_ += 'M';
          point(*p++, decimals);
          break;
        case Path::Verb::kLine:
          out_ += 'L';
          point(*p++, decimals);
          break;
        case Path::Verb::kCubic:
          out_ += 'C';
          point(p[0], decimals);
          out_ += ' ';
          point(p[1], decimals);
          out_ += ' ';
          point(p[2], decimals);
          p += 3;
          break;
        case Path::Verb::kClose:
          out_ += 'Z';
          break;
      }
    }
  }

  void point(const Eigen::Vector2d& p, int decimals) {
    number(p.x(), decimals);
    out_ += ' ';
    number(p.y(), decimals);
  }

  /// Fixed notation without trailing zeros: 12.5, not 12.500 or 1.25e1.
  void number(double value, int decimals) {
    std::array<char, 64> buffer;  // page coordinates have at most 13 digits before the point
    char* end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                              std::chars_format::fixed, decimals)
                    .ptr;
    if (decimals > 0) {
      while (end[-1] == '0') --end;
      if (end[-1] == '.') --end;
    }
    const std::string_view text(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
    out_ += text == "-0" ? std::string_view("0") : text;
  }

  void hex(Color color) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    out_ += '#';
    for (const std::uint8_t c : {color.red, color.green, color.blue}) {
      out_ += kDigits[c >> 4];
      out_ += kDigits[c & 15];
    }
  }

  int visible_;
  int exact_;
  std::string out_;
};

}  // namespace

Expected<std::string> draw_svg(const Sheet& sheet, const Drawing& drawing) {
  SvgCanvas canvas(sheet);
  if (auto drawn = drawing(canvas); !drawn) return tl::unexpected(std::move(drawn.error()));
  return canvas.take();
}

}  // namespace limn
