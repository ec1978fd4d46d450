#pragma once

#include <memory>
#include <stdexcept>

#include "core/base/expression.hpp"
#include "core/base/find_named.hpp"
#include "core/scene/named_quantities.hpp"
#include "core/scene/reading/case_suffix.hpp"

/// What goes into the reading of a formula, and what comes out.
namespace pleuel {

/// Whether a unit counts cycles, Hz or kHz: 1/s in formulas, where frequencies are angular ones.
inline bool is_of_cycles(const std::string& unit) {
  return unit.find("Hz") != std::string::npos;
}

/// A name that an expression may use, and what it stands for: neither a constant nor an argument where
/// that is made from several load cases.
struct Symbol {
  std::string name;
  Dimension dimension;
  std::optional<double> constant = {};              ///< [SI]
  std::optional<ExpressionArgument> argument = {};  ///< if it is no constant
  bool counts_cycles = false;                       ///< a constant made from Hz
};

/// Why an expression cannot be read, and where. The text is the end of a sentence.
class ExpressionError : public std::runtime_error {
 public:
  ExpressionError(std::size_t column, const std::string& why)
      : std::runtime_error(why), column_(column) {}
  std::size_t column() const { return column_; }  ///< from 1, in characters of the whole text

 private:
  std::size_t column_;
};

/// It names load cases, or what is made from several, where none are known.
class CaseExpressionError : public ExpressionError {
 public:
  using ExpressionError::ExpressionError;
};

/// What is known of a number while a text is read.
struct KnownNumber {
  Dimension dimension;
  /// Its value [SI] where it depends on no variable and no response.
  std::optional<double> constant = {};
  bool counts_cycles = false;  ///< made from Hz, which are 1/s in formulas

  /// A plain 0, which is as well no length, no mass, …
  bool is_zero() const { return constant == 0.0 && dimension.is_number(); }
};

struct ReadExpression : KnownNumber {
  std::shared_ptr<const Expression> expression;
};

/// Puts the steps of an expression together while its text is read, and checks that units fit.
/// Operands are indices of steps; positions are those of bytes in the text.
class ExpressionBuilder {
 public:
  /// All must outlive this.
  ExpressionBuilder(std::string_view text, const std::vector<Symbol>& symbols)
      : text_(text), symbols_(symbols) {}

  /// @throws ExpressionError at the column of the position, always
  [[noreturn]] void fail(std::size_t position, const std::string& why) const {
    throw ExpressionError(column_of(position), why);
  }

  /// @param value  the number before the unit
  int add_quantity(std::size_t position, double value, const std::string& unit);

  /// @throws ExpressionError for a name that means nothing, or two things
  int add_name(std::size_t position, const std::string& name);

  /// Of one operand, or of two.
  /// @throws ExpressionError where units do not fit, or the result is no finite number
  int apply(std::size_t position, Operation operation, int first, int second = -1);

  const Symbol* find(const std::string& name) const { return find_named(symbols_, name); }
  bool is_unit(const std::string& name) const;

  /// The expression whose result is that of the last step. Ends the building.
  ReadExpression take();

 private:
  std::size_t column_of(std::size_t position) const;

  int add(const ExpressionStep& step, const KnownNumber& facts);
  int add_constant(const KnownNumber& known);
  int add_symbol(const Symbol& symbol);
  void fold(std::size_t position, int step);
  [[noreturn]] void fail_unknown(std::size_t position, const std::string& name) const;
  [[noreturn]] void fail_unknown_case(std::size_t position, const NameInCase& wanted) const;

  std::string_view text_;
  const std::vector<Symbol>& symbols_;
  Expression expression_;
  std::vector<KnownNumber> facts_;  ///< one a step
};

}  // namespace pleuel
