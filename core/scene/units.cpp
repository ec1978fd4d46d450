#include "core/scene/units.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <udunits2.h>

#include "core/scene/common_units.hpp"
#include "core/scene/reading/suggestion.hpp"
#include "core/scene/reading/unit_scanner.hpp"

namespace pleuel {
namespace {

struct FreeSystem {
  void operator()(ut_system* system) const { ut_free_system(system); }
};
struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
using SystemHandle = std::unique_ptr<ut_system, FreeSystem>;
using UnitHandle = std::unique_ptr<ut_unit, FreeUnit>;

UnitHandle parse_unit(const ut_system* system, const std::string& text) {
  return UnitHandle(ut_parse(system, text.c_str(), UT_UTF8));
}

/// As a symbol, not as a name: case matters in symbols only, and "Nm" must not become "nm".
void add_symbol(ut_system* system, const char* symbol, const std::string& definition) {
  const UnitHandle unit = parse_unit(system, definition);
  if (!unit || ut_map_symbol_to_unit(symbol, UT_UTF8, unit.get()) != UT_SUCCESS) {
    throw std::runtime_error(fmt::format("the database of units does not know {}", definition));
  }
}

/// The database has a byte that is 8, a pure number.
void add_bytes(ut_system* system) {
  const UnitHandle byte(ut_new_base_unit(system));
  if (!byte || ut_map_symbol_to_unit("B", UT_UTF8, byte.get()) != UT_SUCCESS) {
    throw std::runtime_error("the database of units takes no bytes");
  }
  add_symbol(system, "KiB", "1024 B");
  add_symbol(system, "MiB", "1048576 B");
  add_symbol(system, "GiB", "1073741824 B");
}

constexpr std::string_view blanks = " \t\n\v\f\r";

/// Whether the digit at `position` belongs to an exponent (m2, m^2, m-2, m^-2) or is the 1 of
/// "1/s".
bool is_exponent(const std::string& unit, std::size_t position) {
  if (position == 0) return unit.size() > 1 && unit[0] == '1' && unit[1] == '/';
  std::size_t before = position - 1;
  if (unit[before] == '-' || unit[before] == '+') {
    if (before == 0) return false;
    --before;
  }
  const auto character = static_cast<unsigned char>(unit[before]);
  return std::isalpha(character) != 0 || character == '^' || character >= 0x80;
}

/// UDUNITS also takes numbers for units ("mm 30" is 30 mm, "000 mm" is nothing): here they are
/// slips of the pen, as in "1 000 mm" or "120 mm 30".
bool has_stray_number(const std::string& unit) {
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (!is_digit_character(unit[i])) continue;
    if (!is_exponent(unit, i)) return true;
    while (i + 1 < unit.size() && is_digit_character(unit[i + 1])) ++i;
  }
  return false;
}

/// Of a frequency both cycles and radians are units; "1/s" could be either of them.
bool counts_cycles(const std::string& name) {
  return name.ends_with("Hz") || name.ends_with("hertz");
}

/// Words that the database takes for something that few of those mean who write them.
struct Misread {
  std::string_view word, why;
};
constexpr Misread misread_words[] = {
    {"ton", "is 907 kg to some and 1000 kg to others: write t for 1000 kg, or lb"},
    {"tons", "is 907 kg to some and 1000 kg to others: write t for 1000 kg, or lb"},
    {"Mm", "is a thousand kilometres; write mm"},
};

void refuse_misread(const std::string& unit) {
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  for (auto begin = unit.begin(); begin != unit.end();) {
    begin = std::find_if(begin, unit.end(), is_letter);
    const auto end = std::find_if_not(begin, unit.end(), is_letter);
    const std::string_view word(begin, end);
    for (const Misread& misread : misread_words) {
      if (word == misread.word) throw UnitError(fmt::format("\"{}\" {}", word, misread.why));
    }
    begin = end;
  }
}

bool has_angle(const Dimension& dimension) {
  return dimension.powers[3] != 0.0;
}

Dimension without_angle(Dimension dimension) {
  dimension.powers[3] = 0.0;
  return dimension;
}

double cycles_factor(const std::string& name, const Quantity& quantity, const Dimension& from) {
  const auto is = [&quantity](const Quantity& other) {
    return quantity.name == other.name && quantity.unit == other.unit;
  };
  if (is(quantities::angular_frequency) && counts_cycles(name)) return 2.0 * std::numbers::pi;
  return is(quantities::frequency) && has_angle(from) ? 0.5 / std::numbers::pi : 1.0;
}

void check_dimension(const std::string& name, const Dimension& from, const Dimension& to) {
  if (without_angle(from) != without_angle(to) || (has_angle(from) && !has_angle(to))) {
    throw UnitError(fmt::format("\"{}\" measures something else", name));
  }
  if (has_angle(from) == has_angle(to)) return;
  const bool is_rate = without_angle(to) == measure_unit("1/s").dimension;
  throw UnitError(fmt::format("\"{}\" names no angle{}", name,
                              is_rate
                                  ? "; write rad/s, deg/s or rpm"
                                  : ", and what is measured has one: write \"rad\" where it is"));
}

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

/// @param si  of the quantity that is asked for; empty: of any
UnitError unknown_unit(const std::string& name, std::string_view si) {
  std::vector<std::string> known;
  std::string meant;
  for (const CommonUnit& common : common_units()) {
    if (!si.empty() && common.si != si) continue;
    known.emplace_back(common.unit);
    if (in_small_letters(common.unit) == in_small_letters(name)) meant = common.unit;
  }
  if (meant.empty()) meant = pleuel::closest(name, known);
  return UnitError(fmt::format("\"{}\" is not a known unit{}", name,
                               meant.empty() ? "" : fmt::format("; did you mean \"{}\"?", meant)));
}

/// What base_units() writes of powers that are not whole, which the library does not read: "kg^0.5".
/// Four digits of a power stand for a fraction.
std::optional<Dimension> read_base_units(const std::string& text) {
  Dimension dimension;
  double sign = 1.0;
  for (const char* at = text.c_str(); *at != '\0';) {
    const char* end = std::find_if(at, text.c_str() + text.size(),
                                   [](char c) { return c == '^' || c == ' ' || c == '/'; });
    const auto base = std::ranges::find(Dimension::bases, std::string_view(at, end - at));
    if (base == Dimension::bases.end() && std::string_view(at, end - at) != "1")
      return std::nullopt;
    double power = 1.0;
    if (*end == '^') {
      const auto [rest, status] = std::from_chars(end + 1, text.c_str() + text.size(), power);
      if (status != std::errc()) return std::nullopt;
      constexpr double finest = 60.0, digits = 1e-4;
      const double fraction = std::round(finest * power) / finest;
      if (std::abs(fraction - power) < digits) power = fraction;
      end = rest;
    }
    if (base != Dimension::bases.end()) {
      dimension.powers[base - Dimension::bases.begin()] += sign * power;
    }
    if (*end == '/') sign = -1.0;
    at = *end == '\0' ? end : end + 1;
  }
  return dimension;
}

/// Takes a unit apart; callbacks of the library. Its status tells what is no product of base units:
/// logarithms, dates, and temperatures that do not count from zero.
struct UnitTaker {
  MeasuredUnit found;

