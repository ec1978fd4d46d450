#include "core/response/limits_at_ends.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/eager_matrices.hpp"
#include "core/base/int_size.hpp"

namespace pleuel {

namespace {

/// A jump is so many times what the steps beside it change, and the sample is so much of it from
/// both sides at least.
constexpr double steep = 8.0, inside = 0.25;

}  // namespace

LimitsAtEnds::LimitsAtEnds(const Eigen::MatrixXd& values, const StepRange& range,
                           const BrokenInstants& breaks)
    : values_(values) {
  if (breaks.empty()) return;
  look_at(range.first, 1, range, breaks);
  look_at(range.last, -1, range, breaks);
}

void LimitsAtEnds::look_at(int step, int within, const StepRange& range,
                           const BrokenInstants& breaks) {
  const auto last = static_cast<int>(values_.cols()) - 1;
  if (!breaks[step] || step < 2 || step > last - 2 || range.steps() < 4) return;
  for (int channel = 0; channel < static_cast<int>(values_.rows()); ++channel) {
    const auto y = [&](int offset) { return values_(channel, step + offset); };
    const double jump = y(1) - y(-1);
    const double beside = std::max(std::abs(y(-1) - y(-2)), std::abs(y(2) - y(1)));
    const double share = (y(0) - y(-1)) / jump;
    if (!(std::abs(jump) > steep * beside) || share < inside || share > 1.0 - inside) continue;
    limits_.push_back({step, within, channel});
  }
}

Eigen::MatrixXd LimitsAtEnds::applied() const {
  Eigen::MatrixXd values = values_;
  for (const auto& [step, within, channel] : limits_) {
    values(channel, step) =
        2.0 * values_(channel, step + within) - values_(channel, step + 2 * within);
  }
  return values;
}

void LimitsAtEnds::restore(Reduction& reduction) const {
  restore(reduction.samples);
  for (PeakTie& tie : reduction.ties) restore(tie.other_samples);
}

void LimitsAtEnds::restore(std::vector<Sample>& samples) const {
  for (const Limit& limit : limits_) {
    const auto found = std::find_if(samples.begin(), samples.end(), [&](const Sample& sample) {
      return sample.step == limit.step && sample.channel == limit.channel;
    });
    if (found == samples.end()) continue;
    const double weight = found->weight;
    *found = {limit.step + limit.within, limit.channel, 2.0 * weight};
    samples.push_back({limit.step + 2 * limit.within, limit.channel, -weight});
  }
}

}  // namespace pleuel
