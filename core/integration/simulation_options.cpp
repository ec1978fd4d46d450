#include "core/integration/simulation_options.hpp"

#include <algorithm>
#include <cmath>

namespace pleuel {

double steps_within(double time, double step) {
  return std::ceil(time / step * (1.0 - 1e-12));
}

int step_count(const TimeIntegration& options) {
  return std::max(1, static_cast<int>(steps_within(options.end_time, options.step)));
}

std::vector<double> regular_instants(const SimulationOptions& options) {
  constexpr double round_off = 1e-9, least_distance = 0.25;  // of a step
  const int steps = step_count(options);
  const double end = options.end_time, h = end / steps;
  std::vector<double> breaks = options.breaks, instants = {0.0};
  std::ranges::sort(breaks);
  std::erase_if(breaks, [&](double time) { return !(end - time >= least_distance * h); });
  breaks.push_back(end);
  instants.reserve(static_cast<std::size_t>(steps) + 2 * breaks.size());
  double last = 0.0;
  for (const double time : breaks) {
    if (time - last < least_distance * h && time < end) continue;
    const double length = time - last, exact = length / h;
    const int count = std::max(1, static_cast<int>(std::ceil(exact - round_off * exact)));
    const bool is_regular = last == 0.0 && time == end;
    for (int i = 1; i < count; ++i) {
      instants.push_back(is_regular ? end * i / steps : last + length * i / count);
    }
    instants.push_back(time);
    last = time;
  }
  return instants;
}

namespace {

/// A step is halved so often at most, unless told otherwise.
constexpr int usual_halvings = 10, most_halvings = 20;
/// A step doubles where its error is so small, relative to what is allowed: it then is four times
/// as large.
constexpr double small_error = 0.15;

int halvings(const SimulationOptions& options) {
  if (options.smallest_step <= 0.0) return usual_halvings;
  const double regular_step = options.end_time / step_count(options);
  const double ratio = regular_step / options.smallest_step * (1 + 1e-12);
  return std::clamp(static_cast<int>(std::floor(std::log2(ratio))), 0, most_halvings);
}

double error_of(Eigen::Index i, const State& old, const State& found, const Scheme& scheme,
                const Eigen::VectorXd& scale) {
  return std::abs(found.a(i) - old.a(i)) / scale(i) * std::abs(scheme.local_error) / scheme.step;
}

}  // namespace

LocalErrorControl::LocalErrorControl(const Mechanism& mechanism, const SimulationOptions& options)
    : scale_(mechanism.scale), allowed_(options.local_error), finest_level_(halvings(options)) {}

int LocalErrorControl::end_of_part(int begin) {
  while (begin % (parts() >> level_) != 0) ++level_;
  return begin + (parts() >> level_);
}

Eigen::Index LocalErrorControl::worst_coordinate(const State& old, const State& found,
                                                 const Scheme& scheme) const {
  Eigen::Index worst = 0;
  double largest = error_of(0, old, found, scheme, scale_);
  for (Eigen::Index i = 1; i < scale_.size(); ++i) {
    const double error = error_of(i, old, found, scheme, scale_);
    if (error <= largest) continue;
    worst = i;
    largest = error;
  }
  return worst;
}

double LocalErrorControl::relative_error(const State& old, const State& found,
                                         const Scheme& scheme) const {
  const Eigen::Index worst = worst_coordinate(old, found, scheme);
  return error_of(worst, old, found, scheme, scale_) * (1 << level_) / allowed_;
}

bool LocalErrorControl::refine() {
  if (level_ == finest_level_) return false;
  ++level_;
  return true;
}

void LocalErrorControl::accept(double relative_error) {
  if (level_ > 0 && relative_error < small_error) --level_;
}

}  // namespace pleuel
