#pragma once

#include <optional>
#include <string>
#include <vector>

namespace pleuel {

/// A setting in a chart of cost against error.
struct ChartPoint {
  double x = 0.0, y = 0.0;  ///< positive; an x of 0 stands on the left rim
  std::string name = {};    ///< shown when the mouse rests on it
  std::string label = {};   ///< beside the mark where there is room; may be empty
  bool has_failed = false;  ///< stands on the right rim
};

/// Points with one mark and colour; joined in their order if `is_joined`.
struct ChartSeries {
  std::string name;
  std::vector<ChartPoint> points;
  bool is_joined = false;
};

/// Both axes logarithmic; what lies further left and lower is better.
struct LogLogChart {
  std::string title;
  std::vector<std::string> notes;  ///< lines below the title
  std::string x_label, y_label;    ///< with units
  std::vector<ChartSeries> series;
  std::optional<double> floor;  ///< smallest x that means something: a line
  std::string floor_name;
};

/// The chart as an SVG document that stands for itself, in light and dark: marks in colours that
/// colour-blind people tell apart (Okabe & Ito 2008) and in different shapes; the efficient points,
/// than which no other is better in both, are joined by a broad line. Every mark has its numbers as
/// data-x and data-y, every tick its value as data-value.
std::string to_svg(const LogLogChart& chart);

}  // namespace pleuel
