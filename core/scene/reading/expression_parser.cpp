#include "core/scene/reading/expression_parser.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numbers>

#include <fmt/format.h>

#include "core/base/int_size.hpp"
#include "core/scene/load_cases.hpp"
#include "core/scene/reading/suggestion.hpp"
#include "core/scene/reading/unit_scanner.hpp"

namespace pleuel {

namespace {

struct Function {
  const char* name;
  Operation operation;
  int arguments;  ///< -1: two or more
};
constexpr Function functions[] = {{"sqrt", Operation::square_root, 1},
                                  {"exp", Operation::exponential, 1},
                                  {"log", Operation::logarithm, 1},
                                  {"tanh", Operation::hyperbolic_tangent, 1},
                                  {"sin", Operation::sine, 1},
                                  {"cos", Operation::cosine, 1},
                                  {"tan", Operation::tangent, 1},
                                  {"asin", Operation::arc_sine, 1},
                                  {"acos", Operation::arc_cosine, 1},
                                  {"atan", Operation::arc_tangent, 1},
                                  {"atan2", Operation::arc_tangent_2, 2},
                                  {"min", Operation::smaller, -1},
                                  {"max", Operation::larger, -1},
                                  {"abs", Operation::magnitude, 1}};

struct Sign {
  char character;
  Operation operation;
  int rank;  ///< the higher, the more strongly it binds
};
constexpr int sign_rank = 3;  ///< of "-" before a number: -2^2 = -4, and -2*3 = (-2)*3
constexpr Sign signs[] = {{'+', Operation::plus, 1},
                          {'-', Operation::minus, 1},
                          {'*', Operation::times, 2},
                          {'/', Operation::over, 2},
                          {'^', Operation::power, 4}};

/// Brackets, signs and powers inside each other; more is no formula of a person.
constexpr int deepest = 200;

/// Goes through a formula once, by precedence climbing (Clarke 1986):
///
///     chain(r)  = operand { sign of rank ≥ r  chain(above) }     ^ goes from the right: 2^3^2 = 512
///     operand   = ("-" | "+") chain(3) | "(" chain(1) ")" | number [unit] | name
///               | function "(" chain(1) { "," chain(1) } ")"
///
/// Each of these leaves `at_` behind what it took, and returns the step with its result.
class FormulaParser {
 public:
  FormulaParser(std::string_view text, ExpressionBuilder& builder)
      : text_(text), builder_(builder) {}

  void read() {
    chain(1);
    if (next() != end_of_text) fail_behind_operand();
  }

 private:
  static constexpr char end_of_text = '\0';

  /// The next character that is no blank.
  char next() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    return at_ < text_.size() ? text_[at_] : end_of_text;
  }
  bool takes(char wanted) {
    if (next() != wanted) return false;
    ++at_;
    return true;
  }
  const Sign* next_sign() {
    const char c = next();
    const auto* found = std::find_if(std::begin(signs), std::end(signs),
                                     [&](const Sign& sign) { return sign.character == c; });
    return found == std::end(signs) ? nullptr : found;
  }

  int chain(int lowest_rank) {
    if (++depth_ > deepest) {
      builder_.fail(at_, fmt::format("brackets and signs are nested deeper than {}", deepest));
    }
    int result = operand();
    for (const Sign* sign = next_sign(); sign != nullptr && sign->rank >= lowest_rank;
         sign = next_sign()) {
      const std::size_t position = at_++;
      const bool is_from_right = sign->operation == Operation::power;
      const int second = chain(is_from_right ? sign->rank : sign->rank + 1);
      result = builder_.apply(position, sign->operation, result, second);
    }
    --depth_;
    return result;
  }

  int operand() {
    const char c = next();
    const std::size_t position = at_;
    if (takes('+')) return chain(sign_rank);
    if (takes('-')) return builder_.apply(position, Operation::negated, chain(sign_rank));
    if (takes('(')) {
      const int inside = chain(1);
      close();
      return inside;
    }
    const bool is_fraction =
        c == '.' && at_ + 1 < text_.size() && is_digit_character(text_[at_ + 1]);
    if (is_digit_character(c) || is_fraction) return read_number();
    if (c == '\'') return read_quoted();
    if (is_name_character(c)) return read_name();
    fail_before_operand();
  }

  void close() {
    if (next() == end_of_text) builder_.fail(at_, "a bracket is not closed");
    if (!takes(')')) fail_behind_operand();
  }

  [[noreturn]] void fail_before_operand() {
    if (next() == end_of_text) builder_.fail(at_, "the formula ends too early");
    if (next_sign() != nullptr || next() == ')' || next() == ',') {
      builder_.fail(at_, "a number or a name is missing before this");
    }
    builder_.fail(at_, fmt::format("\"{}\" is not understood here", next()));
  }

  [[noreturn]] void fail_behind_operand() {
    switch (next()) {
      case ')':
        builder_.fail(at_, "there is a bracket too many");
      case ',':
        builder_.fail(at_, "there is a comma outside a function; decimals have a point");
      default:
        builder_.fail(at_, "a sign + - * / ^ is missing before this");
    }
  }

  int read_number() {
    double value = 0.0;
    const auto [rest, status] =
        std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (status != std::errc() || !std::isfinite(value)) {
      builder_.fail(at_, "the number is out of range");
    }
    at_ = rest - text_.data();
    return read_unit(value);
  }

