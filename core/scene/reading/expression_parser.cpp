#include "core/scene/reading/expression_parser.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <mpParser.h>

#include "core/scene/load_cases.hpp"
#include "core/scene/reading/case_suffix.hpp"
#include "core/scene/reading/expression_builder.hpp"
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

// The parser calls these while it goes through the text; its values are indices of steps.

int index_of(const mup::ptr_val_type& value) {
  return static_cast<int>(value->GetInteger());
}
mup::int_type value_of_step(int step) {
  return step;
}

class BinaryOperator : public mup::IOprtBin {
 public:
  BinaryOperator(ExpressionBuilder& builder, const char* name, Operation operation, int precedence,
                 mup::EOprtAsct associativity)
      : IOprtBin(name, precedence, associativity), builder_(&builder), operation_(operation) {}

  void Eval(mup::ptr_val_type& result, const mup::ptr_val_type* operands, int) override {
    *result = value_of_step(
        builder_->apply(GetExprPos(), operation_, index_of(operands[0]), index_of(operands[1])));
  }
  const mup::char_type* GetDesc() const override { return ""; }
  mup::IToken* Clone() const override { return new BinaryOperator(*this); }

 private:
  ExpressionBuilder* builder_;
  Operation operation_;
};

class SignOperator : public mup::IOprtInfix {
 public:
  SignOperator(ExpressionBuilder& builder, const char* name)
      : IOprtInfix(name, mup::prINFIX), builder_(&builder), is_minus_(name[0] == '-') {}

  void Eval(mup::ptr_val_type& result, const mup::ptr_val_type* operands, int) override {
    const int of = index_of(operands[0]);
    const std::size_t position = GetExprPos();
    *result = value_of_step(is_minus_ ? builder_->apply(position, Operation::negated, of) : of);
  }
  const mup::char_type* GetDesc() const override { return ""; }
  mup::IToken* Clone() const override { return new SignOperator(*this); }

 private:
  ExpressionBuilder* builder_;
  bool is_minus_;
};

class FunctionCall : public mup::ICallback {
 public:
  FunctionCall(ExpressionBuilder& builder, const Function& function)
      : ICallback(mup::cmFUNC, function.name, function.arguments),
        builder_(&builder),
        function_(&function) {}

  void Eval(mup::ptr_val_type& result, const mup::ptr_val_type* operands, int count) override {
    const std::size_t position = GetExprPos();
    if (function_->arguments < 0 && count < 2) {
      builder_->fail(position, fmt::format("{} needs two numbers at least", function_->name));
    }
    int step = index_of(operands[0]);
    if (count == 1) {
      step = builder_->apply(position, function_->operation, step);
    }
    for (int i = 1; i < count; ++i) {
      step = builder_->apply(position, function_->operation, step, index_of(operands[i]));
    }
    *result = value_of_step(step);
  }
  const mup::char_type* GetDesc() const override { return ""; }
  mup::IToken* Clone() const override { return new FunctionCall(*this); }

 private:
  ExpressionBuilder* builder_;
  const Function* function_;
};

/// Numbers with units, and names.
class OperandReader : public mup::IValueReader {
 public:
  OperandReader(ExpressionBuilder& builder) : builder_(&builder) {}

  bool IsValue(const mup::char_type* whole, int& position, mup::Value& value) override {
    const std::string_view text(whole);
    std::size_t end = position;
    const std::optional<int> step = read(text, position, end);
    if (!step) return false;
    value = value_of_step(*step);
    position = static_cast<int>(end);
    return true;
  }
  mup::IValueReader* Clone(mup::TokenReader* parent) const override {
    auto* copy = new OperandReader(*this);
    copy->SetParent(parent);
    return copy;
  }

 private:
  std::optional<int> read(std::string_view text, std::size_t at, std::size_t& end) {
    const char c = text[at];
    const bool is_fraction = c == '.' && at + 1 < text.size() && is_digit_character(text[at + 1]);
    if (is_digit_character(c) || is_fraction) return read_number(text, at, end);
    if (c == '\'') return read_quoted(text, at, end);
    if (is_name_character(c)) return read_name(text, at, end);
    return std::nullopt;
  }

  int read_number(std::string_view text, std::size_t at, std::size_t& end) {
    double value = 0.0;
    const auto [rest, status] = std::from_chars(text.data() + at, text.data() + text.size(), value);
    if (status != std::errc() || !std::isfinite(value)) {
      builder_->fail(at, "the number is out of range");
    }
    return read_unit(text, rest - text.data(), value, end);
  }

  int read_unit(std::string_view text, std::size_t at, double value, std::size_t& end) {
    const std::string_view rest = text.substr(at);
    const std::size_t length = unit_length(rest, [&](const std::string& word) {
      const bool is_unit = builder_->is_unit(word);
      if (is_unit && builder_->find(word) != nullptr) {
        builder_->fail(at, fmt::format("\"/{}\" may be a unit or the name \"{}\"; put the number "
                                       "with its unit in brackets, or write the power \"{}^-1\"",
                                       word, word, word));
      }
      return is_unit;
    });
    end = at + length;
    const std::size_t first = std::min(text.find_first_not_of(' ', at), end);
    const std::size_t next = text.find_first_not_of(' ', end);
    if (end > first && next != std::string_view::npos && text[next] == '^') {
      builder_->fail(next,
                     "the power of a unit is a whole number, as in \"mm^2\"; to raise a number "
                     "with its unit put both in brackets, as in \"(2 mm)^0.5\"");
    }
    return builder_->add_quantity(first, value, std::string(text.substr(first, end - first)));
  }

