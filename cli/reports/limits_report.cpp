#include "cli/reports/limits_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cli/text/table.hpp"
#include "cli/text/wrapped_text.hpp"
#include "core/base/find_named.hpp"
#include "core/base/number_text.hpp"
#include "core/response/peak_place.hpp"
#include "core/scene/shown_unit.hpp"
#include "optimization/verdict.hpp"
#include "studies/pareto_point.hpp"

namespace pleuel {

namespace {

Json peak_document(const Peak& peak) {
  Json document = {{"time", peak.time}, {"place", peak.place}};
  if (peak.share) document["share"] = *peak.share;
  return document;
}

/// "0.1176 s, 0.42 of the length"
std::string peak_text(const std::optional<Peak>& peak) {
  if (!peak) return "";
  const std::string time = fmt::format("{:.4g} s", peak->time);
  return peak->share ? fmt::format("{}, {:.2g} of the length", time, *peak->share) : time;
}

bool has_peaks(const Analysis& analysis) {
  return std::ranges::any_of(analysis.responses,
                             [](const Response& response) { return response.is_peak_over_time(); });
}

/// Of the terms of a sum, which may cancel.
constexpr double round_off_of_terms = 1e-12;

/// The sum of the magnitudes of what a limit on variables adds up; zero of one on a response.
double terms_of(const ConstraintSettings& constraint, const Eigen::VectorXd& x) {
  double size = 0.0;
  for (const auto& [variable, coefficient] : constraint.linear) {
    size += std::abs(coefficient * x(variable));
  }
  return size;
}

double value_of(const ConstraintSettings& constraint, const ProblemFile& problem,
                const Eigen::VectorXd& x, const Analysis& analysis) {
  double value = 0.0;
  for (const auto& [variable, coefficient] : constraint.linear) value += coefficient * x(variable);
  if (!constraint.linear.empty()) {
    return std::abs(value) <= round_off_of_terms * terms_of(constraint, x) ? 0.0 : value;
  }
  return without_round_off(analysis,
                           index_of_named(problem.responses, constraint.response).value());
}

/// As exactly as a verified optimum keeps its limits; of a limit on variables, which may be zero,
/// to the round-off of its terms.
bool is_kept(const ConstraintSettings& constraint, const Eigen::VectorXd& x, double value) {
  const auto exceeds = [&](double excess, double limit) {
    return excess > std::max(Tolerances().violation * std::abs(limit),
                             round_off_of_terms * terms_of(constraint, x));
  };
  return !(constraint.upper && exceeds(value - *constraint.upper, *constraint.upper)) &&
         !(constraint.lower && exceeds(*constraint.lower - value, *constraint.lower));
}

/// Whether a limit that is broken may be kept as far as the error of its response is known.
bool is_within_error(const ProblemFile& problem, const ConstraintSettings& constraint, double value,
                     const ErrorBars& errors) {
  const auto index = index_of_named(problem.responses, constraint.response);
  const auto bar = index ? error_of(errors, *index) : std::nullopt;
  if (!bar || !bar->is_resolved() || !std::isfinite(bar->bound())) return false;
  const bool is_high = constraint.upper && value > *constraint.upper;
  const double excess = is_high ? value - *constraint.upper : *constraint.lower - value;
  return excess <= bar->bound();
}

/// A difference that value and limit do not show, with their five digits, is none.
double shown_margin(const Json& limit) {
  const double bound = limit.at("limit").get<double>();
  const double below = bound - limit.at("value").get<double>();
  const double margin = limit["side"] == "upper" ? below : -below;
  return std::abs(margin) < 1e-5 * std::abs(bound) ? 0.0 : margin;
}

std::string sum_text(const Json& limits) {
  const std::vector<std::string> broken = broken_limits(limits);
  const std::size_t all = limits.size();
  if (broken.empty() && all == 1) return "The limit is kept.\n";
  if (broken.empty()) return fmt::format("All {} limits are kept.\n", all);
  if (all == 1) return fmt::format("The limit is broken: {}.\n", broken.front());
  return wrapped(fmt::format("{} of {} limits {} broken: {}.\n", broken.size(), all,
                             broken.size() == 1 ? "is" : "are", fmt::join(broken, ", ")),
                 "  ");
}

const char* cause_text(FrontGap::Cause cause) {
  static constexpr std::array<const char*, 4> names = {"open", "jump", "failure", "narrow"};
  return names[static_cast<std::size_t>(cause)];
}

/// Of a gap that more points do not close.
const char* reason(FrontGap::Cause cause) {
  if (cause == FrontGap::Cause::jump) return "the front jumps: searches found no design there";
  if (cause == FrontGap::Cause::narrow) {
    return "nothing was looked for: limits there are too near to each other, and the objective "
           "cannot be limited in their place";
  }
  return "searches failed, or came to designs that others dominate";
}

std::string describe(const Tie& tie, const Response& response) {
  const PeakTie& peaks = tie.peaks;
  return fmt::format("{}: peaks within {:.2g} %, {}; gradients differ by {:.3g} %", response.name,
                     100 * peaks.gap, describe_tie(peaks, response), 100 * *tie.kink);
}

}  // namespace

std::vector<std::string> broken_limits(const Json& limits) {
  std::vector<std::string> broken;
  for (const auto& [name, limit] : limits.items()) {
    if (!limit["kept"].get<bool>()) broken.push_back(name);
  }
  return broken;
}

Json responses_document(const ProblemFile& problem, const Analysis& analysis,
                        const ErrorBars& errors) {
  Json document = Json::object();
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    const Response& response = analysis.responses[i];
    document[response.name] = {{"value", analysis.reductions[i].value}, {"unit", response.unit}};
    if (!errors.empty()) document[response.name]["error"] = error_document(error_of(errors, i));
    if (const auto peak = find_peak(problem, analysis, i)) {
      document[response.name]["peak"] = peak_document(*peak);
    }
  }
  return document;
}

