#include "core/scene/common_units.hpp"

#include <algorithm>
#include <iterator>

namespace pleuel {

namespace {

/// Units of SI have their dimension, in powers of m, kg, s, rad.
constexpr CommonUnit table[] = {
    {"m", "m", 1, {{1}}},
    {"mm", "m", 0.001},
    {"cm", "m", 0.01},
    {"um", "m", 9.9999999999999995e-07},
    {"kg", "kg", 1, {{0, 1}}},
    {"g", "kg", 0.001},
    {"s", "s", 1, {{0, 0, 1}}},
    {"ms", "s", 0.001},
    {"us", "s", 9.9999999999999995e-07},
    {"Pa", "Pa", 1, {{-1, 1, -2}}},
    {"kPa", "Pa", 1000},
    {"MPa", "Pa", 1000000},
    {"GPa", "Pa", 1000000000},
    {"N", "N", 1, {{1, 1, -2}}},
    {"kN", "N", 1000},
    {"N m", "N m", 1, {{2, 1, -2}}},
    {"Nm", "N m", 1},
    {"kg/m^3", "kg/m^3", 1, {{-3, 1}}},
    {"g/cm^3", "kg/m^3", 999.99999999999989},
    {"rad", "rad", 1, {{0, 0, 0, 1}}},
    {"deg", "rad", 0.017453292519943295},
    {"rad/s", "rad/s", 1, {{0, 0, -1, 1}}},
    {"rpm", "rad/s", 0.10471975511965977},
    {"m/s", "m/s", 1, {{1, 0, -1}}},
    {"m/s^2", "m/s^2", 1, {{1, 0, -2}}},
    {"1/s", "1/s", 1, {{0, 0, -1}}},
    {"mm^2", "m^2", 9.9999999999999995e-07},
    {"cm^2", "m^2", 0.0001},
    {"m^2", "m^2", 1, {{2}}},
    {"mm^4", "m^4", 1.0000000000000002e-12},
    {"cm^4", "m^4", 1e-08},
    {"m^4", "m^4", 1, {{4}}},
    {"kg m^2", "kg m^2", 1, {{2, 1}}},
    {"N/m", "N/m", 1, {{0, 1, -2}}},
    {"N s/m", "N s/m", 1, {{0, 1, -1}}},
    {"N m/rad", "N m/rad", 1, {{2, 1, -2, -1}}},
    {"N m s/rad", "N m s/rad", 1, {{2, 1, -1, -1}}},
    {"Hz", "Hz", 1, {{0, 0, -1}}},
    {"W", "W", 1, {{2, 1, -3}}},
    {"J", "J", 1, {{2, 1, -2}}},
};

}  // namespace

std::span<const CommonUnit> common_units() {
  return table;
}

const CommonUnit* find_common_unit(std::string_view unit) {
  const auto* found = std::ranges::find(table, unit, &CommonUnit::unit);
  return found == std::end(table) ? nullptr : found;
}

}  // namespace pleuel