  bool take(const ut_unit* unit) {
    static constexpr ut_visitor visitor = {take_basic, take_product, take_scaled, refuse_date,
                                           refuse_logarithm};
    return ut_accept_visitor(unit, &visitor, this) == UT_SUCCESS;
  }

 private:
  void add(const ut_unit* basic, int power) {
    const char* symbol = ut_get_symbol(basic, UT_ASCII);
    std::size_t base = Dimension::bases.size() - 1;  // bytes: the library has no symbol for them
    for (std::size_t i = 0; symbol != nullptr && i < Dimension::bases.size(); ++i) {
      if (std::string_view(symbol) == Dimension::bases[i]) base = i;
    }
    found.dimension.powers[base] += power;
  }

  static ut_status take_basic(const ut_unit* unit, void* self) {
    static_cast<UnitTaker*>(self)->add(unit, 1);
    return UT_SUCCESS;
  }
  static ut_status take_product(const ut_unit*, int count, const ut_unit* const* basic,
                                const int* powers, void* self) {
    for (int i = 0; i < count; ++i) static_cast<UnitTaker*>(self)->add(basic[i], powers[i]);
    return UT_SUCCESS;
  }
  static ut_status take_scaled(const ut_unit*, double scale, const ut_unit* underlying,
                               double offset, void* self) {
    auto* taker = static_cast<UnitTaker*>(self);
    taker->found.scale *= scale;
    return offset == 0.0 && taker->take(underlying) ? UT_SUCCESS : UT_MEANINGLESS;
  }
  static ut_status refuse_logarithm(const ut_unit*, double, const ut_unit*, void*) {
    return UT_MEANINGLESS;
  }
  static ut_status refuse_date(const ut_unit*, const ut_unit*, double, void*) {
    return UT_MEANINGLESS;
  }
};

SystemHandle read_database() {
  ut_set_error_message_handler(ut_ignore);  // the library would print; we throw
  SystemHandle system(ut_read_xml(nullptr));
  if (!system) throw std::runtime_error("the UDUNITS-2 database of units is not readable");
  add_symbol(system.get(), "deg", "degree");
  add_symbol(system.get(), "rev", "turn");
  add_symbol(system.get(), "Nm", "N m");
  add_symbol(system.get(), "PS", "735.49875 W");  // metric horsepower, no petasiemens
  add_bytes(system.get());
  return system;
}

/// Read when it is needed first: half of what a short run needs before it begins.
const ut_system* database() {
  static const SystemHandle system = read_database();
  return system.get();
}

/// @param si  of the quantity that is asked for; empty: of any
MeasuredUnit measured_by_database(const std::string& name, std::string_view si) {
  refuse_misread(name);
  const UnitHandle handle = has_stray_number(name) ? nullptr : parse_unit(database(), name);
  if (!handle && (si.empty() || has_stray_number(std::string(si)))) {
    if (const auto dimension = read_base_units(name)) return {1.0, *dimension};
  }
  if (!handle) throw unknown_unit(name, si);
  UnitTaker taker;
  if (taker.take(handle.get())) return taker.found;
  throw UnitError(fmt::format("\"{}\" does not count from zero", name));
}

}  // namespace

