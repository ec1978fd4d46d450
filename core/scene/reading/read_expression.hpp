#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/base/expression.hpp"
#include "core/scene/dimension_quantity.hpp"

/// What goes into the reading of a formula, and what comes out.
namespace pleuel {

/// Whether a unit counts cycles, Hz or kHz: 1/s in formulas, where frequencies are angular ones.
inline bool is_of_cycles(const std::string& unit) {
  return unit.find("Hz") != std::string::npos;
}

/// A name that an expression may use, and what it stands for.
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

struct ReadExpression {
  std::shared_ptr<const Expression> expression;
  Dimension dimension;
  /// Its value [SI] where it depends on no variable and no response.
  std::optional<double> constant;
  bool counts_cycles = false;  ///< made from Hz, which are 1/s in formulas
};

}  // namespace pleuel
