#pragma once

#include <memory>
#include <optional>

#include "core/model/attachment.hpp"
#include "core/system/term.hpp"

namespace pleuel {

/// A load or force element of the scene as a term of the system, and what can be read of it.
struct BuiltLoad {
  std::unique_ptr<Term> term;
  std::optional<GaugeModel> gauge;
};

/// @param coordinates  of the whole system
BuiltLoad make_load(const Load& load, const std::vector<BodyModel>& bodies,
                    const BuildContext& context, int coordinates);

/// Adds gauges of its relative coordinates to a joint of the model.
void add_gauges(const Joint& joint, const std::vector<BodyModel>& bodies,
                const BuildContext& context, JointModel& model);

}  // namespace pleuel
