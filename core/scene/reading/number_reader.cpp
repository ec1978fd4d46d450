#include "core/scene/reading/number_reader.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/scene/reading/case_suffix.hpp"
#include "core/scene/reading/unit_scanner.hpp"

namespace pleuel {

std::string rule_of(Range range, const Quantity& quantity) {
  if (range == Range::any) return "must be " + describe(quantity);
  const std::string rule = fmt::format("must {}", kind_of(range).rule);
  if (quantity == quantities::pure_number) return rule;
  return fmt::format("{} [{}]", rule, quantity.unit);
}

NumberReader::NumberReader(std::vector<std::string> variables) : variables_(std::move(variables)) {}

double NumberReader::fixed(const JsonNode& node, const Quantity& quantity, Range range) const {
  const std::string expected = "must be " + describe(quantity);
  double value = 0.0;
  if (node.value().is_number()) {
    value = node.value().get<double>();
  } else if (is_formula(node)) {
    value = constant_formula(node, quantity);
  } else if (node.value().is_string()) {
    try {
      value = read_quantity(node.value().get<std::string>(), quantity);
    } catch (const UnitError& error) {
      const std::string text = node.value().get<std::string>();
      node.fail_with_value(expected,
                           fmt::format(": {}{}", error.what(), formula_hint(text, symbols_)));
    }
  } else {
    node.fail_with_value(expected + ": a number in SI units, a text with unit or a formula");
  }
  if (!is_within(range, value)) node.fail_with_value(rule_of(range, quantity));
  return value;
}

Number NumberReader::designable(const JsonNode& node, const Quantity& quantity, Range range) {
  if (node.value().is_object()) return binding(node, quantity, range);
  if (is_formula(node)) return designable_formula(node, quantity, range);
  if (node.value().is_number() || node.value().is_string()) {
    const double value = fixed(node, quantity, range);
    fixed_.push_back({node, value, quantity});
    return value;
  }
  node.fail_with_value(
      fmt::format("must be {}: a number in SI units, a text with unit, a formula \"= …\" or "
                  "{{\"variable\": name}}",
                  describe(quantity)));
}

void NumberReader::declare(const JsonNode& root) {
  symbols_ = read_symbols(root);
  root_ = root;
  is_of_case_ = root.find(case_key).has_value();
}

void NumberReader::leave_out(const std::string& name, const std::string& formula) {
  left_out_.push_back(name);
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    if (has_word(formula, variables_[i])) count_as_used(static_cast<int>(i));
  }
}

bool NumberReader::leaves_out(const std::string& name) const {
  if (!is_of_case_) return false;
  return split_case(name) || std::ranges::find(left_out_, name) != left_out_.end();
}

void NumberReader::require_here(const JsonNode& node) const {
  if (leaves_out(node.text())) fail_or_leave_out(node, "is of several load cases");
}

void NumberReader::fail_or_leave_out(const JsonNode& node, const std::string& rule) const {
  if (is_of_case_) throw NamesCases(node.message(rule), "");
  node.fail(rule);
}

ReadExpression NumberReader::formula(const JsonNode& node, const std::vector<Symbol>& more) {
  std::vector<Symbol> all = symbols_;
  all.insert(all.end(), more.begin(), more.end());
  for (const std::string& name : left_out_) {
    if (!find_named(all, name)) all.push_back({name, {}});
  }
  ReadExpression read = read_formula(node, all);
  for (const ExpressionArgument& argument : read.expression->arguments) {
    if (argument.kind != ExpressionArgument::Kind::variable) continue;
    mentions_.push_back({static_cast<int>(argument.index), node});
  }
  return read;
}

ReadExpression NumberReader::formula_of(const JsonNode& node, const Quantity& quantity,
                                        const std::vector<Symbol>& more) {
  ReadExpression read = formula(node, more);
  check_quantity(node, read, quantity);
  return read;
}

double NumberReader::constant_formula(const JsonNode& node, const Quantity& quantity) const {
  const ReadExpression read = [&] {
    try {
      return read_formula(node, symbols_);
    } catch (const NamesCases& error) {
      throw InputError(error.what());
    }
  }();
  if (!read.constant) {
    node.fail_with_value(
        "must be fixed here; a formula of design variables can stand for numbers "
        "of the scene");
  }
  check_quantity(node, read, quantity);
  return *read.constant;
}

void NumberReader::check_quantity(const JsonNode& node, const ReadExpression& read,
                                  const Quantity& quantity) const {
  const Dimension asked = dimension_of(quantity);
  if (read.is_zero() || asked == read.dimension) return;
  std::string more = fmt::format(", which is {}", describe(read.dimension));
  if (asked / Dimension::angle() == read.dimension) {
    more +=
        "; angles never come or go silently: write \"= f*1 rev\" for f cycles per second, as of "
        "\"10 "
        "Hz\", and \"= 2*pi*f*1 rad\" where the factor 2*pi is written out";
  } else if (read.dimension.is_number()) {
    more += "; give it its unit, as in \"5 mm\"";
  }
  node.fail_with_value(fmt::format("must be {}", describe(quantity)), more);
}

Number NumberReader::designable_formula(const JsonNode& node, const Quantity& quantity,
                                        Range range) {
  const ReadExpression read = formula(node);
  check_quantity(node, read, quantity);
  if (read.constant) {
    if (!is_within(range, *read.constant)) node.fail_with_value(rule_of(range, quantity));
    return *read.constant;
  }
  const Number number = Number::bound(read.expression);
  add_use({number, quantity, range, node});
  return number;
}