double unit_scale(const std::string& unit, const Quantity& quantity) {
  const CommonUnit* common = find_common_unit(trimmed(unit, blanks));
  if (common != nullptr && common->si == quantity.unit) return common->scale;
  return scale_by_database(unit, quantity);
}

double scale_by_database(const std::string& unit, const Quantity& quantity) {
  const std::string name = trimmed(unit, blanks);
  const MeasuredUnit from = measured_by_database(name, quantity.unit);
  const Dimension to = measure_unit(std::string(quantity.unit)).dimension;
  const double cycles = cycles_factor(name, quantity, from.dimension);
  if (cycles == 1.0 || without_angle(from.dimension) != without_angle(to)) {
    check_dimension(name, from.dimension, to);
  }
  if (!std::isfinite(from.scale) || from.scale == 0.0) {
    throw UnitError(fmt::format("\"{}\" is out of the range of numbers", name));
  }
  return cycles * from.scale;
}

MeasuredUnit measure_unit(const std::string& unit) {
  const CommonUnit* common = find_common_unit(trimmed(unit, blanks));
  if (common == nullptr) return measure_by_database(unit);
  return {common->scale, find_common_unit(common->si)->dimension};
}

MeasuredUnit measure_by_database(const std::string& unit) {
  const std::string name = trimmed(unit, blanks);
  return name == "1" ? MeasuredUnit() : measured_by_database(name, "");
}

double read_quantity(const std::string& text, const Quantity& quantity) {
  const WrittenQuantity written = split_quantity(text);
  if (written.unit.empty() && quantity == quantities::pure_number) return written.value;
  if (written.unit.empty()) throw UnitError("a number in quotes needs its unit");
  const double value = written.value * unit_scale(written.unit, quantity);
  if (!std::isfinite(value) || (value == 0.0 && written.value != 0.0)) {
    throw UnitError("it is out of the range of numbers");
  }
  return value;
}

namespace {

/// "10,5 mm": written as in half of the world.
void refuse_decimal_comma(const char* begin, const char* comma, const char* end) {
  if (comma == end || *comma != ',' || comma + 1 == end || !is_digit_character(comma[1])) return;
  const std::string whole(begin, comma), rest(comma + 1, end);
  const auto behind = std::ranges::find_if_not(rest, is_digit_character);
  if (behind - rest.begin() == 3 && whole != "0") {
    throw UnitError(
        fmt::format("numbers have a decimal point and nothing between thousands; write "
                    "{0}.{1} or {0}{1}",
                    whole, rest));
  }
  throw UnitError(fmt::format("numbers have a decimal point, no comma; write {}.{}", whole, rest));
}

}  // namespace

WrittenQuantity split_quantity(const std::string& text) {
  const std::string whole = trimmed(text, blanks);
  const char* begin = whole.data();
  const char* end = begin + whole.size();
  if (begin != end && *begin == '+' && begin + 1 != end && begin[1] != '-') ++begin;
  WrittenQuantity written;
  const auto [rest, status] = std::from_chars(begin, end, written.value);
  if (status == std::errc::result_out_of_range) {
    throw UnitError("it is out of the range of numbers");
  }
  if (status != std::errc() || !std::isfinite(written.value)) {
    throw UnitError("it does not begin with a number");
  }
  refuse_decimal_comma(begin, rest, end);
  written.unit = trimmed(std::string_view(rest, end - rest), blanks);
  return written;
}

Quantity per_time(const Quantity& quantity) {
  constexpr int most_derivatives = 10;
  const std::pair<std::string, std::string> rates[] = {{"rad", "an angular speed"},
                                                       {"m", "a speed"},
                                                       {"N", "a force per time"},
                                                       {"N m", "a torque per time"}};
  for (const auto& [base, rate] : rates) {
    std::string below = base, name = rate, unit = base + "/s";
    for (int order = 1; order <= most_derivatives; ++order) {
      if (quantity.unit == below) return {kept_text(name), kept_text(unit)};
      below = unit;
      name = fmt::format("a coefficient of t^{}", order + 1);
      unit = fmt::format("{}/s^{}", base, order + 1);
    }
  }
  throw std::logic_error(fmt::format("no quantity is derived from {}", quantity.name));
}

std::string describe(const Quantity& quantity) {
  if (quantity == quantities::pure_number) return std::string(quantity.name);
  return fmt::format("{} [{}]", quantity.name, quantity.unit);
}

}  // namespace pleuel
