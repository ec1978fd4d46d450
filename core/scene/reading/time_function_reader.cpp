#include "core/scene/reading/time_function_reader.hpp"

#include <fmt/format.h>

namespace pleuel {
namespace {

constexpr std::size_t most_coefficients = 11;  // per_time() knows ten derivatives

enum class FunctionType { constant, constant_speed, ramp_to_speed, polynomial, harmonic, table };

enum class Purpose { drive, load };

/// A function in the document and what it measures.
struct Source {
  JsonNode node;
  Quantity value;
  Purpose purpose;
  std::vector<std::string_view> other_keys;  ///< that are not the function's
};

void allow_keys(const Source& source, std::vector<std::string_view> keys) {
  keys.insert(keys.begin(), "type");
  keys.insert(keys.end(), source.other_keys.begin(), source.other_keys.end());
  source.node.allow_keys(keys);
}

ConstantFunction read_constant(const Source& source, NumberReader& numbers) {
  allow_keys(source, {"value"});
  return {numbers.designable(source.node.at("value"), source.value)};
}

ConstantSpeedDrive read_constant_speed(const Source& source, NumberReader& numbers) {
  allow_keys(source, {"speed"});
  return {numbers.designable(source.node.at("speed"), per_time(source.value))};
}

RampToSpeedDrive read_ramp_to_speed(const Source& source, NumberReader& numbers) {
  allow_keys(source, {"speed", "ramp"});
  RampToSpeedDrive drive;
  drive.speed = numbers.designable(source.node.at("speed"), per_time(source.value));
  drive.ramp = numbers.designable(source.node.at("ramp"), quantities::time, Range::positive);
  return drive;
}

PolynomialFunction read_polynomial(const Source& source, NumberReader& numbers) {
  allow_keys(source, {"coefficients"});
  const JsonNode list = source.node.at("coefficients");
  const std::vector<JsonNode> items = list.items();
  if (items.empty() || items.size() > most_coefficients) {
    list.fail(fmt::format("must have from 1 to {} coefficients, got {}", most_coefficients,
                          items.size()));
  }
  PolynomialFunction polynomial;
  Quantity quantity = source.value;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) quantity = per_time(quantity);
    polynomial.coefficients.push_back(numbers.designable(items[i], quantity));
  }
  return polynomial;
}

HarmonicFunction read_harmonic(const Source& source, NumberReader& numbers) {
  allow_keys(source, {"amplitude", "frequency", "phase", "offset"});
  HarmonicFunction harmonic;
  harmonic.amplitude = numbers.designable(source.node.at("amplitude"), source.value);
  harmonic.frequency = numbers.designable(source.node.at("frequency"),
                                          quantities::angular_frequency, Range::positive);
  if (const auto phase = source.node.find("phase")) {
    harmonic.phase = numbers.designable(*phase, quantities::angle);
  }
  if (const auto offset = source.node.find("offset")) {
    harmonic.offset = numbers.designable(*offset, source.value);
  }
  return harmonic;
}

std::vector<double> read_ascending_times(const JsonNode& node, const NumberReader& numbers) {
  std::vector<double> times;
  for (const JsonNode& item : node.items()) {
    const double time = numbers.fixed(item, quantities::time);
    if (!times.empty() && time <= times.back()) {
      item.fail_with_value("must be later than the time before it");
    }
    times.push_back(time);
  }
  if (times.size() < 2) node.fail_with_value("must have at least two times");
  return times;
}

Interpolation read_interpolation(const JsonNode& node, Purpose purpose) {
  if (purpose == Purpose::load) {
    return read_choice<Interpolation>(node, {{"linear", Interpolation::linear},
                                             {"step", Interpolation::step},
                                             {"monotone", Interpolation::monotone},
                                             {"spline", Interpolation::spline}});
  }
  if (node.value() == "step") {
    node.fail_with_value(
        "would move a drive in no time; take \"monotone\", \"spline\" or \"linear\"");
  }
  return read_choice<Interpolation>(node, {{"monotone", Interpolation::monotone},
                                           {"spline", Interpolation::spline},
                                           {"linear", Interpolation::linear}});
}

TableFunction read_table(const Source& source, NumberReader& numbers) {
  allow_keys(source, {"times", "values", "interpolation"});
  TableFunction table;
  table.times = read_ascending_times(source.node.at("times"), numbers);
  for (const JsonNode& value : source.node.at("values").items(table.times.size())) {
    table.values.push_back(numbers.designable(value, source.value));
  }
  table.interpolation =
      source.purpose == Purpose::load ? Interpolation::linear : Interpolation::monotone;
  if (const auto interpolation = source.node.find("interpolation")) {
    table.interpolation = read_interpolation(*interpolation, source.purpose);
  }
  return table;
}

TimeFunction read_function(FunctionType type, const Source& source, NumberReader& numbers) {
  switch (type) {
    case FunctionType::constant:
      return read_constant(source, numbers);
    case FunctionType::constant_speed:
      return read_constant_speed(source, numbers);
    case FunctionType::ramp_to_speed:
      return read_ramp_to_speed(source, numbers);
    case FunctionType::polynomial:
      return read_polynomial(source, numbers);
    case FunctionType::harmonic:
      return read_harmonic(source, numbers);
    case FunctionType::table:
      break;
  }
  return read_table(source, numbers);
}

}  // namespace

TimeFunction read_drive_function(const JsonNode& node, const Quantity& value,
                                 NumberReader& numbers) {
  const auto type =
      read_choice<FunctionType>(node.at("type"), {{"constant-speed", FunctionType::constant_speed},
                                                  {"ramp-to-speed", FunctionType::ramp_to_speed},
                                                  {"constant", FunctionType::constant},
                                                  {"polynomial", FunctionType::polynomial},
                                                  {"harmonic", FunctionType::harmonic},
                                                  {"table", FunctionType::table}});
  return read_function(type, {node, value, Purpose::drive, {"coordinate"}}, numbers);
}

TimeFunction read_load_function(const JsonNode& node, const Quantity& value,
                                NumberReader& numbers) {
  const bool is_binding = node.value().is_object() && node.find("variable").has_value();
  if (!node.value().is_object() || is_binding) {
    return ConstantFunction{numbers.designable(node, value)};
  }
  const auto type =
      read_choice<FunctionType>(node.at("type"), {{"constant", FunctionType::constant},
                                                  {"polynomial", FunctionType::polynomial},
                                                  {"harmonic", FunctionType::harmonic},
                                                  {"table", FunctionType::table}});
  return read_function(type, {node, value, Purpose::load, {}}, numbers);
}

}  // namespace pleuel