  int read_quoted(std::string_view text, std::size_t at, std::size_t& end) {
    const std::size_t close = text.find('\'', at + 1);
    if (close == std::string_view::npos) builder_->fail(at, "a quote is not closed");
    end = close + 1;
    return add_name(text, at, std::string(text.substr(at + 1, close - at - 1)), end);
  }

  /// @param end  behind the name; moved behind its case, if it has one
  int add_name(std::string_view text, std::size_t at, std::string name, std::size_t& end) {
    if (const auto suffix = case_suffix(text, end)) {
      end = suffix->end;
      name = name_in_case(name, suffix->load_case);
    }
    return builder_->add_name(at, name);
  }

  std::optional<int> read_name(std::string_view text, std::size_t at, std::size_t& end) {
    std::size_t stop = at;
    while (stop < text.size() && is_name_character(text[stop])) ++stop;
    const std::size_t next = text.find_first_not_of(' ', stop);
    const std::string name(text.substr(at, stop - at));
    if (next != std::string_view::npos && text[next] == '(') {
      check_function(at, name);
      return std::nullopt;
    }
    end = stop;
    if (name == "pi" && builder_->find(name) == nullptr) {
      return read_unit(text, stop, std::numbers::pi, end);
    }
    return add_name(text, at, name, end);
  }

  void check_function(std::size_t at, const std::string& name) const {
    std::vector<std::string> known;
    for (const Function& function : functions) {
      if (name == function.name) return;
      known.emplace_back(function.name);
    }
    if (builder_->find(name) != nullptr || name == "pi") {
      builder_->fail(at, fmt::format("\"{}\" is no function; a product needs its *", name));
    }
    builder_->fail(at, fmt::format("unknown function \"{}\"{}", name, hint(name, known)));
  }

  ExpressionBuilder* builder_;
};

/// The parser without anything it would know by itself.
mup::ParserX make_parser(ExpressionBuilder& builder) {
  mup::ParserX parser(0U);
  const auto define = [&](const char* name, Operation operation, int precedence,
                          mup::EOprtAsct associativity) {
    parser.DefineOprt(new BinaryOperator(builder, name, operation, precedence, associativity));
  };
  define("+", Operation::plus, mup::prADD_SUB, mup::oaLEFT);
  define("-", Operation::minus, mup::prADD_SUB, mup::oaLEFT);
  define("*", Operation::times, mup::prMUL_DIV, mup::oaLEFT);
  define("/", Operation::over, mup::prMUL_DIV, mup::oaLEFT);
  define("^", Operation::power, mup::prPOW, mup::oaRIGHT);
  parser.DefineInfixOprt(new SignOperator(builder, "-"));
  parser.DefineInfixOprt(new SignOperator(builder, "+"));
  for (const Function& function : functions) parser.DefineFun(new FunctionCall(builder, function));
  parser.AddValueReader(new OperandReader(builder));
  return parser;
}

/// Characters that mean something to the parser, or to other people, but nothing here.
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

/// What the parser says of the grammar, in our words.
std::string grammar_error(const mup::ParserError& error) {
  switch (error.GetCode()) {
    case mup::ecUNEXPECTED_EOF:
      return "the formula ends too early";
    case mup::ecMISSING_PARENS:
      return "a bracket is not closed";
    case mup::ecUNEXPECTED_PARENS:
      return "there is a bracket too many";
    case mup::ecTOO_MANY_PARAMS:
      return fmt::format("too many arguments of {}", error.GetToken());
    case mup::ecTOO_FEW_PARAMS:
      return fmt::format("too few arguments of {}", error.GetToken());
    case mup::ecUNEXPECTED_COMMA:
      return "there is a comma outside a function; decimals have a point";
    case mup::ecUNEXPECTED_VAL:
      return "a sign + - * / ^ is missing before this";
    default:
      return fmt::format("{} is not understood here",
                         error.GetToken().empty() ? "this" : "\"" + error.GetToken() + "\"");
  }
}

}  // namespace

ReadExpression read_expression(const std::string& text, const std::vector<Symbol>& symbols,
                               const UnitSystem& units) {
  // The sign "=" becomes a blank: columns are those of the whole text.
  std::string formula = text;
  const std::size_t first = formula.find_first_not_of(' ');
  if (first != std::string::npos && formula[first] == '=') formula[first] = ' ';
  ExpressionBuilder builder(formula, symbols, units);
  if (formula.find_first_not_of(' ') == std::string::npos) builder.fail(0, "there is no formula");
  check_characters(builder, formula);
  try {
    mup::ParserX parser = make_parser(builder);
    parser.SetExpr(formula);
    return builder.take(index_of(mup::ptr_val_type(parser.Eval().Clone()->AsIValue())));
  } catch (const mup::ParserError& error) {
    const int position = error.GetPos();
    builder.fail(position < 0 ? formula.size() : static_cast<std::size_t>(position),
                 grammar_error(error));
  }
}

}  // namespace pleuel
