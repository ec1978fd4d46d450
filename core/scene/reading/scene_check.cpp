#include "core/scene/reading/scene_check.hpp"

namespace pleuel {

void check_scene(const JsonNode&, const ProblemFile&) {}

}  // namespace pleuel
