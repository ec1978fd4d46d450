#include "cli/text/log_log_chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cli/text/svg.hpp"
#include "cli/text/wrapped_text.hpp"

namespace pleuel {

namespace {

// Pixels.
constexpr double width = 820.0, height = 500.0;
constexpr double left = 78.0, right = 590.0, bottom = 440.0;
constexpr double line_height = 17.0;
constexpr double letter = 6.4;  ///< of small text, on the average
constexpr double mark_size = 5.0;
constexpr double legend = 612.0;

constexpr std::size_t longest_title = 84;

/// Colours on white and on black.
struct Colour {
  const char* light;
  const char* dark;
};
constexpr std::array<Colour, 7> colours = {{{"#0072b2", "#56b4e9"},
                                            {"#d55e00", "#ff8c42"},
                                            {"#009e73", "#2fd3a5"},
                                            {"#b3508a", "#e79bc6"},
                                            {"#a87400", "#f0c04a"},
                                            {"#6a51a3", "#b9a7e8"},
                                            {"#555555", "#bbbbbb"}}};

/// Outlines around the origin.
constexpr std::array<const char*, 8> marks = {"M-5 0a5 5 0 1 0 10 0a5 5 0 1 0 -10 0z",
                                              "M-4.5 -4.5h9v9h-9z",
                                              "M0 -5.5L5.2 4H-5.2z",
                                              "M0 -6L6 0L0 6L-6 0z",
                                              "M0 5.5L5.2 -4H-5.2z",
                                              "M-6 -2h4v-4h4v4h4v4h-4v4h-4v-4h-4z",
                                              "M-5.5 0L-2.7 -5H2.7L5.5 0L2.7 5H-2.7z",
                                              "M-6 -3h12v6h-12z"};

constexpr const char* failure_mark = R"(<path class="failed" d="M-4 -4L4 4M-4 4L4 -4"/>)";
constexpr const char* small_middle = R"(class="small" text-anchor="middle")";

std::string moved(double x, double y) {
  return fmt::format("translate({:.2f} {:.2f})", x, y);
}

/// A logarithmic axis between two pixels.
class Axis {
 public:
  /// @param low, high  of the data; a decade at least is shown
  Axis(double low, double high, double first_pixel, double last_pixel)
      : first_(first_pixel), last_(last_pixel) {
    low_ = std::log10(low) - 0.15;
    high_ = std::log10(high) + 0.15;
    const double missing = 1.0 - (high_ - low_);
    if (missing > 0.0) low_ -= 0.5 * missing, high_ += 0.5 * missing;
  }

  double pixel(double value) const {
    return first_ + (std::log10(value) - low_) / (high_ - low_) * (last_ - first_);
  }

  /// Powers of ten, and 2 and 5 times them where there are less than three.
  std::vector<double> ticks() const {
    std::vector<double> ticks = multiples({1.0});
    return ticks.size() < 3 ? multiples({1.0, 2.0, 5.0}) : ticks;
  }

 private:
  std::vector<double> multiples(const std::vector<double>& factors) const {
    std::vector<double> values;
    for (int power = static_cast<int>(std::floor(low_)); power <= high_; ++power) {
      for (const double factor : factors) {
        const double exponent = power + std::log10(factor);
        if (exponent >= low_ && exponent <= high_) values.push_back(std::pow(10.0, power) * factor);
      }
    }
    return values;
  }

  double first_, last_, low_ = 0.0, high_ = 0.0;
};

struct Box {
  double x0, y0, x1, y1;

  bool meets(const Box& other) const {
    return x0 < other.x1 && other.x0 < x1 && y0 < other.y1 && other.y0 < y1;
  }
};

std::string tick_text(double value) {
  if (value >= 1e-3 && value < 1e5) return fmt::format("{:g}", value);
  return fmt::format("{:.0e}", value);
}

class Drawing {
 public:
  explicit Drawing(const LogLogChart& chart)
      : chart_(chart),
        top_(44.0 + line_height * static_cast<double>(chart.notes.size())),
        x_(axis(&ChartPoint::x, left, right)),
        y_(axis(&ChartPoint::y, bottom, top_)),
        svg_(width, height, chart.title, style()) {
    draw_head();
    draw_axes();
    draw_floor();
    draw_front();
    for (std::size_t i = 0; i < chart_.series.size(); ++i) draw_series(i);
    draw_failures();
    draw_labels();
    draw_legend();
  }

  std::string text() const { return svg_.text(); }

