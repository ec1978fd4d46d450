#include "cli/text/history_chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cli/text/svg.hpp"
#include "core/base/int_size.hpp"
#include "core/base/number_text.hpp"
#include "picture/thinned.hpp"

namespace pleuel {

namespace {

// Pixels of one chart.
constexpr double chart_width = 820.0, chart_height = 270.0;
constexpr double plot_left = 74.0, plot_right = 800.0, plot_top = 36.0, plot_bottom = 226.0;
constexpr int most_points = 1600;
/// A limit farther off than so many ranges of the curves is told, not drawn.
constexpr double near_limit = 1.5;
/// Curves that change by less of their size are drawn as constants.
constexpr double least_change = 1e-9;

constexpr const char* svg_style =
    "text{fill:#17212d;font-size:12px}.soft{fill:#5b6878}.grid{stroke:#dde3ea}"
    ".main{stroke:#0b63ce}.band{fill:#0b63ce}.other{stroke:#98a4b3}.limit{stroke:#c2312f}"
    ".paper{fill:#fff}"
    "@media(prefers-color-scheme:dark){text{fill:#e8edf3}.soft{fill:#97a5b5}.grid{stroke:#2b3542}"
    ".main{stroke:#6aaeff}.band{fill:#6aaeff}.other{stroke:#7d8a9a}.limit{stroke:#ff7b72}"
    ".paper{fill:#171e27}}";

std::string tick_label(double value) {
  return fmt::format("{:.6g}", std::abs(value) < 1e-12 ? 0.0 : value);
}

constexpr const char* soft_end = R"(class="soft" text-anchor="end")";

/// "rod_stress [MPa]"
std::string titled(const HistoryChart& chart) {
  return chart.title + (chart.unit == "1" ? "" : fmt::format(" [{}]", chart.unit));
}

/// From numbers to pixels of one chart.
struct Scale {
  double from, to, first, last;
  double operator()(double value) const {
    return first + (value - from) / (to - from) * (last - first);
  }
};

class ChartDrawing {
 public:
  ChartDrawing(const HistoryChart& chart, double top, Svg& svg)
      : chart_(chart), top_(top), svg_(svg) {
    const auto [low, high] = range_of(chart);
    const Eigen::VectorXd& time = chart.curves.back().time;
    y_ = {low, high, top + plot_bottom, top + plot_top};
    x_ = {time.minCoeff(), std::max(time.maxCoeff(), time.minCoeff() + 1e-300), plot_left,
          plot_right};
    svg_.add_text(plot_left, top_ + 18.0, R"(font-weight="600")", titled(chart));
    draw_key();
    draw_axes();
    for (const double limit : chart_.limits) draw_limit(limit);
    for (const HistoryCurve& curve : chart_.curves) draw_curve(curve);
  }

 private:
  /// Which line is which design, at the right of the title.
  void draw_key() {
    if (chart_.curves.size() < 2) return;
    double right = plot_right;
    for (auto curve = chart_.curves.rbegin(); curve != chart_.curves.rend(); ++curve) {
      svg_.add_text(right, top_ + 18.0, soft_end, curve->name);
      right -= 7.0 * static_cast<double>(curve->name.size()) + 10.0;
      svg_.add(R"(<path class="{}" stroke-width="2" d="M{:.1f} {:.1f}h-18"/>)",
               curve == chart_.curves.rbegin() ? "main" : "other", right, top_ + 14.0);
      right -= 34.0;
    }
  }

  void draw_axes() {
    for (const double tick : round_ticks(y_.from, y_.to, 5)) {
      svg_.add(R"(<path class="grid" d="M{:.1f} {:.1f}H{:.1f}"/>)", plot_left, y_(tick),
               plot_right);
      svg_.add_text(plot_left - 8.0, y_(tick) + 4.0, soft_end, tick_label(tick));
    }
    for (const double tick : round_ticks(x_.from, x_.to, 7)) {
      svg_.add_text(x_(tick), top_ + plot_bottom + 18.0, R"(class="soft" text-anchor="middle")",
                    tick_label(tick));
    }
    svg_.add_text(plot_right, top_ + plot_bottom + 34.0, soft_end,
                  fmt::format("time [{}]", chart_.time_unit));
  }