double size_of(const Model& model) {
  const auto moves = [](const BodyModel& body) { return body.frame.translations() > 0; };
  const auto body = std::ranges::find_if(model.bodies, moves);
  return body == model.bodies.end() ? 0.0 : model.mechanism.scale(body->frame.offset);
}

double without_round_off(const Analysis& analysis, std::size_t response) {
  constexpr double round_off = 1e-14;
  const Response& of = analysis.responses[response];
  const double value = analysis.reductions[response].value;
  if (!of.history()) return value;
  double least = round_off * analysis.histories[response].lpNorm<Eigen::Infinity>();
  if (of.is_reduced_by(OverTime::integral)) least *= analysis.trajectory.time.maxCoeff();
  if (of.unit == "m") least = std::max(least, round_off * size_of(analysis.model));
  return std::abs(value) < least ? 0.0 : value;
}

std::string responses_text(const ProblemFile& problem, const Analysis& analysis,
                           const ErrorBars& errors) {
  std::vector<Table::Column> columns = {left_aligned("response"), "value", left_aligned("unit")};
  if (!errors.empty()) columns.push_back(left_aligned("error"));
  if (has_peaks(analysis)) columns.push_back(left_aligned("peak at"));
  Table table(columns);
  for (std::size_t i = 0; i < analysis.responses.size(); ++i) {
    const ShownUnit unit = unit_of(problem.responses[i]);
    const double value = without_round_off(analysis, i);
    std::vector<std::string> row = {analysis.responses[i].name, significant(unit.shown(value)),
                                    unit.name};
    if (!errors.empty()) row.push_back(error_text(error_document(error_of(errors, i)), unit));
    if (has_peaks(analysis)) {
      row.push_back(value == 0.0 ? "" : peak_text(find_peak(problem, analysis, i)));
    }
    table.add_row(std::move(row));
  }
  return table.is_empty() ? "  The file asks for no responses.\n" : table.text();
}

