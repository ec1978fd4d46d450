#pragma once

#include "core/scene/number.hpp"
#include "core/scene/reading/symbols.hpp"
#include "core/scene/units.hpp"

namespace pleuel {

/// The rule as a part of a sentence: "must be positive [m]".
std::string rule_of(Range range, const Quantity& quantity);

/// A place where a design variable is used: as a number of the scene, or in a linear constraint.
struct VariableUse {
  Number number;
  Quantity quantity;
  Range range = Range::any;
  JsonNode node;
};

/// A fixed number where a design variable could stand.
struct FixedNumber {
  JsonNode node;
  double value = 0.0;  ///< [SI]
  Quantity quantity;
};

/// A formula that names a design variable.
struct VariableMention {
  int variable;
  JsonNode node;
};

/// Reads numbers with units, formulas, and bindings to design variables. The quantity of a variable
/// is that of the places it is used in, which must agree; of one that only formulas name, that of
/// its unit. Everything throws InputError.
class NumberReader {
 public:
  /// @param variables  names in the order of the design.
  explicit NumberReader(std::vector<std::string> variables);

  /// Takes from the document what formulas may name (symbols.hpp), and whether it is that of one of
  /// several load cases (case_key).
  void declare(const JsonNode& root);
  /// The same names, from elsewhere.
  void declare(std::vector<Symbol> symbols) { symbols_ = std::move(symbols); }

  /// A design variable that a limit on variables names.
  void count_as_used(int variable) { used_elsewhere_.push_back(variable); }

  /// Reads a part of the document. That of one load case leaves out what is made from several
  /// (across_cases.hpp); variables that are named there count as used.
  /// @param name  of the part: what names it is left out, too
  /// @returns     whether it was read
  template <class Read>
  bool read_or_leave_out(const std::string& name, const Read& read) {
    try {
      read();
      return true;
    } catch (const NamesCases& cause) {
      if (!is_of_case_) throw;
      leave_out(name, cause.formula());
      return false;
    }
  }

  bool is_of_case() const { return is_of_case_; }
  /// Whether a document of one load case leaves out what has this name: a part that it has left out,
  /// or "bow [fast]", which is a number of a case.
  bool leaves_out(const std::string& name) const;
  /// The node is a name. @throws NamesCases if leaves_out()
  void require_here(const JsonNode& node) const;
  /// What is wrong in the document of one load case need not be where all of them are known.
  [[noreturn]] void fail_or_leave_out(const JsonNode& node, const std::string& rule) const;

  /// A number in SI, a text with unit or a formula of constants, not designable.
  double fixed(const JsonNode& node, const Quantity& quantity, Range range = Range::any) const;

  /// A number in SI, a text with unit, a formula, or {"variable": name, "factor": number}.
  /// The range of a bound number is checked later, when the bounds are known.
  Number designable(const JsonNode& node, const Quantity& quantity, Range range = Range::any);

  /// Three designable numbers of the same quantity.
  std::array<Number, 3> triple(const JsonNode& node, const Quantity& quantity);

  /// Three plain numbers, not all zero.
  std::array<double, 3> direction(const JsonNode& node) const;

  /// The same, made a unit vector.
  std::array<double, 3> unit_vector(const JsonNode& node) const;

  /// A formula that may name constants, design variables and these symbols, besides.
  ReadExpression formula(const JsonNode& node, const std::vector<Symbol>& more = {});

  /// The same, which must measure this quantity.
  ReadExpression formula_of(const JsonNode& node, const Quantity& quantity,
                            const std::vector<Symbol>& more);

  /// Index of the variable with this name, which the document has at `node`.
  int variable(const JsonNode& node, const std::string& name) const;

  /// The start of a variable that is there, in the document. @throws InputError if it has none
  double start_of(const std::string& name, const Quantity& quantity) const;

  /// Index of the variable with this name, if there is one.
  std::optional<int> find_variable(const std::string& name) const;

  /// Says that a variable means this quantity here. Checks that it means the same everywhere.
  void add_use(VariableUse use);

  const std::vector<VariableUse>& uses() const { return uses_; }

  const std::vector<VariableMention>& mentions() const { return mentions_; }

  /// Those of the uses that are formulas.
  std::vector<RangedFormula> ranged_formulas() const;

  /// Whether a formula takes the variable for another quantity than its uses do: what is wrong with
  /// it. @pre it is used or mentioned
  void check_mention(const VariableMention& mention) const;

  /// All that designable() found to be fixed, in the order of reading. Formulas are not among them.
  const std::vector<FixedNumber>& fixed_numbers() const { return fixed_; }

  /// The quantity of a variable; nothing if it is not used, or has a unit that no number has.
  std::optional<Quantity> quantity_of(int variable) const;

 private:
  void leave_out(const std::string& name, const std::string& formula);
  const VariableUse* first_use(int variable) const;
  Number binding(const JsonNode& node, const Quantity& quantity, Range range);
  /// {"variable": name, "path": [values]}, which section_choices.hpp writes.
  Number path_binding(const JsonNode& node, const JsonNode& path, const Quantity& quantity,
                      Range range);
  double constant_formula(const JsonNode& node, const Quantity& quantity) const;
  void check_quantity(const JsonNode& node, const ReadExpression& read,
                      const Quantity& quantity) const;
  Number designable_formula(const JsonNode& node, const Quantity& quantity, Range range);
  const Symbol* symbol_of(int variable) const;

  std::vector<std::string> variables_;
  std::vector<Symbol> symbols_;
  std::optional<JsonNode> root_;
  std::vector<VariableMention> mentions_;
  std::vector<int> used_elsewhere_;
  bool is_of_case_ = false;
  std::vector<std::string> left_out_;
  std::vector<VariableUse> uses_;
  std::vector<FixedNumber> fixed_;
};

}  // namespace pleuel
