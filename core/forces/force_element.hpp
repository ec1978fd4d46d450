#pragma once

#include <memory>

#include "core/system/gauge.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// A force element between two markers: what it adds to the system, and what can be read of it.
struct ForceElement {
  std::unique_ptr<Term> term;
  std::unique_ptr<Gauge> gauge;
};

}  // namespace pleuel
