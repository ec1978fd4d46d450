#include "core/trust/bending_range.hpp"

#include <fmt/format.h>

namespace pleuel {

namespace {

/// Elastic rotations [rad] beyond which deformation is not small.
constexpr double small_rotation = 0.2;

}  // namespace

std::vector<Doubt> doubt_bending_range(const TrustedRun& run) {
  if (run.monitors.elastic_rotation <= small_rotation) return {};
  return {{fmt::format(
               "\"{}\" bends until it has turned by {:.4g} rad against its frame: too far for "
               "linear elasticity, which is good for some {:g} rad. Do not trust these numbers.",
               run.monitors.most_bent, run.monitors.elastic_rotation, small_rotation),
           true}};
}

}  // namespace pleuel