  void draw_limit(double limit) {
    if (limit < y_.from || limit > y_.to) return;
    svg_.add(R"(<path class="limit" stroke-dasharray="6 4" d="M{:.1f} {:.1f}H{:.1f}"/>)", plot_left,
             y_(limit), plot_right);
    svg_.add_text(plot_left + 6.0, y_(limit) - 5.0, R"(class="soft")",
                  "limit " + tick_label(limit));
  }

  void draw_curve(const HistoryCurve& curve) {
    const bool is_main = &curve == &chart_.curves.back();
    const std::vector<int> points = thinned(curve.values, most_points, {});
    if (is_main && curve.band.size() == curve.values.size()) draw_band(curve, points);
    SvgPath path;
    for (const int i : points) path.go_to(x_(curve.time(i)), y_(curve.values(i)));
    Eigen::Index peak = 0;
    curve.values.cwiseAbs().maxCoeff(&peak);
    svg_.add(R"(<path class="{}" data-name="{}" data-peak="{}" fill="none" stroke-width="{}" )"
             R"(stroke-linejoin="round" d="{}"/>)",
             is_main ? "main" : "other", xml_text(curve.name), curve.values(peak),
             is_main ? 1.8 : 1.2, path.text());
    if (is_main) draw_peak(curve, peak);
  }

  void draw_band(const HistoryCurve& curve, const std::vector<int>& points) {
    SvgPath path;
    const auto go_to = [&](int i, double side) {
      path.go_to(x_(curve.time(i)), y_(curve.values(i) + side * curve.band(i)));
    };
    for (const int i : points) go_to(i, 1.0);
    for (auto i = points.rbegin(); i != points.rend(); ++i) go_to(*i, -1.0);
    svg_.add(R"(<path class="band" opacity="0.25" d="{}Z"/>)", path.text());
  }

  void draw_peak(const HistoryCurve& curve, Eigen::Index peak) {
    const double x = x_(curve.time(peak)), y = y_(curve.values(peak));
    const double below = curve.values(peak) < 0.0 ? 16.0 : -8.0;
    const char* anchor = x > plot_right - 60.0 ? "end" : x < plot_left + 60.0 ? "start" : "middle";
    svg_.add(R"(<circle class="paper main" cx="{:.1f}" cy="{:.1f}" r="3.5" stroke-width="1.8"/>)",
             x, y);
    svg_.add_text(x, y + below, fmt::format(R"(text-anchor="{}" font-weight="600")", anchor),
                  significant(curve.values(peak), 4));
  }

  const HistoryChart& chart_;
  double top_;
  Scale x_{}, y_{};
  Svg& svg_;
};

/// Dots of braille letters, two wide and four high (Unicode, U+2800 … U+28FF).
class Dots {
 public:
  Dots(int columns, int rows)
      : columns_(columns), rows_(rows), letters_(static_cast<std::size_t>(columns * rows), 0) {}

  int width() const { return 2 * columns_; }
  int height() const { return 4 * rows_; }

  /// @param y  from above
  void set(int x, int y) {
    if (x < 0 || y < 0 || x >= width() || y >= height()) return;
    static constexpr unsigned char bits[4][2] = {{1, 8}, {2, 16}, {4, 32}, {64, 128}};
    letters_[y / 4 * columns_ + x / 2] |= bits[y % 4][x % 2];
  }

  std::string row(int row) const {
    std::string text;
    for (int i = 0; i < columns_; ++i) {
      const unsigned letter = letters_[row * columns_ + i];
      text += static_cast<char>(0xE2);
      text += static_cast<char>(0xA0 + (letter >> 6U));
      text += static_cast<char>(0x80 + (letter & 63U));
    }
    return text;
  }

