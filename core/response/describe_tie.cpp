#include "core/response/describe_tie.hpp"

#include <fmt/format.h>

namespace pleuel {

std::string describe_tie(const PeakTie& tie, const Response& response) {
  const Signal& signal = *response.history()->signal;
  return fmt::format("at {:.5g} s ({}) and at {:.5g} s ({})", tie.time,
                     signal.describe(tie.channel), tie.other_time,
                     signal.describe(tie.other_channel));
}

}  // namespace pleuel
