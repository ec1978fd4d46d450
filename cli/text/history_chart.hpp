#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

/// Histories as curves with limits and error bands, in the units that people see.
namespace pleuel {

struct HistoryCurve {
  std::string name;  ///< of the design: "start", "optimum"
  Eigen::VectorXd time, values;
  Eigen::VectorXd band{};  ///< half-widths; empty: not known
};

struct HistoryChart {
  std::string title;
  std::string unit, time_unit;
  std::vector<HistoryCurve> curves;  ///< the last one is what the chart is about
  std::vector<double> limits{};
};

/// Lower and upper end of what a chart shows: all curves and bands, and limits that are not far from
/// them.
std::pair<double, double> range_of(const HistoryChart& chart);

/// Round numbers between two ends: about so many.
std::vector<double> round_ticks(double low, double high, int about);

/// Charts one below the other as an SVG document that stands for itself, in light and dark. Curves
/// have their peaks as data-peak.
std::string to_svg(const std::vector<HistoryChart>& charts);

/// The last curve and the limits by dots of braille letters, for terminals.
/// @param width  in letters, with the axis
std::string to_braille(const HistoryChart& chart, int width);

}  // namespace pleuel