 private:
  static std::string style() {
    std::string light, dark;
    for (std::size_t i = 0; i < colours.size(); ++i) {
      light += fmt::format(".c{}{{stroke:{};fill:{}}}", i, colours[i].light, colours[i].light);
      dark += fmt::format(".c{}{{stroke:{};fill:{}}}", i, colours[i].dark, colours[i].dark);
    }
    return ".paper{fill:#fff}text{fill:#222;stroke:none}.small{font-size:12px}"
           ".label{font-size:12px;stroke:#fff;stroke-width:3;paint-order:stroke}"
           ".head{font-size:15px;font-weight:bold}.grid{stroke:#ddd}.frame{stroke:#555;fill:none}"
           ".floor{stroke:#555;stroke-dasharray:6 4}.front{stroke:#e0c94f;stroke-width:7;fill:none;"
           "stroke-linejoin:round;stroke-linecap:round;opacity:.55}.join{fill:none!important;"
           "stroke-width:1.3}.open{fill:none!important;stroke-width:1.6}.failed{stroke:#c00;"
           "stroke-width:2;fill:none}" +
           light +
           "@media(prefers-color-scheme:dark){.paper{fill:#14171a}text{fill:#e8e8e8}"
           ".label{stroke:#14171a}.grid{stroke:#33383d}.frame,.floor{stroke:#aaa}"
           ".front{stroke:#8f7d1e}.failed{stroke:#ff6b6b}" +
           dark + "}";
  }

  template <class Action>
  void for_each_point(const Action& action) const {
    for (const ChartSeries& series : chart_.series) {
      for (const ChartPoint& point : series.points) action(point);
    }
  }

  /// Whether it is a mark between the axes.
  static bool is_drawn(const ChartPoint& point) { return !point.has_failed && point.y > 0.0; }

  /// Of the points that succeeded.
  Axis axis(double ChartPoint::*number, double first, double last) const {
    double low = std::numeric_limits<double>::infinity(), high = 0.0;
    const auto include = [&](double value) {
      if (!(value > 0.0) || !std::isfinite(value)) return;
      low = std::min(low, value);
      high = std::max(high, value);
    };
    for_each_point([&](const ChartPoint& point) {
      if (!point.has_failed) include(point.*number);
    });
    if (number == &ChartPoint::x && chart_.floor) include(*chart_.floor);
    if (high == 0.0) low = high = 1.0;
    return {low, high, first, last};
  }

  double pixel_x(const ChartPoint& point) const { return point.x > 0.0 ? x_.pixel(point.x) : left; }

  void draw_head() {
    svg_.add_text(left, 26.0, R"(class="head")", shortened(chart_.title, longest_title));
    for (std::size_t i = 0; i < chart_.notes.size(); ++i) {
      svg_.add_text(left, 45.0 + line_height * static_cast<double>(i), R"(class="small")",
                    chart_.notes[i]);
    }
  }

  void draw_axes() {
    for (const double value : x_.ticks()) {
      const double x = x_.pixel(value);
      svg_.add(R"(<path class="grid" d="M{:.2f} {:.1f}V{:.1f}"/>)", x, top_, bottom);
      svg_.add(R"(<text class="small tick-x" data-value="{}" x="{:.2f}" y="{:.1f}" )"
               R"(text-anchor="middle">{}</text>)",
               value, x, bottom + 17.0, tick_text(value));
    }
    for (const double value : y_.ticks()) {
      const double y = y_.pixel(value);
      svg_.add(R"(<path class="grid" d="M{:.1f} {:.2f}H{:.1f}"/>)", left, y, right);
      // Texts stand on their line; the tick is in the middle of the digits.
      svg_.add(R"(<text class="small tick-y" data-value="{}" x="{:.1f}" y="{:.2f}" dy="4" )"
               R"(text-anchor="end">{}</text>)",
               value, left - 8.0, y, tick_text(value));
    }
    svg_.add(R"(<rect class="frame" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"/>)", left,
             top_, right - left, bottom - top_);
    svg_.add_text(0.5 * (left + right), bottom + 40.0, small_middle, chart_.x_label);
    svg_.add(R"svg(<text {} transform="{} rotate(-90)">{}</text>)svg", small_middle,
             moved(22.0, 0.5 * (top_ + bottom)), xml_text(chart_.y_label));
  }

  bool has_floor() const { return chart_.floor && *chart_.floor > 0.0; }

  void draw_floor() {
    if (!has_floor()) return;
    svg_.add(R"(<path class="floor" data-value="{}" d="M{:.2f} {:.1f}V{:.1f}"/>)", *chart_.floor,
             x_.pixel(*chart_.floor), top_, bottom);
  }

  /// From the most accurate to the fastest.
  void draw_front() {
    std::vector<const ChartPoint*> points;
    for_each_point([&](const ChartPoint& point) {
      if (is_drawn(point)) points.push_back(&point);
    });
    std::ranges::stable_sort(points, [](const ChartPoint* a, const ChartPoint* b) {
      return a->x != b->x ? a->x < b->x : a->y < b->y;
    });
    SvgPath path;
    for (const ChartPoint* point : points) {
      if (!efficient_.empty() && point->y >= efficient_.back()->y) continue;
      path.go_to(pixel_x(*point), y_.pixel(point->y));
      efficient_.push_back(point);
    }
    if (efficient_.size() > 1) svg_.add(R"(<path class="front" d="{}"/>)", path.text());
  }

