#include <gtest/gtest.h>

#include "tests/scene/bad_edit.hpp"
#include "tests/support/parameter_name.hpp"

namespace pleuel::test::bad_settings_test {
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
            R"(/simulation/initial_state must be "consistent", "quasi-static" or "periodic", got "static")"},
        BadEdit{
            "/simulation/initial_state", R"({"type": "steady"})",
            R"(/simulation/initial_state/type must be "consistent", "quasi-static" or "periodic", got "steady")"},
        BadEdit{
            "/simulation/initial_state", R"({"type": "periodic", "turns": 2})",
            R"(/simulation/initial_state has the unknown key "turns"; known are "type" and "period")"},
        BadEdit{"/simulation/initial_state", R"({"type": "quasi-static", "period": "0.1 s"})",
                R"(/simulation/initial_state/period is for the initial state "periodic" only)"},
        BadEdit{"/simulation/initial_state", R"({"type": "periodic", "period": "0.04 s"})",
                "/simulation/initial_state/period must fit into /simulation/end_time a whole "
                "number of times, and does so 2.5 times, got \"0.04 s\""},
        BadEdit{
            "/simulation/initial_state", R"({"type": "periodic", "period": "0.1 kg"})",
            R"(/simulation/initial_state/period must be a time [s], got "0.1 kg": "kg" measures something else)"}),
    named_by(&BadEdit::pointer));

}  // namespace
}  // namespace pleuel::test::bad_settings_test