 private:
  int columns_, rows_;
  std::vector<unsigned char> letters_;
};

}  // namespace

std::pair<double, double> range_of(const HistoryChart& chart) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const HistoryCurve& curve : chart.curves) {
    low = std::min(low, curve.values.minCoeff());
    high = std::max(high, curve.values.maxCoeff());
    if (curve.band.size() != curve.values.size()) continue;
    low = std::min(low, (curve.values - curve.band).minCoeff());
    high = std::max(high, (curve.values + curve.band).maxCoeff());
  }
  const double size = std::max(std::abs(low), std::abs(high));
  const double own = std::max(high - low, least_change * size);
  const double first_low = low, first_high = high;
  for (const double limit : chart.limits) {
    if (limit > first_high + near_limit * own || limit < first_low - near_limit * own) continue;
    low = std::min(low, limit);
    high = std::max(high, limit);
  }
  const bool is_constant = high - low <= least_change * size;
  const double margin = is_constant ? std::max(1.0, 1e-3 * size) : 0.08 * (high - low);
  return {low - margin, high + margin};
}

std::vector<double> round_ticks(double low, double high, int about) {
  const double rough = (high - low) / about;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double share = rough / power;
  const double step = power * (share < 1.5 ? 1.0 : share < 3.5 ? 2.0 : share < 7.5 ? 5.0 : 10.0);
  std::vector<double> ticks;
  const double first = std::ceil(low / step - least_change);
  const int count = static_cast<int>(std::floor(high / step + least_change) - first) + 1;
  for (int k = 0; k < count; ++k) ticks.push_back((first + k) * step);
  return ticks;
}

std::string to_svg(const std::vector<HistoryChart>& charts) {
  Svg svg(chart_width, chart_height * static_cast<double>(charts.size()), charts.front().title,
          svg_style);
  double top = 0.0;
  for (const HistoryChart& chart : charts) {
    ChartDrawing(chart, top, svg);
    top += chart_height;
  }
  return svg.text();
}

std::string to_braille(const HistoryChart& chart, int width) {
  constexpr int rows = 10, axis = 10;
  Dots dots(std::max(width - axis - 2, 20), rows);
  const HistoryCurve& curve = chart.curves.back();
  const std::pair<double, double> range = range_of(chart);
  const double low = range.first, high = range.second;
  const double begin = curve.time(0), end = curve.time(curve.time.size() - 1);
  const auto dot_y = [&](double value) {
    return static_cast<int>(std::lround((high - value) / (high - low) * (dots.height() - 1)));
  };
  for (const double limit : chart.limits) {
    for (int x = 0; x < dots.width(); x += 4) dots.set(x, dot_y(limit));
  }
  // Of each column of dots everything that the curve passes there.
  const auto dot_x = [&](Eigen::Index i) {
    return static_cast<int>((curve.time(i) - begin) / std::max(end - begin, 1e-300) *
                            (dots.width() - 1));
  };
  for (Eigen::Index i = 0; i + 1 < curve.values.size(); ++i) {
    const int from = dot_x(i), to = dot_x(i + 1);
    for (int x = from; x <= to; ++x) {
      const double a = to > from ? double(x - from) / (to - from) : 0.0;
      const double b = to > from ? std::min(1.0, double(x + 1 - from) / (to - from)) : 1.0;
      const double change = curve.values(i + 1) - curve.values(i);
      const int y0 = dot_y(curve.values(i) + a * change), y1 = dot_y(curve.values(i) + b * change);
      for (int y = std::min(y0, y1); y <= std::max(y0, y1); ++y) dots.set(x, y);
    }
  }
  std::string text = titled(chart) + "\n";
  for (int row = 0; row < rows; ++row) {
    const bool has_label = row == 0 || row == rows - 1 || row == rows / 2;
    const double value = high - (row + 0.5) / rows * (high - low);
    text += fmt::format("{:>{}} ┤{}\n", has_label ? fmt::format("{:.3g}", value) : "", axis,
                        dots.row(row));
  }
  const std::string first = fmt::format("{:.4g}", begin);
  const std::string last = fmt::format("{:.4g} {}", end, chart.time_unit);
  const int space = dots.width() / 2 - int_size(first);
  return text + fmt::format("{:>{}}  {}{:>{}}\n", "", axis, first, last, space);
}

}  // namespace pleuel