  /// Full marks of what the others are changes of.
  std::string mark_of(std::size_t series) const {
    return fmt::format(R"(<path class="c{}{}" d="{}"/>)", series % colours.size(),
                       chart_.series[series].is_joined ? "" : " open",
                       marks[series % marks.size()]);
  }

  void draw_series(std::size_t index) {
    const ChartSeries& series = chart_.series[index];
    SvgPath line;
    for (const ChartPoint& point : series.points) {
      if (is_drawn(point)) line.go_to(pixel_x(point), y_.pixel(point.y));
    }
    if (series.is_joined && !line.text().empty()) {
      svg_.add(R"(<path class="c{} join" d="{}"/>)", index % colours.size(), line.text());
    }
    for (const ChartPoint& point : series.points) {
      if (!is_drawn(point)) continue;
      const double x = pixel_x(point), y = y_.pixel(point.y);
      svg_.add(R"(<g class="point" data-x="{}" data-y="{}" transform="{}"><title>{}</title>{}</g>)",
               point.x, point.y, moved(x, y), xml_text(point.name), mark_of(index));
      taken_.push_back({x - mark_size, y - mark_size, x + mark_size, y + mark_size});
    }
  }

  void draw_failures() {
    double y = top_ + 14.0;
    for_each_point([&](const ChartPoint& point) {
      if (!point.has_failed) return;
      svg_.add(R"(<g class="point failure" transform="{}"><title>{}</title>{}</g>)",
               moved(right, y), xml_text(point.name), failure_mark);
      y = std::min(y + 12.0, bottom - 6.0);
      has_failures_ = true;
    });
  }

  /// Beside efficient points first, where nothing is in the way.
  void draw_labels() {
    for (const ChartPoint* point : efficient_) draw_label(*point);
    for_each_point([&](const ChartPoint& point) {
      const bool is_done = std::ranges::find(efficient_, &point) != efficient_.end();
      if (is_drawn(point) && !is_done) draw_label(point);
    });
  }

  void draw_label(const ChartPoint& point) {
    if (point.label.empty()) return;
    const double x = pixel_x(point), y = y_.pixel(point.y);
    const double length = letter * static_cast<double>(characters(point.label)) + 4.0;
    const double side = mark_size + 4.0;
    const std::array<Box, 4> places = {
        {{x + side, y - 8.0, x + side + length, y + 6.0},
         {x - side - length, y - 8.0, x - side, y + 6.0},
         {x - 0.5 * length, y - side - 12.0, x + 0.5 * length, y - side + 1.0},
         {x - 0.5 * length, y + side - 1.0, x + 0.5 * length, y + side + 12.0}}};
    for (const Box& place : places) {
      const bool is_inside =
          place.x0 > left && place.x1 < right && place.y0 > top_ && place.y1 < bottom;
      const bool is_free =
          std::ranges::none_of(taken_, [&](const Box& other) { return place.meets(other); });
      if (!is_inside || !is_free) continue;
      svg_.add_text(0.5 * (place.x0 + place.x1), place.y1 - 3.0,
                    R"(class="label" text-anchor="middle")", point.label);
      taken_.push_back(place);
      return;
    }
  }

  void draw_legend() {
    double y = top_ + 10.0;
    const auto add_line = [&](const std::string& sign, const std::string& name) {
      svg_.add(R"(<g transform="{}">{}</g>)", moved(legend + 8.0, y), sign);
      svg_.add_text(legend + 26.0, y + 4.0, R"(class="small")", shortened(name, 28));
      y += 21.0;
    };
    for (std::size_t i = 0; i < chart_.series.size(); ++i) {
      add_line(mark_of(i), chart_.series[i].name);
    }
    y += 6.0;
    if (efficient_.size() > 1) {
      add_line(R"(<path class="front" d="M-7 0H8"/>)", "nothing better in both");
    }
    if (has_floor()) add_line(R"(<path class="floor" d="M0 -8V8"/>)", chart_.floor_name);
    if (has_failures_) add_line(failure_mark, "failed (on the rim)");
  }

  const LogLogChart& chart_;
  double top_;
  Axis x_, y_;
  Svg svg_;
  std::vector<const ChartPoint*> efficient_;
  std::vector<Box> taken_;
  bool has_failures_ = false;
};

}  // namespace

std::string to_svg(const LogLogChart& chart) {
  return Drawing(chart).text();
}

}  // namespace pleuel
