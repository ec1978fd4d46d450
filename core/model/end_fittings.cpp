#include "core/model/end_fittings.hpp"

#include <algorithm>
#include <cmath>

namespace pleuel {

std::vector<EndHold> EndFittings::holds() const {
  const double least = same_place * total_;
  std::vector<Joined> left = joints_;
  std::vector<EndHold> holds;
  for (JointHold hold : as_one_.of(beam_)) {
    const double at = hold.at * total_ - before_;
    hold.at = std::clamp(at / length_, 0.0, 1.0);
    const auto joint = std::ranges::find_if(
        left, [&](const Joined& one) { return std::abs(one.position - at) <= least; });
    if (joint != left.end()) {
      holds.push_back({joint->end, true, joint->distance, hold});
      left.erase(joint);
    } else {
      const int end = at <= least ? 0 : at >= length_ - least ? 1 : -1;
      holds.push_back({end, false, {}, hold});
    }
  }
  return holds;
}

}  // namespace pleuel
