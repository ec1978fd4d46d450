#include "core/scene/common_units.hpp"

namespace pleuel {

namespace {

constexpr CommonUnit table[] = {
    {"m", "m", 1},
    {"mm", "m", 0.001},
    {"cm", "m", 0.01},
    {"um", "m", 9.9999999999999995e-07},
    {"kg", "kg", 1},
    {"g", "kg", 0.001},
    {"s", "s", 1},
    {"ms", "s", 0.001},
    {"us", "s", 9.9999999999999995e-07},
    {"Pa", "Pa", 1},
    {"kPa", "Pa", 1000},
    {"MPa", "Pa", 1000000},
    {"GPa", "Pa", 1000000000},
    {"N", "N", 1},
    {"kN", "N", 1000},
    {"N m", "N m", 1},
    {"Nm", "N m", 1},
    {"kg/m^3", "kg/m^3", 1},
    {"g/cm^3", "kg/m^3", 999.99999999999989},
    {"rad", "rad", 1},
    {"deg", "rad", 0.017453292519943295},
    {"rad/s", "rad/s", 1},
    {"rpm", "rad/s", 0.10471975511965977},
    {"m/s", "m/s", 1},
    {"m/s^2", "m/s^2", 1},
    {"1/s", "1/s", 1},
    {"mm^2", "m^2", 9.9999999999999995e-07},
    {"cm^2", "m^2", 0.0001},
    {"m^2", "m^2", 1},
    {"mm^4", "m^4", 1.0000000000000002e-12},
    {"cm^4", "m^4", 1e-08},
    {"m^4", "m^4", 1},
    {"kg m^2", "kg m^2", 1},
    {"N/m", "N/m", 1},
    {"N s/m", "N s/m", 1},
    {"N m/rad", "N m/rad", 1},
    {"N m s/rad", "N m s/rad", 1},
    {"Hz", "Hz", 1},
    {"W", "W", 1},
    {"J", "J", 1},
};

}  // namespace

std::span<const CommonUnit> common_units() {
  return table;
}

std::optional<double> find_common_scale(std::string_view unit, std::string_view si) {
  for (const CommonUnit& common : table) {
    if (common.unit == unit && common.si == si) return common.scale;
  }
  return std::nullopt;
}

}  // namespace pleuel