  int read_unit(double value) {
    const std::size_t begin = at_;
    at_ += unit_length(text_.substr(begin), [&](const std::string& word) {
      const bool is_unit = builder_.is_unit(word);
      if (is_unit && builder_.find(word) != nullptr) {
        builder_.fail(begin, fmt::format("\"/{}\" may be a unit or the name \"{}\"; put the number "
                                         "with its unit in brackets, or write the power \"{}^-1\"",
                                         word, word, word));
      }
      return is_unit;
    });
    const std::size_t end = at_, first = std::min(text_.find_first_not_of(' ', begin), end);
    if (end > first && next() == '^') {
      builder_.fail(at_,
                    "the power of a unit is a whole number, as in \"mm^2\"; to raise a number "
                    "with its unit put both in brackets, as in \"(2 mm)^0.5\"");
    }
    return builder_.add_quantity(first, value, std::string(text_.substr(first, end - first)));
  }

  int read_name() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_name_character(text_[at_])) ++at_;
    const std::string name(text_.substr(begin, at_ - begin));
    if (takes('(')) return read_call(begin, function_called(begin, name));
    if (name == "pi" && builder_.find(name) == nullptr) return read_unit(std::numbers::pi);
    return add_name(begin, name);
  }

  int read_quoted() {
    const std::size_t begin = at_, close = text_.find('\'', begin + 1);
    if (close == std::string_view::npos) builder_.fail(begin, "a quote is not closed");
    at_ = close + 1;
    return add_name(begin, std::string(text_.substr(begin + 1, close - begin - 1)));
  }

  /// With the case behind it, if it has one.
  int add_name(std::size_t begin, std::string name) {
    if (const auto suffix = case_suffix(text_, at_)) {
      at_ = suffix->end;
      name = name_in_case(name, suffix->load_case);
    }
    return builder_.add_name(begin, name);
  }

  int read_call(std::size_t begin, const Function& function) {
    std::vector<int> arguments = {chain(1)};
    while (takes(',')) arguments.push_back(chain(1));
    const std::size_t end = at_;
    close();
    const int count = int_size(arguments), needed = function.arguments;
    if (needed < 0 && count < 2) {
      builder_.fail(begin, fmt::format("{} needs two numbers at least", function.name));
    }
    if (needed > 0 && count != needed) {
      builder_.fail(end, fmt::format("too {} arguments of {}", count > needed ? "many" : "few",
                                     function.name));
    }
    if (count == 1) return builder_.apply(begin, function.operation, arguments[0]);
    int result = arguments[0];
    for (int i = 1; i < count; ++i) {
      result = builder_.apply(begin, function.operation, result, arguments[i]);
    }
    return result;
  }

  const Function& function_called(std::size_t begin, const std::string& name) const {
    std::vector<std::string> known;
    for (const Function& function : functions) {
      if (name == function.name) return function;
      known.emplace_back(function.name);
    }
    if (builder_.find(name) != nullptr || name == "pi") {
      builder_.fail(begin, fmt::format("\"{}\" is no function; a product needs its *", name));
    }
    builder_.fail(begin, fmt::format("unknown function \"{}\"{}", name, hint(name, known)));
  }

  std::string_view text_;
  ExpressionBuilder& builder_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

/// Characters that mean something to other people, but nothing here.
void check_characters(const ExpressionBuilder& builder, std::string_view text) {
  bool is_quoted = false, is_behind_name = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\'') is_quoted = !is_quoted;
    if (is_quoted) continue;
    if (is_behind_name && text[i] == '[') {
      const auto suffix = case_suffix(text, i);
      if (!suffix) {
        builder.fail(i, "the bracket [ of a load case is not closed; write \"name[case]\"");
      }
      i = suffix->end;
      if (i >= text.size()) return;
    }
    is_behind_name =
        text[i] == '\'' || is_name_character(text[i]) || (is_behind_name && text[i] == ' ');
    const std::string_view rest = text.substr(i);
    if (rest.starts_with("**")) builder.fail(i, "a power is written \"^\", not \"**\"");
    for (const char* sign : {"×", "−", "–", "÷"}) {
      if (rest.starts_with(sign)) {
        builder.fail(i, fmt::format("\"{}\" is no sign of a formula; there are + - * / ^", sign));
      }
    }
    if (std::string_view("[]{}?:;=<>!&|#\"\\\n\t").find(text[i]) != std::string_view::npos) {
      builder.fail(i, fmt::format("\"{}\" means nothing in a formula", text[i]));
    }
  }
}

}  // namespace

ReadExpression read_expression(const std::string& text, const std::vector<Symbol>& symbols) {
  // The sign "=" becomes a blank: columns are those of the whole text.
  std::string formula = text;
  const std::size_t first = formula.find_first_not_of(' ');
  if (first != std::string::npos && formula[first] == '=') formula[first] = ' ';
  ExpressionBuilder builder(formula, symbols);
  if (formula.find_first_not_of(' ') == std::string::npos) builder.fail(0, "there is no formula");
  check_characters(builder, formula);
  FormulaParser(formula, builder).read();
  return builder.take();
}

}  // namespace pleuel
