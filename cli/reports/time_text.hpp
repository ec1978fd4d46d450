#pragma once

#include "cli/text/json.hpp"
#include "core/base/stopwatch.hpp"

/// Times that were compared in turns (core/base/stopwatch.hpp).
namespace pleuel {

/// Of the same work, whatever a clock says.
bool is_same(const ComparedTime& time);

/// "15 ± 3 %" of what is measurable
std::string percent_with_spread(const ComparedTime& time);

/// "−15 ± 3 %"; "the same" of the same work, "not measurable" where works differ by no more than times of
/// the same work do
std::string time_change_text(const ComparedTime& time);

/// {"change", "spread", "is_measurable"}: relative
Json time_change_document(const ComparedTime& time);

}  // namespace pleuel
