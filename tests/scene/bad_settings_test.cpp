#include <gtest/gtest.h>

#include "tests/scene/bad_edit.hpp"

namespace pleuel::test {
namespace {

INSTANTIATE_TEST_SUITE_P(
    Settings, BadMechanismFile,
    testing::Values(
        BadEdit{"/effects/elasticity", "1",
                R"(/effects/elasticity must be "auto", "on" or "off", got 1)"},
        BadEdit{
            "/effects/rotary_inertia", R"("offf")",
            R"(/effects/rotary_inertia must be "auto", "on" or "off", got "offf"; did you mean "off"?)"},
        BadEdit{"/effects/tolerance", "1",
                "/effects/tolerance must be at least 0 and less than 1, got 1"},
        BadEdit{"/effects/tolerance", "-1e-3",
                "/effects/tolerance must be at least 0 and less than 1, got -0.001"},
        BadEdit{"/effects/tolerance", R"("1 %")",
                R"(/effects/tolerance must be a number, got "1 %")"},
        BadEdit{
            "/simulation/initial_state", R"("static")",
            R"(/simulation/initial_state must be "consistent" or "quasi-static", got "static")"}));

}  // namespace
}  // namespace pleuel::test