Json monitors_document(const Monitors& monitors) {
  return {{"position_drift", monitors.position_drift},
          {"velocity_drift", monitors.velocity_drift},
          {"energy_error", monitors.energy_error},
          {"elastic_energy_error", monitors.elastic_energy_error},
          {"elastic_rotation", monitors.elastic_rotation}};
}

std::string monitors_text(const Monitors& monitors, int multipliers) {
  std::string text;
  if (multipliers > 0) {
    text = wrapped(
        fmt::format("Joints and drives are kept to {} m or rad, their rates to {} m/s or rad/s.\n",
                    magnitude(monitors.position_drift), magnitude(monitors.velocity_drift)));
  }
  return text + fmt::format("Energy is balanced to {} of the largest energy in the motion.\n",
                            magnitude(monitors.energy_error));
}

std::string size_text(const Analysis& analysis) {
  const System& system = *analysis.model.mechanism.system;
  return fmt::format("{} steps of {:.4g} s, {} coordinates, {} multipliers",
                     analysis.trajectory.steps(), analysis.trajectory.scheme.step,
                     system.coordinates(), system.multipliers());
}

Json limit_entry(const ProblemFile& problem, const ConstraintSettings& constraint, double value) {
  const bool has_both = constraint.lower && constraint.upper;
  const bool is_upper = has_both ? *constraint.upper - value <= value - *constraint.lower
                                 : constraint.upper.has_value();
  const double limit = is_upper ? *constraint.upper : *constraint.lower;
  Json entry = {{"value", value},
                {"limit", limit},
                {"side", is_upper ? "upper" : "lower"},
                {"unit", unit_of(problem, constraint).si}};
  if (limit > 0.0 && value >= 0.0 && is_upper) entry["utilisation"] = value / limit;
  if (limit > 0.0 && value > 0.0 && !is_upper) entry["utilisation"] = limit / value;
  return entry;
}

Json limit_document(const ProblemFile& problem, const ConstraintSettings& constraint,
                    const Eigen::VectorXd& x, double value) {
  Json entry = limit_entry(problem, constraint, value);
  entry["kept"] = is_kept(constraint, x, value);
  return entry;
}

Json limits_document(const ProblemFile& problem, const Eigen::VectorXd& x, const Analysis& analysis,
                     const ErrorBars& errors) {
  Json document = Json::object();
  for (const ConstraintSettings& constraint : problem.constraints) {
    const double value = value_of(constraint, problem, x, analysis);
    Json& entry = document[constraint.name] = limit_document(problem, constraint, x, value);
    if (entry["kept"].get<bool>()) continue;
    entry["within_error"] = is_within_error(problem, constraint, value, errors);
  }
  return document;
}

DocumentColumn kept_column() {
  const auto verdict = [](const std::string&, const Json& limit) {
    if (limit.at("kept").get<bool>()) return "kept";
    return limit.value("within_error", false) ? "BROKEN, within its error" : "BROKEN";
  };
  return {"", verdict, Table::Align::left};
}

std::string limits_text(const ProblemFile& problem, const Json& limits) {
  if (limits.empty()) return "";
  const NamedUnits units = units_of_limits(problem);
  const auto margin = [&](const std::string& name, const Json& limit) {
    return significant(units.at(name).shown(shown_margin(limit)), 3);
  };
  const Table table = table_of(limits, {name_column("constraint"),
                                        shown_column("value", "/value", units),
                                        limit_column(units),
                                        unit_column(units),
                                        number_column("used", "/utilisation", percent),
                                        {"margin", margin},
                                        kept_column()});
  return "\n" + table.text() + "\n" + sum_text(limits);
}