const Symbol* NumberReader::symbol_of(int variable) const {
  const auto found = std::ranges::find_if(symbols_, [&](const Symbol& symbol) {
    return symbol.argument && static_cast<int>(symbol.argument->index) == variable;
  });
  return found == symbols_.end() ? nullptr : &*found;
}

void NumberReader::check_mention(const VariableMention& mention) const {
  const std::string& name = variables_[mention.variable];
  const Dimension dimension = symbol_of(mention.variable)->dimension;
  const auto quantity = quantity_of(mention.variable);
  if (!quantity) {
    mention.node.fail(fmt::format(
        "names the variable \"{}\", which is {}: variables have units of numbers of the scene",
        name, describe(dimension)));
  }
  if (dimension == dimension_of(*quantity)) return;
  mention.node.fail(fmt::format(
      "takes the variable \"{}\" for {}, as its start is written, but {} uses it as {}; give the "
      "start of the variable its unit",
      name, describe(dimension), first_use(mention.variable)->node.place(), describe(*quantity)));
}

Number NumberReader::binding(const JsonNode& node, const Quantity& quantity, Range range) {
  // A path along choices is what catalogues of sections are read as, nothing that a file says.
  if (const auto path = node.find("path")) {
    node.allow_keys({"variable", "path"});
    return path_binding(node, *path, quantity, range);
  }
  node.allow_keys({"variable", "factor"});
  const JsonNode name = node.at("variable");
  const std::optional<JsonNode> factor = node.find("factor");
  if (factor && factor->number() == 0.0) factor->fail_with_value("must not be zero");
  const Number number = Number::bound(variable(name, name.text()), factor ? factor->number() : 1.0);
  add_use({number, quantity, range, node});
  return number;
}

Number NumberReader::path_binding(const JsonNode& node, const JsonNode& path,
                                  const Quantity& quantity, Range range) {
  const int index = variable(node.at("variable"), node.at("variable").text());
  Expression expression;
  expression.text = node.at("variable").text();
  expression.quantity = describe(quantity);
  expression.unit = std::string(quantity.unit);
  expression.arguments = {{ExpressionArgument::Kind::variable, static_cast<std::size_t>(index)}};
  expression.steps = {{Operation::argument, 0.0, 0}, {Operation::path, 0.0, 0}};
  for (const JsonNode& value : path.items()) {
    expression.path.push_back(fixed(value, quantity, range));
  }
  mentions_.push_back({index, node});
  return Number::bound(std::make_shared<const Expression>(std::move(expression)));
}

std::array<Number, 3> NumberReader::triple(const JsonNode& node, const Quantity& quantity) {
  const std::vector<JsonNode> items = node.items(3);
  return {designable(items[0], quantity), designable(items[1], quantity),
          designable(items[2], quantity)};
}

std::array<double, 3> NumberReader::direction(const JsonNode& node) const {
  const std::vector<JsonNode> items = node.items(3);
  const std::array<double, 3> direction = {items[0].number(), items[1].number(), items[2].number()};
  if (direction == std::array<double, 3>{0.0, 0.0, 0.0}) node.fail_with_value("must not be zero");
  return direction;
}

std::array<double, 3> NumberReader::unit_vector(const JsonNode& node) const {
  std::array<double, 3> vector = direction(node);
  const double largest = std::max({std::abs(vector[0]), std::abs(vector[1]), std::abs(vector[2])});
  for (double& component : vector) component /= largest;  // squares stay in range
  const double length = std::hypot(vector[0], vector[1], vector[2]);
  for (double& component : vector) component /= length;
  return vector;
}

int NumberReader::variable(const JsonNode& node, const std::string& name) const {
  const std::optional<int> found = find_variable(name);
  if (!found) fail_unknown_name(node, "variable", name, variables_);
  return *found;
}

double NumberReader::start_of(const std::string& name, const Quantity& quantity) const {
  return fixed(root_->at("variables").at(name).at("start"), quantity);
}

std::optional<int> NumberReader::find_variable(const std::string& name) const {
  const auto found = std::ranges::find(variables_, name);
  if (found == variables_.end()) return std::nullopt;
  return static_cast<int>(found - variables_.begin());
}

void NumberReader::add_use(VariableUse use) {
  if (use.number.expression) {
    uses_.push_back(std::move(use));
    return;
  }
  const VariableUse* first = first_use(use.number.variable);
  if (first != nullptr && !(first->quantity == use.quantity)) {
    use.node.fail(fmt::format("uses the variable \"{}\" as {}, but {} uses it as {}",
                              variables_[use.number.variable], describe(use.quantity),
                              first->node.place(), describe(first->quantity)));
  }
  uses_.push_back(std::move(use));
}

std::vector<RangedFormula> NumberReader::ranged_formulas() const {
  std::vector<RangedFormula> formulas;
  for (const VariableUse& use : uses_) {
    if (!use.number.expression) continue;
    formulas.push_back({use.number, use.range, use.node.place(), rule_of(use.range, use.quantity)});
  }
  return formulas;
}

const VariableUse* NumberReader::first_use(int variable) const {
  const auto first = std::ranges::find_if(
      uses_, [variable](const VariableUse& use) { return use.number.variable == variable; });
  return first == uses_.end() ? nullptr : &*first;
}

std::optional<Quantity> NumberReader::quantity_of(int variable) const {
  if (const VariableUse* first = first_use(variable)) return first->quantity;
  const bool is_mentioned = std::ranges::any_of(mentions_,
                                                [&](const VariableMention& mention) {
                                                  return mention.variable == variable;
                                                }) ||
                            std::ranges::find(used_elsewhere_, variable) != used_elsewhere_.end();
  if (!is_mentioned) return std::nullopt;
  return find_quantity(symbol_of(variable)->dimension);
}

}  // namespace pleuel