std::string gaps_message(const ProblemFile& problem, const ParetoFront& front,
                         const std::string& limited) {
  const double asked = problem.pareto->gap;
  if (!front.gaps.largest && front.gaps.gaps.empty()) {
    return "there are no neighbours: fewer than two points keep the limits and are not dominated";
  }
  std::string text = fmt::format("neighbours are at most {} apart, both goals over their ranges",
                                 percent(front.gaps.largest.value_or(0.0)));
  if (front.gaps.gaps.empty()) return fmt::format("{} ({} asked)", text, percent(asked));
  text += fmt::format("; asked was {}", percent(asked));
  const ShownUnit unit = unit_of(problem, problem.constraints[varied_rows(problem).front()]);
  bool is_open = false;
  for (const FrontGap& gap : front.gaps.gaps) {
    is_open = is_open || gap.cause == FrontGap::Cause::open;
    if (gap.cause == FrontGap::Cause::open) continue;
    const auto value = [&](std::size_t i) {
      return significant(unit.shown(front.points[i].limited_value));
    };
    text += fmt::format("; between {} = {} and {}{} ({}) {}", limited, value(gap.tight),
                        value(gap.loose), unit.suffix(), percent(gap.size), reason(gap.cause));
  }
  if (is_open) {
    text += fmt::format("; no more than {} points were allowed (\"most_points\")",
                        problem.pareto->most_points);
  }
  return text;
}

Json gaps_document(const ProblemFile& problem, const ParetoFront& front) {
  Json document = {{"asked", problem.pareto->gap}, {"largest", number_or_null(front.gaps.largest)}};
  const auto limited = [&](std::size_t i) {
    const ParetoPoint& point = front.points[i];
    return point.has_design() && point.keeps_limits() ? Json(point.limited_value) : Json(nullptr);
  };
  document["left"] = list_of(front.gaps.gaps, [&](const FrontGap& gap) {
    return Json{{"points", {gap.tight + 1, gap.loose + 1}},
                {"limited", {limited(gap.tight), limited(gap.loose)}},
                {"size", gap.size},
                {"cause", cause_text(gap.cause)}};
  });
  return document;
}

Ties make_ties(const Analysis& analysis, const std::vector<Kink>& kinks) {
  Ties ties(analysis.responses.size());
  for (std::size_t i = 0; i < ties.size(); ++i) {
    const std::vector<PeakTie>& all = analysis.reductions[i].ties;
    if (!all.empty()) ties[i] = Tie{all.front(), std::nullopt};
  }
  for (const Kink& kink : kinks) {
    std::optional<Tie>& tie = ties[kink.response];
    if (!tie || !tie->is_kink()) tie = Tie{kink.tie, kink.difference};
  }
  return ties;
}

Json tie_document(const Tie& tie, const Response& response) {
  const Signal& signal = *response.history()->signal;
  return {
      {"times", {tie.peaks.time, tie.peaks.other_time}},
      {"places", {signal.describe(tie.peaks.channel), signal.describe(tie.peaks.other_channel)}},
      {"gap", tie.peaks.gap},
      {"is_kink", tie.is_kink()}};
}

std::string ties_text(const Ties& ties, const Analysis& analysis) {
  std::string kinks;
  std::vector<std::string> harmless;
  for (std::size_t i = 0; i < ties.size(); ++i) {
    if (!ties[i]) continue;
    const Response& response = analysis.responses[i];
    if (ties[i]->is_kink()) {
      kinks += fmt::format("  {}\n", describe(*ties[i], response));
    } else {
      harmless.push_back(response.name);
    }
  }
  std::string text;
  if (!kinks.empty()) {
    text += "\nKinks: two peaks tie, and the gradient is that of the higher one only\n" + kinks;
  }
  if (!harmless.empty()) {
    text += fmt::format("\nHarmless ties (equal peaks that move alike with the design): {}\n",
                        fmt::join(harmless, ", "));
  }
  return wrapped(text, "    ");
}

}  // namespace pleuel
